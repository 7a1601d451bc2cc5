/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "rhotrack/initiator.h"
#include "vectors/initiator_vectors.h"

#define SCORE_TOLERANCE_NAT 0.002 /* float logarithms and determinants differ from double ones */
#define PLACE_TOLERANCE_M 0.02f
#define MAX_SCAN_PLOTS 100

static struct rho_initiator initiator, other;
static struct rho_plot plots[MAX_SCAN_PLOTS];
static uint8_t fates[MAX_SCAN_PLOTS];
static uint32_t num_plots, seed = 1;

static float uniform(float from, float to)
{
    seed = seed * 1664525u + 1013904223u;
    return from + (to - from) * (float)(seed >> 8) / 16777216.0f;
}

static struct rho_initiator_config test_config(void)
{
    struct rho_initiator_config config;
    rho_initiator_config_default(&config);
    config.min_scans = 4;
    config.v_max_mps = 400.0f;
    config.score_min_nat = -3.0f;
    config.area_is_fixed = 1;
    config.area = (struct rho_extent){-2500.0f, 2500.0f, -2500.0f, 2500.0f};
    return config;
}

static void init_initiator(const struct rho_initiator_config *config)
{
    num_plots = 0;
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, config), RHO_OK);
}

static void add_plot(float x_m, float y_m)
{
    plots[num_plots++] =
        (struct rho_plot){.x_m = x_m, .y_m = y_m, .sigma_range_m = 10.0f, .sigma_cross_m = 10.0f};
}

static void push_scan(double t_s)
{
    uint32_t unused = 0;
    struct rho_scan scan = {
        .time_us = (int64_t)(t_s * 1e6), .num_plots = num_plots, .plots = plots};
    memset(fates, RHO_FATE_HELD, sizeof fates);
    assert_int_equal(rho_initiator_push(&initiator, &scan, NULL, fates, &unused), RHO_OK);
    num_plots = 0;
}

static void search_window(enum rho_search kind)
{
    assert_int_equal(rho_initiator_search(&initiator, kind), RHO_OK);
}

/* A target's place and velocity at the first scan. */
struct path {
    float x_m, vx_mps, y_m, vy_mps;
};

static void push_scans_of_paths(const struct path *paths, int count, int scans)
{
    for (int k = 0; k < scans; k++) {
        float t_s = 2.0f * (float)k;
        for (int i = 0; i < count; i++) {
            add_plot(paths[i].x_m + paths[i].vx_mps * t_s + uniform(-8.0f, 8.0f),
                     paths[i].y_m + paths[i].vy_mps * t_s + uniform(-8.0f, 8.0f));
        }
        push_scan(t_s);
    }
}

static int count_found(const struct path *path, float span_s)
{
    int found = 0;
    for (unsigned i = 0; i < initiator.num_candidates; i++) {
        const struct rho_candidate *track = &initiator.candidates[i];
        found += fabsf(track->x_m - path->x_m - path->vx_mps * span_s) < 25.0f &&
                 fabsf(track->y_m - path->y_m - path->vy_mps * span_s) < 25.0f &&
                 fabsf(track->vx_mps - path->vx_mps) < 6.0f &&
                 fabsf(track->vy_mps - path->vy_mps) < 6.0f;
    }
    return found;
}

static void expect_all_found(const struct path *paths, int count)
{
    struct rho_initiator_config config = test_config();
    init_initiator(&config);
    push_scans_of_paths(paths, count, 7);
    search_window(RHO_SEARCH_BATCH);
    assert_int_equal(initiator.num_candidates, count);
    for (int i = 0; i < count; i++) {
        assert_int_equal(count_found(&paths[i], 12.0f), 1);
    }
}

static void expect_config_refused(const struct rho_initiator_config *config)
{
    other = initiator;
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, config), RHO_ERROR_CONFIG);
    assert_memory_equal(&initiator, &other, sizeof initiator);
}

#define REFUSE_WITH(field, value)                                                                  \
    do {                                                                                           \
        struct rho_initiator_config bad = test_config();                                           \
        bad.field = (value);                                                                       \
        expect_config_refused(&bad);                                                               \
    } while (0)

