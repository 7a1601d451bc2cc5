/* SPDX-License-Identifier: MIT */
/*
 * Input estimation at its limits: refused calls, equality with the Kalman filter, and rounding in
 * extreme cases.
 */
#include <float.h>
#include <string.h>

#include "dense_filter.h"
#include "kalman_checks.h"

#include "rhotrack/detail/input_estimation.h"

#define DT_S 0.25f

static struct rho_input_config paper_config(void)
{
    struct rho_input_config config;

    rho_input_config_default(&config);
    return config;
}

static struct rho_input started_filter(const struct rho_input_config *config, int num_axes)
{
    const struct rho_kalman kalman = opened_filter(num_axes, 500.0f, 500.0f);
    struct rho_input input;

    assert_int_equal(rho_input_start(&input, config, &kalman), RHO_OK);
    return input;
}

/*
 * Follows a target at rest at (100, 200, 300) m that accelerates along z from step pushed_from on.
 */
static void follow_pushed_target(struct rho_input *input, const struct rho_input_config *config,
                                 int steps, int pushed_from, float input_mps2)
{
    float z = 300.0f, speed = 0.0f;

    for (int k = 1; k <= steps; ++k) {
        if (k >= pushed_from) {
            z += speed * DT_S + 0.5f * input_mps2 * DT_S * DT_S;
            speed += input_mps2 * DT_S;
        }
        const float truth[STATES] = {100.0f, 200.0f, z, 0.0f, 0.0f, speed};
        assert_int_equal(rho_input_predict(input, config, DT_S), RHO_OK);
        for (int i = 0; i < STATES; ++i) {
            assert_int_equal(rho_input_update_element(input, config, i, truth[i], 1.0f), RHO_OK);
        }
        rho_input_decide(input, config);
    }
}

/* ---- sizes, thresholds, configurations ------------------------------------------------------- */

static void filter_and_input_fit_their_memory_budget(void **state)
{
    (void)state;
    assert_int_equal(sizeof(struct rho_kalman), 108);
    assert_true(sizeof(struct rho_input) <= 256);
}

static void thresholds_follow_from_the_confidence(void **state)
{
    (void)state;
    assert_float_equal(rho_input_threshold_sigmas(0.95f), 1.95996, 1e-3);
    for (int n = 0; n <= 9999; ++n) {
        const float confidence = (float)n / 10000.0f, t = rho_input_threshold_sigmas(confidence);
        double low = 0.0, high = 5.0;

        for (int k = 0; k < 60; ++k) { /* expected threshold, by bisection */
            const double middle = 0.5 * (low + high);

            if (erf(middle / sqrt(2.0)) < confidence) {
                low = middle;
            } else {
                high = middle;
            }
        }
        assert_float_equal(t, low, 1e-3);
    }
    assert_true(isnan(rho_input_threshold_sigmas(1.0f)) &&
                isnan(rho_input_threshold_sigmas(-0.01f)));
    assert_true(isnan(rho_input_threshold_sigmas(NAN)) &&
                isnan(rho_input_threshold_sigmas(INFINITY)));
}

static void the_default_configuration_is_the_papers(void **state)
{
    const struct rho_input_config config = paper_config();

    (void)state;
    assert_true(rho_input_is_usable(&config));
    assert_true(config.is_estimated && config.model == RHO_INPUT_LITERAL && config.gamma == 1.0f);
    assert_float_equal(config.sigma_mps2 * config.sigma_mps2, 500.0, 1e-3);
    assert_float_equal(config.threshold, 1.96, 1e-4);
    assert_true(config.noise_m == 1.0f && config.noise_mps == 1.0f && config.noise_density == 0.0f);
    assert_float_equal(config.velocity_variance, 490000.0, 0.0);
}

