/* SPDX-License-Identifier: MIT */
/*
 * An airport radar: 15 turns a minute, plots in four sectors a turn, a filter against clutter.
 *
 *   data sheet                     field
 *   15 rpm, 60 NM                  scan_interval_s: 60 / 15; range_max_m: times 1852
 *   sectors of 90 deg              sector_from_rad, sector_to_rad of each scan, and its own time;
 *                                  sectors without plots are stepped, too
 *   MTI, blind below 12 m/s        notch_mps of the sensor
 *   blind speed 160 m/s            blind_speed_mps of the sensor
 *   Doppler filters 2 m/s wide     sigma_range_rate_mps: width / 3.5; RHO_MEASURES_RANGE_RATE
 */
#include "preset_example_helpers.h"

int main(void)
{
    struct target departure = {.x_m = 4e3f, .y_m = 6e3f, .vx_mps = 60.0f, .vy_mps = 70.0f};
    float time_s = 0.0f;
    rho_settings_preset(&settings, RHO_PRESET_APPROACH);
    settings.scan_interval_s = 60.0f / 15.0f;
    settings.range_max_m = 60.0f * 1852.0f;
    settings.sigma_range_rate_mps = 2.0f / 3.5f;
    radar.notch_mps = 12.0f;
    radar.blind_speed_mps = 160.0f;
    scan.measures = RHO_MEASURES_RANGE_RATE;
    if (!init_tracking()) {
        return 2;
    }
    for (int sector = 0; sector < 4 * 10; sector++) { /* sectors from north, clockwise */
        int quarter = sector % 4;
        time_s = settings.scan_interval_s * 0.25f * (float)sector;
        scan.sector_from_rad = remainderf(-90.0f * (float)quarter, 360.0f) * DEGREE;
        scan.sector_to_rad = remainderf(90.0f - 90.0f * (float)quarter, 360.0f) * DEGREE;
        if (quarter == 0) { /* the target is in this sector */
            add_target_plot(&departure, time_s);
        }
        add_measured_plot(30e3f + 15e3f * noise(), 45.0f + 20.0f * noise() + 90.0f * (float)quarter,
                          0.0f, 40.0f * noise());
        if (!step_scan(time_s)) {
            return 2;
        }
    }
    return print_tracks(&departure, time_s);
}
