/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "rhotrack/window.h"

#define PLOTS 60

static struct rho_window window, before;
static struct rho_plot plots[RHO_MAX_PLOTS + 10];
static uint8_t fates[RHO_MAX_PLOTS + 10];
static uint32_t seed = 1;

static float uniform(float from, float to)
{
    seed = seed * 1664525u + 1013904223u;
    return from + (to - from) * (float)(seed >> 8) / 16777216.0f;
}

static struct rho_scan scan_of(int64_t time_us, uint32_t count)
{
    memset(fates, RHO_FATE_HELD, sizeof fates);
    return (struct rho_scan){.time_us = time_us, .num_plots = count, .plots = plots};
}

static void place(uint32_t i, float x_m, float y_m, float sigma_m)
{
    plots[i] = (struct rho_plot){
        .x_m = x_m, .y_m = y_m, .sigma_range_m = sigma_m, .sigma_cross_m = sigma_m};
}

static uint32_t push(int64_t time_us, uint32_t count)
{
    uint32_t unused = 0;
    struct rho_scan scan = scan_of(time_us, count);
    assert_int_equal(rho_window_push(&window, &scan, NULL, fates, &unused), RHO_OK);
    return unused;
}

static void start(unsigned scans)
{
    assert_int_equal(rho_window_init(&window, sizeof window, scans, NULL, 0.0f), RHO_OK);
}

static void init_refuses_and_changes_nothing(void **state)
{
    (void)state;
    const struct rho_extent empty = {1.0f, 1.0f, 0.0f, 2.0f};
    const struct rho_extent not_a_number = {NAN, 1.0f, 0.0f, 2.0f};
    const struct rho_extent huge = {0.0f, 3.0e6f, 0.0f, 2.0f};
    memset(&window, 0x5a, sizeof window);
    before = window;
    assert_int_equal(rho_window_init(NULL, sizeof window, 3, NULL, 0.0f), RHO_ERROR_NULL);
    assert_int_equal(rho_window_init(&window, sizeof window - 1, 3, NULL, 0.0f), RHO_ERROR_SIZE);
    assert_int_equal(rho_window_init(&window, sizeof window, 0, NULL, 0.0f), RHO_ERROR_CONFIG);
    assert_int_equal(rho_window_init(&window, sizeof window, RHO_MAX_SCANS + 1, NULL, 0.0f),
                     RHO_ERROR_CONFIG);
    assert_int_equal(rho_window_init(&window, sizeof window, 3, &empty, 0.0f), RHO_ERROR_CONFIG);
    assert_int_equal(rho_window_init(&window, sizeof window, 3, &not_a_number, 0.0f),
                     RHO_ERROR_CONFIG);
    assert_int_equal(rho_window_init(&window, sizeof window, 3, &huge, 0.0f), RHO_ERROR_CONFIG);
    assert_int_equal(rho_window_init(&window, sizeof window, 3, NULL, -1.0f), RHO_ERROR_CONFIG);
    assert_int_equal(rho_window_init(&window, sizeof window, 3, NULL, NAN), RHO_ERROR_CONFIG);
    assert_memory_equal(&window, &before, sizeof window);
}

static void push_refuses_and_changes_nothing(void **state)
{
    (void)state;
    uint32_t unused = 7;
    struct rho_scan scan = scan_of(5, 1);
    place(0, 1.0f, 2.0f, 1.0f);
    memset(&window, 0, sizeof window);
    assert_int_equal(rho_window_push(&window, &scan, NULL, fates, &unused), RHO_ERROR_STATE);
    start(3);
    push(10, 1);
    before = window;
    assert_int_equal(rho_window_push(NULL, &scan, NULL, fates, &unused), RHO_ERROR_NULL);
    assert_int_equal(rho_window_push(&window, NULL, NULL, fates, &unused), RHO_ERROR_NULL);
    assert_int_equal(rho_window_push(&window, &scan, NULL, NULL, &unused), RHO_ERROR_NULL);
    assert_int_equal(rho_window_push(&window, &scan, NULL, fates, NULL), RHO_ERROR_NULL);
    scan.plots = NULL;
    assert_int_equal(rho_window_push(&window, &scan, NULL, fates, &unused), RHO_ERROR_NULL);
    scan.plots = plots;
    assert_int_equal(rho_window_push(&window, &scan, NULL, fates, &unused),
                     RHO_ERROR_STATE); /* older */
    assert_false(rho_window_accepts(&window, 9));
    assert_true(rho_window_accepts(&window, 10));
    assert_memory_equal(&window, &before, sizeof window);
    assert_int_equal(unused, 7);
}

