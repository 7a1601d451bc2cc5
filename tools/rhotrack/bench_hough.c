/* SPDX-License-Identifier: MIT */
/*
 * bench_hough: the streamed accumulator, a dense one in plain C, and OpenCV's, all on the same points in one run: 30 x 30 km,
 * 7 scans. A call clears, votes and finds the peaks.
 */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench.h"
#include "chain.h"
#include "common.h"
#include "grid.h"
#include "random.h"
#include "rhotrack/accumulator.h"

#define SCANS 7
#define HALF_SIDE_M 15000.0
#define RHO_MAX_M 21220.0f /* of its corners */
#define MIN_VOTES 5
#define PEAKS_MAX 1024
#define POINTS_MAX 3000
#define DENSE_ROUNDS 2
#define OPENCV_ROUNDS 3

static const struct {
    const char *name;
    float rho_cell_m, theta_cell_rad;
} cell_sizes[] = {{"5 m x 1 mrad", 5.0f, 0.001f}, {"100 m x 0.5 deg", 100.0f, 0.0087266463f}};

static const unsigned point_counts[] = {30, 300, 3000};

struct cloud {
    unsigned count;
    float x_m[POINTS_MAX], y_m[POINTS_MAX];
    uint32_t scan_end[SCANS];
};

static void scatter(struct cloud *cloud, unsigned count, uint64_t seed)
{
    struct random random = random_start(seed, 77, count);
    cloud->count = count;
    for (unsigned i = 0; i < count; i++) {
        cloud->x_m[i] = (float)random_between(&random, -HALF_SIDE_M, HALF_SIDE_M);
        cloud->y_m[i] = (float)random_between(&random, -HALF_SIDE_M, HALF_SIDE_M);
    }
    for (unsigned scan = 0; scan < SCANS; scan++) {
        cloud->scan_end[scan] = count * (scan + 1) / SCANS;
    }
}

/* ---- the library's ---------------------------------------------------------------------------- */

static double streamed_us(struct rho_accumulator *accumulator, const struct cloud *cloud,
                          struct rho_accumulator_result *result)
{
    static struct rho_accumulator_peak peaks[PEAKS_MAX];
    const struct rho_accumulator_points points = {cloud->x_m, cloud->y_m, SCANS, cloud->scan_end};
    double best_us = INFINITY;
    for (int round = 0; round < BENCH_ROUNDS; round++) {
        int64_t start_us = clock_us();
        must_succeed(rho_accumulator_find(accumulator, &points, peaks, PEAKS_MAX, result), "find");
        best_us = fmin(best_us, (double)(clock_us() - start_us));
    }
    return best_us;
}

/* ---- the whole plane -------------------------------------------------------------------------- */

static unsigned bits(unsigned mask)
{
    unsigned n = 0;
    for (; mask; mask &= mask - 1u) {
        n++;
    }
    return n;
}

static void vote_dense(const struct rho_accumulator *accumulator, const struct cloud *cloud,
                       uint16_t *plane, size_t width)
{
    float per_m = 1.0f / accumulator->config.rho_cell_m, first = RHO_MAX_M * per_m;
    for (unsigned theta = 0; theta < accumulator->theta_cells; theta++) {
        float theta_rad = rho_accumulator_theta_rad(accumulator, theta);
        float by_x = cosf(theta_rad) * per_m, by_y = sinf(theta_rad) * per_m;
        unsigned scan = 0;
        for (unsigned i = 0; i < cloud->count; i++) {
            while (i >= cloud->scan_end[scan]) {
                scan++;
            }
            size_t rho = (size_t)(cloud->x_m[i] * by_x + cloud->y_m[i] * by_y + first);
            plane[theta * width + rho] |= (uint16_t)(1u << scan);
        }
    }
}

/* Cells with min_votes that no neighbour beats; the ends of theta do not matter for the time. */
static unsigned count_peaks(const uint16_t *plane, size_t width, size_t height)
{
    unsigned count = 0;
    for (size_t theta = 1; theta + 1 < height; theta++) {
        const uint16_t *row = plane + theta * width;
        for (size_t rho = 1; rho + 1 < width; rho++) {
            unsigned votes = row[rho] ? bits(row[rho]) : 0u, most = 0;
            for (size_t i = 0; i < 9 && votes >= MIN_VOTES; i++) {
                unsigned other = bits(row[rho + i % 3 - 1 + (i / 3) * width - width]);
                most = other > most ? other : most;
            }
            count += votes >= MIN_VOTES && votes >= most;
        }
    }
    return count;
}

static double dense_us(const struct rho_accumulator *accumulator, const struct cloud *cloud)
{
    size_t width = accumulator->rho_cells + 2u, height = accumulator->theta_cells;
    uint16_t *plane = must_calloc(width * height, sizeof *plane);
    double best_us = INFINITY;
    for (int round = 0; round < DENSE_ROUNDS; round++) {
        int64_t start_us = clock_us();
        memset(plane, 0, width * height * sizeof *plane);
        vote_dense(accumulator, cloud, plane, width);
        if (count_peaks(plane, width, height) > width * height) {
            fail(EXIT_RUNTIME, "more peaks than cells");
        }
        best_us = fmin(best_us, (double)(clock_us() - start_us));
    }
    free(plane);
    return best_us;
}

/* ---- OpenCV's --------------------------------------------------------------------------------- */

/* BUILD/tests/bench/hough_opencv beside this program; NULL where it was not built. */
static const char *opencv_path(char path[512])
{
    char self[400];
    ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
    if (length <= 0) {
        return NULL;
    }
    self[length] = '\0';
    char *end = strrchr(self, '/');
    snprintf(path, 512, "%.*s/tests/bench/hough_opencv", end ? (int)(end - self) : 1, self);
    return access(path, X_OK) == 0 ? path : NULL;
}

