/* SPDX-License-Identifier: MIT */
/*
 * board: what the radar node asks of the hardware. To bring it to another processor, write these
 * functions; nothing else of the node knows where it runs. All are called from one thread.
 */
#ifndef BOARD_H
#define BOARD_H

#include <stddef.h>
#include <stdint.h>

/* Opens network and clock. Returns 0 where the hardware does not answer. */
int board_open(void);

/*
 * Microseconds since the start; goes on as long as it is called, or board_wait, at least once a
 * minute.
 */
int64_t board_time_us(void);

/*
 * A datagram to LCM's group and port that has come. It goes into the buffer; what is longer than
 * capacity is left out whole. Returns its bytes, and the address that it came from (IPv4, 10.9.0.1
 * as 0x0a090001); 0: none has come.
 */
size_t board_receive(uint8_t *buffer, size_t capacity, uint32_t *source_ipv4);

/* Sends a datagram to LCM's group and port; waits some milliseconds for room, and drops it then. */
void board_send(const uint8_t *datagram, size_t size);

/* How many were dropped so far. */
uint32_t board_unsent(void);

/* Counts the starts, in memory that stays without power; 0 where there is none. */
int32_t board_boot(void);

/* Sleeps until a datagram may have come, or that time. May return earlier. */
void board_wait(int64_t until_us);

/* A line for whoever maintains the node. */
void board_say(const char *text);

/* The most of the stack that was in use so far, in bytes. */
size_t board_stack_used(void);

#endif