static void init_refuses_every_bad_parameter(void **state)
{
    (void)state;
    struct rho_initiator_config config = test_config();
    memset(&initiator, 0x33, sizeof initiator);
    assert_int_equal(rho_initiator_init(NULL, sizeof initiator, &config), RHO_ERROR_NULL);
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_initiator_init(&initiator, 12, &config), RHO_ERROR_SIZE);
    REFUSE_WITH(scans, 2);
    REFUSE_WITH(scans, RHO_MAX_SCANS + 1);
    REFUSE_WITH(min_scans, 2);
    REFUSE_WITH(min_scans, 8);
    REFUSE_WITH(v_min_mps, -1.0f);
    REFUSE_WITH(v_min_mps, 400.0f);
    REFUSE_WITH(v_min_mps, NAN);
    REFUSE_WITH(v_max_mps, INFINITY);
    REFUSE_WITH(v_max_mps, 1e-30f);
    config.v_min_mps = 0.0f;
    config.v_max_mps = 0.0099f;
    expect_config_refused(&config);
    config.v_max_mps = 0.0101f;
    assert_int_equal(rho_initiator_init(&other, sizeof other, &config), RHO_OK);
    REFUSE_WITH(false_tracks_per_hour, -5.0f);
    REFUSE_WITH(false_tracks_per_hour, NAN);
    REFUSE_WITH(false_tracks_per_hour, 1e-7f);
    REFUSE_WITH(false_tracks_per_hour, 2e6f);
    REFUSE_WITH(pd, 0.0f);
    REFUSE_WITH(pd, 1.0f);
    REFUSE_WITH(pd, NAN);
    REFUSE_WITH(score_min_nat, NAN);
    REFUSE_WITH(process_noise_mps2, -1.0f);
    REFUSE_WITH(turn_mps2, -1.0f);
    REFUSE_WITH(area.x_max_m, -2500.0f);
    REFUSE_WITH(area.y_min_m, NAN);
}

static void calls_without_init_or_scans_are_refused(void **state)
{
    (void)state;
    uint32_t unused = 0;
    struct rho_scan scan = {0};
    memset(&initiator, 0, sizeof initiator);
    assert_int_equal(rho_initiator_search(NULL, RHO_SEARCH_BATCH), RHO_ERROR_NULL);
    assert_int_equal(rho_initiator_search(&initiator, RHO_SEARCH_BATCH), RHO_ERROR_STATE);
    assert_int_equal(rho_initiator_push(NULL, &scan, NULL, NULL, &unused), RHO_ERROR_NULL);
    assert_int_equal(rho_initiator_push(&initiator, &scan, NULL, NULL, &unused), RHO_ERROR_STATE);
    assert_false(rho_initiator_accepts(&initiator, 0));
    struct rho_initiator_config config = test_config();
    init_initiator(&config);
    search_window(RHO_SEARCH_BATCH); /* a search without any scan */
    assert_int_equal(initiator.num_candidates, 0);
    assert_float_equal(rho_initiator_density(&initiator, 0, 0.0f, 0.0f), 0.0f, 0.0f);
}

static void push_one_scan_of_vector(size_t vector, int scan)
{
    if (initiator_vectors[vector].mask >> scan & 1u) {
        add_plot((float)initiator_vectors[vector].x_m[scan],
                 (float)initiator_vectors[vector].y_m[scan]);
        plots[0].sigma_range_m = plots[0].sigma_cross_m =
            (float)initiator_vectors[vector].sigma_m[scan];
    }
    push_scan(initiator_vectors[vector].t_s[scan]);
}

static void scores_and_fits_agree_with_the_reference(void **state)
{
    (void)state;
    struct rho_initiator_config config;
    rho_initiator_config_default(&config);
    config.pd = VECTOR_PD;
    config.v_max_mps = VECTOR_V_MAX_MPS;
    config.score_min_nat = -1000.0f;
    config.area_is_fixed = 1;
    config.area = (struct rho_extent){-VECTOR_SIDE_M, VECTOR_SIDE_M, -VECTOR_SIDE_M, VECTOR_SIDE_M};
    for (size_t i = 0; i < sizeof initiator_vectors / sizeof initiator_vectors[0]; i++) {
        config.process_noise_mps2 = (float)initiator_vectors[i].process_noise_mps2;
        config.min_scans = 4;
        init_initiator(&config);
        for (int k = 0; k < initiator_vectors[i].num_scans; k++) {
            push_one_scan_of_vector(i, k);
        }
        search_window(RHO_SEARCH_BATCH);
        assert_int_equal(initiator.num_candidates, 1);
        const struct rho_candidate *track = &initiator.candidates[0];
        assert_int_equal(track->mask, initiator_vectors[i].mask);
        assert_true(fabs(track->score_mnat * 1e-3 - initiator_vectors[i].score_nat) <
                    SCORE_TOLERANCE_NAT);
        assert_float_equal(track->x_m, initiator_vectors[i].x_last_m, PLACE_TOLERANCE_M);
        assert_float_equal(track->y_m, initiator_vectors[i].y_last_m, PLACE_TOLERANCE_M);
        assert_float_equal(track->vx_mps, initiator_vectors[i].vx_mps, PLACE_TOLERANCE_M);
        assert_float_equal(track->vy_mps, initiator_vectors[i].vy_mps, PLACE_TOLERANCE_M);
    }
}

