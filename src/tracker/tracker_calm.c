/* SPDX-License-Identifier: MIT */
/*
 * tracker_calm: how long this sky's targets keep straight.
 *
 * The chance that a calm target begins to turn (imm.h) is held against every plot of every straight
 * track: where nobody turns for hours it makes covariances too large and places worse than they
 * need be. Over all grown tracks of the last half an hour, while they were seen, with X the seconds
 * that they kept straight and Y those in which a manoeuvre was likelier than not, the mean time
 * between manoeuvres is
 *
 *      (4 300 s + X) / (4 + Y / maneuver_s)
 *
 * as if four had been seen at the 300 s that are believed at first. calm_s is doubled where it is
 * twice as long, up to 2400 s: a sky in which nobody turned must still see the first one that does.
 * It is halved again where it is less than three quarters. In so few steps a few tracks change
 * nothing of others. After a silence it is 300 s: what calm targets do when nobody looks was not
 * learned.
 */
#include "tracker_step.h"

#define PRIOR 4.0f
#define LONGEST_S (8.0f * RHO_IMM_CALM_S)

/* Between steps that are further apart nobody looked. */
#define LOOKED_S 60.0f

void rho_tracker_forget_calm(struct rho_tracker *tracker, int64_t time_us)
{
    if (RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES) &&
        rho_seconds_between(tracker->time_us, time_us) > LOOKED_S) {
        rho_hypotheses_set_calm(&tracker->hypotheses, RHO_IMM_CALM_S);
        tracker->straight_s = tracker->turning_s = 0.0f;
    }
}

void rho_tracker_learn_calm(struct step *step, float dt_s)
{
    struct rho_tracker *tracker = step->tracker;
    if (!RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES) || !step->model.hypotheses || dt_s > LOOKED_S) {
        return;
    }
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        const struct rho_track *track = &tracker->tracks[i];
        if (rho_tracker_is_grown(track) && track->status == RHO_TRACK_CONFIRMED) {
            *(track->maneuver_probability > 0.5f ? &tracker->turning_s : &tracker->straight_s) +=
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
