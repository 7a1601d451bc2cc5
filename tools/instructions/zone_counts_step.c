/* SPDX-License-Identifier: MIT */
/*
 * zone_counts_step: a step of 16 zones; tools/gates/instructions.sh counts its instructions.
 * RHO_MAX_TRACKS tracks drive along four lanes of four zones each; a zone is 100 m long and 4 m
 * wide.
 */
#include "count.h"
#include "random_draws.h"
#include "rhotrack/zones.h"

#define STEPS 200
#define ZONES 16
#define LANES 4

static struct rho_zones zones;
static struct rho_report report;

static int open_lane_zones(void)
{
    int failed = rho_zones_init(&zones, sizeof zones) != RHO_OK;
    for (int i = 0; i < ZONES; i++) {
        const float x_m = 100.0f * (float)(i / LANES), y_m = 4.0f * (float)(i % LANES);
        const struct rho_zone zone = {.zone_id = i,
                                      .num_corners = 4,
                                      .has_heading = 1,
                                      .x_m = {x_m, x_m + 100.0f, x_m + 100.0f, x_m},
                                      .y_m = {y_m, y_m, y_m + 4.0f, y_m + 4.0f},
                                      .margin_m = 1.0f,
                                      .queue_mps = 2.0f};
        failed |= rho_zones_add(&zones, &zone) != RHO_OK;
    }
    return failed;
}

/* Tracks that have passed all zones begin again 20 m before the first ones. */
static void move_tracks_by_50_ms(void)
{
    report.time_us += 50000;
    for (int i = 0; i < report.num_tracks; i++) {
        float *state = report.tracks[i].state;
        state[RHO_X] += 0.05f * state[RHO_VX];
        state[RHO_Y] += draw_normal(0.1f);
        if (state[RHO_X] > 420.0f) {
            state[RHO_X] = -20.0f;
        }
    }
}

int main(void)
{
    int failed = open_lane_zones();
    report.num_tracks = RHO_MAX_TRACKS;
    for (int i = 0; i < report.num_tracks; i++) {
        report.tracks[i].track_id = (uint32_t)i + 1;
        report.tracks[i].status = RHO_TRACK_CONFIRMED;
        report.tracks[i].state[RHO_X] = draw_uniform(-20.0f, 420.0f);
        report.tracks[i].state[RHO_Y] = draw_uniform(0.0f, 16.0f);
        report.tracks[i].state[RHO_VX] = draw_uniform(0.5f, 30.0f);
    }
    for (int k = 0; k < STEPS; k++) {
        move_tracks_by_50_ms();
        count_begin();
        failed |= rho_zones_step(&zones, &report) != RHO_OK;
        count_end();
    }
    count_print_totals();
    return failed || zones.counts[0].entered == 0;
}
