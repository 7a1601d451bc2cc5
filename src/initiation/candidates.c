/* SPDX-License-Identifier: MIT */
/*
 * candidates: the initiator's bounded list of candidate tracks, each a set of plots with a fit and
 * a score; the choice among candidates that share plots; and their scores against clutter that is
 * measured without the plots of likely targets.
 */
#include "candidates.h"

#include <string.h>

#include "clutter_density.h"
#include "policy.h"
#include "target_model.h"

/* True where a score reaches the start threshold and, if a rate is kept, chi-square is small. */
static int passes_thresholds(const struct search *search, const struct set_score *score)
{
    return (float)score->mnat >= search->score_min_nat * 1000.0f &&
           (!search->keeps_rate ||
            score->chi2 <= rho_chi2_quantile(score->dimensions, SIGMAS_99_9));
}

/*
 * Makes a candidate of a set of plots: fits, associates and scores it. Returns 0 where its score or
 * its fit is not good enough, or where a listed candidate has the same plots: where this one turns
 * and scores higher, it replaces that.
 */
static int make_unlisted_candidate(struct search *search, struct plot_set *set,
                                   struct rho_candidate *candidate)
{
    struct rho_initiator *initiator = search->initiator;
    struct line_fit fit;
    struct set_score score;
    if (!rho_plot_set_refine(search, set, &fit) || !rho_plot_set_score(search, set, &fit, &score) ||
        !passes_thresholds(search, &score)) {
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
    rho_search_charge(search, initiator->num_candidates / COMPARED_IN_UNIT);
    for (unsigned i = 0; i < initiator->num_candidates; i++) {
        struct rho_candidate *other = &initiator->candidates[i];
        if (other->mask == candidate->mask &&
            memcmp(other->plot, candidate->plot, sizeof other->plot) == 0) {
            if (candidate->is_turning && other->score_mnat < candidate->score_mnat) {
                *other = *candidate;
            }
            return 0;
        }
    }
    return 1;
}

void rho_candidates_add(struct search *search, struct plot_set *set)
{
    struct rho_initiator *initiator = search->initiator;
    struct rho_candidate candidate, *lowest = initiator->candidates;
    if (!make_unlisted_candidate(search, set, &candidate)) {
        return;
    }
    if (initiator->num_candidates < RHO_MAX_CANDIDATES) {
        initiator->candidates[initiator->num_candidates++] = candidate;
        return;
    }
    initiator->work.candidates_dropped = rho_count(initiator->work.candidates_dropped, 1);
    for (unsigned i = 1; i < initiator->num_candidates; i++) {
        if (initiator->candidates[i].score_mnat < lowest->score_mnat) {
            lowest = &initiator->candidates[i];
        }
    }
    rho_search_charge(search, initiator->num_candidates / PASSED_IN_UNIT);
    if (lowest->score_mnat < candidate.score_mnat) {
        *lowest = candidate;
    }
}

/*
 * Unpacks the plots and the track of a candidate. The search then assumes turning targets where the
 * candidate turns, and straight ones where not. Returns 0 where the plots do not determine a track.
 */
static int unpack_candidate(struct search *search, const struct rho_candidate *candidate,
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
    rho_target_assume_turns(search, candidate->is_turning);
    return !candidate->is_turning || rho_plot_set_fit(search, set, fit);
}

/* Sets or clears the mark of a candidate's plots as taken. */
static void mark_plots(struct search *search, const struct rho_candidate *candidate, int is_taken)
{
    for (unsigned m = 0; m < search->num_scans; m++) {
        if ((unsigned)candidate->mask >> m & 1u) {
            uint16_t *marks = &rho_search_scan(search, m)->marks[candidate->plot[m]];
            *marks = (uint16_t)((*marks & ~RHO_WINDOW_TAKEN) | (is_taken ? RHO_WINDOW_TAKEN : 0u));
        }
    }
}

static void clear_taken_marks(struct search *search)
{
    for (unsigned i = 0; i < search->initiator->num_candidates; i++) {
        mark_plots(search, &search->initiator->candidates[i], 0);
    }
}

/* True where a candidate shares too many plots with one of those accepted so far. */
static int has_conflict(const struct rho_initiator *initiator, unsigned num_accepted,
                        const struct rho_candidate *candidate)
{
    for (unsigned i = 0; i < num_accepted; i++) {
        const struct rho_candidate *other = &initiator->candidates[i];
        const unsigned common = (unsigned)other->mask & candidate->mask;
        unsigned shared = 0;
        for (unsigned m = 0; m < RHO_MAX_SCANS; m++) {
            shared += (common >> m & 1u) && other->plot[m] == candidate->plot[m];
        }
        if (shared > SHARED_PLOTS_MAX) {
            return 1;
        }
    }
    return 0;
}

/* Makes a candidate of the plots that better ones left. Returns 0 where these are too few. */
static int remake_candidate(struct search *search, struct rho_candidate *candidate)
{
    struct line_fit fit;
    struct plot_set set;
    uint16_t skip = search->skip_flags;
    if (!unpack_candidate(search, candidate, &set, &fit)) {
        return 0;
    }
    search->skip_flags = (uint16_t)(skip | RHO_WINDOW_TAKEN);
    rho_plot_set_associate(search, &fit, SECOND_GATE_FACTOR, &set);
    int found = set.hits >= search->min_scans && make_unlisted_candidate(search, &set, candidate);
    search->skip_flags = skip;
    return found;
}

/* Sorts the candidates by descending score; equal scores keep their order. */
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

void rho_candidates_select(struct search *search)
{
    struct rho_initiator *initiator = search->initiator;
    struct rho_candidate *list = initiator->candidates;
    unsigned accepted = 0;
    while (accepted < initiator->num_candidates) {
        if (rho_search_is_over_limit(search)) {
            initiator->work.candidates_dropped =
                rho_count(initiator->work.candidates_dropped, initiator->num_candidates - accepted);
            initiator->num_candidates = (uint16_t)accepted;
            search->is_partial = 1;
            break;
        }
        /* the least work of this choice */
        rho_search_charge(search, RESCORED_UNITS + accepted / SORTED_IN_UNIT +
                                      accepted / COMPARED_IN_UNIT +
                                      (initiator->num_candidates - accepted) / PASSED_IN_UNIT);
        unsigned best = accepted;
        for (unsigned i = accepted + 1; i < initiator->num_candidates; i++) {
            if (list[i].score_mnat > list[best].score_mnat) {
                best = i;
            }
        }
        struct rho_candidate candidate = list[best];
        list[best] = list[accepted];
        list[accepted] = candidate;
        if (!has_conflict(initiator, accepted, &candidate)) {
            mark_plots(search, &candidate, 1);
            accepted++;
        } else if (remake_candidate(search, &candidate)) {
            list[accepted] = candidate;
        } else {
            initiator->num_candidates--;
            list[accepted] = list[initiator->num_candidates];
        }
    }
    clear_taken_marks(search);
    /* association with the plots left may have raised a score */
    sort_candidates(initiator);
    rho_target_assume_turns(search, 0);
}

void rho_candidates_rescore(struct search *search)
{
    struct rho_initiator *initiator = search->initiator;
    unsigned likely = 0, hits = 0, kept = 0;
    /* a score from 0 on: a target is likelier than clutter, and its plots count as a target's */
    for (unsigned i = 0; i < initiator->num_candidates; i++) {
        if (initiator->candidates[i].score_mnat >= 0) {
            mark_plots(search, &initiator->candidates[i], 1);
            hits += initiator->candidates[i].hits;
            likely++;
        }
    }
    if (hits == 0) {
        return; /* without likely targets every plot counts as clutter already: the scores stand */
    }
    /* one of the likely targets may be clutter nevertheless: its plots, as their mean, count */
    rho_density_measure(search, RHO_WINDOW_INITIATED | RHO_WINDOW_TAKEN,
                        (float)hits / (float)likely);
    clear_taken_marks(search);
    rho_thresholds_update(search);
    for (unsigned i = 0; i < initiator->num_candidates; i++) {
        struct rho_candidate candidate = initiator->candidates[i];
        struct plot_set set;
        struct line_fit fit;
        struct set_score score;
        search->is_left_out = candidate.score_mnat >= 0;
        if (!unpack_candidate(search, &candidate, &set, &fit) || set.hits < search->min_scans ||
            !rho_plot_set_score(search, &set, &fit, &score)) {
            continue;
        }
        candidate.score_mnat = score.mnat;
        if (passes_thresholds(search, &score)) {
            initiator->candidates[kept++] = candidate;
        }
    }
    initiator->num_candidates = (uint16_t)kept;
    sort_candidates(initiator);
}
