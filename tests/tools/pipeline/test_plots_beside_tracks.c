/* SPDX-License-Identifier: MIT */
/* A body's length is found by plots of tracks of equal velocity at unequal distances. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cjson/cJSON.h>
#include <cmocka.h>

#include "base/random.h"
#include "pipeline/plots_beside_tracks.h"

#define NUM_PLOTS 6

static struct plots_beside_tracks beside;
static struct rho_report report;
static struct rho_plot plots[NUM_PLOTS];

static void start_with_noise(float sigma_range_m, float sigma_cross_m)
{
    memset(&beside, 0, sizeof beside);
    memset(&report, 0, sizeof report);
    report.num_tracks = NUM_PLOTS;
    for (int i = 0; i < NUM_PLOTS; i++) {
        report.tracks[i].status = RHO_TRACK_CONFIRMED;
        report.tracks[i].plot = i;
        report.tracks[i].sigma_mps = 0.5f;
        plots[i] =
            (struct rho_plot){.sigma_range_m = sigma_range_m, .sigma_cross_m = sigma_cross_m};
    }
}

/* Adds a number of scans of plots at random places of a row of this length, or a step apart. */
static struct found_body add_scans(int scans, float length_m, float step_m)
{
    const struct rho_scan scan = {.num_plots = NUM_PLOTS, .plots = plots};
    struct random random = random_start(3, 0, 0);

    for (int i = 0; i < scans; i++) {
        for (int k = 0; k < NUM_PLOTS; k++) {
            plots[k].x_m = (float)k * step_m + length_m * (float)random_uniform(&random);
        }
        plots_beside_tracks_add_scan(&beside, &scan, &report);
    }
    return plots_beside_tracks_find_body(&beside);
}

static void test_bodies(void **state)
{
    struct found_body body;

    (void)state;
    start_with_noise(0.2f, 0.5f);
    body = add_scans(100, 4.4f, 0.0f);
    assert_true(body.body_max_m >= 4.0 && body.body_max_m <= 6.0);
    assert_true(body.distance_m > 3.0 && body.distance_m < 4.4);
    assert_float_equal(body.plots, NUM_PLOTS - 1, 1e-9);
    start_with_noise(5.0f, 10.0f);
    body = add_scans(100, 250.0f, 0.0f);
    assert_true(body.body_max_m >= 200.0 && body.body_max_m <= 300.0);
}

static void test_own_targets(void **state)
{
    (void)state;
    start_with_noise(0.2f, 0.5f);
    assert_float_equal(add_scans(100, 1.0f, 11.0f).body_max_m, 0.0, 0.0); /* a convoy */
    start_with_noise(5.0f, 15.0f);
    assert_float_equal(add_scans(100, 1.0f, 11.0f).body_max_m, 0.0, 0.0); /* not resolved */
    start_with_noise(0.2f, 0.5f);
    assert_float_equal(add_scans(100, 400.0f, 0.0f).body_max_m, 0.0, 0.0); /* a crowd */
    start_with_noise(0.2f, 0.5f);
    for (int i = 0; i < NUM_PLOTS; i++) {
        report.tracks[i].state[RHO_VX] = 3.0f * (float)i;
    }
    assert_float_equal(add_scans(100, 4.4f, 0.0f).body_max_m, 0.0, 0.0); /* they part */
}

static void test_looks(void **state)
{
    (void)state;
    start_with_noise(0.2f, 0.5f);
    assert_float_equal(plots_beside_tracks_find_body(&beside).body_max_m, 0.0, 0.0);
    assert_float_equal(add_scans(8, 4.4f, 0.0f).body_max_m, 0.0, 0.0);
    assert_true(add_scans(8, 4.4f, 0.0f).body_max_m > 0.0);
    start_with_noise(0.2f, 0.5f);
    report.tracks[0].plot = -1;
    report.tracks[1].status = RHO_TRACK_TENTATIVE;
    add_scans(10, 4.4f, 0.0f);
    assert_int_equal(beside.looks, 10 * (NUM_PLOTS - 2));
}

static void test_json(void **state)
{
    const struct found_body body = {6.0, 3.6, 4.5};
    cJSON *object = found_body_json(&body);
    char *text = cJSON_PrintUnformatted(object);

    (void)state;
    assert_string_equal(text, "{\"body_max_m\":6,\"plots\":3.6,\"distance_m\":4.5}");
    cJSON_free(text);
    cJSON_Delete(object);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bodies),
        cmocka_unit_test(test_own_targets),
        cmocka_unit_test(test_looks),
        cmocka_unit_test(test_json),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
