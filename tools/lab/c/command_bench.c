/* SPDX-License-Identifier: MIT */
/*
 * bench: times of the library on this machine. Every figure is the minimum of several rounds in one
 * run, so that ratios of figures can be trusted where absolute times cannot.
 */
#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "base/text_table.h"
#include "bench.h"
#include "lab_commands.h"
#include "pipeline/pipeline.h"
#include "scenario_simulation.h"

#define FILTER_STEPS 20000
#define FILTER_LIFE 200

/* ---- kalman ---------------------------------------------------------------------------------- */

static void start_filter_on_axes(struct rho_kalman *kalman)
{
    rho_kalman_init(kalman);
    for (int axis = 0; axis < 3; axis++) {
        must_succeed(rho_kalman_open_axis(kalman, axis, 100.0f, 100.0f, 1e4f), "open");
    }
}

/*
 * The mean time of one prediction and num_updates scalar updates. An axis without updates would
 * drift beyond its limits, so the filter is started again every FILTER_LIFE steps.
 */
static double mean_filter_step_ns(int num_updates)
{
    struct rho_kalman kalman;
    int64_t start_us = monotonic_clock_us();
    for (int step = 0; step < FILTER_STEPS; step++) {
        if (step % FILTER_LIFE == 0) {
            start_filter_on_axes(&kalman);
        }
        must_succeed(rho_kalman_predict(&kalman, 1.0f, 1.0f), "predict");
        for (int i = 0; i < num_updates; i++) {
            must_succeed(rho_kalman_update(&kalman, i, 100.0f + (float)(step & 7), 100.0f, NULL),
                         "update");
        }
    }
    return (double)(monotonic_clock_us() - start_us) * 1e3 / FILTER_STEPS;
}

static void bench_kalman(const struct bench *bench)
{
    static const int updates[] = {2, 3, 6};
    struct text_table table = text_table_start(1, "kalman step|ns");
    for (size_t i = 0; i < 3; i++) {
        double best = INFINITY;
        char name[48];
        for (int round = 0; round < BENCH_ROUNDS; round++) {
            best = fmin(best, mean_filter_step_ns(updates[i]));
        }
        snprintf(name, sizeof name, "predict + %d scalar updates", updates[i]);
        text_table_add_row(&table, "%s|%.0f", name, best);
        if (bench->json) {
            snprintf(name, sizeof name, "kalman_%d_updates_ns", updates[i]);
            cJSON_AddNumberToObject(bench->json, name, best);
        }
    }
    if (!bench->json) {
        text_table_print(&table, stdout);
        printf("\n");
    }
    text_table_free(&table);
}

/* ---- scans of a simulation ------------------------------------------------------------------- */

/* All scans of a run; their plots are in one array. */
struct recording {
    struct rho_scan *scans;
    struct rho_plot *plots;
    size_t count;
};

static size_t copy_plots(const struct simulated_scan *scan, double sigma_m, struct rho_plot *plots)
{
    for (size_t i = 0; i < scan->num_plots; i++) {
        plots[i] = (struct rho_plot){.x_m = (float)scan->plots[i].x_m,
                                     .y_m = (float)scan->plots[i].y_m,
                                     .sigma_range_m = (float)sigma_m,
                                     .sigma_cross_m = (float)sigma_m};
    }
    return scan->num_plots;
}

static struct recording copy_simulation_to_recording(const struct simulation *simulation)
{
    size_t total = 0, used = 0;
    for (size_t i = 0; i < simulation->num_scans; i++) {
        total += simulation->scans[i].num_plots;
    }
    struct recording recording = {.scans =
                                      must_calloc(simulation->num_scans, sizeof(struct rho_scan)),
                                  .plots = must_calloc(total + 1, sizeof(struct rho_plot)),
                                  .count = simulation->num_scans};
    for (size_t i = 0; i < simulation->num_scans; i++) {
        const struct simulated_scan *scan = &simulation->scans[i];
        recording.scans[i].time_us = (int64_t)llround(scan->t_s * 1e6);
        recording.scans[i].num_plots = (uint32_t)scan->num_plots;
        recording.scans[i].plots = recording.plots + used;
        used += copy_plots(scan, simulation->sigma_m, recording.plots + used);
    }
    return recording;
}

static void free_recording(struct recording *recording)
{
    free(recording->scans);
    free(recording->plots);
}

