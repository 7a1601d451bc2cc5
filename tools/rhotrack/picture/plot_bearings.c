/* SPDX-License-Identifier: MIT */
#include "picture/plot_bearings.h"

#include <math.h>

#include "picture/plan_view_map.h"

#define RAYS_MAX 6000       /* most rays drawn; more are sampled */
#define RAYS_CROWDED 2000.0 /* number of rays from which they are drawn most transparent */

/* Box of sensors, plots and truth; without plots and truth also of the rays' ends. */
static struct map_box map_box_of_data(const struct picture_data *data)
{
    const struct plot_rays *rays = &data->bearings;
    struct map_box box = map_box_empty();
    const struct plot_points sensors = {.list = rays->sensors, .count = rays->num_sensors};
    map_box_include_points(&box, &sensors);
    map_box_include_points(&box, &data->plots);
    map_box_include_points(&box, &data->truth);
    if (data->plots.count + data->truth.count == 0) {
        for (size_t i = 0; i < rays->count; i++) {
            map_box_include(&box, rays->list[i].end_x_m, rays->list[i].end_y_m);
        }
    }
    return box;
}

static size_t num_rays_drawn(const struct plot_rays *rays)
{
    return rays->count < RAYS_MAX ? rays->count : RAYS_MAX;
}

static void put_sensors(const struct map *map, const struct plot_rays *rays)
{
    fprintf(map->script, "$sensors << EOD\n");
    for (size_t i = 0; i < rays->num_sensors; i++) {
        map_write_point(map, &rays->sensors[i], 0);
    }
    fprintf(map->script, "EOD\n");
}

/* Draws an arrow head at the end of each target's path. */
static void put_arrow_at_end_of_each_path(const struct map *map, const struct plot_points *truth)
{
    struct plot_points one;
    size_t at = 0;
    while (picture_data_next_identity(truth, &at, &one)) {
        if (one.count > 1) {
            const struct plot_point *end = &one.list[one.count - 1], *before = end - 1;
            fprintf(map->script,
                    "set arrow from %.6g,%.6g to %.6g,%.6g head filled size screen 0.012,18 lw 2 "
                    "lc rgb '#000000' front\n",
                    before->x_m / map->unit_m, before->y_m / map->unit_m, end->x_m / map->unit_m,
                    end->y_m / map->unit_m);
        }
    }
}

/* Alpha of the rays' colour, larger for more rays; 0 is opaque, 255 invisible. */
static int ray_transparency_0_to_255(const struct plot_rays *rays)
{
    return (int)(90.0 + 130.0 * fmin(1.0, sqrt((double)rays->count / RAYS_CROWDED)));
}

void plot_bearings_draw_rays(const struct map *map, const struct plot_rays *rays)
{
    for (size_t i = 0; i < rays->num_sensors; i++) {
        fprintf(map->script, ", \\\n $rays%zu using 1:2 with lines lw 0.6 lc rgb '#%02x%s' notitle",
                i, (unsigned)ray_transparency_0_to_255(rays), picture_colour(i) + 1);
        /* the sample in the legend is opaque */
        fprintf(map->script, ", \\\n NaN with lines lw 2 lc rgb '%s' title 'sensor %d'",
                picture_colour(i), rays->sensors[i].id);
    }
}

void plot_bearings_draw_sensors(const struct map *map, const struct plot_rays *rays)
{
    for (size_t i = 0; i < rays->num_sensors; i++) {
        fprintf(map->script,
                ", \\\n $sensors every ::%zu::%zu using 1:2 with points pt 9 ps 2.4 lc rgb "
                "'#ffffff' notitle, \\\n $sensors every ::%zu::%zu using 1:2 with points pt 9 ps "
                "1.7 lc rgb '%s' notitle",
                i, i, i, i, picture_colour(i));
    }
    fprintf(map->script, ", \\\n $sensors using 1:2:(sprintf('sensor %%d', $4)) with labels left "
                         "boxed offset 1.2,-0.9 tc rgb '#000000' notitle");
}

void plot_bearings_write_data(const struct map *map, const struct plot_rays *rays)
{
    for (size_t i = 0; i < rays->num_sensors; i++) {
        /*
         * Writes the rays of a sensor as a data block $rays0, $rays1, ..., so that each sensor has
         * its colour.
         */
        fprintf(map->script, "$rays%zu << EOD\n", i);
        for (size_t k = 0; k < num_rays_drawn(rays); k++) {
            const struct plot_ray *ray = &rays->list[k * rays->count / num_rays_drawn(rays)];
            if (ray->sensor == i) {
                fprintf(map->script, "%.6g %.6g\n%.6g %.6g\n\n", ray->x_m / map->unit_m,
                        ray->y_m / map->unit_m, ray->end_x_m / map->unit_m,
                        ray->end_y_m / map->unit_m);
            }
        }
        fprintf(map->script, "EOD\n");
    }
    put_sensors(map, rays);
    fprintf(map->script,
            "set style textbox opaque fillcolor rgb '#ffffff' noborder margins 0.5,0.3\n");
}

void plot_bearings(struct picture *picture, const struct picture_data *data)
{
    const struct plot_rays *rays = &data->bearings;
    const struct map map = map_start(picture, map_box_of_data(data));
    picture_set_title(picture, "%zu bearings of %zu sensors", rays->count, rays->num_sensors);
    plot_bearings_write_data(&map, rays);
    map_write_sampled_plots(&map, &data->plots, 0);
    map_write_points(&map, "truth", &data->truth);
    put_arrow_at_end_of_each_path(&map, &data->truth);
    fprintf(map.script, "plot NaN notitle");
    plot_bearings_draw_rays(&map, rays);
    map_draw_plots(&map, &data->plots);
    if (data->truth.count) {
        fprintf(map.script, ", \\\n $truth using 1:2 with lines lw 1.5 lc rgb '#000000' title "
                            "'truth'");
    }
    plot_bearings_draw_sensors(&map, rays);
    fprintf(map.script, "\n");
}
