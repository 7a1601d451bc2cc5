/* SPDX-License-Identifier: MIT */
/*
 * Ambiguous range rates, measured modulo the sensor's span. If the estimate tells which multiple is
 * meant, results equal those of a twin without ambiguity, otherwise those without range rates.
 */
#include "tracker_setup.h"

#include "rhotrack/detail/gate.h"
#include "rhotrack/detail/imm.h"
#include "rhotrack/detail/input_estimation.h"

#define SPAN 50.0f

static struct rho_sensor radar_with_span(float span_mps)
{
    return (struct rho_sensor){
        .sensor_id = 1, .pd = 0.9f, .range_max_m = 1e5f, .range_rate_span_mps = span_mps};
}

static float fold_range_rate(double rate_mps, float span_mps)
{
    return (float)(span_mps > 0.0f ? remainder(rate_mps, (double)span_mps) : rate_mps);
}

/* ---- innovations ---------------------------------------------------------------------------- */

static void innovations_are_folded_to_half_the_span(void **state)
{
    (void)state;
    const struct rho_sensor sensor = radar_with_span(SPAN), whole = radar_with_span(0.0f);
    const float cases[][3] = {
        {0.0f, 0.0f, 0.0f},      {3.0f, 1.0f, 2.0f},    {-20.0f, 20.0f, 10.0f},
        {20.0f, -20.0f, -10.0f}, {7.0f, -243.0f, 0.0f}, {7.0f, 255.0f, 2.0f},
        {410.0f, 8.0f, 2.0f},    {24.0f, 0.0f, 24.0f},  {26.0f, 0.0f, -24.0f}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assert_float_equal(rho_measurement_innovation_mps(&sensor, cases[i][0], cases[i][1]),
                           cases[i][2], 1e-4);
        float all = cases[i][0] - cases[i][1];
        assert_float_equal(rho_measurement_innovation_mps(&whole, cases[i][0], cases[i][1]), all,
                           0.0);
        assert_float_equal(rho_measurement_innovation_mps(NULL, cases[i][0], cases[i][1]), all,
                           0.0);
    }
    assert_true(isnan(rho_measurement_innovation_mps(&sensor, NAN, 0.0f)));
    assert_float_equal(rho_measurement_innovation_mps(&sensor, 1e30f, 0.0f), 1e30f, 0.0);
}

/* An innovation of more than a million spans is left as it is. */
static void innovations_beyond_a_million_spans_are_not_folded(void **state)
{
    const struct rho_sensor sensor = radar_with_span(10.0f);
    (void)state;
    assert_float_equal(rho_measurement_innovation_mps(&sensor, 0.0f, 7.0e6f + 2.0f), -2.0, 0.0);
    assert_float_equal(rho_measurement_innovation_mps(&sensor, 0.0f, 1.5e7f + 2.0f), -1.5e7 - 2.0,
                       0.0);
}

static void a_range_rate_is_unfolded_if_three_sigmas_are_within_half_the_span(void **state)
{
    (void)state;
    const struct rho_sensor sensor = radar_with_span(30.0f), whole = radar_with_span(0.0f);
    assert_true(rho_measurement_can_unfold(&sensor, 24.9f));
    assert_false(rho_measurement_can_unfold(&sensor, 25.1f));
    assert_false(rho_measurement_can_unfold(&sensor, NAN));
    assert_true(rho_measurement_can_unfold(&whole, 1e9f));
    assert_true(rho_measurement_can_unfold(NULL, 1e9f));
    assert_float_equal(rho_measurement_log_aliases(&sensor, 300.0f), log(20.0), 1e-5);
    assert_float_equal(rho_measurement_log_aliases(&sensor, 10.0f), 0.0, 0.0);
    assert_float_equal(rho_measurement_log_aliases(&whole, 300.0f), 0.0, 0.0);
}

/*
 * The place is far ahead, which by correlation tells a higher speed: the multiple nearest to that
 * speed is meant, not the one nearest to the mean.
 */
