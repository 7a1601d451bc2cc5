/* SPDX-License-Identifier: MIT */
/* The tests of test_approx.c on what processors without an instruction for the square root run. */
#define RHO_SOFTWARE_ROOT
#define rho_sin software_sin
#define rho_cos software_cos
#define rho_atan2 software_atan2
#define rho_exp software_exp
#define rho_log software_log
#define rho_log_one_plus software_log_one_plus
#define rho_sqrt software_sqrt
#define rho_inverse_sqrt software_inverse_sqrt

#include "../../src/base/approx.c" /* NOLINT: with these names it stands beside the library's */
#include "test_approx.c"           /* NOLINT */
