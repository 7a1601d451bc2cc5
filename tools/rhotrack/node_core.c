/* SPDX-License-Identifier: MIT */
#include "node_core.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "chain.h"
#include "clutter_file.h"
#include "common.h"
#include "feed_room.h"
#include "learned.h"
#include "node_passive.h"
#include "rhotrack/message.h"
#include "rhotrack/publish.h"
#include "rhotrack/udpm.h"

/* Scans of plots that wait for the open frame; one more closes it. */
#define WAITING_MAX 4

struct waiting {
    struct rho_scan scan;
    struct rho_sensor sensor;
    int has_sensor;
    struct rho_plot *plots; /* RHO_MAX_PLOTS */
};

struct timing {
    int64_t sum_us, max_us;
    uint64_t steps;
};

struct node_core {
    const struct parameters *parameters;
    struct node_core_events events;
    struct chain chain;
    struct node_core_counters counters;
    struct timing total, lately; /* lately: since the last status */
    int32_t step, epoch;
    bool is_restored; /* from a snapshot, and no scan has come since */
    int64_t now_us;   /* reception clock, of the last call that told it */
    int64_t
        frame_due_us; /* when the open frame closes, whoever is missing; INT64_MAX: none is open */
    unsigned num_waiting;
    struct waiting waiting[WAITING_MAX]; /* in the order of time */
    struct rho_feed feed;
    struct node_passive passive;
};

/* ---- Start ---- */

static void open_chain(struct node_core *core)
{
    chain_open(&core->chain, core->parameters);
    chain_open_passive(&core->chain, core->parameters);
}

struct node_core *node_core_open(const struct parameters *parameters, int32_t epoch,
                                 const struct node_core_events *events)
{
    struct node_core *core = must_calloc(1, sizeof *core);

    core->parameters = parameters;
    core->events = *events;
    core->epoch = epoch;
    core->chain = chain_start();
    core->chain.is_live = true;
    memset(core->chain.report, 0, sizeof *core->chain.report);
    for (int i = 0; i < WAITING_MAX; i++) {
        core->waiting[i].plots = must_calloc(RHO_MAX_PLOTS, sizeof(struct rho_plot));
    }
    open_chain(core);
    core->frame_due_us = INT64_MAX;
    node_passive_open(&core->passive, parameters);
    parameters_to_feed(parameters, &core->feed);
    return core;
}

enum chain_restored node_core_restore(struct node_core *core, const char *path)
{
    enum chain_restored restored = chain_restore(&core->chain, core->parameters, path);

    core->is_restored = restored == CHAIN_RESTORED;
    return restored;
}

bool node_core_save(const struct node_core *core, const char *path)
{
    return chain_save(&core->chain, path);
}

/* Tracks do not go on across a clock that was set; counters do, and what stands is where it was. */
static void start_anew(struct node_core *core)
{
    const struct rho_tracker_counters counters = core->chain.tracker->counters;
    const struct rho_tracker_work work = core->chain.tracker->work;
    struct rho_clutter_map *clutter = must_alloc(sizeof *clutter);

    *clutter = core->chain.tracker->clutter_map;
    open_chain(core);
    clutter_file_carry(&core->chain.tracker->clutter_map, clutter);
    free(clutter);
    core->chain.tracker->counters = counters;
    core->chain.tracker->work = work;
    core->epoch = core->epoch == INT32_MAX ? 0 : core->epoch + 1;
    core->counters.restarts++;
}

/* ---- Steps ---- */

static void send_tracks(const struct node_core *core)
{
    const struct rho_report *report = core->chain.report;
    uint8_t buffer[RHO_UDPM_MAX_DATAGRAM];
    size_t size;

    for (uint16_t part = 0; part < rho_publish_num_parts(report); part++) {
        if (rho_publish_tracks(report, core->step, core->epoch, part, buffer, sizeof buffer,
                               &size) == RHO_OK) {
            core->events.send(core->events.context, RHO_MESSAGE_TRACK_LIST_CHANNEL, buffer, size);
        }
    }
}

