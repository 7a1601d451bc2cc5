/* SPDX-License-Identifier: MIT */
/* transport_udpm: the transport of LCM over UDP multicast, on a socket of this program. */
#include <arpa/inet.h>
#include <errno.h>
#include <net/if.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#include "base/common.h"
#include "rhotrack/udpm.h"
#include "transport/address_list.h"
#include "transport/network_watch.h"
#include "transport/transport_provider_interface.h"

/*
 * Interval of looks at the network where the group could not be joined, or the system tells of no
 * changes.
 */
#define RETRY_US 500000

/*
 * BATCH: datagrams read by one system call. DATAGRAM_BYTES: room for one; no message of rhotrack is
 * longer. SHORT_MESSAGE_BYTES: longest payload plus channel of an LCM message that fits a datagram;
 * longer messages would need fragments, and are not sent.
 */
enum { BATCH = 64, DATAGRAM_BYTES = 2048, SHORT_MESSAGE_BYTES = 65499 };

/*
 * Receive buffer. WANTED_BYTES hold a burst of large scans and the datagrams that arrive while this
 * program waits for a processor: a second of 1500 datagrams by the kernel's accounting. A buffer
 * below LITTLE_BYTES, half of Debian's limit, causes a warning.
 */
enum { WANTED_BYTES = 2 << 20, LITTLE_BYTES = 100 << 10 };

union control {
    struct cmsghdr align;
    char bytes[CMSG_SPACE(sizeof(struct timespec)) + CMSG_SPACE(sizeof(uint32_t))];
};

struct udpm {
    struct transport *transport;
    struct sockaddr_in group;
    int ttl, wanted_bytes;      /* wanted_bytes: receive buffer that the URL asks for; 0: none */
    struct network_route route; /* to the group; by the loopback where there is none */
    bool has_route;
    /*
     * socket descriptors; -1: none. ready: readable where receiver or watch is. member: holds the
     * membership of the group
     */
    int receiver, sender, watch, ready, member;
    int join_error;     /* of the last attempt to join the group; 0: it has succeeded */
    int64_t looked_us;  /* monotonic time of the last look at the network */
    in_port_t own_port; /* port of the sender's socket, network byte order; 0: not known yet */
    uint32_t sequence;
    struct rho_udpm_guard guard;
    int num_here, next; /* datagrams of the batch, and the next one to deliver */
    struct sockaddr_in sources[BATCH];
    struct mmsghdr here[BATCH];
    struct iovec parts[BATCH];
    union control controls[BATCH];
    uint8_t bytes[BATCH][DATAGRAM_BYTES];
};

static long parse_url_number(const struct transport *transport, const char *name, const char *text,
                             long min, long max)
{
    char *end;
    long number;

    errno = 0;
    number = strtol(text, &end, 10);
    if (*text < '0' || *text > '9' || *end || errno || number < min || number > max) {
        transport_refuse(transport, "%s '%s' is not a number from %ld to %ld", name, text, min,
                         max);
    }
    return number;
}

static void parse_url_option(struct transport *transport, struct udpm *udpm, char *option)
{
    char *value = strchr(option, '=');
    char reason[ADDRESS_LIST_REASON_BYTES];

    if (!value) {
        transport_refuse(transport, "option '%s' has no value", option);
    }
    *value++ = '\0';
    if (strcmp(option, "ttl") == 0) {
        udpm->ttl = (int)parse_url_number(transport, option, value, 0, 255);
    } else if (strcmp(option, "recv_buf_size") == 0) {
        udpm->wanted_bytes = (int)parse_url_number(transport, option, value, 2048, 1 << 30);
    } else if (strcmp(option, "sources_allowed") == 0) {
        if (!address_list_parse(option, value, &udpm->guard, reason)) {
            transport_refuse(transport, "%s", reason);
        }
    } else {
        transport_refuse(transport,
                         "unknown option '%s'; there are ttl, recv_buf_size and sources_allowed",
                         option);
    }
}

