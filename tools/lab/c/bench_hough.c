/* SPDX-License-Identifier: MIT */
/*
 * bench_hough: times of the streamed accumulator with and without pruning, of a dense accumulator
 * in plain C, and of OpenCV's, all on the same points in one run: 30 x 30 km, 7 scans. A call
 * clears the cells, votes and finds the peaks.
 */
#include "bench_hough.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "base/random.h"
#include "base/text_table.h"
#include "bench.h"
#include "lab_limits.h"
#include "pipeline/pipeline.h"

#define PEAKS_MAX 1024
#define ROUND_US 500 /* shortest round; the clock counts microseconds */

/* The bar for the time of a vote; vectors of 32 bytes make a vote faster. */
#ifdef __AVX2__
#define NS_A_VOTE_MOST 0.7
#else
#define NS_A_VOTE_MOST 0.9
#endif

enum kind { FINE, COARSE };

static const struct {
    const char *name, *json_name;
    float rho_cell_m, theta_cell_rad;
    int dense_rounds, opencv_rounds;
} kinds[] = {[FINE] = {"5 m x 1 mrad", "fine", 5.0f, 0.001f, 2, 3},
             [COARSE] = {"100 m x 0.5 deg", "coarse", 100.0f, 0.0087266463f, 20, 50}};

/* A number of points, of which each target has one in every scan; the others are clutter. */
struct job {
    enum kind kind;
    unsigned points, targets;
};

static const struct job jobs[] = {{FINE, 30, 0},    {FINE, 30, 3},   {FINE, 300, 0},
                                  {FINE, 3000, 0},  {COARSE, 30, 0}, {COARSE, 300, 0},
                                  {COARSE, 3000, 0}};

#define NUM_JOBS (sizeof jobs / sizeof jobs[0])

#define COUNTERS_BYTES_MOST 65536.0

struct figures {
    double votes; /* number of points times cells of theta */
    double us, plain_us, dense_us;
    double bytes, dense_bytes;
    double counters_bytes; /* memory of counters in use: a row of rho */
    struct hough_cost opencv;
};

/* ---- points ---------------------------------------------------------------------------------- */

static void scatter_points_over_scans(struct hough_cloud *cloud, unsigned count, uint64_t seed)
{
    struct random random = random_start(seed, 77, count);
    cloud->count = count;
    for (unsigned i = 0; i < count; i++) {
        cloud->x_m[i] = (float)random_between(&random, -HOUGH_HALF_SIDE_M, HOUGH_HALF_SIDE_M);
        cloud->y_m[i] = (float)random_between(&random, -HOUGH_HALF_SIDE_M, HOUGH_HALF_SIDE_M);
    }
    for (unsigned scan = 0; scan < HOUGH_SCANS; scan++) {
        cloud->scan_end[scan] = count * (scan + 1) / HOUGH_SCANS;
    }
}

/* Replaces the first points of each scan by targets that move up to 1 km a scan on each axis. */
static void replace_points_by_targets(struct hough_cloud *cloud, unsigned targets, uint64_t seed)
{
    struct random random = random_start(seed, 78, targets);
    for (unsigned target = 0; target < targets; target++) {
        double x_m = random_between(&random, -8e3, 8e3), y_m = random_between(&random, -8e3, 8e3);
        double dx_m = random_between(&random, -1e3, 1e3);
        double dy_m = random_between(&random, -1e3, 1e3);
        for (unsigned scan = 0; scan < HOUGH_SCANS; scan++) {
            unsigned i = (scan > 0 ? cloud->scan_end[scan - 1] : 0) + target;
            cloud->x_m[i] = (float)(x_m + dx_m * scan);
            cloud->y_m[i] = (float)(y_m + dy_m * scan);
        }
    }
}

/* ---- times ----------------------------------------------------------------------------------- */

static double total_us_of_searches(struct rho_accumulator *accumulator,
                                   const struct hough_cloud *cloud, int calls)
{
    static struct rho_accumulator_peak peaks[PEAKS_MAX];
    const struct rho_accumulator_points points = {cloud->x_m, cloud->y_m, HOUGH_SCANS,
                                                  cloud->scan_end};
    struct rho_accumulator_result result;
    int64_t start_us = monotonic_clock_us();
    for (int call = 0; call < calls; call++) {
        must_succeed(rho_accumulator_find_peaks(accumulator, &points, peaks, PEAKS_MAX, &result),
                     "find");
    }
    return (double)(monotonic_clock_us() - start_us);
}

