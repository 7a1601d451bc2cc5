/* SPDX-License-Identifier: MIT */
/*
 * Rows of the accumulator in cells of one size: included twice by accumulator.c, with CELL an unsigned type and NAME(f)
 * the functions' names. The hot loops stand here; they want -O3, and nothing that keeps a compiler from vector code.
 */

/* Votes of scan `bit` (0: of points) where few points vote: notes what was touched, and what reached min_votes. */
static void NAME(vote_few)(struct pass *pass, CELL *row, const int32_t *cells, unsigned n, CELL bit)
{
    uint16_t *touched = pass->touched + pass->num_touched, *reached = pass->reached;
    unsigned num_reached = pass->num_reached;
    for (unsigned i = 0; i < n; i++) {
        CELL before = row[cells[i]];
        CELL after = (CELL)(bit ? before | bit : before + 1u);
        row[cells[i]] = after;
        touched[i] = (uint16_t)cells[i];
        reached[num_reached] = (uint16_t)cells[i];
        num_reached += after != before && NAME(votes)(pass, after) == pass->min_votes;
    }
    pass->num_touched += n;
    pass->num_reached = num_reached;
}

static void NAME(vote_scan)(CELL *restrict row, const int32_t *restrict cells, unsigned n, CELL bit)
{
    for (unsigned i = 0; i < n; i++) {
        row[cells[i]] |= bit;
    }
}

static void NAME(vote_points)(CELL *restrict row, const int32_t *restrict cells, unsigned n)
{
    for (unsigned i = 0; i < n; i++) {
        CELL before = row[cells[i]];
        row[cells[i]] = (CELL)(before + (before != (CELL)~0u));
    }
}

static void NAME(vote)(struct pass *pass, CELL *row, const int32_t *cells, unsigned n, CELL bit)
{
    if (pass->is_sparse) {
        NAME(vote_few)(pass, row, cells, n, bit);
    } else if (bit) {
        NAME(vote_scan)(row, cells, n, bit);
    } else {
        NAME(vote_points)(row, cells, n);
    }
}

/* The best cell of a block, in votes. */
static CELL NAME(best_points)(const CELL *restrict block)
{
    CELL best = 0;
    for (int i = 0; i < BLOCK; i++) {
        best = block[i] > best ? block[i] : best;
    }
    return best;
}

static CELL NAME(best_scans)(const CELL *restrict block)
{
    CELL best = 0;
    for (int i = 0; i < BLOCK; i++) {
        CELL v = block[i];
        v = (CELL)(v - ((v >> 1) & (CELL)0x5555u));
        v = (CELL)((v & (CELL)0x3333u) + ((v >> 2) & (CELL)0x3333u));
        v = (CELL)((v + (v >> 4)) & (CELL)0x0f0fu);
        v = (CELL)(sizeof(CELL) > 1 ? (v + (v >> 8)) & (CELL)0x1fu : v);
        best = v > best ? v : best;
    }
    return best;
}

static unsigned NAME(most_around)(const struct pass *pass, const CELL *row, unsigned cell)
{
    unsigned most = NAME(votes)(pass, row[cell]);
    if (pass->neighbours == 8) {
        unsigned left = NAME(votes)(pass, row[cell - 1u]),
                 right = NAME(votes)(pass, row[cell + 1u]);
        most = left > most ? left : most;
        most = right > most ? right : most;
    }
    return most;
}

/* Of equal neighbours the first by theta, then rho, is the peak. */
static int NAME(is_peak)(const struct pass *pass, unsigned cell, unsigned votes)
{
    const CELL *row = pass->rows[1];
    if (pass->neighbours == 0) {
        return 1;
    }
    unsigned above = NAME(most_around)(pass, pass->rows[0], cell);
    unsigned below = NAME(most_around)(pass, pass->rows[2], cell);
    return NAME(votes)(pass, row[cell - 1u]) < votes &&
           NAME(votes)(pass, row[cell + 1u]) <= votes && above + pass->above_is_first <= votes &&
           below + pass->below_is_first <= votes;
}

static void NAME(judge)(struct pass *pass, unsigned cell)
{
    CELL value = ((const CELL *)pass->rows[1])[cell];
    unsigned votes = NAME(votes)(pass, value);
    if (votes < pass->min_votes) {
        return;
    }
    if (votes > pass->result->votes_max) {
        pass->result->votes_max = (uint16_t)votes;
    }
    if (NAME(is_peak)(pass, cell, votes)) {
        keep(pass, cell, votes, pass->counts_points ? 0u : value);
    }
}

/* Looks through the middle row. */
static void NAME(look_through)(struct pass *pass)
{
    const CELL *row = pass->rows[1];
    if (pass->is_sparse) {
        for (unsigned i = 0; i < pass->middle_num_reached; i++) {
            NAME(judge)(pass, pass->middle_reached[i]);
        }
        return;
    }
    unsigned end = pass->accumulator->rho_cells + 1u;
    for (unsigned first = 1; first < end; first += BLOCK) {
        unsigned best =
            pass->counts_points ? NAME(best_points)(&row[first]) : NAME(best_scans)(&row[first]);
        for (unsigned i = first; i < first + BLOCK && i < end && best >= pass->min_votes; i++) {
            NAME(judge)(pass, i);
        }
    }
}

/* The same line seen from the other end of theta. */
static void NAME(turn_round)(struct pass *pass, CELL *row)
{
    unsigned last = pass->accumulator->rho_cells;
    for (unsigned i = 1; i < last + 1u - i; i++) {
        CELL swapped = row[i];
        row[i] = row[last + 1u - i];
        row[last + 1u - i] = swapped;
    }
    for (unsigned i = 0; i < pass->num_touched; i++) {
        pass->touched[i] = (uint16_t)(last + 1u - pass->touched[i]);
    }
}

static void NAME(clear)(struct pass *pass, CELL *row)
{
    if (pass->is_sparse) {
        for (unsigned i = 0; i < pass->num_points; i++) {
            row[pass->touched[i]] = 0;
        }
    } else {
        memset(row, 0, (pass->accumulator->rho_cells + RHO_ACCUMULATOR_PADDING) * sizeof(CELL));
    }
}