static void parse_group_and_port(struct transport *transport, struct udpm *udpm, char *text)
{
    char *port = strchr(text, ':');

    if (port) {
        *port++ = '\0';
        udpm->group.sin_port = htons((uint16_t)parse_url_number(transport, "port", port, 1, 65535));
    }
    if (*text && inet_pton(AF_INET, text, &udpm->group.sin_addr) != 1) {
        transport_refuse(transport, "'%s' is not an IPv4 address", text);
    }
    if (!IN_MULTICAST(ntohl(udpm->group.sin_addr.s_addr))) {
        transport_refuse(transport, "'%s' is not a multicast group (224.0.0.0 to 239.255.255.255)",
                         text);
    }
}

static void parse_udpm_url(struct transport *transport, struct udpm *udpm)
{
    char *text = must_copy_text(transport->url + strlen("udpm://"));
    char *options = strchr(text, '?'), *rest = NULL;

    if (options) {
        *options++ = '\0';
    }
    parse_group_and_port(transport, udpm, text);
    for (char *option = options ? strtok_r(options, "&", &rest) : NULL; option;
         option = strtok_r(NULL, "&", &rest)) {
        parse_url_option(transport, udpm, option);
    }
    free(text);
}

static void must_set_option(const struct transport *transport, int descriptor, int level,
                            int option, const void *value, socklen_t size)
{
    if (setsockopt(descriptor, level, option, value, size)) {
        fail(EXIT_RUNTIME, "%s: %s", transport->url, strerror(errno));
    }
}

static void must_set_int_option(const struct transport *transport, int descriptor, int level,
                                int option, int value)
{
    must_set_option(transport, descriptor, level, option, &value, sizeof value);
}

static int open_bare_udp_socket(const struct transport *transport)
{
    int descriptor = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);

    if (descriptor < 0) {
        fail(EXIT_RUNTIME, "%s: %s", transport->url, strerror(errno));
    }
    return descriptor;
}

static void set_receive_buffer(const struct transport *transport, const struct udpm *udpm)
{
    int wanted = udpm->wanted_bytes ? udpm->wanted_bytes : WANTED_BYTES, granted = 0;
    socklen_t size = sizeof granted;

    if (setsockopt(udpm->receiver, SOL_SOCKET, SO_RCVBUFFORCE, &wanted, sizeof wanted)) {
        must_set_int_option(transport, udpm->receiver, SOL_SOCKET, SO_RCVBUF, wanted);
    }
    if (getsockopt(udpm->receiver, SOL_SOCKET, SO_RCVBUF, &granted, &size) == 0) {
        granted /= 2; /* the kernel reports twice the size, which includes its overhead */
    }
    if (granted < (udpm->wanted_bytes ? udpm->wanted_bytes : LITTLE_BYTES)) {
        fprintf(stderr,
                "rhotrack: %s: the receive buffer has %d bytes, fewer than the %d requested: see "
                "sysctl net.core.rmem_max\n",
                transport->url, granted, wanted);
    }
}

/*
 * Opens the receiving socket. It is bound to the group's address, so that unicast datagrams to the
 * machine are not received.
 */
static void open_receiver(const struct transport *transport, struct udpm *udpm)
{
    udpm->receiver = open_bare_udp_socket(transport);
    must_set_int_option(transport, udpm->receiver, SOL_SOCKET, SO_REUSEADDR, 1);
    must_set_int_option(transport, udpm->receiver, SOL_SOCKET, SO_REUSEPORT, 1);
    must_set_int_option(transport, udpm->receiver, SOL_SOCKET, SO_TIMESTAMPNS, 1);
    must_set_int_option(transport, udpm->receiver, SOL_SOCKET, SO_RXQ_OVFL, 1);
    set_receive_buffer(transport, udpm);
    if (bind(udpm->receiver, (const struct sockaddr *)&udpm->group, sizeof udpm->group)) {
        fail(EXIT_RUNTIME, "%s: %s", transport->url, strerror(errno));
    }
    for (int i = 0; i < BATCH; i++) {
        udpm->parts[i] = (struct iovec){udpm->bytes[i], DATAGRAM_BYTES};
    }
}

