/* SPDX-License-Identifier: MIT */
/*
 * target_model: what a search assumes of targets and their plots before it sees any: detection,
 * births, process noise and turns; and quantiles of the residuals. Private to src/initiation.
 */
#ifndef RHOTRACK_TARGET_MODEL_H
#define RHOTRACK_TARGET_MODEL_H

#include "search.h"

/* Normal deviates below which 95 % and 99.9 % of a distribution lie. */
#define SIGMAS_95 1.6449f
#define SIGMAS_99_9 3.0902f

/* Sets detection probabilities, the density of births and the covariances by process noise. */
void rho_target_model_set(struct search *search);
/*
 * Largest variance by which process noise bends a track off its own fit over the scans from `first`
 * on; *sum_m2: the sum over these scans.
 */
float rho_target_bend_m2(const struct search *search, unsigned first, float *sum_m2);
/* Variance by process noise of the place in scan m about the line from scan a to scan b. */
float rho_target_off_line_m2(const struct search *search, unsigned a, unsigned m, unsigned b);
/*
 * ln of the volume of heights and range rates over which clutter and births are spread, apart from
 * positions and velocities in the plane.
 */
float rho_target_log_volume(const struct search *search, int has_z, unsigned heights,
                            unsigned range_rates);
/* Takes sets as those of turning targets from here on, or of straight ones. */
void rho_target_assume_turns(struct search *search, int turns);

/*
 * Quantile of chi-square with this number of dimensions, below which it lies as often as a normal
 * deviate below `sigmas` (Wilson and Hilferty's approximation).
 */
float rho_chi2_quantile(unsigned dimensions, float sigmas);
/* Natural logarithm of n factorial. */
float rho_log_factorial(unsigned n);

#endif
