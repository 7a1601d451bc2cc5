/* SPDX-License-Identifier: MIT */
/* Elements of the state that were measured with correlated noise. */
#include <float.h>
#include <stddef.h>
#include <string.h>

#include "rhotrack/kalman.h"

/* Of an element's own variance: what its pivot is at least, four units of float32's rounding. */
#define PIVOT_LEAST (1.0f / 4194304.0f)

/* Rows of L^-1 H and L^-1 y, and D: measurements whose noise is independent. */
struct white {
    int num;
    float row[RHO_KALMAN_STATES][RHO_KALMAN_STATES];
    float off[RHO_KALMAN_STATES];
    float variance[RHO_KALMAN_STATES];
};

/* False for NaN. */
static int is_finite(float v)
{
    return v >= -FLT_MAX && v <= FLT_MAX;
}

static int are_usable(int num, const int elements[], const float values[], const float covariance[])
{
    for (int i = 0; i < num; i++) {
        if (elements[i] < 0 || elements[i] >= RHO_KALMAN_STATES || !is_finite(values[i])) {
            return 0;
        }
    }
    for (int k = 0; k < RHO_TRIANGLE(num); k++) {
        if (!is_finite(covariance[k])) {
            return 0;
        }
    }
    return 1;
}

/* row i := row i - factor x row k */
static void take_off(struct white *white, int i, int k, float factor)
{
    for (int j = 0; j < RHO_KALMAN_STATES; j++) {
        white->row[i][j] -= factor * white->row[k][j];
    }
    white->off[i] -= factor * white->off[k];
}

/*
 * Takes what the measurements before tell of element i off it. covariance: of those that count, a triangle that turns into
 * L, whose products with D are what a row of it is found from.
 */
static int whiten(struct white *white, int i, float covariance[])
{
    const float own = covariance[RHO_AT(i, i)];
    float pivot = own;

    for (int k = 0; k < i; k++) {
        float product = covariance[RHO_AT(i, k)];
        for (int j = 0; j < k; j++) {
            product -= covariance[RHO_AT(i, j)] * white->variance[j] * covariance[RHO_AT(k, j)];
        }
        const float factor = product / white->variance[k];
        covariance[RHO_AT(i, k)] = factor;
        pivot -= factor * product;
        take_off(white, i, k, factor);
    }
    white->variance[i] = pivot < own * PIVOT_LEAST ? own * PIVOT_LEAST : pivot;
    return own > 0.0f && pivot > 0.0f && is_finite(white->off[i]);
}

/* What counts of the measurement, and its noise made independent. */
static int open_white(const struct rho_kalman *kalman, int num, const int elements[],
                      const float values[], const float covariance[], struct white *white)
{
    float kept[RHO_TRIANGLE(RHO_KALMAN_STATES)] = {0.0f};
    int source[RHO_KALMAN_STATES] = {0};

    *white = (struct white){.num = 0};
    for (int i = 0; i < num; i++) {
        if (rho_kalman_is_open(kalman, elements[i] % 3)) {
            const int n = white->num++;
            source[n] = i;
            white->row[n][elements[i]] = 1.0f;
            white->off[n] = values[i] - kalman->state[elements[i]];
            for (int k = 0; k <= n; k++) {
                kept[RHO_AT(n, k)] = covariance[RHO_AT(i, source[k])];
            }
        }
    }
    for (int i = 0; i < white->num; i++) {
        if (!whiten(white, i, kept)) {
            return 0;
        }
    }
    return 1;
}

/*
 * By how much the estimate moves is found first, from nothing: rows that take large parts of some elements off others would
 * see what a place far from the origin is rounded by.
 */
static enum rho_status update_all(struct rho_kalman *kalman, const struct white *white)
{
    struct rho_kalman moved = *kalman;
    float total = 0.0f;

    memset(moved.state, 0, sizeof moved.state);
    for (int i = 0; i < white->num; i++) {
        float off = white->off[i];
        for (int j = 0; j < RHO_KALMAN_STATES; j++) {
            off -= white->row[i][j] * moved.state[j];
        }
        const enum rho_status status =
            rho_kalman_update_row(&moved, white->row[i], off, white->variance[i], NULL);
        if (status != RHO_OK) {
            return status;
        }
    }
    for (int j = 0; j < RHO_KALMAN_STATES; j++) {
        moved.state[j] += kalman->state[j];
        total += moved.state[j];
    }
    if (!is_finite(total)) {
        return RHO_ERROR_VALUE;
    }
    *kalman = moved;
    return RHO_OK;
}

enum rho_status rho_kalman_update_correlated(struct rho_kalman *kalman, int num,
                                             const int elements[], const float values[],
                                             const float covariance[])
{
    struct white white;

    if (kalman == NULL || elements == NULL || values == NULL || covariance == NULL) {
        return RHO_ERROR_NULL;
    }
    if (num < 1 || num > RHO_KALMAN_STATES || !are_usable(num, elements, values, covariance)) {
        return RHO_ERROR_VALUE;
    }
    if (!open_white(kalman, num, elements, values, covariance, &white)) {
        return RHO_ERROR_SINGULAR;
    }
    return update_all(kalman, &white);
}
