/* SPDX-License-Identifier: MIT */
/*
 * merged_plots: two targets so near each other that the sensor makes one plot of both.
 *
 * The assignment gives that plot to one of the two tracks; the other one would be missed until it
 * ends. Where both have been seen apart for long, and are expected within a few sigmas of each
 * other, both take the plot, with a noise that covers the distance of targets that are not
 * resolved. So crossing tracks keep their velocities, and tracks in formation stay together until
 * they part.
 *
 * Two targets d apart along the line of sight are unresolved with probability e^-(d^2 / 8 sigma^2),
 * and so across it, each with the sensor's sigma there; d is as uncertain as both tracks' places,
 * by a variance of c. The product of both axes'
 *     root(4 sigma^2 / (4 sigma^2 + c)) e^-(d^2 / 2 (4 sigma^2 + c))
 * is `merged`.
 * The plot is shared where that explains it better than a miss of the second target does:
 *     merged N(z; middle) > (1 - merged) (1 - pd) N(z; first)
 * The second track's score falls by as much as the middle explains the plot worse than the first
 * target alone does, but no more than by a miss. A pair that never parts loses a little each time,
 * until the second track is tentative.
 */
#include "phases.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/measurement.h"

/*
 * Noise of a merged plot, as a multiple of the sensor's own: the root of 1 + 2^2, as it lies up to
 * twice that off.
 */
#define WIDER 2.236068f
/* Hits of a track that may share a plot: a newer one may be of the same target. */
#define HITS_MIN 10
/*
 * ln of the probability that a pair stays merged for another scan: some 50 scans until the second
 * track is tentative.
 */
#define GAIN_MAX_NAT (-0.1f)

struct pair {
    struct rho_track *first, *second; /* first: has the plot */
    int plot;
    float gain_nat;              /* of the first */
    struct rho_measurement seen; /* the plot: its line of sight, and the noise along and across */
    float half_m[2];             /* along and across: from the middle to the second */
};

static int may_be_merged(const struct rho_track *track)
{
    /* tentative ones, too: both missing a merged plot says nothing of the second target alone */
    return track->was_confirmed && track->hits >= HITS_MIN && track->plot < 0;
}

/* Along the line of sight, and across it. */
static void along_and_across(const struct rho_measurement *seen, const float at_m[2],
                             float turned_m[2])
{
    turned_m[0] = seen->cos_azimuth * at_m[0] + seen->sin_azimuth * at_m[1];
    turned_m[1] = seen->cos_azimuth * at_m[1] - seen->sin_azimuth * at_m[0];
}

/* Of the place on the ground. */
static void variances_along(const struct rho_measurement *seen, const struct rho_track *track,
                            float turned_m2[2])
{
    const float *covariance = track->kalman.covariance;
    const float c = seen->cos_azimuth, s = seen->sin_azimuth;
    const float xx = covariance[RHO_AT(0, 0)], yy = covariance[RHO_AT(1, 1)];
    const float twice_xy = 2.0f * covariance[RHO_AT(0, 1)];
    turned_m2[0] = c * c * xx + s * s * yy + c * s * twice_xy;
    turned_m2[1] = s * s * xx + c * c * yy - c * s * twice_xy;
}

/* Finds for a track without a plot the likeliest plot that was assigned to another old track. */
static int find_pair(const struct step *step, unsigned row, struct pair *pair)
{
    struct rho_tracker *tracker = step->tracker;
    const struct rho_assignment *assignment = &tracker->assignment;
    int32_t least = 0;
    pair->second = &tracker->tracks[row];
    for (unsigned i = 0; i < assignment->num_pairs[row]; i++) {
        const struct rho_assignment_pair *offer = &assignment->pairs[row][i];
        const int owner = assignment->column_row[offer->column];
        if (offer->cost < least && owner >= 0 && may_be_merged(&tracker->tracks[owner])) {
            least = offer->cost;
            pair->plot = offer->column;
            pair->first = &tracker->tracks[owner];
            pair->gain_nat = 0.0f;
            (void)rho_tracker_gain_offered(step, (unsigned)owner, offer->column, &pair->gain_nat);
        }
    }
    if (least == 0) {
        return 0;
    }
    rho_measurement_open(&step->scan->plots[pair->plot], 0, step->sensor, &pair->seen);
    const float *from = pair->first->kalman.state, *to = pair->second->kalman.state;
    const float half_m[2] = {0.5f * (to[0] - from[0]), 0.5f * (to[1] - from[1])};
    along_and_across(&pair->seen, half_m, pair->half_m);
    return 1;
}

