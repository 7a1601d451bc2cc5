/* SPDX-License-Identifier: MIT */
/* report: reports the tracks at the step's time, and counts the fates of the plots. */
#include <string.h>

#include "phases.h"

/*
 * After a scan of plots, tracks at another time than the step's are left alone: the scan did not
 * see them, or they started at a plot's own time. The report moves a copy of their estimates.
 */
void rho_step_merge_estimates(const struct step *step)
{
    const struct rho_look *look = &step->look;
    for (unsigned i = 0; i < step->tracker->num_tracks; i++) {
        struct rho_track *track = &step->tracker->tracks[i];
        if ((look->bearings || track->time_us == look->time_us) && !rho_track_is_frozen(track)) {
            rho_track_merge_estimates(track, look->time_us, &look->model);
        }
    }
}

void rho_step_report_tracks(const struct step *step)
{
    const struct rho_look *look = &step->look;
    struct rho_tracker *tracker = step->tracker;
    tracker->counters.hypotheses_cut = tracker->hypotheses.hypotheses_cut;
    step->report->num_tracks = tracker->num_tracks;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        const struct rho_track *track = &tracker->tracks[i], *at = track;
        const int64_t age_us = look->time_us - track->updated_us;
        const float dt_s = rho_seconds_between(track->time_us, look->time_us);
        struct rho_track_report *out = &step->report->tracks[i];
        struct rho_track moved;
        if (track->time_us != look->time_us) {
            moved = *track;
            at = &moved;
            if (!RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
                /* a prediction back from a plot's own time adds no noise; neither can be refused */
                (void)!rho_track_predict(&moved, look->time_us, &look->model);
            } else if (rho_kalman_predict(&moved.kalman, dt_s, look->model.noise_density) ==
                       RHO_OK) {
                /* a merged estimate moves forward with its acceleration, back without */
                for (int axis = 0; axis < 3 && dt_s > 0.0f; axis++) {
                    moved.kalman.state[axis] += 0.5f * dt_s * dt_s * moved.accel_mps2[axis];
                    moved.kalman.state[axis + 3] += dt_s * moved.accel_mps2[axis];
                }
            }
        }
        *out = (struct rho_track_report){
            .track_id = track->track_id,
            .status = (enum rho_track_status)track->status,
            .hits = track->hits,
            .misses = track->misses,
            .sensor_id = track->sensor_id,
            .plot = rho_step_is_newest(tracker, look->time_us) ? track->plot : -1,
            .update_age_us = age_us < 0           ? 0
                             : age_us < INT32_MAX ? (int32_t)age_us
                                                  : INT32_MAX,
            .score_nat = (float)track->score_mnat * 0.001f,
            .sigma_m = rho_track_sigma_m(at),
            .sigma_mps = rho_track_sigma_mps(at),
            .maneuver_probability = at->maneuver_probability,
            .num_hypotheses =
                RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)
                    ? (uint16_t)rho_hypotheses_count(&tracker->hypotheses, track->slot)
                    : 1,
            .is_in_doubt = track->was_confirmed && track->status == RHO_TRACK_TENTATIVE,
        };
        memcpy(out->accel_mps2, at->accel_mps2, sizeof out->accel_mps2);
        memcpy(out->state, at->kalman.state, sizeof out->state);
        memcpy(out->covariance, at->kalman.covariance, sizeof out->covariance);
    }
}

void rho_step_report(const struct step *step)
{
    struct rho_tracker_counters *counters = &step->tracker->counters;
    struct rho_report *report = step->report;
    for (uint32_t i = 0; i < step->look.num_gated; i++) {
        report->fates_total[report->fates[i]]++;
    }
    /* inputs without a place in fates[] */
    uint32_t others = step->look.num_inputs - step->look.num_gated;
    if (RHO_CLAIMS_BEYOND) {
        report->fates_total[RHO_FATE_CLAIMED] += step->num_beyond_claimed;
        report->fates_total[RHO_FATE_INVALID] += step->num_beyond_invalid;
        others -= step->num_beyond_claimed + step->num_beyond_invalid;
    }
    report->fates_total[step->look.teaches ? RHO_FATE_NO_ROOM : RHO_FATE_STALE] += others;
    for (int fate = 0; fate < RHO_NUM_FATES; fate++) {
        counters->fates[fate] = rho_count(counters->fates[fate], report->fates_total[fate]);
    }
    counters->plots_in = rho_count(counters->plots_in, step->look.num_inputs);
    rho_step_report_tracks(step);
}
