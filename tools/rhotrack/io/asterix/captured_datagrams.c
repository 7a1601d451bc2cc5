/* SPDX-License-Identifier: MIT */
#include "io/asterix/captured_datagrams.h"

#include <pcap/pcap.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/common.h"

#define TYPE_IPV4 0x0800u
#define TYPE_IPV6 0x86ddu
#define TYPE_VLAN 0x8100u
#define TYPE_VLANS 0x88a8u /* outer VLAN tag */
#define VLAN_BYTES 4u
#define PROTOCOL_UDP 17u
#define IPV4_BYTES 20u
#define IPV6_BYTES 40u
#define UDP_BYTES 8u
#define FRAGMENT 0x3fffu /* IPv4 bits of a fragment: more fragments, or an offset */

struct captured_datagrams {
    char *path;
    pcap_t *capture;
    int link;
    uint64_t packets, incomplete;
    bool is_cut; /* the file ends within a packet, or is damaged */
};

bool captured_datagrams_is_capture(const char *path)
{
    static const uint8_t beginnings[][4] = {
        {0xa1, 0xb2, 0xc3, 0xd4}, {0xd4, 0xc3, 0xb2, 0xa1}, /* pcap, microseconds */
        {0xa1, 0xb2, 0x3c, 0x4d}, {0x4d, 0x3c, 0xb2, 0xa1}, /* pcap, nanoseconds */
        {0x0a, 0x0d, 0x0d, 0x0a},                           /* pcapng */
    };
    uint8_t bytes[4];
    struct stat status;
    FILE *file = !stat(path, &status) && S_ISREG(status.st_mode) && status.st_size > 0
                     ? fopen(path, "rb")
                     : NULL;
    bool is_capture = false;

    if (file && fread(bytes, 1, sizeof bytes, file) == sizeof bytes) {
        for (size_t i = 0; i < sizeof beginnings / sizeof beginnings[0]; i++) {
            is_capture |= !memcmp(bytes, beginnings[i], sizeof bytes);
        }
    }
    if (file) {
        fclose(file);
    }
    return is_capture;
}

struct captured_datagrams *captured_datagrams_open(const char *path)
{
    struct captured_datagrams *captured = must_calloc(1, sizeof *captured);
    char reason[PCAP_ERRBUF_SIZE] = "";

    captured->path = must_copy_text(path);
    captured->capture = pcap_open_offline(path, reason);
    if (!captured->capture) {
        fail(EXIT_USAGE, "%s: the network recording cannot be read: %s", path, reason);
    }
    captured->link = pcap_datalink(captured->capture);
    switch (captured->link) {
    case DLT_EN10MB:
    case DLT_LINUX_SLL:
    case DLT_LINUX_SLL2:
    case DLT_RAW:
    case DLT_IPV4:
    case DLT_IPV6:
    case DLT_NULL:
    case DLT_LOOP:
        return captured;
    default:
        fail(EXIT_USAGE, "%s: packets of link type %s cannot be read", path,
             pcap_datalink_val_to_name(captured->link) ? pcap_datalink_val_to_name(captured->link)
                                                       : "(unknown)");
    }
}

/* The bytes of a packet that are not parsed yet. */
struct packet_rest {
    const uint8_t *data;
    size_t size;
};

static unsigned read_uint16(const uint8_t *data)
{
    return (unsigned)data[0] << 8 | data[1];
}

/* Skips `size` bytes; false where fewer are left. */
static bool skip_bytes(struct packet_rest *rest, size_t size)
{
    if (rest->size < size) {
        return false;
    }
    rest->data += size;
    rest->size -= size;
    return true;
}

/* Skips the link's header. Returns the type of the packet behind it; 0: none that is read. */
static unsigned skip_link_header(const struct captured_datagrams *captured,
                                 struct packet_rest *rest)
{
    static const struct {
        int link;
        size_t bytes, type_at;
    } links[] = {{DLT_EN10MB, 14, 12}, {DLT_LINUX_SLL, 16, 14}, {DLT_LINUX_SLL2, 20, 0}};
    unsigned type;

