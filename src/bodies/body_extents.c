/* SPDX-License-Identifier: MIT */
/* body_extents: estimates the extent of each track's body from the plots of its groups. */
#include "rhotrack/body.h"

#include "bodies.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/body_extent_filter.h"
#include "rhotrack/detail/measurement.h"

void rho_bodies_begin(struct rho_tracker *tracker, unsigned row)
{
    const float longest_m = tracker->bodies.length_max_m;
    rho_body_filter_init(&tracker->bodies.of[row], tracker->tracks[row].track_id,
                         rho_bodies_prior_m2(tracker), longest_m / rho_bodies_widest_m(longest_m));
}

float rho_bodies_prior_m2(const struct rho_tracker *tracker)
{
    const float length_m = rho_larger(PRIOR_SHARE * tracker->bodies.length_max_m, PRIOR_LEAST_M);
    return length_m * length_m / 12.0f;
}

float rho_bodies_widest_m(float longest_m)
{
    return rho_larger(WIDEST_SHARE * longest_m, rho_smaller(longest_m, ROUND_MOST_M));
}

enum rho_status rho_tracker_set_body_max(struct rho_tracker *tracker, float length_max_m)
{
    const enum rho_status status = rho_tracker_check(tracker, 1);
    if (status != RHO_OK || !rho_is_within(length_max_m, 0.0f, RHO_LIMIT_BODY_M)) {
        return status != RHO_OK ? status : RHO_ERROR_VALUE;
    }
    if (!RHO_BODIES && length_max_m > 0.0f) {
        return RHO_ERROR_CAPACITY;
    }
    tracker->bodies.length_max_m = length_max_m;
    return RHO_OK;
}

/* Moves bodies to the rows of their tracks, drops those of ended tracks, and starts new ones. */
void rho_bodies_align(struct rho_tracker *tracker)
{
    struct rho_bodies *bodies = &tracker->bodies;
    unsigned from = 0;
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        const struct rho_track *track = &tracker->tracks[row];
        while (from < bodies->count && bodies->of[from].track_id != track->track_id) {
            from++;
        }
        if (from < bodies->count) {
            bodies->of[row] = bodies->of[from++];
        } else {
            rho_bodies_begin(tracker, row);
        }
    }
    bodies->count = tracker->num_tracks;
}

int rho_bodies_rate_residual(const struct rho_look *look, const struct rho_scan *scan,
                             const float velocity_mps[3], const struct rho_plot *plot,
                             struct range_rate_residual *rate)
{
    float row[6], rate_mps;
    const float state[6] = {plot->x_m,       plot->y_m,       plot->z_m,
                            velocity_mps[0], velocity_mps[1], velocity_mps[2]};
    if (!(scan->measures & RHO_MEASURES_RANGE_RATE) ||
        !rho_measurement_predict_rate(state, look->sensor, (scan->measures & RHO_MEASURES_Z) != 0,
                                      row, &rate_mps)) {
        return 0;
    }
    rate->sight_line[0] = row[3];
    rate->sight_line[1] = row[4];
    rate->mps = rho_measurement_innovation_mps(look->sensor, plot->range_rate_mps, rate_mps);
    const float turned_mps = (row[3] * row[1] - row[4] * row[0]) * plot->sigma_cross_m;
    rate->line_turn_m2ps2 = turned_mps * turned_mps;
    rate->variance_m2ps2 =
        plot->sigma_range_rate_mps * plot->sigma_range_rate_mps + rate->line_turn_m2ps2;
    return 1;
}

int rho_bodies_locate_plot(const struct rho_look *look, const struct rho_scan *scan, unsigned row,
                           unsigned plot, struct body_plot *at)
{
    const struct rho_body_filter *body = &look->tracker->bodies.of[row];
    const struct rho_track *track = &look->tracker->tracks[row];
    const struct rho_plot *seen = &scan->plots[plot];
    const float after_s = rho_seconds_between(track->time_us, look->time_us + seen->offset_us);
    const float *state = track->kalman.state;
    *at = (struct body_plot){.dx_m = seen->x_m - state[RHO_X] - after_s * state[RHO_VX],
                             .dy_m = seen->y_m - state[RHO_Y] - after_s * state[RHO_VY]};
    at->along_m = body->cos_heading * at->dx_m + body->sin_heading * at->dy_m;
    at->across_m = body->cos_heading * at->dy_m - body->sin_heading * at->dx_m;
    return rho_bodies_rate_residual(look, scan, &state[RHO_VX], seen, &at->rate);
}

void rho_bodies_noise_axes(const struct rho_look *look, float cos_heading, float sin_heading,
                           const struct rho_plot *plot, float axes[3])
{
    struct rho_measurement seen;
    float noise[6];
    rho_measurement_from_plot(plot, 0, look->sensor, &seen);
    rho_measurement_covariance(&seen, noise);
    rho_body_rotate_covariance(cos_heading, sin_heading, noise, axes);
}

void rho_bodies_set_heading(struct rho_tracker *tracker, unsigned row)
{
    const struct rho_kalman *kalman = &tracker->tracks[row].kalman;
    const float *p = kalman->covariance;
    const float velocity[3] = {p[RHO_AT(RHO_VX, RHO_VX)], p[RHO_AT(RHO_VX, RHO_VY)],
                               p[RHO_AT(RHO_VY, RHO_VY)]};
    rho_body_set_heading_if_moving(&tracker->bodies.of[row], &kalman->state[RHO_VX], velocity);
}

