/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "rhotrack/detail/gate.h"

#define TOLERANCE 1e-4
#define NOISE 2.0f /* spectral density of white acceleration, m^2/s^3 */

static uint32_t seed = 3;

static float uniform(float from, float to)
{
    seed = seed * 1664525u + 1013904223u;
    return from + (to - from) * (float)(seed >> 8) / 16777216.0f;
}

/* A filter whose axes are correlated, with random places. */
static struct rho_kalman random_filter(int axes)
{
    struct rho_kalman kalman;
    rho_kalman_init(&kalman);
    for (int axis = 0; axis < axes; axis++) {
        assert_int_equal(rho_kalman_open_axis(&kalman, axis, uniform(-900.0f, 900.0f),
                                              uniform(50.0f, 500.0f), 400.0f),
                         RHO_OK);
    }
    assert_int_equal(rho_kalman_predict(&kalman, uniform(0.5f, 2.0f), 1.0f), RHO_OK);
    kalman.covariance[RHO_AT(1, 0)] = 30.0f; /* less than the variances of the open axes */
    return kalman;
}

/* Covariance of elements i and j, predicted to a plot's own time by F P F^T + Q. */
static double predicted_covariance(const struct rho_kalman *kalman, int i, int j, double offset_s)
{
    double from_i[2] = {1.0, i < 3 ? offset_s : 0.0}, from_j[2] = {1.0, j < 3 ? offset_s : 0.0};
    double noise_s = offset_s > 0.0 ? offset_s : 0.0, sum = 0.0;
    for (int a = 0; a < 2; a++) {
        for (int b = 0; b < 2; b++) {
            int row = i + 3 * a, column = j + 3 * b;
            if (row < 6 && column < 6) {
                sum += from_i[a] * from_j[b] * (double)kalman->covariance[RHO_AT(row, column)];
            }
        }
    }
    if (i % 3 == j % 3 && kalman->covariance[RHO_AT(i % 3, i % 3)] > 0.0f) {
        int positions = (i < 3) + (j < 3);
        sum += (double)NOISE * (positions == 2   ? noise_s * noise_s * noise_s / 3.0
                                : positions == 1 ? noise_s * noise_s / 2.0
                                                 : noise_s);
    }
    return sum;
}

/* Squared Mahalanobis distance and ln det by Gaussian elimination. */
static double mahalanobis2(int n, double s[4][4], const double d[4], double *log_det)
{
    double a[4][5], sum = 0.0;
    *log_det = 0.0;
    for (int i = 0; i < n; i++) {
        memcpy(a[i], s[i], sizeof s[i]);
        a[i][n] = d[i];
    }
    for (int k = 0; k < n; k++) {
        *log_det += log(a[k][k]);
        sum += a[k][n] * a[k][n] / a[k][k];
        for (int i = k + 1; i < n; i++) {
            double share = a[i][k] / a[k][k];
            for (int j = k; j <= n; j++) {
                a[i][j] -= share * a[k][j];
            }
        }
    }
    return sum;
}

/* A plot's noise covariance in x, y, z, from its sigmas along, across and up the line of sight. */
static void plot_noise_xyz(const struct rho_plot *plot, const struct rho_sensor *sensor, int has_z,
                           double r[3][3])
{
    double d[3] = {plot->x_m - sensor->x_m, plot->y_m - sensor->y_m,
                   has_z ? plot->z_m - sensor->z_m : 0.0};
    double ground = hypot(d[0], d[1]), range = hypot(ground, d[2]);
    double axis[3][3] = {
        {d[0] / range, d[1] / range, d[2] / range},
        {-d[1] / ground, d[0] / ground, 0.0},
        {-d[2] * d[0] / range / ground, -d[2] * d[1] / range / ground, ground / range}};
    double sigma[3] = {plot->sigma_range_m, plot->sigma_cross_m, has_z ? plot->sigma_up_m : 0.0};
    memset(r, 0, 9 * sizeof r[0][0]);
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                r[i][j] += sigma[k] * sigma[k] * axis[k][i] * axis[k][j];
            }
        }
    }
}

