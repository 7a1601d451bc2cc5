/* SPDX-License-Identifier: MIT */
/*
 * passive_paper_view: shows intermediate results of the last search: ghost matrices, and planes of
 * votes. They are computed again from the batch, which is unchanged until the next frame.
 */
#include "passive_paper_search.h"

static int is_pair_of_search(const struct rho_passive_paper *paper,
                             const struct rho_passive_paper_pair *pair)
{
    struct rho_passive_paper_pair one;
    for (unsigned number = 0; rho_passive_paper_pair(paper, number, &one); number++) {
        if (one.a == pair->a && one.b == pair->b) {
            return 1;
        }
    }
    return 0;
}

enum rho_status rho_passive_paper_ghosts(const struct rho_passive_paper *paper,
                                         const struct rho_passive_paper_pair *pair, unsigned scan,
                                         struct rho_ghost_matrix *matrix)
{
    struct rho_passive_paper_search search = {.num_sensors = 0};
    struct rho_crossing_base base;
    if (!paper || !pair || !matrix) {
        return RHO_ERROR_NULL;
    }
    if (paper->magic != RHO_PASSIVE_PAPER_MAGIC) {
        return RHO_ERROR_STATE;
    }
    if (scan >= paper->batch.num_scans || !is_pair_of_search(paper, pair)) {
        return RHO_ERROR_VALUE;
    }
    rho_passive_paper_list_sensors(&paper->batch, &search);
    return rho_passive_paper_fill_ghosts(paper, &search, *pair, scan, &base, matrix)
               ? RHO_OK
               : RHO_ERROR_VALUE;
}

enum rho_status rho_passive_paper_space(const struct rho_passive_paper *paper,
                                        struct rho_passive_paper_space *space)
{
    struct rho_passive_paper_search search = {.num_sensors = 0};
    if (!paper || !space) {
        return RHO_ERROR_NULL;
    }
    if (paper->magic == RHO_PASSIVE_PAPER_MAGIC) {
        rho_passive_paper_list_sensors(&paper->batch, &search);
    }
    if (search.num_sensors == 0) {
        return RHO_ERROR_STATE;
    }
    *space = (struct rho_passive_paper_space){
        .origin_x_m = search.middle_x_m,
        .origin_y_m = search.middle_y_m,
        .rho_max_m = 0.5f * paper->config.rho_cell_m * (float)RHO_PAPER_RHO_CELLS,
        .theta_cells = (uint16_t)rho_passive_paper_theta_rows(&paper->config),
        .rho_cells = RHO_PAPER_RHO_CELLS};
    return RHO_OK;
}

/* Prepares a search. STATE: the batch has too few scans or sensors; VALUE: no such pair. */
static enum rho_status prepare_search(struct rho_passive_paper *paper,
                                      const struct rho_passive_paper_pair *pair,
                                      struct rho_passive_paper_search *search)
{
    if (paper->magic != RHO_PASSIVE_PAPER_MAGIC || !rho_passive_paper_begin(paper, search)) {
        return RHO_ERROR_STATE;
    }
    return !pair || is_pair_of_search(paper, pair) ? RHO_OK : RHO_ERROR_VALUE;
}

enum rho_status rho_passive_paper_plane(struct rho_passive_paper *paper,
                                        const struct rho_passive_paper_pair *pair,
                                        struct rho_votes_picture *plane)
{
    struct rho_passive_paper_search search;
    if (!paper) {
        return RHO_ERROR_NULL;
    }
    enum rho_status status = prepare_search(paper, pair, &search);
    if (status == RHO_OK) {
        status = rho_votes_picture_init(plane, (unsigned)search.rows, RHO_PAPER_RHO_CELLS);
    }
    if (status != RHO_OK) {
        return status;
    }
    const struct rho_passive_paper_work work = paper->work;
    if (pair) {
        rho_passive_paper_cross(&search, *pair);
    } else {
        rho_passive_paper_vote_pairs(&search);
        paper->work = work;
    }
    for (int row = 0; row < search.rows; row++) {
        /* the sums of all pairs count from 1, as 0 is a cell that is not confirmed */
        const uint8_t *votes = pair ? paper->rows[0] : paper->cells[row];
        if (pair) {
            rho_passive_paper_count_row(&search, row, paper->rows[0]);
        }
        for (int column = 0; column < RHO_PAPER_RHO_CELLS; column++) {
            unsigned least = pair ? 0u : 1u;
            if (votes[column] > least) {
                rho_votes_picture_enter_cell(plane, (unsigned)row, (unsigned)column,
                                             votes[column] - least);
            }
        }
    }
    return RHO_OK;
}

enum rho_status rho_passive_paper_cells(struct rho_passive_paper *paper,
                                        const struct rho_passive_paper_pair *pair,
                                        struct rho_accumulator_peak *peaks, uint32_t max_peaks,
                                        uint32_t *num_peaks)
{
    struct rho_passive_paper_search search;
    if (!paper || !pair || !peaks || !num_peaks) {
        return RHO_ERROR_NULL;
    }
    const enum rho_status status = prepare_search(paper, pair, &search);
    if (status != RHO_OK) {
        return status;
    }
    uint8_t *counts = paper->rows[0];
    rho_passive_paper_cross(&search, *pair);
    for (int row = 0; row < search.rows; row++) {
        rho_passive_paper_count_row(&search, row, counts);
        for (int column = 0; column < RHO_PAPER_RHO_CELLS; column++) {
            paper->cells[row][column] = counts[column] >= paper->votes_min ? counts[column] : 0;
        }
    }
    search.near = 0; /* neighbours confirm cells of all pairs only */
    *num_peaks = 0;
    while (*num_peaks < max_peaks && rho_passive_paper_take_peak(&search, &peaks[*num_peaks]) > 0) {
        ++*num_peaks;
    }
    return RHO_OK;
}
