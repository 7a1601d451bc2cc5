/* SPDX-License-Identifier: MIT */
#include "registration/register_data.h"

#include <math.h>

struct corrected register_correct_plot(const struct register_data *data,
                                       const struct radar_data *radar,
                                       const struct radar_plot *plot)
{
    double azimuth_rad = plot->azimuth_rad - radar->bias[REGISTER_AZIMUTH];
    struct corrected at = {.range_m = plot->range_m - radar->bias[REGISTER_RANGE],
                           .cos_azimuth = cos(azimuth_rad),
                           .sin_azimuth = sin(azimuth_rad)};

    at.t_s = (double)(plot->time_us - data->start_us) * 1e-6 - radar->bias[REGISTER_TIME];
    at.x_m = (double)radar->sensor.x_m + at.range_m * at.cos_azimuth;
    at.y_m = (double)radar->sensor.y_m + at.range_m * at.sin_azimuth;
    return at;
}
