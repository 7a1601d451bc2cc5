/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/assignment.h"

#include <string.h>

#define ASSIGNMENT_MAGIC 0x41534e31u /* "ASN1" */
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
    return assignment != NULL && assignment->magic == ASSIGNMENT_MAGIC;
}

/* True where `one` has the higher cost; of equal costs, where it has the higher column. */
static int is_costlier(const struct rho_assignment_pair *one,
                       const struct rho_assignment_pair *other)
{
    return one->cost > other->cost || (one->cost == other->cost && one->column > other->column);
}

/* Index of a column among a row's pairs, or the number of pairs where the row does not hold it. */
static int pair_index_or_num_pairs(const struct rho_assignment *a, int row, int column)
{
    const int num_pairs = a->num_pairs[row];
    int i;
    for (i = 0; i < num_pairs; ++i) {
        if (a->pairs[row][i].column == column) {
            break;
        }
    }
    return i;
}

/* Index of the costliest of the RHO_MAX_GATE_PLOTS pairs of a full row. */
static int costliest_pair_of_full_row(const struct rho_assignment_pair *pairs)
{
    int i, costliest = 0;
    for (i = 1; i < RHO_MAX_GATE_PLOTS; ++i) {
        if (is_costlier(&pairs[i], &pairs[costliest])) {
            costliest = i;
        }
    }
    return costliest;
}

/* Drops the costliest of a full row's pairs and the new pair, and counts it. */
static void keep_cheapest_count_dropped(struct rho_assignment *a, int row,
                                        struct rho_assignment_pair pair)
{
    struct rho_assignment_pair *costliest =
        &a->pairs[row][costliest_pair_of_full_row(a->pairs[row])];
    if (is_costlier(costliest, &pair)) {
        *costliest = pair;
    }
    if (a->pairs_dropped < UINT32_MAX) {
        ++a->pairs_dropped;
    }
}

/* Sets a column's distance and the row it was reached from; a new column joins the queue. */
static void label_and_queue_column(struct rho_assignment *a, struct search *s, int column,
                                   int from_row, int32_t distance)
{
    if (a->column_distance[column] == DISTANCE_NONE) {
        a->column_queue[s->num_labelled++] = (int16_t)column;
    }
    a->column_distance[column] = distance;
    a->column_from[column] = (int16_t)from_row;
}

/*
 * Labels the columns that can be reached from a row with their distances, and the row as an end
 * that gives up its column. price_less_distance: the row's price less its distance.
 */
static void label_columns_of_row_and_offer_path_end(struct rho_assignment *a, struct search *s,
                                                    int row, int32_t price_less_distance)
{
    const int num_pairs = a->num_pairs[row];
    int i;
    if (-price_less_distance < s->end_distance) {
        s->end_distance = -price_less_distance;
        s->end_row = (int16_t)row;
    }
    for (i = 0; i < num_pairs; ++i) {
        const int column = a->pairs[row][i].column;
        const int32_t distance =
            a->pairs[row][i].cost - a->column_price[column] - price_less_distance;
        /* Columns at least as far as the end never become part of the path. */
        if (distance < a->column_distance[column] && distance < s->end_distance) {
            label_and_queue_column(a, s, column, row, distance);
        }
    }
}

/*
 * Moves the nearest of the labelled columns that were not scanned, of equals the lowest, to the
 * head of the queue's unscanned part. Returns 0 if none is nearer than the end.
 */
static int try_move_nearest_unscanned_to_queue_head(struct rho_assignment *a,
                                                    const struct search *s)
{
    int16_t *queue = a->column_queue;
    int32_t least = s->end_distance;
    int i, nearest = -1;
    int16_t column;
    for (i = s->num_scanned; i < s->num_labelled; ++i) {
        const int32_t distance = a->column_distance[queue[i]];
        if (distance < least || (nearest >= 0 && distance == least && queue[i] < queue[nearest])) {
            least = distance;
            nearest = i;
        }
    }
    if (nearest < 0) {
        return 0;
    }
    column = queue[nearest];
    queue[nearest] = queue[s->num_scanned];
    queue[s->num_scanned] = column;
    return 1;
}

/*
 * Finds the end of the shortest augmenting path from a row: s->end_column, or where that is NONE,
 * s->end_row, which gives up its column.
 */
