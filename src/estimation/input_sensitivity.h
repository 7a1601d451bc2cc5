/* SPDX-License-Identifier: MIT */
/*
 * input_sensitivity: the sensitivity of the state to the input of each axis, one column an axis,
 * and the effect of an input on an estimate. Private to src/estimation/input_estimation_*.c.
 */
#ifndef RHOTRACK_INPUT_SENSITIVITY_H
#define RHOTRACK_INPUT_SENSITIVITY_H

#include <stdint.h>

#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/input_estimation.h"

#define NUM_AXES RHO_INPUT_AXES
#define NUM_STATES RHO_KALMAN_STATES
enum { INPUT_ALL_PRESENT = 7 };

/* Limit of squared inputs and sensitivities: their products with any variance are finite. */
#define SQUARE_MAX 1.0e24f

static inline int includes_axis(uint32_t axes, int axis)
{
    return (axes >> axis & 1u) != 0;
}

static inline int is_zero(float v)
{
    return !(v < 0.0f || v > 0.0f);
}

/*
 * A term that is added to a variance, raised by sixteen units of rounding: terms that are added to
 * a covariance have errors of some units, and it must stay positive definite.
 */
static inline float with_allowance(float added)
{
    return added + added * RHO_ROUNDING_UNITS(16);
}

/* True if a column of the sensitivities is 0 outside of its own axis: the usual case. */
static inline int is_column_uncoupled(const float sensitivity[NUM_STATES], int axis)
{
    static const uint8_t others[NUM_AXES][2] = {{1, 2}, {0, 2}, {0, 1}};
    const int b = others[axis][0], c = others[axis][1];
    return (rho_size_bits(sensitivity[b]) | rho_size_bits(sensitivity[c]) |
            rho_size_bits(sensitivity[b + NUM_AXES]) | rho_size_bits(sensitivity[c + NUM_AXES])) ==
           0;
}

/* Adds an input u with variance v: x + m u, p + v m m^T, m the axis' column of sensitivities. */
static inline void add_input_effect(struct rho_kalman *kalman, const float sensitivity[NUM_STATES],
                                    int axis, float input_mps2, float variance)
{
    /* indices of var(position), cov(velocity, position), var(velocity) */
    static const uint8_t indices[NUM_AXES][3] = {
        {RHO_XX, RHO_AT(RHO_VX, RHO_X), RHO_AT(RHO_VX, RHO_VX)},
        {RHO_YY, RHO_AT(RHO_VY, RHO_Y), RHO_AT(RHO_VY, RHO_VY)},
        {RHO_ZZ, RHO_AT(RHO_VZ, RHO_Z), RHO_AT(RHO_VZ, RHO_VZ)}};
    float *x = kalman->state, *p = kalman->covariance;
    if (is_column_uncoupled(sensitivity, axis)) {
        const float place = sensitivity[axis], speed = sensitivity[axis + NUM_AXES];
        x[axis] += place * input_mps2;
        x[axis + NUM_AXES] += speed * input_mps2;
        p[indices[axis][0]] += with_allowance(variance * place * place);
        p[indices[axis][1]] += variance * place * speed;
        p[indices[axis][2]] += with_allowance(variance * speed * speed);
        return;
    }
    for (int i = 0; i < NUM_STATES; i++) {
        const float scaled = variance * sensitivity[i];
        float *row = &p[RHO_TRIANGLE(i)];
        x[i] += sensitivity[i] * input_mps2;
        for (int j = 0; j < i; j++) {
            row[j] += scaled * sensitivity[j];
        }
        row[i] += with_allowance(scaled * sensitivity[i]);
    }
}

static inline int are_inputs_independent(const float v[RHO_TRIANGLE(NUM_AXES)])
{
    return (rho_size_bits(v[RHO_YX]) | rho_size_bits(v[RHO_ZX]) | rho_size_bits(v[RHO_ZY])) == 0;
}

#endif
