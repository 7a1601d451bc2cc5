/* SPDX-License-Identifier: MIT */
#include "poisson.h"

#include <math.h>

double poisson_low(double count)
{
    return count < 1.0 ? 0.0
                       : count * pow(1.0 - 1.0 / (9.0 * count) - 1.96 / (3.0 * sqrt(count)), 3.0);
}

double poisson_high(double count)
{
    double next = count + 1.0;
    return next * pow(1.0 - 1.0 / (9.0 * next) + 1.96 / (3.0 * sqrt(next)), 3.0);
}
