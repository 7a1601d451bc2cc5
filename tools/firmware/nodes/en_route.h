/* SPDX-License-Identifier: MIT */
/*
 * en_route: node configuration for a long-range air traffic control radar, 10 s a turn: aircraft at
 * 25 to 350 m/s, 4 to 370 km.
 */
#define RHO_WORK_MAX 4000000
#include "radar_capacities.h"

#define NODE_INTERVAL_S 10.0f
#define NODE_RANGE_MAX_M 370000.0f
#define NODE_SIGMA_RANGE_M 70.0f
#define NODE_SIGMA_AZIMUTH_RAD 0.0014f
#define NODE_V_MIN_MPS 25.0f
#define NODE_V_MAX_MPS 350.0f
#define NODE_ACCEL_MAX_MPS2 10.0f
