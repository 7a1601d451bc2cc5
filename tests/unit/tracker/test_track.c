/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "rhotrack/detail/track.h"
#include "rhotrack/tracker.h"

static const struct rho_track_model model = {.speed_sigma_mps = 300.0f, .noise_density = 1.0f};

static void plots_on_line(struct rho_track_plot *plots, unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        plots[i] = (struct rho_track_plot){.time_us = 2000000 * (int64_t)i,
                                           .plot = {.x_m = 500.0f * (float)i,
                                                    .y_m = -100.0f * (float)i,
                                                    .sigma_range_m = 10.0f,
                                                    .sigma_cross_m = 10.0f},
                                           .sensor_id = 9,
                                           .row = (int16_t)i};
    }
}

static struct rho_track start_track(int32_t score_mnat)
{
    struct rho_track_plot plots[5];
    struct rho_track track;
    plots_on_line(plots, 5);
    assert_int_equal(rho_track_start(&track, 42, plots, 5, &model, score_mnat), RHO_OK);
    return track;
}

static struct rho_track_plot seen_at(int64_t time_us, const struct rho_plot *plot)
{
    return (struct rho_track_plot){
        .time_us = time_us + plot->offset_us, .sensor_id = 9, .plot = *plot};
}

static void status_changes_follow_the_table_of_events(void **state)
{
    (void)state;
    enum {
        F = RHO_TRACK_FREE,
        T = RHO_TRACK_TENTATIVE,
        C = RHO_TRACK_CONFIRMED,
        O = RHO_TRACK_COASTING
    };
    static const int expected[RHO_NUM_TRACK_STATUS][RHO_NUM_TRACK_EVENTS] = {
        /* start confirm update miss doubt drop */
        {T, F, F, F, F, F}, /* free */
        {T, C, T, T, T, F}, /* tentative */
        {C, C, C, O, T, F}, /* confirmed */
        {O, O, C, O, T, F}, /* coasting */
    };
    for (int status = 0; status < RHO_NUM_TRACK_STATUS; status++) {
        for (int event = 0; event < RHO_NUM_TRACK_EVENTS; event++) {
            assert_int_equal(
                rho_track_next_status((enum rho_track_status)status, (enum rho_track_event)event),
                expected[status][event]);
            struct rho_track track = {.status = (uint8_t)status};
            rho_track_apply_event(&track, (enum rho_track_event)event);
            assert_int_equal(track.status, expected[status][event]);
        }
    }
    assert_int_equal(rho_track_next_status((enum rho_track_status)77, RHO_TRACK_DROP), 77);
    assert_int_equal(rho_track_next_status(RHO_TRACK_CONFIRMED, (enum rho_track_event)99), C);
    assert_string_equal(rho_track_status_name(RHO_TRACK_COASTING), "coasting");
    assert_string_equal(rho_track_status_name((enum rho_track_status)4), "unknown");
}

static void a_track_starts_from_its_plots(void **state)
{
    (void)state;
    struct rho_track track = start_track(1000);
    assert_int_equal(track.status, RHO_TRACK_TENTATIVE);
    assert_int_equal(track.track_id, 42);
    assert_int_equal(track.hits, 5);
    assert_int_equal(track.plot, 4);
    assert_float_equal(track.kalman.state[0], 2000.0f, 5.0f);
    assert_float_equal(track.kalman.state[3], 250.0f, 3.0f);
    assert_float_equal(track.kalman.state[4], -50.0f, 3.0f);
    assert_in_range((int)(rho_track_sigma_m(&track) * 10.0f), 40, 100);
    assert_in_range((int)(rho_track_sigma_mps(&track) * 10.0f), 10, 60);
}

/* The state has the plot's noise, and the model's prior velocity until the second plot. */
static void a_single_plot_may_start_a_track(void **state)
{
    (void)state;
    struct rho_track_plot plots[2];
    struct rho_track track;
    plots_on_line(plots, 2);
    assert_int_equal(rho_track_start(&track, 7, plots, 1, &model, 300), RHO_OK);
    assert_int_equal(track.status, RHO_TRACK_TENTATIVE);
    assert_int_equal(track.hits, 1);
    assert_int_equal(track.plot, 0);
    assert_int_equal(track.filter, RHO_TRACK_KALMAN);
    assert_float_equal(rho_track_sigma_m(&track), 10.0f, 1e-3f);
    assert_float_equal(rho_track_sigma_mps(&track), 300.0f, 1e-2f);
    assert_float_equal(track.kalman.state[3], 0.0f, 0.0f);
    assert_int_equal(rho_track_predict(&track, plots[1].time_us, &model), RHO_OK);
    assert_int_equal(rho_track_update_by_plot(&track, &plots[1], &model, 0), RHO_OK);
    /* 14 m of noise over 2 s; the prior of 300 m/s weighs a thousandth */
    assert_float_equal(track.kalman.state[3], 250.0f, 1.0f);
    assert_float_equal(track.kalman.state[4], -50.0f, 1.0f);
    assert_float_equal(rho_track_sigma_mps(&track), 7.16f, 0.1f);
    assert_int_equal(track.hits, 2);
}

