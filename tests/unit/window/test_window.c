/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "rhotrack/detail/measurement.h"
#include "rhotrack/detail/window.h"

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

static void set_plot(uint32_t i, float x_m, float y_m, float sigma_m)
{
    plots[i] = (struct rho_plot){
        .x_m = x_m, .y_m = y_m, .sigma_range_m = sigma_m, .sigma_cross_m = sigma_m};
}

static uint32_t push_scan(int64_t time_us, uint32_t count)
{
    uint32_t unused = 0;
    struct rho_scan scan = scan_of(time_us, count);
    assert_int_equal(rho_window_push(&window, &scan, NULL, fates, &unused), RHO_OK);
    return unused;
}

static void init_window(unsigned scans)
{
    assert_int_equal(rho_window_init(&window, sizeof window, scans, NULL), RHO_OK);
}

static void a_refused_init_changes_nothing(void **state)
{
    (void)state;
    const struct rho_extent empty = {1.0f, 1.0f, 0.0f, 2.0f};
    const struct rho_extent not_a_number = {NAN, 1.0f, 0.0f, 2.0f};
    const struct rho_extent huge = {0.0f, 3.0e6f, 0.0f, 2.0f};
    memset(&window, 0x5a, sizeof window);
    before = window;
    assert_int_equal(rho_window_init(NULL, sizeof window, 3, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_window_init(&window, sizeof window - 1, 3, NULL), RHO_ERROR_SIZE);
    assert_int_equal(rho_window_init(&window, sizeof window, 0, NULL), RHO_ERROR_CONFIG);
    assert_int_equal(rho_window_init(&window, sizeof window, RHO_MAX_SCANS + 1, NULL),
                     RHO_ERROR_CONFIG);
    assert_int_equal(rho_window_init(&window, sizeof window, 3, &empty), RHO_ERROR_CONFIG);
    assert_int_equal(rho_window_init(&window, sizeof window, 3, &not_a_number), RHO_ERROR_CONFIG);
    assert_int_equal(rho_window_init(&window, sizeof window, 3, &huge), RHO_ERROR_CONFIG);
    assert_memory_equal(&window, &before, sizeof window);
}

static void a_refused_push_changes_nothing(void **state)
{
    (void)state;
    uint32_t unused = 7;
    struct rho_scan scan = scan_of(5, 1);
    set_plot(0, 1.0f, 2.0f, 1.0f);
    memset(&window, 0, sizeof window);
    assert_int_equal(rho_window_push(&window, &scan, NULL, fates, &unused), RHO_ERROR_STATE);
    assert_int_equal(rho_window_check_push(&window, &scan, fates, &unused), RHO_ERROR_STATE);
    init_window(3);
    push_scan(10, 1);
    before = window;
    assert_int_equal(rho_window_push(NULL, &scan, NULL, fates, &unused), RHO_ERROR_NULL);
    assert_int_equal(rho_window_push(&window, NULL, NULL, fates, &unused), RHO_ERROR_NULL);
    assert_int_equal(rho_window_push(&window, &scan, NULL, NULL, &unused), RHO_ERROR_NULL);
    assert_int_equal(rho_window_push(&window, &scan, NULL, fates, NULL), RHO_ERROR_NULL);
    scan.plots = NULL;
    assert_int_equal(rho_window_push(&window, &scan, NULL, fates, &unused), RHO_ERROR_NULL);
    assert_int_equal(rho_window_check_push(&window, &scan, fates, &unused), RHO_ERROR_NULL);
    scan.plots = plots;
    assert_int_equal(rho_window_push(&window, &scan, NULL, fates, &unused),
                     RHO_ERROR_STATE); /* older than the newest scan */
    assert_int_equal(rho_window_check_push(&window, &scan, fates, &unused), RHO_ERROR_STATE);
    scan.time_us = 10;
    assert_int_equal(rho_window_check_push(&window, &scan, fates, &unused), RHO_OK);
    assert_false(rho_window_accepts(&window, 9));
    assert_true(rho_window_accepts(&window, 10));
    assert_memory_equal(&window, &before, sizeof window);
    assert_int_equal(unused, 7);
}

static void the_oldest_scan_leaves_and_its_unused_plots_are_counted(void **state)
{
    (void)state;
    init_window(3);
    for (uint32_t i = 0; i < 5; i++) {
        set_plot(i, (float)i, 0.0f, 1.0f);
    }
    for (int k = 0; k < 3; k++) {
        assert_int_equal(push_scan(k, (uint32_t)k + 1), 0);
    }
    /* the plot of the oldest scan started a track */
    rho_window_scan_at(&window, 0)->num_unused = 0;
    assert_int_equal(push_scan(3, 4), 0);
    assert_int_equal(push_scan(4, 0), 2);
    assert_int_equal(window.num_scans, 3);
    assert_int_equal(rho_window_scan_at(&window, 0)->time_us, 2);
    assert_int_equal(rho_window_scan_at(&window, 1)->num_plots, 4);
    assert_int_equal(rho_window_scan_at(&window, 2)->num_plots, 0);
}

static void plots_beyond_the_capacity_get_the_fate_no_room(void **state)
{
    (void)state;
    init_window(1);
    for (uint32_t i = 0; i < RHO_MAX_PLOTS + 10; i++) {
        set_plot(i, uniform(-100.0f, 100.0f), uniform(-100.0f, 100.0f), 1.0f);
    }
    struct rho_scan scan = scan_of(0, RHO_MAX_PLOTS + 10);
    uint32_t unused = 0;
    fates[3] = RHO_FATE_CLAIMED;
    assert_int_equal(rho_window_push(&window, &scan, NULL, fates, &unused), RHO_OK);
    assert_int_equal(rho_window_scan_at(&window, 0)->num_plots, RHO_MAX_PLOTS);
    assert_int_equal(fates[3], RHO_FATE_CLAIMED);
    assert_int_equal(fates[RHO_MAX_PLOTS], RHO_FATE_HELD); /* in the slot of the claimed plot */
    for (uint32_t i = RHO_MAX_PLOTS + 1; i < RHO_MAX_PLOTS + 10; i++) {
        assert_int_equal(fates[i], RHO_FATE_NO_ROOM);
    }
}

#define GATE_CHI2 13.8f

/* The nearest plot by an exhaustive search. */
static int nearest_without_bins(const struct rho_window_scan *scan,
                                const struct rho_window_place *place)
{
    int best = -1;
    float best_d2 = GATE_CHI2, best_variance = 1.0f;
    for (int i = 0; i < scan->num_plots; i++) {
        const struct rho_window_plot *plot = &scan->plots[i];
        float dx = plot->x_m - place->x_m - place->vx_mps * plot->offset_s;
        float dy = plot->y_m - place->y_m - place->vy_mps * plot->offset_s;
        float d2 = dx * dx + dy * dy;
        float sigma_m = rho_window_larger_sigma_m(plot);
        float variance = place->noise.xx_m2 + place->factor * sigma_m * sigma_m;
        if (d2 * best_variance < best_d2 * variance && !(scan->marks[i] & place->skip_flags)) {
            best = i;
            best_d2 = d2;
            best_variance = variance;
        }
    }
    return best;
}

static struct rho_window_place random_straight_place(const struct rho_window_scan *scan)
{
    struct rho_window_place place = {
        .x_m = uniform(-1500.0f, 1500.0f),
        .y_m = uniform(-900.0f, 900.0f),
        .vx_mps = uniform(-50.0f, 50.0f),
        .vy_mps = uniform(-50.0f, 50.0f),
        .noise = {.xx_m2 = uniform(0.0f, 900.0f)},
        .factor = uniform(0.5f, 2.0f),
        .skip_flags = seed & 0x10000u ? RHO_WINDOW_TAKEN : 0,
    };
    place.gate_radius_m = sqrtf(
        GATE_CHI2 * (place.noise.xx_m2 + place.factor * scan->sigma_max_m * scan->sigma_max_m));
    return place;
}

static void scatter_plots(float spread_m)
{
    for (uint32_t i = 0; i < PLOTS; i++) {
        set_plot(i, uniform(-spread_m, spread_m), uniform(-spread_m, spread_m),
                 uniform(1.0f, 60.0f));
        plots[i].offset_us = (int32_t)uniform(-2e6f, 2e6f);
    }
}

static void the_nearest_plot_agrees_with_an_exhaustive_search(void **state)
{
    (void)state;
    const struct rho_extent area = {-500.0f, 700.0f, -100.0f, 100.0f}; /* many plots are outside */
    int found = 0;
    for (int round = 0; round < 200; round++) {
        const struct rho_extent *fixed = round % 2 ? &area : NULL;
        assert_int_equal(rho_window_init(&window, sizeof window, 3, fixed), RHO_OK);
        scatter_plots(round % 5 == 0 ? 0.0f : 1200.0f);
        push_scan(0, PLOTS);
        struct rho_window_scan *scan = rho_window_scan_at(&window, 0);
        scan->marks[7] |= RHO_WINDOW_TAKEN;
        for (int i = 0; i < 50; i++) {
            struct rho_window_work work = {0};
            struct rho_window_place place = random_straight_place(scan);
            int nearest = rho_window_nearest_isotropic(scan, &place, GATE_CHI2, &work);
            assert_int_equal(nearest, nearest_without_bins(scan, &place));
            assert_int_equal(work.lookups, 1);
            found += nearest >= 0;
        }
    }
    assert_in_range(found, 1000, 9900);
}

static void bins_reduce_the_number_of_distance_tests(void **state)
{
    (void)state;
    struct rho_window_work work = {0};
    init_window(1);
    for (uint32_t i = 0; i < 200; i++) {
        set_plot(i, uniform(0.0f, 10000.0f), uniform(0.0f, 10000.0f), 10.0f);
    }
    push_scan(0, 200);
    for (int i = 0; i < 100; i++) {
        struct rho_window_place place = {.x_m = uniform(0.0f, 10000.0f),
                                         .y_m = uniform(0.0f, 10000.0f),
                                         .factor = 1.0f,
                                         .gate_radius_m = 40.0f};
        (void)rho_window_nearest_isotropic(rho_window_scan_at(&window, 0), &place, GATE_CHI2,
                                           &work);
    }
    assert_in_range(work.distances, 1, 200 * 100 / 50);
}

static void plots_keep_their_rows_and_sigmas(void **state)
{
    (void)state;
    init_window(2);
    scatter_plots(500.0f);
    plots[5].sigma_cross_m = 99.0f;
    push_scan(0, PLOTS);
    const struct rho_window_scan *scan = rho_window_scan_at(&window, 0);
    for (int i = 0; i < scan->num_plots; i++) {
        struct rho_plot held = rho_window_unpack_plot(scan, (unsigned)i);
        const struct rho_plot *given = &plots[scan->marks[i] & RHO_WINDOW_ROW];
        assert_float_equal(held.x_m, given->x_m, 0.0f);
        assert_int_equal(held.offset_us, given->offset_us);
        assert_float_equal(held.sigma_range_m, given->sigma_range_m,
                           given->sigma_range_m / 4096.0f);
        assert_float_equal(held.sigma_cross_m, given->sigma_cross_m,
                           given->sigma_cross_m / 4096.0f);
        assert_float_equal(rho_window_larger_sigma_m(&scan->plots[i]), rho_plot_sigma_m(given),
                           rho_plot_sigma_m(given) / 4096.0f);
    }
    assert_float_equal(scan->sigma_max_m, 99.0f, 0.0f);
}

static void sigmas_are_stored_with_twelve_bits(void **state)
{
    (void)state;
    static const float exact[] = {10.0f, 60.0f, 0.5f, 1.0f, 4095.0f, 15.0f, 180.0f, 0.015625f};
    init_window(1);
    for (uint32_t i = 0; i < 8; i++) {
        set_plot(i, 1.0f, 1.0f, exact[i]);
    }
    for (uint32_t i = 8; i < 200; i++) {
        set_plot(i, 1.0f, 1.0f, powf(10.0f, uniform(-2.999f, 4.999f)));
    }
    set_plot(200, 1.0f, 1.0f, RHO_LIMIT_SIGMA_MIN);
    set_plot(201, 1.0f, 1.0f, RHO_LIMIT_SIGMA_MAX);
    push_scan(0, 202);
    const struct rho_window_scan *scan = rho_window_scan_at(&window, 0);
    for (int i = 0; i < 202; i++) {
        float given = plots[i].sigma_range_m,
              held = rho_window_decode_sigma(scan->plots[i].sigma_range);
        assert_float_equal(held, given, i < 8 ? 0.0f : given / 4096.0f);
    }
    assert_int_equal(scan->is_isotropic, 1);
}

static const struct rho_sensor radar = {.sensor_id = 4,
                                        .x_m = -2000.0f,
                                        .y_m = 800.0f,
                                        .z_m = 50.0f,
                                        .pd = 0.8f,
                                        .range_max_m = 50000.0f};

/* Noise covariance in x, y, z from the sigmas along, across and up the line of sight. */
static void plot_covariance(const struct rho_plot *plot, int has_z, double r[3][3])
{
    double d[3] = {plot->x_m - radar.x_m, plot->y_m - radar.y_m, has_z ? plot->z_m - radar.z_m : 0};
    double ground = hypot(d[0], d[1]), range = hypot(ground, d[2]);
    double axis[3][3] = {
        {d[0] / range, d[1] / range, d[2] / range},
        {-d[1] / ground, d[0] / ground, 0.0},
        {-d[2] * d[0] / range / ground, -d[2] * d[1] / range / ground, ground / range}};
    double sigma[3] = {plot->sigma_range_m, plot->sigma_cross_m, plot->sigma_up_m};
    memset(r, 0, 9 * sizeof r[0][0]);
    for (int k = 0; k < (has_z ? 3 : 2); k++) {
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                r[i][j] += sigma[k] * sigma[k] * axis[k][i] * axis[k][j];
            }
        }
    }
}

