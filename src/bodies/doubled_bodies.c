/* SPDX-License-Identifier: MIT */
/*
 * doubled_bodies: ends the younger of two tracks of one target.
 *
 * Two targets are not at one place. Plots that the bodies of two tracks explain equally well lead
 * to pairs of tracks whose bodies lie on each other: that lasts, or it was an error of a place. And
 * a body that comes into view as a whole may start two tracks at once.
 */
#include "../tracker/step.h"
#include "rhotrack/detail/approx.h"

/* A track has lain on an older one in so many scans when it ends, of those that are remembered. */
#define DOUBLED_SCANS 30.0f
#define MEMORY_SCANS 80.0f
/* New tracks, up to so many hits, are one target's so near each other, in shares of the longest
 * body. */
#define NEW_HITS 20u
#define NEW_ALONG_SHARE 0.5f
#define NEW_ACROSS_SHARE 0.15f
/* ... and beyond that by what so many sigmas of the heading turn the line between them. */
#define TURNED_SIGMAS 2.0f
/* Velocities differ by so many sigmas of both. */
#define ALIKE_SIGMAS 4.0f
#define PASS_UNITS 1u

/* Where another track is, in the axes of a track's body; without their sign. */
struct offset {
    float along_m, across_m;
};

static struct offset offset_of(const struct step *step, unsigned row, unsigned other)
{
    const struct rho_track *tracks = step->tracker->tracks;
    const struct rho_body_filter *body = &step->tracker->bodies.of[row];
    const float dx_m = tracks[other].kalman.state[RHO_X] - tracks[row].kalman.state[RHO_X],
                dy_m = tracks[other].kalman.state[RHO_Y] - tracks[row].kalman.state[RHO_Y];
    const float along_m = body->cos_heading * dx_m + body->sin_heading * dy_m,
                across_m = body->cos_heading * dy_m - body->sin_heading * dx_m;
    return (struct offset){along_m < 0.0f ? -along_m : along_m,
                           across_m < 0.0f ? -across_m : across_m};
}

/* Velocities that may be one target's: those that only pass each other have others. */
static int move_alike(const struct rho_track *one, const struct rho_track *other)
{
    const float vx_mps = one->kalman.state[RHO_VX] - other->kalman.state[RHO_VX],
                vy_mps = one->kalman.state[RHO_VY] - other->kalman.state[RHO_VY];
    const float most_mps = ALIKE_SIGMAS * (rho_track_sigma_mps(one) + rho_track_sigma_mps(other));
    return vx_mps * vx_mps + vy_mps * vy_mps <= most_mps * most_mps;
}

/* On both axes half of each body lies on the other one, where headings say which axes. */
static int lie_on_each_other(const struct step *step, unsigned row, unsigned other)
{
    const struct rho_body_filter *one = &step->tracker->bodies.of[row],
                                 *two = &step->tracker->bodies.of[other];
    const struct offset offset = offset_of(step, row, other);
    /* a quarter of both lengths, each root(12 v) */
    return one->has_heading && two->has_heading &&
           offset.along_m <= 0.866f * (rho_sqrt(one->along_m2) + rho_sqrt(two->along_m2)) &&
           offset.across_m <= 0.866f * (rho_sqrt(one->across_m2) + rho_sqrt(two->across_m2));
}

static int is_new(const struct step *step, unsigned row)
{
    return rho_tracker_may_own_plots(step, row) && step->tracker->tracks[row].hits < NEW_HITS;
}

/* Nearer to each other than new ones may be, on both axes of the map: tested first. */
static int are_near(const struct step *step, unsigned row, unsigned other)
{
    const float *one = step->tracker->tracks[row].kalman.state,
                *two = step->tracker->tracks[other].kalman.state;
    const float most_m = (NEW_ALONG_SHARE + NEW_ACROSS_SHARE) * step->tracker->bodies.length_max_m,
                dx_m = two[RHO_X] - one[RHO_X], dy_m = two[RHO_Y] - one[RHO_Y];
    return dx_m <= most_m && dx_m >= -most_m && dy_m <= most_m && dy_m >= -most_m;
}

static int may_be_one_body(const struct step *step, unsigned row, unsigned other)
{
    const struct rho_bodies *bodies = &step->tracker->bodies;
    const struct rho_track *tracks = step->tracker->tracks;
    const struct offset offset = offset_of(step, row, other);
    const float turned_m = TURNED_SIGMAS * bodies->of[row].heading_sigma_rad * offset.along_m;
    return bodies->of[row].has_heading &&
           offset.along_m <= NEW_ALONG_SHARE * bodies->length_max_m &&
           offset.across_m + rho_track_sigma_m(&tracks[row]) + rho_track_sigma_m(&tracks[other]) <=
               NEW_ACROSS_SHARE * bodies->length_max_m + turned_m;
}

/* Its plots are the other one's; nobody contends with one that ends, or with itself. */
static void end_one(struct step *step, unsigned stays, unsigned ends)
{
    struct rho_groups *groups = &step->tracker->bodies.groups;
    for (uint32_t i = 0; i < step->num_gated; i++) {
        if (groups->owner[i] == ends) {
            groups->owner[i] = (uint16_t)stays;
        }
        if (groups->contender[i] == ends || groups->contender[i] == groups->owner[i]) {
            groups->contender[i] = RHO_NO_ROW;
        }
    }
    rho_tracker_spend(step, step->num_gated / RHO_WORK_PASSED_A_UNIT);
    rho_tracker_end_track(step, &step->tracker->tracks[ends]);
}

static void end_those_on_others(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    const struct rho_groups *groups = &tracker->bodies.groups;
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        if (rho_tracker_may_own_plots(step, row)) {
            tracker->bodies.of[row].doubt.doubled *= 1.0f - 1.0f / MEMORY_SCANS;
        }
    }
    for (uint32_t i = 0; i < step->num_gated; i++) {
        const unsigned one = groups->owner[i], other = groups->contender[i];
        if (one == RHO_NO_ROW || other == RHO_NO_ROW) {
            continue;
        }
        const unsigned older = one < other ? one : other, younger = one + other - older;
        struct rho_body_doubt *doubt = &tracker->bodies.of[younger].doubt;
        if (doubt->doubled_us == step->time_us || !rho_tracker_may_own_plots(step, one) ||
            !rho_tracker_may_own_plots(step, other) || !lie_on_each_other(step, older, younger) ||
            !move_alike(&tracker->tracks[one], &tracker->tracks[other])) {
            continue;
        }
        doubt->doubled_us = step->time_us;
        doubt->doubled += 1.0f;
        if (doubt->doubled > DOUBLED_SCANS) {
            end_one(step, older, younger);
        }
    }
}

/* The one with fewer hits ends, of equals the younger. */
static void end_new_ones(struct step *step)
{
    const struct rho_tracker *tracker = step->tracker;
    const struct rho_track *tracks = tracker->tracks;
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        int goes_on = is_new(step, row);
        for (unsigned other = row + 1u;
             goes_on && other < tracker->num_tracks && !rho_tracker_is_spent(step); other++) {
            rho_tracker_spend(step, PASS_UNITS);
            if (are_near(step, row, other) && is_new(step, other) &&
                may_be_one_body(step, row, other) && move_alike(&tracks[row], &tracks[other])) {
                goes_on = tracks[row].hits >= tracks[other].hits;
                end_one(step, goes_on ? row : other, goes_on ? other : row);
            }
        }
    }
}

void rho_tracker_end_doubled(struct step *step)
{
    if (!step->is_late) {
        end_those_on_others(step);
    }
    end_new_ones(step);
}
