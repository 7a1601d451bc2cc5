/* SPDX-License-Identifier: MIT */
/*
 * track_evidence: the probabilities that a track's plots of the last scan are
 * its own, are shared with other tracks, or are clutter.
 */
#include <string.h>

#include "clutter.h"
#include "plots.h"
#include "rhotrack/detail/approx.h"
#include "sensors.h"
#include "step.h"

#define NAT_PER_MNAT 0.001f

void rho_score_remove_row(struct rho_tracker *tracker, unsigned row)
{
    struct rho_assignment *assignment = &tracker->assignment;
    for (unsigned from = row + 1u; from < assignment->num_rows; from++) {
        rho_assignment_move_pairs(assignment, from, from - 1u);
    }
    if (row < assignment->num_rows) {
        assignment->num_rows--;
    }
}

/* Least cost of a track's plots and of a miss, which costs 0: the cost of the likeliest choice. */
static int32_t least_cost_of_track(const struct rho_assignment *assignment, unsigned row)
{
    int32_t least = 0;
    for (unsigned i = 0; i < assignment->num_pairs[row]; i++) {
        const int32_t cost = assignment->pairs[row][i].cost;
        least = cost < least ? cost : least;
    }
    return least;
}

static float relative_likelihood(int32_t cost, int32_t least)
{
    return rho_exp((float)(least - cost) * NAT_PER_MNAT);
}

/* Sum of the likelihoods of a track's plots and of a miss, relative to the likeliest of them. */
static float sum_of_likelihoods(const struct rho_assignment *assignment, unsigned row,
                                int32_t least_cost)
{
    float sum = relative_likelihood(0, least_cost);
    for (unsigned i = 0; i < assignment->num_pairs[row]; i++) {
        sum += relative_likelihood(assignment->pairs[row][i].cost, least_cost);
    }
    return sum;
}

/* Probability that a plot (column) belongs to this track (row) and not to another track. */
static float track_share_of_plot(const struct rho_assignment *assignment, unsigned row,
                                 int16_t column, int32_t cost)
{
    float others = 0.0f;
    for (unsigned other = 0; other < assignment->num_rows; other++) {
        for (unsigned i = 0; other != row && i < assignment->num_pairs[other]; i++) {
            if (assignment->pairs[other][i].column == column) {
                others += relative_likelihood(assignment->pairs[other][i].cost, cost);
            }
        }
    }
    return 1.0f / (1.0f + others);
}

int rho_tracker_evidence_of(const struct rho_tracker *tracker, unsigned track,
                            struct rho_tracker_evidence *evidence)
{
    if (!RHO_KEEPS_OFFERS || !tracker || !evidence || !rho_tracker_is_ready(tracker) ||
        track >= tracker->num_tracks || track >= tracker->assignment.num_rows) {
        return 0;
    }
    const struct rho_assignment *assignment = &tracker->assignment;
    const unsigned offers = assignment->num_pairs[track];
    if (offers == 0 && tracker->tracks[track].time_us != tracker->time_us) {
        return 0; /* a track outside of the scan's field of view was not moved to its time */
    }
    const int32_t least = least_cost_of_track(assignment, track);
    const float sum = sum_of_likelihoods(assignment, track, least);
    *evidence = (struct rho_tracker_evidence){.clutter = relative_likelihood(0, least) / sum};
    for (unsigned i = 0; i < offers; i++) {
        const struct rho_assignment_pair *offer = &assignment->pairs[track][i];
        const float own = relative_likelihood(offer->cost, least) / sum;
        const float share = track_share_of_plot(assignment, track, offer->column, offer->cost);
        evidence->support += own * share;
        evidence->shared += own * (1.0f - share);
    }
    return 1;
}
