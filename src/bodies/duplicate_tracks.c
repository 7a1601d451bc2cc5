/* SPDX-License-Identifier: MIT */
/*
 * duplicate_tracks: ends one of two tracks of one extended target.
 *
 * Two targets cannot be at one place. Tracks whose bodies overlap are found by the plots that both
 * bodies explain about equally well; the younger track ends when the overlap lasts. And a long
 * target that comes into view at once may start two tracks, one of which ends while both are new.
 */
#include "../tracker/clutter.h"
#include "../tracker/sensors.h"
#include "../tracker/step.h"
#include "bodies.h"
#include "rhotrack/detail/approx.h"

/* Scans with overlapping bodies after which the younger track ends, and the memory of the count. */
#define DOUBLED_SCANS 30.0f
#define MEMORY_SCANS 80.0f
/*
 * Two tracks are new below NEW_HITS hits, and of one target where they are nearer to each other
 * than these shares of the longest body, along the heading and across it.
 */
#define NEW_HITS 20u
#define NEW_ALONG_SHARE 0.5f
#define NEW_ACROSS_SHARE 0.15f
/* Sigmas of the heading by which the line between two new tracks may be turned. */
#define TURNED_SIGMAS 2.0f
/* Largest difference of the velocities of two tracks of one target, in the sum of both sigmas. */
#define ALIKE_SIGMAS 4.0f
/* Units of work for a pair of tracks. */
#define PASS_UNITS 1u

/* Distance of another track, along and across the axes of a track's body; not negative. */
struct body_offset {
    float along_m, across_m;
};

static struct body_offset absolute_offset_of_track_on_body(const struct rho_tracker *tracker,
                                                           unsigned row, unsigned other)
{
    const struct rho_track *tracks = tracker->tracks;
    const struct rho_body_filter *body = &tracker->bodies.of[row];
    const float dx_m = tracks[other].kalman.state[RHO_X] - tracks[row].kalman.state[RHO_X],
                dy_m = tracks[other].kalman.state[RHO_Y] - tracks[row].kalman.state[RHO_Y];
    const float along_m = body->cos_heading * dx_m + body->sin_heading * dy_m,
                across_m = body->cos_heading * dy_m - body->sin_heading * dx_m;
    return (struct body_offset){along_m < 0.0f ? -along_m : along_m,
                                across_m < 0.0f ? -across_m : across_m};
}

/* True where two tracks may have one velocity; targets that pass each other have not. */
static int move_alike(const struct rho_track *one, const struct rho_track *other)
{
    const float vx_mps = one->kalman.state[RHO_VX] - other->kalman.state[RHO_VX],
                vy_mps = one->kalman.state[RHO_VY] - other->kalman.state[RHO_VY];
    const float most_mps = ALIKE_SIGMAS * (rho_track_sigma_mps(one) + rho_track_sigma_mps(other));
    return vx_mps * vx_mps + vy_mps * vy_mps <= most_mps * most_mps;
}

/* True where two bodies with known headings overlap by half on both axes. */
static int do_bodies_overlap(const struct rho_tracker *tracker, unsigned row, unsigned other)
{
    const struct rho_body_filter *one = &tracker->bodies.of[row], *two = &tracker->bodies.of[other];
    const struct body_offset offset = absolute_offset_of_track_on_body(tracker, row, other);
    /* a quarter of both lengths, each sqrt(12 variance): 0.866 = sqrt(12) / 4 */
    return one->has_heading && two->has_heading &&
           offset.along_m <= 0.866f * (rho_sqrt(one->along_m2) + rho_sqrt(two->along_m2)) &&
           offset.across_m <= 0.866f * (rho_sqrt(one->across_m2) + rho_sqrt(two->across_m2));
}

static int may_own_plots_and_has_few_hits(const struct rho_look *look, unsigned row)
{
    return rho_bodies_may_own(look, row) && look->tracker->tracks[row].hits < NEW_HITS;
}

/* True where two tracks are near in x and y: a cheap test before that in the body's axes. */
static int are_tracks_near(const struct rho_tracker *tracker, unsigned row, unsigned other)
{
    const float *one = tracker->tracks[row].kalman.state,
                *two = tracker->tracks[other].kalman.state;
    const float most_m = (NEW_ALONG_SHARE + NEW_ACROSS_SHARE) * tracker->bodies.length_max_m,
                dx_m = two[RHO_X] - one[RHO_X], dy_m = two[RHO_Y] - one[RHO_Y];
    return dx_m <= most_m && dx_m >= -most_m && dy_m <= most_m && dy_m >= -most_m;
}