/* Squared Mahalanobis distance and ln det in double precision; returns the number of dimensions. */
static int gate_in_double_precision_and_count_dimensions(const struct rho_kalman *kalman,
                                                         const struct rho_plot *plot,
                                                         uint32_t measures,
                                                         const struct rho_sensor *sensor,
                                                         double *distance2, double *log_det)
{
    double offset_s = plot->offset_us * 1e-6, at[6], r[3][3], s[4][4] = {{0.0}}, d[4] = {0.0};
    int has_z = (measures & RHO_MEASURES_Z) != 0, n = has_z ? 3 : 2;
    for (int i = 0; i < 3; i++) {
        at[i] = (double)kalman->state[i] + offset_s * (double)kalman->state[i + 3];
        at[i + 3] = (double)kalman->state[i + 3];
    }
    const double place[3] = {plot->x_m, plot->y_m, plot->z_m};
    plot_noise_xyz(plot, sensor, has_z, r);
    for (int i = 0; i < n; i++) {
        d[i] = place[i] - at[i];
        for (int j = 0; j < n; j++) {
            s[i][j] = predicted_covariance(kalman, i, j, offset_s) + r[i][j];
        }
    }
    if (measures & RHO_MEASURES_RANGE_RATE) {
        double los[3] = {at[0] - sensor->x_m, at[1] - sensor->y_m,
                         kalman->covariance[RHO_AT(2, 2)] > 0.0f ? at[2] - sensor->z_m : 0.0};
        double range = sqrt(los[0] * los[0] + los[1] * los[1] + los[2] * los[2]), rate = 0.0;
        double row[6];
        for (int i = 0; i < 3; i++) {
            rate += los[i] / range * at[i + 3];
        }
        for (int i = 0; i < 3; i++) {
            row[i] = (at[i + 3] - rate * los[i] / range) / range;
            row[i + 3] = los[i] / range;
        }
        s[n][n] = pow(plot->sigma_range_rate_mps, 2);
        for (int i = 0; i < 6; i++) {
            for (int j = 0; j < 6; j++) {
                s[n][n] += row[i] * row[j] * predicted_covariance(kalman, i, j, offset_s);
                if (i < n) {
                    s[i][n] += row[j] * predicted_covariance(kalman, i, j, offset_s);
                }
            }
        }
        for (int i = 0; i < n; i++) {
            s[n][i] = s[i][n];
        }
        d[n] = plot->range_rate_mps - rate;
        n++;
    }
    *distance2 = mahalanobis2(n, s, d, log_det);
    return n;
}

static struct rho_plot random_plot_around(const struct rho_kalman *kalman)
{
    return (struct rho_plot){.x_m = kalman->state[0] + uniform(-90.0f, 90.0f),
                             .y_m = kalman->state[1] + uniform(-90.0f, 90.0f),
                             .z_m = kalman->state[2] + uniform(-90.0f, 90.0f),
                             .range_rate_mps = uniform(-60.0f, 60.0f),
                             .sigma_range_m = uniform(2.0f, 20.0f),
                             .sigma_cross_m = uniform(2.0f, 60.0f),
                             .sigma_up_m = uniform(2.0f, 40.0f),
                             .sigma_range_rate_mps = uniform(1.0f, 30.0f),
                             .offset_us = (int32_t)uniform(-1e6f, 1e6f)};
}

/*
 * Plots with their own noise, heights, range rates and times are compared with double precision:
 * the quick rejection must lose no plot.
 */
