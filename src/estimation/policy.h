/* SPDX-License-Identifier: MIT */
/* policy: constants that no physics or parameter sets; tools/gates/mutate.py varies numbers. */
#ifndef RHOTRACK_ESTIMATION_POLICY_H
#define RHOTRACK_ESTIMATION_POLICY_H

/* DRIVE_SHARE to TURN_MAX_S: imm.c, tuned with targets that manoeuvre at 1 to 30 g for 4 to 8 s. */

/*
 * Acceleration sd of the manoeuvring model as a share of the largest one. Half: the estimate lags
 * in turns, and plots leave the gate. Twice: wider gates and noisier velocities in each turn.
 */
#define DRIVE_SHARE 0.8f
/*
 * Memory of an acceleration as a share of the turning time v_max / accel_max, and its least value.
 * Half: a turn is forgotten between plots. Twice: it is continued beyond its end.
 */
#define MEMORY_SHARE 0.35f
#define MEMORY_MIN_S 3.0f
/*
 * Mean time in each model as a share of the turning time, and its least value. Half: the models
 * change with the noise of plots. Twice: the onset of a manoeuvre is recognised later.
 */
#define SOJOURN_SHARE 0.47f
#define SOJOURN_MIN_S 4.0f
/*
 * Largest turning time, for targets that hardly accelerate. Half or twice: their memory and mean
 * times are bounded sooner or later; other targets do not change.
 */
#define TURN_MAX_S 1000.0f

/*
 * Velocity sd of the steady model after 1 s as a share of accel_max. Half: small deviations from a
 * straight line count as manoeuvres. Twice: straight tracks stay less certain.
 */
#define QUIET_SHARE 0.05f
/*
 * Upper limits of the steady model's noise, m^2/s^3, for agile and for calm targets. Half: wind and
 * weaving turn into manoeuvres. Twice: velocities of straight targets are noisier.
 */
#define QUIET_DENSITY 1.0f
#define CALM_DENSITY 0.003f
/*
 * Steady model's noise in a gentle turn, of 0.17 accel_max, over that of agile targets, where range
 * rates tell: imm_update.c. Half: gentle turns lag. Twice: they are noisy across the line of sight.
 */
#define TURN_NOISE 12.0f
/*
 * Time over which a gentle turn lasts: plots within say the same of it. Half: at 20 plots a second
 * targets are soon taken for calm. Twice: a turn shows later there.
 */
#define TURN_LASTS_S 4.0f
/*
 * Least probability of agile targets after a range rate: rounding to 0 would exclude them for good.
 * Half or twice: a gentle turn shows after 0.7 nat more or less of evidence.
 */
#define AGILE_MIN 1e-3f
/*
 * Most that one range rate tells for a gentle turn, nat, lest a product overflow. Half or twice: no
 * plot in a gate tells as much.
 */
#define TURN_GAIN_MAX_NAT 50.0f
/*
 * Mean time until an agile target that flies straight becomes calm. Half: a target is taken for
 * calm between two of its turns. Twice: straight targets keep an agile one's noise for minutes.
 */
#define SETTLE_S 60.0f
/*
 * Odds of the manoeuvring model below which it is not mixed into the steady one: even a small share
 * would add the squared difference of the models to the steady variance at each scan, and straight
 * targets would stay uncertain. A bound on the probability would not do, as it hardly falls between
 * fast scans. Half: that uncertainty comes back. Twice: the end of a slow turn is missed.
 */
#define ODDS_OVER 0.16f

/*
 * Least probability of a model, imm_likelihood.c: rounding to 0 would exclude it for good. Half or
 * twice: a model comes back after 0.7 nat more or less of evidence.
 */
#define PROBABILITY_MIN 1.0e-9f

/*
 * Least information of a mix of bearings, over that of a certain one, that changes an estimate,
 * bearing_mix.c. Half: looks that tell nothing cost updates. Twice: faint bearings among many are
 * not used.
 */
#define MIX_GAIN_MIN 0.1f

/* What follows: body_extent_filter.c. */

/*
 * Largest count of a body's plots, and memory of its extent and slope in plots without noise. Half:
 * extents vary more. Twice: an extent that was wrong at the start is corrected at half the pace.
 */
#define PLOTS_MOST 500.0f
/*
 * Half the variance of the square of a place on a body, over its squared variance: 0.4 for places
 * uniform on the body, and half of that, as most scatterers are the same from look to look. Half:
 * stated sigmas of extents are too small. Twice: they are too large.
 */
#define SQUARES_OF_BODY 0.2f
/*
 * Speed, in standard deviations of the velocity along or across it, above which it gives the body's
 * heading. Half: bodies of targets that stop turn across the road. Twice: slow ones get it late.
 */
#define HEADING_SIGMAS 4.0f
/*
 * Actual variance of velocities' directions, as a share of what filters that expect manoeuvres
 * state. Half: widths are too large, as wrong headings count as width. Twice: they are too small.
 */
#define TURNED_SHARE 0.3f
/*
 * Looks over which an error of the heading stays the same. Half: the slope learns from errors of
 * the heading. Twice: it learns at half the pace.
 */
#define TURNED_LOOKS 10.0f
/*
 * Share of scatterers that are elsewhere on their part of the body at each look. Half: centres of
 * bodies count as more certain than they are. Twice: as random plots, and the track follows them.
 */
#define ANEW_SHARE 0.5f
/*
 * Plots without noise at which half of the prior's length is still added for gates. Half: the first
 * plots of a long body are outside of its gate. Twice: neighbours' plots are inside for longer.
 */
#define FEW_PLOTS 4.0f
/*
 * Weights of the priors of length, next to nothing, and of width, which is known to some 30 %. Half
 * or twice: the first looks change the length, and the width, more or less.
 */
#define PRIOR_WEIGHT 0.3f
#define WIDTH_PRIOR_WEIGHT 6.0f
/*
 * Largest ratio of length to width. Half: long narrow bodies are reported too wide. Twice: a width
 * that noise made too small stays so.
 */
#define ASPECT_MAX 16.0f
/*
 * Squares, in variances of a place, that a stray plot or a wrong first heading may add to the sum
 * over n plots, and what each of many plots may. Half: real widths are cut, two people abreast are
 * one for long. Twice: one stray plot, or some, widen a body for many looks.
 */
#define STRAY_SQUARES 12.0f
#define STRAY_SQUARES_EACH 3.0f
/*
 * Prior weight, 1 / variance, of the slope of a body's scatterers: 5 scatterers on a body 6 times
 * as long as wide. Half: an error of the first headings is learned as slope. Twice: a real slope
 * counts as width for longer.
 */
#define SLOPE_WEIGHT 144.0f
/*
 * Correction of a length's sigma for few scatterers: the sigma of a body that looks too short is
 * too small. Half: stated sigmas of bodies of two scatterers are too small. Twice: too large.
 */
#define FEW_PLACES 8.4f
/*
 * Least number of plots, after those used up by the heading's error, that update the width. Half:
 * division by next to nothing. Twice: looks of one plot with a vague heading no longer count.
 */
#define LEAST_PLOTS 0.1f
/* Least variance of a place, m^2: a length of 0.1 m. Half or twice: the least reported length. */
#define PLACE_LEAST_M2 1e-3f

#endif
