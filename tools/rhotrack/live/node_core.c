/* SPDX-License-Identifier: MIT */
#include "live/node_core.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "live/refused_messages.h"
#include "live/restored_commands.h"
#include "pipeline/learned_report.h"
#include "pipeline/pipeline.h"
#include "rhotrack/message.h"
#include "rhotrack/publish.h"
#include "rhotrack/udpm.h"

const int64_t node_core_bounds_us[NODE_CORE_BOUNDS] = {100,   300,    1000,   3000,    10000,
                                                       30000, 100000, 300000, 1000000, 3000000};

/* Position of each sensor's newest scan (number, time, epoch), by place in the assembler. */
struct newest_scan_positions {
    struct rho_scan_assembler_place of[RHO_MAX_SENSORS];
};

struct node_core {
    struct parameters *parameters; /* the node's own copy, which an operator's settings change */
    struct node_core_events events;
    struct pipeline pipeline;
    struct pipeline_show *show; /* messages of --show; NULL: none are sent */
    struct out_of_sequence_counts order;
    struct node_core_times step_times, latencies;
    struct refused_messages refused;
    /* taken: counts of refused scans that were taken later; shown: counters less `taken` */
    struct rho_scan_assembler_counters taken, shown;
};

/* ---- Start ---- */

struct node_core *node_core_open(const struct parameters *parameters, int32_t epoch,
                                 const struct node_core_events *events)
{
    struct node_core *core = must_calloc(1, sizeof *core);

    core->parameters = must_alloc(sizeof *core->parameters);
    *core->parameters = *parameters;
    core->events = *events;
    core->pipeline = pipeline_allocate();
    core->pipeline.is_live = true;
    core->pipeline.epoch = epoch;
    pipeline_open(&core->pipeline, parameters);
    pipeline_open_passive(&core->pipeline, parameters);
    return core;
}

void node_core_set_show(struct node_core *core, struct pipeline_show *show)
{
    core->show = show;
}

void node_core_allow_commands(struct node_core *core)
{
    core->pipeline.takes_commands = true;
    core->pipeline.node->options.takes_commands = 1;
}

uint64_t node_core_num_show_left_out(const struct node_core *core)
{
    return pipeline_show_num_not_sent(core->show);
}

enum pipeline_restored node_core_restore_snapshot(struct node_core *core, const char *path)
{
    struct parameters *told = must_alloc(sizeof *told);
    enum pipeline_restored restored;

    *told = *core->parameters;
    restored = pipeline_restore_snapshot(&core->pipeline, core->parameters, path);
    if (restored == PIPELINE_RESTORED &&
        restored_commands_print(core->pipeline.node, path, stderr) > 0 &&
        !core->pipeline.takes_commands) {
        *core->parameters = *told;
        pipeline_reconfigure(&core->pipeline, told);
        restored_commands_undo(&core->pipeline.node->tracker, told);
    }
    free(told);
    return restored;
}

bool node_core_save_snapshot(struct node_core *core, const char *path)
{
    return pipeline_save_snapshot(&core->pipeline, path);
}

/* ---- Steps ---- */

/* Sends all messages of what the node has done last. */
static void send_messages(const struct node_core *core)
{
    const struct rho_node *node = core->pipeline.node;
    uint8_t buffer[RHO_UDPM_MAX_DATAGRAM];
    size_t size;

    for (uint16_t part = 0; part < rho_node_num_messages(node); part++) {
        if (rho_node_publish(node, part, buffer, sizeof buffer, &size) == RHO_OK) {
            core->events.send(core->events.context, rho_node_channel(node, part), buffer, size);
        }
    }
}

void node_core_avoid_epoch(struct node_core *core, int32_t epoch)
{
    struct rho_node *node = core->pipeline.node;

    node->epoch += node->epoch == epoch ? (epoch == INT32_MAX ? -epoch : 1) : 0;
}

void node_core_send_tracks(const struct node_core *core)
{
    const struct rho_node *node = core->pipeline.node;
    uint8_t buffer[RHO_UDPM_MAX_DATAGRAM];
    size_t size;

    for (uint16_t part = 0; node->counters.steps > 0 && part < rho_publish_num_parts(&node->report);
         part++) {
        if (rho_publish_tracks(&node->report, node->step, node->epoch, part, buffer, sizeof buffer,
                               &size) == RHO_OK) {
            core->events.send(core->events.context, RHO_MESSAGE_TRACK_LIST_CHANNEL, buffer, size);
        }
    }
}

