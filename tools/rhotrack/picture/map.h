/* SPDX-License-Identifier: MIT */
/* map: places in a picture, in metres or kilometres, one scale for both axes. */
#ifndef RHOTRACK_TOOL_MAP_H
#define RHOTRACK_TOOL_MAP_H

#include <stdio.h>

#include "picture/plot_data.h"

#define MAP_KILOMETRES_FROM_M 4000.0

/* The area that must be visible, in metres. */
struct map_box {
    double x_min_m, x_max_m, y_min_m, y_max_m;
};

/* A box without any place; with one more; wider by a margin on all sides. */
struct map_box map_box_empty(void);
void map_box_include(struct map_box *box, double x_m, double y_m);
void map_box_widen(struct map_box *box, double margin_m);

struct map {
    FILE *script;  /* gnuplot commands */
    double unit_m; /* 1 or 1000 */
};

/*
 * Axes and legend, in kilometres where anything of the data lies further apart than
 * MAP_KILOMETRES_FROM_M.
 */
struct map map_start(FILE *script, const struct plot_data *data);

/* The same for what is so wide as a whole. */
void map_set_extent(struct map *map, double side_m);

/* A row of a data block: x, y, time, identity. */
void map_put_point(const struct map *map, const struct plot_point *point);

/* One data block; identities are apart by two blank lines. */
void map_put_points(const struct map *map, const char *name, const struct plot_points *points);

#endif
