/* SPDX-License-Identifier: MIT */
/*
 * clutter_file: the clutter map as a CSV file, read before the first scan, written at the end.
 *
 *     sensor_id,x_m,y_m,sigma_range_m,sigma_cross_m,hits,region,unseen,looks,returns
 *     1,20344.6,-7512.2,11.2,24.9,147,,,,
 *     ,,,,,6,12,1,512.6,260.1
 *
 * A row with a sensor is an echo that stands; one with `looks` is a part of what was learned: how
 * often echoes with so many hits, missed `unseen` times, were looked for and seen again, in a
 * region of the map or, where that is empty, in all of them. By hand sensor_id,x_m,y_m (or
 * lat_deg,lon_deg) will do: hits are 6 then, and the sigmas the sensor's, or 30 m where these are
 * not set.
 */
#ifndef RHOTRACK_TOOL_CLUTTER_FILE_H
#define RHOTRACK_TOOL_CLUTTER_FILE_H

#include <stdbool.h>
#include <stdint.h>

#include "rhotrack/detail/clutter_map.h"
#include "settings/parameters.h"

struct clutter_file {
    const char *path; /* the caller's; NULL: none, and nothing is done below */
    int64_t saved_us; /* clock_us */
};

/* An echo of a file. */
struct clutter_echo {
    int32_t sensor_id;
    float x_m, y_m, sigma_range_m, sigma_cross_m;
    uint16_t hits;
};

/*
 * The echoes of a file, in its order; errors as `rhotrack: FILE:LINE: what is wrong`, exit 2. To be
 * freed.
 */
struct clutter_echo *clutter_file_read_echoes(const char *path, const struct parameters *parameters,
                                              size_t *count);

/*
 * Exit 2 where the map would be written over another file, which is an "input", say. NULL: there is
 * none.
 */
void clutter_file_refuse_same_file(const char *path, const char *other, const char *what);

/*
 * Teaches the map what is in the file; where there is none yet that is said on standard error. Bad
 * files, and what is none: exit 2. A place where nothing can be written: exit 1. map  NULL: a
 * snapshot had it, and the file is only written
 */
struct clutter_file clutter_file_open(const char *path, const struct parameters *parameters,
                                      struct rho_clutter_map *map);

/* Writes what is known beside, then renamed. False: it could not be written, which is said. */
bool clutter_file_save(struct clutter_file *file, const struct rho_clutter_map *map);

/* It is a minute since it was saved. */
bool clutter_file_is_due(const struct clutter_file *file);

/* Saves it where it is due. */
bool clutter_file_save_if_due(struct clutter_file *file, const struct rho_clutter_map *map);

/* Copies the known echoes of a map into an empty one, as a file would. */
void clutter_file_copy_echoes(struct rho_clutter_map *to, const struct rho_clutter_map *from);

#endif
