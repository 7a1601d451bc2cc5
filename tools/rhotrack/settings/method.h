/* SPDX-License-Identifier: MIT */
/* method: the initiation methods by name, and what is customary with each. */
#ifndef RHOTRACK_TOOL_METHOD_H
#define RHOTRACK_TOOL_METHOD_H

#include <stdbool.h>

#include "rhotrack/hough.h"
#include "rhotrack/passive.h"
#include "rhotrack/passive_paper.h"
#include "settings/parameters.h"

enum method {
    METHOD_KERNEL,
    METHOD_HT,
    METHOD_MHT,
    METHOD_IHT,
    METHOD_NHT,
    METHOD_PASSIVE,
    METHOD_PASSIVE_PAPER,
    NUM_METHODS
};

#define METHOD_PLOT_NAMES "kernel, ht, mht, iht, nht"
#define METHOD_NAMES METHOD_PLOT_NAMES ", passive, passive-paper"

const char *method_name(enum method method);

/* It takes bearings, not plots. */
bool method_takes_bearings(enum method method);

/* The parameters method and bearings_method. */
enum method method_of_plots(const struct parameters *parameters);
enum method method_of_bearings(const struct parameters *parameters);

/* Unknown: exit 2 with the list. */
enum method method_find(const char *name);

/* The method's own customary values (parameters_suggest). */
void method_suggest_parameters(enum method method, struct parameters *parameters);

/*
 * Suggests cells of rho, and epsilon with them, that hold plots so far from the origin, where the
 * customary ones do not.
 */
void method_fit_cells(struct parameters *parameters, double range_m);

/*
 * The config of ht, mht, iht and nht, for plots at most so far from the origin. Exit 2 where that
 * takes more cells of rho than there are.
 */
struct rho_hough_config method_hough_config(enum method method, const struct parameters *parameters,
                                            double range_m);

/*
 * The config of passive, and of passive-paper, with cells of rho that hold range_max_m and the
 * parameters' passive_apart_m where d_rho_m is not set. Exit 2 where cells as set do not hold
 * range_max_m or half a turn, or they take no such scans, range or votes.
 */
struct rho_passive_config method_passive_config(const struct parameters *parameters);
struct rho_passive_paper_config method_passive_paper_config(const struct parameters *parameters);

#endif
