/* SPDX-License-Identifier: MIT */
/* record_scans: what turning radars saw, as the library takes it. */
#ifndef RHOTRACK_TOOL_RECORD_SCANS_H
#define RHOTRACK_TOOL_RECORD_SCANS_H

#include "rhotrack/types.h"
#include "scenario_record.h"

/* A radar as it is known: place, P_D and range limits, no biases. */
struct rho_sensor record_sensor(const struct scenario_antenna *antenna);

/* One scan. The biases that the sensor is said to have are taken off. plots: RHO_MAX_PLOTS of the caller. */
struct rho_scan record_scan(const struct scenario_record *record,
                            const struct record_arrival *arrival, const struct rho_sensor *sensor,
                            struct rho_plot *plots);

#endif