void rho_bodies_update(struct rho_tracker *tracker, const struct rho_look *look,
                       const struct rho_scan *scan)
{
    rho_bodies_align(tracker);
    if (!look->teaches) {
        return; /* tracks have returned to the newest time, with another heading than at the scan */
    }
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        const struct rho_track *track = &tracker->tracks[row];
        struct rho_body_look seen = {0};
        if (track->plot < 0) {
            continue;
        }
        rho_bodies_set_heading(tracker, row);
        const struct rho_bodies *bodies = &tracker->bodies;
        struct rho_body_filter *body = &tracker->bodies.of[row];
        for (unsigned i = bodies->groups.first[track->plot]; i != RHO_NO_ROW;
             i = bodies->groups.next[i]) {
            struct body_plot at;
            float axes[3];
            (void)!rho_bodies_locate_plot(look, scan, row, i, &at);
            rho_bodies_noise_axes(look, body->cos_heading, body->sin_heading, &scan->plots[i],
                                  axes);
            seen.num_plots++;
            seen.along_m2 += at.along_m * at.along_m;
            seen.across_m2 += at.across_m * at.across_m;
            seen.cross_m2 += at.along_m * at.across_m;
            seen.noise_along_m2 += axes[0];
            seen.noise_across_m2 += axes[2];
        }
        body->plots_a_look += PLOTS_SHARE * ((float)seen.num_plots - body->plots_a_look);
        rho_body_add_plots(body, &seen);
    }
}

int rho_tracker_body_of(const struct rho_tracker *tracker, unsigned track, struct rho_body *body)
{
    const struct rho_bodies *bodies = tracker ? &tracker->bodies : 0;
    if (!bodies || !body || !rho_tracker_is_ready(tracker) || track >= tracker->num_tracks ||
        track >= bodies->count || bodies->of[track].track_id != tracker->tracks[track].track_id ||
        bodies->of[track].most_plots < 2) {
        return 0;
    }
    rho_body_shape(&bodies->of[track], body);
    return 1;
}

static int is_sound_side(const struct rho_body_side *side)
{
    return rho_is_within(side->mean_m2, -1e12f, 1e12f) &&
           rho_is_within(side->weight, 1e-3f, 1e6f) &&
           rho_is_within(side->variance_m4, 0.0f, 1e30f) &&
           rho_is_within(side->prior_share, 0.0f, 1.0f);
}

int rho_bodies_are_sound(const struct rho_tracker *tracker)
{
    const struct rho_bodies *bodies = &tracker->bodies;
    if (bodies->count > RHO_MAX_TRACKS || bodies->groups.count > RHO_MAX_PLOTS ||
        !rho_is_within(bodies->length_max_m, 0.0f, RHO_LIMIT_BODY_M)) {
        return 0;
    }
    const float least_m2 = 1e-7f; /* far below the least prior */
    for (unsigned i = 0; i < bodies->count; i++) {
        const struct rho_body_filter *body = &bodies->of[i];
        const struct rho_body_doubt *doubt = &body->doubt;
        const float counts[] = {doubt->looks, doubt->long_looks, doubt->steady_looks, doubt->time_s,
                                doubt->plots_beyond_one};
        const float squares[] = {
            doubt->far_m2,        doubt->side_m2,          doubt->cross_m2,
            doubt->rates_m2ps2,   doubt->far_m2ps,         doubt->side_m2ps,
            doubt->side_noise_m2, doubt->rate_noise_m2ps2, doubt->unknown_m2ps2};
        const float cosines[] = {body->cos_heading, body->sin_heading, doubt->cos_heading,
                                 doubt->sin_heading};
        int is_sound = rho_is_within(body->along_m2, least_m2, 1e12f) &&
                       rho_is_within(body->across_m2, least_m2, 1e12f) &&
                       rho_is_within(body->prior_m2, least_m2, 1e12f) &&
                       is_sound_side(&body->along) && rho_is_within(body->aspect, 1.0f, 1e6f) &&
                       rho_is_within(body->plots_a_look, 0.5f, 1e6f) &&
                       rho_is_within(body->two_nat, -1e3f, 1e3f) && is_sound_side(&body->across) &&
                       rho_is_within(body->slope, -1e12f, 1e12f) &&
                       rho_is_within(body->slope_weight, 1e-20f, 1e30f) &&
                       rho_is_within(body->heading_sigma_rad, 0.0f, 10.0f) &&
                       rho_is_within(body->plots, 1.0f, 1e6f) && rho_is_stored_time(doubt->time_us);
        for (unsigned k = 0; k < sizeof counts / sizeof *counts; k++) {
            is_sound &= rho_is_within(counts[k], 0.0f, 1e9f);
        }
        for (unsigned k = 0; k < sizeof squares / sizeof *squares; k++) {
            is_sound &= rho_is_within(squares[k], -1e30f, 1e30f);
        }
        for (unsigned k = 0; k < sizeof cosines / sizeof *cosines; k++) {
            is_sound &= rho_is_within(cosines[k], -1.001f, 1.001f);
        }
        if (!is_sound) {
            return 0;
        }
    }
    return 1;
}
