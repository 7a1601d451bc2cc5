/* SPDX-License-Identifier: MIT */
/*
 * passive_sensors: the passive sensors of all input files, with the file and line that named each
 * first.
 */
#ifndef RHOTRACK_TOOL_PASSIVE_SENSORS_H
#define RHOTRACK_TOOL_PASSIVE_SENSORS_H

#include "io/csv/measurement_row.h"

/* A passive sensor, its first place, and how far from there it is seen. */
struct frame_sensor {
    int32_t sensor_id;
    float x_m, y_m;
    double moves_m;
};

struct known_sensor {
    struct frame_sensor sensor;
    const char *path;
    uint32_t line;
};

/* All sensors so far, in the order in which they were named first. */
struct passive_sensors {
    struct known_sensor list[RHO_MAX_SENSORS];
    size_t count;
    bool is_closed; /* all files were read once: a further sensor is an error */
};

/* Checks that there is room for a row's sensor. Returns false and sets the reason otherwise. */
bool passive_sensors_check_row(const struct passive_sensors *sensors,
                               const struct measurement_row *row, const struct row_check *check);
void passive_sensors_add(struct passive_sensors *known, const char *path,
                         const struct measurement_row *row);

#endif