static void send_peaks(const struct node_core *core, const struct rho_initiator *initiator,
                       const struct rho_passive *passive)
{
    uint8_t buffer[RHO_UDPM_MAX_DATAGRAM];
    size_t size;

    if (rho_publish_peaks(initiator, passive, core->chain.report->time_us, core->step, buffer,
                          sizeof buffer, &size) == RHO_OK) {
        core->events.send(core->events.context, RHO_MESSAGE_PEAK_LIST_CHANNEL, buffer, size);
    }
}

static void count_time(struct timing *timing, int64_t took_us)
{
    timing->steps++;
    timing->sum_us += took_us;
    if (took_us > timing->max_us) {
        timing->max_us = took_us;
    }
}

/* A step that began at start_us was made. Peaks are those of its own search. */
static void finish_step(struct node_core *core, int64_t start_us,
                        const struct rho_initiator *initiator, const struct rho_passive *passive)
{
    int64_t took_us = clock_us() - start_us;

    count_time(&core->total, took_us);
    count_time(&core->lately, took_us);
    core->counters.steps++;
    core->step = core->step == INT32_MAX ? INT32_MIN : core->step + 1;
    if (core->events.stepped) {
        core->events.stepped(core->events.context, core->chain.report);
    }
    send_tracks(core);
    send_peaks(core, initiator, passive);
}

/* Descriptions of sensors that are not heard any more make room. */
static void forget_silent(struct node_core *core)
{
    struct rho_tracker *tracker = core->chain.tracker;

    for (unsigned i = tracker->num_sensors; i-- > 0;) {
        int32_t sensor_id = tracker->sensors[i].sensor_id;

        if (!node_is_heard(&core->feed, sensor_id, core->now_us) &&
            rho_tracker_forget_sensor(tracker, sensor_id) == RHO_OK) {
            core->counters.sensors_forgotten++;
        }
    }
}

static int describe(struct node_core *core, const struct rho_sensor *sensor)
{
    enum rho_status status = rho_tracker_set_sensor(core->chain.tracker, sensor);

    if (status == RHO_ERROR_CAPACITY) {
        forget_silent(core);
        status = rho_tracker_set_sensor(core->chain.tracker, sensor);
    }
    core->counters.sensors_refused += status != RHO_OK;
    return status == RHO_OK;
}

/* Without its sensor's place a scan says something else: it is not stepped. */
static void step_scan(struct node_core *core, const struct rho_scan *scan,
                      const struct rho_sensor *sensor)
{
    struct chain *chain = &core->chain;
    int64_t start_us;

    if (sensor && !describe(core, sensor)) {
        core->counters.scans_refused++;
        return;
    }
    start_us = clock_us();
    if (rho_tracker_step(chain->tracker, chain_initiator_of(chain, scan), scan, chain->report) !=
        RHO_OK) {
        core->counters.scans_refused++;
        return;
    }
    finish_step(core, start_us, chain->initiator, NULL);
}

/* ---- Frames of bearings ---- */

static const struct rho_frames_slot *open_frame(const struct node_core *core)
{
    const struct rho_frames_slot *slot = &core->passive.frames.slots[core->passive.frames.open];

    return slot->num_scans > 0 ? slot : NULL;
}

static void step_closed_frame(struct node_core *core)
{
    struct chain *chain = &core->chain;
    struct rho_frame_view view;
    int64_t start_us;

    if (!rho_frames_closed(&core->passive.frames, &view)) {
        return;
    }
    node_passive_has_frame(&core->passive);
    if (view.is_restart) {
        start_anew(core);
    }
    start_us = clock_us();
    if (rho_tracker_step_frame(chain->tracker, chain->passive, &view.frame, chain->report) !=
        RHO_OK) {
        core->counters.frames_refused++;
        return;
    }
    finish_step(core, start_us, NULL, chain->passive);
}

static void close_frame(struct node_core *core)
{
    core->frame_due_us = INT64_MAX;
    if (open_frame(core) && rho_frames_close(&core->passive.frames) == RHO_OK) {
        step_closed_frame(core);
    }
}

