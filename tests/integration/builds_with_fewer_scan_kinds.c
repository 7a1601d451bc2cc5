/* SPDX-License-Identifier: MIT */
/*
 * builds_with_fewer_scan_kinds: what a build with RHO_SCAN_KINDS takes, for
 * builds_with_fewer_scan_kinds.sh. Prints a line for each kind of message, what the assembler says
 * of it and the bytes of what it gives; and what the initiator finds of two targets in clutter:
 * with the noise of a radar, and with noise of one axis.
 */
#include <stdio.h>
#include <string.h>

#include "rhotrack/initiator.h"
#include "rhotrack/message.h"
#include "rhotrack/scan_assembler.h"

#define SCANS 7
#define TARGETS 2
#define CLUTTER 20

static struct rho_scan_assembler assembler;
static struct rho_initiator initiator;
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

/* ---- messages -------------------------------------------------------------------------------- */

static size_t encode(int kind, uint8_t *buffer, size_t capacity)
{
    static const struct rho_message_plot_scan plots = {
        .sensor_id = 1,
        .kind = RHO_MESSAGE_PLOT_SCAN_POSITION_2D,
        .num_parts = 1,
        .num_plots = 2,
        .plots = {{.x_m = 100.0f, .sigma_m = 3.0f}, {.y_m = -20.0f}}};
    static const struct rho_message_polar_scan polar = {
        .sensor_id = 1,
        .num_parts = 1,
        .sensor_x_m = 5.0f,
        .num_polar_plots = 2,
        .polar_plots = {{.range_m = 100.0f, .azimuth_rad = 1.0f}, {.range_m = 9.0f}}};
    static const struct rho_message_bearing_scan bearings = {
        .sensor_id = 1, .sensor_x_m = 7.0f, .num_bearings = 2, .bearing_rad = {1.0f, -1.0f}};
    static const struct rho_message_direction_scan directions = {
        .sensor_id = 1,
        .sensor_x_m = 7.0f,
        .num_directions = 2,
        .directions = {{.bearing_rad = 1.0f, .elevation_rad = 0.5f, .has_elevation = 1}}};
    size_t size = 0;
    enum rho_status status =
        kind == RHO_SCAN_ASSEMBLER_PLOTS
            ? rho_message_plot_scan_encode(&plots, buffer, capacity, &size)
        : kind == RHO_SCAN_ASSEMBLER_POLAR
            ? rho_message_polar_scan_encode(&polar, buffer, capacity, &size)
        : kind == RHO_SCAN_ASSEMBLER_BEARINGS
            ? rho_message_bearing_scan_encode(&bearings, buffer, capacity, &size)
            : rho_message_direction_scan_encode(&directions, buffer, capacity, &size);
    return status == RHO_OK ? size : 0;
}

static void print_assembled(int kind)
{
    static const char *const channels[] = {
        RHO_MESSAGE_PLOT_SCAN_CHANNEL "1", RHO_MESSAGE_POLAR_SCAN_CHANNEL "1",
        RHO_MESSAGE_BEARING_SCAN_CHANNEL "1", RHO_MESSAGE_DIRECTION_SCAN_CHANNEL "1"};
    struct rho_scan_assembler_config config;
    struct rho_scan_assembler_item item;
    uint8_t buffer[256];
    size_t size = encode(kind, buffer, sizeof buffer);
    unsigned inputs = 0;
    rho_scan_assembler_config_default(&config);
    if (size == 0 || rho_scan_assembler_init(&assembler, sizeof assembler, &config) != RHO_OK) {
        printf("kind %d: unusable\n", kind);
        return;
    }
    sum = 2166136261u;
    enum rho_status status = rho_scan_assembler_take(&assembler, channels[kind], buffer, size, 0);
    while (rho_scan_assembler_next(&assembler, INT64_MAX, &item)) {
        add(&item.sensor.x_m, sizeof item.sensor.x_m);
        add(item.scan.plots, item.scan.num_plots * sizeof *item.scan.plots);
        add(item.bearings.bearings, item.bearings.num_bearings * sizeof *item.bearings.bearings);
        inputs += item.scan.num_plots + item.bearings.num_bearings;
    }
    printf("kind %d: %s %u %08x\n", kind, rho_status_name(status), inputs, (unsigned)sum);
}

/* ---- a search -------------------------------------------------------------------------------- */

static enum rho_status push(int scan, float sigma_cross_m)
{
    struct rho_plot plots[TARGETS + CLUTTER];
    uint8_t fates[TARGETS + CLUTTER];
    uint32_t left_unused;
    for (int i = 0; i < TARGETS + CLUTTER; i++) {
        fates[i] = RHO_FATE_HELD;
        plots[i] = (struct rho_plot){.x_m = uniform(10000.0f, 20000.0f),
                                     .y_m = uniform(-5000.0f, 5000.0f),
                                     .sigma_range_m = 20.0f,
                                     .sigma_cross_m = sigma_cross_m,
                                     .sigma_up_m = 20.0f};
    }
    for (int i = 0; i < TARGETS; i++) {
        plots[i].x_m = 12000.0f + 4000.0f * (float)i + 150.0f * (float)scan;
        plots[i].y_m = 2000.0f - 250.0f * (float)scan * (float)(1 + i);
    }
    return rho_initiator_push(&initiator,
                              &(struct rho_scan){.time_us = 1000000 * (int64_t)scan,
                                                 .sensor_id = 1,
                                                 .num_plots = TARGETS + CLUTTER,
                                                 .plots = plots},
                              &(struct rho_sensor){.sensor_id = 1, .pd = 0.9f, .range_max_m = 1e5f},
                              fates, &left_unused);
}

static void print_search(const char *name, float sigma_cross_m)
{
    struct rho_initiator_config config;
    unsigned found = 0;
    rho_initiator_config_default(&config);
    enum rho_status status = rho_initiator_init(&initiator, sizeof initiator, &config);
    random_state = 7;
    for (int scan = 0; scan < SCANS && status == RHO_OK; scan++) {
        status = push(scan, sigma_cross_m);
    }
    if (status == RHO_OK) {
        status = rho_initiator_search(&initiator, RHO_SEARCH_BATCH);
    }
    sum = 2166136261u;
    for (unsigned i = 0; i < initiator.num_candidates; i++) {
        const struct rho_candidate *candidate = &initiator.candidates[i];
        found += candidate->hits == SCANS;
        add(candidate, sizeof *candidate);
    }
    printf("%s: %s %u found\n", name, rho_status_name(status), found);
    printf("%s bytes: %08x\n", name, (unsigned)sum);
}

int main(void)
{
    for (int kind = 0; kind < 4; kind++) {
        print_assembled(kind);
    }
    print_search("radar", 60.0f);
    print_search("one axis", 20.0f);
    return 0;
}
