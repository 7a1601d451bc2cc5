/* SPDX-License-Identifier: MIT */
/*
 * coverage: the tracks that a scan can see.
 *
 * A track well outside the field of view is left as it is: it is not predicted, gets no plots and
 * counts no miss. So a sensor's scans change no bit of the estimates of tracks that it cannot see,
 * and the cost of a sector grows with the tracks in it alone. The margin of the field of view grows
 * with the uncertainty of the track's place, so that a track that no sensor sees is predicted in
 * the end, until its place is too uncertain to be of use.
 */
#include "policy.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"
#include "sight.h"

static int is_near_sector(float azimuth_rad, float from_rad, float to_rad, float margin_rad)
{
    const float to_first_rad = rho_angle_difference(azimuth_rad, from_rad);
    const float to_last_rad = rho_angle_difference(azimuth_rad, to_rad);
    return rho_angle_in_sector(azimuth_rad, from_rad, to_rad) ||
           (to_first_rad <= margin_rad && to_first_rad >= -margin_rad) ||
           (to_last_rad <= margin_rad && to_last_rad >= -margin_rad);
}

int rho_coverage_holds_plot(const struct rho_sensor *sensor, const struct rho_plot *plot,
                            uint32_t measures)
{
    if (!sensor) {
        return 1;
    }
    const float dx_m = plot->x_m - sensor->x_m, dy_m = plot->y_m - sensor->y_m;
    const float dz_m = measures & RHO_MEASURES_Z ? plot->z_m - sensor->z_m : 0.0f;
    const float ground_m = rho_sqrt(dx_m * dx_m + dy_m * dy_m);
    const float slant_m = rho_sqrt(ground_m * ground_m + dz_m * dz_m);
    const float range_sigma_m = PLOT_SIGMAS * plot->sigma_range_m;
    const float cross_sigma_m = PLOT_SIGMAS * plot->sigma_cross_m;
    if (ground_m - range_sigma_m > sensor->range_max_m ||
        slant_m + range_sigma_m < sensor->range_min_m) {
        return 0;
    }
    return !(cross_sigma_m < ground_m) ||
           rho_angle_is_circle(sensor->sector_from_rad, sensor->sector_to_rad) ||
           rho_coverage_holds_bearing(sensor, rho_atan2(dy_m, dx_m), cross_sigma_m / ground_m);
}

/* True where the scan or the sensor covers a sector instead of the full circle. */
static int covers_part_of_circle(const struct rho_look *look)
{
    const struct rho_scan *scan = look->scan;
    const struct rho_sensor *sensor = look->sensor;
    return !rho_angle_is_circle(scan->sector_from_rad, scan->sector_to_rad) ||
           (sensor && !rho_angle_is_circle(sensor->sector_from_rad, sensor->sector_to_rad));
}

int rho_coverage_holds_bearing(const struct rho_sensor *sensor, float bearing_rad, float margin_rad)
{
    return is_near_sector(bearing_rad, sensor->sector_from_rad, sensor->sector_to_rad, margin_rad);
}

int rho_coverage_may_see(const struct rho_look *look, const struct rho_track *track)
{
    const struct rho_scan *scan = look->scan;
    const struct rho_sensor *sensor = look->sensor;
    const float *state = track->kalman.state;
    const int is_part = covers_part_of_circle(look);
    if (!sensor && !is_part) {
        return 1;
    }
    float dt_s = rho_seconds_between(track->time_us, look->time_us);
    const float dx_m = state[0] + state[3] * dt_s - (sensor ? sensor->x_m : 0.0f);
    const float dy_m = state[1] + state[4] * dt_s - (sensor ? sensor->y_m : 0.0f);
    const float range_m = rho_sqrt(dx_m * dx_m + dy_m * dy_m);
    if (sensor && range_m <= sensor->range_max_m && range_m >= sensor->range_min_m && !is_part) {
        return 1;
    }
    dt_s = rho_magnitude(dt_s); /* the track's estimate may be newer than the scan */
    const float margin_m =
        MARGIN_SIGMAS * (rho_track_sigma_m(track) + rho_track_sigma_mps(track) * dt_s) +
        look->tracker->config.accel_max_mps2 * dt_s * dt_s + MARGIN_SHARE * range_m;
    if (sensor &&
        (range_m - margin_m > sensor->range_max_m || range_m + margin_m < sensor->range_min_m)) {
        return 0;
    }
    if (!(margin_m < range_m) || !is_part) {
        return 1; /* plots of a track within the margin of the sensor may be in any direction */
    }
    /* upper bound of the angle that the margin subtends: asin(x) <= x pi / 2 for x in 0 .. 1 */
    const float margin_rad = margin_m / range_m * (0.5f * RHO_PI);
    const float azimuth_rad = rho_atan2(dy_m, dx_m);
    return is_near_sector(azimuth_rad, scan->sector_from_rad, scan->sector_to_rad, margin_rad) &&
           (!sensor || rho_coverage_holds_bearing(sensor, azimuth_rad, margin_rad));
}

int rho_coverage_holds_track(const struct rho_look *look, float sector_from_rad,
                             float sector_to_rad, const struct rho_track *track)
{
    return rho_measurement_covers(look->sensor, sector_from_rad, sector_to_rad,
                                  track->kalman.state[0], track->kalman.state[1]);
}
