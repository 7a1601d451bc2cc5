/* SPDX-License-Identifier: MIT */
#include "transport/network_watch.h"

#include <errno.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

/* BUFFER_BYTES: more than most messages of the kernel have; longer ones are cut, and count. */
enum { BUFFER_BYTES = 8192 };

union buffer {
    struct nlmsghdr align;
    uint8_t bytes[BUFFER_BYTES];
};

int network_watch_open(void)
{
    const struct sockaddr_nl changes = {.nl_family = AF_NETLINK,
                                        .nl_groups = RTMGRP_LINK | RTMGRP_IPV4_IFADDR |
                                                     RTMGRP_IPV4_ROUTE | RTMGRP_IPV4_RULE};
    int watch = socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, NETLINK_ROUTE);

    if (watch >= 0 && bind(watch, (const struct sockaddr *)&changes, sizeof changes)) {
        close(watch);
        watch = -1;
    }
    return watch;
}

/* Copies the part of a message behind its header; false where the message is shorter. */
static bool copy_message_body(const struct nlmsghdr *header, void *body, size_t size)
{
    if (header->nlmsg_len < NLMSG_LENGTH(size)) {
        return false;
    }
    memcpy(body, (const uint8_t *)header + NLMSG_HDRLEN, size);
    return true;
}

static enum network_change change_of_message(const struct nlmsghdr *header, unsigned interface)
{
    struct ifinfomsg link;
    struct ifaddrmsg address;
    bool is_of_interface = false;

    if (header->nlmsg_type == RTM_NEWLINK || header->nlmsg_type == RTM_DELLINK) {
        is_of_interface =
            copy_message_body(header, &link, sizeof link) && (unsigned)link.ifi_index == interface;
    } else if (header->nlmsg_type == RTM_NEWADDR || header->nlmsg_type == RTM_DELADDR) {
        is_of_interface =
            copy_message_body(header, &address, sizeof address) && address.ifa_index == interface;
    }
    return is_of_interface ? NETWORK_INTERFACE : NETWORK_ROUTES;
}

enum network_change network_watch_read(int watch, unsigned interface)
{
    enum network_change greatest = NETWORK_SAME;
    union buffer buffer;
    ssize_t got;

    do {
        got = recv(watch, &buffer, sizeof buffer, MSG_TRUNC);
        if (got > (ssize_t)sizeof buffer || (got < 0 && errno == ENOBUFS)) {
            greatest = NETWORK_INTERFACE;
        } else if (got >= (ssize_t)sizeof buffer.align) {
            enum network_change change = change_of_message(&buffer.align, interface);

            greatest = change > greatest ? change : greatest;
        }
    } while (got > 0 || (got < 0 && (errno == ENOBUFS || errno == EINTR)));
    return greatest;
}

/* Asks the kernel for a route; the size of its answer, or -1 with errno. */
static ssize_t ask_route(int asking, struct in_addr to, union buffer *answer)
{
    struct {
        struct nlmsghdr header;
        struct rtmsg route;
        struct rtattr attribute;
        struct in_addr to;
    } question = {.header = {.nlmsg_len = sizeof question,
                             .nlmsg_type = RTM_GETROUTE,
                             .nlmsg_flags = NLM_F_REQUEST},
                  .route = {.rtm_family = AF_INET, .rtm_dst_len = 32},
                  .attribute = {.rta_len = RTA_LENGTH(sizeof to), .rta_type = RTA_DST},
                  .to = to};

    /* the kernel has answered when send returns */
    return send(asking, &question, sizeof question, 0) < 0
               ? -1
               : recv(asking, answer, sizeof *answer, MSG_DONTWAIT);
}

static void read_route_attributes(const uint8_t *attributes, size_t bytes,
                                  struct network_route *route)
{
    struct rtattr attribute;

    while (bytes >= sizeof attribute) {
        size_t step;
        bool is_word;

        memcpy(&attribute, attributes, sizeof attribute);
        step = RTA_ALIGN(attribute.rta_len);
        is_word = attribute.rta_len == RTA_LENGTH(sizeof(uint32_t));
        if (attribute.rta_len < RTA_LENGTH(0) || step > bytes) {
            return;
        }
        if (attribute.rta_type == RTA_OIF && is_word) {
            memcpy(&route->interface, attributes + RTA_LENGTH(0), sizeof route->interface);
        } else if (attribute.rta_type == RTA_PREFSRC && is_word) {
            memcpy(&route->address, attributes + RTA_LENGTH(0), sizeof route->address);
        }
        attributes += step;
        bytes -= step;
    }
}

/* Adds what the answer does not say: the name, and the address where packets have none yet. */
static void name_interface(struct network_route *route)
{
    struct ifreq request = {.ifr_name = ""};
    const int descriptor = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);

    if (if_indextoname(route->interface, route->name)) {
        memcpy(request.ifr_name, route->name, sizeof request.ifr_name);
        if (route->address.s_addr == 0 && ioctl(descriptor, SIOCGIFADDR, &request) == 0) {
            struct sockaddr_in address;

            memcpy(&address, &request.ifr_addr, sizeof address);
            route->address = address.sin_addr;
        }
    } else {
        route->name[0] = '\0';
    }
    if (descriptor >= 0) {
        close(descriptor);
    }
}

static int read_route(const union buffer *answer, size_t bytes, struct network_route *route)
{
    const size_t head = NLMSG_LENGTH(sizeof(struct rtmsg));
    struct nlmsgerr error;

    if (bytes < head || answer->align.nlmsg_len > bytes || answer->align.nlmsg_len < head) {
        return EPROTO;
    }
    if (answer->align.nlmsg_type == NLMSG_ERROR) {
        return copy_message_body(&answer->align, &error, sizeof error) ? -error.error : EPROTO;
    }
    read_route_attributes(answer->bytes + head, answer->align.nlmsg_len - head, route);
    name_interface(route);
    return route->interface ? 0 : ENETUNREACH;
}

/* The route as a socket's own address tells it, without the interface. */
static int find_source_address(struct in_addr to, struct network_route *route)
{
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons(9), .sin_addr = to};
    socklen_t size = sizeof address;
    int descriptor = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0), error = 0;

    if (connect(descriptor, (const struct sockaddr *)&address, size) ||
        getsockname(descriptor, (struct sockaddr *)&address, &size)) {
        error = errno;
    }
    route->address = address.sin_addr;
    if (descriptor >= 0) {
        close(descriptor);
    }
    return error;
}

int network_route_find(struct in_addr to, struct network_route *route)
{
    const int asking = socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
    union buffer answer;
    ssize_t got;
    int error;

    *route = (struct network_route){.interface = 0};
    if (asking < 0) {
        return find_source_address(to, route);
    }
    got = ask_route(asking, to, &answer);
    error = got < 0 ? errno : read_route(&answer, (size_t)got, route);
    close(asking);
    return error;
}
