/* SPDX-License-Identifier: MIT */
/*
 * joint_fit: fits several tracks together. The bearings of each look are assigned to the tracks one
 * to one, for a high total score; each track is fitted to its own; both steps are repeated.
 */

#include "passive_search.h"
#include "policy.h"

/*
 * Assigns the bearings of a look: again and again the free track and the free bearing that gain
 * most. Known tracks keep theirs.
 */
static void assign_look(const struct rho_passive_search *search, struct rho_passive_set *set,
                        unsigned scan, unsigned sensor)
{
    const struct rho_passive *passive = search->passive;
    const unsigned num = passive->batch.num_bearings[scan][sensor];
    float gain_nat[RHO_MAX_PASSIVE_TRACKS][RHO_MAX_BEARINGS] = {{0.0f}};
    uint8_t is_taken[RHO_MAX_BEARINGS + 1] = {0}; /* by claims: indices from 1; 0: none */
    for (unsigned t = 0; t < set->num; t++) {
        uint8_t *claim = &set->tracks[t].claim[scan][sensor];
        *claim = set->tracks[t].known > 0 ? *claim : 0;
        is_taken[*claim] = 1;
        for (unsigned i = 0; i < num && set->tracks[t].known == 0; i++) {
            if (passive->is_claimed[scan][sensor][i] != RHO_PASSIVE_BLOCKED) {
                gain_nat[t][i] =
                    rho_passive_gain_nat(search, set->tracks[t].state_m, scan, sensor, i + 1u);
            }
        }
    }
    for (float most_nat = 1.0f; most_nat > 0.0f;) {
        unsigned track = 0, bearing = 0;
        most_nat = 0.0f;
        for (unsigned t = 0; t < set->num; t++) {
            for (unsigned i = 0; i < num && set->tracks[t].claim[scan][sensor] == 0; i++) {
                if (!is_taken[i + 1u] && gain_nat[t][i] > most_nat) {
                    most_nat = gain_nat[t][i];
                    track = t;
                    bearing = i + 1u;
                }
            }
        }
        if (bearing > 0) {
            set->tracks[track].claim[scan][sensor] = (uint8_t)bearing;
            is_taken[bearing] = 1;
        }
    }
}

/* Drops the member with the lowest score that is no track. Returns 0 where all are tracks. */
static int drop_worst_non_track(struct rho_passive_set *set)
{
    unsigned worst = set->num;
    for (unsigned t = 0; t < set->num; t++) {
        if (!set->is_track[t] &&
            (worst == set->num || set->tracks[t].score_nat < set->tracks[worst].score_nat)) {
            worst = t;
        }
    }
    if (worst == set->num) {
        return 0;
    }
    set->num--;
    for (unsigned t = worst; t < set->num; t++) {
        set->tracks[t] = set->tracks[t + 1];
        set->candidate[t] = set->candidate[t + 1];
    }
    return 1;
}

/* Assigns all bearings, fits the set and drops its worst member until all members are tracks. */
static void fit_set(const struct rho_passive_search *search, struct rho_passive_set *set)
{
    const struct rho_batch *batch = &search->passive->batch;
    do {
        for (unsigned round = 0; round < FIT_ROUNDS; round++) {
            for (unsigned k = 0; k < batch->num_scans; k++) {
                for (unsigned s = 0; s < batch->num_sensors; s++) {
                    assign_look(search, set, k, s);
                }
            }
            for (unsigned t = 0; t < set->num; t++) {
                if (set->tracks[t].known == 0) {
                    (void)rho_passive_step_to_claims(search, &set->tracks[t]);
                }
            }
        }
        set->total_nat = 0.0f;
        for (unsigned t = 0; t < set->num; t++) {
            set->is_track[t] = set->tracks[t].known > 0 ||
                               rho_passive_score_claimed(search, &set->tracks[t], &set->chi2[t]);
            set->total_nat += set->tracks[t].score_nat;
        }
    } while (drop_worst_non_track(set));
}

void rho_passive_mark_claims(struct rho_passive *passive, const struct rho_passive_candidate *track,
                             uint8_t is_claimed)
{
    for (unsigned k = 0; k < passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
            if (track->claim[k][s] > 0) {
                passive->is_claimed[k][s][track->claim[k][s] - 1u] = is_claimed;
            }
        }
    }
}

void rho_passive_fit_jointly(const struct rho_passive_search *search,
                             const struct rho_passive_choice *choice, struct rho_passive_set *set)
{
    struct rho_passive *passive = search->passive;
    uint8_t order[RHO_MAX_PASSIVE_CANDIDATES] = {0};
    rho_passive_rank_candidates(passive, order);
    set->num = 0;
    for (unsigned i = 0; i < 2u * choice->count; i++) { /* known tracks first */
        const uint8_t at = order[i < choice->count ? i : i - choice->count];
        if (!choice->is_in[at] || (passive->candidates[at].known > 0) != (i < choice->count)) {
            continue;
        }
        if (set->num == RHO_MAX_PASSIVE_TRACKS) {
            passive->work.candidates_dropped = rho_count(passive->work.candidates_dropped, 1);
        } else {
            set->tracks[set->num] = passive->candidates[at];
            set->candidate[set->num++] = at;
        }
    }
    fit_set(search, set);
}
