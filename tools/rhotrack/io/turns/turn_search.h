/* SPDX-License-Identifier: MIT */
/*
 * turn_search: finds how a radar's plots, each with a time of its own, form scans: by
 * azimuths that advance evenly with a rotating antenna, or by bursts of plots with gaps in time
 * between them.
 */
#ifndef RHOTRACK_TOOL_TURN_SEARCH_H
#define RHOTRACK_TOOL_TURN_SEARCH_H

#include <stddef.h>
#include <stdint.h>

/* A plot: its time, and its place relative to the radar. */
struct turn_plot {
    int64_t time_us;
    double x_m, y_m;
};

enum turn_kind {
    TURN_NONE,     /* no turns: rows of equal times form the scans, or each row is one */
    TURN_UNKNOWN,  /* rows of a scan have times of their own, but its limits were not found */
    TURN_AZIMUTHS, /* a scan is one turn of the antenna, found by azimuths */
    TURN_GAPS      /* a scan is the burst of plots between two gaps in time */
};

struct turn_rule {
    enum turn_kind kind;
    double rate_rad_s; /* TURN_AZIMUTHS: rotation rate, positive counter-clockwise */
    double cut_rad;    /* azimuth at which turns end: where the fewest plots are */
    int64_t gap_us;    /* TURN_GAPS: a longer time between plots ends a scan */
    double turn_s;     /* interval of scans; TURN_UNKNOWN: median time between rows */
};

/*
 * Finds the rule of one radar from its first plots, in the order of time. Scan intervals of 0.5 to
 * 50 s are found. Rows that one target of at most v_max_mps can have caused alone give no turns.
 *   num_empty  rows without a measurement beside them: where these are many, each time is a look,
 *              and pauses between looks are no turns
 */
struct turn_rule turn_search_find_rule(const struct turn_plot *plots, size_t count,
                                       size_t num_empty, double v_max_mps);

#endif
