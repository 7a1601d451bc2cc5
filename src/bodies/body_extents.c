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
                         rho_bodies_prior_m2(tracker),
                         longest_m / rho_bodies_widest_m(longest_m, longest_m));
}

float rho_bodies_prior_m2(const struct rho_tracker *tracker)
{
    const float length_m = rho_larger(PRIOR_SHARE * tracker->bodies.length_max_m, PRIOR_LEAST_M);
    return length_m * length_m / 12.0f;
}

int rho_bodies_is_settled(const struct rho_tracker *tracker, unsigned row)
{
    return tracker->bodies.of[row].plots >= SETTLED_PLOTS;
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
        struct body_sums own = {0};
        if (track->plot < 0) {
            continue;
        }
        const float *p = track->kalman.covariance;
        const float velocity_m2ps2[3] = {p[RHO_AT(RHO_VX, RHO_VX)], p[RHO_AT(RHO_VX, RHO_VY)],
                                         p[RHO_AT(RHO_VY, RHO_VY)]};
        rho_body_set_heading_if_moving(&tracker->bodies.of[row], &track->kalman.state[RHO_VX],
                                       velocity_m2ps2);
        const struct rho_bodies *bodies = &tracker->bodies;
        const struct body_outline outline = rho_bodies_outline_track(look, row);
        struct rho_body_filter *body = &tracker->bodies.of[row];
        for (unsigned i = bodies->groups.first[track->plot]; i != RHO_NO_ROW;
             i = bodies->groups.next[i]) {
            struct outline_fit at;
            rho_bodies_see_plot(look, &outline, &scan->plots[i], &at);
            seen.num_plots++;
            seen.along_m2 += at.along_m * at.along_m;
            seen.across_m2 += at.across_m * at.across_m;
            seen.cross_m2 += at.along_m * at.across_m;
            seen.noise_along_m2 += at.noise_m2[0];
            seen.noise_across_m2 += at.noise_m2[2];
            if (bodies->groups.contender[i] == RHO_NO_ROW &&
                (at.has_rate || !(scan->measures & RHO_MEASURES_RANGE_RATE))) {
                rho_bodies_sum_plot(&own, &scan->plots[i], &at);
            }
        }
        body->plots_a_look += PLOTS_SHARE * ((float)seen.num_plots - body->plots_a_look);
        rho_body_add_plots(body, &seen);
        rho_bodies_add_doubt(tracker, look, &own, row);
    }
}

int rho_tracker_has_body(const struct rho_tracker *tracker, unsigned track)
{
    const struct rho_bodies *bodies = tracker ? &tracker->bodies : 0;
    return bodies && rho_tracker_is_ready(tracker) && track < tracker->num_tracks &&
           track < bodies->count && bodies->of[track].track_id == tracker->tracks[track].track_id &&
           bodies->of[track].most_plots >= 2;
}

int rho_tracker_body_of(const struct rho_tracker *tracker, unsigned track, struct rho_body *body)
{
    if (!body || !rho_tracker_has_body(tracker, track)) {
        return 0;
    }
    rho_body_shape(&tracker->bodies.of[track], body);
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
        const float counts[5] = {doubt->looks, doubt->long_looks, doubt->steady_looks,
                                 doubt->time_s, doubt->sums[BODY_PLOTS_BEYOND_ONE]};
        const float squares_m2[3] = {body->along_m2, body->across_m2, body->prior_m2};
        const float cosines[4] = {body->cos_heading, body->sin_heading, doubt->cos_heading,
                                  doubt->sin_heading};
        int is_sound = is_sound_side(&body->along) && is_sound_side(&body->across) &&
                       rho_is_within(body->aspect, 1.0f, 1e6f) &&
                       rho_is_within(body->plots_a_look, 0.5f, 1e6f) &&
                       rho_is_within(body->two_nat, -1e3f, 1e3f) &&
                       rho_is_within(body->slope, -1e12f, 1e12f) &&
                       rho_is_within(body->slope_weight, 1e-20f, 1e30f) &&
                       rho_is_within(body->heading_sigma_rad, 0.0f, 10.0f) &&
                       rho_is_within(body->plots, 1.0f, 1e6f) && rho_is_stored_time(doubt->time_us);
        is_sound &= rho_are_within(squares_m2, 3, least_m2, 1e12f) &
                    rho_are_within(counts, 5, 0.0f, 1e9f) &
                    rho_are_within(doubt->sums, RHO_BODY_SUMS, -1e30f, 1e30f) &
                    rho_are_within(cosines, 4, -1.001f, 1.001f);
        if (!is_sound) {
            return 0;
        }
    }
    return 1;
}
