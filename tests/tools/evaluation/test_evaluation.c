/* SPDX-License-Identifier: MIT */
/* Figures of tracks against truth, on scenes whose results are worked out by hand. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "evaluation/evaluation.h"

#define S 1000000 /* microseconds in a second */
#define CUTOFF_M 100.0

static bool is_near(double value, double expected)
{
    return fabs(value - expected) <= 1e-9 * fmax(1.0, fabs(expected));
}

/* A point without velocity and covariance. */
static struct evaluation_point point_at(int32_t id, double x_m, double y_m)
{
    return (struct evaluation_point){.id = id,
                                     .x_m = x_m,
                                     .y_m = y_m,
                                     .vx_mps = NAN,
                                     .vy_mps = NAN,
                                     .cov_xx_m2 = NAN,
                                     .cov_yx_m2 = NAN,
                                     .cov_yy_m2 = NAN};
}

/*
 * Adds a time with a target at the origin and, if track is above 0, that track error_m beside it.
 */
static void add_scan_with_error(struct evaluation *e, int64_t time_s, int32_t track, double error_m)
{
    struct evaluation_point target = point_at(7, 0.0, 0.0), there = point_at(track, error_m, 0.0);
    evaluation_add_time(e, time_s * S, &target, 1, &there, track > 0);
}

static void an_empty_evaluation_has_no_figures(void **state)
{
    (void)state;
    struct evaluation *e = evaluation_start(CUTOFF_M);
    struct evaluation_result r = evaluation_result(e);
    size_t count = 1;
    assert_true(r.scans == 0 && r.targets == 0 && r.tracks == 0 && r.switches == 0);
    assert_true(isnan(r.gospa_m) && isnan(r.completeness) && isnan(r.delay_s));
    assert_true(isnan(r.errors.rmse_m) && isnan(r.errors.median_m) && isnan(r.errors.nees));
    free(evaluation_results_by_target(e, &count));
    assert_int_equal(count, 0);
    evaluation_results_over_time(e, &count);
    assert_int_equal(count, 0);
    evaluation_add_time(e, 5 * S, NULL, 0, NULL, 0);
    r = evaluation_result(e);
    assert_true(r.scans == 1 && r.gospa_m == 0.0 && r.ospa_m == 0.0 && isnan(r.completeness));
    assert_true(r.first_us == 5 * S && r.last_us == 5 * S && isnan(r.false_per_hour));
    evaluation_free(e);
}

/* Track 1, a gap, track 1 again, at once track 2, a gap, track 2 again, a gap, track 3, a gap. */
static void identity_switches_and_fragments_are_counted_separately(void **state)
{
    (void)state;
    static const int32_t track[] = {0, 0, 1, 1, 0, 1, 2, 0, 0, 2, 0, 3, 3, 0};
    static const size_t switches[] = {0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0};
    static const size_t fragments[] = {0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0};
    struct evaluation *e = evaluation_start(CUTOFF_M);
    for (int i = 0; i < 14; i++) {
        add_scan_with_error(e, 10 + 2 * i, track[i], 5.0);
    }
    struct evaluation_result r = evaluation_result(e);
    assert_int_equal(r.switches, 2);
    assert_int_equal(r.fragments, 3);
    assert_int_equal(r.delay_scans, 2);
    assert_true(is_near(r.delay_s, 4.0) && is_near(r.completeness, 7.0 / 14.0));
    assert_true(r.first_us == 10 * S && r.last_us == 36 * S);
    size_t count;
    const struct evaluation_scan *scans = evaluation_results_over_time(e, &count);
    assert_int_equal(count, 14);
    for (int i = 0; i < 14; i++) {
        assert_true(scans[i].switches == switches[i] && scans[i].fragments == fragments[i]);
        assert_true(scans[i].time_us == (10 + 2 * i) * S && scans[i].pairs == (track[i] > 0));
    }
    struct evaluation_target *targets = evaluation_results_by_target(e, &count);
    assert_true(count == 1 && targets[0].id == 7);
    assert_true(targets[0].found_us == 14 * S && targets[0].kept_until_us == 34 * S);
    assert_true(targets[0].switches == 2 && targets[0].fragments == 3 &&
                targets[0].delay_scans == 2);
    free(targets);
    evaluation_free(e);
}

