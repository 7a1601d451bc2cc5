/* SPDX-License-Identifier: MIT */
/*
 * unobserved_tracks: ends tracks by time, where no sensor looks.
 *
 * Only a scan that looked at a track can miss it. A track that left the coverage, or whose radar is
 * switched off, has no misses. It may coast for the time of coast_scans_max scans of the sensors
 * that saw it last:
 *
 *      hit   hit   leaves the coverage           the radar is silent, and back
 *       |-----|-----x. . . . . . . . x ends       |-----|-----x . . . . . |  claims a plot: goes on
 *             '-- coast_scans_max --'                                     |  missed: tentative
 *                                                                         |  third miss: ends
 *
 * Where a sensor that covers its place might still look, the track has UNLOOKED times as long. How
 * often a sensor looks at a place is measured from one scan that holds a fixed direction to the
 * next one. Where the track is hit less often than that, the time between its hits counts: a sensor
 * that turns where it likes looks at some directions more often than at others.
 */
#include <string.h>

#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"
#include "step.h"

/*
 * Weight of the newest interval in the mean, and how many times the mean one counts at most: an
 * outage is no interval.
 */
#define INTERVAL_SMOOTHING 0.25f
#define INTERVAL_LONGEST 2.0f

/* After so many intervals without a look the sensor looks elsewhere. */
#define INTERVALS_GONE 16.0f

/* Smoothing of the interval between a track's hits. */
#define SHORTER_SMOOTHING 0.5f
#define LONGER_SMOOTHING 0.0625f

/*
 * Shares of an interval: a look may be so much later; the last one that counts may be so much
 * earlier.
 */
#define OVERDUE 0.5f
#define JITTER 0.7f

/* Times that a track may coast, while a sensor that sees its place might still look. */
#define UNLOOKED 4.0f

/* Misses in a row, including those before the silence, that end a track not seen for so long. */
#define OVERDUE_MISSES 3

/* False plots expected in a gate from which the plot of a track not seen for long is doubtful. */
#define DOUBTFUL_PLOTS 0.1f

/* Ratio of sigma to the sensor's range from which a track's place is unknown. */
#define UNKNOWN_SHARE 1.0f

/* ---- how often sensors look ------------------------------------------------------------------ */

static struct rho_tracker_pace *find_pace(struct rho_tracker *tracker, int32_t sensor_id)
{
    for (unsigned i = 0; i < tracker->num_paces; i++) {
        if (tracker->paces[i].sensor_id == sensor_id) {
            return &tracker->paces[i];
        }
    }
    return 0;
}

/* A new sensor replaces the one that was heard longest ago, where there is no free place. */
static struct rho_tracker_pace *add_pace(struct rho_tracker *tracker)
{
    struct rho_tracker_pace *oldest = &tracker->paces[0];
    if (tracker->num_paces < RHO_MAX_SENSORS) {
        return &tracker->paces[tracker->num_paces++];
    }
    for (unsigned i = 1; i < tracker->num_paces; i++) {
        oldest = tracker->paces[i].time_us < oldest->time_us ? &tracker->paces[i] : oldest;
    }
    return oldest;
}

void rho_tracker_forget_pace(struct rho_tracker *tracker, int32_t sensor_id)
{
    struct rho_tracker_pace *pace = find_pace(tracker, sensor_id);
    if (pace) {
        *pace = tracker->paces[--tracker->num_paces];
        memset(&tracker->paces[tracker->num_paces], 0, sizeof *pace);
    }
}

static void average_interval(struct rho_tracker_pace *pace, float gap_s)
{
    if (!(pace->interval_s > 0.0f)) {
        pace->interval_s = gap_s;
        return;
    }
    const float most_s = INTERVAL_LONGEST * pace->interval_s;
    pace->interval_s += INTERVAL_SMOOTHING * ((gap_s < most_s ? gap_s : most_s) - pace->interval_s);
}

void rho_tracker_note_pace(struct rho_tracker *tracker, int32_t sensor_id,
                           const struct rho_sensor *sensor, int64_t time_us, float sector_from_rad,
                           float sector_to_rad)
{
    const float middle_rad = rho_angle_wrap(
        sector_from_rad + 0.5f * rho_angle_sector_width(sector_from_rad, sector_to_rad));
    struct rho_tracker_pace *pace = find_pace(tracker, sensor_id);
    if (!pace) {
        pace = add_pace(tracker);
        memset(pace, 0, sizeof *pace); /* padding, too: snapshots hold it */
        pace->sensor_id = sensor_id;
        pace->azimuth_rad = middle_rad;
        pace->time_us = time_us;
    }
    pace->x_m = sensor ? sensor->x_m : 0.0f;
    pace->y_m = sensor ? sensor->y_m : 0.0f;
    const float gap_s = rho_seconds_between(pace->time_us, time_us);
    const int looks_there = rho_angle_in_sector(pace->azimuth_rad, sector_from_rad, sector_to_rad);
    if (looks_there && gap_s > 0.0f) {
        average_interval(pace, gap_s);
        pace->time_us = time_us;
    } else if (gap_s > INTERVALS_GONE * pace->interval_s && pace->interval_s > 0.0f) {
        pace->azimuth_rad = middle_rad;
        pace->time_us = time_us;
    }
}