static void configurations_are_checked(void **state)
{
    const float bad[] = {NAN, INFINITY, -INFINITY, -1.0f};
    const struct rho_kalman kalman = opened_filter(3, 1.0f, 1.0f);
    struct rho_input input;

    (void)state;
    memset(&input, 0x5a, sizeof input);
    const struct rho_input before = input;
    for (size_t n = 0; n < 7 * NUM(bad); ++n) {
        struct rho_input_config config = paper_config();
        float *const fields[] = {&config.sigma_mps2,       &config.threshold, &config.gamma,
                                 &config.noise_density,    &config.noise_m,   &config.noise_mps,
                                 &config.velocity_variance};

        *fields[n / NUM(bad)] = bad[n % NUM(bad)];
        assert_false(rho_input_is_usable(&config));
        assert_int_equal(rho_input_start(&input, &config, &kalman), RHO_ERROR_CONFIG);
    }
    struct rho_input_config config = paper_config();
    config.model = RHO_NUM_INPUT_MODELS;
    assert_false(rho_input_is_usable(&config));
    config = paper_config();
    config.gamma = 1.001f;
    assert_false(rho_input_is_usable(&config));
    config.gamma = 0.0f;
    assert_false(rho_input_is_usable(&config));
    /* the first of each pair is usable, the second is not */
    const float sigmas_mps2[][2] = {{0.0011f, 0.0009f}, {1.0e5f, 1.01e5f}};
    for (size_t n = 0; n < NUM(sigmas_mps2); ++n) {
        config = paper_config();
        config.sigma_mps2 = sigmas_mps2[n][0];
        assert_true(rho_input_is_usable(&config));
        config.sigma_mps2 = sigmas_mps2[n][1];
        assert_false(rho_input_is_usable(&config));
    }
    config = paper_config();
    config.noise_m = config.noise_mps = 1.0e6f;
    assert_true(rho_input_is_usable(&config));
    config.noise_m = 1.01e6f;
    assert_false(rho_input_is_usable(&config));
    config = paper_config();
    assert_memory_equal(&input, &before, sizeof input);
}

/* ---- onset of an input ---------------------------------------------------------------------- */

static void an_input_is_detected_in_one_scan(void **state)
{
    (void)state;
    for (int model = 0; model < RHO_NUM_INPUT_MODELS; ++model) {
        struct rho_input_config config = paper_config();

        config.model = (uint8_t)model;
        struct rho_input input = started_filter(&config, 3);
        follow_pushed_target(&input, &config, 20, 21, 98.0f);
        assert_int_equal(input.present, 0);
        struct rho_input pushed = started_filter(&config, 3);
        follow_pushed_target(&pushed, &config, 21, 21, 98.0f);
        assert_int_equal(pushed.present, 4);
        assert_in_range(pushed.input_mps2[2], 80, 100);
        assert_true(pushed.input_mps2[0] == 0.0f && pushed.input_mps2[1] == 0.0f);
        for (int i = 0; i < STATES; ++i) {
            assert_true(pushed.sensitivity[0][i] == 0.0f && pushed.sensitivity[1][i] == 0.0f);
        }
    }
}

/* 0.1 g is within the noise; with a threshold above its significance not even 10 g is an input. */
static void an_acceleration_below_the_threshold_is_no_input(void **state)
{
    struct rho_input_config config = paper_config();
    struct rho_input input = started_filter(&config, 3);

    (void)state;
    follow_pushed_target(&input, &config, 30, 21, 1.0f);
    assert_int_equal(input.present, 0);
    config.threshold = 20.0f; /* the significance of 10 g here is 14.6 */
    input = started_filter(&config, 3);
    follow_pushed_target(&input, &config, 21, 21, 98.0f);
    assert_int_equal(input.present, 0);
}