/* ---- initiate -------------------------------------------------------------------------------- */

static double time_window_search_us(struct rho_initiator *initiator,
                                    const struct recording *recording,
                                    const struct rho_initiator_config *config)
{
    static uint8_t fates[RHO_MAX_PLOTS];
    uint32_t unused = 0;
    must_succeed(rho_initiator_init(initiator, sizeof *initiator, config), "initiator");
    for (size_t i = 0; i < recording->count; i++) {
        memset(fates, RHO_FATE_HELD, sizeof fates);
        must_succeed(rho_initiator_push(initiator, &recording->scans[i], NULL, fates, &unused),
                     "push");
    }
    int64_t start_us = monotonic_clock_us();
    must_succeed(rho_initiator_search(initiator, RHO_SEARCH_BATCH), "search");
    return (double)(monotonic_clock_us() - start_us);
}

static void bench_initiate_with_clutter(const struct bench *bench, struct text_table *table,
                                        struct rho_initiator *initiator, double clutter)
{
    struct parameters parameters;
    struct rho_initiator_config config;
    parameters_set_defaults(&parameters);
    scenario_suggest_parameters("crossing", &parameters);
    parameters_suggest(&parameters, PARAMETER_CLUTTER_PER_KM2, clutter / 10.0);
    parameters_suggest(&parameters, PARAMETER_MIN_SCANS, 5);
    struct simulation *simulation = scenario_simulate("crossing", &parameters, bench->seed, 0);
    struct recording recording = copy_simulation_to_recording(simulation);
    parameters_to_initiator(&parameters, &config);
    config.area_is_fixed = 1;
    config.area =
        (struct rho_extent){(float)simulation->area.x_min_m, (float)simulation->area.x_max_m,
                            (float)simulation->area.y_min_m, (float)simulation->area.y_max_m};
    double best = INFINITY;
    for (int round = 0; round < BENCH_ROUNDS; round++) {
        best = fmin(best, time_window_search_us(initiator, &recording, &config));
    }
    text_table_add_row(table, "%.0f|%.0f|%u|%u|%u|%u", clutter, best, initiator->work.seeds,
                       initiator->work.window.lookups, initiator->work.window.distances,
                       initiator->work.fits);
    if (bench->json) {
        char name[48];
        snprintf(name, sizeof name, "initiate_%.0f_clutter_us", clutter);
        cJSON_AddNumberToObject(bench->json, name, best);
    }
    free_recording(&recording);
    simulation_free(simulation);
}

static void bench_window_by_clutter(const struct bench *bench)
{
    static const double clutter[] = {0, 10, 100, 300};
    struct rho_initiator *initiator = must_alloc(sizeof *initiator);
    struct text_table table =
        text_table_start(0, "clutter plots a scan|us a window|seeds|look-ups|distances|fits");
    for (size_t i = 0; i < sizeof clutter / sizeof clutter[0]; i++) {
        bench_initiate_with_clutter(bench, &table, initiator, clutter[i]);
    }
    if (!bench->json) {
        printf("initiate: one batch window, Table 1's targets, 7 scans, 5 votes\n");
        text_table_print(&table, stdout);
        printf("\n");
    }
    text_table_free(&table);
    free(initiator);
}

/* ---- track ----------------------------------------------------------------------------------- */

struct cost {
    double mean_us, worst_us;
    unsigned tracks;
};

static struct cost time_pipeline_on_recording(struct pipeline *chain,
                                              const struct parameters *parameters,
                                              const struct recording *recording)
{
    struct cost cost = {0};
    pipeline_open(chain, parameters);
    for (size_t i = 0; i < recording->count; i++) {
        int64_t start_us = monotonic_clock_us();
        pipeline_step(chain, &recording->scans[i]);
        double us = (double)(monotonic_clock_us() - start_us);
        cost.mean_us += us / (double)recording->count;
        cost.worst_us = fmax(cost.worst_us, us);
    }
    cost.tracks = chain->node->tracker.counters.tracks_confirmed;
    return cost;
}

