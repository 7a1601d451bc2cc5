/* SPDX-License-Identifier: MIT */
/*
 * node_core: the live tracker without its network: (channel, bytes, time) in, messages out.
 *
 *     node_core_take(core, channel, data, size, now_us);    for each message that comes
 *     node_core_tick(core, now_us);                         when nothing has come, at node_core_due_us at the latest
 *     node_core_status(core, &losses);                      once a second
 *
 * Any bytes may be given: what they do wrong is counted, and nothing of it ends the program. Scans go out of the feed
 * in the order of time; bearings become frames on the way, and scans of plots wait for the frame that began before
 * them, so that the tracker sees what `track` shows it of the same messages.
 */
#ifndef RHOTRACK_TOOL_NODE_CORE_H
#define RHOTRACK_TOOL_NODE_CORE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "chain_snapshot.h"
#include "feed_order.h"
#include "parameters.h"
#include "rhotrack/feed.h"
#include "rhotrack/frames.h"
#include "rhotrack/message.h"
#include "rhotrack/tracker.h"

struct node_core;

/* Called from within the functions below, which must not be called by them. */
struct node_core_events {
    void *context;
    /* a message to publish */
    void (*send)(void *context, const char *channel, const uint8_t *data, size_t size);
    /* a step was made, before its messages; may be NULL */
    void (*stepped)(void *context, const struct rho_report *report);
};

/* Beside those of the feed, the frames and the tracker. */
struct node_core_counters {
    uint64_t steps, restarts;
    uint64_t scans_early;       /* did not wait for hold_ms: all RHO_MAX_OPEN_SCANS did */
    struct feed_order order;    /* of scans that came out of order */
    uint64_t sensors_forgotten; /* descriptions of sensors that are not heard any more */
    /* by the library, for what their values are together: scans, frames, bearings of a sensor that is too far from
     * the others or one too many, descriptions of sensors */
    uint64_t scans_refused, frames_refused, bearings_refused, sensors_refused;
};

/*
 * The parameters' address is kept. Values that the library does not take: exit 2.
 *   epoch  boot number; goes up with every restart of the tracker
 */
struct node_core *node_core_open(const struct parameters *parameters, int32_t epoch,
                                 const struct node_core_events *events);

/*
 * Goes on with the tracks and all that was learned of the file; before the first message. Where the first scan is more than
 * jump_max_s older than the snapshot, the sensors' clock is another one, and tracks begin anew.
 */
enum chain_restored node_core_restore(struct node_core *core, const char *path);

/* False: it failed, with errno. */
bool node_core_save(const struct node_core *core, const char *path);

/* A message that came at now_us of the reception clock; steps what is due then. */
void node_core_take(struct node_core *core, const char *channel, const uint8_t *data, size_t size,
                    int64_t now_us);

/* Steps what is due though nothing has come. */
void node_core_tick(struct node_core *core, int64_t now_us);

/* When that is on the reception clock; INT64_MAX: not before a message comes. */
int64_t node_core_due_us(const struct node_core *core);

/* The end: all that is there is stepped. */
void node_core_flush(struct node_core *core);

/* What its surroundings lost so far. */
struct node_core_losses {
    uint64_t datagrams_refused;   /* by the transport */
    uint64_t reports_not_printed; /* standard output took no more */
    uint64_t events_not_logged;   /* the log took no more */
};

/* Publishes RHO_STATUS, RHO_WORK and RHO_SENSORS. */
void node_core_status(struct node_core *core, const struct node_core_losses *losses);

const struct rho_report *node_core_report(const struct node_core *core); /* of the last step */
const struct rho_feed_counters *node_core_feed(const struct node_core *core);
const struct rho_frames_counters *node_core_frames(const struct node_core *core);
const struct rho_tracker_counters *node_core_tracker(const struct node_core *core);
const struct node_core_counters *node_core_counters(const struct node_core *core);

/* The sensors that are heard, as RHO_SENSORS says it, with the time of the last call that told it. Returns how many. */
unsigned node_core_sensors(const struct node_core *core,
                           struct rho_message_sensor sensors[RHO_MAX_SENSORS]);

/* One of its scans came twice, with different contents. */
bool node_core_has_twin(const struct node_core *core, int16_t sensor_id);

/* Scans after which a sensor is believed. */
int node_core_follow_scans(const struct node_core *core);

/* Sends what is known of clutter that comes back, RHO_CLUTTER. */
void node_core_send_clutter(const struct node_core *core);

/* The tracker's map of clutter. */
struct rho_clutter_map *node_core_clutter(struct node_core *core);

/* Mean and longest step in us since the start. */
double node_core_mean_us(const struct node_core *core);
double node_core_max_us(const struct node_core *core);

void node_core_close(struct node_core *core);

/* What was learned of sensors that are not as stated (learned.h). */
void node_core_print_learned(const struct node_core *core, FILE *to);

#endif