static void bad_starts_are_refused(void **state)
{
    (void)state;
    struct rho_track_plot plots[5];
    struct rho_track track, before;
    plots_on_line(plots, 5);
    memset(&track, 0x11, sizeof track);
    before = track;
    assert_int_equal(rho_track_start(NULL, 1, plots, 5, &model, 0), RHO_ERROR_NULL);
    assert_int_equal(rho_track_start(&track, 1, NULL, 5, &model, 0), RHO_ERROR_NULL);
    assert_int_equal(rho_track_start(&track, 1, plots, 5, NULL, 0), RHO_ERROR_NULL);
    assert_int_equal(rho_track_start(&track, 1, plots, 0, &model, 0), RHO_ERROR_VALUE);
    plots[2].plot.x_m = NAN;
    assert_int_not_equal(rho_track_start(&track, 1, plots, 5, &model, 0), RHO_OK);
    plots_on_line(plots, 5);
    plots[0].plot.sigma_range_m = plots[0].plot.sigma_cross_m = 0.0f;
    assert_int_not_equal(rho_track_start(&track, 1, plots, 5, &model, 0), RHO_OK);
    assert_memory_equal(&track, &before, sizeof track);
}

static void an_update_moves_the_estimate_and_the_score(void **state)
{
    (void)state;
    struct rho_track track = start_track(1000);
    struct rho_plot plot = {
        .x_m = 2505.0f, .y_m = -495.0f, .sigma_range_m = 10.0f, .sigma_cross_m = 10.0f};
    struct rho_track_plot seen = seen_at(10000000, &plot);
    assert_int_equal(rho_track_predict(&track, 10000000, &model), RHO_OK);
    float before_m = rho_track_sigma_m(&track);
    assert_int_equal(rho_track_update_by_plot(&track, &seen, &model, 2500), RHO_OK);
    assert_true(rho_track_sigma_m(&track) < before_m);
    assert_int_equal(track.score_mnat, 3500);
    assert_int_equal(track.score_max_mnat, 3500);
    assert_int_equal(track.hits, 6);
    assert_int_equal(track.sensor_id, 9);
    assert_int_equal(track.plot, 0);
    assert_int_equal(track.updated_us, 10000000);
}

static void a_plot_updates_at_its_own_time(void **state)
{
    (void)state;
    struct rho_track late = start_track(0), on_time = late;
    struct rho_plot now = {
        .x_m = 2500.0f, .y_m = -500.0f, .sigma_range_m = 10.0f, .sigma_cross_m = 10.0f};
    struct rho_plot then = now;
    then.offset_us = 1000000;
    then.x_m += 250.0f; /* where the target is one second later */
    then.y_m -= 50.0f;
    struct rho_track_plot seen = seen_at(10000000, &now), later = seen_at(10000000, &then);
    assert_int_equal(rho_track_predict(&on_time, 10000000, &model), RHO_OK);
    assert_int_equal(rho_track_predict(&late, 10000000, &model), RHO_OK);
    assert_int_equal(rho_track_update_by_plot(&on_time, &seen, &model, 0), RHO_OK);
    assert_int_equal(rho_track_update_by_plot(&late, &later, &model, 0), RHO_OK);
    assert_int_equal(late.time_us, 11000000);
    assert_int_equal(late.updated_us, 11000000);
    /* predicts back in time */
    assert_int_equal(rho_track_predict(&late, 10000000, &model), RHO_OK);
    assert_float_equal(late.kalman.state[0], on_time.kalman.state[0], 1.0f);
    assert_float_equal(late.kalman.state[3], on_time.kalman.state[3], 1.0f);
    assert_int_equal(late.time_us, 10000000);
}

/*
 * Scan times matter only for gates: from plot to plot the estimate is that of one long prediction.
 */
