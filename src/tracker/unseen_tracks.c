/* SPDX-License-Identifier: MIT */
/*
 * unseen_tracks: ends tracks that no sensor has looked at for too long.
 *
 * A track counts a miss only in a scan that looked at it. A track that left the coverage, or whose
 * radar is switched off, has no misses. It may coast for the time of coast_scans_max scans of the
 * sensors that saw it last:
 *
 *      hit   hit   leaves the coverage           the radar is silent, and back
 *       |-----|-----x. . . . . . . . x ends       |-----|-----x . . . . . |  claims a plot: goes on
 *             '-- coast_scans_max --'                                     |  missed: tentative
 *                                                                         |  third miss: ends
 *
 * Where a sensor covers its place and might still look there, the track may coast UNLOOKED times as
 * long. A sensor's scan interval is measured between scans that hold one fixed direction. Where the
 * track is hit less often, the time between its hits counts instead: a sensor that steers its beam
 * freely looks in some directions more often than in others.
 */
#include "clutter.h"
#include "plots.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"
#include "sensors.h"
#include "step.h"

/*
 * Weight of the newest interval in a smoothed interval, and its upper limit over the smoothed one:
 * an outage is not a long interval.
 */
#define INTERVAL_SMOOTHING 0.25f
#define INTERVAL_LONGEST 2.0f

/* Scan intervals without a look in the fixed direction after which another one is chosen. */
#define INTERVALS_GONE 16.0f

/* Weight of the newest time between a track's hits in the smoothed one: if shorter; if longer. */
#define SHORTER_SMOOTHING 0.5f
#define LONGER_SMOOTHING 0.0625f

/*
 * Tolerances in scan intervals: a look may be late by OVERDUE; a track that no sensor covers ends
 * up to JITTER before coast_scans_max intervals are over.
 */
#define OVERDUE 0.5f
#define JITTER 0.7f

/* Factor on the coasting time of a track whose place a sensor covers, but does not look at. */
#define UNLOOKED 4.0f

/* Misses in a row that end a track after a silence; those before the silence are included. */
#define OVERDUE_MISSES 3

/* Clutter plots expected in the gate above which a plot after a long silence is doubtful. */
#define DOUBTFUL_PLOTS 0.1f

/* Largest sigma of a track's place over its sensor's maximum range; above it the track ends. */
#define UNKNOWN_SHARE 1.0f

/* ---- how often sensors look ------------------------------------------------------------------ */

static void smooth_scan_interval(struct rho_tracker_pace *pace, float gap_s)
{
    if (!(pace->interval_s > 0.0f)) {
        pace->interval_s = gap_s;
        return;
    }
    const float most_s = INTERVAL_LONGEST * pace->interval_s;
    pace->interval_s += INTERVAL_SMOOTHING * ((gap_s < most_s ? gap_s : most_s) - pace->interval_s);
}

void rho_pace_update(struct rho_tracker_pace *pace, const struct rho_sensor *sensor,
                     int64_t time_us, float sector_from_rad, float sector_to_rad)
{
    const float middle_rad = rho_angle_wrap(
        sector_from_rad + 0.5f * rho_angle_sector_width(sector_from_rad, sector_to_rad));
    if (!pace->is_heard) {
        pace->is_heard = 1;
        pace->azimuth_rad = middle_rad;
        pace->time_us = time_us;
    }
    pace->x_m = sensor ? sensor->x_m : 0.0f;
    pace->y_m = sensor ? sensor->y_m : 0.0f;
    const float gap_s = rho_seconds_between(pace->time_us, time_us);
    const int looks_there = rho_angle_in_sector(pace->azimuth_rad, sector_from_rad, sector_to_rad);
    if (looks_there && gap_s > 0.0f) {
        smooth_scan_interval(pace, gap_s);
        pace->time_us = time_us;
    } else if (gap_s > INTERVALS_GONE * pace->interval_s && pace->interval_s > 0.0f) {
        pace->azimuth_rad = middle_rad;
        pace->time_us = time_us;
    }
}

/* ---- sensors that could see a track ---------------------------------------------------------- */

struct expected_looks {
    int is_awaited; /* a sensor covers the track's place, and may still look there */
    /* longest scan interval of the sensors that cover the track or saw it last; 0: unknown */
    float interval_s;
    float scans_per_s; /* total scan rate of the sensors that saw the track last */
};

/* True where the sensor's coverage holds a place; an undescribed sensor covers all. */
static int may_sensor_see_place(const struct rho_tracker *tracker, unsigned row, float x_m,
                                float y_m)
{
    const struct rho_sensor *known = &tracker->sensors[row].sensor;
    const struct rho_tracker_pace *pace = &tracker->sensors[row].pace;
    /* the sensor of bearing scans may be elsewhere than described: the place moves along */
    return row >= tracker->num_sensors ||
           rho_measurement_covers(known, 0.0f, 0.0f, x_m + (known->x_m - pace->x_m),
                                  y_m + (known->y_m - pace->y_m));
}

