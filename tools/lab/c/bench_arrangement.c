/* SPDX-License-Identifier: MIT */
/*
 * bench_arrangement: the time of the slowest scan of 5000 plots of several
 * shapes, divided by the median of uniform clutter; and how the time of uniform clutter grows from
 * 1000 to 5000 plots.
 */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "base/random.h"
#include "base/text_table.h"
#include "bench.h"
#include "pipeline/pipeline.h"

enum { PLOTS = 5000, FEW = 1000, SCANS = 16, WARM_UP = 7, ROUNDS = 2, TARGETS = 1600, HEAPS = 20 };

#define SIDE_M 500e3
#define INTERVAL_S 10.0
#define SIGMA_M 50.0

enum shape { EVEN, COMES_BACK, PILE, HEAPED, LINES, RINGS, MANY_TARGETS, CROWDED_TARGETS, SHAPES };

static const struct sky {
    const char *name, *key;
    enum shape shape;
    size_t plots;
    double sigma_m;
    bool has_rates; /* range rates, ambiguous by 20 m/s, and anisotropic noise */
} skies[] = {
    {"evenly spread", "even", EVEN, PLOTS, SIGMA_M, false},
    {"evenly spread, 1000", "even_1000", EVEN, FEW, SIGMA_M, false},
    {"all come back", "comes_back", COMES_BACK, PLOTS, SIGMA_M, false},
    {"all within their noise", "pile", PILE, PLOTS, SIGMA_M, false},
    {"20 heaps of 5 km", "heaps", HEAPED, PLOTS, SIGMA_M, false},
    {"20 lines", "lines", LINES, PLOTS, SIGMA_M, false},
    {"rings of 100 m", "rings", RINGS, PLOTS, SIGMA_M, false},
    {"noise of 20 km", "noise", EVEN, PLOTS, 20e3, false},
    {"1600 targets", "targets", MANY_TARGETS, PLOTS, SIGMA_M, false},
    {"1600 targets near each other", "near_targets", CROWDED_TARGETS, PLOTS, SIGMA_M, false},
    {"ambiguous range rates", "rates", EVEN, PLOTS, SIGMA_M, true},
    {"the same, 20 heaps", "heaps_rates", HEAPED, PLOTS, SIGMA_M, true},
    {"the same, all within their noise", "pile_rates", PILE, PLOTS, SIGMA_M, true},
};

enum { NUM_SKIES = sizeof skies / sizeof skies[0] };

static double random_within_side(struct random *random, double side_m)
{
    return random_between(random, -0.5 * side_m, 0.5 * side_m);
}

static void draw_arranged_plot(const struct sky *sky, struct random *random, size_t i, size_t scan,
                               struct rho_plot *plot)
{
    const size_t heap = i % HEAPS, heap_row = heap / 5, target = i % TARGETS, row = target / 40;
    const double heap_m = 100e3 * (double)(heap % 5) - 200e3;
    const double row_m = 100e3 * (double)heap_row - 150e3;
    const double turn_rad = random_between(random, 0.0, 2.0 * M_PI);
    double x_m = random_within_side(random, SIDE_M), y_m = random_within_side(random, SIDE_M);
    if (sky->shape == PILE) {
        x_m = SIGMA_M * random_normal(random);
        y_m = 40e3 + SIGMA_M * random_normal(random);
    } else if (sky->shape == HEAPED) {
        x_m = heap_m + 5e3 * random_normal(random);
        y_m = row_m + 5e3 * random_normal(random);
    } else if (sky->shape == LINES) {
        y_m = 25e3 * (double)heap - 250e3;
    } else if (sky->shape == RINGS) {
        x_m = heap_m + 100.0 * cos(turn_rad);
        y_m = row_m + 100.0 * sin(turn_rad);
    } else if (sky->shape == MANY_TARGETS || sky->shape == CROWDED_TARGETS) {
        const double spacing_m = sky->shape == MANY_TARGETS ? 11e3 : 400.0;
        x_m = spacing_m * (double)(target % 40) - 20.0 * spacing_m +
              200.0 * INTERVAL_S * (double)scan + sky->sigma_m * random_normal(random);
        y_m = spacing_m * (double)row - 20.0 * spacing_m + sky->sigma_m * random_normal(random);
    }
    *plot = (struct rho_plot){
        .x_m = (float)x_m,
        .y_m = (float)y_m,
        .range_rate_mps = (float)random_between(random, -10.0, 10.0),
        .sigma_range_m = (float)sky->sigma_m,
        .sigma_cross_m = (float)(sky->has_rates ? 3.0 * sky->sigma_m : sky->sigma_m),
        .sigma_range_rate_mps = 1.0f,
    };
}

