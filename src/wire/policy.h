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
 * scan_admission.c: scan intervals of silence after which a sensor may have stopped: two may be
 * lost. Half: a sensor that loses a scan has no say against newcomers. Twice: newcomers wait longer
 * for a sensor that has gone.
 */
#define PRESENT_INTERVALS 3u

#endif
