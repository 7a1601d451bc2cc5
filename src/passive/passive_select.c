/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "passive_search.h"
#include "rhotrack/types.h"

#define TWIN_SHARE 0.8f
#define STARTS 12u
#define GAIN_MIN_NAT 1.0e-3f /* what rounding cannot make */

/* ---- candidates ------------------------------------------------------------------------------- */

static unsigned count_shared(const struct rho_passive_search *search,
                             const struct rho_passive_candidate *a,
                             const struct rho_passive_candidate *b)
{
    unsigned shared = 0;
    for (unsigned k = 0; k < search->passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < search->passive->batch.num_sensors; s++) {
            shared += a->claim[k][s] != 0 && a->claim[k][s] == b->claim[k][s];
        }
    }
    return shared;
}

/* Most of its bearings are the other's. */
static int is_twin(const struct rho_passive_search *search, const struct rho_passive_candidate *of,
                   const struct rho_passive_candidate *other)
{
    return (float)count_shared(search, of, other) >= TWIN_SHARE * (float)of->hits;
}

static int has_better_twin(const struct rho_passive_search *search,
                           const struct rho_passive_candidate *candidate)
{
    const struct rho_passive *passive = search->passive;
    for (unsigned i = 0; i < passive->num_candidates; i++) {
        if (passive->candidates[i].score_nat >= candidate->score_nat &&
            is_twin(search, candidate, &passive->candidates[i])) {
            return 1;
        }
    }
    return 0;
}

static void remove_worse_twins(struct rho_passive_search *search,
                               const struct rho_passive_candidate *candidate)
{
    struct rho_passive *passive = search->passive;
    for (unsigned i = passive->num_candidates; i > 0; i--) {
        if (is_twin(search, &passive->candidates[i - 1u], candidate)) {
            passive->candidates[i - 1u] = passive->candidates[--passive->num_candidates];
        }
    }
}

/* Where there is no room the lowest score gives way. */
static void add_candidate(struct rho_passive *passive,
                          const struct rho_passive_candidate *candidate)
{
    if (passive->num_candidates < RHO_MAX_PASSIVE_CANDIDATES) {
        passive->candidates[passive->num_candidates++] = *candidate;
        return;
    }
    unsigned lowest = 0;
    for (unsigned i = 1; i < passive->num_candidates; i++) {
        if (passive->candidates[i].score_nat < passive->candidates[lowest].score_nat) {
            lowest = i;
        }
    }
    passive->work.candidates_dropped = rho_count(passive->work.candidates_dropped, 1);
    if (candidate->score_nat > passive->candidates[lowest].score_nat) {
        passive->candidates[lowest] = *candidate;
    }
}

void rho_passive_offer(struct rho_passive_search *search, const float state_m[RHO_PASSIVE_STATES])
{
    struct rho_passive_candidate candidate;
    struct rho_passive_judgement judgement = rho_passive_judge(search, state_m, 1, candidate.claim);
    candidate.score_nat = judgement.score_nat;
    candidate.hits = judgement.hits;
    memcpy(candidate.state_m, state_m, sizeof candidate.state_m);
    if (judgement.is_track && !has_better_twin(search, &candidate)) {
        remove_worse_twins(search, &candidate);
        add_candidate(search->passive, &candidate);
    }
}

/* ---- joint selection -------------------------------------------------------------------------- */

/*
 * Maximises the sum of the chosen ones' scores, less share_nat for every bearing that two of them claim. The best subset is
 * sought by adding the candidate that gains most, from several starts, and by leaving one out and filling up again.
 */
struct choice {
    const struct rho_passive_search *search;
    unsigned count;
    uint8_t is_in[RHO_MAX_PASSIVE_CANDIDATES];
    float gain_nat
        [RHO_MAX_PASSIVE_CANDIDATES]; /* of each, with those chosen: its score less what it shares */
    float total_nat;
};

static void start_choice(struct choice *choice, const struct rho_passive_search *search)
{
    *choice = (struct choice){.search = search, .count = search->passive->num_candidates};
    for (unsigned i = 0; i < choice->count; i++) {
        choice->gain_nat[i] = search->passive->candidates[i].score_nat;
    }
}

/* Puts one in or takes it out. */
static void flip(struct choice *choice, unsigned which)
{
    const struct rho_passive *passive = choice->search->passive;
    float sign = choice->is_in[which] ? -1.0f : 1.0f;
    choice->total_nat += sign * choice->gain_nat[which];
    choice->is_in[which] = !choice->is_in[which];
    for (unsigned i = 0; i < choice->count; i++) {
        if (i != which) {
            unsigned shared = passive->shared[which][i];
            choice->gain_nat[i] -= sign * choice->search->share_nat * (float)shared;
        }
    }
}

/* The one that gains most, or count where none gains. */
static unsigned find_gain(const struct choice *choice, unsigned but)
{
    unsigned best = choice->count;
    float most = GAIN_MIN_NAT;
    for (unsigned i = 0; i < choice->count; i++) {
        if (!choice->is_in[i] && i != but && choice->gain_nat[i] > most) {
            most = choice->gain_nat[i];
            best = i;
        }
    }
    return best;
}

