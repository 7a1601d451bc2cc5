/* SPDX-License-Identifier: MIT */
/*
 * evaluation_figures: results of an evaluation as lists of named figures, with the names
 * and in the order in which users read them.
 */
#ifndef RHOTRACK_TOOL_EVALUATION_FIGURES_H
#define RHOTRACK_TOOL_EVALUATION_FIGURES_H

#include "evaluation/evaluation.h"

#define EVALUATION_FIGURES_MAX 32

struct evaluation_figures {
    size_t count;
    struct {
        const char *name;
        double value; /* NAN where the figure is not known */
    } list[EVALUATION_FIGURES_MAX];
};

struct evaluation_figures evaluation_figures_overall(const struct evaluation_result *result);
struct evaluation_figures evaluation_figures_target(const struct evaluation_target *target);
struct evaluation_figures evaluation_motion_figures(const struct evaluation_errors *errors);
struct evaluation_figures evaluation_figures_scan(const struct evaluation_scan *scan);

#endif
