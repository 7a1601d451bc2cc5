/* SPDX-License-Identifier: MIT */
/*
 * udp_frame: builds and parses Ethernet frames with an IPv4 UDP datagram to LCM's multicast group,
 * and builds the IGMP report by which switches learn that this host is a member. Sends no ARP, no
 * fragments and no IP options.
 */
#ifndef UDP_FRAME_H
#define UDP_FRAME_H

#include <stddef.h>
#include <stdint.h>

#define UDP_FRAME_HEAD 42u  /* size of the headers: Ethernet 14, IPv4 20, UDP 8 */
#define UDP_FRAME_MAX 1514u /* largest Ethernet frame */
#define UDP_FRAME_JOIN 60u  /* size of an IGMP report, padded to the smallest frame */

struct udp_frame_host {
    uint8_t mac[6];
    uint8_t address[4];
};

/*
 * Writes the headers of a frame whose payload_size bytes (at most 1472) are already at frame +
 * UDP_FRAME_HEAD. number: IPv4 identification, any. Returns the frame's size.
 */
size_t udp_frame_build_around_payload(uint8_t *frame, const struct udp_frame_host *from,
                                      uint16_t number, size_t payload_size);

/*
 * Parses a frame of any content. Returns the payload's size and sets *payload; 0 where it is no
 * complete datagram to LCM's group and port, or a checksum is wrong.
 */
size_t udp_frame_find_payload(const uint8_t *frame, size_t size, const uint8_t **payload);

/*
 * Sender's IPv4 address (10.9.0.1 as 0x0a090001) of a frame that udp_frame_find_payload accepted.
 */
uint32_t udp_frame_source_ipv4(const uint8_t *frame);

/* Writes an IGMP version 2 report for the group, UDP_FRAME_JOIN bytes. */
void udp_frame_build_igmp_report(uint8_t frame[UDP_FRAME_JOIN], const struct udp_frame_host *from);

#endif
