/* SPDX-License-Identifier: MIT */
/*
 * policy: constants of this room that neither physics nor a parameter sets; tools/gates/mutate.py
 * changes each.
 */
#ifndef RHOTRACK_INITIATION_POLICY_H
#define RHOTRACK_INITIATION_POLICY_H

/* candidates.c */

/*
 * Most plots that two accepted candidates may share: one where their tracks cross. Half (none): of
 * two crossing targets one loses a plot. Twice: one target may start two tracks.
 */
#define SHARED_PLOTS_MAX 1u
/*
 * Factor of the gate's variance when a candidate is associated with the plots that better ones have
 * left, wider than that of a fit, as a neighbour's plots may have biased it. Half: the biased fit
 * misses its own plots. Twice: it takes those of a neighbour.
 */
#define SECOND_GATE_FACTOR 2.5f

/* clutter_density.c */

/*
 * Mean number of plots in a cell of a density map, whose count then has an error of 18 %. Half:
 * hot spots show better, and densities scatter more. Twice: the reverse.
 */
#define PLOTS_PER_CELL 32u
/*
 * Least number of plots that determine the sector of a radar for a map of range and azimuth: half a
 * cell's. Half: chance decides on the kind of map. Twice: thin clutter keeps the square map.
 */
#define POLAR_PLOTS_MIN (PLOTS_PER_CELL / 2u)
/*
 * Largest weight of the mean density against a cell's count, in plots: the map is then flat. Half
 * or twice: no difference, as no cell has that many plots.
 */
#define PRIOR_PLOTS_MAX 1.0e6f
/*
 * Plots expected where none was seen, in searches after every scan: the median of a density without
 * prior knowledge, in area and window. Half: tracks start more easily in clear skies. Twice: later.
 */
#define PLOTS_UNSEEN 0.5f
/*
 * Share of a radar's range below which the density per square metre rises no further. Half or
 * twice: near the radar clutter counts as up to twice as dense, or as half.
 */
#define NEAR_SHARE 0.01f
/*
 * Width of a sector from which a radar counts as looking all round. Half: sectors of 150 degrees
 * get a map of the whole circle, whose mean is too low. Twice: no radar looks all round, and the
 * seam of the sector lies among its plots.
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
 * random counts raise it in every tenth cell. Twice: hot spots are found late, or not at all.
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
 * axes: the prediction is as uncertain as the plot. Half: a further plot of clutter counts for
 * more, and tracks are confirmed later. Twice: earlier, with more false ones.
 */
#define PREDICTION_SPREAD 4.0f
/*
 * Margin by which sets may score higher than the model's perfect fit of their pattern: votes may be
 * nearer to each other than on average, and the set's own plots are not in the density. Half: sets
 * of long spans with few hits are not tried. Twice: more kernels are tried for nothing.
 */
#define BEST_MARGIN_NAT 2.0f

/* initiator.c */

/*
 * Longest interval between scans that counts in the usual interval, in medians: a pause counts as
 * that. Half: regular changes of the interval count as pauses. Twice: a pause lengthens the usual
 * interval, so that fewer false tracks are expected an hour than there are.
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
 * plot; a look-up, and as much for a kernel; look-ups of a pair, on average; and the share of the
 * plots in a gate's square that are in the gate. Half or twice: the dearer way is taken more often.
 */
#define FIRST_PLOTS 0.5f
#define LOOKUP_PLOTS 3.0f
#define LOOKUPS_OF_PAIR 2.0f
#define SHARE_IN_GATE 0.5f

/* plot_pair_enumeration.c, plot_pair_votes.c */

/*
 * Factor by which rounding may increase the distance of a vote from its kernel. Half its excess
 * over 1 is still far above float32's 6e-8 a sum. Twice: a few more kernels are tried.
 */
#define GATE_ROUNDING 1.001f

/* plot_pair_votes.c, target_model.c */

/*
 * Largest climb or sink rate of targets, as a share of v_max. Half: fighters that climb steeply do
 * not start. Twice: heights exclude fewer kernels of clutter.
 */
#define CLIMB_SHARE 0.5f

/* plot_set.c */

/*
 * Variance of a plot about the fitted track over the plot's own: 1 + leverage, which is 1.46 at the
 * ends of seven evenly spread hits. Half: targets lose plots. Twice: clutter is taken. With a
 * turn's acceleration the ends of a fit are less certain.
 */
#define FIT_GATE_FACTOR 1.5f
#define TURN_GATE_FACTOR (FIT_GATE_FACTOR * 2.0f)
/*
 * Rounds of fit and association. Half: a plot of clutter that voted stays in the set. Twice: hardly
 * a difference, as most sets stay the same after one round.
 */
