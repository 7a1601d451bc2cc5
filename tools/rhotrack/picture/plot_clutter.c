/* SPDX-License-Identifier: MIT */
#include "picture/plot_clutter.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "picture/map.h"

#define MARGIN 0.05      /* of the larger side, around all that is drawn */
#define SENSORS_RINGED 3 /* rings of more would hide the echoes */
#define RINGS 4          /* or somewhat more, to the farthest echo */
#define RING_POINTS 144
#define MARGIN_MIN_M 10.0 /* of a single echo */

struct place {
    int32_t sensor_id;
    double x_m, y_m;
    double farthest_m; /* of its echoes */
};

/* ---- sensors ---- */

static struct place *find_sensor(struct place *sensors, size_t count, int32_t sensor_id)
{
    for (size_t i = 0; i < count; i++) {
        if (sensors[i].sensor_id == sensor_id) {
            return &sensors[i];
        }
    }
    return NULL;
}

/* Sensors that have echoes. */
static struct place *find_sensors(const struct clutter_echo *echoes, size_t count,
                                  const struct parameters *parameters, size_t *num_sensors)
{
    struct place *sensors = NULL;
    size_t capacity = 0;

    *num_sensors = 0;
    for (size_t i = 0; i < count; i++) {
        struct place *sensor = find_sensor(sensors, *num_sensors, echoes[i].sensor_id);

        if (!sensor) {
            struct rho_sensor described;

            parameters_to_any_sensor(parameters, echoes[i].sensor_id, &described);
            sensors = must_grow(sensors, *num_sensors, &capacity, sizeof *sensors);
            sensor = &sensors[(*num_sensors)++];
            *sensor = (struct place){.sensor_id = echoes[i].sensor_id,
                                     .x_m = (double)described.x_m,
                                     .y_m = (double)described.y_m};
        }
        sensor->farthest_m = fmax(sensor->farthest_m, hypot((double)echoes[i].x_m - sensor->x_m,
                                                            (double)echoes[i].y_m - sensor->y_m));
    }
    return sensors;
}

/* ---- what is seen ---- */

static struct map_box box_of(const struct clutter_echo *echoes, size_t count,
                             const struct place *sensors, size_t num_sensors,
                             const struct plot_points *plots)
{
    struct map_box box = map_box_empty();
    double margin_m;

    for (size_t i = 0; i < count; i++) {
        map_box_include(&box, (double)echoes[i].x_m, (double)echoes[i].y_m);
    }
    for (size_t i = 0; i < num_sensors; i++) {
        map_box_include(&box, sensors[i].x_m, sensors[i].y_m);
    }
    for (size_t i = 0; i < plots->count; i++) {
        map_box_include(&box, plots->list[i].x_m, plots->list[i].y_m);
    }
    if (!(box.x_min_m <= box.x_max_m)) {
        map_box_include(&box, 0.0, 0.0);
    }
    margin_m =
        fmax(MARGIN_MIN_M, MARGIN * fmax(box.x_max_m - box.x_min_m, box.y_max_m - box.y_min_m));
    map_box_widen(&box, margin_m);
    return box;
}

/* ---- drawing ---- */

/* 1, 2 or 5 times a power of ten, so that some RINGS reach so far. */
static double ring_step_m(double farthest_m)
{
    const double least_m = fmax(farthest_m, 1.0) / (RINGS + 1);
    const double decade_m = pow(10.0, floor(log10(least_m)));

    return least_m <= decade_m         ? decade_m
           : least_m <= 2.0 * decade_m ? 2.0 * decade_m
           : least_m <= 5.0 * decade_m ? 5.0 * decade_m
                                       : 10.0 * decade_m;
}

/* The last one is behind the farthest echo. */
static int num_rings(const struct place *sensor, double step_m)
{
    return (int)fmax(1.0, ceil(sensor->farthest_m / step_m));
}

static void put_ring(const struct map *map, const struct place *sensor, double radius_m)
{
    for (int i = 0; i <= RING_POINTS; i++) {
        const double angle_rad = 2.0 * M_PI * i / RING_POINTS;

        fprintf(map->script, "%.9g %.9g\n", (sensor->x_m + radius_m * cos(angle_rad)) / map->unit_m,
                (sensor->y_m + radius_m * sin(angle_rad)) / map->unit_m);
    }
    fputc('\n', map->script);
}

