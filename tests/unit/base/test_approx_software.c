/* SPDX-License-Identifier: MIT */
/*
 * Runs the tests of test_approx.c on the software square root, for processors without an
 * instruction.
 */
#define RHO_SOFTWARE_ROOT
#define rho_sin software_sin
#define rho_cos software_cos
#define rho_atan2 software_atan2
#define rho_exp software_exp
#define rho_log software_log
#define rho_log_one_plus software_log_one_plus
#define rho_sqrt software_sqrt
#define rho_inverse_sqrt software_inverse_sqrt

#include "../../src/base/approx.c" /* NOLINT: the macros rename its functions */
#include "test_approx.c"           /* NOLINT */
