/* SPDX-License-Identifier: MIT */
/*
 * jobs: one job of the library, named on the command line, for tools/instructions.sh to count the instructions of.
 * What is counted runs inside job(); the rest is preparation.
 */
#include <stdio.h>
#include <string.h>

#include "rhotrack/gate.h"
#include "rhotrack/initiator.h"
#include "rhotrack/input.h"
#include "rhotrack/kalman.h"
#include "rhotrack/measurement.h"
#include "rhotrack/tracker.h"

#define SCANS 7
#define CLUTTER 100
#define SIGMA_M 10.0f

static struct rho_initiator initiator;
static struct rho_plot plots[SCANS][CLUTTER];
static struct rho_kalman kalman;
static struct rho_measurement measurement;
static const struct rho_sensor sensor = {
    .x_m = -20000.0f, .y_m = -15000.0f, .pd = 0.9f, .range_max_m = 1e5f};

static int must(enum rho_status status)
{
    if (status != RHO_OK) {
        fprintf(stderr, "jobs: %s\n", rho_status_name(status));
    }
    return status != RHO_OK;
}

static float uniform(float low, float high)
{
    static uint32_t state = 1;
    state = state * 1664525u + 1013904223u;
    return low + (high - low) * (float)(state >> 8) / 16777216.0f;
}

/* Clutter of the paper's Table 1 at 10 a km^2: 100 plots a scan in 4 x 2.5 km. */
static void fill(float sigma_cross_m)
{
    for (int scan = 0; scan < SCANS; scan++) {
        for (int i = 0; i < CLUTTER; i++) {
            plots[scan][i] = (struct rho_plot){.x_m = uniform(0.0f, 4000.0f),
                                               .y_m = uniform(-1000.0f, 1500.0f),
                                               .sigma_range_m = SIGMA_M,
                                               .sigma_cross_m = sigma_cross_m,
                                               .sigma_up_m = SIGMA_M,
                                               .range_rate_mps = uniform(-400.0f, 400.0f),
                                               .sigma_range_rate_mps = 1.0f};
        }
    }
}

static int prepare_window(float sigma_cross_m, uint32_t measures, uint16_t min_scans)
{
    struct rho_initiator_config config;
    uint8_t fates[RHO_MAX_PLOTS];
    uint32_t unused = 0;
    int failed = 0;
    rho_initiator_config_default(&config);
    config.min_scans = min_scans;
    config.v_min_mps = 100.0f;
    config.v_max_mps = 400.0f;
    config.area_is_fixed = 1;
    config.area = (struct rho_extent){0.0f, 4000.0f, -1000.0f, 1500.0f};
    failed |= must(rho_initiator_init(&initiator, sizeof initiator, &config));
    fill(sigma_cross_m);
    for (int scan = 0; scan < SCANS; scan++) {
        struct rho_scan from = {.time_us = 2000000 * (int64_t)scan,
                                .measures = measures,
                                .num_plots = CLUTTER,
                                .plots = plots[scan]};
        memset(fates, RHO_FATE_HELD, sizeof fates);
        failed |= must(rho_initiator_push(&initiator, &from, &sensor, fates, &unused));
    }
    return failed;
}

static int prepare_filter(void)
{
    int failed = 0;
    struct rho_plot plot = {.x_m = 30000.0f,
                            .y_m = 20000.0f,
                            .z_m = 3000.0f,
                            .sigma_range_m = 15.0f,
                            .sigma_cross_m = 110.0f,
                            .sigma_up_m = 110.0f};
    rho_kalman_init(&kalman);
    for (int axis = 0; axis < 3; axis++) {
        failed |= must(rho_kalman_open_axis(&kalman, axis, 100.0f, 100.0f, 1e4f));
    }
    rho_measurement_open(&plot, RHO_MEASURES_Z, NULL, &measurement);
    return failed;
}

static int filter_job(int updates)
{
    int failed = must(rho_kalman_predict(&kalman, 1.0f, 1.0f));
    for (int i = 0; i < updates; i++) {
        failed |= must(rho_kalman_update(&kalman, i, 100.0f, 100.0f, NULL));
    }
    return failed;
}

static int polar_job(void)
{
    int failed = must(rho_kalman_predict(&kalman, 1.0f, 1.0f));
    failed |= must(rho_kalman_update_position(&kalman, &measurement, 1e4f));
    return failed | must(rho_kalman_update_range_rate(&kalman, NULL, 100.0f, 1.0f));
}

