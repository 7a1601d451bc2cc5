/* SPDX-License-Identifier: MIT */
/* imm_notch: updates both models of a filter by a miss of a radar with a Doppler notch. */
#include "rhotrack/detail/imm_notch.h"

float rho_imm_notch_share(const struct rho_imm *imm, const struct rho_sensor *sensor)
{
    const float steady = rho_notch_share(sensor, imm->steady.state, imm->steady.covariance);
    return steady +
           imm->probability * (rho_notch_share(sensor, imm->state, imm->covariance) - steady);
}

void rho_imm_miss(struct rho_imm *imm, const struct rho_sensor *sensor,
                  const struct rho_notch_look *look)
{
    if (!rho_notch_has(sensor)) {
        return;
    }
    imm->is_coupled = 1;
    const float steady =
        (1.0f - imm->probability) *
        rho_notch_miss(sensor, look, RHO_KALMAN_STATES, imm->steady.state, imm->steady.covariance);
    const float manoeuvre = imm->probability * rho_notch_miss(sensor, look, RHO_IMM_STATES,
                                                              imm->state, imm->covariance);
    imm->probability = manoeuvre / (steady + manoeuvre);
}
