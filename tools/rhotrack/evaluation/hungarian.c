/* SPDX-License-Identifier: MIT */
#include "evaluation/hungarian.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/common.h"

/*
 * Shortest augmenting paths with potentials (Hungarian method) for rows <= columns; rows and
 * columns count from 1, 0 stands for none.
 */
struct assignment {
    size_t rows, columns;
    const double *cost; /* cost matrix, rows x columns */
    double *row_potential, *column_potential, *slack;
    /* for each column: its row, and the column before it on the shortest path */
    size_t *row_of, *from;
    bool *is_done;
};

static double reduced_cost(const struct assignment *a, size_t row, size_t column)
{
    return a->cost[(row - 1) * a->columns + column - 1] - a->row_potential[row] -
           a->column_potential[column];
}

/*
 * Extends the search from the row of `column`: returns the column not yet done that is reached at
 * least reduced cost, and in step that cost.
 */
static size_t find_nearest_column(struct assignment *a, size_t column, double *step)
{
    size_t nearest = 0;
    *step = INFINITY;
    for (size_t j = 1; j <= a->columns; j++) {
        if (a->is_done[j]) {
            continue;
        }
        double reduced = reduced_cost(a, a->row_of[column], j);
        if (reduced < a->slack[j]) {
            a->slack[j] = reduced;
            a->from[j] = column;
        }
        if (a->slack[j] < *step) {
            *step = a->slack[j];
            nearest = j;
        }
    }
    return nearest;
}

static void update_potentials(struct assignment *a, double step)
{
    for (size_t j = 0; j <= a->columns; j++) {
        if (a->is_done[j]) {
            a->row_potential[a->row_of[j]] += step;
            a->column_potential[j] -= step;
        } else {
            a->slack[j] -= step;
        }
    }
}

static void assign_row_by_shortest_path(struct assignment *a, size_t row)
{
    size_t column = 0;
    a->row_of[0] = row;
    for (size_t j = 0; j <= a->columns; j++) {
        a->slack[j] = INFINITY;
        a->is_done[j] = false;
    }
    do {
        double step;
        a->is_done[column] = true;
        size_t next = find_nearest_column(a, column, &step);
        update_potentials(a, step);
        column = next;
    } while (a->row_of[column] != 0);
    while (column != 0) {
        size_t before = a->from[column];
        a->row_of[column] = a->row_of[before];
        column = before;
    }
}

void hungarian_assign(size_t rows, size_t columns, const double *cost, size_t *column_of)
{
    struct assignment a = {
        .rows = rows,
        .columns = columns,
        .cost = cost,
        .row_potential = must_calloc(rows + 1, sizeof(double)),
        .column_potential = must_calloc(columns + 1, sizeof(double)),
        .slack = must_calloc(columns + 1, sizeof(double)),
        .row_of = must_calloc(columns + 1, sizeof(size_t)),
        .from = must_calloc(columns + 1, sizeof(size_t)),
        .is_done = must_calloc(columns + 1, sizeof(bool)),
    };
    for (size_t row = 1; row <= rows; row++) {
        assign_row_by_shortest_path(&a, row);
    }
    for (size_t j = 1; j <= columns; j++) {
        if (a.row_of[j] != 0) {
            column_of[a.row_of[j] - 1] = j - 1;
        }
    }
    free(a.row_potential);
    free(a.column_potential);
    free(a.slack);
    free(a.row_of);
    free(a.from);
    free(a.is_done);
}
