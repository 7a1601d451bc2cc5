/* SPDX-License-Identifier: MIT */
/*
 * accumulator_pass: one search of the accumulator, as its files share it: accumulator_plane.c
 * (cells of points), accumulator_rows.c (votes and peaks of rows), accumulator_prune.c (rows and
 * points that cannot reach a peak), accumulator.c (checks, choice of the search). Each calls only
 * those before it.
 */
#ifndef RHO_ACCUMULATOR_PASS_H
#define RHO_ACCUMULATOR_PASS_H

#include "rhotrack/detail/accumulator.h"

/* In cells: a bound of the rounding error of a point's cell. src/DESIGN.md derives it. */
#define RHO_ACCUMULATOR_ROUNDING 0.125f

struct rho_accumulator_pass {
    struct rho_accumulator *accumulator;
    const struct rho_accumulator_points *points;
    struct rho_peak_list list; /* its min_votes may rise from row to row */
    uint32_t votes;
    unsigned num_points, neighbours;
    int counts_points, is_narrow, is_sparse, is_pruned;
    unsigned scans_outside; /* bit m: scan m has points that may lie beyond rho_max_m */
    const void *rows[3];    /* the row that is searched, with its neighbours above and below */
    unsigned middle_theta_cell;
    unsigned above_is_first, below_is_first; /* that neighbour wins a tie */
};

/* Projection of points onto a row: cell = x by_x + y by_y + first, guard cell included. */
struct rho_accumulator_projection {
    float by_x, by_y, first;
};

struct rho_accumulator_projection
rho_accumulator_projection(const struct rho_accumulator *accumulator, unsigned theta_cell);

/* The cells in which n points vote. */
void rho_accumulator_project(const float *restrict x_m, const float *restrict y_m, unsigned n,
                             struct rho_accumulator_projection place, int32_t *restrict cells);

/* The same; points beyond rho_max_m go to the guard cells, 0 and `last`. Returns how many do. */
unsigned rho_accumulator_project_within(const float *restrict x_m, const float *restrict y_m,
                                        unsigned n, struct rho_accumulator_projection place,
                                        float last, int32_t *restrict cells);

/*
 * All points vote in the row theta_cell, into a slot; with rho reversed if the row is a neighbour
 * from the other end of theta.
 */
void rho_accumulator_fill_row(struct rho_accumulator_pass *pass, unsigned slot, unsigned theta_cell,
                              int is_turned);

/* Only the first num_kept points of room.few vote. */
void rho_accumulator_fill_row_with_kept(struct rho_accumulator_pass *pass, unsigned slot,
                                        unsigned theta_cell, unsigned num_kept);

/* Clears a row. */
void rho_accumulator_clear_row(struct rho_accumulator_pass *pass, unsigned slot);

/*
 * Lists the peaks of row theta_cell, which is in slot theta_cell % 3; its neighbours are in the
 * other slots.
 */
void rho_accumulator_find_row_peaks(struct rho_accumulator_pass *pass, unsigned theta_cell);

/* Fills and searches all rows in their order. */
void rho_accumulator_search_all_rows(struct rho_accumulator_pass *pass);

/* Fills and searches only the rows that can have peaks. */
void rho_accumulator_search_pruned(struct rho_accumulator_pass *pass);

#endif
