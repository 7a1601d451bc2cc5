/* SPDX-License-Identifier: MIT */
/*
 * local_frame: latitude, longitude and height to and from a local frame in metres, by PROJ.
 *
 * The frame is the tangent plane of the WGS 84 ellipsoid at its origin: x east, y true north, z
 * along the ellipsoid's normal. It is not a map: z falls below the ground with distance (785 m at
 * 100 km), and distances are true in space. Latitude and longitude are geodetic, in degrees, north
 * and east positive; heights are above the ellipsoid, not above mean sea level (the geoid is up to
 * 106 m off it).
 *
 * All values passed are finite; latitudes within +-90. Frames are for one thread at a time.
 */
#ifndef RHOTRACK_TOOL_LOCAL_FRAME_H
#define RHOTRACK_TOOL_LOCAL_FRAME_H

#include <stdbool.h>

struct local_frame;

/* The frame at a place. Never NULL: ends the program (exit 1) where PROJ is not able to make it. */
struct local_frame *local_frame_open(double lat_deg, double lon_deg, double alt_m);
void local_frame_close(struct local_frame *frame); /* NULL: nothing */

/*
 * geodetic: lat_deg, lon_deg, alt_m. There and back again: within 1 mm as far as 2000 km away. The
 * arrays may be one.
 */
void local_frame_to_local(const struct local_frame *frame, const double geodetic[3],
                          double place_m[3]);
void local_frame_to_geodetic(const struct local_frame *frame, const double place_m[3],
                             double geodetic[3]); /* longitude -180 .. 180 */

/* The place above or below x, y that has this height: to 1 mm as far as 2000 km away. */
void local_frame_at_height(const struct local_frame *frame, double x_m, double y_m, double alt_m,
                           double geodetic[3]);

/* A radar's view of a target whose height is known otherwise, as by its transponder. */
struct local_frame_plot {
    double range_m;     /* slant range, from the radar to the target */
    double azimuth_rad; /* counter-clockwise from the radar's own east, in its own tangent plane */
    double alt_m;       /* of the target above the ellipsoid */
};

/*
 * Where that target is: place_m in the radar's own frame, whose origin is the radar. Exact on the
 * ellipsoid, to 0.1 mm. False, and nothing is filled, where there is no such place: the height
 * differs from the radar's by more than range_m.
 */
bool local_frame_from_range_and_height(const struct local_frame *radar,
                                       const struct local_frame_plot *plot, double place_m[3]);

/* A place of one frame in another one. The arrays may be one. */
void local_frame_convert_place(const struct local_frame *from, const struct local_frame *to,
                               const double place_m[3], double other_m[3]);

/*
 * By how much the true north of `from`, at its origin, is turned in `to`, in radians
 * counter-clockwise (meridian convergence): an azimuth in `from` plus this is the azimuth in `to`,
 * but for the tilt of the horizons (at 100 km 0.9 degrees, which turn level lines by 0.00013 rad at
 * most).
 */
double local_frame_turn_rad(const struct local_frame *from, const struct local_frame *to);

#endif
