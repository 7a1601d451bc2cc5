/* SPDX-License-Identifier: MIT */
/*
 * register_segments: segments of targets' paths that several radars saw, and what each says of the
 * biases.
 */
#ifndef RHOTRACK_TOOL_REGISTER_SEGMENTS_H
#define RHOTRACK_TOOL_REGISTER_SEGMENTS_H

#include "registration/register_data.h"

#define SEGMENT_TERMS 3 /* of the parabola, each axis */
#define SEGMENT_COEFFICIENTS (2 * SEGMENT_TERMS)

struct segment_plot {
    size_t radar, plot;
    double t_s;
    double weight; /* 1, less where it is far off */
};

struct segment {
    size_t first, count; /* plots */
    double middle_s;
    bool is_left_out; /* no parabola */
    double chi2;      /* weighted, of the last fit */
    double speed_mps;
    double coefficients
        /* of x, then y, in powers of seconds from the middle over SEGMENT_S / 2 */
        [SEGMENT_COEFFICIENTS];
};

struct segments {
    size_t num_segments, segments_room, num_plots, plots_room;
    struct segment *segments;
    struct segment_plot *plots;
};

struct segments segments_cut_paths(const struct register_data *data);
void segments_free(struct segments *segments);

/* The remaining degrees of freedom of a segment. */
double segment_degrees_of_freedom(const struct segment *segment);

/* Normal equations of all radars' biases: num = NUM_REGISTER_KINDS x radars, the matrix by rows. */
struct normal {
    size_t num;
    double *matrix, *right;
};

/*
 * Fits the segment with the biases as they are and its plots' weights, adds what it says to the
 * normal equations (NULL: adds nothing), and sets the weights anew. False where it cannot be
 * fitted.
 */
bool segment_fit(const struct register_data *data, struct segments *segments,
                 struct segment *segment, struct normal *normal);

#endif
