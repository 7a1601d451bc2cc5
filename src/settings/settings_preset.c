/* SPDX-License-Identifier: MIT */
/*
 * settings_preset: the settings of typical kinds of radar. settings.h gives the reason for each
 * figure.
 */
#include "rhotrack/settings.h"

/* Presets by kind; sigma_rad, scans and work_max are left to rho_settings_default. */
static const struct rho_settings presets[RHO_NUM_PRESETS] = {
    [RHO_PRESET_EN_ROUTE] =
        {
            .v_min_mps = 40.0f,
            .v_max_mps = 350.0f,
            .accel_max_mps2 = 6.0f,
            .pd = 0.9f,
            .scan_interval_s = 10.0f,
            .sigma_range_m = 120.0f,
            .sigma_azimuth_rad = 0.0026f,
            .sigma_elevation_rad = 0.0026f,
            .sigma_range_rate_mps = 1.0f,
            .range_min_m = 2000.0f,
            .range_max_m = 470000.0f,
            .false_tracks_per_hour = 1.0f,
            .coast_scans_max = 5,
        },
    [RHO_PRESET_APPROACH] =
        {
            .v_min_mps = 20.0f,
            .v_max_mps = 300.0f,
            .accel_max_mps2 = 8.0f,
            .pd = 0.9f,
            .scan_interval_s = 4.0f,
            .sigma_range_m = 60.0f,
            .sigma_azimuth_rad = 0.0026f,
            .sigma_elevation_rad = 0.0026f,
            .sigma_range_rate_mps = 1.0f,
            .range_min_m = 500.0f,
            .range_max_m = 110000.0f,
            .false_tracks_per_hour = 1.0f,
            .coast_scans_max = 5,
        },
    [RHO_PRESET_MARINE] =
        {
            .v_min_mps = 0.0f,
            .v_max_mps = 50.0f,
            .accel_max_mps2 = 3.0f,
            .pd = 0.8f,
            .scan_interval_s = 2.5f,
            .sigma_range_m = 15.0f,
            .sigma_azimuth_rad = 0.009f,
            .sigma_elevation_rad = 0.009f,
            .sigma_range_rate_mps = 1.0f,
            .range_min_m = 40.0f,
            .range_max_m = 44000.0f,
            .false_tracks_per_hour = 1.0f,
            .coast_scans_max = 10,
        },
    [RHO_PRESET_COASTAL_HARBOUR] =
        {
            .v_min_mps = 0.0f,
            .v_max_mps = 40.0f,
            .accel_max_mps2 = 2.0f,
            .pd = 0.9f,
            .scan_interval_s = 3.0f,
            .sigma_range_m = 5.0f,
            .sigma_azimuth_rad = 0.002f,
            .sigma_elevation_rad = 0.002f,
            .sigma_range_rate_mps = 1.0f,
            .range_min_m = 50.0f,
            .range_max_m = 37000.0f,
            .false_tracks_per_hour = 1.0f,
            .coast_scans_max = 10,
        },
    [RHO_PRESET_DRONE_DEFENCE] =
        {
            .v_min_mps = 0.0f,
            .v_max_mps = 80.0f,
            .accel_max_mps2 = 15.0f,
            .pd = 0.8f,
            .scan_interval_s = 1.0f,
            .sigma_range_m = 5.0f,
            .sigma_azimuth_rad = 0.009f,
            .sigma_elevation_rad = 0.02f,
            .sigma_range_rate_mps = 0.5f,
            .range_min_m = 100.0f,
            .range_max_m = 10000.0f,
            .false_tracks_per_hour = 0.2f,
            .coast_scans_max = 8,
        },
    [RHO_PRESET_TRAFFIC] =
        {
            .v_min_mps = 0.0f,
            .v_max_mps = 70.0f,
            .accel_max_mps2 = 10.0f,
            .pd = 0.9f,
            .scan_interval_s = 0.05f,
            .sigma_range_m = 0.2f,
            .sigma_azimuth_rad = 0.01f,
            .sigma_elevation_rad = 0.02f,
            .sigma_range_rate_mps = 0.1f,
            .range_min_m = 1.0f,
            .range_max_m = 250.0f,
            .false_tracks_per_hour = 10.0f,
            .coast_scans_max = 20,
        },
};

void rho_settings_preset(struct rho_settings *settings, enum rho_preset preset)
{
    rho_settings_default(settings);
    if ((unsigned)preset >= RHO_NUM_PRESETS) {
        return;
    }
    const float sigma_rad = settings->sigma_rad;
    const uint16_t scans = settings->scans;
    const uint32_t work_max = settings->work_max;
    *settings = presets[preset];
    settings->sigma_rad = sigma_rad;
    settings->scans = scans;
    settings->work_max = work_max;
}
