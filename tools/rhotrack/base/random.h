/* SPDX-License-Identifier: MIT */
/*
 * random: own random numbers, the same on every machine.
 *
 * xoshiro256** (Blackman and Vigna, "Scrambled linear pseudorandom number generators", ACM TOMS 47,
 * 2021), seeded by splitmix64 from three numbers, so that every case and run of an experiment has a
 * generator of its own. Normal numbers come from a ratio of uniforms: libm decides there, rarely,
 * but enters no result.
 */
#ifndef RHOTRACK_TOOL_RANDOM_H
#define RHOTRACK_TOOL_RANDOM_H

#include <stdint.h>

struct random {
    uint64_t state[4];
};

/* The generator of one (seed, stream, run). */
struct random random_start(uint64_t seed, uint64_t stream, uint64_t run);

uint64_t random_bits(struct random *random);

/* 0 <= u < 1, 53 bits. */
double random_uniform(struct random *random);

/* lo <= u < hi. */
double random_between(struct random *random, double lo, double hi);

/* 0 .. n - 1, each equally likely; n > 0. */
uint64_t random_below(struct random *random, uint64_t n);

/* Mean 0, variance 1. */
double random_normal(struct random *random);

/* Poisson; mean 0 .. 1e7. Cost: mean. */
uint64_t random_poisson(struct random *random, double mean);

#endif
