/* SPDX-License-Identifier: MIT */
/*
 * guess_origin: previews the first rows of a CSV file of plots, before it is
 * read: for a place on the earth that can be the local frame's origin, and for azimuths that
 * increase clockwise as on a compass.
 */
#ifndef RHOTRACK_TOOL_GUESS_ORIGIN_H
#define RHOTRACK_TOOL_GUESS_ORIGIN_H

#include <stdbool.h>

struct origin_and_azimuth_sense {
    bool has_place; /* place of the first sensor, else of the first plot */
    double lat_deg, lon_deg, alt_m;
    /* azimuth_rad is 0 .. 2 pi and mostly rises with time, as clockwise azimuths of antennas do */
    bool has_compass_azimuths;
};

/* Previews a file. No place and no sense for a file that is not plain, not CSV, or a truth. */
struct origin_and_azimuth_sense guess_origin_from_rows(const char *path);

#endif