static double nis_in_double_precision(const struct rho_plot *plot, uint32_t measures,
                                      const struct rho_window_place *place)
{
    int has_z = (measures & RHO_MEASURES_Z) != 0;
    double t_s = plot->offset_us * 1e-6, r[3][3];
    plot_covariance(plot, has_z, r);
    double dx = plot->x_m - place->x_m - place->vx_mps * t_s;
    double dy = plot->y_m - place->y_m - place->vy_mps * t_s;
    double xx = place->noise.xx_m2 + place->factor * r[0][0];
    double xy = place->noise.xy_m2 + place->factor * r[0][1];
    double yy = place->noise.yy_m2 + place->factor * r[1][1];
    double sum = (yy * dx * dx - 2.0 * xy * dx * dy + xx * dy * dy) / (xx * yy - xy * xy);
    if (has_z && place->has_z) {
        double dz = plot->z_m - place->z_m - place->vz_mps * t_s;
        sum += dz * dz / (place->noise.zz_m2 + place->factor * r[2][2]);
    }
    if (measures & RHO_MEASURES_RANGE_RATE) {
        double u[3] = {plot->x_m - radar.x_m, plot->y_m - radar.y_m,
                       has_z && place->has_z ? plot->z_m - radar.z_m : 0.0};
        double v[3] = {place->vx_mps, place->vy_mps, has_z && place->has_z ? place->vz_mps : 0.0};
        double range = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]), rate = 0.0, turned2 = 0.0;
        for (int i = 0; i < 3; i++) {
            u[i] /= range;
            rate += u[i] * v[i];
        }
        for (int i = 0; i < 3; i++) {
            turned2 += pow((v[i] - rate * u[i]) / range, 2);
        }
        double largest = fmax(plot->sigma_range_m, plot->sigma_cross_m);
        double variance =
            place->factor * (pow(plot->sigma_range_rate_mps, 2) + turned2 * largest * largest) +
            place->velocity_noise.xx_m2 * u[0] * u[0] +
            2.0 * place->velocity_noise.xy_m2 * u[0] * u[1] +
            place->velocity_noise.yy_m2 * u[1] * u[1] + place->velocity_noise.zz_m2 * u[2] * u[2];
        sum += pow(plot->range_rate_mps - rate, 2) / variance;
    }
    return sum;
}

