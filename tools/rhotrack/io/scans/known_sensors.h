/* SPDX-License-Identifier: MIT */
/*
 * known_sensors: sensors of bearings in all files, which stand still, and where each was named
 * first.
 */
#ifndef RHOTRACK_TOOL_KNOWN_SENSORS_H
#define RHOTRACK_TOOL_KNOWN_SENSORS_H

#include "io/csv/record.h"

/* A sensor of the files. */
struct frame_sensor {
    int32_t sensor_id;
    float x_m, y_m;
};

struct known_sensor {
    struct frame_sensor sensor;
    const char *path;
    uint32_t line;
};

/* In the order in which they were first named. */
struct known_sensors {
    struct known_sensor list[RHO_MAX_SENSORS];
    size_t count;
    bool is_closed; /* the files were read once: there are no others */
};

/*
 * The row's sensor is where it was before, or a new one at a place of its own, of which there is
 * room for RHO_MAX_SENSORS. Returns false and sets the reason.
 */
bool known_sensors_check_row(const struct known_sensors *sensors, const char *path,
                             const struct record *row, const struct row_check *check);
void known_sensors_add_row(struct known_sensors *known, const char *path, const struct record *row);

#endif