static void send_show_messages(struct node_core *core, enum rho_node_due done)
{
    const struct pipeline_show_output output = {core->events.context, core->events.send};
    const struct rho_node *node = core->pipeline.node;

    pipeline_show_step(core->show, &core->pipeline, done == RHO_NODE_BEARINGS, node->step,
                       node->epoch, node->now_us, &output);
}

/*
 * Takes settings that an operator has changed into the parameters, and applies what follows from
 * these beside the settings themselves. Where a sensor's own range in the parameters conflicts with
 * several settings of one step, the parameters stay, and the node goes back to them.
 */
static void adopt_changed_settings(struct node_core *core)
{
    const struct rho_settings settings = core->pipeline.node->settings;
    const bool is_adopted = parameters_adopt_settings(core->parameters, &settings);

    pipeline_reconfigure(&core->pipeline, core->parameters);
    if (is_adopted) {
        core->pipeline.node->settings = settings;
    } else {
        fputs("rhotrack: settings of an operator conflict with a sensor's range; they are taken "
              "back\n",
              stderr);
    }
}

/* ---- The loop ---- */

static void add_time_sample(struct node_core_times *times, int64_t took_us)
{
    unsigned bound = 0;

    while (bound < NODE_CORE_BOUNDS && took_us > node_core_bounds_us[bound]) {
        bound++;
    }
    if (bound < NODE_CORE_BOUNDS) {
        times->within[bound]++;
    }
    times->count++;
    times->sum_us += took_us;
    times->max_us = took_us > times->max_us ? took_us : times->max_us;
}

/* Time from the reception of the step's scan to now. */
static int64_t scan_waiting_time_us(const struct node_core *core, enum rho_node_due due)
{
    int64_t heard_us = INT64_MIN;

    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_scan_assembler_source *source = &core->pipeline.node->assembler.sources[i];
        const bool is_of_step =
            due == RHO_NODE_BEARINGS
                ? source->kind == RHO_SCAN_ASSEMBLER_BEARINGS &&
                      source->sensor_id == core->pipeline.node->item.bearings.sensor_id
                : source->kind != RHO_SCAN_ASSEMBLER_BEARINGS &&
                      source->sensor_id == core->pipeline.node->scan.sensor_id;

        if (source->is_used && is_of_step && source->heard_us > heard_us) {
            heard_us = source->heard_us;
        }
    }
    return heard_us == INT64_MIN || heard_us > core->pipeline.node->now_us
               ? 0
               : core->pipeline.node->now_us - heard_us;
}

static void end_step(struct node_core *core, enum rho_node_due done, int64_t took_us)
{
    rho_node_count_time(core->pipeline.node, took_us);
    add_time_sample(&core->step_times, took_us);
    add_time_sample(&core->latencies, took_us + scan_waiting_time_us(core, done));
    if (core->events.stepped) {
        core->events.stepped(core->events.context, &core->pipeline.node->report);
    }
}

static void step_all_due(struct node_core *core, int64_t now_us)
{
    enum rho_node_due done = RHO_NODE_ANSWER;

    while (done != RHO_NODE_NOTHING) {
        struct rho_node *node = core->pipeline.node;
        const uint32_t shared_before = node->windows.shared;
        const uint32_t changed_before = node->settings_changed;
        const int64_t start_us = monotonic_clock_us();

        pipeline_give_storage(&core->pipeline);
        done = rho_node_next(node, now_us);
        if (node->settings_changed != changed_before) {
            adopt_changed_settings(core);
        }
        if (done == RHO_NODE_SCAN || done == RHO_NODE_BEARINGS) {
            pipeline_warn_shared_windows(&core->pipeline, shared_before, node->scan.sensor_id);
            end_step(core, done, monotonic_clock_us() - start_us);
        }
        send_messages(core);
        if (done == RHO_NODE_RESTART && core->events.began_anew) {
            core->events.began_anew(core->events.context);
        } else if (done == RHO_NODE_SCAN || done == RHO_NODE_BEARINGS) {
            send_show_messages(core, done);
        }
    }
}

