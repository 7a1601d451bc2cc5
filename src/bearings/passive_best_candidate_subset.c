/* SPDX-License-Identifier: MIT */
/*
 * passive_best_candidate_subset: the subset of candidates that are tracks together. Its total is
 * the sum of the scores less share_nat for every bearing that two chosen candidates claim. The
 * search adds the candidate that gains most, from several starts, and tries to replace each chosen
 * candidate by others.
 */
#include <string.h>

#include "passive_search.h"

#define STARTS 12u
/* share of a candidate's bearings at which another candidate counts as the same target */
#define SAME_TARGET_SHARE 0.7f

/* ---- joint selection ------------------------------------------------------------------------- */

/* Starts a choice without candidates: each candidate's gain is its score. */
static void init_choice_without_candidates(struct rho_passive_choice *choice,
                                           const struct rho_passive_search *search)
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
            unsigned shared = passive->shared[which][i];
            choice->gain_nat[i] -= sign * choice->search->share_nat * (float)shared;
        }
    }
}

/* The candidate outside the choice that raises the total most; choice->count: no candidate does. */
static unsigned best_addition_or_count(const struct rho_passive_choice *choice, unsigned excluded)
{
    unsigned best = choice->count;
    float most = RHO_PASSIVE_GAIN_MIN_NAT;
    for (unsigned i = 0; i < choice->count; i++) {
        if (!choice->is_in[i] && !choice->is_out[i] && i != excluded &&
            choice->gain_nat[i] > most) {
            most = choice->gain_nat[i];
            best = i;
        }
    }
    return best;
}

/* Adds candidates while the total grows, and removes those whose gain has become negative. */
static void add_and_drop_while_gaining(struct rho_passive_choice *choice, unsigned excluded)
{
    for (unsigned added; (added = best_addition_or_count(choice, excluded)) < choice->count;) {
        toggle_candidate(choice, added);
        for (unsigned i = 0; i < choice->count; i++) {
            if (choice->is_in[i] && i != added && choice->gain_nat[i] < -RHO_PASSIVE_GAIN_MIN_NAT) {
                toggle_candidate(choice, i);
            }
        }
    }
}

/*
 * Removes one candidate and adds others instead, if that raises the total. Returns whether it did.
 */
static int try_to_replace_candidate_by_others(struct rho_passive_choice *choice, unsigned which)
{
    struct rho_passive_choice tried = *choice;
    toggle_candidate(&tried, which);
    add_and_drop_while_gaining(&tried, which);
    if (!(tried.total_nat > choice->total_nat + RHO_PASSIVE_GAIN_MIN_NAT)) {
        return 0;
    }
    *choice = tried;
    return 1;
}

void rho_passive_improve_choice(struct rho_passive_choice *choice)
{
    int is_better;
    do {
        is_better = 0;
        for (unsigned i = 0; i < choice->count; i++) {
            is_better |= choice->is_in[i] && try_to_replace_candidate_by_others(choice, i);
        }
    } while (is_better);
}

static void fill_shared_bearings_table(const struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    for (unsigned i = 0; i < passive->num_candidates; i++) {
        for (unsigned j = 0; j < passive->num_candidates; j++) {
            passive->shared[i][j] = (uint8_t)rho_passive_count_shared_bearings(
                search, &passive->candidates[i], &passive->candidates[j]);
        }
    }
}

void rho_passive_choose_candidates(const struct rho_passive_search *search,
                                   struct rho_passive_choice *best)
{
    uint8_t order[RHO_MAX_PASSIVE_CANDIDATES] = {0};
    rho_passive_rank_candidates(search->passive, order);
    fill_shared_bearings_table(search);
    init_choice_without_candidates(best, search);
    for (unsigned i = 0; i < STARTS && i < best->count; i++) {
        struct rho_passive_choice choice = {.count = 0};
        init_choice_without_candidates(&choice, search);
        toggle_candidate(&choice, order[i]);
        add_and_drop_while_gaining(&choice, choice.count);
        rho_passive_improve_choice(&choice);
        if (choice.total_nat > best->total_nat) {
            *best = choice;
        }
    }
}

/* ---- choices with and without a candidate ---------------------------------------------------- */

/* Whether two candidates share so many bearings that both are fits of one target. */
static int do_candidates_share_one_targets_bearings(const struct rho_passive *passive, unsigned one,
                                                    unsigned other)
{
    return (float)passive->shared[one][other] >=
           SAME_TARGET_SHARE * (float)passive->candidates[one].hits;
}

void rho_passive_exclude_target(struct rho_passive_choice *choice, unsigned which)
{
    for (unsigned i = 0; i < choice->count; i++) {
        if (i == which ||
            do_candidates_share_one_targets_bearings(choice->search->passive, which, i)) {
            choice->is_out[i] = 1;
            if (choice->is_in[i]) {
                toggle_candidate(choice, i);
            }
        }
    }
}

void rho_passive_add_candidate_then_all_gaining(struct rho_passive_choice *choice, unsigned which)
{
    if (which < choice->count && !choice->is_in[which]) {
        toggle_candidate(choice, which);
    }
    add_and_drop_while_gaining(choice, choice->count);
}