static double fastest_search_us(struct rho_accumulator *accumulator,
                                const struct hough_cloud *cloud)
{
    int calls = 1;
    while (total_us_of_searches(accumulator, cloud, calls) < ROUND_US) {
        calls *= 2;
    }
    double best_us = INFINITY;
    for (int round = 0; round < BENCH_ROUNDS; round++) {
        best_us = fmin(best_us, total_us_of_searches(accumulator, cloud, calls) / calls);
    }
    return best_us;
}

static void init_accumulator_of_cell_size(struct rho_accumulator *accumulator, enum kind kind,
                                          int no_pruning)
{
    struct rho_accumulator_config config = {.rho_max_m = HOUGH_RHO_MAX_M,
                                            .rho_cell_m = kinds[kind].rho_cell_m,
                                            .theta_cell_rad = kinds[kind].theta_cell_rad,
                                            .min_votes = HOUGH_MIN_VOTES,
                                            .no_pruning = (uint8_t)no_pruning};
    must_succeed(rho_accumulator_init(accumulator, sizeof *accumulator, &config), "accumulator");
}

static struct figures measure_job_and_rivals(struct rho_accumulator *accumulator,
                                             const struct job *job, uint64_t seed)
{
    static struct hough_cloud cloud;
    struct figures figures;
    scatter_points_over_scans(&cloud, job->points, seed);
    replace_points_by_targets(&cloud, job->targets, seed);
    init_accumulator_of_cell_size(accumulator, job->kind, 1);
    figures.plain_us = fastest_search_us(accumulator, &cloud);
    init_accumulator_of_cell_size(accumulator, job->kind, 0);
    figures.us = fastest_search_us(accumulator, &cloud);
    figures.votes = (double)job->points * accumulator->theta_cells;
    figures.dense_us = hough_dense_fastest_us(accumulator, &cloud, kinds[job->kind].dense_rounds);
    figures.opencv = hough_opencv_cost(accumulator, &cloud, kinds[job->kind].opencv_rounds);
    double points_bytes = 2.0 * sizeof(float) * job->points;
    figures.bytes = sizeof *accumulator + points_bytes;
    figures.counters_bytes = accumulator->rho_cells + RHO_ACCUMULATOR_PADDING;
    figures.dense_bytes = (double)hough_dense_bytes(accumulator) + points_bytes;
    return figures;
}

/* ---- the table ------------------------------------------------------------------------------- */

/* The value as text by the format, or "-" when it is NAN. */
static const char *format_or_dash(char text[32], const char *format, double value)
{
    snprintf(text, 32, format, value);
    return isnan(value) ? "-" : text;
}

static void add_job_row(struct text_table *table, const struct job *job,
                        const struct figures *figures)
{
    char points[32], opencv[32], over[32], bytes[32];
    snprintf(points, sizeof points, job->targets > 0 ? "%u (%u)" : "%u", job->points,
             job->targets * HOUGH_SCANS);
    text_table_add_row(
        table, "%s|%s|%.3f|%.3f|%.3f|%.2f|%.1f|%.0f|%s|%s|%.0f|%.0f|%s", kinds[job->kind].name,
        points, figures->us / 1e3, 1e3 * figures->us / figures->votes, figures->plain_us / 1e3,
        1e3 * figures->plain_us / figures->votes, figures->dense_us / 1e3,
        figures->dense_us / figures->us, format_or_dash(opencv, "%.2f", figures->opencv.us / 1e3),
        format_or_dash(over, "%.1f", figures->opencv.us / figures->us), figures->bytes / 1024.0,
        figures->dense_bytes / 1024.0,
        format_or_dash(bytes, "%.0f", figures->opencv.bytes / 1024.0));
}

