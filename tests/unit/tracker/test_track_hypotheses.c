/* SPDX-License-Identifier: MIT */
/*
 * Hypotheses of a tracker: some without height, some dropped by bearings, plots at other times, and
 * tracks that claim no plot.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "rhotrack/detail/hypotheses.h"
#include "rhotrack/detail/track.h"
#include "rhotrack/tracker.h"

#include "one_bearing.h"

#define SCAN_US 1000000
#define SIGMA_M 10.0f
#define LOG_PD (-0.1f)
#define LOG_MISS (-2.3f)

static struct rho_hypotheses pool;
/* clutter so dense that a plot of the target is worth about as much as a miss */
static const struct rho_hypotheses_clutter clutter = {.log_per_m2 = -9.0f, .log_per_m = -9.0f};

static struct rho_plot plot_at(float x_m, float y_m, float z_m)
{
    return (struct rho_plot){.x_m = x_m,
                             .y_m = y_m,
                             .z_m = z_m,
                             .sigma_range_m = SIGMA_M,
                             .sigma_cross_m = SIGMA_M,
                             .sigma_up_m = SIGMA_M};
}

/* A level estimate at the origin, at rest. */
static struct rho_kalman estimate_at_rest(void)
{
    struct rho_kalman estimate;
    rho_kalman_init(&estimate);
    for (int axis = 0; axis < 2; axis++) {
        assert_int_equal(rho_kalman_open_axis(&estimate, axis, 0.0f, 100.0f, 100.0f), RHO_OK);
    }
    return estimate;
}

static uint16_t open_slot(void)
{
    struct rho_imm_model model;
    const struct rho_kalman estimate = estimate_at_rest();
    uint16_t slot = 0;
    rho_imm_model_default(&model, 10.0f, 300.0f);
    assert_int_equal(rho_hypotheses_init(&pool, sizeof pool, &model), RHO_OK);
    assert_int_equal(rho_hypotheses_open(&pool, &estimate, 0, &slot), RHO_OK);
    return slot;
}

/*
 * Predicts to the scan, opens the gate, and scores a plot at the scan's time. Returns whether it is
 * in the gate.
 */
static int is_plot_in_gate(uint16_t slot, int scan, const struct rho_plot *plot, uint32_t measures,
                           struct rho_hypotheses_box *reach)
{
    struct rho_imm_plot seen;
    float gain_nat = 0.0f;
    const int64_t time_us = (int64_t)scan * SCAN_US;
    assert_int_equal(rho_hypotheses_predict(&pool, slot, time_us), RHO_OK);
    rho_hypotheses_gate_box(&pool, slot, reach);
    rho_imm_prepare_plot(&seen, plot, measures, NULL);
    return rho_hypotheses_score_plot(&pool, slot, &seen, time_us, 0, LOG_PD, &clutter, &gain_nat);
}

static void extend_hypotheses_by_plot(uint16_t slot, int scan, const struct rho_plot *plot,
                                      uint32_t measures)
{
    const struct rho_hypotheses_scan at = {.time_us = (int64_t)scan * SCAN_US,
                                           .measures = measures,
                                           .plots = plot,
                                           .log_miss = LOG_MISS};
    struct rho_hypotheses_outcome outcome;
    assert_int_equal(rho_hypotheses_commit(&pool, slot, &at, &outcome), RHO_OK);
}

/* ---- heights --------------------------------------------------------------------------------- */

/*
 * If the first plot with a height was clutter, its hypothesis has no height, and any height may be
 * the target's.
 */
static void a_hypothesis_without_height_accepts_any_height(void **state)
{
    (void)state;
    struct rho_hypotheses_box reach;
    const uint16_t slot = open_slot();
    const struct rho_plot low = plot_at(2.0f, -3.0f, 500.0f), high = plot_at(0.0f, 4.0f, 90000.0f);
    assert_int_equal(is_plot_in_gate(slot, 1, &low, RHO_MEASURES_Z, &reach), 1);
    extend_hypotheses_by_plot(slot, 1, &low, RHO_MEASURES_Z);
    assert_int_equal(rho_hypotheses_count(&pool, slot), 2);
    assert_int_equal(is_plot_in_gate(slot, 2, &high, RHO_MEASURES_Z, &reach), 1);
    assert_int_equal(rho_hypotheses_is_in_box(&pool, slot, &reach, &high, RHO_MEASURES_Z), 1);
}

