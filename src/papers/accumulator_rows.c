/* SPDX-License-Identifier: MIT */
/* accumulator_rows: votes of the points in a row of theta, and the peaks of the row. */
#include <string.h>

#include "accumulator_search.h"

#define BLOCK 64 /* cells of a row that are tested together; RHO_ACCUMULATOR_PADDING fits */

static void note_votes(struct rho_accumulator_pass *pass, unsigned cell, unsigned votes,
                       unsigned mask)
{
    if (pass->plane) {
        rho_votes_picture_enter_cell(pass->plane, pass->theta_cell, cell - 1u, votes);
        return;
    }
    rho_peak_list_offer(&pass->list,
                        (struct rho_accumulator_peak){.votes = votes,
                                                      .theta_cell = (uint16_t)pass->theta_cell,
                                                      .rho_cell = (uint16_t)(cell - 1u),
                                                      .mask = pass->counts_points ? 0u : mask});
}

/*
 * Calls a function of row_votes.h for the width of the pass' cells: narrow ones of 8 bits hold 8
 * scans, or 255 points.
 */
#define BY_WIDTH(f, ...) (pass->is_narrow ? f##_narrow(__VA_ARGS__) : f##_wide(__VA_ARGS__))

#define CELL uint8_t
#define NAME(f) f##_narrow
#include "row_votes.h"
#undef CELL
#undef NAME
#define CELL uint16_t
#define NAME(f) f##_wide
#include "row_votes.h"
#undef CELL
#undef NAME

static void begin_row(struct rho_accumulator_pass *pass, unsigned theta_cell)
{
    pass->theta_cell = theta_cell;
    pass->place = rho_accumulator_projection(pass->accumulator, theta_cell);
}

/* Computes the cells of n points; those outside the plane are counted, and get guard cells. */
static void project_points(struct rho_accumulator_pass *pass, const float *x_m, const float *y_m,
                           unsigned n)
{
    int32_t *cells = pass->accumulator->cells;
    if (pass->has_outside) {
        float last = (float)(pass->accumulator->rho_cells + 1u);
        pass->outside += rho_accumulator_clamp_cells(x_m, y_m, n, pass->place, last, cells);
    } else {
        rho_accumulator_project(x_m, y_m, n, pass->place, cells);
    }
}

void rho_accumulator_vote_few(struct rho_accumulator_pass *pass, unsigned theta_cell, unsigned n)
{
    struct rho_accumulator *accumulator = pass->accumulator;
    uint16_t *row = accumulator->row, *reached = accumulator->few.reached;
    const int32_t *cells = accumulator->cells;
    unsigned num_reached = 0;
    begin_row(pass, theta_cell);
    project_points(pass, accumulator->few.x_m, accumulator->few.y_m, n);
    for (unsigned i = 0; i < n; i++) {
        const uint16_t before = row[cells[i]];
        const uint16_t after =
            (uint16_t)(pass->counts_points ? before + 1u : before | accumulator->few.bits[i]);
        row[cells[i]] = after;
        reached[num_reached] = (uint16_t)cells[i];
        num_reached += after != before && votes_of_cell_wide(pass, after) == pass->list.min_votes;
    }
    row[0] = row[accumulator->rho_cells + 1u] = 0;
    for (unsigned i = 0; i < num_reached; i++) {
        offer_cell_wide(pass, reached[i]);
    }
    for (unsigned i = 0; i < n; i++) {
        row[cells[i]] = 0;
    }
}

void rho_accumulator_vote_all(struct rho_accumulator_pass *pass, unsigned theta_cell)
{
    const struct rho_accumulator_points *points = pass->points;
    void *row = pass->accumulator->row;
    const int32_t *cells = pass->accumulator->cells;
    begin_row(pass, theta_cell);
    memset(row, 0,
           (pass->accumulator->rho_cells + RHO_ACCUMULATOR_PADDING) * (pass->is_narrow ? 1u : 2u));
    for (unsigned scan = 0, from = 0; scan < points->num_scans; scan++) {
        for (unsigned n = 0; from < points->scan_end[scan]; from += n) {
            n = points->scan_end[scan] - from;
            n = n < RHO_ACCUMULATOR_SPARSE_MAX ? n : RHO_ACCUMULATOR_SPARSE_MAX;
            project_points(pass, points->x_m + from, points->y_m + from, n);
            if (pass->counts_points) {
                BY_WIDTH(vote_points, row, cells, n);
            } else {
                BY_WIDTH(vote_scan, row, cells, n, scan);
            }
        }
    }
    BY_WIDTH(find_row_peaks, pass);
}
