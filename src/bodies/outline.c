/* SPDX-License-Identifier: MIT */
/*
 * outline: where a look's plots of a body are expected.
 *
 * A place on the body is uniform along its heading and normal across it, the error of the
 * prediction and the plot's noise are normal. So with the offset u along and v across, and the
 * covariance N of error and noise, in which the body's width stands, a plot has the density
 *
 *     n(v; N_vv) (F((u - m + h) / s) - F((u - m - h) / s)) / 2 h,   m = N_uv / N_vv v,
 *
 * for a body of length 2 h and s^2 = N_uu - N_uv^2 / N_vv; F: the normal distribution. A body's
 * halves, each taken for a body, so explain its plots no better than the body does.
 */
#include "bodies.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/body_extent_filter.h"
#include "rhotrack/detail/measurement.h"

float rho_bodies_widest_m(float longest_m, float length_m)
{
    length_m = rho_larger(rho_smaller(length_m, longest_m), LENGTH_LEAST_SHARE * longest_m);
    return rho_larger(WIDEST_SHARE * length_m, rho_smaller(longest_m, ROUND_MOST_M));
}

float rho_bodies_width_most_m(const struct rho_tracker *tracker, unsigned row, float length_m)
{
    const struct rho_body_filter *body = &tracker->bodies.of[row];
    const float longest_m = tracker->bodies.length_max_m;
    const float turned_m = LOOSE_SIGMAS * body->heading_sigma_rad * length_m;
    return rho_smaller(rho_bodies_widest_m(longest_m, length_m) + turned_m, longest_m);
}

float rho_bodies_moved_m(const struct rho_look *look, const float velocity_mps[2])
{
    return look->offset_max_s *
           rho_sqrt(velocity_mps[0] * velocity_mps[0] + velocity_mps[1] * velocity_mps[1]);
}

struct body_outline rho_bodies_outline_track(const struct rho_look *look, unsigned row)
{
    const struct rho_track *track = &look->tracker->tracks[row];
    const struct rho_kalman *kalman = &track->kalman;
    const struct rho_body_filter *body = &look->tracker->bodies.of[row];
    const float *state = kalman->state,
                *p = kalman->covariance; /* of the place: xx, yx, yy first */
    struct body_outline outline = {
        .place_m = {state[RHO_X], state[RHO_Y]},
        .velocity_mps = {state[RHO_VX], state[RHO_VY], state[RHO_VZ]},
        .ahead_s = rho_seconds_between(track->time_us, look->time_us),
        .velocity_m2ps2 = {p[RHO_AT(RHO_VX, RHO_VX)], p[RHO_AT(RHO_VX, RHO_VY)],
                           p[RHO_AT(RHO_VY, RHO_VY)]},
        .cos_heading = body->cos_heading,
        .sin_heading = body->sin_heading,
        .along_m2 = body->along_m2,
        .across_m2 = body->across_m2,
        .plots = body->plots_a_look,
        .rates_m2ps2 = rho_bodies_limbs_m2ps2(body),
    };
    rho_body_rotate_covariance(body->cos_heading, body->sin_heading, p, outline.error_m2);
    return outline;
}

