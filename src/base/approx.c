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

/* Parts of a float's bits. */
enum {
    BITS_INFINITY = 0x7f800000,
    BITS_NAN = 0x7fc00000,
    EXPONENT_SHIFT = 23,
    EXPONENT_BIAS = 127,
    FRACTION_MASK = 0x007fffff,
    FRACTION_ONE = 0x00800000
};

/* ln 2 in two parts: the product of the first one with an exponent up to 150 is exact. */
#define LN2_HIGH 0.693359375f
#define LN2_LOW (-2.12194440e-4f)

/* The processor's square root; RHO_SOFTWARE_ROOT disables it, to test the code without one. */
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

static int32_t nearest_integer(float v)
{
    return (int32_t)(v < 0.0f ? v - 0.5f : v + 0.5f);
}

/* sin(angle + quarters * pi/2): quarters 1 gives the cosine. NaN beyond RHO_ANGLE_MAX_RAD. */
static float sine_plus_quarters(float angle_rad, uint32_t quarters)
{
    if (!(angle_rad >= -RHO_ANGLE_MAX_RAD && angle_rad <= RHO_ANGLE_MAX_RAD)) {
        return rho_float_of(BITS_NAN);
    }
    const int32_t count = nearest_integer(angle_rad * 0.636619772f); /* 2 / pi */
    const float r = rho_minus_quarters(angle_rad, (float)count), z = r * r;
    const uint32_t quadrant = (uint32_t)count + quarters;
    /* minimax polynomials on |r| <= pi/4: S. Moshier, Cephes library, sinf.c */
    const float sine =
        (quadrant & 1u) != 0u
            ? ((2.443315711809948e-5f * z - 1.388731625493765e-3f) * z + 4.166664568298827e-2f) *
                      z * z -
                  0.5f * z + 1.0f
            : ((-1.9515295891e-4f * z + 8.3321608736e-3f) * z - 1.6666654611e-1f) * z * r + r;
    return (quadrant & 2u) != 0u ? -sine : sine;
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
    if (!(size_y <= FLT_MAX && size_x <= FLT_MAX)) {
        return rho_float_of(BITS_NAN);
    }
    if (!(longer > 0.0f)) {
        return 0.0f;
    }
    /* atan(t) for 0 <= t <= 1, above tan(pi/8) by way of pi/4: Cephes, atanf.c */
    const float t = (is_steep ? size_x : size_y) / longer;
    const int is_upper = t > 0.414213562f;
    const float u = is_upper ? (t - 1.0f) / (t + 1.0f) : t, z = u * u;
    float angle = (((8.05374449538e-2f * z - 1.38776856032e-1f) * z + 1.99777106478e-1f) * z -
                   3.33329491539e-1f) *
                      z * u +
                  u;
    angle = is_upper ? 0.5f * RHO_HALF_PI + angle : angle;
    angle = is_steep ? RHO_HALF_PI - angle : angle;
    angle = x < 0.0f ? RHO_PI - angle : angle;
    return y < 0.0f ? -angle : angle;
}

/* e^v = 2^n e^r, |r| <= ln(2)/2; the polynomial is Cephes, expf.c. */
float rho_exp(float v)
{
    if (!(v >= -87.0f && v <= 88.0f)) {
        return v < -87.0f ? 0.0f : rho_float_of(v > 88.0f ? BITS_INFINITY : BITS_NAN);
    }
    const int32_t n = nearest_integer(v * 1.44269504f); /* 1 / ln 2 */
    const float r = (v - (float)n * LN2_HIGH) - (float)n * LN2_LOW;
    float y = 1.9875691500e-4f;
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
    if (!(v >= FLT_MIN && v <= FLT_MAX)) {
        if (!(v > 0.0f && v <= FLT_MAX)) {
            return v > 0.0f ? v : rho_float_of(v >= 0.0f ? BITS_INFINITY | 0x80000000u : BITS_NAN);
        }
        bits = rho_float_bits(v * 8388608.0f); /* scales a subnormal number up by 2^23 */
        exponent -= EXPONENT_SHIFT;
    }
    exponent += (int32_t)(bits >> EXPONENT_SHIFT);
    float f = rho_float_of((bits & FRACTION_MASK) | rho_float_bits(0.5f));
    if (f < 0.707106781f) { /* the root of 1/2 */
        f += f;
        --exponent;
    }
    f -= 1.0f;
    /* ln(1 + f) + f^2/2 - f for sqrt(1/2) <= 1 + f < sqrt(2): Cephes, logf.c */
    float y = 7.0376836292e-2f;
    y = y * f - 1.1514610310e-1f;
    y = y * f + 1.1676998740e-1f;
    y = y * f - 1.2420140846e-1f;
    y = y * f + 1.4249322787e-1f;
    y = y * f - 1.6668057665e-1f;
    y = y * f + 2.0000714765e-1f;
    y = y * f - 2.4999993993e-1f;
    y = y * f + 3.3333331174e-1f;
    y = y * f * f * f;
    const float k = (float)exponent;
    return f + (y + k * LN2_LOW - 0.5f * f * f) + k * LN2_HIGH;
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

/* The processor's square root: correctly rounded, so its bits are those of the software's. */
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
    for (int i = 0; i < 3; ++i) {
        y = y * (1.5f - 0.5f * x * y * y);
    }
    uint32_t root = (uint32_t)(x * y * 8388608.0f);
    int32_t rest = (int32_t)((m << EXPONENT_SHIFT) - root * root);
    /* rest / (2 root): units that the estimate is too small */
    const int32_t missing = (int32_t)((float)rest * y * (1.0f / 16777216.0f));
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
    m <<= (exponent + 1u) & 1u; /* makes the exponent even, so that it can be halved */
    const uint32_t half = ((exponent + EXPONENT_BIAS) >> 1) - (is_subnormal ? 12u : 0u);
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
