/* SPDX-License-Identifier: MIT */
/*
 * early_ends: where many tracks end soon after they were confirmed, new ones need more evidence.
 *
 * The track score compares a target with clutter that is independent from scan to scan. It does not
 * model objects that move as targets do and are seldom seen: second-time-around echoes, sidelobes,
 * the edge of a weather front. Such an object becomes a track whenever three of its plots follow
 * each other by chance, and is missed then. Tracks that end so early are counted, and so are
 * established ones, which have 16 hits. The evidence that a track with h hits and m misses is seen
 * as often as targets are, and not 0.3 times as often, is
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
 * A track has ended early if its score had reached the confirm threshold, and misses ended it
 * before 16 hits with e below 0. Targets that stay only for a short time are counted, too: with one
 * false track in twenty instead of ten, all targets would be confirmed later where aircraft come
 * and go.
 */
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "step.h"

/* Evidence of the three hits that start a track, and of a track that is almost established. */
#define START_NAT (HIT_NAT * 3.0f)
#define ALMOST_ESTABLISHED_NAT (START_NAT * 2.0f)

static float evidence_of_target(const struct step *step, const struct rho_track *track)
{
    return (float)track->hits * HIT_NAT - (float)track->misses * step->miss_nat;
}

void rho_evidence_update(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    const struct rho_look *look = &step->look;
    if (!(tracker->ended_early + tracker->established > 0.0f)) {
        tracker->counted_us = look->time_us; /* no track was counted yet: nothing to fade */
    } else if (look->time_us > tracker->counted_us) {
        const float dt_s = rho_seconds_between(tracker->counted_us, look->time_us);
        const float kept = rho_exp(-dt_s / MEMORY_S);
        tracker->ended_early *= kept;
        tracker->established *= kept;
        tracker->straight_s *= kept;
        tracker->turning_s *= kept;
        rho_manoeuvres_learn(tracker, look, dt_s);
        tracker->counted_us = look->time_us;
    }
    if (look->initiator) {
        tracker->wanted_per_hour = look->initiator->config.false_tracks_per_hour;
    }
    float sensors = 0.0f;
    for (unsigned i = 0; i < tracker->num_rows; i++) {
        sensors += tracker->sensors[i].pace.is_heard ? 1.0f : 0.0f;
    }
    /* evidence that a miss takes from a track, by the hits and misses of established tracks */
    float hits = PRIOR_HITS, misses = 1.0f;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        const struct rho_track *track = &tracker->tracks[i];
        if (rho_life_is_established(track) && track->hits < UINT16_MAX) { /* no saturated counts */
            hits += (float)track->hits;
            misses += (float)track->misses;
        }
    }
    step->miss_nat = rho_log(((1.0f - SELDOM) * hits + misses) / misses);
    float almost = 0.0f; /* tracks not yet established, but nearly */
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        const struct rho_track *track = &tracker->tracks[i];
        almost += !rho_life_is_established(track) &&
                          evidence_of_target(step, track) >= ALMOST_ESTABLISHED_NAT
                      ? 1.0f
                      : 0.0f;
    }
    const float wanted =
        tracker->wanted_per_hour * rho_larger(sensors, 1.0f) * (MEMORY_S / 3600.0f);
    const float excess =
        tracker->ended_early - wanted - EXCESS_SIGMAS * rho_sqrt(tracker->ended_early);
    const float odds =
        TRUE_PER_FALSE * excess / (tracker->established + almost + ESTABLISHED_PRIOR);
    /* wanted_per_hour is 0 where score_min_nat sets the threshold: no evidence is needed then */
    step->needed_nat =
        odds > 1.0f && tracker->wanted_per_hour > 0.0f ? START_NAT + rho_log(odds) : 0.0f;
}

int rho_evidence_is_lacking(const struct step *step, const struct rho_track *track)
{
    return step->needed_nat > 0.0f && !rho_life_is_established(track) &&
           evidence_of_target(step, track) < step->needed_nat;
}

void rho_evidence_count_established(struct rho_tracker *tracker, const struct rho_track *track)
{
    if (track->hits == RHO_ESTABLISHED_HITS && track->plot >= 0) {
        tracker->established += 1.0f;
    }
}

void rho_evidence_count_ended(const struct step *step, const struct rho_track *track)
{
    if (!rho_life_is_established(track) && evidence_of_target(step, track) < 0.0f &&
        track->score_max_mnat >= step->tracker->confirm_mnat) {
        step->tracker->ended_early += 1.0f;
    }
}