/* An absent target has no gap; a target found only later has no fragment. */
static void an_absent_target_adds_no_fragment(void **state)
{
    (void)state;
    struct evaluation *e = evaluation_start(CUTOFF_M);
    struct evaluation_point other = point_at(8, 5000.0, 0.0);
    add_scan_with_error(e, 0, 1, 5.0);
    evaluation_add_time(e, 1 * S, &other, 1, NULL, 0);
    add_scan_with_error(e, 2, 1, 5.0);
    struct evaluation_result r = evaluation_result(e);
    assert_int_equal(r.fragments, 0);
    assert_true(r.targets == 2 && r.targets_found == 1 && is_near(r.completeness, 2.0 / 3.0));
    evaluation_free(e);
}

static void quantiles_of_errors_are_interpolated(void **state)
{
    (void)state;
    static const double errors_m[] = {9.0, 1.0, 4.0, 2.0};
    struct evaluation *e = evaluation_start(CUTOFF_M);
    add_scan_with_error(e, 0, 1, 3.0);
    struct evaluation_result r = evaluation_result(e);
    assert_true(r.errors.median_m == 3.0 && r.errors.p95_m == 3.0 && r.errors.rmse_m == 3.0);
    assert_true(isnan(r.errors.rmse_mps) && isnan(r.errors.median_mps) && isnan(r.errors.p95_mps));
    for (int i = 0; i < 4; i++) {
        add_scan_with_error(e, 1 + i, 1, errors_m[i]);
    }
    r = evaluation_result(e); /* median of the errors 1 2 3 4 9 */
    assert_true(is_near(r.errors.median_m, 3.0) && is_near(r.errors.p95_m, 4.0 + 0.8 * 5.0));
    assert_true(is_near(r.errors.rmse_m, sqrt(111.0 / 5.0)));
    add_scan_with_error(e, 5, 1, 5.0); /* of 1 2 3 4 5 9 */
    r = evaluation_result(e);
    assert_true(is_near(r.errors.median_m, 3.5) && is_near(r.errors.p95_m, 5.0 + 0.75 * 4.0));
    evaluation_free(e);
}

/* Velocity errors count pairs in which both velocities are known; heights count, too. */
static void velocity_errors_need_the_velocity_of_track_and_target(void **state)
{
    (void)state;
    struct evaluation *e = evaluation_start(CUTOFF_M);
    struct evaluation_point targets[3] = {point_at(1, 0, 0), point_at(2, 1000, 0),
                                          point_at(3, 2000, 0)};
    struct evaluation_point tracks[3] = {point_at(11, 2, 3), point_at(12, 1000, 0),
                                         point_at(13, 2000, 0)};
    tracks[0].z_m = 6.0;
    targets[0].vx_mps = 10.0, targets[0].vy_mps = 0.0, targets[0].vz_mps = 1.0;
    tracks[0].vx_mps = 12.0, tracks[0].vy_mps = 3.0, tracks[0].vz_mps = -5.0;
    targets[1].vx_mps = 10.0, targets[1].vy_mps = 0.0;
    tracks[2].vx_mps = 10.0, tracks[2].vy_mps = 0.0;
    evaluation_add_time(e, 0, targets, 3, tracks, 3);
    struct evaluation_result r = evaluation_result(e);
    assert_true(r.errors.pairs == 3 && is_near(r.errors.rmse_m, sqrt(49.0 / 3.0)));
    assert_true(is_near(r.errors.rmse_mps, 7.0) && is_near(r.errors.median_mps, 7.0));
    size_t count;
    const struct evaluation_scan *scan = evaluation_results_over_time(e, &count);
    assert_true(is_near(scan->rmse_mps, 7.0) && is_near(scan->rmse_m, sqrt(49.0 / 3.0)));
    assert_true(isnan(scan->nees));
    evaluation_free(e);
}

