/* SPDX-License-Identifier: MIT */
/*
 * linalg_update_any_size: scalar Kalman updates and NIS for states of any size up to
 * RHO_LINALG_MAX.
 */
#include <float.h>
#include <stddef.h>
#include <string.h>

#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/linalg.h"

/*
 * Before an update reduces a variance, the variance is raised by sixteen units of rounding, as in
 * linalg.c.
 */
#define ROUNDING_ALLOWANCE (1.0f + 1.0f / 1048576.0f)

static int is_positive_and_finite(float v)
{
    return v > 0.0f && v <= FLT_MAX;
}

/* 1 / (predicted + variance), or 0 where that is not a finite number. */
static float inverse_innovation_variance(float predicted, float variance)
{
    const float sum = predicted + variance;
    const float inverse = 1.0f / sum;

    return predicted >= 0.0f && variance > 0.0f && sum <= FLT_MAX && inverse <= FLT_MAX ? inverse
                                                                                        : 0.0f;
}

/* x += spread innovation / S. Returns 0, and changes nothing, where a result is not finite. */
static int correct_state(int n, float *x, const float *spread, float innovation, float inverse)
{
    float next[RHO_LINALG_MAX], total = 0.0f;
    const float step = innovation * inverse;
    int i;

    for (i = 0; i < n; ++i) {
        next[i] = x[i] + spread[i] * step;
        total += next[i];
    }
    if (!(rho_is_finite(innovation * step) && rho_is_finite(total))) {
        return 0;
    }
    memcpy(x, next, (size_t)n * sizeof *x);
    return 1;
}

/*
 * p -= spread spread^T / S. Elements that are not coupled to the measurement, such as those of an
 * axis without heights, stay unchanged.
 */
static void reduce_covariance(int n, float *p, const float *spread, float inverse)
{
    int i, j;

    for (i = 0; i < n; p += ++i) {
        const float gain = spread[i] * inverse;

        if (!(gain * spread[i] > 0.0f)) {
            continue;
        }
        for (j = 0; j < i; ++j) {
            p[j] -= gain * spread[j];
        }
        p[i] = p[i] * ROUNDING_ALLOWANCE - gain * spread[i];
    }
}

static void copy_row(int n, const float *p, int index, float *row)
{
    int i;

    for (i = 0; i < n; ++i) {
        row[i] = p[RHO_AT(i, index)];
    }
}

enum rho_status rho_linalg_update_element(int n, float *x, float *p, int element, float innovation,
                                          float variance)
{
    float row[RHO_LINALG_MAX], inverse, kept;
    int i;

    if (x == NULL || p == NULL) {
        return RHO_ERROR_NULL;
    }
    if (n < 1 || n > RHO_LINALG_MAX) {
        return RHO_ERROR_CAPACITY;
    }
    if (element < 0 || element >= n) {
        return RHO_ERROR_VALUE;
    }
    copy_row(n, p, element, row);
    inverse = inverse_innovation_variance(row[element], variance);
    if (!(inverse > 0.0f)) {
        return RHO_ERROR_SINGULAR;
    }
    if (!correct_state(n, x, row, innovation, inverse)) {
        return RHO_ERROR_VALUE;
    }
    kept = variance / (row[element] + variance);
    reduce_covariance(n, p, row, inverse);
    /*
     * The measured row is scaled by R / S instead of being reduced by a difference: no digit
     * cancels.
     */
    for (i = 0; i < n; ++i) {
        p[RHO_AT(i, element)] = row[i] * kept;
    }
    return RHO_OK;
}

/*
 * spread := p row; returns row . p row. Each stored element of p is read once, for its row and for
 * its column.
 */
static float project_covariance(int n, const float *p, int num, const float *row, float *spread)
{
    float variance = 0.0f;
    int i, j;

    for (i = 0; i < n; p += ++i) {
        const int own = i < num ? i : num;
        float sum = i < num ? p[i] * row[i] : 0.0f;

        for (j = 0; j < own; ++j) {
            sum += p[j] * row[j];
        }
        for (j = 0; j < own && i < num; ++j) {
            spread[j] += p[j] * row[i];
        }
        spread[i] = sum;
    }
    for (i = 0; i < num; ++i) {
        variance += spread[i] * row[i];
    }
    return variance;
}

enum rho_status rho_linalg_update_row(int n, float *x, float *p, int num, const float *row,
                                      float innovation, float variance)
{
    float spread[RHO_LINALG_MAX], inverse;

    if (x == NULL || p == NULL || row == NULL) {
        return RHO_ERROR_NULL;
    }
    if (n < 1 || n > RHO_LINALG_MAX || num < 1 || num > n) {
        return RHO_ERROR_CAPACITY;
    }
    inverse = inverse_innovation_variance(project_covariance(n, p, num, row, spread), variance);
    if (!(inverse > 0.0f)) {
        return RHO_ERROR_SINGULAR;
    }
    if (!correct_state(n, x, spread, innovation, inverse)) {
        return RHO_ERROR_VALUE;
    }
    reduce_covariance(n, p, spread, inverse);
    return RHO_OK;
}

/*
 * Eliminates column k of S = L D L^T from the columns to its right and from d. False where the
 * pivot is not positive.
 */
static int eliminate_column(int n, int k, float *s, float *d)
{
    const float pivot = s[RHO_AT(k, k)];
    const float inverse = 1.0f / pivot;
    int i, j;

    if (!is_positive_and_finite(pivot)) {
        return 0;
    }
    for (i = k + 1; i < n; ++i) {
        const float factor = s[RHO_AT(i, k)] * inverse;

        for (j = k + 1; j <= i; ++j) {
            s[RHO_AT(i, j)] -= factor * s[RHO_AT(j, k)];
        }
        d[i] -= factor * d[k];
    }
    return 1;
}

/*
 * ln det S as the sum of logarithms of pivots. Three are multiplied before each logarithm: their
 * product is finite for variances up to 10^12.
 */
static float log_pivot_product(int n, const float *s)
{
    float sum = 0.0f, product = 1.0f;
    int k;

    for (k = 0; k < n; ++k) {
        product *= s[RHO_AT(k, k)];
        if (k % 3 == 2 || k == n - 1) {
            sum += rho_log(product);
            product = 1.0f;
        }
    }
    return sum;
}

int rho_linalg_gated_nis(int n, float *s, float *d, float distance2_max, float *distance2,
                         float *log_det)
{
    float distance = 0.0f, logarithm;
    int k;

    if (n < 1 || n > RHO_LINALG_MAX || s == NULL || d == NULL || distance2 == NULL ||
        log_det == NULL) {
        return 0;
    }
    for (k = 0; k < n; ++k) {
        if (!eliminate_column(n, k, s, d)) {
            return 0;
        }
        distance += d[k] * d[k] / s[RHO_AT(k, k)];
        if (!(distance <= distance2_max)) {
            return 0;
        }
    }
    logarithm = log_pivot_product(n, s);
    if (!rho_is_finite(logarithm)) {
        return 0;
    }
    *distance2 = distance;
    *log_det = logarithm;
    return 1;
}
