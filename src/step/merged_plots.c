/* SPDX-License-Identifier: MIT */
/*
 * merged_plots: two tracks take one plot, where their targets are too near each other to resolve.
 *
 * The assignment gives a merged plot to one of the two tracks; the other would be missed until it
 * ends. Where both tracks are old, and are expected within a resolution cell of each other, both
 * take the plot. So crossing tracks keep their velocities, and tracks in formation go on.
 *
 * Two targets d apart along the line of sight are unresolved with probability e^-(d^2 / 2 n), and
 * the same holds across it (resolution_cell.c has n); d has the variance c of both
 * tracks' places. The probability `merged` is the product of the factors of both axes, and of the
 * range rates where the sensor resolves them:
 *     root(n / (n + c)) e^-(d^2 / 2 (n + c))
 * The plot is shared where a merged plot is likelier than a miss of the second target:
 *     merged N(z; middle) > (1 - merged) (1 - pd) N(z; first)
 *
 * The plot z is the middle of both targets, with noise r: the sensor's, and d^2 / 12, as the middle
 * of their echoes may be anywhere between them. So if the other target is at x, with variance p,
 * then 2 z - x is a plot of the first target, with noise 4 r + p. As the targets are not resolved,
 * x is a plot of the first target, too, with noise n + p. The errors of these two plots have the
 * covariance -p; by least squares they are one plot
 *     w 2 z + (1 - 2 w) x        w = (n + 2 p) / (4 r + n + 4 p)
 * with the noise ((4 r + p) (n + p) - p^2) / (4 r + n + 4 p), on each axis.
 *
 * The second track's score falls by as much as the middle explains the plot worse than the first
 * target alone does, but no more than by a miss. A pair that never parts loses a little each time,
 * until the second track is tentative.
 */
#include "phases.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"

struct track_pair {
    struct rho_track *first, *second; /* the plot is assigned to the first track */
    int plot;
    float gain_nat;              /* the plot's gain for the first track */
    struct rho_measurement seen; /* the plot: its line of sight, and the noise along and across */
    float half_m[2];  /* half the way from first to second, along and across the line of sight */
    float near_m2[2]; /* variances of unresolved distances, along and across the line of sight */
};

static int may_share(const struct rho_track *track)
{
    /* tentative tracks that were confirmed share, too: they may have missed merged plots alone */
    return track->was_confirmed && track->hits >= SHARING_HITS && track->plot < 0;
}

/* Rotates an offset in x and y to the axes along the line of sight and across it. */
static void turn_to_sight_line(const struct rho_measurement *seen, const float at_m[2],
                               float turned_m[2])
{
    turned_m[0] = seen->cos_azimuth * at_m[0] + seen->sin_azimuth * at_m[1];
    turned_m[1] = seen->cos_azimuth * at_m[1] - seen->sin_azimuth * at_m[0];
}

/* Variances of a track's place on the ground, along the line of sight and across it. */
static void turn_variances(const struct rho_measurement *seen, const struct rho_track *track,
                           float turned_m2[2])
{
    const float *covariance = track->kalman.covariance;
    const float c = seen->cos_azimuth, s = seen->sin_azimuth;
    const float xx = covariance[RHO_AT(0, 0)], yy = covariance[RHO_AT(1, 1)];
    const float twice_xy = 2.0f * covariance[RHO_AT(0, 1)];
    turned_m2[0] = c * c * xx + s * s * yy + c * s * twice_xy;
    turned_m2[1] = s * s * xx + c * c * yy - c * s * twice_xy;
}

/* Fills the pair of a track without a plot and the old track with its likeliest plot. 0: none. */
static int find_pair(struct rho_tracker *tracker, const struct rho_look *look, unsigned row,
                     struct track_pair *pair)
{
    const struct rho_assignment *assignment = &tracker->assignment;
    int32_t least = 0;
    pair->second = &tracker->tracks[row];
    for (unsigned i = 0; i < assignment->num_pairs[row]; i++) {
        const struct rho_assignment_pair *offer = &assignment->pairs[row][i];
        const int owner = assignment->column_row[offer->column];
        if (offer->cost < least && owner >= 0 && may_share(&tracker->tracks[owner])) {
            least = offer->cost;
            pair->plot = offer->column;
            pair->first = &tracker->tracks[owner];
            pair->gain_nat = 0.0f;
            (void)rho_score_pair_gain(look, (unsigned)owner, offer->column, &pair->gain_nat);
        }
    }
    if (least == 0) {
        return 0;
    }
    rho_measurement_from_plot(&look->scan->plots[pair->plot], 0, look->sensor, &pair->seen);
    const float *from = pair->first->kalman.state, *to = pair->second->kalman.state;
    const float half_m[2] = {0.5f * (to[0] - from[0]), 0.5f * (to[1] - from[1])};
    turn_to_sight_line(&pair->seen, half_m, pair->half_m);
    rho_cell_variances_at(look, &look->scan->plots[pair->plot], &pair->seen, pair->near_m2);
    return 1;
}

