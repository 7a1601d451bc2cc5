/* SPDX-License-Identifier: MIT */
/* bench: declarations that the parts of `rhotrack bench` share. */
#ifndef RHOTRACK_TOOL_BENCH_H
#define RHOTRACK_TOOL_BENCH_H

#include <cjson/cJSON.h>
#include <stdint.h>

#define BENCH_ROUNDS 7

struct bench {
    cJSON *json; /* results go here; NULL: tables are printed */
    uint64_t seed;
};

/*
 * Compares the Hough accumulator with a dense one, and with OpenCV's where
 * tests/bench/hough_opencv.cpp was built.
 */
void bench_hough(const struct bench *bench);

/* Times searches of batches of bearings; the JSON gets an object "passive". */
void bench_passive(const struct bench *bench);

/*
 * Times the way from a scan's datagrams to its tracks through a node in another process, and the
 * codec of messages; the JSON gets an object "node".
 */
void bench_node(const struct bench *bench);

/* Compares the slowest scan of 5000 plots of several shapes with the median of uniform clutter. */
void bench_arrangements(const struct bench *bench);

#endif
