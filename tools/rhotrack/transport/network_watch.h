/* SPDX-License-Identifier: MIT */
/*
 * network_watch: the route from this machine to an address, and when interfaces, addresses or
 * routes change (rtnetlink). The kernel forgets memberships of multicast groups without a word to
 * the socket where an interface goes, or loses its last address.
 */
#ifndef RHOTRACK_TOOL_NETWORK_WATCH_H
#define RHOTRACK_TOOL_NETWORK_WATCH_H

#include <net/if.h>
#include <netinet/in.h>

struct network_route {
    unsigned interface;     /* index; 0: unknown */
    char name[IF_NAMESIZE]; /* of the interface; "" where it went meanwhile */
    struct in_addr address; /* of packets that are sent there; 0: the interface has none */
};

enum network_change {
    NETWORK_SAME,
    NETWORK_ROUTES,   /* a change that may concern routes */
    NETWORK_INTERFACE /* a change of that interface, or changes were too many to be told */
};

/* Descriptor that is readable after a change; -1 with errno where the system allows none. */
int network_watch_open(void);

/* Reads all changes since the last call, and returns the greatest, seen from an interface. */
enum network_change network_watch_read(int watch, unsigned interface);

/*
 * Finds the route to an address. Returns 0, or the error: ENETUNREACH without a route. The
 * interface stays unknown where the system allows no rtnetlink.
 */
int network_route_find(struct in_addr to, struct network_route *route);

#endif