static void scan_times_do_not_change_the_estimate(void **state)
{
    (void)state;
    struct rho_track track = start_track(0);
    struct rho_kalman direct = track.kalman;
    int64_t at_us = track.time_us;
    for (int k = 0; k < 10; k++) {
        int64_t scan_us = 10000000 + 2000000 * (int64_t)k;
        struct rho_plot plot = {.offset_us = 173000 * k,
                                .x_m = 2500.0f + 500.0f * (float)k,
                                .y_m = -500.0f,
                                .sigma_range_m = 10.0f,
                                .sigma_cross_m = 10.0f};
        struct rho_track_plot seen = seen_at(scan_us, &plot);
        assert_int_equal(rho_track_predict(&track, scan_us, &model), RHO_OK);
        assert_int_equal(rho_track_update_by_plot(&track, &seen, &model, 0), RHO_OK);
        assert_int_equal(rho_kalman_predict(&direct, (float)(seen.time_us - at_us) * 1e-6f, 1.0f),
                         RHO_OK);
        assert_int_equal(rho_kalman_update(&direct, 0, plot.x_m, 100.0f, NULL), RHO_OK);
        assert_int_equal(rho_kalman_update(&direct, 1, plot.y_m, 100.0f, NULL), RHO_OK);
        at_us = seen.time_us;
        for (int i = 0; i < 21; i++) {
            assert_float_equal(track.kalman.covariance[i], direct.covariance[i],
                               1e-3f + 1e-4f * fabsf(direct.covariance[i]));
        }
        for (int i = 0; i < 6; i++) {
            assert_float_equal(track.kalman.state[i], direct.state[i], 0.02f);
        }
    }
}

static void refused_updates_change_nothing(void **state)
{
    (void)state;
    struct rho_track track = start_track(0), before = track;
    struct rho_plot plot = {.x_m = NAN, .sigma_range_m = 10.0f, .sigma_cross_m = 10.0f};
    struct rho_track_plot seen = seen_at(8000000, &plot);
    assert_int_equal(rho_track_update_by_plot(NULL, &seen, &model, 0), RHO_ERROR_NULL);
    assert_int_equal(rho_track_update_by_plot(&track, NULL, &model, 0), RHO_ERROR_NULL);
    assert_int_equal(rho_track_update_by_plot(&track, &seen, NULL, 0), RHO_ERROR_NULL);
    assert_int_equal(rho_track_update_by_plot(&track, &seen, &model, 0), RHO_ERROR_VALUE);
    seen.plot.x_m = 2000.0f;
    seen.plot.y_m = INFINITY; /* of the two scalar updates only the second one fails */
    assert_int_equal(rho_track_update_by_plot(&track, &seen, &model, 0), RHO_ERROR_VALUE);
    seen.plot.y_m = -400.0f;
    seen.measures = RHO_MEASURES_RANGE_RATE; /* no sigma of the range rate is given */
    assert_int_equal(rho_track_update_by_plot(&track, &seen, &model, 0), RHO_ERROR_VALUE);
    assert_int_equal(rho_track_predict(&track, INT64_MAX, &model), RHO_ERROR_VALUE);
    assert_memory_equal(&track, &before, sizeof track);
}

static void a_first_height_opens_the_third_axis(void **state)
{
    (void)state;
    struct rho_track track = start_track(0);
    struct rho_plot plot = {.x_m = 2000.0f,
                            .y_m = -400.0f,
                            .z_m = 3000.0f,
                            .vx_mps = 250.0f,
                            .vy_mps = -50.0f,
                            .vz_mps = 5.0f,
                            .sigma_range_m = 10.0f,
                            .sigma_cross_m = 10.0f,
                            .sigma_up_m = 20.0f,
                            .sigma_mps = 1.0f};
    struct rho_track_plot seen = seen_at(8000000, &plot);
    seen.measures = RHO_MEASURES_Z | RHO_MEASURES_VELOCITY;
    assert_false(rho_kalman_has_axis(&track.kalman, 2));
    assert_int_equal(rho_track_update_by_plot(&track, &seen, &model, 0), RHO_OK);
    assert_true(rho_kalman_has_axis(&track.kalman, 2));
    assert_float_equal(track.kalman.state[2], 3000.0f, 0.1f);
    assert_float_equal(track.kalman.state[5], 5.0f, 0.5f);
    /* at 56 degrees of elevation the variance of z is se^2 100 + ce^2 400, of both sigmas */
    assert_float_equal(track.kalman.covariance[RHO_AT(2, 2)], 194.8f, 1.0f);
}

