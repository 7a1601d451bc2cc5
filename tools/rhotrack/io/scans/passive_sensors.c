/* SPDX-License-Identifier: MIT */
#include "io/scans/passive_sensors.h"

#include <math.h>
#include <stdio.h>

#define SAME_PLACE_M 1.0

static const struct known_sensor *find_sensor(const struct passive_sensors *known,
                                              int32_t sensor_id)
{
    for (size_t i = 0; i < known->count; i++) {
        if (known->list[i].sensor.sensor_id == sensor_id) {
            return &known->list[i];
        }
    }
    return NULL;
}

/*
 * Writes a sensor's position and the line that named it first, with the file where it is not
 * `path`.
 */
#define WHERE_BYTES 120
static const char *format_first_naming(const struct known_sensor *known, const char *path,
                                       char text[WHERE_BYTES])
{
    int length = snprintf(text, WHERE_BYTES, "%.9g, %.9g, line %u", (double)known->sensor.x_m,
                          (double)known->sensor.y_m, (unsigned)known->line);

    if (known->path != path) {
        snprintf(text + length, WHERE_BYTES - (size_t)length, " of %.60s", known->path);
    }
    return text;
}

/* Checks that there is room for another sensor, and that no other stands at its place. */
static bool check_new_sensor(const struct passive_sensors *known, const char *path,
                             const struct measurement_row *row, const struct row_check *check)
{
    char text[WHERE_BYTES];

    for (size_t i = 0; i < known->count; i++) {
        const struct frame_sensor *other = &known->list[i].sensor;

        if (hypot((double)row->sensor.x_m - (double)other->x_m,
                  (double)row->sensor.y_m - (double)other->y_m) < SAME_PLACE_M) {
            return row_refuse(check, "sensor %d has the same place as sensor %d: %s",
                              (int)row->sensor_id, (int)other->sensor_id,
                              format_first_naming(&known->list[i], path, text));
        }
    }
    if (known->is_closed) {
        return row_refuse(check, "sensor %d is new: the file has grown while it was read",
                          (int)row->sensor_id);
    }
    return known->count < RHO_MAX_SENSORS ||
           row_refuse(check, "sensor %d is beyond the limit of %d sensors", (int)row->sensor_id,
                      RHO_MAX_SENSORS);
}

bool passive_sensors_check_row(const struct passive_sensors *sensors, const char *path,
                               const struct measurement_row *row, const struct row_check *check)
{
    const struct known_sensor *known = find_sensor(sensors, row->sensor_id);
    char text[WHERE_BYTES];

    if (!known) {
        return check_new_sensor(sensors, path, row, check);
    }
    if (row->sensor.x_m < known->sensor.x_m || row->sensor.x_m > known->sensor.x_m ||
        row->sensor.y_m < known->sensor.y_m || row->sensor.y_m > known->sensor.y_m) {
        return row_refuse(check, "sensor %d has moved: it was at %s", (int)row->sensor_id,
                          format_first_naming(known, path, text));
    }
    return true;
}

void passive_sensors_add(struct passive_sensors *known, const char *path,
                         const struct measurement_row *row)
{
    if (!find_sensor(known, row->sensor_id)) {
        known->list[known->count++] =
            (struct known_sensor){.sensor = {row->sensor_id, row->sensor.x_m, row->sensor.y_m},
                                  .path = path,
                                  .line = row->line};
    }
}
