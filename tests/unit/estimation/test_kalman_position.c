/* SPDX-License-Identifier: MIT */
/*
 * Position updates in the frame of a plot's line of sight, compared with the vector update in
 * double precision.
 */
#include <float.h>

#include "dense_filter.h"
#include "kalman_checks.h"

/* Tolerances in sigmas of the estimate before; largest seen: 3.8e-5, 2.9e-6 and 4.8e-4. */
#define POSITION_RELATIVE 1e-4
#define OPEN_RELATIVE 2e-5
#define ORDER_RELATIVE 2e-3

#define NUM_CASES 2000
#define SPEED_VARIANCE 1e5f

static const struct rho_sensor somewhere = {
    .sensor_id = 3, .x_m = 1200.0f, .y_m = -3400.0f, .z_m = 250.0f};
static const double there_m[3] = {1200.0, -3400.0, 250.0};

/* --- positions -------------------------------------------------------------------------------- */

static struct rho_plot random_plot(void)
{
    return (struct rho_plot){.x_m = (float)uniform(-3e4, 3e4),
                             .y_m = (float)uniform(-3e4, 3e4),
                             .z_m = (float)uniform(-2e4, 2e4),
                             .sigma_range_m = (float)uniform(5.0, 50.0),
                             .sigma_cross_m = (float)uniform(5.0, 100.0),
                             .sigma_up_m = (float)uniform(5.0, 100.0)};
}

static struct rho_measurement measurement_of(const struct rho_plot *plot, int axes)
{
    struct rho_measurement seen;

    rho_measurement_from_plot(plot, axes == 3 ? RHO_MEASURES_Z : 0u, &somewhere, &seen);
    return seen;
}

static struct dense_place expected_place(const struct rho_plot *plot, int axes)
{
    const double at[3] = {plot->x_m, plot->y_m, plot->z_m};
    const double variance[3] = {pow(plot->sigma_range_m, 2), pow(plot->sigma_cross_m, 2),
                                pow(plot->sigma_up_m, 2)};

    return dense_place_of(there_m, at, axes, variance);
}

/* A correlated estimate near the plot with all axes open and sigmas of 2 to some 80. */
static struct rho_kalman estimate_about(const struct rho_plot *plot)
{
    struct rho_kalman kalman;

    random_covariance(kalman.covariance, 1.5);
    for (int i = 0; i < STATES; ++i) {
        kalman.state[i] = (float)(sqrt(kalman.covariance[RHO_AT(i, i)]) * normal());
    }
    kalman.state[0] += plot->x_m;
    kalman.state[1] += plot->y_m;
    kalman.state[2] += plot->z_m;
    return kalman;
}

/*
 * Rotations mix the axes: errors scale with the largest variance of all positions, or all
 * velocities.
 */
static struct dense scale_of_rotated_axes(const struct dense *d)
{
    struct dense scale = *d;

    for (int i = 0; i < STATES; ++i) {
        for (int k = i / 3 * 3; k < i / 3 * 3 + 3; ++k) {
            scale.p[i][i] = fmax(scale.p[i][i], d->p[k][k]);
        }
    }
    return scale;
}

static void assert_position_update(struct rho_kalman *kalman, const struct rho_measurement *seen,
                                   const struct dense *expected, const struct dense *before,
                                   double relative)
{
    const struct dense scale = scale_of_rotated_axes(before);

    assert_int_equal(rho_kalman_update_position(kalman, seen, SPEED_VARIANCE), RHO_OK);
    assert_near_dense(kalman->state, kalman->covariance, expected, &scale, relative);
    assert_true(is_positive_definite(kalman));
}

static void positions_agree_with_the_vector_update(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        const int axes = 2 + n % 2; /* without a measured height, z changes by its correlation */
        struct rho_plot plot = random_plot();
        struct rho_kalman kalman = estimate_about(&plot);
        const struct dense before = dense_of(kalman.state, kalman.covariance);
        struct dense expected = before;

        if (n % 5 == 0) {
            plot.sigma_cross_m = plot.sigma_up_m = plot.sigma_range_m;
        }
        const struct rho_measurement seen = measurement_of(&plot, axes);
        const struct dense_place place = expected_place(&plot, axes);
        dense_update_place(&expected, &place, 0, axes);
        assert_true(seen.is_isotropic == (n % 5 == 0));
        assert_position_update(&kalman, &seen, &expected, &before, POSITION_RELATIVE);
    }
}

