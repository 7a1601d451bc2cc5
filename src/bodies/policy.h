/* SPDX-License-Identifier: MIT */
/* policy: constants that no physics or parameter sets; tools/gates/mutate.py varies numbers. */
#ifndef RHOTRACK_BODIES_POLICY_H
#define RHOTRACK_BODIES_POLICY_H

/* More than one file */

/*
 * Plots, looks or overlaps after which a body is judged: its extent and velocity have settled, a
 * turn has been seen, and two targets that pass each other are apart. Half: chance splits bodies
 * and ends tracks. Twice: two targets are one, and one has two tracks, for longer.
 */
#define SETTLED_LOOKS 30.0f
/*
 * Memory of the evidence on a body, in looks: sums fade by 1 / DOUBT_MEMORY each look. Half: what
 * needs SETTLED_LOOKS is hardly reached. Twice: old evidence outlasts the cause.
 */
#define DOUBT_MEMORY 80.0f
/*
 * Sigmas that errors explain: of range rates, lengths, velocities of two tracks. Half: targets fall
 * into several groups and tracks. Twice: neighbours with other velocities are one target.
 */
#define BODY_ERROR_SIGMAS 4.0f
/*
 * Sigmas by which things are usually off: two plots of the longest body, a heading, velocity and
 * azimuths. Half: the ends of long bodies are groups of their own. Twice: neighbours join them.
 */
#define LOOSE_SIGMAS 2.0f

/* body_extents.c */

/*
 * Prior length of a body on each axis, as a share of the longest body, and its least value. Half:
 * plots of long targets are taken for several at first. Twice: those of neighbours for one.
 */
#define PRIOR_SHARE 0.5f
#define PRIOR_LEAST_M 0.1f

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

/* duplicate_tracks.c */

/* A track with fewer hits is new. Half: a long target keeps two. Twice: of two cars one is lost. */
#define NEW_HITS 20u
/*
 * Distance of two new tracks of one target along the heading and across it, in longest bodies.
 * Half: a long target keeps two tracks. Twice: neighbouring lanes and followers are one target.
 */
#define NEW_ALONG_SHARE 0.5f
#define NEW_ACROSS_SHARE 0.15f

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
/* Units of work: a plot compared with a body; with another plot; a plot or track passed over. */
enum { TEST_UNITS = 6, PAIR_UNITS = 2, PASS_UNITS = 1 };

#endif
