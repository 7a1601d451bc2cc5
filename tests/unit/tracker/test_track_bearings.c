/* SPDX-License-Identifier: MIT */
/* A track started from an estimate, and its updates by bearings. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "rhotrack/detail/track.h"

#include "one_bearing.h"

#define START_US INT64_C(7000000)

static const struct rho_track_model model = {.speed_sigma_mps = 300.0f, .noise_density = 1.0f};

static struct rho_kalman estimate_of_target(void)
{
    struct rho_kalman kalman;
    rho_kalman_init(&kalman);
    for (int axis = 0; axis < 2; axis++) {
        assert_int_equal(rho_kalman_open_axis(&kalman, axis, 3e4f, 1e4f, 400.0f), RHO_OK);
    }
    kalman.state[3] = -200.0f;
    kalman.covariance[RHO_AT(1, 0)] = 3000.0f;
    kalman.covariance[RHO_AT(3, 0)] = 700.0f;
    return kalman;
}

static struct rho_track start_track(void)
{
    const struct rho_kalman kalman = estimate_of_target();
    struct rho_track track;
    assert_int_equal(rho_track_start_estimate(&track, 42, &kalman, START_US, 9, 8, &model, 6000),
                     RHO_OK);
    return track;
}

/* A bearing from the origin to the estimate. */
static struct track_bearing bearing_at_time(int64_t time_us)
{
    return (struct track_bearing){
        .time_us = time_us, .sensor_id = 11, .bearing_rad = 0.787f, .sigma_rad = 0.002f, .row = 4};
}

static void a_track_starts_from_an_estimate(void **state)
{
    (void)state;
    const struct rho_kalman kalman = estimate_of_target();
    struct rho_track track = start_track();
    assert_int_equal(track.status, RHO_TRACK_TENTATIVE);
    assert_int_equal(track.track_id, 42);
    assert_int_equal(track.hits, 8);
    assert_int_equal(track.misses + track.misses_in_row, 0);
    assert_int_equal(track.plot, -1); /* no plot of the newest scan is known to be its own */
    assert_int_equal(track.sensor_id, 9);
    assert_int_equal(track.score_mnat, 6000);
    assert_int_equal(track.score_max_mnat, 6000);
    assert_true(track.time_us == START_US && track.updated_us == START_US);
    assert_memory_equal(&track.kalman, &kalman, sizeof kalman);
}

static void expect_start_refused(const struct rho_kalman *kalman, uint16_t hits)
{
    struct rho_track track, before;
    memset(&track, 0x5a, sizeof track);
    before = track;
    assert_int_equal(rho_track_start_estimate(&track, 42, kalman, START_US, 9, hits, &model, 6000),
                     RHO_ERROR_VALUE);
    assert_memory_equal(&track, &before, sizeof track);
}

static void starts_from_bad_estimates_are_refused(void **state)
{
    (void)state;
    struct rho_kalman kalman = estimate_of_target();
    struct rho_track track = start_track();
    assert_int_equal(rho_track_start_estimate(NULL, 1, &kalman, 0, 9, 8, &model, 0),
                     RHO_ERROR_NULL);
    assert_int_equal(rho_track_start_estimate(&track, 1, NULL, 0, 9, 8, &model, 0), RHO_ERROR_NULL);
    assert_int_equal(rho_track_start_estimate(&track, 1, &kalman, 0, 9, 8, NULL, 0),
                     RHO_ERROR_NULL);
    assert_int_equal(track.track_id, 42);
    expect_start_refused(&kalman, 0);
    for (int axis = 0; axis < 2; axis++) {
        kalman = estimate_of_target();
        kalman.covariance[RHO_AT(axis, axis)] = 0.0f;
        expect_start_refused(&kalman, 8);
        kalman.covariance[RHO_AT(axis, axis)] = NAN;
        expect_start_refused(&kalman, 8);
    }
    rho_kalman_init(&kalman);
    expect_start_refused(&kalman, 8);
}

/* Equals the filter's own prediction to the bearing's time, and its own update. */
static void a_bearing_updates_the_track_at_its_own_time(void **state)
{
    (void)state;
    const int64_t times_us[] = {START_US, START_US + 2500000, START_US - 1500000};
    for (int i = 0; i < 3; i++) {
        struct rho_track track = start_track();
        struct rho_kalman expected = track.kalman;
        const struct track_bearing bearing = bearing_at_time(times_us[i]);
        assert_int_equal(
            rho_kalman_predict(&expected, (float)(times_us[i] - START_US) * 1e-6f, 1.0f), RHO_OK);
        assert_int_equal(rho_kalman_update_bearing(&expected, 0.0f, 0.0f, bearing.bearing_rad,
                                                   bearing.sigma_rad),
                         RHO_OK);
        assert_int_equal(update_track_by_bearing(&track, &bearing, &model, 1500), RHO_OK);
        assert_memory_equal(&track.kalman, &expected, sizeof expected);
        assert_true(track.time_us == times_us[i] && track.updated_us == times_us[i]);
        assert_int_equal(track.score_mnat, 7500);
        assert_int_equal(track.score_max_mnat, 7500);
        assert_int_equal(track.sensor_id, 11);
        assert_int_equal(track.plot, 4);
        assert_int_equal(track.hits, 9);
    }
}

