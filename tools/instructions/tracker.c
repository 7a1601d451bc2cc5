/* SPDX-License-Identifier: MIT */
/*
 * tracker: whole steps of a tracker that maintains eight tracks; tools/gates/instructions.sh counts
 * their instructions. A step is prediction, gates, assignment, updates and report, without
 * initiation.
 *
 * Arguments: the gate (best, hough or nearest); polar (a radar's plots of 15 m x 3 mrad in range
 * and azimuth, with range rates) or cartesian (positions and velocities with isotropic noise); the
 * plots of each target; the sectors of a turn, each a step. A target's own plot comes with clutter
 * around it (scene.h). Prints the mean number of tracks, and the plots of a turn.
 */
#include <stdlib.h>
#include <string.h>

#include "count.h"
#include "rhotrack/tracker.h"
#include "scene.h"

#define EACH_MAX 10
#define START_TURNS 10
#define SECTORS_MAX 64
#define TURNS 100 /* a mean over 100 turns has two decimals */

static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_report report;
static struct rho_plot plots[TARGETS * EACH_MAX], looked_at[TARGETS * EACH_MAX];

static struct rho_scan draw_scan_of_turn(int turn, int is_polar, int plots_a_target)
{
    for (int i = 0; i < TARGETS; i++) {
        struct target target = target_at(i, INTERVAL_S * (float)turn);
        for (int k = 0; k < plots_a_target; k++) {
            plots[plots_a_target * i + k] = draw_plot(&target, is_polar, k > 0);
        }
    }
    return (struct rho_scan){.time_us = (int64_t)(1e6f * INTERVAL_S) * turn,
                             .sensor_id = sensor.sensor_id,
                             .measures = measured_quantities_of(is_polar),
                             .num_plots = (uint32_t)(TARGETS * plots_a_target),
                             .plots = plots};
}

static int open_tracker(const char *gate)
{
    struct rho_tracker_config config;
    struct rho_initiator_config start;
    rho_tracker_config_default(&config);
    rho_initiator_config_default(&start);
    config.gate = strcmp(gate, "hough") == 0     ? RHO_TRACKER_HOUGH
                  : strcmp(gate, "nearest") == 0 ? RHO_TRACKER_NEAREST
                                                 : RHO_TRACKER_BEST;
    config.input.is_estimated = config.gate == RHO_TRACKER_HOUGH;
    return rho_tracker_init(&tracker, sizeof tracker, &config) != RHO_OK ||
           rho_initiator_init(&initiator, sizeof initiator, &start) != RHO_OK ||
           rho_tracker_set_sensor(&tracker, &sensor) != RHO_OK;
}

/* The scan of one of num_sectors equal sectors of a turn, with the plots that lie in it. */
static struct rho_scan scan_of_sector(const struct rho_scan *turn, int sector, int num_sectors)
{
    struct rho_scan scan = *turn;
    const float width_rad = RHO_TWO_PI / (float)num_sectors;
    if (num_sectors == 1) {
        return scan;
    }
    scan.time_us += (int64_t)(1e6f * INTERVAL_S) * sector / num_sectors;
    scan.sector_from_rad = width_rad * (float)sector - RHO_PI;
    scan.sector_to_rad = width_rad * (float)(sector + 1) - RHO_PI;
    scan.plots = looked_at;
    scan.num_plots = 0;
    for (uint32_t i = 0; i < turn->num_plots; i++) {
        float azimuth_rad = rho_atan2(turn->plots[i].y_m, turn->plots[i].x_m);
        if (azimuth_rad >= scan.sector_from_rad && azimuth_rad < scan.sector_to_rad) {
            looked_at[scan.num_plots++] = turn->plots[i];
        }
    }
    return scan;
}

/* Steps with the initiator and uncounted at the start; afterwards without it, and counted. */
static void step_and_count_unless_start(const struct rho_scan *scan, int is_start)
{
    if (is_start) {
        failed |= rho_tracker_step(&tracker, &initiator, scan, &report) != RHO_OK;
        return;
    }
    count_begin();
    failed |= rho_tracker_step(&tracker, NULL, scan, &report) != RHO_OK;
    count_end();
}

int main(int argc, char **argv)
{
    int each = argc == 5 ? atoi(argv[3]) : 0, sectors = argc == 5 ? atoi(argv[4]) : 0;
    uint32_t tracks = 0;
    if (each < 1 || each > EACH_MAX || sectors < 1 || sectors > SECTORS_MAX) {
        fprintf(stderr,
                "tracker: give a gate, polar or cartesian, 1 .. %d plots, 1 .. %d sectors\n",
                EACH_MAX, SECTORS_MAX);
        return 2;
    }
    failed = open_tracker(argv[1]);
    for (int turn = 0; turn < START_TURNS + TURNS && !failed; turn++) {
        int is_start = turn < START_TURNS;
        struct rho_scan whole =
            draw_scan_of_turn(turn, strcmp(argv[2], "polar") == 0, is_start ? 1 : each);
        for (int sector = 0; sector < (is_start ? 1 : sectors); sector++) {
            struct rho_scan scan = scan_of_sector(&whole, sector, is_start ? 1 : sectors);
            step_and_count_unless_start(&scan, is_start);
        }
        tracks += is_start ? 0 : report.num_tracks;
    }
    printf("%lu.%02lu tracks, %d plots\n", (unsigned long)tracks / TURNS,
           (unsigned long)tracks % TURNS, TARGETS * each);
    count_print_totals();
    return failed;
}
