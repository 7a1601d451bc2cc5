/* SPDX-License-Identifier: MIT */
/*
 * An air route radar: 6 turns a minute, 200 nautical miles, on a hill. A scan is a whole turn.
 *
 *   data sheet                     field
 *   6 rpm                          scan_interval_s: 60 / 6
 *   instrumented range 200 NM      range_max_m: times 1852
 *   range accuracy 0.05 NM rms     sigma_range_m: times 1852
 *   azimuth accuracy 0.12 deg rms  sigma_azimuth_rad: times pi / 180
 *   P_D 80 % at 1 m^2              pd
 *   north is shown as 0.4 deg      azimuth_bias_rad of the sensor; clockwise is negative
 */
#include "preset_example_helpers.h"

int main(void)
{
    struct target airliner = {.x_m = 90e3f, .y_m = -60e3f, .vx_mps = -180.0f, .vy_mps = 140.0f};
    float time_s = 0.0f;
    rho_settings_preset(&settings, RHO_PRESET_EN_ROUTE);
    settings.scan_interval_s = 60.0f / 6.0f;
    settings.range_max_m = 200.0f * 1852.0f;
    settings.sigma_range_m = 0.05f * 1852.0f;
    settings.sigma_azimuth_rad = 0.12f * DEGREE;
    settings.pd = 0.8f;
    radar.azimuth_bias_rad = -0.4f * DEGREE;
    if (!init_tracking()) {
        return 2;
    }
    for (int turn = 0; turn < 12; turn++) {
        time_s = settings.scan_interval_s * (float)turn;
        if (turn % 5 != 3) { /* the target is missed now and then */
            add_target_plot(&airliner, time_s);
        }
        /* a plot of clutter */
        add_measured_plot(100e3f + 60e3f * noise(), 180.0f * noise(), 0.0f, 0.0f);
        if (!step_scan(time_s)) {
            return 2;
        }
    }
    return print_tracks(&airliner, time_s);
}