static void the_literal_model_sees_no_input_in_positions(void **state)
{
    (void)state;
    for (int model = 0; model < RHO_NUM_INPUT_MODELS; ++model) {
        struct rho_input_config config = paper_config();
        uint32_t seen = 0;

        config.model = (uint8_t)model;
        config.threshold = 1e-6f;
        struct rho_input input = started_filter(&config, 3);
        for (int k = 1; k <= 20; ++k) {
            assert_int_equal(rho_input_predict(&input, &config, DT_S), RHO_OK);
            for (int axis = 0; axis < 3; ++axis) {
                assert_int_equal(rho_input_update_element(&input, &config, axis,
                                                          100.0f + 40.0f * (float)(k * k), 1.0f),
                                 RHO_OK);
            }
            rho_input_decide(&input, &config);
            seen |= input.present;
        }
        assert_int_equal(seen, model == RHO_INPUT_PHYSICAL ? 7 : 0);
    }
}

/* A scan without a plot decides nothing, so that the input acts over two intervals. */
static void sensitivities_grow_over_a_missed_scan(void **state)
{
    const struct rho_input_config config = paper_config();
    struct rho_input input = started_filter(&config, 3);

    (void)state;
    assert_int_equal(rho_input_predict(&input, &config, DT_S), RHO_OK);
    assert_int_equal(rho_input_predict(&input, &config, DT_S), RHO_OK);
    for (int axis = 0; axis < 3; ++axis) {
        assert_float_equal(input.sensitivity[axis][axis], 0.0625, 1e-7);
        assert_float_equal(input.sensitivity[axis][axis + 3], 0.5, 1e-7);
    }
}

/* ---- equality with the Kalman filter -------------------------------------------------------- */

static struct rho_plot random_plot(void)
{
    struct rho_plot plot;

    plot = (struct rho_plot){.sigma_range_m = 15.0f, .sigma_cross_m = 80.0f, .sigma_up_m = 60.0f};
    plot.x_m = (float)uniform(2e4, 3e4);
    plot.y_m = (float)uniform(-2e4, 2e4);
    plot.z_m = (float)uniform(1e3, 9e3);
    return plot;
}

static void without_input_estimation_it_equals_the_kalman_filter(void **state)
{
    struct rho_input_config config = paper_config();
    struct rho_kalman estimate;

    (void)state;
    config.is_estimated = 0;
    config.noise_density = 3.0f;
    struct rho_input input = started_filter(&config, 3);
    struct rho_kalman kalman = input.bare;
    for (int k = 0; k < 50; ++k) {
        const struct rho_plot plot = random_plot();
        struct rho_measurement seen;

        rho_measurement_from_plot(&plot, k % 2 ? RHO_MEASURES_Z : 0u, NULL, &seen);
        assert_int_equal(rho_input_predict(&input, &config, DT_S), RHO_OK);
        assert_int_equal(rho_kalman_predict(&kalman, DT_S, 3.0f), RHO_OK);
        for (int i = 0; i < STATES; ++i) {
            kalman.covariance[RHO_AT(i, i)] += 1.0f;
        }
        assert_int_equal(rho_input_update_position(&input, &config, &seen), RHO_OK);
        assert_int_equal(rho_kalman_update_position(&kalman, &seen, config.velocity_variance),
                         RHO_OK);
        assert_int_equal(rho_input_update_element(&input, &config, k % 6, 50.0f, 30.0f), RHO_OK);
        assert_int_equal(rho_kalman_update(&kalman, k % 6, 50.0f, 30.0f, NULL), RHO_OK);
        assert_int_equal(rho_input_update_range_rate(&input, &config, NULL, 20.0f, 4.0f), RHO_OK);
        assert_int_equal(rho_kalman_update_range_rate(&kalman, NULL, 20.0f, 4.0f), RHO_OK);
        rho_input_decide(&input, &config);
        rho_input_estimate(&input, &estimate);
        assert_memory_equal(&estimate, &kalman, sizeof kalman);
    }
    assert_int_equal(input.present, 0);
}

/*
 * The Kalman filter rotates its frame while this one uses rows: they agree within rounding,
 * whichever axes are open.
 */
