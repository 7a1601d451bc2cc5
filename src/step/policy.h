/* SPDX-License-Identifier: MIT */
/*
 * policy: constants of this room that neither physics nor a parameter sets; tools/gates/mutate.py
 * changes each.
 */
#ifndef RHOTRACK_STEP_POLICY_H
#define RHOTRACK_STEP_POLICY_H

/* Several files */

/*
 * Standard deviations by which a speed or a width is surely above its limit. Half: noise of a few
 * plots ends fast tracks and splits bodies. Twice: false tracks stay fast for longer, and cars
 * abreast keep one track.
 */
#define SURE_SIGMAS 2.0f

/* begin.c */

/*
 * White acceleration noise of tracks, over accel_max_mps2, kept up for a second: most targets
 * manoeuvre below their limit. Half: tracks lag in turns, and lose plots. Twice: gates are wider,
 * and estimates noisier.
 */
#define STEADY_SHARE 0.5f

/* bearing_looks.c */

/*
 * Standard deviations by which a bearing may lie outside of its sensor's sector: its noise may take
 * it there. Half: one bearing in forty from the edge is left out. Twice: bearings that the sensor
 * cannot have measured are taken.
 */
#define BEARING_SIGMAS 4.0f

/* bearing_initiation.c */

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
 * Least hits of tracks that share a plot: a newer track may be a second one of the same target.
 * Half: second tracks live on shared plots. Twice: pairs that meet soon after their starts swap or
 * end.
 */
#define SHARING_HITS 10

/*
 * ln of the probability that a pair stays merged for another scan. Half: a pair that never parts is
 * two tracks for some 100 scans. Twice: for some 25, and slow crossings lose a track.
 */
#define STAY_MERGED_NAT (-0.1f)

/* paper_starts.c */

/*
 * Standard deviations within which a line's plots are, from the motion fitted to its voters. Half:
 * a third of the target's plots are left out, and lines are too short. Twice: plots of clutter near
 * the line start tracks.
 */
#define LINE_SIGMAS 3.0f

/* speed_limits.c */

/*
 * Standard deviations of a speed that is surely below the slowest target's. Half: slow targets are
 * ended by noise. Twice: tracks of standing objects stay for longer.
 */
#define SLOW_SIGMAS 3.0f

/*
 * Speed of a track that is too fast, over v_max_mps, where its sigma is small. Half: targets at
 * v_max end, as its estimate may be a little larger. Twice: false tracks at twice v_max stay.
 */
#define FAST_SHARE 1.1f

/*
 * Successive updates at such speeds that end a track. Half: one wrong plot ends it. Twice: false
 * tracks stay for three more scans.
 */
#define FAST_UPDATES 3

/* split_bodies.c */

/*
 * Largest width of one body, over the length of the longest body. Half: lorries are split. Twice:
 * cars abreast keep one track.
 */
#define WIDEST_SHARE 0.3f

/*
 * Plots of a body before its width counts: with fewer, its first heading may still be wrong. Half:
 * bodies seen from the side first are split. Twice: two targets have one track for longer.
 */
#define SETTLED_PLOTS 100.0f

/*
 * Least distance of the outermost plots of two targets, over the largest length or width of one.
 * Half: one body's plots are divided. Twice: a split waits until the targets are a body apart.
 */
#define PARTED_SHARE 0.5f

/*
 * The same of range rates, in their standard deviations. Half: noise divides one body's plots.
 * Twice: targets whose speeds differ little have one track for longer.
 */
#define PARTED_SIGMAS 5.0f

#endif
