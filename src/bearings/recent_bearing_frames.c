/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/recent_bearing_frames.h"

#include <string.h>

#include "policy.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"

static uint64_t apart_us(int64_t a_us, int64_t b_us)
{
    return a_us > b_us ? (uint64_t)a_us - (uint64_t)b_us : (uint64_t)b_us - (uint64_t)a_us;
}

enum rho_status rho_batch_init(struct rho_batch *batch, unsigned scans_max,
                               float sensor_distance_max_m)
{
    if (!batch) {
        return RHO_ERROR_NULL;
    }
    if (scans_max < 1 || scans_max > RHO_MAX_PASSIVE_SCANS ||
        !rho_is_within(sensor_distance_max_m, RHO_CROSSING_BASE_MIN_M,
                       4.0f * RHO_LIMIT_POSITION_M)) {
        return RHO_ERROR_CONFIG;
    }
    memset(batch, 0, sizeof *batch);
    batch->scans_max = (uint16_t)scans_max;
    batch->apart_max_m = sensor_distance_max_m;
    return RHO_OK;
}

static float distance_m(float x_m, float y_m, float other_x_m, float other_y_m)
{
    float dx_m = other_x_m - x_m, dy_m = other_y_m - y_m;
    return rho_sqrt(dx_m * dx_m + dy_m * dy_m);
}

/* A silent sensor's index is free for another one, and no row waits for it. */
static int is_heard(const struct rho_batch_sensor *sensor, int64_t time_us)
{
    return apart_us(sensor->looked_us, time_us) <= RHO_LIMIT_OFFSET_US;
}

static unsigned count_heard(const struct rho_batch *batch, int64_t time_us)
{
    unsigned num = 0;
    for (unsigned s = 0; s < batch->num_sensors; s++) {
        num += (unsigned)is_heard(&batch->sensors[s], time_us);
    }
    return num;
}

/* Index of the sensor, known or not; RHO_MAX_PASSIVE_SENSORS: all are of sensors that are heard. */
static unsigned find_sensor(const struct rho_batch *batch, int32_t sensor_id, int64_t time_us)
{
    unsigned place = batch->num_sensors;
    for (unsigned s = 0; s < batch->num_sensors; s++) {
        if (batch->sensors[s].sensor_id == sensor_id) {
            return s;
        }
        if (place == RHO_MAX_PASSIVE_SENSORS && !is_heard(&batch->sensors[s], time_us)) {
            place = s;
        }
    }
    return place;
}

/* A sensor must be near enough to the others, and in a frame once; more than four share less. */
static int is_sensor_usable(const struct rho_batch *batch, const struct rho_frame *frame,
                            uint32_t scan_number)
{
    const struct rho_bearing_scan *scan = &frame->scans[scan_number];
    if (!rho_is_coordinate(scan->x_m) || !rho_is_coordinate(scan->y_m) ||
        !rho_is_coordinate(scan->z_m) ||
        (scan->time_us != 0 && apart_us(frame->time_us, scan->time_us) > RHO_LIMIT_OFFSET_US)) {
        return 0;
    }
    const unsigned heard = count_heard(batch, frame->time_us);
    const unsigned num = frame->num_scans > heard ? frame->num_scans : heard;
    const float n = rho_larger(4.0f, (float)num);
    const float apart_max_m = batch->apart_max_m * 0.5f * n / (n - 2.0f);
    for (unsigned i = 0; i < batch->num_sensors; i++) {
        const struct rho_batch_sensor *other = &batch->sensors[i];
        if (scan->sensor_id != other->sensor_id && is_heard(other, frame->time_us) &&
            !(distance_m(scan->x_m, scan->y_m, other->x_m, other->y_m) <= apart_max_m)) {
            return 0;
        }
    }
    for (uint32_t i = 0; i < scan_number; i++) {
        const struct rho_bearing_scan *other = &frame->scans[i];
        if (other->sensor_id == scan->sensor_id ||
            !(distance_m(scan->x_m, scan->y_m, other->x_m, other->y_m) <= apart_max_m)) {
            return 0;
        }
    }
    return 1;
}

