/* SPDX-License-Identifier: MIT */
/*
 * frames: scans of single passive sensors, as they arrive, into frames.
 *
 *     while (a scan has come) {
 *         if (rho_frames_push(&frames, &scan) == RHO_OK && rho_frames_closed(&frames, &view)) {
 *             use(&view.frame);
 *         }
 *     }
 *
 * Scans of different sensors are one frame where they lie within tolerance_us of the earliest of them, in whatever
 * order they arrive. A frame closes
 *   - with the scan of the last sensor that is waited for, or
 *   - when a scan comes that cannot be one of its: beyond the tolerance, or of a sensor that is in it, or
 *   - when the caller says so (rho_frames_close): the end, or time has moved on and nothing came.
 * Its scans are in the order of sensor_id, its time is the earliest of theirs. Frames' times rise. One closes at a push
 * at most.
 *
 * Sensors are known from their first scan on, and are waited for. One that was missing in silent_frames frames in a row
 * is not, until it reports again: a dead sensor delays that many frames until the next scan comes, and no more.
 *
 * Late: a scan not later than the frame that was closed last, or too old for the open one. It is counted and left out;
 * its sensor is waited for again, so that a sensor that comes last is not late for ever.
 *
 * The clock is that of the last scan taken. A scan more than jump_max_us off it, ahead or back, is left out and
 * counted, so that one sensor with a wrong clock does not make all others late; once such scans have outnumbered the
 * others by follow_scans, the next one is followed and the frames start anew at its time (is_restart). Most sensors
 * decide; with two of them, the one that came first. A clock that is ahead by more than the scan interval but less than
 * jump_max_us makes the other sensors late for as long as it goes on: scans_late tells.
 *
 * The object holds no pointers: a memcpy is a snapshot.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_FRAMES_H
#define RHOTRACK_FRAMES_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/status.h"
#include "rhotrack/types.h"

struct rho_frames_config {
    int64_t tolerance_us;   /* from a frame's first scan to its last: 0 .. 10 s */
    int64_t jump_max_us;    /* longer than a scan interval: above tolerance_us .. 1 h */
    uint16_t follow_scans;  /* 2 .. 255 */
    uint16_t silent_frames; /* 1 .. 255 */
    uint16_t sensors_min;   /* fewer are no complete frame: 2 .. RHO_MAX_PASSIVE_SENSORS */
};

/* Since init; all saturate. Scans taken are in a frame, closed or open. */
struct rho_frames_counters {
    uint32_t scans_taken, scans_late, scans_off_clock;
    uint32_t frames;            /* closed */
    uint32_t frames_incomplete; /* a known sensor is missing in them */
    uint32_t clock_jumps;       /* followed */
    uint32_t bearings_no_room;  /* of a scan beyond RHO_MAX_BEARINGS: its last ones */
};

struct rho_frames_sensor {
    int32_t sensor_id;
    float x_m, y_m;
    uint32_t missing; /* frames closed without it; saturates */
    uint32_t silent;  /* the last ones of them, in a row */
};

/* One scan of a frame. */
struct rho_frames_scan {
    int64_t time_us;
    float sector_from_rad, sector_to_rad;
    uint16_t sensor; /* its place in sensors */
    uint16_t num_bearings;
    struct rho_bearing bearings[RHO_MAX_BEARINGS];
};

/* A frame as it is kept. */
struct rho_frames_slot {
    int64_t time_us; /* the earliest of its scans */
    int64_t last_us; /* the latest */
    uint16_t num_scans;
    uint16_t is_restart;
    uint32_t reserved;                                     /* 0 */
    struct rho_frames_scan scans[RHO_MAX_PASSIVE_SENSORS]; /* as they came */
};

struct rho_frames {
    uint32_t magic;
    uint16_t num_sensors;
    uint16_t off_clock;  /* scans, less those that were not */
    uint16_t open;       /* slot of the open frame; none is open where it has no scans */
    uint16_t has_closed; /* the last call closed the other slot */
    uint32_t reserved;   /* 0 */
    int64_t clock_us;    /* of the last scan taken */
    int64_t closed_us;   /* of the frame closed last; INT64_MIN: none since the start */
    struct rho_frames_config config;
    struct rho_frames_counters counters;
    struct rho_frames_sensor sensors[RHO_MAX_PASSIVE_SENSORS];
    struct rho_frames_slot slots[2];
};

/* A closed frame to read: it points into itself, and into the object for the bearings. Not to be copied. */
struct rho_frame_view {
    struct rho_frame frame;
    struct rho_bearing_scan scans[RHO_MAX_PASSIVE_SENSORS];
    int is_restart; /* the clock was set: what was made of earlier frames does not go on; the time may have gone back */
};

/* tolerance 50 ms, jump_max 30 s, follow_scans 4, silent_frames 3, sensors_min 2. Constant cost. */
void rho_frames_config_default(struct rho_frames_config *config);

/*
 * Prepares an object without frames; the config is copied.
 *   size   sizeof(struct rho_frames) of the caller
 * Errors: NULL, SIZE, CONFIG (any field outside its range). Cost: sizeof(frames) bytes cleared. Stack: 120 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_frames_init(struct rho_frames *frames, size_t size,
                                               const struct rho_frames_config *config);

/*
 * Takes a scan; its bearings are copied. The frame that was closed before is gone.
 *   scan  not of this object's own frames; its bearings are not looked into: whoever takes the frame checks them
 * Errors: NULL, STATE (not initialised), VALUE (a time beyond RHO_LIMIT_TIME_US, a sector beyond one turn either way, a
 * place that is no coordinate, another one than before, or nearer than 1 m to another sensor's), CAPACITY (more sensors
 * than RHO_MAX_PASSIVE_SENSORS); nothing is changed, and what was closed before stays. Late scans and those off the
 * clock are RHO_OK. Cost: the bearings copied, a slot cleared. Stack: 200 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_frames_push(struct rho_frames *frames,
                                               const struct rho_bearing_scan *scan);

/* Closes the open frame, if there is one. Errors: NULL, STATE. Constant cost. */
RHO_MUST_CHECK enum rho_status rho_frames_close(struct rho_frames *frames);

/*
 * Shows the frame that the last push or close has closed. It is valid until the next of them that is not refused.
 * Returns 0 where none was closed, with an empty frame. Cost: sensors squared. Stack: 120 bytes.
 */
int rho_frames_closed(const struct rho_frames *frames, struct rho_frame_view *view);

#endif
