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
 * alone may explain the plots, too: the target has turned. The older goes on with its estimate.
 */
#include <string.h>

#include "bodies.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"

/*
 * True where a younger track may see what an older one has lost: both were never seen at once, and
 * a turn explains their velocities.
 */
static int may_replace(const struct rho_tracker *tracker, unsigned older, unsigned younger)
{
    const struct rho_track *from = &tracker->tracks[older], *to = &tracker->tracks[younger];
    const float vx_mps = to->kalman.state[RHO_VX] - from->kalman.state[RHO_VX],
                vy_mps = to->kalman.state[RHO_VY] - from->kalman.state[RHO_VY];
    const float most_mps = rho_bodies_turn_most_mps(tracker);
    return from->misses_in_row > 0 && to->hits <= from->misses_in_row + 1u &&
           vx_mps * vx_mps + vy_mps * vy_mps <= most_mps * most_mps;
}

/* Distance of a younger track; less than it is from one that may have turned since it was seen. */
static float distance_m(const struct rho_look *look, unsigned older, unsigned younger)
{
    const struct rho_tracker *tracker = look->tracker;
    const struct rho_track *from = &tracker->tracks[older], *to = &tracker->tracks[younger];
    const float dx_m = to->kalman.state[RHO_X] - from->kalman.state[RHO_X],
                dy_m = to->kalman.state[RHO_Y] - from->kalman.state[RHO_Y];
    const float apart_m = rho_sqrt(dx_m * dx_m + dy_m * dy_m);
    const float turned_m =
        rho_bodies_turn_most_mps(tracker) * rho_seconds_between(from->updated_us, look->time_us);
    return may_replace(tracker, older, younger)
               ? apart_m - rho_smaller(turned_m, tracker->bodies.length_max_m)
               : apart_m;
}

/* Takes an older track as the nearest one, where it is; one that was confirmed counts as older. */
static void compare_older(const struct rho_look *look, unsigned row, unsigned older,
                          unsigned *nearest, float *least_m)
{
    const struct rho_track *tracks = look->tracker->tracks;
    if (older == RHO_NO_ROW || older == row || older == *nearest ||
        (tracks[older].was_confirmed != tracks[row].was_confirmed ? tracks[row].was_confirmed
                                                                  : older > row) ||
        !rho_bodies_may_own(look, older)) {
        return;
    }
    const float apart_m = distance_m(look, older, row);
    if (apart_m < *least_m) {
        *least_m = apart_m;
        *nearest = older;
    }
}

/*
 * Row of the nearest older track whose body may be that of a track; or RHO_NO_ROW. It is found by
 * its plots and by those that its body explains, too; one that missed is compared with new tracks
 * alone. *is_seen: the track has a plot in this look.
 */
static unsigned nearest_older(struct step *step, unsigned row, int *is_seen)
{
    const struct rho_look *look = &step->look;
    const struct rho_tracker *tracker = step->tracker;
    const struct rho_groups *groups = &tracker->bodies.groups;
    const struct rho_track *track = &tracker->tracks[row];
    const float *state = track->kalman.state;
    float least_m = tracker->bodies.length_max_m;
    unsigned nearest = RHO_NO_ROW, last = RHO_NO_ROW;
    const float half_m =
        least_m + LOOSE_SIGMAS * look->sigma_max_m + rho_bodies_moved_m(look, &state[RHO_VX]);
    struct plots_near near = rho_plots_near(tracker, state[RHO_X] - half_m, state[RHO_X] + half_m,
                                            state[RHO_Y] - half_m, state[RHO_Y] + half_m);
    *is_seen = 0;
    rho_work_spend(&step->work, PAIR_UNITS);
    for (uint32_t i; !rho_work_is_spent(&step->work) && rho_plots_next(look, &near, &i);) {
        if (!rho_plots_is_within(&near, &look->scan->plots[i])) {
            continue;
        }
        rho_work_spend(&step->work, PASS_UNITS);
        *is_seen |= groups->owner[i] == row;
        if (groups->owner[i] != last) { /* neighbouring plots are often of one track */
            last = groups->owner[i];
            compare_older(look, row, last, &nearest, &least_m);
        }
        compare_older(look, row, groups->contender[i], &nearest, &least_m);
    }
    if (track->hits <= MISSED_MOST) {
        rho_work_spend(&step->work, tracker->num_tracks / RHO_WORK_PASSED_A_UNIT);
        for (unsigned i = 0; i < tracker->num_tracks; i++) {
            if (may_replace(tracker, i, row)) {
                compare_older(look, row, i, &nearest, &least_m);
            }
        }
    }
    return nearest;
}

/* What the plots of a look say of two tracks. */
struct pair_evidence {
    float nat;         /* ln of the likelihoods' ratio of two bodies to one */
    int is_by_younger; /* the one body is that of the younger track: the older has lost it */
};

