/* SPDX-License-Identifier: MIT */
/*
 * evaluation_statistics: computes the figures of an evaluation, overall and for each target,
 * from the accumulated pairs.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "evaluation/evaluation.h"
#include "evaluation/evaluation_state.h"

/* 95 % quantile of chi-square with two degrees of freedom: -2 ln 0.05 */
#define NEES_95 5.991464547107979

double evaluation_mean_or_nan(double sum, size_t count)
{
    return count == 0 ? NAN : sum / (double)count;
}

/*
 * The value below which a share of the sorted values lies, interpolated between neighbours; NAN
 * where there are none.
 */
static double quantile(const double *sorted, size_t count, double share)
{
    if (count == 0) {
        return NAN;
    }
    double place = share * (double)(count - 1);
    size_t below = (size_t)place, above = below + 1 < count ? below + 1 : below;
    return sorted[below] + (place - (double)below) * (sorted[above] - sorted[below]);
}

static double root_mean_square(const double *values, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        sum += values[i] * values[i];
    }
    return sqrt(evaluation_mean_or_nan(sum, count));
}

struct nees_sum {
    double sum;
    size_t known, inside;
};

static void add_nees(struct nees_sum *to, double nees)
{
    if (isfinite(nees)) {
        to->sum += nees;
        to->known++;
        to->inside += nees <= NEES_95;
    }
}

static void fill_nees_figures(struct evaluation_errors *errors, const struct pair_error *pairs,
                              size_t count)
{
    struct nees_sum place = {0}, velocity = {0};
    for (size_t i = 0; i < count; i++) {
        add_nees(&place, pairs[i].nees);
        add_nees(&velocity, pairs[i].velocity_nees);
    }
    errors->nees = evaluation_mean_or_nan(place.sum, place.known);
    errors->nees_inside = evaluation_mean_or_nan((double)place.inside, place.known);
    errors->velocity_ratio = evaluation_mean_or_nan(velocity.sum, velocity.known) / EVALUATION_AXES;
    errors->velocity_inside = evaluation_mean_or_nan((double)velocity.inside, velocity.known);
}

static struct evaluation_errors errors_of_pairs(const struct pair_error *pairs, size_t count)
{
    struct evaluation_errors errors = {.pairs = count};
    double *values = must_calloc(count, sizeof *values);
    size_t known = 0;
    for (size_t i = 0; i < count; i++) {
        values[i] = pairs[i].error_m;
    }
    qsort(values, count, sizeof *values, compare_doubles);
    errors.rmse_m = root_mean_square(values, count);
    errors.median_m = quantile(values, count, 0.5);
    errors.p95_m = quantile(values, count, 0.95);
    for (size_t i = 0; i < count; i++) {
        if (isfinite(pairs[i].error_mps)) {
            values[known++] = pairs[i].error_mps;
        }
    }
    qsort(values, known, sizeof *values, compare_doubles);
    errors.rmse_mps = root_mean_square(values, known);
    errors.median_mps = quantile(values, known, 0.5);
    errors.p95_mps = quantile(values, known, 0.95);
    free(values);
    fill_nees_figures(&errors, pairs, count);
    return errors;
}

static void fill_figures_over_all_targets(const struct evaluation *e,
                                          struct evaluation_result *result)
{
    double delay_scans = 0.0, delay_s = 0.0, points = 0.0, points_after = 0.0;
    for (size_t i = 0; i < e->target_ids.count; i++) {
        const struct target_life *life = &e->targets[i];
        points += (double)life->scans;
        /* a target that was never found has delay_scans 0: all its points count */
        points_after += (double)(life->scans - life->delay_scans);
        result->switches += life->switches;
        result->fragments += life->fragments;
        if (life->paired > 0) {
            result->targets_found++;
            delay_scans += (double)life->delay_scans;
            delay_s += (double)(life->found_us - life->first_us) * 1e-6;
        }
    }
    result->targets = e->target_ids.count;
    result->completeness = points > 0.0 ? (double)e->num_pairs / points : NAN;
    result->completeness_once_found =
        points_after > 0.0 ? (double)e->num_pairs / points_after : NAN;
    result->delay_scans = evaluation_mean_or_nan(delay_scans, result->targets_found);
    result->delay_s = evaluation_mean_or_nan(delay_s, result->targets_found);
}

