/* SPDX-License-Identifier: MIT */
/* track_evidence: probabilities that a track's plots are its own, are shared, or are clutter. */
#include "look.h"
#include "rhotrack/detail/approx.h"

static float relative_likelihood(int32_t cost, int32_t least)
{
    return rho_exp((float)(least - cost) * 0.001f); /* nat of mnat */
}

/* Probability that a plot (column) belongs to this track (row) and not to another track. */
static float own_share(const struct rho_assignment *assignment, unsigned row, int16_t column,
                       int32_t cost)
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
    int32_t least = 0; /* cost of the likeliest choice; a miss costs 0 */
    for (unsigned i = 0; i < offers; i++) {
        const int32_t cost = assignment->pairs[track][i].cost;
        least = cost < least ? cost : least;
    }
    float sum = relative_likelihood(0, least);
    for (unsigned i = 0; i < offers; i++) {
        sum += relative_likelihood(assignment->pairs[track][i].cost, least);
    }
    *evidence = (struct rho_tracker_evidence){.clutter = relative_likelihood(0, least) / sum};
    for (unsigned i = 0; i < offers; i++) {
        const struct rho_assignment_pair *offer = &assignment->pairs[track][i];
        const float own = relative_likelihood(offer->cost, least) / sum;
        const float share = own_share(assignment, track, offer->column, offer->cost);
        evidence->support += own * share;
        evidence->shared += own * (1.0f - share);
    }
    return 1;
}
