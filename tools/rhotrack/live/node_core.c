/* SPDX-License-Identifier: MIT */
#include "live/node_core.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "io/output/clutter_map_file.h"
#include "live/refused_messages.h"
#include "pipeline/learned_report.h"
#include "pipeline/pipeline.h"
#include "rhotrack/command.h"
#include "rhotrack/message.h"
#include "rhotrack/operator.h"
#include "rhotrack/publish.h"
#include "rhotrack/udpm.h"

/*
 * Capacity of the queue of plot scans that wait for an open frame of bearings; one more closes the
 * frame.
 */
#define WAITING_MAX 4

/* Capacity of the queue of operators' commands, which are run after a step. */
#define COMMANDS_MAX 16
/* longest wait of a command for a step: longer than a turn of any radar */
#define COMMAND_WAIT_US 60000000
#define COMMAND_IS_LATE RHO_ERROR_STATE

const int64_t node_core_bounds_us[NODE_CORE_BOUNDS] = {100,   300,    1000,   3000,    10000,
                                                       30000, 100000, 300000, 1000000, 3000000};

/* Position of each sensor's newest scan (number, time, epoch), by place in the assembler. */
struct newest_scan_positions {
    struct rho_scan_assembler_place of[RHO_MAX_SENSORS];
};

/* An operator's command or setting that waits for the end of a step. */
struct waiting_command {
    int64_t came_us; /* reception time of the command */
    bool is_setting;
    struct rho_message_command command;
    struct rho_message_setting setting;
};

struct node_core {
    struct parameters *parameters; /* the node's own copy, which an operator's settings change */
    struct node_core_events events;
    struct pipeline pipeline;
    struct pipeline_show *show; /* messages of --show; NULL: none are sent */
    struct rho_node node;
    struct out_of_sequence_counts order;
    struct node_core_times step_times, latencies;
    struct rho_scan_assembler assembler;
    struct refused_messages refused;
    /* taken: counts of refused scans that were taken later; shown: counters less `taken` */
    struct rho_scan_assembler_counters taken, shown;
    struct rho_frames frames;
    struct rho_node_waiting waiting[WAITING_MAX];
    bool takes_commands;
    unsigned num_commands;
    struct waiting_command commands[COMMANDS_MAX];
    struct node_core_commands counters;
};

/* ---- Start ---- */

static void open_pipeline(struct node_core *core)
{
    pipeline_open(&core->pipeline, core->parameters);
    pipeline_open_passive(&core->pipeline, core->parameters);
}

static void open_bearing_frames(struct node_core *core)
{
    const double *value = core->parameters->value;
    struct rho_frames_config config;

    rho_frames_config_default(&config);
    config.tolerance_us = llround(value[PARAMETER_FRAME_TOLERANCE_S] * 1e6);
    config.jump_max_us = llround(value[PARAMETER_JUMP_MAX_S] * 1e6);
    config.follow_scans = (uint16_t)value[PARAMETER_FOLLOW_SCANS];
    if (rho_frames_init(&core->frames, sizeof core->frames, &config) != RHO_OK) {
        fail(EXIT_USAGE, "node: frame_tolerance_s has to be 10 s at most, and below jump_max_s");
    }
}

static void init_library_node(struct node_core *core, int32_t epoch)
{
    const struct rho_node_config config = {
        .assembler = &core->assembler,
        .tracker = core->pipeline.tracker,
        .report = core->pipeline.report,
        .frames = &core->frames,
        .passive = core->pipeline.paper ? NULL : core->pipeline.passive,
        .apart_max_m = core->pipeline.paper ? core->pipeline.paper->batch.apart_max_m : 0.0f,
        .waiting = core->waiting,
        .waiting_max = WAITING_MAX,
        .passive_range_max_m = (float)core->parameters->value[PARAMETER_RANGE_MAX_M],
        .epoch = epoch};

    must_succeed(rho_node_init(&core->node, sizeof core->node, &config), "node");
}

struct node_core *node_core_open(const struct parameters *parameters, int32_t epoch,
                                 const struct node_core_events *events)
{
    struct node_core *core = must_calloc(1, sizeof *core);

    core->parameters = must_alloc(sizeof *core->parameters);
    *core->parameters = *parameters;
    core->events = *events;
    core->pipeline = pipeline_allocate();
    core->pipeline.is_live = true;
    memset(core->pipeline.report, 0, sizeof *core->pipeline.report);
    open_pipeline(core);
    open_bearing_frames(core);
    parameters_to_assembler(parameters, &core->assembler);
    init_library_node(core, epoch);
    return core;
}

