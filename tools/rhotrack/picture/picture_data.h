/* SPDX-License-Identifier: MIT */
/*
 * picture_data: reads what the command plot draws: plots, bearings, tracks and truth from LCM logs
 * and from CSV files, which are told apart by their columns.
 */
#ifndef RHOTRACK_TOOL_PICTURE_DATA_H
#define RHOTRACK_TOOL_PICTURE_DATA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "io/csv/csv_table.h"
#include "settings/parameters.h"

#define PLOT_LEGEND_MAX 8 /* most tracks or targets that have an entry each in the legend */

struct plot_point {
    int64_t time_us;
    int32_t id; /* id of the track or target; 0 for plots */
    double x_m, y_m;
    double vx_mps, vy_mps; /* velocity; 0 where not given */
    bool is_tentative;
    /* table of the row; of a track it is one of plot_data.track_tables */
    const struct table *table;
    size_t row;
};

/* Points sorted by identity, then time; plots are in the order of the file. */
struct plot_points {
    struct plot_point *list;
    size_t count;
};

/* The ray of a bearing, from the passive sensor to its maximum range. */
struct plot_ray {
    size_t sensor; /* index of the sensor in plot_rays.sensors */
    int64_t time_us;
    double x_m, y_m, end_x_m, end_y_m;
};

/* All bearings of the files, and their sensors in the order of sensor_id. */
struct plot_rays {
    struct plot_ray *list;
    size_t count;
    struct plot_point *sensors;
    size_t num_sensors;
    bool has_own_file; /* true where a file has bearings and no plots, tracks or truth */
};

/* A radar whose place is known from columns of the plots or from the parameters. */
struct plot_radar {
    int32_t sensor_id;
    double x_m, y_m;
    double range_max_m; /* INFINITY where not known */
    double sector_from_rad, sector_to_rad;
};

struct picture_data {
    struct plot_points plots, tracks, truth;
    struct plot_rays bearings;
    struct plot_radar *radars; /* radars in the order of their first plots */
    size_t num_radars, radars_capacity;
    char **plot_paths; /* paths of the files with plots; the strings are the caller's */
    int num_plot_paths;
    struct table **track_tables;
    size_t num_track_tables, track_tables_capacity;
};

/*
 * Reads the files; errors end the program as `rhotrack: FILE:LINE: what is wrong`, exit 2. Tracks
 * that were never confirmed are left out; tentative rows of the others are kept. The parameters
 * give places and biases of the sensors of polar plots, and the range of passive sensors.
 */
struct picture_data picture_data_read(char *const *paths, int num_paths,
                                      const struct parameters *parameters);
void picture_data_free(struct picture_data *data);

/*
 * Sets *one to the rows of the identity that begins at *at, and moves *at behind them. False at the
 * end.
 */
bool picture_data_next_identity(const struct plot_points *points, size_t *at,
                                struct plot_points *one);

/* Number of different identities among points sorted by identity. */
size_t picture_data_count_identities(const struct plot_points *points);

/*
 * Time that pictures show as 0: the earliest time where it is a clock's (1000 s or more), else 0;
 * and the label of a time axis, "time (s)" or "time (s), from T on".
 */
int64_t picture_data_time_origin_us(const struct picture_data *data);
void picture_data_write_time_label(const struct picture_data *data, char *text, size_t size);

/* The number that a track's row has in this column; NAN without such a column or number. */
double plot_data_number_in_column(const struct plot_point *track, const char *column);

/*
 * One-sigma ellipse of a track's position by its covariance columns, or sigma_m; false where the
 * row has neither.
 */
struct plot_ellipse {
    /* semi-axes; angle of the major one, counter-clockwise from east */
    double major_m, minor_m, angle_rad;
};
bool picture_data_sigma_ellipse(const struct plot_point *track, struct plot_ellipse *ellipse);

#endif
