/* SPDX-License-Identifier: MIT */
/*
 * final_tracks: after the first pass the best set of candidates claims its
 * bearings; after the second pass the best set becomes the tracks of the search. The margin of each
 * track: total score of the best set of tracks minus that of the best set without this track. A set
 * with a higher total that is found becomes the best set.
 */
#include <string.h>

#include "passive_search.h"
#include "policy.h"
#include "rhotrack/types.h"

static const float none_nat = -1.0e9f;

/* Choices without a candidate's target: alternative i has candidate i instead, the last none. */
struct alternatives {
    struct rho_passive_choice without;
    /* total score of each alternative; none_nat: no such alternative, or already fitted */
    float total_nat[RHO_MAX_PASSIVE_CANDIDATES + 1];
};

static unsigned best_alternative(const struct alternatives *alternatives)
{
    unsigned best = 0;
    for (unsigned i = 1; i <= alternatives->without.count; i++) {
        if (alternatives->total_nat[i] > alternatives->total_nat[best]) {
            best = i;
        }
    }
    return best;
}

/*
 * The highest total of a set of tracks without the target of candidate `which`. With
 * may_replace_best, a set that exceeds passive->best replaces it, and its choice replaces *choice.
 * Alternatives beyond ALTERNATIVES_MAX are not fitted; the total of their choice is taken.
 */
static float best_total_without_target(const struct rho_passive_search *search,
                                       struct rho_passive_choice *choice, unsigned which,
                                       int may_replace_best)
{
    struct rho_passive *passive = search->passive;
    float most_nat = none_nat, fit_nat = passive->best.total_nat - choice->total_nat;
    struct alternatives alternatives = {.without = *choice};
    rho_passive_exclude_target(&alternatives.without, which);
    for (unsigned i = 0; i <= choice->count; i++) {
        alternatives.total_nat[i] = none_nat;
        if (i == choice->count ||
            (!alternatives.without.is_out[i] && passive->shared[which][i] > 0)) {
            struct rho_passive_choice tried = alternatives.without;
            rho_passive_add_gaining(&tried, i);
            rho_passive_improve_choice(&tried);
            alternatives.total_nat[i] = tried.total_nat;
        }
    }
    for (unsigned n = 0; n < ALTERNATIVES_MAX; n++) {
        unsigned best = best_alternative(&alternatives);
        if (alternatives.total_nat[best] < choice->total_nat - ALTERNATIVES_WITHIN_NAT) {
            break;
        }
        struct rho_passive_choice tried = alternatives.without;
        rho_passive_add_gaining(&tried, best);
        rho_passive_improve_choice(&tried);
        rho_passive_fit_jointly(search, &tried, &passive->other);
        alternatives.total_nat[best] = none_nat;
        most_nat = passive->other.total_nat > most_nat ? passive->other.total_nat : most_nat;
        if (may_replace_best && most_nat > passive->best.total_nat + GAIN_MIN_NAT) {
            passive->best = passive->other;
            *choice = tried;
            memset(choice->is_out, 0, sizeof choice->is_out);
            return most_nat;
        }
    }
    float unfitted_nat = alternatives.total_nat[best_alternative(&alternatives)] + fit_nat;
    return unfitted_nat > most_nat ? unfitted_nat : most_nat;
}

/*
 * Finds the margin of each track. All margins refer to one best set: they are computed anew when
 * another set becomes the best, which happens at most CHANGES_MAX times.
 */
static void find_margins(const struct rho_passive_search *search, struct rho_passive_choice *choice,
                         float margins_nat[RHO_MAX_PASSIVE_TRACKS])
{
    const struct rho_passive_set *best = &search->passive->best;
    unsigned changes = 0;
    for (unsigned t = 0; t < best->num;) {
        if (best->tracks[t].known > 0) {
            margins_nat[t++] = 0.0f;
            continue;
        }
        float total_nat = best->total_nat;
        float margin_nat = total_nat - best_total_without_target(search, choice, best->candidate[t],
                                                                 changes < CHANGES_MAX);
        if (best->total_nat > total_nat) {
            changes++;
            t = 0;
        } else {
            margins_nat[t++] = margin_nat > 0.0f ? margin_nat : 0.0f;
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
        rho_passive_mark_claims(passive, &passive->best.tracks[i], 1);
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