/* ---- bearings -------------------------------------------------------------------------------- */

/*
 * Bearings from the other side show that a plot was clutter: its hypothesis goes back to the pool.
 */
static void a_bearing_drops_hypotheses_it_contradicts(void **state)
{
    (void)state;
    struct rho_hypotheses_box reach;
    const uint16_t slot = open_slot();
    const struct rho_plot aside = plot_at(0.0f, 60.0f, 0.0f);
    assert_int_equal(is_plot_in_gate(slot, 2, &aside, 0, &reach), 1);
    extend_hypotheses_by_plot(slot, 2, &aside, 0);
    assert_int_equal(rho_hypotheses_count(&pool, slot), 2);
    struct one_bearing from;
    assert_int_equal(rho_hypotheses_update_bearings(
                         &pool, slot, 2 * SCAN_US,
                         one_bearing(&from, 2 * SCAN_US, -5000.0f, 0.0f, -0.02f, 1e-3f)),
                     RHO_OK);
    assert_int_equal(rho_hypotheses_count(&pool, slot), 1);
    assert_int_equal(pool.num_free, RHO_MAX_HYPOTHESES - 1);
    assert_true(rho_hypotheses_at(&pool, slot, 0)->imm.steady.state[1] < 0.0f);
}

/*
 * A hypothesis at the sensor's own place has no bearing: it has missed, which must not make it
 * likelier than others.
 */
static void a_bearing_undefined_for_a_hypothesis_is_its_miss(void **state)
{
    (void)state;
    struct rho_hypotheses_box reach;
    const struct rho_plot plot = plot_at(50.0f, 0.0f, 0.0f);
    const uint16_t slot = open_slot();
    assert_int_equal(is_plot_in_gate(slot, 1, &plot, 0, &reach), 1);
    extend_hypotheses_by_plot(slot, 1, &plot, 0);
    assert_int_equal(rho_hypotheses_predict(&pool, slot, 2 * SCAN_US), RHO_OK);
    assert_int_equal(rho_hypotheses_count(&pool, slot), 2);
    const struct rho_hypothesis best = *rho_hypotheses_at(&pool, slot, 0);
    const struct rho_hypothesis other = *rho_hypotheses_at(&pool, slot, 1);
    const float *at_m = other.imm.steady.state;
    const float bearing_rad =
        atan2f(best.imm.steady.state[1] - at_m[1], best.imm.steady.state[0] - at_m[0]);
    assert_true(other.weight_nat > -2.5f); /* a smaller loss than the bearing causes */
    struct one_bearing at;
    const struct rho_weighed_bearings *look =
        one_bearing_in_row(&at, 0, 2 * SCAN_US, at_m[0], at_m[1], bearing_rad, 1.0f, 0.1f);
    assert_int_equal(rho_hypotheses_update_bearings(&pool, slot, 2 * SCAN_US, look), RHO_OK);
    assert_int_equal(rho_hypotheses_at(&pool, slot, 0)->picks[RHO_HYPOTHESES_MEMORY - 1],
                     best.picks[RHO_HYPOTHESES_MEMORY - 1]);
    assert_true(rho_hypotheses_at(&pool, slot, 1)->weight_nat < other.weight_nat - 1.0f);
}

/* ---- plots' own times ------------------------------------------------------------------------ */

/* A plot is scored at its own time, whatever plot came before it and wherever the time is given. */
static void a_plot_is_scored_at_its_own_time(void **state)
{
    (void)state;
    struct rho_hypotheses_box reach;
    const struct rho_plot plot = plot_at(20.0f, 0.0f, 0.0f);
    struct rho_imm_plot seen;
    float first_nat = 0.0f, second_nat = 0.0f;
    rho_imm_prepare_plot(&seen, &plot, 0, NULL);
    uint16_t slot = open_slot();
    rho_hypotheses_gate_box(&pool, slot, &reach);
    assert_int_equal(
        rho_hypotheses_score_plot(&pool, slot, &seen, 4 * SCAN_US, 0, LOG_PD, &clutter, &first_nat),
        1);
    slot = open_slot();
    assert_int_equal(is_plot_in_gate(slot, 0, &plot, 0, &reach), 1);
    assert_int_equal(rho_hypotheses_score_plot(&pool, slot, &seen, 4 * SCAN_US, 1, LOG_PD, &clutter,
                                               &second_nat),
                     1);
    assert_true(fabsf(first_nat - second_nat) < 1e-6f);
}

