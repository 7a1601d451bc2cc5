/* SPDX-License-Identifier: MIT */
/*
 * The rules of hypotheses.h as plainly as possible, for comparison: whole lists are sorted, weights
 * are double, there is no pool. The filter is rho_imm itself, which test_imm.c compares with a
 * reference of its own.
 */
#ifndef RHOTRACK_TESTS_HYPOTHESES_MODEL_H
#define RHOTRACK_TESTS_HYPOTHESES_MODEL_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/detail/hypotheses.h"

#define MODEL_PLOTS 64
#define MODEL_CHILDREN (RHO_HYPOTHESES_OF_TRACK * (MODEL_PLOTS + 1))

struct model_answer {
    struct rho_imm imm;
    int64_t time_us;
    double weight;
    int16_t picks[RHO_HYPOTHESES_MEMORY];
};

struct model_track {
    struct rho_imm_model model;
    struct model_answer answers[RHO_HYPOTHESES_OF_TRACK];
    int num;
    int num_refused;
};

struct model_child {
    double weight;
    int parent, row;
    struct rho_imm_match match;
};

static inline double model_log_sum(const struct model_track *track)
{
    double sum = 0.0;

    for (int i = 0; i < track->num; ++i) {
        sum += exp(track->answers[i].weight);
    }
    return log(sum);
}

static inline enum rho_status model_step_filter(const struct model_track *track,
                                                struct rho_imm *imm, int64_t from_us, int64_t to_us,
                                                int is_prediction)
{
    struct rho_imm_step step;

    if (from_us == to_us) {
        return RHO_OK;
    }
    rho_imm_prepare_step(&step, &track->model, (float)((double)(to_us - from_us) * 1e-6));
    return is_prediction ? rho_imm_predict(imm, &step) : rho_imm_predict_unmixed(imm, &step);
}

static inline void model_open(struct model_track *track, const struct rho_imm_model *model,
                              const struct rho_kalman *estimate, int64_t time_us)
{
    memset(track, 0, sizeof *track);
    track->model = *model;
    track->num = 1;
    rho_imm_start(&track->answers[0].imm, model, estimate);
    track->answers[0].time_us = time_us;
    for (int k = 0; k < RHO_HYPOTHESES_MEMORY; ++k) {
        track->answers[0].picks[k] = RHO_HYPOTHESES_MISS;
    }
}

static inline void model_predict(struct model_track *track, int64_t time_us)
{
    for (int i = 0; i < track->num; ++i) {
        struct model_answer *at = &track->answers[i];

        assert_int_equal(model_step_filter(track, &at->imm, at->time_us, time_us, 1), RHO_OK);
        at->time_us = time_us;
    }
}

/* Sorts by falling weight; children of equal weight keep their order. */
static inline void model_sort_by_weight(struct model_child *children, int num)
{
    for (int i = 1; i < num; ++i) {
        const struct model_child child = children[i];
        int place = i;

        for (; place > 0 && children[place - 1].weight < child.weight; --place) {
            children[place] = children[place - 1];
        }
        children[place] = child;
    }
}

/*
 * Makes the best children that take a plot from one hypothesis, without the miss; returns their
 * number.
 */
static inline int model_best_children_that_take_a_plot(const struct model_track *track, int parent,
                                                       const struct rho_hypotheses_scan *scan,
                                                       int num_plots, double log_pd,
                                                       const struct rho_hypotheses_clutter *clutter,
                                                       struct model_child *out)
{
    const struct model_answer *at = &track->answers[parent];
    int num = 0;

    for (int row = 0; row < num_plots; ++row) {
        struct model_child child = {.parent = parent, .row = row};
        struct rho_imm moved = at->imm;
        struct rho_imm_plot seen;

        rho_imm_prepare_plot(&seen, &scan->plots[row], scan->measures, scan->sensor);
        if (model_step_filter(track, &moved, at->time_us,
                              scan->time_us + scan->plots[row].offset_us, 0) != RHO_OK ||
            !rho_imm_score_plot(&moved, &seen, &child.match)) {
            continue;
        }
        child.weight = at->weight + log_pd + child.match.log_likelihood - clutter->log_per_m2;
        child.weight -= child.match.num_axes > 2 ? (double)clutter->log_per_m : 0.0;
        child.weight -=
            child.match.has_velocity ? child.match.num_axes * (double)clutter->log_per_mps : 0.0;
        child.weight -= child.match.has_range_rate ? (double)clutter->log_per_range_rate : 0.0;
        out[num++] = child;
    }
    model_sort_by_weight(out, num);
    return num < RHO_HYPOTHESES_CHILDREN ? num : RHO_HYPOTHESES_CHILDREN;
}

