/* SPDX-License-Identifier: MIT */
/*
 * A vessel traffic service: a radar on the shore, land behind it, a basin of known extent.
 *
 *   data sheet, chart              field
 *   20 rpm, 10 NM                  scan_interval_s: 60 / 20; range_max_m: times 1852
 *   range cell 3 m                 sigma_range_m: cell / 3.5
 *   beam 0.4 deg                   sigma_azimuth_rad: a quarter of it
 *   water from 250 to 110 deg      sector_from_rad, sector_to_rad of the sensor, counter-clockwise:
 *                                  plots elsewhere are INVALID, and no misses
 *   survey of the radar's mast     x_m, y_m of the sensor
 *   basin of the chart             area, area_is_fixed: clutter is expected there alone
 */
#include "preset_example_helpers.h"

int main(void)
{
    struct target tug = {.x_m = 2e3f, .y_m = 3e3f, .vx_mps = 4.0f, .vy_mps = -3.0f};
    float time_s = 0.0f;
    rho_settings_preset(&settings, RHO_PRESET_COASTAL_HARBOUR);
    settings.scan_interval_s = 60.0f / 20.0f;
    settings.range_max_m = 10.0f * 1852.0f;
    settings.sigma_range_m = 3.0f / 3.5f;
    settings.sigma_azimuth_rad = 0.4f * DEGREE / 4.0f;
    settings.area = (struct rho_extent){-8000.0f, 8000.0f, -1000.0f, 9000.0f};
    settings.area_is_fixed = 1;
    radar.x_m = 120.0f;
    radar.y_m = -40.0f;
    radar.sector_from_rad = remainderf(90.0f - 110.0f, 360.0f) * DEGREE;
    radar.sector_to_rad = remainderf(90.0f - 250.0f, 360.0f) * DEGREE;
    if (!init_tracking()) {
        return 2;
    }
    for (int turn = 0; turn < 16; turn++) {
        time_s = settings.scan_interval_s * (float)turn;
        add_target_plot(&tug, time_s);
        /* echo of a crane */
        add_measured_plot(900.0f + 10.0f * noise(), 180.0f + noise(), 0.0f, 0.0f);
        add_measured_plot(4e3f + 2e3f * noise(), 30.0f * noise(), 0.0f, 0.0f); /* sea clutter */
        if (!step_scan(time_s)) {
            return 2;
        }
    }
    return print_tracks(&tug, time_s);
}
