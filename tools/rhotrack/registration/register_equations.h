/* SPDX-License-Identifier: MIT */
/*
 * register_equations: cuts targets' paths into segments that several radars saw,
 * and adds the equations of each segment to the least squares for the biases.
 */
#ifndef RHOTRACK_TOOL_REGISTER_EQUATIONS_H
#define RHOTRACK_TOOL_REGISTER_EQUATIONS_H

#include "registration/register_data.h"

#define SEGMENT_TERMS 3 /* coefficients of the parabola of each axis */
#define SEGMENT_COEFFICIENTS (2 * SEGMENT_TERMS)

struct segment_plot {
    size_t radar, plot;
    double t_s;
    double weight; /* Huber weight: 1, less for outliers */
};

struct segment {
    size_t first, count; /* index of the segment's first plot, and number of its plots */
    double middle_s;
    bool is_left_out; /* the plots do not fit a parabola */
    double chi2;      /* weighted chi-square of the last fit */
    double speed_mps;
    /* parabolas of x, then of y, in powers of the seconds from the middle over SEGMENT_S / 2 */
    double coefficients[SEGMENT_COEFFICIENTS];
};

struct segments {
    size_t num_segments, segments_room, num_plots, plots_room;
    struct segment *segments;
    struct segment_plot *plots;
};

struct segments segments_cut_paths(const struct register_data *data);
void segments_free(struct segments *segments);

/* Degrees of freedom of a segment's chi-square: measurements minus coefficients. */
double segment_degrees_of_freedom(const struct segment *segment);

/* Normal equations of all radars' biases: num = NUM_REGISTER_KINDS x radars, the matrix by rows. */
struct normal_equations {
    size_t num;
    double *matrix, *right;
};

/*
 * Fits the segment's parabola with the present biases and weights, adds the segment to the normal
 * equations (unless NULL), and updates the plots' weights. False where it cannot be fitted.
 */
bool segment_fit_and_add_equations(const struct register_data *data, struct segments *segments,
                                   struct segment *segment, struct normal_equations *normal);

#endif