/* As `track` describes them: passive sensors see as far as bearings are searched. */
static void describe_passive(struct node_core *core, const struct rho_feed_item *item)
{
    struct rho_sensor sensor = item->sensor;

    if (item->has_sensor) {
        sensor.range_max_m = (float)parameters_range_max_m(core->parameters, sensor.sensor_id);
        (void)describe(core, &sensor);
    }
}

/* The open frame closes when nothing has come for as long as its sensors may differ, and messages are held. */
static void push_bearings(struct node_core *core, const struct rho_feed_item *item, int64_t now_us)
{
    int64_t hold_us = core->feed.config.hold_us;
    int64_t wait_us = hold_us + core->passive.frames.config.tolerance_us;
    float apart_max_m = core->chain.passive->batch.apart_max_m;

    if (!node_passive_take(&core->passive, &item->bearings, apart_max_m)) {
        core->counters.bearings_refused++;
        if (!node_passive_is_blocked(&core->passive, &core->feed, &item->bearings, now_us)) {
            return;
        }
        close_frame(core);
        node_passive_forget(&core->passive);
        chain_open_passive(&core->chain, core->parameters);
        if (!node_passive_take(&core->passive, &item->bearings, apart_max_m)) {
            return;
        }
    }
    describe_passive(core, item);
    step_closed_frame(core);
    core->frame_due_us = INT64_MAX;
    if (open_frame(core) && hold_us > 0 && now_us < INT64_MAX - wait_us) {
        core->frame_due_us = now_us + wait_us;
    }
}

/* ---- Scans of plots beside frames ---- */

static void keep_waiting(struct node_core *core, const struct rho_feed_item *item)
{
    struct waiting *waiting = &core->waiting[core->num_waiting++];

    waiting->scan = item->scan;
    waiting->sensor = item->sensor;
    waiting->has_sensor = item->has_sensor;
    memcpy(waiting->plots, item->scan.plots, item->scan.num_plots * sizeof *waiting->plots);
    waiting->scan.plots = waiting->plots;
}

static void step_first_waiting(struct node_core *core)
{
    struct waiting first = core->waiting[0];

    core->num_waiting--;
    memmove(core->waiting, core->waiting + 1, core->num_waiting * sizeof first);
    core->waiting[core->num_waiting] = first; /* its memory */
    step_scan(core, &first.scan, first.has_sensor ? &first.sensor : NULL);
}

/* Steps what waits until the next one has to go on waiting; a frame that no scan can join any more is closed. */
static void settle(struct node_core *core)
{
    while (core->num_waiting > 0) {
        const struct rho_frames_slot *frame = open_frame(core);
        int64_t time_us = core->waiting[0].scan.time_us;

        if (!frame || frame->time_us >= time_us) {
            step_first_waiting(core);
        } else if (core->num_waiting == WAITING_MAX ||
                   time_us > frame->time_us + core->passive.frames.config.tolerance_us) {
            close_frame(core);
        } else {
            return;
        }
    }
}

static void take_plots(struct node_core *core, const struct rho_feed_item *item)
{
    if (core->num_waiting > 0 || open_frame(core)) {
        keep_waiting(core, item);
        settle(core);
    } else {
        step_scan(core, &item->scan, item->has_sensor ? &item->sensor : NULL);
    }
}

/* ---- Items of the feed ---- */

static void step_all_waiting(struct node_core *core)
{
    close_frame(core);
    settle(core);
}

static void restart(struct node_core *core)
{
    step_all_waiting(core);
    node_passive_forget(&core->passive);
    start_anew(core);
}

/* Of the first scan after a snapshot was taken over. */
static bool is_of_another_clock(const struct node_core *core, const struct rho_feed_item *item)
{
    int64_t time_us = item->kind == RHO_FEED_BEARINGS ? item->bearings.time_us : item->scan.time_us;

    return core->is_restored && core->chain.tracker->has_time &&
           time_us < core->chain.tracker->time_us - core->feed.config.jump_max_us;
}

