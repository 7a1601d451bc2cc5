/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/assignment.h"

#include <string.h>

enum { ASSIGNMENT_MAGIC = 0x41534e31 }; /* "ASN1" */
#define DISTANCE_NONE INT32_MAX

/*
 * Search for one row's shortest augmenting path: Dijkstra's algorithm over costs reduced by the
 * columns' prices (Jonker and Volgenant 1987). A path ends at a free column, or at a row that gives
 * up its column. Such a row is as if assigned to a dummy column of its own with cost and price 0;
 * dummy columns need no tables, as no later search reaches a row in one. Prices stay within
 * -COST_MAX .. 0 and distances within twice that: an assigned row has cost - price <= 0, and no
 * path of higher cost than leaving the row unassigned is followed. int32_t is enough.
 */
struct search {
    /* distance to the nearest row that may give up its column; after the search, to the end */
    int32_t end_distance;
    int16_t end_row;
    int16_t end_column;
    int num_scanned;  /* columns at the head of the queue whose rows were expanded */
    int num_labelled; /* columns in the queue: those that were labelled */
};

int rho_assignment_is_ready(const struct rho_assignment *assignment)
{
    return assignment->magic == ASSIGNMENT_MAGIC;
}

/* True where `one` has the higher cost; of equal costs, where it has the higher column. */
static int is_costlier(const struct rho_assignment_pair *one,
                       const struct rho_assignment_pair *other)
{
    return one->cost > other->cost || (one->cost == other->cost && one->column > other->column);
}

/* Index of a column among a row's pairs, or the number of pairs where the row does not hold it. */
static int pair_index(const struct rho_assignment *a, int row, int column)
{
    const int num_pairs = a->num_pairs[row];
    int i = 0;
    while (i < num_pairs && a->pairs[row][i].column != column) {
        ++i;
    }
    return i;
}

/*
 * Labels the columns that can be reached from a row with their distances, and the row as an end
 * that gives up its column. price_less_distance: the row's price less its distance.
 */
static void label_columns(struct rho_assignment *a, struct search *s, int row,
                          int32_t price_less_distance)
{
    if (-price_less_distance < s->end_distance) {
        s->end_distance = -price_less_distance;
        s->end_row = (int16_t)row;
    }
    for (int i = 0; i < a->num_pairs[row]; ++i) {
        const int column = a->pairs[row][i].column;
        const int32_t distance =
            a->pairs[row][i].cost - a->column_price[column] - price_less_distance;
        /* columns at least as far as the end never become part of the path */
        if (distance < a->column_distance[column] && distance < s->end_distance) {
            if (a->column_distance[column] == DISTANCE_NONE) {
                a->column_queue[s->num_labelled++] = (int16_t)column;
            }
            a->column_distance[column] = distance;
            a->column_from[column] = (int16_t)row;
        }
    }
}

/*
 * Finds the end of the shortest augmenting path from a row: s->end_column, or where that is NONE,
 * s->end_row, which gives up its column.
 */
static void find_path_end(struct rho_assignment *a, struct search *s, int row)
{
    int16_t *queue = a->column_queue;
    label_columns(a, s, row, 0);
    for (;;) { /* at most num_columns times: each column is scanned once */
        /* the nearest of the labelled columns that were not scanned, of equals the lowest */
        int32_t least = s->end_distance;
        int nearest = -1;
        for (int i = s->num_scanned; i < s->num_labelled; ++i) {
            const int32_t distance = a->column_distance[queue[i]];
            if (distance < least ||
                (nearest >= 0 && distance == least && queue[i] < queue[nearest])) {
                least = distance;
                nearest = i;
            }
        }
        if (nearest < 0) {
            return; /* none is nearer than the end */
        }
        const int16_t column = queue[nearest], owner = a->column_row[column];
        queue[nearest] = queue[s->num_scanned];
        queue[s->num_scanned] = column;
        if (owner == RHO_ASSIGNMENT_NONE) {
            s->end_column = column;
            s->end_distance = a->column_distance[column];
            return;
        }
        ++s->num_scanned;
        const int32_t price =
            a->pairs[owner][pair_index(a, owner, column)].cost - a->column_price[column];
        label_columns(a, s, owner, price - a->column_distance[column]);
    }
}

/* Walks back from the path's end to first_row: each row takes the column reached from it. */
static void augment_path(struct rho_assignment *a, const struct search *s, int first_row)
{
    int16_t column = s->end_column;
    int16_t row = s->end_row;
    if (column == RHO_ASSIGNMENT_NONE) {
        column = a->row_column[row];
        a->row_column[row] = RHO_ASSIGNMENT_NONE;
        if (row == first_row) {
            return;
        }
    }
    do { /* terminates: a shortest path meets a row once */
        const int16_t freed = a->row_column[a->column_from[column]];

        row = a->column_from[column];
        a->row_column[row] = column;
        a->column_row[column] = row;
        column = freed;
    } while (row != first_row);
}

