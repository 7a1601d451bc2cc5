/* SPDX-License-Identifier: MIT */
/*
 * merged_plots: two targets so near each other that the sensor makes one plot of both.
 *
 * The assignment gives that plot to one of the two tracks; the other one would be missed until it
 * ends. Where both have been seen apart for long, and are expected within a resolution cell of each
 * other, both take the plot. So crossing tracks keep their velocities, and tracks in formation stay
 * together until they part.
 *
 * Two targets d apart along the line of sight are unresolved with probability e^-(d^2 / 2 n), and
 * so across it (resolution_cell.c has n); d is as uncertain as both tracks' places, by a variance
 * of c. The product of both axes'
 *     root(n / (n + c)) e^-(d^2 / 2 (n + c))
 * is `merged`; and of the range rates', where the sensor resolves those.
 * The plot is shared where that explains it better than a miss of the second target does:
 *     merged N(z; middle) > (1 - merged) (1 - pd) N(z; first)
 *
 * The plot z is the middle of both, with noise r: the sensor's, and d^2 / 12, as the middle of
 * their echoes may be anywhere between them. So if the other target is at x, with variance p, then
 * 2 z - x is a plot of the first one, with noise 4 r + p. And since both are not resolved x is one,
 * too, with noise n + p. Their errors have the covariance -p; by least squares they are one plot
 *     w 2 z + (1 - 2 w) x        w = (n + 2 p) / (4 r + n + 4 p)
 * with the noise ((4 r + p) (n + p) - p^2) / (4 r + n + 4 p), on each axis.
 *
 * The second track's score falls by as much as the middle explains the plot worse than the first
 * target alone does, but no more than by a miss. A pair that never parts loses a little each time,
 * until the second track is tentative.
 */
#include "phases.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"

/* Variance of a place anywhere between both targets, over the square of half their distance. */
#define BETWEEN (1.0f / 3.0f)
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
    float near_m2[2];            /* variances of distances that are not resolved, likewise */
};

static int may_be_merged(const struct rho_track *track)
{
    /* tentative ones, too: both missing a merged plot says nothing of the second target alone */
    return track->was_confirmed && track->hits >= HITS_MIN && track->plot < 0;
}

/* Turns a distance in x and y into one along the line of sight and one across it. */
static void along_and_across(const struct rho_measurement *seen, const float at_m[2],
                             float turned_m[2])
{
    turned_m[0] = seen->cos_azimuth * at_m[0] + seen->sin_azimuth * at_m[1];
    turned_m[1] = seen->cos_azimuth * at_m[1] - seen->sin_azimuth * at_m[0];
}

/* Variances of a track's place on the ground, along the line of sight and across it. */
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
    rho_tracker_cell_at(step, &step->scan->plots[pair->plot], &pair->seen, pair->near_m2);
    return 1;
}

/* How far the range rates of both are apart, where the plot has one; 0: no matter how far. */
static float rates_apart_mps(const struct step *step, const struct pair *pair)
{
    const int use_z = (step->scan->measures & RHO_MEASURES_Z) != 0;
    float row[6], first_mps, second_mps;
    if (!(step->scan->measures & RHO_MEASURES_RANGE_RATE) ||
        !rho_measurement_range_rate(pair->first->kalman.state, step->sensor, use_z, row,
                                    &first_mps) ||
        !rho_measurement_range_rate(pair->second->kalman.state, step->sensor, use_z, row,
                                    &second_mps)) {
        return 0.0f;
    }
    return second_mps - first_mps;
}

/*
 * From where the track expects its target to the plot, along and across: at the plot's own time.
 * The way from one target to the other is taken to be the same then.
 */
static void offset_from_track(const struct step *step, const struct pair *pair,
                              const struct rho_track *track, float from_m[2])
{
    const struct rho_plot *plot = &step->scan->plots[pair->plot];
    const float after_s = (float)plot->offset_us * 1e-6f, *state = track->kalman.state;
    const float place_m[2] = {plot->x_m - state[RHO_X] - after_s * state[RHO_VX],
                              plot->y_m - state[RHO_Y] - after_s * state[RHO_VY]};
    along_and_across(&pair->seen, place_m, from_m);
}

/* One axis of the probability that both are not resolved. */
static float unresolved_probability(float near2, float apart, float variance)
{
    const float spread2 = near2 + variance;
    return rho_sqrt(near2 / spread2) * rho_exp(-0.5f * apart * apart / spread2);
}

static float unresolved_by_rate(const struct step *step, const struct pair *pair)
{
    const float near_mps2 = rho_tracker_rate_cell_mps2(step->sensor);
    const float first_mps = rho_track_sigma_mps(pair->first),
                second_mps = rho_track_sigma_mps(pair->second);
    return near_mps2 > 0.0f
               ? unresolved_probability(near_mps2, rates_apart_mps(step, pair),
                                        first_mps * first_mps + second_mps * second_mps)
               : 1.0f;
}

/* Teaches the resolution cell by the pair, with the probability that the plot is of both. */
static void teach_resolution_cell(struct step *step, const struct pair *pair,
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
    rho_tracker_learn_cell(step, &apart);
}

