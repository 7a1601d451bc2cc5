/* SPDX-License-Identifier: MIT */
/* policy: constants that no physics or parameter sets; tools/gates/mutate.py varies numbers. */
#ifndef RHOTRACK_BODIES_POLICY_H
#define RHOTRACK_BODIES_POLICY_H

/* More than one file */

/*
 * Plots or looks after which a body is judged: its extent and velocity have settled, and a turn has
 * been seen. Half: chance splits bodies. Twice: two targets are one for longer.
 */
#define SETTLED_LOOKS 30.0f
/*
 * Plots after which a body is settled: with fewer, its first heading and velocity may be wrong.
 * Half: bodies seen from the side first are split. Twice: two targets have one track for longer.
 */
#define SETTLED_PLOTS 100.0f
/*
 * Memory of the evidence on a body, in looks: sums fade by 1 / DOUBT_MEMORY each look. Half: what
 * needs SETTLED_LOOKS is hardly reached. Twice: old evidence outlasts the cause.
 */
#define DOUBT_MEMORY 80.0f
/*
 * Sigmas that errors explain: of range rates and lengths. Half: targets fall into several groups
 * and tracks. Twice: neighbours with other velocities are one target.
 */
#define BODY_ERROR_SIGMAS 4.0f
/*
 * Sigmas by which things are usually off: two plots of the longest body, its turn, a heading,
 * velocity and azimuths. Half: ends of long bodies are groups of their own. Twice: cars that start
 * abreast are one.
 */
#define LOOSE_SIGMAS 2.0f

/* body_extents.c */

/*
 * Prior length of a body on each axis, as a share of the longest body, and its least value. Half:
 * plots of long targets are taken for several at first. Twice: those of neighbours for one.
 */
#define PRIOR_SHARE 0.5f
#define PRIOR_LEAST_M 0.1f
/* Weight of a look in the mean number of plots. Half or twice: it follows later, or is noisier. */
#define PLOTS_SHARE 0.07f

/* body_split_evidence.c */

/*
 * Looks, and share of all looks, beyond which a body that is longer than any is two targets. Half:
 * stray plots split bodies. Twice: cars in a row stay one truck.
 */
#define LONG_LOOKS 4.0f
#define LONG_SHARE 0.1f
/*
 * Deviation of a steady heading from its mean, beside its sigma. Half: sums of range rates begin
 * anew by the noise of the heading. Twice: a turn is taken for two targets.
 */
#define STEADY_RAD 0.1f
/* Largest unseen turn, over the tolerance. Half: a turn splits a body. Twice: two cars stay one. */
#define UNSEEN_TURN_SHARE 2.0f
/* Limit of chi-square; errors of looks correlate. Half: wheels split bodies. Twice: two are one. */
#define APART_CHI2 40.0f
/*
 * Least variance of places across the line of sight, as a share of their noise. Half: narrow bodies
 * that turn are split. Twice: two cars beside each other stay one.
 */
#define SIDE_SHARE 0.2f
/*
 * Least 1 - correlation^2 of places in two axes, for a plane to be fitted to the range rates. Half:
 * planes of thin bodies are of noise. Twice: slender bodies are not judged.
 */
#define PLANE_SHARE 0.1f

/* outline.c */

/*
 * Width of the widest body: a share of its length, but this many m at least, and at most the
 * longest: people are round. Half: lorries are split. Twice: cars abreast keep one track.
 */
#define WIDEST_SHARE 0.3f
#define ROUND_MOST_M 2.5f
/*
 * Least length that it is a share of, over the longest. Half: ships seen from ahead are split.
 * Twice: cars beside trucks keep one track.
 */
#define LENGTH_LEAST_SHARE 0.5f
/*
 * Most sigma of range rates by parts that move, in sigmas of their noise. Half: limbs have tracks.
 * Twice: two who pass each other are one.
 */
#define LIMBS_SIGMAS 2.0f
/* Least variance of a place, m^2, against a division by 0. Half or twice: nothing changes. */
#define LINE_LEAST_M2 1e-6f
/*
 * Square of a misfit, and share of a density, beyond which a plot is far: strays are as likely by
 * any body. Half: plots of two targets are strays. Twice: one stray decides.
 */
#define FAR_SQUARE 20.0f
#define FAR_SHARE 1e-3f

/* sudden_turns.c */

/*
 * Change of a velocity at once, sigma on an axis: the largest acceleration for this time. Half:
 * people who turn lose their plots. Twice: cars take those of the next lane.
 */
#define TURN_S 0.35f
/*
 * ln of the prior odds against a turn in a look, and the most that one plot says: it takes three.
 * Half: two strays turn a track. Twice: people of six plots who turn are lost.
 */
#define TURN_NAT 6.5f
#define TURN_PLOT_NAT 3.0f
/* Plots in a look that a body must have had. Half: two strays. Twice: people of few plots. */
#define TURN_PLOTS 3u
/* Share of the usual plots that must have turned. Half: strays about one who stands. Twice: none */
#define TURN_SHARE 0.33f
/* Gate of places, chi-square of two. Half: outer plots stay behind. Twice: neighbours' plots. */
#define TURN_GATE_CHI2 11.8f

/* duplicate_tracks.c */

/*
 * Evidence against two bodies for one in each look, and in each of its plots, ln: two fit better
 * than one by chance. Half: halves of ships stay two tracks. Twice: people side by side are one.
 */
#define TWO_LOOK_NAT 0.1f
#define TWO_PLOT_NAT 0.1f
/* Most that a look says, either way. Half: second tracks last. Twice: a stray ends known tracks. */
#define TWO_LOOK_MOST_NAT 4.0f
/* Evidence at which a track ends. Half: new neighbours are lost. Twice: second tracks are shown. */
#define ONE_BODY_NAT 3.0f
/*
 * Evidence by a look apart from all others, and its sum at most. Half: two who meet become one.
 * Twice: a second track that was once apart stays.
 */
#define APART_NAT 2.0f
#define TWO_MOST_NAT 60.0f
/*
 * Hits of a track that may replace one which was lost for as long. Half: who is hidden as he turns
 * gets a new number. Twice: his number goes to another who is seen later.
 */
#define MISSED_MOST 20u

/* plot_groups.c */

/* Sigmas of a plot on a body. Half: its outer plots start tracks. Twice: it takes a neighbour's. */
#define BODY_GATE_SIGMAS 3.0f
/*
 * Largest turn rate of a track's body, which spreads its range rates. Half: plots of a turning
 * target start tracks. Twice: those of a faster neighbour are taken.
 */
#define TURN_RADPS 0.3f
/* Turn rate without a track, sigma. Half: turns start two tracks. Twice: neighbours start one. */
#define TURN_USUAL_RADPS 0.1f
/*
 * Difference of misfits below which the second best body contends for a plot. Half: overlaps of two
 * tracks are missed. Twice: bodies beside each other lack the plots between them.
 */
#define CONTESTED_MISFIT 6.0f
/* Units of work: a plot compared with a body; with three bodies; with a plot; passed over. */
enum { TEST_UNITS = 4, EVIDENCE_UNITS = 12, PAIR_UNITS = 2, PASS_UNITS = 1 };

#endif
