/* SPDX-License-Identifier: MIT */
#include "rhotrack/gate.h"

#include <float.h>

#include "rhotrack/approx.h"
#include "rhotrack/linalg.h"

#define DIMENSIONS_MAX 4

void rho_gate_open(struct rho_gate *gate, const struct rho_kalman *predicted, float noise_density,
                   const struct rho_sensor *sensor)
{
    gate->predicted = *predicted;
    gate->noise_density = noise_density;
    gate->sensor = sensor;
    gate->has_z = rho_kalman_is_open(predicted, 2);
}

/* Outside the gate along one axis alone, at the plot's own time: most plots end here, without a division. NaN ends
 * here too. */
static int is_far(const struct rho_gate *gate, int axis, float place_m, float offset_s,
                  float variance_m2)
{
    const struct rho_kalman *at = &gate->predicted;
    const float *p = at->covariance;
    float d_m = place_m - at->state[axis] - at->state[axis + 3] * offset_s;
    float noise = offset_s > 0.0f ? gate->noise_density * offset_s : 0.0f;
    float spread_m2 = p[RHO_AT(axis, axis)] + 2.0f * offset_s * p[RHO_AT(axis + 3, axis)] +
                      offset_s * offset_s * (p[RHO_AT(axis + 3, axis + 3)] + noise * (1.0f / 3.0f));
    return !(d_m * d_m <= RHO_GATE_CHI2_4D * (spread_m2 + variance_m2));
}

/* Innovation and its covariance: x, y, then z and the range rate where they count. */
struct innovation {
    int num;
    float d[DIMENSIONS_MAX];
    float s[RHO_TRIANGLE(DIMENSIONS_MAX)];
};

static void add_position(const struct rho_kalman *at, const struct rho_measurement *seen, int num,
                         struct innovation *innovation)
{
    float noise[RHO_TRIANGLE(3)];
    rho_measurement_covariance(seen, noise);
    innovation->num = num;
    for (int i = 0; i < num; i++) {
        innovation->d[i] = seen->place_m[i] - at->state[i];
    }
    /* the first rows of the packed triangle are the position's covariance */
    for (int k = 0; k < RHO_TRIANGLE(num); k++) {
        innovation->s[k] = at->covariance[k] + noise[k];
    }
}

/* A range rate's row meets the position's: the innovations are correlated. */
static int add_range_rate(const struct rho_gate *gate, const struct rho_kalman *at,
                          const struct rho_plot *plot, struct innovation *innovation)
{
    float row[RHO_KALMAN_STATES], projected[RHO_KALMAN_STATES], rate_mps;
    int n = innovation->num;
    if (!rho_measurement_range_rate(at->state, gate->sensor, gate->has_z, row, &rate_mps)) {
        return 0;
    }
    float predicted = rho_linalg_project6(at->covariance, row, projected);
    for (int i = 0; i < n; i++) {
        innovation->s[RHO_AT(n, i)] = projected[i];
    }
    innovation->s[RHO_AT(n, n)] =
        predicted + plot->sigma_range_rate_mps * plot->sigma_range_rate_mps;
    innovation->d[n] = plot->range_rate_mps - rate_mps;
    innovation->num = n + 1;
    return 1;
}

/* Four dimensions: by the Cholesky factor. */
static int measure_four(struct innovation *innovation, struct rho_gate_result *result)
{
    if (rho_linalg_cholesky(4, innovation->s, innovation->s) != RHO_OK) {
        return 0;
    }
    rho_linalg_forward(4, innovation->s, innovation->d);
    result->distance2 = 0.0f;
    for (int i = 0; i < 4; i++) {
        result->distance2 += innovation->d[i] * innovation->d[i];
    }
    result->log_det = rho_linalg_log_determinant(4, innovation->s);
    return result->distance2 <= RHO_GATE_CHI2_4D;
}

static int is_inside(struct innovation *innovation, struct rho_gate_result *result)
{
    const float *s = innovation->s, *d = innovation->d;
    if (innovation->num == 4) {
        return measure_four(innovation, result);
    }
    if (innovation->num == 3) {
        return rho_linalg_gate3(s, d, &result->distance2, &result->log_det) == RHO_OK &&
               result->distance2 <= RHO_GATE_CHI2_3D;
    }
    return rho_linalg_gate2(s, d, &result->distance2, &result->log_det) == RHO_OK &&
           result->distance2 <= RHO_GATE_CHI2_2D;
}

static int test_closely(const struct rho_gate *gate, const struct rho_kalman *at,
                        const struct rho_plot *plot, uint32_t measures,
                        struct rho_gate_result *result)
{
    struct rho_measurement seen;
    struct innovation innovation;
    rho_measurement_open(plot, measures, gate->sensor, &seen);
    result->has_z = gate->has_z && seen.has_z;
    add_position(at, &seen, result->has_z ? 3 : 2, &innovation);
    result->has_range_rate =
        (measures & RHO_MEASURES_RANGE_RATE) != 0 && add_range_rate(gate, at, plot, &innovation);
    return is_inside(&innovation, result);
}

int rho_gate_test(const struct rho_gate *gate, const struct rho_plot *plot, uint32_t measures,
                  struct rho_gate_result *result)
{
    float sigma_m = rho_plot_sigma_m(plot);
    if ((measures & RHO_MEASURES_Z) && plot->sigma_up_m > sigma_m) {
        sigma_m = plot->sigma_up_m; /* a high line of sight brings it down */
    }
    float offset_s = (float)plot->offset_us * 1e-6f;
    if (is_far(gate, 0, plot->x_m, offset_s, sigma_m * sigma_m) ||
        is_far(gate, 1, plot->y_m, offset_s, sigma_m * sigma_m)) {
        return 0;
    }
    if (plot->offset_us == 0) {
        return test_closely(gate, &gate->predicted, plot, measures, result);
    }
    struct rho_kalman at = gate->predicted;
    return rho_kalman_predict(&at, offset_s, gate->noise_density) == RHO_OK &&
           test_closely(gate, &at, plot, measures, result);
}

static int test_bearing(const struct rho_kalman *at, const struct rho_bearing *bearing, float x_m,
                        float y_m, struct rho_gate_result *result)
{
    struct rho_kalman_bearing seen;
    float projected[RHO_KALMAN_STATES];
    if (!rho_kalman_see_bearing(at, x_m, y_m, bearing->bearing_rad, bearing->sigma_rad, &seen)) {
        return 0;
    }
    float variance_m2 = rho_linalg_project6(at->covariance, seen.row, projected) + seen.variance_m2;
    if (!(seen.off_m * seen.off_m <= RHO_GATE_CHI2_1D * variance_m2) || !(variance_m2 <= FLT_MAX)) {
        return 0;
    }
    *result =
        (struct rho_gate_result){.distance2 = seen.off_m * seen.off_m / variance_m2,
                                 .log_det = rho_log(variance_m2) - 2.0f * rho_log(seen.range_m)};
    return 1;
}

int rho_gate_test_bearing(const struct rho_gate *gate, const struct rho_bearing *bearing, float x_m,
                          float y_m, struct rho_gate_result *result)
{
    if (bearing->offset_us == 0) {
        return test_bearing(&gate->predicted, bearing, x_m, y_m, result);
    }
    struct rho_kalman at = gate->predicted;
    return rho_kalman_predict(&at, (float)bearing->offset_us * 1e-6f, gate->noise_density) ==
               RHO_OK &&
           test_bearing(&at, bearing, x_m, y_m, result);
}
