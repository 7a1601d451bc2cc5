/* SPDX-License-Identifier: MIT */
/*
 * passive_candidate_list: the list of candidates for tracks. A candidate that shares most of its
 * bearings with a better one is a duplicate, and is dropped.
 */
#include <string.h>

#include "passive_search.h"
#include "rhotrack/types.h"

#define DUPLICATE_SHARE 0.8f

unsigned rho_passive_count_shared_bearings(const struct rho_passive_search *search,
                                           const struct rho_passive_candidate *a,
                                           const struct rho_passive_candidate *b)
{
    unsigned shared = 0;
    for (unsigned k = 0; k < search->passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < search->passive->batch.num_sensors; s++) {
            shared += a->claim[k][s] != 0 && a->claim[k][s] == b->claim[k][s];
        }
    }
    return shared;
}

/* Whether candidate `other` claims at least DUPLICATE_SHARE of the bearings of `owner`. */
static int shares_most_bearings_of(const struct rho_passive_search *search,
                                   const struct rho_passive_candidate *owner,
                                   const struct rho_passive_candidate *other)
{
    return (float)rho_passive_count_shared_bearings(search, owner, other) >=
           DUPLICATE_SHARE * (float)owner->hits;
}

static int has_better_duplicate(const struct rho_passive_search *search,
                                const struct rho_passive_candidate *candidate)
{
    const struct rho_passive *passive = search->passive;
    for (unsigned i = 0; i < passive->num_candidates; i++) {
        if (passive->candidates[i].score_nat >= candidate->score_nat &&
            shares_most_bearings_of(search, candidate, &passive->candidates[i])) {
            return 1;
        }
    }
    return 0;
}

/* Removes the candidates that share most of their bearings with this one, which is better. */
static void remove_candidates_sharing_most_bearings(struct rho_passive_search *search,
                                                    const struct rho_passive_candidate *candidate)
{
    struct rho_passive *passive = search->passive;
    for (unsigned i = passive->num_candidates; i > 0; i--) {
        if (shares_most_bearings_of(search, &passive->candidates[i - 1u], candidate)) {
            passive->candidates[i - 1u] = passive->candidates[--passive->num_candidates];
            /* cannot overflow: at most one removal for each of 2 passes x 96 lines x 20 fits */
            search->candidates_removed++;
        }
    }
}

/* Adds a candidate to the list; a full list drops its lowest score, or the new candidate. */
static void add_or_replace_lowest_candidate(struct rho_passive_search *search,
                                            const struct rho_passive_candidate *candidate)
{
    struct rho_passive *passive = search->passive;
    if (passive->num_candidates < RHO_MAX_PASSIVE_CANDIDATES) {
        passive->candidates[passive->num_candidates++] = *candidate;
        return;
    }
    unsigned lowest = 0;
    for (unsigned i = 1; i < passive->num_candidates; i++) {
        if (passive->candidates[i].score_nat < passive->candidates[lowest].score_nat) {
            lowest = i;
        }
    }
    passive->work.candidates_dropped = rho_count(passive->work.candidates_dropped, 1);
    search->candidates_removed++;
    if (candidate->score_nat > passive->candidates[lowest].score_nat) {
        passive->candidates[lowest] = *candidate;
    }
}

int rho_passive_offer_if_track(struct rho_passive_search *search,
                               const float state_m[RHO_PASSIVE_STATES])
{
    struct rho_passive_candidate candidate;
    struct rho_passive_score score =
        rho_passive_claim_and_score_nearest(search, state_m, 1, candidate.claim);
    candidate.score_nat = score.score_nat;
    candidate.hits = score.hits;
    memcpy(candidate.state_m, state_m, sizeof candidate.state_m);
    if (score.is_track && !has_better_duplicate(search, &candidate)) {
        remove_candidates_sharing_most_bearings(search, &candidate);
        add_or_replace_lowest_candidate(search, &candidate);
    }
    return score.is_track;
}

void rho_passive_rank_candidates(const struct rho_passive *passive,
                                 uint8_t order[RHO_MAX_PASSIVE_CANDIDATES])
{
    for (unsigned i = 0; i < passive->num_candidates; i++) {
        unsigned place = i;
        for (; place > 0 &&
               passive->candidates[i].score_nat > passive->candidates[order[place - 1u]].score_nat;
             place--) {
            order[place] = order[place - 1u];
        }
        order[place] = (uint8_t)i;
    }
}
