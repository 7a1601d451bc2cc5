/* SPDX-License-Identifier: MIT */
/*
 * random: a pseudorandom generator with the same numbers on every machine.
 *
 * xoshiro256** (Blackman and Vigna, "Scrambled linear pseudorandom number generators", ACM TOMS 47,
 * 2021), seeded by splitmix64 from three numbers, so that each case and run of an experiment has
 * its own generator. Normal deviates come from a ratio of uniforms, where libm's logarithm rarely
 * decides whether a deviate is accepted, and never enters its value.
 */
#ifndef RHOTRACK_TOOL_RANDOM_H
#define RHOTRACK_TOOL_RANDOM_H

#include <stdint.h>

struct random {
    uint64_t state[4];
};

/* Generator for one combination of seed, stream and run. */
struct random random_start(uint64_t seed, uint64_t stream, uint64_t run);

uint64_t random_bits(struct random *random);

/* Uniform in 0 <= u < 1, with 53 random bits. */
double random_uniform(struct random *random);

/* Uniform in lo <= u < hi. */
double random_between(struct random *random, double lo, double hi);

/* Uniform whole number in 0 .. n - 1, n > 0. */
uint64_t random_below(struct random *random, uint64_t n);

/* Normal deviate of mean 0 and variance 1. */
double random_normal(struct random *random);

/* Poisson deviate, mean 0 .. 1e7; the cost is proportional to the mean. */
uint64_t random_poisson(struct random *random, double mean);

#endif
