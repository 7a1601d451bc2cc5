/* SPDX-License-Identifier: MIT */
/* policy: constants that no physics or parameter sets; tools/gates/mutate.py varies numbers. */
#ifndef RHOTRACK_WINDOW_POLICY_H
#define RHOTRACK_WINDOW_POLICY_H

/* nearest_plot.c */

/*
 * Least ground range, squared, at which a plot has a line of sight: nearer, its direction is that
 * of the noise. Half or twice: plots nearer than 0.7 m or 1.4 m have isotropic noise.
 */
#define RANGE_LEAST_M2 1.0f

/* window.c */

/*
 * Most bins for each plot of a scan with few plots: more are not worth their memory traffic. Half:
 * look-ups compare more plots. Twice: pushes and look-ups pass more empty bins.
 */
#define BINS_PER_PLOT 8u
/*
 * Largest angle of missing sectors (lost, or out of sequence) that does not end a revolution;
 * places in the gap count as not covered. Half: a lost sector ends it, and its scan has a part of
 * the plots. Twice: the sectors of two revolutions may count as one.
 */
#define SECTOR_GAP_RAD (RHO_TWO_PI / 8.0f)

/* window.c, the extent */

/*
 * Square of the standard deviations from the mean beyond which a plot is an outlier: 3 sigma;
 * evenly spread clutter ends at 1.7. Half: thinner borders are cut off. Twice: a few far false
 * plots widen the area, and clutter looks thin.
 */
#define OUTLIER_SIGMAS2 9.0f
/*
 * Rounds: the first takes all plots, each later one leaves out those that larger outliers hid
 * before. Half: none is left out. Twice: tails of what is left are cut, too.
 */
#define OUTLIER_ROUNDS 3
/*
 * Least number of plots for outliers: of fewer, the spread tells little. Half: single targets off a
 * small cluster are left out. Twice: thin windows keep their outliers.
 */
#define OUTLIER_PLOTS 12.0f
/*
 * Share of the difference by which the extent shrinks in a scan: a mean age of 50 scans. Half: an
 * area that has become smaller counts as large for longer. Twice: the density follows chance gaps.
 */
#define EXTENT_DECAY 0.02f

#endif
