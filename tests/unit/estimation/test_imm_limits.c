/* SPDX-License-Identifier: MIT */
/*
 * The interacting multiple model filter at its limits: refused calls, and rounding in extreme
 * cases.
 */
#include <float.h>
#include <string.h>

#include "dense_filter.h"

#include "rhotrack/detail/hypotheses.h"
#include "rhotrack/detail/imm.h"

#include "one_bearing.h"

#define NUM(array) (sizeof(array) / sizeof((array)[0]))
#define PLACED RHO_TRIANGLE(RHO_IMM_STATES)

static struct rho_imm_model model_of_limits(float accel_max_mps2, float v_max_mps)
{
    struct rho_imm_model model;

    rho_imm_model_default(&model, accel_max_mps2, v_max_mps);
    return model;
}

static struct rho_imm started_filter(const struct rho_imm_model *model, int num_axes,
                                     float position_variance)
{
    struct rho_kalman first;
    struct rho_imm imm;

    rho_kalman_init(&first);
    for (int axis = 0; axis < num_axes; ++axis) {
        assert_int_equal(rho_kalman_open_axis(&first, axis, 1000.0f * (float)(axis + 1),
                                              position_variance,
                                              model->speed_sigma_mps * model->speed_sigma_mps),
                         RHO_OK);
    }
    rho_imm_start(&imm, model, &first);
    return imm;
}

static enum rho_status predict_filter(struct rho_imm *imm, const struct rho_imm_model *model,
                                      float dt_s)
{
    struct rho_imm_step step;

    rho_imm_prepare_step(&step, model, dt_s);
    return rho_imm_predict(imm, &step);
}

/* Scores and updates; a plot outside the gate updates, too, and the probability stays. */
static enum rho_status update_with_plot(struct rho_imm *imm, const struct rho_imm_model *model,
                                        const struct rho_plot *plot, uint32_t measures)
{
    struct rho_imm_plot seen;
    struct rho_imm_match match;

    rho_imm_prepare_plot(&seen, plot, measures, NULL);
    if (!rho_imm_score_plot(imm, &seen, &match)) {
        match.probability = imm->probability;
    }
    return rho_imm_update(imm, model, &seen, &match);
}

static struct rho_plot plot_at(float x_m, float y_m, float z_m, float sigma_m)
{
    return (struct rho_plot){.x_m = x_m,
                             .y_m = y_m,
                             .z_m = z_m,
                             .sigma_range_m = sigma_m,
                             .sigma_cross_m = sigma_m,
                             .sigma_up_m = sigma_m,
                             .sigma_mps = 10.0f,
                             .sigma_range_rate_mps = 1.0f};
}

/*
 * Tries a Cholesky factorisation of the open elements in double precision, their variances raised
 * by that share.
 */
static int is_positive_definite(int n, const float *covariance, double variances_raised_by_share)
{
    double l[RHO_IMM_STATES][RHO_IMM_STATES] = {{0.0}};

    for (int i = 0; i < n; ++i) {
        for (int j = 0; j <= i; ++j) {
            double rest = covariance[RHO_AT(i, j)];

            rest *= i == j ? 1.0 + variances_raised_by_share : 1.0;
            for (int k = 0; k < j; ++k) {
                rest -= l[i][k] * l[j][k];
            }
            if (i == j && covariance[RHO_AT(i, i)] == 0.0f) {
                continue;
            }
            if (i == j && !(rest > 0.0)) {
                return 0;
            }
            l[i][j] = i == j ? sqrt(rest) : (l[j][j] > 0.0 ? rest / l[j][j] : 0.0);
        }
    }
    return 1;
}

static void assert_finite_and_within_limits(int n, const float *state, const float *covariance,
                                            int has_z)
{
    for (int i = 0; i < n; ++i) {
        const float variance = covariance[RHO_AT(i, i)];

        assert_true(isfinite(state[i]));
        if (i % 3 < 2 || has_z) {
            assert_true(variance >= RHO_VARIANCE_MIN && variance <= RHO_VARIANCE_MAX);
        } else {
            assert_true(variance == 0.0f && state[i] == 0.0f);
        }
    }
    for (int i = 0; i < RHO_TRIANGLE(n); ++i) {
        assert_true(isfinite(covariance[i]));
    }
}

