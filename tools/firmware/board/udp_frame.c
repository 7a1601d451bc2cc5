/* SPDX-License-Identifier: MIT */
#include "udp_frame.h"

#include <string.h>

#include "rhotrack/udpm.h"

#define ETHERNET_HEAD 14u
#define IP_HEAD 20u
#define UDP_HEAD 8u
#define PROTOCOL_IGMP 2
#define PROTOCOL_UDP 17
#define IGMP_REPORT 0x16

/* LCM's multicast group, as in RHO_UDPM_GROUP */
static const uint8_t group[4] = {239, 255, 76, 67};
static const uint8_t group_mac[6] = {0x01, 0x00, 0x5e, 0x7f, 0x4c, 0x43};

static void put_be16(uint8_t *out, unsigned value)
{
    out[0] = (uint8_t)(value >> 8);
    out[1] = (uint8_t)value;
}

static unsigned get_be16(const uint8_t *in)
{
    return (unsigned)in[0] << 8 | in[1];
}

/* Adds bytes to the running sum of an Internet checksum. */
static uint32_t add_to_checksum(uint32_t sum, const uint8_t *bytes, size_t size)
{
    for (size_t i = 0; i + 1 < size; i += 2) {
        sum += get_be16(bytes + i);
    }
    return size % 2 ? sum + ((uint32_t)bytes[size - 1] << 8) : sum;
}

static unsigned fold_checksum(uint32_t sum)
{
    while (sum >> 16) {
        sum = (sum & 0xffff) + (sum >> 16);
    }
    return (unsigned)sum;
}

/* Checksum sum of a UDP datagram with its pseudo header: 0xffff where its checksum is right. */
static unsigned folded_udp_checksum_sum(const uint8_t *ip, const uint8_t *udp, size_t size)
{
    return fold_checksum(
        add_to_checksum(add_to_checksum(PROTOCOL_UDP + (uint32_t)size, ip + 12, 8), udp, size));
}

static void put_ethernet_head(uint8_t *frame, const struct udp_frame_host *from)
{
    memcpy(frame, group_mac, 6);
    memcpy(frame + 6, from->mac, 6);
    put_be16(frame + 12, 0x0800);
}

/*
 * Writes an IPv4 header of head_size bytes (its options are there already) for a packet of size
 * bytes.
 */
static void put_ip_head(uint8_t *ip, const struct udp_frame_host *from, uint8_t protocol,
                        uint16_t number, size_t head_size, size_t size)
{
    ip[0] = (uint8_t)(0x40 | head_size / 4);
    ip[1] = 0;
    put_be16(ip + 2, (unsigned)size);
    put_be16(ip + 4, number);
    put_be16(ip + 6, 0x4000); /* do not fragment */
    ip[8] = 1;                /* time to live 1: does not leave the local network */
    ip[9] = protocol;
    put_be16(ip + 10, 0);
    memcpy(ip + 12, from->address, 4);
    memcpy(ip + 16, group, 4);
    put_be16(ip + 10, ~fold_checksum(add_to_checksum(0, ip, head_size)) & 0xffffu);
}

size_t udp_frame_build_around_payload(uint8_t *frame, const struct udp_frame_host *from,
                                      uint16_t number, size_t payload_size)
{
    uint8_t *ip = frame + ETHERNET_HEAD, *udp = ip + IP_HEAD;
    size_t size = UDP_HEAD + payload_size;
    unsigned checksum;
    put_ethernet_head(frame, from);
    put_ip_head(ip, from, PROTOCOL_UDP, number, IP_HEAD, IP_HEAD + size);
    put_be16(udp, RHO_UDPM_PORT);
    put_be16(udp + 2, RHO_UDPM_PORT);
    put_be16(udp + 4, (unsigned)size);
    put_be16(udp + 6, 0);
    checksum = ~folded_udp_checksum_sum(ip, udp, size) & 0xffffu;
    put_be16(udp + 6, checksum ? checksum : 0xffffu); /* in UDP a checksum of 0 means none */
    return ETHERNET_HEAD + IP_HEAD + size;
}

/*
 * Size of the IPv4 header of an unfragmented UDP packet to LCM's group; 0 where the packet is
 * another one, incomplete or has a wrong checksum.
 */
static size_t checked_ip_head_size(const uint8_t *ip, size_t size)
{
    size_t head = 4u * (ip[0] & 15u);
    if (ip[0] >> 4 != 4 || head < IP_HEAD || get_be16(ip + 2) > size ||
        get_be16(ip + 2) < head + UDP_HEAD ||
        fold_checksum(add_to_checksum(0, ip, head)) != 0xffff) {
        return 0;
    }
    return ip[9] == PROTOCOL_UDP && (get_be16(ip + 6) & 0x3fff) == 0 &&
                   memcmp(ip + 16, group, 4) == 0
               ? head
               : 0;
}

size_t udp_frame_find_payload(const uint8_t *frame, size_t size, const uint8_t **payload)
{
    const uint8_t *ip = frame + ETHERNET_HEAD, *udp;
    size_t head, length;
    if (size < UDP_FRAME_HEAD || get_be16(frame + 12) != 0x0800) {
        return 0;
    }
    head = checked_ip_head_size(ip, size - ETHERNET_HEAD);
    if (head == 0) {
        return 0;
    }
    udp = ip + head;
    length = get_be16(udp + 4);
    if (get_be16(udp + 2) != RHO_UDPM_PORT || length < UDP_HEAD ||
        length > get_be16(ip + 2) - head ||
        (get_be16(udp + 6) != 0 && folded_udp_checksum_sum(ip, udp, length) != 0xffff)) {
        return 0;
    }
    *payload = udp + UDP_HEAD;
    return length - UDP_HEAD;
}

uint32_t udp_frame_source_ipv4(const uint8_t *frame)
{
    const uint8_t *source = frame + ETHERNET_HEAD + 12;
    return (uint32_t)get_be16(source) << 16 | get_be16(source + 2);
}

void udp_frame_build_igmp_report(uint8_t frame[UDP_FRAME_JOIN], const struct udp_frame_host *from)
{
    static const uint8_t router_alert[4] = {0x94, 0x04, 0, 0};
    uint8_t *ip = frame + ETHERNET_HEAD, *igmp = ip + IP_HEAD + 4;
    memset(frame, 0, UDP_FRAME_JOIN);
    put_ethernet_head(frame, from);
    memcpy(ip + IP_HEAD, router_alert, 4);
    put_ip_head(ip, from, PROTOCOL_IGMP, 0, IP_HEAD + 4, IP_HEAD + 4 + 8);
    igmp[0] = IGMP_REPORT;
    memcpy(igmp + 4, group, 4);
    put_be16(igmp + 2, ~fold_checksum(add_to_checksum(0, igmp, 8)) & 0xffffu);
}
