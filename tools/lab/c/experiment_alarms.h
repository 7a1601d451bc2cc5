/* SPDX-License-Identifier: MIT */
/*
 * experiment_alarms: does the tracker keep the rate of false tracks that it was asked for, and how
 * soon does it believe in a target? Clutter alone over thousands of scans, and the targets of the
 * paper's Table 1 in clutter.
 */
#ifndef RHOTRACK_TOOL_EXPERIMENT_ALARMS_H
#define RHOTRACK_TOOL_EXPERIMENT_ALARMS_H

#include <stddef.h>

#include "pipeline/pipeline.h"
#include "scenario.h"

#define ALARM_LEVELS 3
#define ALARM_RATES 3
#define ALARM_SCANS 10000 /* of clutter alone, a run */
#define DELAY_LEVELS 6
#define DELAY_SCANS                                                                                \
    12 /* with targets; a target that is not confirmed by then counts as one scan more */
#define DELAY_TARGETS 3

extern const double alarm_per_km2[ALARM_LEVELS], alarm_wanted_per_hour[ALARM_RATES];
extern const double delay_per_km2[DELAY_LEVELS];

/* Clutter alone. */
struct alarm_result {
    double scans, hours;
    double started, confirmed;     /* tracks */
    double min_scans, confirm_nat; /* sums over the scans */
    double time_us;
};
struct alarm_result alarm_run(double per_km2, double wanted_per_hour, uint64_t seed, uint64_t run,
                              struct pipeline *chain);

/* Targets in clutter, one false track an hour wanted. */
struct delay_result {
    /*
     * by target: scan of confirmation, 1 = first, DELAY_SCANS + 1: never; the plots that the target
     * had until then
     */
    int confirmed_at[DELAY_TARGETS], plots[DELAY_TARGETS];
    /* the first scan at which a fit through the target's own plots reaches the threshold in use */
    int possible_at[DELAY_TARGETS];
};
struct delay_result delay_run(double per_km2, uint64_t seed, uint64_t run, struct pipeline *chain);

#endif
