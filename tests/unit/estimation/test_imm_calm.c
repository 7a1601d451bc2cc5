/* SPDX-License-Identifier: MIT */
/*
 * Calm and agile targets: how the share of calm ones moves, what it does to the steady model, and
 * what it is worth.
 */
#include <string.h>

#include "dense_filter.h"

#include "rhotrack/detail/imm.h"

#define NUM(array) (sizeof(array) / sizeof((array)[0]))

static struct rho_imm_model some_model(void)
{
    struct rho_imm_model model;

    rho_imm_model_default(&model, 20.0f, 350.0f);
    return model;
}

static struct rho_imm started(const struct rho_imm_model *model)
{
    struct rho_kalman first;
    struct rho_imm imm;

    rho_kalman_init(&first);
    for (int axis = 0; axis < 2; ++axis) {
        assert_int_equal(rho_kalman_open_axis(&first, axis, 0.0f, 2500.0f, 2500.0f), RHO_OK);
    }
    rho_imm_start(&imm, model, &first);
    return imm;
}

static void predict(struct rho_imm *imm, const struct rho_imm_model *model, float dt_s)
{
    struct rho_imm_step step;

    rho_imm_prepare_step(&step, model, dt_s);
    assert_int_equal(rho_imm_predict(imm, &step), RHO_OK);
}

/*
 * Without an end of manoeuvres: 1 - c decays as exp(-t / settle_s), times what stays steady of
 * agile beside calm targets.
 */
static void calm_grows_with_the_time_that_nothing_happens(void **state)
{
    static const float settles_s[] = {5.0f, 60.0f, 600.0f};

    (void)state;
    for (size_t k = 0; k < NUM(settles_s); ++k) {
        struct rho_imm_model model = some_model();
        double expected = 0.5;

        model.settle_s = settles_s[k];
        struct rho_imm imm = started(&model);
        const double sum_per_s = 1.0 / model.steady_s + 1.0 / model.maneuver_s;
        const double agile_stays = 1.0 + expm1(-4.0 * sum_per_s) / (sum_per_s * model.steady_s);
        const double calm_stays = exp(-4.0 / model.calm_s);

        for (int scan = 0; scan < 100; ++scan) {
            const float before = imm.calm;
            const double agile = (1.0 - expected) * agile_stays, calm = expected * calm_stays;

            imm.probability = 0.01f; /* plots say so */
            predict(&imm, &model, 4.0f);
            expected = (calm + agile * -expm1(-4.0 / model.settle_s)) / (calm + agile);
            assert_float_equal(imm.calm, expected, 1e-5);
            assert_true(imm.calm >= before && imm.calm <= 1.0f);
        }
    }
}

/*
 * Targets that end a manoeuvre are agile ones; while one is likely they outnumber the calm, and it
 * takes as long again.
 */
static void calm_falls_with_manoeuvres_and_comes_back(void **state)
{
    const struct rho_imm_model model = some_model();
    struct rho_imm imm = started(&model);

    (void)state;
    imm.calm = 0.95f;
    for (int scan = 0; scan < 5; ++scan) {
        const float before = imm.calm;

        imm.probability = 0.9f;
        predict(&imm, &model, 4.0f);
        assert_true(scan > 1 || imm.calm < 0.5f * before);
    }
    assert_true(imm.calm < 0.05f);
    for (float t_s = 0.0f; t_s < 2.0f * model.settle_s; t_s += 4.0f) {
        imm.probability = 0.01f;
        predict(&imm, &model, 4.0f);
    }
    assert_true(imm.calm > 0.8f);
}

/*
 * Plots do not tell calm from agile: an update, a bearing, a move without mixing leave the share as
 * it is.
 */
static void time_alone_moves_the_share(void **state)
{
    const struct rho_imm_model model = some_model();
    const struct rho_plot plot = {
        .x_m = 40.0f, .y_m = -30.0f, .sigma_range_m = 50.0f, .sigma_cross_m = 50.0f};
    struct rho_imm imm = started(&model);
    struct rho_imm_plot seen;
    struct rho_imm_match match;
    struct rho_imm_step step;
    float gain_nat;

    (void)state;
    imm.calm = 0.3f;
    rho_imm_prepare_plot(&seen, &plot, 0, NULL);
    assert_true(rho_imm_score_plot(&imm, &seen, &match));
    assert_int_equal(rho_imm_update(&imm, &model, &seen, &match), RHO_OK);
    assert_int_equal(rho_imm_update_bearing(&imm, 0.0f, 5000.0f, -1.5f, 0.01f, &gain_nat), RHO_OK);
    rho_imm_prepare_step(&step, &model, 0.4f);
    assert_int_equal(rho_imm_predict_unmixed(&imm, &step), RHO_OK);
    rho_imm_prepare_step(&step, &model, -0.4f);
    assert_int_equal(rho_imm_predict_unmixed(&imm, &step), RHO_OK);
    assert_true(imm.calm == 0.3f);
}

