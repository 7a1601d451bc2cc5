/* SPDX-License-Identifier: MIT */
/* track_life: the end of a track, and the thresholds that confirm and end tracks. */
#include "clutter.h"
#include "plots.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "step.h"

void rho_life_end(const struct step *step, struct rho_track *track)
{
    struct rho_report *report = step->report;
    if (track->was_confirmed) {
        report->ended[report->num_ended++] = track->track_id;
    }
    rho_track_free_hypotheses(track, &step->look.model);
    track->status = RHO_TRACK_FREE;
    step->tracker->counters.tracks_ended = rho_count(step->tracker->counters.tracks_ended, 1);
}

void rho_life_remove_ended(struct rho_tracker *tracker)
{
    unsigned live = 0;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        if (tracker->tracks[i].status != RHO_TRACK_FREE) {
            if (RHO_KEEPS_OFFERS) {
                rho_assignment_move_pairs(&tracker->assignment, i, live);
            }
            tracker->tracks[live++] = tracker->tracks[i];
        }
    }
    tracker->num_tracks = (uint16_t)live;
    if (RHO_KEEPS_OFFERS && tracker->assignment.num_rows > live) {
        tracker->assignment.num_rows = (uint16_t)live;
    }
}

struct rho_track_limits rho_life_limits(const struct rho_look *look)
{
    const struct rho_tracker *tracker = look->tracker;
    /*
     * Largest loss of score by one miss, of all sensors. With the loss of the scan's own sensor
     * alone, a sensor with a low pd would lower the limit for the misses of a better one.
     */
    float loss = -look->log_miss;
    for (unsigned i = 0; i < tracker->num_sensors; i++) {
        float other = -rho_log(1.0f - tracker->sensors[i].sensor.pd);
        loss = other > loss ? other : loss;
    }
    return (struct rho_track_limits){
        .confirm_mnat = tracker->confirm_mnat,
        /* the sensors of a frame of bearings are assumed to miss a target together */
        .doubt_mnat = LIFETIME_MNAT * (int32_t)tracker->looks_max,
        .tentative_mnat = tracker->start_mnat - TENTATIVE_FALL_MNAT,
        .fall_mnat = rho_score_to_mnat(loss * (float)tracker->config.coast_scans_max *
                                       (float)tracker->looks_max),
        .misses_in_row_max = (uint8_t)tracker->config.coast_scans_max,
    };
}

void rho_life_apply(const struct step *step, struct rho_track *track,
                    const struct rho_track_limits *limits)
{
    const uint8_t was_confirmed = track->was_confirmed;
    const int32_t most_mnat = 2 * limits->doubt_mnat;
    const int is_low = track->score_max_mnat - track->score_mnat > most_mnat;
    const int is_missed_out = track->misses_in_row >= limits->misses_in_row_max;
    struct rho_track_limits own = *limits;
    /*
     * The target of an established track that has moved may be hidden: its track ends later, and
     * its score is held, as misses are no evidence then, and two plots should confirm its return.
     */
    if ((is_low || is_missed_out) && rho_life_is_established(track) &&
        (RHO_MAX_ECHOES == 0 || track->has_taken_back) &&
        rho_clutter_in_gate(&step->look, track) <= COAST_CLUTTER_MAX) {
        const float misses = HIDE_SHARE * (float)own.misses_in_row_max;
        const int32_t least_mnat = track->score_max_mnat - most_mnat;
        own.misses_in_row_max = misses < (float)UINT8_MAX ? (uint8_t)misses : UINT8_MAX;
        own.fall_mnat = own.fall_mnat > most_mnat ? own.fall_mnat : most_mnat + 1;
        track->score_mnat = track->score_mnat > least_mnat ? track->score_mnat : least_mnat;
    }
    if (is_missed_out || rho_evidence_is_lacking(step, track)) {
        own.doubt_mnat = 0;
    }
    rho_evidence_count_established(step->tracker, track);
    if (rho_track_apply_thresholds(track, &own) == RHO_TRACK_FREE) {
        rho_evidence_count_ended(step, track);
        rho_life_end(step, track);
    } else if (track->was_confirmed != was_confirmed) {
        step->tracker->counters.tracks_confirmed =
            rho_count(step->tracker->counters.tracks_confirmed, 1);
    }
}
