/* SPDX-License-Identifier: MIT */
/*
 * track_life: the end of a track, and the thresholds that confirm and end tracks.
 */
#include "clutter.h"
#include "plots.h"
#include "rhotrack/detail/approx.h"
#include "sensors.h"
#include "step.h"

/* Wald's lower threshold below the start score, ln 100: loses one true track in a hundred. */
#define TENTATIVE_FALL_MNAT 4605

/*
 * Fall of the score at which a target has probably gone, ln 200: a target's mean lifetime is 200
 * scans. In frames of bearings it is multiplied by the number of sensors, which are assumed to miss
 * a target together.
 */
#define LIFETIME_MNAT 5298

/*
 * The target of an established track that has moved, and is not seen any more, may be hidden behind
 * something. Its track is kept, tentative and unreported, for HIDE_SHARE times coast_scans_max
 * misses, while at most HIDE_CLUTTER_MAX clutter plots are expected in its gate.
 */
#define HIDE_SHARE 2.4f
#define HIDE_CLUTTER_MAX 3.0f

void rho_life_end(struct step *step, struct rho_track *track)
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

/*
 * Largest loss of score by one miss, of all sensors. With the loss of the scan's own sensor alone,
 * a scan of a sensor with a low pd would lower the limit for the misses of a better one.
 */
static float largest_miss_loss_of_sensors(const struct rho_look *look)
{
    float loss = -look->log_miss;
    for (unsigned i = 0; i < look->tracker->num_sensors; i++) {
        float other = -rho_log(1.0f - look->tracker->sensors[i].sensor.pd);
        loss = other > loss ? other : loss;
    }
    return loss;
}

struct rho_track_limits rho_life_limits(const struct rho_look *look)
{
    const struct rho_tracker *tracker = look->tracker;
    struct rho_track_limits limits = {
        .confirm_mnat = tracker->confirm_mnat,
        .doubt_mnat = LIFETIME_MNAT * (int32_t)tracker->looks_max,
        .tentative_mnat = tracker->start_mnat - TENTATIVE_FALL_MNAT,
        .fall_mnat =
            rho_score_to_mnat(largest_miss_loss_of_sensors(look) *
                              (float)tracker->config.coast_scans_max * (float)tracker->looks_max),
        .misses_in_row_max = (uint8_t)tracker->config.coast_scans_max,
    };
    return limits;
}

static int may_be_hidden_target(const struct rho_look *look, const struct rho_track *track)
{
    return rho_life_is_established(track) &&
           (RHO_MAX_ECHOES == 0 || rho_echoes_is_moving_target(track)) &&
           rho_clutter_in_gate(look, track) <= HIDE_CLUTTER_MAX;
}

/*
 * Lets a track of a hidden target end later, and holds its score within twice doubt_mnat of its
 * highest: misses of a hidden target are no evidence, and two plots should confirm its return.
 */
static void keep_hidden_target_longer(struct rho_track *track, struct rho_track_limits *limits)
{
    const float misses = HIDE_SHARE * (float)limits->misses_in_row_max;
    const int32_t most_mnat = 2 * limits->doubt_mnat;
    const int32_t least_mnat = track->score_max_mnat - most_mnat;
    limits->misses_in_row_max = misses < (float)UINT8_MAX ? (uint8_t)misses : UINT8_MAX;
    limits->fall_mnat = limits->fall_mnat > most_mnat ? limits->fall_mnat : most_mnat + 1;
    track->score_mnat = track->score_mnat > least_mnat ? track->score_mnat : least_mnat;
}

void rho_life_apply(struct step *step, struct rho_track *track,
                    const struct rho_track_limits *limits)
{
    const uint8_t was_confirmed = track->was_confirmed;
    const int is_low = track->score_max_mnat - track->score_mnat > 2 * limits->doubt_mnat;
    const int is_missed_out = track->misses_in_row >= limits->misses_in_row_max;
    struct rho_track_limits own = *limits;
    if ((is_low || is_missed_out) && may_be_hidden_target(&step->look, track)) {
        keep_hidden_target_longer(track, &own);
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
