/* SPDX-License-Identifier: MIT */
/*
 * The life of a track in double precision, to compare with: the rate equations of the three states
 * (visible, hidden, gone) in small steps, and Bayes' rule for what a look has seen.
 */
#ifndef RHOTRACK_TESTS_LIFE_CHAIN_H
#define RHOTRACK_TESTS_LIFE_CHAIN_H

#include <math.h>

#include "rhotrack/tracker.h"

#define CHAIN_SHOWN 0.48 /* probabilities of existence: of a track that is shown */
#define CHAIN_SHOWN_AGAIN 0.8
#define CHAIN_ENDED 0.02

struct life_chain {
    double visible, hidden;
    double share; /* of existing targets that the next look can see */
    int is_established;
};

/* A track whose score is over_nat above the threshold that confirms it. */
static inline struct life_chain chain_of_start(double over_nat)
{
    const double odds = 5.0 * exp(fmin(over_nat, 1.5));
    return (struct life_chain){.visible = odds / (1.0 + odds), .share = 1.0};
}

static inline double chain_exists(const struct life_chain *chain)
{
    return chain->visible + chain->hidden;
}

/* blind: the probability that the look before was blind; with 0.8 of it the next one is, too. */
static inline void chain_pass(struct life_chain *chain, double scans,
                              const struct rho_tracker_life *rates, double blind)
{
    enum { STEPS = 20000 };
    const double step = scans / STEPS, death = (double)rates->death;
    const double hide = (double)rates->hide, appear = (double)rates->appear;
    for (int i = 0; i < STEPS; i++) {
        const double v = chain->visible, h = chain->hidden;
        chain->visible += step * (appear * h - (hide + death) * v);
        chain->hidden += step * (hide * v - (appear + death) * h);
    }
    const double share = (1.0 - 0.8 * blind) * chain->visible / chain_exists(chain);
    chain->share = share < 0.95 ? share : 1.0; /* nearly all count as all */
}

/*
 * Weighs one look at `count` tracks whose scores changed by gain_nat[i]. *blind: that of the look
 * before, and then of this one; may_spare: 0 where the tracks have coasted for too long for that.
 */
static inline void chain_weigh(struct life_chain *chains, const double *gain_nat, int count,
                               double *blind, int may_spare)
{
    double sees = 1.0;
    double prior = 0.8 * *blind;
    prior = prior > 0.005 ? prior : 0.005;
    for (int i = 0; i < count; i++) {
        if (chains[i].is_established) {
            sees *= 1.0 + chains[i].visible * (exp(gain_nat[i]) - 1.0) / chains[i].share;
        }
    }
    *blind = prior / (prior + (1.0 - prior) * sees);
    for (int i = 0; i < count; i++) {
        const double seen = 1.0 + (exp(gain_nat[i]) - 1.0) / chains[i].share;
        const double sum = 1.0 + chains[i].visible * (seen - 1.0);
        const double spared = may_spare ? *blind : 0.0;
        chains[i].visible *= spared + (1.0 - spared) * seen / sum;
        chains[i].hidden *= spared + (1.0 - spared) / sum;
    }
}

/* Status of a track with such a life that was confirmed before. */
static inline enum rho_track_status chain_status(const struct life_chain *chain,
                                                 enum rho_track_status before, int is_missed)
{
    const double least = before == RHO_TRACK_TENTATIVE ? CHAIN_SHOWN_AGAIN : CHAIN_SHOWN;
    if (chain_exists(chain) < CHAIN_ENDED) {
        return RHO_TRACK_FREE;
    }
    return chain_exists(chain) < least ? RHO_TRACK_TENTATIVE
           : is_missed                 ? RHO_TRACK_COASTING
                                       : RHO_TRACK_CONFIRMED;
}

#endif