static void one_target_is_found_in_every_direction(void **state)
{
    (void)state;
    for (int i = 0; i < 72; i++) {
        float heading = (float)i * 0.0872664626f;
        struct path path = {-1200.0f * cosf(heading), 200.0f * cosf(heading),
                            -1200.0f * sinf(heading), 200.0f * sinf(heading)};
        expect_all_found(&path, 1);
    }
}

static void two_near_targets_are_found_as_two_tracks(void **state)
{
    (void)state;
    static const struct path pairs[][2] = {
        {{-1500, 250, 0, 0}, {-1500, 250, 100, 0}},             /* parallel, 100 m apart */
        {{-1500, 250, 0, 0}, {-1500, 250, 60, 0}},              /* parallel, six sigmas apart */
        {{-1500, 250, -130, 21.9f}, {-1500, 250, 130, -21.9f}}, /* crossing at 10 degrees */
        {{-1500, 250, 0, 0}, {0, 0, -1500, 250}},               /* crossing at 90 degrees */
        /* on one line, opposite directions */
        {{-1500, 250, 300, 0}, {1500, -250, 300, 0}},
        /* on one line, one after the other */
        {{-1500, 250, 300, 0}, {-1200, 250, 300, 0}},
        {{-1500, 250, 500, 0}, {-1500, 250, -500, 0}}, /* mirrored in the x axis */
    };
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        expect_all_found(pairs[i], 2);
    }
}

static void a_target_is_found_with_misses_and_unequal_intervals(void **state)
{
    (void)state;
    static const double times_s[7] = {0.0, 1.0, 4.0, 4.5, 9.0, 11.0, 12.0};
    struct rho_initiator_config config = test_config();
    init_initiator(&config);
    for (int k = 0; k < 7; k++) {
        if (k != 2 && k != 5) {
            add_plot(-1000.0f + 200.0f * (float)times_s[k], 100.0f);
        }
        push_scan(times_s[k]);
    }
    search_window(RHO_SEARCH_BATCH);
    assert_int_equal(initiator.num_candidates, 1);
    assert_int_equal(initiator.candidates[0].mask, 0x5b);
    assert_int_equal(initiator.candidates[0].hits, 5);
    assert_float_equal(initiator.candidates[0].x_m, 1400.0f, 1.0f);
}

static void the_longest_window_is_searched_completely(void **state)
{
    (void)state;
    struct rho_initiator_config config = test_config();
    const struct path path = {-2400, 150, 0, 0};
    config.scans = RHO_MAX_SCANS;
    config.min_scans = RHO_MAX_SCANS;
    init_initiator(&config);
    push_scans_of_paths(&path, 1, RHO_MAX_SCANS + 3);
    search_window(RHO_SEARCH_BATCH);
    assert_int_equal(initiator.num_candidates, 1);
    assert_int_equal(initiator.candidates[0].hits, RHO_MAX_SCANS);
    assert_int_equal(count_found(&path, 2.0f * (RHO_MAX_SCANS + 2)), 1);
}

