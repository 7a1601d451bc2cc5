/* SPDX-License-Identifier: MIT */
/* accumulator_rows: votes of the points in each row of theta, and the peaks of the row. */
#include <string.h>

#include "accumulator_search.h"
#include "policy.h"
#include "rhotrack/types.h"

#define BLOCK 64 /* cells of a dense row that are tested together; RHO_ACCUMULATOR_PADDING fits */
/* cells of a block and its neighbours on both sides, in whole vector registers */
#define AROUND (BLOCK + 16)

static const uint8_t bits_of_byte[256] = {
#define TWO(n) (n), (n) + 1, (n) + 1, (n) + 2
#define FOUR(n) TWO(n), TWO((n) + 1), TWO((n) + 1), TWO((n) + 2)
#define SIX(n) FOUR(n), FOUR((n) + 1), FOUR((n) + 1), FOUR((n) + 2)
    SIX(0), SIX(1), SIX(1), SIX(2)};

static void add_peak(struct rho_accumulator_pass *pass, unsigned cell, unsigned votes,
                     unsigned mask)
{
    struct rho_accumulator_peak peak = {.votes = votes,
                                        .theta_cell = (uint16_t)pass->middle_theta_cell,
                                        .rho_cell = (uint16_t)(cell - 1u),
                                        .mask = pass->counts_points ? 0u : mask};
    rho_peak_list_offer(&pass->list, peak);
}

/* Calls a function of row_votes.h for the width of the pass' cells. */
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

/*
 * Computes the cells of points from .. from + n - 1, which are of the scans in the mask `scans`.
 * Points outside the plane are not added to pass->votes.
 */
static void project_counting_votes(struct rho_accumulator_pass *pass, unsigned scans, unsigned from,
                                   unsigned n, struct rho_accumulator_projection place,
                                   int32_t *cells)
{
    const float *x_m = pass->points->x_m + from, *y_m = pass->points->y_m + from;
    unsigned outside = 0;
    if (pass->scans_outside & scans) {
        float last = (float)(pass->accumulator->rho_cells + 1u);
        outside = rho_accumulator_clamp_cells(x_m, y_m, n, place, last, cells);
    } else {
        rho_accumulator_project(x_m, y_m, n, place, cells);
    }
    pass->votes = rho_count(pass->votes, n - outside);
}

/* Votes of one scan. Lists the cells that reach min_votes by them, and returns their number. */
static unsigned vote_in_sparse_row(const struct rho_accumulator_pass *pass, void *row,
                                   const int32_t *cells, unsigned n, unsigned scan,
                                   uint16_t *reached)
{
    unsigned bit = pass->counts_points ? 0u : 1u << scan;
    if (bit && scan + 1u < pass->list.min_votes) {
        /* the scans up to this one are too few to reach min_votes */
        if (pass->is_narrow) {
            vote_scan_narrow(row, cells, n, (uint8_t)bit);
        } else {
            vote_scan_wide(row, cells, n, (uint16_t)bit);
        }
        return 0;
    }
    return pass->is_narrow ? vote_reaching_narrow(pass, row, cells, n, (uint8_t)bit, reached)
                           : vote_reaching_wide(pass, row, cells, n, (uint16_t)bit, reached);
}

static void vote_in_dense_row(const struct rho_accumulator_pass *pass, void *row,
                              const int32_t *cells, unsigned n, unsigned scan)
{
    void *apart = pass->accumulator->room.scan;
    unsigned num_cells = pass->accumulator->rho_cells + RHO_ACCUMULATOR_PADDING;
    int is_crowded = n * CROWDED > num_cells;
    if (pass->counts_points) {
        BY_WIDTH(vote_points, row, cells, n);
    } else if (pass->is_narrow && is_crowded) {
        vote_scan_via_scratch_narrow(row, apart, num_cells, cells, n, (uint8_t)(1u << scan));
    } else if (pass->is_narrow) {
        vote_scan_narrow(row, cells, n, (uint8_t)(1u << scan));
    } else if (is_crowded) {
        vote_scan_via_scratch_wide(row, apart, num_cells, cells, n, (uint16_t)(1u << scan));
    } else {
        vote_scan_wide(row, cells, n, (uint16_t)(1u << scan));
    }
}

void rho_accumulator_clear_row(struct rho_accumulator_pass *pass, unsigned slot)
{
    struct rho_accumulator *accumulator = pass->accumulator;
    const int32_t *cells = accumulator->touched[slot];
    void *row = accumulator->rows[slot];
    for (unsigned i = 0; i < accumulator->num_touched[slot]; i++) {
        if (pass->is_narrow) {
            ((uint8_t *)row)[cells[i]] = 0;
        } else {
            ((uint16_t *)row)[cells[i]] = 0;
        }
    }
    accumulator->num_touched[slot] = accumulator->num_reached[slot] = 0;
}

