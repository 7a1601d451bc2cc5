/* SPDX-License-Identifier: MIT */
#include "accumulator_pass.h"
void rho_accumulator_prune(struct rho_accumulator_pass *pass)
{
    rho_accumulator_stream(pass);
}