static void find_shortest_path_end(struct rho_assignment *a, struct search *s, int row)
{
    label_columns_of_row_and_offer_path_end(a, s, row, 0);
    /* at most num_columns times: each column is scanned once */
    while (try_move_nearest_unscanned_to_queue_head(a, s)) {
        const int16_t column = a->column_queue[s->num_scanned];
        const int16_t owner = a->column_row[column];
        int32_t price;
        if (owner == RHO_ASSIGNMENT_NONE) {
            s->end_column = column;
            s->end_distance = a->column_distance[column];
            return;
        }
        ++s->num_scanned;
        price = a->pairs[owner][pair_index_or_num_pairs(a, owner, column)].cost -
                a->column_price[column];
        label_columns_of_row_and_offer_path_end(a, s, owner, price - a->column_distance[column]);
    }
}

/*
 * Updates the prices of scanned columns so that the reduced costs of their rows stay at least 0,
 * and clears all labels.
 */
static void update_prices_and_clear_labels(struct rho_assignment *a, const struct search *s)
{
    int i;
    for (i = 0; i < s->num_labelled; ++i) {
        const int16_t column = a->column_queue[i];
        if (i < s->num_scanned) {
            a->column_price[column] += a->column_distance[column] - s->end_distance;
        }
        a->column_distance[column] = DISTANCE_NONE;
    }
}

/*
 * Walks back along the path from its end to the row that was searched for: each row takes the
 * column that was reached from it.
 */
static void augment_along_path(struct rho_assignment *a, const struct search *s, int first_row)
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

static void clear_answer_and_prices(struct rho_assignment *a)
{
    int i;
    for (i = 0; i < a->num_rows; ++i) {
        a->row_column[i] = RHO_ASSIGNMENT_NONE;
    }
    for (i = 0; i < a->num_columns; ++i) {
        a->column_row[i] = RHO_ASSIGNMENT_NONE;
        a->column_price[i] = 0;
        a->column_distance[i] = DISTANCE_NONE;
    }
}

enum rho_status rho_assignment_init(struct rho_assignment *assignment, size_t object_size)
{
    if (assignment == NULL) {
        return RHO_ERROR_NULL;
    }
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
    if (assignment == NULL) {
        return RHO_ERROR_NULL;
    }
    if (!rho_assignment_is_ready(assignment)) {
        return RHO_ERROR_STATE;
    }
    if (num_rows > RHO_MAX_TRACKS || num_columns > RHO_MAX_PLOTS) {
        return RHO_ERROR_CAPACITY;
    }
    assignment->num_rows = (uint16_t)num_rows;
    assignment->num_columns = (uint16_t)num_columns;
    assignment->pairs_dropped = 0;
    memset(assignment->num_pairs, 0, num_rows * sizeof assignment->num_pairs[0]);
    clear_answer_and_prices(assignment);
    return RHO_OK;
}

enum rho_status rho_assignment_offer_pair(struct rho_assignment *assignment, unsigned row,
                                          unsigned column, int32_t cost)
{
    const struct rho_assignment_pair pair = {.cost = cost, .column = (int16_t)column};
    uint16_t *num_pairs;
    if (assignment == NULL) {
        return RHO_ERROR_NULL;
    }
    if (!rho_assignment_is_ready(assignment)) {
        return RHO_ERROR_STATE;
    }
    if (row >= assignment->num_rows || column >= assignment->num_columns ||
        cost < -RHO_ASSIGNMENT_COST_MAX || cost > RHO_ASSIGNMENT_COST_MAX) {
        return RHO_ERROR_VALUE;
    }
    num_pairs = &assignment->num_pairs[row];
    if (pair_index_or_num_pairs(assignment, (int)row, (int)column) < *num_pairs) {
        return RHO_ERROR_VALUE;
    }
    if (cost >= 0) {
        return RHO_OK;
    }
    if (*num_pairs < RHO_MAX_GATE_PLOTS) {
        assignment->pairs[row][(*num_pairs)++] = pair;
    } else {
        keep_cheapest_count_dropped(assignment, (int)row, pair);
    }
    return RHO_OK;
}

void rho_assignment_solve(struct rho_assignment *assignment)
{
    int row;
    if (!rho_assignment_is_ready(assignment)) {
        return;
    }
    clear_answer_and_prices(assignment);
    for (row = 0; row < assignment->num_rows; ++row) {
        struct search s = {.end_distance = DISTANCE_NONE, .end_column = RHO_ASSIGNMENT_NONE};
        find_shortest_path_end(assignment, &s, row);
        update_prices_and_clear_labels(assignment, &s);
        augment_along_path(assignment, &s, row);
    }
}

int rho_assignment_column(const struct rho_assignment *assignment, unsigned row)
{
    if (!rho_assignment_is_ready(assignment) || row >= assignment->num_rows) {
        return RHO_ASSIGNMENT_NONE;
    }
    return assignment->row_column[row];
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