static void push_random_radar_plots(uint32_t measures)
{
    for (uint32_t i = 0; i < PLOTS; i++) {
        plots[i] = (struct rho_plot){.x_m = uniform(-1000.0f, 1000.0f),
                                     .y_m = uniform(-1000.0f, 1000.0f),
                                     .z_m = uniform(0.0f, 900.0f),
                                     .offset_us = (int32_t)uniform(-5e5f, 5e5f),
                                     .range_rate_mps = uniform(-80.0f, 80.0f),
                                     .sigma_range_m = uniform(5.0f, 40.0f),
                                     .sigma_cross_m = uniform(20.0f, 200.0f),
                                     .sigma_up_m = uniform(20.0f, 200.0f),
                                     .sigma_range_rate_mps = uniform(1.0f, 20.0f)};
    }
    struct rho_scan scan = scan_of(0, PLOTS);
    uint32_t unused = 0;
    scan.measures = measures;
    assert_int_equal(rho_window_push(&window, &scan, &radar, fates, &unused), RHO_OK);
}

static struct rho_window_place random_place(uint32_t measures)
{
    return (struct rho_window_place){.x_m = uniform(-1000.0f, 1000.0f),
                                     .y_m = uniform(-1000.0f, 1000.0f),
                                     .z_m = uniform(0.0f, 900.0f),
                                     .vx_mps = uniform(-60.0f, 60.0f),
                                     .vy_mps = uniform(-60.0f, 60.0f),
                                     .vz_mps = uniform(-10.0f, 10.0f),
                                     .noise = {900.0f, 300.0f, 400.0f, 500.0f},
                                     .velocity_noise = {25.0f, -5.0f, 16.0f, 9.0f},
                                     .factor = uniform(1.0f, 2.0f),
                                     .has_z = (measures & RHO_MEASURES_Z) != 0,
                                     .gate_radius_m = 1100.0f,
                                     .skip_flags = RHO_WINDOW_TAKEN};
}

