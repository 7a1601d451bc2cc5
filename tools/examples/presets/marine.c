/* SPDX-License-Identifier: MIT */
/*
 * A ship's radar: 24 turns a minute, bearings from the bow, on a ship that moves.
 *
 *   data sheet                     field
 *   24 rpm, scale 12 NM            scan_interval_s: 60 / 24; range_max_m: times 1852
 *   short pulse 80 ns              sigma_range_m: 150 m/us times 0.08 us, / 3.5
 *   beam 1.2 deg                   sigma_azimuth_rad: a quarter of it, and the compass' 0.5 deg
 *   compass heading                is added to the bearing: plots are over ground
 *   own place (GPS)                x_m, y_m of the sensor, set anew at each turn
 */
#include "preset_example_helpers.h"

int main(void)
{
    struct target own = {.vy_mps = 7.0f}; /* own ship, heading north at 14 knots */
    struct target ferry = {.x_m = 3e3f, .y_m = 5e3f, .vx_mps = -9.0f, .vy_mps = 2.0f};
    float time_s = 0.0f;
    rho_settings_preset(&settings, RHO_PRESET_MARINE);
    settings.scan_interval_s = 60.0f / 24.0f;
    settings.range_max_m = 12.0f * 1852.0f;
    settings.sigma_range_m = 150.0f * 0.08f / 3.5f;
    settings.sigma_azimuth_rad = hypotf(1.2f / 4.0f, 0.5f) * DEGREE;
    if (!init_tracking()) {
        return 2;
    }
    for (int turn = 0; turn < 16; turn++) {
        /* clutter bearing, relative to the bow */
        float heading_deg = 2.0f * noise(), wave_deg = 60.0f * noise();
        time_s = settings.scan_interval_s * (float)turn;
        radar.x_m = own.vx_mps * time_s;
        radar.y_m = own.vy_mps * time_s;
        if (rho_tracker_set_sensor(&tracker, &radar) != RHO_OK) {
            return 2;
        }
        add_target_plot(&ferry, time_s);
        add_measured_plot(900.0f + 400.0f * noise(), heading_deg + wave_deg, 0.0f, 0.0f);
        if (!step_scan(time_s)) {
            return 2;
        }
    }
    return print_tracks(&ferry, time_s);
}