static void position_updates_agree_with_the_kalman_filter(void **state)
{
    const struct rho_input_config config = paper_config();

    (void)state;
    for (int n = 0; n < 2000; ++n) {
        const struct rho_plot plot = random_plot();
        struct rho_plot round = plot;
        struct rho_kalman kalman;
        struct rho_measurement seen;
        struct rho_input input;

        round.sigma_cross_m = round.sigma_up_m = round.sigma_range_m;
        random_covariance(kalman.covariance, 1.5);
        for (int i = 0; i < STATES; ++i) {
            const double off = normal();
            const float at[STATES] = {plot.x_m, plot.y_m, plot.z_m};

            kalman.state[i] = at[i] + (float)(30.0 * off);
        }
        for (int axis = 0; axis < 3; ++axis) {
            if (n % 4 == 1 || (n % 4 == 2 && axis == 2) || (n % 4 == 3 && axis < 2)) {
                close_axis(&kalman, axis);
            }
        }
        rho_measurement_from_plot(n % 5 ? &plot : &round, n % 7 ? RHO_MEASURES_Z : 0u, NULL, &seen);
        assert_int_equal(rho_input_start(&input, &config, &kalman), RHO_OK);
        assert_int_equal(rho_input_update_position(&input, &config, &seen), RHO_OK);
        assert_int_equal(rho_kalman_update_position(&kalman, &seen, config.velocity_variance),
                         RHO_OK);
        const struct dense expected = dense_of(kalman.state, kalman.covariance);
        struct dense scale = expected;
        for (int i = 0; i < STATES; ++i) {
            /* bound of all variances before the update */
            scale.p[i][i] = scale.p[i][i] > 0.0 ? 3e4 : 0.0;
        }
        assert_near_dense(input.bare.state, input.bare.covariance, &expected, &scale, 2e-5);
        assert_true(is_positive_definite(&input.bare));
    }
}

/* An axis opened by a first height has no input yet, and may get one later. */
static void an_axis_opened_later_can_have_an_input(void **state)
{
    const struct rho_input_config config = paper_config();
    struct rho_input input = started_filter(&config, 2);
    const struct rho_measurement seen = {.place_m = {100.0f, 200.0f, 300.0f},
                                         .variance_m2 = {1.0f, 1.0f, 1.0f},
                                         .cos_azimuth = 1.0f,
                                         .cos_elevation = 1.0f,
                                         .has_z = 1,
                                         .is_isotropic = 1};

    (void)state;
    for (int k = 0; k < 10; ++k) {
        assert_int_equal(rho_input_predict(&input, &config, DT_S), RHO_OK);
        assert_true(input.sensitivity[2][5] == 0.0f && input.bare.covariance[RHO_AT(2, 2)] == 0.0f);
        assert_int_equal(rho_input_update_element(&input, &config, 0, 100.0f, 1.0f), RHO_OK);
        rho_input_decide(&input, &config);
    }
    assert_int_equal(rho_input_update_position(&input, &config, &seen), RHO_OK);
    assert_true(rho_kalman_has_axis(&input.bare, 2));
    rho_input_decide(&input, &config);
    follow_pushed_target(&input, &config, 21, 21, 98.0f);
    assert_int_equal(input.present, 4);
}

/* ---- predictions back in time --------------------------------------------------------------- */