/*
 * Variances of velocity grow by density times time; below the odds nothing else gets into the
 * steady model.
 */
static void the_noise_lies_between_calm_and_agile(void **state)
{
    static const float shares[] = {0.0f, 0.25f, 0.5f, 0.9f, 1.0f};
    struct rho_imm_model model = some_model();

    (void)state;
    model.quiet_density = 2.0f;
    model.calm_density = 0.5f;
    for (int is_coupled = 0; is_coupled < 2; ++is_coupled) {
        for (size_t k = 0; k < NUM(shares); ++k) {
            struct rho_imm imm = started(&model);

            imm.calm = shares[k];
            imm.probability = 0.01f;
            imm.is_coupled = (uint8_t)is_coupled;
            predict(&imm, &model, 4.0f);
            const double density = 0.5 * imm.calm + 2.0 * (1.0 - (double)imm.calm);
            const float *p = imm.steady.covariance;
            assert_float_equal(p[RHO_AT(3, 3)], 2500.0 + 4.0 * density, 0.01);
            assert_float_equal(p[RHO_AT(3, 0)], 4.0 * 2500.0 + 8.0 * density, 0.02);
            assert_float_equal(p[RHO_AT(0, 0)], 2500.0 + 16.0 * 2500.0 + 64.0 / 3.0 * density, 0.1);
        }
    }
}

/*
 * 0.16 to 1: what is less likely gives nothing back, and takes from the steady model all the same.
 */
static void a_refuted_manoeuvre_gives_nothing_back(void **state)
{
    static const double odds[] = {1e-6, 0.01, 0.159, 0.161, 1.0, 100.0};
    const struct rho_imm_model model = some_model();
    struct rho_imm_step step;

    (void)state;
    rho_imm_prepare_step(&step, &model, 4.0f);
    for (size_t k = 0; k < NUM(odds); ++k) {
        const int gives = odds[k] > 0.16;
        struct rho_imm imm = started(&model);

        imm.probability = (float)(odds[k] / (1.0 + odds[k]));
        imm.state[0] = 1000.0f;
        imm.state[6] = 20.0f;
        const double was = imm.probability;
        assert_int_equal(rho_imm_predict(&imm, &step), RHO_OK);
        assert_int_equal(imm.steady.state[0] > 0.0f, gives);
        const double begins = 0.5 * (1.0 - was) * ((double)step.begins + (double)step.calm_begins);
        const double ends = gives ? was * (double)step.ends : 0.0;
        assert_float_equal(imm.probability, begins + was - ends, 1e-6);
        /* and takes from the steady model, which is at 0, all the same */
        const double taken = begins / (begins + was - ends);
        assert_float_equal(imm.state[0],
                           (1.0 - taken) * (1000.0 + 20.0 * (double)step.position_by_accel), 0.01);
    }
}

/* Chains of two states: none is ever calm, and what is set of calm targets does not count. */
static void without_calm_targets_the_chain_has_two_states(void **state)
{
    struct rho_imm_model model = some_model(), other;

    (void)state;
    model.calm_s = 0.0f;
    model.settle_s = 0.0f;
    other = model;
    other.settle_s = 5.0f;
    other.calm_density = 0.0f;
    struct rho_imm imm = started(&model), same = started(&other);
    for (int scan = 0; scan < 50; ++scan) {
        const double was = scan % 2 ? 0.01 : 0.7;
        const double sum_per_s = 1.0 / model.steady_s + 1.0 / model.maneuver_s;
        const double moved = -expm1(-4.0 * sum_per_s) / sum_per_s;
        const float vv = imm.steady.covariance[RHO_AT(3, 3)];

        imm.probability = same.probability = (float)was;
        predict(&imm, &model, 4.0f);
        predict(&same, &other, 4.0f);
        assert_float_equal(
            imm.probability,
            was - was * moved / model.maneuver_s + (1.0 - was) * moved / model.steady_s, 1e-6);
        assert_true(imm.calm == 0.0f);
        /* all of the quiet density, and what a manoeuvre of any odds gives back */
        assert_true(imm.steady.covariance[RHO_AT(3, 3)] > vv + 4.0f * model.quiet_density);
    }
    assert_memory_equal(&imm, &same, sizeof imm);
}

