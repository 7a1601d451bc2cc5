/* SPDX-License-Identifier: MIT */
/*
 * map: places in a picture, in metres or kilometres, one scale for both axes; radars with their
 * range rings and coverage; and how much of the data can be told apart at that scale.
 */
#ifndef RHOTRACK_TOOL_MAP_H
#define RHOTRACK_TOOL_MAP_H

#include <stdio.h>

#include "picture/picture.h"
#include "picture/plot_data.h"

#define MAP_KILOMETRES_FROM_M 4000.0

#define MAP_PLOTS_MAX 20000 /* more are sampled: an SVG of a million has 142 MB */

/* The area that must be visible, in metres. */
struct map_box {
    double x_min_m, x_max_m, y_min_m, y_max_m;
};

/* A box without any place; with one more, or more. */
struct map_box map_box_empty(void);
void map_box_include(struct map_box *box, double x_m, double y_m);
void map_box_include_points(struct map_box *box, const struct plot_points *points);
void map_box_include_radars(struct map_box *box, const struct plot_data *data);

struct map {
    FILE *script;        /* gnuplot commands */
    double unit_m;       /* 1 or 1000 */
    double pixels_per_m; /* about */
    struct map_box box;  /* what is seen */
};

/*
 * Axes and legend of a map of this box and a margin, in kilometres where it is larger than
 * MAP_KILOMETRES_FROM_M.
 */
struct map map_start(const struct picture *picture, struct map_box box);

/* A row of a data block: x, y, time, identity. */
void map_put_point(const struct map *map, const struct plot_point *point, int64_t zero_us);

/* One data block; identities are apart by two blank lines. */
void map_put_points(const struct map *map, const char *name, const struct plot_points *points);

/* How many of so many plots are drawn, and the index of the k-th of them: evenly, out of step. */
size_t map_num_plots_drawn(size_t count);
size_t map_plot_index(size_t k, size_t count);

/* The data block $plots of those. */
void map_put_plots(const struct map *map, const struct plot_points *plots, int64_t zero_us);

/* Size and colour of plots that are drawn beneath something; "N of M plots" where not all are. */
void map_draw_plots(const struct map *map, const struct plot_points *plots);

/*
 * Radars with range rings (of three at most: more would hide the rest), and their coverage where it
 * is said. Blocks and labels come before the command plot, what draws them within it.
 */
void map_put_radars(const struct map *map, const struct plot_radar *radars, size_t count);
void map_draw_radars(const struct map *map, const struct plot_radar *radars, size_t count);

/* Every how many points of a path a marker can be told from the next. */
size_t map_marker_interval(const struct map *map, const struct plot_points *path);

/* 1, 2 or 5 times a power of ten, not above the value. */
double map_round_to_1_2_5(double value);

#endif
