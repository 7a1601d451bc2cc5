/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/approx.h"

#include <float.h>
#include <stdint.h>

/*
 * Float arithmetic must be done in float: s390x with gcc -std=c99, x87, and rearranged arithmetic
 * compute other bits. FLT_EVAL_METHOD 16 is about half precision; float is computed as float.
 */
#if FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16
#error "float must be computed as float: -fexcess-precision=fast (s390x), -msse2 -mfpmath=sse (x86)"
#endif
#if defined __FAST_MATH__ || defined __ASSOCIATIVE_MATH__ || defined __RECIPROCAL_MATH__ ||        \
    (defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__)
#error "-ffast-math, and what is part of it, change what the library computes"
#endif

#define BITS_INFINITY 0x7f800000u
#define BITS_NAN 0x7fc00000u
#define EXPONENT_SHIFT 23
#define EXPONENT_BIAS 127
#define FRACTION_MASK 0x007fffffu
#define FRACTION_ONE 0x00800000u

#define TRIG_LIMIT_RAD 100.0f
#define TWO_OVER_PI 0.636619772f

/*
 * pi/2 in three parts (Cody and Waite). The first two have so few bits that their products with
 * a quarter-turn count up to 64 are exact.
 */
#define QUARTER_HIGH 1.5703125f
#define QUARTER_MIDDLE 4.83751296997070312e-4f
#define QUARTER_LOW 7.54978995489188216e-8f

/* ln 2 in two parts: the product of the first one with an exponent up to 150 is exact. */
#define LN2_HIGH 0.693359375f
#define LN2_LOW (-2.12194440e-4f)
#define LOG2_E 1.44269504f
#define EXP_LOWEST (-87.0f)
#define EXP_HIGHEST 88.0f

/*
 * The processor's square root instruction. RHO_SOFTWARE_ROOT disables it, to test the code for
 * processors without one.
 */
#if defined __GNUC__ && !defined RHO_SOFTWARE_ROOT
#if defined __SSE__
/* operand order of both assembler dialects (-masm) */
#define ROOT_INSTRUCTION "sqrtss {%1, %0|%0, %1}"
#define ROOT_REGISTER "x"
#elif defined __aarch64__
#define ROOT_INSTRUCTION "fsqrt %s0, %s1"
#define ROOT_REGISTER "w"
#elif defined __arm__ && defined __ARM_FP && (__ARM_FP & 4)
#define ROOT_INSTRUCTION "vsqrt.f32 %0, %1"
#define ROOT_REGISTER "t"
#elif defined __riscv_flen && __riscv_flen >= 32
#define ROOT_INSTRUCTION "fsqrt.s %0, %1"
#define ROOT_REGISTER "f"
#endif
#endif

#define SQRT_HALF 0.707106781f
#define TAN_PI_8 0.414213562f
#define QUARTER_PI 0.785398163f

static int32_t nearest_integer(float v)
{
    return (int32_t)(v < 0.0f ? v - 0.5f : v + 0.5f);
}

/* Minimax polynomials on |r| <= pi/4: S. Moshier, Cephes library, sinf.c. */
static float sine_kernel(float r)
{
    const float z = r * r;

    return ((-1.9515295891e-4f * z + 8.3321608736e-3f) * z - 1.6666654611e-1f) * z * r + r;
}

static float cosine_kernel(float r)
{
    const float z = r * r;

    return ((2.443315711809948e-5f * z - 1.388731625493765e-3f) * z + 4.166664568298827e-2f) * z *
               z -
           0.5f * z + 1.0f;
}

/* sin(angle + quarters * pi/2): quarters 1 gives the cosine. NaN beyond TRIG_LIMIT_RAD. */
static float sine_plus_quarters(float angle_rad, uint32_t quarters)
{
    int32_t count;
    uint32_t quadrant;
    float k, r, sine;

    if (!(angle_rad >= -TRIG_LIMIT_RAD && angle_rad <= TRIG_LIMIT_RAD)) {
        return rho_float_of(BITS_NAN);
    }
    count = nearest_integer(angle_rad * TWO_OVER_PI);
    k = (float)count;
    r = ((angle_rad - k * QUARTER_HIGH) - k * QUARTER_MIDDLE) - k * QUARTER_LOW;
    quadrant = (uint32_t)count + quarters;
    sine = (quadrant & 1u) != 0u ? cosine_kernel(r) : sine_kernel(r);
    return (quadrant & 2u) != 0u ? -sine : sine;
}