static void assert_valid_filter(const struct rho_imm *imm)
{
    const int has_z = rho_kalman_has_axis(&imm->steady, 2);

    assert_finite_and_within_limits(6, imm->steady.state, imm->steady.covariance, has_z);
    assert_finite_and_within_limits(RHO_IMM_STATES, imm->state, imm->covariance, has_z);
    assert_true(imm->probability >= 0.0f && imm->probability <= 1.0f);
    assert_true(imm->calm >= 0.0f && imm->calm <= 1.0f);
}

static void assert_positive_definite(const struct rho_imm *imm)
{
    assert_true(is_positive_definite(6, imm->steady.covariance, 0.0));
    assert_true(is_positive_definite(RHO_IMM_STATES, imm->covariance, 0.0));
}

/* ---- sizes and models ----------------------------------------------------------------------- */

static void filters_and_hypotheses_fit_their_memory_budget(void **state)
{
    (void)state;
    assert_true(sizeof(struct rho_imm) <= 512);
    assert_true(sizeof(struct rho_hypothesis) <= 512);
    assert_true(sizeof(struct rho_hypotheses) <= RHO_RAM_HYPOTHESES_BYTES);
#ifndef RHO_PROFILE_WORKSTATION
    assert_int_equal(RHO_MAX_HYPOTHESES, 96);
    assert_int_equal(RHO_MAX_TRACKS, 32);
    assert_true(sizeof(struct rho_hypotheses) <= 48 * 1024);
#endif
}

static void the_default_model_follows_speed_and_acceleration_limits(void **state)
{
    static const float accels[] = {0.0f, 0.01f, 1.0f, 5.0f, 120.0f, 300.0f, 1000.0f};
    static const float speeds[] = {1.0f, 10.0f, 300.0f, 1000.0f, 20000.0f};

    (void)state;
    for (size_t n = 0; n < NUM(accels) * NUM(speeds); ++n) {
        const double a = accels[n % NUM(accels)], v = speeds[n / NUM(accels)];
        const struct rho_imm_model model = model_of_limits((float)a, (float)v);
        const double turn_s = a * 1000.0 > v ? v / a : 1000.0;

        assert_true(rho_imm_model_is_usable(&model));
        assert_float_equal(model.memory_s, fmax(3.0, 0.35 * turn_s), 1e-6 * turn_s + 1e-6);
        assert_float_equal(model.maneuver_s, fmax(4.0, 0.47 * turn_s), 1e-6 * turn_s + 1e-6);
        assert_true(model.steady_s == model.maneuver_s);
        /* stationary variance of a Singer process: density times memory / 2 */
        assert_float_equal(0.5 * model.drive_density * model.memory_s, pow(0.8 * a, 2),
                           1e-5 * a * a);
        assert_float_equal(model.quiet_density, fmin(1.0, 0.0025 * a * a), 1e-6);
        assert_float_equal(model.calm_density, fmin(0.003, 0.0025 * a * a), 1e-8);
        assert_true(model.calm_s == 300.0f && model.settle_s == 60.0f);
        assert_true(model.speed_sigma_mps == (float)v && model.accel_sigma_mps2 == (float)a);
    }
}

static void models_with_parameters_out_of_range_are_refused(void **state)
{
    static const float bad[] = {NAN, INFINITY, -INFINITY, -1.0f, 1e9f};
    const struct rho_imm_model good = model_of_limits(30.0f, 300.0f);
    struct rho_imm_model model;
    const struct {
        float *field;
        int may_be_0; /* true for densities and accelerations, not for times and speeds */
    } cases[] = {{&model.quiet_density, 0}, /* 0 is less than calm_density */
                 {&model.calm_density, 1},  {&model.drive_density, 1},
                 {&model.memory_s, 0},      {&model.steady_s, 0},
                 {&model.maneuver_s, 0},    {&model.calm_s, 1},
                 {&model.settle_s, 0},      {&model.speed_sigma_mps, 0},
                 {&model.speed_max_mps, 1}, {&model.accel_sigma_mps2, 1}};

    (void)state;
    assert_true(rho_imm_model_is_usable(&good));
    for (size_t n = 0; n < NUM(cases); ++n) {
        for (size_t k = 0; k < NUM(bad); ++k) {
            model = good;
            *cases[n].field = bad[k];
            assert_false(rho_imm_model_is_usable(&model));
        }
        model = good;
        *cases[n].field = 0.0f;
        assert_int_equal(rho_imm_model_is_usable(&model), cases[n].may_be_0);
    }
}

