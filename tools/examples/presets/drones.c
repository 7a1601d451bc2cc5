/* SPDX-License-Identifier: MIT */
/*
 * A radar against drones: it measures elevations and range rates, a turn a second.
 *
 *   data sheet                     field
 *   60 rpm, 5 km                   scan_interval_s: 60 / 60; range_max_m
 *   bandwidth 30 MHz               sigma_range_m: cell 150 / 30 m, / 3.5
 *   monopulse 0.4 deg, 0.8 deg     sigma_azimuth_rad, sigma_elevation_rad; RHO_MEASURES_Z
 *   velocity resolution 0.9 m/s    sigma_range_rate_mps: / 3.5; RHO_MEASURES_RANGE_RATE
 *   antenna 12 m above ground      z_m of the sensor
 *   an alarm a day may be false    false_tracks_per_hour: 1 / 24
 *   P_D 70 %                       pd
 */
#include "preset_example_helpers.h"

int main(void)
{
    struct target drone = {
        .x_m = 1500.0f, .y_m = 800.0f, .z_m = 90.0f, .vx_mps = -12.0f, .vy_mps = 5.0f};
    float time_s = 0.0f;
    rho_settings_preset(&settings, RHO_PRESET_DRONE_DEFENCE);
    settings.scan_interval_s = 60.0f / 60.0f;
    settings.range_max_m = 5000.0f;
    settings.sigma_range_m = 150.0f / 30.0f / 3.5f;
    settings.sigma_azimuth_rad = 0.4f * DEGREE;
    settings.sigma_elevation_rad = 0.8f * DEGREE;
    settings.sigma_range_rate_mps = 0.9f / 3.5f;
    settings.false_tracks_per_hour = 1.0f / 24.0f;
    settings.pd = 0.7f;
    radar.z_m = 12.0f;
    scan.measures = RHO_MEASURES_Z | RHO_MEASURES_RANGE_RATE;
    if (!init_tracking()) {
        return 2;
    }
    for (int turn = 0; turn < 20; turn++) {
        time_s = settings.scan_interval_s * (float)turn;
        if (turn % 4 != 2) {
            add_target_plot(&drone, time_s);
        }
        add_measured_plot(1500.0f + 700.0f * noise(), 90.0f * noise(), 3.0f + noise(),
                          3.0f * noise());
        if (!step_scan(time_s)) {
            return 2;
        }
    }
    return print_tracks(&drone, time_s);
}
