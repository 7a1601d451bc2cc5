/* SPDX-License-Identifier: MIT */
/*
 * full: the node of README.md: any one radar, with all that the embedded profile holds
 * (radar_capacities.h). The settings are the library's own.
 */
#include "radar_capacities.h"
