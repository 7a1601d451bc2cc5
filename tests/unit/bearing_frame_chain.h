/* SPDX-License-Identifier: MIT */
/*
 * A tracker with a passive initiator that steps through frames of a scene, and an extended Kalman
 * filter to compare with.
 */
#ifndef BEARING_FRAME_CHAIN_H
#define BEARING_FRAME_CHAIN_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "passive_scene.h"
#include "rhotrack/tracker.h"
#include "step_looks.h"

#define BATCH 8u    /* frames in a batch of the default configuration */
#define ROWS_MIN 3u /* frames from which on tracks start */

static struct rho_tracker tracker;
static struct rho_passive passive;
static struct rho_report report;
static struct scene scene;
static struct full_frame full;

/* ---- setting up ------------------------------------------------------------------------------ */

static inline void start_chain(float accel_max_mps2)
{
    struct rho_tracker_config config;
    rho_tracker_config_default(&config);
    config.late_max_s = 0.0f;
    config.v_max_mps = 450.0f;
    config.accel_max_mps2 = accel_max_mps2;
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    assert_int_equal(start_passive(&passive), RHO_OK);
}

/* Initialises the tracker again with another gate, and so another filter for new tracks. */
static inline void use_gate(uint8_t gate)
{
    struct rho_tracker_config config = tracker.config;
    config.gate = gate;
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
}

/* The scene stores the last SCENE_SCANS frames, frame k in this place. */
static inline unsigned scene_slot_of(unsigned k)
{
    return k % SCENE_SCANS;
}

/* Puts the bearings of all sensors at time_s into `full`. */
static inline void see_frame(unsigned k, double time_s)
{
    scene.time_s[scene_slot_of(k)] = time_s;
    for (unsigned s = 0; s < scene.sensors; s++) {
        see_look(&scene, scene_slot_of(k), s);
    }
    fill_frame(&scene, scene_slot_of(k), &full);
}

/* ---- steps ----------------------------------------------------------------------------------- */

/* Number of bearings in the batch that a track took; 0: that none did. */
static inline uint32_t count_bearings_of_track_in_batch(uint32_t track_id)
{
    uint32_t count = 0;
    for (unsigned k = 0; k < passive.batch.num_scans; k++) {
        for (unsigned s = 0; s < passive.batch.num_sensors; s++) {
            for (unsigned i = 0; i < passive.batch.num_bearings[k][s]; i++) {
                const struct rho_batch_bearing *bearing = &passive.batch.bearings[k][s][i];
                count += track_id == 0 ? rho_batch_is_unclaimed(bearing)
                                       : bearing->owner.track_id == track_id;
            }
        }
    }
    return count;
}

/* Checks that the numbers of fates add up to the bearings of all scans. */
static inline void check_fate_counts_add_up(const struct rho_frame *frame)
{
    uint32_t sum = 0, counted = 0, bearings = 0;
    for (unsigned i = 0; i < frame->num_scans; i++) {
        bearings += frame->scans[i].num_bearings;
    }
    for (int fate = 0; fate < RHO_NUM_FATES; fate++) {
        uint32_t here = 0;
        for (unsigned i = 0; i < bearings && i < RHO_MAX_PLOTS; i++) {
            here += report.fates[i] == fate;
        }
        assert_true(report.fates_total[fate] >= here);
        sum += report.fates_total[fate];
        counted += tracker.counters.fates[fate];
    }
    assert_int_equal(sum, bearings);
    assert_int_equal(report.num_plots, bearings);
    assert_int_equal(counted, tracker.counters.plots_in);
}

static inline void check_report(void)
{
    for (unsigned i = 0; i < report.num_tracks; i++) {
        const struct rho_track_report *track = &report.tracks[i];
        assert_true(i == 0 || report.tracks[i - 1].track_id < track->track_id);
        assert_int_not_equal(track->status, RHO_TRACK_FREE);
        assert_true(isfinite(track->sigma_m) && isfinite(track->score_nat));
        for (int k = 0; k < RHO_KALMAN_STATES; k++) {
            assert_true(isfinite(track->state[k]));
            assert_true(track->covariance[RHO_AT(k, k)] >= 0.0f);
        }
    }
}

