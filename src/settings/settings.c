/* SPDX-License-Identifier: MIT */
#include "rhotrack/settings.h"

#include "policy.h"
#include "rhotrack/detail/approx.h"

void rho_settings_default(struct rho_settings *settings)
{
    *settings = (struct rho_settings){
        .v_max_mps = 700.0f,
        .accel_max_mps2 = 30.0f,
        .pd = 0.9f,
        .scan_interval_s = 10.0f,
        .sigma_range_m = 15.0f,
        .sigma_azimuth_rad = 0.003f,
        .sigma_elevation_rad = 0.003f,
        .sigma_range_rate_mps = 1.0f,
        .sigma_rad = 0.00175f,
        .range_max_m = 100000.0f,
        .false_tracks_per_hour = 1.0f,
        .scans = RHO_MAX_SCANS < 7 ? RHO_MAX_SCANS : 7,
        .coast_scans_max = 5,
        .work_max = RHO_WORK_MAX,
    };
}

/*
 * True where the value is finite and in min .. max. Always notes field, value and limits in *fault,
 * so that the first refused one stands there.
 */
static int note_range(struct rho_settings_fault *fault, const char *field, float value, float min,
                      float max)
{
    *fault = (struct rho_settings_fault){field, value, min, max};
    return rho_is_within(value, min, max);
}

#define IS_WITHIN(field, min, max)                                                                 \
    note_range(&first, #field, (float)settings->field, (float)(min), (float)(max))
#define IS_BELOW(field, min, max) (IS_WITHIN(field, min, max) && settings->field < (max))
#define IS_LENGTH_SIGMA(field) IS_WITHIN(field, RHO_LIMIT_SIGMA_MIN, RHO_LIMIT_SIGMA_MAX)
#define IS_ANGLE_SIGMA(field) IS_WITHIN(field, RHO_LIMIT_SIGMA_RAD_MIN, RHO_LIMIT_SIGMA_RAD_MAX)

enum rho_status rho_settings_check(const struct rho_settings *settings,
                                   struct rho_settings_fault *fault)
{
    const float limit_m = RHO_LIMIT_POSITION_M;
    struct rho_settings_fault first;
    if (!settings) {
        return RHO_ERROR_NULL;
    }
    if (IS_WITHIN(v_max_mps, 1.0f, RHO_LIMIT_SPEED_MPS) &&
        IS_BELOW(v_min_mps, 0.0f, settings->v_max_mps) &&
        IS_WITHIN(accel_max_mps2, 0.0f, 1000.0f) && IS_WITHIN(pd, 0.01f, 0.999f) &&
        IS_WITHIN(scan_interval_s, 1e-3f, 3600.0f) && IS_LENGTH_SIGMA(sigma_range_m) &&
        IS_ANGLE_SIGMA(sigma_azimuth_rad) && IS_ANGLE_SIGMA(sigma_elevation_rad) &&
        IS_LENGTH_SIGMA(sigma_range_rate_mps) && IS_ANGLE_SIGMA(sigma_rad) &&
        IS_WITHIN(range_max_m, 1.0f, 2.0f * limit_m) &&
        IS_BELOW(range_min_m, 0.0f, settings->range_max_m) &&
        (!settings->area_is_fixed || (IS_WITHIN(area.x_max_m, -limit_m, limit_m) &&
                                      IS_WITHIN(area.y_max_m, -limit_m, limit_m) &&
                                      IS_BELOW(area.x_min_m, -limit_m, settings->area.x_max_m) &&
                                      IS_BELOW(area.y_min_m, -limit_m, settings->area.y_max_m))) &&
        IS_WITHIN(false_tracks_per_hour, 1e-6f, 1e6f) && IS_WITHIN(scans, 3, RHO_MAX_SCANS) &&
        (settings->min_scans == 0 || IS_WITHIN(min_scans, 3, settings->scans)) &&
        IS_WITHIN(coast_scans_max, 1, UINT8_MAX) &&
        IS_WITHIN(standing, RHO_STANDING_CLUTTER, RHO_STANDING_TARGETS) &&
        IS_WITHIN(work_max, 0, RHO_LIMIT_WORK) &&
        /* compared as an integer, too: the float may have been rounded down to the limit */
        settings->work_max <= RHO_LIMIT_WORK) {
        return RHO_OK;
    }
    if (fault) {
        *fault = first;
    }
    return RHO_ERROR_CONFIG;
}

void rho_settings_apply(const struct rho_settings *settings, struct rho_tracker_config *tracker,
                        struct rho_initiator_config *initiator, struct rho_passive_config *passive)
{
    if (tracker) {
        tracker->pd = settings->pd;
        tracker->v_min_mps = settings->v_min_mps;
        tracker->v_max_mps = settings->v_max_mps;
        tracker->accel_max_mps2 = settings->accel_max_mps2;
        tracker->coast_scans_max = settings->coast_scans_max;
        tracker->standing = settings->standing;
        tracker->work_max = settings->work_max;
        /* at most what a tracker accepts */
        tracker->late_max_s = rho_smaller(LATE_SCANS * settings->scan_interval_s, 60.0f);
    }
    if (initiator) {
        initiator->scans = settings->scans;
        initiator->min_scans = settings->min_scans;
        initiator->v_min_mps = settings->v_min_mps;
        initiator->v_max_mps = settings->v_max_mps;
        initiator->pd = settings->pd;
        initiator->false_tracks_per_hour = settings->false_tracks_per_hour;
        initiator->turn_mps2 = TURN_SHARE * settings->accel_max_mps2;
        initiator->work_max = settings->work_max;
        initiator->area_is_fixed = settings->area_is_fixed;
        initiator->area = settings->area;
    }
    if (passive) {
        /* within the limits of a passive search */
        const float range_m = rho_smaller(settings->range_max_m, 500000.0f);
        passive->range_max_m = range_m > 1000.0f ? range_m : 1000.0f;
        passive->v_max_mps = settings->v_max_mps;
        passive->pd = settings->pd;
        passive->false_tracks_per_hour = settings->false_tracks_per_hour;
        passive->work_max = settings->work_max;
    }
}

void rho_settings_apply_sensor(const struct rho_settings *settings, struct rho_sensor *sensor)
{
    sensor->pd = settings->pd;
    sensor->range_min_m = settings->range_min_m;
    sensor->range_max_m = settings->range_max_m;
}

void rho_settings_apply_noise(const struct rho_settings *settings, struct rho_polar_plot *plot)
{
    plot->sigma_range_m = settings->sigma_range_m;
    plot->sigma_azimuth_rad = settings->sigma_azimuth_rad;
    plot->sigma_elevation_rad = settings->sigma_elevation_rad;
    plot->sigma_range_rate_mps = settings->sigma_range_rate_mps;
}
