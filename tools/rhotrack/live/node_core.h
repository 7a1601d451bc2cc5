/* SPDX-License-Identifier: MIT */
/*
 * node_core: the library's node (rhotrack/node.h) with the objects that the program's parameters
 * describe: (channel, bytes, time) in, messages out.
 *
 *     node_core_take_message(core, channel, data, size, now_us);    for each message that comes
 *     node_core_tick(core, now_us);        when nothing has come, by node_core_due_us at the latest
 *     node_core_send_status(core, &losses);                         once a second
 *
 * Any bytes may be given: faults in them are counted, and none of them ends the program.
 */
#ifndef RHOTRACK_TOOL_NODE_CORE_H
#define RHOTRACK_TOOL_NODE_CORE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "io/scans/out_of_sequence_counts.h"
#include "pipeline/pipeline_show.h"
#include "pipeline/pipeline_snapshot.h"
#include "rhotrack/frames.h"
#include "rhotrack/message.h"
#include "rhotrack/node.h"
#include "rhotrack/reflectors.h"
#include "rhotrack/scan_assembler.h"
#include "rhotrack/tracker.h"
#include "rhotrack/zones.h"
#include "settings/parameters.h"

struct node_core;

/* Called from within the functions below, which must not be called by them. */
struct node_core_events {
    void *context;
    /* a message to publish */
    void (*send)(void *context, const char *channel, const uint8_t *data, size_t size);
    /* a step was made, before its messages; may be NULL */
    void (*stepped)(void *context, const struct rho_report *report);
    /* the sensor has begun again, with an earlier time or another epoch; may be NULL */
    void (*restarted)(void *context, int16_t sensor_id);
    /* the common clock was set anew, and tracks begin again; may be NULL */
    void (*began_anew)(void *context);
};

/*
 * The parameters are copied. Values that the library does not take: exit 2.
 *   epoch  boot number; goes up with every restart of the tracker
 */
struct node_core *node_core_open(const struct parameters *parameters, int32_t epoch,
                                 const struct node_core_events *events);

/* Each step is shown from now on; the core closes it at its end. NULL: nothing is. */
void node_core_set_show(struct node_core *core, struct pipeline_show *show);

/* Takes an operator's messages on RHO_COMMANDS and RHO_SETTINGS from now on. */
void node_core_allow_commands(struct node_core *core);

/* What has become of them so far. */
struct node_core_commands {
    uint64_t done, refused; /* both are answered */
    uint64_t bad;           /* messages that are none */
    uint64_t not_allowed;   /* this node takes none */
};
const struct node_core_commands *node_core_command_counts(const struct node_core *core);

/* Messages of --show that its rates have left out. */
uint64_t node_core_num_not_shown(const struct node_core *core);

/*
 * Goes on with the tracks and all that was learned of the file; before the first message. Where the
 * first scan is more than jump_max_s older than the snapshot, the sensors' clock is another one,
 * and tracks begin anew.
 */
enum pipeline_restored node_core_restore_snapshot(struct node_core *core, const char *path);

/* False: it failed, with errno. */
bool node_core_save_snapshot(struct node_core *core, const char *path);

/* A message that came at now_us of the reception clock; steps what is due then. */
void node_core_take_message(struct node_core *core, const char *channel, const uint8_t *data,
                            size_t size, int64_t now_us);

/* Steps what is due though nothing has come. */
void node_core_tick(struct node_core *core, int64_t now_us);

/* When that is on the reception clock; INT64_MAX: not before a message comes. */
int64_t node_core_due_us(const struct node_core *core);

/* The end: all that is there is stepped. */
void node_core_flush(struct node_core *core);

/* Messages that the node's inputs and outputs have lost so far. */
struct node_core_losses {
    uint64_t datagrams_refused;   /* by the transport */
    uint64_t reports_not_printed; /* standard output took no more */
    uint64_t events_not_logged;   /* the log took no more */
};

/* Publishes RHO_STATUS, RHO_WORK, RHO_SENSORS and of one sensor in turn RHO_LEARNED. */
void node_core_send_status(struct node_core *core, const struct node_core_losses *losses);

const struct rho_report *node_core_last_report(const struct node_core *core); /* of the last step */
/* Without the scans that were refused at first, and taken when their sensor's restart was clear. */
const struct rho_scan_assembler_counters *
node_core_assembler_counters(const struct node_core *core);
const struct rho_frames_counters *node_core_frame_counters(const struct node_core *core);
const struct rho_tracker_counters *node_core_tracker_counters(const struct node_core *core);
const struct rho_node_counters *node_core_node_counters(const struct node_core *core);

/* Scans that came out of sequence, and were used. */
const struct out_of_sequence_counts *node_core_sequence_counts(const struct node_core *core);

/*
 * The sensors that are heard, as RHO_SENSORS says it, with the time of the last call that told it.
 * Returns how many.
 */
unsigned node_core_list_sensors(const struct node_core *core,
                                struct rho_message_sensor sensors[RHO_MAX_SENSORS]);

/* One of its scans came twice, with different contents. */
bool node_core_has_two_senders(const struct node_core *core, int16_t sensor_id);

/* Scans after which a sensor is believed. */
int node_core_follow_scans(const struct node_core *core);

/* The wall that was learned at this place (reflectors.h); 0: none. */
int node_core_learned_wall(const struct node_core *core, unsigned place,
                           struct rho_reflector *wall);

/* Sends what is known of clutter that comes back, RHO_CLUTTER. */
void node_core_send_clutter(const struct node_core *core);

/* The tracker's map of clutter. */
struct rho_clutter_map *node_core_clutter_map(struct node_core *core);

/* Times since the start, how many of them were within each bound. */
#define NODE_CORE_BOUNDS 10
extern const int64_t node_core_bounds_us[NODE_CORE_BOUNDS];
struct node_core_times {
    int64_t sum_us, max_us;
    uint64_t count;
    uint64_t within[NODE_CORE_BOUNDS]; /* and not within the bound before */
};

/* Of the steps; and from the reception of a scan's last message to its tracks. */
const struct node_core_times *node_core_step_times(const struct node_core *core);
const struct node_core_times *node_core_latencies(const struct node_core *core);

/* Mean and longest step in us since the start. */
double node_core_mean_step_us(const struct node_core *core);
double node_core_max_step_us(const struct node_core *core);

/* The objects themselves, to be looked at. */
const struct rho_tracker *node_core_tracker_state(const struct node_core *core);
const struct rho_zones *node_core_zones(const struct node_core *core); /* NULL: there are none */

void node_core_close(struct node_core *core);

/* Learned values of sensors that are not as stated, and learned walls (learned_report.h). */
void node_core_print_learned(const struct node_core *core, FILE *to);

#endif