static struct cost fastest_track_cost(const struct bench *bench, struct pipeline *chain,
                                      double plots)
{
    struct parameters parameters;
    parameters_set_defaults(&parameters);
    scenario_suggest_parameters("traffic", &parameters);
    parameters_suggest(&parameters, PARAMETER_CLUTTER_PER_SCAN, plots - 50.0);
    struct simulation *simulation = scenario_simulate("traffic", &parameters, bench->seed, 0);
    struct recording recording = copy_simulation_to_recording(simulation);
    struct cost best = {.mean_us = INFINITY, .worst_us = INFINITY};
    for (int round = 0; round < BENCH_ROUNDS; round++) {
        struct cost cost = time_pipeline_on_recording(chain, &parameters, &recording);
        best.mean_us = fmin(best.mean_us, cost.mean_us);
        best.worst_us = fmin(best.worst_us, cost.worst_us);
        best.tracks = cost.tracks;
    }
    free_recording(&recording);
    simulation_free(simulation);
    return best;
}

static void bench_track(const struct bench *bench)
{
    static const double plots[] = {100, 300, 1000, 3000, 5000};
    struct pipeline chain = pipeline_allocate();
    struct text_table table =
        text_table_start(0, "plots a scan|us a scan|worst scan us|ratio|tracks confirmed");
    double first_us = 0.0;
    for (size_t i = 0; i < sizeof plots / sizeof plots[0]; i++) {
        struct cost cost = fastest_track_cost(bench, &chain, plots[i]);
        first_us = i == 0 ? cost.mean_us : first_us;
        text_table_add_row(&table, "%.0f|%.0f|%.0f|%.1f|%u", plots[i], cost.mean_us, cost.worst_us,
                           cost.mean_us / first_us, cost.tracks);
        if (bench->json) {
            char name[48];
            snprintf(name, sizeof name, "track_%.0f_plots_us", plots[i]);
            cJSON_AddNumberToObject(bench->json, name, cost.mean_us);
        }
    }
    if (!bench->json) {
        printf("track: 120 scans, 10 s apart, 500 x 500 km, 50 targets, sigma 50 m\n");
        text_table_print(&table, stdout);
        printf("\n");
    }
    text_table_free(&table);
    pipeline_free(&chain);
}

/* ---- the command ----------------------------------------------------------------------------- */

static const struct {
    const char *name;
    void (*run)(const struct bench *bench);
} benches[] = {{"kalman", bench_kalman},    {"initiate", bench_window_by_clutter},
               {"track", bench_track},      {"hough", bench_hough},
               {"passive", bench_passive},  {"node", bench_node},
               {"work", bench_arrangements}};

#define NUM_BENCHES (sizeof benches / sizeof benches[0])

static void read_processor_name(char *name, size_t size)
{
    char line[256];
    FILE *file = fopen("/proc/cpuinfo", "r");
    snprintf(name, size, "unknown");
    while (file && fgets(line, sizeof line, file)) {
        char *text = strstr(line, ": ");
        if (strncmp(line, "model name", 10) == 0 && text) {
            line[strcspn(line, "\n")] = '\0';
            snprintf(name, size, "%s", text + 2);
            break;
        }
    }
    if (file) {
        fclose(file);
    }
}

static void check_bench_name(const char *name)
{
    for (size_t i = 0; i < NUM_BENCHES; i++) {
        if (strcmp(benches[i].name, name) == 0) {
            return;
        }
    }
    fail(EXIT_USAGE, "no bench '%s'; there is: kalman, initiate, track, hough, passive, node",
         name);
}

int command_bench(struct command_line *line)
{
    char machine[200];
    const char *wanted = line->num_arguments > 0 ? line->arguments[0] : NULL;
    struct bench bench = {.seed = line->seed};
    if (line->num_arguments > 1) {
        fail(EXIT_USAGE, "bench: give one name or none; there is: kalman, initiate, track, hough, "
                         "passive, node");
    }
    if (wanted) {
        check_bench_name(wanted);
    }
    read_processor_name(machine, sizeof machine);
    if (line->json) {
        bench.json = cJSON_CreateObject();
        cJSON_AddStringToObject(bench.json, "machine", machine);
    } else {
        printf("%s; minimum of %d rounds\n\n", machine, BENCH_ROUNDS);
    }
    for (size_t i = 0; i < NUM_BENCHES; i++) {
        if (!wanted || strcmp(benches[i].name, wanted) == 0) {
            benches[i].run(&bench);
        }
    }
    if (bench.json) {
        json_print_and_delete(bench.json);
    }
    return 0;
}
