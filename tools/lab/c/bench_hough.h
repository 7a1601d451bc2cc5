/* SPDX-License-Identifier: MIT */
/*
 * bench_hough: the points of `rhotrack bench hough`, and the rivals of the accumulator on these
 * points: a dense accumulator and OpenCV's.
 */
#ifndef RHOTRACK_TOOL_BENCH_HOUGH_H
#define RHOTRACK_TOOL_BENCH_HOUGH_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/detail/accumulator.h"

#define HOUGH_SCANS 7
#define HOUGH_HALF_SIDE_M 15000.0
#define HOUGH_RHO_MAX_M 21220.0f /* distance of the area's corners from its centre */
#define HOUGH_MIN_VOTES 5
#define HOUGH_POINTS_MAX 3000

struct hough_cloud {
    unsigned count;
    float x_m[HOUGH_POINTS_MAX], y_m[HOUGH_POINTS_MAX];
    uint32_t scan_end[HOUGH_SCANS];
};

struct hough_cost {
    double us, bytes; /* time of a call and memory; NAN: not known */
};

/* The least time, of all rounds, to clear a dense plane, vote and count its peaks. */
double hough_dense_fastest_us(const struct rho_accumulator *accumulator,
                              const struct hough_cloud *cloud, int rounds);
size_t hough_dense_bytes(const struct rho_accumulator *accumulator);

/*
 * The time and memory of OpenCV's Hough transform, NAN where tests/bench/hough_opencv.cpp was not
 * built. The bytes are those of the whole program.
 */
struct hough_cost hough_opencv_cost(const struct rho_accumulator *accumulator,
                                    const struct hough_cloud *cloud, int rounds);

#endif
