/* SPDX-License-Identifier: MIT */
/*
 * final_tracks: after the first pass the best set of candidates claims its bearings; after the
 * second pass it becomes the tracks of the search. The margin of each: total score of the best set
 * minus that of the best set without its target.
 */
#include <string.h>

#include "passive_search.h"

/*
 * The highest total of a set of tracks without the target of candidate `which`: of the rest, and
 * with each candidate that shares bearings with it. What a joint fit gained is taken to be gained
 * by the others too.
 */
static float total_without_target(const struct rho_passive_search *search,
                                  const struct rho_passive_choice *choice, unsigned which)
{
    const struct rho_passive *passive = search->passive;
    struct rho_passive_choice without = *choice;
    float most_nat = 0.0f;
    rho_passive_exclude_target(&without, which);
    for (unsigned i = 0; i <= choice->count; i++) {
        if (i == choice->count || (!without.is_out[i] && passive->shared[RHO_AT(which, i)] > 0)) {
            struct rho_passive_choice tried = without;
            rho_passive_add_gaining(&tried, i);
            rho_passive_improve_choice(&tried);
            most_nat = rho_larger(most_nat, tried.total_nat);
        }
    }
    return most_nat + passive->best.total_nat - choice->total_nat;
}

/* Margins of the new tracks of the best set. */
static void find_margins(const struct rho_passive_search *search,
                         const struct rho_passive_choice *choice,
                         float margins_nat[RHO_MAX_PASSIVE_TRACKS])
{
    const struct rho_passive_set *best = &search->passive->best;
    for (unsigned t = 0; t < best->num; t++) {
        if (best->tracks[t].known == 0) {
            const float less_nat = total_without_target(search, choice, best->candidate[t]);
            margins_nat[t] = rho_larger(best->total_nat - less_nat, 0.0f);
        }
    }
}

void rho_passive_claim_best_set(struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    struct rho_passive_choice choice;
    rho_passive_choose(search, &choice);
    rho_passive_fit_jointly(search, &choice, &passive->best);
    for (unsigned i = 0; i < passive->best.num; i++) {
        rho_passive_mark_claims(passive, &passive->best.tracks[i], RHO_PASSIVE_CLAIMED);
    }
}

static int32_t nat_to_mnat(float nat)
{
    return (int32_t)(1000.0f * nat);
}

void rho_passive_select_tracks(struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    const struct rho_passive_set *best = &passive->best;
    float margins_nat[RHO_MAX_PASSIVE_TRACKS] = {0};
    struct rho_passive_choice choice;
    rho_passive_choose(search, &choice);
    rho_passive_fit_jointly(search, &choice, &passive->best);
    find_margins(search, &choice, margins_nat);
    passive->num_tracks = 0;
    for (uint32_t i = 0; i < search->num_known; i++) {
        search->known[i].is_beaten = !search->known[i].is_safe;
    }
    for (unsigned i = 0; i < best->num; i++) {
        if (best->tracks[i].known > 0) {
            search->known[best->tracks[i].known - 1u].is_beaten = 0;
            continue;
        }
        struct rho_passive_track *track = &passive->tracks[passive->num_tracks];
        memcpy(track->claim, best->tracks[i].claim, sizeof track->claim);
        if (!rho_passive_estimate_track(search, &best->tracks[i], track)) {
            continue; /* its covariance cannot be computed */
        }
        track->score_mnat = nat_to_mnat(best->tracks[i].score_nat);
        track->margin_mnat = nat_to_mnat(margins_nat[i]);
        track->prior_nat = rho_passive_prior_nat(search, &best->tracks[i]);
        track->chi2 = best->chi2[i];
        track->hits = (uint16_t)best->tracks[i].hits;
        track->scans = 0;
        for (unsigned k = 0; k < passive->batch.num_scans; k++) {
            for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
                track->scans = (uint16_t)(track->scans | (unsigned)(track->claim[k][s] > 0) << k);
            }
        }
        passive->num_tracks++;
    }
    /* by score, best first: the joint fit has changed the order of the scores */
    for (unsigned i = 1; i < passive->num_tracks; i++) {
        struct rho_passive_track track = passive->tracks[i];
        unsigned place = i;
        for (; place > 0 && track.score_mnat > passive->tracks[place - 1u].score_mnat; place--) {
            passive->tracks[place] = passive->tracks[place - 1u];
        }
        passive->tracks[place] = track;
    }
}
