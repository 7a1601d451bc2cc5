/* SPDX-License-Identifier: MIT */
/*
 * candidate_selection: chooses among candidate tracks that share plots, and scores the chosen
 * candidates against clutter that is measured without the plots of likely targets.
 */
#include "search.h"

/* Most plots that two accepted candidates may share: one where their tracks cross. */
#define SHARED_PLOTS_MAX 1u

/* Score from which a candidate is more likely a target than clutter. */
#define LIKELY_MNAT 0

/*
 * Factor of the gate's variance when a candidate is associated with the plots that better
 * candidates have left. It is wider than the gate of the fit, as a neighbour's plots may have
 * biased the fit.
 */
#define SECOND_GATE_FACTOR 2.5f

/*
 * Units of work charged for each accepted candidate: its second score, and its moves in two sorts.
 */
#define RESCORED_UNITS 100u
#define SORTED_IN_UNIT 2u

/* ---- exclusive selection --------------------------------------------------------------------- */

static unsigned count_shared_plots(const struct rho_candidate *a, const struct rho_candidate *b)
{
    unsigned common = (unsigned)a->mask & b->mask, shared = 0;
    for (unsigned m = 0; m < RHO_MAX_SCANS; m++) {
        shared += (common >> m & 1u) && a->plot[m] == b->plot[m];
    }
    return shared;
}

static int conflicts_with_accepted(const struct rho_initiator *initiator, unsigned num_accepted,
                                   const struct rho_candidate *candidate)
{
    for (unsigned i = 0; i < num_accepted; i++) {
        if (count_shared_plots(&initiator->candidates[i], candidate) > SHARED_PLOTS_MAX) {
            return 1;
        }
    }
    return 0;
}

static void mark_plots_as_taken(struct search *search, const struct rho_candidate *candidate)
{
    for (unsigned m = 0; m < search->num_scans; m++) {
        if ((unsigned)candidate->mask >> m & 1u) {
            rho_window_scan_at(&search->initiator->window, m)->marks[candidate->plot[m]] |=
                RHO_WINDOW_TAKEN;
        }
    }
}

static void clear_taken_marks(struct search *search)
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
 * Associates a candidate with the plots that better candidates have left, and scores it again.
 * Returns 0 where too few plots are left.
 */
static int remake_candidate_from_untaken_plots(struct search *search,
                                               struct rho_candidate *candidate)
{
    struct line_fit fit;
    struct plot_set set;
    uint16_t skip = search->skip_flags;
    if (!rho_initiator_unpack_and_assume_its_turning(search, candidate, &set, &fit)) {
        return 0;
    }
    search->skip_flags = (uint16_t)(skip | RHO_WINDOW_TAKEN);
    rho_initiator_associate_plots(search, &fit, SECOND_GATE_FACTOR, &set);
    int found = set.hits >= search->min_scans &&
                rho_initiator_make_candidate_not_yet_listed(search, &set, candidate);
    search->skip_flags = skip;
    return found;
}

static void move_best_remaining_first(struct rho_initiator *initiator, unsigned num_accepted)
{
    struct rho_candidate *list = initiator->candidates;
    unsigned best = num_accepted;
    for (unsigned i = num_accepted + 1; i < initiator->num_candidates; i++) {
        if (list[i].score_mnat > list[best].score_mnat) {
            best = i;
        }
    }
    struct rho_candidate first = list[num_accepted];
    list[num_accepted] = list[best];
    list[best] = first;
}

/* Sorts the candidates by descending score; equal scores keep their order. */
static void sort_candidates_by_score(struct rho_initiator *initiator)
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

/*
 * Charges the least work of the next choice. Where the work is spent, drops all candidates that are
 * not accepted yet and returns 0.
 */
