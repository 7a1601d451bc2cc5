/* SPDX-License-Identifier: MIT */
/*
 * How a window codes standard deviations: the upper 16 bits below the sign of a float32, exponents
 * from 2^-10 on. Private to src/initiation/window*.c.
 */
#ifndef RHOTRACK_WINDOW_SIGMA_H
#define RHOTRACK_WINDOW_SIGMA_H

#include <stdint.h>

#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/window.h"

/* Exponent of the least code, 2^-10, as a float32 has it. */
#define SIGMA_EXPONENT (117u << 23)
#define SIGMA_SHIFT 12

/* To the nearest code. */
static inline uint16_t sigma_code(float sigma)
{
    uint32_t bits = rho_float_bits(sigma);
    return (uint16_t)((bits + (1u << (SIGMA_SHIFT - 1)) - SIGMA_EXPONENT) >> SIGMA_SHIFT);
}

static inline float sigma_of(uint16_t code)
{
    return rho_float_of(((uint32_t)code << SIGMA_SHIFT) + SIGMA_EXPONENT);
}

static inline uint16_t larger_sigma(const struct rho_window_plot *plot)
{
    return plot->sigma_range > plot->sigma_cross ? plot->sigma_range : plot->sigma_cross;
}

#endif
