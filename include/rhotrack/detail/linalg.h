/* SPDX-License-Identifier: MIT */
/*
 * linalg: small symmetric matrices: Cholesky factors, NIS, scalar Kalman updates, rotations.
 *
 * A symmetric n x n matrix is its lower triangle row by row: element (i, j <= i) at i (i + 1) / 2 +
 * j, n (n + 1) / 2 floats. Sizes n, 1 .. RHO_LINALG_MAX, and indices are not checked. Every routine
 * checks positive definiteness where it divides (by a comparison that is false for NaN), and
 * returns an error without changing its operands; rho_linalg_cholesky alone may have changed l.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_LINALG_H
#define RHOTRACK_LINALG_H

#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

#define RHO_LINALG_MAX 12
#define RHO_TRIANGLE(n) ((n) * ((n) + 1) / 2)
#define RHO_AT(i, j) ((i) >= (j) ? (i) * ((i) + 1) / 2 + (j) : (j) * ((j) + 1) / 2 + (i))

/* n units of float32's rounding, 2^-24 each, as a share of a number. */
#define RHO_ROUNDING_UNITS(n) ((float)(n) / 16777216.0f)

/*
 * Factor by which a variance is raised before an update reduces it. The products that are
 * subtracted carry at most four units of rounding each, so a positive definite matrix stays so even
 * where the measurement is 10^8 times better than the prediction and every digit cancels.
 */
#define RHO_ROUNDING_ALLOWANCE (1.0f + RHO_ROUNDING_UNITS(16))

/* least variance of an element of an open axis; updates keep it there */
#define RHO_VARIANCE_MIN 1.0e-9f
/* largest variance; larger results are refused, RHO_ERROR_VALUE */
#define RHO_VARIANCE_MAX 1.0e12f

/* Indices of the elements of row i of a packed symmetric 6 x 6 matrix. */
extern const uint8_t rho_linalg_row6[6][6];

/* Unrolls the loop that follows, also where the compiler optimises for size. */
#if RHO_FAST_UPDATES && defined(__GNUC__)
#define RHO_UNROLL _Pragma("GCC unroll 6")
#else
#define RHO_UNROLL
#endif

/*
 * Cholesky factor L of a positive definite matrix, a = L L^T, into l (row-wise triangle; may be a
 * itself). Errors: SINGULAR (a pivot is not a positive finite number; l is undefined). Cost: n^3
 * / 6 multiplications, n square roots. Stack: 120 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_linalg_cholesky(int n, const float *a, float *l);

/* Forward substitution: b := L^-1 b for a factor from rho_linalg_cholesky. Cost: n^2 / 2. */
void rho_linalg_forward(int n, const float *l, float *b);

/* Backward substitution: b := L^-T b; after rho_linalg_forward it solves a x = b. Cost: n^2 / 2. */
void rho_linalg_backward(int n, const float *l, float *b);

/* ln det(L L^T) = 2 sum ln L_ii, from the Cholesky factor. Cost: n logarithms. */
float rho_linalg_log_determinant(int n, const float *l);

/*
 * Squared Mahalanobis distance d^T S^-1 d and ln det S in num = 2 or 3 dimensions. Errors: SINGULAR
 * (S is not positive definite, or a result is not finite); outputs untouched. Cost: 25 or 60
 * operations and a logarithm.
 */
RHO_MUST_CHECK enum rho_status rho_linalg_nis(int num, const float *s, const float *d,
                                              float *distance2, float *log_det);

/*
 * One scalar Kalman update of a six-element state x with covariance p (21 floats): `element` of x
 * was measured, `innovation` is its measured minus predicted value, `variance` the measurement's
 * noise. *nis (may be NULL) gets innovation^2 / (p_ii + variance). No variance grows by more than
 * 2^-20 of itself, and a positive definite p stays so in spite of rounding, unless it is singular
 * to within 10^-6 already. Errors: VALUE (innovation or a result not finite), SINGULAR (variance
 * not positive, p_ii negative, or their sum not a number one can divide by); x, p and *nis
 * untouched. Cost: about 240 instructions. Stack: 112 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_linalg_update6_element(float x[6], float p[21], int element,
                                                          float innovation, float variance,
                                                          float *nis);

/*
 * One scalar Kalman update by a measurement of row . x, with row any vector of 6 floats;
 * `innovation` is the measured minus the predicted value. Errors: as the update by one element.
 * Cost: about 530 instructions. Stack: 144 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_linalg_update6_row(float x[6], float p[21], const float row[6],
                                                      float innovation, float variance);

/* projected := p row; returns row . p row, the variance of row . x. Cost: about 90 instructions. */
float rho_linalg_project6(const float p[21], const float row[6], float projected[6]);

/*
 * Scalar Kalman updates of a state of n <= RHO_LINALG_MAX elements with covariance p: by a
 * measurement of `element` of x, or of row . x, where elements of row beyond the first num are 0.
 * Errors: as for six elements. Cost: about 4 n^2 and 6 n^2 instructions. Stack: 250 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_linalg_update_element(int n, float *x, float *p, int element,
                                                         float innovation, float variance);
RHO_MUST_CHECK enum rho_status rho_linalg_update_row(int n, float *x, float *p, int num,
                                                     const float *row, float innovation,
                                                     float variance);

/*
 * NIS d^T S^-1 d and ln det S for any n <= RHO_LINALG_MAX; S (a triangle) and d are overwritten.
 * Returns 0, and fills nothing, where S is not positive definite, a result is not finite, or the
 * NIS exceeds its limit. Cost: n^3 / 3 operations, n divisions and a logarithm for each three
 * dimensions.
 */
int rho_linalg_gated_nis(int n, float *s, float *d, float distance2_max, float *distance2,
                         float *log_det);

/*
 * Rotates the frame of a symmetric 6 x 6 matrix in the plane of two of its elements a and b: p := G
 * p G^T with new a = c a + s b and new b = c b - s a, c^2 + s^2 = 1. The two variances are raised
 * by 2^-22 of the larger one, more than rounding takes, so that a positive definite p stays so,
 * unless it is singular to within 10^-6 already. a and b are two different elements, 0 .. 5, and
 * not checked. Cost: about 90 instructions.
 */
void rho_linalg_rotate6(float p[21], int a, int b, float c, float s);

RHO_END_C

#endif
