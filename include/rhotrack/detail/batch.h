/* SPDX-License-Identifier: MIT */
/*
 * batch: the bearings of the last N frames, by scan and sensor.
 *
 * The passive initiators search it. A frame has the scans of several sensors at one time. A sensor
 * is known from its first scan on, does not move, and keeps its index. Embedded in the initiators;
 * usable alone.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_BATCH_H
#define RHOTRACK_BATCH_H

#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/detail/crossing.h"
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

struct rho_batch_sensor {
    int32_t sensor_id;
    float x_m, y_m;
};

/* One held bearing. */
struct rho_batch_bearing {
    float cosine, sine, bearing_rad;
    float sigma_rad;
};

struct rho_batch {
    uint16_t scans_max; /* N */
    uint16_t num_sensors, num_scans;
    float apart_max_m; /* largest distance of two sensors */
    uint32_t num_left; /* bearings that the last push dropped with the oldest frame */
    struct rho_batch_sensor sensors[RHO_MAX_PASSIVE_SENSORS];
    /* the last scans, oldest first */
    int64_t time_us[RHO_MAX_PASSIVE_SCANS];
    uint8_t num_bearings[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS];
    uint8_t was_seen[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS]; /* the sensor reported */
    /* of each look, counter-clockwise from .. to; equal: the whole circle */
    float sector_from_rad[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS];
    float sector_to_rad[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS];
    struct rho_batch_bearing bearings[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS]
                                     [RHO_MAX_BEARINGS];
};

/*
 * Prepares an empty batch of scans_max scans; sensors farther apart than apart_max_m are refused.
 * Errors: NULL, CONFIG (scans_max not 1 .. RHO_MAX_PASSIVE_SCANS, apart_max_m not
 * RHO_CROSSING_BASE_MIN_M .. 4 RHO_LIMIT_POSITION_M). Cost: sizeof(batch) bytes cleared.
 */
RHO_MUST_CHECK enum rho_status rho_batch_init(struct rho_batch *batch, unsigned scans_max,
                                              float apart_max_m);

/*
 * Whether rho_batch_push takes the frame: its errors, but for fates. Cost: sensors squared.
 * Stack: 100 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_batch_accepts(const struct rho_batch *batch,
                                                 const struct rho_frame *frame);

/*
 * Takes a frame; the oldest leaves when the batch is full.
 *   frame  its time counts for all its bearings, offsets do not
 *   fates  one a bearing, in the order of the frame's scans; HELD ones are taken; INVALID
 *          (rho_measurement_is_bearing) and NO_ROOM (beyond RHO_MAX_BEARINGS) ones are not
 * Errors: NULL, STATE (the frame is not newer than the newest), CAPACITY (more sensors than
 * RHO_MAX_PASSIVE_SENSORS), VALUE (a sensor twice in the frame, a sensor that has moved,
 * nearer than RHO_CROSSING_BASE_MIN_M or farther than apart_max_m from another, its place not a
 * coordinate, a sector beyond one turn either way); nothing is changed. Cost: the bearings, and the
 * batch moved by a frame.
 * Stack: 150 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_batch_push(struct rho_batch *batch,
                                              const struct rho_frame *frame, uint8_t *fates);

/*
 * Removes bearings.
 *   claim  by scan and sensor: index of the bearing among those held, from 1; 0: none
 * Indices stay valid until rho_batch_compact, so that several claims can be removed; until then a
 * removed bearing has a sigma_rad of 0. Returns how many were removed. Cost: scans times sensors.
 */
uint32_t rho_batch_remove(struct rho_batch *batch,
                          const uint8_t claim[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS]);

/* Closes the gaps that removed bearings left. Cost: the bearings. */
void rho_batch_compact(struct rho_batch *batch);

/*
 * True if the object is valid, whatever its bytes come from (a snapshot, memory that outlived a
 * reset): counts and indices are within their arrays, numbers within their limits.
 * rho_snapshot_load asks it. Cost: all bearings held.
 */
int rho_batch_is_sound(const struct rho_batch *batch);

#ifdef __cplusplus
}
#endif

#endif