static void fill_scan_figures(const struct evaluation *e, struct evaluation_result *result)
{
    double squared_m2 = 0.0, localisation_m2 = 0.0, ospa_m = 0.0, missed = 0.0, false_rows = 0.0;
    for (size_t i = 0; i < e->num_scans; i++) {
        const struct evaluation_scan *scan = &e->scans[i];
        squared_m2 += scan->localisation_m2 + scan->missed_m2 + scan->false_m2;
        localisation_m2 += scan->localisation_m2;
        ospa_m += scan->ospa_m;
        missed += (double)(scan->targets - scan->pairs);
        false_rows += (double)(scan->tracks - scan->pairs);
    }
    result->scans = e->num_scans;
    result->first_us = e->num_scans ? e->scans[0].time_us : 0;
    result->last_us = e->num_scans ? e->scans[e->num_scans - 1].time_us : 0;
    result->gospa_m = sqrt(evaluation_mean_or_nan(squared_m2, e->num_scans));
    result->gospa_localisation_m = sqrt(evaluation_mean_or_nan(localisation_m2, e->num_scans));
    result->gospa_missed = evaluation_mean_or_nan(missed, e->num_scans);
    result->gospa_false = result->false_per_scan = evaluation_mean_or_nan(false_rows, e->num_scans);
    result->ospa_m = evaluation_mean_or_nan(ospa_m, e->num_scans);
}

static void fill_errors_by_motion(const struct evaluation *e, struct evaluation_result *result)
{
    struct pair_error *pairs = must_calloc(e->num_pairs, sizeof *pairs);
    for (int motion = 0; motion < EVALUATION_MOTIONS; motion++) {
        size_t count = 0;
        for (size_t i = 0; i < e->num_pairs; i++) {
            if (e->pairs[i].motion == (enum evaluation_motion)motion) {
                pairs[count++] = e->pairs[i];
            }
        }
        result->by_motion[motion] = errors_of_pairs(pairs, count);
    }
    free(pairs);
}

struct evaluation_result evaluation_result(const struct evaluation *e)
{
    struct evaluation_result result = {0};
    fill_scan_figures(e, &result);
    fill_figures_over_all_targets(e, &result);
    double hours = (double)(result.last_us - result.first_us) / 3.6e9;
    for (size_t i = 0; i < e->track_ids.count; i++) {
        result.false_tracks += 2 * e->tracks[i].paired < e->tracks[i].scans;
    }
    result.tracks = e->track_ids.count;
    result.false_per_hour = hours > 0.0 ? (double)result.false_tracks / hours : NAN;
    result.errors = errors_of_pairs(e->pairs, e->num_pairs);
    fill_errors_by_motion(e, &result);
    return result;
}

static int by_id(const void *a, const void *b)
{
    const struct evaluation_target *one = a, *other = b;
    return one->id < other->id ? -1 : one->id > other->id;
}

/*
 * Copies the pairs' errors sorted by target; begin[number] is the index of a target's first pair.
 */
static struct pair_error *group_pairs_by_target(const struct evaluation *e, size_t *begin)
{
    struct pair_error *grouped = must_calloc(e->num_pairs, sizeof *grouped);
    size_t *next = must_calloc(e->target_ids.count, sizeof *next);
    begin[0] = 0;
    for (size_t i = 0; i < e->target_ids.count; i++) {
        begin[i + 1] = begin[i] + e->targets[i].paired;
        next[i] = begin[i];
    }
    for (size_t i = 0; i < e->num_pairs; i++) {
        grouped[next[e->pairs[i].target]++] = e->pairs[i];
    }
    free(next);
    return grouped;
}

struct evaluation_target *evaluation_results_by_target(const struct evaluation *e, size_t *count)
{
    struct evaluation_target *targets = must_calloc(e->target_ids.count, sizeof *targets);
    size_t *begin = must_calloc(e->target_ids.count + 1, sizeof *begin);
    struct pair_error *pairs = group_pairs_by_target(e, begin);
    for (size_t i = 0; i < e->target_ids.count; i++) {
        const struct target_life *life = &e->targets[i];
        targets[i] = (struct evaluation_target){
            .id = e->target_ids.ids[i],
            .first_us = life->first_us,
            .last_us = life->last_us,
            .found_us = life->found_us,
            .kept_until_us = life->kept_until_us,
            .scans = life->scans,
            .paired = life->paired,
            .delay_scans = life->delay_scans,
            .switches = life->switches,
            .fragments = life->fragments,
            .errors = errors_of_pairs(&pairs[begin[i]], life->paired),
        };
    }
    free(begin);
    free(pairs);
    *count = e->target_ids.count;
    qsort(targets, *count, sizeof *targets, by_id);
    return targets;
}
