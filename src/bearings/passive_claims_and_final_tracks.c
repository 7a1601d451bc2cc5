/* SPDX-License-Identifier: MIT */
/*
 * passive_claims_and_final_tracks: after the first pass the best set of candidates claims its
 * bearings; after the second pass the best set becomes the tracks of the search.
 */
#include <string.h>

#include "passive_search.h"
#include "rhotrack/types.h"

void rho_passive_claim_best_set(struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    struct rho_passive_choice choice;
    rho_passive_choose_candidates(search, &choice);
    rho_passive_fit_jointly(search, &choice, &passive->best);
    for (unsigned i = 0; i < passive->best.num; i++) {
        rho_passive_mark_claims(passive, (rho_passive_const_claim *)passive->best.tracks[i].claim,
                                1);
    }
}

static void set_mask_of_claimed_scans(const struct rho_passive *passive,
                                      struct rho_passive_track *track)
{
    track->scans = 0;
    for (unsigned k = 0; k < passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
            if (track->claim[k][s] > 0) {
                track->scans = (uint16_t)(track->scans | 1u << k);
            }
        }
    }
}

static int32_t nat_to_mnat(float nat)
{
    return (int32_t)(1000.0f * nat);
}

/* Adds a member of the best set to the tracks, unless its covariance cannot be computed. */
static void add_track_of_best_set(struct rho_passive_search *search, unsigned number,
                                  float margin_nat)
{
    struct rho_passive *passive = search->passive;
    const struct rho_passive_candidate *from = &passive->best.tracks[number];
    struct rho_passive_track *track = &passive->tracks[passive->num_tracks];
    memcpy(track->claim, from->claim, sizeof track->claim);
    if (!rho_passive_estimate_track(search, from->state_m, track)) {
        return;
    }
    track->score_mnat = nat_to_mnat(from->score_nat);
    track->margin_mnat = nat_to_mnat(margin_nat);
    track->chi2 = passive->best.chi2[number];
    track->hits = (uint16_t)from->hits;
    set_mask_of_claimed_scans(passive, track);
    passive->num_tracks++;
}

/* Sorts the tracks by score, best first: the joint fit has changed the order of the scores. */
static void sort_tracks(struct rho_passive *passive)
{
    for (unsigned i = 1; i < passive->num_tracks; i++) {
        struct rho_passive_track track = passive->tracks[i];
        unsigned place = i;
        for (; place > 0 && track.score_mnat > passive->tracks[place - 1u].score_mnat; place--) {
            passive->tracks[place] = passive->tracks[place - 1u];
        }
        passive->tracks[place] = track;
    }
}

void rho_passive_select_tracks(struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    float margins_nat[RHO_MAX_PASSIVE_TRACKS] = {0};
    struct rho_passive_choice choice;
    rho_passive_choose_candidates(search, &choice);
    rho_passive_fit_jointly(search, &choice, &passive->best);
    rho_passive_find_margins_and_improve(search, &choice, margins_nat);
    passive->num_tracks = 0;
    for (unsigned i = 0; i < passive->best.num; i++) {
        add_track_of_best_set(search, i, margins_nat[i]);
    }
    sort_tracks(passive);
}
