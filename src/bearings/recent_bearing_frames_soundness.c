/* SPDX-License-Identifier: MIT */
/*
 * recent_bearing_frames_soundness: checks that a batch of unknown origin (a snapshot) is valid:
 * counts, positions and baselines of the sensors, rising times, bearings.
 */
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/recent_bearing_frames.h"

static int are_sensor_positions_and_distances_valid(const struct rho_batch *batch)
{
    for (unsigned i = 0; i < batch->num_sensors; i++) {
        const struct rho_batch_sensor *sensor = &batch->sensors[i];
        if (!rho_is_coordinate(sensor->x_m) || !rho_is_coordinate(sensor->y_m)) {
            return 0;
        }
        for (unsigned k = 0; k < i; k++) {
            const float dx_m = sensor->x_m - batch->sensors[k].x_m;
            const float dy_m = sensor->y_m - batch->sensors[k].y_m;
            if (!rho_is_within(rho_sqrt(dx_m * dx_m + dy_m * dy_m), RHO_CROSSING_BASE_MIN_M,
                               batch->apart_max_m)) {
                return 0;
            }
        }
    }
    return 1;
}

/* The sigma of a removed bearing is 0. */
static int is_sound_bearing(const struct rho_batch_bearing *bearing)
{
    return rho_is_within(bearing->cosine, -1.01f, 1.01f) &&
           rho_is_within(bearing->sine, -1.01f, 1.01f) &&
           rho_is_within(bearing->bearing_rad, -10.0f, 10.0f) &&
           (rho_is_within(bearing->sigma_rad, 0.0f, 0.0f) ||
            rho_is_within(bearing->sigma_rad, RHO_LIMIT_SIGMA_RAD_MIN, RHO_LIMIT_SIGMA_RAD_MAX));
}

static int is_sound_look(const struct rho_batch *batch, unsigned scan, unsigned sensor)
{
    if (batch->num_bearings[scan][sensor] > RHO_MAX_BEARINGS || batch->was_seen[scan][sensor] > 1 ||
        !rho_angle_are_sector_ends_valid(batch->sector_from_rad[scan][sensor],
                                         batch->sector_to_rad[scan][sensor])) {
        return 0;
    }
    for (unsigned i = 0; i < batch->num_bearings[scan][sensor]; i++) {
        if (!is_sound_bearing(&batch->bearings[scan][sensor][i])) {
            return 0;
        }
    }
    return 1;
}

int rho_batch_is_sound(const struct rho_batch *batch)
{
    if (batch->scans_max < 1 || batch->scans_max > RHO_MAX_PASSIVE_SCANS ||
        batch->num_scans > batch->scans_max || batch->num_sensors > RHO_MAX_PASSIVE_SENSORS ||
        !rho_is_within(batch->apart_max_m, RHO_CROSSING_BASE_MIN_M, 4.0f * RHO_LIMIT_POSITION_M) ||
        !are_sensor_positions_and_distances_valid(batch)) {
        return 0;
    }
    for (unsigned k = 0; k < batch->num_scans; k++) {
        if (k > 0 && batch->time_us[k] <= batch->time_us[k - 1]) {
            return 0;
        }
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            if (!is_sound_look(batch, k, s)) {
                return 0;
            }
        }
    }
    return 1;
}
