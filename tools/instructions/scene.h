/* SPDX-License-Identifier: MIT */
/*
 * scene: eight targets that start on a ring about a radar and fly along its tangents, for the
 * programs in this folder; and plots of them, polar (15 m x 3 mrad, range rates) or Cartesian
 * (positions and velocities, isotropic noise). Clutter lies 1.3 to 2.2 standard deviations from the
 * target on each axis: in the gate, and seldom the nearest plot.
 */
#ifndef SCENE_H
#define SCENE_H

#include "random_draws.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/types.h"

#define TARGETS 8
#define INTERVAL_S 1.0f
#define SIGMA_RANGE_M 15.0f
#define SIGMA_RAD 0.003f
#define SIGMA_RATE_MPS 1.0f
#define SIGMA_M 10.0f
#define SIGMA_MPS 1.0f

static const struct rho_sensor sensor = {.sensor_id = 1, .pd = 0.95f, .range_max_m = 1e5f};
static int failed;

struct target {
    float x_m, y_m, vx_mps, vy_mps;
};

static struct target target_at(int target, float t_s)
{
    float bearing_rad = RHO_PI / 4.0f * ((float)target + 0.5f), range_m = 30000.0f;
    float vx_mps = -200.0f * rho_sin(bearing_rad), vy_mps = 200.0f * rho_cos(bearing_rad);
    return (struct target){range_m * rho_cos(bearing_rad) + vx_mps * t_s,
                           range_m * rho_sin(bearing_rad) + vy_mps * t_s, vx_mps, vy_mps};
}

/* Normal for the target's own plot; for clutter 1.3 to 2.2 sigma to either side. */
static float draw_normal_or_clutter_offset(int is_clutter, float sigma)
{
    float size = is_clutter ? draw_uniform(1.3f, 2.2f) : 0.0f;
    return is_clutter ? (draw_uniform(-1.0f, 1.0f) < 0.0f ? -size : size) * sigma
                      : draw_normal(sigma);
}

static struct rho_plot draw_polar_plot(const struct target *target, int is_clutter)
{
    float range_m = rho_sqrt(target->x_m * target->x_m + target->y_m * target->y_m);
    struct rho_polar_plot polar = {
        .range_m = range_m + draw_normal_or_clutter_offset(is_clutter, SIGMA_RANGE_M),
        .azimuth_rad = rho_angle_wrap(rho_atan2(target->y_m, target->x_m) +
                                      draw_normal_or_clutter_offset(is_clutter, SIGMA_RAD)),
        .range_rate_mps = (target->x_m * target->vx_mps + target->y_m * target->vy_mps) / range_m +
                          draw_normal_or_clutter_offset(is_clutter, SIGMA_RATE_MPS),
        .sigma_range_m = SIGMA_RANGE_M,
        .sigma_azimuth_rad = SIGMA_RAD,
        .sigma_range_rate_mps = SIGMA_RATE_MPS};
    struct rho_plot plot = {0};
    failed |= rho_measurement_from_polar(&polar, RHO_MEASURES_RANGE_RATE, &sensor, &plot) != RHO_OK;
    return plot;
}

static struct rho_plot draw_cartesian_plot(const struct target *target, int is_clutter)
{
    return (struct rho_plot){
        .x_m = target->x_m + draw_normal_or_clutter_offset(is_clutter, SIGMA_M),
        .y_m = target->y_m + draw_normal_or_clutter_offset(is_clutter, SIGMA_M),
        .z_m = 3000.0f + draw_normal_or_clutter_offset(is_clutter, SIGMA_M),
        .vx_mps = target->vx_mps + draw_normal_or_clutter_offset(is_clutter, SIGMA_MPS),
        .vy_mps = target->vy_mps + draw_normal_or_clutter_offset(is_clutter, SIGMA_MPS),
        .vz_mps = draw_normal_or_clutter_offset(is_clutter, SIGMA_MPS),
        .sigma_range_m = SIGMA_M,
        .sigma_cross_m = SIGMA_M,
        .sigma_up_m = SIGMA_M,
        .sigma_mps = SIGMA_MPS};
}

static struct rho_plot draw_plot(const struct target *target, int is_polar, int is_clutter)
{
    return is_polar ? draw_polar_plot(target, is_clutter) : draw_cartesian_plot(target, is_clutter);
}

static uint32_t measured_quantities_of(int is_polar)
{
    return is_polar ? RHO_MEASURES_RANGE_RATE : RHO_MEASURES_Z | RHO_MEASURES_VELOCITY;
}

#endif
