/* SPDX-License-Identifier: MIT */
/*
 * input_estimation_decide: tests on each axis whether an input (an acceleration) is present. The
 * effect of an input that was present before and is rejected now is moved into the estimate.
 */
#include <string.h>

#include "input_sensitivity.h"
#include "rhotrack/detail/input_estimation.h"

/* Restarts the estimation of one axis' input: 0 with this variance, and no sensitivity. */
static void reset_input(struct rho_input *input, int axis, float variance)
{
    const uint8_t *place = rho_linalg_row6[axis];
    memset(input->sensitivity[axis], 0, sizeof input->sensitivity[axis]);
    input->input_mps2[axis] = 0.0f;
    input->variance[place[0]] = 0.0f;
    input->variance[place[1]] = 0.0f;
    input->variance[place[2]] = 0.0f;
    input->variance[place[axis]] = variance;
}

/* Square of the estimated input of one axis over its variance. */
static float input_nis(const struct rho_input *input, int axis)
{
    const float u = input->input_mps2[axis];
    return u / input->variance[rho_linalg_row6[axis][axis]] * u;
}

/* Conditional variance, variance minus the explained part, with a lower limit against rounding. */
static float remaining_variance(float variance, float explained)
{
    const float rest = variance - explained, least = variance * RHO_ROUNDING_UNITS(16);
    return rest > least ? rest : least;
}

/* Conditions the other axes' inputs on an input of 0 on this axis. */
static void condition_others_on_no_input(struct rho_input *input, int axis)
{
    const int b = (axis + 1) % NUM_AXES, c = (axis + 2) % NUM_AXES;
    float *v = input->variance;
    const float vb = v[RHO_AT(axis, b)], vc = v[RHO_AT(axis, c)];
    const float share_b = vb / v[RHO_AT(axis, axis)], share_c = vc / v[RHO_AT(axis, axis)];
    input->input_mps2[b] -= share_b * input->input_mps2[axis];
    input->input_mps2[c] -= share_c * input->input_mps2[axis];
    v[RHO_AT(b, b)] = remaining_variance(v[RHO_AT(b, b)], share_b * vb);
    v[RHO_AT(c, c)] = remaining_variance(v[RHO_AT(c, c)], share_c * vc);
    v[RHO_AT(b, c)] -= share_b * vc;
}

/*
 * Moves the effect of an ended input on one axis into the estimate. By regression on the other
 * axes, u = s_b u_b + s_c u_c + rest: the other axes' sensitivities get the shares s_b and s_c, and
 * only the rest, which is uncorrelated with the other inputs, goes into the estimate, so that
 * estimate and inputs stay independent.
 */
static void move_input_effect_into_filter(struct rho_input *input, int axis)
{
    const int b = (axis + 1) % NUM_AXES, c = (axis + 2) % NUM_AXES;
    const float *v = input->variance, *m = input->sensitivity[axis];
    const float vb = v[RHO_AT(axis, b)], vc = v[RHO_AT(axis, c)];
    float rest_mps2 = input->input_mps2[axis], variance = v[RHO_AT(axis, axis)];
    if (!is_zero(vb) || !is_zero(vc)) {
        const float bb = v[RHO_AT(b, b)], bc = v[RHO_AT(b, c)];
        const float pivot = remaining_variance(v[RHO_AT(c, c)], bc / bb * bc);
        const float share_c = (vc - bc / bb * vb) / pivot;
        const float share_b = (vb - share_c * bc) / bb;
        rest_mps2 -= share_b * input->input_mps2[b] + share_c * input->input_mps2[c];
        variance = remaining_variance(variance, share_b * vb + share_c * vc);
        for (int i = 0; i < NUM_STATES; i++) {
            input->sensitivity[b][i] += share_b * m[i];
            input->sensitivity[c][i] += share_c * m[i];
        }
    }
    add_input_effect(&input->bare, m, axis, rest_mps2, variance);
}

/* Removes correlated inputs below the limit, the weakest first. Returns the axes with inputs. */
static uint32_t end_correlated_inputs(struct rho_input *input, float nis_limit,
                                      float initial_variance)
{
    uint32_t left = INPUT_ALL_PRESENT;
    while (left) {
        /* of equals the first */
        int weakest = includes_axis(left, 0) ? 0 : (includes_axis(left, 1) ? 1 : 2);
        float least = input_nis(input, weakest);
        for (int axis = weakest + 1; axis < NUM_AXES; axis++) {
            if (includes_axis(left, axis) && input_nis(input, axis) < least) {
                weakest = axis;
                least = input_nis(input, axis);
            }
        }
        if (least > nis_limit) {
            break;
        }
        if (includes_axis(input->present, weakest)) {
            move_input_effect_into_filter(input, weakest);
        } else {
            condition_others_on_no_input(input, weakest);
        }
        reset_input(input, weakest, initial_variance);
        left &= ~(1u << weakest);
    }
    return left;
}

void rho_input_decide(struct rho_input *input, const struct rho_input_config *config)
{
    if (!config->is_estimated) {
        return;
    }
    const float limit2 = config->threshold * config->threshold;
    const float variance = config->sigma_mps2 * config->sigma_mps2;

    if (!are_inputs_independent(input->variance)) {
        input->present = end_correlated_inputs(input, limit2, variance);
        return;
    }
    uint32_t left = 0;
    for (int axis = 0; axis < NUM_AXES; axis++) {
        if (input_nis(input, axis) > limit2) {
            left |= 1u << axis;
            continue;
        }
        if (includes_axis(input->present, axis)) {
            add_input_effect(&input->bare, input->sensitivity[axis], axis, input->input_mps2[axis],
                             input->variance[rho_linalg_row6[axis][axis]]);
        }
        reset_input(input, axis, variance);
    }
    input->present = left;
}