struct body_outline rho_bodies_join_outlines(const struct rho_look *look, unsigned row,
                                             unsigned other_row, const struct body_outline *of,
                                             const struct body_outline *of_other)
{
    const struct rho_tracker *tracker = look->tracker;
    const struct body_outline one = *of, other = *of_other;
    const float longest_m = tracker->bodies.length_max_m;
    const float left = other.plots / (one.plots + other.plots), share = 1.0f - left;
    const float dx_m = other.place_m[0] - one.place_m[0], dy_m = other.place_m[1] - one.place_m[1];
    const float along_m = one.cos_heading * dx_m + one.sin_heading * dy_m,
                across_m = one.cos_heading * dy_m - one.sin_heading * dx_m;
    struct body_outline joint = one;
    float extent_m2[3], turned_m2[3], error_m2[3];
    rho_body_place_covariance(&tracker->bodies.of[other_row], extent_m2);
    rho_body_rotate_covariance(one.cos_heading, one.sin_heading, extent_m2, turned_m2);
    rho_body_rotate_covariance(one.cos_heading, one.sin_heading,
                               tracker->tracks[other_row].kalman.covariance, error_m2);
    for (unsigned i = 0; i < 3; i++) {
        joint.error_m2[i] = share * one.error_m2[i] + left * error_m2[i];
        joint.velocity_mps[i] += left * (other.velocity_mps[i] - one.velocity_mps[i]);
        joint.velocity_m2ps2[i] = share * one.velocity_m2ps2[i] + left * other.velocity_m2ps2[i];
    }
    joint.place_m[0] += left * dx_m;
    joint.place_m[1] += left * dy_m;
    /* what the velocities differ along the line of sight is spread of the one body's range rates */
    const struct rho_sensor *sensor = look->sensor;
    const float *state = tracker->tracks[row].kalman.state;
    const float sight_m[3] = {
        joint.place_m[0] - (sensor ? sensor->x_m : 0.0f),
        joint.place_m[1] - (sensor ? sensor->y_m : 0.0f),
        look->scan->measures & RHO_MEASURES_Z ? state[2] - (sensor ? sensor->z_m : 0.0f) : 0.0f};
    float range_m2 = LINE_LEAST_M2, off_m2ps = 0.0f;
    for (unsigned i = 0; i < 3; i++) {
        range_m2 += sight_m[i] * sight_m[i];
        off_m2ps += sight_m[i] * (other.velocity_mps[i] - one.velocity_mps[i]);
    }
    joint.rates_m2ps2 = share * one.rates_m2ps2 + left * other.rates_m2ps2 +
                        share * left * off_m2ps * off_m2ps / range_m2;
    joint.along_m2 =
        rho_smaller(share * one.along_m2 + left * (turned_m2[0] + share * along_m * along_m),
                    longest_m * longest_m / 12.0f);
    const float widest_m = rho_bodies_width_most_m(tracker, row, rho_sqrt(12.0f * joint.along_m2));
    joint.across_m2 =
        rho_smaller(share * one.across_m2 + left * (turned_m2[2] + share * across_m * across_m),
                    widest_m * widest_m / 12.0f);
    joint.plots += other.plots;
    return joint;
}

void rho_bodies_see_plot(const struct rho_look *look, const struct body_outline *outline,
                         const struct rho_plot *plot, struct outline_fit *fit)
{
    const struct rho_sensor *sensor = look->sensor;
    const float after_s = outline->ahead_s + (float)plot->offset_us * 1e-6f;
    const float c = outline->cos_heading, s = outline->sin_heading;
    const float *velocity_mps = outline->velocity_mps;
    fit->dx_m = plot->x_m - outline->place_m[0] - after_s * velocity_mps[0];
    fit->dy_m = plot->y_m - outline->place_m[1] - after_s * velocity_mps[1];
    fit->along_m = c * fit->dx_m + s * fit->dy_m;
    fit->across_m = c * fit->dy_m - s * fit->dx_m;
    /* the noise of the place, without its height, in the axes of the body */
    const struct rho_sigma_factors factors = rho_measurement_sigma_factors(sensor);
    const float x_m = plot->x_m - (sensor ? sensor->x_m : 0.0f),
                y_m = plot->y_m - (sensor ? sensor->y_m : 0.0f);
    const float ground_m = rho_sqrt(x_m * x_m + y_m * y_m);
    const int is_far = ground_m >= RHO_RANGE_LEAST_M;
    float range_m = ground_m, per_m = is_far ? 1.0f / ground_m : 0.0f;
    float sigma_m = factors.range * plot->sigma_range_m,
          side_m = factors.cross * plot->sigma_cross_m;
    if (!is_far) {
        sigma_m = side_m = rho_plot_sigma_m(plot) * rho_larger(factors.range, factors.cross);
    }
    const float ahead = is_far ? per_m * (c * x_m + s * y_m) : 1.0f,
                aside = per_m * (c * y_m - s * x_m);
    const float range_m2 = sigma_m * sigma_m, side_m2 = side_m * side_m;
    fit->noise_m2[0] = range_m2 * ahead * ahead + side_m2 * aside * aside;
    fit->noise_m2[1] = (range_m2 - side_m2) * ahead * aside;
    fit->noise_m2[2] = range_m2 * aside * aside + side_m2 * ahead * ahead;
    /* the range rate, with its height */
    float climb_mps = 0.0f;
    if (look->scan->measures & RHO_MEASURES_Z) {
        const float z_m = plot->z_m - (sensor ? sensor->z_m : 0.0f);
        range_m = rho_sqrt(ground_m * ground_m + z_m * z_m);
        per_m = range_m >= RHO_RANGE_LEAST_M ? 1.0f / range_m : 0.0f;
        climb_mps = per_m * z_m * velocity_mps[2];
    }
    fit->has_rate =
        (look->scan->measures & RHO_MEASURES_RANGE_RATE) && range_m >= RHO_RANGE_LEAST_M;
    if (!fit->has_rate) {
        fit->sight_line[0] = fit->sight_line[1] = 0.0f;
        fit->rate_mps = fit->rate_m2ps2 = fit->line_turn_m2ps2 = 0.0f;
        return;
    }
    fit->sight_line[0] = per_m * x_m;
    fit->sight_line[1] = per_m * y_m;
    fit->rate_mps = rho_measurement_innovation_mps(
        sensor, plot->range_rate_mps,
        fit->sight_line[0] * velocity_mps[0] + fit->sight_line[1] * velocity_mps[1] + climb_mps);
    const float turned_mps =
        per_m * plot->sigma_cross_m *
        (fit->sight_line[0] * velocity_mps[1] - fit->sight_line[1] * velocity_mps[0]);
    fit->line_turn_m2ps2 = turned_mps * turned_mps;
    const float noise_m2ps2 = plot->sigma_range_rate_mps * plot->sigma_range_rate_mps;
    fit->rate_m2ps2 = noise_m2ps2 + fit->line_turn_m2ps2 +
                      rho_smaller(outline->rates_m2ps2, LIMBS_SIGMAS * LIMBS_SIGMAS * noise_m2ps2);
}

