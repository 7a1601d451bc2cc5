/* SPDX-License-Identifier: MIT */
/* linalg_any_size: scalar Kalman updates and NIS for states of up to RHO_LINALG_MAX elements. */
#include <float.h>
#include <stddef.h>
#include <string.h>

#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/linalg.h"

/* 1 / (predicted + variance), or 0 where that is not a finite number. */
static float inverse_innovation_variance(float predicted, float variance)
{
    const float sum = predicted + variance, inverse = 1.0f / sum;
    const int is_good =
        predicted >= 0.0f && variance > 0.0f && sum <= FLT_MAX && inverse <= FLT_MAX;
    return is_good ? inverse : 0.0f;
}

/* x += spread innovation / S. Returns 0, and changes nothing, where a result is not finite. */
static int correct_state(int n, float *x, const float *spread, float innovation, float inverse)
{
    float next[RHO_LINALG_MAX], total = 0.0f;
    const float step = innovation * inverse;
    for (int i = 0; i < n; ++i) {
        next[i] = x[i] + spread[i] * step;
        total += next[i];
    }
    if (!(rho_is_finite(innovation * step) && rho_is_finite(total))) {
        return 0;
    }
    memcpy(x, next, (size_t)n * sizeof *x);
    return 1;
}

/* p -= spread spread^T / S. Elements that are not coupled to the measurement stay unchanged. */
static void reduce_covariance(int n, float *p, const float *spread, float inverse)
{
    for (int i = 0; i < n; p += ++i) {
        const float gain = spread[i] * inverse;
        if (!(gain * spread[i] > 0.0f)) {
            continue;
        }
        for (int j = 0; j < i; ++j) {
            p[j] -= gain * spread[j];
        }
        p[i] = p[i] * RHO_ROUNDING_ALLOWANCE - gain * spread[i];
    }
}

enum rho_status rho_linalg_update_element(int n, float *x, float *p, int element, float innovation,
                                          float variance)
{
    float row[RHO_LINALG_MAX];
    for (int i = 0; i < n; ++i) {
        row[i] = p[RHO_AT(i, element)];
    }
    const float inverse = inverse_innovation_variance(row[element], variance);
    if (!(inverse > 0.0f)) {
        return RHO_ERROR_SINGULAR;
    }
    if (!correct_state(n, x, row, innovation, inverse)) {
        return RHO_ERROR_VALUE;
    }
    /* scaled by R / S instead of being reduced by a difference: no digit cancels */
    const float kept = variance / (row[element] + variance);
    reduce_covariance(n, p, row, inverse);
    for (int i = 0; i < n; ++i) {
        p[RHO_AT(i, element)] = row[i] * kept;
    }
    return RHO_OK;
}

/* spread := p row; returns row . p row. Each element of p is read once, for row and column. */
static float project_covariance(int n, const float *p, int num, const float *row, float *spread)
{
    float variance = 0.0f;
    for (int i = 0; i < n; p += ++i) {
        const int own = i < num ? i : num;
        float sum = i < num ? p[i] * row[i] : 0.0f;
        for (int j = 0; j < own; ++j) {
            sum += p[j] * row[j];
        }
        for (int j = 0; j < own && i < num; ++j) {
            spread[j] += p[j] * row[i];
        }
        spread[i] = sum;
    }
    for (int i = 0; i < num; ++i) {
        variance += spread[i] * row[i];
    }
    return variance;
}

enum rho_status rho_linalg_update_row(int n, float *x, float *p, int num, const float *row,
                                      float innovation, float variance)
{
    float spread[RHO_LINALG_MAX] = {0.0f};
    const float inverse =
        inverse_innovation_variance(project_covariance(n, p, num, row, spread), variance);
    if (!(inverse > 0.0f)) {
        return RHO_ERROR_SINGULAR;
    }
    if (!correct_state(n, x, spread, innovation, inverse)) {
        return RHO_ERROR_VALUE;
    }
    reduce_covariance(n, p, spread, inverse);
    return RHO_OK;
}

int rho_linalg_gated_nis(int n, float *s, float *d, float distance2_max, float *distance2,
                         float *log_det)
{
    float distance = 0.0f, logarithm = 0.0f, product = 1.0f;
    /* S = L D L^T: column k is eliminated from the columns to its right and from d */
    for (int k = 0; k < n; ++k) {
        const float pivot = s[RHO_AT(k, k)], inverse = 1.0f / pivot;
        if (!(pivot > 0.0f && pivot <= FLT_MAX)) {
            return 0;
        }
        for (int i = k + 1; i < n; ++i) {
            const float factor = s[RHO_AT(i, k)] * inverse;
            for (int j = k + 1; j <= i; ++j) {
                s[RHO_AT(i, j)] -= factor * s[RHO_AT(j, k)];
            }
            d[i] -= factor * d[k];
        }
        distance += d[k] * d[k] / pivot;
        if (!(distance <= distance2_max)) {
            return 0;
        }
    }
    /* of the product of three pivots one logarithm: finite for variances up to 10^12 */
    for (int k = 0; k < n; ++k) {
        product *= s[RHO_AT(k, k)];
        if (k % 3 == 2 || k == n - 1) {
            logarithm += rho_log(product);
            product = 1.0f;
        }
    }
    if (!rho_is_finite(logarithm)) {
        return 0;
    }
    *distance2 = distance;
    *log_det = logarithm;
    return 1;
}
