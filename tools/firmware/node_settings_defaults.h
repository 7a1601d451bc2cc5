/* SPDX-License-Identifier: MIT */
/*
 * node_settings_defaults: defaults of the settings that a node's configuration (nodes/NAME.h, used
 * as RHO_CONFIG_FILE) may define besides capacities: radar, motion of targets, work of a step.
 */
#ifndef RHOTRACK_FIRMWARE_NODE_SETTINGS_DEFAULTS_H
#define RHOTRACK_FIRMWARE_NODE_SETTINGS_DEFAULTS_H

#include "rhotrack/node.h"

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
/* enum rho_tracker_standing: what never moved may be a target */
#ifndef NODE_STANDING
#define NODE_STANDING RHO_STANDING_CLUTTER
#endif
#ifndef NODE_GATE
#define NODE_GATE (RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES) ? RHO_TRACKER_BEST : RHO_TRACKER_NEAREST)
#endif
#ifndef NODE_WORK_MAX
#define NODE_WORK_MAX RHO_WORK_MAX
#endif

/*
 * Fills in motion of targets, range and work of the node's settings, whose other fields are the
 * library's defaults, and the configurations of its parts with them. The library's defaults, not
 * the settings, hold for sensors that are not in known_radars.h and for the search for tracks in
 * bearings; the papers' search has the settings' range. Interval and sigmas above are those of
 * known_radars.h and of the tools that make scans for a node.
 */
static inline void node_settings(struct rho_settings *settings, struct rho_node_config *config)
{
    rho_settings_default(settings);
    settings->v_min_mps = NODE_V_MIN_MPS;
    settings->v_max_mps = NODE_V_MAX_MPS;
    settings->accel_max_mps2 = NODE_ACCEL_MAX_MPS2;
    settings->range_max_m = NODE_RANGE_MAX_M;
    settings->standing = NODE_STANDING;
    settings->work_max = NODE_WORK_MAX;
    rho_node_config_default(config, settings);
    rho_scan_assembler_config_default(&config->assembler);
    if (RHO_NODE_HAS_PASSIVE) {
        rho_passive_config_default(&config->passive);
    }
    config->passive_range_max_m = 0.0f;
    config->tracker.gate = NODE_GATE;
    config->body_max_m = NODE_BODY_MAX_M;
    config->options.learns_reflectors = RHO_LEARNS_REFLECTORS;
}

#endif
