/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/ghost_matrix.h"

static int are_bearings_valid(const float *bearings_rad, unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        if (!rho_is_within(bearings_rad[i], -100.0f, 100.0f)) { /* as angle.h accepts */
            return 0;
        }
    }
    return 1;
}

enum rho_status rho_ghost_fill(struct rho_ghost_matrix *matrix,
                               const struct rho_crossing_base *base, const float *bearings_a_rad,
                               unsigned num_a, const float *bearings_b_rad, unsigned num_b,
                               float range_max_m)
{
    if (!matrix || !base || (num_a > 0 && !bearings_a_rad) || (num_b > 0 && !bearings_b_rad)) {
        return RHO_ERROR_NULL;
    }
    if (num_a > RHO_MAX_BEARINGS || num_b > RHO_MAX_BEARINGS) {
        return RHO_ERROR_CAPACITY;
    }
    if (!are_bearings_valid(bearings_a_rad, num_a) || !are_bearings_valid(bearings_b_rad, num_b) ||
        !(range_max_m > 0.0f)) {
        return RHO_ERROR_VALUE;
    }
    matrix->rows = (uint16_t)num_a;
    matrix->columns = (uint16_t)num_b;
    for (unsigned i = 0; i < num_a; i++) {
        for (unsigned j = 0; j < num_b; j++) {
            struct rho_crossing crossing;
            enum rho_crossing_fate fate = rho_crossing_find(
                base, bearings_a_rad[i], bearings_b_rad[j], range_max_m, &crossing);
            matrix->delta_rad[i][j] = fate == RHO_CROSSING_MEETS ? crossing.delta_rad : 0.0f;
            matrix->reason[i][j] = (uint8_t)fate;
        }
    }
    return RHO_OK;
}

/* The beams of one sensor: rows or columns of the matrix, which are pruned by the same rule. */
struct beams {
    struct rho_ghost_matrix *matrix;
    unsigned count, others; /* number of beams of this sensor, and of the other one */
    int are_columns;
};

static int is_crossing_kept(const struct beams *beams, unsigned beam, unsigned other)
{
    const struct rho_ghost_matrix *matrix = beams->matrix;
    return (beams->are_columns ? matrix->reason[other][beam] : matrix->reason[beam][other]) ==
           RHO_GHOST_KEPT;
}

/*
 * Steps 2.1 to 2.4 of the paper: where a beam has a single crossing left, that is the target of
 * both beams, and the other crossings of the other sensor's beam are ghosts. Returns their number.
 */
static unsigned prune_single_crossings(const struct beams *beams, uint8_t *done,
                                       uint8_t *others_done)
{
    struct rho_ghost_matrix *matrix = beams->matrix;
    unsigned removed = 0, beam = 0;
    while (beam < beams->count) {
        unsigned kept = 0, only = 0;
        for (unsigned other = 0; !done[beam] && other < beams->others; other++) {
            if (is_crossing_kept(beams, beam, other)) {
                only = other;
                kept++;
            }
        }
        if (kept != 1) {
            beam++;
            continue;
        }
        for (unsigned i = 0; i < beams->count; i++) {
            if (i != beam && is_crossing_kept(beams, i, only)) {
                unsigned row = beams->are_columns ? only : i;
                unsigned column = beams->are_columns ? i : only;
                matrix->delta_rad[row][column] = 0.0f;
                matrix->reason[row][column] = beams->are_columns ? RHO_GHOST_COLUMN : RHO_GHOST_ROW;
                removed++;
            }
        }
        done[beam] = others_done[only] = 1;
        beam = 0; /* other beams may have a single crossing now */
    }
    return removed;
}

#define NONE UINT8_MAX

/* One-to-one matching of the bearings of sensor a (rows) with those of sensor b (columns). */
struct matching {
    unsigned count;                   /* number of bearings of either sensor */
    uint64_t kept[RHO_MAX_BEARINGS];  /* bit j of row i: crossing (i, j) is not a ghost */
    uint8_t column[RHO_MAX_BEARINGS]; /* column matched with each row; NONE: not matched yet */
    uint8_t row[RHO_MAX_BEARINGS];    /* row matched with each column; NONE: not matched yet */
};

/*
 * Matches one more row: breadth-first search for an augmenting path to a free column, along which
 * each row gives up its column and gets the next one. Returns 0 where there is no such path.
 */
