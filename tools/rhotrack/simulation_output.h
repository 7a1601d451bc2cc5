/* SPDX-License-Identifier: MIT */
/* simulation_output: a simulation as files: plots, polar plots or bearings, truth, and what a tracker may know. */
#ifndef RHOTRACK_TOOL_SIMULATION_OUTPUT_H
#define RHOTRACK_TOOL_SIMULATION_OUTPUT_H

#include "scenario.h"

/* Makes FOLDER with plots.csv (polar.csv, bearings.csv), truth.csv, scenario.ini. */
void simulation_write(const char *name, const struct simulation *simulation,
                      const struct parameters *parameters, const char *folder);

#endif