/* calm_density may not exceed quiet_density; without calm targets settle_s may be 0. */
static void models_with_calm_targets_noisier_than_others_are_refused(void **state)
{
    struct rho_imm_model model = model_of_limits(30.0f, 300.0f);

    (void)state;
    model.calm_density = model.quiet_density;
    assert_true(rho_imm_model_is_usable(&model));
    model.calm_density = nextafterf(model.quiet_density, 2.0f);
    assert_false(rho_imm_model_is_usable(&model));
    model.calm_density = model.quiet_density = 0.0f;
    assert_true(rho_imm_model_is_usable(&model));
    model.settle_s = 9e-4f;
    assert_false(rho_imm_model_is_usable(&model));
    model.calm_s = 0.0f;
    assert_true(rho_imm_model_is_usable(&model));
    model.settle_s = 0.0f;
    assert_true(rho_imm_model_is_usable(&model));
    model.settle_s = -1.0f;
    assert_false(rho_imm_model_is_usable(&model));
}

/* ---- vague estimates and sharp sensors ------------------------------------------------------ */

/*
 * The variance is 5e8 times that of the plots, as when a very good sensor sees a target after a
 * poor one.
 */
static void a_vague_start_with_a_sharp_sensor_stays_positive_definite(void **state)
{
    (void)state;
    for (int n = 0; n < 400; ++n) {
        const uint32_t measures = (n & 1 ? RHO_MEASURES_Z : 0u) |
                                  (n & 2 ? RHO_MEASURES_VELOCITY : 0u) |
                                  (n & 4 ? RHO_MEASURES_RANGE_RATE : 0u);
        const struct rho_imm_model model = model_of_limits(100.0f, 1000.0f);
        struct rho_imm imm = started_filter(&model, 2 + (n & 1), 5e8f);

        for (int k = 0; k < 30; ++k) {
            struct rho_plot plot = plot_at((float)(1000.0 + normal()), (float)(2000.0 + normal()),
                                           (float)(3000.0 + normal()), 1.0f);

            plot.sigma_mps = 1.0f;
            if (n & 8) {
                plot.sigma_cross_m = 30.0f;
            }
            assert_int_equal(predict_filter(&imm, &model, (float)uniform(0.1, 2.0)), RHO_OK);
            assert_int_equal(update_with_plot(&imm, &model, &plot, measures), RHO_OK);
            assert_valid_filter(&imm);
            assert_positive_definite(&imm);
        }
    }
}

/* Each plot's sigma is drawn from a millimetre to 100 km. */
static void sigmas_from_millimetres_to_100_km_stay_positive_definite(void **state)
{
    (void)state;
    for (int n = 0; n < 200; ++n) {
        const struct rho_imm_model model = model_of_limits(100.0f, 1000.0f);
        struct rho_imm imm = started_filter(&model, 3, 1e6f);

        for (int k = 0; k < 50; ++k) {
            const float sigma_m = (float)pow(10.0, uniform(-3.0, 5.0));
            const struct rho_plot plot =
                plot_at((float)(1000.0 + sigma_m * normal()), (float)(2000.0 + sigma_m * normal()),
                        (float)(3000.0 + sigma_m * normal()), sigma_m);

            assert_int_equal(predict_filter(&imm, &model, (float)uniform(0.1, 10.0)), RHO_OK);
            assert_int_equal(update_with_plot(&imm, &model, &plot, n % 2 ? RHO_MEASURES_Z : 0u),
                             RHO_OK);
            assert_valid_filter(&imm);
            assert_positive_definite(&imm);
        }
    }
}

/* ---- random hostile calls ------------------------------------------------------------------- */

static float random_power_of_ten(double from_exponent, double to_exponent)
{
    return (float)pow(10.0, uniform(from_exponent, to_exponent));
}

static uint32_t random_measures(void)
{
    const double choice = uniform(0.0, 8.0);

    return (uint32_t)choice & 7u;
}