/* No share is 0 by 0: certain of everything, for a microsecond and for a day. */
static void certainty_survives_any_interval(void **state)
{
    static const float shares[] = {0.0f, 1e-30f, 1e-8f, 0.5f, 0.99999994f, 1.0f};
    static const float intervals_s[] = {1e-6f, 1e-5f, 1e-3f, 1.0f, 1e3f, 8e3f, 1e5f};
    unsigned num_good = 0;

    (void)state;
    for (size_t n = 0; n < NUM(shares) * NUM(shares) * NUM(intervals_s) * 2; ++n) {
        const float dt_s = intervals_s[n / 2 / NUM(shares) / NUM(shares)];
        struct rho_imm_model model;
        struct rho_imm_step step;

        /* one that hardly accelerates: its variances stay within limits for hours */
        rho_imm_model_default(&model, 1e-3f, 10.0f);
        model.steady_s = n % 2 ? 1e5f : 4.0f;
        model.maneuver_s = 4.0f;
        struct rho_imm imm = started(&model);
        imm.probability = shares[n / 2 % NUM(shares)];
        imm.calm = shares[n / 2 / NUM(shares) % NUM(shares)];
        rho_imm_prepare_step(&step, &model, dt_s);
        const enum rho_status status = rho_imm_predict(&imm, &step);
        assert_true(status == RHO_OK || dt_s > 1e4f);
        assert_true(imm.probability >= 0.0f && imm.probability <= 1.0f);
        assert_true(imm.calm >= 0.0f && imm.calm <= 1.0f);
        num_good += status == RHO_OK;
    }
    assert_true(num_good >= 6 * NUM(shares) * NUM(shares) * 2);
}

/* ---- what it is worth ------------------------------------------------------------------------ */

#define SCANS 75
#define JUDGED_SCAN 25
#define RUNS 20
#define SIGMA_M 60.0
#define PERIOD_S 4.0
#define WHITE_DENSITY 0.01 /* m^2/s^3, of the target and of the filter that is told */

struct errors {
    double told2, imm2;
};

static double off2(const float *state, const double x[4])
{
    return pow(state[0] - x[0], 2.0) + pow(state[1] - x[1], 2.0);
}

/* White acceleration over an interval. */
static void fly(double x[4], double dt)
{
    for (int axis = 0; axis < 2; ++axis) {
        const double v = sqrt(WHITE_DENSITY * dt) * normal();
        const double rest = sqrt(WHITE_DENSITY * dt * dt * dt / 12.0) * normal();

        x[axis] += dt * x[2 + axis] + 0.5 * dt * v + rest;
        x[2 + axis] += v;
    }
}

static void follow(const struct rho_imm_model *model, struct errors *errors)
{
    double x[4] = {0.0, 0.0, 200.0, 100.0};
    struct rho_imm imm = started(model);
    struct rho_kalman told;

    for (int axis = 0; axis < 2; ++axis) {
        imm.steady.state[3 + axis] = imm.state[3 + axis] = (float)(x[2 + axis] + 30.0 * normal());
    }
    told = imm.steady;
    for (int scan = 0; scan < SCANS; ++scan) {
        fly(x, PERIOD_S);
        const struct rho_plot plot = {.x_m = (float)(x[0] + SIGMA_M * normal()),
                                      .y_m = (float)(x[1] + SIGMA_M * normal()),
                                      .sigma_range_m = (float)SIGMA_M,
                                      .sigma_cross_m = (float)SIGMA_M};
        const float places[2] = {plot.x_m, plot.y_m};
        struct rho_imm_plot seen;
        struct rho_imm_match match;
        struct rho_kalman estimate;

        assert_int_equal(rho_kalman_predict(&told, (float)PERIOD_S, (float)WHITE_DENSITY), RHO_OK);
        for (int axis = 0; axis < 2; ++axis) {
            assert_int_equal(
                rho_kalman_update(&told, axis, places[axis], (float)(SIGMA_M * SIGMA_M), NULL),
                RHO_OK);
        }
        predict(&imm, model, (float)PERIOD_S);
        rho_imm_prepare_plot(&seen, &plot, 0, NULL);
        assert_true(rho_imm_score_plot(&imm, &seen, &match));
        assert_int_equal(rho_imm_update(&imm, model, &seen, &match), RHO_OK);
        rho_imm_estimate(&imm, &estimate, NULL);
        if (scan >= JUDGED_SCAN) {
            errors->told2 += off2(told.state, x);
            errors->imm2 += off2(estimate.state, x);
        }
    }
}