static void open_sender(const struct transport *transport, struct udpm *udpm)
{
    struct timeval wait = {.tv_usec = 100000};

    udpm->sender = open_bare_udp_socket(transport);
    must_set_int_option(transport, udpm->sender, IPPROTO_IP, IP_MULTICAST_LOOP, 1);
    must_set_int_option(transport, udpm->sender, IPPROTO_IP, IP_MULTICAST_TTL, udpm->ttl);
    must_set_option(transport, udpm->sender, SOL_SOCKET, SO_SNDTIMEO, &wait, sizeof wait);
}

/* ---- The network, which may change ---- */

static void write_place(const struct udpm *udpm)
{
    struct transport *transport = udpm->transport;
    const struct network_route *route = &udpm->route;
    char group[INET_ADDRSTRLEN], address[INET_ADDRSTRLEN], place[TRANSPORT_PLACE_BYTES];
    const char *does = udpm->receiver < 0 ? "sends to"
                       : udpm->join_error ? "cannot listen to"
                                          : "listens to";

    inet_ntop(AF_INET, &udpm->group.sin_addr, group, sizeof group);
    inet_ntop(AF_INET, &route->address, address, sizeof address);
    snprintf(place, sizeof place, "%s %s:%u on %s (%s)%s%s%s", does, group,
             (unsigned)ntohs(udpm->group.sin_port), *route->name ? route->name : "an interface",
             route->address.s_addr ? address : "no address",
             udpm->has_route ? "" : ", the programs of this machine alone: no route to the group",
             udpm->join_error ? ": " : "", udpm->join_error ? strerror(udpm->join_error) : "");
    if (strcmp(place, transport->place) != 0) {
        memcpy(transport->place, place, sizeof place);
        transport->is_place_new = true;
    }
}

/*
 * Joins the group with a socket of its own, before the one is closed that has joined it until now:
 * where the membership still holds, it is never left, and the network hears nothing of it.
 */
static void join_group(struct udpm *udpm)
{
    const struct ip_mreqn member = {.imr_multiaddr = udpm->group.sin_addr,
                                    .imr_ifindex = (int)udpm->route.interface};
    const int descriptor = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);

    udpm->join_error =
        setsockopt(descriptor, IPPROTO_IP, IP_ADD_MEMBERSHIP, &member, sizeof member) ? errno : 0;
    if (udpm->member >= 0) {
        close(udpm->member);
    }
    udpm->member = descriptor;
}

/*
 * Looks for the route to the group. Without one the loopback is used: programs on a machine without
 * a network can still reach each other.
 */
static void follow_route(struct udpm *udpm)
{
    struct ip_mreqn out = {.imr_ifindex = 0}; /* as routes say */

    udpm->has_route = network_route_find(udpm->group.sin_addr, &udpm->route) == 0;
    if (!udpm->has_route) {
        udpm->route = (struct network_route){
            .interface = if_nametoindex("lo"), .name = "lo", .address = {htonl(INADDR_LOOPBACK)}};
        out.imr_ifindex = (int)udpm->route.interface;
    }
    (void)setsockopt(udpm->sender, IPPROTO_IP, IP_MULTICAST_IF, &out, sizeof out);
}

/* True where a look at the network is due though the kernel tells of no change. */
static bool is_look_due(const struct udpm *udpm)
{
    return (udpm->join_error || udpm->watch < 0) &&
           monotonic_clock_us() >= udpm->looked_us + RETRY_US;
}

/* Follows changes of the network since the last call, and tries again to join the group. */
static void follow_network(struct udpm *udpm)
{
    const unsigned before = udpm->route.interface;
    enum network_change change = is_look_due(udpm) ? NETWORK_INTERFACE : NETWORK_SAME;

    if (udpm->watch >= 0) {
        const enum network_change told = network_watch_read(udpm->watch, before);

        change = told > change ? told : change;
    }
    if (change == NETWORK_SAME) {
        return;
    }
    udpm->looked_us = monotonic_clock_us();
    follow_route(udpm);
    if (udpm->receiver >= 0 && (change == NETWORK_INTERFACE || udpm->route.interface != before)) {
        join_group(udpm);
    }
    write_place(udpm);
}

static int ready_descriptor(const void *object)
{
    return ((const struct udpm *)object)->ready;
}

