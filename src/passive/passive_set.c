/* SPDX-License-Identifier: MIT */
/*
 * passive_set: tracks fitted together. Each look gives its bearings out so that the scores gain most, one to a track; then
 * each track is fitted to its own, and again.
 */
#include <string.h>

#include "passive_search.h"
#include "rhotrack/types.h"

#define ROUNDS 3
#define EXCHANGES_MAX (2 * RHO_MAX_PASSIVE_TRACKS)
#define OTHERS_NAT 20.0f /* worse by the choice's reckoning: not looked at closely */
#define OTHERS_MAX 4u    /* looked at closely, for each track */
#define NONE_NAT (-1.0e9f)
#define CHANGES_MAX 4

/* ---- one look --------------------------------------------------------------------------------- */

/* Who gets which bearing (from 1; 0: none), and what each would gain. */
struct look {
    unsigned num_tracks, num_bearings;
    float gain_nat[RHO_MAX_PASSIVE_TRACKS][RHO_MAX_BEARINGS + 1];
    uint8_t claim[RHO_MAX_PASSIVE_TRACKS];
    uint8_t is_taken[RHO_MAX_BEARINGS + 1];
};

static void open_look(const struct rho_passive_search *search, const struct rho_passive_set *set,
                      unsigned scan, unsigned sensor, struct look *look)
{
    memset(look, 0, sizeof *look);
    look->num_tracks = set->num;
    look->num_bearings = search->passive->batch.num_bearings[scan][sensor];
    for (unsigned t = 0; t < look->num_tracks; t++) {
        for (unsigned i = 1; i <= look->num_bearings; i++) {
            look->gain_nat[t][i] =
                rho_passive_gain(search, set->tracks[t].state_m, scan, sensor, i);
        }
    }
}

static void give(struct look *look, unsigned track, unsigned bearing)
{
    look->is_taken[look->claim[track]] = 0;
    look->claim[track] = (uint8_t)bearing;
    look->is_taken[bearing] = bearing > 0;
}

/* The bearing that gains most of those that are free, 0 where none gains. */
static unsigned best_free(const struct look *look, unsigned track)
{
    unsigned best = 0;
    for (unsigned i = 1; i <= look->num_bearings; i++) {
        if (!look->is_taken[i] && look->gain_nat[track][i] > look->gain_nat[track][best]) {
            best = i;
        }
    }
    return best;
}

/* The largest gain first. */
static void give_out(struct look *look)
{
    for (unsigned given = 0; given < look->num_tracks; given++) {
        unsigned who = look->num_tracks, what = 0;
        float most_nat = 0.0f;
        for (unsigned t = 0; t < look->num_tracks; t++) {
            unsigned i = look->claim[t] ? 0 : best_free(look, t);
            if (look->gain_nat[t][i] > most_nat) {
                most_nat = look->gain_nat[t][i];
                who = t;
                what = i;
            }
        }
        if (who == look->num_tracks) {
            return;
        }
        give(look, who, what);
    }
}

/* One takes the other's bearing, which takes the best of what is free then. Returns whether that gains. */
static int exchange(struct look *look, unsigned taker, unsigned loser)
{
    unsigned kept = look->claim[taker], wanted = look->claim[loser];
    float before_nat = look->gain_nat[taker][kept] + look->gain_nat[loser][wanted];
    if (!(look->gain_nat[taker][wanted] > 0.0f)) {
        return 0;
    }
    give(look, loser, 0);
    give(look, taker, wanted);
    give(look, loser, best_free(look, loser));
    float after_nat = look->gain_nat[taker][wanted] + look->gain_nat[loser][look->claim[loser]];
    if (after_nat > before_nat + RHO_PASSIVE_GAIN_MIN_NAT) {
        return 1;
    }
    give(look, loser, 0);
    give(look, taker, kept);
    give(look, loser, wanted);
    return 0;
}

static int exchange_any(struct look *look)
{
    for (unsigned taker = 0; taker < look->num_tracks; taker++) {
        for (unsigned loser = 0; loser < look->num_tracks; loser++) {
            if (taker != loser && look->claim[loser] > 0 && exchange(look, taker, loser)) {
                return 1;
            }
        }
    }
    return 0;
}

