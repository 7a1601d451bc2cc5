/* SPDX-License-Identifier: MIT */
/*
 * Work of a batch search with 100 clutter plots a scan (area of Table 1, 7 scans, 5 votes), counted
 * in look-ups and distance tests and so equal on every machine; and the RAM of the embedded
 * profile.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "rhotrack/initiator.h"

#define SCANS 7
#define PLOTS 100
#define WINDOWS 20

static struct rho_initiator initiator;
static uint32_t random_state = 12345;

static float uniform(float from, float to)
{
    random_state = random_state * 1664525u + 1013904223u;
    return from + (to - from) * (float)(random_state >> 8) / 16777216.0f;
}

static void push_clutter(int k)
{
    static struct rho_plot plots[PLOTS];
    static uint8_t fates[PLOTS];
    uint32_t unused = 0;
    for (int i = 0; i < PLOTS; i++) {
        plots[i] = (struct rho_plot){.x_m = uniform(0.0f, 4000.0f),
                                     .y_m = uniform(-1000.0f, 1500.0f),
                                     .sigma_range_m = 10.0f,
                                     .sigma_cross_m = 10.0f};
        fates[i] = RHO_FATE_HELD;
    }
    struct rho_scan scan = {.time_us = 2000000 * (int64_t)k, .num_plots = PLOTS, .plots = plots};
    assert_int_equal(rho_initiator_push(&initiator, &scan, NULL, fates, &unused), RHO_OK);
}

static void search_clutter(void)
{
    struct rho_initiator_config config;
    rho_initiator_config_default(&config);
    config.min_scans = 5;
    config.v_min_mps = 100.0f;
    config.v_max_mps = 400.0f;
    config.score_min_nat = -3.0f;
    config.area_is_fixed = 1;
    config.area = (struct rho_extent){0.0f, 4000.0f, -1000.0f, 1500.0f};
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, &config), RHO_OK);
    for (int k = 0; k < SCANS; k++) {
        push_clutter(k);
    }
    assert_int_equal(rho_initiator_search(&initiator, RHO_SEARCH_BATCH), RHO_OK);
}

static void the_work_of_a_clutter_window_is_within_its_budget(void **state)
{
    (void)state;
    uint64_t seeds = 0, lookups = 0, distances = 0;
    for (int window = 0; window < WINDOWS; window++) {
        search_clutter();
        seeds += initiator.work.seeds;
        lookups += initiator.work.window.lookups;
        distances += initiator.work.window.distances;
    }
    print_message("a window at %d clutter plots a scan: %u seeds, %u look-ups, %u distances\n",
                  PLOTS, (unsigned)(seeds / WINDOWS), (unsigned)(lookups / WINDOWS),
                  (unsigned)(distances / WINDOWS));
    assert_in_range(seeds / WINDOWS, 10000, 25000);
    assert_in_range(lookups / WINDOWS, seeds / WINDOWS, 60000);
    assert_in_range(distances / WINDOWS, 1000, 50000);
}

static void an_initiator_of_the_embedded_profile_fits_66_kib(void **state)
{
    (void)state;
    assert_true(sizeof(struct rho_initiator) <= RHO_RAM_INITIATOR_BYTES);
#ifndef RHO_PROFILE_WORKSTATION
    assert_int_equal(RHO_MAX_SCANS, 7);
    assert_int_equal(RHO_MAX_PLOTS, 256);
    assert_true(sizeof(struct rho_initiator) <= 66 * 1024);
#endif
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_work_of_a_clutter_window_is_within_its_budget),
        cmocka_unit_test(an_initiator_of_the_embedded_profile_fits_66_kib),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
