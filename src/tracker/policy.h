/* SPDX-License-Identifier: MIT */
/*
 * policy: constants of this room that neither physics nor a parameter sets; tools/gates/mutate.py
 * changes each.
 */
#ifndef RHOTRACK_TRACKER_POLICY_H
#define RHOTRACK_TRACKER_POLICY_H

/* Clutter and plots. */

/* expected_clutter.c */

/*
 * Weight of the newest scan in a smoothed count of plots: a memory of ten scans. Half: the density
 * follows changing clutter later. Twice: it follows the scatter of single scans.
 */
#define NEWEST_SCAN_WEIGHT 0.1f

/*
 * Radius of the circle that stands for a track's gate, sigmas of the track's place: all but one
 * per cent of its plots. Half: a quarter of the clutter is expected there. Twice: four times.
 */
#define GATE_CIRCLE_SIGMAS 3.0f

/* echo_clutter.c and second_plots.c */

/*
 * Hits from which a track that moves is of a target, and above which no track is taken for a second
 * one. Half: tracks of clutter take their returns out of the map. Twice: targets' plots stay in the
 * map for longer, and a neighbouring target's track may still end.
 */
#define TARGET_TRACK_HITS 12

/*
 * Weight of the prior of a learned rate, in looks or plots: of exact range rates, of a sensor's
 * second plots, and of its rate in that of a track. Half: the first plots decide. Twice: sensors
 * that differ from the prior are learned later.
 */
#define RATE_PRIOR_LOOKS 10.0f

/*
 * Looks or plots at which a sensor's learned sums are halved. Half: learned rates scatter more.
 * Twice: changes of a sensor are followed later.
 */
#define LOOKS_REMEMBERED 1000.0f

/* echo_clutter.c */

/*
 * Sigmas of both places by which a track has left its start; five are too few where one of its
 * first plots was clutter. Half: wandering tracks of clutter count as moved. Twice: slow targets
 * stay in the map for longer.
 */
#define MOVED_SIGMAS 8.0f

/*
 * Limit of the NIS of an echo's plot: e^-9 is cut off. Half: plots of an echo's edge raise no
 * density. Twice: nothing changes but the work, as the density there is nearly 0.
 */
#define ECHO_CHI2 18.0f

/*
 * Largest variance of an echo's place, as a share of its sensor's squared maximum range: a tenth of
 * the range. Half: echoes are forgotten in shorter silences. Twice: lost echoes cost work.
 */
#define ECHO_UNKNOWN_SHARE 0.01f

/*
 * Least share of the clutter density at a plot that an echo must explain to be updated with it.
 * Half: echoes are updated with chance plots. Twice: weak echoes start anew beside their place.
 */
#define ECHO_WEIGHT_MIN 0.3f

/*
 * Share of echoes' plots with exactly the range rate of the echo's own speed, before it is learned.
 * Half: masts are learned later. Twice: so are trees and water.
 */
#define ECHO_EXACT_PRIOR 0.3f

/*
 * Sigma of the range rates of half the other plots; the rest have any rate. Half: the rates of
 * swaying trees count as any. Twice: targets as slow as 2 m/s count as echoes.
 */
#define ECHO_RATE_SIGMA_MPS 1.0f

/*
 * Plots of three neighbouring directions above which a jammer's strobe is sought, and times the
 * usual number that they must exceed. Half: roads and coasts that run towards the sensor are
 * strobes. Twice: weak strobes start tracks.
 */
#define STROBE_PLOTS_MIN 8.0f
#define STROBE_TIMES_USUAL 6.0f

/*
 * Parts of the range, three quarters of which a strobe fills. Half: a few clusters in one direction
 * are a strobe. Twice: none is found, as the clutter map has a byte for the parts with plots.
 */
#define STROBE_RANGES 8u
#define STROBE_RANGES_MIN (STROBE_RANGES * 3u / 4u)

/* second_plots.c */

/*
 * Weight of the prior shares of distances, in plots. Half: the first second plots decide on the
 * distances. Twice: a sensor's own distances are learned later.
 */
#define SECOND_BINS_PRIOR 4.0f

/*
 * Second plots of a claimed plot before any is learned. Half: the first second plots start tracks.
 * Twice: targets beside others start later at first.
 */