static void correlated_innovations_select_the_multiple_of_the_span(void **state)
{
    (void)state;
    const struct rho_sensor sensor = radar_with_span(SPAN);
    /* place and range rate: variances of 400, correlation 0.99, 2.8 m/s remain */
    const float covariance[3] = {400.0f, 396.0f, 400.0f};
    float innovation[2] = {40.0f, -8.0f};
    assert_true(rho_measurement_unfold_rate(&sensor, 2, covariance, innovation));
    assert_float_equal(innovation[1], 42.0, 1e-4);
    const float apart[3] = {400.0f, 0.0f, 400.0f};
    innovation[1] = -8.0f;
    assert_false(rho_measurement_unfold_rate(&sensor, 2, apart, innovation));
    assert_float_equal(innovation[1], -8.0, 0.0);
    const float singular[3] = {400.0f, 400.0f, 400.0f};
    assert_false(rho_measurement_unfold_rate(&sensor, 2, singular, innovation));
    innovation[1] = 999.0f;
    assert_true(rho_measurement_unfold_rate(NULL, 2, apart, innovation));
    assert_float_equal(innovation[1], 999.0, 0.0);
}

static void spans_beyond_the_limits_are_refused(void **state)
{
    (void)state;
    const float good[] = {0.0f, 1.0f, 30.0f, 4e4f};
    const float bad[] = {-1.0f, 0.5f, 4.1e4f, NAN, INFINITY};
    use_usual_configs(1);
    begin_tracker();
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        struct rho_sensor sensor = radar_with_span(good[i]);
        assert_true(rho_measurement_is_valid_site(&sensor));
        assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
    }
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct rho_sensor sensor = radar_with_span(bad[i]);
        assert_false(rho_measurement_is_valid_site(&sensor));
        assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_ERROR_CONFIG);
    }
}

/* ---- filters -------------------------------------------------------------------------------- */

/* A target at 40 km that closes at 200 m/s, with velocities known to sd_mps. */
static struct rho_kalman approaching_estimate(float sd_mps)
{
    struct rho_kalman kalman;
    rho_kalman_init(&kalman);
    for (int axis = 0; axis < 2; axis++) {
        assert_int_equal(
            rho_kalman_open_axis(&kalman, axis, axis == 0 ? 4e4f : 5e3f, 400.0f, sd_mps * sd_mps),
            RHO_OK);
    }
    kalman.state[3] = -200.0f;
    kalman.state[4] = 60.0f;
    return kalman;
}

static void assert_same_estimate(const struct rho_kalman *a, const struct rho_kalman *b)
{
    for (int i = 0; i < RHO_KALMAN_STATES; i++) {
        assert_float_equal(a->state[i], b->state[i], 2e-3);
    }
    for (int k = 0; k < RHO_TRIANGLE(RHO_KALMAN_STATES); k++) {
        assert_float_equal(a->covariance[k], b->covariance[k],
                           1e-4 * (1.0 + fabs((double)b->covariance[k])));
    }
}

static void an_unfolded_range_rate_updates_as_an_unambiguous_one(void **state)
{
    (void)state;
    const struct rho_sensor sensor = radar_with_span(SPAN), whole = radar_with_span(0.0f);
    struct rho_kalman at = approaching_estimate(5.0f), twin = at;
    struct rho_input input = {0}, input_twin;
    struct rho_input_config estimating;
    rho_input_config_default(&estimating);
    assert_int_equal(
        rho_kalman_update_range_rate(&at, &sensor, fold_range_rate(-185.0, SPAN), 1.0f), RHO_OK);
    assert_int_equal(rho_kalman_update_range_rate(&twin, &whole, -185.0f, 1.0f), RHO_OK);
    assert_same_estimate(&at, &twin);
    assert_true(at.state[3] > -199.0f); /* the range rate moved the estimate */
    input.bare = approaching_estimate(5.0f);
    input_twin = input;
    assert_int_equal(rho_input_update_range_rate(&input, &estimating, &sensor,
                                                 fold_range_rate(-185.0, SPAN), 1.0f),
                     RHO_OK);
    assert_int_equal(rho_input_update_range_rate(&input_twin, &estimating, &whole, -185.0f, 1.0f),
                     RHO_OK);
    assert_same_estimate(&input.bare, &input_twin.bare);
}