/* atan(t) for 0 <= t <= 1: Cephes, atanf.c. */
static float atan_unit(float t)
{
    const int is_upper = t > TAN_PI_8;
    const float u = is_upper ? (t - 1.0f) / (t + 1.0f) : t;
    const float z = u * u;
    const float angle = (((8.05374449538e-2f * z - 1.38776856032e-1f) * z + 1.99777106478e-1f) * z -
                         3.33329491539e-1f) *
                            z * u +
                        u;

    return is_upper ? QUARTER_PI + angle : angle;
}

/* ln(1 + f) + f^2/2 - f for sqrt(1/2) <= 1 + f < sqrt(2): Cephes, logf.c. */
static float log_series_beyond_square(float f)
{
    float y = 7.0376836292e-2f;

    y = y * f - 1.1514610310e-1f;
    y = y * f + 1.1676998740e-1f;
    y = y * f - 1.2420140846e-1f;
    y = y * f + 1.4249322787e-1f;
    y = y * f - 1.6668057665e-1f;
    y = y * f + 2.0000714765e-1f;
    y = y * f - 2.4999993993e-1f;
    y = y * f + 3.3333331174e-1f;
    return y * f * f * f;
}

float rho_sin(float angle_rad)
{
    return sine_plus_quarters(angle_rad, 0u);
}

float rho_cos(float angle_rad)
{
    return sine_plus_quarters(angle_rad, 1u);
}

float rho_atan2(float y, float x)
{
    const float size_y = y < 0.0f ? -y : y;
    const float size_x = x < 0.0f ? -x : x;
    const int is_steep = size_y > size_x;
    const float longer = is_steep ? size_y : size_x;
    float angle;

    if (!(size_y <= FLT_MAX && size_x <= FLT_MAX)) {
        return rho_float_of(BITS_NAN);
    }
    if (!(longer > 0.0f)) {
        return 0.0f;
    }
    angle = atan_unit((is_steep ? size_x : size_y) / longer);
    angle = is_steep ? RHO_HALF_PI - angle : angle;
    angle = x < 0.0f ? RHO_PI - angle : angle;
    return y < 0.0f ? -angle : angle;
}

/* e^v = 2^n e^r, |r| <= ln(2)/2; the polynomial is Cephes, expf.c. */
float rho_exp(float v)
{
    int32_t n;
    float r, y;

    if (!(v >= EXP_LOWEST && v <= EXP_HIGHEST)) {
        return v < EXP_LOWEST ? 0.0f : rho_float_of(v > EXP_HIGHEST ? BITS_INFINITY : BITS_NAN);
    }
    n = nearest_integer(v * LOG2_E);
    r = (v - (float)n * LN2_HIGH) - (float)n * LN2_LOW;
    y = 1.9875691500e-4f;
    y = y * r + 1.3981999507e-3f;
    y = y * r + 8.3334519073e-3f;
    y = y * r + 4.1665795894e-2f;
    y = y * r + 1.6666665459e-1f;
    y = y * r + 5.0000001201e-1f;
    y = y * r * r + r + 1.0f;
    return y * rho_float_of((uint32_t)(n + EXPONENT_BIAS) << EXPONENT_SHIFT);
}

float rho_log(float v)
{
    uint32_t bits = rho_float_bits(v);
    int32_t exponent = -(EXPONENT_BIAS - 1);
    float f, k;

    if (!(v >= FLT_MIN && v <= FLT_MAX)) {
        if (!(v > 0.0f && v <= FLT_MAX)) {
            return v > 0.0f ? v : rho_float_of(v >= 0.0f ? BITS_INFINITY | 0x80000000u : BITS_NAN);
        }
        bits = rho_float_bits(v * 8388608.0f); /* scales a subnormal number up by 2^23 */
        exponent -= EXPONENT_SHIFT;
    }
    exponent += (int32_t)(bits >> EXPONENT_SHIFT);
    f = rho_float_of((bits & FRACTION_MASK) | rho_float_bits(0.5f));
    if (f < SQRT_HALF) {
        f += f;
        --exponent;
    }
    f -= 1.0f;
    k = (float)exponent;
    return f + (log_series_beyond_square(f) + k * LN2_LOW - 0.5f * f * f) + k * LN2_HIGH;
}

