/* SPDX-License-Identifier: MIT */
/*
 * split_bodies: splits the track of a body that is two targets: its width surely exceeds that of
 * any target so long, or body_split_evidence.c finds in its length or range rates that it is two.
 *
 * Cars abreast of each other are one group of plots from afar, and have one track. Nearer to the
 * sensor their body is seen to be as wide as two lanes; where one car is faster, range rates show
 * it earlier. In the first look whose plots are far enough apart the track continues with the plots
 * on one side, and a new track starts with the plots on the other: each at the mean of its plots,
 * and at the old velocity corrected by the mean residual of its range rates.
 */
#include "phases.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/body_extent_filter.h"

struct body_side {
    unsigned plots;
    /* mean of the plots, less the track's: place x, y in m, range rate as a velocity x, y in m/s */
    float off[4];
};

/*
 * Means of the track's own plots on either side of their middle; most_m: the length or width that
 * is exceeded. 0: too near to show two targets.
 */
static int divide_plots(const struct rho_look *look, const struct rho_scan *scan, unsigned row,
                        enum rho_body_split why, float most_m, struct body_side sides[2])
{
    const struct rho_groups *groups = &look->tracker->bodies.groups;
    const unsigned group = groups->first[look->tracker->tracks[row].plot];
    float least = 1e30f, most = -1e30f, rate_m2ps2 = 0.0f;
    const struct body_outline outline = rho_bodies_outline_track(look, row);
    struct outline_fit at;
    const float *value = why == RHO_BODY_TOO_LONG   ? &at.along_m /* tells the sides apart */
                         : why == RHO_BODY_TOO_WIDE ? &at.across_m
                                                    : &at.rate_mps;
    for (unsigned i = rho_bodies_next_own_plot(groups, group); i != RHO_NO_ROW;
         i = rho_bodies_next_own_plot(groups, groups->next[i])) {
        rho_bodies_see_plot(look, &outline, &scan->plots[i], &at);
        least = rho_smaller(least, *value);
        most = rho_larger(most, *value);
        const float sigma_mps = scan->plots[i].sigma_range_rate_mps;
        rate_m2ps2 = rho_larger(rate_m2ps2, sigma_mps * sigma_mps + at.line_turn_m2ps2);
    }
    const float middle = 0.5f * (least + most);
    const float parted =
        why == RHO_BODY_MOVES_APART ? PARTED_SIGMAS * rho_sqrt(rate_m2ps2) : PARTED_SHARE * most_m;
    if (!(most - least > parted)) {
        return 0;
    }
    for (unsigned i = rho_bodies_next_own_plot(groups, group); i != RHO_NO_ROW;
         i = rho_bodies_next_own_plot(groups, groups->next[i])) {
        rho_bodies_see_plot(look, &outline, &scan->plots[i], &at);
        struct body_side *side = &sides[*value < middle];
        side->plots++;
        const float off[4] = {at.dx_m, at.dy_m, at.sight_line[0] * at.rate_mps,
                              at.sight_line[1] * at.rate_mps};
        for (unsigned k = 0; k < 4; k++) {
            side->off[k] += (off[k] - side->off[k]) / (float)side->plots;
        }
    }
    return sides[0].plots > 0 && sides[1].plots > 0;
}

/* Starts a track at the mean position and velocity of one side's plots. */
static enum rho_status start_from_side(const struct rho_look *look, const struct rho_track *track,
                                       uint32_t track_id, const struct body_side *side,
                                       struct rho_track *out)
{
    const float mean_m2 = rho_bodies_prior_m2(look->tracker) / (float)side->plots;
    struct rho_kalman there = track->kalman;
    for (unsigned k = 0; k < 4; k++) {
        const unsigned of = k < 2 ? RHO_X + k : RHO_VX + k - 2u;
        there.state[of] += side->off[k];
        there.covariance[RHO_AT(of, of)] += k < 2 ? mean_m2 : side->off[k] * side->off[k];
    }
    return rho_track_start_estimate(out, track_id, &there, track->time_us, track->sensor_id,
                                    track->hits, &look->model, track->score_mnat);
}

/* Begins the body of one side, headed as the whole was: of one that stands, no velocity tells. */
static void restart_body_filter(struct rho_tracker *tracker, unsigned row,
                                const struct rho_body_filter *whole)
{
    struct rho_body_filter *body = &tracker->bodies.of[row];
    rho_bodies_begin(tracker, row);
    if (whole->has_heading) {
        rho_body_set_heading(body, whole->cos_heading, whole->sin_heading,
                             whole->heading_sigma_rad);
    }
    body->two_nat = SPLIT_NAT;
}

/* Splits a track into its own, at side 0, and a new one, at side 1. 0: there is no room for it. */
static int split_track(struct step *step, unsigned row, const struct body_side sides[2])
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_track *track = &tracker->tracks[row];
    struct rho_track stays, leaves;
    if (tracker->num_tracks == RHO_MAX_TRACKS ||
        start_from_side(&step->look, track, track->track_id, &sides[0], &stays) != RHO_OK) {
        return 0;
    }
    const struct rho_track was = *track;
    rho_track_free_hypotheses(track, &step->look.model);
    *track = was;
    track->slot = stays.slot;
    track->kalman = stays.kalman;
    track->input = stays.input;
    if (start_from_side(&step->look, &was, tracker->next_track_id, &sides[1], &leaves) == RHO_OK) {
        /* the new track is not established: it may still be an image in a wall (reflectors.h) */
        if (leaves.hits >= RHO_ESTABLISHED_HITS) {
            leaves.hits = RHO_ESTABLISHED_HITS - 1;
        }
        leaves.status = was.status;
        leaves.was_confirmed = was.was_confirmed;
        if (leaves.score_mnat < tracker->confirm_mnat) { /* it lives on as a start would */
            leaves.score_mnat = tracker->confirm_mnat;
        }
        (void)!rho_step_admit(step, &leaves, tracker->confirm_mnat);
    }
    return 1;
}

void rho_step_split_bodies(struct step *step, const struct rho_scan *scan)
{
    struct rho_tracker *tracker = step->tracker;
    const float least_m = rho_bodies_widest_m(tracker->bodies.length_max_m, 0.0f);
    for (unsigned row = 0; step->look.teaches && row < tracker->bodies.count; row++) {
        const struct rho_body_filter *body = &tracker->bodies.of[row];
        const unsigned num_tracks = tracker->num_tracks;
        struct body_side sides[2] = {{0}, {0}};
        struct rho_body shape;
        float most_m = tracker->bodies.length_max_m;
        if (tracker->tracks[row].plot < 0) {
            continue;
        }
        enum rho_body_split why = rho_bodies_split_reason(tracker, row);
        if (rho_bodies_is_settled(tracker, row) && 12.0f * body->across_m2 > least_m * least_m) {
            rho_body_shape(body, &shape);
            const float widest_m = rho_bodies_width_most_m(
                tracker, row, shape.length_m + SURE_SIGMAS * shape.sigma_length_m);
            if (shape.width_m - SURE_SIGMAS * shape.sigma_width_m > widest_m) {
                why = RHO_BODY_TOO_WIDE;
                most_m = widest_m;
            }
        }
        if (why != RHO_BODY_ONE && divide_plots(&step->look, scan, row, why, most_m, sides) &&
            split_track(step, row, sides)) {
            const struct rho_body_filter whole = *body;
            restart_body_filter(tracker, row, &whole);
            if (tracker->num_tracks > num_tracks) {
                rho_bodies_align(tracker);
                restart_body_filter(tracker, num_tracks, &whole);
            }
        }
    }
}