/* A target that keeps straight, by a filter that allows for 2 g. */
static void straight_targets_are_known_nearly_as_by_a_filter_that_is_told(void **state)
{
    struct rho_imm_model model = some_model();
    struct errors calm = {0.0, 0.0}, two_states = {0.0, 0.0};

    (void)state;
    dense_seed = 11;
    for (int run = 0; run < RUNS; ++run) {
        follow(&model, &calm);
    }
    model.calm_s = 0.0f;
    dense_seed = 11;
    for (int run = 0; run < RUNS; ++run) {
        follow(&model, &two_states);
    }
    const double with = sqrt(calm.imm2 / calm.told2);
    const double without = sqrt(two_states.imm2 / two_states.told2);
    print_message("rms over that of a filter that is told: %.3f; of two states %.3f\n", with,
                  without);
    assert_true(with < 1.2);           /* 1.07 */
    assert_true(with < 0.6 * without); /* 2.15 */
}

/*
 * Of the velocity, m/s, of a car that keeps straight, seen 20 times a second with 1 m, from 10 s to
 * 20 s.
 */
static double car_error_mps(float accel_max_mps2)
{
    double sum = 0.0;
    struct rho_imm_model model;

    rho_imm_model_default(&model, accel_max_mps2, 40.0f);
    dense_seed = 12;
    for (int run = 0; run < RUNS; ++run) {
        struct rho_imm imm = started(&model);

        for (int scan = 1; scan <= 400; ++scan) {
            const struct rho_plot plot = {.x_m = (float)(0.5 * scan + normal()),
                                          .y_m = (float)normal(),
                                          .sigma_range_m = 1.0f,
                                          .sigma_cross_m = 1.0f};
            struct rho_imm_plot seen;
            struct rho_imm_match match;
            struct rho_kalman estimate;

            predict(&imm, &model, 0.05f);
            rho_imm_prepare_plot(&seen, &plot, 0, NULL);
            assert_true(rho_imm_score_plot(&imm, &seen, &match));
            assert_int_equal(rho_imm_update(&imm, &model, &seen, &match), RHO_OK);
            rho_imm_estimate(&imm, &estimate, NULL);
            sum +=
                scan > 200 ? pow(estimate.state[3] - 10.0, 2.0) + pow(estimate.state[4], 2.0) : 0.0;
        }
    }
    return sqrt(sum / (200.0 * RUNS));
}

/*
 * Who says that targets accelerate less knows straight ones better: .59 at 6 m/s^2 and .10 at 30
 * was the other way round.
 */
static void straight_cars_are_known_the_better_the_less_they_may_accelerate(void **state)
{
    static const float accels_mps2[] = {30.0f, 20.0f, 10.0f, 6.0f, 4.0f, 2.0f, 1.0f};
    double before_mps = 0.5; /* a quarter of it is measured */

    (void)state;
    for (size_t k = 0; k < NUM(accels_mps2); ++k) {
        const double error_mps = car_error_mps(accels_mps2[k]);
        print_message("%g m/s^2: %.3f m/s\n", (double)accels_mps2[k], error_mps);
        assert_true(error_mps < 1.05 * before_mps);
        before_mps = error_mps;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(calm_grows_with_the_time_that_nothing_happens),
        cmocka_unit_test(calm_falls_with_manoeuvres_and_comes_back),
        cmocka_unit_test(time_alone_moves_the_share),
        cmocka_unit_test(the_noise_lies_between_calm_and_agile),
        cmocka_unit_test(a_refuted_manoeuvre_gives_nothing_back),
        cmocka_unit_test(without_calm_targets_the_chain_has_two_states),
        cmocka_unit_test(certainty_survives_any_interval),
        cmocka_unit_test(straight_targets_are_known_nearly_as_by_a_filter_that_is_told),
        cmocka_unit_test(straight_cars_are_known_the_better_the_less_they_may_accelerate),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