static struct rho_plot *draw_plots_of_all_scans(const struct sky *sky, uint64_t seed)
{
    struct rho_plot *plots = must_calloc(SCANS * sky->plots, sizeof *plots);
    struct random random = random_start(seed, (uint64_t)sky->shape, 0);
    for (size_t scan = 0; scan < SCANS; scan++) {
        for (size_t i = 0; i < sky->plots; i++) {
            struct rho_plot *plot = &plots[scan * sky->plots + i];
            if (sky->shape == COMES_BACK && scan > 0) {
                *plot = plots[i];
                plot->x_m += (float)(SIGMA_M * random_normal(&random));
                plot->y_m += (float)(SIGMA_M * random_normal(&random));
            } else {
                draw_arranged_plot(sky, &random, i, scan, plot);
            }
        }
    }
    return plots;
}

struct times {
    double median_us, worst_us;
    unsigned partial; /* number of partial steps in a round */
};

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void open_pipeline_for_sky(struct pipeline *chain, const struct sky *sky)
{
    const struct rho_sensor sensor = {.sensor_id = 1,
                                      .pd = 0.9f,
                                      .range_max_m = 400e3f,
                                      .range_rate_span_mps = sky->has_rates ? 20.0f : 0.0f};
    struct parameters parameters;
    parameters_set_defaults(&parameters);
    pipeline_open(chain, &parameters);
    (void)!rho_tracker_set_sensor(&chain->node->tracker, &sensor);
}

/* The median and the longest time of a scan; each scan counts with its fastest round. */
static struct times time_scans_of_sky(const struct sky *sky, struct pipeline *chain, uint64_t seed)
{
    struct rho_plot *plots = draw_plots_of_all_scans(sky, seed);
    double us[SCANS];
    for (size_t i = 0; i < SCANS; i++) {
        us[i] = INFINITY;
    }
    for (int round = 0; round < ROUNDS; round++) {
        open_pipeline_for_sky(chain, sky);
        for (size_t i = 0; i < SCANS; i++) {
            const struct rho_scan scan = {
                .time_us = llround(1e6 * INTERVAL_S * (double)i),
                .sensor_id = 1,
                .measures = sky->has_rates ? RHO_MEASURES_RANGE_RATE : 0,
                .num_plots = (uint32_t)sky->plots,
                .plots = &plots[i * sky->plots],
            };
            const int64_t start_us = monotonic_clock_us();
            pipeline_step(chain, &scan);
            us[i] = fmin(us[i], (double)(monotonic_clock_us() - start_us));
        }
    }
    struct times times = {.partial = chain->node->tracker.work.partial_steps};
    qsort(us + WARM_UP, SCANS - WARM_UP, sizeof us[0], compare_numbers);
    times.median_us = us[WARM_UP + (SCANS - WARM_UP) / 2];
    qsort(us, SCANS, sizeof us[0], compare_numbers);
    times.worst_us = us[SCANS - 1];
    free(plots);
    return times;
}

void bench_arrangements(const struct bench *bench)
{
    struct pipeline chain = pipeline_allocate();
    struct text_table table =
        text_table_start(1, "5000 plots a scan|median us|worst us|over the even median|partial");
    double even_us = 1.0, few_us = 1.0;
    for (size_t i = 0; i < NUM_SKIES; i++) {
        const struct times times = time_scans_of_sky(&skies[i], &chain, bench->seed);
        even_us = i == 0 ? times.median_us : even_us;
        few_us = skies[i].plots == FEW ? times.median_us : few_us;
        text_table_add_row(&table, "%s|%.0f|%.0f|%.2f|%u", skies[i].name, times.median_us,
                           times.worst_us, times.worst_us / even_us, times.partial);
        if (bench->json) {
            char name[64];
            snprintf(name, sizeof name, "work_%s_ratio", skies[i].key);
            cJSON_AddNumberToObject(bench->json, name, times.worst_us / even_us);
        }
    }
    if (bench->json) {
        cJSON_AddNumberToObject(bench->json, "work_growth_ratio", even_us / few_us);
    } else {
        printf("work: %d scans, 10 s apart, 500 x 500 km, sigma 50 m\n", SCANS);
        text_table_print(&table, stdout);
        printf("from 1000 to 5000 evenly spread: %.1f times\n\n", even_us / few_us);
    }
    text_table_free(&table);
    pipeline_free(&chain);
}
