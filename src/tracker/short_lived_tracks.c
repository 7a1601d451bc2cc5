/* SPDX-License-Identifier: MIT */
/*
 * short_lived_tracks: where many tracks end soon after they were confirmed, new ones need more
 * evidence.
 *
 * The score compares a target with clutter that comes and goes. It knows nothing of objects that
 * move as targets do and are seldom seen: second-time-around echoes, sidelobes, the edge of a
 * weather front. Such an object is a track each time three of its plots follow each other by
 * chance, and is missed then. Tracks that end so early are counted, and established ones, which
 * have 16 hits. For each track the evidence that it is seen as often as targets are, and not 0.3
 * times as often, is (h hits, m misses)
 *
 *      e = h ln(1 / 0.3) - m ln((1 - 0.3 p) / (1 - p))
 *
 * with p the detection probability of established tracks. Three hits are 3.6. Where D tracks ended
 * early and G were established in the last half an hour, or soon will be (e is 7.2), a track is
 * confirmed from
 *
 *      e = 3.6 + ln(10 (D - W - sqrt(D) / 2) / (G + 2))
 *
 * on, or from 16 hits on: one in ten of the confirmed tracks will be false (Wald). W is the number
 * that false_tracks_per_hour allows, and half a standard deviation of D may be chance; where no
 * more tracks end early, no evidence is needed. Until then a track is tentative.
 *
 * A track has ended early whose score was one that confirms, and that misses ended before 16 hits
 * with e below 0. Targets that came and left soon are counted, too: with one in twenty instead of
 * one in ten, all targets would be found later where aircraft come and go.
 */
#include "rhotrack/detail/approx.h"
#include "step.h"

/* Share of looks that see an object that is no target, over that of targets. */
#define SELDOM 0.3f
#define HIT_NAT 1.2039728f /* ln(1 / SELDOM) */
#define START_NAT (3.0f * HIT_NAT)

#define ALMOST_ESTABLISHED_NAT (2.0f * START_NAT)

/* True tracks to a false one among the confirmed tracks; established tracks before any was seen. */
#define TRUE_PER_FALSE 10.0f
#define ESTABLISHED_PRIOR 2.0f

/* Standard deviations by which the count of tracks that ended early may exceed its mean. */
#define EXCESS_SIGMAS 0.5f

/* Time in which counts fade to 1/e. */
#define MEMORY_S 1600.0f

/* Prior hits and misses of the share of looks that see an established track. */
#define PRIOR_HITS 9.0f
#define PRIOR_MISSES 1.0f

static float evidence_of(const struct step *step, const struct rho_track *track)
{
    return (float)track->hits * HIT_NAT - (float)track->misses * step->miss_nat;
}

/* Evidence of a miss, by the share of looks that see established tracks now. */
static float miss_nat(const struct rho_tracker *tracker)
{
    float hits = PRIOR_HITS, misses = PRIOR_MISSES;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        const struct rho_track *track = &tracker->tracks[i];
        if (rho_tracker_is_established(track) && track->hits < UINT16_MAX) { /* counts end there */
            hits += (float)track->hits;
            misses += (float)track->misses;
        }
    }
    return rho_log(((1.0f - SELDOM) * hits + misses) / misses);
}

/* Tracks that soon will be established: seen so often that they are of targets. */
static float count_almost_established(const struct step *step)
{
    float count = 0.0f;
    for (unsigned i = 0; i < step->tracker->num_tracks; i++) {
        const struct rho_track *track = &step->tracker->tracks[i];
        count +=
            !rho_tracker_is_established(track) && evidence_of(step, track) >= ALMOST_ESTABLISHED_NAT
                ? 1.0f
                : 0.0f;
    }
    return count;
}

void rho_tracker_find_evidence_needed(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    if (!(tracker->ended_early + tracker->established > 0.0f)) {
        tracker->counted_us = step->time_us; /* nothing to forget yet */
    } else if (step->time_us > tracker->counted_us) {
        const float kept =
            rho_exp(-rho_seconds_between(tracker->counted_us, step->time_us) / MEMORY_S);
        tracker->ended_early *= kept;
        tracker->established *= kept;
        tracker->straight_s *= kept;
        tracker->turning_s *= kept;
        rho_tracker_learn_manoeuvre_interval(
            step, rho_seconds_between(tracker->counted_us, step->time_us));
        tracker->counted_us = step->time_us;
    }
    if (step->initiator) {
        tracker->wanted_per_hour = step->initiator->config.false_tracks_per_hour;
    }
    const float sensors = tracker->num_paces > 1 ? (float)tracker->num_paces : 1.0f;
    const float wanted = tracker->wanted_per_hour * sensors * (MEMORY_S / 3600.0f);
    const float excess =
        tracker->ended_early - wanted - EXCESS_SIGMAS * rho_sqrt(tracker->ended_early);
    step->miss_nat = miss_nat(tracker);
    const float odds = TRUE_PER_FALSE * excess /
                       (tracker->established + count_almost_established(step) + ESTABLISHED_PRIOR);
    /* where the threshold is set by hand, no rate of false tracks is wanted */
    step->needed_nat =
        odds > 1.0f && tracker->wanted_per_hour > 0.0f ? START_NAT + rho_log(odds) : 0.0f;
}

int rho_tracker_lacks_evidence(const struct step *step, const struct rho_track *track)
{
    return step->needed_nat > 0.0f && !rho_tracker_is_established(track) &&
           evidence_of(step, track) < step->needed_nat;
}

void rho_tracker_note_established(struct step *step, const struct rho_track *track)
{
    if (track->hits == RHO_ESTABLISHED_HITS && track->plot >= 0) {
        step->tracker->established += 1.0f;
    }
}

void rho_tracker_note_early_end(struct step *step, const struct rho_track *track)
{
    if (!rho_tracker_is_established(track) && evidence_of(step, track) < 0.0f &&
        track->score_max_mnat >= step->tracker->confirm_mnat) {
        step->tracker->ended_early += 1.0f;
    }
}