static void assign_look(const struct rho_passive_search *search, struct rho_passive_set *set,
                        unsigned scan, unsigned sensor)
{
    struct look look;
    open_look(search, set, scan, sensor, &look);
    give_out(&look);
    for (unsigned i = 0; i < EXCHANGES_MAX && exchange_any(&look); i++) {
    }
    for (unsigned t = 0; t < set->num; t++) {
        set->tracks[t].claim[scan][sensor] = look.claim[t];
    }
}

/* ---- all looks -------------------------------------------------------------------------------- */

static void assign(const struct rho_passive_search *search, struct rho_passive_set *set)
{
    for (unsigned k = 0; k < search->passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < search->passive->batch.num_sensors; s++) {
            assign_look(search, set, k, s);
        }
    }
}

static void judge(const struct rho_passive_search *search, struct rho_passive_set *set)
{
    set->total_nat = 0.0f;
    for (unsigned t = 0; t < set->num; t++) {
        struct rho_passive_candidate *track = &set->tracks[t];
        struct rho_passive_judgement judgement = rho_passive_judge_claimed(
            search, track->state_m, (rho_passive_const_claim *)track->claim);
        track->score_nat = judgement.score_nat;
        track->hits = judgement.hits;
        set->chi2[t] = judgement.chi2;
        set->is_track[t] = (uint8_t)judgement.is_track;
        set->total_nat += judgement.score_nat;
    }
}

static void refine(const struct rho_passive_search *search, struct rho_passive_set *set)
{
    for (unsigned round = 0; round < ROUNDS; round++) {
        assign(search, set);
        for (unsigned t = 0; t < set->num; t++) {
            struct rho_passive_candidate *track = &set->tracks[t];
            rho_passive_fit_claimed(search, track->state_m,
                                    (rho_passive_const_claim *)track->claim);
        }
    }
    judge(search, set);
}

/* The worst of those that are no tracks goes. Returns whether there was one. */
static int drop_worst(struct rho_passive_set *set)
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

static void fill(const struct rho_passive_search *search, const struct rho_passive_choice *choice,
                 struct rho_passive_set *set)
{
    struct rho_passive *passive = search->passive;
    uint8_t order[RHO_MAX_PASSIVE_CANDIDATES] = {0};
    rho_passive_rank(passive, order);
    set->num = 0;
    for (unsigned i = 0; i < choice->count; i++) {
        if (!choice->is_in[order[i]]) {
            continue;
        }
        if (set->num == RHO_MAX_PASSIVE_TRACKS) {
            passive->work.candidates_dropped = rho_count(passive->work.candidates_dropped, 1);
            continue;
        }
        set->tracks[set->num] = passive->candidates[order[i]];
        set->candidate[set->num++] = order[i];
    }
}

static void settle(const struct rho_passive_search *search, struct rho_passive_set *set)
{
    do {
        refine(search, set);
    } while (drop_worst(set));
}

static void claim(struct rho_passive *passive, rho_passive_const_claim *claims, uint8_t is_claimed)
{
    for (unsigned k = 0; k < passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
            if (claims[k][s] > 0) {
                passive->is_claimed[k][s][claims[k][s] - 1u] = is_claimed;
            }
        }
    }
}

/* Each is fitted to the nearest bearings that better ones have left. */
static void fit_in_turn(const struct rho_passive_search *search, struct rho_passive_set *set)
{
    for (unsigned t = 0; t < set->num; t++) {
        struct rho_passive_candidate *track = &set->tracks[t];
        rho_passive_fit(search, track->state_m, 0);
        (void)rho_passive_judge(search, track->state_m, 0, track->claim);
        claim(search->passive, (rho_passive_const_claim *)track->claim, 1);
    }
    for (unsigned t = 0; t < set->num; t++) {
        claim(search->passive, (rho_passive_const_claim *)set->tracks[t].claim, 0);
    }
}

