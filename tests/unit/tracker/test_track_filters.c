/* SPDX-License-Identifier: MIT */
/*
 * One track with each of its filters: plain Kalman, input estimation, hypotheses. Which functions
 * each filter has, and what is freed.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "rhotrack/detail/track.h"

#include "one_bearing.h"

#define SCAN_US 1000000
#define SIGMA_M 5.0f

static struct rho_hypotheses pool;
static struct rho_input_config estimation;
static struct rho_track_model model; /* model of the filter under test */

static void set_filter(enum rho_track_filter filter)
{
    struct rho_imm_model motion;
    rho_imm_model_default(&motion, 40.0f, 400.0f);
    assert_int_equal(rho_hypotheses_init(&pool, sizeof pool, &motion), RHO_OK);
    rho_input_config_default(&estimation);
    estimation.is_estimated = 1;
    estimation.model = RHO_INPUT_PHYSICAL;
    estimation.noise_m = estimation.noise_mps = 0.0f;
    estimation.noise_density = 1.0f;
    model = (struct rho_track_model){.speed_sigma_mps = 300.0f, .noise_density = 100.0f};
    model.hypotheses = filter == RHO_TRACK_HYPOTHESES ? &pool : NULL;
    model.input = filter == RHO_TRACK_INPUT ? &estimation : NULL;
}

/* Straight for 4 s, then 30 m/s^2 to the left of the course along x. */
static struct rho_track_plot plot_of_scan(int k)
{
    float t_s = (float)k, turned_s = k > 4 ? t_s - 4.0f : 0.0f;
    return (struct rho_track_plot){.time_us = (int64_t)SCAN_US * k,
                                   .plot = {.x_m = 200.0f * t_s,
                                            .y_m = 15.0f * turned_s * turned_s,
                                            .sigma_range_m = SIGMA_M,
                                            .sigma_cross_m = SIGMA_M},
                                   .sensor_id = 3,
                                   .row = 0};
}

static struct rho_track start_track(void)
{
    struct rho_track track;
    struct rho_track_plot plots[4] = {plot_of_scan(0), plot_of_scan(1), plot_of_scan(2),
                                      plot_of_scan(3)};
    assert_int_equal(rho_track_start(&track, 1, plots, 4, &model, 0), RHO_OK);
    return track;
}

static unsigned count_hypotheses_of_all_slots(void)
{
    unsigned nodes = 0;
    for (unsigned slot = 0; slot < RHO_HYPOTHESES_SLOTS; slot++) {
        nodes += rho_hypotheses_count(&pool, (uint16_t)slot);
    }
    assert_int_equal(nodes + pool.num_free, RHO_MAX_HYPOTHESES);
    return nodes;
}

/* ---- the model selects the filter ------------------------------------------------------------ */

static void the_model_selects_the_filter_of_a_track(void **state)
{
    (void)state;
    for (int filter = 0; filter < RHO_NUM_TRACK_FILTERS; filter++) {
        set_filter((enum rho_track_filter)filter);
        struct rho_track track = start_track();
        assert_int_equal(track.filter, filter);
        assert_int_equal(count_hypotheses_of_all_slots(), filter == RHO_TRACK_HYPOTHESES ? 1 : 0);
        assert_int_equal(track.time_us, 3 * SCAN_US);
        assert_float_equal(track.kalman.state[0], 600.0f, 2.0f);
        assert_float_equal(track.kalman.state[3], 200.0f, 2.0f);
        rho_track_free_hypotheses(&track, &model);
        assert_int_equal(count_hypotheses_of_all_slots(), 0);
    }
    /* with a pool of hypotheses, input estimation is not used */
    set_filter(RHO_TRACK_HYPOTHESES);
    model.input = &estimation;
    struct rho_track track = start_track();
    assert_int_equal(track.filter, RHO_TRACK_HYPOTHESES);
}