static void receive_batch_of_datagrams(struct udpm *udpm)
{
    int count;

    for (int i = 0; i < BATCH; i++) {
        udpm->here[i].msg_hdr = (struct msghdr){.msg_name = &udpm->sources[i],
                                                .msg_namelen = sizeof udpm->sources[i],
                                                .msg_iov = &udpm->parts[i],
                                                .msg_iovlen = 1,
                                                .msg_control = &udpm->controls[i],
                                                .msg_controllen = sizeof udpm->controls[i]};
    }
    count = recvmmsg(udpm->receiver, udpm->here, BATCH, MSG_DONTWAIT, NULL);
    udpm->num_here = count > 0 ? count : 0;
    udpm->next = 0;
}

/*
 * Reception time of a datagram, by the kernel's time stamp; also records the kernel's count of
 * dropped datagrams.
 */
static int64_t read_reception_time_and_drops(struct transport *transport, struct msghdr *header)
{
    int64_t time_us = INT64_MAX;

    for (struct cmsghdr *part = CMSG_FIRSTHDR(header); part; part = CMSG_NXTHDR(header, part)) {
        if (part->cmsg_level == SOL_SOCKET && part->cmsg_type == SO_TIMESTAMPNS) {
            struct timespec time;

            memcpy(&time, CMSG_DATA(part), sizeof time);
            time_us = (int64_t)time.tv_sec * 1000000 + time.tv_nsec / 1000;
        } else if (part->cmsg_level == SOL_SOCKET && part->cmsg_type == SO_RXQ_OVFL) {
            uint32_t dropped;

            memcpy(&dropped, CMSG_DATA(part), sizeof dropped);
            transport->counters.dropped = dropped;
        }
    }
    return time_us == INT64_MAX ? transport_now_us(transport)
                                : transport_reception_time_us(transport, time_us);
}

/* True for a datagram that this program sent itself, which multicast loops back. */
static bool is_own_datagram(struct udpm *udpm, const struct sockaddr_in *source)
{
    struct sockaddr_in own = {.sin_port = 0};
    socklen_t size = sizeof own;

    if (udpm->own_port == 0 && getsockname(udpm->sender, (struct sockaddr *)&own, &size) == 0) {
        udpm->own_port = own.sin_port; /* the port is 0 until the first message is sent */
    }
    return udpm->own_port != 0 && udpm->own_port == source->sin_port;
}

static bool is_source_admitted(struct transport *transport, struct udpm *udpm,
                               const struct sockaddr_in *source)
{
    if (rho_udpm_admits(&udpm->guard, ntohl(source->sin_addr.s_addr))) {
        return true;
    }
    transport->counters.refused_source += !is_own_datagram(udpm, source);
    return false;
}

/*
 * Parses a datagram into a message. Returns false, and counts a refusal, where it is not an LCM
 * message; long messages of other programs are recognised by their channel and not counted.
 */
static bool parse_whole_message(struct transport *transport, struct mmsghdr *here,
                                const uint8_t *bytes, struct transport_message *message)
{
    struct rho_udpm_datagram datagram;
    bool is_cut = here->msg_hdr.msg_flags & MSG_TRUNC;
    size_t size = here->msg_len < DATAGRAM_BYTES ? here->msg_len : DATAGRAM_BYTES;

    message->received_us = read_reception_time_and_drops(transport, &here->msg_hdr);
    if (rho_udpm_parse(bytes, size, &datagram) != RHO_OK) {
        transport->counters.refused++;
        return false;
    }
    if (is_cut) {
        transport->counters.refused += strncmp(datagram.channel, "RHO_", 4) == 0;
        return false;
    }
    message->channel = datagram.channel;
    message->data = datagram.payload;
    message->size = datagram.payload_size;
    return !rho_udpm_is_self_test(&datagram);
}

/*
 * Delivers the next admitted message. Reads one batch of datagrams per call at most, so that a
 * flood of refused datagrams cannot block the program.
 */
static enum transport_found receive_message(struct transport *transport, void *object,
                                            struct transport_message *message)
{
    struct udpm *udpm = object;

