/* SPDX-License-Identifier: MIT */
/*
 * marine: node configuration for a ship's or harbour radar, 2.5 s a turn: vessels of up to 30 m/s,
 * some at anchor, to 45 km.
 */
#define RHO_WORK_MAX 1000000
#include "radar_capacities.h"

#define NODE_INTERVAL_S 2.5f
#define NODE_RANGE_MAX_M 45000.0f
#define NODE_SIGMA_RANGE_M 10.0f
#define NODE_SIGMA_AZIMUTH_RAD 0.004f
#define NODE_STANDING RHO_STANDING_TARGETS
#define NODE_V_MAX_MPS 30.0f
#define NODE_ACCEL_MAX_MPS2 2.0f
