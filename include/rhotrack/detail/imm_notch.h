/* SPDX-License-Identifier: MIT */
/* imm_notch: an IMM filter and a radar's Doppler notch. Stack: 300 bytes at most. */
#ifndef RHOTRACK_IMM_NOTCH_H
#define RHOTRACK_IMM_NOTCH_H

#include "rhotrack/detail/doppler_notch.h"
#include "rhotrack/detail/imm.h"

RHO_BEGIN_C

/* Probability of a blind look, over both models. Cost: twice rho_notch_blind_probability. */
float rho_imm_blind_probability(const struct rho_imm *imm, const struct rho_sensor *sensor);

/*
 * Updates models and probabilities by a miss if sensor or look has one: rho_notch_update_by_miss.
 */
void rho_imm_update_by_miss(struct rho_imm *imm, const struct rho_sensor *sensor,
                            const struct rho_notch_look *look);

RHO_END_C

#endif
