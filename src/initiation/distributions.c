/* SPDX-License-Identifier: MIT */
/*
 * distributions: limits of chi-square and factorials.
 */
#include "rhotrack/detail/approx.h"
#include "search.h"

/* Wilson and Hilferty's approximation: a normal deviate of `sigmas` as a limit of chi-square. */
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
