/* SPDX-License-Identifier: MIT */
/*
 * traffic: node configuration for a 24 GHz radar above a road: 20 looks a second of at most 128
 * plots with range rates, 64 vehicles of up to 90 m/s and 15 m length, with estimated extents. No
 * clutter map, to save flash.
 */
#define RHO_WORK_MAX 12800
#define RHO_MAX_SCANS 4
#define RHO_MAX_PLOTS 128
#define RHO_MAX_TRACKS 64
#define RHO_MAX_HYPOTHESES 70
#define RHO_BODIES 1
#define RHO_MAX_ECHOES 0
#define RHO_MAX_BINS 144
#define RHO_MAX_SENSORS 2
#include "radar_capacities.h"

#define NODE_INTERVAL_S 0.05f
#define NODE_RANGE_MAX_M 300.0f
#define NODE_SIGMA_RANGE_M 0.3f
#define NODE_SIGMA_AZIMUTH_RAD 0.01f
#define NODE_SIGMA_RANGE_RATE_MPS 0.1f
#define NODE_V_MAX_MPS 90.0f
#define NODE_ACCEL_MAX_MPS2 10.0f
#define NODE_BODY_MAX_M 15.0f
