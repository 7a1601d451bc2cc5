/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "passive_search.h"
#include "rhotrack/types.h"

#define TWIN_SHARE 0.8f

/* ---- candidates ------------------------------------------------------------------------------- */

unsigned rho_passive_count_shared(const struct rho_passive_search *search,
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
    return (float)rho_passive_count_shared(search, of, other) >= TWIN_SHARE * (float)of->hits;
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
            search->candidates_taken++; /* less often than there are fits: 2 passes, 96 lines, 20 */
        }
    }
}

/* Where there is no room the lowest score gives way. */
static void add_candidate(struct rho_passive_search *search,
                          const struct rho_passive_candidate *candidate)
{
    struct rho_passive *passive = search->passive;
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
    search->candidates_taken++;
    if (candidate->score_nat > passive->candidates[lowest].score_nat) {
        passive->candidates[lowest] = *candidate;
    }
}

int rho_passive_offer(struct rho_passive_search *search, const float state_m[RHO_PASSIVE_STATES])
{
    struct rho_passive_candidate candidate;
    struct rho_passive_judgement judgement = rho_passive_judge(search, state_m, 1, candidate.claim);
    candidate.score_nat = judgement.score_nat;
    candidate.hits = judgement.hits;
    memcpy(candidate.state_m, state_m, sizeof candidate.state_m);
    if (judgement.is_track && !has_better_twin(search, &candidate)) {
        remove_worse_twins(search, &candidate);
        add_candidate(search, &candidate);
    }
    return judgement.is_track;
}

/* ---- tracks ----------------------------------------------------------------------------------- */

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

static int32_t mnat_of(float nat)
{
    return (int32_t)(1000.0f * nat);
}

static void add_track(struct rho_passive_search *search, unsigned number, float margin_nat)
{
    struct rho_passive *passive = search->passive;
    const struct rho_passive_candidate *from = &passive->best.tracks[number];
    struct rho_passive_track *track = &passive->tracks[passive->num_tracks];
    memcpy(track->claim, from->claim, sizeof track->claim);
    if (!rho_passive_report(search, from->state_m, track)) {
        return;
    }
    track->score_mnat = mnat_of(from->score_nat);
    track->margin_mnat = mnat_of(margin_nat);
    track->chi2 = passive->best.chi2[number];
    track->hits = (uint16_t)from->hits;
    set_scans(passive, track);
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
    float margins_nat[RHO_MAX_PASSIVE_TRACKS] = {0};
    struct rho_passive_choice choice;
    rho_passive_choose(search, &choice);
    rho_passive_gather(search, &choice, &passive->best);
    rho_passive_weigh(search, &choice, margins_nat);
    passive->num_tracks = 0;
    for (unsigned i = 0; i < passive->best.num; i++) {
        add_track(search, i, margins_nat[i]);
    }
    sort_tracks(passive);
}
