/* SPDX-License-Identifier: MIT */
/*
 * frames: groups the scans of single passive sensors, as they arrive, into frames.
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
 * A sensor is expected from its first scan on. Once it was missing in silent_frames frames in a row
 * it is not expected until it reports again: a dead sensor keeps only silent_frames frames open
 * until the next scan.
 *
 * A scan is late if its time is not after the last closed frame, or too old for the open frame. It
 * is counted and left out; its sensor is expected again, so that the slowest sensor is not late for
 * ever.
 *
 * The clock is the time of the last scan taken. A scan more than jump_max_us before or after it is
 * counted and left out, so that one sensor with a wrong clock does not make all others late. Once
 * such scans outnumber the others by follow_scans, the next such scan sets the clock, and the
 * frames start anew at its time (is_restart). So the majority of the sensors sets the clock; of two
 * sensors, the first one does. A clock that is ahead by more than the scan interval but less than
 * jump_max_us makes the other sensors late as long as it lasts: scans_late counts them.
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

RHO_BEGIN_C

struct rho_frames_config {
    int64_t tolerance_us; /* longest time from the first scan of a frame to its last: 0 .. 10 s */
    /* largest difference of a scan from the clock: above a scan interval and tolerance_us .. 1 h */
    int64_t jump_max_us;
    /* excess of scans off the clock after which the clock follows them: 2 .. 255 */
    uint16_t follow_scans;
    /* frames in a row without a sensor after which it is not expected: 1 .. 255 */
    uint16_t silent_frames;
    /* smallest number of scans of a complete frame: 2 .. RHO_MAX_PASSIVE_SENSORS */
    uint16_t sensors_min;
};

/* Counters since init; all saturate. Scans taken are those put into a frame, closed or open. */
struct rho_frames_counters {
    uint32_t scans_taken, scans_late, scans_off_clock;
    uint32_t frames;            /* frames closed */
    uint32_t frames_incomplete; /* frames closed in which a known sensor is missing */
    uint32_t clock_jumps;       /* number of times that the clock was set to scans off the clock */
    /* bearings left out of scans with more than RHO_MAX_BEARINGS, the last ones */
    uint32_t bearings_no_room;
};

struct rho_frames_sensor {
    int32_t sensor_id;
    float x_m, y_m;
    uint32_t missing; /* number of frames closed without this sensor; saturates */
    uint32_t silent; /* number of frames in a row, up to the last closed one, without this sensor */
};

/* One scan stored in a frame. */
struct rho_frames_scan {
    int64_t time_us;
    float sector_from_rad, sector_to_rad;
    float x_m, y_m, z_m; /* place of the sensor */
    uint16_t sensor;     /* index of the scan's sensor in sensors[] */
    uint16_t num_bearings;
    struct rho_bearing bearings[RHO_MAX_BEARINGS];
};

/* A frame as it is stored, open or closed. */
struct rho_frames_slot {
    int64_t time_us; /* time of the earliest scan of the frame */
    int64_t last_us; /* time of the latest scan of the frame */
    uint16_t num_scans;
    uint16_t is_restart;
    uint32_t reserved;                                     /* always 0 */
    struct rho_frames_scan scans[RHO_MAX_PASSIVE_SENSORS]; /* scans in the order of their arrival */
};

struct rho_frames {
    uint32_t magic;
    uint16_t num_sensors;
    uint16_t off_clock; /* number of scans off the clock less scans on the clock, at least 0 */
    uint16_t open; /* index of the slot with the open frame; a slot without scans is no frame */
    uint16_t has_closed; /* 1: the last push or close closed the frame in the other slot */
    uint32_t reserved;   /* always 0 */
    int64_t clock_us;    /* the clock: time of the last scan taken */
    /* time of the frame closed last; INT64_MIN: no frame since the start or restart */
    int64_t closed_us;
    struct rho_frames_config config;
    struct rho_frames_counters counters;
    struct rho_frames_sensor sensors[RHO_MAX_PASSIVE_SENSORS];
    struct rho_frames_slot slots[2];
};

/*
 * A closed frame to read. Its pointers lead into the view itself, and to bearings in the frames
 * object, so that a view must not be copied.
 */
struct rho_frame_view {
    struct rho_frame frame;
    struct rho_bearing_scan scans[RHO_MAX_PASSIVE_SENSORS];
    /* 1: the clock was set anew: earlier frames do not continue, and time may have gone back */
    int is_restart;
};

/* Defaults: tolerance 50 ms, jump 30 s, follow 4, silent 3, sensors_min 2. Constant cost. */
void rho_frames_config_default(struct rho_frames_config *config);

/*
 * Initialises an object without frames; the config is copied.
 *   object_size   sizeof(struct rho_frames) of the caller
 * Errors: NULL, SIZE, CONFIG (a field outside its range). Cost: sizeof(frames). Stack: 120 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_frames_init(struct rho_frames *frames, size_t object_size,
                                               const struct rho_frames_config *config);

/*
 * Puts a scan into the open frame, which may close it, or closes the open frame and starts the next
 * one with the scan. The bearings are copied; the frame closed before is discarded.
 *   scan  must not be of this object's own frames; its bearings are not checked here, but by the
 *         user of the frame
 * Errors: NULL, STATE (not initialised), VALUE (a time beyond RHO_LIMIT_TIME_US, a sector beyond
 * one turn either way, a position of the sensor that is no coordinate), CAPACITY (more sensors than
 * RHO_MAX_PASSIVE_SENSORS); nothing is changed, and the frame closed before stays. Late scans and
 * scans off the clock are RHO_OK. Cost: the bearings copied, a slot cleared. Stack: 200 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_frames_push(struct rho_frames *frames,
                                               const struct rho_bearing_scan *scan);

/*
 * Closes the open frame of bearing scans, if there is one, without waiting for more sensors.
 * Errors: NULL, STATE. Constant cost.
 */
RHO_MUST_CHECK enum rho_status rho_frames_close(struct rho_frames *frames);

/*
 * Shows the frame that the last push or close has closed. The view is valid until the next push or
 * close without an error. Returns 0, with an empty frame, where no frame was closed. Cost: sensors
 * squared. Stack: 120 bytes.
 */
int rho_frames_closed(const struct rho_frames *frames, struct rho_frame_view *view);

RHO_END_C

#endif