/* The plot found is in the gate and nearest of all, in double precision. */
static void the_nearest_plot_uses_covariance_height_and_range_rate(void **state)
{
    (void)state;
    static const double gate[3] = {(double)RHO_GATE_CHI2_2D, (double)RHO_GATE_CHI2_3D,
                                   (double)RHO_GATE_CHI2_4D};
    int found = 0;
    for (int round = 0; round < 400; round++) {
        uint32_t measures =
            (round & 1 ? RHO_MEASURES_Z : 0u) | (round & 2 ? RHO_MEASURES_RANGE_RATE : 0u);
        double limit = gate[(round & 1) + (round >> 1 & 1)];
        init_window(1);
        push_random_radar_plots(measures);
        struct rho_window_scan *scan = rho_window_scan_at(&window, 0);
        scan->marks[3] |= RHO_WINDOW_TAKEN;
        for (int i = 0; i < 25; i++) {
            struct rho_window_place place = random_place(measures);
            struct rho_window_work work = {0};
            double best = limit, chosen = limit;
            int nearest = rho_window_nearest_plot(scan, &place, &work);
            for (int k = 0; k < scan->num_plots; k++) {
                struct rho_plot plot = rho_window_unpack_plot(scan, (unsigned)k);
                double d2 = nis_in_double_precision(&plot, measures, &place);
                best = k != 3 && d2 < best ? d2 : best;
                chosen = k == nearest ? d2 : chosen;
            }
            assert_int_not_equal(nearest, 3);
            assert_float_equal(chosen, best, 1e-3 * (1.0 + best));
            found += nearest >= 0;
        }
    }
    assert_in_range(found, 1500, 9500);
}