/* ---- sensors that could see a track ---------------------------------------------------------- */

struct wait {
    int is_awaited; /* a sensor sees the place, if it still looks */
    float
        /*
         * the longest interval of these sensors and of the one that saw it last; 0: none is known
         */
        interval_s;
    float scans_per_s; /* of the sensors that saw it last */
};

/* A sensor that was not described may see any place. */
static int may_see(const struct rho_tracker *tracker, const struct rho_tracker_pace *pace,
                   float x_m, float y_m)
{
    const struct rho_sensor *known = rho_tracker_find_sensor(tracker, pace->sensor_id);
    if (!known) {
        return 1;
    }
    /* bearings say themselves where it is: the place is moved as far as it is off */
    return rho_measurement_covers(known, 0.0f, 0.0f, x_m + (known->x_m - pace->x_m),
                                  y_m + (known->y_m - pace->y_m));
}

/* One of the sensors that saw the track last: two are known of where there are sectors. */
static int saw_last(const struct rho_track *track, int32_t sensor_id)
{
    return track->sensor_id == sensor_id || (RHO_SECTORS && rho_tracker_saw_last(track, sensor_id));
}

static struct wait wait_for(const struct step *step, const struct rho_track *track)
{
    const struct rho_tracker *tracker = step->tracker;
    const float *state = track->kalman.state;
    const float dt_s = rho_seconds_between(track->time_us, step->time_us);
    const float x_m = state[0] + state[3] * dt_s, y_m = state[1] + state[4] * dt_s;
    struct wait wait = {0, track->seen_every_s, 0.0f};
    for (unsigned i = 0; i < tracker->num_paces; i++) {
        const struct rho_tracker_pace *pace = &tracker->paces[i];
        const int is_seen = may_see(tracker, pace, x_m, y_m);
        const int is_last = saw_last(track, pace->sensor_id);
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

/* Longer times between hits are scans that missed it rather than the sensor's interval. */
static void note_hit(struct rho_track *track, int64_t time_us)
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
 * A target that was out of sight for longer than tracks may coast has probably gone. When it is
 * missed, or its plot may be clutter, the track must be seen once more before it is confirmed
 * again. Where a fall of doubt_mnat would end the track, only misses end it.
 */
static void make_tentative(struct rho_track *track, const struct rho_track_limits *limits)
{
    if (limits->doubt_mnat < limits->fall_mnat) {
        rho_track_lower_score(track, limits->doubt_mnat);
    }
}

int rho_tracker_is_long_unobserved(const struct step *step, struct rho_track *track, int is_missed,
                                   const struct rho_track_limits *limits)
{
    if (step->is_late) {
        if (track->plot >= 0 && step->time_us > track->seen_us) {
            track->seen_us = step->time_us;
        }
        return 0;
    }
    const struct wait wait = wait_for(step, track);
    const float coast = (float)step->tracker->config.coast_scans_max;
    const float unseen_s = rho_seconds_between(track->seen_us, step->time_us);
    const int is_overdue =
        wait.interval_s > 0.0f && unseen_s >= (coast + OVERDUE) * wait.interval_s;
    if (is_overdue && track->status != RHO_TRACK_TENTATIVE &&
        (track->plot < 0 ? is_missed : rho_tracker_clutter_in_gate(step, track) > DOUBTFUL_PLOTS)) {
        make_tentative(track, limits);
    }
    if (track->plot >= 0) {
        note_hit(track, step->time_us);
        return 0;
    }
    if (!wait.is_awaited && wait.scans_per_s > 0.0f) {
        return unseen_s * wait.scans_per_s >= coast - JITTER;
    }
    /* unseen time less the scans that missed it */
    const float silent_s = unseen_s - (float)track->misses_in_row * wait.interval_s;
    const int is_back = silent_s >= (coast + OVERDUE) * wait.interval_s;
    return is_overdue && ((is_back && track->misses_in_row >= OVERDUE_MISSES) ||
                          unseen_s >= (UNLOOKED * coast + OVERDUE) * wait.interval_s);
}

/* ---- places ---------------------------------------------------------------------------------- */

int rho_tracker_is_place_unknown(const struct step *step, const struct rho_track *track)
{
    const struct rho_sensor *sensor = rho_tracker_find_sensor(step->tracker, track->sensor_id);
    return sensor && rho_track_sigma_m(track) > UNKNOWN_SHARE * sensor->range_max_m;
}
