/* SPDX-License-Identifier: MIT */
/* hough_votes: hash table of the cells with votes, and their spread over neighbours (NHT_C). */
#include "hough_search.h"

#include <string.h>

#include "rhotrack/detail/approx.h"

static uint32_t cell_key(int32_t row, int32_t column)
{
    return (uint32_t)row << 16 | (uint32_t)column;
}

static int32_t row_of_key(uint32_t key)
{
    return (int32_t)(key >> 16);
}

static int32_t column_of_key(uint32_t key)
{
    return (int32_t)(key & 0xffffu);
}

void rho_hough_clear_cells(struct rho_hough_pass *pass)
{
    struct rho_hough_cell *cells = pass->hough->work.sparse.cells;
    pass->num_cells = 0;
    memset(cells, 0, pass->table_size * sizeof *cells);
}

/* The slot of the hash table that holds a cell's key, or the free slot to insert it. */
static struct rho_hough_cell *find_slot(struct rho_hough_pass *pass, uint32_t key)
{
    struct rho_hough_cell *cells = pass->hough->work.sparse.cells;
    uint32_t hash = key * 0x9e3779b1u, at = (hash ^ hash >> 15) & (pass->table_size - 1u);
    while (cells[at].votes > 0 && cells[at].key != key) {
        at = (at + 1u) & (pass->table_size - 1u);
    }
    return &cells[at];
}

struct columns {
    int32_t from, to;
};

static struct columns spread_columns(const struct rho_hough *hough, int32_t column)
{
    int32_t reach = hough->rho_reach, last = hough->rho_cells - 1;
    return (struct columns){column > reach ? column - reach : 0,
                            column + reach < last ? column + reach : last};
}

void rho_hough_add_votes(struct rho_hough_pass *pass, struct rho_line line, uint32_t votes)
{
    const struct rho_hough *hough = pass->hough;
    int32_t row = rho_hough_row_of_theta(hough, line.theta_rad);
    int32_t column = rho_hough_column_of_rho(hough, line.rho_m);
    if (column < 0) {
        return;
    }
    struct rho_hough_cell *cell = find_slot(pass, cell_key(row, column));
    int is_new = cell->votes == 0;
    if (is_new && pass->num_cells >= pass->table_size - pass->table_size / 8u) {
        pass->found.votes_dropped = rho_count(pass->found.votes_dropped, 1);
        pass->is_full = 1;
        return;
    }
    pass->num_cells += (uint32_t)is_new;
    cell->key = cell_key(row, column);
    cell->votes = rho_count(cell->votes, votes);
    uint32_t cells = 1;
    if (hough->config.method == RHO_HOUGH_NHT_C) { /* the cells of the wanted rows in reach */
        struct columns columns = spread_columns(hough, column);
        cells = 0;
        for (int32_t i = -(int32_t)hough->theta_reach; i <= hough->theta_reach; i++) {
            cells += rho_hough_has_row(hough, pass->wanted, row + i) != 0;
        }
        cells *= (uint32_t)(columns.to - columns.from + 1);
    }
    pass->found.votes = rho_count(pass->found.votes, cells);
}

static void sink_cell(struct rho_hough_cell *heap, uint32_t n, uint32_t place)
{
    struct rho_hough_cell cell = heap[place];
    for (uint32_t child = 2u * place + 1u; child < n; child = 2u * place + 1u) {
        child += child + 1u < n && heap[child].key < heap[child + 1u].key;
        if (heap[child].key < cell.key) {
            break;
        }
        heap[place] = heap[child];
        place = child;
    }
    heap[place] = cell;
}

/*
 * Spread of votes in NHT reading C. All votes have the same spread weights, so that each cell's sum
 * is spread at once instead of single votes, row by row of theta: the band is a window over the
 * sorted cells, with those within reach of the row.
 */
struct band {
    struct rho_hough_pass *pass;
    const struct rho_hough_cell *cells;
    uint32_t theta_shares[RHO_HOUGH_REACH_MAX + 1], rho_shares[RHO_HOUGH_REACH_MAX + 1];
    int32_t length;
    /*
     * cells within reach of the row: from first to end - 1; indices below 0 and from length on are
     * cells across the ends of theta
     */
    int32_t first, end;
};

/* A cell within the band; across the ends of theta its row is outside, its column reversed. */
struct band_cell {
    int32_t row, column;
    uint32_t votes;
};

static struct band_cell band_cell_at(const struct band *band, int32_t place)
{
    const struct rho_hough *hough = band->pass->hough;
    int32_t lap = place < 0 ? -1 : place >= band->length ? 1 : 0;
    const struct rho_hough_cell *cell = &band->cells[place - lap * band->length];
    int32_t column = column_of_key(cell->key);
    return (struct band_cell){.row = row_of_key(cell->key) + lap * hough->theta_cells,
                              .column = lap == 0 ? column : hough->rho_cells - 1 - column,
                              .votes = cell->votes};
}

