/* SPDX-License-Identifier: MIT */
#include "rhotrack/node.h"

#include <string.h>

#include "message_clamps.h"
#include "rhotrack/publish.h"

#define MAGIC 0x6e6f6465u
#define RANGE_UNKNOWN_M (2.0f * RHO_LIMIT_POSITION_M)

/* Least number of passive sensors whose bearings give positions. */
#define PASSIVE_MIN 2

/* Successive refused scans of a passive sensor after which it is taken to have moved. */
#define MOVED_SCANS 16

/*
 * Values of is_making_room: when the assembler has no room for a message (WANTED), one scan is
 * stepped (MADE), and the caller gives the message again.
 */
enum { ROOM_ENOUGH = 0, ROOM_WANTED, ROOM_MADE };

/* Values of has_closed: no closed frame; one to be stepped; one whose restart was told before. */
enum { FRAME_NONE = 0, FRAME_CLOSED, FRAME_RESTARTED };

/* ---- Start ---- */

/* The frames; a constant NULL, which the compiler sees, in a build without bearings. */
static struct rho_frames *frames_or_null(const struct rho_node *node)
{
    return RHO_SCAN_ASSEMBLER_HAS(RHO_SCAN_ASSEMBLER_BEARINGS) ? node->config.frames : NULL;
}

static int is_initialised(const struct rho_node *node)
{
    return node && node->magic == MAGIC;
}

/*
 * Makes the first frame wait for the largest number of passive sensors, until a scan of the next
 * frame comes or its time has passed: the number of sensors is unknown, and a frame closed by the
 * second sensor would make the scans of all others out of sequence.
 */
static void require_all_sensors_in_frame(struct rho_frames *frames)
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
    if (frames_or_null(node)) {
        if (rho_frames_close(frames_or_null(node)) != RHO_OK) {
            return RHO_ERROR_STATE;
        }
        require_all_sensors_in_frame(frames_or_null(node));
    }
    node->magic = MAGIC;
    return RHO_OK;
}

/* ---- Sensors ---- */

/* 1 where the assembler has accepted a scan of the sensor in the last jump_max_us. */
static int is_sensor_heard_lately(const struct rho_node *node, int32_t sensor_id)
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

static void make_tracker_forget_silent_sensors(struct rho_node *node)
{
    struct rho_tracker *tracker = node->config.tracker;

    for (unsigned i = tracker->num_sensors; i-- > 0;) {
        int32_t sensor_id = tracker->sensors[i].sensor.sensor_id;

        if (!is_sensor_heard_lately(node, sensor_id) &&
            rho_tracker_forget_sensor(tracker, sensor_id) == RHO_OK) {
            node->counters.sensors_forgotten = rho_count(node->counters.sensors_forgotten, 1);
        }
    }
}

static int describe_sensor_to_tracker(struct rho_node *node, const struct rho_sensor *sensor)
{
    enum rho_status status = rho_tracker_set_sensor(node->config.tracker, sensor);

    if (status == RHO_ERROR_CAPACITY) {
        make_tracker_forget_silent_sensors(node);
        status = rho_tracker_set_sensor(node->config.tracker, sensor);
    }
    node->counters.sensors_refused = rho_count(node->counters.sensors_refused, status != RHO_OK);
    return status == RHO_OK;
}

/* ---- Frames of bearings ---- */

/* The frame that scans may still join; NULL: no frame is open. */
static const struct rho_frames_slot *find_open_frame(const struct rho_node *node)
{
    const struct rho_frames *frames = frames_or_null(node);

    return frames && frames->slots[frames->open].num_scans > 0 ? &frames->slots[frames->open]
                                                               : NULL;
}

/* Closes the open frame; returns 0 where no frame was open. */
static int close_open_bearing_frame_to_be_stepped_later(struct rho_node *node)
{
    node->frame_due_us = INT64_MAX;
    if (!find_open_frame(node) || rho_frames_close(frames_or_null(node)) != RHO_OK) {
        return 0;
    }
    node->has_closed = FRAME_CLOSED;
    return 1;
}

/* Initialises passive initiation anew; its config is known to be valid. */
static void reset_passive_search(struct rho_node *node)
{
    struct rho_passive *passive = node->config.passive;

    if (frames_or_null(node) && passive) {
        (void)!rho_passive_init(passive, sizeof *passive, &passive->config);
    }
}

/* Initialises the frames and their sensors anew, but keeps their counters. */
static void reset_frames(struct rho_node *node)
{
    struct rho_frames *frames = frames_or_null(node);

    if (frames) {
        struct rho_frames_counters counters = frames->counters;

        (void)!rho_frames_init(frames, sizeof *frames, &frames->config);
        require_all_sensors_in_frame(frames);
        counters.scans_taken = 0; /* 0 tells the frames that they have no clock yet */
        frames->counters = counters;
        memset(node->refused_scans, 0, sizeof node->refused_scans);
    }
}

