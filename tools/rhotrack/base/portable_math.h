/* SPDX-License-Identifier: MIT */
/*
 * portable_math: sine, cosine and arc tangent from additions and multiplications alone, so that
 * every machine has the same bits. Errors: below 2e-15 for angles within 1e5 rad. Square roots and
 * remainders are exact by IEEE 754 anyway.
 */
#ifndef RHOTRACK_TOOL_PORTABLE_MATH_H
#define RHOTRACK_TOOL_PORTABLE_MATH_H

#define PORTABLE_PI 3.14159265358979323846
#define PORTABLE_TURN (2.0 * PORTABLE_PI)

double portable_sin(double angle_rad);
double portable_cos(double angle_rad);
double portable_atan2(double y, double x); /* -pi .. pi; 0 where both are 0 */
double portable_hypot(double x, double y); /* of lengths whose squares are numbers */

/* Within -pi .. pi. */
double portable_wrap(double angle_rad);

#endif
