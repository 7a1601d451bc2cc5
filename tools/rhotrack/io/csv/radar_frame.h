/* SPDX-License-Identifier: MIT */
/*
 * radar_frame: what a radar measures in its own level frame, as azimuth and elevation in the local
 * frame.
 *
 * A radar counts azimuths from its own true north and elevations from its own horizon. In the local
 * frame, the tangent plane at another place, its north is turned (meridian convergence) and its
 * horizon is tilted, by 0.9 degrees each 100 km: 1.6 km of height at a range of 100 km. Ranges are
 * the same.
 *
 * A height that comes from elsewhere (a transponder) makes a slant range a place: it is told as the
 * elevation of the line of sight, with the noise upwards that height and range bring in.
 */
#ifndef RHOTRACK_TOOL_RADAR_FRAME_H
#define RHOTRACK_TOOL_RADAR_FRAME_H

#include <stdbool.h>

#include "io/csv/local_frame.h"

struct radar_frame;

/*
 * A radar at a place on the earth (lat_deg, lon_deg, alt_m), in the frame `common`. has_own_north:
 * its azimuths are from its own north and its elevations from its own horizon; else its place was
 * said in metres, and azimuths are those of the common frame, elevations too. Never NULL. place_m:
 * in the common frame.
 */
struct radar_frame *radar_frame_open(const struct local_frame *common, const double geodetic[3],
                                     bool has_own_north);
void radar_frame_close(struct radar_frame *frame); /* NULL: nothing */
const double *radar_frame_place_m(const struct radar_frame *frame);

/* By how much its azimuths are turned in the common frame; 0 where they are counted there. */
double radar_frame_turn_rad(const struct radar_frame *frame);

/* A line of sight of this length; angles as rho_polar_plot has them. */
struct radar_look {
    double range_m, azimuth_rad, elevation_rad;
};

/*
 * From the radar's own frame to the common one, in place. Without elevation the azimuth is turned,
 * and that is all.
 */
void radar_frame_turn_look(const struct radar_frame *frame, bool has_elevation,
                           struct radar_look *look);

/* A height that goes with a range. */
struct radar_height {
    double alt_m; /* above the ellipsoid */
    double sigma_alt_m, sigma_range_m;
};

/*
 * The elevation that the height means, and its noise: the sigma upwards, at right angles to the
 * line of sight, over the range, at most 0.5. The look (range and azimuth set, as the radar has
 * them) becomes one of the common frame. frame NULL: on a flat earth, where the radar is at
 * radar_z_m; else exact on the ellipsoid. False where there is no such place: the height differs
 * from the radar's by more than the range.
 */
bool radar_frame_elevation_from_height(const struct radar_frame *frame, double radar_z_m,
                                       const struct radar_height *height, struct radar_look *look,
                                       double *sigma_elevation_rad);

#endif