/* ---- plots claimed by tracks ----------------------------------------------------------------- */

static void a_track_that_scores_no_plot_claims_none(void **state)
{
    (void)state;
    struct rho_track track;
    (void)open_slot();
    const struct rho_track_model model = {
        .speed_sigma_mps = 300.0f, .noise_density = 1.0f, .hypotheses = &pool};
    const struct rho_track_plot start = {.plot = plot_at(0.0f, 0.0f, 0.0f), .row = 7};
    const struct rho_hypotheses_scan scan = {.time_us = SCAN_US, .log_miss = LOG_MISS};
    assert_int_equal(rho_track_start(&track, 1, &start, 1, &model, 0), RHO_OK);
    assert_int_equal(track.plot, 7);
    assert_int_equal(rho_track_predict(&track, SCAN_US, &model), RHO_OK);
    rho_hypotheses_gate_box(&pool, track.slot, NULL);
    assert_int_equal(rho_track_commit_scan(&track, &scan, 0, &model), RHO_OK);
    assert_int_equal(track.plot, -1);
}

/* By the second call the slot belongs to another track. */
static void freeing_hypotheses_twice_does_no_harm(void **state)
{
    (void)state;
    struct rho_track first, second;
    struct rho_imm_model motion;
    rho_imm_model_default(&motion, 10.0f, 300.0f);
    assert_int_equal(rho_hypotheses_init(&pool, sizeof pool, &motion), RHO_OK);
    const struct rho_track_model model = {
        .speed_sigma_mps = 300.0f, .noise_density = 1.0f, .hypotheses = &pool};
    const struct rho_track_plot start = {.plot = plot_at(0.0f, 0.0f, 0.0f)};
    assert_int_equal(rho_track_start(&first, 1, &start, 1, &model, 0), RHO_OK);
    rho_track_free_hypotheses(&first, &model);
    assert_int_equal(rho_track_start(&second, 2, &start, 1, &model, 0), RHO_OK);
    rho_track_free_hypotheses(&first, &model);
    assert_int_equal(rho_hypotheses_count(&pool, second.slot), 1);
}

static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_report report;

/* One target, along x at 200 m/s until 11 s. */
static void follow_straight_target(const struct rho_tracker_config *config)
{
    struct rho_initiator_config search;
    rho_initiator_config_default(&search);
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, config), RHO_OK);
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, &search), RHO_OK);
    for (int k = 0; k < 12; k++) {
        const struct rho_plot plot = plot_at(200.0f * (float)k, 0.0f, 0.0f);
        const struct rho_scan scan = {
            .time_us = (int64_t)k * SCAN_US, .num_plots = 1, .plots = &plot};
        assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
    }
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(report.tracks[0].plot, 0);
}

/* The late scan has no plots, so the track claims no row of it. */
static void late_scans_without_plots_claim_none(void **state)
{
    (void)state;
    struct rho_tracker_config config;
    rho_tracker_config_default(&config);
    follow_straight_target(&config);
    const struct rho_scan late = {.time_us = 10 * SCAN_US};
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &late, &report), RHO_OK);
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(report.tracks[0].plot, -1);
}

#define NUM_ABREAST 6

/* Pseudo-random numbers -1 .. 1. */
static float draw_uniform_minus_1_to_1(void)
{
    static uint32_t seed = 1;
    seed = seed * 1103515245u + 12345u;
    return (float)(seed >> 16 & 1023u) / 512.0f - 1.0f;
}

static void step_targets_abreast(int k, float gap_m)
{
    struct rho_plot plots[NUM_ABREAST];
    for (int i = 0; i < NUM_ABREAST; i++) {
        const float x_m = 30.0f * draw_uniform_minus_1_to_1(),
                    y_m = 30.0f * draw_uniform_minus_1_to_1();
        plots[i] = plot_at(200.0f * (float)k + x_m, gap_m * (float)i + y_m, 0.0f);
        plots[i].sigma_range_m = plots[i].sigma_cross_m = 30.0f;
    }
    const struct rho_scan scan = {
        .time_us = (int64_t)k * SCAN_US, .num_plots = NUM_ABREAST, .plots = plots};
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
}

/*
 * As many plots as targets, all in each other's gates: each target still claims one plot, though a
 * hypothesis may prefer another's.
 */
