/* SPDX-License-Identifier: MIT */
/* lab_input: simulated plots and bearings as the library takes them. */
#ifndef RHOTRACK_LAB_INPUT_H
#define RHOTRACK_LAB_INPUT_H

#include "base/random.h"
#include "pipeline/pipeline.h"
#include "scenario.h"

/* A plot with the same noise on all axes. */
struct rho_plot lab_plot(double x_m, double y_m, double sigma_m);

/*
 * Clutter alone, so many plots on average, even over the parameters' area, goes into the chain's
 * plots: how many it is.
 */
size_t lab_fill_clutter(struct pipeline *chain, const struct parameters *parameters, double mean,
                        struct random *random);

/*
 * A simulated look as the library takes it, `most` bearings of it at most; these go into the
 * caller's array.
 */
struct rho_bearing_scan lab_look(const struct scenario_passive *passive,
                                 const struct simulated_look *look, struct rho_bearing *bearings,
                                 size_t most);

#endif
