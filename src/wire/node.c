/* SPDX-License-Identifier: MIT */
#include "rhotrack/node.h"

#include <string.h>

#include "rhotrack/publish.h"

#define MAGIC 0x6e6f6465u
#define RANGE_UNKNOWN_M (2.0f * RHO_LIMIT_POSITION_M)

/* Fewer passive sensors give no positions. */
#define PASSIVE_MIN 2

/* Scans of one sensor refused in a row until the node believes that the sensor has moved. */
#define MOVED_SCANS 16

/*
 * is_making_room: the assembler had no room for a message. One scan goes out, then it is tried
 * again.
 */
enum { ROOM_ENOUGH = 0, ROOM_WANTED, ROOM_MADE };

/* has_closed: a frame is closed and not stepped; a restart that comes with it is told before. */
enum { FRAME_NONE = 0, FRAME_CLOSED, FRAME_RESTARTED };

/* ---- Start ---- */

/* Known to the compiler to be none where the library is built without bearings. */
static struct rho_frames *frames_of(const struct rho_node *node)
{
    return RHO_SCAN_ASSEMBLER_HAS(RHO_SCAN_ASSEMBLER_BEARINGS) ? node->config.frames : NULL;
}

static int is_ready(const struct rho_node *node)
{
    return node && node->magic == MAGIC;
}

/*
 * How many passive sensors there are is unknown before the first frame: it waits for as many as
 * there can be, until scans of the next frame come, or for its time. If the second sensor closed
 * it, the scans of all others would be out of sequence.
 */
static void await_all_sensors(struct rho_frames *frames)
{
    frames->config.sensors_min = RHO_MAX_PASSIVE_SENSORS;
}

enum rho_status rho_node_init(struct rho_node *node, size_t size,
                              const struct rho_node_config *config)
{
    if (!node || !config || !config->assembler || !config->tracker || !config->report ||
        (config->passive && !config->frames) || (config->waiting_max > 0 && !config->waiting)) {
        return RHO_ERROR_NULL;
    }
    if (size != sizeof *node) {
        return RHO_ERROR_SIZE;
    }
    if (!rho_is_within(config->passive_range_max_m, 0.0f, RANGE_UNKNOWN_M) ||
        (config->frames && !config->passive && !(config->apart_max_m > 0.0f))) {
        return RHO_ERROR_CONFIG;
    }
    memset(node, 0, sizeof *node);
    node->config = *config;
    node->epoch = config->epoch;
    node->frame_due_us = INT64_MAX;
    if (frames_of(node)) {
        if (rho_frames_close(frames_of(node)) != RHO_OK) {
            return RHO_ERROR_STATE;
        }
        await_all_sensors(frames_of(node));
    }
    node->magic = MAGIC;
    return RHO_OK;
}

/* ---- Sensors ---- */

/* An accepted scan of the sensor, of any kind, came in the last jump_max_us. */
static int is_sensor_heard(const struct rho_node *node, int32_t sensor_id)
{
    const struct rho_scan_assembler *assembler = node->config.assembler;

    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_scan_assembler_source *source = &assembler->sources[i];

        if (source->is_used && source->sensor_id == sensor_id &&
            rho_elapsed_us(node->now_us, source->heard_us) <=
                (uint64_t)assembler->config.jump_max_us) {
            return 1;
        }
    }
    return 0;
}

static void forget_silent_sensors(struct rho_node *node)
{
    struct rho_tracker *tracker = node->config.tracker;

    for (unsigned i = tracker->num_sensors; i-- > 0;) {
        int32_t sensor_id = tracker->sensors[i].sensor_id;

        if (!is_sensor_heard(node, sensor_id) &&
            rho_tracker_forget_sensor(tracker, sensor_id) == RHO_OK) {
            node->counters.sensors_forgotten = rho_count(node->counters.sensors_forgotten, 1);
        }
    }
}

static int describe_sensor(struct rho_node *node, const struct rho_sensor *sensor)
{
    enum rho_status status = rho_tracker_set_sensor(node->config.tracker, sensor);

    if (status == RHO_ERROR_CAPACITY) {
        forget_silent_sensors(node);
        status = rho_tracker_set_sensor(node->config.tracker, sensor);
    }
    node->counters.sensors_refused = rho_count(node->counters.sensors_refused, status != RHO_OK);
    return status == RHO_OK;
}

/* ---- Frames of bearings ---- */

/* NULL: none is open. */
static const struct rho_frames_slot *open_frame(const struct rho_node *node)
{
    const struct rho_frames *frames = frames_of(node);

    return frames && frames->slots[frames->open].num_scans > 0 ? &frames->slots[frames->open]
                                                               : NULL;
}

