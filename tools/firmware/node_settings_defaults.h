/* SPDX-License-Identifier: MIT */
/*
 * node_settings_defaults: defaults of the settings that a node's configuration (nodes/NAME.h, used
 * as RHO_CONFIG_FILE) may define besides capacities: radar, motion of targets, work of a step.
 */
#ifndef RHOTRACK_FIRMWARE_NODE_SETTINGS_DEFAULTS_H
#define RHOTRACK_FIRMWARE_NODE_SETTINGS_DEFAULTS_H

#include "rhotrack/initiator.h"
#include "rhotrack/tracker.h"

#ifndef NODE_INTERVAL_S
#define NODE_INTERVAL_S 4.0f
#endif
#ifndef NODE_RANGE_MAX_M
#define NODE_RANGE_MAX_M 150000.0f
#endif
#ifndef NODE_SIGMA_RANGE_M
#define NODE_SIGMA_RANGE_M 15.0f
#endif
#ifndef NODE_SIGMA_AZIMUTH_RAD
#define NODE_SIGMA_AZIMUTH_RAD 0.003f
#endif
#ifndef NODE_SIGMA_RANGE_RATE_MPS
#define NODE_SIGMA_RANGE_RATE_MPS 1.0f
#endif
#ifndef NODE_V_MIN_MPS
#define NODE_V_MIN_MPS 0.0f
#endif
#ifndef NODE_V_MAX_MPS
#define NODE_V_MAX_MPS 700.0f
#endif
#ifndef NODE_ACCEL_MAX_MPS2
#define NODE_ACCEL_MAX_MPS2 30.0f
#endif
/*
 * Length of the largest target where one target gives several plots (RHO_BODIES 1); 0: point
 * targets.
 */
#ifndef NODE_BODY_MAX_M
#define NODE_BODY_MAX_M 0.0f
#endif
/* 1: reflectors that make mirror images are learned (needs RHO_MAX_REFLECTORS above 0). */
#ifndef NODE_LEARNS_REFLECTORS
#define NODE_LEARNS_REFLECTORS 0
#endif
#ifndef NODE_GATE
#define NODE_GATE (RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES) ? RHO_TRACKER_BEST : RHO_TRACKER_NEAREST)
#endif
#ifndef NODE_WORK_MAX
#define NODE_WORK_MAX RHO_WORK_MAX
#endif

/* Fills both configs with the library's defaults and the node's settings. */
static inline void node_settings(struct rho_tracker_config *tracker,
                                 struct rho_initiator_config *initiator)
{
    rho_tracker_config_default(tracker);
    rho_initiator_config_default(initiator);
    tracker->v_min_mps = initiator->v_min_mps = NODE_V_MIN_MPS;
    tracker->v_max_mps = initiator->v_max_mps = NODE_V_MAX_MPS;
    tracker->accel_max_mps2 = NODE_ACCEL_MAX_MPS2;
    initiator->turn_mps2 = 0.2f * NODE_ACCEL_MAX_MPS2;
    tracker->gate = NODE_GATE;
    tracker->work_max = initiator->work_max = NODE_WORK_MAX;
}

#endif
