/* SPDX-License-Identifier: MIT */
#include "io/scans/passive_sensors.h"

#include <math.h>

/* Index of the sensor in the list; count: it is not there. */
static size_t find_sensor(const struct passive_sensors *known, int32_t sensor_id)
{
    size_t i = 0;

    while (i < known->count && known->list[i].sensor.sensor_id != sensor_id) {
        i++;
    }
    return i;
}

bool passive_sensors_check_row(const struct passive_sensors *known,
                               const struct measurement_row *row, const struct row_check *check)
{
    if (find_sensor(known, row->sensor_id) < known->count) {
        return true;
    }
    if (known->is_closed) {
        return row_refuse(check, "sensor %d is new: the file has grown while it was read",
                          (int)row->sensor_id);
    }
    return known->count < RHO_MAX_SENSORS ||
           row_refuse(check, "sensor %d is beyond the limit of %d sensors", (int)row->sensor_id,
                      RHO_MAX_SENSORS);
}

void passive_sensors_add(struct passive_sensors *known, const char *path,
                         const struct measurement_row *row)
{
    const size_t i = find_sensor(known, row->sensor_id);
    struct known_sensor *sensor = &known->list[i];

    if (i == known->count) {
        known->count++;
        *sensor =
            (struct known_sensor){.sensor = {row->sensor_id, row->sensor.x_m, row->sensor.y_m, 0},
                                  .path = path,
                                  .line = row->line};
    }
    sensor->sensor.moves_m =
        fmax(sensor->sensor.moves_m, hypot((double)row->sensor.x_m - (double)sensor->sensor.x_m,
                                           (double)row->sensor.y_m - (double)sensor->sensor.y_m));
}
