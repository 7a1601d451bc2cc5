/* SPDX-License-Identifier: MIT */
/* calibrate_segments: segments of a radar's tracks, each a parabola, and how far plots lie beside
 * them. */
#ifndef RHOTRACK_TOOL_CALIBRATE_SEGMENTS_H
#define RHOTRACK_TOOL_CALIBRATE_SEGMENTS_H

#include "registration/register_data.h"

/*
 * The distance along an axis of a plot from its segment's path, fitted without that plot; its
 * variance is that of the noise there.
 */
struct residual {
    size_t segment, track;
    int axis; /* 0: along the line of sight, 1: across */
    double off_m, range_m;
};

struct calibrate_segment {
    size_t track;
    double speed_mps, speed_sigma_mps; /* in its middle */
};

struct calibrate_segments {
    size_t num_segments, segments_room, num_residuals, residuals_room;
    size_t num_left_out; /* no parabolas */
    struct calibrate_segment *segments;
    struct residual *residuals;
};

/* Of the radar's tracks, weighed by the sigmas of its plots. Round: axes are x and y. */
struct calibrate_segments calibrate_cut_segments(const struct register_data *data, size_t radar,
                                                 bool is_round);
void calibrate_segments_free(struct calibrate_segments *segments);

/* Squares of the next plots of tracks beside where the last ones lead on a straight line, over
 * what is expected of them by the plots' sigmas; cut at 4. Returns their sum. */
double calibrate_sum_innovations(const struct register_data *data, size_t radar, bool is_round,
                                 size_t *count);

#endif