static void targets_abreast_each_claim_a_plot(void **state)
{
    (void)state;
    struct rho_tracker_config config;
    struct rho_initiator_config search;
    unsigned missed = 0;
    rho_tracker_config_default(&config);
    rho_initiator_config_default(&search);
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, &search), RHO_OK);
    for (int k = 0; k < 60; k++) {
        step_targets_abreast(k, k < 15 ? 400.0f - 26.0f * (float)k : 10.0f);
        for (unsigned i = 0; k >= 15 && i < report.num_tracks; i++) {
            missed += report.tracks[i].plot < 0;
        }
    }
    assert_int_equal(report.num_tracks, NUM_ABREAST);
    assert_int_equal(missed, 0);
}

/*
 * An input may have begun since the last plot and moved the target far out of the gate without
 * input.
 */
static void bearings_are_gated_with_a_possible_new_input(void **state)
{
    (void)state;
    struct rho_tracker_config config;
    rho_tracker_config_default(&config);
    config.gate = RHO_TRACKER_NEAREST;
    config.accel_max_mps2 = 0.0f;
    config.input.is_estimated = 1;
    config.input.model = RHO_INPUT_PHYSICAL;
    config.input.sigma_mps2 = 200.0f;
    config.input.noise_m = config.input.noise_mps = 0.0f;
    follow_straight_target(&config);
    const struct rho_bearing bearing = {.bearing_rad = 0.02f, .sigma_rad = 1e-4f};
    const struct rho_bearing_scan scan = {.time_us = 12 * SCAN_US,
                                          .sensor_id = 5,
                                          .x_m = 2400.0f - 5000.0f,
                                          .num_bearings = 1,
                                          .bearings = &bearing};
    assert_int_equal(rho_tracker_step_bearings(&tracker, NULL, &scan, &report), RHO_OK);
    assert_int_equal(report.fates_total[RHO_FATE_CLAIMED], 1);
}

/* A target that may have turned: both models are less certain of its velocity, and of no place. */
static void a_loosened_track_is_uncertain_of_its_velocity(void **state)
{
    (void)state;
    const uint16_t slot = open_slot();
    const struct rho_imm before = pool.nodes[pool.node_of[slot][0]].imm;
    rho_hypotheses_loosen(&pool, slot, 9.0f);
    const struct rho_imm *after = &pool.nodes[pool.node_of[slot][0]].imm;
    for (int i = 0; i < 6; i++) {
        const float more = i == RHO_VX || i == RHO_VY ? 9.0f : 0.0f;
        assert_float_equal(after->steady.covariance[RHO_AT(i, i)],
                           before.steady.covariance[RHO_AT(i, i)] + more, 1e-3);
        assert_float_equal(after->covariance[RHO_AT(i, i)], before.covariance[RHO_AT(i, i)] + more,
                           1e-3);
    }
    const struct rho_track_model model = {.hypotheses = &pool};
    struct rho_track track = {
        .filter = RHO_TRACK_HYPOTHESES, .slot = slot, .kalman = estimate_at_rest()};
    const float was = track.kalman.covariance[RHO_AT(RHO_VX, RHO_VX)];
    rho_track_loosen(&track, &model, 4.0f);
    assert_float_equal(track.kalman.covariance[RHO_AT(RHO_VX, RHO_VX)], was + 4.0f, 1e-3);
    assert_float_equal(after->covariance[RHO_AT(RHO_VY, RHO_VY)],
                       before.covariance[RHO_AT(RHO_VY, RHO_VY)] + 13.0f, 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_loosened_track_is_uncertain_of_its_velocity),
        cmocka_unit_test(a_hypothesis_without_height_accepts_any_height),
        cmocka_unit_test(a_bearing_drops_hypotheses_it_contradicts),
        cmocka_unit_test(a_bearing_undefined_for_a_hypothesis_is_its_miss),
        cmocka_unit_test(a_plot_is_scored_at_its_own_time),
        cmocka_unit_test(a_track_that_scores_no_plot_claims_none),
        cmocka_unit_test(freeing_hypotheses_twice_does_no_harm),
        cmocka_unit_test(late_scans_without_plots_claim_none),
        cmocka_unit_test(targets_abreast_each_claim_a_plot),
        cmocka_unit_test(bearings_are_gated_with_a_possible_new_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
