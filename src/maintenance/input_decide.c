/* SPDX-License-Identifier: MIT */
/* Onset and stop: on which axes is there an input, and what becomes of one that has stopped? */
#include <stddef.h>
#include <string.h>

#include "input_columns.h"
#include "rhotrack/input.h"

/* Where row i of a packed 3 x 3 matrix lies. */
static const uint8_t places[NUM_AXES][NUM_AXES] = {{0, 1, 3}, {1, 2, 4}, {3, 4, 5}};

static void start_anew(struct rho_input *input, int axis, float variance)
{
    const uint8_t *place = places[axis];

    memset(input->sensitivity[axis], 0, sizeof input->sensitivity[axis]);
    input->input_mps2[axis] = 0.0f;
    input->variance[place[0]] = 0.0f;
    input->variance[place[1]] = 0.0f;
    input->variance[place[2]] = 0.0f;
    input->variance[place[axis]] = variance;
}

static float significance2(const struct rho_input *input, int axis)
{
    const float u = input->input_mps2[axis];

    return u / input->variance[places[axis][axis]] * u;
}

/* ---- inputs that are correlated --------------------------------------------------------------- */

/* A variance less what another explains; rounding must not take all of it. */
static float remaining(float variance, float explained)
{
    const float rest = variance - explained, least = variance * ROUNDING_SHARE;

    return rest > least ? rest : least;
}

/* There never was an input on this axis: the others are what they are, given that. */
static void rule_out(struct rho_input *input, int axis)
{
    const int b = (axis + 1) % NUM_AXES, c = (axis + 2) % NUM_AXES;
    float *v = input->variance;
    const float vb = v[RHO_AT(axis, b)], vc = v[RHO_AT(axis, c)];
    const float share_b = vb / v[RHO_AT(axis, axis)], share_c = vc / v[RHO_AT(axis, axis)];

    input->input_mps2[b] -= share_b * input->input_mps2[axis];
    input->input_mps2[c] -= share_c * input->input_mps2[axis];
    v[RHO_AT(b, b)] = remaining(v[RHO_AT(b, b)], share_b * vb);
    v[RHO_AT(c, c)] = remaining(v[RHO_AT(c, c)], share_c * vc);
    v[RHO_AT(b, c)] -= share_b * vc;
}

/*
 * The input of this axis has been, and is no more: what it did goes into the estimate. Expressed by those of the other
 * axes, u = s_b u_b + s_c u_c + rest: their sensitivities take their shares over, and only the rest, which they do not
 * explain, is taken in, so that the filter's estimate and they stay independent.
 */
static void take_in(struct rho_input *input, int axis)
{
    const int b = (axis + 1) % NUM_AXES, c = (axis + 2) % NUM_AXES;
    const float *v = input->variance, *m = input->sensitivity[axis];
    const float vb = v[RHO_AT(axis, b)], vc = v[RHO_AT(axis, c)];
    float rest_mps2 = input->input_mps2[axis], variance = v[RHO_AT(axis, axis)];

    if (!is_zero(vb) || !is_zero(vc)) {
        const float bb = v[RHO_AT(b, b)], bc = v[RHO_AT(b, c)];
        const float pivot = remaining(v[RHO_AT(c, c)], bc / bb * bc);
        const float share_c = (vc - bc / bb * vb) / pivot;
        const float share_b = (vb - share_c * bc) / bb;

        rest_mps2 -= share_b * input->input_mps2[b] + share_c * input->input_mps2[c];
        variance = remaining(variance, share_b * vb + share_c * vc);
        for (int i = 0; i < NUM_STATES; i++) {
            input->sensitivity[b][i] += share_b * m[i];
            input->sensitivity[c][i] += share_c * m[i];
        }
    }
    add_column(&input->bare, m, axis, rest_mps2, variance);
}

/* Of these axes, at least one; of equals the first. */
static int find_weakest(const struct rho_input *input, uint32_t axes)
{
    int weakest = is_in(axes, 0) ? 0 : (is_in(axes, 1) ? 1 : 2);
    float least = significance2(input, weakest);

    for (int axis = weakest + 1; axis < NUM_AXES; axis++) {
        if (is_in(axes, axis) && significance2(input, axis) < least) {
            weakest = axis;
            least = significance2(input, axis);
        }
    }
    return weakest;
}

/* Returns the axes with inputs. */
static uint32_t decide_together(struct rho_input *input, float limit2, float variance)
{
    uint32_t left = INPUT_ALL_PRESENT;

    while (left) {
        const int axis = find_weakest(input, left);

        if (significance2(input, axis) > limit2) {
            break;
        }
        if (is_in(input->present, axis)) {
            take_in(input, axis);
        } else {
            rule_out(input, axis);
        }
        start_anew(input, axis, variance);
        left &= ~(1u << axis);
    }
    return left;
}

/* ---- inputs that are not ---------------------------------------------------------------------- */

static uint32_t decide_apart(struct rho_input *input, float limit2, float variance)
{
    uint32_t left = 0;

    for (int axis = 0; axis < NUM_AXES; axis++) {
        if (significance2(input, axis) > limit2) {
            left |= 1u << axis;
            continue;
        }
        if (is_in(input->present, axis)) {
            add_column(&input->bare, input->sensitivity[axis], axis, input->input_mps2[axis],
                       input->variance[places[axis][axis]]);
        }
        start_anew(input, axis, variance);
    }
    return left;
}

void rho_input_decide(struct rho_input *input, const struct rho_input_config *config)
{
    if (input == NULL || config == NULL || !config->is_estimated) {
        return;
    }
    const float limit2 = config->threshold * config->threshold;
    const float variance = config->sigma_mps2 * config->sigma_mps2;

    input->present = are_independent(input->variance) ? decide_apart(input, limit2, variance)
                                                      : decide_together(input, limit2, variance);
}
