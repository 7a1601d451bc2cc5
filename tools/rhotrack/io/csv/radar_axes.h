/* SPDX-License-Identifier: MIT */
/*
 * radar_axes: converts a radar's angles from its own level frame to the
 * common local frame.
 *
 * A radar counts azimuths from its own true north and elevations from its own horizon. In the local
 * frame, the tangent plane at another place, its north is turned (meridian convergence) and its
 * horizon is tilted, by 0.9 degrees each 100 km: 1.6 km of height at a range of 100 km. Ranges are
 * equal in both.
 *
 * A target's height that is known from elsewhere (a transponder) is converted with the slant range
 * to the elevation of the line of sight, with the noise upwards that height and range cause.
 */
#ifndef RHOTRACK_TOOL_RADAR_AXES_H
#define RHOTRACK_TOOL_RADAR_AXES_H

#include <stdbool.h>

#include "io/csv/local_frame.h"

struct radar_axes;

/*
 * Makes the frame of a radar at a place on the earth (lat_deg, lon_deg, alt_m) beside the frame
 * `common`. has_own_north: its azimuths count from its own north and its elevations from its own
 * horizon; else, where its position is given in metres, both are those of the common frame. Never
 * NULL. radar_axes_place_m: its position in the common frame.
 */
struct radar_axes *radar_axes_open(const struct local_frame *common, const double geodetic[3],
                                   bool has_own_north);
void radar_axes_close(struct radar_axes *frame); /* frees a frame; NULL is allowed */
const double *radar_axes_place_m(const struct radar_axes *frame);

/* Angle to be added to its azimuths in the common frame; 0 where they are measured there. */
double radar_axes_turn_rad(const struct radar_axes *frame);

/* A line of sight with its length; angles as in rho_polar_plot. */
struct radar_look {
    double range_m, azimuth_rad, elevation_rad;
};

/*
 * Converts a line of sight from the radar's own frame to the common one, in place. Without
 * elevation only the azimuth is turned, by the meridian convergence.
 */
void radar_axes_look_to_common(const struct radar_axes *frame, bool has_elevation,
                               struct radar_look *look);

/* A target's height and the sigmas of height and slant range. */
struct radar_height {
    double alt_m; /* height above the ellipsoid */
    double sigma_alt_m, sigma_range_m;
};

/*
 * Computes a target's elevation from its height and slant range, and its sigma: the noise upwards,
 * at right angles to the line of sight, divided by the range, at most 0.5. look: range and azimuth
 * as measured, converted to the common frame. frame NULL: on a flat earth, with the radar at
 * radar_z_m; else exact on the ellipsoid. Returns false where the height differs from the radar's
 * by more than the range.
 */
bool radar_axes_height_elevation(const struct radar_axes *frame, double radar_z_m,
                                 const struct radar_height *height, struct radar_look *look,
                                 double *sigma_elevation_rad);

#endif
