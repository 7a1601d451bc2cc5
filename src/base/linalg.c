/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/linalg.h"

#include <float.h>
#include <stddef.h>

#include "rhotrack/detail/approx.h"

const uint8_t rho_linalg_row6[6][6] = {
    {0, 1, 3, 6, 10, 15}, {1, 2, 4, 7, 11, 16},     {3, 4, 5, 8, 12, 17},
    {6, 7, 8, 9, 13, 18}, {10, 11, 12, 13, 14, 19}, {15, 16, 17, 18, 19, 20},
};

/* True for a positive finite number; false for NaN. */
static int is_pivot(float v)
{
    return v > 0.0f && v <= FLT_MAX;
}

/* Scalar product of the first n elements of two rows. */
static float dot(int n, const float *a, const float *b)
{
    float sum = 0.0f;
    for (int i = 0; i < n; ++i) {
        sum += a[i] * b[i];
    }
    return sum;
}

enum rho_status rho_linalg_cholesky(int n, const float *a, float *l)
{
    for (int i = 0; i < n; ++i) {
        float *row = &l[RHO_TRIANGLE(i)];
        for (int j = 0; j < i; ++j) {
            const float *above = &l[RHO_TRIANGLE(j)];
            row[j] = (a[RHO_TRIANGLE(i) + j] - dot(j, row, above)) / above[j];
        }
        const float pivot = a[RHO_TRIANGLE(i) + i] - dot(i, row, row);
        row[i] = rho_sqrt(pivot);
        if (!is_pivot(pivot)) {
            return RHO_ERROR_SINGULAR;
        }
    }
    return RHO_OK;
}

void rho_linalg_forward(int n, const float *l, float *b)
{
    for (int i = 0; i < n; ++i) {
        const float *row = &l[RHO_TRIANGLE(i)];
        b[i] = (b[i] - dot(i, row, b)) / row[i];
    }
}

void rho_linalg_backward(int n, const float *l, float *b)
{
    for (int i = n - 1; i >= 0; --i) {
        for (int j = i + 1; j < n; ++j) {
            b[i] -= l[RHO_AT(j, i)] * b[j];
        }
        b[i] /= l[RHO_AT(i, i)];
    }
}

float rho_linalg_log_determinant(int n, const float *l)
{
    float sum = 0.0f;
    for (int i = 0; i < n; ++i) {
        sum += rho_log(l[RHO_AT(i, i)]);
    }
    return 2.0f * sum;
}

/* NIS by S = L D L^T: pivots, as a determinant cancels where errors are correlated. */
enum rho_status rho_linalg_nis(int num, const float *s, const float *d, float *distance2,
                               float *log_det)
{
    const float l10 = s[1] / s[0], pivot1 = s[2] - l10 * s[1], y1 = d[1] - l10 * d[0];
    float distance = d[0] * d[0] / s[0] + y1 * y1 / pivot1, det = s[0] * pivot1;
    int is_good = is_pivot(s[0]) && is_pivot(pivot1);
    if (num > 2) {
        const float l20 = s[3] / s[0], c21 = s[4] - l20 * s[1], l21 = c21 / pivot1;
        const float pivot2 = s[5] - l20 * s[3] - l21 * c21, y2 = d[2] - l20 * d[0] - l21 * y1;
        distance += y2 * y2 / pivot2;
        det *= pivot2;
        is_good = is_good && is_pivot(pivot2);
    }
    const float logarithm = rho_log(det);
    if (!(is_good && rho_is_finite(distance) && rho_is_finite(logarithm))) {
        return RHO_ERROR_SINGULAR;
    }
    *distance2 = distance;
    *log_det = logarithm;
    return RHO_OK;
}

/* A variance after an update. Without covariances of its element it needs no allowance. */
static inline float reduced_variance(float variance, float gain, float covariance)
{
    /* 0 or more; 0 where measurement and element are not coupled */
    const float taken = gain * covariance;
    return taken > 0.0f ? variance * RHO_ROUNDING_ALLOWANCE - taken : variance;
}

/* p := p - gain row^T; gain: row / S. */
static inline void reduce_covariance(float p[21], const float row[6], const float gain[6])
{
    RHO_UNROLL
    for (int i = 1; i < 6; ++i) {
        RHO_UNROLL
        for (int j = 0; j < i; ++j) {
            p[RHO_AT(i, j)] -= gain[i] * row[j];
        }
    }
    RHO_UNROLL
    for (int i = 0; i < 6; ++i) {
        p[RHO_AT(i, i)] = reduced_variance(p[RHO_AT(i, i)], gain[i], row[i]);
    }
}

/* x := x + gain innovation. Returns 0, and changes nothing, where a result is not finite. */
static inline int correct_state(float x[6], const float gain[6], float innovation, float inverse)
{
    float next[6], sum = 0.0f;
    RHO_UNROLL
    for (int i = 0; i < 6; ++i) {
        next[i] = x[i] + gain[i] * innovation;
        sum = i > 0 ? sum + next[i] : next[i];
    }
    if (!(rho_is_finite(innovation * inverse * innovation) && rho_is_finite(sum))) {
        return 0;
    }
    RHO_UNROLL
    for (int i = 0; i < 6; ++i) {
        x[i] = next[i];
    }
    return 1;
}

static inline void scale_row(float scaled[6], const float row[6], float factor)
{
    RHO_UNROLL
    for (int i = 0; i < 6; ++i) {
        scaled[i] = row[i] * factor;
    }
}

/* A scalar measurement of one element: innovation, 1 / S, and the share R / S that is kept. */
struct scalar_measurement {
    float innovation, inverse, kept;
};

