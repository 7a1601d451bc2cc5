/* SPDX-License-Identifier: MIT */
/* Random numbers that are the same on every machine; a test sets random_state. */
#ifndef RHOTRACK_TESTS_RANDOM_DRAWS_H
#define RHOTRACK_TESTS_RANDOM_DRAWS_H

#include <math.h>
#include <stdint.h>

static uint64_t random_state = 1;

static inline double uniform(double from, double to)
{
    random_state = random_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return from + (to - from) * (double)(random_state >> 11) / 9007199254740992.0;
}

static inline double normal(void)
{
    double radius = sqrt(-2.0 * log(1.0 - uniform(0.0, 1.0)));
    return radius * cos(uniform(0.0, 6.283185307179586));
}

#endif
