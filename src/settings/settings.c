/* SPDX-License-Identifier: MIT */
#include "rhotrack/settings.h"

#include "rhotrack/detail/approx.h"

/*
 * Share of the largest acceleration that the initiator assumes turning targets to keep for a
 * window.
 */
#define TURN_SHARE 0.2f

/*
 * Scan intervals by which the network may delay a scan, and the largest late_max_s that a tracker
 * accepts.
 */
#define LATE_SCANS 2.0f
#define LATE_LIMIT_S 60.0f

/*
 * Least and largest range_max_m of a passive search; and the span of all its cells of rho over
 * range_max_m: range_max_m either way, and room for the sensors' own places.
 */
#define PASSIVE_RANGE_MIN_M 1000.0f
#define PASSIVE_RANGE_MAX_M 500000.0f
#define PASSIVE_SPAN 2.56f

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

/* ---- check --------------------------------------------------------------------------------- */

/*
 * True where the value is finite and in min .. max. Always notes field, value and limits in *fault,
 * so that the first refused one stands there.
 */
static int is_within_noting_fault(struct rho_settings_fault *fault, const char *field, float value,
                                  float min, float max)
{
    *fault = (struct rho_settings_fault){field, value, min, max};
    return rho_is_within(value, min, max);
}

/* True where the value is in min .. max, max excluded. Notes field, value and limits in *fault. */
static int is_below_max_noting_fault(struct rho_settings_fault *fault, const char *field,
                                     float value, float min, float max)
{
    return is_within_noting_fault(fault, field, value, min, max) && value < max;
}

static int is_length_sigma_noting_fault(struct rho_settings_fault *fault, const char *field,
                                        float sigma)
{
    return is_within_noting_fault(fault, field, sigma, RHO_LIMIT_SIGMA_MIN, RHO_LIMIT_SIGMA_MAX);
}

static int is_angle_sigma_noting_fault(struct rho_settings_fault *fault, const char *field,
                                       float sigma_rad)
{
    return is_within_noting_fault(fault, field, sigma_rad, RHO_LIMIT_SIGMA_RAD_MIN,
                                  RHO_LIMIT_SIGMA_RAD_MAX);
}

static int has_usable_targets(const struct rho_settings *settings, struct rho_settings_fault *fault)
{
    return is_within_noting_fault(fault, "v_max_mps", settings->v_max_mps, 1.0f,
                                  RHO_LIMIT_SPEED_MPS) &&
           is_below_max_noting_fault(fault, "v_min_mps", settings->v_min_mps, 0.0f,
                                     settings->v_max_mps) &&
           is_within_noting_fault(fault, "accel_max_mps2", settings->accel_max_mps2, 0.0f, 1000.0f);
}

static int has_usable_sensor_values(const struct rho_settings *settings,
                                    struct rho_settings_fault *fault)
{
    return is_within_noting_fault(fault, "pd", settings->pd, 0.01f, 0.999f) &&
           is_within_noting_fault(fault, "scan_interval_s", settings->scan_interval_s, 1e-3f,
                                  3600.0f) &&
           is_length_sigma_noting_fault(fault, "sigma_range_m", settings->sigma_range_m) &&
           is_angle_sigma_noting_fault(fault, "sigma_azimuth_rad", settings->sigma_azimuth_rad) &&
           is_angle_sigma_noting_fault(fault, "sigma_elevation_rad",
                                       settings->sigma_elevation_rad) &&
           is_length_sigma_noting_fault(fault, "sigma_range_rate_mps",
                                        settings->sigma_range_rate_mps) &&
           is_angle_sigma_noting_fault(fault, "sigma_rad", settings->sigma_rad) &&
           is_within_noting_fault(fault, "range_max_m", settings->range_max_m, 1.0f,
                                  2.0f * RHO_LIMIT_POSITION_M) &&
           is_below_max_noting_fault(fault, "range_min_m", settings->range_min_m, 0.0f,
                                     settings->range_max_m);
}