/* Range rate of the second track less that of the first; 0 where the scan measures none. */
static float rate_difference_mps(const struct rho_look *look, const struct track_pair *pair)
{
    const int use_z = (look->scan->measures & RHO_MEASURES_Z) != 0;
    float row[6], first_mps, second_mps;
    if (!(look->scan->measures & RHO_MEASURES_RANGE_RATE) ||
        !rho_measurement_predict_rate(pair->first->kalman.state, look->sensor, use_z, row,
                                      &first_mps) ||
        !rho_measurement_predict_rate(pair->second->kalman.state, look->sensor, use_z, row,
                                      &second_mps)) {
        return 0.0f;
    }
    return second_mps - first_mps;
}

/*
 * Plot minus the track's predicted position at the plot's own time, along the line of sight and
 * across it. The distance of the two targets is taken as constant meanwhile.
 */
static void offset_from_track(const struct rho_look *look, const struct track_pair *pair,
                              const struct rho_track *track, float from_m[2])
{
    const struct rho_plot *plot = &look->scan->plots[pair->plot];
    const float after_s = (float)plot->offset_us * 1e-6f, *state = track->kalman.state;
    const float place_m[2] = {plot->x_m - state[RHO_X] - after_s * state[RHO_VX],
                              plot->y_m - state[RHO_Y] - after_s * state[RHO_VY]};
    turn_to_sight_line(&pair->seen, place_m, from_m);
}

/* Factor of one axis in the probability that two targets are unresolved. */
static float unresolved_on_axis(float unresolved_variance, float apart, float variance)
{
    const float spread2 = unresolved_variance + variance;
    return rho_sqrt(unresolved_variance / spread2) * rho_exp(-0.5f * apart * apart / spread2);
}

/* Updates the learned resolution cell by a pair; is_one: probability that its plot is merged. */
static void learn_cell(const struct rho_look *look, const struct track_pair *pair,
                       const float both_m2[2], float is_one)
{
    struct apart apart = {.is_one = is_one};
    for (int axis = 0; axis < 2; axis++) {
        const float near_m2 = pair->near_m2[axis];
        const float apart_m = 2.0f * pair->half_m[axis];
        const float kept = near_m2 / (near_m2 + both_m2[axis]);
        apart.near_m2[axis] = near_m2;
        apart.of_one_m2[axis] = kept * (kept * apart_m * apart_m + both_m2[axis]);
        apart.of_two_m2[axis] = apart_m * apart_m + both_m2[axis];
    }
    rho_cell_learn(look, &apart);
}

/*
 * 1 where a merged plot is likelier than a miss of the second target. *gain_nat: the plot's gain
 * for the second track. The pair also updates the learned resolution cell.
 */
static int is_merged(const struct rho_look *look, const struct track_pair *pair, float *gain_nat)
{
    float from_m[2], first_m2[2], second_m2[2], both_m2[2];
    float merged = 1.0f, ratio_nat = 0.0f;
    const float near_mps2 = rho_cell_rate_variance(look->sensor);
    if (near_mps2 > 0.0f) {
        const float first_mps = rho_track_sigma_mps(pair->first),
                    second_mps = rho_track_sigma_mps(pair->second);
        merged = unresolved_on_axis(near_mps2, rate_difference_mps(look, pair),
                                    first_mps * first_mps + second_mps * second_mps);
    }
    offset_from_track(look, pair, pair->first, from_m);
    turn_variances(&pair->seen, pair->first, first_m2);
    turn_variances(&pair->seen, pair->second, second_m2);
    for (int axis = 0; axis < 2; axis++) {
        const float half_m = pair->half_m[axis];
        both_m2[axis] = first_m2[axis] + second_m2[axis];
        merged *= unresolved_on_axis(pair->near_m2[axis], 2.0f * half_m, both_m2[axis]);
        /* half the squared distance from plot to first less that from plot to middle, over noise */
        ratio_nat += half_m * (from_m[axis] - 0.5f * half_m) /
                     (pair->seen.variance_m2[axis] + first_m2[axis]);
    }
    const float log_miss = rho_look_visible(look, pair->second).log_miss;
    *gain_nat = rho_larger(log_miss, ratio_nat);
    const float one = merged * rho_exp(ratio_nat), two = (1.0f - merged) * rho_exp(log_miss);
    learn_cell(look, pair, both_m2, one / (one + two));
    return one > two;
}