static void stored_covariances_follow_the_line_of_sight(void **state)
{
    (void)state;
    for (int round = 0; round < 2; round++) {
        uint32_t measures = round ? RHO_MEASURES_Z : 0u;
        init_window(1);
        push_random_radar_plots(measures);
        const struct rho_window_scan *scan = rho_window_scan_at(&window, 0);
        for (int i = 0; i < scan->num_plots; i++) {
            struct rho_plot plot = rho_window_unpack_plot(scan, (unsigned)i);
            struct rho_window_plot_noise noise = rho_window_plot_noise(scan, &scan->plots[i]);
            double r[3][3];
            plot_covariance(&plot, round, r);
            double scale = r[0][0] + r[1][1];
            assert_float_equal(noise.xx_m2, r[0][0], 1e-4 * scale);
            assert_float_equal(noise.xy_m2, r[0][1], 1e-4 * scale);
            assert_float_equal(noise.yy_m2, r[1][1], 1e-4 * scale);
            if (round) {
                assert_float_equal(noise.zz_m2, r[2][2], 1e-4 * (scale + r[2][2]));
            }
        }
        assert_int_equal(scan->is_isotropic, 0);
        assert_int_equal(rho_window_sensor_if_described(scan)->sensor_id, 4);
    }
    init_window(1);
    scatter_plots(500.0f);
    push_scan(0, PLOTS);
    assert_null(rho_window_sensor_if_described(rho_window_scan_at(&window, 0)));
}

