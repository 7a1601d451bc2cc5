/* SPDX-License-Identifier: MIT */
/*
 * accumulator_pass: one search of the accumulator, as its parts share it: accumulator.c (checks, set-up), accumulator_rows.c
 * (rows that vote and are looked through), accumulator_prune.c (which rows, and whose votes, cannot be left out).
 */
#ifndef RHO_ACCUMULATOR_PASS_H
#define RHO_ACCUMULATOR_PASS_H

#include "rhotrack/accumulator.h"

/* Cells: more than all roundings of a point's place in a row. src/DESIGN.md counts them up. */
#define RHO_ACCUMULATOR_ROUNDING 0.125f

struct rho_accumulator_pass {
    struct rho_accumulator *accumulator;
    const struct rho_accumulator_points *points;
    struct rho_peak_list list; /* its min_votes may rise from row to row */
    uint32_t votes;
    unsigned num_points, neighbours;
    int counts_points, is_narrow, is_sparse, is_pruned;
    unsigned scans_outside; /* bit m: scan m has points that may lie beyond rho_max_m */
    const void *rows[3];    /* above, in and below the one that is looked through */
    unsigned middle_theta_cell;
    unsigned above_is_first, below_is_first; /* such rows win a tie */
};

/* Where points vote in a row: x by_x + y by_y + first, the guard cell counted. */
struct rho_accumulator_place {
    float by_x, by_y, first;
};

struct rho_accumulator_place rho_accumulator_place(const struct rho_accumulator *accumulator,
                                                   unsigned theta_cell);

/* Cells of n points. */
void rho_accumulator_cells(const float *restrict x_m, const float *restrict y_m, unsigned n,
                           struct rho_accumulator_place place, int32_t *restrict cells);

/* The same; points beyond rho_max_m go to the guard cells, 0 and `last`. Returns how many do. */
unsigned rho_accumulator_cells_within(const float *restrict x_m, const float *restrict y_m,
                                      unsigned n, struct rho_accumulator_place place, float last,
                                      int32_t *restrict cells);

/* All points vote in the row theta_cell, in a slot; turned round where it is a neighbour from the other end of theta. */
void rho_accumulator_fill(struct rho_accumulator_pass *pass, unsigned slot, unsigned theta_cell,
                          int is_turned);

/* The first num_kept points of room.few vote, no others. */
void rho_accumulator_fill_kept(struct rho_accumulator_pass *pass, unsigned slot,
                               unsigned theta_cell, unsigned num_kept);

/* A row without votes. */
void rho_accumulator_fill_none(struct rho_accumulator_pass *pass, unsigned slot);

/* Takes the peaks of row theta_cell, which is in slot theta_cell % 3; its neighbours are in the others. */
void rho_accumulator_look_through(struct rho_accumulator_pass *pass, unsigned theta_cell);

/* All rows, one after the other. */
void rho_accumulator_stream(struct rho_accumulator_pass *pass);

/* Only those that can have peaks. */
void rho_accumulator_prune(struct rho_accumulator_pass *pass);

#endif
