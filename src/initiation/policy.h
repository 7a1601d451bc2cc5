/* SPDX-License-Identifier: MIT */
/* policy: constants that no physics or parameter sets; tools/gates/mutate.py varies numbers. */
#ifndef RHOTRACK_INITIATION_POLICY_H
#define RHOTRACK_INITIATION_POLICY_H

/* candidates.c */

/*
 * Most plots that two accepted candidates may share: one where their tracks cross. Half (none): of
 * two crossing targets one loses a plot. Twice: one target may start two tracks.
 */
#define SHARED_PLOTS_MAX 1u
/*
 * Factor of the gate's variance for plots that better candidates have left, wider than that of a
 * fit, as a neighbour's plots may have biased it. Half: the fit misses its own plots. Twice: it
 * takes those of a neighbour.
 */
#define SECOND_GATE_FACTOR 2.5f

/* clutter_density.c */

/*
 * Mean number of plots in a cell of a density map: its count has an error of 18 %. Half: hot spots
 * show better, and densities scatter more. Twice: the reverse.
 */
#define PLOTS_PER_CELL 32u
/*
 * Largest weight of the mean density against a cell's count, in plots: the map is then flat. Half
 * or twice: no difference, as no cell has that many plots.
 */
#define PRIOR_PLOTS_MAX 1.0e6f
/*
 * Plots expected in area and window where none was seen, in searches after every scan: the median
 * without prior knowledge. Half: tracks start more easily in clear skies. Twice: later.
 */
#define PLOTS_UNSEEN 0.5f
/*
 * Share of a radar's range below which the density per square metre rises no further. Half: nearer
 * clutter counts as up to twice as dense. Twice: as half as dense.
 */
#define NEAR_SHARE 0.01f
/*
 * Width of a sector from which a radar looks all round. Half: sectors of 150 degrees have a map of
 * the whole circle, whose mean is too low. Twice: all round, a seam lies among the plots.
 */
#define ALL_ROUND_RAD 5.0f

/* clutter_memory.c */

/*
 * Remembered scans at which all counts are halved: the memory is 64 to 128 scans long. Half: small
 * hot spots do not stand out. Twice: clutter that has ended raises thresholds for longer.
 */
#define MEMORY_SCANS_MAX 128u
/*
 * Excess of a cell's count, in standard deviations, from which the memory raises the density. Half:
 * random counts raise it in many cells. Twice: hot spots are found late, or not at all.
 */
#define MEMORY_SIGMAS 3.0f
/*
 * Margin of the memory's cells at each border, as a share of the area's sides. Half: a growing area
 * clears the memory more often. Twice: cells are wider.
 */
#define MEMORY_MARGIN 0.25f
/*
 * Sides of the memory over those of the area from which its cells are laid out anew. Half: an area
 * that shrinks a little clears the memory. Twice: cells are too wide for hot spots.
 */
#define MEMORY_TOO_WIDE 4.0f

/* false_track_rate.c */

/*
 * Ratio of the variances of a tentative track's prediction and of a plot, as determinants of both
 * axes. Half: a hit of clutter counts for more, and tracks are confirmed later. Twice: for less.
 */
#define PREDICTION_SPREAD 4.0f
/*
 * Margin by which sets may score above the perfect fit of their pattern: votes may be nearer to one
 * another than on average, and their own plots are not in the density. Half: sets of long spans
 * with few hits are not tried. Twice: more kernels are tried for nothing.
 */
#define BEST_MARGIN_NAT 2.0f

/* initiator.c */

/*
 * Longest interval between scans that counts in the usual one, in medians: a pause counts as that.
 * Half: changing intervals count as pauses. Twice: a pause lengthens the usual interval.
 */
#define PAUSE_GAPS 3.0f

/* plot_pair_enumeration.c */

/*
 * Largest gate, as a share of a target's travel, for which a box of first plots is not cut off at
 * the places that a target can reach. Half or twice: only the time of a search changes.
 */
#define NARROW_SHARE 0.25f
/*
 * Costs in plots compared, for the choice between the two ways of enumeration: the test of a first
 * plot; a look-up, and as much for a kernel. Half or twice: the dearer way is taken more often.
 */
#define FIRST_PLOTS 0.5f
#define LOOKUP_PLOTS 3.0f
/*
 * For the same choice: look-ups of a pair, on average, and the share of the plots in a gate's
 * square that are in the gate. Half or twice: the dearer way is taken more often.
 */
#define LOOKUPS_OF_PAIR 2.0f
#define SHARE_IN_GATE 0.5f
/*
 * Factor by which rounding may increase the distance of a vote from its kernel. Half: kernels with
 * good votes are lost. Twice: kernels are tried for nothing.
 */
#define GATE_ROUNDING 1.001f

/* plot_pair_votes.c, target_model.c */

/*
 * Largest climb or sink rate of targets, as a share of v_max. Half: targets that climb steeply do
 * not start. Twice: heights exclude fewer kernels of clutter.
 */
#define CLIMB_SHARE 0.5f

/* plot_set.c */

/*
 * Variance of a plot about the fitted track over the plot's own: 1 + leverage, which is 1.46 at the
 * ends of seven evenly spread hits; a turn's acceleration makes these less certain. Half: targets
 * lose plots. Twice: clutter is taken.
 */