void node_core_set_show(struct node_core *core, struct pipeline_show *show)
{
    core->show = show;
}

void node_core_allow_commands(struct node_core *core)
{
    core->takes_commands = true;
}

uint64_t node_core_num_show_left_out(const struct node_core *core)
{
    return pipeline_show_num_not_sent(core->show);
}

enum pipeline_restored node_core_restore_snapshot(struct node_core *core, const char *path)
{
    enum pipeline_restored restored =
        pipeline_restore_snapshot(&core->pipeline, core->parameters, path);

    parameters_update_assembler(core->parameters, &core->assembler);
    init_library_node(core, core->node.epoch); /* the restored pipeline has new objects */
    core->node.is_restored = restored == PIPELINE_RESTORED;
    return restored;
}

bool node_core_save_snapshot(struct node_core *core, const char *path)
{
    return pipeline_save_snapshot(&core->pipeline, path);
}

/* Excludes the areas again that an operator had excluded before the tracker was reset. */
static void restore_excluded_areas(struct rho_tracker *tracker, const struct rho_extent *areas,
                                   unsigned num_areas)
{
    for (unsigned i = 0; i < num_areas; i++) {
        must_succeed(rho_tracker_exclude_area(tracker, &areas[i]), "excluded area");
    }
}

/*
 * Resets the tracker after a change of the common clock. Counters, the clutter map and excluded
 * areas are kept.
 */
static void reset_tracking(struct node_core *core)
{
    const unsigned num_excluded = core->pipeline.tracker->num_excluded;
    struct rho_extent excluded[RHO_MAX_EXCLUDED_AREAS];
    const struct rho_tracker_counters counters = core->pipeline.tracker->counters;
    const struct rho_tracker_work work = core->pipeline.tracker->work;
    struct rho_clutter_map *clutter = must_alloc(sizeof *clutter);

    *clutter = core->pipeline.tracker->clutter_map;
    memcpy(excluded, core->pipeline.tracker->excluded, sizeof excluded);
    pipeline_open(&core->pipeline, core->parameters);
    pipeline_reopen_passive_paper(&core->pipeline);
    clutter_map_file_copy(&core->pipeline.tracker->clutter_map, clutter);
    free(clutter);
    restore_excluded_areas(core->pipeline.tracker, excluded, num_excluded);
    core->pipeline.tracker->counters = counters;
    core->pipeline.tracker->work = work;
    core->node.epoch = core->node.epoch == INT32_MAX ? 0 : core->node.epoch + 1;
}

/* ---- Steps ---- */

/* Publishes events of tracks that entered or left zones in this step, if any. */
static void send_zone_events(const struct node_core *core)
{
    struct rho_message_zone_event_list list;
    uint8_t buffer[RHO_MESSAGE_ZONE_EVENT_LIST_MAX_SIZE];
    size_t size;

    if (!core->pipeline.zones || core->pipeline.zones->num_events == 0) {
        return;
    }
    rho_publish_zone_events(core->pipeline.zones, &list);
    list.scan = core->node.step;
    list.epoch = core->node.epoch;
    if (rho_message_zone_event_list_encode(&list, buffer, sizeof buffer, &size) == RHO_OK) {
        core->events.send(core->events.context, RHO_MESSAGE_ZONE_EVENT_LIST_CHANNEL, buffer, size);
    }
}

static void send_step_messages(const struct node_core *core)
{
    uint8_t buffer[RHO_UDPM_MAX_DATAGRAM];
    size_t size;

    for (uint16_t part = 0; part < rho_node_num_messages(&core->node); part++) {
        if (rho_node_publish(&core->node, core->pipeline.initiator, part, buffer, sizeof buffer,
                             &size) == RHO_OK) {
            core->events.send(core->events.context, rho_node_channel(&core->node, part), buffer,
                              size);
        }
    }
}

static void send_show_messages(struct node_core *core, enum rho_node_due due)
{
    const struct pipeline_show_output output = {core->events.context, core->events.send};

    pipeline_show_step(core->show, &core->pipeline, due == RHO_NODE_FRAME, core->node.step,
                       core->node.epoch, core->node.now_us, &output);
}