/* A second update by the same plots moves no side of a lone scan's extent. */
static void a_lone_scans_extent_is_that_of_its_plots(void **state)
{
    (void)state;
    init_window(3);
    scatter_plots(1000.0f);
    push_scan(0, PLOTS);
    const struct rho_extent once = window.extent;
    assert_true(once.x_max_m > once.x_min_m && once.y_max_m > once.y_min_m);
    rho_window_update_extent(&window);
    assert_memory_equal(&window.extent, &once, sizeof once);
}

static void an_extent_grows_with_its_points(void **state)
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

/*
 * Plots are stored in the order of bins: each one between the start of its bin and that of the
 * next.
 */
static void each_plot_is_stored_in_the_bin_of_its_place(void **state)
{
    (void)state;
    init_window(3);
    for (uint32_t i = 0; i < PLOTS; i++) {
        set_plot(i, uniform(-1000.0f, 1000.0f), uniform(-500.0f, 500.0f), 5.0f);
    }
    push_scan(0, PLOTS);
    const struct rho_window_scan *scan = rho_window_scan_at(&window, 0);
    assert_true(scan->bins_x * scan->bins_y > 1);
    for (unsigned i = 0; i < scan->num_plots; i++) {
        const struct rho_window_plot *plot = &scan->plots[i];
        const unsigned bin = rho_window_bin_at(scan, plot->x_m, plot->y_m);
        const struct rho_extent place = {plot->x_m, plot->x_m, plot->y_m, plot->y_m};
        const struct rho_window_bins under = rho_window_bins_under(scan, &place);

        assert_in_range(i, scan->bin_start[bin], scan->bin_start[bin + 1] - 1);
        assert_int_equal(under.column_first, under.column_last);
        assert_int_equal(under.row_first * scan->bins_x + under.column_first, bin);
    }
    const struct rho_extent plane = {-INFINITY, INFINITY, -INFINITY, INFINITY};
    const struct rho_window_bins all = rho_window_bins_under(scan, &plane);
    assert_int_equal(all.column_first, 0);
    assert_int_equal(all.column_last, scan->bins_x - 1);
    assert_int_equal(all.row_first, 0);
    assert_int_equal(all.row_last, scan->bins_y - 1);
    assert_int_equal(rho_window_bin_at(scan, 1e6f, 1e6f), scan->bins_x * scan->bins_y - 1);
}

#define DEGREE_RAD 0.017453293f

/* A scan of a quarter turn with one plot in its middle. */
static struct rho_scan quarter_turn_scan(int64_t time_us, float from_degree)
{
    struct rho_scan scan = scan_of(time_us, 1);

