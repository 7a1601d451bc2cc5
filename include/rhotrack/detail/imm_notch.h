/* SPDX-License-Identifier: MIT */
/*
 * imm_notch: both models of a filter beside a radar's blind range rates (notch.h).
 *
 * Stack: 280 bytes at most.
 */
#ifndef RHOTRACK_IMM_NOTCH_H
#define RHOTRACK_IMM_NOTCH_H

#include "rhotrack/detail/imm.h"
#include "rhotrack/detail/notch.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The share of looks that are blind to the target. Cost: twice rho_notch_share. */
float rho_imm_notch_share(const struct rho_imm *imm, const struct rho_sensor *sensor);

/*
 * Both models after a look without a plot, and their probabilities by how likely they made that.
 * Nothing changes without a notch. Cost: rho_notch_miss twice.
 */
void rho_imm_miss(struct rho_imm *imm, const struct rho_sensor *sensor,
                  const struct rho_notch_look *look);

#ifdef __cplusplus
}
#endif

#endif
