/* SPDX-License-Identifier: MIT */
#include "double_filter.h"

#include <math.h>
#include <string.h>

#define PI 3.141592653589793

static void multiply(double a[4][4], double b[4][4], double out[4][4])
{
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            out[i][j] = 0.0;
            for (int k = 0; k < 4; k++) {
                out[i][j] += a[i][k] * b[k][j];
            }
        }
    }
}

void double_filter_predict(struct double_filter *filter, double t_s, double noise_density)
{
    double dt_s = t_s - filter->t_s, half[4][4], back[4][4] = {{0.0}};
    double move[4][4] = {{1, 0, dt_s, 0}, {0, 1, 0, dt_s}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            back[i][j] = move[j][i];
        }
    }
    multiply(move, filter->covariance, half);
    multiply(half, back, filter->covariance);
    double q = noise_density * fmax(dt_s, 0.0);
    for (int axis = 0; axis < 2; axis++) {
        filter->state[axis] += dt_s * filter->state[axis + 2];
        filter->covariance[axis][axis] += q * dt_s * dt_s / 3.0;
        filter->covariance[axis][axis + 2] += q * dt_s / 2.0;
        filter->covariance[axis + 2][axis] += q * dt_s / 2.0;
        filter->covariance[axis + 2][axis + 2] += q;
    }
    filter->t_s = t_s;
}

/* What the radar would measure: range, azimuth, range rate; and its derivative by the state. */
static void look(const double state[4], double seen[3], double rows[3][4])
{
    double range_m = hypot(state[0], state[1]);
    double ux = state[0] / range_m, uy = state[1] / range_m;
    double rate_mps = ux * state[2] + uy * state[3];
    seen[0] = range_m;
    seen[1] = atan2(state[1], state[0]);
    seen[2] = rate_mps;
    memset(rows, 0, 3 * sizeof rows[0]);
    rows[0][0] = ux;
    rows[0][1] = uy;
    rows[1][0] = -uy / range_m;
    rows[1][1] = ux / range_m;
    rows[2][0] = (state[2] - rate_mps * ux) / range_m;
    rows[2][1] = (state[3] - rate_mps * uy) / range_m;
    rows[2][2] = ux;
    rows[2][3] = uy;
}

/* One scalar of independent noise: gain, state, covariance. */
static void update(struct double_filter *filter, const double row[4], double innovation,
                   double variance)
{
    double spread[4] = {0.0}, total = variance;
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            spread[i] += filter->covariance[i][j] * row[j];
        }
    }
    for (int i = 0; i < 4; i++) {
        total += row[i] * spread[i];
    }
    for (int i = 0; i < 4; i++) {
        filter->state[i] += spread[i] / total * innovation;
        for (int j = 0; j < 4; j++) {
            filter->covariance[i][j] -= spread[i] * spread[j] / total;
        }
    }
}

static void update_one(struct double_filter *filter, int which, double measured, double sigma)
{
    double seen[3], rows[3][4];
    look(filter->state, seen, rows);
    double innovation = measured - seen[which];
    update(filter, rows[which], which == 1 ? remainder(innovation, 2.0 * PI) : innovation,
           sigma * sigma);
}

static void update_range_rate(struct double_filter *filter, const struct scenario_radar *radar,
                              const struct simulated_plot *plot)
{
    if (radar->has_range_rate) {
        update_one(filter, 2, plot->range_rate_mps, radar->sigma_range_rate_mps);
    }
}

void double_filter_update(struct double_filter *filter, const struct scenario_radar *radar,
                          const struct simulated_plot *plot)
{
    update_one(filter, 0, plot->range_m, radar->sigma_range_m);
    update_one(filter, 1, plot->azimuth_rad, radar->sigma_azimuth_rad);
    update_range_rate(filter, radar, plot);
}

struct double_filter double_filter_open(const struct scenario_radar *radar, double t_s,
                                        const struct simulated_plot *plot, double speed_sigma_mps)
{
    double ca = cos(plot->azimuth_rad), sa = sin(plot->azimuth_rad);
    double along_m2 = radar->sigma_range_m * radar->sigma_range_m;
    double across_m2 = pow(plot->range_m * radar->sigma_azimuth_rad, 2.0);
    struct double_filter filter = {.t_s = t_s,
                                   .state = {plot->range_m * ca, plot->range_m * sa, 0.0, 0.0}};
    filter.covariance[0][0] = ca * ca * along_m2 + sa * sa * across_m2;
    filter.covariance[1][1] = sa * sa * along_m2 + ca * ca * across_m2;
    filter.covariance[0][1] = filter.covariance[1][0] = ca * sa * (along_m2 - across_m2);
    filter.covariance[2][2] = filter.covariance[3][3] = speed_sigma_mps * speed_sigma_mps;
    update_range_rate(&filter, radar, plot);
    return filter;
}

void double_filter_update_bearing(struct double_filter *filter, double x_m, double y_m,
                                  double bearing_rad, double sigma_rad)
{
    double dx_m = filter->state[0] - x_m, dy_m = filter->state[1] - y_m;
    double range2_m2 = dx_m * dx_m + dy_m * dy_m;
    const double row[4] = {-dy_m / range2_m2, dx_m / range2_m2, 0.0, 0.0};
    update(filter, row, remainder(bearing_rad - atan2(dy_m, dx_m), 2.0 * PI),
           sigma_rad * sigma_rad);
}
