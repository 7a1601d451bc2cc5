/* SPDX-License-Identifier: MIT */
/*
 * chi_square_and_log_factorial: quantiles of the chi-square distribution, and logarithms of
 * factorials.
 */
#include "rhotrack/detail/approx.h"
#include "search.h"

/*
 * Quantile of chi-square with this number of dimensions, below which it lies as often as a normal
 * deviate below `sigmas` (Wilson and Hilferty's approximation).
 */
float rho_initiator_chi2_limit(unsigned dimensions, float sigmas)
{
    float f = 2.0f / (9.0f * (float)dimensions);
    float root = 1.0f - f + sigmas * rho_sqrt(f);
    return (float)dimensions * root * root * root;
}

float rho_initiator_log_factorial(unsigned n)
{
    float sum = 0.0f;
    for (unsigned i = 2; i <= n; i++) {
        sum += rho_log((float)i);
    }
    return sum;
}