static struct evaluation_point with_covariance(struct evaluation_point point, double xx, double yx,
                                               double yy)
{
    point.cov_xx_m2 = xx;
    point.cov_yx_m2 = yx;
    point.cov_yy_m2 = yy;
    return point;
}

/* Covariance P = [4 2; 2 3], determinant 8, inverse [3 -2; -2 4] / 8. */
static void nees_uses_the_full_covariance(void **state)
{
    (void)state;
    struct evaluation *e = evaluation_start(CUTOFF_M);
    struct evaluation_point targets[5], tracks[5];
    for (int i = 0; i < 5; i++) {
        targets[i] = point_at(i, 1000.0 * i, 0.0);
        tracks[i] = with_covariance(point_at(20 + i, 1000.0 * i, 0.0), 4.0, 2.0, 3.0);
    }
    tracks[0].x_m += 2.0, tracks[0].y_m += 1.0; /* NEES (12 - 8 + 4) / 8 = 1 */
    /* NEES (48 + 16 + 4) / 8 = 8.5, outside the ellipse */
    tracks[1].x_m += 4.0, tracks[1].y_m -= 1.0;
    tracks[2] = point_at(22, 2000.0, 50.0);                  /* no covariance */
    tracks[3] = with_covariance(tracks[3], 4.0, 4.0, 4.0);   /* singular covariance */
    tracks[4] = with_covariance(tracks[4], -4.0, 0.0, -4.0); /* not positive definite */
    evaluation_add_time(e, 0, targets, 5, tracks, 5);
    struct evaluation_result r = evaluation_result(e);
    assert_true(is_near(r.errors.nees, 9.5 / 2.0) && is_near(r.errors.nees_inside, 0.5));
    size_t count;
    assert_true(is_near(evaluation_results_over_time(e, &count)->nees, 9.5 / 2.0));
    struct evaluation_target *by_target = evaluation_results_by_target(e, &count);
    assert_true(is_near(by_target[0].errors.nees, 1.0) && by_target[0].errors.nees_inside == 1.0);
    assert_true(is_near(by_target[1].errors.nees, 8.5) && by_target[1].errors.nees_inside == 0.0);
    assert_true(isnan(by_target[2].errors.nees) && isnan(by_target[3].errors.nees_inside));
    free(by_target);
    evaluation_free(e);
}

static struct evaluation_point with_velocity(struct evaluation_point point, double vx_mps,
                                             double vy_mps)
{
    point.vx_mps = vx_mps;
    point.vy_mps = vy_mps;
    return point;
}

static struct evaluation_point with_velocity_covariance(struct evaluation_point point, double xx,
                                                        double yx, double yy)
{
    point.cov_vxx_m2ps2 = xx;
    point.cov_vyx_m2ps2 = yx;
    point.cov_vyy_m2ps2 = yy;
    return point;
}

/*
 * The same covariance for velocities: NEES over its two dimensions is 1 / 2 and 8.5 / 2. Without a
 * velocity or a positive definite covariance there is none.
 */
static void velocity_nees_uses_the_velocity_covariance(void **state)
{
    (void)state;
    struct evaluation *e = evaluation_start(CUTOFF_M);
    struct evaluation_point targets[5], tracks[5];
    for (int i = 0; i < 5; i++) {
        targets[i] = with_velocity(point_at(i, 1000.0 * i, 0.0), 100.0, -50.0);
        tracks[i] = with_velocity_covariance(
            with_velocity(point_at(20 + i, 1000.0 * i, 0.0), 100.0, -50.0), 4.0, 2.0, 3.0);
    }
    tracks[0].vx_mps += 2.0, tracks[0].vy_mps += 1.0;
    tracks[1].vx_mps += 4.0, tracks[1].vy_mps -= 1.0;
    tracks[2] = with_velocity_covariance(point_at(22, 2000.0, 0.0), 4.0, 2.0, 3.0);
    tracks[3] = with_covariance(with_velocity(point_at(23, 3000.0, 0.0), 90.0, 0.0), 1.0, 0.0, 1.0);
    tracks[4] = with_velocity_covariance(tracks[4], 4.0, 4.0, 4.0);
    evaluation_add_time(e, 0, targets, 5, tracks, 5);
    struct evaluation_result r = evaluation_result(e);
    assert_true(is_near(r.errors.velocity_ratio, 4.75 / 2.0) && r.errors.velocity_inside == 0.5);
    /* share of the only track with a place NEES */
    assert_true(r.errors.nees == 0.0 && r.errors.nees_inside == 1.0);
    size_t count;
    assert_true(is_near(evaluation_results_over_time(e, &count)->velocity_ratio, 4.75 / 2.0));
    evaluation_free(e);
}