/* Returns 0 where no frame was open. */
static int close_frame(struct rho_node *node)
{
    node->frame_due_us = INT64_MAX;
    if (!open_frame(node) || rho_frames_close(frames_of(node)) != RHO_OK) {
        return 0;
    }
    node->has_closed = FRAME_CLOSED;
    return 1;
}

/* Tracks that bearings start begin anew. The config was taken before. */
static void reset_search(struct rho_node *node)
{
    struct rho_passive *passive = node->config.passive;

    if (frames_of(node) && passive) {
        (void)!rho_passive_init(passive, sizeof *passive, &passive->config);
    }
}

/* The frames and their sensors begin anew; the counters go on. */
static void reset_frames(struct rho_node *node)
{
    struct rho_frames *frames = frames_of(node);

    if (frames) {
        struct rho_frames_counters counters = frames->counters;

        (void)!rho_frames_init(frames, sizeof *frames, &frames->config);
        await_all_sensors(frames);
        counters.scans_taken = 0; /* by it the frames know that there is no clock yet */
        frames->counters = counters;
        memset(node->refused_scans, 0, sizeof node->refused_scans);
    }
}

/*
 * A search refuses a frame with two sensors that are farther apart than its cells reach. Of these
 * two the sensor that came last is refused.
 */
static int is_near_others(const struct rho_node *node, const struct rho_bearing_scan *scan)
{
    const struct rho_frames *frames = frames_of(node);
    const struct rho_passive *passive = node->config.passive;
    float apart_max_m = passive ? passive->batch.apart_max_m : node->config.apart_max_m;

    for (unsigned i = 0; i < frames->num_sensors; i++) {
        float x_m = frames->sensors[i].x_m - scan->x_m, y_m = frames->sensors[i].y_m - scan->y_m;

        if (x_m * x_m + y_m * y_m > apart_max_m * apart_max_m) {
            return 0;
        }
    }
    return 1;
}

/* Into the open frame, or the next. */
static int push_bearings(struct rho_node *node, const struct rho_bearing_scan *scan)
{
    struct rho_frames *frames = frames_of(node);

    if (!frames || !is_near_others(node, scan) || rho_frames_push(frames, scan) != RHO_OK) {
        return 0;
    }
    for (unsigned i = 0; i < frames->num_sensors; i++) {
        if (frames->sensors[i].sensor_id == scan->sensor_id) {
            node->refused_scans[i] = 0;
        }
    }
    node->has_closed = frames->has_closed ? FRAME_CLOSED : FRAME_NONE;
    return 1;
}

/*
 * After a refusal: a silent sensor keeps the scan's sensor out, or that one has been refused so
 * often that it is likely to stand at another place.
 */
static int is_kept_out(struct rho_node *node, const struct rho_bearing_scan *scan)
{
    const struct rho_frames *frames = frames_of(node);

    for (unsigned i = 0; frames && i < frames->num_sensors; i++) {
        int32_t sensor_id = frames->sensors[i].sensor_id;

        if (sensor_id == scan->sensor_id ? ++node->refused_scans[i] >= MOVED_SCANS
                                         : !is_sensor_heard(node, sensor_id)) {
            return 1;
        }
    }
    return 0;
}

static void describe_passive_sensor(struct rho_node *node)
{
    struct rho_sensor sensor = node->item.sensor;

    if (node->item.has_sensor) {
        if (node->config.passive_range_max_m > 0.0f && sensor.range_max_m >= RANGE_UNKNOWN_M) {
            sensor.range_max_m = node->config.passive_range_max_m;
        }
        (void)describe_sensor(node, &sensor);
    }
}

/* The open frame closes when nothing has come for as long as its scans may differ and wait. */
static void set_frame_due(struct rho_node *node, int64_t now_us)
{
    int64_t hold_us = node->config.assembler->config.hold_us;
    int64_t wait_us = hold_us + frames_of(node)->config.tolerance_us;

    node->frame_due_us = open_frame(node) && hold_us > 0 && now_us < INT64_MAX - wait_us
                             ? now_us + wait_us
                             : INT64_MAX;
}

/* A scan that a sensor keeps out is tried again after the open frame's step, with empty frames. */
static void take_bearings(struct rho_node *node, int64_t now_us)
{
    const struct rho_bearing_scan *scan = &node->item.bearings;
    int is_again = node->is_forgetting;

    node->is_forgetting = 0;
    if (is_again) {
        reset_frames(node);
        reset_search(node);
    }
    if (push_bearings(node, scan)) {
        describe_passive_sensor(node);
        set_frame_due(node, now_us);
    } else if (!is_again) {
        node->counters.bearings_refused = rho_count(node->counters.bearings_refused, 1);
        if (is_kept_out(node, scan)) {
            node->is_forgetting = 1;
            (void)close_frame(node);
        }
    }
    node->has_item = node->is_forgetting;
}