/* ---- the paper's step: target and clutter of one scan, which the caller has put aside from the last ----- */

#define PLOTS 5 /* the target's is the first */

static struct rho_input_config input_config;
static struct rho_input input;
static float before_mps[3], newest_mps[3];
static float seen[PLOTS][RHO_KALMAN_STATES];

static int estimate_input(void)
{
    struct rho_kalman estimate;
    rho_input_decide(&input, &input_config);
    rho_input_estimate(&input, &estimate);
    memcpy(before_mps, newest_mps, sizeof before_mps);
    memcpy(newest_mps, &estimate.state[3], sizeof newest_mps);
    return 0;
}

static int update_input(const float plot[RHO_KALMAN_STATES])
{
    int failed = 0;
    for (int i = 0; i < RHO_KALMAN_STATES; i++) {
        failed |= must(rho_input_update(&input, &input_config, i, plot[i], 1.0f));
    }
    return failed;
}

static int input_job(void)
{
    struct rho_gate_hough hough;
    int best = 0;
    int failed = must(rho_input_predict(&input, &input_config, 0.25f));
    failed |=
        must(rho_gate_hough_open(&hough, RHO_GATE_PLANE_XY | RHO_GATE_PLANE_XZ | RHO_GATE_PLANE_YZ,
                                 0.0872664626f, before_mps, newest_mps));
    float least = rho_gate_hough_off(&hough, &seen[0][3]);
    for (int i = 1; i < PLOTS; i++) {
        float off = rho_gate_hough_off(&hough, &seen[i][3]);
        if (off < least) {
            least = off;
            best = i;
        }
    }
    failed |= update_input(seen[best]);
    return failed | estimate_input();
}

/* Three scans, of which the last begins a turn on all axes: the inputs of all three are present. */
static int prepare_input(void)
{
    int failed = 0;
    rho_input_config_default(&input_config);
    rho_kalman_init(&kalman);
    for (int axis = 0; axis < 3; axis++) {
        failed |= must(rho_kalman_open_axis(&kalman, axis, 100.0f, 500.0f, 500.0f));
    }
    failed |= must(rho_input_start(&input, &input_config, &kalman));
    for (int scan = 1; scan <= 4; scan++) {
        float speed_mps = scan < 3 ? 0.0f : 20.0f * (float)(scan - 2);
        for (int i = 0; i < RHO_KALMAN_STATES; i++) {
            seen[0][i] = i < 3 ? 100.0f : speed_mps;
            for (int k = 1; k < PLOTS; k++) {
                seen[k][i] = seen[0][i] + uniform(500.0f, 2000.0f);
            }
        }
        if (scan < 4) {
            failed |= must(rho_input_predict(&input, &input_config, 0.25f));
            failed |= update_input(seen[0]) | estimate_input();
        }
    }
    return failed | (input.present != 7);
}

static enum rho_search kind;
static enum { SEARCH, AXES, POLAR, INPUT } work;
static int num_updates;

/* Counted. */
__attribute__((noinline)) int job(void)
{
    switch (work) {
    case AXES:
        return filter_job(num_updates);
    case POLAR:
        return polar_job();
    case INPUT:
        return input_job();
    default:
        return must(rho_initiator_search(&initiator, kind));
    }
}

static int prepare(const char *name)
{
    kind = strncmp(name, "newest", 6) == 0 ? RHO_SEARCH_NEWEST : RHO_SEARCH_BATCH;
    uint16_t min_scans = kind == RHO_SEARCH_NEWEST ? 0 : 5;
    if (strncmp(name, "predict", 7) == 0) {
        work = strcmp(name, "predict+polar") == 0 ? POLAR : AXES;
        num_updates = name[8] - '0';
        return prepare_filter();
    }
    if (strcmp(name, "input+hough") == 0) {
        work = INPUT;
        return prepare_input();
    }
    if (strstr(name, "isotropic")) {
        return prepare_window(SIGMA_M, 0, min_scans);
    }
    /* nearly the same noise, so that the work is the same, too */
    return prepare_window(SIGMA_M * 1.01f, strstr(name, "rate") ? RHO_MEASURES_RANGE_RATE : 0,
                          min_scans);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "jobs: give one name\n");
        return 2;
    }
    int failed = prepare(argv[1]) | job();
    printf("%u %u %u %u\n", initiator.work.seeds, initiator.work.window.lookups,
           initiator.work.window.distances, initiator.num_candidates);
    return failed;
}
