/* SPDX-License-Identifier: MIT */
#include "maintenance/plot_distance.h"

#include <math.h>

#include "rhotrack/detail/measurement.h"

#define DIMENSIONS_MAX 7

/*
 * Difference of measurement and prediction (off), its Jacobian by the state (rows), and the
 * measurement's noise covariance.
 */
struct innovation {
    int num;
    double off[DIMENSIONS_MAX];
    double rows[DIMENSIONS_MAX][RHO_KALMAN_STATES];
    double noise[DIMENSIONS_MAX][DIMENSIONS_MAX];
};

static void add_scalar_innovation(struct innovation *innovation, int element, double off,
                                  double variance)
{
    int i = innovation->num++;

    innovation->off[i] = off;
    innovation->rows[i][element] = 1.0;
    innovation->noise[i][i] = variance;
}

static void add_place_innovation(struct innovation *innovation, const struct rho_kalman *at,
                                 const struct rho_measurement *seen, int axes)
{
    float noise[RHO_TRIANGLE(3)];

    rho_measurement_covariance(seen, noise);
    for (int i = 0; i < axes; i++) {
        add_scalar_innovation(innovation, i, (double)seen->place_m[i] - (double)at->state[i], 0.0);
        for (int j = 0; j <= i; j++) {
            innovation->noise[i][j] = innovation->noise[j][i] = (double)noise[RHO_AT(i, j)];
        }
    }
}

static void add_velocity_innovation(struct innovation *innovation, const struct rho_kalman *at,
                                    const struct rho_plot *plot, int axes)
{
    const float velocity_mps[3] = {plot->vx_mps, plot->vy_mps, plot->vz_mps};

    for (int i = 0; i < axes; i++) {
        add_scalar_innovation(innovation, i + 3, (double)velocity_mps[i] - (double)at->state[i + 3],
                              (double)plot->sigma_mps * (double)plot->sigma_mps);
    }
}

static void add_range_rate_innovation(struct innovation *innovation, const struct rho_kalman *at,
                                      const struct rho_plot *plot, const struct rho_sensor *sensor,
                                      int axes)
{
    float row[RHO_KALMAN_STATES], rate_mps;
    int i = innovation->num;

    if (!rho_measurement_predict_range_rate(at->state, sensor, axes == 3, row, &rate_mps)) {
        return;
    }
    innovation->num++;
    innovation->off[i] =
        (double)rho_measurement_range_rate_innovation_mps(sensor, plot->range_rate_mps, rate_mps);
    innovation->noise[i][i] =
        (double)plot->sigma_range_rate_mps * (double)plot->sigma_range_rate_mps;
    for (int k = 0; k < RHO_KALMAN_STATES; k++) {
        innovation->rows[i][k] = (double)row[k];
    }
}

static double innovation_covariance(const struct innovation *innovation,
                                    const struct rho_kalman *at, int i, int j)
{
    double sum = innovation->noise[i][j];

    for (int k = 0; k < RHO_KALMAN_STATES; k++) {
        for (int l = 0; l < RHO_KALMAN_STATES; l++) {
            double p = (double)at->covariance[k >= l ? RHO_AT(k, l) : RHO_AT(l, k)];

            sum += innovation->rows[i][k] * p * innovation->rows[j][l];
        }
    }
    return sum;
}

/*
 * Squared Mahalanobis distance by a Cholesky factorisation with forward substitution; NAN where a
 * pivot is not positive.
 */
static double squared_mahalanobis_distance(const struct innovation *innovation,
                                           const struct rho_kalman *at)
{
    double factor[DIMENSIONS_MAX][DIMENSIONS_MAX] = {{0.0}};
    double white[DIMENSIONS_MAX] = {0.0}, sum = 0.0;

    for (int i = 0; i < innovation->num; i++) {
        double rest = innovation->off[i];

        for (int j = 0; j <= i; j++) {
            double c = innovation_covariance(innovation, at, i, j);

            for (int k = 0; k < j; k++) {
                c -= factor[i][k] * factor[j][k];
            }
            factor[i][j] = j < i ? c / factor[j][j] : sqrt(c);
            rest -= j < i ? factor[i][j] * white[j] : 0.0;
        }
        white[i] = rest / factor[i][i];
        sum += white[i] * white[i];
    }
    return isfinite(sum) ? sum : NAN;
}

double plot_squared_mahalanobis(const struct rho_kalman *predicted, const struct rho_plot *plot,
                                uint32_t measures, const struct rho_sensor *sensor, int *dimensions)
{
    struct innovation innovation = {.num = 0};
    struct rho_measurement seen;
    int axes;

    rho_measurement_from_plot(plot, measures, sensor, &seen);
    axes = seen.has_z && rho_kalman_has_estimate_on_axis(predicted, 2) ? 3 : 2;
    add_place_innovation(&innovation, predicted, &seen, axes);
    if (measures & RHO_MEASURES_VELOCITY) {
        add_velocity_innovation(&innovation, predicted, plot, axes);
    }
    if (measures & RHO_MEASURES_RANGE_RATE) {
        add_range_rate_innovation(&innovation, predicted, plot, sensor, axes);
    }
    if (dimensions) {
        *dimensions = innovation.num;
    }
    return squared_mahalanobis_distance(&innovation, predicted);
}
