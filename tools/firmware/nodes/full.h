/* SPDX-License-Identifier: MIT */
/*
 * full: node configuration for any one radar, with all capacities of radar_capacities.h and the
 * library's default settings; the node that README.md describes.
 */
#include "radar_capacities.h"
