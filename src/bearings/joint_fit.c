/* SPDX-License-Identifier: MIT */
/*
 * joint_fit: fits several tracks together. The bearings of each look are
 * assigned to the tracks one to one, for a high total score; each track is fitted to its own
 * bearings; both steps are repeated.
 */
#include <string.h>

#include "passive_search.h"
#include "policy.h"
#include "rhotrack/types.h"

/*
 * Assignment of the bearings of one look to tracks: the bearing of each track (index from 1; 0:
 * none), and the score gain of each pair of track and bearing.
 */
struct look_assignment {
    unsigned num_tracks, num_bearings;
    float gain_nat[RHO_MAX_PASSIVE_TRACKS][RHO_MAX_BEARINGS + 1];
    uint8_t claim[RHO_MAX_PASSIVE_TRACKS];
    uint8_t is_taken[RHO_MAX_BEARINGS + 1];
};

static void assign_bearing(struct look_assignment *look, unsigned track, unsigned bearing)
{
    look->is_taken[look->claim[track]] = 0;
    look->claim[track] = (uint8_t)bearing;
    look->is_taken[bearing] = bearing > 0;
}

/* The unassigned bearing of the look that gains most for a track; 0: no bearing gains. */
static unsigned best_free_bearing(const struct look_assignment *look, unsigned track)
{
    unsigned best = 0;
    for (unsigned i = 1; i <= look->num_bearings; i++) {
        if (!look->is_taken[i] && look->gain_nat[track][i] > look->gain_nat[track][best]) {
            best = i;
        }
    }
    return best;
}

/* Greedy assignment: repeatedly the pair of free track and free bearing with the largest gain. */
static void assign_greedily(struct look_assignment *look)
{
    for (unsigned n = 0; n < look->num_tracks; n++) {
        unsigned track = look->num_tracks, bearing = 0;
        float most_nat = 0.0f;
        for (unsigned t = 0; t < look->num_tracks; t++) {
            unsigned i = look->claim[t] ? 0 : best_free_bearing(look, t);
            if (look->gain_nat[t][i] > most_nat) {
                most_nat = look->gain_nat[t][i];
                track = t;
                bearing = i;
            }
        }
        if (track == look->num_tracks) {
            return;
        }
        assign_bearing(look, track, bearing);
    }
}

/*
 * Gives the bearing of track `loser` to track `taker`, and the best free bearing to the loser. If
 * the total gain does not grow, that is undone, and 0 is returned.
 */
static int take_over_bearing(struct look_assignment *look, unsigned taker, unsigned loser)
{
    unsigned kept = look->claim[taker], wanted = look->claim[loser];
    float before_nat = look->gain_nat[taker][kept] + look->gain_nat[loser][wanted];
    if (!(look->gain_nat[taker][wanted] > 0.0f)) {
        return 0;
    }
    assign_bearing(look, loser, 0);
    assign_bearing(look, taker, wanted);
    assign_bearing(look, loser, best_free_bearing(look, loser));
    float after_nat = look->gain_nat[taker][wanted] + look->gain_nat[loser][look->claim[loser]];
    if (after_nat > before_nat + GAIN_MIN_NAT) {
        return 1;
    }
    assign_bearing(look, loser, 0);
    assign_bearing(look, taker, kept);
    assign_bearing(look, loser, wanted);
    return 0;
}

static void assign_look(const struct rho_passive_search *search, struct rho_passive_set *set,
                        unsigned scan, unsigned sensor)
{
    struct look_assignment look = {.num_tracks = set->num};
    look.num_bearings = search->passive->batch.num_bearings[scan][sensor];
    for (unsigned t = 0; t < look.num_tracks; t++) {
        const int is_known = set->tracks[t].known > 0;
        for (unsigned i = 1; i <= look.num_bearings && !is_known; i++) {
            look.gain_nat[t][i] =
                search->passive->is_claimed[scan][sensor][i - 1u] == RHO_PASSIVE_BLOCKED
                    ? 0.0f
                    : rho_passive_gain_nat(search, set->tracks[t].state_m, scan, sensor, i);
        }
        if (is_known) { /* keeps its bearings */
            assign_bearing(&look, t, set->tracks[t].claim[scan][sensor]);
        }
    }
    assign_greedily(&look);
    int is_better = 1;
    for (unsigned n = 0; n < 2u * RHO_MAX_PASSIVE_TRACKS && is_better; n++) { /* exchanges */
        is_better = 0;
        for (unsigned taker = 0; taker < look.num_tracks && !is_better; taker++) {
            for (unsigned loser = 0; loser < look.num_tracks && !is_better; loser++) {
                is_better = taker != loser && look.claim[loser] > 0 &&
                            set->tracks[loser].known == 0 &&
                            take_over_bearing(&look, taker, loser);
            }
        }
    }
    for (unsigned t = 0; t < set->num; t++) {
        set->tracks[t].claim[scan][sensor] = look.claim[t];
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
                    rho_passive_step_to_claims(search, &set->tracks[t]);
                }
            }
        }
        set->total_nat = 0.0f;
        for (unsigned t = 0; t < set->num; t++) {
            set->is_track[t] =
                set->tracks[t].known > 0 ||
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

/*
 * Alternating assignment and fit ends in a local optimum near its start. So there are two starts,
 * and the result with the higher total is kept: the candidates, and the tracks fitted one after the
 * other, best first, each to the nearest bearings that no earlier track has claimed.
 */
void rho_passive_fit_jointly(const struct rho_passive_search *search,
                             const struct rho_passive_choice *choice, struct rho_passive_set *set)
{
    struct rho_passive *passive = search->passive;
    uint8_t order[RHO_MAX_PASSIVE_CANDIDATES] = {0};
    rho_passive_rank_candidates(passive, order);
    set->num = 0;
    for (unsigned i = 0; i < choice->count; i++) {
        if (choice->is_in[order[i]] && set->num == RHO_MAX_PASSIVE_TRACKS) {
            passive->work.candidates_dropped = rho_count(passive->work.candidates_dropped, 1);
        } else if (choice->is_in[order[i]]) {
            set->tracks[set->num] = passive->candidates[order[i]];
            set->candidate[set->num++] = order[i];
        }
    }
    fit_set(search, set);
}
