/* SPDX-License-Identifier: MIT */
/*
 * assignment: which track gets which plot, each at most one, at the least total cost.
 *
 * Rows (tracks) may stay without a column (plot) at cost 0, so only pairs of negative cost are
 * assigned. Costs are integers (thousandths of a nat), so the optimum is exact; it is found by
 * shortest augmenting paths, row by row, each search confined to the rows and columns that share
 * candidates. Equal totals are decided by row and column order: the same input gives the same
 * answer everywhere.
 *
 * Source: Jonker and Volgenant, "A shortest augmenting path algorithm for dense and sparse linear
 * assignment problems", Computing 38, 1987.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_ASSIGNMENT_H
#define RHOTRACK_ASSIGNMENT_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

#define RHO_ASSIGNMENT_NONE (-1)
/* Largest magnitude of a pair's cost, thousandths of a nat. */
#define RHO_ASSIGNMENT_COST_MAX 100000000

struct rho_assignment_pair {
    int32_t cost;
    int16_t column;
};

struct rho_assignment {
    uint32_t magic;
    uint32_t pairs_dropped; /* pairs of this problem beyond RHO_MAX_GATE_PLOTS a row; saturates */
    uint16_t num_rows, num_columns;
    uint16_t num_pairs[RHO_MAX_TRACKS];
    int16_t row_column[RHO_MAX_TRACKS]; /* the answer: each row's column, or RHO_ASSIGNMENT_NONE */
    struct rho_assignment_pair pairs[RHO_MAX_TRACKS][RHO_MAX_GATE_PLOTS];
    /* the answer by column: each column's row, or RHO_ASSIGNMENT_NONE */
    int16_t column_row[RHO_MAX_PLOTS];
    /* scratch of a search: the row from which the column was reached */
    int16_t column_from[RHO_MAX_PLOTS];
    int32_t column_price[RHO_MAX_PLOTS];
    int32_t column_distance[RHO_MAX_PLOTS];
    int16_t column_queue[RHO_MAX_PLOTS];
};

/* Initialises the object; object_size: sizeof *assignment of the caller. Errors: SIZE. */
RHO_MUST_CHECK enum rho_status rho_assignment_init(struct rho_assignment *assignment,
                                                   size_t object_size);

/*
 * Starts a problem of num_rows x num_columns without pairs. Errors: CAPACITY (rows beyond
 * RHO_MAX_TRACKS, columns beyond RHO_MAX_PLOTS). Cost: num_rows + num_columns.
 */
RHO_MUST_CHECK enum rho_status rho_assignment_begin(struct rho_assignment *assignment,
                                                    unsigned num_rows, unsigned num_columns);

/*
 * Adds a pair of a row and a column; a pair of cost >= 0 is ignored. A row holds RHO_MAX_GATE_PLOTS
 * pairs: of more, the one with the highest cost is dropped (of equals the higher column) and
 * pairs_dropped counts it. Errors: VALUE (row, column, cost magnitude, a column that the row
 * holds). Cost: RHO_MAX_GATE_PLOTS.
 */
RHO_MUST_CHECK enum rho_status rho_assignment_offer_pair(struct rho_assignment *assignment,
                                                         unsigned row, unsigned column,
                                                         int32_t cost);

/*
 * Finds the assignment of least total cost, which rho_assignment_column then returns.
 * Cost: a row's search visits each pair of its cluster once and picks the nearest column from a
 * list: at worst rows x (pairs + columns^2) of the cluster. Stack: 130 bytes.
 */
void rho_assignment_solve(struct rho_assignment *assignment);

/* Column of a row in the last solution, or RHO_ASSIGNMENT_NONE. Constant cost. */
int rho_assignment_column(const struct rho_assignment *assignment, unsigned row);

/*
 * Moves the pairs of from_row to to_row, whose own pairs are lost; from_row has none afterwards.
 * Does nothing for rows beyond num_rows. Cost: RHO_MAX_GATE_PLOTS.
 */
void rho_assignment_move_pairs(struct rho_assignment *assignment, unsigned from_row,
                               unsigned to_row);

/* True for an initialised object. Constant cost. */
int rho_assignment_is_ready(const struct rho_assignment *assignment);

RHO_END_C

#endif
