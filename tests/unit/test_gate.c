/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "rhotrack/gate.h"

#define TOLERANCE 1e-4

static uint32_t seed = 3;

static float uniform(float from, float to)
{
    seed = seed * 1664525u + 1013904223u;
    return from + (to - from) * (float)(seed >> 8) / 16777216.0f;
}

/* A filter with correlated axes, by updates of a few positions. */
static struct rho_kalman some_filter(int axes)
{
    struct rho_kalman kalman;
    rho_kalman_init(&kalman);
    for (int axis = 0; axis < axes; axis++) {
        assert_int_equal(rho_kalman_open_axis(&kalman, axis, uniform(-900.0f, 900.0f),
                                              uniform(50.0f, 500.0f), 400.0f),
                         RHO_OK);
    }
    assert_int_equal(rho_kalman_predict(&kalman, uniform(0.5f, 2.0f), 1.0f), RHO_OK);
    kalman.covariance[RHO_AT(1, 0)] = 30.0f; /* the open axes' variances are larger */
    return kalman;
}

static double distance2_2d(const struct rho_kalman *kalman, const struct rho_plot *plot,
                           double *log_det)
{
    double offset_s = plot->offset_us * 1e-6, sigma2 = pow(plot->sigma_cross_m, 2);
    double dx = plot->x_m - kalman->state[0] - kalman->state[3] * offset_s;
    double dy = plot->y_m - kalman->state[1] - kalman->state[4] * offset_s;
    double a = kalman->covariance[0] + sigma2, b = kalman->covariance[1];
    double c = kalman->covariance[2] + sigma2, det = a * c - b * b;
    *log_det = log(det);
    return (c * dx * dx - 2.0 * b * dx * dy + a * dy * dy) / det;
}

static void the_distance_is_mahalanobis_s(void **state)
{
    (void)state;
    int inside = 0;
    for (int i = 0; i < 2000; i++) {
        struct rho_kalman kalman = some_filter(2);
        struct rho_gate gate;
        struct rho_gate_result result;
        struct rho_plot plot = {.x_m = kalman.state[0] + uniform(-90.0f, 90.0f),
                                .y_m = kalman.state[1] + uniform(-90.0f, 90.0f),
                                .sigma_range_m = 1.0f,
                                .sigma_cross_m = uniform(2.0f, 20.0f),
                                .offset_us = (int32_t)uniform(-1e6f, 1e6f)};
        double log_det, expected = distance2_2d(&kalman, &plot, &log_det);
        rho_gate_open(&gate, &kalman);
        int is_in = rho_gate_test(&gate, &plot, 0, &result);
        if (fabs(expected - (double)RHO_GATE_CHI2_2D) > 0.01) {
            assert_int_equal(is_in, expected < (double)RHO_GATE_CHI2_2D);
        }
        if (is_in) {
            inside++;
            assert_true(fabs(result.distance2 - expected) < TOLERANCE * (1.0 + expected));
            assert_true(fabs(result.log_det - log_det) < TOLERANCE * log_det);
            assert_int_equal(result.has_z, 0);
        }
    }
    assert_in_range(inside, 500, 1950);
}

static void z_counts_where_both_have_it(void **state)
{
    (void)state;
    struct rho_gate gate;
    struct rho_gate_result result;
    struct rho_kalman flat = some_filter(2), solid = some_filter(3);
    struct rho_plot plot = {.x_m = solid.state[0],
                            .y_m = solid.state[1],
                            .z_m = solid.state[2] + 500.0f,
                            .sigma_range_m = 5.0f,
                            .sigma_cross_m = 5.0f,
                            .sigma_up_m = 5.0f};
    rho_gate_open(&gate, &solid);
    assert_int_equal(rho_gate_test(&gate, &plot, RHO_MEASURES_Z, &result), 0);
    assert_int_equal(rho_gate_test(&gate, &plot, 0, &result), 1);
    plot.z_m = solid.state[2] + 1.0f;
    assert_int_equal(rho_gate_test(&gate, &plot, RHO_MEASURES_Z, &result), 1);
    assert_int_equal(result.has_z, 1);
    rho_gate_open(&gate, &flat);
    plot.x_m = flat.state[0];
    plot.y_m = flat.state[1];
    assert_int_equal(rho_gate_test(&gate, &plot, RHO_MEASURES_Z, &result), 1);
    assert_int_equal(result.has_z, 0);
}

static void what_is_not_a_number_is_outside(void **state)
{
    (void)state;
    struct rho_gate gate;
    struct rho_gate_result result;
    struct rho_kalman kalman = some_filter(2);
    struct rho_plot plot = {.x_m = NAN, .y_m = 0.0f, .sigma_range_m = 5.0f, .sigma_cross_m = 5.0f};
    rho_gate_open(&gate, &kalman);
    assert_int_equal(rho_gate_test(&gate, &plot, 0, &result), 0);
    plot.x_m = kalman.state[0];
    plot.y_m = INFINITY;
    assert_int_equal(rho_gate_test(&gate, &plot, 0, &result), 0);
    plot.y_m = kalman.state[1];
    assert_int_equal(rho_gate_test(&gate, &plot, 0, &result), 1);
    kalman.covariance[0] = NAN;
    rho_gate_open(&gate, &kalman);
    assert_int_equal(rho_gate_test(&gate, &plot, 0, &result), 0);
    kalman.covariance[0] = 100.0f;
    kalman.covariance[1] = 1e6f; /* not positive definite */
    rho_gate_open(&gate, &kalman);
    assert_int_equal(rho_gate_test(&gate, &plot, 0, &result), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_distance_is_mahalanobis_s),
        cmocka_unit_test(z_counts_where_both_have_it),
        cmocka_unit_test(what_is_not_a_number_is_outside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
