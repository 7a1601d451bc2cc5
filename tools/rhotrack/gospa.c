/* SPDX-License-Identifier: MIT */
#include "gospa.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "common.h"

/* ---- optimal assignment ----------------------------------------------------------------------- */

/*
 * Shortest augmenting paths with potentials (Hungarian method) for rows <= columns; rows and columns count from 1, 0
 * stands for none.
 */
struct assignment {
    size_t rows, columns;
    const double *cost; /* rows x columns */
    double *row_price, *column_price, *slack;
    size_t *row_of, *from; /* by column */
    bool *is_done;
};

static double reduced_cost(const struct assignment *a, size_t row, size_t column)
{
    return a->cost[(row - 1) * a->columns + column - 1] - a->row_price[row] -
           a->column_price[column];
}

/* Scans the columns from `column`'s row: the nearest one not done, and how far on. */
static size_t nearest_column(struct assignment *a, size_t column, double *step)
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

static void move_prices(struct assignment *a, double step)
{
    for (size_t j = 0; j <= a->columns; j++) {
        if (a->is_done[j]) {
            a->row_price[a->row_of[j]] += step;
            a->column_price[j] -= step;
        } else {
            a->slack[j] -= step;
        }
    }
}

static void assign_row(struct assignment *a, size_t row)
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
        size_t next = nearest_column(a, column, &step);
        move_prices(a, step);
        column = next;
    } while (a->row_of[column] != 0);
    while (column != 0) {
        size_t before = a->from[column];
        a->row_of[column] = a->row_of[before];
        column = before;
    }
}

/* column_of[row], both from 0. */
static void assign(size_t rows, size_t columns, const double *cost, size_t *column_of)
{
    struct assignment a = {
        .rows = rows,
        .columns = columns,
        .cost = cost,
        .row_price = must_calloc(rows + 1, sizeof(double)),
        .column_price = must_calloc(columns + 1, sizeof(double)),
        .slack = must_calloc(columns + 1, sizeof(double)),
        .row_of = must_calloc(columns + 1, sizeof(size_t)),
        .from = must_calloc(columns + 1, sizeof(size_t)),
        .is_done = must_calloc(columns + 1, sizeof(bool)),
    };
    for (size_t row = 1; row <= rows; row++) {
        assign_row(&a, row);
    }
    for (size_t j = 1; j <= columns; j++) {
        if (a.row_of[j] != 0) {
            column_of[a.row_of[j] - 1] = j - 1;
        }
    }
    free(a.row_price);
    free(a.column_price);
    free(a.slack);
    free(a.row_of);
    free(a.from);
    free(a.is_done);
}

/* ---- the metric ------------------------------------------------------------------------------- */

static double distance2(const struct gospa_place *a, const struct gospa_place *b)
{
    double dx = a->x_m - b->x_m, dy = a->y_m - b->y_m, dz = a->z_m - b->z_m;
    return dx * dx + dy * dy + dz * dz;
}

struct side {
    const struct gospa_place *places;
    size_t count;
};

/* Pairs the smaller side with the larger: partner_of[i of the smaller]. */
static void pair_sides(struct side few, struct side many, double cutoff2_m2, size_t *partner_of)
{
    double *cost = must_calloc(few.count * many.count, sizeof *cost);
    for (size_t i = 0; i < few.count; i++) {
        for (size_t j = 0; j < many.count; j++) {
            cost[i * many.count + j] = fmin(distance2(&few.places[i], &many.places[j]), cutoff2_m2);
        }
    }
    assign(few.count, many.count, cost, partner_of);
    free(cost);
}

static void count_pair(struct gospa *result, double squared_m2)
{
    result->pairs++;
    result->localisation_m2 += squared_m2;
}

static double ospa(const struct gospa *result, size_t num_targets, size_t num_tracks,
                   double cutoff2_m2)
{
    size_t larger = num_targets > num_tracks ? num_targets : num_tracks;
    double unpaired = (double)(larger - result->pairs) * cutoff2_m2;
    return larger == 0 ? 0.0 : sqrt((result->localisation_m2 + unpaired) / (double)larger);
}

struct gospa gospa_compare(const struct gospa_place *targets, size_t num_targets,
                           const struct gospa_place *tracks, size_t num_tracks, double cutoff_m,
                           int *track_of)
{
    struct gospa result = {0};
    struct side target_side = {targets, num_targets}, track_side = {tracks, num_tracks};
    bool targets_are_few = num_targets <= num_tracks;
    struct side few = targets_are_few ? target_side : track_side;
    struct side many = targets_are_few ? track_side : target_side;
    size_t *partner_of = must_calloc(few.count + 1, sizeof *partner_of);
    double cutoff2_m2 = cutoff_m * cutoff_m;

    for (size_t i = 0; track_of != NULL && i < num_targets; i++) {
        track_of[i] = -1;
    }
    if (few.count > 0) {
        pair_sides(few, many, cutoff2_m2, partner_of);
    }
    for (size_t i = 0; i < few.count; i++) {
        double squared_m2 = distance2(&few.places[i], &many.places[partner_of[i]]);
        if (squared_m2 >= cutoff2_m2) {
            continue;
        }
        count_pair(&result, squared_m2);
        if (track_of != NULL) {
            track_of[targets_are_few ? i : partner_of[i]] =
                (int)(targets_are_few ? partner_of[i] : i);
        }
    }
    free(partner_of);
    result.missed = num_targets - result.pairs;
    result.false_tracks = num_tracks - result.pairs;
    result.squared_m2 =
        result.localisation_m2 + 0.5 * cutoff2_m2 * (double)(result.missed + result.false_tracks);
    result.ospa_m = ospa(&result, num_targets, num_tracks, cutoff2_m2);
    return result;
}
