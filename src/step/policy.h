/* SPDX-License-Identifier: MIT */
/* policy: constants that no physics or parameter sets; tools/gates/mutate.py varies numbers. */
#ifndef RHOTRACK_STEP_POLICY_H
#define RHOTRACK_STEP_POLICY_H

/* Several files */

/*
 * Sigmas by which a speed or width is surely above its limit. Half: noise of a few plots ends fast
 * tracks and splits bodies. Twice: false tracks stay fast, and cars abreast keep one track.
 */
#define SURE_SIGMAS 2.0f

/* begin.c */

/*
 * White acceleration noise over accel_max_mps2, for a second: most targets manoeuvre below it.
 * Half: tracks lag in turns, and lose plots. Twice: gates are wider, estimates noisier.
 */
#define STEADY_SHARE 0.5f

/* initiate.c */
/*
 * Probability that a track's target exists from which on its plot starts no other track. Half:
 * tracks of clutter keep the plots of new targets. Twice: searches cost more.
 */
#define OWNS_PLOT 0.1f

/* bearing_looks.c */
/*
 * Sigmas by which noise may take a bearing out of its sensor's sector. Half: one bearing in forty
 * from the edge is left out. Twice: bearings that cannot have been measured are taken.
 */
#define BEARING_SIGMAS 4.0f

/* bearing_initiation.c */

/*
 * Tracks that a search challenges at most, those of fewest bearings. Half: swapped ones are seldom
 * challenged together. Twice: four times the crossings, and sixteen times the pairs of them.
 */
#define CHALLENGED_MAX (RHO_MAX_PASSIVE_TRACKS < 16u ? RHO_MAX_PASSIVE_TRACKS : 16u)

/*
 * Least margin of a found track over rival tracks of its bearings: ln of odds of 100 to 1. Half:
 * one start in ten may be a ghost. Twice: crossing targets start only after they have parted.
 */
#define MARGIN_MIN_MNAT 4605

/* claim.c */

/*
 * Gain of a confirmed track's plot, in nat, when its Hough residual falls by a factor of e; that of
 * tentative ones is 1: a residual a tenth smaller outweighs any gain of a tentative track. Half: a
 * residual must be a fifth smaller. Twice: a twentieth is enough.
 */
#define HOUGH_CONFIRMED_NAT 200.0f

/* merged_plots.c */

/*
 * Least hits of tracks that share a plot; a newer one may be a second track of the target. Half:
 * second tracks live on shared plots. Twice: pairs that meet soon after starts swap or end.
 */
#define SHARING_HITS 10

/* paper_starts.c */

/*
 * Sigmas of a line's plots from the motion fitted to its voters. Half: a third of the target's
 * plots are left out. Twice: plots of clutter near the line start tracks.
 */
#define LINE_SIGMAS 3.0f

/* speed_limits.c */

/* Sigmas below the slowest speed. Half: noise ends slow targets. Twice: standing objects stay. */
#define SLOW_SIGMAS 3.0f
/*
 * Speed of a track that is too fast, over v_max_mps, where its sigma is small. Half: targets
 * above 0.55 v_max end. Twice: false tracks at twice v_max stay.
 */
#define FAST_SHARE 1.1f
/* Successive fast updates that end a track. Half: one wrong plot does. Twice: false ones stay. */
#define FAST_UPDATES 3

/* split_bodies.c */

/*
 * ln evidence that the two tracks of a split are two targets. Half: cars abreast are one again
 * before they are known. Twice: halves of a car stay two.
 */
#define SPLIT_NAT 6.0f
/*
 * Least distance of the outermost plots of two targets, over the largest length or width of one.
 * Half: one body's plots are divided. Twice: a split waits until the targets are a body apart.
 */
#define PARTED_SHARE 0.5f
/* The same of range rates, in sigmas. Half: noise divides bodies. Twice: similar speeds are one. */
#define PARTED_SIGMAS 5.0f

/* update.c */

/* Probability of a manoeuvre above which a target may stop. Half or twice: see STOP_NAT. */
#define STOPS_ABOVE 0.5f
/*
 * Seconds of braking at accel_max in which a target that seems to stop at once may stop. Half: cars
 * at 40 km/h that stop hard are lost. Twice: tracks of fast targets branch at each miss.
 */
#define STOP_S 2.0f
/*
 * ln of the probability that a target that is missed, or manoeuvres, has stopped so. Half: the mean
 * of hypotheses moves at each miss. Twice: one stop in eight is found when a second track is there.
 */
#define STOP_NAT (-5.0f)

#endif