static void start_paper_tracks(struct node_core *core, enum rho_node_due due)
{
    struct rho_frame_view view;

    if (due == RHO_NODE_SCAN) {
        pipeline_start_paper_tracks(&core->pipeline, &core->node.scan, NULL);
    } else if (rho_frames_closed(&core->frames, &view)) {
        pipeline_start_paper_tracks(&core->pipeline, NULL, &view.frame);
    }
}

/* ---- Commands ---- */

static void count_command_answer(struct node_core *core, int8_t status)
{
    *(status == RHO_OK ? &core->counters.done : &core->counters.refused) += 1;
}

static void send_command_answer(struct node_core *core, struct rho_message_command_answer *answer)
{
    uint8_t buffer[RHO_MESSAGE_COMMAND_ANSWER_MAX_SIZE];
    size_t size;

    count_command_answer(core, answer->status);
    answer->scan = core->node.step;
    answer->epoch = core->node.epoch;
    if (rho_message_command_answer_encode(answer, buffer, sizeof buffer, &size) == RHO_OK) {
        core->events.send(core->events.context, RHO_MESSAGE_COMMAND_ANSWER_CHANNEL, buffer, size);
    }
}

static void send_setting_answer(struct node_core *core, struct rho_message_setting_answer *answer)
{
    uint8_t buffer[RHO_MESSAGE_SETTING_ANSWER_MAX_SIZE];
    size_t size;

    count_command_answer(core, answer->status);
    answer->utime = core->pipeline.report->time_us;
    answer->scan = core->node.step;
    answer->epoch = core->node.epoch;
    if (rho_message_setting_answer_encode(answer, buffer, sizeof buffer, &size) == RHO_OK) {
        core->events.send(core->events.context, RHO_MESSAGE_SETTING_ANSWER_CHANNEL, buffer, size);
    }
}

/*
 * Changes one setting as if the node had been started with it, reconfigures the running objects,
 * and answers the operator.
 */
static void apply_setting_and_answer(struct node_core *core,
                                     const struct rho_message_setting *setting)
{
    struct rho_settings settings = parameters_to_settings(core->parameters);
    struct rho_message_setting_answer answer;

    if (rho_command_set(setting, &settings, &answer) == RHO_OK) {
        if (parameters_adopt_settings(core->parameters, &settings)) {
            pipeline_reconfigure(&core->pipeline, core->parameters);
            parameters_update_assembler(core->parameters, &core->assembler);
        } else {
            /* the range limits of a single sensor conflict with the setting */
            answer.status = RHO_ERROR_CONFIG;
        }
    }
    send_setting_answer(core, &answer);
}

/* Runs the queued commands after a step, and updates the step's report by their changes. */
static void run_queued_commands(struct node_core *core)
{
    struct rho_message_command_answer answer;

    for (unsigned i = 0; i < core->num_commands; i++) {
        if (core->commands[i].is_setting) {
            apply_setting_and_answer(core, &core->commands[i].setting);
        } else {
            (void)!rho_command_run(&core->commands[i].command, core->pipeline.tracker,
                                   /* the status is sent in the answer */
                                   core->pipeline.report, &answer);
            send_command_answer(core, &answer);
        }
    }
    core->num_commands = 0;
}

static void refuse_command(struct node_core *core, const struct waiting_command *waiting,
                           enum rho_status status)
{
    if (waiting->is_setting) {
        send_setting_answer(core,
                            &(struct rho_message_setting_answer){.number = waiting->setting.number,
                                                                 .field = waiting->setting.field,
                                                                 .status = (int8_t)status});
        return;
    }
    send_command_answer(
        core, &(struct rho_message_command_answer){.utime = core->pipeline.report->time_us,
                                                   .number = waiting->command.number,
                                                   .action = waiting->command.action,
                                                   .status = (int8_t)status});
}

/* Refuses queued commands received before that time, as what the operator saw has changed. */
static void refuse_queued_commands(struct node_core *core, int64_t before_us)
{
    unsigned kept = 0;

    for (unsigned i = 0; i < core->num_commands; i++) {
        if (core->commands[i].came_us < before_us) {
            refuse_command(core, &core->commands[i], COMMAND_IS_LATE);
        } else {
            core->commands[kept++] = core->commands[i];
        }
    }
    core->num_commands = kept;
}