#define FIT_ROUNDS 2

/* recurring_clutter_map.c */

/*
 * Prior standard deviation of an echo's speed on each axis, as a share of the slowest target's
 * speed. Half: drifting clutter is lost. Twice: echoes follow slow targets.
 */
#define ECHO_SPEED_SHARE 0.4f
/*
 * Share of a plot's variance that each plot adds to the variance of its echo's place: a quay or a
 * tree has plots at several places within their noise. Half: old echoes miss such plots. Twice:
 * echoes of a tower stay wide, and explain less.
 */
#define PLACE_NOISE 0.02f
/*
 * Mean age of the counts of looks and returns, in revolutions. Half: probabilities of return
 * scatter more. Twice: they follow the weather later.
 */
#define TURNS_REMEMBERED 200.0f
/*
 * Revolutions in a block of counts. Counts are used one to two blocks after they were made, as the
 * first plots of a target are counted before its track starts, and are taken out when it does.
 * Half: plots of targets that start late count as clutter's. Twice: a new map is used later.
 */
#define BLOCK_TURNS 4.0f
/*
 * Prior probability of a return where targets may stand: standing plots are then clutter less
 * often. Half: standing clutter starts tracks for longer. Twice: standing targets start later.
 */
#define PRIOR_PROBABILITY_STANDING 0.003f
/* Weight of the prior probability, in looks. Half or twice: a new map learns faster, or slower. */
#define PRIOR_LOOKS 3.0f
/*
 * Weight of the mean over all regions in the return probability of one region, in looks. Half:
 * regions with few echoes follow chance. Twice: differences between regions show later.
 */
#define REGION_LOOKS 2.0f
/*
 * Largest probability of a return: no echo is certain. Half: towers leave half of their plots to
 * tracks. Twice: above 1, and a miss of a learned echo has no probability.
 */
#define PROBABILITY_MAX 0.98f
/*
 * Seconds in which an echo that no scan covers counts as missed once. Half: echoes outside of a
 * sector are dropped sooner from a full table. Twice: later than those that were looked at.
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
 * Of the work for the newest plots, one part in PLOT_KEPT_SHARE is reserved in equal shares for the
 * plots not tried yet. Half: each plot has the same share, and dear plots are left out. Twice: a
 * few dear plots take the work of the rest.
 */
#define PLOT_KEPT_SHARE 2u
/*
 * A plot may take one part in PLOT_FREE_PARTS of the work that is not reserved. Half: the first dear
 * plots take most of it. Twice: none of them is finished.
 */
#define PLOT_FREE_PARTS 4u
/*
 * Work on kernels of turning targets, at most: as much as straight ones took; one part in
 * TURN_SHARE_OF_PLACES of that where plots have positions alone, which hardly reveal turns. Half:
 * twice the work for few more starts. Twice: turning targets start later in clutter.
 */
#define TURN_SHARE_OF_PLACES 8u
/* And at least ten fits, which few plots need. Half or twice: in nearly clear skies as above. */
#define TURN_UNITS_MIN (FIT_UNITS * 10u)

/* start_thresholds.c */

/*
 * Most sets of clutter plots that may start a tentative track, expected a search; later scans
 * confirm or drop such tracks. In a batch: most false tracks, from which M follows. Half: targets
 * start later. Twice: tentative tracks take the plots of targets.
 */
#define FALSE_STARTS_MAX 0.1f
/*
 * Bounds of thresholds, in nats: every track in the gates reaches the lower one. Half or twice of
 * the lower: tracks in clear skies start later, or no difference. Of the upper: dense clutter
 * starts false tracks, or the bisection is half as fine.
 */
#define THRESHOLD_MIN_NAT (-10.0f)
#define THRESHOLD_MAX_NAT 60.0f
/*
 * Step of the score that a tentative track of clutter still lacks, in the table of probabilities to
 * climb to the confirm threshold. Half: the table ends at 12 nat, and counts climbs from below as
 * impossible. Twice: thresholds are rougher.
 */
#define CLIMB_STEP 0.5f
/*
 * Prior share of targets that turn, and share of the wanted false tracks that turning sets may add.
 * Half: turning targets start later. Twice: they add a fifth of false tracks.
 */
#define TURNING_SHARE 0.1f
/*
 * Clutter counts as thin below this share of the thinnest sampled clutter: places of one class
 * differ by about as much. Half: fewer plots may end sets of M hits. Twice: sampled places count as
 * thin, and kernels are tried that can start no track.
 */
#define THIN_SHARE 0.9f

#endif
