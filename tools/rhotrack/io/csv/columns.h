/* SPDX-License-Identifier: MIT */
/*
 * columns: the columns that the readers of CSV files know: their names, the other names, units and
 * angles in degrees that files may have in their place, and which of them a table has.
 */
#ifndef RHOTRACK_TOOL_COLUMNS_H
#define RHOTRACK_TOOL_COLUMNS_H

#include <stdbool.h>
#include <stddef.h>

#include "io/csv/csv_table.h"

/*
 * Each column's name, in SI units and radians. --columns may name those of COLUMNS_NAMED, and the
 * columns that have other names too.
 */
#define COLUMNS_NAMED(X)                                                                           \
    X(AZIMUTH_RAD, "azimuth_rad")                                                                  \
    X(BEARING_RAD, "bearing_rad")                                                                  \
    X(ELEVATION_RAD, "elevation_rad")                                                              \
    X(SIGMA_M, "sigma_m")                                                                          \
    X(SIGMA_MPS, "sigma_mps")                                                                      \
    X(SIGMA_RANGE_M, "sigma_range_m")                                                              \
    X(SIGMA_AZIMUTH_RAD, "sigma_azimuth_rad")                                                      \
    X(SIGMA_ELEVATION_RAD, "sigma_elevation_rad")                                                  \
    X(SIGMA_RAD, "sigma_rad")                                                                      \
    X(SECTOR_FROM_RAD, "sector_from_rad")                                                          \
    X(SECTOR_TO_RAD, "sector_to_rad")                                                              \
    X(SCAN, "scan")                                                                                \
    X(EPOCH, "epoch")                                                                              \
    X(RECEIVED_S, "received_s")                                                                    \
    X(SENSOR_X_M, "sensor_x_m")                                                                    \
    X(SENSOR_Y_M, "sensor_y_m")                                                                    \
    X(SENSOR_Z_M, "sensor_z_m")                                                                    \
    X(SENSOR_LAT_DEG, "sensor_lat_deg")                                                            \
    X(SENSOR_LON_DEG, "sensor_lon_deg")                                                            \
    X(SENSOR_ALT_M, "sensor_alt_m")                                                                \
    X(SIGMA_ALT_M, "sigma_alt_m")                                                                  \
    X(TARGET_ID, "target_id")                                                                      \
    X(TRACK_ID, "track_id")                                                                        \
    X(STATUS, "status")                                                                            \
    X(SIGMA_RANGE_RATE_MPS, "sigma_range_rate_mps")                                                \
    X(FRAME, "frame")
#define COLUMNS_WITH_OTHER_NAMES(X)                                                                \
    X(T_S, "t_s")                                                                                  \
    X(SENSOR_ID, "sensor_id")                                                                      \
    X(X_M, "x_m")                                                                                  \
    X(Y_M, "y_m")                                                                                  \
    X(Z_M, "z_m")                                                                                  \
    X(VX_MPS, "vx_mps")                                                                            \
    X(VY_MPS, "vy_mps")                                                                            \
    X(VZ_MPS, "vz_mps")                                                                            \
    X(RANGE_M, "range_m")                                                                          \
    X(RANGE_RATE_MPS, "range_rate_mps")                                                            \
    X(LAT_DEG, "lat_deg")                                                                          \
    X(LON_DEG, "lon_deg")                                                                          \
    X(ALT_M, "alt_m")                                                                              \
    X(SNR_DB, "snr_db")