static bool decode_command(struct waiting_command *waiting, const uint8_t *data, size_t size)
{
    return waiting->is_setting
               ? rho_message_setting_decode(data, size, &waiting->setting) == RHO_OK &&
                     rho_message_setting_validate(&waiting->setting, NULL) == RHO_OK
               : rho_message_command_decode(data, size, &waiting->command) == RHO_OK &&
                     rho_message_command_validate(&waiting->command, NULL) == RHO_OK;
}

/* Queues or counts an operator's command or setting; false where the channel is another one. */
static bool queue_if_command_message(struct node_core *core, const char *channel,
                                     const uint8_t *data, size_t size, int64_t now_us)
{
    struct waiting_command waiting = {
        .came_us = now_us, .is_setting = strcmp(channel, RHO_MESSAGE_SETTING_CHANNEL) == 0};

    if (!waiting.is_setting && strcmp(channel, RHO_MESSAGE_COMMAND_CHANNEL) != 0) {
        return false;
    }
    if (!core->takes_commands) {
        core->counters.not_allowed++;
    } else if (!decode_command(&waiting, data, size)) {
        core->counters.bad++;
    } else if (core->num_commands < COMMANDS_MAX) {
        core->commands[core->num_commands++] = waiting;
    } else {
        refuse_command(core, &waiting, RHO_ERROR_CAPACITY);
    }
    return true;
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

/* Time from the reception of the step's scan to now; of a frame, from its last bearing scan. */
static int64_t scan_waiting_time_us(const struct node_core *core, enum rho_node_due due)
{
    int64_t heard_us = INT64_MIN;

    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_scan_assembler_source *source = &core->assembler.sources[i];
        const bool is_of_step = due == RHO_NODE_FRAME
                                    ? source->kind == RHO_SCAN_ASSEMBLER_BEARINGS
                                    : source->kind != RHO_SCAN_ASSEMBLER_BEARINGS &&
                                          source->sensor_id == core->node.scan.sensor_id;

        if (source->is_used && is_of_step && source->heard_us > heard_us) {
            heard_us = source->heard_us;
        }
    }
    return heard_us == INT64_MIN || heard_us > core->node.now_us ? 0 : core->node.now_us - heard_us;
}

static void step_due_input(struct node_core *core, enum rho_node_due due)
{
    const int64_t start_us = monotonic_clock_us();
    struct rho_initiator *initiator =
        due == RHO_NODE_SCAN && !core->pipeline.starts
            ? pipeline_initiator_of_sensor(&core->pipeline, &core->node.scan)
            : NULL;
    int64_t took_us;

    if (rho_node_step(&core->node, initiator) != RHO_OK) {
        return;
    }
    start_paper_tracks(core, due);
    if (due == RHO_NODE_SCAN) {
        pipeline_learn_walls(&core->pipeline, &core->node.scan);
    }
    run_queued_commands(core);
    pipeline_count_tracks_in_zones(&core->pipeline);
    took_us = monotonic_clock_us() - start_us;
    rho_node_count_time(&core->node, took_us);
    add_time_sample(&core->step_times, took_us);
    add_time_sample(&core->latencies, took_us + scan_waiting_time_us(core, due));
    if (core->events.stepped) {
        core->events.stepped(core->events.context, core->pipeline.report);
    }
    send_step_messages(core);
    send_zone_events(core);
    send_show_messages(core, due);
}

