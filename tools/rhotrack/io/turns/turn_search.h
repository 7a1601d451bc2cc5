/* SPDX-License-Identifier: MIT */
/*
 * turn_search: how a radar's plots, each with a time of its own, belong together. An antenna that
 * turns sees them at azimuths that go round evenly; plots of other looks come in bursts with gaps
 * between them.
 */
#ifndef RHOTRACK_TOOL_TURN_SEARCH_H
#define RHOTRACK_TOOL_TURN_SEARCH_H

#include <stddef.h>
#include <stdint.h>

/* A plot, its place as seen from the radar. */
struct turn_plot {
    int64_t time_us;
    double x_m, y_m;
};

enum turn_kind {
    TURN_NONE,     /* rows of equal times are the scans, or each row is */
    TURN_UNKNOWN,  /* rows of one look have times of their own, and it is not known which */
    TURN_AZIMUTHS, /* a turn of the antenna */
    TURN_GAPS      /* what comes between two gaps */
};

struct turn_rule {
    enum turn_kind kind;
    double rate_rad_s; /* TURN_AZIMUTHS: counter-clockwise is positive */
    double cut_rad;    /* a turn ends at this azimuth, where the fewest plots are */
    int64_t gap_us;    /* TURN_GAPS: a longer one ends a look */
    double turn_s;     /* from one to the next; TURN_UNKNOWN: from row to row */
};

/*
 * The rule of one radar's first plots, in the order of time. Looks of 0.5 to 50 s are found.
 * Rows that one target of v_max_mps may have made alone are no turns.
 */
struct turn_rule turn_search_find_rule(const struct turn_plot *plots, size_t count,
                                       double v_max_mps);

#endif
