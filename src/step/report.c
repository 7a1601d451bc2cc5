/* SPDX-License-Identifier: MIT */
/*
 * report: reports the tracks at the step's time, and counts the fates of the plots.
 */
#include <string.h>

#include "phases.h"

/*
 * After a scan of plots, tracks at another time than the step's are left alone: the scan did not see
 * them, or they started at a plot's own time. The report moves a copy of their estimates.
 */
void rho_step_merge_estimates(struct step *step)
{
    const struct rho_look *look = &step->look;
    for (unsigned i = 0; i < step->tracker->num_tracks; i++) {
        struct rho_track *track = &step->tracker->tracks[i];
        if ((step->frame || track->time_us == look->time_us) && !rho_track_is_frozen(track)) {
            rho_track_merge_estimates(track, look->time_us, &look->model);
        }
    }
}

/* Moves a merged estimate by dt_s: forward with its acceleration, back without. */
static void extrapolate_estimate(struct rho_track *at, float dt_s, float noise_density)
{
    if (rho_kalman_predict(&at->kalman, dt_s, noise_density) != RHO_OK) {
        return;
    }
    for (int axis = 0; axis < 3 && dt_s > 0.0f; axis++) {
        at->kalman.state[axis] += 0.5f * dt_s * dt_s * at->accel_mps2[axis];
        at->kalman.state[axis + 3] += dt_s * at->accel_mps2[axis];
    }
}

/* The track itself where it is at the step's time; else a copy, *at, moved to that time. */
static const struct rho_track *
track_at_step_time(const struct rho_look *look, const struct rho_track *track, struct rho_track *at)
{
    if (track->time_us == look->time_us) {
        return track;
    }
    *at = *track;
    /* a prediction back from a plot's own time adds no noise; neither way can be refused */
    if (RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
        extrapolate_estimate(at, rho_seconds_between(track->time_us, look->time_us),
                             look->model.noise_density);
    } else {
        (void)!rho_track_predict(at, look->time_us, &look->model);
    }
    return at;
}

static void report_track(const struct rho_look *look, const struct rho_track *track,
                         struct rho_track_report *out)
{
    int64_t age_us = look->time_us - track->updated_us;
    struct rho_track moved;
    const struct rho_track *at = track_at_step_time(look, track, &moved);
    *out = (struct rho_track_report){
        .track_id = track->track_id,
        .status = (enum rho_track_status)track->status,
        .hits = track->hits,
        .misses = track->misses,
        .sensor_id = track->sensor_id,
        .plot = rho_step_is_newest(look->tracker, look->time_us) ? track->plot : -1,
        .update_age_us = age_us < 0           ? 0
                         : age_us < INT32_MAX ? (int32_t)age_us
                                              : INT32_MAX,
        .score_nat = (float)track->score_mnat * 0.001f,
        .sigma_m = rho_track_sigma_m(at),
        .sigma_mps = rho_track_sigma_mps(at),
        .maneuver_probability = at->maneuver_probability,
        .num_hypotheses = 1,
    };
    if (RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
        out->num_hypotheses =
            (uint16_t)rho_hypotheses_count(&look->tracker->hypotheses, track->slot);
    }
    memcpy(out->accel_mps2, at->accel_mps2, sizeof out->accel_mps2);
    memcpy(out->state, at->kalman.state, sizeof out->state);
    memcpy(out->covariance, at->kalman.covariance, sizeof out->covariance);
}

/*
 * Adds each input's fate to the totals of report and tracker. Inputs without a place in fates[] are
 * STALE in an out-of-sequence scan, else NO_ROOM.
 */
static void count_plot_fates(const struct step *step)
{
    struct rho_tracker_counters *counters = &step->tracker->counters;
    struct rho_report *report = step->report;
    for (uint32_t i = 0; i < step->look.num_gated; i++) {
        report->fates_total[report->fates[i]]++;
    }
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
}

void rho_step_report_tracks(const struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    tracker->counters.hypotheses_cut = tracker->hypotheses.hypotheses_cut;
    step->report->num_tracks = tracker->num_tracks;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        report_track(&step->look, &tracker->tracks[i], &step->report->tracks[i]);
    }
}

void rho_step_report(struct step *step)
{
    count_plot_fates(step);
    rho_step_report_tracks(step);
}
