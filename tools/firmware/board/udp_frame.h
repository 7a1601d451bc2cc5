/* SPDX-License-Identifier: MIT */
/*
 * udp_frame: Ethernet frames with an IPv4 UDP datagram to LCM's multicast group, and the IGMP
 * report by which switches learn that this host wants it. No ARP, no fragments, no IP options in
 * what is sent.
 */
#ifndef UDP_FRAME_H
#define UDP_FRAME_H

#include <stddef.h>
#include <stdint.h>

#define UDP_FRAME_HEAD 42u /* Ethernet 14, IPv4 20, UDP 8 */
#define UDP_FRAME_MAX 1514u
#define UDP_FRAME_JOIN 60u

struct udp_frame_host {
    uint8_t mac[6];
    uint8_t address[4];
};

/*
 * Writes the head of a frame before payload_size bytes of payload (1472 at most) that stand at
 * frame + UDP_FRAME_HEAD. number: the datagram's, any. Returns the frame's bytes.
 */
size_t udp_frame_build(uint8_t *frame, const struct udp_frame_host *from, uint16_t number,
                       size_t payload_size);

/*
 * Opens a frame of any bytes. Returns the payload's bytes and where it begins; 0 where it is no
 * whole datagram to the group and port, or its checksums are wrong.
 */
size_t udp_frame_open(const uint8_t *frame, size_t size, const uint8_t **payload);

/*
 * The address that a frame comes from which udp_frame_open has opened: IPv4, 10.9.0.1 as
 * 0x0a090001.
 */
uint32_t udp_frame_source(const uint8_t *frame);

/* Writes an IGMP version 2 report for the group, UDP_FRAME_JOIN bytes. */
void udp_frame_join(uint8_t frame[UDP_FRAME_JOIN], const struct udp_frame_host *from);

#endif