#define FIT_GATE_FACTOR 1.5f
#define TURN_GATE_FACTOR (FIT_GATE_FACTOR * 2.0f)
/*
 * Rounds of association and fit. Half: plots that only the second fit is near to are missed. Twice:
 * hardly a difference, as most sets stay the same after one round.
 */
#define FIT_ROUNDS 2

/* recurring_clutter_map.c */

/*
 * Prior standard deviation of an echo's speed on each axis, as a share of the slowest target's
 * speed. Half: drifting clutter is lost. Twice: echoes follow slow targets.
 */
#define ECHO_SPEED_SHARE 0.4f
/*
 * Share of a plot's variance that it adds to the variance of its echo's place: a quay has plots at
 * several places. Half: old echoes miss some of these. Twice: echoes stay wide and explain less.
 */
#define PLACE_NOISE 0.02f
/*
 * Mean age of the counts of looks and returns, in revolutions. Half: probabilities of return
 * scatter more. Twice: they follow the weather later.
 */
#define TURNS_REMEMBERED 200.0f
/*
 * Revolutions in a block of counts, which are used one to two blocks later, as the first plots of a
 * target are counted until its track starts. Half: plots of targets that start late count as
 * clutter's. Twice: a new map is used later.
 */
#define BLOCK_TURNS 4.0f
/*
 * Prior probability of a return where targets may stand: standing plots are then clutter less
 * often. Half: standing clutter starts tracks for longer. Twice: standing targets start later.
 */
#define PRIOR_PROBABILITY_STANDING 0.003f
/*
 * Weights in looks: of the prior probability, and of the mean over all regions in one region. Half:
 * new maps and regions with few echoes follow chance. Twice: they learn more slowly.
 */
#define PRIOR_LOOKS 3.0f
#define REGION_LOOKS 2.0f
/*
 * Largest probability of a return: no echo is certain. Half: towers leave half of their plots to
 * tracks. Twice: above 1.
 */
#define PROBABILITY_MAX 0.98f
/*
 * Seconds in which an echo that no scan covers counts as missed once. Half: a full table drops
 * echoes outside of a sector sooner. Twice: later than those that were looked at.
 */
#define MISSED_S 60.0f
/*
 * Square of the ratio of speed to its standard deviation above which an echo counts as moving: 4
 * sigma. Half: standing echoes move by chance, and are not saved. Twice: slow ones are saved.
 */
#define MOVES_SIGMAS2 16.0f
/* Most looks or returns that are taught or sound. Half or twice: float32 counts them as well. */
#define ECHO_LOOKS_MAX 1e9f

/* search_order.c */

/*
 * Part of a scan's work that is kept for the selection among candidates: one in CHOICE_SHARE. Half:
 * fewer kernels. Twice: in dense scans candidates are dropped without a choice.
 */
#define CHOICE_SHARE 4u
/*
 * Of the work for the newest plots one part in PLOT_KEPT_SHARE is reserved, in equal shares, for
 * the plots not tried yet. Half: dear plots are left out. Twice: they take the work of the rest.
 */
#define PLOT_KEPT_SHARE 2u
/*
 * A plot may take one part in PLOT_FREE_PARTS of the work that is not reserved. Half: the first
 * dear plots take most of it. Twice: none of them is finished.
 */
#define PLOT_FREE_PARTS 4u
/*
 * Work on kernels of turning targets, at most: as much as straight ones took; one part in
 * TURN_SHARE_OF_PLACES of that where plots have positions alone, which hardly reveal turns; at
 * least ten fits. Half: more work for few more starts. Twice: turns in clutter start later.
 */
#define TURN_SHARE_OF_PLACES 8u
#define TURN_UNITS_MIN (FIT_UNITS * 10u)

/* start_thresholds.c */

/*
 * Most sets of clutter plots that may start a tentative track, expected a search, which later scans
 * confirm or drop; in a batch, most false tracks. Half: targets start later. Twice: tentative
 * tracks take the plots of targets.
 */
#define FALSE_STARTS_MAX 0.1f
/*
 * Bounds of thresholds, in nats: every track in the gates reaches the lower one. Half: of the lower
 * one, tracks in clear skies start later; of the upper one, dense clutter starts false tracks.
 * Twice: the bisection is less fine.
 */
#define THRESHOLD_MIN_NAT (-10.0f)
#define THRESHOLD_MAX_NAT 60.0f
/*
 * Step of the score that a tentative track of clutter still lacks, in the table of probabilities to
 * climb to the confirm threshold. Half: climbs of more than 12 nat count as impossible. Twice:
 * thresholds are rougher.
 */
#define CLIMB_STEP 0.5f
/*
 * Prior share of targets that turn, and share of the wanted false tracks that turning sets may add.
 * Half: turning targets start later. Twice: they add a fifth of false tracks.
 */
#define TURNING_SHARE 0.1f
/*
 * Clutter counts as thin below this share of the thinnest sampled clutter: places of one class
 * differ by about as much. Half: fewer plots may end sets of M hits. Twice: kernels are tried that
 * can start no track.
 */
#define THIN_SHARE 0.9f

#endif
