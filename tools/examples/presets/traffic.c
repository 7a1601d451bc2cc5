/* SPDX-License-Identifier: MIT */
/*
 * A radar at a road: it stares, 20 frames a second, and its range rates are ambiguous.
 *
 *   data sheet                     field
 *   frame of 50 ms                 scan_interval_s
 *   24 GHz, chirps of 250 us       range_rate_span_mps of the sensor: wavelength / (2 times 250 us)
 *   bandwidth 250 MHz              sigma_range_m: cell 150 / 250 m, / 3.5
 *   velocity resolution 0.4 m/s    sigma_range_rate_mps: / 3.5; RHO_MEASURES_RANGE_RATE
 *   field of view +-50 deg         sector_from_rad, sector_to_rad of the sensor
 *   120 m                          range_max_m
 *   speed limit                    v_max_mps: what is driven, not what is allowed
 */
#include "preset_example_helpers.h"

int main(void)
{
    struct target car = {.x_m = 3.5f, .y_m = 100.0f, .vx_mps = 0.0f, .vy_mps = -22.0f};
    float time_s = 0.0f;
    rho_settings_preset(&settings, RHO_PRESET_TRAFFIC);
    settings.scan_interval_s = 0.05f;
    settings.range_max_m = 120.0f;
    settings.sigma_range_m = 150.0f / 250.0f / 3.5f;
    settings.sigma_range_rate_mps = 0.4f / 3.5f;
    settings.v_max_mps = 60.0f;
    radar.range_rate_span_mps = 0.0125f / (2.0f * 250e-6f);
    radar.sector_from_rad = (90.0f - 50.0f) * DEGREE;
    radar.sector_to_rad = (90.0f + 50.0f) * DEGREE;
    scan.measures = RHO_MEASURES_RANGE_RATE;
    if (!init_tracking()) {
        return 2;
    }
    for (int frame = 0; frame < 40; frame++) {
        time_s = settings.scan_interval_s * (float)frame;
        if (frame % 7 != 5) {
            add_target_plot(&car, time_s);
        }
        add_measured_plot(60.0f + 30.0f * noise(), 30.0f * noise(), 0.0f, 15.0f * noise());
        if (!step_scan(time_s)) {
            return 2;
        }
    }
    return print_tracks(&car, time_s);
}