    if (udpm->next == udpm->num_here) {
        follow_network(udpm);
        receive_batch_of_datagrams(udpm);
    }
    while (udpm->next < udpm->num_here) {
        int i = udpm->next++;

        if (is_source_admitted(transport, udpm, &udpm->sources[i]) &&
            parse_whole_message(transport, &udpm->here[i], udpm->bytes[i], message)) {
            message->sender = (struct transport_sender){ntohl(udpm->sources[i].sin_addr.s_addr),
                                                        ntohs(udpm->sources[i].sin_port),
                                                        is_own_datagram(udpm, &udpm->sources[i])};
            return TRANSPORT_MESSAGE;
        }
    }
    return TRANSPORT_NOTHING;
}

static bool send_message(void *object, const char *channel, const uint8_t *data, size_t size)
{
    struct udpm *udpm = object;
    uint8_t head[RHO_UDPM_MAX_HEAD];
    size_t head_bytes;
    struct iovec parts[2] = {{.iov_base = head}, {.iov_base = (void *)data}};
    struct msghdr header = {.msg_name = &udpm->group,
                            .msg_namelen = sizeof udpm->group,
                            .msg_iov = parts,
                            .msg_iovlen = 2};

    if (rho_udpm_begin(head, sizeof head, udpm->sequence, channel, &head_bytes) != RHO_OK) {
        errno = EINVAL;
        return false;
    }
    if (size + strlen(channel) > SHORT_MESSAGE_BYTES) {
        errno = EMSGSIZE;
        return false;
    }
    if (udpm->receiver < 0) {
        follow_network(udpm);
    }
    parts[0].iov_len = head_bytes;
    parts[1].iov_len = size;
    if (sendmsg(udpm->sender, &header, MSG_NOSIGNAL) < 0) {
        return false;
    }
    udpm->sequence++;
    return true;
}

static void close_sockets(void *object)
{
    struct udpm *udpm = object;
    const int descriptors[] = {udpm->receiver, udpm->sender, udpm->watch, udpm->ready,
                               udpm->member};

    for (size_t i = 0; i < sizeof descriptors / sizeof *descriptors; i++) {
        if (descriptors[i] >= 0) {
            close(descriptors[i]);
        }
    }
    free(udpm);
}

/* Makes one descriptor readable where a datagram or a change of the network has come. */
static void open_ready_descriptor(const struct transport *transport, struct udpm *udpm)
{
    struct epoll_event event = {.events = EPOLLIN};

    udpm->ready = epoll_create1(EPOLL_CLOEXEC);
    if (udpm->ready < 0 || epoll_ctl(udpm->ready, EPOLL_CTL_ADD, udpm->receiver, &event) ||
        (udpm->watch >= 0 && epoll_ctl(udpm->ready, EPOLL_CTL_ADD, udpm->watch, &event))) {
        fail(EXIT_RUNTIME, "%s: %s", transport->url, strerror(errno));
    }
}

void transport_open_udpm(struct transport *transport, enum transport_use use)
{
    static const struct transport_provider provider = {ready_descriptor, receive_message,
                                                       send_message, close_sockets};
    struct udpm *udpm = must_calloc(1, sizeof *udpm);

    udpm->transport = transport;
    udpm->receiver = udpm->ready = udpm->member = -1;
    udpm->group = (struct sockaddr_in){.sin_family = AF_INET, .sin_port = htons(RHO_UDPM_PORT)};
    inet_pton(AF_INET, RHO_UDPM_GROUP, &udpm->group.sin_addr);
    parse_udpm_url(transport, udpm);
    udpm->watch = network_watch_open(); /* before the first look, so that no change is missed */
    open_sender(transport, udpm);
    follow_route(udpm);
    if (!udpm->has_route) {
        fprintf(stderr,
                "rhotrack: %s: no route to this group; the loopback is used, which reaches only "
                "programs of this machine\n",
                transport->url);
    }
    if (use == TRANSPORT_SEND_AND_RECEIVE) {
        open_receiver(transport, udpm);
        join_group(udpm);
        open_ready_descriptor(transport, udpm);
    }
    write_place(udpm);
    transport->is_place_new = udpm->receiver >= 0; /* of senders only changes are of interest */
    transport->provider = &provider;
    transport->object = udpm;
    transport->can_send = true;
}