static void a_range_rate_that_cannot_be_unfolded_changes_nothing(void **state)
{
    (void)state;
    const struct rho_sensor sensor = radar_with_span(SPAN);
    struct rho_kalman at = approaching_estimate(20.0f), before = at;
    struct rho_input input = {.bare = at}, input_before = input;
    struct rho_input_config estimating;
    rho_input_config_default(&estimating);
    assert_int_equal(rho_kalman_update_range_rate(&at, &sensor, 7.0f, 1.0f), RHO_OK);
    assert_memory_equal(&at, &before, sizeof at);
    assert_int_equal(rho_input_update_range_rate(&input, &estimating, &sensor, 7.0f, 1.0f), RHO_OK);
    assert_memory_equal(&input.bare, &input_before.bare, sizeof input.bare);
}

/* ---- gates ---------------------------------------------------------------------------------- */

static struct rho_plot plot_with_range_rate(double rate_mps, float span_mps)
{
    return (struct rho_plot){.x_m = 40020.0f,
                             .y_m = 4990.0f,
                             .sigma_range_m = 15.0f,
                             .sigma_cross_m = 120.0f,
                             .range_rate_mps = fold_range_rate(rate_mps, span_mps),
                             .sigma_range_rate_mps = 1.0f};
}

static void gates_with_ambiguous_range_rates_hold_the_same_plots(void **state)
{
    (void)state;
    const struct rho_sensor sensor = radar_with_span(SPAN), whole = radar_with_span(0.0f);
    const struct rho_kalman clear = approaching_estimate(5.0f),
                            unclear = approaching_estimate(20.0f);
    const double rates[] = {-185.0, -190.0, -175.0, -205.0};
    struct rho_gate gate, twin;
    struct rho_gate_result result, expected;
    rho_gate_open(&gate, &clear, 0.0f, &sensor, RHO_MEASURES_RANGE_RATE);
    rho_gate_open(&twin, &clear, 0.0f, &whole, RHO_MEASURES_RANGE_RATE);
    for (size_t i = 0; i < sizeof rates / sizeof rates[0]; i++) {
        struct rho_plot plot = plot_with_range_rate(rates[i], SPAN),
                        whole_plot = plot_with_range_rate(rates[i], 0.0f);
        int is_inside = rho_gate_test(&twin, &whole_plot, &expected);
        assert_int_equal(rho_gate_test(&gate, &plot, &result), is_inside);
        if (is_inside) {
            assert_float_equal(result.distance2, expected.distance2, 1e-2);
            assert_float_equal(result.log_det, expected.log_det, 1e-4);
            assert_true(result.has_range_rate);
        }
    }
    /*
     * taken as unambiguous the folded range rate is outside; with a vague estimate places alone
     * count
     */
    struct rho_plot plot = plot_with_range_rate(-190.0, SPAN);
    assert_false(rho_gate_test(&twin, &plot, &expected));
    rho_gate_open(&gate, &unclear, 0.0f, &sensor, RHO_MEASURES_RANGE_RATE);
    rho_gate_open(&twin, &unclear, 0.0f, &sensor, 0);
    assert_true(rho_gate_test(&gate, &plot, &result));
    assert_true(rho_gate_test(&twin, &plot, &expected));
    assert_false(result.has_range_rate);
    assert_float_equal(result.distance2, expected.distance2, 1e-4);
}

