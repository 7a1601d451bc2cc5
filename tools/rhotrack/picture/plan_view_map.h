/* SPDX-License-Identifier: MIT */
/*
 * plan_view_map: draws plots, tracks and radars on a map in gnuplot, in metres or kilometres with
 * one scale for both axes; range rings and coverage of radars; thins out plots that could not be
 * told apart.
 */
#ifndef RHOTRACK_TOOL_PLAN_VIEW_MAP_H
#define RHOTRACK_TOOL_PLAN_VIEW_MAP_H

#include <stdio.h>

#include "picture/gnuplot_picture_file.h"
#include "picture/picture_data.h"

#define MAP_KILOMETRES_FROM_M 4000.0

/* most plots drawn; more are sampled, as an SVG of a million has 142 MB */
#define MAP_PLOTS_MAX 20000

/* The area that must be visible, in metres. */
struct map_box {
    double x_min_m, x_max_m, y_min_m, y_max_m;
};

/*
 * map_box_empty is a box without any place; the others extend a box to include a place, a list of
 * points or all radars.
 */
struct map_box map_box_empty(void);
void map_box_include(struct map_box *box, double x_m, double y_m);
void map_box_include_points(struct map_box *box, const struct plot_points *points);
void map_box_include_radars(struct map_box *box, const struct picture_data *data);

struct map {
    FILE *script;        /* file to which gnuplot commands are written */
    double unit_m;       /* length of the axes' unit: 1 or 1000 m */
    double pixels_per_m; /* approximate scale of the map */
    struct map_box box;  /* visible area */
};

/*
 * Writes the axes of a map of this box with a margin; in kilometres where it is longer than
 * MAP_KILOMETRES_FROM_M.
 */
struct map map_start(const struct picture *picture, struct map_box box);

/* Writes a row of a gnuplot data block: x, y, seconds since zero_us, identity. */
void map_write_point(const struct map *map, const struct plot_point *point, int64_t zero_us);

/* Writes the points as a data block $name; two blank lines separate identities. */
void map_write_points(const struct map *map, const char *name, const struct plot_points *points);

/* Number of plots drawn of `count`. */
size_t map_num_plots_drawn(size_t count);

/* Writes the drawn plots as the data block $plots. */
void map_write_sampled_plots(const struct map *map, const struct plot_points *plots,
                             int64_t zero_us);

/*
 * Writes the clause of gnuplot's command plot that draws $plots beneath other data; the legend says
 * "N of M plots" where not all are drawn.
 */
void map_draw_plots(const struct map *map, const struct plot_points *plots);

/*
 * map_write_range_rings writes data blocks and labels, before the command plot: range
 * rings (for at most three radars: more would hide the rest) and coverage where it is known.
 * map_draw_range_rings writes the clauses of the command plot that draw them.
 */
void map_write_range_rings(const struct map *map, const struct plot_radar *radars, size_t count);
void map_draw_range_rings(const struct map *map, const struct plot_radar *radars, size_t count);

/* Interval in points between markers of a path, so that neighbouring markers can be told apart. */
size_t map_points_between_markers(const struct map *map, const struct plot_points *path);

/* Rounds down to 1, 2 or 5 times a power of ten. */
double map_round_down_to_1_2_5(double value);

#endif
