/* SPDX-License-Identifier: MIT */
/*
 * candidates: the initiator's bounded list of candidate tracks, each a set of plots with a fit and
 * a score.
 */
#include "search.h"

static int merge_into_listed_twin(struct search *search, const struct rho_candidate *candidate)
{
    struct rho_initiator *initiator = search->initiator;
    rho_initiator_charge_work(search, initiator->num_candidates / COMPARED_IN_UNIT);
    for (unsigned i = 0; i < initiator->num_candidates; i++) {
        struct rho_candidate *other = &initiator->candidates[i];
        unsigned m = 0;
        if (other->mask != candidate->mask) {
            continue;
        }
        while (m < RHO_MAX_SCANS && other->plot[m] == candidate->plot[m]) {
            m++;
        }
        if (m == RHO_MAX_SCANS) {
            if (candidate->is_turning && other->score_mnat < candidate->score_mnat) {
                *other = *candidate;
            }
            return 1;
        }
    }
    return 0;
}

int rho_initiator_passes_thresholds(const struct search *search, const struct set_score *score)
{
    return (float)score->mnat >= search->score_min_nat * 1000.0f &&
           (!search->keeps_rate ||
            score->chi2 <= rho_initiator_chi2_limit(score->dimensions, SIGMAS_99_9));
}

/*
 * Makes a candidate of a set of plots: fits, associates and scores it. Returns 0 where its score or
 * its fit is not good enough, or where a listed candidate has the same plots.
 */
int rho_initiator_make_candidate_not_yet_listed(struct search *search, struct plot_set *set,
                                                struct rho_candidate *candidate)
{
    struct line_fit fit;
    struct set_score score;
    if (!rho_initiator_refine_set(search, set, &fit) ||
        !rho_initiator_score_set_if_determined(search, set, &fit, &score) ||
        !rho_initiator_passes_thresholds(search, &score)) {
        return 0;
    }
    *candidate = (struct rho_candidate){
        .mask = (uint16_t)set->mask,
        .hits = (uint16_t)set->hits,
        .score_mnat = score.mnat,
        .x_m = fit.x_m,
        .y_m = fit.y_m,
        .vx_mps = fit.vx_mps,
        .vy_mps = fit.vy_mps,
        .z_m = fit.z_m,
        .vz_mps = fit.vz_mps,
        .has_z = fit.has_z != 0,
        .is_turning = search->turn_mps2 > 0.0f,
    };
    for (unsigned m = 0; m < search->num_scans; m++) {
        candidate->plot[m] = set->plot[m];
    }
    return !merge_into_listed_twin(search, candidate);
}

static unsigned lowest_score_candidate(const struct rho_initiator *initiator)
{
    unsigned low = 0;
    for (unsigned i = 1; i < initiator->num_candidates; i++) {
        if (initiator->candidates[i].score_mnat < initiator->candidates[low].score_mnat) {
            low = i;
        }
    }
    return low;
}

void rho_initiator_add_set_as_candidate(struct search *search, struct plot_set *set)
{
    struct rho_initiator *initiator = search->initiator;
    struct rho_candidate candidate;
    if (!rho_initiator_make_candidate_not_yet_listed(search, set, &candidate)) {
        return;
    }
    if (initiator->num_candidates < RHO_MAX_CANDIDATES) {
        initiator->candidates[initiator->num_candidates++] = candidate;
        return;
    }
    initiator->work.candidates_dropped = rho_count(initiator->work.candidates_dropped, 1);
    unsigned low = lowest_score_candidate(initiator);
    rho_initiator_charge_work(search, initiator->num_candidates / PASSED_IN_UNIT);
    if (initiator->candidates[low].score_mnat < candidate.score_mnat) {
        initiator->candidates[low] = candidate;
    }
}

/*
 * Unpacks the plots and the track of a candidate. The search then assumes turning targets where the
 * candidate turns, and straight ones where not. Returns 0 where the plots do not determine a track.
 */
int rho_initiator_unpack_and_assume_its_turning(struct search *search,
                                                const struct rho_candidate *candidate,
                                                struct plot_set *set, struct line_fit *fit)
{
    *set = (struct plot_set){.mask = candidate->mask, .hits = candidate->hits};
    for (unsigned m = 0; m < search->num_scans; m++) {
        set->plot[m] = candidate->plot[m];
    }
    *fit = (struct line_fit){.x_m = candidate->x_m,
                             .y_m = candidate->y_m,
                             .vx_mps = candidate->vx_mps,
                             .vy_mps = candidate->vy_mps,
                             .has_z = candidate->has_z,
                             .z_m = candidate->z_m,
                             .vz_mps = candidate->vz_mps};
    rho_initiator_assume_turning_targets(search, candidate->is_turning);
    return !candidate->is_turning || rho_initiator_fit_track_if_determined(search, set, fit);
}