/* For an axis coupled with no other: the same bits but a zero's sign, in a third of the time. */
static int update_axis_alone(float x[6], float p[21], int element,
                             const struct scalar_measurement *seen)
{
    const int other = element < 3 ? element + 3 : element - 3;
    float *const mixed = &p[rho_linalg_row6[element][other]];
    float *const own = &p[rho_linalg_row6[element][element]];
    float *const others = &p[rho_linalg_row6[other][other]];
    const float gain = *mixed * seen->inverse;
    const float x_own = x[element] + *own * seen->inverse * seen->innovation;
    const float x_other = x[other] + gain * seen->innovation;
    if (!(rho_is_finite(seen->innovation * seen->inverse * seen->innovation) &&
          rho_is_finite(x_own + x_other) &&
          rho_is_finite(x[0] + x[1] + x[2] + x[3] + x[4] + x[5]))) {
        return 0;
    }
    x[element] = x_own;
    x[other] = x_other;
    *others = reduced_variance(*others, gain, *mixed);
    *own *= seen->kept;
    *mixed *= seen->kept;
    return 1;
}

static int update_all_axes(float x[6], float p[21], const uint8_t place[6],
                           const struct scalar_measurement *seen)
{
    float row[6], gain[6];
    RHO_UNROLL
    for (int i = 0; i < 6; ++i) {
        row[i] = p[place[i]];
    }
    scale_row(gain, row, seen->inverse);
    if (!correct_state(x, gain, seen->innovation, seen->inverse)) {
        return 0;
    }
    reduce_covariance(p, row, gain);
    RHO_UNROLL
    for (int i = 0; i < 6; ++i) {
        p[place[i]] = row[i] * seen->kept;
    }
    return 1;
}

enum rho_status rho_linalg_update6_element(float x[6], float p[21], int element, float innovation,
                                           float variance, float *nis)
{
    /* indices of an element's covariances with the elements of the other two axes */
    static const uint8_t other_axes[6][4] = {
        {1, 3, 10, 15}, {1, 4, 7, 16},    {3, 4, 8, 12},
        {7, 8, 13, 18}, {10, 12, 13, 19}, {15, 16, 18, 19},
    };
    const float predicted = p[RHO_AT(element, element)], sum = predicted + variance;
    /* the measured row is scaled by R / S <= 1, not reduced by a difference: no digit cancels */
    const struct scalar_measurement seen = {innovation, 1.0f / sum, variance / sum};
    if (!(predicted >= 0.0f && variance > 0.0f && sum <= FLT_MAX && seen.inverse <= FLT_MAX)) {
        return RHO_ERROR_SINGULAR;
    }
    const uint8_t *others = other_axes[element];
    const int is_alone =
        RHO_FAST_UPDATES && (rho_size_bits(p[others[0]]) | rho_size_bits(p[others[1]]) |
                             rho_size_bits(p[others[2]]) | rho_size_bits(p[others[3]])) == 0;
    if (!(is_alone ? update_axis_alone(x, p, element, &seen)
                   : update_all_axes(x, p, rho_linalg_row6[element], &seen))) {
        return RHO_ERROR_VALUE;
    }
    if (nis != NULL) {
        *nis = innovation * seen.inverse * innovation;
    }
    return RHO_OK;
}

float rho_linalg_project6(const float p[21], const float row[6], float projected[6])
{
    float variance = 0.0f;
    for (int i = 0; i < 6; ++i) {
        const uint8_t *place = rho_linalg_row6[i];
        float sum = p[place[0]] * row[0];
        RHO_UNROLL
        for (int k = 1; k < 6; ++k) {
            sum += p[place[k]] * row[k];
        }
        projected[i] = sum;
        variance += sum * row[i];
    }
    return variance;
}

enum rho_status rho_linalg_update6_row(float x[6], float p[21], const float row[6],
                                       float innovation, float variance)
{
    float projected[6], gain[6];
    const float predicted = rho_linalg_project6(p, row, projected), sum = predicted + variance;
    const float inverse = 1.0f / sum;
    if (!(predicted >= 0.0f && variance > 0.0f && sum <= FLT_MAX && inverse <= FLT_MAX)) {
        return RHO_ERROR_SINGULAR;
    }
    scale_row(gain, projected, inverse);
    if (!correct_state(x, gain, innovation, inverse)) {
        return RHO_ERROR_VALUE;
    }
    reduce_covariance(p, projected, gain);
    return RHO_OK;
}

void rho_linalg_rotate6(float p[21], int a, int b, float c, float s)
{
    const uint8_t *row_a = rho_linalg_row6[a], *row_b = rho_linalg_row6[b];
    const float aa = p[row_a[a]], ab = p[row_a[b]], bb = p[row_b[b]];
    /* the mean of both variances is kept, only their difference is rotated: that rounds least */
    const float cos_twice = c * c - s * s, sin_twice = 2.0f * c * s;
    const float mean = 0.5f * (aa + bb), half = 0.5f * (aa - bb);
    const float rest = cos_twice * half + sin_twice * ab;
    const float allowance = (aa > bb ? aa : bb) * RHO_ROUNDING_UNITS(4);
    for (int k = 0; k < 6; ++k) {
        const float ka = p[row_a[k]], kb = p[row_b[k]];
        p[row_a[k]] = c * ka + s * kb;
        p[row_b[k]] = c * kb - s * ka;
    }
    p[row_a[a]] = mean + rest + allowance;
    p[row_b[b]] = mean - rest + allowance;
    p[row_a[b]] = cos_twice * ab - sin_twice * half;
}
