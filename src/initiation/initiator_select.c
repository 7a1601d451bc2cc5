/* SPDX-License-Identifier: MIT */
/*
 * initiator_select: the bounded list of candidates, and the choice among those that claim the same plots.
 */
#include "initiator_search.h"

/* Plots that two tracks may share: where they cross, one plot is both's. */
#define SHARED_PLOTS_MAX 1u

/* From here on a candidate is likelier a target than chance. */
#define LIKELY_MNAT 0

/* Gate of the second association, when better tracks have taken their plots: wider than the fit's, for the fit may have
 * leant on a neighbour's plots. */
#define SECOND_GATE_FACTOR 2.5f

/* Candidates passed in a list, and compared by their plots, that make a unit of work. */
#define PASSED_IN_UNIT 8u
#define COMPARED_IN_UNIT 2u

/* What is still to come for an accepted candidate: a second score, and its place in two sorted lists. */
#define JUDGED_UNITS 100u
#define SORTED_IN_UNIT 2u

static int is_known(struct search *search, const struct rho_candidate *candidate)
{
    struct rho_initiator *initiator = search->initiator;
    rho_initiator_charge(search, initiator->num_candidates / COMPARED_IN_UNIT);
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

static int is_good_enough(const struct search *search, const struct set_score *score)
{
    return (float)score->mnat >= search->score_min_nat * 1000.0f &&
           (!search->keeps_rate || score->chi2 <= rho_initiator_chi2_max(score->dimensions));
}

/* Settles and scores a set of plots. 0 where it is no candidate, or one that is already listed. */
static int make_candidate(struct search *search, struct plot_set *set,
                          struct rho_candidate *candidate)
{
    struct line_fit fit;
    struct set_score score;
    if (!rho_initiator_settle(search, set, &fit) ||
        !rho_initiator_score(search, set, &fit, &score) || !is_good_enough(search, &score)) {
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
    return !is_known(search, candidate);
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
    rho_initiator_charge(search, initiator->num_candidates / PASSED_IN_UNIT);
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

/*
 * The candidate's plots and its track; searched and scored is from here on as it was: straight or
 * turning. 0 where its plots determine none.
 */
static int open_candidate(struct search *search, const struct rho_candidate *candidate,
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
    rho_initiator_let_turn(search, candidate->is_turning);
    return !candidate->is_turning || rho_initiator_fit(search, set, fit);
}

/* What is left for a candidate along its own track once better ones have their plots. 0: nothing that counts. */
static int associate_again(struct search *search, struct rho_candidate *candidate)
{
    struct line_fit fit;
    struct plot_set set;
    uint16_t skip = search->skip_flags;
    if (!open_candidate(search, candidate, &set, &fit)) {
        return 0;
    }
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

/* Best first; of equals the one that came first. */
static void sort_candidates(struct rho_initiator *initiator)
{
    struct rho_candidate *list = initiator->candidates;
    for (unsigned i = 1; i < initiator->num_candidates; i++) {
        struct rho_candidate candidate = list[i];
        unsigned place = i;
        while (place > 0 && list[place - 1u].score_mnat < candidate.score_mnat) {
            list[place] = list[place - 1u];
            place--;
        }
        list[place] = candidate;
    }
}

/* What the next choice and its consequences cost at least; 0 where the work ends before. */
static int may_choose(struct search *search, unsigned accepted)
{
    struct rho_initiator *initiator = search->initiator;
    if (rho_initiator_is_spent(search)) {
        initiator->work.candidates_dropped =
            rho_count(initiator->work.candidates_dropped, initiator->num_candidates - accepted);
        initiator->num_candidates = (uint16_t)accepted;
        search->is_partial = 1;
        return 0;
    }
    rho_initiator_charge(search, JUDGED_UNITS + accepted / SORTED_IN_UNIT +
                                     accepted / COMPARED_IN_UNIT +
                                     (initiator->num_candidates - accepted) / PASSED_IN_UNIT);
    return 1;
}

/*
 * Best first; accepted candidates gather at the head of the list, in the order of their scores when accepted. The worst are
 * dropped where the work ends.
 */
void rho_initiator_select(struct search *search)
{
    struct rho_initiator *initiator = search->initiator;
    unsigned accepted = 0;
    while (accepted < initiator->num_candidates && may_choose(search, accepted)) {
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
    sort_candidates(
        initiator); /* one that was associated again may have become better than those before */
}

/* ---- judgement -------------------------------------------------------------------------------- */

/* Plots of likely targets are no clutter: but for one of the targets, which may be chance as well, they are left out of
 * the density. Returns how many plots that one has, on average. */
static float mark_likely(struct search *search)
{
    struct rho_initiator *initiator = search->initiator;
    unsigned likely = 0, hits = 0;
    for (unsigned i = 0; i < initiator->num_candidates; i++) {
        if (initiator->candidates[i].score_mnat >= LIKELY_MNAT) {
            mark_taken(search, &initiator->candidates[i]);
            hits += initiator->candidates[i].hits;
            likely++;
        }
    }
    return likely ? (float)hits / (float)likely : 0.0f;
}

static int judge_one(struct search *search, struct rho_candidate *candidate)
{
    struct plot_set set;
    struct line_fit fit;
    struct set_score score;
    search->is_left_out = candidate->score_mnat >= LIKELY_MNAT;
    if (!open_candidate(search, candidate, &set, &fit) || set.hits < search->min_scans ||
        !rho_initiator_score(search, &set, &fit, &score)) {
        return 0;
    }
    candidate->score_mnat = score.mnat;
    return is_good_enough(search, &score);
}

/* Scores the accepted candidates again, against clutter without the likely targets. */
void rho_initiator_judge(struct search *search)
{
    struct rho_initiator *initiator = search->initiator;
    float more_plots = mark_likely(search);
    if (more_plots <= 0.0f) {
        return; /* nothing that would not count as clutter: the scores stand */
    }
    struct rate rate;
    rho_initiator_measure_density(search, RHO_WINDOW_INITIATED | RHO_WINDOW_TAKEN, more_plots);
    clear_taken(search);
    rho_initiator_find_rate(search, &rate);
    rho_initiator_use_rate(search, &rate);
    search->min_scans = rate.min_scans;
    unsigned kept = 0;
    for (unsigned i = 0; i < initiator->num_candidates; i++) {
        struct rho_candidate candidate = initiator->candidates[i];
        if (judge_one(search, &candidate)) {
            initiator->candidates[kept++] = candidate;
        }
    }
    initiator->num_candidates = (uint16_t)kept;
    sort_candidates(initiator);
}
