/* SPDX-License-Identifier: MIT */
/*
 * manoeuvre_interval: learns the mean time between manoeuvres of calm targets.
 *
 * The probability that a calm target begins to turn (imm.h) enters the estimate of every straight
 * track at every plot. Where no target turns for hours, it makes covariances too large and
 * estimates worse than necessary. Of all established tracks of the last half an hour, let Y be the
 * seconds of confirmed track in which the target surely manoeuvred and X the other seconds. The
 * mean time between manoeuvres is then
 *
 *      (4 300 s + X) / (4 + Y / maneuver_s)
 *
 * as if four manoeuvres had been seen at the default of 300 s. A manoeuvre that is only likelier
 * than not does not count, as noise above the stated one also looks like a manoeuvre. The model's
 * calm_s is doubled where this mean is twice calm_s, up to 2400 s, so that a first manoeuvre is
 * still followed. It is halved where the mean is below three quarters of calm_s, down to 300 s:
 * where tracks seem to manoeuvre all the time, noise above the stated one could not be learned.
 * With steps of two a few tracks do not change the model of the others. After a silence calm_s is
 * 300 s again, as nothing was learned meanwhile.
 */
#include "policy.h"
#include "sight.h"
#include "step.h"

#define LONGEST_S (RHO_IMM_CALM_S * 8.0f)
/* Longest time between two steps that is counted: sensors are not silent for longer. */
#define LOOKED_S ((float)RHO_TRACKER_SILENT_US * 1e-6f)

void rho_manoeuvres_reset(struct rho_tracker *tracker, int64_t time_us)
{
    if (RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES) &&
        rho_seconds_between(tracker->time_us, time_us) > LOOKED_S) {
        rho_hypotheses_set_calm_s(&tracker->hypotheses, RHO_IMM_CALM_S);
        tracker->straight_s = tracker->turning_s = 0.0f;
    }
}

void rho_manoeuvres_learn(struct rho_tracker *tracker, const struct rho_look *look, float dt_s)
{
    if (!RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES) || !look->model.hypotheses || dt_s > LOOKED_S) {
        return;
    }
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        const struct rho_track *track = &tracker->tracks[i];
        if (rho_life_is_established(track) && track->status == RHO_TRACK_CONFIRMED) {
            *(track->maneuver_probability > TURNS_SURELY ? &tracker->turning_s
                                                         : &tracker->straight_s) += dt_s;
        }
    }
    const struct rho_imm_model *model = &tracker->hypotheses.model;
    const float calm_s = (MANOEUVRES_PRIOR * RHO_IMM_CALM_S + tracker->straight_s) /
                         (MANOEUVRES_PRIOR + tracker->turning_s / model->maneuver_s);
    if (calm_s >= 2.0f * model->calm_s && model->calm_s < LONGEST_S) {
        rho_hypotheses_set_calm_s(&tracker->hypotheses, 2.0f * model->calm_s);
    } else if (calm_s < 0.75f * model->calm_s && model->calm_s > RHO_IMM_CALM_S) {
        rho_hypotheses_set_calm_s(&tracker->hypotheses, 0.5f * model->calm_s);
    }
}
