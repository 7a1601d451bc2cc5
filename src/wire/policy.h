/* SPDX-License-Identifier: MIT */
/* policy: constants that no physics or parameter sets; tools/gates/mutate.py varies numbers. */
#ifndef RHOTRACK_WIRE_POLICY_H
#define RHOTRACK_WIRE_POLICY_H

/*
 * scan_admission.c: tolerated jitter of the time between two scans of a sensor. It counts beside
 * intervals of tens of milliseconds; of longer ones, half is tolerated anyway. Half: scans of fast
 * sensors that jitter are refused for their times. Twice: wrong times of fast sensors pass.
 */
#define JITTER_US 10000

/*
 * scan_admission.c: jump_max_us over the tolerated difference of two sensors' clocks, which hold_us
 * adds to. Half: a clock twice as far ahead is followed, and the other sensors' scans are out of
 * sequence beside it. Twice: a sensor with a slow network is taken for one with a wrong clock.
 */
#define CLOCK_OFFSET_SHARE 8

/*
 * scan_admission.c: jump_max_us over the largest error, with hold_us, of a sensor's time by its own
 * clock. Half: steps of a second pass, and tracks are off by them. Twice: scans of a radar with
 * uneven turns on a network that jitters by .3 s are refused.
 */
#define OWN_CLOCK_SHARE 64

/*
 * scan_admission.c: jump_max_us in which the delay of a sensor's network is forgotten. Half: after
 * 15 s without a network, scans that then come at once are refused. Twice: a clock that is set back
 * slowly is followed for longer.
 */
#define DELAY_JUMPS 2u

/*
 * scan_admission.c: scan intervals of silence after which a sensor may have stopped: two may be
 * lost. Half: a sensor that loses a scan has no say against newcomers. Twice: newcomers wait longer
 * for a sensor that has gone.
 */
#define PRESENT_INTERVALS 3u

#endif
