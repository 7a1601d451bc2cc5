/* SPDX-License-Identifier: MIT */
/*
 * main: smallest complete use of the library: a radar sees one target in clutter every 2 s; the
 * target becomes a track, the clutter does not. Exit code 0 on success.
 */
#include <stdio.h>

#include "rhotrack/tracker.h"

#define NUM_SCANS 8
#define NUM_PLOTS 4

static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_report report;
static struct rho_plot plots[NUM_PLOTS];

/* Prints the status unless it is RHO_OK; returns whether it is. */
static int is_ok_else_print_failure(const char *what, enum rho_status status)
{
    if (status != RHO_OK) {
        printf("%s: %s\n", what, rho_status_name(status));
    }
    return status == RHO_OK;
}

static int init_objects(void)
{
    struct rho_tracker_config maintain;
    struct rho_initiator_config initiate;
    rho_tracker_config_default(&maintain);
    rho_initiator_config_default(&initiate);
    return is_ok_else_print_failure("tracker",
                                    rho_tracker_init(&tracker, sizeof tracker, &maintain)) &&
           is_ok_else_print_failure("initiator",
                                    rho_initiator_init(&initiator, sizeof initiator, &initiate));
}

/* A random coordinate, 0 to 20 km, by a linear congruential generator. */
static float random_coordinate_m(void)
{
    static uint32_t seed = 1;
    seed = seed * 1664525u + 1013904223u;
    return (float)(seed >> 8) * (20000.0f / 16777216.0f);
}

/* Steps scan k: plot 0 is the target, flying east at 250 m/s, the others are clutter. */
static int step_scan(int k)
{
    struct rho_scan scan = {
        .time_us = 2000000 * (int64_t)k, .num_plots = NUM_PLOTS, .plots = plots};
    for (int i = 0; i < NUM_PLOTS; i++) {
        plots[i].x_m = i == 0 ? 500.0f * (float)k : random_coordinate_m();
        plots[i].y_m = i == 0 ? 1000.0f : random_coordinate_m();
        plots[i].sigma_range_m = 10.0f;
        plots[i].sigma_cross_m = 10.0f;
    }
    return is_ok_else_print_failure("step", rho_tracker_step(&tracker, &initiator, &scan, &report));
}

int main(void)
{
    const struct rho_track_report *track = &report.tracks[0];
    if (!init_objects()) {
        return 1;
    }
    for (int k = 0; k < NUM_SCANS; k++) {
        if (!step_scan(k)) {
            return 1;
        }
    }
    printf("tracks: %u; the first: id %u, %s, at %d m, %d m/s\n", (unsigned)report.num_tracks,
           (unsigned)track->track_id, rho_track_status_name(track->status),
           (int)(track->state[0] + 0.5f), (int)(track->state[3] + 0.5f));
    printf("bytes: tracker %u, initiator %u, report %u\n", (unsigned)sizeof tracker,
           (unsigned)sizeof initiator, (unsigned)sizeof report);
    return report.num_tracks == 1 && track->status == RHO_TRACK_CONFIRMED ? 0 : 1;
}
