/* SPDX-License-Identifier: MIT */
/*
 * seldom_seen: where many tracks are of objects that are seldom seen, tracks need more evidence.
 *
 * The track score compares a target with clutter that is independent from scan to scan. It does not
 * model objects that move as targets do and are seldom seen, as second-time-around echoes; they
 * become tracks whenever three of their plots follow each other. The evidence that a track is seen
 * as often as targets are, and not 0.3 times as often, is
 *
 *      e = sum of ln(G / (1 + 0.3 (G - 1))) over its hits  -  m ln((1 - 0.3 p) / (1 - p))
 *
 * with G of track_life.c, p the detection probability of tracks with eight hits, and m its misses;
 * that of a probably hidden target or blind look counts less. Three sure hits are 3.6. Tracks whose
 * score reached the confirm threshold and whose e fell by a hit below 0 are counted as seldom seen,
 * tracks with 16 hits as established. Where D of the former and G of the latter came in the last
 * half an hour, or soon will (e is 7.2), a track is shown from
 *
 *      e = 3.6 + ln(10 (D - W - sqrt(D) / 2) / (G + 2))
 *
 * on: one in ten of them will be false (Wald). W is what false_tracks_per_hour allows.
 */
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "step.h"

/* Evidence of the three hits that start a track, and of a track that is almost established. */
#define START_NAT (HIT_NAT * 3.0f)
#define ALMOST_ESTABLISHED_NAT (START_NAT * 2.0f)

static float evidence_of_target(const struct step *step, const struct rho_track *track)
{
    return track->seen_nat - track->missed * step->miss_nat;
}

void rho_evidence_update(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    const struct rho_look *look = &step->look;
    if (!(tracker->seldom + tracker->established + tracker->lived > 0.0f)) {
        tracker->counted_us = look->time_us; /* no track was counted yet: nothing to fade */
    } else if (look->time_us > tracker->counted_us) {
        const float dt_s = rho_seconds_between(tracker->counted_us, look->time_us);
        const float kept = rho_exp(-dt_s / MEMORY_S);
        tracker->seldom *= kept;
        tracker->established *= kept;
        tracker->lived *= kept;
        tracker->gone *= kept;
        tracker->returned *= kept;
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
    /* evidence that a miss takes from a track, by those of tracks with TEACHER_HITS */
    const float pd = look->pd;
    float hits = PRIOR_LOOKS * pd, misses = PRIOR_LOOKS * (1.0f - pd);
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        const struct rho_track *track = &tracker->tracks[i];
        if (track->hits >= TEACHER_HITS && track->hits < UINT16_MAX) { /* no saturated counts */
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
    const float excess = tracker->seldom - wanted - EXCESS_SIGMAS * rho_sqrt(tracker->seldom);
    const float odds =
        TRUE_PER_FALSE * excess / (tracker->established + almost + ESTABLISHED_PRIOR);
    /* wanted_per_hour is 0 where score_min_nat sets the threshold: no evidence is needed then */
    step->needed_nat =
        odds > 1.0f && tracker->wanted_per_hour > 0.0f ? START_NAT + rho_log(odds) : 0.0f;
}

int rho_evidence_is_lacking(const struct step *step, const struct rho_track *track)
{
    return step->needed_nat > 0.0f && evidence_of_target(step, track) < step->needed_nat;
}

void rho_evidence_count(const struct step *step, struct rho_track *track)
{
    struct rho_tracker *tracker = step->tracker;
    if (track->hits == RHO_ESTABLISHED_HITS && track->plot >= 0) {
        tracker->established += 1.0f;
    }
    if (!track->is_seldom && track->score_max_mnat >= tracker->confirm_mnat &&
        evidence_of_target(step, track) < SELDOM_NAT) {
        track->is_seldom = 1;
        tracker->seldom += 1.0f;
    }
}
