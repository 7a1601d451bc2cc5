/* SPDX-License-Identifier: MIT */
/*
 * growth: steps of a whole tracker in clutter that is uniform over 500 x 500 km, a scan every 10 s;
 * tools/gates/instructions.sh counts how the instructions grow with the number of plots.
 *
 * Arguments: plots a scan; v_min and v_max in m/s. Only steps with a full window are counted.
 * Prints how many steps were partial because the work limit was reached.
 */
#include <stdlib.h>

#include "count.h"
#include "random_draws.h"
#include "rhotrack/tracker.h"

#define SIDE_M 500e3f
#define INTERVAL_US 10000000
#define SIGMA_M 50.0f
#define START_STEPS 7
#define STEPS 8

static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_report report;
static struct rho_plot plots[RHO_MAX_PLOTS];

static int init_failed(float v_min_mps, float v_max_mps)
{
    static const struct rho_sensor sensor = {.sensor_id = 1, .pd = 0.9f, .range_max_m = 400e3f};
    struct rho_tracker_config config;
    struct rho_initiator_config start;
    rho_tracker_config_default(&config);
    rho_initiator_config_default(&start);
    config.v_min_mps = start.v_min_mps = v_min_mps;
    config.v_max_mps = start.v_max_mps = v_max_mps;
    return rho_tracker_init(&tracker, sizeof tracker, &config) != RHO_OK ||
           rho_initiator_init(&initiator, sizeof initiator, &start) != RHO_OK ||
           rho_tracker_set_sensor(&tracker, &sensor) != RHO_OK;
}

int main(int argc, char **argv)
{
    const int count = argc == 4 ? atoi(argv[1]) : 0;
    if (count < 1 || count > RHO_MAX_PLOTS) {
        fprintf(stderr, "growth: give 1 .. %d plots, v_min and v_max in m/s\n", RHO_MAX_PLOTS);
        return 2;
    }
    int failed = init_failed((float)atof(argv[2]), (float)atof(argv[3]));
    for (int k = 0; k < START_STEPS + STEPS && !failed; k++) {
        for (int i = 0; i < count; i++) {
            plots[i] = (struct rho_plot){.x_m = draw_uniform(-0.5f * SIDE_M, 0.5f * SIDE_M),
                                         .y_m = draw_uniform(-0.5f * SIDE_M, 0.5f * SIDE_M),
                                         .sigma_range_m = SIGMA_M,
                                         .sigma_cross_m = SIGMA_M};
        }
        const struct rho_scan scan = {.time_us = (int64_t)INTERVAL_US * k,
                                      .sensor_id = 1,
                                      .num_plots = (uint32_t)count,
                                      .plots = plots};
        if (k >= START_STEPS) {
            count_begin();
        }
        failed |= rho_tracker_step(&tracker, &initiator, &scan, &report) != RHO_OK;
        if (k >= START_STEPS) {
            count_end();
        }
    }
    printf("%lu partial\n", (unsigned long)tracker.work.partial_steps);
    count_print_totals();
    return failed;
}