static void write_points(const struct cloud *cloud, const char *path)
{
    FILE *file = fopen(path, "wb");
    if (!file) {
        fail(EXIT_RUNTIME, "%s: cannot be written", path);
    }
    for (unsigned i = 0; i < cloud->count; i++) {
        const float pair[2] = {cloud->x_m[i], cloud->y_m[i]};
        fwrite(pair, sizeof pair, 1, file);
    }
    fclose(file);
}

/* What the program prints on its standard output, as a number; NAN where it prints none. */
static double run_for_number(char *const arguments[])
{
    char answer[64] = "";
    int ends[2];
    if (pipe(ends) != 0) {
        fail(EXIT_RUNTIME, "pipe: %s", strerror(errno));
    }
    pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], STDOUT_FILENO);
        execv(arguments[0], arguments);
        _exit(127);
    }
    close(ends[1]);
    ssize_t length = child > 0 ? read(ends[0], answer, sizeof answer - 1) : 0;
    close(ends[0]);
    if (child > 0) {
        waitpid(child, NULL, 0);
    }
    char *end = answer;
    double value = length > 0 ? strtod(answer, &end) : 0.0;
    return end == answer ? NAN : value;
}

/* NAN where it is not there. */
static double opencv_us(const struct cloud *cloud, float rho_cell_m, float theta_cell_rad)
{
    char program[512], points[64], rho_max[32], rho_cell[32], theta_cell[32], votes[16], rounds[16];
    if (!opencv_path(program)) {
        return NAN;
    }
    snprintf(points, sizeof points, "/tmp/rhotrack-hough-%ld", (long)getpid());
    snprintf(rho_max, sizeof rho_max, "%g", (double)RHO_MAX_M);
    snprintf(rho_cell, sizeof rho_cell, "%g", (double)rho_cell_m);
    snprintf(theta_cell, sizeof theta_cell, "%.9g", (double)theta_cell_rad);
    snprintf(votes, sizeof votes, "%d", MIN_VOTES);
    snprintf(rounds, sizeof rounds, "%d", OPENCV_ROUNDS);
    char *const arguments[] = {program, points, rho_max, rho_cell, theta_cell, votes, rounds, NULL};
    write_points(cloud, points);
    double ms = run_for_number(arguments);
    remove(points);
    return 1e3 * ms;
}

/* ---- the table -------------------------------------------------------------------------------- */

static const char *or_dash(char text[32], const char *format, double value)
{
    snprintf(text, 32, format, value);
    return isnan(value) ? "-" : text;
}

static void add_row(const struct bench *bench, struct grid *grid,
                    struct rho_accumulator *accumulator, size_t size, unsigned count)
{
    static struct cloud cloud;
    struct rho_accumulator_result result;
    struct rho_accumulator_config config = {.rho_max_m = RHO_MAX_M,
                                            .rho_cell_m = cell_sizes[size].rho_cell_m,
                                            .theta_cell_rad = cell_sizes[size].theta_cell_rad,
                                            .min_votes = MIN_VOTES,
                                            .neighbours = 8};
    char ratio[32], opencv[32], over[32];
    scatter(&cloud, count, bench->seed);
    must_succeed(rho_accumulator_init(accumulator, sizeof *accumulator, &config), "accumulator");
    double own_us = streamed_us(accumulator, &cloud, &result);
    double whole_us = dense_us(accumulator, &cloud);
    double other_us = opencv_us(&cloud, config.rho_cell_m, config.theta_cell_rad);
    grid_row(grid, "%s|%u|%.3f|%.2f|%.1f|%s|%s|%s", cell_sizes[size].name, count, own_us / 1e3,
             1e3 * own_us / result.votes, whole_us / 1e3, or_dash(ratio, "%.0f", whole_us / own_us),
             or_dash(opencv, "%.2f", other_us / 1e3), or_dash(over, "%.1f", other_us / own_us));
    if (bench->json) {
        const char *kind = size == 0 ? "fine" : "coarse";
        char name[64];
        snprintf(name, sizeof name, "hough_%s_%u_points_us", kind, count);
        cJSON_AddNumberToObject(bench->json, name, own_us);
        snprintf(name, sizeof name, "hough_%s_%u_points_dense_us", kind, count);
        cJSON_AddNumberToObject(bench->json, name, whole_us);
        snprintf(name, sizeof name, "hough_%s_%u_points_opencv_us", kind, count);
        if (!isnan(other_us)) {
            cJSON_AddNumberToObject(bench->json, name, other_us);
        }
    }
}

void bench_hough(const struct bench *bench)
{
    struct rho_accumulator *accumulator = must_alloc(sizeof *accumulator);
    struct grid grid =
        grid_start(1, "cells|points|ms a call|ns a vote|dense ms|over|OpenCV ms|over");
    for (size_t size = 0; size < sizeof cell_sizes / sizeof cell_sizes[0]; size++) {
        for (size_t i = 0; i < sizeof point_counts / sizeof point_counts[0]; i++) {
            add_row(bench, &grid, accumulator, size, point_counts[i]);
        }
    }
    if (!bench->json) {
        printf("hough: 30 x 30 km, 7 scans, distinct scans count; streamed rows of %zu bytes\n",
               sizeof accumulator->rows);
        grid_print(&grid, stdout);
        printf("\n");
    }
    grid_free(&grid);
    free(accumulator);
}