/*
 * One target and its track: two seconds at 10 m/s, a turn of 0.1 m/s^2 with a missed scan, straight
 * again, an unknown velocity. Errors differ at each time, so that the RMS of each motion shows its
 * times.
 */
static void errors_are_split_by_straight_turning_and_coasting(void **state)
{
    (void)state;
    static const double vx_mps[] = {10.0, 10.0, 10.2, 10.4, 10.4, NAN, 10.4, 10.43};
    static const enum evaluation_motion expected[] = {
        EVALUATION_NO_MOTION, EVALUATION_STRAIGHT,  EVALUATION_TURNING,   EVALUATION_COASTING,
        EVALUATION_STRAIGHT,  EVALUATION_NO_MOTION, EVALUATION_NO_MOTION, EVALUATION_STRAIGHT};
    struct evaluation *e = evaluation_start(CUTOFF_M);
    double squares_m2[EVALUATION_MOTIONS + 1] = {0};
    size_t pairs[EVALUATION_MOTIONS + 1] = {0};
    for (int i = 0; i < 8; i++) {
        double error_m = 1.0 + 3.0 * i;
        struct evaluation_point target = with_velocity(point_at(1, 0.0, 0.0), vx_mps[i], 0.0);
        struct evaluation_point track = point_at(2, error_m, 0.0);
        track.is_coasting = i == 3;
        evaluation_add_time(e, 2 * i * S, &target, 1, &track, 1);
        squares_m2[expected[i]] += error_m * error_m;
        pairs[expected[i]]++;
    }
    struct evaluation_result r = evaluation_result(e);
    for (int i = 0; i < EVALUATION_MOTIONS; i++) {
        assert_int_equal(r.by_motion[i].pairs, pairs[i]);
        assert_true(is_near(r.by_motion[i].rmse_m, sqrt(squares_m2[i] / (double)pairs[i])));
    }
    assert_int_equal(r.errors.pairs, 8);
    /* 0.04 m/s in a second is a turn if the limit is lower */
    struct evaluation_point track = point_at(2, 0.0, 0.0);
    struct evaluation_point target = with_velocity(point_at(1, 0.0, 0.0), 10.47, 0.0);
    evaluation_add_time(e, 15 * S, &target, 1, &track, 1);
    assert_int_equal(evaluation_result(e).by_motion[EVALUATION_TURNING].pairs, 2);
    evaluation_set_turning_limit(e, 0.05);
    target.vx_mps += 0.04;
    evaluation_add_time(e, 16 * S, &target, 1, &track, 1);
    r = evaluation_result(e);
    assert_true(r.by_motion[EVALUATION_TURNING].pairs == 2 &&
                r.by_motion[EVALUATION_STRAIGHT].pairs == pairs[EVALUATION_STRAIGHT] + 1);
    evaluation_free(e);
}

/* The ellipse of 95 % ends at a chi-square of 5.9915. */
static void the_nees_ellipse_ends_at_chi_square_5_99(void **state)
{
    (void)state;
    struct evaluation *e = evaluation_start(CUTOFF_M);
    struct evaluation_point target = point_at(1, 0.0, 0.0), track;
    track = with_covariance(point_at(1, sqrt(5.991), 0.0), 1.0, 0.0, 1.0);
    evaluation_add_time(e, 0, &target, 1, &track, 1);
    assert_true(evaluation_result(e).errors.nees_inside == 1.0);
    track.x_m = sqrt(5.992);
    evaluation_add_time(e, S, &target, 1, &track, 1);
    assert_true(is_near(evaluation_result(e).errors.nees_inside, 0.5));
    evaluation_free(e);
}

