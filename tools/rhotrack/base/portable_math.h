/* SPDX-License-Identifier: MIT */
/*
 * portable_math: sine, cosine and arc tangent from basic arithmetic alone, so that all machines
 * compute identical bits. Errors are below 2e-15 for angles within 1e5 rad. IEEE 754 requires
 * square roots and remainders to be exactly rounded, so these come from libm.
 */
#ifndef RHOTRACK_TOOL_PORTABLE_MATH_H
#define RHOTRACK_TOOL_PORTABLE_MATH_H

#define PORTABLE_PI 3.14159265358979323846
#define PORTABLE_TURN (2.0 * PORTABLE_PI)

double portable_sin(double angle_rad);
double portable_cos(double angle_rad);
double portable_atan2(double y, double x); /* -pi .. pi; 0 where x and y are 0 */
/* sqrt(x^2 + y^2), for lengths whose squares do not overflow */
double portable_hypot(double x, double y);

/* Wraps an angle into -pi .. pi. */
double portable_wrap_angle(double angle_rad);

#endif