static inline int model_is_repeated(const struct model_track *track, const struct model_child *kept,
                                    int num, const struct model_child *child)
{
    for (int i = 0; i < num; ++i) {
        int is_same = kept[i].row == child->row;

        for (int k = 1; k < RHO_HYPOTHESES_MEMORY; ++k) {
            is_same = is_same && track->answers[kept[i].parent].picks[k] ==
                                     track->answers[child->parent].picks[k];
        }
        if (is_same) {
            return 1;
        }
    }
    return 0;
}

static inline struct model_answer model_answer_of_child(struct model_track *track,
                                                        const struct rho_hypotheses_scan *scan,
                                                        const struct model_child *child)
{
    const struct model_answer *parent = &track->answers[child->parent];
    struct model_answer out = *parent;
    int16_t row = (int16_t)child->row;

    if (row >= 0) {
        const int64_t time_us = scan->time_us + scan->plots[row].offset_us;
        struct rho_imm_plot seen;

        rho_imm_prepare_plot(&seen, &scan->plots[row], scan->measures, scan->sensor);
        if (model_step_filter(track, &out.imm, out.time_us, time_us, 0) == RHO_OK &&
            rho_imm_update(&out.imm, &track->model, &seen, &child->match) == RHO_OK) {
            out.time_us = time_us;
        } else {
            out = *parent;
            row = RHO_HYPOTHESES_MISS;
            track->num_refused++;
        }
    }
    for (int k = 1; k < RHO_HYPOTHESES_MEMORY; ++k) {
        out.picks[k - 1] = parent->picks[k];
    }
    out.picks[RHO_HYPOTHESES_MEMORY - 1] = row;
    out.weight = child->weight;
    return out;
}

/*
 * Runs a scan after the prediction: children, pruning, updates. Returns the track's gain: ln of the
 * sum of the children's likelihoods over the parents'.
 */
static inline double model_take_scan(struct model_track *track,
                                     const struct rho_hypotheses_scan *scan, int num_plots,
                                     double log_pd, const struct rho_hypotheses_clutter *clutter)
{
    static struct model_child children[MODEL_CHILDREN], candidates[MODEL_PLOTS];
    struct model_child kept[RHO_HYPOTHESES_OF_TRACK];
    struct model_answer next[RHO_HYPOTHESES_OF_TRACK];
    const double before = model_log_sum(track);
    int num = 0, num_kept = 0;

    for (int i = 0; i < track->num; ++i) {
        const int n = model_best_children_that_take_a_plot(track, i, scan, num_plots, log_pd,
                                                           clutter, candidates);

        for (int k = 0; k < n; ++k) {
            const int16_t owner = scan->claims ? scan->claims[candidates[k].row] : -1;

            if (owner < 0 || owner == scan->own) {
                children[num++] = candidates[k];
            }
        }
        children[num++] = (struct model_child){
            .weight = track->answers[i].weight + scan->log_miss, .parent = i, .row = -1};
    }
    model_sort_by_weight(children, num);
    for (int i = 0; i < num && num_kept < RHO_HYPOTHESES_OF_TRACK; ++i) {
        if (children[i].weight >= children[0].weight + (double)RHO_HYPOTHESES_WEIGHT_MIN &&
            !model_is_repeated(track, kept, num_kept, &children[i])) {
            kept[num_kept++] = children[i];
        }
    }
    for (int i = 0; i < num_kept; ++i) {
        next[i] = model_answer_of_child(track, scan, &kept[i]);
    }
    memcpy(track->answers, next, (size_t)num_kept * sizeof next[0]);
    track->num = num_kept;
    const double gain = model_log_sum(track) - before;
    for (int i = num_kept - 1; i >= 0; --i) {
        track->answers[i].weight -= track->answers[0].weight;
    }
    return gain;
}

#endif