/* Steps with a frame; the report is overwritten before, so that each field must be written. */
static inline void step_frame(const struct rho_frame *frame)
{
    if (frame->num_scans == 0) {
        return;
    }
    memset(&report, 0xee, sizeof report);
    assert_int_equal(step_looks(&tracker, &passive, NULL, frame, &report), RHO_OK);
    check_fate_counts_add_up(frame);
    check_report();
}

/* Steps with frame k of frames that are interval_s apart. */
static inline void fly_frame(unsigned k, double interval_s)
{
    see_frame(k, interval_s * k);
    step_frame(&full.frame);
}

static inline void fly_frames(unsigned from, unsigned to, double interval_s)
{
    for (unsigned k = from; k < to; k++) {
        fly_frame(k, interval_s);
    }
}

/* Steps with the scans of frame k as frames of their own, which follow one another evenly. */
static inline void fly_sensors_in_turn(unsigned k, double interval_s)
{
    for (unsigned s = 0; s < scene.sensors; s++) {
        scene.offset_s[s] = interval_s * s / scene.sensors;
    }
    see_frame(k, interval_s * k);
    for (uint32_t i = 0; i < full.frame.num_scans; i++) {
        const struct rho_frame frame = {
            .time_us = full.scans[i].time_us, .num_scans = 1, .scans = &full.scans[i]};
        step_frame(&frame);
    }
}

/* ---- tracks and targets ---------------------------------------------------------------------- */

static inline double track_error_m(const struct rho_track_report *track,
                                   const struct target *target, double time_s)
{
    return hypot((double)track->state[0] - target_x_m(target, time_s),
                 (double)track->state[1] - target_y_m(target, time_s));
}

/* The track nearest to a target at time_s; NULL: none within 3 km. */
static inline const struct rho_track_report *track_nearest_to(const struct target *target,
                                                              double time_s)
{
    const struct rho_track_report *nearest = NULL;
    double least_m = 3000.0;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        double off_m = track_error_m(&report.tracks[i], target, time_s);
        if (off_m < least_m) {
            least_m = off_m;
            nearest = &report.tracks[i];
        }
    }
    return nearest;
}

static inline const struct rho_track_report *track_with_id(uint32_t track_id)
{
    for (unsigned i = 0; i < report.num_tracks; i++) {
        if (report.tracks[i].track_id == track_id) {
            return &report.tracks[i];
        }
    }
    return NULL;
}

/* ---- a filter in double precision ------------------------------------------------------------ */

/* Extended Kalman filter in x, y, vx, vy with bearings in radians, in double precision. */
struct ekf {
    double x[4], p[4][4];
};

/*
 * A filter that starts at the true state with sigmas of 5 km and 100 m/s, which a batch of bearings
 * makes negligible.
 */
static inline struct ekf ekf_at_target(const struct target *target)
{
    struct ekf ekf = {.x = {target->x_m, target->y_m, target->vx_mps, target->vy_mps}};
    for (int i = 0; i < 4; i++) {
        ekf.p[i][i] = i < 2 ? 25e6 : 1e4;
    }
    return ekf;
}

static inline void ekf_predict(struct ekf *ekf, double dt_s, double density)
{
    for (int axis = 0; axis < 2; axis++) {
        ekf->x[axis] += dt_s * ekf->x[axis + 2];
        for (int j = 0; j < 4; j++) {
            ekf->p[axis][j] += dt_s * ekf->p[axis + 2][j];
        }
        for (int j = 0; j < 4; j++) {
            ekf->p[j][axis] += dt_s * ekf->p[j][axis + 2];
        }
        if (dt_s > 0.0) {
            ekf->p[axis][axis] += density * dt_s * dt_s * dt_s / 3.0;
            ekf->p[axis][axis + 2] += density * dt_s * dt_s / 2.0;
            ekf->p[axis + 2][axis] += density * dt_s * dt_s / 2.0;
            ekf->p[axis + 2][axis + 2] += density * dt_s;
        }
    }
}