/*
 * Track 2 is unpaired in two of three rows, track 3 in one of two, track 4 in its only one; over
 * half an hour.
 */
static void tracks_unpaired_in_most_rows_are_false(void **state)
{
    (void)state;
    struct evaluation *e = evaluation_start(CUTOFF_M);
    struct evaluation_point target = point_at(1, 0.0, 0.0);
    struct evaluation_point first[2] = {point_at(2, 10.0, 0.0), point_at(3, 900.0, 0.0)};
    struct evaluation_point then[3] = {point_at(3, 10.0, 0.0), point_at(2, 900.0, 0.0),
                                       point_at(4, 0.0, 900.0)};
    struct evaluation_point last[1] = {point_at(2, 900.0, 0.0)};
    evaluation_add_time(e, 0, &target, 1, first, 2);
    evaluation_add_time(e, 900 * (int64_t)S, &target, 1, then, 3);
    evaluation_add_time(e, 1800 * (int64_t)S, &target, 1, last, 1);
    struct evaluation_result r = evaluation_result(e);
    assert_true(r.tracks == 3 && r.false_tracks == 2 && is_near(r.false_per_hour, 4.0));
    assert_true(is_near(r.gospa_false, 4.0 / 3.0) && is_near(r.false_per_scan, 4.0 / 3.0));
    assert_true(is_near(r.gospa_missed, 1.0 / 3.0));
    /* squared GOSPA in m^2: 100 + 5000; 100 + 2 x 5000; 2 x 5000 */
    assert_true(is_near(r.gospa_m, sqrt((5100.0 + 10100.0 + 10000.0) / 3.0)));
    assert_true(is_near(r.gospa_localisation_m, sqrt(200.0 / 3.0)));
    assert_true(is_near(r.ospa_m,
                        (sqrt((100.0 + 1e4) / 2.0) + sqrt((100.0 + 2e4) / 3.0) + CUTOFF_M) / 3.0));
    size_t count;
    const struct evaluation_scan *scans = evaluation_results_over_time(e, &count);
    assert_true(is_near(scans[1].gospa_m, sqrt(10100.0)) && is_near(scans[1].missed_m2, 0.0) &&
                is_near(scans[1].false_m2, 10000.0) && is_near(scans[1].localisation_m2, 100.0));
    assert_true(scans[1].targets == 1 && scans[1].tracks == 3 && scans[1].pairs == 1);
    evaluation_free(e);
}

/* Targets that appear in another order than that of their identities, which may be any number. */
static void results_by_target_are_sorted_by_identity(void **state)
{
    (void)state;
    struct evaluation *e = evaluation_start(CUTOFF_M);
    struct evaluation_point first[2] = {point_at(INT32_MAX, 0.0, 0.0), point_at(-5, 1000.0, 0.0)};
    struct evaluation_point then[3] = {point_at(-5, 1000.0, 0.0), point_at(INT32_MIN, 2000.0, 0.0),
                                       point_at(INT32_MAX, 0.0, 0.0)};
    struct evaluation_point tracks[2] = {point_at(INT32_MIN, 1003.0, 0.0),
                                         point_at(0, 2004.0, 0.0)};
    evaluation_add_time(e, 0, first, 2, NULL, 0);
    evaluation_add_time(e, S, then, 3, tracks, 2);
    evaluation_add_time(e, 2 * S, then, 3, tracks, 1);
    size_t count;
    struct evaluation_target *targets = evaluation_results_by_target(e, &count);
    assert_true(count == 3 && targets[0].id == INT32_MIN && targets[1].id == -5 &&
                targets[2].id == INT32_MAX);
    assert_true(targets[0].first_us == S && targets[0].scans == 2 && targets[0].paired == 1 &&
                targets[0].delay_scans == 0 && targets[0].kept_until_us == S);
    assert_true(is_near(targets[0].errors.median_m, 4.0) && is_near(targets[0].errors.p95_m, 4.0));
    assert_true(targets[1].first_us == 0 && targets[1].last_us == 2 * S && targets[1].paired == 2 &&
                targets[1].delay_scans == 1 && targets[1].found_us == S);
    assert_true(is_near(targets[1].errors.rmse_m, 3.0) && targets[1].switches == 0);
    assert_true(targets[2].scans == 3 && targets[2].paired == 0 && isnan(targets[2].errors.rmse_m));
    struct evaluation_result r = evaluation_result(e);
    assert_true(is_near(r.delay_scans, 0.5) && is_near(r.delay_s, 0.5) && r.targets_found == 2);
    free(targets);
    evaluation_free(e);
}