static struct rho_plot random_hostile_plot(const struct rho_imm *imm)
{
    const float sigma_m = random_power_of_ten(-3.0, 5.0);
    struct rho_plot plot = plot_at(imm->state[0], imm->state[1], imm->state[2], sigma_m);
    float *const places[3] = {&plot.x_m, &plot.y_m, &plot.z_m};

    for (int i = 0; i < 3; ++i) {
        const double sigma = sqrt((double)imm->covariance[RHO_AT(i, i)] + sigma_m * sigma_m);

        *places[i] += (float)(sigma * normal());
        *places[i] = fmaxf(-2e6f, fminf(2e6f, *places[i]));
    }
    plot.vx_mps = (float)uniform(-2e4, 2e4);
    plot.vy_mps = imm->state[4];
    plot.vz_mps = (float)uniform(-100.0, 100.0);
    plot.range_rate_mps = (float)uniform(-1e3, 1e3);
    plot.sigma_mps = random_power_of_ten(-3.0, 5.0);
    plot.sigma_range_rate_mps = random_power_of_ten(-3.0, 5.0);
    if (uniform(0.0, 1.0) < 0.5) {
        plot.sigma_cross_m = random_power_of_ten(-3.0, 5.0);
        plot.sigma_up_m = random_power_of_ten(-3.0, 5.0);
    }
    return plot;
}

static enum rho_status make_random_call(struct rho_imm *imm, const struct rho_imm_model *model)
{
    const double choice = uniform(0.0, 1.0);
    float gain_nat;

    if (choice < 0.4) {
        return predict_filter(imm, model, random_power_of_ten(-6.0, 3.0));
    }
    if (choice < 0.45) {
        struct rho_imm_step step;

        rho_imm_prepare_step(&step, model, (float)uniform(-1.0, 1.0));
        return rho_imm_predict_unmixed(imm, &step);
    }
    if (choice < 0.55) {
        return update_imm_by_bearing(imm, (float)uniform(-1e5, 1e5), (float)uniform(-1e5, 1e5),
                                     (float)uniform(-3.14, 3.14), random_power_of_ten(-6.0, -0.4),
                                     &gain_nat);
    }
    const struct rho_plot plot = random_hostile_plot(imm);
    const uint32_t measures = random_measures();
    return update_with_plot(imm, model, &plot, measures);
}

/* A refused call may leave an invalid filter, so the test goes on from the one before. */
static void random_hostile_calls_leave_a_valid_filter(void **state)
{
    unsigned num_refused = 0, num_definite = 0, num_judged = 0;
    struct rho_imm_model model = model_of_limits(100.0f, 1000.0f);
    struct rho_imm imm = started_filter(&model, 2, 1e4f);

    (void)state;
    for (int n = 0; n < 100000; ++n) {
        const struct rho_imm before = imm;

        if (make_random_call(&imm, &model) != RHO_OK) {
            imm = before;
            num_refused++;
        }
        assert_valid_filter(&imm);
        if (n % 16 == 0) {
            num_judged++;
            num_definite += is_positive_definite(6, imm.steady.covariance, 1e-6) &&
                            is_positive_definite(RHO_IMM_STATES, imm.covariance, 1e-6);
        }
        if (n % 200 == 199) {
            const float accel_mps2 = random_power_of_ten(0.0, 3.0);

            model = model_of_limits(accel_mps2, random_power_of_ten(0.0, 4.0));
            imm = started_filter(&model, 2 + (n / 200) % 2, random_power_of_ten(-6.0, 8.0));
        }
    }
    /*
     * 9522 were refused; 6234 of 6250 covariances were positive definite, the others singular
     * before a plot 10^8 times sharper
     */
    assert_in_range(num_refused, 1000, 20000);
    assert_true(num_judged == 6250 && num_definite >= 6220);
}

/* ---- refusals -------------------------------------------------------------------------------- */

static void steps_that_are_not_finite_or_too_long_are_refused(void **state)
{
    static const float bad[] = {NAN, INFINITY, -INFINITY, 1.1e5f, -1.1e5f};
    const struct rho_imm_model model = model_of_limits(100.0f, 1000.0f);

    (void)state;
    for (size_t k = 0; k < NUM(bad); ++k) {
        struct rho_imm imm = started_filter(&model, 3, 100.0f);
        struct rho_imm_step step;

        rho_imm_prepare_step(&step, &model, bad[k]);
        assert_int_equal(rho_imm_predict_unmixed(&imm, &step), RHO_ERROR_VALUE);
        assert_int_equal(rho_imm_predict(&imm, &step), RHO_ERROR_VALUE);
    }
}