enum rho_status rho_batch_accepts(const struct rho_batch *batch, const struct rho_frame *frame)
{
    if (!batch || !frame || (frame->num_scans > 0 && !frame->scans)) {
        return RHO_ERROR_NULL;
    }
    if (batch->num_scans > 0 && frame->time_us < batch->newest_us) {
        return RHO_ERROR_STATE;
    }
    unsigned num_sensors = count_heard(batch, frame->time_us);
    for (uint32_t i = 0; i < frame->num_scans; i++) {
        const struct rho_bearing_scan *scan = &frame->scans[i];
        if (scan->num_bearings > 0 && !scan->bearings) {
            return RHO_ERROR_NULL;
        }
        if (!is_sensor_usable(batch, frame, i) ||
            !rho_angle_is_valid_sector(scan->sector_from_rad, scan->sector_to_rad)) {
            return RHO_ERROR_VALUE;
        }
        const unsigned s = find_sensor(batch, scan->sensor_id, frame->time_us);
        const int is_known = s < batch->num_sensors && is_heard(&batch->sensors[s], frame->time_us);
        if (is_known && batch->sensors[s].looked_us == frame->time_us) {
            return RHO_ERROR_STATE;
        }
        num_sensors += !is_known;
        if (num_sensors > RHO_MAX_PASSIVE_SENSORS) {
            return RHO_ERROR_CAPACITY;
        }
    }
    return RHO_OK;
}

/*
 * Longest time between a sensor's two newest looks, but not far above the shortest: one that looks
 * now and then keeps no row open. 0: none has looked twice.
 */
static float longest_interval_s(const struct rho_batch *batch)
{
    float longest_s = 0.0f, shortest_s = 1e9f;
    for (unsigned s = 0; s < batch->num_sensors; s++) {
        int64_t newer_us = INT64_MAX;
        for (unsigned k = batch->num_scans; k-- > 0;) {
            if (!batch->was_seen[k][s]) {
                continue;
            }
            const int64_t time_us = batch->time_us[k] + batch->looks[k][s].offset_us;
            if (newer_us != INT64_MAX) {
                const float interval_s = rho_seconds_between(time_us, newer_us);
                longest_s = rho_larger(longest_s, interval_s);
                shortest_s = interval_s > 0.0f ? rho_smaller(shortest_s, interval_s) : shortest_s;
                break;
            }
            newer_us = time_us;
        }
    }
    return rho_smaller(longest_s, ROW_RATIO * shortest_s);
}

static int has_looks_of_all(const struct rho_batch *batch, unsigned scan)
{
    unsigned s = 0;
    while (s < batch->num_sensors &&
           (batch->was_seen[scan][s] || !is_heard(&batch->sensors[s], batch->newest_us))) {
        s++;
    }
    return s == batch->num_sensors;
}

/*
 * Whether a frame goes into the newest row: that lacks its sensors, or others, and is younger than
 * the longest interval of a sensor, so that a dead one keeps no row open.
 */
static int joins_newest_row(const struct rho_batch *batch, const struct rho_frame *frame)
{
    const unsigned newest = batch->num_scans - 1u;
    if (batch->num_scans == 0) {
        return 0;
    }
    int is_lacking = 1;
    for (uint32_t i = 0; i < frame->num_scans; i++) {
        const unsigned s = find_sensor(batch, frame->scans[i].sensor_id, frame->time_us);
        is_lacking &= s >= batch->num_sensors || !batch->was_seen[newest][s];
    }
    const float age_s = rho_seconds_between(batch->time_us[newest], frame->time_us);
    const float interval_s = longest_interval_s(batch);
    return apart_us(batch->time_us[newest], frame->time_us) < RHO_LIMIT_OFFSET_US &&
           (!(interval_s > 0.0f) || age_s < ROW_INTERVALS * interval_s) &&
           (is_lacking || !has_looks_of_all(batch, newest));
}

/* Counts the bearings without an owner that leave a look. */
static void count_left(struct rho_batch *batch, unsigned scan, unsigned sensor)
{
    for (unsigned i = 0; i < batch->num_bearings[scan][sensor]; i++) {
        batch->num_left += (uint32_t)rho_batch_is_unclaimed(&batch->bearings[scan][sensor][i]);
    }
}

