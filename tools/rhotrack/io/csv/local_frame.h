/* SPDX-License-Identifier: MIT */
/*
 * local_frame: converts latitude, longitude and height to and from a local Cartesian frame, by
 * PROJ.
 *
 * The frame is the tangent plane of the WGS 84 ellipsoid at its origin: x east, y true north, z
 * along the ellipsoid's normal, metres. It is not a map projection: z falls below the ground with
 * distance (785 m at 100 km), and distances are true in space. Latitude and longitude are geodetic,
 * in degrees, north and east positive; heights are above the ellipsoid, not above mean sea level
 * (the geoid is up to 106 m off it).
 *
 * All values passed must be finite; latitudes within +-90. A frame is for one thread at a time.
 */
#ifndef RHOTRACK_TOOL_LOCAL_FRAME_H
#define RHOTRACK_TOOL_LOCAL_FRAME_H

#include <stdbool.h>

struct local_frame;

/* Makes the frame at an origin. Never NULL: exit 1 where PROJ cannot make it. */
struct local_frame *local_frame_open(double lat_deg, double lon_deg, double alt_m);
void local_frame_close(struct local_frame *frame); /* frees a frame; NULL is allowed */

/*
 * Conversions between geodetic (lat_deg, lon_deg, alt_m; longitude -180 .. 180) and local
 * coordinates; there and back they are within 1 mm up to 2000 km away. Both arrays may be the same.
 */
void local_frame_to_local(const struct local_frame *frame, const double geodetic[3],
                          double place_m[3]);
void local_frame_to_geodetic(const struct local_frame *frame, const double place_m[3],
                             double geodetic[3]);

/*
 * The place at x, y in the local frame whose height above the ellipsoid is alt_m, to 1 mm up to
 * 2000 km away.
 */
void local_frame_at_height(const struct local_frame *frame, double x_m, double y_m, double alt_m,
                           double geodetic[3]);

/* A radar's measurement of a target whose height is known from elsewhere, as by a transponder. */
struct local_frame_plot {
    double range_m;     /* slant range from the radar to the target */
    double azimuth_rad; /* counter-clockwise from the radar's own east, in its own tangent plane */
    double alt_m;       /* height of the target above the ellipsoid */
};

/*
 * Position of a target, in the radar's own frame, from its slant range, azimuth and height. Exact
 * on the ellipsoid, to 0.1 mm. Returns false, with place_m unchanged, where the height differs from
 * the radar's by more than range_m.
 */
bool local_frame_from_slant_range(const struct local_frame *radar,
                                  const struct local_frame_plot *plot, double place_m[3]);

/* Converts a position from one frame to another. Both arrays may be the same. */
void local_frame_convert_place(const struct local_frame *from, const struct local_frame *to,
                               const double place_m[3], double other_m[3]);

/*
 * Angle by which the true north of `from`, at its origin, is turned in `to`, in radians
 * counter-clockwise (meridian convergence): an azimuth in `from` plus this angle is the azimuth in
 * `to`, except for the tilt of the horizons (0.9 degrees at 100 km, which turns level lines by at
 * most 0.00013 rad).
 */
double local_frame_convergence_rad(const struct local_frame *from, const struct local_frame *to);

#endif
