/* SPDX-License-Identifier: MIT */
/*
 * node: a radar node for firmware: LCM datagrams in, LCM datagrams out. It knows no board.
 *
 *     node_start(&config);
 *     for (;;) {
 *         if (a datagram has come) {
 *             node_receive(datagram, size, source, now_us);
 *         }
 *         node_tick(now_us);                           wait for a datagram, or until node_due_us()
 *     }
 *
 * Every byte is static: one node a program. What the messages do wrong is counted (RHO_STATUS and
 * RHO_WORK, once a second, with RHO_LEARNED of each sensor in turn) and nothing of it stops the
 * node. It takes passive sensors, too, where RHO_SCAN_KINDS has them. What becomes of the messages
 * is the library's node (rhotrack/node.h).
 */
#ifndef NODE_H
#define NODE_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/initiator.h"
#include "rhotrack/scan_assembler.h"
#include "rhotrack/tracker.h"
#include "rhotrack/udpm.h"

struct node_config {
    struct rho_scan_assembler_config assembler;
    struct rho_tracker_config tracker;
    struct rho_initiator_config initiator;
    const struct rho_scan_assembler_sensor
        *sensors; /* num_sensors of them; only read by node_start */
    uint16_t num_sensors;
    /*
     * Where the network is not closed: addresses that datagrams may come from (IPv4, 10.9.0.1 as
     * 0x0a090001), num_sources of them, 0: any; only read by node_start. And the check of the
     * code behind each datagram: returns 0 where it is not the right one, else *size without it.
     * NULL: there is none. What is sent gets its code in send.
     */
    const uint32_t *sources;
    uint16_t num_sources;
    int (*is_authentic)(void *context, const uint8_t *datagram, size_t *size);
    /*
     * Counts starts, in memory that stays: receivers see by it that track numbers began anew.
     * Messages say 256 of it and how often the sensors' clock was set.
     */
    int32_t boot;
    /* Called from within the functions below, which must not be called by them. */
    void *context;
    void (*send)(void *context, const uint8_t *datagram, size_t size); /* to LCM's group and port */
    void (*stepped)(void *context,
                    const struct rho_report *report); /* before its messages; may be NULL */
    int64_t (*clock_us)(void *context);               /* for the step times in RHO_STATUS */
};

/* What node_settings.h says, else the defaults; without sensors and functions. */
void node_config_default(struct node_config *config);

/*
 * Once a program. The config is copied. Errors: those of the objects' init functions; the node then
 * takes nothing.
 */
RHO_MUST_CHECK enum rho_status node_start(const struct node_config *config);

/*
 * A datagram of any bytes and length that came from that IPv4 address at now_us of the reception
 * clock.
 */
void node_receive(const uint8_t *bytes, size_t size, uint32_t source_ipv4, int64_t now_us);

/* Senders refused so far; in RHO_STATUS among fragments_refused, with datagrams that are no LCM. */
const struct rho_udpm_guard *node_guard(void);

/* Steps what is due though nothing has come, and says once a second how the node is. */
void node_tick(int64_t now_us);

/* When node_tick is to be called though nothing has come. */
int64_t node_due_us(void);

/* The end of a record: all that is there is stepped. */
void node_flush(void);

#endif
