/* SPDX-License-Identifier: MIT */
/*
 * lan9118: driver of the Ethernet chip SMSC LAN9118; frames are polled, its interrupt signals
 * received ones.
 */
#ifndef LAN9118_H
#define LAN9118_H

#include <stddef.h>
#include <stdint.h>

/*
 * Starts the chip, which then receives all multicast frames and those to mac. Returns 0 where no
 * LAN9118 answers.
 */
int lan9118_try_to_open(const uint8_t mac[6]);

/*
 * Copies a received frame, without its checksum, and returns its size; 0 where there is none.
 * Frames that are damaged or longer than capacity are dropped.
 */
size_t lan9118_receive(uint8_t *frame, size_t capacity);

/* Sends a frame; returns 0 where the chip's FIFO has no room for it. */
int lan9118_try_to_send(const uint8_t *frame, size_t size);

#endif
