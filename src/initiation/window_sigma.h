/* SPDX-License-Identifier: MIT */
/* How a window codes standard deviations: the upper 16 bits below the sign of a float32, exponents from 2^-10 on.
 * Private to src/initiation/window*.c. */
#ifndef RHOTRACK_WINDOW_SIGMA_H
#define RHOTRACK_WINDOW_SIGMA_H

/* Exponent of the least code, 2^-10, as a float32 has it. */
#define SIGMA_EXPONENT (117u << 23)
#define SIGMA_SHIFT 12

#endif