static void prediction_forth_and_back_restores_the_filter(void **state)
{
    (void)state;
    for (int model = 0; model < RHO_NUM_INPUT_MODELS; ++model) {
        struct rho_input_config config = paper_config();

        config.model = (uint8_t)model;
        config.noise_m = config.noise_mps = 0.0f;
        struct rho_input input = started_filter(&config, 3);
        follow_pushed_target(&input, &config, 25, 21, 98.0f);
        const struct rho_input before = input;
        assert_int_equal(rho_input_predict(&input, &config, 0.0f), RHO_OK);
        assert_memory_equal(&input, &before, sizeof input);
        assert_int_equal(rho_input_predict(&input, &config, 1.5f), RHO_OK);
        config.noise_m = config.noise_mps = 50.0f;
        config.noise_density = 100.0f;
        config.gamma = 0.5f;
        assert_int_equal(rho_input_predict(&input, &config, -1.5f), RHO_OK);
        for (int i = 0; i < STATES; ++i) {
            assert_float_equal(input.bare.state[i], before.bare.state[i], 1e-3);
            assert_float_equal(input.bare.covariance[RHO_AT(i, i)],
                               before.bare.covariance[RHO_AT(i, i)], 1e-3);
            for (int axis = 0; axis < 3; ++axis) {
                assert_float_equal(input.sensitivity[axis][i], before.sensitivity[axis][i], 1e-5);
            }
        }
        assert_memory_equal(input.variance, before.variance, sizeof before.variance);
    }
}

/* ---- refusals ------------------------------------------------------------------------------- */

static struct rho_input manoeuvring_filter(const struct rho_input_config *config)
{
    struct rho_input input = started_filter(config, 3);

    follow_pushed_target(&input, config, 25, 21, 98.0f);
    assert_int_equal(input.present, 4);
    return input;
}

static void bad_numbers_change_nothing(void **state)
{
    const float bad[] = {NAN, INFINITY, -INFINITY};
    const struct rho_input_config config = paper_config();
    struct rho_input input = manoeuvring_filter(&config);
    const struct rho_input before = input;

    (void)state;
    for (size_t k = 0; k < NUM(bad); ++k) {
        assert_int_not_equal(rho_input_predict(&input, &config, bad[k]), RHO_OK);
        for (int i = 0; i < STATES; ++i) {
            float row[STATES] = {1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f};

            assert_int_not_equal(rho_input_update_element(&input, &config, i, bad[k], 1.0f),
                                 RHO_OK);
            assert_int_not_equal(rho_input_update_element(&input, &config, i, 1.0f, bad[k]),
                                 RHO_OK);
            row[i] = bad[k];
            assert_int_not_equal(rho_input_update_row(&input, &config, row, 1.0f, 1.0f), RHO_OK);
            assert_int_not_equal(rho_input_update_row(&input, &config, row, bad[k], 1.0f), RHO_OK);
        }
        for (int i = 0; i < 6; ++i) {
            struct rho_measurement seen = {.place_m = {100.0f, 200.0f, 900.0f},
                                           .variance_m2 = {1.0f, 2.0f, 3.0f},
                                           .cos_azimuth = 0.8f,
                                           .sin_azimuth = 0.6f,
                                           .cos_elevation = 1.0f,
                                           .has_z = 1};

            seen.is_isotropic = i % 2;
            *(i < 3 ? &seen.place_m[i] : &seen.variance_m2[i - 3]) = bad[k];
            assert_int_not_equal(rho_input_update_position(&input, &config, &seen), RHO_OK);
        }
        assert_int_not_equal(rho_input_update_range_rate(&input, &config, NULL, bad[k], 1.0f),
                             RHO_OK);
        assert_int_not_equal(rho_input_update_range_rate(&input, &config, NULL, 1.0f, bad[k]),
                             RHO_OK);
        assert_int_not_equal(rho_input_update_bearing(&input, &config, 0.0f, 0.0f, bad[k], 0.1f),
                             RHO_OK);
        assert_int_not_equal(rho_input_update_bearing(&input, &config, 0.0f, 0.0f, 1.0f, bad[k]),
                             RHO_OK);
    }
    assert_int_equal(rho_input_update_element(&input, &config, 6, 1.0f, 1.0f), RHO_ERROR_VALUE);
    assert_int_equal(rho_input_update_element(&input, &config, -1, 1.0f, 1.0f), RHO_ERROR_VALUE);
    assert_int_equal(rho_input_update_element(&input, &config, 0, 1.0f, 0.0f), RHO_ERROR_VALUE);
    assert_int_equal(rho_input_update_element(&input, &config, 0, FLT_MAX, 1.0f), RHO_ERROR_VALUE);
    assert_int_equal(rho_input_predict(&input, &config, 1.1e5f), RHO_ERROR_VALUE);
    assert_memory_equal(&input, &before, sizeof input);
}

