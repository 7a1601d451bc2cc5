/* SPDX-License-Identifier: MIT */
/*
 * passive_score_lost_without_a_track: the margin of each track: total score of the best set of
 * tracks minus that of the best set without this track. A set with a higher total that is found
 * becomes the best set.
 */
#include <string.h>

#include "passive_search.h"
#include "rhotrack/types.h"

/* alternatives whose total is lower than the best choice's by more than this are not fitted */
#define FITTED_WITHIN_NAT 20.0f
#define FITTED_MAX 4u /* largest number of alternatives that are fitted for each track */
#define NONE_NAT (-1.0e9f)
#define CHANGES_MAX 4 /* largest number of times that another set may become the best set */

/*
 * Choices without the target of one candidate: alternative i has candidate i in its place, the last
 * alternative has none.
 */
struct alternatives {
    struct rho_passive_choice without;
    /* total score of each alternative; NONE_NAT: no such alternative, or already fitted */
    float total_nat[RHO_MAX_PASSIVE_CANDIDATES + 1];
};

static void compute_totals_of_choices_without_target(const struct rho_passive *passive,
                                                     const struct rho_passive_choice *choice,
                                                     unsigned which,
                                                     struct alternatives *alternatives)
{
    alternatives->without = *choice;
    rho_passive_exclude_target(&alternatives->without, which);
    for (unsigned i = 0; i <= choice->count; i++) {
        alternatives->total_nat[i] = NONE_NAT;
        if (i == choice->count ||
            (!alternatives->without.is_out[i] && passive->shared[which][i] > 0)) {
            struct rho_passive_choice tried = alternatives->without;
            rho_passive_add_candidate_then_all_gaining(&tried, i);
            rho_passive_improve_choice(&tried);
            alternatives->total_nat[i] = tried.total_nat;
        }
    }
}

static unsigned find_best_candidate_to_replace_target(const struct alternatives *alternatives)
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
 * Alternatives beyond FITTED_MAX are not fitted; the total of their choice is taken.
 */
static float best_total_without_target(const struct rho_passive_search *search,
                                       struct rho_passive_choice *choice, unsigned which,
                                       int may_replace_best)
{
    struct rho_passive *passive = search->passive;
    float most_nat = NONE_NAT, fit_nat = passive->best.total_nat - choice->total_nat;
    struct alternatives alternatives;
    compute_totals_of_choices_without_target(passive, choice, which, &alternatives);
    for (unsigned n = 0; n < FITTED_MAX; n++) {
        unsigned best = find_best_candidate_to_replace_target(&alternatives);
        if (alternatives.total_nat[best] < choice->total_nat - FITTED_WITHIN_NAT) {
            break;
        }
        struct rho_passive_choice tried = alternatives.without;
        rho_passive_add_candidate_then_all_gaining(&tried, best);
        rho_passive_improve_choice(&tried);
        rho_passive_fit_jointly(search, &tried, &passive->other);
        alternatives.total_nat[best] = NONE_NAT;
        most_nat = passive->other.total_nat > most_nat ? passive->other.total_nat : most_nat;
        if (may_replace_best && most_nat > passive->best.total_nat + RHO_PASSIVE_GAIN_MIN_NAT) {
            passive->best = passive->other;
            *choice = tried;
            memset(choice->is_out, 0, sizeof choice->is_out);
            return most_nat;
        }
    }
    float unfitted_nat =
        alternatives.total_nat[find_best_candidate_to_replace_target(&alternatives)] + fit_nat;
    return unfitted_nat > most_nat ? unfitted_nat : most_nat;
}

/*
 * All margins refer to one best set: they are computed anew when another set becomes the best,
 * which happens at most CHANGES_MAX times.
 */
void rho_passive_find_margins_and_improve(const struct rho_passive_search *search,
                                          struct rho_passive_choice *choice,
                                          float margins_nat[RHO_MAX_PASSIVE_TRACKS])
{
    const struct rho_passive_set *best = &search->passive->best;
    unsigned changes = 0;
    for (unsigned t = 0; t < best->num;) {
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
