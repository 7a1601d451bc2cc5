/* SPDX-License-Identifier: MIT */
/*
 * last_bearings: searches the last bearing frames of files as one batch, by either
 * method for bearings.
 */
#ifndef RHOTRACK_TOOL_LAST_BEARINGS_H
#define RHOTRACK_TOOL_LAST_BEARINGS_H

#include "commands.h"
#include "io/scans/bearing_reader.h"
#include "rhotrack/detail/recent_bearing_frames.h"

/* A method's initiator for bearings, initialised, and the calls to feed and search it. */
struct bearings_search {
    void *object;
    const struct rho_batch *batch; /* the batch inside the initiator */
    enum rho_status (*push)(void *object, const struct rho_frame *frame, uint8_t *fates);
    enum rho_status (*search)(void *object);
};

struct last_bearings {
    /* num_lost: bearings that exceeded a capacity of the library */
    uint64_t frames, bearings, num_lost;
    int64_t first_us, time_us; /* times of the first and the last frame */
    int64_t wall_us;
};

/*
 * Opens files of bearings, and sets passive_apart_m of the parameters from their sensors. Exit 2
 * for fewer than two sensors and for bad input.
 */
struct bearing_reader *last_bearings_open(const struct command_line *line,
                                          struct parameters *parameters);

/*
 * Pushes the last frames, searches them, and closes the reader. Exit 2 for too many sensors, or
 * sensors too far apart for the batch's cells.
 */
struct last_bearings last_bearings_search_and_close(const struct bearings_search *search,
                                                    struct bearing_reader *reader,
                                                    const struct parameters *parameters);

/* Largest distance between two of the sensors, m. */
double bearing_sensors_max_distance_m(const struct frame_sensor *sensors, size_t count);

/* Exit 2 where the sensors are too many, or too far apart for the batch's cells. */
void bearing_sensors_check(const struct frame_sensor *sensors, size_t count,
                           const struct rho_batch *batch, const struct parameters *parameters);

#endif