#define SECOND_RATE_PRIOR 0.01f

/*
 * Looks at which a track's sums are halved: its aspect changes faster than the sensor. Half: the
 * rate scatters. Twice: it lags behind a target that turns.
 */
#define TRACK_LOOKS_REMEMBERED 50.0f

/*
 * Fewest hits of a track that teaches second plots: a neighbouring target has a track of its own by
 * then. Half: neighbours count as second plots. Twice: short tracks teach nothing.
 */
#define TEACHER_HITS 8

/*
 * ln of the odds that two tracks are of one target: above it the younger track ends; also the
 * largest change by one scan. Half: tracks of close targets end. Twice: second tracks stay longer.
 */
#define ONE_TARGET_END_NAT 3.0f

/*
 * Lower bound of these odds. Half: targets that were apart for long are one after a short approach.
 * Twice: a second track that once looked like a target stays longer.
 */
#define ONE_TARGET_LEAST_NAT (-4.0f)

/*
 * Evidence for one target by a merged plot, to which two near targets come, too. Half: two tracks
 * that share all plots stay longer. Twice: crossing targets lose a track.
 */
#define MERGED_NAT 0.3f

/*
 * Evidence for one target where the younger track has no plot, and the older one's is outside its
 * gate. Half: second tracks without plots stay longer. Twice: three misses end a new track.
 */
#define YOUNGER_MISS_NAT 1.0f

/* work_budget.c */

/*
 * One half of a phase is reserved for the tracks that wait, in even shares. Half (all of it): dense
 * places get no more than empty ones. Twice (a quarter): the last tracks score few plots.
 */
#define KEPT_PARTS 2u

/*
 * A track takes at most a quarter of the rest. Half: the first two tracks take most of it. Twice:
 * tracks in dense places score few of their plots although work is left.
 */
#define FREE_PARTS 4u

/*
 * Units of work, as measured: a plot scored by one hypothesis, in addition to move the hypothesis
 * to the plot's own time; the gate of a Kalman filter; in addition for a measured velocity in two or
 * three axes; an echo and a plot near it, and their range rates; a pair of plots near each other;
 * the image of a track, and a plot tested against an image.
 */
enum {
    SCORE_UNITS = 20,
    MOVE_UNITS = 60,
    GATE_UNITS = 12,
    VELOCITY_UNITS = 70,
    VELOCITY_3D_UNITS = VELOCITY_UNITS * 2,
    ECHO_UNITS = 4,
    ECHO_RATE_UNITS = 6,
    SECOND_UNITS = 12,
    IMAGE_UNITS = 12,
    IMAGE_TEST_UNITS = 3
};

/* resolution_cell.c */

/*
 * Weight of the default cell, and from which a learned cell is reported, in squared slopes of
 * pairs. Half: the first pairs decide on the cell. Twice: the cell is learned later.
 */
#define CELL_WEIGHT_FIRST 4.0f

/*
 * Largest weight that pairs add up to. Half: the cell scatters more. Twice: it follows a changed
 * sensor later.
 */
#define CELL_WEIGHT_MAX 200.0f

/*
 * Limit of the logarithm of a learned cell either way: cells of 0.3 to 19 sigmas. Half: only cells
 * of 0.8 to 7 sigmas are learned. Twice: wrong pairs may drive the cell to any size.
 */
#define CELL_LOG_MAX 4.2f

/* reflectors.c */

/*
 * Sigmas of a track's place by which the line of sight to its image may miss the wall. Half: images
 * at a wall's ends start tracks. Twice: plots beside the wall count as ghosts.
 */
#define BESIDE_WALL_SIGMAS 3.0f

/*
 * Fewest hits of a track whose images are looked for; one with fewer may be of clutter. Half: plots
 * at images of clutter start no tracks. Twice: images start tracks before their targets count.
 */
#define IMAGED_HITS 3

/*
 * Limit of the NIS of a track and an image in place and velocity: the 99.9 % quantile of chi-square
 * in four dimensions. Half: tracks of images stay. Twice: targets near images end.
 */
#define IMAGE_CHI2 18.5f

/*
 * Hits over looks below which also an established track may be an image. Half: images that are
 * often seen stay. Twice: every track that agrees with an image ends.
 */
#define IMAGE_SHARE 0.6f

#endif
