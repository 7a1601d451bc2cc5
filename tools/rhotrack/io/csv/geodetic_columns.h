/* SPDX-License-Identifier: MIT */
/*
 * geodetic_columns: converts latitudes, longitudes and heights in a file of plots, polar plots,
 * bearings or truth to positions in the local frame.
 *
 * lat_deg, lon_deg[, alt_m] replace x_m, y_m[, z_m]; sensor_lat_deg, sensor_lon_deg[, sensor_alt_m]
 * replace sensor_x_m and so on, and azimuths then count from the radar's own north; alt_m of a
 * polar plot is the target's height, in place of an elevation. Degrees north and east, -90 .. 90
 * and -180 .. 360; metres above the WGS 84 ellipsoid.
 */
#ifndef RHOTRACK_TOOL_GEODETIC_COLUMNS_H
#define RHOTRACK_TOOL_GEODETIC_COLUMNS_H

#include <stdbool.h>
#include <stdint.h>

#include "io/csv/radar_axes.h"
#include "io/csv/row_cells.h"
#include "settings/parameters.h"

struct geodetic_columns;

/*
 * Finds the columns of a table. The parameters, which give the origin, must outlive the object.
 * Exit 2, with the header's line, where one of two columns is missing, a position is given twice,
 * there are latitudes without an origin, or two sources of heights.
 */
struct geodetic_columns *geodetic_open(const struct table *table,
                                       const struct parameters *parameters);
void geodetic_close(struct geodetic_columns *geodetic); /* frees the object; NULL is allowed */

/* Whether the table has lat_deg and lon_deg as positions of plots or targets; false for NULL. */
bool geodetic_has_places(const struct geodetic_columns *geodetic);

/* Whether its rows, or the parameters, may give a sensor's place as latitude and longitude. */
bool geodetic_has_sensor_places(const struct geodetic_columns *geodetic);

/* The functions that follow return false where the row is bad, with the reason set. */

/* Reads the row's position. Without alt_m it is taken at the origin's height, and z_m is 0. */
bool geodetic_read_place(struct geodetic_columns *geodetic, const struct row_check *check,
                         double place_m[3], bool *has_alt);

/*
 * The frame of the row's radar, where the row or the parameters give its position as latitude and
 * longitude; else NULL. Valid until another frame is found, or the close.
 */
bool geodetic_radar_frame(struct geodetic_columns *geodetic, const struct row_check *check,
                          int32_t sensor_id, const struct radar_axes **frame);

/* A polar plot under conversion. */
struct geodetic_polar {
    int32_t sensor_id;
    const struct radar_axes *frame; /* result of geodetic_radar_frame */
    double place_m[3];              /* position of the radar in the local frame */
    struct radar_look look;
    bool has_elevation;
    double sigma_range_m;
    double sigma_elevation_rad; /* set where alt_m was converted to an elevation */
};

/*
 * Converts angles from the radar's own frame to the local frame, and alt_m, if the row has it, to
 * an elevation.
 */
bool geodetic_turn_polar(struct geodetic_columns *geodetic, const struct row_check *check,
                         struct geodetic_polar *polar);

#endif
