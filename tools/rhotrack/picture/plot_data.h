/* SPDX-License-Identifier: MIT */
/*
 * plot_data: what the plot command draws: plots, bearings, tracks and truth from CSV files, told
 * apart by their columns, and LCM logs.
 */
#ifndef RHOTRACK_TOOL_PLOT_DATA_H
#define RHOTRACK_TOOL_PLOT_DATA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "io/csv/table.h"
#include "settings/parameters.h"

#define PLOT_LEGEND_MAX                                                                            \
    8 /* more tracks or targets than that get no line of their own in the legend */

struct plot_point {
    int64_t time_us;
    int32_t id; /* of the track or target */
    double x_m, y_m;
    double vx_mps, vy_mps; /* 0 where not given */
    bool is_tentative;
    const struct table *table; /* of a track's row; the data's */
    size_t row;
};

/* By identity, then time (plots: as in the file). */
struct plot_points {
    struct plot_point *list;
    size_t count;
};

/* From a passive sensor as far as it sees. */
struct plot_ray {
    size_t sensor; /* index of the list */
    int64_t time_us;
    double x_m, y_m, end_x_m, end_y_m;
};

/* All bearings of the files, and their sensors in the order of sensor_id. */
struct plot_rays {
    struct plot_ray *list;
    size_t count;
    struct plot_point *sensors;
    size_t num_sensors;
    bool has_own_file; /* one of the files has bearings and nothing else to draw */
};

/* A radar whose place is known: the plots' own columns or the parameters say it. */
struct plot_radar {
    int32_t sensor_id;
    double x_m, y_m;
    double range_max_m; /* INFINITY: not said */
    double sector_from_rad, sector_to_rad;
};

struct plot_data {
    struct plot_points plots, tracks, truth;
    struct plot_rays bearings;
    struct plot_radar *radars; /* in the order of their first plots */
    size_t num_radars, radars_capacity;
    char **plot_paths; /* of the files with plots; the names are the caller's */
    int num_plot_paths;
    struct table **track_tables;
    size_t num_track_tables, track_tables_capacity;
};

/*
 * Reads the files; errors as `rhotrack: FILE:LINE: what is wrong`, exit 2. A track's rows while
 * tentative are kept, but tracks that were never confirmed are left out. The parameters say where
 * the sensors of polar plots are, what their biases are, and how far passive sensors see.
 */
struct plot_data plot_data_read(char *const *paths, int num_paths,
                                const struct parameters *parameters);
void plot_data_free(struct plot_data *data);

/* The rows of one identity: from *at on; moves *at behind them. False at the end. */
bool plot_data_next_identity(const struct plot_points *points, size_t *at, struct plot_points *one);

/* How many identities. */
size_t plot_data_count_identities(const struct plot_points *points);

/*
 * Times are shown from here on: the first time of all where that is late (a clock's), else 0; and
 * the words for it, "time (s)" or the same with where it begins.
 */
int64_t plot_data_first_shown_us(const struct plot_data *data);
void plot_data_time_label(const struct plot_data *data, char *text, size_t size);

/* A track's own ellipse of one sigma; false where its row does not say it. */
struct plot_ellipse {
    double major_m, minor_m, angle_rad; /* of the major axis, counter-clockwise from east */
};
bool plot_data_sigma_ellipse(const struct plot_point *track, struct plot_ellipse *ellipse);

#endif
