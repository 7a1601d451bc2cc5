/* SPDX-License-Identifier: MIT */
/*
 * clutter_map_file: reads and writes the clutter map as a CSV file, before the first scan
 * and at the end.
 *
 *     sensor_id,x_m,y_m,sigma_range_m,sigma_cross_m,hits,region,unseen,looks,returns
 *     1,20344.6,-7512.2,11.2,24.9,147,,,,
 *     ,,,,,6,12,1,512.6,260.1
 *     # CRC-32 5b2a90e7
 *
 * A row with a sensor is a stationary echo; a row with `looks` has statistics of returns: how
 * often echoes with so many hits, missed `unseen` times in a row, were looked for (looks) and seen
 * again (returns), in a region of the map or, where that is empty, in all regions. A file made by
 * hand needs only sensor_id,x_m,y_m (or lat_deg,lon_deg): hits are then 6, and the sigmas the
 * sensor's, or 30 m where these are not set. A file that was written ends with a line of its
 * checksum, and says so in its head; a file without both is read as it is.
 */
#ifndef RHOTRACK_TOOL_CLUTTER_MAP_FILE_H
#define RHOTRACK_TOOL_CLUTTER_MAP_FILE_H

#include <stdbool.h>
#include <stdint.h>

#include "rhotrack/detail/recurring_clutter_map.h"
#include "settings/parameters.h"

struct clutter_map_file {
    const char *path; /* the caller's text; NULL: no file, and the functions do nothing */
    int64_t saved_us; /* monotonic_clock_us() at the last save */
};

/* An echo in a file. */
struct clutter_echo {
    int32_t sensor_id;
    float x_m, y_m, sigma_range_m, sigma_cross_m;
    uint16_t hits;
};

/*
 * Reads the echoes of a file, in its order, into memory that the caller frees. Errors as `rhotrack:
 * FILE:LINE: what is wrong`, exit 2.
 */
struct clutter_echo *
clutter_map_file_read_echoes(const char *path, const struct parameters *parameters, size_t *count);

/*
 * Loads a file into the map for a program that has to run: a file that is damaged is set aside
 * (state_file.h), and what was read, not found or is wrong is told on standard error. map NULL: a
 * snapshot gave the map, and the file is only checked. Returns false where it is damaged and must
 * not be written over. Exit 2 for a file of plots or tracks, and for what is no regular file.
 */
bool clutter_map_file_restore(const char *path, const struct parameters *parameters,
                              struct rho_clutter_map *map);

/* Writes the map, as state_file_replace: false with errno on failure. */
bool clutter_map_file_write(const char *path, const struct rho_clutter_map *map);

/*
 * Loads a file into the map; a missing file is reported on standard error. Bad files: exit 2. A
 * place that is not writable: exit 1.
 */
struct clutter_map_file clutter_map_file_open(const char *path, const struct parameters *parameters,
                                              struct rho_clutter_map *map);

/*
 * Writes the map. Returns false, with a report on standard error, where it could not be written.
 */
bool clutter_map_file_save(struct clutter_map_file *file, const struct rho_clutter_map *map);

/*
 * Saves the map if a minute has passed since the last save. Returns false where it could not be
 * written.
 */
bool clutter_map_file_save_if_due(struct clutter_map_file *file, const struct rho_clutter_map *map);

#endif