/* A target that hardly moves, so that no variance exceeds its limit. */
static void steps_are_limited_to_about_a_day(void **state)
{
    const struct rho_imm_model model = {
        .memory_s = 1e6f, .steady_s = 1.0f, .maneuver_s = 1.0f, .speed_sigma_mps = 1e-3f};
    struct rho_imm imm = started_filter(&model, 3, 1.0f);

    (void)state;
    assert_int_equal(predict_filter(&imm, &model, 1.0e5f), RHO_OK);
    assert_int_equal(predict_filter(&imm, &model, -1.0e5f), RHO_OK);
    assert_int_equal(predict_filter(&imm, &model, 1.1e5f), RHO_ERROR_VALUE);
    assert_int_equal(predict_filter(&imm, &model, -1.1e5f), RHO_ERROR_VALUE);
}

static void predictions_beyond_the_largest_variance_are_refused(void **state)
{
    const struct rho_imm_model model = model_of_limits(100.0f, 1000.0f);

    (void)state;
    for (int coupled = 0; coupled < 2; ++coupled) {
        struct rho_imm imm = started_filter(&model, 3, 100.0f);
        int num_steps = 0;

        imm.is_coupled = (uint8_t)coupled;
        while (predict_filter(&imm, &model, 30.0f) == RHO_OK) {
            assert_valid_filter(&imm);
            assert_true(++num_steps < 1000);
        }
        assert_true(num_steps > 3);
        /* the limit is exceeded in one step */
        imm = started_filter(&model, 3, 100.0f);
        imm.is_coupled = (uint8_t)coupled;
        assert_int_equal(predict_filter(&imm, &model, 1e5f), RHO_ERROR_VALUE);
        imm = started_filter(&model, 3, RHO_VARIANCE_MAX);
        imm.is_coupled = (uint8_t)coupled;
        assert_int_equal(predict_filter(&imm, &model, 1.0f), RHO_ERROR_VALUE);
    }
}

/* NAN or infinity in any element makes a prediction fail, whether the axes are coupled or not. */
static void filters_that_hold_nan_or_infinity_are_not_predicted(void **state)
{
    static const float bad[] = {NAN, INFINITY};
    const struct rho_imm_model model = model_of_limits(100.0f, 1000.0f);

    (void)state;
    for (size_t k = 0; k < 2 * NUM(bad); ++k) {
        for (int i = 0; i < RHO_IMM_STATES; ++i) {
            struct rho_imm imm = started_filter(&model, 3, 100.0f);

            imm.is_coupled = k % 2;
            imm.state[i] = bad[k / 2];
            assert_int_not_equal(predict_filter(&imm, &model, 1.0f), RHO_OK);
            imm = started_filter(&model, 3, 100.0f);
            imm.is_coupled = k % 2;
            imm.covariance[RHO_AT(i, i)] = bad[k / 2];
            assert_int_not_equal(predict_filter(&imm, &model, 1.0f), RHO_OK);
            if (i < 6) {
                imm = started_filter(&model, 3, 100.0f);
                imm.is_coupled = k % 2;
                imm.steady.covariance[RHO_AT(i, i)] = bad[k / 2];
                assert_int_not_equal(predict_filter(&imm, &model, 1.0f), RHO_OK);
            }
        }
    }
}