static void the_imm_scores_and_updates_with_ambiguous_range_rates(void **state)
{
    (void)state;
    const struct rho_sensor sensor = radar_with_span(SPAN), whole = radar_with_span(0.0f);
    const struct rho_kalman clear = approaching_estimate(5.0f),
                            unclear = approaching_estimate(20.0f);
    const struct rho_plot plot = plot_with_range_rate(-190.0, SPAN),
                          whole_plot = plot_with_range_rate(-190.0, 0.0f);
    struct rho_imm_model model;
    struct rho_imm imm, twin;
    struct rho_imm_plot seen, whole_seen, place_seen;
    struct rho_imm_match match, expected;
    rho_imm_model_default(&model, 5.0f, 400.0f);
    rho_imm_start(&imm, &model, &clear);
    twin = imm;
    rho_imm_prepare_plot(&seen, &plot, RHO_MEASURES_RANGE_RATE, &sensor);
    rho_imm_prepare_plot(&whole_seen, &whole_plot, RHO_MEASURES_RANGE_RATE, &whole);
    assert_true(rho_imm_score_plot(&imm, &seen, &match));
    assert_true(rho_imm_score_plot(&twin, &whole_seen, &expected));
    assert_float_equal(match.log_likelihood, expected.log_likelihood, 2e-3);
    assert_int_equal(rho_imm_update(&imm, &model, &seen, &match), RHO_OK);
    assert_int_equal(rho_imm_update(&twin, &model, &whole_seen, &expected), RHO_OK);
    assert_same_estimate(&imm.steady, &twin.steady);
    /* vague estimate: the density of the place over the span, and an update with the place alone */
    rho_imm_start(&imm, &model, &unclear);
    twin = imm;
    rho_imm_prepare_plot(&place_seen, &plot, 0, &sensor);
    assert_true(rho_imm_score_plot(&imm, &seen, &match));
    assert_true(rho_imm_score_plot(&twin, &place_seen, &expected));
    assert_float_equal(match.log_likelihood, (double)expected.log_likelihood - log((double)SPAN),
                       1e-3);
    assert_int_equal(rho_imm_update(&imm, &model, &seen, &match), RHO_OK);
    assert_int_equal(rho_imm_update(&twin, &model, &place_seen, &expected), RHO_OK);
    assert_same_estimate(&imm.steady, &twin.steady);
}

/* ---- initiation and tracks ------------------------------------------------------------------ */

/* A target's plot with noise, and clutter with random range rates; equal draws for any span. */
static void add_scan_plots(double t_s, float span_mps, int clutter)
{
    double x_m = 4e4 - 200.0 * t_s, y_m = 5e3 + 150.0 * t_s, range_m = hypot(x_m, y_m);
    double rate_mps = (x_m * -200.0 + y_m * 150.0) / range_m;
    double noise_x_m = 15.0 * normal(), noise_y_m = 15.0 * normal(), noise_mps = normal();
    struct rho_plot *plot = add_plot(x_m + noise_x_m, y_m + noise_y_m, 15.0);
    plot->range_rate_mps = fold_range_rate(rate_mps + noise_mps, span_mps);
    plot->sigma_range_rate_mps = 1.0f;
    for (int i = 0; i < clutter; i++) {
        double at_x_m = uniform(3e4, 5e4), at_y_m = uniform(0.0, 1e4);
        plot = add_plot(at_x_m, at_y_m, 15.0);
        plot->range_rate_mps = fold_range_rate(uniform(-400.0, 400.0), span_mps);
        plot->sigma_range_rate_mps = 1.0f;
    }
}

static struct rho_candidate best_candidate_with_span(float span_mps)
{
    struct rho_sensor sensor = radar_with_span(span_mps);
    uint8_t fates[64];
    uint32_t unused = 0;
    use_usual_configs(5);
    initiation.area_is_fixed = 1;
    initiation.area = (struct rho_extent){3e4f, 5e4f, 0.0f, 1e4f};
    begin_tracker();
    for (int scan = 0; scan < 5; scan++) {
        add_scan_plots(4.0 * scan, span_mps, 30);
        struct rho_scan pushed = {.time_us = 4000000 * scan,
                                  .sensor_id = 1,
                                  .measures = RHO_MEASURES_RANGE_RATE,
                                  .num_plots = num_plots,
                                  .plots = plots};
        memset(fates, RHO_FATE_HELD, sizeof fates);
        assert_int_equal(rho_initiator_push(&initiator, &pushed, &sensor, fates, &unused), RHO_OK);
        num_plots = 0;
    }
    assert_int_equal(rho_initiator_search(&initiator, RHO_SEARCH_BATCH), RHO_OK);
    assert_true(initiator.num_candidates > 0);
    return initiator.candidates[0];
}