void rho_hough_spread_weights(uint32_t shares[RHO_HOUGH_REACH_MAX + 1], unsigned reach, float cell,
                              float eps)
{
    for (unsigned i = 0; i <= reach; i++) {
        float distance = (float)i * cell / eps;
        shares[i] = (uint32_t)(rho_exp(-0.5f * distance * distance) * (float)RHO_HOUGH_VOTE + 0.5f);
    }
}

uint32_t rho_hough_scale_votes(uint32_t votes, uint32_t share)
{
    return (uint32_t)(((uint64_t)votes * share + RHO_HOUGH_VOTE / 2u) / RHO_HOUGH_VOTE);
}

/* Adds a cell to the list of peaks, or to the plane of the pass where there is no list. */
static void note_cell(const struct rho_hough_pass *pass, struct rho_peak_list *list, int32_t row,
                      int32_t column, uint32_t votes)
{
    if (!list) {
        rho_votes_picture_enter_cell(pass->plane, (unsigned)row, (unsigned)column, votes);
    } else if (votes >= list->min_votes) {
        rho_peak_list_offer(list, (struct rho_accumulator_peak){.votes = votes,
                                                                .theta_cell = (uint16_t)row,
                                                                .rho_cell = (uint16_t)column});
    }
}

/*
 * Moves the band to a row of theta, adds the votes of its cells, scaled by their distance, to the
 * sums of the row's cells, lists the sums and clears them.
 */
static void spread_row(struct band *band, int32_t row, struct rho_peak_list *list)
{
    struct rho_hough *hough = band->pass->hough;
    uint32_t *sums = hough->work.sparse.step.row;
    int32_t reach = hough->theta_reach;
    while (band->end < 2 * band->length && band_cell_at(band, band->end).row <= row + reach) {
        band->end++;
    }
    while (band->first < band->end && band_cell_at(band, band->first).row < row - reach) {
        band->first++;
    }
    for (int32_t place = band->first; place < band->end; place++) {
        struct band_cell cell = band_cell_at(band, place);
        struct columns columns = spread_columns(hough, cell.column);
        int32_t away = row < cell.row ? cell.row - row : row - cell.row;
        uint32_t votes = rho_hough_scale_votes(cell.votes, band->theta_shares[away]);
        for (int32_t i = columns.from; i <= columns.to; i++) {
            uint32_t share = band->rho_shares[i < cell.column ? cell.column - i : i - cell.column];
            uint32_t sum = sums[i] + rho_hough_scale_votes(votes, share);
            sums[i] = sum < sums[i] ? UINT32_MAX : sum;
        }
    }
    for (int32_t place = band->first; place < band->end; place++) {
        struct columns columns = spread_columns(hough, band_cell_at(band, place).column);
        for (int32_t i = columns.from; i <= columns.to; i++) {
            if (sums[i] > 0) {
                band->pass->found.cells = rho_count(band->pass->found.cells, 1);
                note_cell(band->pass, list, row, i, sums[i]);
                sums[i] = 0;
            }
        }
    }
}

void rho_hough_collect_cells(struct rho_hough_pass *pass, struct rho_peak_list *list)
{
    struct rho_hough *hough = pass->hough;
    const struct rho_hough_config *config = &hough->config;
    struct rho_hough_cell *cells = hough->work.sparse.cells;
    uint32_t n = 0;
    for (uint32_t i = 0; i < pass->table_size; i++) {
        if (cells[i].votes > 0) {
            cells[n++] = cells[i];
        }
    }
    if (config->method != RHO_HOUGH_NHT_C) {
        for (uint32_t i = 0; i < n; i++) {
            note_cell(pass, list, row_of_key(cells[i].key), column_of_key(cells[i].key),
                      cells[i].votes);
        }
        pass->found.cells = n;
        return;
    }
    struct band band = {.pass = pass,
                        .cells = cells,
                        .length = (int32_t)n,
                        .first = -(int32_t)n,
                        .end = -(int32_t)n};
    /* heap sort by theta, then rho, in place */
    for (uint32_t i = n / 2u; i > 0; i--) {
        sink_cell(cells, n, i - 1u);
    }
    while (n > 1) {
        struct rho_hough_cell last = cells[0];
        cells[0] = cells[--n];
        cells[n] = last;
        sink_cell(cells, n, 0);
    }
    rho_hough_spread_weights(band.theta_shares, hough->theta_reach, config->theta_cell_rad,
                             config->eps_theta_rad);
    rho_hough_spread_weights(band.rho_shares, hough->rho_reach, config->rho_cell_m,
                             config->eps_rho_m);
    memset(hough->work.sparse.step.row, 0, sizeof hough->work.sparse.step.row);
    for (int32_t i = 0; i < pass->wanted.count; i++) {
        spread_row(&band, pass->wanted.first + i, list);
    }
}
