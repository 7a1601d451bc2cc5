/* SPDX-License-Identifier: MIT */
/* policy: constants that no physics or parameter sets; tools/gates/mutate.py varies numbers. */
#ifndef RHOTRACK_MEASUREMENT_POLICY_H
#define RHOTRACK_MEASUREMENT_POLICY_H

/*
 * Least angle between the bearings of a crossing, bearing_crossing.c: the sine of a smaller one has
 * no significant digits. Half: crossings whose range is mostly rounding. Twice: pairs a little less
 * parallel count as parallel; either way their crossing is beyond any sensor's range.
 */
#define DELTA_MIN_RAD 1.0e-6f

/*
 * Blind zones farther from the expected range rate than this many sigmas are ignored,
 * doppler_notch.c: together they hold 6e-5 of a normal distribution. Half: up to 5 % are lost.
 * Twice: the same probabilities at twice the cost, and with densely spaced zones the uniform case
 * comes sooner.
 */
#define ZONE_SIGMAS 4.0f
/*
 * With more blind zones within that span all range rates count as equally likely, which bounds the
 * cost. Half: the approximation already where zones are 1.8 sigmas apart. Twice: twice the worst
 * cost for probabilities that agree already.
 */
#define ZONES_MAX 9
/*
 * Least and largest ratio of a range rate's variance after a miss to the variance before. Half or
 * twice the least: a row of misses in a narrow notch sharpens the estimate more, or less, than the
 * notch's model deserves. Half or twice the largest: a variance that grows by leaps at each miss
 * between two zones, or hardly.
 */
#define KEPT_MIN 0.01f
#define KEPT_MAX 4.0f
/*
 * Least probability that a miss was due to the notch at which the target is assumed to stand: the
 * likelier explanation. Half: targets missed for another reason are stopped. Twice: none stands.
 */
#define STAND_SHARE 0.5f

/*
 * Standard deviations of the expected range rate that half the span of ambiguous range rates must
 * hold, measurement.c: 0.3 % wrong multiples. Half: 13 % wrong. Twice: clear range rates are lost.
 */
#define CLEAR_SIGMAS 3.0f

#endif