static void a_start_from_an_estimate_uses_the_models_filter(void **state)
{
    (void)state;
    struct rho_track track, plain;
    set_filter(RHO_TRACK_KALMAN);
    plain = start_track();
    for (int filter = 0; filter < RHO_NUM_TRACK_FILTERS; filter++) {
        set_filter((enum rho_track_filter)filter);
        assert_int_equal(
            rho_track_start_estimate(&track, 2, &plain.kalman, 3 * SCAN_US, 3, 5, &model, 100),
            RHO_OK);
        assert_int_equal(track.filter, filter);
        assert_float_equal(track.kalman.state[0], plain.kalman.state[0], 0.01f);
        struct rho_track_plot next = plot_of_scan(4);
        assert_int_equal(rho_track_predict(&track, next.time_us, &model), RHO_OK);
        assert_int_equal(rho_track_update_by_plot(&track, &next, &model, 0), RHO_OK);
        assert_int_equal(count_hypotheses_of_all_slots() > 0, filter == RHO_TRACK_HYPOTHESES);
        rho_track_free_hypotheses(&track, &model);
        assert_int_equal(count_hypotheses_of_all_slots(), 0);
    }
}

/* The paper's P(0|0) is the covariance at the end of a start, and used nowhere else. */
static void input_estimation_starts_with_the_initial_variance(void **state)
{
    (void)state;
    struct rho_track track, other;
    set_filter(RHO_TRACK_INPUT);
    other = start_track();
    estimation.initial_variance = 500.0f;
    for (int from_estimate = 0; from_estimate < 2; from_estimate++) {
        if (from_estimate) {
            assert_int_equal(
                rho_track_start_estimate(&track, 2, &other.kalman, 3 * SCAN_US, 3, 5, &model, 100),
                RHO_OK);
        } else {
            track = start_track();
        }
        for (int i = 0; i < RHO_KALMAN_STATES; i++) {
            assert_float_equal(track.kalman.state[i], other.kalman.state[i], 0.0f);
            for (int j = 0; j <= i; j++) {
                const int is_open = i % 3 < 2; /* axes x and y are open */
                assert_float_equal(track.kalman.covariance[RHO_AT(i, j)],
                                   i == j && is_open ? 500.0f : 0.0f, 0.0f);
            }
        }
    }
    estimation.initial_variance = 0.0f;
}

static void a_refused_start_gives_its_slot_back(void **state)
{
    (void)state;
    for (int filter = 0; filter < RHO_NUM_TRACK_FILTERS; filter++) {
        struct rho_track track, before;
        struct rho_track_plot plots[4] = {plot_of_scan(0), plot_of_scan(1), plot_of_scan(2),
                                          plot_of_scan(3)};
        set_filter((enum rho_track_filter)filter);
        memset(&track, 0x22, sizeof track);
        before = track;
        plots[2].plot.y_m = NAN;
        assert_int_not_equal(rho_track_start(&track, 1, plots, 4, &model, 0), RHO_OK);
        plots[2] = plot_of_scan(2);
        plots[2].time_us = INT64_MAX; /* no filter can predict to this time */
        assert_int_not_equal(rho_track_start(&track, 1, plots, 4, &model, 0), RHO_OK);
        assert_memory_equal(&track, &before, sizeof track);
        assert_int_equal(count_hypotheses_of_all_slots(), 0);
    }
}

/* The pool has one slot more than tracks, as a candidate is opened before it gets its row. */
static void a_full_pool_refuses_a_start(void **state)
{
    (void)state;
    static struct rho_track tracks[RHO_HYPOTHESES_SLOTS];
    struct rho_track one_more, before;
    struct rho_track_plot plot = plot_of_scan(0);
    set_filter(RHO_TRACK_HYPOTHESES);
    for (unsigned i = 0; i < RHO_HYPOTHESES_SLOTS; i++) {
        assert_int_equal(rho_track_start(&tracks[i], i, &plot, 1, &model, 0), RHO_OK);
    }
    memset(&one_more, 0x33, sizeof one_more);
    before = one_more;
    assert_int_equal(rho_track_start(&one_more, 9, &plot, 1, &model, 0), RHO_ERROR_CAPACITY);
    assert_memory_equal(&one_more, &before, sizeof before);
    const uint16_t slot = tracks[5].slot;
    rho_track_free_hypotheses(&tracks[5], &model);
    assert_int_equal(rho_track_start(&one_more, 9, &plot, 1, &model, 0), RHO_OK);
    assert_int_equal(one_more.slot, slot);
}

/* ---- commit and settle ----------------------------------------------------------------------- */

static enum rho_status commit_plots(struct rho_track *track, const struct rho_plot *plots,
                                    float log_miss)
{
    const struct rho_hypotheses_scan scan = {
        .time_us = track->time_us, .plots = plots, .log_miss = log_miss};
    return rho_track_commit_scan(track, &scan, 8, &model);
}

