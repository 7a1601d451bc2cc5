/* SPDX-License-Identifier: MIT */
/*
 * people: node configuration for a 60 GHz radar in a room: 10 looks a second of at most 128 points
 * with range rates, ten people of some tens of points, with estimated extents.
 */
#define RHO_WORK_MAX 20000
#define RHO_SCAN_KINDS 2
#define RHO_MAX_SCANS 3
#define RHO_MAX_PLOTS 128
#define RHO_MAX_TRACKS 12
#define RHO_MAX_HYPOTHESES 14
#define RHO_FAST_UPDATES 0
#define RHO_BODIES 1
#define RHO_MAX_CANDIDATES 8
#define RHO_MAX_ECHOES 0
#define RHO_MAX_BINS 32
#define RHO_MAX_SENSORS 1
#include "radar_capacities.h"

#define NODE_INTERVAL_S 0.1f
#define NODE_RANGE_MAX_M 12.0f
#define NODE_SIGMA_RANGE_M 0.05f
#define NODE_SIGMA_AZIMUTH_RAD 0.03f
#define NODE_SIGMA_RANGE_RATE_MPS 0.3f
#define NODE_V_MAX_MPS 3.0f
#define NODE_ACCEL_MAX_MPS2 3.0f
#define NODE_BODY_MAX_M 0.8f