static void take_item(struct node_core *core, const struct rho_feed_item *item, int64_t now_us)
{
    if (item->is_restart || is_of_another_clock(core, item)) {
        restart(core);
    }
    core->is_restored = false;
    if (item->kind == RHO_FEED_BEARINGS) {
        push_bearings(core, item, now_us);
        settle(core);
    } else {
        take_plots(core, item);
    }
}

static void step_due(struct node_core *core, int64_t now_us)
{
    struct rho_feed_item item;

    while (rho_feed_next(&core->feed, now_us, &item)) {
        take_item(core, &item, now_us);
    }
}

void node_core_take(struct node_core *core, const char *channel, const uint8_t *data, size_t size,
                    int64_t now_us)
{
    struct rho_feed_item item;

    core->now_us = now_us;
    while (feed_order_take(&core->counters.order, &core->feed, channel, data, size, now_us) ==
           RHO_ERROR_CAPACITY) {
        if (rho_feed_next(&core->feed, now_us, &item)) {
            core->counters.scans_early += feed_room_was_short(&core->feed, &item, now_us);
            take_item(core, &item, now_us);
        }
    }
    node_core_tick(core, now_us);
}

void node_core_tick(struct node_core *core, int64_t now_us)
{
    core->now_us = now_us;
    step_due(core, now_us);
    if (now_us >= core->frame_due_us) {
        step_all_waiting(core);
    }
}

int64_t node_core_due_us(const struct node_core *core)
{
    int64_t due_us = rho_feed_due_us(&core->feed);

    return due_us < core->frame_due_us ? due_us : core->frame_due_us;
}

void node_core_flush(struct node_core *core)
{
    step_due(core, INT64_MAX);
    step_all_waiting(core);
}

/* ---- What it says of itself ---- */

static int32_t round_origin(const struct parameters *parameters, enum parameter_id id, double scale)
{
    return parameters_is_set(parameters, id) ? (int32_t)lround(parameters->value[id] * scale) : 0;
}

static void send_sensors(const struct node_core *core)
{
    struct rho_message_sensor_list list;
    uint8_t buffer[RHO_MESSAGE_SENSOR_LIST_MAX_SIZE];
    size_t size;

    for (uint16_t part = 0; part < rho_publish_num_sensor_parts(&core->feed); part++) {
        if (rho_publish_sensors(&core->feed, core->chain.tracker, core->now_us, part, &list) !=
            RHO_OK) {
            return;
        }
        list.scan = core->step;
        list.epoch = core->epoch;
        if (rho_message_sensor_list_encode(&list, buffer, sizeof buffer, &size) == RHO_OK) {
            core->events.send(core->events.context, RHO_MESSAGE_SENSOR_LIST_CHANNEL, buffer, size);
        }
    }
}

static int64_t at_most_int64(uint64_t count)
{
    return count < INT64_MAX ? (int64_t)count : INT64_MAX;
}

static void send_work(const struct node_core *core, const struct node_core_losses *losses)
{
    struct rho_message_work work;
    uint8_t buffer[RHO_MESSAGE_WORK_MAX_SIZE];
    size_t size;

    rho_publish_work(core->chain.tracker, &work);
    work.scan = core->step;
    work.epoch = core->epoch;
    work.num_steps = at_most_int64(core->counters.steps);
    work.reports_not_printed = at_most_int64(losses->reports_not_printed);
    work.events_not_logged = at_most_int64(losses->events_not_logged);
    if (rho_message_work_encode(&work, buffer, sizeof buffer, &size) == RHO_OK) {
        core->events.send(core->events.context, RHO_MESSAGE_WORK_CHANNEL, buffer, size);
    }
}

