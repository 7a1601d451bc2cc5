/* SPDX-License-Identifier: MIT */
/*
 * candidate_list: the list of candidates for tracks. A candidate that shares most of its
 * bearings with a better one is a duplicate, and is dropped.
 */
#include <string.h>

#include "passive_search.h"
#include "policy.h"

unsigned rho_passive_count_shared(const struct rho_passive_search *search,
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
static int shares_most_of(const struct rho_passive_search *search,
                          const struct rho_passive_candidate *owner,
                          const struct rho_passive_candidate *other)
{
    return (float)rho_passive_count_shared(search, owner, other) >=
           DUPLICATE_SHARE * (float)owner->hits;
}

void rho_passive_offer_if_track(struct rho_passive_search *search,
                                const float state_m[RHO_PASSIVE_STATES])
{
    struct rho_passive_candidate candidate = {.known = 0};
    float chi2;
    memcpy(candidate.state_m, state_m, sizeof candidate.state_m);
    rho_passive_claim_nearest(search, RHO_PASSIVE_ALSO_CLAIMED | RHO_PASSIVE_BY_SLOPE, &candidate);
    if (!rho_passive_score_claimed(search, &candidate, &chi2)) {
        return;
    }
    struct rho_passive *passive = search->passive;
    struct rho_passive_candidate *list = passive->candidates;
    for (unsigned i = 0; i < passive->num_candidates; i++) {
        if ((list[i].known > 0 || list[i].score_nat >= candidate.score_nat) &&
            shares_most_of(search, &candidate, &list[i])) {
            return; /* a better duplicate is there */
        }
    }
    for (unsigned i = passive->num_candidates; i > 0; i--) {
        if (list[i - 1u].known == 0 && shares_most_of(search, &list[i - 1u], &candidate)) {
            list[i - 1u] = list[--passive->num_candidates];
        }
    }
    if (passive->num_candidates < RHO_MAX_PASSIVE_CANDIDATES) {
        list[passive->num_candidates++] = candidate;
        return;
    }
    /* a full list drops its lowest score, or the new candidate */
    unsigned lowest = 0;
    for (unsigned i = 1; i < passive->num_candidates; i++) {
        lowest = list[lowest].known > 0 ||
                         (list[i].known == 0 && list[i].score_nat < list[lowest].score_nat)
                     ? i
                     : lowest;
    }
    passive->work.candidates_dropped = rho_count(passive->work.candidates_dropped, 1);
    if (candidate.score_nat > list[lowest].score_nat) {
        list[lowest] = candidate;
    }
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
