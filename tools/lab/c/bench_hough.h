/* SPDX-License-Identifier: MIT */
/*
 * bench_hough: the points of `rhotrack bench hough`, and what the accumulator is compared with on
 * them.
 */
#ifndef RHOTRACK_TOOL_BENCH_HOUGH_H
#define RHOTRACK_TOOL_BENCH_HOUGH_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/detail/accumulator.h"

#define HOUGH_SCANS 7
#define HOUGH_HALF_SIDE_M 15000.0
#define HOUGH_RHO_MAX_M 21220.0f /* of its corners */
#define HOUGH_MIN_VOTES 5
#define HOUGH_POINTS_MAX 3000

struct hough_cloud {
    unsigned count;
    float x_m[HOUGH_POINTS_MAX], y_m[HOUGH_POINTS_MAX];
    uint32_t scan_end[HOUGH_SCANS];
};

struct hough_cost {
    double us, bytes; /* NAN: not known */
};

/* A whole plane in plain C: clears, votes, finds the peaks; the least time of a call. */
double hough_dense_us(const struct rho_accumulator *accumulator, const struct hough_cloud *cloud,
                      int rounds);
size_t hough_dense_bytes(const struct rho_accumulator *accumulator);

/*
 * OpenCV's; NAN where tests/bench/hough_opencv.cpp was not built. The bytes are the whole
 * program's.
 */
struct hough_cost hough_opencv(const struct rho_accumulator *accumulator,
                               const struct hough_cloud *cloud, int rounds);

#endif