/* The next step resets the plot to -1. */
static void bearings_of_one_step_count_as_one_hit(void **state)
{
    (void)state;
    struct rho_track track = start_track();
    struct track_bearing bearing = bearing_at_time(START_US);
    rho_track_count_miss(&track, 100);
    rho_track_count_miss(&track, 100);
    assert_int_equal(track.misses_in_row, 2);
    for (int sensor = 0; sensor < 3; sensor++) {
        bearing.row = (int16_t)sensor;
        assert_int_equal(update_track_by_bearing(&track, &bearing, &model, 1000), RHO_OK);
    }
    assert_int_equal(track.hits, 9);
    assert_int_equal(track.misses, 2);
    assert_int_equal(track.misses_in_row, 0);
    assert_int_equal(track.score_mnat, 6000 - 200 + 3000);
    assert_int_equal(track.plot, 2);
    track.plot = -1;
    assert_int_equal(update_track_by_bearing(&track, &bearing, &model, 1000), RHO_OK);
    assert_int_equal(track.hits, 10);
    track.plot = -1;
    track.hits = UINT16_MAX;
    assert_int_equal(update_track_by_bearing(&track, &bearing, &model, 1000), RHO_OK);
    assert_int_equal(track.hits, UINT16_MAX);
}

static void a_bearing_ends_coasting_of_a_track(void **state)
{
    (void)state;
    struct rho_track track = start_track();
    const struct track_bearing bearing = bearing_at_time(START_US);
    assert_int_equal(update_track_by_bearing(&track, &bearing, &model, -20000), RHO_OK);
    assert_int_equal(track.status, RHO_TRACK_TENTATIVE); /* a bearing alone confirms no track */
    track = start_track();
    track.status = RHO_TRACK_CONFIRMED;
    rho_track_count_miss(&track, 100);
    assert_int_equal(track.status, RHO_TRACK_COASTING);
    assert_int_equal(update_track_by_bearing(&track, &bearing, &model, 100), RHO_OK);
    assert_int_equal(track.status, RHO_TRACK_CONFIRMED);
}

/* A mix of bearings of which none is claimed moves the estimate, and is neither hit nor miss. */
static void a_bearing_of_no_row_is_no_hit(void **state)
{
    (void)state;
    struct rho_track track = start_track(), sure = track;
    struct track_bearing bearing = bearing_at_time(START_US + 1000000);
    track.status = RHO_TRACK_CONFIRMED;
    rho_track_count_miss(&track, 100);
    assert_int_equal(update_track_by_bearing(&sure, &bearing, &model, 700), RHO_OK);
    bearing.row = -1;
    assert_int_equal(update_track_by_bearing(&track, &bearing, &model, 700), RHO_OK);
    assert_memory_equal(&track.kalman, &sure.kalman, sizeof sure.kalman);
    assert_true(track.time_us == START_US + 1000000);
    assert_true(track.updated_us == START_US);
    assert_int_equal(track.hits, 8);
    assert_int_equal(track.misses_in_row, 1);
    assert_int_equal(track.status, RHO_TRACK_COASTING);
    assert_int_equal(track.plot, -1);
    assert_int_equal(track.sensor_id, 9);
    assert_int_equal(track.score_mnat, 6000 - 100 + 700);
}

static void expect_refused(struct rho_track track, const struct track_bearing *bearing,
                           enum rho_status expected_error)
{
    const struct rho_track before = track;
    assert_int_equal(update_track_by_bearing(&track, bearing, &model, 100), expected_error);
    assert_memory_equal(&track, &before, sizeof track);
}

static void a_refused_bearing_changes_nothing(void **state)
{
    (void)state;
    struct rho_track track = start_track();
    struct track_bearing bearing = bearing_at_time(START_US + 1000000);
    assert_int_equal(update_track_by_bearing(NULL, &bearing, &model, 0), RHO_ERROR_NULL);
    assert_int_equal(update_track_by_bearing(&track, &bearing, NULL, 0), RHO_ERROR_NULL);
    expect_refused(track, NULL, RHO_ERROR_NULL);
    bearing.bearing_rad = NAN;
    expect_refused(track, &bearing, RHO_ERROR_VALUE);
    bearing = bearing_at_time(START_US + 1000000);
    bearing.sigma_rad = 0.0f;
    expect_refused(track, &bearing, RHO_ERROR_VALUE);
    bearing = bearing_at_time(INT64_C(4000000000000000000)); /* farther than a filter can predict */
    expect_refused(track, &bearing, RHO_ERROR_VALUE);
    bearing = bearing_at_time(START_US);
    track.kalman.covariance[RHO_AT(3, 3)] = 9e11f;
    bearing.time_us += 1000000000; /* the covariance grows beyond its limits */
    expect_refused(track, &bearing, RHO_ERROR_VALUE);
}

static void a_lowered_score_is_no_miss(void **state)
{
    (void)state;
    struct rho_track track = start_track(), before;
    before = track;
    rho_track_add_score(&track, -2303);
    assert_int_equal(track.score_mnat, 6000 - 2303);
    assert_float_equal(track.look_nat, -2.303f, 1e-5f);
    before.score_mnat = track.score_mnat;
    before.look_nat = track.look_nat;
    assert_memory_equal(&track, &before, sizeof track);
    for (int i = 0; i < 3; i++) {
        rho_track_add_score(&track, -INT32_MAX); /* the score stays at its limit */
    }
    assert_int_equal(track.score_mnat, -1000000000);
    assert_int_equal(track.score_max_mnat, 6000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_track_starts_from_an_estimate),
        cmocka_unit_test(starts_from_bad_estimates_are_refused),
        cmocka_unit_test(a_bearing_updates_the_track_at_its_own_time),
        cmocka_unit_test(bearings_of_one_step_count_as_one_hit),
        cmocka_unit_test(a_bearing_ends_coasting_of_a_track),
        cmocka_unit_test(a_bearing_of_no_row_is_no_hit),
        cmocka_unit_test(a_refused_bearing_changes_nothing),
        cmocka_unit_test(a_lowered_score_is_no_miss),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