/* Derives a track's own plot from a merged plot and the other track of the pair (top of file). */
static struct rho_track_plot own_part(const struct rho_look *look, const struct track_pair *pair,
                                      const struct rho_track *other)
{
    struct rho_track_plot part = rho_score_track_plot(look, pair->plot);
    const float c = pair->seen.cos_azimuth, s = pair->seen.sin_azimuth;
    const float half_mps = 0.5f * rate_difference_mps(look, pair);
    float from_m[2], other_m2[2], farther_m[2], wider[2];
    offset_from_track(look, pair, other, from_m);
    turn_variances(&pair->seen, other, other_m2);
    for (int axis = 0; axis < 2; axis++) {
        const float noise_m2 =
            pair->seen.variance_m2[axis] + 1.0f / 3.0f * pair->half_m[axis] * pair->half_m[axis];
        const float n = pair->near_m2[axis], p = other_m2[axis], r = 4.0f * noise_m2;
        const float all_m2 = r + n + 4.0f * p;
        farther_m[axis] = (2.0f * (n + 2.0f * p) / all_m2 - 1.0f) * from_m[axis];
        wider[axis] =
            rho_sqrt(((r + p) * (n + p) - p * p) / (all_m2 * pair->seen.variance_m2[axis]));
    }
    part.plot.x_m += c * farther_m[0] - s * farther_m[1];
    part.plot.y_m += s * farther_m[0] + c * farther_m[1];
    part.plot.sigma_range_m *= wider[0];
    part.plot.sigma_cross_m *= wider[1];
    part.plot.sigma_range_rate_mps = rho_sqrt(
        part.plot.sigma_range_rate_mps * part.plot.sigma_range_rate_mps + half_mps * half_mps);
    return part;
}

static int update_by_part(const struct rho_look *look, struct rho_track *track,
                          const struct rho_track_plot *part, float gain_nat)
{
    if (rho_track_update_by_plot(track, part, &look->model, rho_score_to_mnat(gain_nat)) !=
        RHO_OK) {
        return 0;
    }
    /* hypotheses are at the plot's own time: bring the track's estimate to the step's */
    rho_track_merge_estimates(track, look->time_us, &look->model);
    return 1;
}

/* Teaches the resolution cell by tracks with a plot each: resolved at the plots' distance. */
static void learn_resolved_pairs(struct rho_tracker *tracker, const struct rho_look *look,
                                 unsigned row)
{
    const struct rho_assignment *assignment = &tracker->assignment;
    const int own = rho_assignment_column(assignment, row);
    for (unsigned i = 0; i < assignment->num_pairs[row]; i++) {
        const int column = assignment->pairs[row][i].column;
        const int other = assignment->column_row[column];
        if (column == own || other <= (int)row || !may_share(&tracker->tracks[other])) {
            continue;
        }
        const struct rho_plot *from = &look->scan->plots[own], *to = &look->scan->plots[column];
        const float half_m[2] = {0.5f * (to->x_m - from->x_m), 0.5f * (to->y_m - from->y_m)};
        const float none_m2[2] = {0.0f, 0.0f};
        struct track_pair pair = {.first = &tracker->tracks[row],
                                  .second = &tracker->tracks[other]};
        rho_measurement_from_plot(from, 0, look->sensor, &pair.seen);
        turn_to_sight_line(&pair.seen, half_m, pair.half_m);
        rho_cell_variances_at(look, from, &pair.seen, pair.near_m2);
        learn_cell(look, &pair, none_m2, 0.0f);
    }
}

void rho_step_share_merged(struct rho_tracker *tracker, const struct rho_look *look)
{
    struct track_pair pair;
    float gain_nat;
    if (look->has_more_parts) {
        return; /* tracks may still be assigned plots of their own, in later parts of the scan */
    }
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        const int has_own = rho_assignment_column(&tracker->assignment, row) != RHO_ASSIGNMENT_NONE;
        /* the track needs an offer besides the plot that it was assigned */
        if (tracker->assignment.num_pairs[row] <= (unsigned)has_own ||
            !may_share(&tracker->tracks[row])) {
            continue;
        }
        if (has_own) {
            learn_resolved_pairs(tracker, look, row);
        } else if (find_pair(tracker, look, row, &pair) && is_merged(look, &pair, &gain_nat)) {
            /* the older track gets the gain of an unmerged plot, the newer one that of sharing */
            const int second_is_older = pair.second < pair.first;
            const struct rho_track_plot of_first = own_part(look, &pair, pair.second),
                                        of_second = own_part(look, &pair, pair.first);
            /* where the second track refuses, the first goes on to take its plot alone */
            if (update_by_part(look, pair.second, &of_second,
                               second_is_older ? pair.gain_nat : gain_nat)) {
                look->fates[pair.plot] = RHO_FATE_CLAIMED;
                (void)!update_by_part(look, pair.first, &of_first,
                                      second_is_older ? gain_nat : pair.gain_nat);
            }
        }
    }
}
