/* SPDX-License-Identifier: MIT */
/*
 * passive_choose: which candidates are tracks together. The sum of the chosen ones' scores, less share_nat for every bearing
 * that two of them claim, is maximised: the best subset is sought by adding the candidate that gains most, from several
 * starts, and by leaving one out and filling up again.
 */
#include <string.h>

#include "passive_search.h"

#define STARTS 12u
#define KIN_SHARE 0.7f

/* ---- joint selection -------------------------------------------------------------------------- */

static void start_choice(struct rho_passive_choice *choice, const struct rho_passive_search *search)
{
    memset(choice, 0, sizeof *choice);
    choice->search = search;
    choice->count = search->passive->num_candidates;
    for (unsigned i = 0; i < choice->count; i++) {
        choice->gain_nat[i] = search->passive->candidates[i].score_nat;
    }
}

/* Puts one in or takes it out. */
static void flip(struct rho_passive_choice *choice, unsigned which)
{
    const struct rho_passive *passive = choice->search->passive;
    float sign = choice->is_in[which] ? -1.0f : 1.0f;
    choice->total_nat += sign * choice->gain_nat[which];
    choice->is_in[which] = !choice->is_in[which];
    for (unsigned i = 0; i < choice->count; i++) {
        if (i != which) {
            unsigned shared = passive->shared[which][i];
            choice->gain_nat[i] -= sign * choice->search->share_nat * (float)shared;
        }
    }
}

/* The one that gains most, or count where none gains. */
static unsigned find_gain(const struct rho_passive_choice *choice, unsigned but)
{
    unsigned best = choice->count;
    float most = RHO_PASSIVE_GAIN_MIN_NAT;
    for (unsigned i = 0; i < choice->count; i++) {
        if (!choice->is_in[i] && !choice->is_out[i] && i != but && choice->gain_nat[i] > most) {
            most = choice->gain_nat[i];
            best = i;
        }
    }
    return best;
}

/* Adds while that gains; those that lose by it leave. */
static void fill_up(struct rho_passive_choice *choice, unsigned but)
{
    for (unsigned added; (added = find_gain(choice, but)) < choice->count;) {
        flip(choice, added);
        for (unsigned i = 0; i < choice->count; i++) {
            if (choice->is_in[i] && i != added && choice->gain_nat[i] < -RHO_PASSIVE_GAIN_MIN_NAT) {
                flip(choice, i);
            }
        }
    }
}

/* Leaves one out and fills up again. Returns whether that is more. */
static int leave_out(struct rho_passive_choice *choice, unsigned which)
{
    struct rho_passive_choice tried = *choice;
    flip(&tried, which);
    fill_up(&tried, which);
    if (!(tried.total_nat > choice->total_nat + RHO_PASSIVE_GAIN_MIN_NAT)) {
        return 0;
    }
    *choice = tried;
    return 1;
}

void rho_passive_improve(struct rho_passive_choice *choice)
{
    int is_better;
    do {
        is_better = 0;
        for (unsigned i = 0; i < choice->count; i++) {
            is_better |= choice->is_in[i] && leave_out(choice, i);
        }
    } while (is_better);
}

void rho_passive_rank(const struct rho_passive *passive, uint8_t order[RHO_MAX_PASSIVE_CANDIDATES])
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

static void set_shared(const struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    for (unsigned i = 0; i < passive->num_candidates; i++) {
        for (unsigned j = 0; j < passive->num_candidates; j++) {
            passive->shared[i][j] = (uint8_t)rho_passive_count_shared(
                search, &passive->candidates[i], &passive->candidates[j]);
        }
    }
}

void rho_passive_choose(const struct rho_passive_search *search, struct rho_passive_choice *best)
{
    uint8_t order[RHO_MAX_PASSIVE_CANDIDATES] = {0};
    rho_passive_rank(search->passive, order);
    set_shared(search);
    start_choice(best, search);
    for (unsigned i = 0; i < STARTS && i < best->count; i++) {
        struct rho_passive_choice choice = {.count = 0};
        start_choice(&choice, search);
        flip(&choice, order[i]);
        fill_up(&choice, choice.count);
        rho_passive_improve(&choice);
        if (choice.total_nat > best->total_nat) {
            *best = choice;
        }
    }
}

/* ---- other choices ---------------------------------------------------------------------------- */

/* The same target with a few other bearings, rather than something else. */
static int is_kin(const struct rho_passive *passive, unsigned of, unsigned other)
{
    return (float)passive->shared[of][other] >= KIN_SHARE * (float)passive->candidates[of].hits;
}

void rho_passive_bar(struct rho_passive_choice *choice, unsigned which)
{
    for (unsigned i = 0; i < choice->count; i++) {
        if (i == which || is_kin(choice->search->passive, which, i)) {
            choice->is_out[i] = 1;
            if (choice->is_in[i]) {
                flip(choice, i);
            }
        }
    }
}

void rho_passive_force(struct rho_passive_choice *choice, unsigned which)
{
    if (which < choice->count && !choice->is_in[which]) {
        flip(choice, which);
    }
    fill_up(choice, choice->count);
}
