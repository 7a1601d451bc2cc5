/* SPDX-License-Identifier: MIT */
/* policy: constants that no physics or parameter sets; tools/gates/mutate.py varies numbers. */
#ifndef RHOTRACK_BEARINGS_POLICY_H
#define RHOTRACK_BEARINGS_POLICY_H

/* best_subset.c */

/*
 * Smallest gain of a total score that counts, so that rounding does not keep exchanges going. Half
 * or twice: still far above rounding and below a bearing's worth.
 */
#define GAIN_MIN_NAT 1.0e-3f
/*
 * Best candidates from which choices start. Half: targets behind ghosts of the lower half stay
 * hidden. Twice: the time.
 */
#define BEST_TRIED 12u
/*
 * Share of a candidate's bearings at which another is the same target for the margin. Half: targets
 * side by side count as one. Twice: other fits of the target take its place, and margins vanish.
 */
#define SAME_TARGET_SHARE 0.7f
/*
 * Distance at which another candidate is where a target is: it makes the target no less certain.
 * Half: the choice of bearings of targets side by side keeps both from starting. Twice: ghosts near
 * a target count as it.
 */
#define SAME_TARGET_SIGMAS 5.0f

/* recent_bearing_frames.c */

/*
 * Age in intervals at which a row waits for no sensor more. Half: sensors that look in turn fall
 * into rows of two halves. Twice: a missed look is waited for, and the sensor's next one joins.
 */
#define ROW_INTERVALS 0.9f
/*
 * Longest interval that a row waits for, in shortest ones. Half: finders of unlike turns fall into
 * rows of their own. Twice: one sensor that looks now and then makes all starts late.
 */
#define ROW_RATIO 4.0f

/* bearing_match.c */

/*
 * Bearings farther than this from the predicted bearing never match: a hypothesis through two
 * crossings has several times a bearing's error. Half: true hypotheses look empty. Twice: ghosts
 * agree with bearings of others, and take the places of the partners that are kept.
 */
#define MATCH_SIGMAS 6.0f

/* candidate_list.c */

/*
 * Share at which the lower of two candidates is dropped as a duplicate. Half: targets side by side
 * lose theirs. Twice: no candidate is dropped, and the list fills.
 */
#define DUPLICATE_SHARE 0.8f

/* known_tracks.c */

/*
 * What a track that is followed has over a new one of equal score. Half: tracks are exchanged for
 * the noise of their bearings. Twice: tracks of swapped bearings stay.
 */
#define KNOWN_NAT 10.0f

/* passive_crossings.c */

/*
 * A third sensor's bearing within this of a crossing supports it. Half: one true crossing in eight
 * has no support. Twice: ghosts find support by chance.
 */
#define SUPPORT_SIGMAS 3.0f

/*
 * Largest uncertainty of a place, in its range: beyond it two bearings tell no range. Half: what is
 * far from a short base is not found. Twice: sensors side by side cross anywhere.
 */
#define RANGE_SHARE 0.4f

/* passive_fit.c */

/*
 * Gate of a track's bearings, 99.95 % of them. Half: one bearing in twelve is a miss. Twice: false
 * bearings pull the fit.
 */
#define BEARING_GATE_SIGMAS 3.5f
/*
 * Sigma of the motion model: it limits the weight of bearings taken near a sensor. Half or twice:
 * four times more or less weight at most, felt only within some hundred metres.
 */
#define EXACT_M 1.0f
/*
 * Largest change of a state component in a step, in range_max_m. Half: bad starts do not arrive in
 * four steps. Twice: they overshoot.
 */
#define STEP_MAX_RANGES 0.1f
/*
 * Largest magnitude of a state component, in range_max_m. Half: positions at the limit of range are
 * clipped. Twice: diverged fits lose more digits.
 */
#define POSITION_MAX_RANGES 2.0f

/* joint_fit.c */

/* Rounds of assignment and fit. Half: assignments of the start stay. Twice: hardly any change. */
#define FIT_ROUNDS 3u

/* starts.c */

/*
 * Least share of the rows between the crossings of a pair. Half: pairs whose velocity is noise fill
 * the lists. Twice: a target that missed at an end of the rows has no pair.
 */
#define PAIR_ROWS_SHARE 0.34f
/*
 * Margin above v_max_mps for the speed of a pair, as crossings are inaccurate before the fit. Half:
 * some fast targets get no hypothesis. Twice: more hypotheses that cannot be tracks.
 */
#define SPEED_SLACK_MPS 150.0f
/* Pairs that are fitted in a pass. Half: true pairs are missed among ghosts. Twice: the time. */
#define FITS_MAX (2u * RHO_MAX_PASSIVE_CANDIDATES)

/* passive_prepare.c */

/*
 * Floor of the number of false bearings a look, so that an empty sky does not make every bearing
 * certain. Half or twice: 0.7 nat more or less a bearing where there are few.
 */
#define FALSE_MIN 0.3f
/*
 * Largest ratio of sigmas: float32 has too few digits for the normal equations of very different
 * bearings. Half: the most exact bearings count a quarter. Twice: two bits more are lost.
 */
#define SIGMA_RATIO_MAX 200.0f

#endif
