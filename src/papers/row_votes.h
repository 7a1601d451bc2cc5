/* SPDX-License-Identifier: MIT */
/*
 * row_votes: votes and peaks in rows of cells. A template, included twice, with CELL an unsigned
 * type and NAME(f) adding its suffix to f. gcc -O3 vectorises these hot loops as they are written.
 */

static unsigned NAME(votes_of_cell)(const struct rho_accumulator_pass *pass, CELL cell)
{
    return pass->counts_points ? cell
                               : (unsigned)bits_of_byte[cell & 255u] +
                                     (sizeof(CELL) > 1 ? bits_of_byte[cell >> 8] : 0u);
}

/* Votes of one scan: sets its bit in its points' cells; by fours, as stores are the limit. */
static void NAME(vote_scan)(CELL *restrict row, const int32_t *restrict cells, unsigned n, CELL bit)
{
    unsigned i = 0;
    for (; i + 4u <= n; i += 4u) {
        row[(uint32_t)cells[i]] |= bit;
        row[(uint32_t)cells[i + 1u]] |= bit;
        row[(uint32_t)cells[i + 2u]] |= bit;
        row[(uint32_t)cells[i + 3u]] |= bit;
    }
    for (; i < n; i++) {
        row[(uint32_t)cells[i]] |= bit;
    }
}

/*
 * Votes of a scan with many points: its bits are set in a scratch row, where stores do not depend
 * on each other, and then merged. The scratch row is empty before and after.
 */
static void NAME(vote_scan_via_scratch)(CELL *restrict row, CELL *restrict apart,
                                        unsigned num_cells, const int32_t *restrict cells,
                                        unsigned n, CELL bit)
{
    for (unsigned i = 0; i < n; i++) {
        apart[(uint32_t)cells[i]] = bit;
    }
    for (unsigned i = 0; i < num_cells; i++) {
        row[i] |= apart[i];
        apart[i] = 0;
    }
}

/*
 * Votes of n points of one scan (its bit; 0: points are counted). Lists the cells that reach
 * min_votes by these votes in reached[]; returns their number.
 */
static unsigned NAME(vote_reaching)(const struct rho_accumulator_pass *pass, CELL *row,
                                    const int32_t *cells, unsigned n, CELL bit, uint16_t *reached)
{
    unsigned num_reached = 0;
    for (unsigned i = 0; i < n; i++) {
        CELL *cell = &row[(uint32_t)cells[i]], before = *cell;
        CELL after = (CELL)(bit ? before | bit : before + 1u);
        *cell = after;
        reached[num_reached] = (uint16_t)cells[i];
        num_reached += after != before && NAME(votes_of_cell)(pass, after) == pass->list.min_votes;
    }
    return num_reached;
}

/*
 * Votes of n points of several scans, with the bit of each point's scan, or 0 where points are
 * counted. Lists cells that reach min_votes; returns their number.
 */
static unsigned NAME(vote_kept_reaching)(const struct rho_accumulator_pass *pass, CELL *row,
                                         const int32_t *cells, const uint16_t *bits, unsigned n,
                                         uint16_t *reached)
{
    unsigned num_reached = 0;
    for (unsigned i = 0; i < n; i++) {
        num_reached +=
            NAME(vote_reaching)(pass, row, cells + i, 1, (CELL)bits[i], reached + num_reached);
    }
    return num_reached;
}

/* Most votes of a cell and, with eight neighbours, of the cells left and right of it. */
static unsigned NAME(max_votes_beside)(const struct rho_accumulator_pass *pass, const CELL *row,
                                       unsigned cell)
{
    unsigned most = NAME(votes_of_cell)(pass, row[cell]);
    if (pass->neighbours == 8) {
        unsigned left = NAME(votes_of_cell)(pass, row[cell - 1u]);
        unsigned right = NAME(votes_of_cell)(pass, row[cell + 1u]);
        most = left > most ? left : most;
        most = right > most ? right : most;
    }
    return most;
}

/* Whether no neighbour has more votes; among equals the first by theta, then rho, is a peak. */
static int NAME(is_peak)(const struct rho_accumulator_pass *pass, unsigned cell, unsigned votes)
{
    const CELL *row = pass->rows[1];
    if (pass->neighbours == 0) {
        return 1;
    }
    unsigned above = NAME(max_votes_beside)(pass, pass->rows[0], cell);
    unsigned below = NAME(max_votes_beside)(pass, pass->rows[2], cell);
    return NAME(votes_of_cell)(pass, row[cell - 1u]) < votes &&
           NAME(votes_of_cell)(pass, row[cell + 1u]) <= votes &&
           above + pass->above_is_first <= votes && below + pass->below_is_first <= votes;
}

static void NAME(find_peaks_in_reached)(struct rho_accumulator_pass *pass, const uint16_t *reached,
                                        unsigned num_reached)
{
    for (unsigned i = 0; i < num_reached; i++) {
        CELL value = ((const CELL *)pass->rows[1])[reached[i]];
        unsigned votes = NAME(votes_of_cell)(pass, value);
        /* drops guard cells, which are empty, and cells below a min_votes that has risen since */
        if (votes >= pass->list.min_votes && NAME(is_peak)(pass, reached[i], votes)) {
            add_peak(pass, reached[i], votes, value);
        }
    }
}