static void clear_answer(struct rho_assignment *a)
{
    for (int i = 0; i < a->num_rows; ++i) {
        a->row_column[i] = RHO_ASSIGNMENT_NONE;
    }
    for (int i = 0; i < a->num_columns; ++i) {
        a->column_row[i] = RHO_ASSIGNMENT_NONE;
        a->column_price[i] = 0;
        a->column_distance[i] = DISTANCE_NONE;
    }
}

enum rho_status rho_assignment_init(struct rho_assignment *assignment, size_t object_size)
{
    if (object_size != sizeof *assignment) {
        return RHO_ERROR_SIZE;
    }
    memset(assignment, 0, sizeof *assignment);
    assignment->magic = ASSIGNMENT_MAGIC;
    return RHO_OK;
}

enum rho_status rho_assignment_begin(struct rho_assignment *assignment, unsigned num_rows,
                                     unsigned num_columns)
{
    if (num_rows > RHO_MAX_TRACKS || num_columns > RHO_MAX_PLOTS) {
        return RHO_ERROR_CAPACITY;
    }
    assignment->num_rows = (uint16_t)num_rows;
    assignment->num_columns = (uint16_t)num_columns;
    assignment->pairs_dropped = 0;
    memset(assignment->num_pairs, 0, num_rows * sizeof assignment->num_pairs[0]);
    clear_answer(assignment);
    return RHO_OK;
}

enum rho_status rho_assignment_offer_pair(struct rho_assignment *assignment, unsigned row,
                                          unsigned column, int32_t cost)
{
    const struct rho_assignment_pair pair = {.cost = cost, .column = (int16_t)column};
    if (row >= assignment->num_rows || column >= assignment->num_columns ||
        cost < -RHO_ASSIGNMENT_COST_MAX || cost > RHO_ASSIGNMENT_COST_MAX) {
        return RHO_ERROR_VALUE;
    }
    uint16_t *num_pairs = &assignment->num_pairs[row];
    if (pair_index(assignment, (int)row, (int)column) < *num_pairs) {
        return RHO_ERROR_VALUE;
    }
    if (cost >= 0) {
        return RHO_OK;
    }
    if (*num_pairs < RHO_MAX_GATE_PLOTS) {
        assignment->pairs[row][(*num_pairs)++] = pair;
        return RHO_OK;
    }
    struct rho_assignment_pair *costliest = assignment->pairs[row];
    for (int i = 1; i < RHO_MAX_GATE_PLOTS; ++i) {
        if (is_costlier(&assignment->pairs[row][i], costliest)) {
            costliest = &assignment->pairs[row][i];
        }
    }
    if (is_costlier(costliest, &pair)) {
        *costliest = pair;
    }
    assignment->pairs_dropped = rho_count(assignment->pairs_dropped, 1);
    return RHO_OK;
}

void rho_assignment_solve(struct rho_assignment *assignment)
{
    clear_answer(assignment);
    for (int row = 0; row < assignment->num_rows; ++row) {
        struct search s = {.end_distance = DISTANCE_NONE, .end_column = RHO_ASSIGNMENT_NONE};
        find_path_end(assignment, &s, row);
        /* prices of scanned columns keep the reduced costs of their rows at 0 at least */
        for (int i = 0; i < s.num_labelled; ++i) {
            const int16_t column = assignment->column_queue[i];
            if (i < s.num_scanned) {
                assignment->column_price[column] +=
                    assignment->column_distance[column] - s.end_distance;
            }
            assignment->column_distance[column] = DISTANCE_NONE;
        }
        augment_path(assignment, &s, row);
    }
}

int rho_assignment_column(const struct rho_assignment *assignment, unsigned row)
{
    return row < assignment->num_rows ? assignment->row_column[row] : RHO_ASSIGNMENT_NONE;
}

void rho_assignment_move_pairs(struct rho_assignment *assignment, unsigned from_row,
                               unsigned to_row)
{
    if (from_row == to_row || from_row >= assignment->num_rows || to_row >= assignment->num_rows) {
        return;
    }
    for (unsigned i = 0; i < assignment->num_pairs[from_row]; i++) {
        assignment->pairs[to_row][i] = assignment->pairs[from_row][i];
    }
    assignment->num_pairs[to_row] = assignment->num_pairs[from_row];
    assignment->num_pairs[from_row] = 0;
}