static void a_miss_lowers_the_score_and_lets_a_confirmed_track_coast(void **state)
{
    (void)state;
    for (int is_confirmed = 0; is_confirmed < 2; is_confirmed++) {
        struct rho_track track = start_track(5000);
        track.status = is_confirmed ? RHO_TRACK_CONFIRMED : RHO_TRACK_TENTATIVE;
        for (int misses = 1; misses < 4; misses++) {
            rho_track_count_miss(&track, 2300);
            assert_int_equal(track.status, is_confirmed ? RHO_TRACK_COASTING : RHO_TRACK_TENTATIVE);
            assert_int_equal(track.misses, misses);
            assert_int_equal(track.misses_in_row, misses);
            assert_int_equal(track.score_mnat, 5000 - 2300 * misses);
            assert_int_equal(track.score_max_mnat, 5000);
        }
    }
}

/* The evidence of a look is what it changed the score by, in nat. */
static void hits_and_misses_of_a_look_add_up(void **state)
{
    (void)state;
    struct rho_plot plot = {
        .x_m = 2500.0f, .y_m = -500.0f, .sigma_range_m = 10.0f, .sigma_cross_m = 10.0f};
    struct rho_track track = start_track(5000);
    struct rho_track_plot seen = seen_at(10000000, &plot);
    assert_float_equal(track.look_nat, 0.0f, 0.0f); /* a start is no look */
    rho_track_count_miss(&track, 2300);
    assert_float_equal(track.look_nat, -2.3f, 1e-5f);
    assert_int_equal(rho_track_update_by_plot(&track, &seen, &model, 7100), RHO_OK);
    assert_float_equal(track.look_nat, 4.8f, 1e-5f);
    rho_track_add_score(&track, -5000);
    assert_float_equal(track.look_nat, -0.2f, 1e-5f);
}

static void counters_and_scores_stay_at_their_limits(void **state)
{
    (void)state;
    struct rho_track track = start_track(0);
    track.misses = UINT16_MAX;
    track.misses_in_row = UINT8_MAX;
    track.score_mnat = -999999999;
    rho_track_count_miss(&track, INT32_MAX);
    assert_int_equal(track.misses, UINT16_MAX);
    assert_int_equal(track.misses_in_row, UINT8_MAX);
    assert_int_equal(track.score_mnat, -1000000000);
}

/* Moved back and forward without noise, the track has its former estimate. */
static void going_back_in_time_restores_the_estimate(void **state)
{
    (void)state;
    struct rho_track track = start_track(9000);
    assert_int_equal(rho_track_predict(&track, 12000000, &model), RHO_OK);
    const struct rho_track was = track;
    assert_int_equal(rho_track_return(&track, 9000000, &model), RHO_OK);
    assert_int_equal(track.time_us, 9000000);
    assert_true(fabsf(track.kalman.state[0] - was.kalman.state[0] + 3.0f * was.kalman.state[3]) <
                0.01f);
    assert_int_equal(rho_track_return(&track, 12000000, &model), RHO_OK);
    assert_int_equal(track.time_us, 12000000);
    for (int i = 0; i < 6; i++) {
        assert_true(fabsf(track.kalman.state[i] - was.kalman.state[i]) < 0.01f);
    }
    assert_true(fabsf(track.kalman.covariance[0] - was.kalman.covariance[0]) <
                0.01f * was.kalman.covariance[0]);
    assert_int_equal(rho_track_return(NULL, 0, &model), RHO_ERROR_NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(status_changes_follow_the_table_of_events),
        cmocka_unit_test(a_track_starts_from_its_plots),
        cmocka_unit_test(a_single_plot_may_start_a_track),
        cmocka_unit_test(bad_starts_are_refused),
        cmocka_unit_test(an_update_moves_the_estimate_and_the_score),
        cmocka_unit_test(a_plot_updates_at_its_own_time),
        cmocka_unit_test(scan_times_do_not_change_the_estimate),
        cmocka_unit_test(refused_updates_change_nothing),
        cmocka_unit_test(a_first_height_opens_the_third_axis),
        cmocka_unit_test(a_miss_lowers_the_score_and_lets_a_confirmed_track_coast),
        cmocka_unit_test(hits_and_misses_of_a_look_add_up),
        cmocka_unit_test(counters_and_scores_stay_at_their_limits),
        cmocka_unit_test(going_back_in_time_restores_the_estimate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