void rho_bodies_fit_plot(const struct rho_look *look, const struct body_outline *outline,
                         const struct rho_plot *plot, struct outline_fit *fit)
{
    rho_bodies_see_plot(look, outline, plot, fit);
    for (unsigned i = 0; i < 3; i++) {
        fit->noise_m2[i] += outline->error_m2[i];
    }
    fit->noise_m2[2] += outline->across_m2;
    const float *line = fit->sight_line, *p = outline->velocity_m2ps2;
    fit->track_m2ps2 =
        line[0] * line[0] * p[0] + 2.0f * line[0] * line[1] * p[1] + line[1] * line[1] * p[2];
}

float rho_bodies_rate_variance(const struct outline_fit *fit, float turn_radps)
{
    const float apart_m2 = fit->dx_m * fit->dx_m + fit->dy_m * fit->dy_m;
    return fit->track_m2ps2 + fit->rate_m2ps2 + turn_radps * turn_radps * apart_m2;
}

/* The normal distribution, within 0.01. */
static float normal_below(float sigmas)
{
    return 1.0f / (1.0f + rho_exp(-1.702f * sigmas));
}

float rho_bodies_density(const struct rho_look *look, const struct body_outline *outline,
                         const struct rho_plot *plot)
{
    struct outline_fit fit;
    rho_bodies_fit_plot(look, outline, plot, &fit);
    const float slope = fit.noise_m2[1] / fit.noise_m2[2];
    const float half_m = rho_sqrt(3.0f * outline->along_m2);
    const float along_m = fit.along_m - slope * fit.across_m;
    const float per_sigma =
        1.0f / rho_sqrt(rho_larger(fit.noise_m2[0] - slope * fit.noise_m2[1], LINE_LEAST_M2));
    const float along = (normal_below((along_m + half_m) * per_sigma) -
                         normal_below((along_m - half_m) * per_sigma)) /
                        half_m;
    float square = fit.across_m * fit.across_m / fit.noise_m2[2], size = fit.noise_m2[2];
    if (fit.has_rate) {
        const float variance = rho_bodies_rate_variance(&fit, TURN_USUAL_RADPS);
        square += fit.rate_mps * fit.rate_mps / variance;
        size *= variance;
    }
    return outline->plots * (along + FAR_SHARE / half_m) *
           rho_exp(-0.5f * rho_smaller(square, FAR_SQUARE)) / rho_sqrt(size);
}
