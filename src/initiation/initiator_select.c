/* SPDX-License-Identifier: MIT */
/*
 * initiator_select: the bounded list of candidates, and the choice among those that claim the same plots.
 */
#include "initiator_search.h"

/* Plots that two tracks may share: where they cross, one plot is both's. */
#define SHARED_PLOTS_MAX 1u

/* Gate of the second association, when better tracks have taken their plots: wider than the fit's, for the fit may have
 * leant on a neighbour's plots. */
#define SECOND_GATE_FACTOR 2.5f

static int is_known(const struct rho_initiator *initiator, const struct rho_candidate *candidate)
{
    for (unsigned i = 0; i < initiator->num_candidates; i++) {
        const struct rho_candidate *other = &initiator->candidates[i];
        unsigned m = 0;
        if (other->mask != candidate->mask) {
            continue;
        }
        while (m < RHO_MAX_SCANS && other->plot[m] == candidate->plot[m]) {
            m++;
        }
        if (m == RHO_MAX_SCANS) {
            return 1;
        }
    }
    return 0;
}

/* Settles and scores a set of plots. 0 where it is no candidate, or one that is already listed. */
static int make_candidate(struct search *search, struct plot_set *set,
                          struct rho_candidate *candidate)
{
    struct line_fit fit;
    struct set_score score;
    if (!rho_initiator_settle(search, set, &fit) ||
        !rho_initiator_score(search, set, &fit, &score) ||
        (float)score.mnat < search->initiator->config.score_min_nat * 1000.0f) {
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
        .has_z = (uint8_t)fit.has_z,
    };
    for (unsigned m = 0; m < search->num_scans; m++) {
        candidate->plot[m] = set->plot[m];
    }
    return !is_known(search->initiator, candidate);
}

static unsigned lowest(const struct rho_initiator *initiator)
{
    unsigned low = 0;
    for (unsigned i = 1; i < initiator->num_candidates; i++) {
        if (initiator->candidates[i].score_mnat < initiator->candidates[low].score_mnat) {
            low = i;
        }
    }
    return low;
}

void rho_initiator_offer(struct search *search, struct plot_set *set)
{
    struct rho_initiator *initiator = search->initiator;
    struct rho_candidate candidate;
    if (!make_candidate(search, set, &candidate)) {
        return;
    }
    if (initiator->num_candidates < RHO_MAX_CANDIDATES) {
        initiator->candidates[initiator->num_candidates++] = candidate;
        return;
    }
    initiator->work.candidates_dropped = rho_count(initiator->work.candidates_dropped, 1);
    unsigned low = lowest(initiator);
    if (initiator->candidates[low].score_mnat < candidate.score_mnat) {
        initiator->candidates[low] = candidate;
    }
}

/* ---- selection -------------------------------------------------------------------------------- */

static unsigned shared_plots(const struct rho_candidate *a, const struct rho_candidate *b)
{
    unsigned common = (unsigned)a->mask & b->mask, shared = 0;
    for (unsigned m = 0; m < RHO_MAX_SCANS; m++) {
        shared += (common >> m & 1u) && a->plot[m] == b->plot[m];
    }
    return shared;
}

static int conflicts(const struct rho_initiator *initiator, unsigned accepted,
                     const struct rho_candidate *candidate)
{
    for (unsigned i = 0; i < accepted; i++) {
        if (shared_plots(&initiator->candidates[i], candidate) > SHARED_PLOTS_MAX) {
            return 1;
        }
    }
    return 0;
}

static void mark_taken(struct search *search, const struct rho_candidate *candidate)
{
    for (unsigned m = 0; m < search->num_scans; m++) {
        if ((unsigned)candidate->mask >> m & 1u) {
            rho_window_scan_at(&search->initiator->window, m)->marks[candidate->plot[m]] |=
                RHO_WINDOW_TAKEN;
        }
    }
}

static void clear_taken(struct search *search)
{
    for (unsigned i = 0; i < search->initiator->num_candidates; i++) {
        const struct rho_candidate *candidate = &search->initiator->candidates[i];
        for (unsigned m = 0; m < search->num_scans; m++) {
            if ((unsigned)candidate->mask >> m & 1u) {
                struct rho_window_scan *scan = rho_window_scan_at(&search->initiator->window, m);
                scan->marks[candidate->plot[m]] &= (uint16_t)~RHO_WINDOW_TAKEN;
            }
        }
    }
}

/* What is left for a candidate along its own track once better ones have their plots. 0: nothing that counts. */
static int associate_again(struct search *search, struct rho_candidate *candidate)
{
    struct line_fit fit = {.x_m = candidate->x_m,
                           .y_m = candidate->y_m,
                           .vx_mps = candidate->vx_mps,
                           .vy_mps = candidate->vy_mps,
                           .has_z = candidate->has_z,
                           .z_m = candidate->z_m,
                           .vz_mps = candidate->vz_mps};
    struct plot_set set;
    uint16_t skip = search->skip_flags;
    search->skip_flags = (uint16_t)(skip | RHO_WINDOW_TAKEN);
    rho_initiator_collect(search, &fit, SECOND_GATE_FACTOR, &set);
    int found = set.hits >= search->min_scans && make_candidate(search, &set, candidate);
    search->skip_flags = skip;
    return found;
}

static void bring_best_forward(struct rho_initiator *initiator, unsigned accepted)
{
    struct rho_candidate *list = initiator->candidates;
    unsigned best = accepted;
    for (unsigned i = accepted + 1; i < initiator->num_candidates; i++) {
        if (list[i].score_mnat > list[best].score_mnat) {
            best = i;
        }
    }
    struct rho_candidate first = list[accepted];
    list[accepted] = list[best];
    list[best] = first;
}

/* Best first; accepted candidates gather at the head of the list, in the order of their scores when accepted. */
void rho_initiator_select(struct search *search)
{
    struct rho_initiator *initiator = search->initiator;
    unsigned accepted = 0;
    while (accepted < initiator->num_candidates) {
        bring_best_forward(initiator, accepted);
        struct rho_candidate candidate = initiator->candidates[accepted];
        if (!conflicts(initiator, accepted, &candidate)) {
            mark_taken(search, &candidate);
            accepted++;
        } else if (associate_again(search, &candidate)) {
            initiator->candidates[accepted] = candidate;
        } else {
            initiator->num_candidates--;
            initiator->candidates[accepted] = initiator->candidates[initiator->num_candidates];
        }
    }
    clear_taken(search);
}
