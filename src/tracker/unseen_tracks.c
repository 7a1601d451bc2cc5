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
#include "policy.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/measurement.h"
#include "sensors.h"
#include "step.h"

/* Smooths an interval; an outage is not a long interval. */
static void smooth_interval(float *interval_s, float gap_s, float weight)
{
    if (!(*interval_s > 0.0f)) {
        *interval_s = gap_s;
        return;
    }
    const float most_s = INTERVAL_LONGEST * *interval_s;
    *interval_s += weight * ((gap_s < most_s ? gap_s : most_s) - *interval_s);
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
    if (rho_angle_in_sector(pace->azimuth_rad, sector_from_rad, sector_to_rad) && gap_s > 0.0f) {
        smooth_interval(&pace->interval_s, gap_s, INTERVAL_SMOOTHING);
        pace->time_us = time_us;
    } else if (gap_s > INTERVALS_GONE * pace->interval_s && pace->interval_s > 0.0f) {
        pace->azimuth_rad = middle_rad;
        pace->time_us = time_us;
    }
}

struct expected_looks {
    int is_awaited; /* a sensor covers the track's place, and may still look there */
    /* longest scan interval of the sensors that cover the track or saw it last; 0: unknown */
    float interval_s;
    float scans_per_s; /* total scan rate of the sensors that saw the track last */
};

static struct expected_looks expected_looks_at(const struct rho_look *look,
                                               const struct rho_track *track)
{
    const struct rho_tracker *tracker = look->tracker;
    const float *state = track->kalman.state;
    const float dt_s = rho_seconds_between(track->time_us, look->time_us);
    const float x_m = state[0] + state[3] * dt_s, y_m = state[1] + state[4] * dt_s;
    struct expected_looks wait = {0, track->seen_every_s, 0.0f};
    for (unsigned i = 0; i < tracker->num_rows; i++) {
        const struct rho_tracker_pace *pace = &tracker->sensors[i].pace;
        const struct rho_sensor *known = &tracker->sensors[i].sensor;
        if (!pace->is_heard) {
            continue;
        }
        /* an undescribed sensor covers all; the site of bearings may be another than described */
        const int is_seen =
            i >= tracker->num_sensors ||
            rho_measurement_covers(known, 0.0f, 0.0f, x_m + (known->x_m - pace->x_m),
                                   y_m + (known->y_m - pace->y_m));
        const int is_last = track->sensor_id == known->sensor_id ||
                            (RHO_SECTORS && rho_turn_was_seen_by(track, known->sensor_id));
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

int rho_unseen_update(const struct rho_look *look, struct rho_track *track, int is_missed,
                      const struct rho_track_limits *limits)
{
    if (!look->teaches) {
        if (track->plot >= 0 && look->time_us > track->seen_us) {
            track->seen_us = look->time_us;
        }
        return 0;
    }
    const struct expected_looks wait = expected_looks_at(look, track);
    const float coast = (float)look->tracker->config.coast_scans_max;
    const float unseen_s = rho_seconds_between(track->seen_us, look->time_us);
    const int is_overdue =
        wait.interval_s > 0.0f && unseen_s >= (coast + OVERDUE) * wait.interval_s;
    if (is_overdue && track->status != RHO_TRACK_TENTATIVE &&
        (track->plot < 0 ? is_missed : rho_clutter_in_gate(look, track) > DOUBTFUL_PLOTS)) {
        /* a target that was not observed for so long has probably gone: the track is tentative */
        if (limits->doubt_mnat < limits->fall_mnat) { /* else this fall would end the track */
            rho_track_lower_score(track, limits->doubt_mnat);
        }
    }
    if (track->plot >= 0) {
        track->seen_us = look->time_us;
        if (unseen_s > 0.0f) {
            /* longer times are rather missed scans than a longer interval of the sensor */
            smooth_interval(&track->seen_every_s, unseen_s,
                            unseen_s < track->seen_every_s ? SHORTER_SMOOTHING : LONGER_SMOOTHING);
        }
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

int rho_unseen_is_lost(const struct rho_tracker *tracker, const struct rho_track *track)
{
    const struct rho_sensor *sensor = rho_sensors_find(tracker, track->sensor_id);
    return sensor && rho_track_sigma_m(track) > sensor->range_max_m;
}
