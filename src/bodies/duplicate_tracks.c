/* SPDX-License-Identifier: MIT */
/*
 * duplicate_tracks: are two tracks of one target or of two? One track is left where it is one.
 *
 * The plots of a track and of the older track beside it are explained twice: by their two bodies,
 * and by one body in place of them, no larger than the longest. The ratio of the likelihoods is
 * evidence, summed over the looks; a new track begins without any, and tracks apart from all others
 * gain some in each look, so that two targets that come from afar stay two when they meet.
 *
 * Where an older track does not see its target any more since a younger one began, the younger
 * alone may explain the plots, too: the target has turned. The track that sees it is left, with the
 * number of the older.
 */
#include "bodies.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"

static int is_older(const struct rho_tracker *tracker, unsigned row, unsigned other)
{
    const unsigned hits = tracker->tracks[row].hits, others = tracker->tracks[other].hits;
    return hits > others || (hits == others && row < other);
}

/* The most, on an axis, by which a turn changes the velocity of a target. */
static float turn_most_mps(const struct rho_tracker *tracker)
{
    return BODY_GATE_SIGMAS * rho_bodies_turn_mps(tracker);
}

/*
 * True where a younger track may see what an older one has lost: both were never seen at once, and
 * a turn explains their velocities.
 */
static int may_replace(const struct rho_tracker *tracker, unsigned older, unsigned younger)
{
    const struct rho_track *from = &tracker->tracks[older], *to = &tracker->tracks[younger];
    const float dvx_mps = to->kalman.state[RHO_VX] - from->kalman.state[RHO_VX],
                dvy_mps = to->kalman.state[RHO_VY] - from->kalman.state[RHO_VY];
    const float most_mps = turn_most_mps(tracker);
    return from->misses_in_row > 0 && to->hits <= from->misses_in_row + 1u &&
           dvx_mps * dvx_mps + dvy_mps * dvy_mps <= most_mps * most_mps;
}

/* Distance of a younger track; less than it is from one that may have turned since it was seen. */
static float distance_m(const struct rho_look *look, unsigned older, unsigned younger)
{
    const struct rho_tracker *tracker = look->tracker;
    const struct rho_track *from = &tracker->tracks[older], *to = &tracker->tracks[younger];
    const float dx_m = to->kalman.state[RHO_X] - from->kalman.state[RHO_X],
                dy_m = to->kalman.state[RHO_Y] - from->kalman.state[RHO_Y];
    const float apart_m = rho_sqrt(dx_m * dx_m + dy_m * dy_m);
    return may_replace(tracker, older, younger)
               ? apart_m -
                     turn_most_mps(tracker) * rho_seconds_between(from->updated_us, look->time_us)
               : apart_m;
}

/* Takes an older track as the nearest one, where it is. */
static void compare_older(const struct rho_look *look, unsigned row, unsigned older,
                          unsigned *nearest, float *least_m)
{
    if (older != row && older != *nearest && is_older(look->tracker, older, row) &&
        rho_bodies_may_own(look, older)) {
        const float apart_m = distance_m(look, older, row);
        if (apart_m < *least_m) {
            *least_m = apart_m;
            *nearest = older;
        }
    }
}

/*
 * Row of the nearest older track whose body may be that of a track; or RHO_NO_ROW. It is found by
 * its plots; one without plots is compared with new tracks alone.
 */
static unsigned nearest_older(struct step *step, unsigned row)
{
    const struct rho_look *look = &step->look;
    const struct rho_tracker *tracker = step->tracker;
    const struct rho_track *track = &tracker->tracks[row];
    const float longest_m = tracker->bodies.length_max_m;
    const float *state = track->kalman.state;
    float least_m = longest_m;
    unsigned nearest = RHO_NO_ROW;
    const float half_m = 1.5f * longest_m + LOOSE_SIGMAS * look->sigma_max_m +
                         rho_bodies_moved_m(look, &state[RHO_VX]);
    struct plots_near near = rho_plots_near(tracker, state[RHO_X] - half_m, state[RHO_X] + half_m,
                                            state[RHO_Y] - half_m, state[RHO_Y] + half_m);
    for (uint32_t i; !rho_work_is_spent(&step->work) && rho_plots_next(look, &near, &i);) {
        const unsigned owner = tracker->bodies.groups.owner[i];
        rho_work_spend(&step->work, PASS_UNITS);
        if (owner != RHO_NO_ROW) {
            compare_older(look, row, owner, &nearest, &least_m);
        }
    }
    for (unsigned i = 0; i < tracker->num_tracks && track->hits <= MISSED_MOST; i++) {
        if (may_replace(tracker, i, row)) {
            compare_older(look, row, i, &nearest, &least_m);
        }
    }
    return nearest;
}

