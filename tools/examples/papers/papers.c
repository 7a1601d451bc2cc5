/* SPDX-License-Identifier: MIT */
/*
 * papers: each paper's method as a function of its own. The Hough gate with input estimation takes
 * one scan by one call; the Hough transforms need the plots or bearings of some scans. Exit code 0
 * where each finds its target.
 */
#include <math.h>
#include <stdio.h>

#include "rhotrack/hough.h"
#include "rhotrack/passive_paper.h"
#include "rhotrack/tracker.h"

#define SCANS 8

static struct rho_tracker tracker;
static struct rho_report report;
static struct rho_hough hough;
static struct rho_passive_paper passive;

/* A target at 250 m/s, and false plots ever elsewhere: places at scan k. */
static const float x_m[] = {0, 500, 1000, 1500, 2000, 2500, 3000, 3500};

/* The maintenance paper: the target's plot is chosen among clutter, scan by scan. */
static int follow_by_hough_gate(void)
{
    struct rho_tracker_config config;
    rho_tracker_config_default(&config);
    config.gate = RHO_TRACKER_HOUGH;
    config.input.is_estimated = 1;
    int is_ok = rho_tracker_init(&tracker, sizeof tracker, &config) == RHO_OK;
    for (int k = 0; is_ok && k < SCANS; k++) {
        struct rho_plot plots[2] = {{.x_m = x_m[k], .y_m = 9e3f},
                                    {.x_m = x_m[7 - k] + 150, .y_m = 9e3f + 120}};
        struct rho_scan scan = {.time_us = 2000000LL * k, .num_plots = 2, .plots = plots};
        plots[0].sigma_range_m = plots[0].sigma_cross_m = 10;
        plots[1].sigma_range_m = plots[1].sigma_cross_m = 10;
        is_ok = rho_tracker_step(&tracker, NULL, &scan, &report) == RHO_OK; /* the one call */
        if (is_ok && k == 0) {
            const struct rho_track_plot start = {.time_us = 0, .plot = plots[0]};
            is_ok = rho_tracker_start_track(&tracker, &start, 1, 0, &report) == RHO_OK;
        }
    }
    return is_ok && report.num_tracks == 1 && fabsf(report.tracks[0].state[0] - 3500) < 50;
}

/* The neutrosophic paper: the line with the most votes in the plots of eight scans. */
static int find_line_by_neutrosophic_transform(void)
{
    static const float y_m[SCANS] = {900, 900, 900, 900, 900, 900, 900, 900};
    static const float t_s[SCANS] = {0, 2, 4, 6, 8, 10, 12, 14};
    static const uint32_t scan_end[SCANS] = {1, 2, 3, 4, 5, 6, 7, 8};
    const struct rho_hough_points points = {.at = {x_m, y_m, SCANS, scan_end}, .t_s = t_s};
    struct rho_accumulator_peak peaks[32];
    struct rho_hough_config config;
    struct rho_hough_result result;
    rho_hough_config_default(&config, RHO_HOUGH_NHT_C);
    return rho_hough_init(&hough, sizeof hough, &config) == RHO_OK &&
           rho_hough_find(&hough, &points, peaks, 32, &result) == RHO_OK &&
           fabsf(rho_hough_theta_rad(&hough, peaks[0].theta_cell) - 1.5708f) < 0.01f;
}

/* The passive paper: crossings of two sensors' bearings, and the line that they vote for. */
static int find_line_by_passive_transform(void)
{
    struct rho_passive_paper_config config;
    rho_passive_paper_config_default(&config);
    int is_ok = rho_passive_paper_init(&passive, sizeof passive, &config) == RHO_OK;
    for (int k = 0; is_ok && k < SCANS; k++) {
        struct rho_bearing bearings[2] = {{.sigma_rad = 0.002f}, {.sigma_rad = 0.002f}};
        struct rho_bearing_scan looks[2] = {{.sensor_id = 1, .y_m = -10e3f},
                                            {.sensor_id = 2, .y_m = 10e3f}};
        uint8_t fates[2] = {RHO_FATE_HELD, RHO_FATE_HELD};
        for (int s = 0; s < 2; s++) {
            bearings[s].bearing_rad = atan2f(5.4e3f - looks[s].y_m, 60e3f - 5 * x_m[k]);
            looks[s].num_bearings = 1;
            looks[s].bearings = &bearings[s];
        }
        const struct rho_frame frame = {10000000LL * k, 2, looks};
        is_ok = rho_passive_paper_push(&passive, &frame, fates) == RHO_OK;
    }
    return is_ok && rho_passive_paper_search(&passive) == RHO_OK && passive.num_lines == 1;
}

int main(void)
{
    const int gate = follow_by_hough_gate(), line = find_line_by_neutrosophic_transform(),
              passive_line = find_line_by_passive_transform();
    printf("Hough gate %d, neutrosophic transform %d, passive transform %d\n", gate, line,
           passive_line);
    return !(gate && line && passive_line);
}
