/* SPDX-License-Identifier: MIT */
/*
 * plot_votes: draws the accumulator of one of the papers' Hough methods for the last scans' plots;
 * of the neutrosophic method also its truth, indeterminacy and falsity, C_T, C_I and C_F.
 */
#ifndef RHOTRACK_TOOL_PLOT_VOTES_H
#define RHOTRACK_TOOL_PLOT_VOTES_H

#include "io/turns/merged_sectors.h"
#include "picture/gnuplot_picture_file.h"
#include "settings/initiation_methods.h"

/* The votes to be drawn, computed before the picture is begun so that errors leave no file. */
struct plot_votes;

/*
 * Computes the votes. Exits with 2 where the method has no accumulator of plots, or its cells
 * cannot hold the plots.
 */
struct plot_votes *plot_votes_compute_pictures(enum method method,
                                               const struct revolutions *revolutions,
                                               const struct parameters *parameters);
void plot_votes(struct picture *picture, const struct plot_votes *votes);
void plot_votes_free(struct plot_votes *votes);

#endif
