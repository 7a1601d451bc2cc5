/* SPDX-License-Identifier: MIT */
/*
 * imm_notch: an IMM filter and a radar's Doppler notch (notch.h): probability of a blind look, and
 * update by a miss. Stack: 280 bytes at most.
 */
#ifndef RHOTRACK_IMM_NOTCH_H
#define RHOTRACK_IMM_NOTCH_H

#include "rhotrack/detail/imm.h"
#include "rhotrack/detail/notch.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Probability that the target's range rate is in the sensor's notch, over both models. Cost: twice
 * rho_notch_share.
 */
float rho_imm_notch_share(const struct rho_imm *imm, const struct rho_sensor *sensor);

/*
 * Updates both models, and their probabilities, by a look without a plot. Nothing changes for a
 * sensor without a notch. Cost: rho_notch_miss twice.
 */
void rho_imm_miss(struct rho_imm *imm, const struct rho_sensor *sensor,
                  const struct rho_notch_look *look);

#ifdef __cplusplus
}
#endif

#endif