/* The bare filter could be predicted by 10^4 s; with its input the variance is too large. */
static void a_prediction_too_uncertain_by_its_input_is_refused(void **state)
{
    struct rho_input_config config = paper_config();

    (void)state;
    config.model = RHO_INPUT_PHYSICAL;
    struct rho_input input = manoeuvring_filter(&config);
    const struct rho_input before = input;
    struct rho_kalman bare = input.bare;
    assert_int_equal(rho_kalman_predict(&bare, 1e4f, 0.0f), RHO_OK);
    assert_int_equal(rho_input_predict(&input, &config, 1e4f), RHO_ERROR_VALUE);
    assert_memory_equal(&input, &before, sizeof input);
    struct rho_input quiet = started_filter(&config, 3);
    follow_pushed_target(&quiet, &config, 20, 21, 0.0f);
    assert_int_equal(rho_input_predict(&quiet, &config, 1e4f), RHO_OK);
}

/* ---- extreme cases -------------------------------------------------------------------------- */

static int is_variance_positive_definite(const float v[6])
{
    const double xx = v[0], yx = v[1], yy = v[2], zx = v[3], zy = v[4], zz = v[5];
    const double second = yy - yx * yx / xx, mixed = zy - zx * yx / xx;

    return xx > 0.0 && second > 0.0 && zz - zx * zx / xx - mixed * mixed / second > 0.0;
}

static void assert_valid_filter(const struct rho_input *input)
{
    struct rho_kalman estimate;

    assert_finite_with_variances_in_limits(&input->bare);
    assert_true(is_positive_definite(&input->bare));
    assert_true(is_variance_positive_definite(input->variance));
    for (int axis = 0; axis < 3; ++axis) {
        assert_true(isfinite(input->input_mps2[axis]));
        for (int i = 0; i < STATES; ++i) {
            assert_true(isfinite(input->sensitivity[axis][i]));
        }
    }
    rho_input_gate_estimate(input, &estimate);
    assert_true(is_positive_definite(&estimate));
    rho_input_estimate(input, &estimate);
    assert_true(is_positive_definite(&estimate));
    for (int i = 0; i < PACKED; ++i) {
        assert_true(isfinite(estimate.covariance[i]));
        assert_true(isfinite(estimate.state[i % STATES]));
    }
}

static float random_hostile_number(double from_exponent, double to_exponent)
{
    static const float nonsense[] = {NAN,      INFINITY,     -INFINITY, FLT_MAX,
                                     -FLT_MAX, FLT_TRUE_MIN, 0.0f,      -1.0f};
    const double sign = uniform(0.0, 1.0) < 0.3 ? -1.0 : 1.0;
    const double usual = sign * pow(10.0, uniform(from_exponent, to_exponent));
    const int which = (int)uniform(0.0, 8.0);

    return uniform(0.0, 1.0) < 0.05 ? nonsense[which] : (float)usual;
}

static enum rho_status update_with_random_position(struct rho_input *input,
                                                   const struct rho_input_config *config)
{
    struct rho_plot plot = random_plot();
    struct rho_measurement seen;

    plot.sigma_range_m = fabsf(random_hostile_number(-1.0, 2.0));
    plot.sigma_cross_m = fabsf(random_hostile_number(-1.0, 3.0));
    plot.sigma_up_m = fabsf(random_hostile_number(-1.0, 3.0));
    rho_measurement_from_plot(&plot, RHO_MEASURES_Z, NULL, &seen);
    return rho_input_update_position(input, config, &seen);
}