/* Reverses a row in place: rho changes its sign where theta continues beyond its ends. */
static void NAME(reverse_row)(CELL *row, unsigned num_cells)
{
    for (unsigned i = 1; i < num_cells + 1u - i; i++) {
        CELL swapped = row[i];
        row[i] = row[num_cells + 1u - i];
        row[num_cells + 1u - i] = swapped;
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

static CELL NAME(larger)(CELL a, CELL b)
{
    return a > b ? a : b;
}

/*
 * False where none of n cells has min_votes, points or scans; n is a multiple of BLOCK. Scans in
 * cells of 8 bits are counted eight cells at a time, in words that a compiler vectorises: the bit
 * count of each byte ends in its upper half; bits shifted into the lower half stay there.
 */
static int NAME(may_have_min_votes)(const struct rho_accumulator_pass *pass,
                                    const CELL *restrict row, unsigned n)
{
    unsigned min_votes = pass->list.min_votes;
    CELL most = 0;
    if (pass->counts_points) {
        for (unsigned i = 0; i < n; i++) {
            most = NAME(larger)(row[i], most);
        }
        return most >= min_votes;
    }
    if (sizeof(CELL) > 1) {
        for (unsigned i = 0; i < n; i++) {
            most = NAME(larger)(NAME(count_scans)(row[i]), most);
        }
        return most >= min_votes;
    }
    const uint64_t ones = UINT64_C(0x0101010101010101);
    uint64_t reached = 0, add = ones * (0x80u - 16u * (min_votes < 8u ? min_votes : 8u));
    for (unsigned i = 0; i < n; i += 8u) {
        uint64_t v;
        memcpy(&v, row + i, sizeof v);
        v -= v >> 1 & ones * 0x55u;
        v = (v & ones * 0x33u) + (v >> 2 & ones * 0x33u);
        reached |= v + (v << 4) + add;
    }
    return (reached & ones * 0x80u) != 0;
}

/* Counts the votes of the cells of a block and of its neighbours on both sides. */
static void NAME(count_votes_in_block)(const struct rho_accumulator_pass *pass,
                                       const CELL *restrict block, CELL *restrict votes)
{
    if (pass->counts_points) {
        memcpy(votes, block - 1, AROUND * sizeof *votes);
        return;
    }
    for (int i = 0; i < AROUND; i++) {
        votes[i] = NAME(count_scans)(block[i - 1]);
    }
}

/*
 * Marks the peaks of a block: cells that have min_votes and more votes than their four or eight
 * neighbours; of equal neighbours the first one is marked.
 */
static void NAME(mark_peaks)(const struct rho_accumulator_pass *pass, const CELL *restrict above,
                             const CELL *restrict row, const CELL *restrict below,
                             uint8_t *restrict is_peak)
{
    CELL least = (CELL)pass->list.min_votes, corners = (CELL)(pass->neighbours == 8 ? ~0u : 0u);
    CELL above_first = (CELL)pass->above_is_first, below_first = (CELL)pass->below_is_first;
    for (int i = 0; i < BLOCK; i++) {
        CELL v = row[i];
        CELL up =
            NAME(larger)(above[i], (CELL)(NAME(larger)(above[i - 1], above[i + 1]) & corners));
        CELL down =
            NAME(larger)(below[i], (CELL)(NAME(larger)(below[i - 1], below[i + 1]) & corners));
        is_peak[i] = (uint8_t)((v >= least) & (v > row[i - 1]) & (v >= row[i + 1]) &
                               ((v > up) | ((v == up) & !above_first)) &
                               ((v > down) | ((v == down) & !below_first)));
    }
}

static void NAME(find_peaks_in_block)(struct rho_accumulator_pass *pass, unsigned first)
{
    CELL votes[3][AROUND];
    uint8_t is_peak[BLOCK], found[BLOCK];
    const CELL *row = pass->rows[1];
    NAME(count_votes_in_block)(pass, row + first, votes[1]);
    if (pass->neighbours > 0) {
        NAME(count_votes_in_block)(pass, (const CELL *)pass->rows[0] + first, votes[0]);
        NAME(count_votes_in_block)(pass, (const CELL *)pass->rows[2] + first, votes[2]);
        NAME(mark_peaks)(pass, votes[0] + 1, votes[1] + 1, votes[2] + 1, is_peak);
    } else {
        for (int i = 0; i < BLOCK; i++) {
            is_peak[i] = votes[1][i + 1] >= pass->list.min_votes;
        }
    }
    unsigned num_found = 0;
    for (unsigned i = 0; i < BLOCK; i++) {
        found[num_found] = (uint8_t)i;
        num_found += is_peak[i];
    }
    for (unsigned i = 0; i < num_found; i++) {
        add_peak(pass, first + found[i], votes[1][found[i] + 1u], row[first + found[i]]);
    }
}

/*
 * Finds the peaks of a row where all cells are tested; cells behind the last one are 0. After
 * several blocks without min_votes, the next BLOCKS blocks are tested together.
 */
static void NAME(find_dense_row_peaks)(struct rho_accumulator_pass *pass)
{
    unsigned cells = (pass->accumulator->rho_cells + BLOCK - 1u) / BLOCK * BLOCK, num_passed = 0;
    for (unsigned first = 1; first <= cells;) {
        unsigned left = cells + 1u - first, most = num_passed < BLOCKS ? BLOCK : BLOCKS * BLOCK;
        unsigned n = most < left ? most : left;
        int may_have = NAME(may_have_min_votes)(pass, (const CELL *)pass->rows[1] + first, n);
        num_passed = may_have ? 0u : num_passed + 1u;
        if (may_have && n > BLOCK) {
            continue; /* test the blocks one by one now */
        }
        if (may_have) {
            NAME(find_peaks_in_block)(pass, first);
        }
        first += n;
    }
}