static void commit_and_settle_need_a_filter_of_hypotheses(void **state)
{
    (void)state;
    struct rho_plot plot = plot_of_scan(4).plot;
    const struct rho_hypotheses_scan scan = {.time_us = 3 * SCAN_US, .plots = &plot};
    for (int filter = 0; filter < RHO_TRACK_HYPOTHESES; filter++) {
        set_filter((enum rho_track_filter)filter);
        struct rho_track track = start_track(), before = track;
        assert_int_equal(commit_plots(&track, &plot, -2.0f), RHO_ERROR_STATE);
        rho_track_merge_estimates(&track, 9 * SCAN_US, &model);
        assert_memory_equal(&track, &before, sizeof track);
        model.hypotheses = &pool; /* an unused pool makes no difference */
        assert_int_equal(commit_plots(&track, &plot, -2.0f), RHO_ERROR_STATE);
        rho_track_merge_estimates(&track, 9 * SCAN_US, &model);
        rho_track_free_hypotheses(&track, &model);
        assert_memory_equal(&track, &before, sizeof track);
        assert_int_equal(count_hypotheses_of_all_slots(), 0);
    }
    set_filter(RHO_TRACK_HYPOTHESES);
    struct rho_track track = start_track();
    assert_int_equal(rho_track_commit_scan(NULL, &scan, 8, &model), RHO_ERROR_NULL);
    assert_int_equal(rho_track_commit_scan(&track, NULL, 8, &model), RHO_ERROR_NULL);
    assert_int_equal(rho_track_commit_scan(&track, &scan, 8, NULL), RHO_ERROR_NULL);
}

/* Steps a track of hypotheses with the plots of a scan; row 0 is its own. */
static void step_hypotheses(struct rho_track *track, int k, const struct rho_plot *plots,
                            int num_plots)
{
    const struct rho_hypotheses_clutter clutter = {.log_per_m2 = logf(1e-6f)};
    struct rho_hypotheses_box reach;
    struct rho_imm_plot opened;
    float gain_nat;
    track->plot = -1;
    assert_int_equal(rho_track_predict(track, (int64_t)SCAN_US * k, &model), RHO_OK);
    rho_hypotheses_gate_box(&pool, track->slot, &reach);
    for (int i = 0; i < num_plots; i++) {
        rho_imm_prepare_plot(&opened, &plots[i], 0, NULL);
        (void)rho_hypotheses_score_plot(&pool, track->slot, &opened, (int64_t)SCAN_US * k,
                                        (int16_t)i, logf(0.9f), &clutter, &gain_nat);
    }
    assert_int_equal(commit_plots(track, plots, logf(0.1f)), RHO_OK);
}

static void a_commit_counts_the_plot_of_the_best_hypothesis(void **state)
{
    (void)state;
    set_filter(RHO_TRACK_HYPOTHESES);
    struct rho_track track = start_track();
    struct rho_plot plots[2] = {plot_of_scan(4).plot, plot_of_scan(4).plot};
    plots[0].y_m += 2000.0f; /* a plot outside all gates */
    step_hypotheses(&track, 4, plots, 2);
    assert_int_equal(track.plot, 1);
    assert_int_equal(track.hits, 5);
    assert_int_equal(track.sensor_id, 8);
    assert_int_equal(track.updated_us, 4 * SCAN_US);
    /* ln(0.9 / 1e-6) less about ln(2 pi 10^2), for an innovation of 7 to 20 m */
    assert_in_range(track.score_mnat, 5000, 8500);
    assert_int_equal(track.score_max_mnat, track.score_mnat);
    int32_t score_mnat = track.score_mnat;
    step_hypotheses(&track, 5, plots, 0);
    assert_int_equal(track.plot, -1);
    assert_int_equal(track.hits, 5);
    assert_int_equal(track.sensor_id, 8);
    /* ln(0.1), the miss of all hypotheses */
    assert_in_range(score_mnat - track.score_mnat, 2301, 2304);
    assert_int_equal(track.misses, 0); /* misses are counted by rho_track_count_miss instead */
}