static enum rho_status make_random_call(struct rho_input *input,
                                        const struct rho_input_config *config)
{
    const int what = (int)uniform(0.0, 12.0), element = (int)uniform(-0.2, 6.2);
    const float first = random_hostile_number(-3.0, 5.0), second = random_hostile_number(-6.0, 6.0),
                dt_s = random_hostile_number(-3.0, 2.0);
    float row[STATES];

    for (int i = 0; i < STATES; ++i) {
        row[i] = (float)normal();
    }
    switch (what) {
    case 0:
    case 1:
    case 2:
        return rho_input_predict(input, config, dt_s);
    case 3:
    case 4:
        return update_with_random_position(input, config);
    case 5:
        return rho_input_update_row(input, config, row, first, second);
    case 6:
        return rho_input_update_range_rate(input, config, NULL, first, second);
    case 7:
        return rho_input_update_bearing(input, config, first, second, (float)uniform(-3.0, 3.0),
                                        1e-3f);
    case 8:
        rho_input_decide(input, config);
        return RHO_OK;
    default:
        return rho_input_update_element(input, config, element, first, second);
    }
}

static void random_hostile_calls_leave_a_valid_filter(void **state)
{
    int accepted = 0, present = 0, num = 0;

    (void)state;
    dense_seed = 7;
    for (int n = 0; n < 100; ++n) {
        struct rho_input_config config = paper_config();

        config.model = (uint8_t)(n % 2);
        config.gamma = n % 3 ? 0.5f : 1.0f;
        config.noise_density = n % 5 ? 0.0f : 50.0f;
        config.sigma_mps2 = n % 4 ? 22.0f : 300.0f;
        struct rho_input input = started_filter(&config, 3);
        for (int k = 0; k < 2000; ++k) {
            const struct rho_input before = input;
            const enum rho_status status = make_random_call(&input, &config);

            accepted += status == RHO_OK;
            present += input.present != 0;
            ++num;
            if (status != RHO_OK) {
                assert_memory_equal(&input, &before, sizeof input);
            }
            assert_valid_filter(&input);
        }
    }
    assert_true(accepted > num / 3 && accepted < num);
    assert_true(present > num / 20);
}

/* The input's variance falls by a factor of 10^8, without cancellation. */
static void a_vague_input_with_a_sharp_sensor_stays_positive_definite(void **state)
{
    struct rho_input_config config = paper_config();

    (void)state;
    config.model = RHO_INPUT_PHYSICAL;
    config.sigma_mps2 = 2000.0f;
    config.noise_m = config.noise_mps = 0.0f;
    struct rho_input input = started_filter(&config, 3);
    for (int k = 1; k <= 30; ++k) {
        const float t_s = 10.0f * (float)k;

        assert_int_equal(rho_input_predict(&input, &config, 10.0f), RHO_OK);
        for (int axis = 0; axis < 3; ++axis) {
            assert_int_equal(
                rho_input_update_element(&input, &config, axis,
                                         100.0f * (float)(axis + 1) + 20.0f * t_s * t_s, 1.0f),
                RHO_OK);
        }
        rho_input_decide(&input, &config);
        assert_valid_filter(&input);
        assert_int_equal(input.present, 7);
    }
    for (int axis = 0; axis < 3; ++axis) {
        assert_float_equal(input.input_mps2[axis], 40.0, 1e-3);
    }
}

/*
 * A target at rest, known far better than an input would move it, is pushed at the last step. The
 * input's variance must be V P / (V s^2 + P).
 */