static void plots_own_times_are_used_in_the_fit(void **state)
{
    (void)state;
    struct rho_initiator_config config = test_config();
    init_initiator(&config);
    for (int k = 0; k < 7; k++) {
        int32_t offset_us = (int32_t)uniform(0.0f, 1.9e6f);
        add_plot(-1500.0f + 300.0f * (2.0f * (float)k + (float)offset_us * 1e-6f), 0.0f);
        plots[0].offset_us = offset_us;
        push_scan(2.0 * k);
    }
    search_window(RHO_SEARCH_BATCH);
    assert_int_equal(initiator.num_candidates, 1);
    assert_int_equal(initiator.candidates[0].hits, 7);
    /* at the time of the newest scan */
    assert_float_equal(initiator.candidates[0].x_m, 2100.0f, 2.0f);
    assert_float_equal(initiator.candidates[0].vx_mps, 300.0f, 0.5f);
}

static void targets_too_slow_too_fast_or_with_few_plots_are_not_found(void **state)
{
    (void)state;
    struct rho_initiator_config config = test_config();
    const struct path slow = {0, 80, 0, 0}, fast = {-2400, 410, 0, 0}, fine = {-1500, 250, 0, 0};
    config.v_min_mps = 100.0f;
    init_initiator(&config);
    push_scans_of_paths(&slow, 1, 7);
    search_window(RHO_SEARCH_BATCH);
    assert_int_equal(initiator.num_candidates, 0);
    init_initiator(&config);
    push_scans_of_paths(&fast, 1, 7);
    search_window(RHO_SEARCH_BATCH);
    assert_int_equal(initiator.num_candidates, 0);
    init_initiator(&config);
    push_scans_of_paths(&fine, 1, 3);
    search_window(RHO_SEARCH_BATCH);
    assert_int_equal(initiator.num_candidates, 0);
}

static void process_noise_finds_a_turning_target(void **state)
{
    (void)state;
    struct rho_initiator_config config = test_config();
    unsigned found[2];
    config.min_scans = 7;
    for (int mode = 0; mode < 2; mode++) {
        float x_m = -1000.0f, y_m = 0.0f, heading = 0.0f;
        config.process_noise_mps2 = mode ? 5.0f : 0.0f;
        init_initiator(&config);
        for (int k = 0; k < 7; k++) {
            add_plot(x_m, y_m);
            push_scan(2.0 * k);
            heading += 0.06f;
            x_m += 400.0f * cosf(heading);
            y_m += 400.0f * sinf(heading);
        }
        search_window(RHO_SEARCH_BATCH);
        found[mode] = initiator.num_candidates;
    }
    assert_int_equal(found[0], 0);
    assert_int_equal(found[1], 1);
}

static void a_streaming_search_needs_a_plot_of_the_newest_scan(void **state)
{
    (void)state;
    struct rho_initiator_config config = test_config();
    const struct path path = {-1500, 250, 0, 0};
    init_initiator(&config);
    push_scans_of_paths(&path, 1, 5);
    search_window(RHO_SEARCH_NEWEST);
    assert_int_equal(initiator.num_candidates, 1);
    push_scan(10.0); /* a scan without plots */
    search_window(RHO_SEARCH_NEWEST);
    assert_int_equal(initiator.num_candidates, 0);
    search_window(RHO_SEARCH_BATCH);
    assert_int_equal(initiator.num_candidates, 1);
}

static void consumed_plots_start_no_second_track(void **state)
{
    (void)state;
    struct rho_initiator_config config = test_config();
    const struct path path = {-1500, 250, 0, 0};
    init_initiator(&config);
    push_scans_of_paths(&path, 1, 6);
    search_window(RHO_SEARCH_BATCH);
    struct rho_candidate track = initiator.candidates[0];
    assert_int_equal(rho_initiator_consume(&initiator, &track), 6);
    assert_int_equal(rho_initiator_consume(&initiator, &track), 0);
    search_window(RHO_SEARCH_BATCH);
    assert_int_equal(initiator.num_candidates, 0);
    assert_int_equal(rho_window_scan_at(&initiator.window, 0)->num_unused, 0);
}

static void min_scans_0_requires_more_votes_in_denser_clutter(void **state)
{
    (void)state;
    struct rho_initiator_config config = test_config();
    unsigned wanted[3];
    config.min_scans = 0;
    for (int density = 0; density < 3; density++) {
        init_initiator(&config);
        for (int k = 0; k < 7; k++) {
            for (int i = 0; i < (density == 0 ? 1 : density == 1 ? 20 : 90); i++) {
                add_plot(uniform(-2500.0f, 2500.0f), uniform(-2500.0f, 2500.0f));
            }
            push_scan(2.0 * k);
        }
        search_window(RHO_SEARCH_BATCH);
        wanted[density] = initiator.min_scans;
    }
    assert_int_equal(wanted[0], 3);
    assert_in_range(wanted[1], 4, 5);
    assert_in_range(wanted[2], wanted[1] + 1, 7);
}

