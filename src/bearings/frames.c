/* SPDX-License-Identifier: MIT */
#include "rhotrack/frames.h"

#include <string.h>

#include "rhotrack/detail/angle.h"

enum { FRAMES_MAGIC = 0x46524d53 }; /* "FRMS" in ASCII */

#define SECOND_US INT64_C(1000000)

void rho_frames_config_default(struct rho_frames_config *config)
{
    *config = (struct rho_frames_config){.tolerance_us = 50000,
                                         .jump_max_us = 30 * SECOND_US,
                                         .follow_scans = 4,
                                         .silent_frames = 3,
                                         .sensors_min = 2};
}

enum rho_status rho_frames_init(struct rho_frames *frames, size_t object_size,
                                const struct rho_frames_config *config)
{
    if (!frames || !config) {
        return RHO_ERROR_NULL;
    }
    if (object_size != sizeof *frames) {
        return RHO_ERROR_SIZE;
    }
    if (config->tolerance_us < 0 || config->tolerance_us > 10 * SECOND_US ||
        config->jump_max_us <= config->tolerance_us || config->jump_max_us > 3600 * SECOND_US ||
        config->follow_scans < 2 || config->follow_scans > UINT8_MAX || config->silent_frames < 1 ||
        config->silent_frames > UINT8_MAX || config->sensors_min < 2 ||
        config->sensors_min > RHO_MAX_PASSIVE_SENSORS) {
        return RHO_ERROR_CONFIG;
    }
    /* the caller's config may lie within *frames, which is cleared */
    struct rho_frames_config kept = *config;
    memset(frames, 0, sizeof *frames);
    frames->magic = FRAMES_MAGIC;
    frames->config.tolerance_us = kept.tolerance_us; /* no padding of the caller's */
    frames->config.jump_max_us = kept.jump_max_us;
    frames->config.follow_scans = kept.follow_scans;
    frames->config.silent_frames = kept.silent_frames;
    frames->config.sensors_min = kept.sensors_min;
    frames->closed_us = INT64_MIN;
    return RHO_OK;
}

/* Index of the sensor with this sensor_id in the frames object; num_sensors: it has none. */
static unsigned find_sensor(const struct rho_frames *frames, int32_t sensor_id)
{
    unsigned i = 0;
    while (i < frames->num_sensors && frames->sensors[i].sensor_id != sensor_id) {
        i++;
    }
    return i;
}

/* Finds or adds the sensor of a scan, which is no longer silent. */
static unsigned hear_sensor(struct rho_frames *frames, const struct rho_bearing_scan *scan)
{
    unsigned i = find_sensor(frames, scan->sensor_id);
    struct rho_frames_sensor *sensor = &frames->sensors[i];
    if (i == frames->num_sensors) {
        frames->num_sensors++;
        sensor->sensor_id = scan->sensor_id;
    }
    sensor->x_m = scan->x_m;
    sensor->y_m = scan->y_m;
    sensor->silent = 0;
    return i;
}

static enum rho_status check_scan(const struct rho_frames *frames,
                                  const struct rho_bearing_scan *scan)
{
    if (scan->num_bearings > 0 && !scan->bearings) {
        return RHO_ERROR_NULL;
    }
    if (scan->time_us < -RHO_LIMIT_TIME_US || scan->time_us > RHO_LIMIT_TIME_US ||
        !rho_angle_is_valid_sector(scan->sector_from_rad, scan->sector_to_rad) ||
        !rho_is_coordinate(scan->x_m) || !rho_is_coordinate(scan->y_m) ||
        !rho_is_coordinate(scan->z_m)) {
        return RHO_ERROR_VALUE;
    }
    return find_sensor(frames, scan->sensor_id) < RHO_MAX_PASSIVE_SENSORS ? RHO_OK
                                                                          : RHO_ERROR_CAPACITY;
}

static int has_scan_of(const struct rho_frames_slot *slot, unsigned sensor)
{
    for (unsigned i = 0; i < slot->num_scans; i++) {
        if (slot->scans[i].sensor == sensor) {
            return 1;
        }
    }
    return 0;
}

/* The open frame, if it has scans, becomes the closed one; the other slot is emptied and opened. */
static void close_open_frame(struct rho_frames *frames)
{
    const struct rho_frames_slot *slot = &frames->slots[frames->open];
    struct rho_frames_counters *counters = &frames->counters;
    if (slot->num_scans == 0) {
        return;
    }
    for (unsigned i = 0; i < frames->num_sensors; i++) {
        struct rho_frames_sensor *sensor = &frames->sensors[i];
        if (!has_scan_of(slot, i)) {
            sensor->missing = rho_count(sensor->missing, 1);
            sensor->silent = rho_count(sensor->silent, 1);
        }
    }
    counters->frames_incomplete =
        rho_count(counters->frames_incomplete, slot->num_scans < frames->num_sensors);
    counters->frames = rho_count(counters->frames, 1);
    frames->closed_us = slot->time_us;
    frames->has_closed = 1;
    frames->open = frames->open ^ 1u;
    memset(&frames->slots[frames->open], 0, sizeof frames->slots[0]);
}

/*
 * Adds the scan, with its first RHO_MAX_BEARINGS bearings, to the open frame, and closes the frame
 * if it then has sensors_min scans, and one of every sensor that is expected.
 */