#define COLUMNS_OF_TRACKS(X)                                                                       \
    X(AX_MPS2, "ax_mps2")                                                                          \
    X(AY_MPS2, "ay_mps2")                                                                          \
    X(AZ_MPS2, "az_mps2")                                                                          \
    X(HITS, "hits")                                                                                \
    X(MISSES, "misses")                                                                            \
    X(PLOT, "plot")                                                                                \
    X(COV_X_X, "cov_x_x")                                                                          \
    X(COV_Y_X, "cov_y_x")                                                                          \
    X(COV_Y_Y, "cov_y_y")                                                                          \
    X(COV_Z_X, "cov_z_x")                                                                          \
    X(COV_Z_Y, "cov_z_y")                                                                          \
    X(COV_Z_Z, "cov_z_z")                                                                          \
    X(COV_VX_X, "cov_vx_x")                                                                        \
    X(COV_VX_Y, "cov_vx_y")                                                                        \
    X(COV_VX_Z, "cov_vx_z")                                                                        \
    X(COV_VX_VX, "cov_vx_vx")                                                                      \
    X(COV_VY_X, "cov_vy_x")                                                                        \
    X(COV_VY_Y, "cov_vy_y")                                                                        \
    X(COV_VY_Z, "cov_vy_z")                                                                        \
    X(COV_VY_VX, "cov_vy_vx")                                                                      \
    X(COV_VY_VY, "cov_vy_vy")                                                                      \
    X(COV_VZ_X, "cov_vz_x")                                                                        \
    X(COV_VZ_Y, "cov_vz_y")                                                                        \
    X(COV_VZ_Z, "cov_vz_z")                                                                        \
    X(COV_VZ_VX, "cov_vz_vx")                                                                      \
    X(COV_VZ_VY, "cov_vz_vy")                                                                      \
    X(COV_VZ_VZ, "cov_vz_vz")                                                                      \
    X(UPDATE_AGE_US, "update_age_us")                                                              \
    X(SCORE_NAT, "score_nat")                                                                      \
    X(MANEUVER_PROBABILITY, "maneuver_probability")
#define COLUMNS_OF_CLUTTER_MAP(X)                                                                  \
    X(SIGMA_CROSS_M, "sigma_cross_m")                                                              \
    X(REGION, "region")                                                                            \
    X(UNSEEN, "unseen")                                                                            \
    X(LOOKS, "looks")                                                                              \
    X(RETURNS, "returns")

#define COLUMN_ENUMERATOR(id, name) COL_##id,
enum column_id {
    COLUMNS_NAMED(COLUMN_ENUMERATOR) COLUMNS_WITH_OTHER_NAMES(COLUMN_ENUMERATOR)
        COLUMNS_OF_TRACKS(COLUMN_ENUMERATOR) COLUMNS_OF_CLUTTER_MAP(COLUMN_ENUMERATOR)
            NUM_COLUMN_IDS
};

const char *column_name(enum column_id column);

/* Where a table has its columns. */
struct columns {
    const struct table *table;
    int at[NUM_COLUMN_IDS]; /* index into the table's columns, -1 where it has no such column */
};

/*
 * Finds all columns, an azimuth or elevation in degrees where there is none in radians, and the
 * number of the frame where there is no time and the table has a frame rate. Azimuth and elevation
 * without a range are a bearing and its elevation; a bearing with a range and without azimuth is a
 * radar's azimuth.
 */
struct columns columns_find(const struct table *table);

/*
 * Index of a column; exit 2 where it is missing, with the columns of the file and advice on the one
 * that may be meant.
 */
int columns_need(const struct columns *columns, enum column_id column);

/* Exit 2 where the table has one of two columns that have a meaning only together, or both. */
void columns_need_both(const struct columns *columns, enum column_id first, enum column_id second);
void columns_refuse_both(const struct columns *columns, enum column_id first,
                         enum column_id second);

/*
 * Azimuths and elevations: a file has them in radians, counter-clockwise from east, or in degrees,
 * clockwise from north. Exit 2 where it has both; other columns have no degrees.
 */
void columns_refuse_two_units(const struct columns *columns, enum column_id angle);
bool columns_has_degrees(const struct columns *columns, enum column_id angle);
double column_radians(enum column_id angle, double degrees);

/*
 * A line of sight that an antenna reached over the zenith, as at 92 degrees: the elevation becomes
 * 88, the azimuth that of the other side. Elevations up to half a turn.
 */
void columns_fold_over_zenith(double *elevation_rad, double *azimuth_rad);

/*
 * Renames the columns of a header to the names that the readers use, from any case and with the
 * units that tools/README.md lists. Known names stay, and so does a header that already names its
 * time and a place. Sets the table's factors and offsets where units differ.
 */
void columns_rename(struct table *table);

/*
 * Sets NAME=COLUMN[,NAME=COLUMN...] of the option --columns: in files that have such a COLUMN it is
 * read as if its name were NAME. Exit 2 where a NAME is not one that is read.
 */
void columns_set_option(const char *text);

/* Exit 2 where no file so far has the columns of --columns. */
void columns_check_option_used(void);

#endif
