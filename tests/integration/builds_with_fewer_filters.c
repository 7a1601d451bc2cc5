/* SPDX-License-Identifier: MIT */
/*
 * builds_with_fewer_filters: what a build with RHO_FILTERS takes, and the same bytes as the full
 * build's of it, for builds_with_fewer_filters.sh. Prints a line for each gate, with and without
 * input estimation: the outcome of init, and a sum over all reports of a scene; and one for a scan
 * and a frame that are to start tracks.
 */
#include <stdio.h>
#include <string.h>

#include "rhotrack/passive.h"
#include "rhotrack/tracker.h"

#define SCANS 30
#define CLUTTER 12

static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_passive passive;
static struct rho_report report;
static uint32_t sum, random_state;

static void add(const void *data, size_t size)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i++) {
        sum = (sum ^ bytes[i]) * 16777619u;
    }
}

static float uniform(float low, float high)
{
    random_state = random_state * 1664525u + 1013904223u;
    return low + (high - low) * (float)(random_state >> 8) / 16777216.0f;
}

static void take(const struct rho_scan *scan)
{
    const int status = (int)rho_tracker_step(&tracker, &initiator, scan, &report);
    add(&status, sizeof status);
    for (unsigned i = 0; i < report.num_tracks; i++) {
        add(&report.tracks[i].track_id, sizeof report.tracks[i].track_id);
        add(report.tracks[i].state, sizeof report.tracks[i].state);
        add(report.tracks[i].covariance, sizeof report.tracks[i].covariance);
    }
}

/* A target that flies straight and one that turns, in clutter. */
static void step(int scan)
{
    struct rho_plot plots[CLUTTER];
    const float t = 2.0f * (float)scan;
    for (int i = 0; i < CLUTTER; i++) {
        plots[i] = (struct rho_plot){.x_m = uniform(-8000.0f, 8000.0f),
                                     .y_m = uniform(-8000.0f, 8000.0f),
                                     .sigma_range_m = 20.0f,
                                     .sigma_cross_m = 20.0f,
                                     .sigma_up_m = 20.0f};
    }
    plots[0].x_m = -6000.0f + 200.0f * t + uniform(-30.0f, 30.0f);
    plots[0].y_m = 1000.0f + uniform(-30.0f, 30.0f);
    plots[1].x_m = 100.0f * t + uniform(-30.0f, 30.0f);
    plots[1].y_m = -5000.0f + 2.0f * t * t + uniform(-30.0f, 30.0f);
    take(&(struct rho_scan){
        .time_us = 2000000 * (int64_t)scan, .num_plots = CLUTTER, .plots = plots});
    /* reports that tracks are moved for: a sector that looks elsewhere, a scan that is late */
    take(&(struct rho_scan){.time_us = 2000000 * (int64_t)scan + 500000,
                            .sector_from_rad = -2.4f,
                            .sector_to_rad = -2.3f});
    take(&(struct rho_scan){.time_us = 2000000 * (int64_t)scan - 700000});
}

static enum rho_status init(uint8_t gate, uint8_t is_input_estimated)
{
    struct rho_tracker_config config;
    struct rho_initiator_config initiation;
    rho_tracker_config_default(&config);
    config.gate = gate;
    config.input.is_estimated = is_input_estimated;
    rho_initiator_config_default(&initiation);
    enum rho_status status = rho_initiator_init(&initiator, sizeof initiator, &initiation);
    return status == RHO_OK ? rho_tracker_init(&tracker, sizeof tracker, &config) : status;
}

static void print_status_of_default_config(void)
{
    struct rho_tracker_config config;
    rho_tracker_config_default(&config);
    printf("default %s\n", rho_status_name(rho_tracker_init(&tracker, sizeof tracker, &config)));
}

static void print_status_of_steps_with_initiators(void)
{
    static const struct rho_scan scan = {.time_us = 0};
    static const struct rho_bearing_scan look = {.time_us = 0};
    struct rho_initiator_config initiation;
    struct rho_passive_config config;
    rho_initiator_config_default(&initiation);
    rho_passive_config_default(&config);
    const int failed = rho_initiator_init(&initiator, sizeof initiator, &initiation) != RHO_OK ||
                       rho_passive_init(&passive, sizeof passive, &config) != RHO_OK;
    printf("starts %s %s\n",
           failed ? "unusable"
                  : rho_status_name(rho_tracker_step(&tracker, &initiator, &scan, &report)),
           failed ? "unusable"
                  : rho_status_name(rho_tracker_step_bearings(&tracker, &passive, &look, &report)));
}

int main(void)
{
    for (uint8_t way = 0; way < 2 * RHO_NUM_TRACKER_GATES; way++) {
        const enum rho_status status = init(way / 2, way % 2);
        sum = 2166136261u;
        random_state = 1;
        for (int scan = 0; scan < SCANS && status == RHO_OK; scan++) {
            step(scan);
        }
        printf("gate %d input %d: %s %08x %u\n", way / 2, way % 2, rho_status_name(status),
               (unsigned)sum, status == RHO_OK ? (unsigned)report.num_tracks : 0u);
    }
    print_status_of_default_config();
    print_status_of_steps_with_initiators();
    return 0;
}
