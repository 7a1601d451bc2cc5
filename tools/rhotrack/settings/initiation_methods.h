/* SPDX-License-Identifier: MIT */
/*
 * initiation_methods: initiation methods by name, their customary parameter
 * values, and their configurations.
 */
#ifndef RHOTRACK_TOOL_INITIATION_METHODS_H
#define RHOTRACK_TOOL_INITIATION_METHODS_H

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

/* True where the method takes bearings; false where it takes plots. */
bool method_takes_bearings(enum method method);

/* The methods that the parameters method (plots) and bearings_method (bearings) choose. */
enum method track_start_method(const struct parameters *parameters);
enum method method_of_bearings(const struct parameters *parameters);

/* Finds a method by its name; exit 2 with the list of methods for an unknown name. */
enum method method_must_find(const char *name);

/* Suggests the method's customary parameter values (parameters_suggest). */
void method_suggest_parameters(enum method method, struct parameters *parameters);

/*
 * Suggests larger cells of rho, and a larger eps_rho_m with them, where the accumulator would not
 * hold plots within range_m of the origin.
 */
void method_widen_cells_to_range(struct parameters *parameters, double range_m);

/*
 * Configuration of ht, mht, iht or nht for plots within range_m of the origin. Exit 2 where that
 * takes more cells of rho than the accumulator has.
 */
struct rho_hough_config method_hough_config(enum method method, const struct parameters *parameters,
                                            double range_m);

/*
 * Configurations of passive and passive-paper. Where d_rho_m is not set, cells of rho are enlarged
 * to hold range_max_m and passive_apart_m. Exit 2 where cells as set do not hold range_max_m or
 * half a turn, or scans, range_max_m or votes_min are outside the method's limits.
 */
struct rho_passive_config method_passive_config(const struct parameters *parameters);
struct rho_passive_paper_config method_passive_paper_config(const struct parameters *parameters);

#endif