/* ln of the likelihoods' ratio of two bodies to one, by the look's plots of two tracks. */
static float evidence_of_two(struct step *step, unsigned older, unsigned younger)
{
    const struct rho_look *look = &step->look;
    const struct rho_tracker *tracker = step->tracker;
    const struct rho_groups *groups = &tracker->bodies.groups;
    const struct body_outline first = rho_bodies_outline_track(tracker, older),
                              second = rho_bodies_outline_track(tracker, younger),
                              joint = rho_bodies_join_outlines(tracker, older, younger);
    /* two bodies fit the same plots better than one: that is no evidence, unless they are known */
    const float known = rho_larger(tracker->bodies.of[younger].two_nat, 0.0f) / TWO_MOST_NAT;
    const float plot_nat = TWO_PLOT_NAT * (1.0f - known);
    const int replaces = may_replace(tracker, older, younger);
    unsigned num_plots = 0;
    float joint_nat = -TWO_LOOK_NAT, first_nat = -TWO_LOOK_NAT, second_nat = -TWO_LOOK_NAT;
    const float half_m = 2.0f * tracker->bodies.length_max_m + LOOSE_SIGMAS * look->sigma_max_m +
                         rho_bodies_moved_m(look, joint.velocity_mps);
    struct plots_near near =
        rho_plots_near(tracker, joint.place_m[0] - half_m, joint.place_m[0] + half_m,
                       joint.place_m[1] - half_m, joint.place_m[1] + half_m);
    for (uint32_t i; !rho_work_is_spent(&step->work) && rho_plots_next(look, &near, &i);) {
        if (groups->owner[i] != older && groups->owner[i] != younger) {
            continue;
        }
        num_plots++;
        rho_work_spend(&step->work, EVIDENCE_UNITS);
        const struct rho_plot *plot = &look->scan->plots[i];
        const float by_first = rho_bodies_density(look, &first, plot),
                    by_second = rho_bodies_density(look, &second, plot),
                    by_joint = rho_bodies_density(look, &joint, plot);
        const float two = by_first + by_second, far = FAR_SHARE * two;
        joint_nat += rho_log(two / (by_joint + far)) - plot_nat;
        first_nat += rho_log(two / (by_first * joint.plots / first.plots + far)) - plot_nat;
        second_nat += rho_log(two / (by_second * joint.plots / second.plots + far)) - plot_nat;
    }
    /* a look says little: plots are not independent, and older tracks change from look to look */
    first_nat = replaces ? rho_smaller(first_nat, second_nat) : first_nat;
    const float nat = rho_larger(rho_smaller(joint_nat, first_nat), -TWO_LOOK_MOST_NAT);
    return num_plots > 0 ? rho_smaller(nat, TWO_LOOK_MOST_NAT) : 0.0f;
}

static void swap_bytes(void *one, void *other, unsigned size)
{
    uint8_t *a = one, *b = other;
    for (unsigned i = 0; i < size; i++) {
        const uint8_t was = a[i];
        a[i] = b[i];
        b[i] = was;
    }
}

/* Gives the estimate and the life of a younger track to an older one that has lost the target. */
static void exchange_estimates(struct rho_track *older, struct rho_track *younger)
{
    swap_bytes(older, younger, sizeof *older);
    swap_bytes(&older->track_id, &younger->track_id, sizeof older->track_id);
    swap_bytes(&older->hits, &younger->hits, sizeof older->hits);
    swap_bytes(&older->misses, &younger->misses, sizeof older->misses);
    swap_bytes(&older->status, &younger->status, sizeof older->status);
    swap_bytes(&older->was_confirmed, &younger->was_confirmed, sizeof older->was_confirmed);
}

/* Leaves one of two tracks of one target, with the number of the older and the plots of both. */
static void end_duplicate(struct step *step, unsigned older, unsigned younger)
{
    struct rho_groups *groups = &step->tracker->bodies.groups;
    struct rho_track *tracks = step->tracker->tracks;
    if (tracks[older].misses_in_row > tracks[younger].misses_in_row) {
        exchange_estimates(&tracks[older], &tracks[younger]);
    }
    for (uint32_t i = 0; i < step->look.num_gated; i++) {
        if (groups->owner[i] == younger) {
            groups->owner[i] = (uint16_t)older;
        }
        if (groups->contender[i] == younger || groups->contender[i] == groups->owner[i]) {
            groups->contender[i] = RHO_NO_ROW;
        }
    }
    rho_work_spend(&step->work, step->look.num_gated / RHO_WORK_PASSED_A_UNIT);
    rho_life_end(step, &tracks[younger]);
}

void rho_bodies_end_duplicates(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    for (unsigned row = tracker->num_tracks; step->look.teaches && row-- > 0;) {
        struct rho_body_filter *body = &tracker->bodies.of[row];
        if (!rho_bodies_may_own(&step->look, row) || rho_work_is_spent(&step->work)) {
            continue;
        }
        const unsigned older = nearest_older(step, row);
        const float nat = older == RHO_NO_ROW ? APART_NAT : evidence_of_two(step, older, row);
        body->two_nat = rho_smaller(body->two_nat + nat, TWO_MOST_NAT);
        if (older != RHO_NO_ROW && body->two_nat < -ONE_BODY_NAT) {
            end_duplicate(step, older, row);
        }
    }
}