/* True of the sensor that saw the track last; with RHO_SECTORS also of the one before it. */
static int is_among_last_seeing_sensors(const struct rho_track *track, int32_t sensor_id)
{
    return track->sensor_id == sensor_id || (RHO_SECTORS && rho_turn_was_seen_by(track, sensor_id));
}

static struct expected_looks expected_look_interval_and_rate_at_track(const struct rho_look *look,
                                                                      const struct rho_track *track)
{
    const struct rho_tracker *tracker = look->tracker;
    const float *state = track->kalman.state;
    const float dt_s = rho_seconds_between(track->time_us, look->time_us);
    const float x_m = state[0] + state[3] * dt_s, y_m = state[1] + state[4] * dt_s;
    struct expected_looks wait = {0, track->seen_every_s, 0.0f};
    for (unsigned i = 0; i < tracker->num_rows; i++) {
        const struct rho_tracker_pace *pace = &tracker->sensors[i].pace;
        if (!pace->is_heard) {
            continue;
        }
        const int is_seen = may_sensor_see_place(tracker, i, x_m, y_m);
        const int is_last =
            is_among_last_seeing_sensors(track, tracker->sensors[i].sensor.sensor_id);
        const float interval_s =
            pace->interval_s > track->seen_every_s ? pace->interval_s : track->seen_every_s;
        if ((is_seen || is_last) && interval_s > wait.interval_s) {
            wait.interval_s = interval_s;
        }
        if (is_last && interval_s > 0.0f) {
            wait.scans_per_s += 1.0f / interval_s;
        }
        wait.is_awaited |= is_seen;
    }
    return wait;
}

/* ---- time goes by ---------------------------------------------------------------------------- */

/*
 * Smooths the time between a track's hits. Longer times count little: they are rather missed scans
 * than a longer interval of the sensor.
 */
static void smooth_hit_interval(struct rho_track *track, int64_t time_us)
{
    const float gap_s = rho_seconds_between(track->seen_us, time_us);
    track->seen_us = time_us;
    if (!(gap_s > 0.0f)) {
        return;
    }
    if (!(track->seen_every_s > 0.0f)) {
        track->seen_every_s = gap_s;
    } else if (gap_s < track->seen_every_s) {
        track->seen_every_s += SHORTER_SMOOTHING * (gap_s - track->seen_every_s);
    } else {
        const float most_s = INTERVAL_LONGEST * track->seen_every_s;
        track->seen_every_s +=
            LONGER_SMOOTHING * ((gap_s < most_s ? gap_s : most_s) - track->seen_every_s);
    }
}

/*
 * Lowers the score by doubt_mnat, which makes a track tentative: a target that was not observed for
 * longer than tracks may coast has probably gone. The score stays where that fall would end the
 * track.
 */
static void lower_score_to_tentative(struct rho_track *track, const struct rho_track_limits *limits)
{
    if (limits->doubt_mnat < limits->fall_mnat) {
        rho_track_lower_score(track, limits->doubt_mnat);
    }
}

int rho_unseen_update(const struct rho_look *look, struct rho_track *track, int is_missed,
                      const struct rho_track_limits *limits)
{
    if (!look->teaches) {
        if (track->plot >= 0 && look->time_us > track->seen_us) {
            track->seen_us = look->time_us;
        }
        return 0;
    }
    const struct expected_looks wait = expected_look_interval_and_rate_at_track(look, track);
    const float coast = (float)look->tracker->config.coast_scans_max;
    const float unseen_s = rho_seconds_between(track->seen_us, look->time_us);
    const int is_overdue =
        wait.interval_s > 0.0f && unseen_s >= (coast + OVERDUE) * wait.interval_s;
    if (is_overdue && track->status != RHO_TRACK_TENTATIVE &&
        (track->plot < 0 ? is_missed : rho_clutter_in_gate(look, track) > DOUBTFUL_PLOTS)) {
        lower_score_to_tentative(track, limits);
    }
    if (track->plot >= 0) {
        smooth_hit_interval(track, look->time_us);
        return 0;
    }
    if (!wait.is_awaited && wait.scans_per_s > 0.0f) {
        return unseen_s * wait.scans_per_s >= coast - JITTER;
    }
    /* time without a hit, less the scans that looked and missed */
    const float silent_s = unseen_s - (float)track->misses_in_row * wait.interval_s;
    const int is_back = silent_s >= (coast + OVERDUE) * wait.interval_s;
    return is_overdue && ((is_back && track->misses_in_row >= OVERDUE_MISSES) ||
                          unseen_s >= (UNLOOKED * coast + OVERDUE) * wait.interval_s);
}

/* ---- places ---------------------------------------------------------------------------------- */

int rho_unseen_is_lost(const struct rho_tracker *tracker, const struct rho_track *track)
{
    const struct rho_sensor *sensor = rho_sensors_find(tracker, track->sensor_id);
    return sensor && rho_track_sigma_m(track) > UNKNOWN_SHARE * sensor->range_max_m;
}
