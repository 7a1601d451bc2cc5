/* SPDX-License-Identifier: MIT */
/*
 * recent_bearing_frames: the newest bearings, in N rows of a look of each sensor, in which the
 * passive initiators search for tracks.
 *
 * Each look has its own time and place: sensors may move, stand together, and look at times of
 * their own. A sensor keeps its index while it is heard; once it was silent for
 * RHO_LIMIT_OFFSET_US, another one may have it. A look goes into the newest row while that lacks
 * its sensor; in a row that waits for slower sensors it takes the place of its sensor's older look.
 * Embedded in the initiators; usable alone.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_RECENT_BEARING_FRAMES_H
#define RHOTRACK_RECENT_BEARING_FRAMES_H

#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/detail/bearing_crossing.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

/* fewest rows that are searched for tracks: two tell a velocity, and another one tests it */
#define RHO_BATCH_SCANS_MIN 3u

struct rho_batch_sensor {
    int64_t looked_us; /* time of the frame with its newest look */
    float x_m, y_m;    /* place at that look */
    int32_t sensor_id;
    uint32_t reserved; /* padding: 0 */
};

/* When and where a sensor looked. */
struct rho_batch_look {
    int32_t offset_us; /* time after that of its row */
    float x_m, y_m, z_m;
};

/* The track that has a bearing, and ln of its density, 1/rad, where the last one expected it. */
struct rho_batch_owner {
    uint32_t track_id; /* 0: no track's */
    float density_nat;
};

/* One bearing held in the batch, with its direction as cosine and sine. */
struct rho_batch_bearing {
    float cosine, sine, bearing_rad;
    float sigma_rad;
    float slope, sigma_slope; /* tangent of its elevation; sigma 0: not measured */
    struct rho_batch_owner owner;
};

/* 1: no track has taken the bearing so far. */
static inline int rho_batch_is_unclaimed(const struct rho_batch_bearing *bearing)
{
    return bearing->owner.track_id == 0 &&
           !(bearing->owner.density_nat < 0.0f || bearing->owner.density_nat > 0.0f);
}

struct rho_batch {
    uint16_t scans_max; /* capacity in rows: N */
    uint16_t num_sensors, num_scans;
    uint8_t is_whole;  /* 1: the newest row has a look of each sensor, or a frame of several */
    uint8_t is_due;    /* 1: the last push made a row whole, or ended one that was not */
    float apart_max_m; /* largest distance of two sensors that is accepted */
    uint32_t num_left; /* number of bearings of no track that the last push dropped */
    int64_t newest_us; /* time of the newest frame */
    struct rho_batch_sensor sensors[RHO_MAX_PASSIVE_SENSORS];
    /* times of the first looks of the rows, oldest first */
    int64_t time_us[RHO_MAX_PASSIVE_SCANS];
    struct rho_batch_look looks[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS];
    uint8_t num_bearings[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS];
    /* 1: the sensor looked in this row, also without bearings */
    uint8_t was_seen[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS];
    /* sector of each look, counter-clockwise from .. to; equal: the whole circle */
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
 * Tells whether rho_batch_push would take the frame. Errors: those of rho_batch_push, except NULL
 * for fates. Cost: sensors squared. Stack: 100 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_batch_accepts(const struct rho_batch *batch,
                                                 const struct rho_frame *frame);

/*
 * Adds a frame of one look or more to the batch; a full batch drops its oldest row.
 *   frame  a scan's time, 0: the frame's, is that of its bearings; their offsets are ignored
 *   fates  one for each bearing, in the order of the frame's scans; bearings with HELD are stored,
 *          or get INVALID (rho_bearing_is_valid) or NO_ROOM (beyond RHO_MAX_BEARINGS)
 *   owners NULL, or the tracks of the bearings in the same order: those with CLAIMED are stored too
 * Errors: NULL, STATE (older than the newest, or as old, of a sensor that is in it), CAPACITY (more
 * than RHO_MAX_PASSIVE_SENSORS that are heard), VALUE (a sensor twice in the frame, a sensor
 * farther than apart_max_m from another, or whose position is not a coordinate, a sector beyond one
 * turn either way, a scan more than RHO_LIMIT_OFFSET_US from its frame); nothing is changed. Cost:
 * the bearings, and moving the batch by a row. Stack: 230 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_batch_push(struct rho_batch *batch,
                                              const struct rho_frame *frame, uint8_t *fates,
                                              const struct rho_batch_owner *owners);

/*
 * True if the object is valid, whatever its bytes come from (a snapshot, memory that outlived a
 * reset): counts and indices are within their arrays, numbers within their limits.
 * rho_snapshot_load asks it. Cost: all bearings held.
 */
int rho_batch_is_sound(const struct rho_batch *batch);

RHO_END_C

#endif
