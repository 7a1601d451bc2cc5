/* SPDX-License-Identifier: MIT */
/*
 * blind_looks: tracks in the Doppler notch of a sensor
 * (rhotrack/detail/doppler_notch.h).
 *
 * The share of looks that are blind follows from the range rate that a track's estimate expects.
 * Where most looks are blind, a scan without a plot is no miss: a confirmed track coasts, with its
 * identity, until it leaves the notch, or its place is so uncertain that clutter would be claimed,
 * or it was not seen for too long. Blind looks count neither for the sensor's health nor for its
 * learned pd.
 */
#include "clutter.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/imm_notch.h"
#include "sight.h"

/* Probability that a look at the track is blind, as its range rate lies in the sensor's notch. */
static float blind_look_probability(const struct rho_look *look, const struct rho_track *track)
{
    const struct rho_hypotheses *pool = &look->tracker->hypotheses;
    float sum = 0.0f, shares = 0.0f;
    if (!RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
        return rho_notch_blind_probability(look->sensor, track->kalman.state,
                                           track->kalman.covariance);
    }
    for (unsigned i = 0; i < rho_hypotheses_count(pool, track->slot); i++) {
        const struct rho_hypothesis *at = rho_hypotheses_at(pool, track->slot, i);
        shares += at->share;
        sum += at->share * rho_imm_blind_probability(&at->imm, look->sensor);
    }
    return shares > 0.0f ? sum / shares : 0.0f;
}

void rho_notch_mark_tracks(struct rho_tracker *tracker, struct rho_look *look)
{
    look->notch_look = (struct rho_notch_look){
        .pd = look->pd,
        .may_stand = tracker->config.v_min_mps <= look->sensor->notch_mps,
    };
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        if (track->status == RHO_TRACK_FREE || !rho_look_has_in_view(look, row)) {
            continue;
        }
        track->blind_percent = 0; /* unseen for too long, or clutter would be claimed */
        if (!(rho_seconds_between(track->updated_us, look->time_us) > BLIND_MAX_S) &&
            !(rho_clutter_in_gate(look, track) > COAST_CLUTTER_MAX)) {
            const float percent = 100.0f * blind_look_probability(look, track);
            track->blind_percent = (uint8_t)(percent < 99.0f ? percent : 99.0f);
        }
    }
}

struct detection rho_notch_detection(const struct rho_look *look, const struct rho_track *track,
                                     struct detection elsewhere)
{
    const float blind = 0.01f * (float)track->blind_percent;
    const float seen = rho_exp(elsewhere.log_pd) * (1.0f - blind);
    const float *velocity_mps = &track->kalman.state[3];
    const float most_mps = RHO_NOTCH_STAND_WIDTHS * look->sensor->notch_mps;
    const int may_stand = rho_notch_is_mostly_blind(track) &&
                          velocity_mps[0] * velocity_mps[0] + velocity_mps[1] * velocity_mps[1] <=
                              most_mps * most_mps;
    /*
     * a target that stands stays in the notch: misses are no independent evidence, nearly certain
     */
    return (struct detection){rho_log(seen + NOTCH_PD * blind),
                              may_stand ? -1.0e-4f : rho_log(1.0f - seen)};
}

void rho_notch_coast(const struct rho_look *look, struct rho_track *track)
{
    rho_track_apply_event(track, RHO_TRACK_MISS);
    if (look->teaches) {
        track->seen_us = look->time_us;
    }
}