static int try_match_row(struct matching *matching, unsigned row)
{
    uint8_t rows[RHO_MAX_BEARINGS], reached_from[RHO_MAX_BEARINGS];
    uint64_t reached = 0;
    unsigned end = 0, taker = NONE;
    rows[end++] = (uint8_t)row;
    for (unsigned i = 0; i < end; i++) {
        for (unsigned column = 0; column < matching->count; column++) {
            if (!((matching->kept[rows[i]] & ~reached) >> column & 1u)) {
                continue;
            }
            reached |= (uint64_t)1 << column;
            reached_from[column] = rows[i];
            if (matching->row[column] != NONE) {
                rows[end++] = matching->row[column];
                continue;
            }
            while (taker != row) {
                taker = reached_from[column];
                const unsigned left = matching->column[taker];
                matching->column[taker] = (uint8_t)column;
                matching->row[column] = (uint8_t)taker;
                column = left;
            }
            return 1;
        }
    }
    return 0;
}

/*
 * Removes crossings that are in no complete matching. Crossing (i, j) is in one if the row matched
 * with column j can get the column of row i while rows between them exchange columns.
 */
static unsigned prune_crossings_in_no_matching(struct rho_ghost_matrix *matrix)
{
    struct matching matching = {.count = matrix->rows};
    uint64_t ways[RHO_MAX_BEARINGS]; /* bit k of ways[i]: row i can get the column of row k */
    unsigned removed = 0, n = matrix->rows;
    for (unsigned i = 0; i < n; i++) {
        matching.column[i] = matching.row[i] = NONE;
        for (unsigned j = 0; j < n; j++) {
            matching.kept[i] |= (uint64_t)(matrix->reason[i][j] == RHO_GHOST_KEPT) << j;
        }
    }
    for (unsigned row = 0; row < n; row++) {
        if (!try_match_row(&matching, row)) {
            return 0;
        }
    }
    for (unsigned i = 0; i < n; i++) {
        ways[i] = 0;
        for (unsigned k = 0; k < n; k++) {
            ways[i] |= (matching.kept[i] >> matching.column[k] & 1u) << k;
        }
    }
    for (unsigned k = 0; k < n; k++) { /* transitive closure */
        for (unsigned i = 0; i < n; i++) {
            ways[i] |= ways[i] >> k & 1u ? ways[k] : 0;
        }
    }
    for (unsigned i = 0; i < n; i++) {
        for (unsigned j = 0; j < n; j++) {
            if (matrix->reason[i][j] == RHO_GHOST_KEPT && !(ways[matching.row[j]] >> i & 1u)) {
                matrix->delta_rad[i][j] = 0.0f;
                matrix->reason[i][j] = RHO_GHOST_UNMATCHED;
                removed++;
            }
        }
    }
    return removed;
}

unsigned rho_ghost_prune(struct rho_ghost_matrix *matrix, enum rho_ghost_rule rule)
{
    if (rule == RHO_GHOST_LITERAL) {
        uint8_t rows_done[RHO_MAX_BEARINGS] = {0}, columns_done[RHO_MAX_BEARINGS] = {0};
        struct beams rows = {matrix, matrix->rows, matrix->columns, 0};
        struct beams columns = {matrix, matrix->columns, matrix->rows, 1};
        unsigned removed = prune_single_crossings(&rows, rows_done, columns_done);
        return removed + prune_single_crossings(&columns, columns_done, rows_done);
    }
    return rule == RHO_GHOST_SAFE && matrix->rows == matrix->columns
               ? prune_crossings_in_no_matching(matrix)
               : 0;
}

/* arrays of characters rather than pointers, so that the table needs no relocation */
static const char names[RHO_NUM_GHOST_REASONS][10] = {
    [RHO_GHOST_KEPT] = "kept",           [RHO_GHOST_SIDES] = "sides", [RHO_GHOST_APART] = "apart",
    [RHO_GHOST_RANGE] = "range",         [RHO_GHOST_ROW] = "row",     [RHO_GHOST_COLUMN] = "column",
    [RHO_GHOST_UNMATCHED] = "unmatched",
};

const char *rho_ghost_reason_name(enum rho_ghost_reason reason)
{
    return (unsigned)reason < RHO_NUM_GHOST_REASONS ? names[reason] : "unknown";
}