/*
 * Reports sensors whose scan time went back or whose epoch changed. A sensor that is followed after
 * a gap has not restarted.
 */
static void report_sensor_restarts(const struct node_core *core,
                                   const struct newest_scan_positions *before)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS && core->events.restarted; i++) {
        const struct rho_scan_assembler_source *source = &core->pipeline.node->assembler.sources[i];

        if (source->is_used && (source->place.time_us < before->of[i].time_us ||
                                source->place.epoch != before->of[i].epoch)) {
            core->events.restarted(core->events.context, source->sensor_id);
        }
    }
}

/*
 * Updates counts after the assembler took a message: keeps it if it was refused, and where it
 * completes a sensor's restart feeds the refused messages again.
 */
static void note_message_sender(struct node_core *core, const char *channel, const uint8_t *data,
                                size_t size, const struct rho_scan_assembler_counters *before,
                                const struct newest_scan_positions *places, int64_t now_us)
{
    const struct rho_scan_assembler_counters *after = &core->pipeline.node->assembler.counters;

    out_of_sequence_counts_note(&core->order, before, &core->pipeline.node->assembler);
    if (after->sensor_restarts == before->sensor_restarts) {
        refused_messages_keep(&core->refused, channel, data, size, before, after);
    } else {
        report_sensor_restarts(core, places);
        if (core->pipeline.node->assembler
                .is_restart) { /* no scan since the restart has been stepped yet */
            refused_messages_retry(&core->refused, channel, &core->pipeline.node->assembler, now_us,
                                   &core->taken);
        }
    }
    core->shown = refused_messages_correct(after, &core->taken);
}

void node_core_take_message(struct node_core *core, const char *channel, const uint8_t *data,
                            size_t size, int64_t now_us)
{
    struct rho_scan_assembler_counters before;
    struct rho_scan_assembler *assembler = &core->pipeline.node->assembler;
    struct newest_scan_positions places;
    bool has_room = false;

    while (!has_room) {
        before = assembler->counters;
        for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
            places.of[i] = assembler->sources[i].place;
        }
        has_room =
            rho_node_take(core->pipeline.node, channel, data, size, now_us) != RHO_ERROR_CAPACITY;
        if (has_room) {
            note_message_sender(core, channel, data, size, &before, &places, now_us);
        }
        step_all_due(core, now_us);
    }
}

void node_core_tick(struct node_core *core, int64_t now_us)
{
    step_all_due(core, now_us);
}

int64_t node_core_due_us(const struct node_core *core)
{
    return rho_node_due_us(core->pipeline.node);
}

void node_core_flush(struct node_core *core)
{
    step_all_due(core, INT64_MAX);
}

/* ---- State ---- */

static int32_t scaled_origin_coordinate(const struct parameters *parameters, enum parameter_id id,
                                        double scale)
{
    return parameters_has_value(parameters, id) ? (int32_t)lround(parameters->value[id] * scale)
                                                : 0;
}

static void send_sensor_states(const struct node_core *core)
{
    struct rho_message_sensor_list list;
    uint8_t buffer[RHO_MESSAGE_SENSOR_LIST_MAX_SIZE];
    size_t size;

    for (uint16_t part = 0; part < rho_publish_num_sensor_parts(&core->pipeline.node->assembler);
         part++) {
        if (rho_publish_sensors(&core->pipeline.node->assembler, &core->pipeline.node->tracker,
                                core->pipeline.node->now_us, part, &list) != RHO_OK) {
            return;
        }
        list.scan = core->pipeline.node->step;
        list.epoch = core->pipeline.node->epoch;
        if (rho_message_sensor_list_encode(&list, buffer, sizeof buffer, &size) == RHO_OK) {
            core->events.send(core->events.context, RHO_MESSAGE_SENSOR_LIST_CHANNEL, buffer, size);
        }
    }
}

static int64_t clamp_to_int64(uint64_t count)
{
    return count < INT64_MAX ? (int64_t)count : INT64_MAX;
}

