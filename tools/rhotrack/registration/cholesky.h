/* SPDX-License-Identifier: MIT */
/* cholesky: symmetric positive definite systems in double precision, matrices by rows. */
#ifndef RHOTRACK_TOOL_CHOLESKY_H
#define RHOTRACK_TOOL_CHOLESKY_H

#include <stdbool.h>
#include <stddef.h>

/*
 * The lower factor in place of the lower triangle. False where the matrix is not positive definite.
 */
bool cholesky_factor(double *matrix, size_t n);

/* L^-1 v, and (L L')^-1 v, in place. */
void cholesky_solve_lower(const double *factor, size_t n, double *v);
void cholesky_solve(const double *factor, size_t n, double *v);

/* Element (i, i) of the inverse. work: n. */
double cholesky_inverse_diagonal(const double *factor, size_t n, size_t i, double *work);

#endif
