/* SPDX-License-Identifier: MIT */
/* experiment_alarms_page: the figures of the false-alarms experiment, and their page. */
#ifndef RHOTRACK_TOOL_EXPERIMENT_ALARMS_PAGE_H
#define RHOTRACK_TOOL_EXPERIMENT_ALARMS_PAGE_H

#include "base/grid.h"
#include "experiment_alarms.h"
#include "verdicts.h"

/* Clutter alone, at one density and wanted rate, over all runs. */
struct alarm_summary {
    double per_km2, wanted_per_hour;
    double confirmed, hours, per_hour;
    double low_per_hour, high_per_hour; /* 95 % limits of the rate */
    double started_a_scan, min_scans, confirm_nat, time_us;
};

/* Targets at one density over all runs. */
struct delay_summary {
    double per_km2;
    double targets;
    double third_plot; /* share confirmed on their 3rd plot */
    double in_time;    /* share confirmed at most a scan after the first possible one */
    double confirmed_at, possible_at; /* means, scans, 1 = first */
    double share_at[DELAY_SCANS];     /* confirmed by the scan, as a share of the targets */
};

struct alarm_figures {
    struct alarm_summary alarms[ALARM_LEVELS * ALARM_RATES];
    struct delay_summary delays[DELAY_LEVELS];
};

struct grid alarm_grid(const struct alarm_figures *figures);
struct grid delay_grid(const struct alarm_figures *figures);

/* FOLDER/index.html and its pictures. */
void alarm_page(const struct alarm_figures *figures, const struct verdicts *verdicts,
                size_t num_runs, uint64_t seed, const char *folder);

#endif