static void the_oldest_scan_leaves_and_its_unused_plots_count(void **state)
{
    (void)state;
    start(3);
    for (uint32_t i = 0; i < 5; i++) {
        place(i, (float)i, 0.0f, 1.0f);
    }
    for (int k = 0; k < 3; k++) {
        assert_int_equal(push(k, (uint32_t)k + 1), 0);
    }
    rho_window_scan_at(&window, 0)->num_unused = 0; /* its plot started a track */
    assert_int_equal(push(3, 4), 0);
    assert_int_equal(push(4, 0), 2);
    assert_int_equal(window.num_scans, 3);
    assert_int_equal(rho_window_scan_at(&window, 0)->time_us, 2);
    assert_int_equal(rho_window_scan_at(&window, 1)->num_plots, 4);
    assert_int_equal(rho_window_scan_at(&window, 2)->num_plots, 0);
}

static void plots_beyond_the_capacity_have_no_room(void **state)
{
    (void)state;
    start(1);
    for (uint32_t i = 0; i < RHO_MAX_PLOTS + 10; i++) {
        place(i, uniform(-100.0f, 100.0f), uniform(-100.0f, 100.0f), 1.0f);
    }
    struct rho_scan scan = scan_of(0, RHO_MAX_PLOTS + 10);
    uint32_t unused = 0;
    fates[3] = RHO_FATE_CLAIMED;
    assert_int_equal(rho_window_push(&window, &scan, NULL, fates, &unused), RHO_OK);
    assert_int_equal(rho_window_scan_at(&window, 0)->num_plots, RHO_MAX_PLOTS);
    assert_int_equal(fates[3], RHO_FATE_CLAIMED);
    assert_int_equal(fates[RHO_MAX_PLOTS], RHO_FATE_HELD); /* in the place of the claimed one */
    for (uint32_t i = RHO_MAX_PLOTS + 1; i < RHO_MAX_PLOTS + 10; i++) {
        assert_int_equal(fates[i], RHO_FATE_NO_ROOM);
    }
}

/* The definition, without bins. */
static int brute_nearest(const struct rho_window_scan *scan, const struct rho_window_query *query)
{
    int best = -1;
    float best_d2 = query->gate_chi2, best_variance = 1.0f;
    for (int i = 0; i < scan->num_plots; i++) {
        const struct rho_window_plot *plot = &scan->plots[i];
        float dx = plot->x_m - query->x_m - query->vx_mps * plot->offset_s;
        float dy = plot->y_m - query->y_m - query->vy_mps * plot->offset_s;
        float d2 = dx * dx + dy * dy;
        float variance = query->variance_m2 + query->sigma_factor * plot->sigma_m * plot->sigma_m;
        if (d2 * best_variance < best_d2 * variance && !(plot->flags & query->skip_flags)) {
            best = i;
            best_d2 = d2;
            best_variance = variance;
        }
    }
    return best;
}

static struct rho_window_query random_query(const struct rho_window_scan *scan)
{
    struct rho_window_query query = {
        .x_m = uniform(-1500.0f, 1500.0f),
        .y_m = uniform(-900.0f, 900.0f),
        .vx_mps = uniform(-50.0f, 50.0f),
        .vy_mps = uniform(-50.0f, 50.0f),
        .variance_m2 = uniform(0.0f, 900.0f),
        .sigma_factor = uniform(0.5f, 2.0f),
        .gate_chi2 = 13.8f,
        .skip_flags = seed & 0x10000u ? RHO_WINDOW_TAKEN : 0,
    };
    query.reach_m =
        sqrtf(query.gate_chi2 *
              (query.variance_m2 + query.sigma_factor * scan->sigma_max_m * scan->sigma_max_m));
    return query;
}