static int may_be_one_body(const struct rho_tracker *tracker, unsigned row, unsigned other)
{
    const struct rho_bodies *bodies = &tracker->bodies;
    const struct rho_track *tracks = tracker->tracks;
    const struct body_offset offset = absolute_offset_of_track_on_body(tracker, row, other);
    const float turned_m = TURNED_SIGMAS * bodies->of[row].heading_sigma_rad * offset.along_m;
    return bodies->of[row].has_heading &&
           offset.along_m <= NEW_ALONG_SHARE * bodies->length_max_m &&
           offset.across_m + rho_track_sigma_m(&tracks[row]) + rho_track_sigma_m(&tracks[other]) <=
               NEW_ACROSS_SHARE * bodies->length_max_m + turned_m;
}

/* Ends a track, gives its plots to the track that stays, and clears contenders that this leaves. */
static void end_track_and_move_plots(struct step *step, unsigned stays, unsigned ends)
{
    struct rho_groups *groups = &step->tracker->bodies.groups;
    for (uint32_t i = 0; i < step->look.num_gated; i++) {
        if (groups->owner[i] == ends) {
            groups->owner[i] = (uint16_t)stays;
        }
        if (groups->contender[i] == ends || groups->contender[i] == groups->owner[i]) {
            groups->contender[i] = RHO_NO_ROW;
        }
    }
    rho_work_spend(&step->work, step->look.num_gated / RHO_WORK_PASSED_A_UNIT);
    rho_life_end(step, &step->tracker->tracks[ends]);
}

/* Counts scans in which bodies overlap; the younger track ends after DOUBLED_SCANS of these. */
static void count_overlaps_and_end_younger(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    const struct rho_groups *groups = &tracker->bodies.groups;
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        if (rho_bodies_may_own(&step->look, row)) {
            tracker->bodies.of[row].doubt.doubled *= 1.0f - 1.0f / MEMORY_SCANS;
        }
    }
    for (uint32_t i = 0; i < step->look.num_gated; i++) {
        const unsigned one = groups->owner[i], other = groups->contender[i];
        if (one == RHO_NO_ROW || other == RHO_NO_ROW) {
            continue;
        }
        const unsigned older = one < other ? one : other, younger = one + other - older;
        struct rho_body_doubt *doubt = &tracker->bodies.of[younger].doubt;
        if (doubt->doubled_us == step->look.time_us || !rho_bodies_may_own(&step->look, one) ||
            !rho_bodies_may_own(&step->look, other) ||
            !do_bodies_overlap(tracker, older, younger) ||
            !move_alike(&tracker->tracks[one], &tracker->tracks[other])) {
            continue;
        }
        doubt->doubled_us = step->look.time_us;
        doubt->doubled += 1.0f;
        if (doubt->doubled > DOUBLED_SCANS) {
            end_track_and_move_plots(step, older, younger);
        }
    }
}

/* Of two new tracks of one target ends the one with fewer hits, of equals the younger. */
static void end_one_of_each_two_new_duplicates(struct step *step)
{
    const struct rho_tracker *tracker = step->tracker;
    const struct rho_track *tracks = tracker->tracks;
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        int goes_on = may_own_plots_and_has_few_hits(&step->look, row);
        for (unsigned other = row + 1u;
             goes_on && other < tracker->num_tracks && !rho_work_is_spent(&step->work); other++) {
            rho_work_spend(&step->work, PASS_UNITS);
            if (are_tracks_near(step->tracker, row, other) &&
                may_own_plots_and_has_few_hits(&step->look, other) &&
                may_be_one_body(step->tracker, row, other) &&
                move_alike(&tracks[row], &tracks[other])) {
                goes_on = tracks[row].hits >= tracks[other].hits;
                end_track_and_move_plots(step, goes_on ? row : other, goes_on ? other : row);
            }
        }
    }
}

void rho_bodies_end_duplicates(struct step *step)
{
    if (step->look.teaches) {
        count_overlaps_and_end_younger(step);
    }
    end_one_of_each_two_new_duplicates(step);
}