static void plots_that_are_not_finite_are_in_no_gate_and_refused(void **state)
{
    static const float bad[] = {NAN, INFINITY, -INFINITY};
    const struct rho_imm_model model = model_of_limits(100.0f, 1000.0f);

    (void)state;
    for (size_t n = 0; n < 4 * NUM(bad) * 7; ++n) {
        const int field = (int)(n / 4 % 7);
        const uint32_t measures = RHO_MEASURES_Z | RHO_MEASURES_VELOCITY |
                                  (field == 6 || n % 2 ? RHO_MEASURES_RANGE_RATE : 0u);
        struct rho_plot plot = plot_at(1000.0f, 2000.0f, 3000.0f, 10.0f);
        float *const fields[7] = {&plot.x_m,    &plot.y_m,    &plot.z_m,           &plot.vx_mps,
                                  &plot.vy_mps, &plot.vz_mps, &plot.range_rate_mps};
        struct rho_imm imm = started_filter(&model, 3, 100.0f);
        struct rho_imm_plot seen;
        struct rho_imm_match match;

        *fields[field] = bad[n / 28];
        plot.sigma_cross_m = n % 4 < 2 ? 10.0f : 40.0f;
        rho_imm_prepare_plot(&seen, &plot, measures, NULL);
        assert_false(rho_imm_score_plot(&imm, &seen, &match));
        match.probability = 0.5f;
        assert_int_not_equal(rho_imm_update(&imm, &model, &seen, &match), RHO_OK);
    }
}

/* A negative variance or a state that is not finite makes an update fail, coupled or not. */
static void invalid_estimates_are_not_updated(void **state)
{
    static const float bad_states[] = {NAN, INFINITY, -INFINITY};
    const struct rho_imm_model model = model_of_limits(100.0f, 1000.0f);
    const struct rho_plot plot = plot_at(1000.0f, 2000.0f, 3000.0f, 10.0f);

    (void)state;
    for (int n = 0; n < 2; ++n) {
        for (int i = 0; i < 2; ++i) { /* not z: a height without variance is opened */
            struct rho_imm imm = started_filter(&model, 3, 100.0f);

            imm.is_coupled = (uint8_t)n;
            imm.covariance[RHO_AT(i, i)] = -50.0f;
            assert_int_not_equal(update_with_plot(&imm, &model, &plot, RHO_MEASURES_Z), RHO_OK);
            imm = started_filter(&model, 3, 100.0f);
            imm.is_coupled = (uint8_t)n;
            imm.steady.covariance[RHO_AT(i, i)] = -50.0f;
            const enum rho_status status = update_with_plot(&imm, &model, &plot, RHO_MEASURES_Z);
            /* an update of another axis may raise the variance */
            assert_true(status != RHO_OK || n == 1);
        }
        for (size_t k = 0; k < NUM(bad_states) * RHO_IMM_STATES; ++k) {
            struct rho_imm imm = started_filter(&model, 3, 100.0f);

            imm.is_coupled = (uint8_t)n;
            imm.state[k % RHO_IMM_STATES] = bad_states[k / RHO_IMM_STATES];
            assert_int_not_equal(update_with_plot(&imm, &model, &plot, RHO_MEASURES_Z), RHO_OK);
        }
    }
}

static void bearings_that_are_not_finite_are_refused(void **state)
{
    const struct rho_imm_model model = model_of_limits(100.0f, 1000.0f);
    const float bad[] = {NAN, INFINITY, -INFINITY};

    (void)state;
    for (size_t k = 0; k < NUM(bad); k++) {
        struct rho_imm imm = started_filter(&model, 3, 100.0f);
        float gain_nat;

        assert_int_equal(update_imm_by_bearing(&imm, 0.0f, 0.0f, bad[k], 0.1f, &gain_nat),
                         RHO_ERROR_VALUE);
    }
}

/* ---- gates, copies -------------------------------------------------------------------------- */

/* A plot just inside or just outside the gate of one model, while the other model is far away. */
static void a_plot_in_the_gate_of_one_model_is_in_the_gate(void **state)
{
    const struct rho_imm_model model = model_of_limits(100.0f, 1000.0f);

    (void)state;
    for (int n = 0; n < 8; ++n) {
        const int is_inside = n & 1, is_steady = n & 2, is_coupled = n & 4;
        struct rho_imm imm = started_filter(&model, 2, 300.0f);
        struct rho_imm_match match;
        struct rho_imm_plot seen;
        const double reach = sqrt(30.0 * 400.0) * (is_inside ? 0.999 : 1.001);
        struct rho_plot plot =
            plot_at((float)(1000.0 + 0.6 * reach), (float)(2000.0 + 0.8 * reach), 0.0f, 10.0f);

        imm.is_coupled = is_coupled != 0;
        if (is_steady) {
            imm.state[0] += 1e6f;
        } else {
            imm.steady.state[0] += 1e6f;
        }
        rho_imm_prepare_plot(&seen, &plot, 0, NULL);
        assert_int_equal(rho_imm_score_plot(&imm, &seen, &match), is_inside);
        if (is_inside) {
            assert_float_equal(match.nis, 30.0 * 0.998, 0.01);
            assert_true(match.probability == (is_steady ? 0.0f : 1.0f));
            assert_float_equal(match.log_likelihood,
                               log(0.5) - 0.5 * 29.94 - log(2.0 * 3.14159265 * 400.0), 1e-3);
        }
    }
}