/* Seen along y: variances of 12 and 4 make 3 there, and 100 and 100 make 50 across. */
static void a_position_update_agrees_with_a_result_by_hand(void **state)
{
    const struct rho_measurement seen = {.place_m = {300.0f, 130.0f, 0.0f},
                                         .cos_azimuth = 0.0f,
                                         .sin_azimuth = 1.0f,
                                         .cos_elevation = 1.0f,
                                         .variance_m2 = {4.0f, 100.0f, 0.0f}};
    struct rho_kalman kalman = opened_filter(2, 100.0f, 9.0f);

    (void)state;
    kalman.state[1] = 122.0f;
    kalman.covariance[RHO_AT(1, 1)] = 12.0f;
    assert_int_equal(rho_kalman_update_position(&kalman, &seen, SPEED_VARIANCE), RHO_OK);
    assert_float_equal(kalman.state[0], 200.0, 0.01);
    assert_float_equal(kalman.state[1], 128.0, 0.001);
    assert_float_equal(kalman.covariance[RHO_AT(0, 0)], 50.0, 0.001);
    assert_float_equal(kalman.covariance[RHO_AT(1, 1)], 3.0, 0.001);
    assert_float_equal(kalman.covariance[RHO_AT(1, 0)], 0.0, 0.001);
}

/* --- closed axes ------------------------------------------------------------------------------ */

static void a_first_position_opens_its_axes(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        const int axes = 2 + n % 2;
        struct rho_plot plot = random_plot();
        struct dense expected = {.x = {0.0}};
        struct rho_kalman kalman;

        if (n % 5 == 0) {
            plot.sigma_cross_m = plot.sigma_up_m = plot.sigma_range_m;
        }
        const struct rho_measurement seen = measurement_of(&plot, axes);
        const struct dense_place place = expected_place(&plot, axes);
        dense_open_place(&expected, &place, 0, axes, SPEED_VARIANCE);
        rho_kalman_init(&kalman);
        assert_position_update(&kalman, &seen, &expected, &expected, OPEN_RELATIVE);
        assert_int_equal(rho_kalman_has_axis(&kalman, 2), axes == 3);
    }
}

/*
 * x and y are open and z is not: z opens with the noise of the height, x and y are updated without
 * it.
 */
static void a_first_height_opens_z_and_leaves_x_and_y_apart(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        const struct rho_plot plot = random_plot();
        const struct rho_measurement seen = measurement_of(&plot, 3);
        const struct dense_place place = expected_place(&plot, 3);
        struct rho_kalman kalman = estimate_about(&plot);

        close_axis(&kalman, 2);
        struct dense expected = dense_of(kalman.state, kalman.covariance), before = expected;
        before.p[2][2] = place.r[2][2];
        before.p[5][5] = SPEED_VARIANCE;
        dense_update_place(&expected, &place, 0, 2);
        dense_open_place(&expected, &place, 2, 3, SPEED_VARIANCE);
        assert_position_update(&kalman, &seen, &expected, &before, POSITION_RELATIVE);
    }
}

static void a_first_place_opens_x_and_y_and_leaves_z_apart(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        const struct rho_plot plot = random_plot();
        const struct rho_measurement seen = measurement_of(&plot, 3);
        const struct dense_place place = expected_place(&plot, 3);
        struct rho_kalman kalman = estimate_about(&plot);

        close_axis(&kalman, 0);
        close_axis(&kalman, 1);
        struct dense expected = dense_of(kalman.state, kalman.covariance), before = expected;
        dense_open_place(&before, &place, 0, 2, SPEED_VARIANCE);
        dense_open_place(&expected, &place, 0, 2, SPEED_VARIANCE);
        dense_update_place(&expected, &place, 2, 3);
        assert_position_update(&kalman, &seen, &expected, &before, POSITION_RELATIVE);
    }
}

/* --- refusals --------------------------------------------------------------------------------- */

static void a_position_is_refused_if_only_x_is_open(void **state)
{
    const struct rho_plot plot = {.x_m = 5000.0f,
                                  .y_m = 7000.0f,
                                  .sigma_range_m = 10.0f,
                                  .sigma_cross_m = 90.0f,
                                  .sigma_up_m = 40.0f};

    (void)state;
    for (int axes = 2; axes <= 3; ++axes) {
        const struct rho_measurement seen = measurement_of(&plot, axes);
        struct rho_kalman kalman = opened_filter(1, 4.0f, 9.0f);
        const struct rho_kalman before = kalman;

        assert_int_equal(rho_kalman_update_position(&kalman, &seen, SPEED_VARIANCE),
                         RHO_ERROR_VALUE);
        assert_changed_nothing(&kalman, &before);
    }
}

/* A plot 10^4 times wider across than along: the variance of its height must not cancel. */
static void a_first_height_of_a_very_wide_plot_is_accepted(void **state)
{
    (void)state;
    for (int i = 0; i < 60; ++i) {
        struct rho_kalman kalman = opened_filter(2, 100.0f, 100.0f);
        const double azimuth = 0.1047 * i;
        const struct rho_plot plot = {.x_m = (float)(1e5 * cos(azimuth)),
                                      .y_m = (float)(1e5 * sin(azimuth)),
                                      .z_m = 5000.0f,
                                      .sigma_range_m = 1.0f,
                                      .sigma_cross_m = 1e4f,
                                      .sigma_up_m = 1.0f};
        const struct rho_measurement seen = measurement_of(&plot, 3);

        kalman.state[0] = plot.x_m;
        kalman.state[1] = plot.y_m;
        assert_int_equal(rho_kalman_update_position(&kalman, &seen, SPEED_VARIANCE), RHO_OK);
        assert_true(rho_kalman_has_axis(&kalman, 2));
    }
}

