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

/* bound of the rounding error of a point's cell, in cells; src/DESIGN.md derives it */
#define RHO_ACCUMULATOR_ROUNDING 0.125f

struct rho_accumulator_pass {
    struct rho_accumulator *accumulator;
    const struct rho_accumulator_points *points;
    struct rho_peak_list list; /* peaks found so far; list.min_votes may rise from row to row */
    uint32_t votes;
    unsigned num_points, neighbours;
    int counts_points, is_narrow, is_sparse;
    /* mask of scans with points that may lie beyond rho_max_m: bit m for scan m */
    unsigned scans_outside;
    /* the row that is searched for peaks (1), its neighbour above (0) and below (2) */
    const void *rows[3];
    unsigned middle_theta_cell;
    /* the cells of that neighbour row come first: they win ties of votes */
    unsigned above_is_first, below_is_first;
};

/* Projection of points onto a row of theta: cell = x by_x + y by_y + first, with one guard cell. */
struct rho_accumulator_projection {
    float by_x, by_y, first;
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
/*
 * Fills one of the three row slots with the votes of all points in row theta_cell, with rho
 * reversed if the row stands in for a neighbour beyond the ends of theta.
 */
void rho_accumulator_fill_row(struct rho_accumulator_pass *pass, unsigned slot, unsigned theta_cell,
                              int is_rho_reversed);
/* Fills a row slot with the votes of the first num_kept points of room.few only. */
void rho_accumulator_fill_kept(struct rho_accumulator_pass *pass, unsigned slot,
                               unsigned theta_cell, unsigned num_kept);
/* Clears a sparse row: its touched cells, and its lists of touched and reached cells. */
void rho_accumulator_clear_row(struct rho_accumulator_pass *pass, unsigned slot);
/* Lists the peaks of row theta_cell, in slot theta_cell % 3; the other slots: its neighbours. */
void rho_accumulator_find_row_peaks(struct rho_accumulator_pass *pass, unsigned theta_cell);
/* Fills all rows of theta in their order, and lists their peaks. */
void rho_accumulator_search_rows(struct rho_accumulator_pass *pass);
/* Fills only the rows of theta that can have peaks, and lists their peaks. */
void rho_accumulator_search_pruned(struct rho_accumulator_pass *pass);

#endif