static void step_all_due(struct node_core *core, int64_t now_us)
{
    enum rho_node_due due;

    refuse_queued_commands(core, now_us - COMMAND_WAIT_US);
    while ((due = rho_node_next(&core->node, now_us)) != RHO_NODE_NOTHING) {
        if (due == RHO_NODE_RESTART) {
            refuse_queued_commands(core, INT64_MAX);
            reset_tracking(core);
            if (core->events.began_anew) {
                core->events.began_anew(core->events.context);
            }
        } else {
            step_due_input(core, due);
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
        const struct rho_scan_assembler_source *source = &core->assembler.sources[i];

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
    const struct rho_scan_assembler_counters *after = &core->assembler.counters;

    out_of_sequence_counts_note(&core->order, before, &core->assembler);
    if (after->sensor_restarts == before->sensor_restarts) {
        refused_messages_keep(&core->refused, channel, data, size, before, after);
    } else {
        report_sensor_restarts(core, places);
        if (core->assembler.is_restart) { /* no scan since the restart has been stepped yet */
            refused_messages_retry(&core->refused, channel, &core->assembler, now_us, &core->taken);
        }
    }
    core->shown = refused_messages_correct(after, &core->taken);
}

void node_core_take_message(struct node_core *core, const char *channel, const uint8_t *data,
                            size_t size, int64_t now_us)
{
    struct rho_scan_assembler_counters before;
    bool has_room = queue_if_command_message(core, channel, data, size, now_us);
    struct newest_scan_positions places;

    while (!has_room) {
        before = core->assembler.counters;
        for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
            places.of[i] = core->assembler.sources[i].place;
        }
        has_room = rho_node_take(&core->node, channel, data, size, now_us) != RHO_ERROR_CAPACITY;
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
    return rho_node_due_us(&core->node);
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

    for (uint16_t part = 0; part < rho_publish_num_sensor_parts(&core->assembler); part++) {
        if (rho_publish_sensors(&core->assembler, core->pipeline.tracker, core->node.now_us, part,
                                &list) != RHO_OK) {
            return;
        }
        list.scan = core->node.step;
        list.epoch = core->node.epoch;
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

    rho_node_work(&core->node, &work);
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

    if (rho_node_learned(&core->node, &learned) &&
        rho_message_learned_encode(&learned, buffer, sizeof buffer, &size) == RHO_OK) {
        core->events.send(core->events.context, RHO_MESSAGE_LEARNED_CHANNEL, buffer, size);
    }
}

static void send_zone_counts(const struct node_core *core)
{
    struct rho_message_zone_list list;
    uint8_t buffer[RHO_MESSAGE_ZONE_LIST_MAX_SIZE];
    size_t size;

    if (!core->pipeline.zones) {
        return;
    }
    rho_publish_zones(core->pipeline.zones, &list);
    list.scan = core->node.step;
    list.epoch = core->node.epoch;
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

    rho_node_status(&core->node, core->pipeline.initiator, &status);
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
    send_zone_counts(core);
}

void node_core_send_clutter_map(const struct node_core *core)
{
    struct rho_message_clutter_map list;
    uint8_t buffer[RHO_MESSAGE_CLUTTER_MAP_MAX_SIZE];
    size_t size;

    for (uint16_t part = 0; part < rho_publish_num_clutter_parts(core->pipeline.tracker); part++) {
        if (rho_publish_clutter(core->pipeline.tracker, part, &list) != RHO_OK) {
            return;
        }
        list.scan = core->node.step;
        list.epoch = core->node.epoch;
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
        count += rho_publish_sensor(&core->assembler, core->pipeline.tracker, core->node.now_us,
                                    place, &sensors[count]) != 0;
    }
    return count;
}

bool node_core_has_two_senders(const struct node_core *core, int16_t sensor_id)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_scan_assembler_source *source = &core->assembler.sources[i];

        if (source->is_used && source->sensor_id == sensor_id && source->has_two_senders) {
            return true;
        }
    }
    return false;
}

int node_core_sensor_scans_min(const struct node_core *core)
{
    return (int)core->assembler.config.follow_scans;
}

const struct rho_report *node_core_last_report(const struct node_core *core)
{
    return core->pipeline.report;
}

int node_core_get_learned_wall(const struct node_core *core, unsigned place,
                               struct rho_reflector *wall)
{
    return rho_reflector_learning_wall(core->pipeline.learning, place, wall);
}

struct rho_clutter_map *node_core_clutter_map(struct node_core *core)
{
    return &core->pipeline.tracker->clutter_map;
}

const struct rho_scan_assembler_counters *node_core_assembler_counters(const struct node_core *core)
{
    return &core->shown;
}

const struct rho_frames_counters *node_core_frame_counters(const struct node_core *core)
{
    return &core->frames.counters;
}

const struct rho_tracker_counters *node_core_tracker_counters(const struct node_core *core)
{
    return &core->pipeline.tracker->counters;
}

const struct rho_node_counters *node_core_node_counters(const struct node_core *core)
{
    return &core->node.counters;
}

const struct node_core_commands *node_core_command_counts(const struct node_core *core)
{
    return &core->counters;
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
    return core->pipeline.tracker;
}

const struct rho_zones *node_core_zones(const struct node_core *core)
{
    return core->pipeline.zones;
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
    learned_report_print(core->pipeline.tracker, core->pipeline.learning, to);
}
