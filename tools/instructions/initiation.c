/* SPDX-License-Identifier: MIT */
/*
 * initiation: searches of a full initiation window; tools/gates/instructions.sh counts their
 * instructions.
 *
 * Arguments: the search (batch or newest); the plots' noise (isotropic; own, where each plot's
 * covariance is slightly anisotropic; or rate, anisotropic and with range rates); clutter plots a
 * scan; the number of windows, each with other plots. Three targets cross the 4 x 2.5 km of the
 * literature's Table 1. Prints seeds, look-ups, distances and candidates of the last search.
 */
#include <stdlib.h>
#include <string.h>

#include "count.h"
#include "random_draws.h"
#include "rhotrack/initiator.h"

#define SCANS 7
#define TARGETS 3
#define CLUTTER_MAX 200
#define SIGMA_M 10.0f
#define INTERVAL_US 2000000

static struct rho_initiator initiator;
static struct rho_plot plots[SCANS][TARGETS + CLUTTER_MAX];
static const struct rho_sensor sensor = {
    .x_m = -20000.0f, .y_m = -15000.0f, .pd = 0.9f, .range_max_m = 1e5f};

static struct rho_plot plot_with_random_range_rate(float x_m, float y_m, float sigma_cross_m)
{
    return (struct rho_plot){.x_m = x_m,
                             .y_m = y_m,
                             .sigma_range_m = SIGMA_M,
                             .sigma_cross_m = sigma_cross_m,
                             .sigma_up_m = SIGMA_M,
                             .range_rate_mps = draw_uniform(-400.0f, 400.0f),
                             .sigma_range_rate_mps = 1.0f};
}

static void draw_plots_of_all_scans(int num_clutter, float sigma_cross_m)
{
    for (int scan = 0; scan < SCANS; scan++) {
        for (int i = 0; i < TARGETS; i++) {
            float along_m = 400.0f * (float)scan; /* 200 m/s */
            plots[scan][i] = plot_with_random_range_rate(
                200.0f + along_m + draw_normal(SIGMA_M),
                -800.0f + 800.0f * (float)i + draw_normal(SIGMA_M), sigma_cross_m);
        }
        for (int i = 0; i < num_clutter; i++) {
            float x_m = draw_uniform(0.0f, 4000.0f), y_m = draw_uniform(-1000.0f, 1500.0f);
            plots[scan][TARGETS + i] = plot_with_random_range_rate(x_m, y_m, sigma_cross_m);
        }
    }
}

static int failed_to_fill_window(int num_clutter, uint32_t measures, uint16_t min_scans)
{
    struct rho_initiator_config config;
    uint8_t fates[RHO_MAX_PLOTS];
    uint32_t unused = 0;
    int failed;
    rho_initiator_config_default(&config);
    config.min_scans = min_scans;
    config.v_min_mps = 100.0f;
    config.v_max_mps = 400.0f;
    config.area_is_fixed = 1;
    config.area = (struct rho_extent){0.0f, 4000.0f, -1000.0f, 1500.0f};
    failed = rho_initiator_init(&initiator, sizeof initiator, &config) != RHO_OK;
    for (int scan = 0; scan < SCANS; scan++) {
        struct rho_scan from = {.time_us = (int64_t)INTERVAL_US * scan,
                                .measures = measures,
                                .num_plots = (uint32_t)(TARGETS + num_clutter),
                                .plots = plots[scan]};
        memset(fates, RHO_FATE_HELD, sizeof fates);
        failed |= rho_initiator_push(&initiator, &from, &sensor, fates, &unused) != RHO_OK;
    }
    return failed;
}

int main(int argc, char **argv)
{
    int clutter = argc == 5 ? atoi(argv[3]) : -1, windows = argc == 5 ? atoi(argv[4]) : 0,
        failed = 0;
    if (clutter < 0 || clutter > CLUTTER_MAX || windows < 1) {
        fprintf(
            stderr,
            "initiation: give batch or newest, isotropic, own or rate, 0 .. %d plots, windows\n",
            CLUTTER_MAX);
        return 2;
    }
    enum rho_search kind = strcmp(argv[1], "newest") == 0 ? RHO_SEARCH_NEWEST : RHO_SEARCH_BATCH;
    float sigma_cross_m = strcmp(argv[2], "isotropic") == 0 ? SIGMA_M : 1.01f * SIGMA_M;
    uint32_t measures = strcmp(argv[2], "rate") == 0 ? RHO_MEASURES_RANGE_RATE : 0;
    for (int i = 0; i < windows && !failed; i++) {
        draw_plots_of_all_scans(clutter, sigma_cross_m);
        failed |= failed_to_fill_window(clutter, measures, kind == RHO_SEARCH_NEWEST ? 0 : 5);
        count_begin();
        failed |= rho_initiator_search(&initiator, kind) != RHO_OK;
        count_end();
    }
    printf("%lu seeds, %lu look-ups, %lu distances, %u candidates\n",
           (unsigned long)initiator.work.seeds, (unsigned long)initiator.work.window.lookups,
           (unsigned long)initiator.work.window.distances, (unsigned)initiator.num_candidates);
    count_print_totals();
    return failed;
}
