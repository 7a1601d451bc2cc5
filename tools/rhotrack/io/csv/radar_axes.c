/* SPDX-License-Identifier: MIT */
#include "io/csv/radar_axes.h"

#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "rhotrack/types.h"

#define TURN 6.283185307179586
#define EARTH_RADIUS_M 6371000.0 /* only for a noise, and not for a position */

struct radar_axes {
    const struct local_frame *common;
    struct local_frame *own;
    bool has_own_north;
    double alt_m, turn_rad, place_m[3];
};

struct radar_axes *radar_axes_open(const struct local_frame *common, const double geodetic[3],
                                   bool has_own_north)
{
    struct radar_axes *frame = must_calloc(1, sizeof *frame);

    frame->common = common;
    frame->own = local_frame_open(geodetic[0], geodetic[1], geodetic[2]);
    frame->has_own_north = has_own_north;
    frame->alt_m = geodetic[2];
    frame->turn_rad = local_frame_convergence_rad(frame->own, common);
    local_frame_to_local(common, geodetic, frame->place_m);
    return frame;
}

void radar_axes_close(struct radar_axes *frame)
{
    if (frame) {
        local_frame_close(frame->own);
        free(frame);
    }
}

const double *radar_axes_place_m(const struct radar_axes *frame)
{
    return frame->place_m;
}

double radar_axes_turn_rad(const struct radar_axes *frame)
{
    return frame->has_own_north ? frame->turn_rad : 0.0;
}

/* Azimuth and elevation in the common frame of a position in the radar's own frame. */
static void set_common_angles(const struct radar_axes *frame, const double own_m[3],
                              struct radar_look *look)
{
    double place_m[3];

    local_frame_convert_place(frame->own, frame->common, own_m, place_m);
    for (int i = 0; i < 3; i++) {
        place_m[i] -= frame->place_m[i];
    }
    look->azimuth_rad = atan2(place_m[1], place_m[0]);
    look->elevation_rad = atan2(place_m[2], hypot(place_m[0], place_m[1]));
}

void radar_axes_look_to_common(const struct radar_axes *frame, bool has_elevation,
                               struct radar_look *look)
{
    double ground_m = look->range_m * cos(look->elevation_rad);
    const double own_m[3] = {ground_m * cos(look->azimuth_rad), ground_m * sin(look->azimuth_rad),
                             look->range_m * sin(look->elevation_rad)};

    if (!frame->has_own_north) {
        return;
    }
    if (has_elevation) {
        set_common_angles(frame, own_m, look);
    } else {
        look->azimuth_rad = remainder(look->azimuth_rad + frame->turn_rad, TURN);
    }
}

/*
 * Sigma of the position upwards, at right angles to the line of sight u, divided by the range.
 * Range and height determine the position by dP . u = dr and dP . n = dh, n being the vertical at
 * the target, which u meets at the elevation e: the error upwards is (dh - sin e dr) / cos e.
 */
static double elevation_sigma_from_height(const struct radar_height *height, double sin_elevation,
                                          double range_m)
{
    double cos_elevation = sqrt(fmax(0.0, 1 - sin_elevation * sin_elevation));
    double sigma_m = hypot(height->sigma_alt_m, sin_elevation * height->sigma_range_m);
    double sigma_rad = sigma_m / fmax(cos_elevation, 1e-9) / range_m;

    return fmax((double)RHO_LIMIT_SIGMA_RAD_MIN, fmin((double)RHO_LIMIT_SIGMA_RAD_MAX, sigma_rad));
}

static bool elevation_on_flat_earth(double radar_z_m, const struct radar_height *height,
                                    struct radar_look *look, double *sigma_elevation_rad)
{
    double sine = (height->alt_m - radar_z_m) / look->range_m;

    if (!(fabs(sine) <= 1)) {
        return false;
    }
    look->elevation_rad = asin(sine);
    *sigma_elevation_rad = elevation_sigma_from_height(height, sine, look->range_m);
    return true;
}

/*
 * Sine of the elevation of the line of sight at the target, on a spherical earth: from the triangle
 * of radar, target and the earth's centre.
 */
static double elevation_sine_at_target(double radar_alt_m, double target_alt_m, double range_m)
{
    double up_m = target_alt_m - radar_alt_m, target_m = EARTH_RADIUS_M + target_alt_m;
    double sine = (up_m * (target_m + EARTH_RADIUS_M + radar_alt_m) + range_m * range_m) /
                  (2 * target_m * range_m);

    return fmax(-1.0, fmin(1.0, sine));
}

bool radar_axes_height_elevation(const struct radar_axes *frame, double radar_z_m,
                                 const struct radar_height *height, struct radar_look *look,
                                 double *sigma_elevation_rad)
{
    struct local_frame_plot plot = {
        .range_m = look->range_m, .azimuth_rad = look->azimuth_rad, .alt_m = height->alt_m};
    double own_m[3];

    if (!frame) {
        return elevation_on_flat_earth(radar_z_m, height, look, sigma_elevation_rad);
    }
    plot.azimuth_rad -= frame->has_own_north ? 0.0 : frame->turn_rad;
    if (!local_frame_from_slant_range(frame->own, &plot, own_m)) {
        return false;
    }
    set_common_angles(frame, own_m, look);
    *sigma_elevation_rad = elevation_sigma_from_height(
        height, elevation_sine_at_target(frame->alt_m, height->alt_m, look->range_m),
        look->range_m);
    return true;
}
