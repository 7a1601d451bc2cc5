/* SPDX-License-Identifier: MIT */
/*
 * row_votes: votes and peaks in a row with many points. A template, included twice, with CELL an
 * unsigned type and NAME(f) adding its suffix to f. gcc -O3 vectorises these hot loops as they are
 * written.
 */

/* Votes of one scan: sets its bit in its points' cells. */
static void NAME(vote_scan)(CELL *restrict row, const int32_t *restrict cells, unsigned n,
                            unsigned scan)
{
    const CELL bit = (CELL)(1u << scan);
    for (unsigned i = 0; i < n; i++) {
        row[(uint32_t)cells[i]] |= bit;
    }
}

/* Counts a vote for each point's cell, up to the largest count that a cell holds. */
static void NAME(vote_points)(CELL *restrict row, const int32_t *restrict cells, unsigned n)
{
    for (unsigned i = 0; i < n; i++) {
        CELL before = row[(uint32_t)cells[i]];
        row[(uint32_t)cells[i]] = (CELL)(before + (before != (CELL)~0u));
    }
}

/* Number of scans in a cell's mask of scans. */
static CELL NAME(count_scans)(CELL mask)
{
    CELL v = (CELL)(mask - ((mask >> 1) & (CELL)0x5555u));
    v = (CELL)((v & (CELL)0x3333u) + ((v >> 2) & (CELL)0x3333u));
    v = (CELL)((v + (v >> 4)) & (CELL)0x0f0fu);
    return (CELL)(sizeof(CELL) > 1 ? (v + (v >> 8)) & (CELL)0x1fu : v);
}

static CELL NAME(votes_of_cell)(const struct rho_accumulator_pass *pass, CELL cell)
{
    return pass->counts_points ? cell : NAME(count_scans)(cell);
}

/* Lists a cell as a peak, or notes its votes in the plane, if it has min_votes. */
static void NAME(offer_cell)(struct rho_accumulator_pass *pass, unsigned cell)
{
    const CELL value = ((const CELL *)pass->accumulator->row)[cell];
    const unsigned votes = NAME(votes_of_cell)(pass, value);
    if (votes >= pass->list.min_votes) {
        note_votes(pass, cell, votes, value);
    }
}

/* False where none of the cells of a block has min_votes. */
static int NAME(may_have_peak)(const struct rho_accumulator_pass *pass, const CELL *block)
{
    CELL most = 0;
    for (unsigned i = 0; i < BLOCK; i++) {
        CELL votes = NAME(votes_of_cell)(pass, block[i]);
        most = votes > most ? votes : most;
    }
    return most >= pass->list.min_votes;
}

/* Lists the peaks of a row, block by block; cells behind the last one are 0. */
static void NAME(find_row_peaks)(struct rho_accumulator_pass *pass)
{
    CELL *row = (CELL *)pass->accumulator->row;
    const unsigned last = pass->accumulator->rho_cells;
    row[0] = row[last + 1u] = 0;
    for (unsigned first = 1; first <= last; first += BLOCK) {
        if (NAME(may_have_peak)(pass, row + first)) {
            for (unsigned i = first; i < first + BLOCK; i++) {
                NAME(offer_cell)(pass, i);
            }
        }
    }
}