/*
 * 1 where a merged plot is likelier than a miss of the second target. *gain_nat: of the plot, for
 * the second track.
 */
static int is_merged(const struct step *step, const struct pair *pair, float *gain_nat)
{
    const struct rho_plot *plot = &step->scan->plots[pair->plot];
    /* at the plot's own time; the way from one to the other is taken to be the same then */
    const float after_s = (float)plot->offset_us * 1e-6f, *state = pair->first->kalman.state;
    const float place_m[2] = {plot->x_m - state[0] - after_s * state[3],
                              plot->y_m - state[1] - after_s * state[4]};
    float from_m[2], first_m2[2], second_m2[2];
    float share = 1.0f, distance2 = 0.0f, ratio_nat = 0.0f;
    along_and_across(&pair->seen, place_m, from_m);
    variances_along(&pair->seen, pair->first, first_m2);
    variances_along(&pair->seen, pair->second, second_m2);
    for (int axis = 0; axis < 2; axis++) {
        const float half_m = pair->half_m[axis];
        const float near_m2 = 4.0f * pair->seen.variance_m2[axis];
        const float spread_m2 = near_m2 + first_m2[axis] + second_m2[axis];
        share *= near_m2 / spread_m2;
        distance2 += 4.0f * half_m * half_m / spread_m2;
        /* |z - first|^2 less |z - middle|^2 */
        ratio_nat += half_m * (from_m[axis] - 0.5f * half_m) /
                     (pair->seen.variance_m2[axis] + first_m2[axis]);
    }
    const float merged = rho_sqrt(share) * rho_exp(-0.5f * distance2);
    const float log_miss = rho_tracker_detection(step, pair->second).log_miss;
    *gain_nat = rho_larger(log_miss, ratio_nat < GAIN_MAX_NAT ? ratio_nat : GAIN_MAX_NAT);
    return merged * rho_exp(ratio_nat) > (1.0f - merged) * rho_exp(log_miss);
}

static int take_merged_plot(struct step *step, struct rho_track *track, int plot, float gain_nat)
{
    struct rho_track_plot seen = rho_tracker_plot_of(step, plot);
    seen.plot.sigma_range_m *= WIDER;
    seen.plot.sigma_cross_m *= WIDER;
    if (rho_track_update(track, &seen, &step->model, rho_tracker_mnat(gain_nat)) != RHO_OK) {
        return 0;
    }
    /* hypotheses are at the plot's own time, and so is said of the track */
    rho_track_merge_estimates(track, step->time_us, &step->model);
    return 1;
}

void rho_tracker_share_merged_plots(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    struct pair pair;
    float gain_nat;
    if (step->has_more_parts) {
        return; /* its own plot may be there */
    }
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        if (rho_assignment_column(&tracker->assignment, row) != RHO_ASSIGNMENT_NONE ||
            !may_be_merged(&tracker->tracks[row]) || !find_pair(step, row, &pair) ||
            !is_merged(step, &pair, &gain_nat)) {
            continue;
        }
        /*
         * a track that refuses goes on as without a pair; the older one gains as from a plot of its
         * own
         */
        const int second_is_older = pair.second < pair.first;
        if (take_merged_plot(step, pair.second, pair.plot,
                             second_is_older ? pair.gain_nat : gain_nat)) {
            step->report->fates[pair.plot] = RHO_FATE_CLAIMED;
            (void)!take_merged_plot(step, pair.first, pair.plot,
                                    second_is_older ? gain_nat : pair.gain_nat);
        }
    }
}
