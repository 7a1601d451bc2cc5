/* SPDX-License-Identifier: MIT */
/*
 * experiment_air_traffic_limit: what the library's filter could do if it knew whose plot is whose.
 *
 * A tracker of its own follows each target, and sees this target's plots and nothing else. So
 * gates, filter, and the rules by which tracks end are the library's, whatever they are; the start
 * is fixed to the M of N of the run beside it, and takes any score, since without clutter every
 * score is high. What differs from that run is association alone.
 */
#include <stdlib.h>

#include "base/common.h"
#include "experiment_air_traffic.h"

#define TRACKS_OF_A_TARGET 1000 /* identities of a target's tracks begin at its number times this */
#define ANY_SCORE_NAT (-100.0)

/* Rows of plots by target and scan; -1: not seen. */
struct rows {
    size_t num_scans;
    int32_t *row;
};

static struct rows find_rows(const struct simulation *simulation)
{
    struct rows rows = {.num_scans = simulation->num_scans};
    size_t count = simulation->num_targets * simulation->num_scans;

    rows.row = must_alloc((count + 1) * sizeof *rows.row);
    for (size_t i = 0; i < count; i++) {
        rows.row[i] = -1;
    }
    for (size_t scan = 0; scan < simulation->num_scans; scan++) {
        const struct simulated_scan *from = &simulation->scans[scan];
        for (size_t i = 0; i < from->num_plots; i++) {
            if (from->plots[i].target_id >= 0) {
                rows.row[(size_t)from->plots[i].target_id * rows.num_scans + scan] = (int32_t)i;
            }
        }
    }
    return rows;
}

static struct parameters parameters_of(const struct parameters *parameters, unsigned min_scans)
{
    struct parameters limit = *parameters;

    limit.value[PARAMETER_MIN_SCANS] = min_scans;
    limit.value[PARAMETER_SCORE_MIN_NAT] = ANY_SCORE_NAT;
    limit.source[PARAMETER_SCORE_MIN_NAT] = SOURCE_SET;
    return limit;
}

static void step_alone(const struct simulation *simulation, size_t index, int32_t row,
                       struct pipeline *chain)
{
    const struct simulated_scan *from = &simulation->scans[index];
    struct simulated_scan alone = {
        .t_s = from->t_s, .num_plots = row >= 0, .plots = row >= 0 ? &from->plots[row] : NULL};
    struct simulation single = {.num_scans = 1, .sigma_m = simulation->sigma_m, .scans = &alone};
    struct rho_scan scan = air_scan(&single, 0, chain);

    pipeline_step(chain, &scan);
}

/* From its first plot until nothing is left of it. */
static void follow_one(const struct simulation *simulation, size_t target, const int32_t *rows,
                       struct pipeline *chain, struct air_points *scans)
{
    size_t first = 0, last = simulation->num_scans;

    while (first < simulation->num_scans && rows[first] < 0) {
        first++;
    }
    while (last > first && rows[last - 1] < 0) {
        last--;
    }
    for (size_t i = first; i < simulation->num_scans; i++) {
        step_alone(simulation, i, rows[i], chain);
        air_points_add(&scans[i], chain->report, (int32_t)(target * TRACKS_OF_A_TARGET));
        if (i >= last && chain->report->num_tracks == 0) {
            break;
        }
    }
}

void air_limit(const struct parameters *parameters, const struct simulation *simulation,
               unsigned min_scans, struct pipeline *chain, struct air_points *scans)
{
    struct parameters limit = parameters_of(parameters, min_scans);
    struct rows rows = find_rows(simulation);

    for (size_t i = 0; i < simulation->num_scans; i++) {
        scans[i].count = 0;
    }
    for (size_t target = 0; target < simulation->num_targets; target++) {
        pipeline_open(chain, &limit);
        follow_one(simulation, target, &rows.row[target * rows.num_scans], chain, scans);
    }
    free(rows.row);
}