/* ---- Scans of plots ---- */

/* Without its sensor's place a scan says something else: it is refused. */
static enum rho_node_due give_scan(struct rho_node *node, const struct rho_scan *scan,
                                   const struct rho_sensor *sensor)
{
    if (sensor && !describe_sensor(node, sensor)) {
        node->counters.scans_refused = rho_count(node->counters.scans_refused, 1);
        node->counters.plots_refused = rho_count(node->counters.plots_refused, scan->num_plots);
        return RHO_NODE_NOTHING;
    }
    node->scan = *scan;
    return RHO_NODE_SCAN;
}

static struct rho_node_waiting *waiting_at(const struct rho_node *node, unsigned place)
{
    unsigned at = node->first_waiting + place;

    return &node->config
                .waiting[at < node->config.waiting_max ? at : at - node->config.waiting_max];
}

static void keep_waiting(struct rho_node *node)
{
    struct rho_node_waiting *waiting = waiting_at(node, node->num_waiting++);

    waiting->scan = node->item.scan;
    waiting->sensor = node->item.sensor;
    waiting->has_sensor = node->item.has_sensor;
    memcpy(waiting->plots, node->item.scan.plots,
           node->item.scan.num_plots * sizeof(struct rho_plot));
    waiting->scan.plots = waiting->plots;
}

static enum rho_node_due give_first_waiting(struct rho_node *node)
{
    const struct rho_node_waiting *first = waiting_at(node, 0);

    node->num_waiting--;
    node->first_waiting = (uint16_t)(waiting_at(node, 1) - node->config.waiting);
    return give_scan(node, &first->scan, first->has_sensor ? &first->sensor : NULL);
}

static enum rho_node_due take_plots(struct rho_node *node)
{
    const struct rho_frames_slot *frame = open_frame(node);
    const struct rho_scan_assembler_item *item = &node->item;

    if (node->num_waiting == 0 && (!frame || frame->time_us >= item->scan.time_us)) {
        node->has_item = 0;
        return give_scan(node, &item->scan, item->has_sensor ? &item->sensor : NULL);
    }
    if (node->num_waiting < node->config.waiting_max) {
        keep_waiting(node);
        node->has_item = 0;
    } else {
        (void)close_frame(node);
    }
    return RHO_NODE_NOTHING;
}

/* ---- What is due ---- */

static enum rho_node_due restart(struct rho_node *node)
{
    reset_search(node);
    node->counters.restarts = rho_count(node->counters.restarts, 1);
    return RHO_NODE_RESTART;
}

static enum rho_node_due give_closed_frame(struct rho_node *node)
{
    struct rho_frames *frames = frames_of(node);

    frames->config.sensors_min = PASSIVE_MIN;
    if (node->has_closed == FRAME_CLOSED && frames->slots[1 - frames->open].is_restart) {
        node->has_closed = FRAME_RESTARTED;
        return restart(node);
    }
    node->has_closed = FRAME_NONE;
    return RHO_NODE_FRAME;
}

/*
 * The closed frame, then scans that have waited for it. A frame that no scan can join any more
 * closes.
 */
static enum rho_node_due give_waiting(struct rho_node *node)
{
    enum rho_node_due due = RHO_NODE_NOTHING;
    const struct rho_frames_slot *frame;
    int64_t time_us;

    while (frames_of(node) && due == RHO_NODE_NOTHING) {
        if (node->has_closed) {
            return give_closed_frame(node);
        }
        if (node->num_waiting == 0) {
            break;
        }
        frame = open_frame(node);
        time_us = waiting_at(node, 0)->scan.time_us;
        if (!frame || frame->time_us >= time_us) {
            due = give_first_waiting(node);
        } else if (node->num_waiting == node->config.waiting_max ||
                   time_us > frame->time_us + frames_of(node)->config.tolerance_us) {
            (void)close_frame(node);
        } else {
            break;
        }
    }
    return due;
}

/* The step of the open frame, and of scans that wait for it, comes before a restart. */
static enum rho_node_due take_item(struct rho_node *node, int64_t now_us)
{
    if (node->item.is_restart) {
        if (close_frame(node)) {
            return RHO_NODE_NOTHING;
        }
        node->item.is_restart = 0;
        reset_frames(node);
        return restart(node);
    }
    if (RHO_SCAN_ASSEMBLER_IS(node->item.kind, RHO_SCAN_ASSEMBLER_BEARINGS)) {
        take_bearings(node, now_us);
        return RHO_NODE_NOTHING;
    }
    return take_plots(node);
}

