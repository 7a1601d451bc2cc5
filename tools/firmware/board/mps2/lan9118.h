/* SPDX-License-Identifier: MIT */
/*
 * lan9118: Ethernet frames through an SMSC LAN9118, by polling; its interrupt says that there are
 * some.
 */
#ifndef LAN9118_H
#define LAN9118_H

#include <stddef.h>
#include <stdint.h>

/* Takes all multicast frames, and those to this address. Returns 0 where no such chip answers. */
int lan9118_open(const uint8_t mac[6]);

/*
 * A frame that has come, without its checksum; one longer than capacity, or damaged, is left out.
 * Returns its bytes.
 */
size_t lan9118_receive(uint8_t *frame, size_t capacity);

/* Returns 0 where the chip has no room for it. */
int lan9118_send(const uint8_t *frame, size_t size);

#endif