/* Adds while that gains; those that lose by it leave. */
static void fill_up(struct choice *choice, unsigned but)
{
    for (unsigned added; (added = find_gain(choice, but)) < choice->count;) {
        flip(choice, added);
        for (unsigned i = 0; i < choice->count; i++) {
            if (choice->is_in[i] && i != added && choice->gain_nat[i] < -GAIN_MIN_NAT) {
                flip(choice, i);
            }
        }
    }
}

/* Leaves one out and fills up again. Returns whether that is more. */
static int leave_out(struct choice *choice, unsigned which)
{
    struct choice tried = *choice;
    flip(&tried, which);
    fill_up(&tried, which);
    if (!(tried.total_nat > choice->total_nat + GAIN_MIN_NAT)) {
        return 0;
    }
    *choice = tried;
    return 1;
}

static void improve(struct choice *choice)
{
    int is_better;
    do {
        is_better = 0;
        for (unsigned i = 0; i < choice->count; i++) {
            is_better |= choice->is_in[i] && leave_out(choice, i);
        }
    } while (is_better);
}

/* Candidates by score, best first. */
static void rank(const struct rho_passive *passive, uint8_t order[RHO_MAX_PASSIVE_CANDIDATES])
{
    for (unsigned i = 0; i < passive->num_candidates; i++) {
        unsigned place = i;
        for (; place > 0 &&
               passive->candidates[i].score_nat > passive->candidates[order[place - 1u]].score_nat;
             place--) {
            order[place] = order[place - 1u];
        }
        order[place] = (uint8_t)i;
    }
}

static void set_shared(const struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    for (unsigned i = 0; i < passive->num_candidates; i++) {
        for (unsigned j = 0; j < passive->num_candidates; j++) {
            passive->shared[i][j] =
                (uint8_t)count_shared(search, &passive->candidates[i], &passive->candidates[j]);
        }
    }
}

static void choose(const struct rho_passive_search *search, const uint8_t *order,
                   struct choice *best)
{
    set_shared(search);
    start_choice(best, search);
    for (unsigned i = 0; i < STARTS && i < best->count; i++) {
        struct choice choice;
        start_choice(&choice, search);
        flip(&choice, order[i]);
        fill_up(&choice, choice.count);
        improve(&choice);
        if (choice.total_nat > best->total_nat) {
            *best = choice;
        }
    }
}

/* ---- tracks ----------------------------------------------------------------------------------- */

static void claim(struct rho_passive *passive, const struct rho_passive_track *track)
{
    for (unsigned k = 0; k < passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
            if (track->claim[k][s] > 0) {
                passive->is_claimed[k][s][track->claim[k][s] - 1u] = 1;
            }
        }
    }
}

static void set_scans(const struct rho_passive *passive, struct rho_passive_track *track)
{
    track->scans = 0;
    for (unsigned k = 0; k < passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
            if (track->claim[k][s] > 0) {
                track->scans = (uint16_t)(track->scans | 1u << k);
            }
        }
    }
}

/* Fitted and judged again on the bearings that better tracks have left. */
static void add_track(struct rho_passive_search *search, const float from_m[RHO_PASSIVE_STATES])
{
    static const float gates[2] = {3.5f, 3.5f};
    struct rho_passive *passive = search->passive;
    if (passive->num_tracks == RHO_MAX_PASSIVE_TRACKS) {
        passive->work.candidates_dropped = rho_count(passive->work.candidates_dropped, 1);
        return;
    }
    struct rho_passive_track *track = &passive->tracks[passive->num_tracks];
    float state_m[RHO_PASSIVE_STATES];
    memcpy(state_m, from_m, sizeof state_m);
    rho_passive_fit(search, state_m, gates, 2, 0);
    struct rho_passive_judgement judgement = rho_passive_judge(search, state_m, 0, track->claim);
    if (!judgement.is_track || !rho_passive_report(search, state_m, track)) {
        return;
    }
    track->score_mnat = (int32_t)(1000.0f * judgement.score_nat);
    track->chi2 = judgement.chi2;
    track->hits = judgement.hits;
    set_scans(passive, track);
    claim(passive, track);
    passive->num_tracks++;
}

/* A track's score is that of the bearings that were left to it: the order may have changed. */
static void sort_tracks(struct rho_passive *passive)
{
    for (unsigned i = 1; i < passive->num_tracks; i++) {
        struct rho_passive_track track = passive->tracks[i];
        unsigned place = i;
        for (; place > 0 && track.score_mnat > passive->tracks[place - 1u].score_mnat; place--) {
            passive->tracks[place] = passive->tracks[place - 1u];
        }
        passive->tracks[place] = track;
    }
}

void rho_passive_select(struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    uint8_t order[RHO_MAX_PASSIVE_CANDIDATES] = {0};
    struct choice choice;
    rank(passive, order);
    choose(search, order, &choice);
    passive->num_tracks = 0;
    for (unsigned i = 0; i < passive->num_candidates; i++) {
        if (choice.is_in[order[i]]) {
            add_track(search, passive->candidates[order[i]].state_m);
        }
    }
    sort_tracks(passive);
}