static void the_gate_uses_every_measured_dimension(void **state)
{
    (void)state;
    static const double limit[5] = {0.0, 0.0, (double)RHO_GATE_CHI2_2D, (double)RHO_GATE_CHI2_3D,
                                    (double)RHO_GATE_CHI2_4D};
    const struct rho_sensor sensor = {
        .x_m = -3000.0f, .y_m = 2000.0f, .z_m = 100.0f, .pd = 0.9f, .range_max_m = 1e5f};
    int inside[5] = {0};
    for (int i = 0; i < 12000; i++) {
        uint32_t measures = (i & 1 ? RHO_MEASURES_Z : 0u) | (i & 2 ? RHO_MEASURES_RANGE_RATE : 0u);
        struct rho_kalman kalman = random_filter(3);
        struct rho_gate gate;
        struct rho_gate_result result;
        struct rho_plot plot = random_plot_around(&kalman);
        double distance2, log_det;
        kalman.state[3] = uniform(-40.0f, 40.0f);
        kalman.state[4] = uniform(-40.0f, 40.0f);
        int n = gate_in_double_precision_and_count_dimensions(&kalman, &plot, measures, &sensor,
                                                              &distance2, &log_det);
        rho_gate_open(&gate, &kalman, NOISE, &sensor, measures);
        int is_in = rho_gate_test(&gate, &plot, &result);
        if (fabs(distance2 - limit[n]) > 0.02) {
            assert_int_equal(is_in, distance2 < limit[n]);
        }
        if (is_in) {
            inside[n]++;
            assert_float_equal(result.distance2, distance2, 1e-3 * (1.0 + distance2));
            assert_float_equal(result.log_det, log_det, 1e-3 * fabs(log_det));
            assert_int_equal(result.has_z, i & 1);
            assert_int_equal(result.has_range_rate, (i & 2) != 0);
        }
    }
    assert_true(inside[2] > 500 && inside[3] > 1000 && inside[4] > 300);
}

/* Holds for any plot whose noise and own time are within the bounds that the box was made for. */
static void plots_in_the_gate_are_inside_its_bounding_box(void **state)
{
    (void)state;
    int inside = 0, outside = 0;
    for (int i = 0; i < 60000; i++) {
        struct rho_kalman kalman = random_filter(3);
        struct rho_gate gate;
        struct rho_gate_result result;
        struct rho_plot plot = random_plot_around(&kalman);
        float half_m[2];
        kalman.state[3] = uniform(-400.0f, 400.0f);
        kalman.state[4] = uniform(-400.0f, 400.0f);
        plot.x_m += uniform(-900.0f, 900.0f);
        plot.y_m += uniform(-900.0f, 900.0f);
        rho_gate_open(&gate, &kalman, NOISE, NULL, i & 1 ? RHO_MEASURES_Z : 0u);
        /* bounds of the noise and own times of random_plot_around */
        rho_gate_box(&gate, 60.0f, 1.0f, half_m);
        int is_beyond = fabsf(plot.x_m - kalman.state[0]) > half_m[0] ||
                        fabsf(plot.y_m - kalman.state[1]) > half_m[1];
        if (rho_gate_test(&gate, &plot, &result)) {
            inside++;
            assert_false(is_beyond);
        }
        outside += is_beyond;
    }
    assert_true(inside > 1000 && outside > 1000);
}

/* Without own times the box is as wide as the gate along one axis, within 1 % for rounding. */
static void the_bounding_box_is_as_small_as_the_gate_allows(void **state)
{
    (void)state;
    for (int i = 0; i < 100; i++) {
        const struct rho_kalman kalman = random_filter(3);
        struct rho_gate gate;
        float half_m[2];
        rho_gate_open(&gate, &kalman, NOISE, NULL, 0u);
        rho_gate_box(&gate, 60.0f, 0.0f, half_m);
        for (int axis = 0; axis < 2; axis++) {
            const double variance_m2 = (double)kalman.covariance[RHO_AT(axis, axis)] + 3600.0;
            const double exact_m = sqrt((double)RHO_GATE_CHI2_4D * variance_m2);
            assert_true((double)half_m[axis] >= exact_m && (double)half_m[axis] < 1.01 * exact_m);
        }
    }
}

