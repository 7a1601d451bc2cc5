/* SPDX-License-Identifier: MIT */
/*
 * full: the node of README.md: any one radar, with all that the embedded profile holds (radar_capacities.h). The settings are
 * the library's own.
 */
#include "radar_capacities.h"

#define NODE_INTERVAL_S 4.0f
#define NODE_RANGE_MAX_M 150000.0f
#define NODE_V_MIN_MPS 0.0f
#define NODE_V_MAX_MPS 700.0f
#define NODE_ACCEL_MAX_MPS2 30.0f
#define NODE_WORK_MAX RHO_WORK_MAX
