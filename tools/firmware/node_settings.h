/* SPDX-License-Identifier: MIT */
/*
 * node_settings: what the node's configuration (nodes/NAME.h, which is RHO_CONFIG_FILE) says beside its capacities: its
 * radar, how its targets move, and the work that a step may do.
 */
#ifndef RHOTRACK_FIRMWARE_NODE_SETTINGS_H
#define RHOTRACK_FIRMWARE_NODE_SETTINGS_H

#include "rhotrack/feed.h"
#include "rhotrack/initiator.h"
#include "rhotrack/tracker.h"

#ifndef NODE_SIGMA_RANGE_M
#define NODE_SIGMA_RANGE_M 15.0f
#endif
#ifndef NODE_SIGMA_AZIMUTH_RAD
#define NODE_SIGMA_AZIMUTH_RAD 0.003f
#endif
#ifndef NODE_SIGMA_RANGE_RATE_MPS
#define NODE_SIGMA_RANGE_RATE_MPS 1.0f
#endif

/* The library's own settings but for those. */
static inline void node_settings(struct rho_tracker_config *tracker,
                                 struct rho_initiator_config *initiator)
{
    rho_tracker_config_default(tracker);
    rho_initiator_config_default(initiator);
    tracker->v_min_mps = initiator->v_min_mps = NODE_V_MIN_MPS;
    tracker->v_max_mps = initiator->v_max_mps = NODE_V_MAX_MPS;
    tracker->accel_max_mps2 = NODE_ACCEL_MAX_MPS2;
    tracker->work_max = initiator->work_max = NODE_WORK_MAX;
}

#endif