static int charge_work_or_drop_unaccepted(struct search *search, unsigned num_accepted)
{
    struct rho_initiator *initiator = search->initiator;
    if (rho_initiator_is_work_limit_exceeded(search)) {
        initiator->work.candidates_dropped =
            rho_count(initiator->work.candidates_dropped, initiator->num_candidates - num_accepted);
        initiator->num_candidates = (uint16_t)num_accepted;
        search->is_partial = 1;
        return 0;
    }
    rho_initiator_charge_work(
        search, RESCORED_UNITS + num_accepted / SORTED_IN_UNIT + num_accepted / COMPARED_IN_UNIT +
                    (initiator->num_candidates - num_accepted) / PASSED_IN_UNIT);
    return 1;
}

/*
 * Accepts candidates in the order of their scores, so that no two share more than one plot. Where
 * the work ends, the candidates with the lowest scores are dropped.
 */
void rho_initiator_select_candidates(struct search *search)
{
    struct rho_initiator *initiator = search->initiator;
    unsigned accepted = 0;
    while (accepted < initiator->num_candidates &&
           charge_work_or_drop_unaccepted(search, accepted)) {
        move_best_remaining_first(initiator, accepted);
        struct rho_candidate candidate = initiator->candidates[accepted];
        if (!conflicts_with_accepted(initiator, accepted, &candidate)) {
            mark_plots_as_taken(search, &candidate);
            accepted++;
        } else if (remake_candidate_from_untaken_plots(search, &candidate)) {
            initiator->candidates[accepted] = candidate;
        } else {
            initiator->num_candidates--;
            initiator->candidates[accepted] = initiator->candidates[initiator->num_candidates];
        }
    }
    clear_taken_marks(search);
    /* association with the plots left may have raised a score */
    sort_candidates_by_score(initiator);
    rho_initiator_assume_turning_targets(search, 0);
}

/* ---- judgement ------------------------------------------------------------------------------- */

/*
 * Marks the plots of likely targets as taken, as they are not clutter. Returns the mean number of
 * plots of a likely target: one of these targets may be clutter nevertheless, and its plots count.
 */
static float mark_likely_target_plots_mean_hits(struct search *search)
{
    struct rho_initiator *initiator = search->initiator;
    unsigned likely = 0, hits = 0;
    for (unsigned i = 0; i < initiator->num_candidates; i++) {
        if (initiator->candidates[i].score_mnat >= LIKELY_MNAT) {
            mark_plots_as_taken(search, &initiator->candidates[i]);
            hits += initiator->candidates[i].hits;
            likely++;
        }
    }
    return likely ? (float)hits / (float)likely : 0.0f;
}

static int rescore_candidate(struct search *search, struct rho_candidate *candidate)
{
    struct plot_set set;
    struct line_fit fit;
    struct set_score score;
    search->is_left_out = candidate->score_mnat >= LIKELY_MNAT;
    if (!rho_initiator_unpack_and_assume_its_turning(search, candidate, &set, &fit) ||
        set.hits < search->min_scans ||
        !rho_initiator_score_set_if_determined(search, &set, &fit, &score)) {
        return 0;
    }
    candidate->score_mnat = score.mnat;
    return rho_initiator_passes_thresholds(search, &score);
}

/*
 * Scores the accepted candidates again, with thresholds and clutter density measured without the
 * plots of likely targets, and drops those below the threshold.
 */
void rho_initiator_rescore_and_drop_weak(struct search *search)
{
    struct rho_initiator *initiator = search->initiator;
    float more_plots = mark_likely_target_plots_mean_hits(search);
    if (more_plots <= 0.0f) {
        return; /* without likely targets every plot counts as clutter already: the scores stand */
    }
    rho_initiator_measure_density(search, RHO_WINDOW_INITIATED | RHO_WINDOW_TAKEN, more_plots);
    clear_taken_marks(search);
    rho_initiator_update_thresholds(search);
    unsigned kept = 0;
    for (unsigned i = 0; i < initiator->num_candidates; i++) {
        struct rho_candidate candidate = initiator->candidates[i];
        if (rescore_candidate(search, &candidate)) {
            initiator->candidates[kept++] = candidate;
        }
    }
    initiator->num_candidates = (uint16_t)kept;
    sort_candidates_by_score(initiator);
}
