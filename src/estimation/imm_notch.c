/* SPDX-License-Identifier: MIT */
/* imm_notch: updates both models of a filter by a miss that tells of the range rate. */
#include "rhotrack/detail/imm_notch.h"

float rho_imm_blind_probability(const struct rho_imm *imm, const struct rho_sensor *sensor)
{
    const float steady =
        rho_notch_blind_probability(sensor, imm->steady.state, imm->steady.covariance);
    return steady + imm->probability *
                        (rho_notch_blind_probability(sensor, imm->state, imm->covariance) - steady);
}

void rho_imm_update_by_miss(struct rho_imm *imm, const struct rho_sensor *sensor,
                            const struct rho_notch_look *look)
{
    if (!rho_notch_sensor_has_notch(sensor) && !(look->rest_mps > 0.0f)) {
        return;
    }
    imm->is_coupled = 1;
    const float steady = (1.0f - imm->probability) *
                         rho_notch_update_by_miss(sensor, look, RHO_KALMAN_STATES,
                                                  imm->steady.state, imm->steady.covariance);
    const float manoeuvre =
        imm->probability *
        rho_notch_update_by_miss(sensor, look, RHO_IMM_STATES, imm->state, imm->covariance);
    imm->probability = manoeuvre / (steady + manoeuvre);
}
