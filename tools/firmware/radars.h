/* SPDX-License-Identifier: MIT */
/* The radars that the node knows before it hears them: of the image, and of the replay that says what it must send. */
#ifndef RHOTRACK_FIRMWARE_RADARS_H
#define RHOTRACK_FIRMWARE_RADARS_H

#include "rhotrack/feed.h"

/* One radar at the origin. Sensors that are not in the table are taken at their word, with the feed's defaults. */
static const struct rho_feed_sensor radars[] = {
    {.sensor = {.sensor_id = 1, .pd = 0.9f, .range_max_m = 150000.0f},
     .noise = {.sigma_m = 20.0f,
               .sigma_mps = 1.0f,
               .sigma_range_m = 15.0f,
               .sigma_azimuth_rad = 0.003f,
               .sigma_elevation_rad = 0.003f,
               .sigma_range_rate_mps = 1.0f,
               .sigma_rad = 0.002f}},
};

#endif