    scan.sensor_id = 5;
    scan.sector_from_rad = from_degree * DEGREE_RAD;
    scan.sector_to_rad = (from_degree + 90.0f) * DEGREE_RAD;
    set_plot(0, 1000.0f * cosf((from_degree + 45.0f) * DEGREE_RAD),
             1000.0f * sinf((from_degree + 45.0f) * DEGREE_RAD), 5.0f);
    return scan;
}

/* Without RHO_SECTORS no scan continues another. */
static void the_next_sector_of_a_turn_continues_its_scan(void **state)
{
    const struct rho_sensor turning = {.sensor_id = 5, .pd = 0.9f},
                            moved = {.sensor_id = 5, .pd = 0.9f, .x_m = 30.0f};
    uint32_t unused = 0;

    (void)state;
    init_window(3);
    struct rho_scan scan = quarter_turn_scan(0, 0.0f);
    assert_false(rho_window_continues_newest(&window, &scan, &turning)); /* the window is empty */
    assert_int_equal(rho_window_push(&window, &scan, &turning, fates, &unused), RHO_OK);
    scan = quarter_turn_scan(1000000, 90.0f);
    assert_int_equal(rho_window_continues_newest(&window, &scan, &turning) != 0, RHO_SECTORS);
    assert_false(rho_window_continues_newest(&window, &scan, &moved));
    scan.sensor_id = 6;
    assert_false(rho_window_continues_newest(&window, &scan,
                                             &(struct rho_sensor){.sensor_id = 6, .pd = 0.9f}));
    scan = quarter_turn_scan(1000000, 90.0f + 40.0f); /* a gap of an eighth of a turn */
    assert_int_equal(rho_window_continues_newest(&window, &scan, &turning) != 0, RHO_SECTORS);
    scan = quarter_turn_scan(1000000, 90.0f + 50.0f);
    assert_false(rho_window_continues_newest(&window, &scan, &turning));
    scan = quarter_turn_scan(RHO_LIMIT_OFFSET_US + INT64_C(1), 90.0f);
    assert_false(rho_window_continues_newest(&window, &scan, &turning));
}

/* Two sectors of one time: their plots' times do not tell them apart. */
static void plots_of_an_earlier_sector_have_no_row(void **state)
{
    const struct rho_sensor turning = {.sensor_id = 5, .pd = 0.9f};
    uint32_t unused = 0;

    (void)state;
    init_window(3);
    struct rho_scan scan = quarter_turn_scan(0, 0.0f);
    assert_int_equal(rho_window_push(&window, &scan, &turning, fates, &unused), RHO_OK);
    assert_int_equal(rho_window_scan_at(&window, 0)->marks[0] & RHO_WINDOW_ROW, 0);
    if (!RHO_SECTORS) {
        skip();
    }
    scan = quarter_turn_scan(0, 90.0f);
    assert_int_equal(rho_window_push(&window, &scan, &turning, fates, &unused), RHO_OK);
    const struct rho_window_scan *turn = rho_window_scan_at(&window, 0);
    assert_int_equal(turn->num_plots, 2);
    for (unsigned i = 0; i < 2; i++) {
        assert_int_equal(turn->marks[i] & RHO_WINDOW_ROW,
                         turn->plots[i].x_m > 0.0f ? RHO_WINDOW_ROW : 0);
    }
    assert_true(rho_window_is_sound(&window));
}

static void a_damaged_window_is_not_sound(void **state)
{
    (void)state;
    init_window(3);
    set_plot(0, 1.0f, 2.0f, 1.0f);
    set_plot(1, 50.0f, 60.0f, 1.0f);
    push_scan(10, 2);
    push_scan(20, 1);
    assert_true(rho_window_is_sound(&window));
    before = window;
    window.num_scans = RHO_MAX_SCANS + 1;
    assert_false(rho_window_is_sound(&window));
    window = before;
    rho_window_scan_at(&window, 0)->num_plots = RHO_MAX_PLOTS + 1;
    assert_false(rho_window_is_sound(&window));
    window = before;
    rho_window_scan_at(&window, 0)->plots[1].x_m = NAN;
    assert_false(rho_window_is_sound(&window));
    window = before;
    rho_window_scan_at(&window, 0)->bin_start[1] = 9;
    assert_false(rho_window_is_sound(&window));
    window = before;
    rho_window_scan_at(&window, 1)->time_us = 9; /* before the first scan's time */
    assert_false(rho_window_is_sound(&window));
    window = before;
    memset(&window, 0, sizeof window);
    assert_false(rho_window_is_sound(&window));
}