static void a_range_rate_is_ignored_at_the_sensors_place(void **state)
{
    (void)state;
    struct rho_kalman kalman = random_filter(2);
    const struct rho_sensor sensor = {.x_m = kalman.state[0], .y_m = kalman.state[1], .pd = 0.9f};
    struct rho_plot plot = {.x_m = kalman.state[0],
                            .y_m = kalman.state[1],
                            .range_rate_mps = 9999.0f,
                            .sigma_range_m = 5.0f,
                            .sigma_cross_m = 5.0f,
                            .sigma_range_rate_mps = 1.0f};
    struct rho_gate gate;
    struct rho_gate_result result;
    rho_gate_open(&gate, &kalman, NOISE, &sensor, RHO_MEASURES_RANGE_RATE);
    assert_int_equal(rho_gate_test(&gate, &plot, &result), 1);
    assert_int_equal(result.has_range_rate, 0);
}

static void heights_count_if_both_plot_and_track_have_one(void **state)
{
    (void)state;
    struct rho_gate gate;
    struct rho_gate_result result;
    struct rho_kalman flat = random_filter(2), solid = random_filter(3);
    struct rho_plot plot = {.x_m = solid.state[0],
                            .y_m = solid.state[1],
                            .z_m = solid.state[2] + 500.0f,
                            .sigma_range_m = 5.0f,
                            .sigma_cross_m = 5.0f,
                            .sigma_up_m = 5.0f};
    rho_gate_open(&gate, &solid, NOISE, NULL, 0);
    assert_int_equal(rho_gate_test(&gate, &plot, &result), 1);
    rho_gate_open(&gate, &solid, NOISE, NULL, RHO_MEASURES_Z);
    assert_int_equal(rho_gate_test(&gate, &plot, &result), 0);
    plot.z_m = solid.state[2] + 1.0f;
    assert_int_equal(rho_gate_test(&gate, &plot, &result), 1);
    assert_int_equal(result.has_z, 1);
    rho_gate_open(&gate, &flat, NOISE, NULL, RHO_MEASURES_Z);
    plot.x_m = flat.state[0];
    plot.y_m = flat.state[1];
    assert_int_equal(rho_gate_test(&gate, &plot, &result), 1);
    assert_int_equal(result.has_z, 0);
}

static void values_that_are_not_finite_are_outside_the_gate(void **state)
{
    (void)state;
    struct rho_gate gate;
    struct rho_gate_result result;
    struct rho_kalman kalman = random_filter(2);
    struct rho_plot plot = {.x_m = NAN, .y_m = 0.0f, .sigma_range_m = 5.0f, .sigma_cross_m = 5.0f};
    rho_gate_open(&gate, &kalman, NOISE, NULL, 0);
    assert_int_equal(rho_gate_test(&gate, &plot, &result), 0);
    plot.x_m = kalman.state[0];
    plot.y_m = INFINITY;
    assert_int_equal(rho_gate_test(&gate, &plot, &result), 0);
    plot.y_m = kalman.state[1];
    assert_int_equal(rho_gate_test(&gate, &plot, &result), 1);
    kalman.covariance[0] = NAN;
    rho_gate_open(&gate, &kalman, NOISE, NULL, 0);
    assert_int_equal(rho_gate_test(&gate, &plot, &result), 0);
    kalman.covariance[0] = 100.0f;
    kalman.covariance[1] = 1e6f; /* makes the covariance indefinite */
    rho_gate_open(&gate, &kalman, NOISE, NULL, 0);
    assert_int_equal(rho_gate_test(&gate, &plot, &result), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_gate_uses_every_measured_dimension),
        cmocka_unit_test(plots_in_the_gate_are_inside_its_bounding_box),
        cmocka_unit_test(the_bounding_box_is_as_small_as_the_gate_allows),
        cmocka_unit_test(a_range_rate_is_ignored_at_the_sensors_place),
        cmocka_unit_test(heights_count_if_both_plot_and_track_have_one),
        cmocka_unit_test(values_that_are_not_finite_are_outside_the_gate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
