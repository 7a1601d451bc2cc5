/* SPDX-License-Identifier: MIT */
/* plot_noise: how noisy is a plot? As stated, by learned notch and noise, by a suspect sensor. */
#include "sensors.h"

void rho_look_open_noise(struct rho_tracker *tracker, struct rho_look *look)
{
    if (RHO_DOPPLER_NOTCH) {
        rho_learning_apply_notch(look);
    }
    const float suspicion = RHO_SECTORS ? rho_health_sigma_factor(tracker, look) : 1.0f;
    if (RHO_SIGMAS_VARY && look->learned) {
        rho_learning_write_noise(look, suspicion, &look->row->sensor);
    }
}