/* The plot is due north of the radar, so that the range rate is the velocity along y. */
static void range_rates_are_compared_along_the_line_of_sight(void **state)
{
    const struct rho_sensor turning = {.sensor_id = 5, .x_m = 100.0f, .y_m = -200.0f};
    const struct rho_window_place seen_place = {.x_m = 100.0f,
                                                .y_m = 9800.0f,
                                                .vx_mps = 70.0f,
                                                .vy_mps = -30.0f,
                                                .velocity_noise = {.xx_m2 = 9.0f, .yy_m2 = 16.0f},
                                                .factor = 1.0f};
    struct rho_window_range_rate seen = {.error_mps = 0.0f};
    uint32_t unused = 0;

    (void)state;
    init_window(3);
    set_plot(0, 100.0f, 9800.0f, 5.0f);
    plots[0].range_rate_mps = -25.0f;
    plots[0].sigma_range_rate_mps = 2.0f;
    struct rho_scan scan = scan_of(0, 1);
    scan.sensor_id = 5;
    scan.measures = RHO_MEASURES_RANGE_RATE;
    assert_int_equal(rho_window_push(&window, &scan, &turning, fates, &unused), RHO_OK);
    const struct rho_window_scan *held = rho_window_scan_at(&window, 0);
    assert_true(rho_window_compare_range_rate(held, &held->plots[0], &seen_place, &seen));
    assert_true(fabsf(seen.error_mps - 5.0f) < 1e-3f);
    assert_true(fabsf(seen.along[0]) < 1e-6f && fabsf(seen.along[1] - 1.0f) < 1e-6f);
    /* 16 of the velocity and 2^2 of the plot; 70 m/s across with 5 m at 10 km add little */
    assert_true(fabsf(seen.variance - 20.0f) < 0.02f);
    assert_true(fabsf(rho_window_range_rate_nis(held, &held->plots[0], &seen_place) -
                      25.0f / seen.variance) < 1e-3f);

    set_plot(0, turning.x_m, turning.y_m, 5.0f);
    scan.time_us = 1;
    assert_int_equal(rho_window_push(&window, &scan, &turning, fates, &unused), RHO_OK);
    held = rho_window_scan_at(&window, 1);
    assert_false(rho_window_compare_range_rate(held, &held->plots[0], &seen_place, &seen));
    assert_true(rho_window_range_rate_nis(held, &held->plots[0], &seen_place) == 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_refused_init_changes_nothing),
        cmocka_unit_test(a_refused_push_changes_nothing),
        cmocka_unit_test(the_oldest_scan_leaves_and_its_unused_plots_are_counted),
        cmocka_unit_test(plots_beyond_the_capacity_get_the_fate_no_room),
        cmocka_unit_test(the_nearest_plot_agrees_with_an_exhaustive_search),
        cmocka_unit_test(bins_reduce_the_number_of_distance_tests),
        cmocka_unit_test(plots_keep_their_rows_and_sigmas),
        cmocka_unit_test(sigmas_are_stored_with_twelve_bits),
        cmocka_unit_test(the_nearest_plot_uses_covariance_height_and_range_rate),
        cmocka_unit_test(stored_covariances_follow_the_line_of_sight),
        cmocka_unit_test(a_lone_scans_extent_is_that_of_its_plots),
        cmocka_unit_test(an_extent_grows_with_its_points),
        cmocka_unit_test(each_plot_is_stored_in_the_bin_of_its_place),
        cmocka_unit_test(the_next_sector_of_a_turn_continues_its_scan),
        cmocka_unit_test(plots_of_an_earlier_sector_have_no_row),
        cmocka_unit_test(a_damaged_window_is_not_sound),
        cmocka_unit_test(range_rates_are_compared_along_the_line_of_sight),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