static void settling_sets_the_estimate_from_the_hypotheses(void **state)
{
    (void)state;
    set_filter(RHO_TRACK_HYPOTHESES);
    struct rho_track track = start_track();
    for (int k = 4; k < 10; k++) {
        struct rho_plot plot = plot_of_scan(k).plot;
        step_hypotheses(&track, k, &plot, 1);
        assert_int_equal(track.plot, 0);
        rho_track_merge_estimates(&track, (int64_t)SCAN_US * k, &model);
    }
    struct rho_hypotheses_estimate estimate;
    assert_int_equal(rho_hypotheses_estimate(&pool, track.slot, 9 * SCAN_US, &estimate), RHO_OK);
    assert_memory_equal(&estimate.kalman, &track.kalman, sizeof track.kalman);
    assert_memory_equal(estimate.accel_mps2, track.accel_mps2, sizeof track.accel_mps2);
    assert_float_equal(track.kalman.state[0], 1800.0f, 6.0f);
    assert_float_equal(track.kalman.state[1], 375.0f, 10.0f);
    assert_float_equal(track.kalman.state[4], 150.0f, 15.0f);
    /* measured 17.6: an acceleration is remembered for 3.5 s, and may already have ended */
    assert_float_equal(track.accel_mps2[1], 22.0f, 10.0f);
    assert_float_equal(track.accel_mps2[0], 0.0f, 5.0f);
    assert_true(track.maneuver_probability > 0.7f);
    /* at another time the estimate is predicted to it */
    rho_track_merge_estimates(&track, 9 * SCAN_US + SCAN_US / 2, &model);
    assert_int_equal(track.time_us, 9 * SCAN_US + SCAN_US / 2);
    assert_float_equal(track.kalman.state[0], 1900.0f, 8.0f);
}

/* Settling a closed slot leaves the track unchanged. */
static void settling_a_closed_slot_changes_nothing(void **state)
{
    (void)state;
    set_filter(RHO_TRACK_HYPOTHESES);
    struct rho_track track = start_track(), before;
    rho_track_free_hypotheses(&track, &model);
    before = track;
    rho_track_merge_estimates(&track, 5 * SCAN_US, &model);
    assert_int_not_equal(rho_track_predict(&track, 5 * SCAN_US, &model), RHO_OK);
    assert_memory_equal(&track, &before, sizeof track);
    rho_track_free_hypotheses(&track, &model); /* freed a second time */
    assert_int_equal(count_hypotheses_of_all_slots(), 0);
}

/* ---- every filter updated by a caller -------------------------------------------------------- */

/* For a caller that updates tracks itself, the settled estimate is at the plot's time. */
static void every_filter_is_updated_by_a_caller_plot_by_plot(void **state)
{
    (void)state;
    for (int filter = 0; filter < RHO_NUM_TRACK_FILTERS; filter++) {
        set_filter((enum rho_track_filter)filter);
        struct rho_track track = start_track();
        for (int k = 4; k < 14; k++) {
            struct rho_track_plot plot = plot_of_scan(k);
            assert_int_equal(rho_track_predict(&track, plot.time_us, &model), RHO_OK);
            assert_int_equal(rho_track_update_by_plot(&track, &plot, &model, 10), RHO_OK);
            assert_int_equal(track.time_us, plot.time_us);
            rho_track_merge_estimates(&track, plot.time_us, &model);
            assert_float_equal(track.kalman.state[0], plot.plot.x_m, 10.0f);
            assert_float_equal(track.kalman.state[1], plot.plot.y_m, 40.0f);
        }
        assert_int_equal(track.hits, 14);
        assert_int_equal(track.score_mnat, 100);
        /* measured: 0, 33.2 and 18.4 m/s^2 */
        static const float accel_mps2[RHO_NUM_TRACK_FILTERS] = {0.0f, 30.0f, 22.0f};
        static const float probability[RHO_NUM_TRACK_FILTERS] = {0.0f, 1.0f, 0.8f};
        assert_float_equal(track.accel_mps2[1], accel_mps2[filter], filter ? 8.0f : 0.0f);
        assert_float_equal(track.maneuver_probability, probability[filter],
                           filter == RHO_TRACK_HYPOTHESES ? 0.1f : 0.0f);
        assert_float_equal(track.newest_mps[0], 200.0f, 20.0f);
    }
}

