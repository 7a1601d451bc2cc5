/* SPDX-License-Identifier: MIT */
#include "pipeline/hidden_turns.h"

#include <math.h>

#include "rhotrack/detail/imm.h"

/*
 * Share of an acceleration that the tracker's motion model holds from one look to the next, below
 * which turns are hidden. Bearings of .1 deg, turns that last, beside a filter told whose they are:
 * at .39 (10 m/s^2 of 300 m/s, each 10 s) completeness is .003 lower, at .15 (20 m/s^2) .04, and
 * there are seven times its false tracks, at .02 (each 20 s) .2.
 */
#define HELD_LEAST 0.2

void hidden_turns_print(int64_t span_us, uint64_t looks, const struct parameters *parameters,
                        FILE *file)
{
    const double interval_s = looks > 1 ? 1e-6 * (double)span_us / (double)(looks - 1) : 0;
    const double accel_mps2 = parameters->value[PARAMETER_ACCEL_MAX_MPS2];
    const double speed_mps = parameters->value[PARAMETER_V_MAX_MPS];
    struct rho_imm_model model;

    rho_imm_model_default(&model, (float)accel_mps2, (float)speed_mps);
    if (parameters->source[PARAMETER_ACCEL_MAX_MPS2] > SOURCE_METHOD &&
        exp(-interval_s / (double)model.memory_s) < HELD_LEAST) {
        fprintf(file,
                "rhotrack: looks each %.3g s hide turns: with accel_max_mps2=%g a target at "
                "v_max_mps=%g turns by %.0f degrees between two, a slower one by more; "
                "accel_max_mps2 should be no more than targets need\n",
                interval_s, accel_mps2, speed_mps,
                interval_s * accel_mps2 / speed_mps * 180 / M_PI);
    }
}
