/* SPDX-License-Identifier: MIT */
/*
 * sensor_lookup_and_validity: looks up the descriptions of sensors (rho_tracker_set_sensor), and
 * tests them.
 */
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/doppler_notch.h"
#include "rhotrack/detail/measurement.h"
#include "step.h"

unsigned rho_tracker_index_of_sensor(const struct rho_tracker *tracker, int32_t sensor_id)
{
    unsigned place = 0;

    while (place < tracker->num_sensors && tracker->sensors[place].sensor_id != sensor_id) {
        place++;
    }
    return place;
}

const struct rho_sensor *rho_tracker_find_sensor(const struct rho_tracker *tracker,
                                                 int32_t sensor_id)
{
    unsigned place = rho_tracker_index_of_sensor(tracker, sensor_id);

    return place < tracker->num_sensors ? &tracker->sensors[place] : NULL;
}

int rho_tracker_is_usable_sensor(const struct rho_sensor *sensor)
{
    return rho_measurement_has_valid_place_and_biases(sensor) &&
           rho_is_within(sensor->pd, 0.01f, 0.999f) &&
           rho_is_within(sensor->range_min_m, 0.0f, 2.0f * RHO_LIMIT_POSITION_M) &&
           rho_is_within(sensor->range_max_m, 0.0f, 2.0f * RHO_LIMIT_POSITION_M) &&
           sensor->range_min_m < sensor->range_max_m &&
           (!RHO_DOPPLER_NOTCH || rho_notch_is_valid(sensor)) &&
           (!RHO_SHARES_PLOTS || rho_tracker_has_usable_resolution_cell(sensor)) &&
           rho_angle_are_sector_ends_valid(sensor->sector_from_rad, sensor->sector_to_rad);
}