/*
 * 1 where a scan's sensor is within apart_max_m of all sensors of the frames: a search refuses
 * frames whose sensors are farther apart than its cells reach.
 */
static int is_sensor_within_apart_max_of_others(const struct rho_node *node,
                                                const struct rho_bearing_scan *scan)
{
    const struct rho_frames *frames = frames_or_null(node);
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

/* Adds a scan to the open frame or the next one; returns 0 where it is refused. */
static int add_bearings_to_frame_unless_refused(struct rho_node *node,
                                                const struct rho_bearing_scan *scan)
{
    struct rho_frames *frames = frames_or_null(node);

    if (!frames || !is_sensor_within_apart_max_of_others(node, scan) ||
        rho_frames_push(frames, scan) != RHO_OK) {
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
 * Counts a refused scan. Returns 1 where the frames are to begin anew: a silent sensor keeps the
 * scan's sensor out, or MOVED_SCANS refusals suggest that the scan's sensor has moved.
 */
static int count_refusal_and_must_reset_frames(struct rho_node *node,
                                               const struct rho_bearing_scan *scan)
{
    const struct rho_frames *frames = frames_or_null(node);

    for (unsigned i = 0; frames && i < frames->num_sensors; i++) {
        int32_t sensor_id = frames->sensors[i].sensor_id;

        if (sensor_id == scan->sensor_id ? ++node->refused_scans[i] >= MOVED_SCANS
                                         : !is_sensor_heard_lately(node, sensor_id)) {
            return 1;
        }
    }
    return 0;
}

static void describe_bearing_sensor_to_tracker(struct rho_node *node)
{
    struct rho_sensor sensor = node->item.sensor;

    if (node->item.has_sensor) {
        if (node->config.passive_range_max_m > 0.0f && sensor.range_max_m >= RANGE_UNKNOWN_M) {
            sensor.range_max_m = node->config.passive_range_max_m;
        }
        (void)describe_sensor_to_tracker(node, &sensor);
    }
}

/* The open frame closes when no scan has come for tolerance_us and hold_us together. */
static void set_frame_due_time(struct rho_node *node, int64_t now_us)
{
    int64_t hold_us = node->config.assembler->config.hold_us;
    int64_t wait_us = hold_us + frames_or_null(node)->config.tolerance_us;

    node->frame_due_us = find_open_frame(node) && hold_us > 0 && now_us < INT64_MAX - wait_us
                             ? now_us + wait_us
                             : INT64_MAX;
}

/* Adds the item to a frame; where frames must begin anew, keeps it until the open frame's step. */
static void push_bearings_into_frame_or_await_reset(struct rho_node *node, int64_t now_us)
{
    const struct rho_bearing_scan *scan = &node->item.bearings;
    int is_again = node->is_forgetting;

    node->is_forgetting = 0;
    if (is_again) {
        reset_frames(node);
        reset_passive_search(node);
    }
    if (add_bearings_to_frame_unless_refused(node, scan)) {
        describe_bearing_sensor_to_tracker(node);
        set_frame_due_time(node, now_us);
    } else if (!is_again) {
        node->counters.bearings_refused = rho_count(node->counters.bearings_refused, 1);
        if (count_refusal_and_must_reset_frames(node, scan)) {
            node->is_forgetting = 1;
            (void)close_open_bearing_frame_to_be_stepped_later(node);
        }
    }
    node->has_item = node->is_forgetting;
}

/* ---- Scans of plots ---- */

/* Refuses a scan whose sensor the tracker does not take: the sensor's position would be unknown. */
static enum rho_node_due describe_sensor_and_give_scan(struct rho_node *node,
                                                       const struct rho_scan *scan,
                                                       const struct rho_sensor *sensor)
{
    if (sensor && !describe_sensor_to_tracker(node, sensor)) {
        node->counters.scans_refused = rho_count(node->counters.scans_refused, 1);
        node->counters.plots_refused = rho_count(node->counters.plots_refused, scan->num_plots);
        return RHO_NODE_NOTHING;
    }
    node->scan = *scan;
    return RHO_NODE_SCAN;
}

static struct rho_node_waiting *waiting_scan_at(const struct rho_node *node, unsigned place)
{
    unsigned at = node->first_waiting + place;

    return &node->config
                .waiting[at < node->config.waiting_max ? at : at - node->config.waiting_max];
}

static void copy_fetched_scan_to_waiting_queue(struct rho_node *node)
{
    struct rho_node_waiting *waiting = waiting_scan_at(node, node->num_waiting++);

    waiting->scan = node->item.scan;
    waiting->sensor = node->item.sensor;
    waiting->has_sensor = node->item.has_sensor;
    memcpy(waiting->plots, node->item.scan.plots,
           node->item.scan.num_plots * sizeof(struct rho_plot));
    waiting->scan.plots = waiting->plots;
}

static enum rho_node_due give_first_waiting_scan(struct rho_node *node)
{
    const struct rho_node_waiting *first = waiting_scan_at(node, 0);

    node->num_waiting--;
    node->first_waiting = (uint16_t)(waiting_scan_at(node, 1) - node->config.waiting);
    return describe_sensor_and_give_scan(node, &first->scan,
                                         first->has_sensor ? &first->sensor : NULL);
}

/*
 * Gives the item's scan; while an older frame is open the scan waits, or closes it if none may
 * wait.
 */
static enum rho_node_due give_scan_or_let_wait(struct rho_node *node)
{
    const struct rho_frames_slot *frame = find_open_frame(node);
    const struct rho_scan_assembler_item *item = &node->item;

    if (node->num_waiting == 0 && (!frame || frame->time_us >= item->scan.time_us)) {
        node->has_item = 0;
        return describe_sensor_and_give_scan(node, &item->scan,
                                             item->has_sensor ? &item->sensor : NULL);
    }
    if (node->num_waiting < node->config.waiting_max) {
        copy_fetched_scan_to_waiting_queue(node);
        node->has_item = 0;
    } else {
        (void)close_open_bearing_frame_to_be_stepped_later(node);
    }
    return RHO_NODE_NOTHING;
}

/* ---- What is due ---- */

/* Initialises passive initiation anew, counts the restart, and tells the caller of it. */
static enum rho_node_due reset_search_and_tell_restart(struct rho_node *node)
{
    reset_passive_search(node);
    node->counters.restarts = rho_count(node->counters.restarts, 1);
    return RHO_NODE_RESTART;
}

static enum rho_node_due give_closed_frame_or_tell_restart(struct rho_node *node)
{
    struct rho_frames *frames = frames_or_null(node);

    frames->config.sensors_min = PASSIVE_MIN;
    if (node->has_closed == FRAME_CLOSED && frames->slots[1 - frames->open].is_restart) {
        node->has_closed = FRAME_RESTARTED;
        return reset_search_and_tell_restart(node);
    }
    node->has_closed = FRAME_NONE;
    return RHO_NODE_FRAME;
}

/*
 * Gives the closed frame, and then the scans that have waited for it. Closes a frame that no scan
 * can join any more.
 */
static enum rho_node_due give_frame_or_waiting_scan(struct rho_node *node)
{
    enum rho_node_due due = RHO_NODE_NOTHING;
    const struct rho_frames_slot *frame;
    int64_t time_us;

    while (frames_or_null(node) && due == RHO_NODE_NOTHING) {
        if (node->has_closed) {
            return give_closed_frame_or_tell_restart(node);
        }
        if (node->num_waiting == 0) {
            break;
        }
        frame = find_open_frame(node);
        time_us = waiting_scan_at(node, 0)->scan.time_us;
        if (!frame || frame->time_us >= time_us) {
            due = give_first_waiting_scan(node);
        } else if (node->num_waiting == node->config.waiting_max ||
                   time_us > frame->time_us + frames_or_null(node)->config.tolerance_us) {
            (void)close_open_bearing_frame_to_be_stepped_later(node);
        } else {
            break;
        }
    }
    return due;
}

/* Takes the fetched scan. Before a restart, the open frame and the scans behind it are stepped. */
static enum rho_node_due take_fetched_item(struct rho_node *node, int64_t now_us)
{
    if (node->item.is_restart) {
        if (close_open_bearing_frame_to_be_stepped_later(node)) {
            return RHO_NODE_NOTHING;
        }
        node->item.is_restart = 0;
        reset_frames(node);
        return reset_search_and_tell_restart(node);
    }
    if (RHO_SCAN_ASSEMBLER_IS(node->item.kind, RHO_SCAN_ASSEMBLER_BEARINGS)) {
        push_bearings_into_frame_or_await_reset(node, now_us);
        return RHO_NODE_NOTHING;
    }
    return give_scan_or_let_wait(node);
}

/* 1 where the first scan after a snapshot is jump_max_us older: it is of another clock. */
static int is_item_of_another_clock(const struct rho_node *node)
{
    const struct rho_tracker *tracker = node->config.tracker;
    int64_t time_us = RHO_SCAN_ASSEMBLER_IS(node->item.kind, RHO_SCAN_ASSEMBLER_BEARINGS)
                          ? node->item.bearings.time_us
                          : node->item.scan.time_us;

    return node->is_restored && tracker->has_time &&
           time_us < tracker->time_us - node->config.assembler->config.jump_max_us;
}

/* Fetches a due scan, or closes a frame whose time has passed. Returns 0 where neither is due. */
static int fetch_item_or_close_frame(struct rho_node *node, int64_t now_us)
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
        node->item.is_restart |= is_item_of_another_clock(node);
        node->is_restored = 0;
        node->has_item = 1;
        return 1;
    }
    return room == ROOM_ENOUGH && now_us >= node->frame_due_us &&
           close_open_bearing_frame_to_be_stepped_later(node);
}

enum rho_node_due rho_node_next(struct rho_node *node, int64_t now_us)
{
    enum rho_node_due due = RHO_NODE_NOTHING;
    int has_more = is_initialised(node);

    if (has_more && now_us != INT64_MAX) {
        node->now_us = now_us;
    }
    while (has_more && due == RHO_NODE_NOTHING) {
        due = give_frame_or_waiting_scan(node);
        if (due == RHO_NODE_NOTHING && node->has_item) {
            due = take_fetched_item(node, now_us);
        } else if (due == RHO_NODE_NOTHING) {
            has_more = fetch_item_or_close_frame(node, now_us);
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

    if (!is_initialised(node)) {
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

    if (is_initialised(node)) {
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
    if (frames_or_null(node) && node->due == RHO_NODE_FRAME) {
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

/* Number of messages of tracks and peaks, which come before those of bodies. */
static uint16_t num_messages_without_bodies(const struct rho_node *node)
{
    return is_initialised(node) ? (uint16_t)(rho_publish_num_parts(node->config.report) + 1u) : 0;
}

uint16_t rho_node_num_messages(const struct rho_node *node)
{
    const uint16_t num_messages = num_messages_without_bodies(node);

    return RHO_BODIES && num_messages > 0
               ? (uint16_t)(num_messages +
                            rho_publish_num_body_parts(node->config.tracker, node->config.report))
               : num_messages;
}

const char *rho_node_channel(const struct rho_node *node, uint16_t part)
{
    if (RHO_BODIES && part >= num_messages_without_bodies(node)) {
        return RHO_MESSAGE_BODY_LIST_CHANNEL;
    }
    return part + 1u < num_messages_without_bodies(node) ? RHO_MESSAGE_TRACK_LIST_CHANNEL
                                                         : RHO_MESSAGE_PEAK_LIST_CHANNEL;
}

enum rho_status rho_node_publish(const struct rho_node *node, const struct rho_initiator *initiator,
                                 uint16_t part, uint8_t *buffer, size_t capacity, size_t *size)
{
    const struct rho_report *report;
    int is_frame;

    if (!is_initialised(node)) {
        return node ? RHO_ERROR_STATE : RHO_ERROR_NULL;
    }
    report = node->config.report;
    if (part < rho_publish_num_parts(report)) {
        return rho_publish_tracks(report, node->step, node->epoch, part, buffer, capacity, size);
    }
    if (part >= rho_node_num_messages(node)) {
        return RHO_ERROR_VALUE;
    }
    if (RHO_BODIES && part >= num_messages_without_bodies(node)) {
        return rho_publish_bodies(node->config.tracker, report, node->step, node->epoch,
                                  (uint16_t)(part - num_messages_without_bodies(node)), buffer,
                                  capacity, size);
    }
    is_frame = frames_or_null(node) && node->stepped == RHO_NODE_FRAME;
    return rho_publish_peaks(is_frame ? NULL : initiator, is_frame ? node->config.passive : NULL,
                             report->time_us, node->step, buffer, capacity, size);
}

void rho_node_status(struct rho_node *node, const struct rho_initiator *initiator,
                     struct rho_message_status *status)
{
    if (!is_initialised(node) || !status) {
        return;
    }
    rho_publish_status(node->config.assembler, frames_or_null(node), node->config.tracker,
                       initiator, status);
    status->scan = node->step;
    status->epoch = node->epoch;
    status->plots_in = rho_clamp_sum_to_int32(status->plots_in, node->counters.plots_refused);
    status->inputs_no_room =
        rho_clamp_sum_to_int32(status->inputs_no_room, node->counters.plots_refused);
    if (node->timing.steps > 0) {
        status->step_us = (float)node->timing.sum_us / (float)node->timing.steps;
        status->step_max_us = (float)node->timing.max_us;
    }
    node->timing = (struct rho_node_timing){0};
}

void rho_node_work(const struct rho_node *node, struct rho_message_work *work)
{
    if (is_initialised(node) && work) {
        rho_publish_work(node->config.tracker, work);
        work->scan = node->step;
        work->epoch = node->epoch;
        work->num_steps = node->counters.steps;
    }
}

int rho_node_learned(struct rho_node *node, struct rho_message_learned *learned)
{
    const struct rho_tracker *tracker = is_initialised(node) ? node->config.tracker : NULL;
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