/* Velocity and range rate with 1 m/s sigma, which four places alone give to about 4 m/s. */
static void every_filter_uses_velocity_and_range_rate(void **state)
{
    static const uint32_t kinds[] = {0, RHO_MEASURES_VELOCITY, RHO_MEASURES_RANGE_RATE};
    (void)state;
    for (int filter = 0; filter < RHO_NUM_TRACK_FILTERS; filter++) {
        for (int kind = 0; kind < 3; kind++) {
            set_filter((enum rho_track_filter)filter);
            struct rho_track track = start_track();
            struct rho_track_plot plot = plot_of_scan(4);
            plot.measures = kinds[kind];
            /* values that contradict the motion */
            plot.plot.vx_mps = plot.plot.range_rate_mps = 200.0f;
            plot.plot.sigma_mps = plot.plot.sigma_range_rate_mps = 1.0f;
            assert_int_equal(rho_track_predict(&track, plot.time_us, &model), RHO_OK);
            assert_int_equal(rho_track_update_by_plot(&track, &plot, &model, 0), RHO_OK);
            rho_track_merge_estimates(&track, plot.time_us, &model);
            assert_int_equal(track.kalman.covariance[RHO_AT(3, 3)]<1.5f, kind> 0);
            assert_int_equal(track.kalman.covariance[RHO_AT(4, 4)] < 1.5f, kind == 1);
        }
    }
}

static void refused_updates_leave_every_filter_unchanged(void **state)
{
    (void)state;
    for (int filter = 0; filter < RHO_NUM_TRACK_FILTERS; filter++) {
        set_filter((enum rho_track_filter)filter);
        struct rho_track track = start_track(), before = track;
        struct rho_track_plot bad = plot_of_scan(4);
        bad.plot.y_m = NAN;
        assert_int_not_equal(rho_track_update_by_plot(&track, &bad, &model, 10), RHO_OK);
        assert_memory_equal(&track, &before, sizeof track);
        struct rho_track_plot good = plot_of_scan(4);
        assert_int_equal(rho_track_predict(&track, good.time_us, &model), RHO_OK);
        assert_int_equal(rho_track_update_by_plot(&track, &good, &model, 10), RHO_OK);
        rho_track_merge_estimates(&track, good.time_us, &model);
        assert_float_equal(track.kalman.state[0], 800.0f, 10.0f);
        assert_float_equal(track.kalman.state[3], 200.0f, 10.0f);
    }
}

/* With input estimation the gate includes an input that may have begun since the last plot. */
static void only_input_estimation_widens_the_gate(void **state)
{
    (void)state;
    for (int filter = 0; filter < RHO_NUM_TRACK_FILTERS; filter++) {
        struct rho_kalman expected, of_input;
        set_filter((enum rho_track_filter)filter);
        struct rho_track track = start_track();
        assert_int_equal(rho_track_predict(&track, 4 * SCAN_US, &model), RHO_OK);
        rho_track_estimate_for_gate(&track, &expected);
        assert_float_equal(
            rho_track_noise_density(&track, &model),
            filter == RHO_TRACK_INPUT ? model.input->noise_density : model.noise_density, 0.0f);
        if (filter == RHO_TRACK_INPUT) {
            rho_input_gate_estimate(&track.input, &of_input);
            assert_memory_equal(&expected, &of_input, sizeof expected);
            /* 22 m/s^2 for a second: 11 m */
            assert_true(expected.covariance[RHO_AT(0, 0)] >
                        track.kalman.covariance[RHO_AT(0, 0)] + 100.0f);
        } else {
            assert_memory_equal(&expected, &track.kalman, sizeof expected);
        }
    }
}

/* ---- updates by bearings --------------------------------------------------------------------- */

/* The bearing of the target at scan k from (x, y), with 0.5 mrad sigma. */
static struct track_bearing bearing_from(float x_m, float y_m, int k)
{
    const struct rho_plot at = plot_of_scan(k).plot;
    return (struct track_bearing){.time_us = (int64_t)SCAN_US * k,
                                  .sensor_id = 4,
                                  .x_m = x_m,
                                  .y_m = y_m,
                                  .bearing_rad = atan2f(at.y_m - y_m, at.x_m - x_m),
                                  .sigma_rad = 5e-4f,
                                  .row = 1};
}

/*
 * Seen along y from 5 km the sigma across is 2.5 m after the update, so that the next sensor's gate
 * is narrower.
 */
