/* SPDX-License-Identifier: MIT */
/*
 * early_deaths: where tracks die young, new ones need more evidence.
 *
 * The score compares a target with clutter that comes and goes. It knows nothing of objects that
 * move as targets do and are seldom seen: second-time-around echoes, sidelobes, the edge of a
 * weather front. Such an object is a track each time three of its plots follow each other by
 * chance, and is missed then. The tracks that end so are counted, and those that grow up. For each
 * track the evidence that it is seen as often as targets are, and not 0.3 times as often, is (h
 * hits, m misses)
 *
 *      e = h ln(1 / 0.3) - m ln((1 - 0.3 p) / (1 - p))
 *
 * with p the detection probability of grown tracks. Three hits are 3.6. Where D tracks died young
 * and G grew up in the last half an hour, or are about to (e is 7.2), a track is believed from
 *
 *      e = 3.6 + ln(10 (D - W - sqrt(D) / 2) / (G + 2))
 *
 * on, or from 16 hits on: one in ten of those that are believed will be false (Wald). W is the
 * number that false_tracks_per_hour allows, and half a standard deviation may have been chance;
 * where no more tracks die young, nothing is asked. Until then a track is tentative.
 *
 * A track has died young whose score was one that confirms, and that misses ended before 16 hits
 * with e below 0. Targets that came and left soon are counted, too: with one in twenty instead of
 * one in ten, all targets would be found later where aircraft come and go.
 */
#include "rhotrack/detail/approx.h"
#include "step.h"

/* Objects that are no targets are seen so many times as often as targets are. */
#define SELDOM 0.3f
#define HIT_NAT 1.2039728f /* ln(1 / SELDOM) */
#define START_NAT (3.0f * HIT_NAT)

#define GROWING_NAT (2.0f * START_NAT)

/* Of so many tracks that are believed one may be of no target. */
#define ODDS 10.0f
#define GROWN_PRIOR 2.0f

/* So many standard deviations of the count of deaths may be chance. */
#define CHANCE_SIGMAS 0.5f

/* Counts fade to 1/e in so long. */
#define MEMORY_S 1600.0f

/* How often grown tracks are seen: hits and misses that count beside theirs. */
#define PRIOR_HITS 9.0f
#define PRIOR_MISSES 1.0f

static float evidence(const struct step *step, const struct rho_track *track)
{
    return (float)track->hits * HIT_NAT - (float)track->misses * step->miss_nat;
}

/* Evidence of a miss, by how often grown tracks are seen now. */
static float miss_nat(const struct rho_tracker *tracker)
{
    float hits = PRIOR_HITS, misses = PRIOR_MISSES;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        const struct rho_track *track = &tracker->tracks[i];
        if (rho_tracker_is_grown(track) && track->hits < UINT16_MAX) { /* counts end there */
            hits += (float)track->hits;
            misses += (float)track->misses;
        }
    }
    return rho_log(((1.0f - SELDOM) * hits + misses) / misses);
}

/* Tracks that are almost grown: seen so often that they are of targets. */
static float growing(const struct step *step)
{
    float count = 0.0f;
    for (unsigned i = 0; i < step->tracker->num_tracks; i++) {
        const struct rho_track *track = &step->tracker->tracks[i];
        count += !rho_tracker_is_grown(track) && evidence(step, track) >= GROWING_NAT ? 1.0f : 0.0f;
    }
    return count;
}

void rho_tracker_find_asked_evidence(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    if (!(tracker->died_young + tracker->grown > 0.0f)) {
        tracker->youth_us = step->time_us; /* nothing to forget yet */
    } else if (step->time_us > tracker->youth_us) {
        const float kept =
            rho_exp(-rho_seconds_between(tracker->youth_us, step->time_us) / MEMORY_S);
        tracker->died_young *= kept;
        tracker->grown *= kept;
        tracker->straight_s *= kept;
        tracker->turning_s *= kept;
        rho_tracker_learn_manoeuvre_interval(step,
                                             rho_seconds_between(tracker->youth_us, step->time_us));
        tracker->youth_us = step->time_us;
    }
    if (step->initiator) {
        tracker->wanted_per_hour = step->initiator->config.false_tracks_per_hour;
    }
    const float sensors = tracker->num_paces > 1 ? (float)tracker->num_paces : 1.0f;
    const float wanted = tracker->wanted_per_hour * sensors * (MEMORY_S / 3600.0f);
    const float more_than_chance =
        tracker->died_young - wanted - CHANCE_SIGMAS * rho_sqrt(tracker->died_young);
    step->miss_nat = miss_nat(tracker);
    const float odds = ODDS * more_than_chance / (tracker->grown + growing(step) + GROWN_PRIOR);
    /* where the threshold is set by hand, no rate of false tracks is wanted */
    step->asked_nat =
        odds > 1.0f && tracker->wanted_per_hour > 0.0f ? START_NAT + rho_log(odds) : 0.0f;
}

int rho_tracker_is_too_young(const struct step *step, const struct rho_track *track)
{
    return step->asked_nat > 0.0f && !rho_tracker_is_grown(track) &&
           evidence(step, track) < step->asked_nat;
}

void rho_tracker_note_growth(struct step *step, const struct rho_track *track)
{
    if (track->hits == RHO_GROWN_HITS && track->plot >= 0) {
        step->tracker->grown += 1.0f;
    }
}

void rho_tracker_note_death(struct step *step, const struct rho_track *track)
{
    if (!rho_tracker_is_grown(track) && evidence(step, track) < 0.0f &&
        track->score_max_mnat >= step->tracker->confirm_mnat) {
        step->tracker->died_young += 1.0f;
    }
}