static int has_usable_area(const struct rho_settings *settings, struct rho_settings_fault *fault)
{
    const struct rho_extent *area = &settings->area;
    const float limit_m = RHO_LIMIT_POSITION_M;
    return !settings->area_is_fixed ||
           (is_within_noting_fault(fault, "area.x_max_m", area->x_max_m, -limit_m, limit_m) &&
            is_within_noting_fault(fault, "area.y_max_m", area->y_max_m, -limit_m, limit_m) &&
            is_below_max_noting_fault(fault, "area.x_min_m", area->x_min_m, -limit_m,
                                      area->x_max_m) &&
            is_below_max_noting_fault(fault, "area.y_min_m", area->y_min_m, -limit_m,
                                      area->y_max_m));
}

static int has_usable_rates_and_limits(const struct rho_settings *settings,
                                       struct rho_settings_fault *fault)
{
    const float scans = settings->scans;
    return is_within_noting_fault(fault, "false_tracks_per_hour", settings->false_tracks_per_hour,
                                  1e-6f, 1e6f) &&
           is_within_noting_fault(fault, "scans", scans, 3.0f, (float)RHO_MAX_SCANS) &&
           (settings->min_scans == 0 ||
            is_within_noting_fault(fault, "min_scans", settings->min_scans, 3.0f, scans)) &&
           is_within_noting_fault(fault, "coast_scans_max", settings->coast_scans_max, 1.0f,
                                  (float)UINT8_MAX) &&
           is_within_noting_fault(fault, "work_max", (float)settings->work_max, 0.0f,
                                  (float)RHO_LIMIT_WORK) &&
           /* compared as an integer, too: the float may have been rounded down to the limit */
           settings->work_max <= RHO_LIMIT_WORK;
}

enum rho_status rho_settings_check(const struct rho_settings *settings,
                                   struct rho_settings_fault *fault)
{
    struct rho_settings_fault first;
    if (!settings) {
        return RHO_ERROR_NULL;
    }
    if (has_usable_targets(settings, &first) && has_usable_sensor_values(settings, &first) &&
        has_usable_area(settings, &first) && has_usable_rates_and_limits(settings, &first)) {
        return RHO_OK;
    }
    if (fault) {
        *fault = first;
    }
    return RHO_ERROR_CONFIG;
}

/* ---- apply --------------------------------------------------------------------------------- */

static void apply_to_tracker(const struct rho_settings *settings, struct rho_tracker_config *config)
{
    config->pd = settings->pd;
    config->v_min_mps = settings->v_min_mps;
    config->v_max_mps = settings->v_max_mps;
    config->accel_max_mps2 = settings->accel_max_mps2;
    config->coast_scans_max = settings->coast_scans_max;
    config->work_max = settings->work_max;
    config->late_max_s = rho_smaller(LATE_SCANS * settings->scan_interval_s, LATE_LIMIT_S);
}

static void apply_to_initiator(const struct rho_settings *settings,
                               struct rho_initiator_config *config)
{
    config->scans = settings->scans;
    config->min_scans = settings->min_scans;
    config->v_min_mps = settings->v_min_mps;
    config->v_max_mps = settings->v_max_mps;
    config->pd = settings->pd;
    config->false_tracks_per_hour = settings->false_tracks_per_hour;
    config->turn_mps2 = TURN_SHARE * settings->accel_max_mps2;
    config->work_max = settings->work_max;
    config->area_is_fixed = settings->area_is_fixed;
    config->area = settings->area;
}

static void apply_to_passive(const struct rho_settings *settings, struct rho_passive_config *config)
{
    const float range_m = rho_smaller(settings->range_max_m, PASSIVE_RANGE_MAX_M);
    config->range_max_m = range_m > PASSIVE_RANGE_MIN_M ? range_m : PASSIVE_RANGE_MIN_M;
    config->rho_cell_m = PASSIVE_SPAN * config->range_max_m / (float)RHO_PASSIVE_RHO_CELLS;
    config->v_max_mps = settings->v_max_mps;
    config->pd = settings->pd;
    config->false_tracks_per_hour = settings->false_tracks_per_hour;
}

void rho_settings_apply(const struct rho_settings *settings, struct rho_tracker_config *tracker,
                        struct rho_initiator_config *initiator, struct rho_passive_config *passive)
{
    if (tracker) {
        apply_to_tracker(settings, tracker);
    }
    if (initiator) {
        apply_to_initiator(settings, initiator);
    }
    if (passive) {
        apply_to_passive(settings, passive);
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
