/* SPDX-License-Identifier: MIT */
/*
 * last_bearings: the last frames of a file of bearings, searched as one batch by any method that
 * takes them.
 */
#ifndef RHOTRACK_TOOL_LAST_BEARINGS_H
#define RHOTRACK_TOOL_LAST_BEARINGS_H

#include "commands.h"
#include "io/scans/bearing_frame_reader.h"
#include "rhotrack/detail/batch.h"

/* An initiator, ready for a first frame. */
struct bearings_search {
    void *object;
    const struct rho_batch *batch; /* its own */
    enum rho_status (*push)(void *object, const struct rho_frame *frame, uint8_t *fates);
    enum rho_status (*search)(void *object);
};

struct last_bearings {
    uint64_t frames, bearings, num_lost; /* lost: the library had no room for them */
    int64_t time_us;                     /* of the last frame */
    int64_t wall_us;
};

/*
 * Opens the files; the parameters then know how far their sensors are apart. Fewer than two
 * sensors, and bad input: exit 2.
 */
struct bearing_frame_reader *last_bearings_open(const struct command_line *line,
                                                struct parameters *parameters);

/*
 * Searches, and closes the reader. Sensors that are too many, or too far apart for the cells:
 * exit 2.
 */
struct last_bearings last_bearings_search(const struct bearings_search *search,
                                          struct bearing_frame_reader *reader,
                                          const struct parameters *parameters);

/* The distance of the farthest two. */
double bearing_sensors_apart_m(const struct frame_sensor *sensors, size_t count);

/* Exit 2 where the sensors are too many, or too far apart for the batch's cells. */
void bearing_sensors_check(const struct frame_sensor *sensors, size_t count,
                           const struct rho_batch *batch, const struct parameters *parameters);

#endif