/* Giving out and fitting by turns ends where it began near; two beginnings are better than one. */
void rho_passive_gather(const struct rho_passive_search *search,
                        const struct rho_passive_choice *choice, struct rho_passive_set *set)
{
    struct rho_passive_set *spare = &search->passive->spare;
    fill(search, choice, set);
    *spare = *set;
    settle(search, set);
    fit_in_turn(search, spare);
    settle(search, spare);
    if (spare->total_nat > set->total_nat + RHO_PASSIVE_GAIN_MIN_NAT) {
        *set = *spare;
    }
}

void rho_passive_claim_best(struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    struct rho_passive_choice choice;
    rho_passive_choose(search, &choice);
    rho_passive_gather(search, &choice, &passive->best);
    for (unsigned i = 0; i < passive->best.num; i++) {
        claim(passive, (rho_passive_const_claim *)passive->best.tracks[i].claim, 1);
    }
}

/* ---- other sets ------------------------------------------------------------------------------- */

/* Choices without a candidate and its kin, by what is in its place; last: nothing. */
struct others {
    struct rho_passive_choice without;
    float total_nat[RHO_MAX_PASSIVE_CANDIDATES +
                    1]; /* by the choice's reckoning; NONE_NAT: none, or done with */
};

static void list_others(const struct rho_passive *passive, const struct rho_passive_choice *choice,
                        unsigned which, struct others *others)
{
    others->without = *choice;
    rho_passive_bar(&others->without, which);
    for (unsigned i = 0; i <= choice->count; i++) {
        others->total_nat[i] = NONE_NAT;
        if (i == choice->count || (!others->without.is_out[i] && passive->shared[which][i] > 0)) {
            struct rho_passive_choice tried = others->without;
            rho_passive_force(&tried, i);
            rho_passive_improve(&tried);
            others->total_nat[i] = tried.total_nat;
        }
    }
}

static unsigned best_of(const struct others *others)
{
    unsigned best = 0;
    for (unsigned i = 1; i <= others->without.count; i++) {
        if (others->total_nat[i] > others->total_nat[best]) {
            best = i;
        }
    }
    return best;
}

/*
 * The most that any set is worth without the candidate and its kin. More than the best: where it may, it becomes the best,
 * and its choice the choice. Sets that are far worse by the choice's reckoning count as that says.
 */
static float best_without(const struct rho_passive_search *search,
                          struct rho_passive_choice *choice, unsigned which, int may_change)
{
    struct rho_passive *passive = search->passive;
    float most_nat = NONE_NAT, off_nat = passive->best.total_nat - choice->total_nat;
    struct others others;
    list_others(passive, choice, which, &others);
    for (unsigned looked = 0; looked < OTHERS_MAX; looked++) {
        unsigned best = best_of(&others);
        if (others.total_nat[best] < choice->total_nat - OTHERS_NAT) {
            break;
        }
        struct rho_passive_choice tried = others.without;
        rho_passive_force(&tried, best);
        rho_passive_improve(&tried);
        rho_passive_gather(search, &tried, &passive->other);
        others.total_nat[best] = NONE_NAT;
        most_nat = passive->other.total_nat > most_nat ? passive->other.total_nat : most_nat;
        if (may_change && most_nat > passive->best.total_nat + RHO_PASSIVE_GAIN_MIN_NAT) {
            passive->best = passive->other;
            *choice = tried;
            memset(choice->is_out, 0, sizeof choice->is_out);
            return most_nat;
        }
    }
    float left_nat = others.total_nat[best_of(&others)] + off_nat;
    return left_nat > most_nat ? left_nat : most_nat;
}

/* Margins are all of one set: where another is better they begin anew with it, and in the end no other one is let in. */
void rho_passive_weigh(const struct rho_passive_search *search, struct rho_passive_choice *choice,
                       float margins_nat[RHO_MAX_PASSIVE_TRACKS])
{
    const struct rho_passive_set *best = &search->passive->best;
    unsigned changes = 0;
    for (unsigned t = 0; t < best->num;) {
        float total_nat = best->total_nat;
        float margin_nat =
            total_nat - best_without(search, choice, best->candidate[t], changes < CHANGES_MAX);
        if (best->total_nat > total_nat) {
            changes++;
            t = 0;
        } else {
            margins_nat[t++] = margin_nat > 0.0f ? margin_nat : 0.0f;
        }
    }
}
