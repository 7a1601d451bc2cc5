/* SPDX-License-Identifier: MIT */
/*
 * tracker_shared: two targets so near each other that the sensor makes one plot of both.
 *
 * The assignment gives that plot to one of the two tracks; the other would starve, though nothing
 * says that its target has gone. Where both have been seen apart for long, and are expected within
 * a few sigmas of each other, both take the plot, as one that is off by as much as targets seen as
 * one lie apart. So those that cross keep their velocities, and those in formation stay together
 * until they part.
 *
 * Two targets d apart along the line of sight are seen as one with probability
 * e^-(d^2 / 8 sigma^2), and so across it, each with the sensor's sigma there; d is as uncertain as
 * both tracks' places are, by a variance of c. The product of both axes'
 *     root(4 sigma^2 / (4 sigma^2 + c)) e^-(d^2 / 2 (4 sigma^2 + c))
 * is `merged`.
 * The plot is shared where that explains it better than a miss of the second target does:
 *     merged N(z; middle) > (1 - merged) (1 - pd) N(z; first)
 * and it takes from the second track's score what the middle explains it worse than the first
 * target alone, but no more than
 * a miss. A pair that never parts again loses a little each time, until the second one is in doubt.
 */
#include "rhotrack/approx.h"
#include "rhotrack/measurement.h"
#include "tracker_step.h"

#if RHO_SHARES_PLOTS

/* Noise of such a plot, as a multiple of the sensor's own: root of 1 + 2^2, being off by twice that. */
#define WIDER 2.236068f
/* Scans that a track has been seen in: one that is new may be the same target's again. */
#define HITS_MIN 10
/* ln of how likely a pair goes on as one for another scan: some 50 scans until the second one is in doubt. */
#define GAIN_MAX_NAT (-0.1f)

struct pair {
    struct rho_track *first, *second; /* first: has the plot */
    int plot;
    float gain_nat;              /* of the first */
    struct rho_measurement seen; /* the plot: its line of sight, and the noise along and across */
    float half_m[2];             /* along and across: from the middle to the second */
};

static int is_old(const struct rho_track *track)
{
    /* one in doubt, too: a plot of both that is missed twice says nothing of the second target alone */
    return track->is_believed && track->hits >= HITS_MIN && track->plot < 0;
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

/* Of a track without a plot: the likeliest one that another old track got. */
static int find_pair(const struct step *step, unsigned row, struct pair *pair)
{
    struct rho_tracker *tracker = step->tracker;
    const struct rho_assignment *assignment = &tracker->assignment;
    int32_t least = 0;
    pair->second = &tracker->tracks[row];
    for (unsigned i = 0; i < assignment->num_pairs[row]; i++) {
        const struct rho_assignment_pair *offer = &assignment->pairs[row][i];
        const int owner = assignment->column_row[offer->column];
        if (offer->cost < least && owner >= 0 && is_old(&tracker->tracks[owner])) {
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

static float larger(float a, float b)
{
    return a > b ? a : b;
}

/* 1 where both are rather seen as one than the second one missed, and what the plot says of it. */
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
    const float log_miss = rho_tracker_odds(step, pair->second).log_miss;
    *gain_nat = larger(log_miss, ratio_nat < GAIN_MAX_NAT ? ratio_nat : GAIN_MAX_NAT);
    return merged * rho_exp(ratio_nat) > (1.0f - merged) * rho_exp(log_miss);
}

static int take(struct step *step, struct rho_track *track, int plot, float gain_nat)
{
    struct rho_track_plot seen = rho_tracker_plot_of(step, plot);
    seen.plot.sigma_range_m *= WIDER;
    seen.plot.sigma_cross_m *= WIDER;
    if (rho_track_update(track, &seen, &step->model, rho_tracker_mnat(gain_nat)) != RHO_OK) {
        return 0;
    }
    /* hypotheses are at the plot's own time, and so is said of the track */
    rho_track_settle(track, step->time_us, &step->model);
    return 1;
}

void rho_tracker_share(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    struct pair pair;
    float gain_nat;
    if (step->has_more_parts) {
        return; /* its own plot may be there */
    }
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        if (rho_assignment_column(&tracker->assignment, row) != RHO_ASSIGNMENT_NONE ||
            !is_old(&tracker->tracks[row]) || !find_pair(step, row, &pair) ||
            !is_merged(step, &pair, &gain_nat)) {
            continue;
        }
        /* one that refuses goes on as if there were no pair; the elder one has what the plot is worth */
        const int second_is_elder = pair.second < pair.first;
        if (take(step, pair.second, pair.plot, second_is_elder ? pair.gain_nat : gain_nat)) {
            step->report->fates[pair.plot] = RHO_FATE_CLAIMED;
            (void)!take(step, pair.first, pair.plot, second_is_elder ? gain_nat : pair.gain_nat);
        }
    }
}

#else

typedef int rho_tracker_shares_nothing; /* a file must not be empty */

#endif