/*
 * Plots and fit are the same; each range rate is worth less by the number of multiples, 800 m/s
 * over the span.
 */
static void initiation_finds_the_same_with_ambiguous_range_rates(void **state)
{
    (void)state;
    const struct rho_candidate twin = best_candidate_with_span(0.0f);
    const float spans[] = {100.0f, 30.0f};
    assert_int_equal(twin.hits, 5);
    assert_float_equal(twin.vx_mps, -200.0, 3.0);
    for (size_t i = 0; i < sizeof spans / sizeof spans[0]; i++) {
        const struct rho_candidate found = best_candidate_with_span(spans[i]);
        assert_int_equal(found.mask, twin.mask);
        assert_memory_equal(found.plot, twin.plot, sizeof found.plot);
        assert_float_equal(found.vx_mps, twin.vx_mps, 0.05);
        assert_float_equal(found.vy_mps, twin.vy_mps, 0.05);
        assert_float_equal((double)found.score_mnat,
                           (double)twin.score_mnat - 5e3 * log(800.0 / (double)spans[i]), 100.0);
    }
}

static struct rho_track_report track_with_span(float span_mps)
{
    struct rho_sensor sensor = radar_with_span(span_mps);
    use_usual_configs(9);
    begin_tracker();
    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
    for (int scan = 0; scan < 20; scan++) {
        add_scan_plots(4.0 * scan, span_mps, 20);
        step_scan((struct rho_scan){
            .time_us = 4000000 * scan, .sensor_id = 1, .measures = RHO_MEASURES_RANGE_RATE});
    }
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(report.tracks[0].status, RHO_TRACK_CONFIRMED);
    return report.tracks[0];
}

/*
 * The first multiples are unknown; after 20 scans the track equals that of a radar without
 * ambiguity.
 */
static void a_track_with_ambiguous_range_rates_becomes_as_good(void **state)
{
    (void)state;
    const struct rho_track_report twin = track_with_span(0.0f);
    const float spans[] = {100.0f, 50.0f, 30.0f};
    for (size_t i = 0; i < sizeof spans / sizeof spans[0]; i++) {
        const struct rho_track_report track = track_with_span(spans[i]);
        assert_int_equal(track.hits, twin.hits);
        for (int k = 0; k < 2; k++) {
            assert_float_equal(track.state[k], twin.state[k], 3.0);
            assert_float_equal(track.state[k + 3], twin.state[k + 3], 1.0);
        }
        assert_float_equal(track.sigma_mps, twin.sigma_mps, 0.1 * (double)twin.sigma_mps);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(innovations_are_folded_to_half_the_span),
        cmocka_unit_test(innovations_beyond_a_million_spans_are_not_folded),
        cmocka_unit_test(a_range_rate_is_unfolded_if_three_sigmas_are_within_half_the_span),
        cmocka_unit_test(correlated_innovations_select_the_multiple_of_the_span),
        cmocka_unit_test(spans_beyond_the_limits_are_refused),
        cmocka_unit_test(an_unfolded_range_rate_updates_as_an_unambiguous_one),
        cmocka_unit_test(a_range_rate_that_cannot_be_unfolded_changes_nothing),
        cmocka_unit_test(gates_with_ambiguous_range_rates_hold_the_same_plots),
        cmocka_unit_test(the_imm_scores_and_updates_with_ambiguous_range_rates),
        cmocka_unit_test(initiation_finds_the_same_with_ambiguous_range_rates),
        cmocka_unit_test(a_track_with_ambiguous_range_rates_becomes_as_good),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
