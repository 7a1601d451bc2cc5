/* SPDX-License-Identifier: MIT */
/*
 * my_config: capacities for one small radar: 64 plots a scan, 8 tracks; all others are the embedded
 * profile's. README.md has the RAM they take, rhotrack/config.h their meaning.
 */
#define RHO_MAX_SCANS 5
#define RHO_MAX_PLOTS 64
#define RHO_MAX_ECHOES 32 /* places of recurring clutter, in the clutter map */
#define RHO_ECHO_REGIONS 1
#define RHO_STROBE_BINS 120
#define RHO_MAX_CANDIDATES 8
#define RHO_MAX_TRACKS 8
#define RHO_MAX_HYPOTHESES 24
#define RHO_MAX_GATE_PLOTS 4
#define RHO_MAX_SENSORS 1
#define RHO_MAX_OPEN_SCANS 1
#define RHO_MAX_PARTS 4

/* One radar whose scans are whole turns, without ambiguous range rates. */
#define RHO_SECTORS 0
#define RHO_AMBIGUOUS_RANGE_RATES 0