/* The first scan after a snapshot was loaded is of an older time: the clock is another one. */
static int is_of_another_clock(const struct rho_node *node)
{
    const struct rho_tracker *tracker = node->config.tracker;
    int64_t time_us = RHO_SCAN_ASSEMBLER_IS(node->item.kind, RHO_SCAN_ASSEMBLER_BEARINGS)
                          ? node->item.bearings.time_us
                          : node->item.scan.time_us;

    return node->is_restored && tracker->has_time &&
           time_us < tracker->time_us - node->config.assembler->config.jump_max_us;
}

/* A scan that is due, or an open frame whose time has passed. Returns 0 where there is neither. */
static int fetch_due_item(struct rho_node *node, int64_t now_us)
{
    struct rho_scan_assembler *assembler = node->config.assembler;
    const uint8_t room = node->is_making_room;

    node->is_making_room = room == ROOM_WANTED ? ROOM_MADE : ROOM_ENOUGH;
    if (room == ROOM_MADE) {
        return 0;
    }
    if (rho_scan_assembler_next(assembler, now_us, &node->item)) {
        if (room == ROOM_WANTED && assembler->is_pressed &&
            now_us - node->item.heard_us < assembler->config.hold_us) {
            node->counters.scans_early = rho_count(node->counters.scans_early, 1);
        }
        node->item.is_restart |= is_of_another_clock(node);
        node->is_restored = 0;
        node->has_item = 1;
        return 1;
    }
    return room == ROOM_ENOUGH && now_us >= node->frame_due_us && close_frame(node);
}

enum rho_node_due rho_node_next(struct rho_node *node, int64_t now_us)
{
    enum rho_node_due due = RHO_NODE_NOTHING;
    int has_more = is_ready(node);

    if (has_more && now_us != INT64_MAX) {
        node->now_us = now_us;
    }
    while (has_more && due == RHO_NODE_NOTHING) {
        due = give_waiting(node);
        if (due == RHO_NODE_NOTHING && node->has_item) {
            due = take_item(node, now_us);
        } else if (due == RHO_NODE_NOTHING) {
            has_more = fetch_due_item(node, now_us);
        }
    }
    if (due != RHO_NODE_NOTHING) {
        node->due = (uint8_t)due;
    }
    return due;
}

enum rho_status rho_node_take(struct rho_node *node, const char *channel, const uint8_t *data,
                              size_t size, int64_t now_us)
{
    enum rho_status status;

    if (!is_ready(node)) {
        return node ? RHO_ERROR_STATE : RHO_ERROR_NULL;
    }
    node->now_us = now_us;
    status = rho_scan_assembler_take(node->config.assembler, channel, data, size, now_us);
    node->is_making_room = status == RHO_ERROR_CAPACITY ? ROOM_WANTED : ROOM_ENOUGH;
    return status;
}

int64_t rho_node_due_us(const struct rho_node *node)
{
    int64_t due_us = INT64_MAX;

    if (is_ready(node)) {
        due_us = rho_scan_assembler_due_us(node->config.assembler);
        due_us = node->frame_due_us < due_us ? node->frame_due_us : due_us;
    }
    return due_us;
}

/* ---- Steps ---- */

static enum rho_status step_frame(struct rho_node *node)
{
    const struct rho_node_config *config = &node->config;
    struct rho_frame_view view;
    enum rho_status status;

    (void)rho_frames_closed(config->frames, &view);
    status = rho_tracker_step_frame(config->tracker, config->passive, &view.frame, config->report);
    node->counters.frames_refused = rho_count(node->counters.frames_refused, status != RHO_OK);
    return status;
}

static enum rho_status step_scan(struct rho_node *node, struct rho_initiator *initiator)
{
    enum rho_status status =
        rho_tracker_step(node->config.tracker, initiator, &node->scan, node->config.report);

    node->counters.scans_refused = rho_count(node->counters.scans_refused, status != RHO_OK);
    return status;
}

enum rho_status rho_node_step(struct rho_node *node, struct rho_initiator *initiator)
{
    enum rho_status status = RHO_ERROR_STATE;

    if (!node) {
        return RHO_ERROR_NULL;
    }
    if (frames_of(node) && node->due == RHO_NODE_FRAME) {
        status = step_frame(node);
    } else if (node->due == RHO_NODE_SCAN) {
        status = step_scan(node, initiator);
    }
    node->stepped = node->due;
    node->due = RHO_NODE_NOTHING;
    if (status == RHO_OK) {
        node->counters.steps = rho_count(node->counters.steps, 1);
        node->step = node->step == INT32_MAX ? INT32_MIN : node->step + 1;
    }
    return status;
}

