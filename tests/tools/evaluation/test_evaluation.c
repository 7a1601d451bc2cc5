/* SPDX-License-Identifier: MIT */
/* The figures of tracks against truth, on scenes whose answers are known by hand. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "evaluation/evaluation.h"

#define S 1000000 /* us */
#define CUTOFF_M 100.0

static bool is_near(double value, double expected)
{
    return fabs(value - expected) <= 1e-9 * fmax(1.0, fabs(expected));
}

/* Without velocity and covariance. */
static struct evaluation_point at(int32_t id, double x_m, double y_m)
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

/* A target in the origin and, where track is above 0, that track error_m beside it. */
static void step(struct evaluation *e, int64_t time_s, int32_t track, double error_m)
{
    struct evaluation_point target = at(7, 0.0, 0.0), there = at(track, error_m, 0.0);
    evaluation_add_time(e, time_s * S, &target, 1, &there, track > 0);
}

static void nothing_is_known_of_nothing(void **state)
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

/*
 * Track 1, a gap, track 1 again, track 2 at once, a gap, track 2 again, a gap with track 3 at its
 * end, a gap.
 */
static void switches_and_fragments_are_told_apart(void **state)
{
    (void)state;
    static const int32_t track[] = {0, 0, 1, 1, 0, 1, 2, 0, 0, 2, 0, 3, 3, 0};
    static const size_t switches[] = {0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0};
    static const size_t fragments[] = {0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0};
    struct evaluation *e = evaluation_start(CUTOFF_M);
    for (int i = 0; i < 14; i++) {
        step(e, 10 + 2 * i, track[i], 5.0);
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

/* A target that is not there has no gap; one that is found only later has no fragment. */
static void absence_is_no_fragment(void **state)
{
    (void)state;
    struct evaluation *e = evaluation_start(CUTOFF_M);
    struct evaluation_point other = at(8, 5000.0, 0.0);
    step(e, 0, 1, 5.0);
    evaluation_add_time(e, 1 * S, &other, 1, NULL, 0);
    step(e, 2, 1, 5.0);
    struct evaluation_result r = evaluation_result(e);
    assert_int_equal(r.fragments, 0);
    assert_true(r.targets == 2 && r.targets_found == 1 && is_near(r.completeness, 2.0 / 3.0));
    evaluation_free(e);
}

static void quantiles_interpolate(void **state)
{
    (void)state;
    static const double errors_m[] = {9.0, 1.0, 4.0, 2.0};
    struct evaluation *e = evaluation_start(CUTOFF_M);
    step(e, 0, 1, 3.0);
    struct evaluation_result r = evaluation_result(e);
    assert_true(r.errors.median_m == 3.0 && r.errors.p95_m == 3.0 && r.errors.rmse_m == 3.0);
    assert_true(isnan(r.errors.rmse_mps) && isnan(r.errors.median_mps) && isnan(r.errors.p95_mps));
    for (int i = 0; i < 4; i++) {
        step(e, 1 + i, 1, errors_m[i]);
    }
    r = evaluation_result(e); /* 1 2 3 4 9 */
    assert_true(is_near(r.errors.median_m, 3.0) && is_near(r.errors.p95_m, 4.0 + 0.8 * 5.0));
    assert_true(is_near(r.errors.rmse_m, sqrt(111.0 / 5.0)));
    step(e, 5, 1, 5.0); /* 1 2 3 4 5 9 */
    r = evaluation_result(e);
    assert_true(is_near(r.errors.median_m, 3.5) && is_near(r.errors.p95_m, 5.0 + 0.75 * 4.0));
    evaluation_free(e);
}

/* Errors of velocity are those of the pairs that have both; a height's count. */
static void velocities_count_where_both_are_known(void **state)
{
    (void)state;
    struct evaluation *e = evaluation_start(CUTOFF_M);
    struct evaluation_point targets[3] = {at(1, 0, 0), at(2, 1000, 0), at(3, 2000, 0)};
    struct evaluation_point tracks[3] = {at(11, 2, 3), at(12, 1000, 0), at(13, 2000, 0)};
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

/* P = [4 2; 2 3], det 8, inverse [3 -2; -2 4] / 8. */
static void nees_is_that_of_the_covariance(void **state)
{
    (void)state;
    struct evaluation *e = evaluation_start(CUTOFF_M);
    struct evaluation_point targets[5], tracks[5];
    for (int i = 0; i < 5; i++) {
        targets[i] = at(i, 1000.0 * i, 0.0);
        tracks[i] = with_covariance(at(20 + i, 1000.0 * i, 0.0), 4.0, 2.0, 3.0);
    }
    tracks[0].x_m += 2.0, tracks[0].y_m += 1.0;              /* (12 - 8 + 4) / 8 = 1 */
    tracks[1].x_m += 4.0, tracks[1].y_m -= 1.0;              /* (48 + 16 + 4) / 8 = 8.5, outside */
    tracks[2] = at(22, 2000.0, 50.0);                        /* none is given */
    tracks[3] = with_covariance(tracks[3], 4.0, 4.0, 4.0);   /* singular */
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
 * The same matrix for velocities, over the 2 of its mean: 1 / 2, 8.5 / 2. Without a velocity, a
 * covariance or a positive definite one there is none, whatever is known of the place.
 */
static void velocities_have_a_ratio_of_their_own(void **state)
{
    (void)state;
    struct evaluation *e = evaluation_start(CUTOFF_M);
    struct evaluation_point targets[5], tracks[5];
    for (int i = 0; i < 5; i++) {
        targets[i] = with_velocity(at(i, 1000.0 * i, 0.0), 100.0, -50.0);
        tracks[i] = with_velocity_covariance(
            with_velocity(at(20 + i, 1000.0 * i, 0.0), 100.0, -50.0), 4.0, 2.0, 3.0);
    }
    tracks[0].vx_mps += 2.0, tracks[0].vy_mps += 1.0;
    tracks[1].vx_mps += 4.0, tracks[1].vy_mps -= 1.0;
    tracks[2] = with_velocity_covariance(at(22, 2000.0, 0.0), 4.0, 2.0, 3.0);
    tracks[3] = with_covariance(with_velocity(at(23, 3000.0, 0.0), 90.0, 0.0), 1.0, 0.0, 1.0);
    tracks[4] = with_velocity_covariance(tracks[4], 4.0, 4.0, 4.0);
    evaluation_add_time(e, 0, targets, 5, tracks, 5);
    struct evaluation_result r = evaluation_result(e);
    assert_true(is_near(r.errors.velocity_ratio, 4.75 / 2.0) && r.errors.velocity_inside == 0.5);
    assert_true(r.errors.nees == 0.0 && r.errors.nees_inside == 1.0); /* of the fourth */
    size_t count;
    assert_true(is_near(evaluation_results_over_time(e, &count)->velocity_ratio, 4.75 / 2.0));
    evaluation_free(e);
}

/*
 * What one target does and its track: two seconds of 10 m/s, a turn of 0.1 m/s^2, a missed scan in
 * it, straight again, a velocity that is not given. Errors tell the times apart: the root mean
 * square of a motion's.
 */
static void motions_are_told_apart(void **state)
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
        struct evaluation_point target = with_velocity(at(1, 0.0, 0.0), vx_mps[i], 0.0);
        struct evaluation_point track = at(2, error_m, 0.0);
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
    /* 0.04 m/s in a second is a turn, and below another limit none */
    struct evaluation_point track = at(2, 0.0, 0.0);
    struct evaluation_point target = with_velocity(at(1, 0.0, 0.0), 10.47, 0.0);
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

/* The ellipse ends at chi-square 5.9915. */
static void the_ellipse_is_that_of_95_percent(void **state)
{
    (void)state;
    struct evaluation *e = evaluation_start(CUTOFF_M);
    struct evaluation_point target = at(1, 0.0, 0.0), track;
    track = with_covariance(at(1, sqrt(5.991), 0.0), 1.0, 0.0, 1.0);
    evaluation_add_time(e, 0, &target, 1, &track, 1);
    assert_true(evaluation_result(e).errors.nees_inside == 1.0);
    track.x_m = sqrt(5.992);
    evaluation_add_time(e, S, &target, 1, &track, 1);
    assert_true(is_near(evaluation_result(e).errors.nees_inside, 0.5));
    evaluation_free(e);
}

/*
 * Track 2 is alone in two of three rows, track 3 in one of two, track 4 in its only one; over half
 * an hour.
 */
static void false_tracks_are_alone_most_of_the_time(void **state)
{
    (void)state;
    struct evaluation *e = evaluation_start(CUTOFF_M);
    struct evaluation_point target = at(1, 0.0, 0.0);
    struct evaluation_point first[2] = {at(2, 10.0, 0.0), at(3, 900.0, 0.0)};
    struct evaluation_point then[3] = {at(3, 10.0, 0.0), at(2, 900.0, 0.0), at(4, 0.0, 900.0)};
    struct evaluation_point last[1] = {at(2, 900.0, 0.0)};
    evaluation_add_time(e, 0, &target, 1, first, 2);
    evaluation_add_time(e, 900 * (int64_t)S, &target, 1, then, 3);
    evaluation_add_time(e, 1800 * (int64_t)S, &target, 1, last, 1);
    struct evaluation_result r = evaluation_result(e);
    assert_true(r.tracks == 3 && r.false_tracks == 2 && is_near(r.false_per_hour, 4.0));
    assert_true(is_near(r.gospa_false, 4.0 / 3.0) && is_near(r.false_per_scan, 4.0 / 3.0));
    assert_true(is_near(r.gospa_missed, 1.0 / 3.0));
    /* squares: 100 + 5000; 100 + 2 x 5000; 2 x 5000 */
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

/* Targets that appear, in an order that is not that of their identities, which may be any. */
static void targets_are_listed_by_identity(void **state)
{
    (void)state;
    struct evaluation *e = evaluation_start(CUTOFF_M);
    struct evaluation_point first[2] = {at(INT32_MAX, 0.0, 0.0), at(-5, 1000.0, 0.0)};
    struct evaluation_point then[3] = {at(-5, 1000.0, 0.0), at(INT32_MIN, 2000.0, 0.0),
                                       at(INT32_MAX, 0.0, 0.0)};
    struct evaluation_point tracks[2] = {at(INT32_MIN, 1003.0, 0.0), at(0, 2004.0, 0.0)};
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
 * 3000 targets and as many tracks over 20 times: each is found under a number of its own, and the
 * parts are the whole.
 */
static void many_identities_add_up(void **state)
{
    (void)state;
    enum { MANY = 3000, TIMES = 20 };
    struct evaluation *e = evaluation_start(CUTOFF_M);
    struct evaluation_point *targets = calloc(MANY, sizeof *targets);
    struct evaluation_point *tracks = calloc(MANY, sizeof *tracks);
    for (int t = 0; t < TIMES; t++) {
        size_t num_tracks = 0;
        for (int i = 0; i < MANY; i++) {
            targets[i] = at(i * 70000, 300.0 * (i % 60), 300.0 * (i / 60));
            if ((i + t) % 7 != 0) { /* each is without a track every seventh time */
                tracks[num_tracks] = at(1000000007 - 64 * i, targets[i].x_m, targets[i].y_m);
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
        cmocka_unit_test(nothing_is_known_of_nothing),
        cmocka_unit_test(switches_and_fragments_are_told_apart),
        cmocka_unit_test(absence_is_no_fragment),
        cmocka_unit_test(quantiles_interpolate),
        cmocka_unit_test(velocities_count_where_both_are_known),
        cmocka_unit_test(nees_is_that_of_the_covariance),
        cmocka_unit_test(velocities_have_a_ratio_of_their_own),
        cmocka_unit_test(motions_are_told_apart),
        cmocka_unit_test(the_ellipse_is_that_of_95_percent),
        cmocka_unit_test(false_tracks_are_alone_most_of_the_time),
        cmocka_unit_test(targets_are_listed_by_identity),
        cmocka_unit_test(many_identities_add_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