/* Index of a scan's sensor: what another one had at it goes. */
static unsigned give_index(struct rho_batch *batch, const struct rho_bearing_scan *scan)
{
    const unsigned s = find_sensor(batch, scan->sensor_id, batch->newest_us);
    if (s == batch->num_sensors) {
        batch->num_sensors++;
    } else if (batch->sensors[s].sensor_id != scan->sensor_id) {
        for (unsigned k = 0; k < batch->num_scans; k++) {
            count_left(batch, k, s);
            batch->num_bearings[k][s] = batch->was_seen[k][s] = 0;
            batch->looks[k][s] = (struct rho_batch_look){.offset_us = 0};
        }
    }
    batch->sensors[s] = (struct rho_batch_sensor){.looked_us = batch->newest_us,
                                                  .sensor_id = scan->sensor_id,
                                                  .x_m = scan->x_m,
                                                  .y_m = scan->y_m};
    return s;
}

/* Stores a scan, and those of its bearings to be held; others it refuses get their fate. */
static void store_scan(struct rho_batch *batch, const struct rho_bearing_scan *scan, uint8_t *fates,
                       const struct rho_batch_owner *owners)
{
    const unsigned k = batch->num_scans - 1u, s = give_index(batch, scan);
    const int64_t time_us = scan->time_us != 0 ? scan->time_us : batch->newest_us;
    batch->looks[k][s] =
        (struct rho_batch_look){.offset_us = (int32_t)(time_us - batch->time_us[k]),
                                .x_m = scan->x_m,
                                .y_m = scan->y_m,
                                .z_m = scan->z_m};
    count_left(batch, k, s);
    batch->num_bearings[k][s] = 0;
    batch->was_seen[k][s] = 1;
    batch->sector_from_rad[k][s] = scan->sector_from_rad;
    batch->sector_to_rad[k][s] = scan->sector_to_rad;
    for (uint32_t i = 0; i < scan->num_bearings; i++) {
        const struct rho_bearing *from = &scan->bearings[i];
        uint8_t *count = &batch->num_bearings[k][s];
        if (fates[i] != RHO_FATE_HELD && !(owners && fates[i] == RHO_FATE_CLAIMED)) {
            continue;
        }
        if (!rho_bearing_is_valid(from)) {
            fates[i] = RHO_FATE_INVALID;
        } else if (*count == RHO_MAX_BEARINGS) {
            fates[i] = RHO_FATE_NO_ROOM;
        } else {
            const struct rho_slope slope = rho_measurement_slope(scan, from);
            batch->bearings[k][s][(*count)++] = (struct rho_batch_bearing){
                .cosine = rho_cos(from->bearing_rad),
                .sine = rho_sin(from->bearing_rad),
                .bearing_rad = from->bearing_rad,
                .sigma_rad = from->sigma_rad,
                .slope = slope.value,
                .sigma_slope = slope.sigma,
                .owner = owners ? owners[i] : (struct rho_batch_owner){0, 0.0f}};
        }
    }
}

/* Begins a row at this time; a full batch drops its oldest. */
static void begin_row(struct rho_batch *batch, int64_t time_us)
{
    if (batch->num_scans == batch->scans_max) {
        size_t left = (size_t)batch->num_scans - 1u;
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            count_left(batch, 0, s);
        }
        memmove(batch->time_us, batch->time_us + 1, left * sizeof batch->time_us[0]);
        memmove(batch->looks, batch->looks + 1, left * sizeof batch->looks[0]);
        memmove(batch->num_bearings, batch->num_bearings + 1, left * sizeof batch->num_bearings[0]);
        memmove(batch->was_seen, batch->was_seen + 1, left * sizeof batch->was_seen[0]);
        memmove(batch->sector_from_rad, batch->sector_from_rad + 1,
                left * sizeof batch->sector_from_rad[0]);
        memmove(batch->sector_to_rad, batch->sector_to_rad + 1,
                left * sizeof batch->sector_to_rad[0]);
        memmove(batch->bearings, batch->bearings + 1, left * sizeof batch->bearings[0]);
        batch->num_scans--;
    }
    unsigned k = batch->num_scans++;
    batch->time_us[k] = time_us;
    memset(batch->looks[k], 0, sizeof batch->looks[k]);
    memset(batch->num_bearings[k], 0, sizeof batch->num_bearings[k]);
    memset(batch->was_seen[k], 0, sizeof batch->was_seen[k]);
}

