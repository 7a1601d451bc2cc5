/* SPDX-License-Identifier: MIT */
/*
 * input_estimation_columns: columns of the sensitivities, and their part of an estimate. Private to
 * src/estimation/input*.c.
 */
#ifndef RHOTRACK_INPUT_ESTIMATION_COLUMNS_H
#define RHOTRACK_INPUT_ESTIMATION_COLUMNS_H

#include <stdint.h>
#include <string.h>

#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/input.h"

#define NUM_AXES RHO_INPUT_AXES
#define NUM_STATES RHO_KALMAN_STATES
#define INPUT_ALL_PRESENT 7u

/* Limit of the squared sensitivities: with it their products with any variance are finite. */
#define SENSITIVITY2_MAX 1.0e24f

/*
 * Terms added to a covariance have rounding errors of some units in the last place; what is added
 * to a variance is raised by sixteen such units, so that the covariance stays positive definite.
 */
#define ROUNDING_SHARE (1.0f / 1048576.0f)

static inline int has_axis(uint32_t axes, int axis)
{
    return (axes >> axis & 1u) != 0;
}

static inline int is_zero(float v)
{
    return !(v < 0.0f || v > 0.0f);
}

/* The bits of a number without its sign: 0 for zero. */
static inline uint32_t bits_of(float v)
{
    return rho_float_bits(v) << 1;
}

/* A term added to a variance, with the allowance for rounding. */
static inline float with_allowance(float added)
{
    return added + added * ROUNDING_SHARE;
}

/* True if only the entries of its own axis are not 0: the usual case. */
static inline int is_column_of_axis(const float m[NUM_STATES], int a)
{
    static const uint8_t others[NUM_AXES][2] = {{1, 2}, {0, 2}, {0, 1}};
    const int b = others[a][0], c = others[a][1];

    return (bits_of(m[b]) | bits_of(m[c]) | bits_of(m[b + NUM_AXES]) | bits_of(m[c + NUM_AXES])) ==
           0;
}

/* x := x + m u, p := p + v m m^T, m the column of this axis. */
static inline void add_column(struct rho_kalman *kalman, const float m[NUM_STATES], int a, float u,
                              float v)
{
    /* indices of var(position), cov(velocity, position), var(velocity) */
    static const uint8_t indices[NUM_AXES][3] = {
        {RHO_XX, RHO_AT(RHO_VX, RHO_X), RHO_AT(RHO_VX, RHO_VX)},
        {RHO_YY, RHO_AT(RHO_VY, RHO_Y), RHO_AT(RHO_VY, RHO_VY)},
        {RHO_ZZ, RHO_AT(RHO_VZ, RHO_Z), RHO_AT(RHO_VZ, RHO_VZ)}};
    float *x = kalman->state, *p = kalman->covariance;

    if (is_column_of_axis(m, a)) {
        const float place = m[a], speed = m[a + NUM_AXES];

        x[a] += place * u;
        x[a + NUM_AXES] += speed * u;
        p[indices[a][0]] += with_allowance(v * place * place);
        p[indices[a][1]] += v * place * speed;
        p[indices[a][2]] += with_allowance(v * speed * speed);
        return;
    }
    for (int i = 0; i < NUM_STATES; i++) {
        const float scaled = v * m[i];
        float *row = &p[RHO_TRIANGLE(i)];

        x[i] += m[i] * u;
        for (int j = 0; j < i; j++) {
            row[j] += scaled * m[j];
        }
        row[i] += with_allowance(scaled * m[i]);
    }
}

static inline int are_independent(const float v[RHO_TRIANGLE(NUM_AXES)])
{
    return (bits_of(v[RHO_YX]) | bits_of(v[RHO_ZX]) | bits_of(v[RHO_ZY])) == 0;
}

#endif
