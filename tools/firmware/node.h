/* SPDX-License-Identifier: MIT */
/*
 * node: a radar node for firmware: LCM datagrams in, LCM datagrams out. It knows no board.
 *
 *     node_start(&config);
 *     for (;;) {
 *         if (a datagram has come) {
 *             node_receive(datagram, size, now_us);
 *         }
 *         node_tick(now_us);                           wait for a datagram, or until node_due_us()
 *     }
 *
 * Every byte is static: one node a program. What the messages do wrong is counted (RHO_STATUS and RHO_WORK, once a second) and
 * nothing of it stops the node. Built with NODE_BEARINGS=1 it takes passive sensors, too (node_bearings.h).
 */
#ifndef NODE_H
#define NODE_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/feed.h"
#include "rhotrack/initiator.h"
#include "rhotrack/tracker.h"

#ifndef NODE_BEARINGS
#define NODE_BEARINGS 0
#endif

struct node_config {
    struct rho_feed_config feed;
    struct rho_tracker_config tracker;
    struct rho_initiator_config initiator;
    const struct rho_feed_sensor *sensors; /* num_sensors of them; only read by node_start */
    uint16_t num_sensors;
    /* Counts starts, in memory that stays: receivers see by it that track numbers began anew. Messages say 256 of it and
     * how often the sensors' clock was set. */
    int32_t boot;
    /* Called from within the functions below, which must not be called by them. */
    void *context;
    void (*send)(void *context, const uint8_t *datagram, size_t size); /* to LCM's group and port */
    void (*stepped)(void *context,
                    const struct rho_report *report); /* before its messages; may be NULL */
    int64_t (*clock_us)(void *context);               /* for the step times in RHO_STATUS */
};

/* All defaults, without sensors and functions. */
void node_config_default(struct node_config *config);

/* Once a program. The config is copied. Errors: those of the objects' init functions; the node then takes nothing. */
RHO_MUST_CHECK enum rho_status node_start(const struct node_config *config);

/* A datagram of any bytes and length that came at now_us of the reception clock. */
void node_receive(const uint8_t *bytes, size_t size, int64_t now_us);

/* Steps what is due though nothing has come, and says once a second how the node is. */
void node_tick(int64_t now_us);

/* When node_tick is to be called though nothing has come. */
int64_t node_due_us(void);

/* The end of a record: all that is there is stepped. */
void node_flush(void);

#endif
