/* SPDX-License-Identifier: MIT */
/*
 * node_core: the library's node (rhotrack/node.h) built from the program's parameters: received
 * messages (channel, bytes, time) in, messages to publish out.
 *
 *     node_core_take_message(core, channel, data, size, now_us);    for each received message
 *     node_core_tick(core, now_us);        without messages, by node_core_due_us at the latest
 *     node_core_send_status(core, &losses);                         once a second
 *
 * Messages may be any bytes: faulty ones are counted, and never end the program.
 */
#ifndef RHOTRACK_TOOL_NODE_CORE_H
#define RHOTRACK_TOOL_NODE_CORE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "io/scans/out_of_sequence_counts.h"
#include "pipeline/pipeline_show.h"
#include "pipeline/pipeline_snapshot.h"
#include "rhotrack/message.h"
#include "rhotrack/node.h"
#include "rhotrack/reflectors.h"
#include "rhotrack/scan_assembler.h"
#include "rhotrack/tracker.h"
#include "rhotrack/zones.h"
#include "settings/parameters.h"

struct node_core;

/* Callbacks of the core. They must not call functions of the core that change it. */
struct node_core_events {
    void *context;
    /* publishes a message */
    void (*send)(void *context, const char *channel, const uint8_t *data, size_t size);
    /* called after each step, before its messages are sent; may be NULL */
    void (*stepped)(void *context, const struct rho_report *report);
    /* called where a sensor restarted, with an earlier time or another epoch; may be NULL */
    void (*restarted)(void *context, int16_t sensor_id);
    /* called where the common clock changed and all tracks were dropped; may be NULL */
    void (*began_anew)(void *context);
};

/*
 * Creates a node with a copy of the parameters. Exit 2 where the library refuses a value.
 *   epoch  boot number of the node; incremented with every restart of the tracker
 */
struct node_core *node_core_open(const struct parameters *parameters, int32_t epoch,
                                 const struct node_core_events *events);

/* Sends the messages of --show after each step from now on; the core owns `show`. NULL: none. */
void node_core_set_show(struct node_core *core, struct pipeline_show *show);

/*
 * Accepts an operator's messages on RHO_COMMANDS and RHO_SETTINGS from now on; before a snapshot is
 * restored.
 */
void node_core_allow_commands(struct node_core *core);

/* Messages of --show that its rate limits left out. */
uint64_t node_core_num_show_left_out(const struct node_core *core);

/*
 * Restores tracks and learned values from a snapshot file; before the first message. If the first
 * scan is more than jump_max_s older than the snapshot, the sensors' clock has changed, and all
 * tracks are dropped. Areas, settings and frozen tracks of an operator are named on standard error;
 * a node that accepts no commands goes on without them.
 */
enum pipeline_restored node_core_restore_snapshot(struct node_core *core, const char *path);

/* Saves a snapshot; false with errno on failure. */
bool node_core_save_snapshot(struct node_core *core, const char *path);

/* Takes a message received at now_us of the reception clock, and makes the steps that are due. */
void node_core_take_message(struct node_core *core, const char *channel, const uint8_t *data,
                            size_t size, int64_t now_us);

/* Makes the steps that are due by time alone, without a message. */
void node_core_tick(struct node_core *core, int64_t now_us);

/* Reception time at which node_core_tick has a step to make; INT64_MAX: not before a message. */
int64_t node_core_due_us(const struct node_core *core);

/* Another node's lists have this epoch: the core's have the next one, if theirs was the same. */
void node_core_avoid_epoch(struct node_core *core, int32_t epoch);

/* Sends the lists of tracks of the last step, once more or for the first time; none before one. */
void node_core_send_tracks(const struct node_core *core);

/* Steps all scans that are held back, at the end of the input. */
void node_core_flush(struct node_core *core);

/* Losses of the node's inputs and outputs so far. */
struct node_core_losses {
    uint64_t datagrams_refused;   /* datagrams that the transport refused */
    uint64_t reports_not_printed; /* reports left out as standard output was full */
    uint64_t events_not_logged;   /* events left out as the log was full */
};

/*
 * Publishes RHO_STATUS, RHO_WORK, RHO_SENSORS, RHO_LEARNED of one sensor in turn, RHO_LIFE and
 * RHO_ZONES.
 */
void node_core_send_status(struct node_core *core, const struct node_core_losses *losses);

/* settings in force, as configured and then changed by an operator; and as configured */
const struct rho_settings *node_core_settings(const struct node_core *core);
const struct rho_settings *node_core_told_settings(const struct node_core *core);

/* report of the last step */
const struct rho_report *node_core_last_report(const struct node_core *core);
/*
 * Counters of the scan assembler, less scans refused at first that were taken after their sensor's
 * restart.
 */
const struct rho_scan_assembler_counters *
node_core_assembler_counters(const struct node_core *core);
const struct rho_tracker_counters *node_core_tracker_counters(const struct node_core *core);
const struct rho_node_counters *node_core_node_counters(const struct node_core *core);

/* Counts of scans that arrived out of sequence and were used. */
const struct out_of_sequence_counts *node_core_used_out_of_sequence(const struct node_core *core);

/*
 * Lists the sensors that are heard, as published in RHO_SENSORS, at the time of the last message or
 * tick. Returns their number.
 */
unsigned node_core_list_sensors(const struct node_core *core,
                                struct rho_message_sensor sensors[RHO_MAX_SENSORS]);

/* True where a scan of the sensor came twice with different contents. */
bool node_core_has_two_senders(const struct node_core *core, int16_t sensor_id);

/*
 * True where the sensor's clock has been off those of the others for follow_scans scans, which are
 * left aside; *ahead_s is then how far it is ahead of the common clock, as its scans are received.
 */
bool node_core_is_off_clock(const struct node_core *core, int16_t sensor_id, double *ahead_s);

/* Number of consistent scans after which a sensor is believed (follow_scans). */
int node_core_sensor_scans_min(const struct node_core *core);

/* Gets the learned wall (reflectors.h) with this index; returns 0 where there is none. */
int node_core_get_learned_wall(const struct node_core *core, unsigned place,
                               struct rho_reflector *wall);

/* Publishes the clutter map, RHO_CLUTTER. */
void node_core_send_clutter_map(const struct node_core *core);

/* The tracker's clutter map. */
struct rho_clutter_map *node_core_clutter_map(struct node_core *core);

/* Statistics of durations since the start: a histogram over node_core_bounds_us. */
#define NODE_CORE_BOUNDS 10
extern const int64_t node_core_bounds_us[NODE_CORE_BOUNDS];
struct node_core_times {
    int64_t sum_us, max_us;
    uint64_t count;
    uint64_t within[NODE_CORE_BOUNDS]; /* durations in bin i, above the bound before */
};

/* Durations of steps; latencies from the reception of a scan's last message to its tracks. */
const struct node_core_times *node_core_step_histogram(const struct node_core *core);
const struct node_core_times *node_core_latencies(const struct node_core *core);

/* Mean and longest duration of a step since the start, us. */
double node_core_mean_step_us(const struct node_core *core);
double node_core_max_step_us(const struct node_core *core);

/* The core's own objects, for reading. */
const struct rho_tracker *node_core_tracker_state(const struct node_core *core);
/* NULL: no zones are configured */
const struct rho_zones *node_core_zones(const struct node_core *core);

void node_core_close(struct node_core *core);

/* Prints learned values that differ from the stated ones, and learned walls (learned_report.h). */
void node_core_print_learned(const struct node_core *core, FILE *to);

#endif
