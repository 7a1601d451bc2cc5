/* SPDX-License-Identifier: MIT */
/* random_draws: random numbers for the programs in this folder, the same ones on every machine. */
#ifndef RANDOM_DRAWS_H
#define RANDOM_DRAWS_H

#include <stdint.h>

static uint32_t draw_state = 1;

static inline float draw_uniform(float low, float high)
{
    draw_state = draw_state * 1664525u + 1013904223u;
    return low + (high - low) * (float)(draw_state >> 8) / 16777216.0f;
}

/* Nearly normal with mean 0: the sum of twelve uniform numbers. */
static inline float draw_normal(float sigma)
{
    float sum = 0.0f;
    for (int i = 0; i < 12; i++) {
        sum += draw_uniform(-0.5f, 0.5f);
    }
    return sigma * sum;
}

#endif
