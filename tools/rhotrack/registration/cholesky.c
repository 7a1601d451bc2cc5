/* SPDX-License-Identifier: MIT */
#include "registration/cholesky.h"

#include <math.h>
#include <string.h>

#define PIVOT_LEAST 1e-12 /* share of the diagonal element below which a pivot is rounding error */

bool cholesky_factor(double *matrix, size_t n)
{
    for (size_t j = 0; j < n; j++) {
        double whole = matrix[j * n + j], pivot = whole;

        for (size_t k = 0; k < j; k++) {
            pivot -= matrix[j * n + k] * matrix[j * n + k];
        }
        if (!(pivot > PIVOT_LEAST * whole)) {
            return false;
        }
        pivot = sqrt(pivot);
        matrix[j * n + j] = pivot;
        for (size_t i = j + 1; i < n; i++) {
            double sum = matrix[i * n + j];

            for (size_t k = 0; k < j; k++) {
                sum -= matrix[i * n + k] * matrix[j * n + k];
            }
            matrix[i * n + j] = sum / pivot;
        }
    }
    return true;
}

void cholesky_solve_lower(const double *factor, size_t n, double *v)
{
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < i; k++) {
            v[i] -= factor[i * n + k] * v[k];
        }
        v[i] /= factor[i * n + i];
    }
}

void cholesky_solve(const double *factor, size_t n, double *v)
{
    cholesky_solve_lower(factor, n, v);
    for (size_t i = n; i-- > 0;) {
        for (size_t k = i + 1; k < n; k++) {
            v[i] -= factor[k * n + i] * v[k];
        }
        v[i] /= factor[i * n + i];
    }
}

double cholesky_inverse_diagonal(const double *factor, size_t n, size_t i, double *work)
{
    double sum = 0.0;

    memset(work, 0, n * sizeof *work);
    work[i] = 1.0;
    cholesky_solve_lower(factor, n, work);
    for (size_t k = i; k < n; k++) {
        sum += work[k] * work[k];
    }
    return sum;
}
