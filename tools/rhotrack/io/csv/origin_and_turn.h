/* SPDX-License-Identifier: MIT */
/*
 * origin_and_turn: what the first rows of a CSV file of plots tell before it is read: a place on
 * the earth, where the local frame may have its origin, and azimuths that run as a compass does.
 */
#ifndef RHOTRACK_TOOL_ORIGIN_AND_TURN_H
#define RHOTRACK_TOOL_ORIGIN_AND_TURN_H

#include <stdbool.h>

struct origin_and_turn {
    bool has_place; /* of the first sensor, else of the first plot */
    double lat_deg, lon_deg, alt_m;
    /* a turning radar's azimuth_rad, 0 .. 2 pi and rising with time: antennas turn clockwise */
    bool runs_clockwise;
};

/* Nothing of what is no plain file, no CSV, or a truth. */
struct origin_and_turn origin_and_turn_of(const char *path);

#endif