enum rho_status rho_batch_push(struct rho_batch *batch, const struct rho_frame *frame,
                               uint8_t *fates, const struct rho_batch_owner *owners)
{
    enum rho_status status = rho_batch_accepts(batch, frame);
    if (status != RHO_OK) {
        return status;
    }
    if (frame->num_scans > 0 && !fates) {
        return RHO_ERROR_NULL;
    }
    batch->num_left = 0;
    const int joins = joins_newest_row(batch, frame);
    batch->is_due = !joins && batch->num_scans > 0 && !batch->is_whole;
    if (!joins) {
        begin_row(batch, frame->time_us);
    }
    batch->newest_us = frame->time_us;
    for (uint32_t i = 0; i < frame->num_scans; i++) {
        store_scan(batch, &frame->scans[i], fates, owners);
        fates += frame->scans[i].num_bearings;
        owners = owners ? owners + frame->scans[i].num_bearings : 0;
    }
    batch->is_whole = (joins && batch->is_whole) || frame->num_scans > 1 ||
                      has_looks_of_all(batch, batch->num_scans - 1u);
    batch->is_due |= batch->is_whole && frame->num_scans > 0;
    return RHO_OK;
}

static int is_sound_look(const struct rho_batch *batch, unsigned scan, unsigned sensor)
{
    const struct rho_batch_look *look = &batch->looks[scan][sensor];
    if (batch->num_bearings[scan][sensor] > RHO_MAX_BEARINGS || batch->was_seen[scan][sensor] > 1 ||
        look->offset_us > 2 * RHO_LIMIT_OFFSET_US || look->offset_us < -RHO_LIMIT_OFFSET_US ||
        !rho_is_coordinate(look->x_m) || !rho_is_coordinate(look->y_m) ||
        !rho_is_coordinate(look->z_m) ||
        !rho_angle_is_valid_sector(batch->sector_from_rad[scan][sensor],
                                   batch->sector_to_rad[scan][sensor])) {
        return 0;
    }
    for (unsigned i = 0; i < batch->num_bearings[scan][sensor]; i++) {
        const struct rho_batch_bearing *bearing = &batch->bearings[scan][sensor][i];
        if (!rho_is_within(bearing->cosine, -1.01f, 1.01f) ||
            !rho_is_within(bearing->sine, -1.01f, 1.01f) ||
            !rho_is_within(bearing->bearing_rad, -10.0f, 10.0f) ||
            !rho_is_within(bearing->slope, -10.0f, 10.0f) ||
            !rho_is_within(bearing->sigma_slope, 0.0f, 100.0f) ||
            !rho_is_within(bearing->owner.density_nat, -1.0e6f, 1.0e6f) ||
            !rho_is_within(bearing->sigma_rad, RHO_LIMIT_SIGMA_RAD_MIN, RHO_LIMIT_SIGMA_RAD_MAX)) {
            return 0;
        }
    }
    return 1;
}

int rho_batch_is_sound(const struct rho_batch *batch)
{
    if (batch->scans_max < 1 || batch->scans_max > RHO_MAX_PASSIVE_SCANS ||
        batch->num_scans > batch->scans_max || batch->is_whole > 1 || batch->is_due > 1 ||
        batch->num_sensors > RHO_MAX_PASSIVE_SENSORS ||
        (batch->num_scans > 0 &&
         apart_us(batch->time_us[batch->num_scans - 1u], batch->newest_us) > RHO_LIMIT_OFFSET_US) ||
        !rho_is_within(batch->apart_max_m, RHO_CROSSING_BASE_MIN_M, 4.0f * RHO_LIMIT_POSITION_M)) {
        return 0;
    }
    for (unsigned i = 0; i < batch->num_sensors; i++) {
        const struct rho_batch_sensor *sensor = &batch->sensors[i];
        if (!rho_is_coordinate(sensor->x_m) || !rho_is_coordinate(sensor->y_m) ||
            sensor->looked_us > batch->newest_us) {
            return 0;
        }
    }
    for (unsigned k = 0; k < batch->num_scans; k++) {
        if ((k > 0 && batch->time_us[k] <= batch->time_us[k - 1]) ||
            rho_seconds_between(batch->time_us[k], batch->newest_us) < 0.0f) {
            return 0;
        }
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            if (!is_sound_look(batch, k, s)) {
                return 0;
            }
        }
    }
    return 1;
}
