/* SPDX-License-Identifier: MIT */
/*
 * geodetic: latitudes, longitudes and heights in a file of plots, polar plots or truth, as places
 * in the local frame.
 *
 * lat_deg, lon_deg[, alt_m] stand for x_m, y_m[, z_m]; sensor_lat_deg, sensor_lon_deg[,
 * sensor_alt_m] for sensor_x_m and so on, then with azimuths from the radar's own north; alt_m of a
 * polar plot is the target's height in the place of an elevation. Degrees north and east, -90 .. 90
 * and -180 .. 360; metres above the WGS 84 ellipsoid.
 */
#ifndef RHOTRACK_TOOL_GEODETIC_H
#define RHOTRACK_TOOL_GEODETIC_H

#include <stdbool.h>
#include <stdint.h>

#include "io/csv/radar_frame.h"
#include "io/csv/row_check.h"
#include "io/csv/table.h"
#include "settings/parameters.h"

struct geodetic;

/*
 * The columns of a table, and the origin. The parameters stay the caller's, and must outlive it.
 * Exit 2, with the header's line: one of two columns is missing, a place is there twice, latitudes
 * without an origin, two sources of heights.
 */
struct geodetic *geodetic_open(const struct table *table, const struct parameters *parameters);
void geodetic_close(struct geodetic *geodetic); /* NULL: nothing */

/* lat_deg and lon_deg are there and mean places. NULL: no. */
bool geodetic_has_place_columns(const struct geodetic *geodetic);

/* Below, bool false: the row is bad, and the reason is set. */

/* The row has anything in lat_deg, lon_deg or alt_m. */
bool geodetic_row_has_place(const struct geodetic *geodetic, const struct row_check *check);

/* The place. Without alt_m it is that of the origin's height, and z_m is 0. */
bool geodetic_read_place(struct geodetic *geodetic, const struct row_check *check,
                         double place_m[3], bool *has_alt);

/*
 * The radar's frame, where its place was said on the earth, by the row or the parameters; else
 * NULL. Valid until closed.
 */
bool geodetic_find_radar_frame(struct geodetic *geodetic, const struct row_check *check,
                               int32_t sensor_id, const struct radar_frame **frame);

/* A polar plot on its way. */
struct geodetic_polar {
    int32_t sensor_id;
    const struct radar_frame *frame; /* as geodetic_find_radar_frame found it */
    double place_m[3];               /* of the radar */
    struct radar_look look;
    bool has_elevation;
    double sigma_range_m;
    double sigma_elevation_rad; /* set where alt_m became an elevation */
};

/* From the radar's own north to the local frame, and alt_m, if the row has it, to an elevation. */
bool geodetic_convert_polar(struct geodetic *geodetic, const struct row_check *check,
                            struct geodetic_polar *polar);

#endif