/*
 * 3000 targets and as many tracks over 20 times: each keeps its own result, and their sum is the
 * total.
 */
static void results_of_3000_targets_sum_to_the_total(void **state)
{
    (void)state;
    enum { MANY = 3000, TIMES = 20 };
    struct evaluation *e = evaluation_start(CUTOFF_M);
    struct evaluation_point *targets = calloc(MANY, sizeof *targets);
    struct evaluation_point *tracks = calloc(MANY, sizeof *tracks);
    for (int t = 0; t < TIMES; t++) {
        size_t num_tracks = 0;
        for (int i = 0; i < MANY; i++) {
            targets[i] = point_at(i * 70000, 300.0 * (i % 60), 300.0 * (i / 60));
            if ((i + t) % 7 != 0) { /* every target is without a track at every seventh time */
                tracks[num_tracks] = point_at(1000000007 - 64 * i, targets[i].x_m, targets[i].y_m);
                tracks[num_tracks++].y_m += i % 50;
            }
        }
        evaluation_add_time(e, t * S, targets, MANY, tracks, num_tracks);
    }
    struct evaluation_result r = evaluation_result(e);
    size_t count, paired = 0, fragments = 0;
    struct evaluation_target *by_target = evaluation_results_by_target(e, &count);
    for (size_t i = 0; i < count; i++) {
        assert_int_equal(by_target[i].id, (int32_t)i * 70000);
        assert_true(is_near(by_target[i].errors.median_m, (double)(i % 50)));
        assert_true(is_near(by_target[i].errors.rmse_m, (double)(i % 50)));
        paired += by_target[i].paired;
        fragments += by_target[i].fragments;
    }
    assert_true(r.targets == MANY && count == MANY && r.tracks == MANY && r.false_tracks == 0);
    assert_true(r.switches == 0 && r.fragments == fragments && r.errors.pairs == paired);
    assert_true(is_near(r.completeness, (double)paired / (MANY * TIMES)));
    assert_true(is_near(r.errors.median_m, 24.0) || is_near(r.errors.median_m, 25.0));
    free(by_target);
    free(targets);
    free(tracks);
    evaluation_free(e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_empty_evaluation_has_no_figures),
        cmocka_unit_test(identity_switches_and_fragments_are_counted_separately),
        cmocka_unit_test(an_absent_target_adds_no_fragment),
        cmocka_unit_test(quantiles_of_errors_are_interpolated),
        cmocka_unit_test(velocity_errors_need_the_velocity_of_track_and_target),
        cmocka_unit_test(nees_uses_the_full_covariance),
        cmocka_unit_test(velocity_nees_uses_the_velocity_covariance),
        cmocka_unit_test(errors_are_split_by_straight_turning_and_coasting),
        cmocka_unit_test(the_nees_ellipse_ends_at_chi_square_5_99),
        cmocka_unit_test(tracks_unpaired_in_most_rows_are_false),
        cmocka_unit_test(results_by_target_are_sorted_by_identity),
        cmocka_unit_test(results_of_3000_targets_sum_to_the_total),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