static void the_density_is_higher_in_a_patch_of_clutter(void **state)
{
    (void)state;
    struct rho_initiator_config config = test_config();
    for (int patchy = 0; patchy < 2; patchy++) {
        init_initiator(&config);
        for (int k = 0; k < 7; k++) {
            for (int i = 0; i < 90; i++) {
                int inside = patchy && i < 45;
                add_plot(uniform(inside ? 1250.0f : -2500.0f, 2500.0f),
                         uniform(inside ? 1250.0f : -2500.0f, 2500.0f));
            }
            push_scan(2.0 * k);
        }
        search_window(RHO_SEARCH_BATCH);
        float mean = 90.0f / 25e6f;
        float dense = rho_initiator_density(&initiator, 0, 2000.0f, 2000.0f) / mean;
        float thin = rho_initiator_density(&initiator, 0, -2000.0f, -2000.0f) / mean;
        assert_in_range((int)(dense * 100.0f), patchy ? 400 : 85, patchy ? 1000 : 115);
        assert_in_range((int)(thin * 100.0f), patchy ? 30 : 85, patchy ? 70 : 115);
    }
}

static void a_full_list_keeps_the_best_candidates_and_counts_the_others(void **state)
{
    (void)state;
    struct rho_initiator_config config = test_config();
    const struct path path = {-2400, 390, 2400, 0};
    config.min_scans = 3;
    config.scans = 3;
    config.score_min_nat = -1000.0f;
    init_initiator(&config);
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 90; i++) {
            add_plot(uniform(-600.0f, 600.0f), uniform(-600.0f, 600.0f));
        }
        add_plot(path.x_m + path.vx_mps * 2.0f * (float)k, path.y_m);
        push_scan(2.0 * k);
    }
    search_window(RHO_SEARCH_BATCH);
    assert_true(initiator.work.fits > RHO_MAX_CANDIDATES);
    assert_true(initiator.work.candidates_dropped > 0);
    assert_in_range(initiator.num_candidates, 1, RHO_MAX_CANDIDATES);
    assert_int_equal(count_found(&path, 4.0f), 1); /* in thin clutter, with the best score of all */
    for (unsigned i = 0; i < initiator.num_candidates; i++) {
        assert_int_equal(initiator.candidates[i].hits, 3);
    }
}

static void candidates_share_one_plot_at_most(void **state)
{
    (void)state;
    struct rho_initiator_config config = test_config();
    config.score_min_nat = -1000.0f;
    init_initiator(&config);
    for (int k = 0; k < 7; k++) {
        for (int i = 0; i < 80; i++) {
            add_plot(uniform(-1000.0f, 1000.0f), uniform(-1000.0f, 1000.0f));
        }
        push_scan(2.0 * k);
    }
    search_window(RHO_SEARCH_BATCH);
    assert_true(initiator.num_candidates > 1);
    for (unsigned i = 0; i < initiator.num_candidates; i++) {
        for (unsigned j = 0; j < i; j++) {
            const struct rho_candidate *a = &initiator.candidates[i], *b = &initiator.candidates[j];
            int shared = 0;
            for (unsigned m = 0; m < 7; m++) {
                shared += (a->mask & b->mask) >> m & 1u && a->plot[m] == b->plot[m];
            }
            assert_true(shared <= 1);
        }
    }
}

static void the_same_scans_give_the_same_bytes(void **state)
{
    (void)state;
    struct rho_initiator_config config = test_config();
    const struct path paths[2] = {{-1500, 250, 0, 0}, {0, 0, -1500, 250}};
    for (int run = 0; run < 2; run++) {
        seed = 99;
        init_initiator(&config);
        push_scans_of_paths(paths, 2, 7);
        search_window(RHO_SEARCH_BATCH);
        if (run == 0) {
            other = initiator;
        }
    }
    assert_memory_equal(&initiator, &other, sizeof initiator);
}

