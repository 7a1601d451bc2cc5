/* SPDX-License-Identifier: MIT */
/*
 * first_look: what the first rows of a CSV file of plots tell before it is read: a place on the
 * earth, where the local frame may have its origin, and azimuths that run as a compass does.
 */
#ifndef RHOTRACK_TOOL_FIRST_LOOK_H
#define RHOTRACK_TOOL_FIRST_LOOK_H

#include <stdbool.h>

struct first_look {
    bool has_place; /* of the first sensor, else of the first plot */
    double lat_deg, lon_deg, alt_m;
    /* a turning radar's azimuth_rad, 0 .. 2 pi and rising with time: antennas turn clockwise */
    bool runs_clockwise;
};

/* Nothing of what is no plain file, no CSV, or a truth. */
struct first_look first_look_at(const char *path);

#endif
