/* SPDX-License-Identifier: MIT */
/*
 * poisson: 95 % limits of a Poisson mean from a count: Garwood's, by Wilson and Hilferty's
 * approximation.
 */
#ifndef RHOTRACK_TOOL_POISSON_H
#define RHOTRACK_TOOL_POISSON_H

double poisson_low(double count);
double poisson_high(double count);

#endif
