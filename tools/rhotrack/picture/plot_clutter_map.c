/* SPDX-License-Identifier: MIT */
#include "picture/plot_clutter_map.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "picture/plan_view_map.h"

static struct plot_radar *find_sensor_by_id(struct plot_radar *sensors, size_t count,
                                            int32_t sensor_id)
{
    for (size_t i = 0; i < count; i++) {
        if (sensors[i].sensor_id == sensor_id) {
            return &sensors[i];
        }
    }
    return NULL;
}

/*
 * Lists the sensors that have echoes, at the places that the parameters give, without a maximum
 * range.
 */
static struct plot_radar *list_echo_sensors(const struct clutter_echo *echoes, size_t count,
                                            const struct parameters *parameters,
                                            size_t *num_sensors)
{
    struct plot_radar *sensors = NULL;
    size_t capacity = 0;

    *num_sensors = 0;
    for (size_t i = 0; i < count; i++) {
        if (!find_sensor_by_id(sensors, *num_sensors, echoes[i].sensor_id)) {
            struct rho_sensor described;

            parameters_sensor_or_default(parameters, echoes[i].sensor_id, &described);
            sensors = must_make_room_for_one(sensors, *num_sensors, &capacity, sizeof *sensors);
            sensors[(*num_sensors)++] = (struct plot_radar){.sensor_id = echoes[i].sensor_id,
                                                            .x_m = (double)described.x_m,
                                                            .y_m = (double)described.y_m,
                                                            .range_max_m = INFINITY};
        }
    }
    return sensors;
}

static struct map_box map_box_of_echoes(const struct clutter_echo *echoes, size_t count,
                                        const struct plot_radar *sensors, size_t num_sensors,
                                        const struct plot_points *plots)
{
    struct map_box box = map_box_empty();

    for (size_t i = 0; i < count; i++) {
        map_box_include(&box, (double)echoes[i].x_m, (double)echoes[i].y_m);
    }
    for (size_t i = 0; i < num_sensors; i++) {
        map_box_include(&box, sensors[i].x_m, sensors[i].y_m);
    }
    map_box_include_points(&box, plots);
    return box;
}

static double echo_point_size(double hits)
{
    return 0.3 + 0.35 * log10(fmax(hits, 1.0));
}

static void put_echoes_of_sensor(const struct map *map, const struct clutter_echo *echoes,
                                 size_t count, int32_t sensor_id, size_t index)
{
    fprintf(map->script, "$echoes%zu << EOD\n", index);
    for (size_t i = 0; i < count; i++) {
        if (echoes[i].sensor_id == sensor_id) {
            fprintf(map->script, "%.9g %.9g %.3f\n", (double)echoes[i].x_m / map->unit_m,
                    (double)echoes[i].y_m / map->unit_m, echo_point_size(echoes[i].hits));
        }
    }
    fprintf(map->script, "EOD\n");
}

/* Writes legend entries for the sizes of 10, 100, ... hits up to the largest number of hits. */
static void draw_size_legend(const struct map *map, const struct clutter_echo *echoes, size_t count)
{
    unsigned most = 0, hits = 10;

    for (size_t i = 0; i < count; i++) {
        most = echoes[i].hits > most ? echoes[i].hits : most;
    }
    do {
        fprintf(map->script, ", \\\n NaN with points pt 7 ps %.3f lc rgb '#555555' title '%u hits'",
                echo_point_size(hits), hits);
        hits *= 10;
    } while (hits <= most);
}

void plot_clutter(struct picture *picture, const struct clutter_echo *echoes, size_t count,
                  const struct picture_data *data, const struct parameters *parameters)
{
    size_t num_sensors;
    struct plot_radar *sensors = list_echo_sensors(echoes, count, parameters, &num_sensors);
    const struct map map =
        map_start(picture, map_box_of_echoes(echoes, count, sensors, num_sensors, &data->plots));

    picture_set_title(picture, "Clutter map: %zu fixed echoes of %zu sensors", count, num_sensors);
    for (size_t i = 0; i < num_sensors; i++) {
        put_echoes_of_sensor(&map, echoes, count, sensors[i].sensor_id, i);
    }
    map_write_range_rings(&map, sensors, num_sensors);
    map_write_sampled_plots(&map, &data->plots, 0);
    fprintf(map.script, "unset grid\nplot NaN notitle");
    map_draw_range_rings(&map, sensors, num_sensors);
    map_draw_plots(&map, &data->plots);
    for (size_t i = 0; i < num_sensors; i++) {
        fprintf(map.script,
                ", \\\n $echoes%zu using 1:2:3 with points pt 7 ps variable lc rgb '#60%s' title "
                "'echoes of sensor %" PRId32 "'",
                i, picture_colour(i + 1) + 1, sensors[i].sensor_id);
    }
    draw_size_legend(&map, echoes, count);
    fprintf(map.script, "\n");
    free(sensors);
}
