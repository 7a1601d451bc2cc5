/* SPDX-License-Identifier: MIT */
/*
 * node_settings: what a node's configuration (nodes/NAME.h, which is RHO_CONFIG_FILE) may say
 * beside its capacities: its radar, how its targets move, the work that a step may do. What it does
 * not say is as here.
 */
#ifndef RHOTRACK_FIRMWARE_NODE_SETTINGS_H
#define RHOTRACK_FIRMWARE_NODE_SETTINGS_H

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
/* Its longest target, where targets give several plots (RHO_BODIES 1); 0: they are points. */
#ifndef NODE_BODY_MAX_M
#define NODE_BODY_MAX_M 0.0f
#endif
/* 1: walls that show targets twice are learned (RHO_MAX_REFLECTORS above 0). */
#ifndef NODE_LEARNS_REFLECTORS
#define NODE_LEARNS_REFLECTORS 0
#endif
#ifndef NODE_GATE
#define NODE_GATE (RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES) ? RHO_TRACKER_BEST : RHO_TRACKER_NEAREST)
#endif
#ifndef NODE_WORK_MAX
#define NODE_WORK_MAX RHO_WORK_MAX
#endif

/* The library's defaults, but for what the configuration says. */
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
