/* SPDX-License-Identifier: MIT */
#include "rhotrack/gate.h"

#include "rhotrack/linalg.h"

void rho_gate_open(struct rho_gate *gate, const struct rho_kalman *predicted)
{
    for (int axis = 0; axis < 3; axis++) {
        gate->position_m[axis] = predicted->state[axis];
        gate->velocity_mps[axis] = predicted->state[axis + 3];
    }
    /* the first three rows of the packed triangle are the position's covariance */
    for (int k = 0; k < RHO_TRIANGLE(3); k++) {
        gate->covariance[k] = predicted->covariance[k];
    }
    gate->has_z = rho_kalman_is_open(predicted, 2);
}

/* Outside the box around the gate's ellipsoid: most plots end here, without a division. NaN ends here too. */
static int is_far(float d_m, float variance_m2)
{
    return !(d_m * d_m <= RHO_GATE_CHI2_3D * variance_m2);
}

int rho_gate_test(const struct rho_gate *gate, const struct rho_plot *plot, uint32_t measures,
                  struct rho_gate_result *result)
{
    float sigma_m = rho_plot_sigma_m(plot);
    float variance_m2 = sigma_m * sigma_m;
    float offset_s = (float)plot->offset_us * 1e-6f;
    const float d_m[3] = {
        plot->x_m - gate->position_m[0] - gate->velocity_mps[0] * offset_s,
        plot->y_m - gate->position_m[1] - gate->velocity_mps[1] * offset_s,
        plot->z_m - gate->position_m[2] - gate->velocity_mps[2] * offset_s,
    };
    float s[6];
    for (int k = 0; k < RHO_TRIANGLE(3); k++) {
        s[k] = gate->covariance[k];
    }
    s[0] += variance_m2;
    s[2] += variance_m2;
    s[5] += plot->sigma_up_m * plot->sigma_up_m;
    if (is_far(d_m[0], s[0]) || is_far(d_m[1], s[2])) {
        return 0;
    }
    result->has_z = gate->has_z && (measures & RHO_MEASURES_Z);
    if (result->has_z) {
        return rho_linalg_gate3(s, d_m, &result->distance2, &result->log_det) == RHO_OK &&
               result->distance2 <= RHO_GATE_CHI2_3D;
    }
    return rho_linalg_gate2(s, d_m, &result->distance2, &result->log_det) == RHO_OK &&
           result->distance2 <= RHO_GATE_CHI2_2D;
}
