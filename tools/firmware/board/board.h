/* SPDX-License-Identifier: MIT */
/*
 * board: the functions that the radar node needs from the hardware. A port to another processor
 * writes these; no other part of the node depends on the hardware. All are called from one thread.
 */
#ifndef BOARD_H
#define BOARD_H

#include <stddef.h>
#include <stdint.h>

/* Opens network and clock. Returns 0 where the network chip does not answer. */
int board_try_to_open(void);

/*
 * Microseconds since the start. This function or board_sleep_until must be called at
 * least once a minute, or time is lost.
 */
int64_t board_time_us(void);

/*
 * Copies a received datagram to LCM's group and port into the buffer, and returns its size and the
 * sender's address (IPv4, 10.9.0.1 as 0x0a090001); 0 where none has arrived. Datagrams longer than
 * capacity are dropped.
 */
size_t board_receive(uint8_t *buffer, size_t capacity, uint32_t *source_ipv4);

/*
 * Sends a datagram to LCM's group and port; drops it if the chip has no room for some milliseconds.
 */
void board_send(const uint8_t *datagram, size_t size);

/* Number of datagrams that board_send has dropped. */
uint32_t board_num_unsent(void);

/* Increments and returns a count of starts in non-volatile memory; 0 where the board has none. */
int32_t board_count_start(void);

/* Sleeps until a datagram may have arrived or the time is until_us; may return earlier. */
void board_sleep_until(int64_t until_us);

/* Prints a line on the board's console. */
void board_print_line(const char *text);

/* Largest stack depth so far, in bytes. */
size_t board_stack_used(void);

#endif