/* ln of the likelihoods' ratio of two bodies to one, by the look's plots of two tracks. */
static struct pair_evidence evidence_of_two(struct step *step, unsigned older, unsigned younger)
{
    const struct rho_look *look = &step->look;
    const struct rho_tracker *tracker = step->tracker;
    const struct rho_groups *groups = &tracker->bodies.groups;
    const struct body_outline first = rho_bodies_outline_track(look, older),
                              second = rho_bodies_outline_track(look, younger),
                              joint =
                                  rho_bodies_join_outlines(look, older, younger, &first, &second);
    /* two bodies fit the same plots better than one: that is no evidence, unless they are known */
    const float known = rho_larger(tracker->bodies.of[younger].two_nat, 0.0f) / TWO_MOST_NAT;
    const float plot_nat = TWO_PLOT_NAT * (1.0f - known);
    const int is_lost = may_replace(tracker, older, younger);
    unsigned num_plots = 0;
    rho_work_spend(&step->work, EVIDENCE_UNITS);
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
        if (is_lost) {
            second_nat += rho_log(two / (by_second * joint.plots / second.plots + far)) - plot_nat;
        }
    }
    const int is_by_younger = is_lost && second_nat < first_nat && second_nat < joint_nat;
    float nat = is_by_younger ? second_nat : rho_smaller(joint_nat, first_nat);
    /* a look says little: plots are not independent, and older tracks change from look to look */
    nat = rho_smaller(rho_larger(nat, -TWO_LOOK_MOST_NAT), TWO_LOOK_MOST_NAT);
    return (struct pair_evidence){num_plots > 0 ? nat : 0.0f, is_by_younger};
}

/* Gives the estimate of a younger track to an older one that has lost their target. */
static void take_estimate(struct rho_track *older, struct rho_track *younger)
{
    const uint8_t filter = older->filter;
    const uint16_t slot = older->slot;
    older->filter = younger->filter;
    older->slot = younger->slot;
    younger->filter = filter;
    younger->slot = slot; /* it is freed as the younger track ends */
    older->kalman = younger->kalman;
    older->input = younger->input;
    older->maneuver_probability = younger->maneuver_probability;
    older->is_undecided = younger->is_undecided;
    older->num_velocities = younger->num_velocities;
    memcpy(older->accel_mps2, younger->accel_mps2, sizeof older->accel_mps2);
    memcpy(older->newest_mps, younger->newest_mps, sizeof older->newest_mps);
    memcpy(older->before_mps, younger->before_mps, sizeof older->before_mps);
    older->time_us = younger->time_us;
    older->updated_us = younger->updated_us;
    older->seen_us = younger->seen_us;
    older->sensor_id = younger->sensor_id;
    older->misses_in_row = younger->misses_in_row;
    older->has_shown = 0;
    memcpy(older->plot_m, younger->plot_m, sizeof older->plot_m);
    older->plot_sigma_m = younger->plot_sigma_m;
    if (rho_track_existence(older) < rho_track_existence(younger)) {
        older->visible = younger->visible;
        older->hidden = younger->hidden;
        older->lived_us = younger->lived_us;
    }
}

/* Leaves the older of two tracks of one target, with the plots of both. */
static void end_duplicate(struct step *step, unsigned older, unsigned younger, int is_by_younger)
{
    struct rho_groups *groups = &step->tracker->bodies.groups;
    struct rho_track *tracks = step->tracker->tracks;
    if (is_by_younger) {
        take_estimate(&tracks[older], &tracks[younger]);
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
    const struct rho_groups *groups = &tracker->bodies.groups;
    uint8_t is_contested[RHO_BODY_TRACKS] = {0};
    if (!step->look.teaches) {
        return;
    }
    rho_work_spend(&step->work, step->look.num_gated / RHO_WORK_PASSED_A_UNIT);
    for (uint32_t i = 0; i < step->look.num_gated; i++) {
        if (groups->contender[i] != RHO_NO_ROW) {
            is_contested[groups->contender[i]] = is_contested[groups->owner[i]] = 1;
        }
    }
    for (unsigned row = tracker->num_tracks; row-- > 0;) {
        struct rho_body_filter *body = &tracker->bodies.of[row];
        int is_seen = 0;
        /* long apart from each older track, and no other contends for its plots: not asked */
        if (!rho_bodies_may_own(&step->look, row) ||
            (!is_contested[row] && body->two_nat >= TWO_MOST_NAT &&
             tracker->tracks[row].hits > MISSED_MOST)) {
            continue;
        }
        const unsigned older = nearest_older(step, row, &is_seen);
        struct pair_evidence found = {is_seen ? APART_NAT : 0.0f, 0};
        if (older != RHO_NO_ROW) {
            found = evidence_of_two(step, older, row);
        }
        if (rho_work_is_spent(&step->work)) {
            return; /* not all plots were asked */
        }
        body->two_nat = rho_smaller(body->two_nat + found.nat, TWO_MOST_NAT);
        if (older != RHO_NO_ROW && body->two_nat < -ONE_BODY_NAT) {
            end_duplicate(step, older, row, found.is_by_younger);
        }
    }
}