/*
 * One model has the probability 1 by rounding; a plot or a bearing that only the other explains
 * must restore that one.
 */
static void a_model_of_probability_zero_can_recover(void **state)
{
    const struct rho_imm_model model = model_of_limits(100.0f, 1000.0f);
    struct rho_imm imm = started_filter(&model, 2, 100.0f);
    const struct rho_plot plot = plot_at(1000.0f, 2000.0f, 0.0f, 10.0f);
    struct rho_imm_plot seen;
    struct rho_imm_match match;
    float gain_nat = 0.0f;

    (void)state;
    imm.probability = 1.0f;
    imm.state[0] += 1e5f;
    const struct rho_imm before = imm;
    rho_imm_prepare_plot(&seen, &plot, 0, NULL);
    assert_true(rho_imm_score_plot(&imm, &seen, &match));
    assert_true(match.probability == 0.0f && match.log_likelihood < -20.0f);
    assert_int_equal(update_imm_by_bearing(&imm, 1000.0f, -8000.0f, 1.5707963f, 1e-3f, &gain_nat),
                     RHO_OK);
    assert_true(imm.probability < 1e-6f && isfinite(gain_nat) && gain_nat < -10.0f);
    imm = before;
    imm.probability = 0.0f;
    imm.steady.state[0] += 2e5f;
    imm.state[0] -= 1e5f;
    assert_true(rho_imm_score_plot(&imm, &seen, &match));
    assert_true(match.probability == 1.0f && match.log_likelihood < -20.0f);
}

static void a_copied_filter_continues_identically(void **state)
{
    (void)state;
    for (int n = 0; n < 50; ++n) {
        const struct rho_imm_model model = model_of_limits(100.0f, 1000.0f);
        struct rho_imm one = started_filter(&model, 2 + n % 2, 100.0f), other;
        const uint64_t seed = dense_seed;

        for (int k = 0; k < 20; ++k) {
            (void)make_random_call(&one, &model);
        }
        memcpy(&other, &one, sizeof one);
        dense_seed = seed;
        for (int k = 0; k < 20; ++k) {
            (void)make_random_call(&one, &model);
        }
        dense_seed = seed;
        for (int k = 0; k < 20; ++k) {
            (void)make_random_call(&other, &model);
        }
        assert_memory_equal(&one, &other, sizeof one);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(filters_and_hypotheses_fit_their_memory_budget),
        cmocka_unit_test(the_default_model_follows_speed_and_acceleration_limits),
        cmocka_unit_test(models_with_parameters_out_of_range_are_refused),
        cmocka_unit_test(models_with_calm_targets_noisier_than_others_are_refused),
        cmocka_unit_test(a_vague_start_with_a_sharp_sensor_stays_positive_definite),
        cmocka_unit_test(sigmas_from_millimetres_to_100_km_stay_positive_definite),
        cmocka_unit_test(random_hostile_calls_leave_a_valid_filter),
        cmocka_unit_test(steps_that_are_not_finite_or_too_long_are_refused),
        cmocka_unit_test(steps_are_limited_to_about_a_day),
        cmocka_unit_test(predictions_beyond_the_largest_variance_are_refused),
        cmocka_unit_test(filters_that_hold_nan_or_infinity_are_not_predicted),
        cmocka_unit_test(plots_that_are_not_finite_are_in_no_gate_and_refused),
        cmocka_unit_test(invalid_estimates_are_not_updated),
        cmocka_unit_test(bearings_that_are_not_finite_are_refused),
        cmocka_unit_test(a_plot_in_the_gate_of_one_model_is_in_the_gate),
        cmocka_unit_test(a_model_of_probability_zero_can_recover),
        cmocka_unit_test(a_copied_filter_continues_identically),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
