/* SPDX-License-Identifier: MIT */
/*
 * size_tracker: the minimal use of the library in firmware: converts polar plots and
 * steps scans. `make budget` links it to measure its size; it is never run.
 */
#include "rhotrack/initiator.h"
#include "rhotrack/tracker.h"

static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_report report;
static struct rho_plot plots[RHO_MAX_PLOTS];
static struct rho_polar_plot polar;

int main(void)
{
    struct rho_tracker_config maintain;
    struct rho_initiator_config start;
    struct rho_initiator *starts = RHO_SEARCHES ? &initiator : NULL;
    struct rho_scan scan = {.num_plots = RHO_MAX_PLOTS, .plots = plots};
    rho_tracker_config_default(&maintain);
    rho_initiator_config_default(&start);
    if (rho_tracker_init(&tracker, sizeof tracker, &maintain) != RHO_OK ||
        (starts && rho_initiator_init(starts, sizeof *starts, &start) != RHO_OK)) {
        return 1;
    }
    for (unsigned i = 0; i < RHO_MAX_PLOTS; i++) {
        if (rho_measurement_from_polar(&polar, 0, NULL, &plots[i]) != RHO_OK) {
            return 1;
        }
    }
    return rho_tracker_step(&tracker, starts, &scan, &report) != RHO_OK;
}