static void scatter(float spread_m)
{
    for (uint32_t i = 0; i < PLOTS; i++) {
        place(i, uniform(-spread_m, spread_m), uniform(-spread_m, spread_m), uniform(1.0f, 60.0f));
        plots[i].offset_us = (int32_t)uniform(-2e6f, 2e6f);
    }
}

static void the_nearest_plot_is_the_nearest_of_all(void **state)
{
    (void)state;
    const struct rho_extent area = {-500.0f, 700.0f, -100.0f, 100.0f}; /* many plots lie outside */
    int found = 0;
    for (int round = 0; round < 200; round++) {
        const struct rho_extent *fixed = round % 2 ? &area : NULL;
        assert_int_equal(rho_window_init(&window, sizeof window, 3, fixed, 0.0f), RHO_OK);
        scatter(round % 5 == 0 ? 0.0f : 1200.0f);
        push(0, PLOTS);
        struct rho_window_scan *scan = rho_window_scan_at(&window, 0);
        scan->plots[7].flags = RHO_WINDOW_TAKEN;
        for (int i = 0; i < 50; i++) {
            struct rho_window_work work = {0};
            struct rho_window_query query = random_query(scan);
            int nearest = rho_window_nearest(scan, &query, &work);
            assert_int_equal(nearest, brute_nearest(scan, &query));
            assert_int_equal(work.lookups, 1);
            found += nearest >= 0;
        }
    }
    assert_in_range(found, 1000, 9900);
}

static void bins_save_distance_tests(void **state)
{
    (void)state;
    struct rho_window_work work = {0};
    start(1);
    for (uint32_t i = 0; i < 200; i++) {
        place(i, uniform(0.0f, 10000.0f), uniform(0.0f, 10000.0f), 10.0f);
    }
    push(0, 200);
    for (int i = 0; i < 100; i++) {
        struct rho_window_query query = {.x_m = uniform(0.0f, 10000.0f),
                                         .y_m = uniform(0.0f, 10000.0f),
                                         .sigma_factor = 1.0f,
                                         .gate_chi2 = 13.8f,
                                         .reach_m = 40.0f};
        (void)rho_window_nearest(rho_window_scan_at(&window, 0), &query, &work);
    }
    assert_in_range(work.distances, 1, 200 * 100 / 50);
}

static void rows_and_sigmas_are_kept(void **state)
{
    (void)state;
    start(2);
    scatter(500.0f);
    plots[5].sigma_cross_m = 99.0f;
    push(0, PLOTS);
    const struct rho_window_scan *scan = rho_window_scan_at(&window, 0);
    for (int i = 0; i < scan->num_plots; i++) {
        const struct rho_window_plot *held = &scan->plots[i];
        assert_float_equal(held->x_m, plots[held->row].x_m, 0.0f);
        assert_float_equal(held->offset_s, (float)plots[held->row].offset_us * 1e-6f, 1e-9f);
        assert_float_equal(held->sigma_m, rho_plot_sigma_m(&plots[held->row]), 0.0f);
    }
    assert_float_equal(scan->sigma_max_m, 99.0f, 0.0f);
}

static void an_extent_grows_and_has_sides(void **state)
{
    (void)state;
    struct rho_extent extent = {1.0f, 0.0f, 1.0f, 0.0f};
    rho_extent_add(&extent, -3.0f, 4.0f);
    assert_float_equal(rho_extent_area_m2(&extent, 0.0f), 0.0f, 0.0f);
    rho_extent_add(&extent, 5.0f, 1.0f);
    assert_float_equal(rho_extent_width_m(&extent, 0.0f), 8.0f, 0.0f);
    assert_float_equal(rho_extent_height_m(&extent, 0.0f), 3.0f, 0.0f);
    assert_float_equal(rho_extent_area_m2(&extent, 5.0f), 40.0f, 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(init_refuses_and_changes_nothing),
        cmocka_unit_test(push_refuses_and_changes_nothing),
        cmocka_unit_test(the_oldest_scan_leaves_and_its_unused_plots_count),
        cmocka_unit_test(plots_beyond_the_capacity_have_no_room),
        cmocka_unit_test(the_nearest_plot_is_the_nearest_of_all),
        cmocka_unit_test(bins_save_distance_tests),
        cmocka_unit_test(rows_and_sigmas_are_kept),
        cmocka_unit_test(an_extent_grows_and_has_sides),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