static void assert_position_refused(const struct rho_measurement *seen, float velocity_variance,
                                    int is_open)
{
    struct rho_kalman kalman = opened_filter(is_open ? 3 : 0, 4.0f, 9.0f);

    assert_int_equal(rho_kalman_update_position(&kalman, seen, velocity_variance), RHO_ERROR_VALUE);
}

static void positions_refuse_bad_numbers(void **state)
{
    const float bad_places[] = {NAN, INFINITY, -INFINITY};
    const float bad_variances[] = {0.0f, -1.0f, NAN, INFINITY};
    const struct rho_plot plot = {.x_m = 5000.0f,
                                  .y_m = 7000.0f,
                                  .z_m = 900.0f,
                                  .sigma_range_m = 10.0f,
                                  .sigma_cross_m = 90.0f,
                                  .sigma_up_m = 40.0f};
    const struct rho_measurement good = measurement_of(&plot, 3);

    (void)state;
    for (int is_open = 0; is_open <= 1; ++is_open) {
        for (int i = 0; i < 2 * 3; ++i) {
            struct rho_measurement bad = good;

            bad.is_isotropic = i / 3;
            for (size_t k = 0; k < NUM(bad_places); ++k) {
                bad.place_m[i % 3] = bad_places[k];
                assert_position_refused(&bad, SPEED_VARIANCE, is_open);
            }
            bad.place_m[i % 3] = good.place_m[i % 3];
            for (size_t k = 0; k < NUM(bad_variances); ++k) {
                bad.variance_m2[i % 3] = bad_variances[k];
                assert_position_refused(&bad, SPEED_VARIANCE, is_open);
            }
        }
    }
    for (size_t k = 0; k < NUM(bad_variances); ++k) {
        assert_position_refused(&good, bad_variances[k], 0);
    }
}

/* --- extreme cases ---------------------------------------------------------------------------- */

/* Updates with a measured combination of velocities. */
static void update_velocity_row(struct rho_kalman *kalman, const float row[STATES], double value)
{
    double innovation = value;

    for (int i = 3; i < STATES; ++i) {
        innovation -= (double)row[i] * kalman->state[i];
    }
    assert_int_equal(rho_kalman_update_row(kalman, row, (float)innovation, 30.0f), RHO_OK);
}

/* Both updates are linear, so that either may come first. */
static void the_order_of_positions_and_rows_does_not_matter(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        const struct rho_plot plot = random_plot();
        const struct rho_measurement seen = measurement_of(&plot, 3);
        struct rho_kalman one = estimate_about(&plot), other = one;
        const struct dense before = dense_of(one.state, one.covariance);
        const float row[STATES] = {0.0f,           0.0f, 0.0f, (float)normal(), (float)normal(),
                                   (float)normal()};
        const double value = 10.0 * normal();

        assert_int_equal(rho_kalman_update_position(&one, &seen, SPEED_VARIANCE), RHO_OK);
        update_velocity_row(&one, row, value);
        update_velocity_row(&other, row, value);
        const struct dense expected = dense_of(one.state, one.covariance);
        assert_position_update(&other, &seen, &expected, &before, ORDER_RELATIVE);
    }
}

/*
 * A variance of 10^8 is updated with variances of 1 along a line of sight that turns from scan to
 * scan.
 */
static void a_vague_start_with_a_sharp_radar_stays_positive_definite(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES / 10; ++n) {
        struct rho_kalman kalman = opened_filter(3, 1e8f, 1e8f);

        for (int k = 0; k < 60; ++k) {
            struct rho_plot plot = random_plot();

            plot.sigma_range_m = 1.0f;
            plot.sigma_cross_m = n % 3 == 0 ? 1.0f : 300.0f;
            const struct rho_measurement seen = measurement_of(&plot, n % 2 == 0 ? 3 : 2 + k % 2);
            assert_int_equal(rho_kalman_update_position(&kalman, &seen, SPEED_VARIANCE), RHO_OK);
            assert_finite_with_variances_in_limits(&kalman);
            assert_true(is_positive_definite(&kalman));
            assert_int_equal(rho_kalman_predict(&kalman, 1.0f, 0.0f), RHO_OK);
            assert_true(is_positive_definite(&kalman));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(positions_agree_with_the_vector_update),
        cmocka_unit_test(a_position_update_agrees_with_a_result_by_hand),
        cmocka_unit_test(a_first_position_opens_its_axes),
        cmocka_unit_test(a_first_height_opens_z_and_leaves_x_and_y_apart),
        cmocka_unit_test(a_first_place_opens_x_and_y_and_leaves_z_apart),
        cmocka_unit_test(a_position_is_refused_if_only_x_is_open),
        cmocka_unit_test(a_first_height_of_a_very_wide_plot_is_accepted),
        cmocka_unit_test(positions_refuse_bad_numbers),
        cmocka_unit_test(the_order_of_positions_and_rows_does_not_matter),
        cmocka_unit_test(a_vague_start_with_a_sharp_radar_stays_positive_definite),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
