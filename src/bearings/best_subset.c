/* SPDX-License-Identifier: MIT */
/*
 * best_subset: the candidates that are tracks together. Their total is the sum of the scores less
 * share_nat for every bearing that two of them claim. The search adds the candidate that gains
 * most, from several starts, and tries to replace each chosen candidate by others.
 */
#include <string.h>

#include "passive_search.h"
#include "policy.h"

/* Starts a choice without candidates: each candidate's gain is its score. */
static void init_choice(struct rho_passive_choice *choice, const struct rho_passive_search *search)
{
    memset(choice, 0, sizeof *choice);
    choice->search = search;
    choice->count = search->passive->num_candidates;
    for (unsigned i = 0; i < choice->count; i++) {
        choice->gain_nat[i] = search->passive->candidates[i].score_nat;
    }
}

/* Adds a candidate to the choice, or removes it, and updates the gains of the others. */
static void toggle_candidate(struct rho_passive_choice *choice, unsigned which)
{
    const struct rho_passive *passive = choice->search->passive;
    float sign = choice->is_in[which] ? -1.0f : 1.0f;
    choice->total_nat += sign * choice->gain_nat[which];
    choice->is_in[which] = !choice->is_in[which];
    for (unsigned i = 0; i < choice->count; i++) {
        if (i != which) {
            unsigned shared = passive->shared[RHO_AT(which, i)];
            choice->gain_nat[i] -= sign * choice->search->share_nat * (float)shared;
        }
    }
}

/* Adds candidates while the total grows, and removes those whose gain has become negative. */
static void add_gaining(struct rho_passive_choice *choice, unsigned excluded)
{
    for (;;) {
        unsigned best = choice->count;
        float most = GAIN_MIN_NAT;
        for (unsigned i = 0; i < choice->count; i++) {
            if (!choice->is_in[i] && !choice->is_out[i] && i != excluded &&
                choice->gain_nat[i] > most) {
                most = choice->gain_nat[i];
                best = i;
            }
        }
        if (best == choice->count) {
            return;
        }
        toggle_candidate(choice, best);
        for (unsigned i = 0; i < choice->count; i++) {
            if (choice->is_in[i] && i != best && choice->gain_nat[i] < -GAIN_MIN_NAT) {
                toggle_candidate(choice, i);
            }
        }
    }
}

void rho_passive_improve_choice(struct rho_passive_choice *choice)
{
    int is_better;
    do {
        is_better = 0;
        for (unsigned i = 0; i < choice->count; i++) {
            if (!choice->is_in[i]) {
                continue;
            }
            struct rho_passive_choice tried = *choice;
            toggle_candidate(&tried, i);
            add_gaining(&tried, i);
            if (tried.total_nat > choice->total_nat + GAIN_MIN_NAT) {
                *choice = tried;
                is_better = 1;
            }
        }
    } while (is_better);
}

void rho_passive_choose(const struct rho_passive_search *search, struct rho_passive_choice *best)
{
    uint8_t order[RHO_MAX_PASSIVE_CANDIDATES] = {0};
    struct rho_passive *passive = search->passive;
    rho_passive_rank_candidates(passive, order);
    for (unsigned i = 0; i < passive->num_candidates; i++) {
        for (unsigned j = 0; j <= i; j++) {
            passive->shared[RHO_AT(i, j)] = (uint8_t)rho_passive_count_shared(
                search, &passive->candidates[i], &passive->candidates[j]);
        }
    }
    init_choice(best, search);
    for (unsigned i = 0; i < BEST_TRIED && i < best->count; i++) {
        struct rho_passive_choice choice = {.count = 0};
        init_choice(&choice, search);
        toggle_candidate(&choice, order[i]);
        add_gaining(&choice, choice.count);
        rho_passive_improve_choice(&choice);
        if (choice.total_nat > best->total_nat) {
            *best = choice;
        }
    }
}

void rho_passive_exclude_target(struct rho_passive_choice *choice, unsigned which)
{
    const struct rho_passive *passive = choice->search->passive;
    const struct rho_passive_candidate *target = &passive->candidates[which];
    const struct rho_passive_equations known = rho_passive_equate_claims(choice->search, target);
    float least = SAME_TARGET_SHARE * (float)target->hits;
    for (unsigned i = 0; i < choice->count; i++) {
        if (i == which || (float)passive->shared[RHO_AT(which, i)] >= least ||
            rho_passive_distance2(choice->search, &known, target->state_m,
                                  passive->candidates[i].state_m) <
                SAME_TARGET_SIGMAS * SAME_TARGET_SIGMAS) {
            choice->is_out[i] = 1;
            if (choice->is_in[i]) {
                toggle_candidate(choice, i);
            }
        }
    }
}

void rho_passive_add_gaining(struct rho_passive_choice *choice, unsigned which)
{
    if (which < choice->count && !choice->is_in[which]) {
        toggle_candidate(choice, which);
    }
    add_gaining(choice, choice->count);
}
