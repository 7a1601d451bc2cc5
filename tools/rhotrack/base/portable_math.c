/* SPDX-License-Identifier: MIT */
#include "base/portable_math.h"

#include <math.h>

/*
 * pi/2 as the sum of two constants: the first has 33 significant bits, so that its products with
 * small whole numbers are exact.
 */
#define HALF_PI_HIGH 1.57079632673412561417e+00
#define HALF_PI_LOW 6.07710050650619224932e-11

/* Taylor series of the sine for |x| <= pi/4; the first omitted term is below 1e-17. */
static double sin_series(double x)
{
    double x2 = x * x, sum = 0.0;

    for (int n = 17; n >= 3; n -= 2) {
        sum = (1.0 - sum) * x2 / (double)(n * (n - 1));
    }
    return x * (1.0 - sum);
}

static double cos_series(double x)
{
    double x2 = x * x, sum = 0.0;

    for (int n = 18; n >= 2; n -= 2) {
        sum = (1.0 - sum) * x2 / (double)(n * (n - 1));
    }
    return 1.0 - sum;
}

static double split_quarter_turns(double angle_rad, double *rest_rad)
{
    double quarters = floor(angle_rad / (PORTABLE_PI / 2.0) + 0.5);

    *rest_rad = (angle_rad - quarters * HALF_PI_HIGH) - quarters * HALF_PI_LOW;
    return quarters - 4.0 * floor(quarters / 4.0);
}

double portable_sin(double angle_rad)
{
    double rest_rad, quarters = split_quarter_turns(angle_rad, &rest_rad);
    double value = quarters == 1.0 || quarters == 3.0 ? cos_series(rest_rad) : sin_series(rest_rad);

    return quarters >= 2.0 ? -value : value;
}

double portable_cos(double angle_rad)
{
    double rest_rad, quarters = split_quarter_turns(angle_rad, &rest_rad);
    double value = quarters == 1.0 || quarters == 3.0 ? sin_series(rest_rad) : cos_series(rest_rad);

    return quarters == 1.0 || quarters == 2.0 ? -value : value;
}

/*
 * atan(t) for t in 0 .. 1: halves the angle three times by atan t = 2 atan(t / (1 + sqrt(1 +
 * t^2))), then sums the Taylor series.
 */
static double atan_series(double t)
{
    double t2, sum = 0.0;

    for (int i = 0; i < 3; i++) {
        t = t / (1.0 + sqrt(1.0 + t * t));
    }
    t2 = t * t;
    for (int n = 17; n >= 1; n -= 2) {
        sum = 1.0 / (double)n - t2 * sum;
    }
    return 8.0 * t * sum;
}

double portable_atan2(double y, double x)
{
    double ax = fabs(x), ay = fabs(y), angle;

    if (!(ax > 0.0) && !(ay > 0.0)) {
        return 0.0;
    }
    angle = ay <= ax ? atan_series(ay / ax) : PORTABLE_PI / 2.0 - atan_series(ax / ay);
    angle = x < 0.0 ? PORTABLE_PI - angle : angle;
    return y < 0.0 ? -angle : angle;
}

double portable_hypot(double x, double y)
{
    return sqrt(x * x + y * y);
}

double portable_wrap_angle(double angle_rad)
{
    return remainder(angle_rad, PORTABLE_TURN);
}
