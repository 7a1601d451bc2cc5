/* SPDX-License-Identifier: MIT */
/*
 * smallest: node configuration of least memory: one radar, eight tracks, 64 polar plots a turn,
 * nearest-plot gate.
 */
#define RHO_SCAN_KINDS 2
#define RHO_WORK_MAX 20000
#define RHO_MAX_SCANS 6
#define RHO_MAX_PLOTS 64
#define RHO_MAX_TRACKS 8
#define RHO_MAX_HYPOTHESES 1
#define RHO_MAX_SENSORS 1
#define RHO_MAX_CANDIDATES 8
#define RHO_MAX_ECHOES 0
#define RHO_FILTERS 1
#define RHO_MAX_OPEN_SCANS 1
#define RHO_SHARES_PLOTS 0
#define RHO_CLAIMS_BEYOND 0
#define RHO_AMBIGUOUS_RANGE_RATES 0
#define RHO_DOPPLER_NOTCH 0
#define RHO_MAX_REFLECTORS 0
#define RHO_MAX_EXCLUDED_AREAS 0
#define RHO_MAX_ZONES 0
#define RHO_MAX_CLUTTER_CELLS 0
#define RHO_SECTORS 0
#define RHO_FAST_UPDATES 0

#define NODE_RANGE_MAX_M 60000.0f
#define NODE_V_MAX_MPS 300.0f
#define NODE_ACCEL_MAX_MPS2 10.0f
