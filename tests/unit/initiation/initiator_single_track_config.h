/* SPDX-License-Identifier: MIT */
/*
 * Configuration for tests of single tracks seen by a radar: windows of seven scans over an area
 * east of the origin, and no lower limit of the score.
 */
#ifndef RHOTRACK_TESTS_INITIATOR_SINGLE_TRACK_CONFIG_H
#define RHOTRACK_TESTS_INITIATOR_SINGLE_TRACK_CONFIG_H

#include "initiator_setup.h"

#define SCANS 7
#define SCAN_S 2.0
#define PD 0.9

/* the origin is outside */
static const struct rho_extent east = {1000.0f, 41000.0f, -20000.0f, 20000.0f};

static inline struct rho_initiator_config usual_config(void)
{
    struct rho_initiator_config config;
    rho_initiator_config_default(&config);
    config.min_scans = 4;
    config.v_max_mps = 400.0f;
    config.score_min_nat = -1000.0f;
    config.area_is_fixed = 1;
    config.area = east;
    return config;
}

#endif