void rho_node_count_time(struct rho_node *node, int64_t took_us)
{
    uint32_t step_us = took_us < 0 ? 0 : took_us < INT32_MAX ? (uint32_t)took_us : INT32_MAX;

    if (node) {
        node->timing.sum_us = rho_count(node->timing.sum_us, step_us);
        node->timing.max_us = step_us > node->timing.max_us ? step_us : node->timing.max_us;
        node->timing.steps++;
    }
}

/* ---- Messages ---- */

/* Tracks and peaks; bodies come behind them. */
static uint16_t num_without_bodies(const struct rho_node *node)
{
    return is_ready(node) ? (uint16_t)(rho_publish_num_parts(node->config.report) + 1u) : 0;
}

uint16_t rho_node_num_messages(const struct rho_node *node)
{
    const uint16_t num_messages = num_without_bodies(node);

    return RHO_BODIES && num_messages > 0
               ? (uint16_t)(num_messages +
                            rho_publish_num_body_parts(node->config.tracker, node->config.report))
               : num_messages;
}

const char *rho_node_channel(const struct rho_node *node, uint16_t part)
{
    if (RHO_BODIES && part >= num_without_bodies(node)) {
        return RHO_MESSAGE_BODY_LIST_CHANNEL;
    }
    return part + 1u < num_without_bodies(node) ? RHO_MESSAGE_TRACK_LIST_CHANNEL
                                                : RHO_MESSAGE_PEAK_LIST_CHANNEL;
}

enum rho_status rho_node_publish(const struct rho_node *node, const struct rho_initiator *initiator,
                                 uint16_t part, uint8_t *buffer, size_t capacity, size_t *size)
{
    const struct rho_report *report;
    int is_frame;

    if (!is_ready(node)) {
        return node ? RHO_ERROR_STATE : RHO_ERROR_NULL;
    }
    report = node->config.report;
    if (part < rho_publish_num_parts(report)) {
        return rho_publish_tracks(report, node->step, node->epoch, part, buffer, capacity, size);
    }
    if (part >= rho_node_num_messages(node)) {
        return RHO_ERROR_VALUE;
    }
    if (RHO_BODIES && part >= num_without_bodies(node)) {
        return rho_publish_bodies(node->config.tracker, report, node->step, node->epoch,
                                  (uint16_t)(part - num_without_bodies(node)), buffer, capacity,
                                  size);
    }
    is_frame = frames_of(node) && node->stepped == RHO_NODE_FRAME;
    return rho_publish_peaks(is_frame ? NULL : initiator, is_frame ? node->config.passive : NULL,
                             report->time_us, node->step, buffer, capacity, size);
}

static int32_t add_to_counter(int32_t counter, uint32_t more)
{
    uint32_t sum = rho_count((uint32_t)counter, more);

    return sum < INT32_MAX ? (int32_t)sum : INT32_MAX;
}

void rho_node_status(struct rho_node *node, const struct rho_initiator *initiator,
                     struct rho_message_status *status)
{
    if (!is_ready(node) || !status) {
        return;
    }
    rho_publish_status(node->config.assembler, frames_of(node), node->config.tracker, initiator,
                       status);
    status->scan = node->step;
    status->epoch = node->epoch;
    status->plots_in = add_to_counter(status->plots_in, node->counters.plots_refused);
    status->inputs_no_room = add_to_counter(status->inputs_no_room, node->counters.plots_refused);
    if (node->timing.steps > 0) {
        status->step_us = (float)node->timing.sum_us / (float)node->timing.steps;
        status->step_max_us = (float)node->timing.max_us;
    }
    node->timing = (struct rho_node_timing){0};
}

void rho_node_work(const struct rho_node *node, struct rho_message_work *work)
{
    if (is_ready(node) && work) {
        rho_publish_work(node->config.tracker, work);
        work->scan = node->step;
        work->epoch = node->epoch;
        work->num_steps = node->counters.steps;
    }
}

int rho_node_learned(struct rho_node *node, struct rho_message_learned *learned)
{
    const struct rho_tracker *tracker = is_ready(node) ? node->config.tracker : NULL;
    const unsigned place =
        tracker && node->next_learned < tracker->num_sensors ? node->next_learned : 0;

    if (!rho_publish_learned(tracker, place, learned)) {
        return 0;
    }
    node->next_learned = (uint8_t)(place + 1u);
    learned->scan = node->step;
    learned->epoch = node->epoch;
    return 1;
}
