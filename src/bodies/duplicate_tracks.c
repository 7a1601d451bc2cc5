/* SPDX-License-Identifier: MIT */
/*
 * duplicate_tracks: ends one of two tracks of one extended target.
 *
 * Two targets cannot be at one place. Tracks whose bodies overlap are found by the plots that both
 * bodies explain about equally well; the younger track ends when the overlap lasts. And a long
 * target that comes into view at once may start two tracks, one of which ends while both are new.
 */
#include "bodies.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"

/* Distance of another track, along and across the axes of a track's body; not negative. */
struct body_offset {
    float along_m, across_m;
};

static struct body_offset offset_on_body(const struct rho_tracker *tracker, unsigned row,
                                         unsigned other)
{
    const struct rho_track *tracks = tracker->tracks;
    const struct rho_body_filter *body = &tracker->bodies.of[row];
    const float dx_m = tracks[other].kalman.state[RHO_X] - tracks[row].kalman.state[RHO_X],
                dy_m = tracks[other].kalman.state[RHO_Y] - tracks[row].kalman.state[RHO_Y];
    const float along_m = body->cos_heading * dx_m + body->sin_heading * dy_m,
                across_m = body->cos_heading * dy_m - body->sin_heading * dx_m;
    return (struct body_offset){rho_magnitude(along_m), rho_magnitude(across_m)};
}

/* True where two tracks may have one velocity; targets that pass each other have not. */
static int move_alike(const struct rho_track *one, const struct rho_track *other)
{
    const float vx_mps = one->kalman.state[RHO_VX] - other->kalman.state[RHO_VX],
                vy_mps = one->kalman.state[RHO_VY] - other->kalman.state[RHO_VY];
    const float most_mps =
        BODY_ERROR_SIGMAS * (rho_track_sigma_mps(one) + rho_track_sigma_mps(other));
    return vx_mps * vx_mps + vy_mps * vy_mps <= most_mps * most_mps;
}

/* True of a track with few hits for which plots may be grouped. */
static int is_new(const struct rho_look *look, unsigned row)
{
    return rho_bodies_may_own(look, row) && look->tracker->tracks[row].hits < NEW_HITS;
}

/* True where two tracks may be of one target, by their places on the body of the first. */
static int may_be_one_body(const struct rho_tracker *tracker, unsigned row, unsigned other)
{
    const struct rho_bodies *bodies = &tracker->bodies;
    const struct rho_track *one = &tracker->tracks[row], *two = &tracker->tracks[other];
    const float most_m = (NEW_ALONG_SHARE + NEW_ACROSS_SHARE) * bodies->length_max_m,
                dx_m = two->kalman.state[RHO_X] - one->kalman.state[RHO_X],
                dy_m = two->kalman.state[RHO_Y] - one->kalman.state[RHO_Y];
    if (!(dx_m <= most_m && dx_m >= -most_m && dy_m <= most_m && dy_m >= -most_m)) {
        return 0; /* most pairs: a cheap test before that in the body's axes */
    }
    const struct body_offset offset = offset_on_body(tracker, row, other);
    const float turned_m = LOOSE_SIGMAS * bodies->of[row].heading_sigma_rad * offset.along_m;
    return bodies->of[row].has_heading &&
           offset.along_m <= NEW_ALONG_SHARE * bodies->length_max_m &&
           offset.across_m + rho_track_sigma_m(one) + rho_track_sigma_m(two) <=
               NEW_ACROSS_SHARE * bodies->length_max_m + turned_m;
}

/* Ends a track, gives its plots to the track that stays, and clears contenders that this leaves. */
static void end_duplicate(struct step *step, unsigned stays, unsigned ends)
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

void rho_bodies_end_duplicates(struct step *step)
{
    const struct rho_look *look = &step->look;
    struct rho_tracker *tracker = step->tracker;
    const struct rho_track *tracks = tracker->tracks;
    const struct rho_groups *groups = &tracker->bodies.groups;
    for (unsigned row = 0; look->teaches && row < tracker->num_tracks; row++) {
        if (rho_bodies_may_own(look, row)) {
            tracker->bodies.of[row].doubt.doubled *= 1.0f - 1.0f / DOUBT_MEMORY;
        }
    }
    /* counts scans in which bodies overlap; the younger track ends when the overlap lasts */
    for (uint32_t i = 0; look->teaches && i < look->num_gated; i++) {
        const unsigned one = groups->owner[i], other = groups->contender[i];
        if (one == RHO_NO_ROW || other == RHO_NO_ROW) {
            continue;
        }
        const unsigned older = one < other ? one : other, younger = one + other - older;
        const struct rho_body_filter *a = &tracker->bodies.of[older];
        struct rho_body_filter *b = &tracker->bodies.of[younger];
        if (b->doubt.doubled_us == look->time_us || !rho_bodies_may_own(look, one) ||
            !rho_bodies_may_own(look, other) || !a->has_heading || !b->has_heading ||
            !move_alike(&tracks[one], &tracks[other])) {
            continue;
        }
        const struct body_offset offset = offset_on_body(tracker, older, younger);
        /* half of one on the other: a quarter of both lengths, each sqrt(12 variance) */
        const float quarter = 0.866f; /* sqrt(12) / 4 */
        if (!(offset.along_m <= quarter * (rho_sqrt(a->along_m2) + rho_sqrt(b->along_m2))) ||
            !(offset.across_m <= quarter * (rho_sqrt(a->across_m2) + rho_sqrt(b->across_m2)))) {
            continue;
        }
        b->doubt.doubled_us = look->time_us;
        b->doubt.doubled += 1.0f;
        if (b->doubt.doubled > SETTLED_LOOKS) {
            end_duplicate(step, older, younger);
        }
    }
    /* of two new tracks of one target ends the one with fewer hits, of equals the younger */
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        int goes_on = is_new(look, row);
        for (unsigned other = row + 1u;
             goes_on && other < tracker->num_tracks && !rho_work_is_spent(&step->work); other++) {
            rho_work_spend(&step->work, PASS_UNITS);
            if (is_new(look, other) && may_be_one_body(tracker, row, other) &&
                move_alike(&tracks[row], &tracks[other])) {
                goes_on = tracks[row].hits >= tracks[other].hits;
                end_duplicate(step, goes_on ? row : other, goes_on ? other : row);
            }
        }
    }
}
