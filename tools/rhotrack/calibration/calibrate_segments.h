/* SPDX-License-Identifier: MIT */
/*
 * calibrate_segments: cuts a radar's tracks into segments, fits a line or a
 * parabola to each, and collects the plots' residuals.
 */
#ifndef RHOTRACK_TOOL_CALIBRATE_SEGMENTS_H
#define RHOTRACK_TOOL_CALIBRATE_SEGMENTS_H

#include "registration/register_data.h"

/*
 * Residual of a plot along one axis of its noise, scaled to the distance from a path fitted without
 * this plot; its variance is that of the plot's noise.
 */
struct residual {
    size_t segment, track;
    int axis; /* axis of the noise; 0: along the line of sight, or x; 1: across it, or y */
    double off_m, range_m;
};

struct calibrate_segment {
    size_t track;
    /* speed in the middle of the segment, and its standard error */
    double speed_mps, speed_sigma_mps;
};

struct calibrate_segments {
    size_t num_segments, segments_room, num_residuals, residuals_room;
    size_t num_unfitted; /* segments that fit neither a line nor a parabola */
    struct calibrate_segment *segments;
    struct residual *residuals;
};

/*
 * Cuts the tracks of the radar into segments, with weights by the plots' sigmas. is_isotropic:
 * residuals are along x and y instead of along and across the line of sight.
 */
struct calibrate_segments calibrate_cut_segments(const struct register_data *data, size_t radar,
                                                 bool is_isotropic);
void calibrate_segments_free(struct calibrate_segments *segments);

/*
 * Sum of the normalised innovations squared, each cut at 4, of the radar's plots against a straight
 * line through the four plots of the track before; *count is their number.
 */
double calibrate_sum_innovations(const struct register_data *data, size_t radar, bool is_isotropic,
                                 size_t *count);

#endif
