/* SPDX-License-Identifier: MIT */
/*
 * unseen_tracks: ends tracks that no sensor has looked at for too long.
 *
 * A track counts a miss only in a scan that looked at it. A track that left the coverage, or whose
 * radar is switched off, has no misses. It may coast for the time of coast_scans_max scans of the
 * sensors that saw it last:
 *
 *      hit   hit   leaves the coverage
 *       |-----|-----x. . . . . . . . x ends
 *             '-- coast_scans_max --'
 *
 * Where a sensor covers its place and might still look there, the track may coast UNLOOKED times as
 * long. A sensor's scan interval is measured between scans that hold one fixed direction. Where the
 * track is hit less often, the time between its hits counts instead: a sensor that steers its beam
 * freely looks in some directions more often than in others.
 */
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

/* True of a sensor that saw the track last. */
static int is_last_sensor(const struct rho_track *track, int32_t sensor_id)
{
    return track->sensor_id == sensor_id || (RHO_SECTORS && rho_turn_was_seen_by(track, sensor_id));
}

/* True where a sensor covers the track's place at the look's time; one not described covers all. */
static int covers_track(const struct rho_look *look, const struct rho_track *track, unsigned row)
{
    const struct rho_tracker_pace *pace = &look->tracker->sensors[row].pace;
    const struct rho_sensor *known = &look->tracker->sensors[row].sensor;
    const float *state = track->kalman.state;
    const float dt_s = rho_seconds_between(track->time_us, look->time_us);
    /* the site of bearings may be another than described */
    return row >= look->tracker->num_sensors ||
           rho_measurement_covers(known, 0.0f, 0.0f,
                                  state[0] + state[3] * dt_s + (known->x_m - pace->x_m),
                                  state[1] + state[4] * dt_s + (known->y_m - pace->y_m));
}

float rho_unseen_interval_s(const struct rho_look *look, const struct rho_track *track)
{
    float interval_s = track->seen_every_s;
    for (unsigned row = 0; row < look->tracker->num_rows; row++) {
        const struct rho_tracker_sensor *sensor = &look->tracker->sensors[row];
        if (sensor->pace.is_heard && sensor->pace.interval_s > interval_s &&
            (is_last_sensor(track, sensor->sensor.sensor_id) || covers_track(look, track, row))) {
            interval_s = sensor->pace.interval_s;
        }
    }
    return interval_s;
}

/* Total scan rate of the sensors that saw the track last; 0 where one may still look there. */
static float looks_per_s(const struct rho_look *look, const struct rho_track *track)
{
    float sum = 0.0f;
    for (unsigned row = 0; row < look->tracker->num_rows; row++) {
        const struct rho_tracker_sensor *sensor = &look->tracker->sensors[row];
        const float interval_s = rho_larger(sensor->pace.interval_s, track->seen_every_s);
        if (sensor->pace.is_heard && covers_track(look, track, row)) {
            return 0.0f;
        }
        if (sensor->pace.is_heard && interval_s > 0.0f &&
            is_last_sensor(track, sensor->sensor.sensor_id)) {
            sum += 1.0f / interval_s;
        }
    }
    return sum;
}

int rho_unseen_update(const struct rho_look *look, struct rho_track *track)
{
    if (!look->teaches) {
        if (track->plot >= 0 && look->time_us > track->seen_us) {
            track->seen_us = look->time_us;
        }
        return 0;
    }
    const float unseen_s = rho_seconds_between(track->seen_us, look->time_us);
    if (track->plot >= 0) {
        track->seen_us = look->time_us;
        if (unseen_s > 0.0f) {
            /* longer times are rather missed scans than a longer interval of the sensor */
            smooth_interval(&track->seen_every_s, unseen_s,
                            unseen_s < track->seen_every_s ? SHORTER_SMOOTHING : LONGER_SMOOTHING);
        }
        return 0;
    }
    const float coast = (float)look->tracker->config.coast_scans_max;
    const float per_s = looks_per_s(look, track);
    if (per_s > 0.0f) {
        return unseen_s * per_s >= coast - JITTER;
    }
    const float interval_s = rho_unseen_interval_s(look, track);
    /* misses do not matter: a sensor that sees nothing there looks in vain */
    return interval_s > 0.0f && unseen_s >= (UNLOOKED * coast + OVERDUE) * interval_s;
}

int rho_unseen_is_lost(const struct rho_tracker *tracker, const struct rho_track *track)
{
    const struct rho_sensor *sensor = rho_sensors_find(tracker, track->sensor_id);
    return sensor && rho_track_sigma_m(track) > sensor->range_max_m;
}