static void frame_add_scan(struct rho_frames *frames, const struct rho_bearing_scan *scan)
{
    struct rho_frames_slot *slot = &frames->slots[frames->open];
    struct rho_frames_counters *counters = &frames->counters;
    int is_first = slot->num_scans == 0;
    struct rho_frames_scan *to = &slot->scans[slot->num_scans++];
    uint32_t count = scan->num_bearings < RHO_MAX_BEARINGS ? scan->num_bearings : RHO_MAX_BEARINGS;
    to->x_m = scan->x_m;
    to->y_m = scan->y_m;
    to->z_m = scan->z_m;
    to->sensor = (uint16_t)hear_sensor(frames, scan);
    to->time_us = scan->time_us;
    to->sector_from_rad = scan->sector_from_rad;
    to->sector_to_rad = scan->sector_to_rad;
    to->num_bearings = (uint16_t)count;
    if (count > 0) {
        memcpy(to->bearings, scan->bearings, count * sizeof to->bearings[0]);
    }
    counters->bearings_no_room = rho_count(counters->bearings_no_room, scan->num_bearings - count);
    slot->time_us = is_first || scan->time_us < slot->time_us ? scan->time_us : slot->time_us;
    slot->last_us = is_first || scan->time_us > slot->last_us ? scan->time_us : slot->last_us;
    frames->clock_us = scan->time_us;
    counters->scans_taken = rho_count(counters->scans_taken, 1);
    int is_complete = slot->num_scans >= frames->config.sensors_min;
    for (unsigned i = 0; i < frames->num_sensors; i++) {
        is_complete &=
            frames->sensors[i].silent >= frames->config.silent_frames || has_scan_of(slot, i);
    }
    if (is_complete) {
        close_open_frame(frames);
    }
}

/* Adds a scan to the open frame or a new one; a scan older than its frame is counted as late. */
static void frame_take_scan(struct rho_frames *frames, const struct rho_bearing_scan *scan)
{
    const struct rho_frames_slot *slot = &frames->slots[frames->open];
    int64_t first_us = scan->time_us < slot->time_us ? scan->time_us : slot->time_us;
    int64_t last_us = scan->time_us > slot->last_us ? scan->time_us : slot->last_us;
    int is_joining = slot->num_scans > 0 && last_us - first_us <= frames->config.tolerance_us &&
                     !has_scan_of(slot, find_sensor(frames, scan->sensor_id));
    int is_newer = slot->num_scans == 0 || scan->time_us > slot->time_us;
    if (scan->time_us <= frames->closed_us || (!is_joining && !is_newer)) {
        (void)hear_sensor(frames, scan);
        frames->counters.scans_late = rho_count(frames->counters.scans_late, 1);
        return;
    }
    if (!is_joining) {
        close_open_frame(frames);
    }
    frame_add_scan(frames, scan);
}

enum rho_status rho_frames_push(struct rho_frames *frames, const struct rho_bearing_scan *scan)
{
    if (!frames || !scan) {
        return RHO_ERROR_NULL;
    }
    if (frames->magic != FRAMES_MAGIC) {
        return RHO_ERROR_STATE;
    }
    enum rho_status status = check_scan(frames, scan);
    if (status != RHO_OK) {
        return status;
    }
    frames->has_closed = 0;
    /* cannot overflow: times are within RHO_LIMIT_TIME_US */
    int64_t ahead_us = scan->time_us - frames->clock_us, jump_us = frames->config.jump_max_us;
    if (frames->counters.scans_taken == 0 || (ahead_us <= jump_us && -ahead_us <= jump_us)) {
        frames->off_clock = (uint16_t)(frames->off_clock - (frames->off_clock > 0));
        frame_take_scan(frames, scan);
    } else if (frames->off_clock < frames->config.follow_scans) {
        frames->off_clock++;
        frames->counters.scans_off_clock = rho_count(frames->counters.scans_off_clock, 1);
    } else {
        /* the clock has jumped: a frame starts with this scan */
        close_open_frame(frames);
        frames->closed_us = INT64_MIN;
        frames->off_clock = 0;
        frames->counters.clock_jumps = rho_count(frames->counters.clock_jumps, 1);
        frames->slots[frames->open].is_restart = 1;
        frame_add_scan(frames, scan);
    }
    return RHO_OK;
}

enum rho_status rho_frames_close(struct rho_frames *frames)
{
    if (!frames) {
        return RHO_ERROR_NULL;
    }
    if (frames->magic != FRAMES_MAGIC) {
        return RHO_ERROR_STATE;
    }
    frames->has_closed = 0;
    close_open_frame(frames);
    return RHO_OK;
}

int rho_frames_closed(const struct rho_frames *frames, struct rho_frame_view *view)
{
    if (!view) {
        return 0;
    }
    memset(view, 0, sizeof *view);
    if (!frames || frames->magic != FRAMES_MAGIC || !frames->has_closed) {
        return 0;
    }
    const struct rho_frames_slot *slot = &frames->slots[frames->open ^ 1u];
    for (unsigned i = 0; i < slot->num_scans; i++) {
        const struct rho_frames_scan *from = &slot->scans[i];
        const struct rho_frames_sensor *sensor = &frames->sensors[from->sensor];
        unsigned place = i;
        for (; place > 0 && view->scans[place - 1u].sensor_id > sensor->sensor_id; place--) {
            view->scans[place] = view->scans[place - 1u];
        }
        view->scans[place] = (struct rho_bearing_scan){.time_us = from->time_us,
                                                       .sensor_id = sensor->sensor_id,
                                                       .x_m = from->x_m,
                                                       .y_m = from->y_m,
                                                       .z_m = from->z_m,
                                                       .sector_from_rad = from->sector_from_rad,
                                                       .sector_to_rad = from->sector_to_rad,
                                                       .num_bearings = from->num_bearings,
                                                       .bearings = from->bearings};
    }
    view->frame.time_us = slot->time_us;
    view->frame.num_scans = slot->num_scans;
    view->frame.scans = view->scans;
    view->is_restart = slot->is_restart;
    return 1;
}
