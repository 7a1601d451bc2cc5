/* SPDX-License-Identifier: MIT */
/*
 * manoeuvre_interval: learns the mean time between manoeuvres of calm targets.
 *
 * The probability that a calm target begins to turn (imm.h) is weighed at every plot of every
 * straight track. Where no target turns for hours, it makes covariances too large and estimates
 * worse than necessary. Over all established tracks of the last half an hour, while they were seen,
 * with Y the seconds in which they surely manoeuvred and X the others, the mean time between
 * manoeuvres is
 *
 *      (4 300 s + X) / (4 + Y / maneuver_s)
 *
 * as if four manoeuvres had been seen at the default of 300 s. A manoeuvre that is only likelier
 * than not does not count: noise above the stated one looks so. calm_s is doubled where that is
 * twice as long, up to 2400 s, so that the first manoeuvre is still followed in a sky without any.
 * It is halved where that is less than three quarters, down to 300 s: noise above the stated one is
 * not learned where tracks are taken to manoeuvre all the time. With such coarse steps a few tracks
 * change nothing for the others. After a silence it is 300 s again: nothing was learned meanwhile.
 */
#include "step.h"

#define PRIOR 4.0f
#define LONGEST_S (8.0f * RHO_IMM_CALM_S)
#define SURELY 0.9f

/* Longer gaps between steps teach nothing. */
#define LOOKED_S 60.0f

void rho_tracker_reset_manoeuvre_interval(struct rho_tracker *tracker, int64_t time_us)
{
    if (RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES) &&
        rho_seconds_between(tracker->time_us, time_us) > LOOKED_S) {
        rho_hypotheses_set_calm(&tracker->hypotheses, RHO_IMM_CALM_S);
        tracker->straight_s = tracker->turning_s = 0.0f;
    }
}

void rho_tracker_learn_manoeuvre_interval(struct step *step, float dt_s)
{
    struct rho_tracker *tracker = step->tracker;
    if (!RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES) || !step->model.hypotheses || dt_s > LOOKED_S) {
        return;
    }
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        const struct rho_track *track = &tracker->tracks[i];
        if (rho_tracker_is_established(track) && track->status == RHO_TRACK_CONFIRMED) {
            *(track->maneuver_probability > SURELY ? &tracker->turning_s : &tracker->straight_s) +=
                dt_s;
        }
    }
    const struct rho_imm_model *model = &tracker->hypotheses.model;
    const float calm_s = (PRIOR * RHO_IMM_CALM_S + tracker->straight_s) /
                         (PRIOR + tracker->turning_s / model->maneuver_s);
    if (calm_s >= 2.0f * model->calm_s && model->calm_s < LONGEST_S) {
        rho_hypotheses_set_calm(&tracker->hypotheses, 2.0f * model->calm_s);
    } else if (calm_s < 0.75f * model->calm_s && model->calm_s > RHO_IMM_CALM_S) {
        rho_hypotheses_set_calm(&tracker->hypotheses, 0.5f * model->calm_s);
    }
}
