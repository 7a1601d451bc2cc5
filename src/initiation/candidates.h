/* SPDX-License-Identifier: MIT */
/* candidates: sets of plots are fitted, scored and selected. Private to src/initiation. */
#ifndef RHOTRACK_CANDIDATES_H
#define RHOTRACK_CANDIDATES_H

#include "search.h"

/* Largest score, either way: sums of scores then do not overflow. */
enum { SCORE_MAX_MNAT = 1000000000 };

/* Converts nats to integer thousandths, limited to SCORE_MAX_MNAT (plot_set.c). */
int32_t rho_nat_to_mnat(float nat);
/* Fits a track to a set of plots. Returns 0 where the plots do not determine a track. */
int rho_plot_set_fit(const struct search *search, const struct plot_set *set, struct line_fit *fit);
/* Makes the set of each scan's plot nearest to the fit, widened by variance_factor. */
void rho_plot_set_associate(struct search *search, const struct line_fit *fit,
                            float variance_factor, struct plot_set *set);
/*
 * Fits a set and associates the plots of every scan with the fit, until the set stays the same.
 * Returns 0 where too few scans have a plot, or the speed is outside v_min .. v_max.
 */
int rho_plot_set_refine(struct search *search, struct plot_set *set, struct line_fit *fit);
/*
 * Sets the score ln [ P(plots | one target) / P(plots | clutter) ] of a set of plots. Returns 0
 * where the plots do not determine a track.
 */
int rho_plot_set_score(const struct search *search, const struct plot_set *set,
                       const struct line_fit *fit, struct set_score *score);

/*
 * Arithmetic of plot_set.c for isotropic noise (isotropic_fit.c) and for all other plots
 * (anisotropic_fit.c): the fit; and *nat, ln of the joint density of a set's plots with position
 * and velocity integrated out, with the residual's chi-square and dimensions. Both return 0 where
 * there is no track.
 */
int rho_isotropic_fit(const struct search *search, const struct plot_set *set,
                      struct line_fit *fit);
int rho_isotropic_likelihood(const struct search *search, const struct plot_set *set,
                             struct set_score *score, float *nat);
int rho_anisotropic_fit(const struct search *search, const struct plot_set *set,
                        struct line_fit *fit);
int rho_anisotropic_likelihood(const struct search *search, const struct plot_set *set,
                               struct set_score *score, float *nat);

/* Makes a candidate of a set and lists it; a full list drops the lowest score (candidates.c). */
void rho_candidates_add(struct search *search, struct plot_set *set);
/*
 * Accepts candidates in the order of their scores, so that no two share more than one plot. Where
 * the work ends, the candidates with the lowest scores are dropped.
 */
void rho_candidates_select(struct search *search);
/*
 * Scores the accepted candidates again, with thresholds and clutter density measured without the
 * plots of likely targets, and drops those below the threshold.
 */
void rho_candidates_rescore(struct search *search);

#endif
