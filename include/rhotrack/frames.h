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
 * Scans of different sensors within tolerance_us of the earliest of them are one frame, in any
 * order of arrival. A frame closes
 *   - with the scan of the last sensor that is expected, or
 *   - when a scan arrives that does not belong to it: beyond the tolerance, or of a sensor that is
 *     in the frame already, or
 *   - when the caller closes it (rho_frames_close): at the end, or when no scan came for some time.
 * Its scans are in the order of sensor_id, its time is that of its earliest scan. The times of the
 * frames rise. A push closes one frame at most.
 *
 * A sensor is expected from its first scan on. After it was missing in silent_frames frames in a
 * row it is not expected until it reports again: a dead sensor delays only so many frames until the
 * next scan.
 *
 * A scan is late if it is not later than the last closed frame, or too old for the open one. It is
 * counted and left out; its sensor is expected again, so that the slowest sensor is not late for
 * ever.
 *
 * The clock is the time of the last scan taken. A scan more than jump_max_us before or after it is
 * counted and left out, so that one sensor with a wrong clock does not make all others late. Once
 * such scans outnumber the others by follow_scans, the next one sets the clock, and the frames
 * start anew at its time (is_restart). The majority of the sensors decides; of two, the first one.
 * A clock that is ahead by more than the scan interval but less than jump_max_us makes the other
 * sensors late as long as it lasts: scans_late counts them.
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
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

struct rho_frames_config {
    int64_t tolerance_us;   /* from a frame's first scan to its last: 0 .. 10 s */
    int64_t jump_max_us;    /* longer than a scan interval: above tolerance_us .. 1 h */
    uint16_t follow_scans;  /* 2 .. 255 */
    uint16_t silent_frames; /* 1 .. 255 */
    uint16_t sensors_min;   /* of a complete frame: 2 .. RHO_MAX_PASSIVE_SENSORS */
};

/* Since init; all saturate. Scans taken are in a frame, closed or open. */
struct rho_frames_counters {
    uint32_t scans_taken, scans_late, scans_off_clock;
    uint32_t frames;            /* closed */
    uint32_t frames_incomplete; /* a known sensor is missing in them */
    uint32_t clock_jumps;       /* followed */
    uint32_t bearings_no_room;  /* the last ones of a scan, beyond RHO_MAX_BEARINGS */
};

struct rho_frames_sensor {
    int32_t sensor_id;
    float x_m, y_m;
    uint32_t missing; /* frames closed without it; saturates */
    uint32_t silent;  /* the last of them in a row */
};

/* One scan of a frame. */
struct rho_frames_scan {
    int64_t time_us;
    float sector_from_rad, sector_to_rad;
    uint16_t sensor; /* its index in sensors */
    uint16_t num_bearings;
    struct rho_bearing bearings[RHO_MAX_BEARINGS];
};

/* A stored frame. */
struct rho_frames_slot {
    int64_t time_us; /* the earliest of its scans */
    int64_t last_us; /* the latest */
    uint16_t num_scans;
    uint16_t is_restart;
    uint32_t reserved;                                     /* 0 */
    struct rho_frames_scan scans[RHO_MAX_PASSIVE_SENSORS]; /* in the order of arrival */
};

struct rho_frames {
    uint32_t magic;
    uint16_t num_sensors;
    uint16_t off_clock;  /* scans off the clock minus scans on it */
    uint16_t open;       /* slot of the open frame; without scans there is none */
    uint16_t has_closed; /* the last call closed the other slot */
    uint32_t reserved;   /* 0 */
    int64_t clock_us;    /* of the last scan taken */
    int64_t closed_us;   /* of the frame closed last; INT64_MIN: none since the start */
    struct rho_frames_config config;
    struct rho_frames_counters counters;
    struct rho_frames_sensor sensors[RHO_MAX_PASSIVE_SENSORS];
    struct rho_frames_slot slots[2];
};

/*
 * A closed frame to read: it points into itself, and into the object for the bearings. Not to be
 * copied.
 */
struct rho_frame_view {
    struct rho_frame frame;
    struct rho_bearing_scan scans[RHO_MAX_PASSIVE_SENSORS];
    int is_restart; /* the clock was set anew: earlier frames do not continue, time may go back */
};

/* tolerance 50 ms, jump_max 30 s, follow_scans 4, silent_frames 3, sensors_min 2. Constant cost. */
void rho_frames_config_default(struct rho_frames_config *config);

/*
 * Prepares an object without frames; the config is copied.
 *   size   sizeof(struct rho_frames) of the caller
 * Errors: NULL, SIZE, CONFIG (any field outside its range). Cost: sizeof(frames) bytes cleared.
 * Stack: 120 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_frames_init(struct rho_frames *frames, size_t size,
                                               const struct rho_frames_config *config);

/*
 * Takes a scan; its bearings are copied. The frame that was closed before is gone.
 *   scan  not of this object's own frames; its bearings are checked by the user of the
 *         frame
 * Errors: NULL, STATE (not initialised), VALUE (a time beyond RHO_LIMIT_TIME_US, a sector beyond
 * one turn either way, a place that is no coordinate, another one than before, or nearer than 1 m
 * to another sensor's), CAPACITY (more sensors than RHO_MAX_PASSIVE_SENSORS); nothing is changed,
 * and what was closed before stays. Late scans and those off the clock are RHO_OK. Cost: the
 * bearings copied, a slot cleared. Stack: 200 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_frames_push(struct rho_frames *frames,
                                               const struct rho_bearing_scan *scan);

/* Closes the open frame, if there is one. Errors: NULL, STATE. Constant cost. */
RHO_MUST_CHECK enum rho_status rho_frames_close(struct rho_frames *frames);

/*
 * Shows the frame that the last push or close has closed. It is valid until the next of them that
 * is not refused.
 * Returns 0 where none was closed, with an empty frame. Cost: sensors squared. Stack: 120 bytes.
 */
int rho_frames_closed(const struct rho_frames *frames, struct rho_frame_view *view);

#ifdef __cplusplus
}
#endif

#endif
