/* SPDX-License-Identifier: MIT */
/*
 * finders: node configuration for four direction finders or cameras, each of one look a second with
 * at most 16 bearings, and eight targets. Capacities and work are what a quarter of a second has
 * time for: sixteen places a row, of which the bearings of all sensors tell the likely.
 */
#define RHO_MAX_PASSIVE_SENSORS 4
#define RHO_MAX_BEARINGS 16
#define RHO_WORK_MAX 150000
#define RHO_MAX_PASSIVE_POINTS 128
#define RHO_MAX_PASSIVE_CANDIDATES 24
#define RHO_SCAN_KINDS 4
#define RHO_MAX_SCANS 3
#define RHO_MAX_PLOTS 64
#define RHO_MAX_TRACKS 16
#define RHO_MAX_HYPOTHESES 48
#define RHO_MAX_ECHOES 0
#define RHO_MAX_CLUTTER_CELLS 0
#define RHO_MAX_SENSORS 4
#define RHO_MAX_OPEN_SCANS 4
#define RHO_FILTERS 4
#define RHO_SECTORS 0
#define RHO_SHARES_PLOTS 0
#define RHO_CLAIMS_BEYOND 0
#define RHO_AMBIGUOUS_RANGE_RATES 0
#define RHO_DOPPLER_NOTCH 0
#define RHO_MAX_REFLECTORS 0
#define RHO_MAX_EXCLUDED_AREAS 0
#define RHO_MAX_ZONES 0

#define NODE_RANGE_MAX_M 100000.0f
#define NODE_V_MAX_MPS 450.0f
