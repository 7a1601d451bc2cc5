/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/gate.h"

#include <float.h>

#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/linalg.h"

enum { DIMENSIONS_MAX = RHO_Z + 2 }; /* x, y, z and the range rate */

/* Predicts the range rate of an estimate: it holds for all plots without an own time. */
static void predict_range_rate(const struct rho_kalman *at, const struct rho_sensor *sensor,
                               int has_z, struct rho_gate_rate *rate)
{
    float row[RHO_KALMAN_STATES], projected[RHO_KALMAN_STATES];
    rate->is_known = rho_measurement_predict_rate(at->state, sensor, has_z, row, &rate->rate_mps);
    if (rate->is_known) {
        rate->variance = rho_linalg_project6(at->covariance, row, projected);
        for (int i = 0; i < 3; i++) {
            rate->covariance[i] = projected[i];
        }
    }
}

void rho_gate_open(struct rho_gate *gate, const struct rho_kalman *predicted, float noise_density,
                   const struct rho_sensor *sensor, uint32_t measures)
{
    gate->predicted = *predicted;
    gate->noise_density = noise_density;
    gate->sensor = sensor;
    gate->has_z = rho_kalman_has_axis(predicted, 2);
    gate->measures = measures;
    if (measures & RHO_MEASURES_RANGE_RATE) {
        predict_range_rate(predicted, sensor, gate->has_z, &gate->rate);
    }
}

void rho_gate_box(const struct rho_gate *gate, float sigma_max_m, float offset_max_s,
                  float half_widths_m[2])
{
    const struct rho_kalman *at = &gate->predicted;
    const float *p = at->covariance;
    float noise = gate->noise_density * offset_max_s;
    for (int axis = 0; axis < 2; axis++) {
        float mixed = p[RHO_AT(axis + 3, axis)], speed_mps = at->state[axis + 3];
        float spread_m2 =
            p[RHO_AT(axis, axis)] + 2.0f * offset_max_s * rho_magnitude(mixed) +
            offset_max_s * offset_max_s * (p[RHO_AT(axis + 3, axis + 3)] + noise * (1.0f / 3.0f));
        /* a margin of more than rounding errors */
        half_widths_m[axis] =
            1.001f * rho_sqrt(RHO_GATE_CHI2_4D * (spread_m2 + sigma_max_m * sigma_max_m)) +
            offset_max_s * rho_magnitude(speed_mps);
    }
}

/* True where a plot is outside of the gate along one axis; also for NaN. Saves divisions. */
static int is_outside_on_axis(const struct rho_gate *gate, int axis, float place_m, float offset_s,
                              float variance_m2)
{
    const struct rho_kalman *at = &gate->predicted;
    const float *p = at->covariance;
    float d_m = place_m - at->state[axis], spread_m2 = p[RHO_AT(axis, axis)];
    if (offset_s > 0.0f || offset_s < 0.0f) {
        float noise = offset_s > 0.0f ? gate->noise_density * offset_s : 0.0f;
        d_m -= at->state[axis + 3] * offset_s;
        spread_m2 = spread_m2 + 2.0f * offset_s * p[RHO_AT(axis + 3, axis)] +
                    offset_s * offset_s * (p[RHO_AT(axis + 3, axis + 3)] + noise * (1.0f / 3.0f));
    }
    return !(d_m * d_m <= RHO_GATE_CHI2_4D * (spread_m2 + variance_m2));
}

/*
 * Tests position and range rate of a plot against an estimate at the plot's time. Fills *result,
 * and returns 1 where the NIS is within the limit for the number of dimensions.
 */
static int test_plot(const struct rho_gate *gate, const struct rho_kalman *at,
                     const struct rho_gate_rate *rate, const struct rho_plot *plot,
                     struct rho_gate_result *result)
{
    struct rho_measurement seen;
    /* innovation d and its covariance s: x, y, then z and the range rate where they are tested */
    float d[DIMENSIONS_MAX], s[RHO_TRIANGLE(DIMENSIONS_MAX)], noise[RHO_TRIANGLE(3)];
    rho_measurement_from_plot(plot, gate->measures, gate->sensor, &seen);
    rho_measurement_covariance(&seen, noise);
    result->has_z = gate->has_z && seen.has_z;
    int num = result->has_z ? 3 : 2;
    for (int i = 0; i < num; i++) {
        d[i] = seen.place_m[i] - at->state[i];
    }
    /* the first rows of the packed triangle are the position's covariance */
    for (int k = 0; k < RHO_TRIANGLE(num); k++) {
        s[k] = at->covariance[k] + noise[k];
    }
    result->has_range_rate = (gate->measures & RHO_MEASURES_RANGE_RATE) != 0 && rate->is_known;
    if (result->has_range_rate) { /* it is correlated with the position */
        for (int i = 0; i < num; i++) {
            s[RHO_AT(num, i)] = rate->covariance[i];
        }
        s[RHO_AT(num, num)] =
            rate->variance + plot->sigma_range_rate_mps * plot->sigma_range_rate_mps;
        d[num] = plot->range_rate_mps - rate->rate_mps;
        result->has_range_rate = rho_measurement_unfold_rate(gate->sensor, num + 1, s, d);
        num += result->has_range_rate;
    }
    if (num < DIMENSIONS_MAX) {
        return rho_linalg_nis(num, s, d, &result->distance2, &result->log_det) == RHO_OK &&
               result->distance2 <= (num == 2 ? RHO_GATE_CHI2_2D : RHO_GATE_CHI2_3D);
    }
    if (rho_linalg_cholesky(num, s, s) != RHO_OK) {
        return 0;
    }
    rho_linalg_forward(num, s, d);
    result->distance2 = 0.0f;
    for (int i = 0; i < num; i++) {
        result->distance2 += d[i] * d[i];
    }
    result->log_det = rho_linalg_log_determinant(num, s);
    return result->distance2 <= RHO_GATE_CHI2_4D;
}

int rho_gate_test(const struct rho_gate *gate, const struct rho_plot *plot,
                  struct rho_gate_result *result)
{
    /* the largest sigma: at high elevation the noise of the height is partly horizontal */
    float offset_s = (float)plot->offset_us * 1e-6f, sigma_m = rho_plot_sigma_m(plot);
    if ((gate->measures & RHO_MEASURES_Z) && plot->sigma_up_m > sigma_m) {
        sigma_m = plot->sigma_up_m;
    }
    sigma_m *= rho_measurement_factor_max(gate->sensor);
    if (is_outside_on_axis(gate, 0, plot->x_m, offset_s, sigma_m * sigma_m) ||
        is_outside_on_axis(gate, 1, plot->y_m, offset_s, sigma_m * sigma_m)) {
        return 0;
    }
    if (plot->offset_us == 0) {
        return test_plot(gate, &gate->predicted, &gate->rate, plot, result);
    }
    struct rho_kalman at = gate->predicted; /* at the plot's own time */
    struct rho_gate_rate rate;
    if (rho_kalman_predict(&at, offset_s, gate->noise_density) != RHO_OK) {
        return 0;
    }
    if (gate->measures & RHO_MEASURES_RANGE_RATE) {
        predict_range_rate(&at, gate->sensor, gate->has_z, &rate);
    }
    return test_plot(gate, &at, &rate, plot, result);
}