/* ln(1 + v) by a polynomial that is fitted to ln(1 + v) / v for the least absolute error. */
float rho_log_one_plus(float zero_to_one)
{
    float y = -6.4526148e-3f;

    y = y * zero_to_one + 3.6084529e-2f;
    y = y * zero_to_one - 9.5322505e-2f;
    y = y * zero_to_one + 1.6764787e-1f;
    y = y * zero_to_one - 2.4073076e-1f;
    y = y * zero_to_one + 3.3179826e-1f;
    y = y * zero_to_one - 4.9987406e-1f;
    y = y * zero_to_one + 9.9999642e-1f;
    return y * zero_to_one;
}

#if defined ROOT_INSTRUCTION

/*
 * Square root by the processor's instruction: correctly rounded, so its bits are those of the
 * software version, in one instruction instead of forty.
 */
static float square_root(float v)
{
    float root;

    __asm__(ROOT_INSTRUCTION : "=" ROOT_REGISTER(root) : ROOT_REGISTER(v));
    return root;
}

#else

/*
 * Square root of m * 2^23 for 2^23 <= m < 2^25, to the nearest integer. Newton's iteration for
 * 1/sqrt gives an estimate that is a few units off. The remainder fits 32 bits though m * 2^23 does
 * not; it tells the error in units, and settles the last unit exactly. A root is never half an
 * integer, so there are no ties.
 */
static uint32_t rounded_root_of_shifted_23(uint32_t m)
{
    const float x = (float)m * (1.0f / 8388608.0f);
    float y = rho_float_of(0x5f3759dfu - (rho_float_bits(x) >> 1));
    uint32_t root;
    int32_t rest, missing;
    int i;

    for (i = 0; i < 3; ++i) {
        y = y * (1.5f - 0.5f * x * y * y);
    }
    root = (uint32_t)(x * y * 8388608.0f);
    rest = (int32_t)((m << EXPONENT_SHIFT) - root * root);
    /* rest / (2 root): units that the estimate is too small */
    missing = (int32_t)((float)rest * y * (1.0f / 16777216.0f));
    rest -= missing * (int32_t)(2u * root + (uint32_t)missing);
    root += (uint32_t)missing;
    return root + (uint32_t)(rest > (int32_t)root) - (uint32_t)(rest <= -(int32_t)root);
}

/* Square root of 0 < v <= FLT_MAX, correctly rounded, by integer arithmetic. */
static float square_root(float v)
{
    const int is_subnormal = v < FLT_MIN;
    const uint32_t bits = rho_float_bits(is_subnormal ? v * 16777216.0f : v);
    const uint32_t exponent = bits >> EXPONENT_SHIFT;
    uint32_t m = (bits & FRACTION_MASK) | FRACTION_ONE;
    uint32_t half;

    m <<= (exponent + 1u) & 1u; /* makes the exponent even, so that it can be halved */
    half = ((exponent + EXPONENT_BIAS) >> 1) - (is_subnormal ? 12u : 0u);
    return rho_float_of((half << EXPONENT_SHIFT) + (rounded_root_of_shifted_23(m) - FRACTION_ONE));
}

#endif

float rho_sqrt(float v)
{
    if (!(v > 0.0f && v <= FLT_MAX)) {
        return v >= 0.0f ? v : rho_float_of(BITS_NAN);
    }
    return square_root(v);
}

/* 1 / sqrt(v): a first guess by halving the exponent's bits, and three steps of Newton's method. */
float rho_inverse_sqrt(float v)
{
    const float half = 0.5f * v;
    float root = rho_float_of(0x5f375a86u - (rho_float_bits(v) >> 1));

    root *= 1.5f - half * root * root;
    root *= 1.5f - half * root * root;
    root *= 1.5f - half * root * root;
    return root;
}
