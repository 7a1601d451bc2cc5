/* SPDX-License-Identifier: MIT */
/*
 * settings_preset: the settings of typical kinds of radar. settings.h gives the reason for each
 * figure.
 */
#include "rhotrack/settings.h"

#include <string.h>

/* One parameter in all presets, in the order of enum rho_preset. */
struct parameter {
    size_t place;
    float values[RHO_NUM_PRESETS];
};

#define PLACE(field) offsetof(struct rho_settings, field)

/* The table of settings.h; all other parameters are left to rho_settings_default. */
static const struct parameter parameters[] = {
    {PLACE(v_min_mps), {40.0f, 20.0f, 0.0f, 0.0f, 0.0f, 0.0f}},
    {PLACE(v_max_mps), {350.0f, 300.0f, 50.0f, 40.0f, 80.0f, 70.0f}},
    {PLACE(accel_max_mps2), {6.0f, 8.0f, 3.0f, 2.0f, 15.0f, 10.0f}},
    {PLACE(pd), {0.9f, 0.9f, 0.8f, 0.9f, 0.8f, 0.9f}},
    {PLACE(scan_interval_s), {10.0f, 4.0f, 2.5f, 3.0f, 1.0f, 0.05f}},
    {PLACE(sigma_range_m), {120.0f, 60.0f, 15.0f, 5.0f, 5.0f, 0.2f}},
    {PLACE(sigma_azimuth_rad), {0.0026f, 0.0026f, 0.009f, 0.002f, 0.009f, 0.01f}},
    {PLACE(sigma_elevation_rad), {0.0026f, 0.0026f, 0.009f, 0.002f, 0.02f, 0.02f}},
    {PLACE(sigma_range_rate_mps), {1.0f, 1.0f, 1.0f, 1.0f, 0.5f, 0.1f}},
    {PLACE(range_min_m), {2000.0f, 500.0f, 40.0f, 50.0f, 100.0f, 1.0f}},
    {PLACE(range_max_m), {470000.0f, 110000.0f, 44000.0f, 37000.0f, 10000.0f, 250.0f}},
    {PLACE(false_tracks_per_hour), {1.0f, 1.0f, 1.0f, 1.0f, 0.2f, 10.0f}},
};
static const uint8_t coast_scans_max[RHO_NUM_PRESETS] = {5, 5, 10, 10, 8, 20};

void rho_settings_preset(struct rho_settings *settings, enum rho_preset preset)
{
    rho_settings_default(settings);
    if ((unsigned)preset >= RHO_NUM_PRESETS) {
        return;
    }
    for (unsigned i = 0; i < sizeof parameters / sizeof parameters[0]; i++) {
        memcpy((char *)settings + parameters[i].place, &parameters[i].values[preset],
               sizeof(float));
    }
    settings->coast_scans_max = coast_scans_max[preset];
    /* ships at anchor, drones that hover and cars in a queue stand; aircraft do not */
    settings->standing = settings->v_min_mps > 0.0f ? RHO_STANDING_CLUTTER : RHO_STANDING_TARGETS;
}
