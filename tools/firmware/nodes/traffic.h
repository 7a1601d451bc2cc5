/* SPDX-License-Identifier: MIT */
/*
 * traffic: a 24 GHz radar above a road, 20 looks a second of 64 plots with range rates at most:
 * vehicles of up to 90 m/s.
 */
#define RHO_WORK_MAX 40000
#define RHO_MAX_SCANS 6
#define RHO_MAX_PLOTS 64
#define RHO_MAX_TRACKS 32
#define RHO_MAX_SENSORS 2
#include "radar_capacities.h"

#define NODE_INTERVAL_S 0.05f
#define NODE_RANGE_MAX_M 300.0f
#define NODE_SIGMA_RANGE_M 0.3f
#define NODE_SIGMA_AZIMUTH_RAD 0.01f
#define NODE_SIGMA_RANGE_RATE_MPS 0.1f
#define NODE_V_MAX_MPS 90.0f
#define NODE_ACCEL_MAX_MPS2 10.0f
