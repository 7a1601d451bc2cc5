/* SPDX-License-Identifier: MIT */
/*
 * Capacities of one small radar: 64 plots a scan, 8 tracks. What is not named here has the embedded
 * profile's value. README.md beside says what RAM that takes; rhotrack/config.h, what each means.
 */
#define RHO_MAX_SCANS 5
#define RHO_MAX_PLOTS 64
#define RHO_MAX_ECHOES 32 /* of clutter that comes back */
#define RHO_ECHO_REGIONS 1
#define RHO_STROBE_BINS 120
#define RHO_MAX_CANDIDATES 8
#define RHO_MAX_TRACKS 8
#define RHO_MAX_HYPOTHESES 24
#define RHO_MAX_GATE_PLOTS 4
#define RHO_MAX_SENSORS 1
#define RHO_MAX_OPEN_SCANS 1
#define RHO_MAX_PARTS 4

/* Its scans are whole turns, and it is alone; its range rates, if it has any, are not ambiguous. */
#define RHO_SECTORS 0
#define RHO_AMBIGUOUS_RANGE_RATES 0
