/* SPDX-License-Identifier: MIT */
/*
 * known_radars: table of the radars that the node knows beforehand; used by the firmware image and
 * by replay, which computes the messages that the image must send.
 */
#ifndef RHOTRACK_FIRMWARE_KNOWN_RADARS_H
#define RHOTRACK_FIRMWARE_KNOWN_RADARS_H

#include "node_settings_defaults.h"
#include "rhotrack/scan_assembler.h"

/*
 * One radar at the origin. Sensors that are not in the table are accepted with the description in
 * their messages and the scan assembler's defaults.
 */
static const struct rho_scan_assembler_sensor radars[] = {
    {.sensor = {.sensor_id = 1, .pd = 0.9f, .range_max_m = NODE_RANGE_MAX_M},
     .noise = {.sigma_m = 20.0f,
               .sigma_mps = 1.0f,
               .sigma_range_m = NODE_SIGMA_RANGE_M,
               .sigma_azimuth_rad = NODE_SIGMA_AZIMUTH_RAD,
               .sigma_elevation_rad = 0.003f,
               .sigma_range_rate_mps = NODE_SIGMA_RANGE_RATE_MPS,
               .sigma_rad = 0.002f}},
};

#endif