void node_core_status(struct node_core *core, const struct node_core_losses *losses)
{
    const uint64_t refused = losses->datagrams_refused;
    struct rho_message_status status;
    struct timing *lately = &core->lately;
    uint8_t buffer[RHO_MESSAGE_STATUS_MAX_SIZE];
    size_t size;

    rho_publish_status(&core->feed, &core->passive.frames, core->chain.tracker,
                       core->chain.initiator, &status);
    status.scan = core->step;
    status.epoch = core->epoch;
    status.fragments_refused = refused < INT32_MAX ? (int32_t)refused : INT32_MAX;
    status.step_us = lately->steps ? (float)lately->sum_us / (float)lately->steps : 0.0f;
    status.step_max_us = (float)lately->max_us;
    status.origin_lat_1e7deg = round_origin(core->parameters, PARAMETER_ORIGIN_LAT_DEG, 1e7);
    status.origin_lon_1e7deg = round_origin(core->parameters, PARAMETER_ORIGIN_LON_DEG, 1e7);
    status.origin_alt_mm = round_origin(core->parameters, PARAMETER_ORIGIN_ALT_M, 1e3);
    *lately = (struct timing){0};
    if (rho_message_status_encode(&status, buffer, sizeof buffer, &size) == RHO_OK) {
        core->events.send(core->events.context, RHO_MESSAGE_STATUS_CHANNEL, buffer, size);
    }
    send_work(core, losses);
    send_sensors(core);
}

void node_core_send_clutter(const struct node_core *core)
{
    struct rho_message_clutter_map list;
    uint8_t buffer[RHO_MESSAGE_CLUTTER_MAP_MAX_SIZE];
    size_t size;

    for (uint16_t part = 0; part < rho_publish_num_clutter_parts(core->chain.tracker); part++) {
        if (rho_publish_clutter(core->chain.tracker, part, &list) != RHO_OK) {
            return;
        }
        list.scan = core->step;
        list.epoch = core->epoch;
        if (rho_message_clutter_map_encode(&list, buffer, sizeof buffer, &size) == RHO_OK) {
            core->events.send(core->events.context, RHO_MESSAGE_CLUTTER_MAP_CHANNEL, buffer, size);
        }
    }
}

unsigned node_core_sensors(const struct node_core *core,
                           struct rho_message_sensor sensors[RHO_MAX_SENSORS])
{
    unsigned count = 0;

    for (unsigned place = 0; place < RHO_MAX_SENSORS; place++) {
        count += rho_publish_sensor(&core->feed, core->chain.tracker, core->now_us, place,
                                    &sensors[count]) != 0;
    }
    return count;
}

bool node_core_has_twin(const struct node_core *core, int16_t sensor_id)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_feed_source *source = &core->feed.sources[i];

        if (source->is_used && source->sensor_id == sensor_id && source->has_twin) {
            return true;
        }
    }
    return false;
}

int node_core_follow_scans(const struct node_core *core)
{
    return (int)core->feed.config.follow_scans;
}

const struct rho_report *node_core_report(const struct node_core *core)
{
    return core->chain.report;
}

struct rho_clutter_map *node_core_clutter(struct node_core *core)
{
    return &core->chain.tracker->clutter_map;
}

const struct rho_feed_counters *node_core_feed(const struct node_core *core)
{
    return &core->feed.counters;
}

const struct rho_frames_counters *node_core_frames(const struct node_core *core)
{
    return &core->passive.frames.counters;
}

const struct rho_tracker_counters *node_core_tracker(const struct node_core *core)
{
    return &core->chain.tracker->counters;
}

const struct node_core_counters *node_core_counters(const struct node_core *core)
{
    return &core->counters;
}

double node_core_mean_us(const struct node_core *core)
{
    return core->total.steps ? (double)core->total.sum_us / (double)core->total.steps : 0;
}

double node_core_max_us(const struct node_core *core)
{
    return (double)core->total.max_us;
}

void node_core_close(struct node_core *core)
{
    for (int i = 0; i < WAITING_MAX; i++) {
        free(core->waiting[i].plots);
    }
    chain_free(&core->chain);
    free(core);
}

void node_core_print_learned(const struct node_core *core, FILE *to)
{
    learned_print(core->chain.tracker, to);
}