void rho_accumulator_fill_kept(struct rho_accumulator_pass *pass, unsigned slot,
                               unsigned theta_cell, unsigned num_kept)
{
    struct rho_accumulator *accumulator = pass->accumulator;
    int32_t *cells = accumulator->touched[slot];
    const uint16_t *bits = accumulator->room.few.bits;
    void *row = accumulator->rows[slot];
    uint16_t *reached = accumulator->reached[slot];
    rho_accumulator_clear_row(pass, slot);
    rho_accumulator_project(accumulator->room.few.x_m, accumulator->room.few.y_m, num_kept,
                            rho_accumulator_projection(accumulator, theta_cell), cells);
    unsigned num_reached = BY_WIDTH(vote_kept_reaching, pass, row, cells, bits, num_kept, reached);
    accumulator->num_touched[slot] = (uint16_t)num_kept;
    accumulator->num_reached[slot] = (uint16_t)num_reached;
}

void rho_accumulator_fill_row(struct rho_accumulator_pass *pass, unsigned slot, unsigned theta_cell,
                              int is_rho_reversed)
{
    struct rho_accumulator *accumulator = pass->accumulator;
    struct rho_accumulator_projection place = rho_accumulator_projection(accumulator, theta_cell);
    /* dense rows have no list of touched cells: one of them is their scratch */
    int32_t *cells = accumulator->touched[pass->is_sparse ? slot : 0];
    void *row = accumulator->rows[slot];
    unsigned num_cells = accumulator->rho_cells, num_reached = 0;
    uint32_t votes = pass->votes;
    if (pass->is_sparse) {
        rho_accumulator_clear_row(pass, slot);
        project_counting_votes(pass, ~0u, 0, pass->num_points, place, cells);
    } else {
        memset(row, 0, (num_cells + RHO_ACCUMULATOR_PADDING) * (pass->is_narrow ? 1u : 2u));
    }
    for (unsigned scan = 0, from = 0; scan < pass->points->num_scans; scan++) {
        unsigned end = pass->points->scan_end[scan], n = end - from;
        if (pass->is_sparse) {
            num_reached += vote_in_sparse_row(pass, row, cells + from, n, scan,
                                              accumulator->reached[slot] + num_reached);
            from = end;
        }
        for (; from < end; from += n) {
            n = end - from < RHO_ACCUMULATOR_SPARSE_MAX ? end - from : RHO_ACCUMULATOR_SPARSE_MAX;
            project_counting_votes(pass, 1u << scan, from, n, place, cells);
            vote_in_dense_row(pass, row, cells, n, scan);
        }
    }
    if (pass->is_sparse) {
        accumulator->num_touched[slot] = (uint16_t)pass->num_points;
        accumulator->num_reached[slot] = (uint16_t)num_reached;
    }
    /* guard cells must never exceed their neighbours */
    if (pass->is_narrow) {
        ((uint8_t *)row)[0] = ((uint8_t *)row)[num_cells + 1u] = 0;
    } else {
        ((uint16_t *)row)[0] = ((uint16_t *)row)[num_cells + 1u] = 0;
    }
    if (!is_rho_reversed) {
        return;
    }
    pass->votes = votes; /* a reversed row is filled a second time, and its votes count once */
    BY_WIDTH(reverse_row, row, num_cells);
    for (unsigned i = 0; pass->is_sparse && i < pass->num_points; i++) {
        cells[i] = (int32_t)num_cells + 1 - cells[i];
    }
}

void rho_accumulator_find_row_peaks(struct rho_accumulator_pass *pass, unsigned theta_cell)
{
    const struct rho_accumulator *accumulator = pass->accumulator;
    unsigned slot = theta_cell % 3u;
    for (unsigned i = 0; i < 3; i++) {
        pass->rows[i] = accumulator->rows[(slot + 2u + i) % 3u];
    }
    pass->middle_theta_cell = theta_cell;
    pass->above_is_first = theta_cell > 0;
    pass->below_is_first = theta_cell + 1u == accumulator->theta_cells;
    if (pass->is_sparse) {
        BY_WIDTH(find_peaks_in_reached, pass, accumulator->reached[slot],
                 accumulator->num_reached[slot]);
    } else {
        BY_WIDTH(find_dense_row_peaks, pass);
    }
}

/*
 * Fills each row and searches the row before it; before row 0 comes the last row, reversed, and
 * after the last row comes row 0, reversed.
 */
void rho_accumulator_search_rows(struct rho_accumulator_pass *pass)
{
    unsigned last = pass->accumulator->theta_cells - 1u;
    rho_accumulator_fill_row(pass, 2, last, 1);
    rho_accumulator_fill_row(pass, 0, 0, 0);
    for (unsigned theta_cell = 0; theta_cell <= last; theta_cell++) {
        int is_end = theta_cell == last;
        rho_accumulator_fill_row(pass, (theta_cell + 1u) % 3u, is_end ? 0u : theta_cell + 1u,
                                 is_end);
        rho_accumulator_find_row_peaks(pass, theta_cell);
    }
}
