/* SPDX-License-Identifier: MIT */
/*
 * assignment: which track gets which plot, each at most one, at the least total cost.
 *
 * Rows (tracks) may stay without a column (plot) at cost 0, so only pairs of negative cost are ever
 * used. Costs are integers (thousandths of a nat), so the optimum is exact; it is found by shortest
 * augmenting paths, row by row, each search confined to the rows and columns that share candidates.
 * Equal totals are decided by row and column order: the same input gives the same answer
 * everywhere.
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

#ifdef __cplusplus
extern "C" {
#endif

#define RHO_ASSIGNMENT_NONE (-1)
#define RHO_ASSIGNMENT_COST_MAX 100000000 /* magnitude of a pair's cost */

struct rho_assignment_pair {
    int32_t cost;
    int16_t column;
};

struct rho_assignment {
    uint32_t magic;
    uint32_t pairs_dropped; /* of this problem, beyond RHO_MAX_GATE_PLOTS a row; saturates */
    uint16_t num_rows, num_columns;
    uint16_t num_pairs[RHO_MAX_TRACKS];
    int16_t row_column[RHO_MAX_TRACKS]; /* the answer */
    struct rho_assignment_pair pairs[RHO_MAX_TRACKS][RHO_MAX_GATE_PLOTS];
    int16_t column_row[RHO_MAX_PLOTS];  /* the answer by column: its row, or RHO_ASSIGNMENT_NONE */
    int16_t column_from[RHO_MAX_PLOTS]; /* scratch of a search: the row that reached it */
    int32_t column_price[RHO_MAX_PLOTS];
    int32_t column_distance[RHO_MAX_PLOTS];
    int16_t column_queue[RHO_MAX_PLOTS];
};

/* Prepares the object once. Errors: NULL, SIZE. */
RHO_MUST_CHECK enum rho_status rho_assignment_init(struct rho_assignment *assignment, size_t size);

/*
 * Starts a problem of num_rows x num_columns without pairs. Errors: NULL, STATE, CAPACITY (rows
 * beyond RHO_MAX_TRACKS, columns beyond RHO_MAX_PLOTS). Cost: num_rows + num_columns.
 */
RHO_MUST_CHECK enum rho_status rho_assignment_begin(struct rho_assignment *assignment,
                                                    unsigned num_rows, unsigned num_columns);

/*
 * Adds a pair; one of cost >= 0 is ignored. A row holds RHO_MAX_GATE_PLOTS pairs: beyond, the
 * dearest gives way and pairs_dropped moves; of equals the higher column. Errors: NULL, STATE,
 * VALUE (row, column, cost magnitude, a column that the row holds). Cost: RHO_MAX_GATE_PLOTS.
 */
RHO_MUST_CHECK enum rho_status rho_assignment_add(struct rho_assignment *assignment, unsigned row,
                                                  unsigned column, int32_t cost);

/*
 * Solves: rho_assignment_column then answers. An object that was not initialised is left alone.
 * Cost: a row's search visits each pair of its cluster once and picks the nearest column from a
 * list: at worst rows x (pairs + columns^2) of the cluster. Stack: 130 bytes.
 */
void rho_assignment_solve(struct rho_assignment *assignment);

/* The column of a row by the last solve, or RHO_ASSIGNMENT_NONE. Constant cost. */
int rho_assignment_column(const struct rho_assignment *assignment, unsigned row);

/*
 * The pairs of row `from` become those of row `to`; rows that were moved on have none. Of rows
 * beyond num_rows nothing happens. Cost: RHO_MAX_GATE_PLOTS.
 */
void rho_assignment_move_pairs(struct rho_assignment *assignment, unsigned from, unsigned to);

/* True of an initialised object. Constant cost. */
int rho_assignment_is_ready(const struct rho_assignment *assignment);

#ifdef __cplusplus
}
#endif

#endif
