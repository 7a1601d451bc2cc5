/* SPDX-License-Identifier: MIT */
/*
 * accumulator_search: state of one search of the accumulator for peaks, and the functions
 * that its files share. Each file calls only files above it in this list:
 *
 * - accumulator_geometry.c: cells of points
 * - accumulator_rows.c: votes and peaks of rows
 * - accumulator_pruning.c: rows and points that cannot reach a peak
 * - accumulator_search.c: checks, choice of the search
 */
#ifndef RHOTRACK_ACCUMULATOR_SEARCH_H
#define RHOTRACK_ACCUMULATOR_SEARCH_H

#include "rhotrack/detail/accumulator.h"
#include "rhotrack/detail/votes_picture.h"

/* bound of the rounding error of a point's cell, in cells; src/DESIGN.md derives it */
#define RHO_ACCUMULATOR_ROUNDING 0.125f

/* Projection of points onto a row of theta: cell = x by_x + y by_y + first, with one guard cell. */
struct rho_accumulator_projection {
    float by_x, by_y, first;
};

struct rho_accumulator_pass {
    struct rho_accumulator *accumulator;
    const struct rho_accumulator_points *points;
    /* plane in which the votes of cells are noted; NULL: cells are listed as peaks */
    struct rho_votes_picture *plane;
    struct rho_peak_list list; /* peaks found so far; list.min_votes may rise from row to row */
    uint64_t outside;          /* points beyond rho_max_m, summed over the rows */
    unsigned num_points, theta_cell;
    struct rho_accumulator_projection place; /* onto row theta_cell */
    int counts_points, is_narrow;
    int has_outside; /* points may lie beyond rho_max_m in some rows */
};

struct rho_accumulator_projection
rho_accumulator_projection(const struct rho_accumulator *accumulator, unsigned theta_cell);
/* Computes the cells of rho in which n points vote, for points that all lie within rho_max_m. */
void rho_accumulator_project(const float *restrict x_m, const float *restrict y_m, unsigned n,
                             struct rho_accumulator_projection place, int32_t *restrict cells);
/*
 * Computes the cells of rho in which n points vote; points beyond rho_max_m get the guard cells 0
 * and `last`. Returns the number of such points.
 */
unsigned rho_accumulator_clamp_cells(const float *restrict x_m, const float *restrict y_m,
                                     unsigned n, struct rho_accumulator_projection place,
                                     float last, int32_t *restrict cells);
/* Lets the first n points of the scratch vote in a row of theta, empty before and after. */
void rho_accumulator_vote_few(struct rho_accumulator_pass *pass, unsigned theta_cell, unsigned n);
/* Lets all points vote in a row of theta. */
void rho_accumulator_vote_all(struct rho_accumulator_pass *pass, unsigned theta_cell);
/*
 * Lets points that the scratch has room for vote in all rows of theta, or, with is_pruned, only in
 * those that can have peaks, which needs all points within rho_max_m.
 */
void rho_accumulator_search_few(struct rho_accumulator_pass *pass, int is_pruned);

#endif
