/* SPDX-License-Identifier: MIT */
/*
 * resolution_cell: the distance at which a sensor no longer resolves two targets and gives one
 * plot; stated, or learned from pairs of near tracks that get one merged plot or two plots.
 *
 * Two targets d apart are not resolved with the probability (W. Koch, G. van Keuk, Multiple
 * Hypothesis Track Maintenance with Possibly Unresolved Measurements, IEEE Transactions on
 * Aerospace and Electronic Systems 33 (1997), 883-892)
 *
 *     p = e^-(d1^2 / 2 n1 + d2^2 / 2 n2)        n = cell^2 / 2 ln 2
 *
 * with d1 along the line of sight and d2 across it: at a distance of one cell p is a half. Where no
 * cell was stated, n = e^l (2 sigma)^2 with the plot's sigma on that axis, and l is 0 at first. A
 * pair with a merged plot has the likelihood p, a pair with two plots 1 - p. The derivatives of
 * their logarithms by l are
 *
 *     d^2 / 2 n        -p / (1 - p) d^2 / 2 n
 *
 * and the expectation of their squares is p / (1 - p) (d^2 / 2 n)^2, whose sum is the weight of the
 * estimate. l moves by the derivative over the weight (Fisher's scoring).
 */
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"
#include "sensors.h"

/* Variance n over the squared resolution cell: 1 / (2 ln 2). */
#define NEAR_OF_CELL 0.72134752f

static int is_cell_stated(const struct rho_sensor *sensor, int axis)
{
    return sensor &&
           (axis == 0 ? sensor->resolution_range_m : sensor->resolution_azimuth_rad) > 0.0f;
}

void rho_cell_variances_at(const struct rho_look *look, const struct rho_plot *plot,
                           const struct rho_measurement *seen, float near_m2[2])
{
    for (int axis = 0; axis < 2; axis++) {
        if (is_cell_stated(look->sensor, axis)) {
            const struct rho_sensor *sensor = look->sensor;
            const float x_m = plot->x_m - sensor->x_m, y_m = plot->y_m - sensor->y_m;
            const float cell_m =
                axis == 0 ? sensor->resolution_range_m
                          : sensor->resolution_azimuth_rad * rho_sqrt(x_m * x_m + y_m * y_m);
            near_m2[axis] = NEAR_OF_CELL * cell_m * cell_m;
        } else {
            near_m2[axis] = 4.0f * seen->variance_m2[axis] *
                            rho_exp(look->learned ? look->learned->log_cell[axis] : 0.0f);
        }
    }
}

float rho_cell_rate_variance(const struct rho_sensor *sensor)
{
    const float cell_mps = sensor ? sensor->resolution_range_rate_mps : 0.0f;
    return NEAR_OF_CELL * cell_mps * cell_mps;
}

int rho_cell_is_usable(const struct rho_sensor *sensor)
{
    return rho_is_within(sensor->resolution_range_m, 0.0f, RHO_LIMIT_POSITION_M) &&
           rho_is_within(sensor->resolution_azimuth_rad, 0.0f, 7.0f) &&
           rho_is_within(sensor->resolution_range_rate_mps, 0.0f, 2.0f * RHO_LIMIT_SPEED_MPS);
}

void rho_cell_learn(const struct rho_look *look, const struct apart *apart)
{
    struct rho_tracker_learned *learned = look->learned;
    float of_one[2], of_two[2], distance = 0.0f;
    if (!learned || !look->teaches || look->tracker->config.gate != RHO_TRACKER_BEST) {
        return;
    }
    for (int axis = 0; axis < 2; axis++) {
        of_one[axis] = 0.5f * apart->of_one_m2[axis] / apart->near_m2[axis];
        of_two[axis] = 0.5f * apart->of_two_m2[axis] / apart->near_m2[axis];
        distance += of_two[axis];
    }
    const float merged = rho_exp(-distance);
    const float odds = merged / rho_larger(1.0f - merged, 1e-3f); /* rounding may leave 0 */
    for (int axis = 0; axis < 2; axis++) {
        float *weight = &learned->cell_weight[axis], *nat = &learned->log_cell[axis];
        if (is_cell_stated(look->sensor, axis)) {
            continue;
        }
        const float slope =
            apart->is_one * of_one[axis] - (1.0f - apart->is_one) * odds * of_two[axis];
        *weight = rho_smaller(*weight + odds * of_two[axis] * of_two[axis], CELL_WEIGHT_MAX);
        *nat += slope / (CELL_WEIGHT_FIRST + *weight);
        *nat = rho_larger(-CELL_LOG_MAX, rho_smaller(CELL_LOG_MAX, *nat));
    }
}

float rho_cell_learned_sigmas(const struct rho_tracker_learned *learned, int axis)
{
    /* cell = sqrt(n / NEAR_OF_CELL) with n = e^l (2 sigma)^2 */
    return learned->cell_weight[axis] >= CELL_WEIGHT_FIRST
               ? 2.0f * rho_sqrt(rho_exp(learned->log_cell[axis]) / NEAR_OF_CELL)
               : 0.0f;
}

int rho_cell_is_sound(const struct rho_tracker_learned *learned)
{
    for (int axis = 0; axis < 2; axis++) {
        if (!rho_is_within(learned->log_cell[axis], -CELL_LOG_MAX, CELL_LOG_MAX) ||
            !rho_is_within(learned->cell_weight[axis], 0.0f, CELL_WEIGHT_MAX)) {
            return 0;
        }
    }
    return 1;
}
