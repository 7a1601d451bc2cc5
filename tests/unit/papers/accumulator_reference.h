/* SPDX-License-Identifier: MIT */
/*
 * Reference of the accumulator: it holds the whole plane and is written for clarity, not speed;
 * also points and configurations for the tests that compare the streamed accumulator with it.
 */
#ifndef TEST_ACCUMULATOR_REFERENCE_H
#define TEST_ACCUMULATOR_REFERENCE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/detail/accumulator.h"

#define POINTS_MAX 2000
#define PEAKS_MAX 200000
#define DEG_RAD 0.0174532925f

static struct rho_accumulator accumulator;
static struct rho_accumulator_peak peaks[PEAKS_MAX], expected[PEAKS_MAX];
static struct rho_accumulator_result result;
static float x_m[POINTS_MAX], y_m[POINTS_MAX];
static uint32_t scan_end[RHO_ACCUMULATOR_SCANS_MAX];
static struct rho_accumulator_points points = {.x_m = x_m, .y_m = y_m, .scan_end = scan_end};
static uint64_t random_state = 1;

static inline double uniform(double from, double to)
{
    random_state = random_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return from + (to - from) * (double)(random_state >> 11) / 9007199254740992.0;
}

static uint16_t *plane; /* each cell's bit mask of scans, or number of points */
static const struct rho_accumulator_config *of;

static inline int num_theta(void)
{
    return accumulator.theta_cells;
}

static inline int num_rho(void)
{
    return accumulator.rho_cells;
}

static inline int count_bits(unsigned mask)
{
    int n = 0;
    for (; mask; mask &= mask - 1u) {
        n++;
    }
    return n;
}

static inline void fill_plane(void)
{
    plane = calloc((size_t)num_theta() * (size_t)num_rho(), sizeof *plane);
    for (int theta = 0; theta < num_theta(); theta++) {
        unsigned scan = 0, total = points.num_scans ? scan_end[points.num_scans - 1] : 0;
        for (unsigned i = 0; i < total; i++) {
            while (i >= scan_end[scan]) {
                scan++;
            }
            int rho = rho_accumulator_cell_of_point(&accumulator, (unsigned)theta, x_m[i], y_m[i]);
            if (rho >= 0) {
                uint16_t *cell = &plane[theta * num_rho() + rho];
                *cell = (uint16_t)(of->votes == RHO_VOTES_SCANS ? *cell | 1u << scan : *cell + 1u);
            }
        }
    }
}

static inline int votes_at(int theta, int rho)
{
    unsigned value = plane[theta * num_rho() + rho];
    return of->votes == RHO_VOTES_SCANS ? count_bits(value) : (int)value;
}

static inline int by_rank(const void *a, const void *b)
{
    const struct rho_accumulator_peak *p = a, *q = b;
    if (p->votes != q->votes) {
        return p->votes < q->votes ? 1 : -1;
    }
    if (p->theta_cell != q->theta_cell) {
        return p->theta_cell < q->theta_cell ? -1 : 1;
    }
    return p->rho_cell < q->rho_cell ? -1 : 1;
}

static inline uint32_t list_peaks_of_whole_plane(void)
{
    uint32_t count = 0;
    fill_plane();
    for (int theta = 0; theta < num_theta(); theta++) {
        for (int rho = 0; rho < num_rho(); rho++) {
            if (votes_at(theta, rho) < of->min_votes) {
                continue;
            }
            assert_true(count < PEAKS_MAX);
            unsigned mask = of->votes == RHO_VOTES_SCANS ? plane[theta * num_rho() + rho] : 0u;
            expected[count++] = (struct rho_accumulator_peak){(uint32_t)votes_at(theta, rho),
                                                              (uint16_t)theta, (uint16_t)rho, mask};
        }
    }
    free(plane);
    qsort(expected, count, sizeof expected[0], by_rank);
    return count;
}

static inline struct rho_accumulator_config paper_cells(void)
{
    return (struct rho_accumulator_config){
        .rho_max_m = 4300.0f, .rho_cell_m = 5.0f, .theta_cell_rad = 0.001f, .min_votes = 3};
}

static inline void init_accumulator_with_config(const struct rho_accumulator_config *config)
{
    of = config;
    assert_int_equal(rho_accumulator_init(&accumulator, sizeof accumulator, config), RHO_OK);
}

/* Draws points in a square about the origin, divided evenly among the scans. */
static inline void scatter_points(unsigned num_scans, unsigned total_points, double half_m)
{
    points.num_scans = num_scans;
    for (unsigned i = 0; i < total_points; i++) {
        x_m[i] = (float)uniform(-half_m, half_m);
        y_m[i] = (float)uniform(-half_m, half_m);
    }
    for (unsigned scan = 0; scan < num_scans; scan++) {
        scan_end[scan] = total_points * (scan + 1) / num_scans;
    }
}

static inline void find_peaks(uint32_t max_peaks)
{
    assert_int_equal(rho_accumulator_find_peaks(&accumulator, &points, peaks, max_peaks, &result),
                     RHO_OK);
}

static inline void expect_same_peaks(const struct rho_accumulator_config *config)
{
    init_accumulator_with_config(config);
    find_peaks(PEAKS_MAX);
    uint32_t count = list_peaks_of_whole_plane();
    assert_int_equal(result.num_peaks, count);
    assert_int_equal(result.peaks_dropped, 0);
    assert_memory_equal(peaks, expected, count * sizeof peaks[0]);
    assert_int_equal(result.votes_max, count ? expected[0].votes : 0);
}

#endif