static void send_work_message(const struct node_core *core, const struct node_core_losses *losses)
{
    struct rho_message_work work;
    uint8_t buffer[RHO_MESSAGE_WORK_MAX_SIZE];
    size_t size;

    rho_node_work(core->pipeline.node, &work);
    work.reports_not_printed = clamp_to_int64(losses->reports_not_printed);
    work.events_not_logged = clamp_to_int64(losses->events_not_logged);
    if (rho_message_work_encode(&work, buffer, sizeof buffer, &size) == RHO_OK) {
        core->events.send(core->events.context, RHO_MESSAGE_WORK_CHANNEL, buffer, size);
    }
}

/* Publishes the learned values of one sensor, in turn at each call. */
static void send_learned_of_next_sensor(struct node_core *core)
{
    struct rho_message_learned learned;
    uint8_t buffer[RHO_MESSAGE_LEARNED_MAX_SIZE];
    size_t size;

    if (rho_node_learned(core->pipeline.node, &learned) &&
        rho_message_learned_encode(&learned, buffer, sizeof buffer, &size) == RHO_OK) {
        core->events.send(core->events.context, RHO_MESSAGE_LEARNED_CHANNEL, buffer, size);
    }
}

static void send_lives_of_tracks(const struct node_core *core)
{
    uint8_t buffer[RHO_MESSAGE_LIFE_MAX_SIZE];
    size_t size;

    for (uint16_t part = 0;
         rho_node_life(core->pipeline.node, part, buffer, sizeof buffer, &size) == RHO_OK; part++) {
        core->events.send(core->events.context, RHO_MESSAGE_LIFE_CHANNEL, buffer, size);
    }
}

static void send_zone_counts(const struct node_core *core)
{
    struct rho_message_zone_list list;
    uint8_t buffer[RHO_MESSAGE_ZONE_LIST_MAX_SIZE];
    size_t size;

    if (!pipeline_zones(&core->pipeline)) {
        return;
    }
    rho_publish_zones(pipeline_zones(&core->pipeline), &list);
    list.scan = core->pipeline.node->step;
    list.epoch = core->pipeline.node->epoch;
    if (rho_message_zone_list_encode(&list, buffer, sizeof buffer, &size) == RHO_OK) {
        core->events.send(core->events.context, RHO_MESSAGE_ZONE_LIST_CHANNEL, buffer, size);
    }
}

void node_core_send_status(struct node_core *core, const struct node_core_losses *losses)
{
    const uint64_t refused = losses->datagrams_refused;
    struct rho_message_status status;
    uint8_t buffer[RHO_MESSAGE_STATUS_MAX_SIZE];
    size_t size;

    rho_node_status(core->pipeline.node, &status);
    status.fragments_refused = refused < INT32_MAX ? (int32_t)refused : INT32_MAX;
    status.origin_lat_1e7deg =
        scaled_origin_coordinate(core->parameters, PARAMETER_ORIGIN_LAT_DEG, 1e7);
    status.origin_lon_1e7deg =
        scaled_origin_coordinate(core->parameters, PARAMETER_ORIGIN_LON_DEG, 1e7);
    status.origin_alt_mm = scaled_origin_coordinate(core->parameters, PARAMETER_ORIGIN_ALT_M, 1e3);
    if (rho_message_status_encode(&status, buffer, sizeof buffer, &size) == RHO_OK) {
        core->events.send(core->events.context, RHO_MESSAGE_STATUS_CHANNEL, buffer, size);
    }
    send_work_message(core, losses);
    send_sensor_states(core);
    send_learned_of_next_sensor(core);
    send_lives_of_tracks(core);
    send_zone_counts(core);
}

void node_core_send_clutter_map(const struct node_core *core)
{
    struct rho_message_clutter_map list;
    uint8_t buffer[RHO_MESSAGE_CLUTTER_MAP_MAX_SIZE];
    size_t size;

    for (uint16_t part = 0; part < rho_publish_num_clutter_parts(&core->pipeline.node->tracker);
         part++) {
        if (rho_publish_clutter(&core->pipeline.node->tracker, part, &list) != RHO_OK) {
            return;
        }
        list.scan = core->pipeline.node->step;
        list.epoch = core->pipeline.node->epoch;
        if (rho_message_clutter_map_encode(&list, buffer, sizeof buffer, &size) == RHO_OK) {
            core->events.send(core->events.context, RHO_MESSAGE_CLUTTER_MAP_CHANNEL, buffer, size);
        }
    }
}

