/* SPDX-License-Identifier: MIT */
#include "io/asterix/asterix_udp_receiver.h"

#include <arpa/inet.h>
#include <errno.h>
#include <net/if.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/common.h"

#define SCHEME "udp://"
/* socket buffer, for datagrams that arrive while the program is busy */
#define BUFFER_BYTES (2 << 20)

bool asterix_udp_receiver_is_url(const char *text)
{
    return text_begins_with(text, SCHEME);
}

/* Processes the records of a data block; false from the first one that cannot be read. */
static bool process_block_records(struct asterix_scans *scans, const struct asterix_block *block)
{
    struct asterix_block_source source = {.is_given = false};
    struct asterix_record record;
    struct asterix_error error;

    for (size_t at = 0; at < block->size; at += record.size) {
        if (!asterix_record_read(block->category, block->records + at, block->size - at, &record,
                                 &error)) {
            return false;
        }
        asterix_record_complete_source(&record, at == 0, &source);
        asterix_scans_take_record(scans, &record);
    }
    return true;
}

void asterix_datagram_take_records(struct asterix_scans *scans, const uint8_t *data, size_t size,
                                   struct asterix_datagram_counts *heard)
{
    struct asterix_block block;
    struct asterix_error error;

    heard->datagrams++;
    for (size_t at = 0; at < size; at += ASTERIX_HEADER_BYTES + block.size) {
        if (!asterix_block_read(data + at, size - at, &block, &error)) {
            heard->bad++;
            return;
        }
        if (!asterix_category_is_plots(block.category) &&
            !asterix_category_is_service(block.category)) {
            heard->others++;
        } else if (!process_block_records(scans, &block)) {
            heard->bad++;
            return;
        }
    }
}

static struct sockaddr_in parse_url(const char *url)
{
    struct sockaddr_in address = {.sin_family = AF_INET};
    char *text = must_copy_text(url + strlen(SCHEME)), *port = strrchr(text, ':'), *end = NULL;
    long number = port ? strtol(port + 1, &end, 10) : 0;

    if (!port || end == port + 1 || *end || port[1] < '0' || port[1] > '9' || number < 1 ||
        number > 65535) {
        fail(EXIT_USAGE, "%s: udp://ADDRESS:PORT is needed, with a port from 1 to 65535", url);
    }
    *port = '\0';
    if (*text && inet_pton(AF_INET, text, &address.sin_addr) != 1) {
        fail(EXIT_USAGE, "%s: '%s' is not an IPv4 address", url, text);
    }
    address.sin_port = htons((uint16_t)number);
    free(text);
    return address;
}

/* Exit 1 with the reason in errno where the result of a system call is not 0. */
static void fail_if_nonzero(const char *url, int result)
{
    if (result) {
        fail(EXIT_RUNTIME, "%s: %s", url, strerror(errno));
    }
}

static void join_multicast_group(const char *url, int receiver, const struct sockaddr_in *group)
{
    struct ip_mreqn member = {.imr_multiaddr = group->sin_addr};

    if (setsockopt(receiver, IPPROTO_IP, IP_ADD_MEMBERSHIP, &member, sizeof member) == 0) {
        return;
    }
    member.imr_ifindex = (int)if_nametoindex("lo");
    fail_if_nonzero(url,
                    setsockopt(receiver, IPPROTO_IP, IP_ADD_MEMBERSHIP, &member, sizeof member));
    fprintf(stderr,
            "rhotrack: %s: no route to this group; the loopback is used, which reaches only "
            "programs of this machine\n",
            url);
}

int asterix_udp_receiver_open(const char *url)
{
    struct sockaddr_in address = parse_url(url);
    int receiver = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0), yes = 1, bytes = BUFFER_BYTES;

    fail_if_nonzero(url, receiver < 0);
    fail_if_nonzero(url, setsockopt(receiver, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes));
    if (setsockopt(receiver, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes)) {
        fail_if_nonzero(url, setsockopt(receiver, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes));
    }
    fail_if_nonzero(url, bind(receiver, (const struct sockaddr *)&address, sizeof address));
    if (IN_MULTICAST(ntohl(address.sin_addr.s_addr))) {
        join_multicast_group(url, receiver, &address);
    }
    return receiver;
}