/*
 * 1 where a merged plot is likelier than a miss of the second target. *gain_nat: of the plot, for
 * the second track.
 */
static int is_merged(struct step *step, const struct pair *pair, float *gain_nat)
{
    float from_m[2], first_m2[2], second_m2[2], both_m2[2];
    float merged = unresolved_by_rate(step, pair), ratio_nat = 0.0f;
    offset_from_track(step, pair, pair->first, from_m);
    variances_along(&pair->seen, pair->first, first_m2);
    variances_along(&pair->seen, pair->second, second_m2);
    for (int axis = 0; axis < 2; axis++) {
        const float half_m = pair->half_m[axis];
        both_m2[axis] = first_m2[axis] + second_m2[axis];
        merged *= unresolved_probability(pair->near_m2[axis], 2.0f * half_m, both_m2[axis]);
        /* |z - first|^2 less |z - middle|^2 */
        ratio_nat += half_m * (from_m[axis] - 0.5f * half_m) /
                     (pair->seen.variance_m2[axis] + first_m2[axis]);
    }
    const float log_miss = rho_tracker_detection(step, pair->second).log_miss;
    *gain_nat = rho_larger(log_miss, rho_smaller(ratio_nat, GAIN_MAX_NAT));
    const float one = merged * rho_exp(ratio_nat), two = (1.0f - merged) * rho_exp(log_miss);
    teach_resolution_cell(step, pair, both_m2, one / (one + two));
    return one > two;
}

/* The merged plot as one of this track, which is the other one's pair. */
static struct rho_track_plot part_of_plot(const struct step *step, const struct pair *pair,
                                          const struct rho_track *other)
{
    struct rho_track_plot part = rho_tracker_plot_of(step, pair->plot);
    const float c = pair->seen.cos_azimuth, s = pair->seen.sin_azimuth;
    const float half_mps = 0.5f * rates_apart_mps(step, pair);
    float from_m[2], other_m2[2], farther_m[2], wider[2];
    offset_from_track(step, pair, other, from_m);
    variances_along(&pair->seen, other, other_m2);
    for (int axis = 0; axis < 2; axis++) {
        const float noise_m2 =
            pair->seen.variance_m2[axis] + BETWEEN * pair->half_m[axis] * pair->half_m[axis];
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

static int take_plot_part(struct step *step, struct rho_track *track,
                          const struct rho_track_plot *part, float gain_nat)
{
    if (rho_track_update(track, part, &step->model, rho_tracker_mnat(gain_nat)) != RHO_OK) {
        return 0;
    }
    /* hypotheses are at the plot's own time, and so is said of the track */
    rho_track_merge_estimates(track, step->time_us, &step->model);
    return 1;
}

static void share_plot(struct step *step, const struct pair *pair, float gain_nat)
{
    /* the older one gains as from a plot of its own */
    const int second_is_older = pair->second < pair->first;
    const struct rho_track_plot of_first = part_of_plot(step, pair, pair->second),
                                of_second = part_of_plot(step, pair, pair->first);
    /* a track that refuses goes on as without a pair */
    if (take_plot_part(step, pair->second, &of_second,
                       second_is_older ? pair->gain_nat : gain_nat)) {
        step->report->fates[pair->plot] = RHO_FATE_CLAIMED;
        (void)!take_plot_part(step, pair->first, &of_first,
                              second_is_older ? gain_nat : pair->gain_nat);
    }
}

/* Pairs that each have a plot are resolved, at the distance of their plots. */
static void note_resolved(struct step *step, unsigned row)
{
    struct rho_tracker *tracker = step->tracker;
    const struct rho_assignment *assignment = &tracker->assignment;
    const int own = rho_assignment_column(assignment, row);
    for (unsigned i = 0; i < assignment->num_pairs[row]; i++) {
        const int column = assignment->pairs[row][i].column;
        const int other = assignment->column_row[column];
        if (column == own || other <= (int)row || !may_be_merged(&tracker->tracks[other])) {
            continue;
        }
        const struct rho_plot *from = &step->scan->plots[own], *to = &step->scan->plots[column];
        const float half_m[2] = {0.5f * (to->x_m - from->x_m), 0.5f * (to->y_m - from->y_m)};
        const float none_m2[2] = {0.0f, 0.0f};
        struct pair pair = {.first = &tracker->tracks[row], .second = &tracker->tracks[other]};
        rho_measurement_open(from, 0, step->sensor, &pair.seen);
        along_and_across(&pair.seen, half_m, pair.half_m);
        rho_tracker_cell_at(step, from, &pair.seen, pair.near_m2);
        teach_resolution_cell(step, &pair, none_m2, 0.0f);
    }
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
        const int has_own = rho_assignment_column(&tracker->assignment, row) != RHO_ASSIGNMENT_NONE;
        /* one's own plot says nothing of another target */
        if (tracker->assignment.num_pairs[row] <= (unsigned)has_own ||
            !may_be_merged(&tracker->tracks[row])) {
            continue;
        }
        if (has_own) {
            note_resolved(step, row);
        } else if (find_pair(step, row, &pair) && is_merged(step, &pair, &gain_nat)) {
            share_plot(step, &pair, gain_nat);
        }
    }
}
