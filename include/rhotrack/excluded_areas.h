/* SPDX-License-Identifier: MIT */
/*
 * excluded_areas: places in which a person wants no tracks to start: a wind farm, a junction, a
 * harbour basin.
 *
 * Stack: 100 bytes at most.
 */
#ifndef RHOTRACK_EXCLUDED_AREAS_H
#define RHOTRACK_EXCLUDED_AREAS_H

#include "rhotrack/config.h"
#include "rhotrack/tracker.h"
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Excludes an area, sides included: from the next step on its plots start no tracks. Tracks still
 * take them. A plot there that no track claims is GHOST (enum rho_fate), and counted in
 * plots_excluded; bearings are not touched.
 *   area  copied; min below max
 * Errors: NULL, STATE (not initialised), CAPACITY (RHO_MAX_EXCLUDED_AREAS are there), VALUE (a side
 * that is no coordinate, or turned round). Constant cost; a step's grows by plots times areas.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_exclude_area(struct rho_tracker *tracker,
                                                        const struct rho_extent *area);

/*
 * Takes back the excluded areas that hold a place. Errors: NULL, STATE (not initialised), VALUE
 * (none does). Cost: areas.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_include_place(struct rho_tracker *tracker, float x_m,
                                                         float y_m);

#ifdef __cplusplus
}
#endif

#endif
