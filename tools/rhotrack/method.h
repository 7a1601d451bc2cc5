/* SPDX-License-Identifier: MIT */
/* method: the initiation methods by name, and what is customary with each. */
#ifndef RHOTRACK_TOOL_METHOD_H
#define RHOTRACK_TOOL_METHOD_H

#include <stdbool.h>

#include "parameters.h"
#include "rhotrack/classic.h"

enum method { METHOD_KERNEL, METHOD_HT, METHOD_MHT, METHOD_IHT, METHOD_NHT, NUM_METHODS };

#define METHOD_NAMES "kernel, ht, mht, iht, nht"

const char *method_name(enum method method);

/* NULL: kernel. Unknown: exit 2 with the list. */
enum method method_find(const char *name);

/* The method's own customary values (parameters_suggest): the paper's speeds, and that plots count, for the paper's. */
void method_suggest(enum method method, struct parameters *parameters);

/* The config of any method but kernel, for plots at most so far from the origin. Exit 2 where that takes more cells of
 * rho than there are. */
struct rho_classic_config method_classic(enum method method, const struct parameters *parameters,
                                         double range_m);

#endif
