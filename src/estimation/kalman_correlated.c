/* SPDX-License-Identifier: MIT */
/*
 * kalman_correlated: Kalman update with several elements of the state that were measured with
 * correlated noise.
 */
#include <stddef.h>
#include <string.h>

#include "rhotrack/detail/kalman.h"

/* Smallest pivot as a share of the element's variance: four units of float32's rounding. */
#define PIVOT_LEAST (1.0f / 4194304.0f)

/* Measurements made independent: rows of L^-1 H, innovations L^-1 y, and noise variances D. */
struct decorrelated_rows {
    int num;
    float row[RHO_KALMAN_STATES][RHO_KALMAN_STATES];
    float off[RHO_KALMAN_STATES];
    float variance[RHO_KALMAN_STATES];
};

static int are_valid_measurements(int num, const int elements[], const float values[],
                                  const float covariance[])
{
    for (int i = 0; i < num; i++) {
        if (elements[i] < 0 || elements[i] >= RHO_KALMAN_STATES || !rho_is_finite(values[i])) {
            return 0;
        }
    }
    for (int k = 0; k < RHO_TRIANGLE(num); k++) {
        if (!rho_is_finite(covariance[k])) {
            return 0;
        }
    }
    return 1;
}

/* Subtracts factor times row k, and its innovation, from row i. */
static void subtract_row(struct decorrelated_rows *decorrelated, int i, int k, float factor)
{
    for (int j = 0; j < RHO_KALMAN_STATES; j++) {
        decorrelated->row[i][j] -= factor * decorrelated->row[k][j];
    }
    decorrelated->off[i] -= factor * decorrelated->off[k];
}

/*
 * Computes row i of L^-1, and D_i, by elimination of the rows before. covariance: noise of the
 * elements that are used; it is overwritten by L row by row. False where the noise is not positive
 * definite.
 */
static int decorrelate_row(struct decorrelated_rows *decorrelated, int i, float covariance[])
{
    const float own = covariance[RHO_AT(i, i)];
    float pivot = own;

    for (int k = 0; k < i; k++) {
        float product = covariance[RHO_AT(i, k)];
        for (int j = 0; j < k; j++) {
            product -=
                covariance[RHO_AT(i, j)] * decorrelated->variance[j] * covariance[RHO_AT(k, j)];
        }
        const float factor = product / decorrelated->variance[k];
        covariance[RHO_AT(i, k)] = factor;
        pivot -= factor * product;
        subtract_row(decorrelated, i, k, factor);
    }
    decorrelated->variance[i] = pivot < own * PIVOT_LEAST ? own * PIVOT_LEAST : pivot;
    return own > 0.0f && pivot > 0.0f && rho_is_finite(decorrelated->off[i]);
}

/* Drops elements of closed axes, and decorrelates the noise of the others. */
static int decorrelate_open_elements(const struct rho_kalman *kalman, int num, const int elements[],
                                     const float values[], const float covariance[],
                                     struct decorrelated_rows *decorrelated)
{
    float kept[RHO_TRIANGLE(RHO_KALMAN_STATES)] = {0.0f};
    int source[RHO_KALMAN_STATES] = {0};

    *decorrelated = (struct decorrelated_rows){.num = 0};
    for (int i = 0; i < num; i++) {
        if (rho_kalman_has_estimate_on_axis(kalman, elements[i] % 3)) {
            const int n = decorrelated->num++;
            source[n] = i;
            decorrelated->row[n][elements[i]] = 1.0f;
            decorrelated->off[n] = values[i] - kalman->state[elements[i]];
            for (int k = 0; k <= n; k++) {
                kept[RHO_AT(n, k)] = covariance[RHO_AT(i, source[k])];
            }
        }
    }
    for (int i = 0; i < decorrelated->num; i++) {
        if (!decorrelate_row(decorrelated, i, kept)) {
            return 0;
        }
    }
    return 1;
}

/*
 * The correction is computed first, from a state of 0, and added at the end: differences of large
 * coordinates would add their rounding errors to the innovations.
 */
static enum rho_status update_with_decorrelated(struct rho_kalman *kalman,
                                                const struct decorrelated_rows *decorrelated)
{
    struct rho_kalman moved = *kalman;
    float total = 0.0f;

    memset(moved.state, 0, sizeof moved.state);
    for (int i = 0; i < decorrelated->num; i++) {
        float off = decorrelated->off[i];
        for (int j = 0; j < RHO_KALMAN_STATES; j++) {
            off -= decorrelated->row[i][j] * moved.state[j];
        }
        const enum rho_status status = rho_kalman_update_row(&moved, decorrelated->row[i], off,
                                                             decorrelated->variance[i], NULL);
        if (status != RHO_OK) {
            return status;
        }
    }
    for (int j = 0; j < RHO_KALMAN_STATES; j++) {
        moved.state[j] += kalman->state[j];
        total += moved.state[j];
    }
    if (!rho_is_finite(total)) {
        return RHO_ERROR_VALUE;
    }
    *kalman = moved;
    return RHO_OK;
}

enum rho_status rho_kalman_update_correlated(struct rho_kalman *kalman, int num,
                                             const int elements[], const float values[],
                                             const float covariance[])
{
    struct decorrelated_rows decorrelated;

    if (kalman == NULL || elements == NULL || values == NULL || covariance == NULL) {
        return RHO_ERROR_NULL;
    }
    if (num < 1 || num > RHO_KALMAN_STATES ||
        !are_valid_measurements(num, elements, values, covariance)) {
        return RHO_ERROR_VALUE;
    }
    if (!decorrelate_open_elements(kalman, num, elements, values, covariance, &decorrelated)) {
        return RHO_ERROR_SINGULAR;
    }
    return update_with_decorrelated(kalman, &decorrelated);
}