static void add_job_json(cJSON *json, const struct job *job, const struct figures *figures)
{
    const struct {
        const char *name;
        double value;
    } numbers[] = {{"us", figures->us},
                   {"ns_a_vote", 1e3 * figures->us / figures->votes},
                   {"plain_us", figures->plain_us},
                   {"plain_ns_a_vote", 1e3 * figures->plain_us / figures->votes},
                   {"bytes", figures->bytes},
                   {"dense_us", figures->dense_us},
                   {"dense_bytes", figures->dense_bytes},
                   {"opencv_us", figures->opencv.us},
                   {"opencv_bytes", figures->opencv.bytes}};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        char name[80];
        snprintf(name, sizeof name, "hough_%s_%u_points_%s%s", kinds[job->kind].json_name,
                 job->points, job->targets > 0 ? "targets_" : "", numbers[i].name);
        if (!isnan(numbers[i].value)) {
            cJSON_AddNumberToObject(json, name, numbers[i].value);
        }
    }
}

/* ---- bars ------------------------------------------------------------------------------------ */

static void add_verdict_on_opencv(struct verdicts *verdicts, const struct job *job,
                                  const struct figures *figures)
{
    static const struct {
        struct job job;
        double least;
    } bars[] = {{{FINE, 30, 0}, 4000.0},
                {{FINE, 3000, 0}, 150.0},
                {{COARSE, 30, 0}, 8.0},
                {{COARSE, 3000, 0}, 4.0}};
    for (size_t i = 0; i < sizeof bars / sizeof bars[0]; i++) {
        if (bars[i].job.kind == job->kind && bars[i].job.points == job->points &&
            bars[i].job.targets == job->targets && !isnan(figures->opencv.us)) {
            verdicts_add_at_least(verdicts, figures->opencv.us / figures->us, bars[i].least,
                                  "%s, %u points: times OpenCV's speed", kinds[job->kind].name,
                                  job->points);
        }
    }
}

static void add_verdicts_on_job(struct verdicts *verdicts, const struct job *job,
                                const struct figures *figures)
{
    if (job->kind == FINE && job->points == 30) {
        verdicts_add_at_most(verdicts, figures->us / 1e3, 0.25, "%s, %u points%s: ms a call",
                             kinds[FINE].name, job->points,
                             job->targets > 0 ? " with targets" : "");
    }
    if (job->kind == FINE && job->points == 3000) {
        verdicts_add_at_most(verdicts, figures->counters_bytes, COUNTERS_BYTES_MOST,
                             "%s, %u points: bytes of counters", kinds[FINE].name, job->points);
        verdicts_add_at_most(verdicts, 1e3 * figures->us / figures->votes, NS_A_VOTE_MOST,
                             "%s, %u points: ns a vote", kinds[FINE].name, job->points);
    }
    add_verdict_on_opencv(verdicts, job, figures);
}

/* ---- all jobs -------------------------------------------------------------------------------- */

static void print_table_and_verdicts(const struct text_table *table,
                                     const struct verdicts *verdicts, int has_opencv)
{
    printf(
        "hough: 30 x 30 km, 7 scans, distinct scans count, %d votes; (21): so many are on 3 lines\n"
        "plain: without pruning; a vote: a point in a row of theta; KiB: ours and the plane with "
        "the "
        "points, OpenCV's program\n",
        HOUGH_MIN_VOTES);
    text_table_print(table, stdout);
    printf("\n");
    verdicts_print(verdicts, stdout);
    printf("%sinstructions a vote: make instructions\n\n",
           has_opencv ? "" : "- : OpenCV's was not built (make bench-opencv), its bars are open\n");
}

void bench_hough(const struct bench *bench)
{
    struct rho_accumulator *accumulator = must_alloc(sizeof *accumulator);
    struct verdicts verdicts = verdicts_start();
    struct text_table table =
        text_table_start(1, "cells|points|ms|ns a vote|plain ms|ns a vote|dense ms|over|"
                            "OpenCV ms|over|KiB|dense|OpenCV");
    int has_opencv = 1;
    for (size_t i = 0; i < NUM_JOBS; i++) {
        struct figures figures = measure_job_and_rivals(accumulator, &jobs[i], bench->seed);
        add_job_row(&table, &jobs[i], &figures);
        add_verdicts_on_job(&verdicts, &jobs[i], &figures);
        has_opencv = has_opencv && !isnan(figures.opencv.us);
        if (bench->json) {
            add_job_json(bench->json, &jobs[i], &figures);
        }
    }
    if (bench->json) {
        verdicts_move_to_json(&verdicts, bench->json);
    } else {
        print_table_and_verdicts(&table, &verdicts, has_opencv);
    }
    verdicts_free(&verdicts);
    text_table_free(&table);
    free(accumulator);
}
