/* SPDX-License-Identifier: MIT */
/*
 * approx: elementary functions in float32.
 *
 * The library has its own functions so that tracks are the same on every machine: libm differs
 * between newlib and glibc, and newlib's versions need errno. Only +, -, *, / and the square root
 * of IEEE binary32, and integer operations: the same bits on every machine. No state, no loops over
 * data, constant cost. Errors below are against exact arithmetic over the whole stated range,
 * checked by tests/unit/base/test_approx.c. NaN in gives NaN out. Stack: 32 bytes at most.
 */
#ifndef RHOTRACK_APPROX_H
#define RHOTRACK_APPROX_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RHO_PI 3.14159274f
#define RHO_TWO_PI 6.28318548f
#define RHO_HALF_PI 1.57079637f
#define RHO_LOG_TWO_PI 1.83787707f
#define RHO_ROOT_TWO_PI 2.50662827f

/* Largest angle of rho_sin, rho_cos and rho_angle_wrap, either way: 16 turns. */
#define RHO_ANGLE_MAX_RAD 100.0f

/* A float's bits, and back. By a union: a freestanding memcpy is a call. No stack. */
union rho_binary32 {
    float v;
    uint32_t bits;
};

static inline uint32_t rho_float_bits(float v)
{
    union rho_binary32 binary;
    binary.v = v;
    return binary.bits;
}

static inline float rho_float_of(uint32_t bits)
{
    union rho_binary32 binary;
    binary.bits = bits;
    return binary.v;
}

/* Bits of a float without its sign: 0 for +0 and -0 alone. No stack. */
static inline uint32_t rho_size_bits(float v)
{
    return rho_float_bits(v) << 1;
}

/*
 * angle_rad - quarters pi/2, with pi/2 in three parts (Cody and Waite). The first two have so few
 * bits that their products with a count up to 64 are exact. No stack.
 */
static inline float rho_minus_quarters(float angle_rad, float quarters)
{
    return ((angle_rad - quarters * 1.5703125f) - quarters * 4.83751296997070312e-4f) -
           quarters * 7.54978995489188216e-8f;
}

/* The larger and the smaller of two numbers; b where they cannot be compared (NaN). No stack. */
static inline float rho_larger(float a, float b)
{
    return a > b ? a : b;
}

static inline float rho_smaller(float a, float b)
{
    return a < b ? a : b;
}

/* A number without its sign; -0 and NaN stay. No stack. */
static inline float rho_magnitude(float v)
{
    return v < 0.0f ? -v : v;
}

/* True where two numbers are the same, without a comparison that compilers warn of. No stack. */
static inline int rho_is_equal(float a, float b)
{
    return a <= b && a >= b;
}

static inline float rho_square(float v)
{
    return v * v;
}

/* The cell of 0 .. n - 1 nearest to a place counted in cells; NaN: 0. No stack. */
static inline int rho_cell_at(float place, int n)
{
    return place > 0.0f ? place < (float)n ? (int)place : n - 1 : 0;
}

/* Sine and cosine of an angle, |angle_rad| <= 100, NaN beyond. Absolute error <= 1e-7. */
float rho_sin(float angle_rad);
float rho_cos(float angle_rad);

/*
 * Angle of the point (x, y) in radians, -pi .. pi, counter-clockwise from +x. Absolute error <=
 * 3e-7. (0, 0) gives 0; -0 counts as 0. Infinite arguments give NaN.
 */
float rho_atan2(float y, float x);

/* e^v. Relative error <= 1e-7 for -87 <= v <= 88; 0 below, +infinity above. */
float rho_exp(float v);

/*
 * Natural logarithm of v > 0, subnormal v included. Relative error <= 1e-7 + 1e-7 absolute. 0:
 * -infinity; v < 0: NaN; +infinity: +infinity.
 */
float rho_log(float v);

/* ln(1 + zero_to_one), of 0 .. 1 alone: absolute error <= 2e-7. A third of rho_log's cost. */
float rho_log_one_plus(float zero_to_one);

/*
 * Square root of v >= 0, correctly rounded as IEEE 754 demands. v < 0: NaN. +infinity: +infinity.
 * The processor's own instruction where gcc or clang know one, else some 40 instructions.
 */
float rho_sqrt(float v);

/*
 * 1 / sqrt(v) of FLT_MIN .. FLT_MAX alone: relative error <= 3e-7. Some 20 instructions: for
 * probability densities, which do not need rho_sqrt's last digits.
 */
float rho_inverse_sqrt(float v);

#ifdef __cplusplus
}
#endif

#endif
