/* SPDX-License-Identifier: MIT */
/*
 * sigma_code: the 16-bit code of standard deviations in a window: the upper 16 bits below the
 * sign of a float32, whose exponents count from 2^-10. Private to src/window.
 */
#ifndef RHOTRACK_SIGMA_CODE_H
#define RHOTRACK_SIGMA_CODE_H

#include <stdint.h>

#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/window.h"

enum {
    SIGMA_SHIFT = 12,
    SIGMA_EXPONENT = 117 << 23, /* of the smallest code, 2^-10, in the bits of a float32 */
};

/* The code nearest to a standard deviation. */
static inline uint16_t code_of_sigma(float sigma)
{
    uint32_t bits = rho_float_bits(sigma);
    return (uint16_t)((bits + (1u << (SIGMA_SHIFT - 1)) - SIGMA_EXPONENT) >> SIGMA_SHIFT);
}

static inline float sigma_of_code(uint16_t code)
{
    return rho_float_of(((uint32_t)code << SIGMA_SHIFT) + SIGMA_EXPONENT);
}

static inline uint16_t larger_sigma_code(const struct rho_window_plot *plot)
{
    return plot->sigma_range > plot->sigma_cross ? plot->sigma_range : plot->sigma_cross;
}

#endif
