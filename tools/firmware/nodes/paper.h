/* SPDX-License-Identifier: MIT */
/*
 * paper: node configuration with the papers' methods: neutrosophic Hough transform of plots, ghost
 * matrix and passive Hough transform of bearings, Kalman filter with input estimation, Hough gate.
 * One radar and three passive sensors.
 */
#define RHO_MAX_SCANS 4
#define RHO_MAX_PLOTS 128
#define RHO_MAX_TRACKS 16
#define RHO_MAX_HYPOTHESES 1
#define RHO_MAX_CANDIDATES 8
#define RHO_MAX_ECHOES 0
#define RHO_MAX_CLUTTER_CELLS 0
#define RHO_MAX_SENSORS 4
#define RHO_MAX_OPEN_SCANS 4
#define RHO_FILTERS 2
#define RHO_SEARCHES 0
#define RHO_SECTORS 0
#define RHO_SHARES_PLOTS 0
#define RHO_CLAIMS_BEYOND 0
#define RHO_AMBIGUOUS_RANGE_RATES 0
#define RHO_DOPPLER_NOTCH 0
#define RHO_MAX_REFLECTORS 0
#define RHO_MAX_EXCLUDED_AREAS 0
#define RHO_MAX_ZONES 0

#define NODE_RANGE_MAX_M 100000.0f
#define NODE_V_MIN_MPS 100.0f
#define NODE_V_MAX_MPS 400.0f
#define NODE_GATE RHO_TRACKER_HOUGH