static void a_bearing_reduces_the_covariance_of_every_filter(void **state)
{
    (void)state;
    for (int filter = 0; filter < RHO_NUM_TRACK_FILTERS; filter++) {
        set_filter((enum rho_track_filter)filter);
        struct rho_track track = start_track();
        struct track_bearing bearing = bearing_from(800.0f, -5000.0f, 4);
        assert_int_equal(rho_track_predict(&track, bearing.time_us, &model), RHO_OK);
        rho_track_merge_estimates(&track, bearing.time_us, &model);
        assert_true(track.kalman.covariance[RHO_AT(0, 0)] > 20.0f);
        assert_int_equal(update_track_by_bearing(&track, &bearing, &model, 0), RHO_OK);
        assert_true(track.kalman.covariance[RHO_AT(0, 0)] < 6.3f);
        assert_float_equal(track.kalman.state[0], 800.0f, 3.0f);
    }
}

/* A bearing counts as an update like a plot; the velocity of the last update in a step is kept. */
static void velocities_of_the_last_two_hits_are_kept(void **state)
{
    (void)state;
    for (int filter = 0; filter < RHO_TRACK_HYPOTHESES; filter++) {
        set_filter((enum rho_track_filter)filter);
        struct rho_track track = start_track();
        float before_mps = track.kalman.state[4];
        for (int k = 4; k < 9; k++) {
            struct track_bearing south = bearing_from(800.0f, -5000.0f, k);
            struct track_bearing east = bearing_from(7000.0f, 300.0f, k);
            track.plot = -1;
            assert_int_equal(rho_track_predict(&track, south.time_us, &model), RHO_OK);
            assert_int_equal(update_track_by_bearing(&track, &south, &model, 0), RHO_OK);
            assert_int_equal(update_track_by_bearing(&track, &east, &model, 0), RHO_OK);
            assert_float_equal(track.newest_mps[1], track.kalman.state[4], 0.0f);
            assert_float_equal(track.before_mps[1], before_mps, 0.0f);
            before_mps = track.kalman.state[4];
        }
        assert_int_equal(track.hits, 9);
    }
}

/*
 * Two simultaneous bearings: the first alone shows no input, and if that were decided at once, the
 * second could not show it any more: 43 m of error instead of 0.01 m.
 */
static void simultaneous_bearings_reveal_a_turn(void **state)
{
    static const float least[RHO_NUM_TRACK_FILTERS] = {0.0f, 1.0f, 0.6f};
    (void)state;
    for (int filter = 0; filter < RHO_NUM_TRACK_FILTERS; filter++) {
        set_filter((enum rho_track_filter)filter);
        struct rho_track track = start_track();
        for (int k = 4; k < 14; k++) {
            struct track_bearing south = bearing_from(800.0f, -5000.0f, k);
            struct track_bearing east = bearing_from(7000.0f, 300.0f, k);
            track.plot = -1;
            assert_int_equal(rho_track_predict(&track, south.time_us, &model), RHO_OK);
            assert_int_equal(update_track_by_bearing(&track, &south, &model, 0), RHO_OK);
            assert_int_equal(update_track_by_bearing(&track, &east, &model, 0), RHO_OK);
            rho_track_merge_estimates(&track, south.time_us, &model);
        }
        assert_float_equal(track.kalman.state[1], 15.0f * 81.0f, 5.0f);
        assert_float_equal(track.kalman.state[4], 270.0f, 20.0f);
        assert_true(track.maneuver_probability >= least[filter]);
        assert_true(filter == RHO_TRACK_KALMAN || track.accel_mps2[1] > 12.0f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_model_selects_the_filter_of_a_track),
        cmocka_unit_test(a_start_from_an_estimate_uses_the_models_filter),
        cmocka_unit_test(input_estimation_starts_with_the_initial_variance),
        cmocka_unit_test(a_refused_start_gives_its_slot_back),
        cmocka_unit_test(a_full_pool_refuses_a_start),
        cmocka_unit_test(commit_and_settle_need_a_filter_of_hypotheses),
        cmocka_unit_test(a_commit_counts_the_plot_of_the_best_hypothesis),
        cmocka_unit_test(settling_sets_the_estimate_from_the_hypotheses),
        cmocka_unit_test(settling_a_closed_slot_changes_nothing),
        cmocka_unit_test(every_filter_is_updated_by_a_caller_plot_by_plot),
        cmocka_unit_test(every_filter_uses_velocity_and_range_rate),
        cmocka_unit_test(refused_updates_leave_every_filter_unchanged),
        cmocka_unit_test(only_input_estimation_widens_the_gate),
        cmocka_unit_test(a_bearing_reduces_the_covariance_of_every_filter),
        cmocka_unit_test(velocities_of_the_last_two_hits_are_kept),
        cmocka_unit_test(simultaneous_bearings_reveal_a_turn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
