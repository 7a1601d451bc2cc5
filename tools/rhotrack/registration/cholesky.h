/* SPDX-License-Identifier: MIT */
/*
 * cholesky: factors and solves symmetric positive definite systems in double precision; matrices
 * are stored by rows.
 */
#ifndef RHOTRACK_TOOL_CHOLESKY_H
#define RHOTRACK_TOOL_CHOLESKY_H

#include <stdbool.h>
#include <stddef.h>

/*
 * Replaces the lower triangle of an n x n matrix by its Cholesky factor L. False where the matrix
 * is not positive definite.
 */
bool cholesky_factor(double *matrix, size_t n);

/* Replaces v by L^-1 v (solve_lower) or by (L L')^-1 v (solve). */
void cholesky_solve_lower(const double *factor, size_t n, double *v);
void cholesky_solve(const double *factor, size_t n, double *v);

/* Element (i, i) of (L L')^-1; work has room for n numbers. */
double cholesky_inverse_diagonal(const double *factor, size_t n, size_t i, double *work);

#endif