static void scans_of_equal_times_make_no_track(void **state)
{
    (void)state;
    struct rho_initiator_config config = test_config();
    config.min_scans = 3;
    init_initiator(&config);
    for (int k = 0; k < 7; k++) {
        add_plot(100.0f * (float)k, 0.0f);
        push_scan(5.0);
    }
    search_window(RHO_SEARCH_BATCH);
    assert_int_equal(initiator.num_candidates, 0);
    assert_int_equal(initiator.work.seeds, 0);
}

static const struct path straight = {-500.0f, 100.0f, 0.0f, 0.0f};

/*
 * Changed speeds apply at once, another window length or area empties the window, and refused
 * configurations change nothing.
 */
static void reconfiguring_keeps_the_window_unless_length_or_area_change(void **state)
{
    struct rho_initiator_config config = test_config();
    (void)state;
    config.v_max_mps = 50.0f;
    init_initiator(&config);
    push_scans_of_paths(&straight, 1, 6);
    search_window(RHO_SEARCH_NEWEST);
    assert_int_equal(initiator.num_candidates, 0);
    config.v_max_mps = 400.0f;
    assert_int_equal(rho_initiator_reconfigure(&initiator, &config), RHO_OK);
    assert_int_equal(initiator.window.num_scans, 6);
    search_window(RHO_SEARCH_NEWEST);
    assert_int_equal(initiator.num_candidates, 1);

    memcpy(&other, &initiator, sizeof other);
    config.pd = 2.0f;
    assert_int_equal(rho_initiator_reconfigure(&initiator, &config), RHO_ERROR_CONFIG);
    config.pd = 0.9f;
    config.area.x_max_m = -9999.0f;
    assert_int_equal(rho_initiator_reconfigure(&initiator, &config), RHO_ERROR_CONFIG);
    assert_int_equal(rho_initiator_reconfigure(&initiator, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_initiator_reconfigure(NULL, &config), RHO_ERROR_NULL);
    assert_memory_equal(&other, &initiator, sizeof other);

    config = test_config();
    config.scans = 5;
    assert_int_equal(rho_initiator_reconfigure(&initiator, &config), RHO_OK);
    assert_int_equal(initiator.window.num_scans, 0);
    assert_int_equal(initiator.window.scans_max, 5);
    assert_int_equal(initiator.num_candidates, 0);
    config.area.x_max_m = 3000.0f;
    push_scans_of_paths(&straight, 1, 5);
    assert_int_equal(rho_initiator_reconfigure(&initiator, &config), RHO_OK);
    assert_int_equal(initiator.window.num_scans, 0);
    assert_true(rho_initiator_is_sound(&initiator));
    push_scans_of_paths(&straight, 1, 5);
    search_window(RHO_SEARCH_NEWEST);
    assert_int_equal(initiator.num_candidates, 1);

    memset(&initiator, 0, sizeof initiator);
    assert_int_equal(rho_initiator_reconfigure(&initiator, &config), RHO_ERROR_STATE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(init_refuses_every_bad_parameter),
        cmocka_unit_test(calls_without_init_or_scans_are_refused),
        cmocka_unit_test(scores_and_fits_agree_with_the_reference),
        cmocka_unit_test(one_target_is_found_in_every_direction),
        cmocka_unit_test(two_near_targets_are_found_as_two_tracks),
        cmocka_unit_test(a_target_is_found_with_misses_and_unequal_intervals),
        cmocka_unit_test(the_longest_window_is_searched_completely),
        cmocka_unit_test(plots_own_times_are_used_in_the_fit),
        cmocka_unit_test(targets_too_slow_too_fast_or_with_few_plots_are_not_found),
        cmocka_unit_test(process_noise_finds_a_turning_target),
        cmocka_unit_test(a_streaming_search_needs_a_plot_of_the_newest_scan),
        cmocka_unit_test(consumed_plots_start_no_second_track),
        cmocka_unit_test(min_scans_0_requires_more_votes_in_denser_clutter),
        cmocka_unit_test(the_density_is_higher_in_a_patch_of_clutter),
        cmocka_unit_test(a_full_list_keeps_the_best_candidates_and_counts_the_others),
        cmocka_unit_test(candidates_share_one_plot_at_most),
        cmocka_unit_test(the_same_scans_give_the_same_bytes),
        cmocka_unit_test(scans_of_equal_times_make_no_track),
        cmocka_unit_test(reconfiguring_keeps_the_window_unless_length_or_area_change),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