    for (size_t i = 0; i < sizeof links / sizeof links[0]; i++) {
        if (links[i].link != captured->link) {
            continue;
        }
        if (rest->size < links[i].bytes) {
            return 0;
        }
        type = read_uint16(rest->data + links[i].type_at);
        skip_bytes(rest, links[i].bytes);
        while ((type == TYPE_VLAN || type == TYPE_VLANS) && rest->size >= VLAN_BYTES) {
            type = read_uint16(rest->data + 2);
            skip_bytes(rest, VLAN_BYTES);
        }
        return type;
    }
    if ((captured->link == DLT_NULL || captured->link == DLT_LOOP) && !skip_bytes(rest, 4)) {
        return 0;
    }
    return rest->size > 0 && rest->data[0] >> 4 == 6 ? TYPE_IPV6 : TYPE_IPV4;
}

/*
 * Skips the header of an IPv4 packet that holds UDP, and cuts what is left to the packet's length,
 * since frames may be longer. False: no such packet, or incomplete.
 */
static bool skip_ipv4_header(struct packet_rest *rest, bool *is_incomplete)
{
    size_t header, total;

    if (rest->size < IPV4_BYTES || rest->data[0] >> 4 != 4 || rest->data[9] != PROTOCOL_UDP) {
        return false;
    }
    header = (size_t)(rest->data[0] & 15u) * 4u;
    total = read_uint16(rest->data + 2);
    if (header < IPV4_BYTES || total < header) {
        return false;
    }
    *is_incomplete = (read_uint16(rest->data + 6) & FRAGMENT) != 0 || total > rest->size;
    if (*is_incomplete) {
        return false;
    }
    rest->size = total;
    return skip_bytes(rest, header);
}

/* Skips the header of an IPv6 packet that holds UDP, without extension headers. */
static bool skip_ipv6_header(struct packet_rest *rest)
{
    if (rest->size < IPV6_BYTES || rest->data[0] >> 4 != 6 || rest->data[6] != PROTOCOL_UDP) {
        return false;
    }
    return skip_bytes(rest, IPV6_BYTES);
}

/* Cuts a packet to its UDP content; false where it has none, or is incomplete, which is counted. */
static bool cut_to_udp_content(struct captured_datagrams *captured, struct packet_rest *rest)
{
    const unsigned type = skip_link_header(captured, rest);
    bool is_incomplete = false;
    size_t size;

    if (!(type == TYPE_IPV4 ? skip_ipv4_header(rest, &is_incomplete)
                            : type == TYPE_IPV6 && skip_ipv6_header(rest)) ||
        rest->size < UDP_BYTES) {
        captured->incomplete += is_incomplete;
        return false;
    }
    size = read_uint16(rest->data + 4);
    if (size > rest->size) {
        captured->incomplete++;
        return false;
    }
    rest->size = size;
    return skip_bytes(rest, UDP_BYTES) && rest->size > 0;
}

bool captured_datagrams_next(struct captured_datagrams *captured, bool keep_going,
                             const uint8_t **data, size_t *size)
{
    struct pcap_pkthdr *header;
    const u_char *bytes;
    int got;

    while ((got = pcap_next_ex(captured->capture, &header, &bytes)) == 1) {
        struct packet_rest rest = {bytes, header->caplen};
        captured->packets++;
        if (cut_to_udp_content(captured, &rest)) {
            *data = rest.data;
            *size = rest.size;
            return true;
        }
    }
    if (got == PCAP_ERROR && !keep_going) {
        fail(EXIT_USAGE, "%s: after packet %llu: %s", captured->path,
             (unsigned long long)captured->packets, pcap_geterr(captured->capture));
    }
    captured->is_cut = got == PCAP_ERROR;
    return false;
}

uint64_t captured_datagrams_packet(const struct captured_datagrams *captured)
{
    return captured->packets;
}

const char *captured_datagrams_why_cut(const struct captured_datagrams *captured)
{
    return captured->is_cut ? pcap_geterr(captured->capture) : NULL;
}

uint64_t captured_datagrams_incomplete(const struct captured_datagrams *captured)
{
    return captured->incomplete;
}

void captured_datagrams_close(struct captured_datagrams *captured)
{
    if (captured) {
        pcap_close(captured->capture);
        free(captured->path);
        free(captured);
    }
}