unsigned node_core_list_sensors(const struct node_core *core,
                                struct rho_message_sensor sensors[RHO_MAX_SENSORS])
{
    unsigned count = 0;

    for (unsigned place = 0; place < RHO_MAX_SENSORS; place++) {
        count += rho_publish_sensor(&core->pipeline.node->assembler, &core->pipeline.node->tracker,
                                    core->pipeline.node->now_us, place, &sensors[count]) != 0;
    }
    return count;
}

bool node_core_has_two_senders(const struct node_core *core, int16_t sensor_id)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_scan_assembler_source *source = &core->pipeline.node->assembler.sources[i];

        if (source->is_used && source->sensor_id == sensor_id && source->has_two_senders) {
            return true;
        }
    }
    return false;
}

/* Time of a sensor's newest scan after the time at which the node received it. */
static double clock_s(const struct rho_scan_assembler_source *source)
{
    return (double)(source->place.time_us - source->heard_us) / 1e6;
}

bool node_core_is_off_clock(const struct node_core *core, int16_t sensor_id, double *ahead_s)
{
    const struct rho_scan_assembler *assembler = &core->pipeline.node->assembler;
    const struct rho_scan_assembler_source *off = NULL, *common = NULL;

    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_scan_assembler_source *source = &assembler->sources[i];

        if (source->is_used && source->sensor_id == sensor_id &&
            source->off_clock >= assembler->config.follow_scans) {
            off = source;
        } else if (source->is_used && source->off_clock == 0 &&
                   (!common || source->heard_us > common->heard_us)) {
            common = source;
        }
    }
    *ahead_s = off && common ? clock_s(off) - clock_s(common) : 0.0;
    return off != NULL;
}

int node_core_sensor_scans_min(const struct node_core *core)
{
    return (int)core->pipeline.node->assembler.config.follow_scans;
}

const struct rho_settings *node_core_settings(const struct node_core *core)
{
    return &core->pipeline.node->settings;
}

const struct rho_settings *node_core_told_settings(const struct node_core *core)
{
    return &core->pipeline.node->told;
}

const struct rho_report *node_core_last_report(const struct node_core *core)
{
    return &core->pipeline.node->report;
}

int node_core_get_learned_wall(const struct node_core *core, unsigned place,
                               struct rho_reflector *wall)
{
    return rho_reflector_learning_wall(pipeline_learning(&core->pipeline), place, wall);
}

struct rho_clutter_map *node_core_clutter_map(struct node_core *core)
{
    return &core->pipeline.node->tracker.clutter_map;
}

const struct rho_scan_assembler_counters *node_core_assembler_counters(const struct node_core *core)
{
    return &core->shown;
}

const struct rho_tracker_counters *node_core_tracker_counters(const struct node_core *core)
{
    return &core->pipeline.node->tracker.counters;
}

const struct rho_node_counters *node_core_node_counters(const struct node_core *core)
{
    return &core->pipeline.node->counters;
}

const struct out_of_sequence_counts *node_core_used_out_of_sequence(const struct node_core *core)
{
    return &core->order;
}

const struct node_core_times *node_core_step_histogram(const struct node_core *core)
{
    return &core->step_times;
}

const struct node_core_times *node_core_latencies(const struct node_core *core)
{
    return &core->latencies;
}

double node_core_mean_step_us(const struct node_core *core)
{
    const struct node_core_times *times = &core->step_times;

    return times->count ? (double)times->sum_us / (double)times->count : 0;
}

double node_core_max_step_us(const struct node_core *core)
{
    return (double)core->step_times.max_us;
}

const struct rho_tracker *node_core_tracker_state(const struct node_core *core)
{
    return &core->pipeline.node->tracker;
}

const struct rho_zones *node_core_zones(const struct node_core *core)
{
    return pipeline_zones(&core->pipeline);
}

void node_core_close(struct node_core *core)
{
    pipeline_show_close(core->show);
    pipeline_free(&core->pipeline);
    free(core->parameters);
    free(core);
}

void node_core_print_learned(const struct node_core *core, FILE *to)
{
    learned_report_print(&core->pipeline.node->tracker, pipeline_learning(&core->pipeline), to);
}
