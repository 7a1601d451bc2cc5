/* SPDX-License-Identifier: MIT */
#include "picture/map.h"

#include <math.h>

static double extent_m(const struct plot_points *points)
{
    double largest = 0.0;
    for (size_t i = 1; i < points->count; i++) {
        largest = fmax(largest, fabs(points->list[i].x_m - points->list[0].x_m));
        largest = fmax(largest, fabs(points->list[i].y_m - points->list[0].y_m));
    }
    return largest;
}

static double length_m(const struct plot_rays *rays)
{
    double largest = 0.0;
    for (size_t i = 0; i < rays->count; i++) {
        const struct plot_ray *ray = &rays->list[i];
        largest = fmax(largest, hypot(ray->end_x_m - ray->x_m, ray->end_y_m - ray->y_m));
    }
    return largest;
}

void map_set_extent(struct map *map, double side_m)
{
    const char *unit;
    map->unit_m = side_m > MAP_KILOMETRES_FROM_M ? 1000.0 : 1.0;
    unit = map->unit_m > 1.0 ? "km" : "m";
    fprintf(map->script, "set xlabel 'x east (%s)'\nset ylabel 'y north (%s)'\n", unit, unit);
}

struct map_box map_box_empty(void)
{
    return (struct map_box){INFINITY, -INFINITY, INFINITY, -INFINITY};
}

void map_box_include(struct map_box *box, double x_m, double y_m)
{
    box->x_min_m = fmin(box->x_min_m, x_m);
    box->x_max_m = fmax(box->x_max_m, x_m);
    box->y_min_m = fmin(box->y_min_m, y_m);
    box->y_max_m = fmax(box->y_max_m, y_m);
}

void map_box_widen(struct map_box *box, double margin_m)
{
    map_box_include(box, box->x_min_m - margin_m, box->y_min_m - margin_m);
    map_box_include(box, box->x_max_m + margin_m, box->y_max_m + margin_m);
}

struct map map_start(FILE *script, const struct plot_data *data)
{
    struct map map = {script, 1.0};
    fprintf(map.script, "set size ratio -1\nset key outside top center horizontal\n");
    map_set_extent(&map, fmax(fmax(extent_m(&data->plots), length_m(&data->bearings)),
                              fmax(extent_m(&data->tracks), extent_m(&data->truth))));
    return map;
}

void map_put_point(const struct map *map, const struct plot_point *point)
{
    fprintf(map->script, "%.6g %.6g %.6g %d\n", point->x_m / map->unit_m, point->y_m / map->unit_m,
            (double)point->time_us * 1e-6, point->id);
}

void map_put_points(const struct map *map, const char *name, const struct plot_points *points)
{
    fprintf(map->script, "$%s << EOD\n", name);
    for (size_t i = 0; i < points->count; i++) {
        if (i > 0 && points->list[i].id != points->list[i - 1].id) {
            fprintf(map->script, "\n\n");
        }
        map_put_point(map, &points->list[i]);
    }
    fprintf(map->script, "EOD\n");
}
