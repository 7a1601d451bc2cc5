/* SPDX-License-Identifier: MIT */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/common.h"
#include "bench_hough.h"

/* ---- the dense accumulator ------------------------------------------------------------------- */

static unsigned count_bits(unsigned mask)
{
    unsigned n = 0;
    for (; mask; mask &= mask - 1u) {
        n++;
    }
    return n;
}

static void vote_in_dense_plane(const struct rho_accumulator *accumulator,
                                const struct hough_cloud *cloud, uint16_t *plane, size_t width)
{
    float per_m = 1.0f / accumulator->config.rho_cell_m, first = HOUGH_RHO_MAX_M * per_m;
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

/* Counts cells with enough votes. */
static unsigned count_peaks(const uint16_t *plane, size_t width, size_t height)
{
    unsigned count = 0;
    for (size_t i = 0; i < width * height; i++) {
        count += plane[i] && count_bits(plane[i]) >= HOUGH_MIN_VOTES;
    }
    return count;
}

static size_t dense_plane_width(const struct rho_accumulator *accumulator)
{
    return accumulator->rho_cells + 2u;
}

size_t hough_dense_bytes(const struct rho_accumulator *accumulator)
{
    return dense_plane_width(accumulator) * accumulator->theta_cells * sizeof(uint16_t);
}

double hough_dense_fastest_us(const struct rho_accumulator *accumulator,
                              const struct hough_cloud *cloud, int rounds)
{
    size_t width = dense_plane_width(accumulator), height = accumulator->theta_cells;
    uint16_t *plane = must_calloc(width * height, sizeof *plane);
    double best_us = INFINITY;
    for (int round = 0; round < rounds; round++) {
        int64_t start_us = monotonic_clock_us();
        memset(plane, 0, width * height * sizeof *plane);
        vote_in_dense_plane(accumulator, cloud, plane, width);
        if (count_peaks(plane, width, height) > width * height) {
            fail(EXIT_RUNTIME, "more peaks than cells");
        }
        best_us = fmin(best_us, (double)(monotonic_clock_us() - start_us));
    }
    free(plane);
    return best_us;
}

/* ---- OpenCV ---------------------------------------------------------------------------------- */

/* The path of tests/bench/hough_opencv beside this program; NULL where it was not built. */
static const char *find_opencv_program(char path[512])
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

static void write_points(const struct hough_cloud *cloud, const char *path)
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

/*
 * Runs a program and returns the number that it prints on standard output, or NAN when it prints
 * none; *bytes_max is the greatest memory that the program used.
 */
static double run_program_for_number(char *const arguments[], double *bytes_max)
{
    char answer[64] = "";
    struct rusage usage = {0};
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
        wait4(child, NULL, 0, &usage);
    }
    *bytes_max = 1024.0 * (double)usage.ru_maxrss;
    char *end = answer;
    double value = length > 0 ? strtod(answer, &end) : 0.0;
    return end == answer ? NAN : value;
}

struct hough_cost hough_opencv_cost(const struct rho_accumulator *accumulator,
                                    const struct hough_cloud *cloud, int rounds)
{
    char program[512], points[64], rho_max[32], rho_cell[32], theta_cell[32], votes[16], times[16];
    struct hough_cost cost = {NAN, NAN};
    if (!find_opencv_program(program)) {
        return cost;
    }
    snprintf(points, sizeof points, "/tmp/rhotrack-hough-%ld", (long)getpid());
    snprintf(rho_max, sizeof rho_max, "%g", (double)HOUGH_RHO_MAX_M);
    snprintf(rho_cell, sizeof rho_cell, "%g", (double)accumulator->config.rho_cell_m);
    snprintf(theta_cell, sizeof theta_cell, "%.9g", (double)accumulator->config.theta_cell_rad);
    snprintf(votes, sizeof votes, "%d", HOUGH_MIN_VOTES);
    snprintf(times, sizeof times, "%d", rounds);
    char *const arguments[] = {program, points, rho_max, rho_cell, theta_cell, votes, times, NULL};
    write_points(cloud, points);
    cost.us = 1e3 * run_program_for_number(arguments, &cost.bytes);
    remove(points);
    return cost;
}