static void an_onset_seen_by_a_sharp_sensor_is_estimated(void **state)
{
    struct rho_input_config config = paper_config();

    (void)state;
    config.model = RHO_INPUT_PHYSICAL;
    config.sigma_mps2 = 2000.0f;
    config.noise_m = config.noise_mps = 0.0f;
    struct rho_input input = started_filter(&config, 3);
    for (int k = 1; k <= 25; ++k) {
        assert_int_equal(rho_input_predict(&input, &config, 10.0f), RHO_OK);
        assert_valid_filter(&input);
        for (int axis = 0; axis < 3; ++axis) {
            const double variance = input.bare.covariance[RHO_AT(axis, axis)] + 1e-4;
            const double s = input.sensitivity[axis][axis], v = 4e6;
            const float onset_m = k == 25 ? 500.0f : 0.0f;

            assert_int_equal(rho_input_update_element(&input, &config, axis,
                                                      100.0f * (float)(axis + 1) + onset_m, 1e-4f),
                             RHO_OK);
            assert_float_equal(input.variance[RHO_AT(axis, axis)],
                               v * variance / (v * s * s + variance),
                               1e-4 * v * variance / (v * s * s + variance));
            assert_valid_filter(&input);
        }
        rho_input_decide(&input, &config);
        assert_int_equal(input.present, k == 25 ? 7 : 0);
        assert_valid_filter(&input);
    }
    for (int axis = 0; axis < 3; ++axis) {
        assert_float_equal(input.input_mps2[axis], 10.0, 1e-3);
    }
}

/* The input adds 10^10 times the bare variance, whose rounding alone would exceed the latter. */
static void an_estimate_widened_by_an_input_stays_positive_definite(void **state)
{
    struct rho_input_config config = paper_config();

    (void)state;
    config.model = RHO_INPUT_PHYSICAL;
    config.sigma_mps2 = 2000.0f;
    config.noise_m = config.noise_mps = 0.0f;
    for (int n = 0; n < 2000; ++n) {
        const struct rho_kalman sharp = opened_filter(3, 1e-6f, 1e-6f);
        struct rho_kalman estimate;
        struct rho_input input;

        assert_int_equal(rho_input_start(&input, &config, &sharp), RHO_OK);
        assert_int_equal(rho_input_predict(&input, &config, (float)uniform(0.1, 3.0)), RHO_OK);
        rho_input_gate_estimate(&input, &estimate);
        assert_true(is_positive_definite(&estimate));
    }
}

static void a_copied_filter_continues_identically(void **state)
{
    struct rho_input_config config = paper_config();
    unsigned char snapshot[sizeof(struct rho_input)];

    (void)state;
    config.gamma = 0.5f;
    struct rho_input one = manoeuvring_filter(&config), other;
    memset(&other, 0xa5, sizeof other);
    memcpy(snapshot, &one, sizeof one);
    follow_pushed_target(&one, &config, 30, 10, -60.0f);
    memcpy(&other, snapshot, sizeof other);
    follow_pushed_target(&other, &config, 30, 10, -60.0f);
    assert_memory_equal(&one, &other, sizeof one);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(filter_and_input_fit_their_memory_budget),
        cmocka_unit_test(thresholds_follow_from_the_confidence),
        cmocka_unit_test(the_default_configuration_is_the_papers),
        cmocka_unit_test(configurations_are_checked),
        cmocka_unit_test(an_input_is_detected_in_one_scan),
        cmocka_unit_test(an_acceleration_below_the_threshold_is_no_input),
        cmocka_unit_test(the_literal_model_sees_no_input_in_positions),
        cmocka_unit_test(sensitivities_grow_over_a_missed_scan),
        cmocka_unit_test(without_input_estimation_it_equals_the_kalman_filter),
        cmocka_unit_test(position_updates_agree_with_the_kalman_filter),
        cmocka_unit_test(an_axis_opened_later_can_have_an_input),
        cmocka_unit_test(prediction_forth_and_back_restores_the_filter),
        cmocka_unit_test(bad_numbers_change_nothing),
        cmocka_unit_test(a_prediction_too_uncertain_by_its_input_is_refused),
        cmocka_unit_test(random_hostile_calls_leave_a_valid_filter),
        cmocka_unit_test(a_vague_input_with_a_sharp_sensor_stays_positive_definite),
        cmocka_unit_test(an_onset_seen_by_a_sharp_sensor_is_estimated),
        cmocka_unit_test(an_estimate_widened_by_an_input_stays_positive_definite),
        cmocka_unit_test(a_copied_filter_continues_identically),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
