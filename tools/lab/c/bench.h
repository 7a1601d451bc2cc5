/* SPDX-License-Identifier: MIT */
/* bench: what the parts of `rhotrack bench` share. */
#ifndef RHOTRACK_TOOL_BENCH_H
#define RHOTRACK_TOOL_BENCH_H

#include <cjson/cJSON.h>
#include <stdint.h>

#define BENCH_ROUNDS 7

struct bench {
    cJSON *json; /* NULL: tables are wanted */
    uint64_t seed;
};

/*
 * The Hough accumulator against a dense one, and against OpenCV where tests/bench/hough_opencv.cpp
 * was built.
 */
void bench_hough(const struct bench *bench);

/* Searches of bearings; in JSON an object of its own. */
void bench_passive(const struct bench *bench);

/*
 * From a scan's datagrams to its tracks, with a node as a process of its own; and the codec. In
 * JSON an object.
 */
void bench_node(const struct bench *bench);

/* The worst scans of 5000 plots, however they lie, over the median of evenly spread ones. */
void bench_work(const struct bench *bench);

#endif