/* $rings, and what they are. */
static void put_rings(const struct map *map, const struct place *sensors, size_t count)
{
    fprintf(map->script, "$rings << EOD\n");
    for (size_t i = 0; i < count; i++) {
        const double step_m = ring_step_m(sensors[i].farthest_m);

        for (int ring = 1; ring <= num_rings(&sensors[i], step_m); ring++) {
            put_ring(map, &sensors[i], ring * step_m);
        }
    }
    fprintf(map->script, "EOD\n");
    for (size_t i = 0; i < count; i++) {
        const double step_m = ring_step_m(sensors[i].farthest_m);
        const double x = sensors[i].x_m / map->unit_m, y = sensors[i].y_m / map->unit_m;

        for (int ring = 1; ring <= num_rings(&sensors[i], step_m); ring++) {
            const double radius = ring * step_m / map->unit_m;

            fprintf(map->script,
                    "set label '%.9g' at %.9g,%.9g left front font ',11' tc rgb '#777777' offset "
                    "0.2,0.4\n",
                    radius, x, y + radius);
        }
        fprintf(map->script,
                "set label 'S%" PRId32 "' at %.9g,%.9g point pt 9 ps 1.2 lc rgb '#000000' offset "
                "0.8,-0.6 front\n",
                sensors[i].sensor_id, x, y);
    }
}

static double size_of(double hits)
{
    return 0.3 + 0.35 * log10(fmax(hits, 1.0));
}

static void put_echoes(const struct map *map, const struct clutter_echo *echoes, size_t count,
                       int32_t sensor_id, size_t index)
{
    fprintf(map->script, "$echoes%zu << EOD\n", index);
    for (size_t i = 0; i < count; i++) {
        if (echoes[i].sensor_id == sensor_id) {
            fprintf(map->script, "%.9g %.9g %.3f\n", (double)echoes[i].x_m / map->unit_m,
                    (double)echoes[i].y_m / map->unit_m, size_of(echoes[i].hits));
        }
    }
    fprintf(map->script, "EOD\n");
}

/* The legend of sizes: 10, 100, ... up to the largest number of hits. */
static void put_legend(const struct map *map, const struct clutter_echo *echoes, size_t count)
{
    unsigned most = 0, hits = 10;

    for (size_t i = 0; i < count; i++) {
        most = echoes[i].hits > most ? echoes[i].hits : most;
    }
    do {
        fprintf(map->script, ", \\\n NaN with points pt 7 ps %.3f lc rgb '#555555' title '%u hits'",
                size_of(hits), hits);
        hits *= 10;
    } while (hits <= most);
}

void plot_clutter(struct picture *picture, const struct clutter_echo *echoes, size_t count,
                  const struct plot_data *data, const struct parameters *parameters)
{
    size_t num_sensors;
    struct place *sensors = find_sensors(echoes, count, parameters, &num_sensors);
    const struct map_box box = box_of(echoes, count, sensors, num_sensors, &data->plots);
    struct map map = map_start(picture->script, data);

    map_set_extent(&map, fmax(box.x_max_m - box.x_min_m, box.y_max_m - box.y_min_m));
    fprintf(map.script, "set xrange [%.9g:%.9g]\nset yrange [%.9g:%.9g]\n",
            box.x_min_m / map.unit_m, box.x_max_m / map.unit_m, box.y_min_m / map.unit_m,
            box.y_max_m / map.unit_m);
    for (size_t i = 0; i < num_sensors; i++) {
        put_echoes(&map, echoes, count, sensors[i].sensor_id, i);
    }
    put_rings(&map, sensors, num_sensors <= SENSORS_RINGED ? num_sensors : 0);
    map_put_points(&map, "plots", &data->plots);
    fprintf(map.script, "unset grid\nplot NaN notitle");
    if (num_sensors > 0 && num_sensors <= SENSORS_RINGED) {
        fprintf(map.script, ", \\\n $rings using 1:2 with lines lw 0.8 lc rgb '#c0c0c0' notitle");
    }
    if (data->plots.count) {
        fprintf(map.script,
                ", \\\n $plots using 1:2 with points pt 7 ps 0.2 lc rgb '#b0b0b0' title 'plots'");
    }
    for (size_t i = 0; i < num_sensors; i++) {
        fprintf(map.script,
                ", \\\n $echoes%zu using 1:2:3 with points pt 7 ps variable lc rgb '#60%s' title "
                "'echoes of sensor %" PRId32 "'",
                i, picture_colour(i + 1) + 1, sensors[i].sensor_id);
    }
    put_legend(&map, echoes, count);
    fprintf(map.script, "\n");
    free(sensors);
}
