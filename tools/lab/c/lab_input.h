/* SPDX-License-Identifier: MIT */
/* lab_input: simulated plots and bearings as the library takes them. */
#ifndef RHOTRACK_LAB_INPUT_H
#define RHOTRACK_LAB_INPUT_H

#include "base/random.h"
#include "pipeline/pipeline.h"
#include "scenario.h"

/* A plot with the same noise on all axes. */
struct rho_plot lab_isotropic_plot(double x_m, double y_m, double sigma_m);

/*
 * Draws clutter, uniform over the parameters' area, into the pipeline's plots and returns the
 * number of plots, which is Poisson-distributed with this mean.
 */
size_t lab_draw_clutter_plots(struct pipeline *chain, const struct parameters *parameters,
                              double mean, struct random *random);

/*
 * Converts a simulated look of a passive sensor for the library; at most bearings_max of its
 * bearings go into the caller's array.
 */
struct rho_bearing_scan lab_bearing_scan_of_look(const struct scenario_passive *passive,
                                                 const struct simulated_look *look,
                                                 struct rho_bearing *bearings, size_t bearings_max);

#endif
