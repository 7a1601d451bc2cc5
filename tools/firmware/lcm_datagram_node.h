/* SPDX-License-Identifier: MIT */
/*
 * lcm_datagram_node: a radar node for firmware, independent of the board: LCM datagrams in and out.
 *
 *     node_start(&config);
 *     for (;;) {
 *         if (a datagram has arrived) {
 *             node_receive(datagram, size, source, now_us);
 *         }
 *         node_tick(now_us);                           wait for a datagram, or until node_due_us()
 *     }
 *
 * All memory is static: one node a program. Faulty messages never stop the node; they are counted
 * in the messages RHO_STATUS and RHO_WORK, which are sent once a second, with RHO_LEARNED of each
 * sensor in turn, and RHO_LIFE. Passive sensors are handled, too, where RHO_SCAN_KINDS includes
 * them. Messages are processed by the library's node (rhotrack/node.h).
 */
#ifndef LCM_DATAGRAM_NODE_H
#define LCM_DATAGRAM_NODE_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/node.h"
#include "rhotrack/udpm.h"

/* Callbacks, called from within the functions below, which they must not call. */
struct node_hooks {
    void *context;
    /* sends a datagram to LCM's group and port */
    void (*send)(void *context, const uint8_t *datagram, size_t size);
    /* called after each step, before its messages are sent; may be NULL */
    void (*stepped)(void *context, const struct rho_report *report);
    int64_t (*clock_us)(void *context); /* clock for the step times in RHO_STATUS */
    /*
     * checks the authentication code at the end of a datagram: returns 0 where it is wrong, else
     * sets *size to the size without it; NULL: there are no codes. Codes of sent datagrams are
     * added in send
     */
    int (*is_authentic)(void *context, const uint8_t *datagram, size_t *size);
};

struct node_config {
    struct rho_settings settings;
    struct rho_node_config node; /* of the parts; its epoch is not used */
    /* num_sensors known sensors; only read by node_start */
    const struct rho_scan_assembler_sensor *sensors;
    uint16_t num_sensors;
    /*
     * Protection on an open network, with hooks.is_authentic: num_sources IPv4 addresses (10.9.0.1
     * as 0x0a090001) that datagrams are accepted from, 0: any; only read by node_start.
     */
    uint16_t num_sources;
    const uint32_t *sources;
    /*
     * Count of starts in non-volatile memory, by which receivers see that track numbers began anew:
     * the epoch in messages is 256 boot plus the number of jumps of the sensors' clock.
     */
    int32_t boot;
    struct node_hooks hooks;
};

/*
 * The settings of node_settings_defaults.h, which default to the library's; no sensors and no
 * callbacks.
 */
void node_config_default(struct node_config *config);

/*
 * Starts the node; call it once a program. The config is copied. Errors are those of the objects'
 * init functions; the node then ignores all datagrams.
 */
RHO_MUST_CHECK enum rho_status node_start(const struct node_config *config);

/*
 * Processes a datagram of any content and length that came from source_ipv4 at now_us of the
 * reception clock.
 */
void node_receive(const uint8_t *bytes, size_t size, uint32_t source_ipv4, int64_t now_us);

/*
 * The sender filter with its counts of refused datagrams; RHO_STATUS has these in
 * fragments_refused, together with datagrams that are not LCM.
 */
const struct rho_udpm_guard *node_sender_filter(void);

/* Steps scans that have become due without a new datagram, and sends the status once a second. */
void node_tick(int64_t now_us);

/* Time at which node_tick must be called even if no datagram arrives. */
int64_t node_due_us(void);

/* End of a recording: steps all scans that are still held, and sends the status. */
void node_step_waiting_scans(void);

#endif