/* Scalar update by a row over x and y, the innovation and the noise variance. */
static inline void ekf_take_row(struct ekf *ekf, const double row[2], double off, double variance)
{
    double ph[4], s = variance;
    for (int i = 0; i < 4; i++) {
        ph[i] = ekf->p[i][0] * row[0] + ekf->p[i][1] * row[1];
    }
    s += row[0] * ph[0] + row[1] * ph[1];
    for (int i = 0; i < 4; i++) {
        ekf->x[i] += ph[i] / s * off;
        for (int j = 0; j < 4; j++) {
            ekf->p[i][j] -= ph[i] * ph[j] / s;
        }
    }
}

static inline void ekf_update(struct ekf *ekf, double x_m, double y_m,
                              const struct rho_bearing *bearing)
{
    double dx_m = ekf->x[0] - x_m, dy_m = ekf->x[1] - y_m, range2 = dx_m * dx_m + dy_m * dy_m;
    const double row[2] = {-dy_m / range2, dx_m / range2};
    double off_rad = remainder((double)bearing->bearing_rad - atan2(dy_m, dx_m), 2.0 * PI);
    ekf_take_row(ekf, row, off_rad, (double)bearing->sigma_rad * (double)bearing->sigma_rad);
}

/* Updates with a plot seen from (x_m, y_m), along the line of sight and then across it. */
static inline void ekf_take_plot(struct ekf *ekf, double x_m, double y_m,
                                 const struct rho_plot *plot)
{
    double azimuth_rad = atan2((double)plot->y_m - y_m, (double)plot->x_m - x_m);
    const double along[2] = {cos(azimuth_rad), sin(azimuth_rad)};
    const double across[2] = {-along[1], along[0]};
    for (int axis = 0; axis < 2; axis++) {
        const double *row = axis ? across : along;
        double sigma_m = (double)(axis ? plot->sigma_cross_m : plot->sigma_range_m);
        double off_m =
            row[0] * ((double)plot->x_m - ekf->x[0]) + row[1] * ((double)plot->y_m - ekf->x[1]);
        ekf_take_row(ekf, row, off_m, sigma_m * sigma_m);
    }
}

/* A filter that starts from a track's state and covariance. */
static inline struct ekf ekf_from_track(const struct rho_track_report *track)
{
    static const int at[4] = {0, 1, 3, 4};
    struct ekf ekf;
    for (int i = 0; i < 4; i++) {
        ekf.x[i] = (double)track->state[at[i]];
        for (int j = 0; j <= i; j++) {
            ekf.p[i][j] = ekf.p[j][i] = (double)track->covariance[RHO_AT(at[i], at[j])];
        }
    }
    return ekf;
}

/* Updates with all bearings of a target in frame k, in the order of sensors. */
static inline void ekf_take_frame(struct ekf *ekf, unsigned k, int target)
{
    for (unsigned s = 0; s < scene.sensors; s++) {
        const struct look *look = &scene.look[scene_slot_of(k)][s];
        for (unsigned i = 0; i < look->count && !look->is_absent; i++) {
            if (look->target[i] == target) {
                ekf_update(ekf, scene.sensor_x_m[s], scene.sensor_y_m[s], &look->bearings[i]);
            }
        }
    }
}

static inline double ekf_error_m(const struct ekf *ekf, const struct target *target, double time_s)
{
    return hypot(ekf->x[0] - target_x_m(target, time_s), ekf->x[1] - target_y_m(target, time_s));
}

/* Normalised estimation error squared, e^T P^-1 e, of a track in x, y, vx, vy. */
static inline double nees_of(const struct rho_track_report *track, const double truth[4])
{
    static const int at[4] = {0, 1, 3, 4};
    double a[4][5], sum = 0.0;
    for (int i = 0; i < 4; i++) {
        a[i][4] = (double)track->state[at[i]] - truth[i];
        for (int j = 0; j < 4; j++) {
            int row = at[i] > at[j] ? at[i] : at[j], column = at[i] > at[j] ? at[j] : at[i];
            a[i][j] = (double)track->covariance[RHO_AT(row, column)];
        }
    }
    for (int k = 0; k < 4; k++) {
        sum += a[k][4] * a[k][4] / a[k][k];
        for (int i = k + 1; i < 4; i++) {
            double factor = a[i][k] / a[k][k];
            for (int j = k; j < 5; j++) {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    return sum;
}

#endif
