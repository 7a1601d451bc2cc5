/* SPDX-License-Identifier: MIT */
#include "rhotrack/accumulator.h"

#include <string.h>

#include "rhotrack/angle.h"
#include "rhotrack/approx.h"
#include "rhotrack/types.h"

#define ACCUMULATOR_MAGIC 0x41434355u /* "ACCU" */

#define THETA_CELL_MIN_RAD 1.0e-4f
#define BLOCK 64  /* cells looked at together */
#define CHUNK 256 /* points whose cells are found together */
#define NARROW_SCANS 8u
#define NARROW_POINTS 255u

/* The build fails where the RAM formula of config.h is no longer an upper bound. */
typedef char rho_assert_accumulator_ram[sizeof(struct rho_accumulator) <= RHO_RAM_ACCUMULATOR_BYTES
                                            ? 1
                                            : -1];

/* ---- one pass over theta ---------------------------------------------------------------------- */

struct pass {
    struct rho_accumulator *accumulator;
    const struct rho_accumulator_points *points;
    struct rho_peak_list list; /* its min_votes may rise from row to row */
    uint32_t votes;
    unsigned num_points, neighbours;
    int counts_points, is_narrow, is_sparse, may_be_outside;
    const void *rows[3]; /* above, in and below the one that is looked through: votes_of() */
    unsigned middle_theta_cell;
    unsigned above_is_first, below_is_first; /* such rows win a tie */
};

static const uint8_t bits_of_byte[256] = {
#define TWO(n) (n), (n) + 1, (n) + 1, (n) + 2
#define FOUR(n) TWO(n), TWO((n) + 1), TWO((n) + 1), TWO((n) + 2)
#define SIX(n) FOUR(n), FOUR((n) + 1), FOUR((n) + 1), FOUR((n) + 2)
    SIX(0), SIX(1), SIX(1), SIX(2)};

static unsigned votes_narrow(const struct pass *pass, uint8_t cell)
{
    return pass->counts_points ? cell : bits_of_byte[cell];
}

static unsigned votes_wide(const struct pass *pass, uint16_t cell)
{
    return pass->counts_points ? cell
                               : (unsigned)bits_of_byte[cell & 255u] + bits_of_byte[cell >> 8];
}

static void keep(struct pass *pass, unsigned cell, unsigned votes, unsigned mask)
{
    struct rho_accumulator_peak peak = {.votes = votes,
                                        .theta_cell = (uint16_t)pass->middle_theta_cell,
                                        .rho_cell = (uint16_t)(cell - 1u),
                                        .mask = pass->counts_points ? 0u : mask};
    rho_peak_list_add(&pass->list, peak);
}

/* ---- rows ------------------------------------------------------------------------------------- */

#define CELL uint8_t
#define NAME(f) f##_narrow
#include "accumulator_cells.h"
#undef CELL
#undef NAME
#define CELL uint16_t
#define NAME(f) f##_wide
#include "accumulator_cells.h"
#undef CELL
#undef NAME

/* Where points vote in a row: x by_x + y by_y + first, the guard cell counted. */
struct place {
    float by_x, by_y, first;
};

static struct place place_of(const struct rho_accumulator *accumulator, unsigned theta_cell)
{
    float theta_rad = rho_accumulator_theta_rad(accumulator, theta_cell);
    return (struct place){rho_cos(theta_rad) * accumulator->cells_per_m,
                          rho_sin(theta_rad) * accumulator->cells_per_m, accumulator->first_cell};
}

static void find_cells(const float *restrict x_m, const float *restrict y_m, unsigned n,
                       struct place place, int32_t *restrict cells)
{
    for (unsigned i = 0; i < n; i++) {
        cells[i] = (int32_t)(x_m[i] * place.by_x + y_m[i] * place.by_y + place.first);
    }
}

/* Points that may lie beyond rho_max_m go to the guard cells. Returns how many do. */
static unsigned find_cells_within(const float *restrict x_m, const float *restrict y_m, unsigned n,
                                  struct place place, float last, int32_t *restrict cells)
{
    unsigned outside = 0;
    for (unsigned i = 0; i < n; i++) {
        float cell = x_m[i] * place.by_x + y_m[i] * place.by_y + place.first;
        cell = cell > 0.0f ? cell : 0.0f;
        cell = cell < last ? cell : last;
        cells[i] = (int32_t)cell;
        outside += cells[i] == 0 || cells[i] == (int32_t)last;
    }
    return outside;
}

/* Cells of points from .. from + n - 1; those outside are taken off the votes. */
static void find_some(struct pass *pass, unsigned from, unsigned n, struct place place,
                      int32_t *cells)
{
    const float *x_m = pass->points->x_m + from, *y_m = pass->points->y_m + from;
    unsigned outside = 0;
    if (pass->may_be_outside) {
        float last = (float)(pass->accumulator->rho_cells + 1u);
        outside = find_cells_within(x_m, y_m, n, place, last, cells);
    } else {
        find_cells(x_m, y_m, n, place, cells);
    }
    pass->votes = rho_count(pass->votes, n - outside);
}

static unsigned scan_start(const struct pass *pass, unsigned scan)
{
    return scan > 0 ? pass->points->scan_end[scan - 1u] : 0u;
}

/* Guard cells hold no votes: nothing beyond the last cell is a neighbour. */
static void empty_guards(const struct pass *pass, void *row)
{
    unsigned last = pass->accumulator->rho_cells + 1u;
    if (pass->is_narrow) {
        ((uint8_t *)row)[0] = ((uint8_t *)row)[last] = 0;
    } else {
        ((uint16_t *)row)[0] = ((uint16_t *)row)[last] = 0;
    }
}

static void turn_round(const struct pass *pass, void *row)
{
    if (pass->is_narrow) {
        turn_round_narrow(row, pass->accumulator->rho_cells);
    } else {
        turn_round_wide(row, pass->accumulator->rho_cells);
    }
}

/* Where a slot's votes are compared: few points, and numbers of points, as they voted; masks as numbers of scans. */
static void *votes_of(const struct pass *pass, unsigned slot)
{
    struct rho_accumulator *accumulator = pass->accumulator;
    return pass->is_sparse || pass->counts_points ? accumulator->rows[slot]
                                                  : accumulator->votes[slot];
}

/* ---- few points ------------------------------------------------------------------------------- */

static unsigned vote_few(const struct pass *pass, void *row, const int32_t *cells, unsigned n,
                         unsigned scan, uint16_t *reached)
{
    unsigned bit = pass->counts_points ? 0u : 1u << scan;
    if (bit && scan + 1u < pass->list.min_votes) {
        /* so few scans cannot reach it */
        if (pass->is_narrow) {
            vote_scan_narrow(row, cells, n, (uint8_t)bit);
        } else {
            vote_scan_wide(row, cells, n, (uint16_t)bit);
        }
        return 0;
    }
    return pass->is_narrow ? vote_few_narrow(pass, row, cells, n, (uint8_t)bit, reached)
                           : vote_few_wide(pass, row, cells, n, (uint16_t)bit, reached);
}

static void clear_few(const struct pass *pass, void *row, const int32_t *cells)
{
    for (unsigned i = 0; i < pass->num_points; i++) {
        if (pass->is_narrow) {
            ((uint8_t *)row)[cells[i]] = 0;
        } else {
            ((uint16_t *)row)[cells[i]] = 0;
        }
    }
}

static void fill_few(struct pass *pass, unsigned slot, struct place place, int is_turned)
{
    struct rho_accumulator *accumulator = pass->accumulator;
    int32_t *cells = accumulator->touched[slot];
    void *row = accumulator->rows[slot];
    unsigned num_reached = 0;
    clear_few(pass, row, cells);
    find_some(pass, 0, pass->num_points, place, cells);
    for (unsigned scan = 0; scan < pass->points->num_scans; scan++) {
        unsigned from = scan_start(pass, scan), n = pass->points->scan_end[scan] - from;
        num_reached +=
            vote_few(pass, row, cells + from, n, scan, accumulator->reached[slot] + num_reached);
    }
    accumulator->num_reached[slot] = (uint16_t)num_reached;
    empty_guards(pass, row);
    if (is_turned) {
        turn_round(pass, row);
        for (unsigned i = 0; i < pass->num_points; i++) {
            cells[i] = accumulator->rho_cells + 1 - cells[i];
        }
    }
}

/* ---- many points ------------------------------------------------------------------------------ */

static void vote_many(const struct pass *pass, void *row, const int32_t *cells, unsigned n,
                      unsigned scan)
{
    if (pass->counts_points && pass->is_narrow) {
        vote_points_narrow(row, cells, n);
    } else if (pass->counts_points) {
        vote_points_wide(row, cells, n);
    } else if (pass->is_narrow) {
        vote_scan_narrow(row, cells, n, (uint8_t)(1u << scan));
    } else {
        vote_scan_wide(row, cells, n, (uint16_t)(1u << scan));
    }
}

static void vote_chunks(struct pass *pass, void *row, struct place place, unsigned scan)
{
    unsigned end = pass->points->scan_end[scan];
    for (unsigned from = scan_start(pass, scan); from < end; from += CHUNK) {
        int32_t cells[CHUNK];
        unsigned n = end - from < CHUNK ? end - from : CHUNK;
        find_some(pass, from, n, place, cells);
        vote_many(pass, row, cells, n, scan);
    }
}

static void fill_many(struct pass *pass, unsigned slot, struct place place, int is_turned)
{
    struct rho_accumulator *accumulator = pass->accumulator;
    void *row = accumulator->rows[slot], *votes = votes_of(pass, slot);
    unsigned cells = accumulator->rho_cells + RHO_ACCUMULATOR_PADDING;
    memset(row, 0, cells * (pass->is_narrow ? 1u : 2u));
    for (unsigned scan = 0; scan < pass->points->num_scans; scan++) {
        vote_chunks(pass, row, place, scan);
    }
    empty_guards(pass, row);
    if (votes != row && pass->is_narrow) {
        count_scans_narrow(row, votes, cells);
    } else if (votes != row) {
        count_scans_wide(row, votes, cells);
    }
    if (is_turned) {
        turn_round(pass, votes);
    }
}

/* ---- all rows --------------------------------------------------------------------------------- */

/* Row theta_cell into a slot; turned round where it is a neighbour from the other end of theta. */
static void fill_row(struct pass *pass, unsigned slot, unsigned theta_cell, int is_turned)
{
    struct place place = place_of(pass->accumulator, theta_cell);
    uint32_t votes = pass->votes;
    if (pass->is_sparse) {
        fill_few(pass, slot, place, is_turned);
    } else {
        fill_many(pass, slot, place, is_turned);
    }
    if (is_turned) {
        pass->votes = votes; /* the row votes twice, and counts once */
    }
}

static void look_at_few(struct pass *pass, unsigned slot)
{
    const struct rho_accumulator *accumulator = pass->accumulator;
    if (pass->is_narrow) {
        look_at_few_narrow(pass, accumulator->reached[slot], accumulator->num_reached[slot]);
    } else {
        look_at_few_wide(pass, accumulator->reached[slot], accumulator->num_reached[slot]);
    }
}

static void look_at_all(struct pass *pass, unsigned slot)
{
    if (pass->is_narrow) {
        look_at_all_narrow(pass, (const uint8_t *)pass->accumulator->rows[slot]);
    } else {
        look_at_all_wide(pass, pass->accumulator->rows[slot]);
    }
}

static void look_through(struct pass *pass, unsigned slot, unsigned theta_cell)
{
    struct rho_accumulator *accumulator = pass->accumulator;
    for (unsigned i = 0; i < 3; i++) {
        unsigned of = (slot + 2u + i) % 3u;
        pass->rows[i] = votes_of(pass, of);
    }
    pass->middle_theta_cell = theta_cell;
    pass->above_is_first = theta_cell > 0;
    pass->below_is_first = theta_cell + 1u == accumulator->theta_cells;
    if (pass->is_sparse) {
        look_at_few(pass, slot);
    } else {
        look_at_all(pass, slot);
    }
}

/* Rows -1 (the last, turned round), 0, 1, ... and behind the last one the first, turned round. */
static void stream(struct pass *pass)
{
    unsigned last = pass->accumulator->theta_cells - 1u;
    fill_row(pass, 2, last, 1);
    fill_row(pass, 0, 0, 0);
    for (unsigned theta_cell = 0; theta_cell <= last; theta_cell++) {
        int is_end = theta_cell == last;
        fill_row(pass, (theta_cell + 1u) % 3u, is_end ? 0u : theta_cell + 1u, is_end);
        look_through(pass, theta_cell % 3u, theta_cell);
    }
}

/* ---- public ----------------------------------------------------------------------------------- */

static int is_usable(const struct rho_accumulator_config *config)
{
    return rho_is_within(config->rho_cell_m, RHO_LIMIT_SIGMA_MIN, RHO_LIMIT_POSITION_M) &&
           rho_is_within(config->rho_max_m, 0.5f * config->rho_cell_m,
                         config->rho_cell_m * 0.5f * (float)RHO_MAX_RHO_CELLS) &&
           rho_is_within(config->theta_cell_rad, THETA_CELL_MIN_RAD, RHO_PI) &&
           (config->votes == RHO_VOTES_SCANS || config->votes == RHO_VOTES_POINTS) &&
           config->min_votes >= 1 && rho_is_within(config->min_share, 0.0f, 1.0f) &&
           (config->neighbours == 0 || config->neighbours == 4 || config->neighbours == 8);
}

enum rho_status rho_accumulator_plane(const struct rho_accumulator_config *config,
                                      uint16_t *theta_cells, uint16_t *rho_cells)
{
    if (!is_usable(config)) {
        return RHO_ERROR_CONFIG;
    }
    float rows = RHO_PI / config->theta_cell_rad;
    *theta_cells = (uint16_t)((float)(uint16_t)rows < rows ? rows + 1.0f : rows);
    *rho_cells = (uint16_t)(2.0f * config->rho_max_m / config->rho_cell_m + 0.5f);
    return RHO_OK;
}

enum rho_status rho_accumulator_init(struct rho_accumulator *accumulator, size_t size,
                                     const struct rho_accumulator_config *config)
{
    if (!accumulator || !config) {
        return RHO_ERROR_NULL;
    }
    if (size != sizeof *accumulator) {
        return RHO_ERROR_SIZE;
    }
    if (rho_accumulator_plane(config, &accumulator->theta_cells, &accumulator->rho_cells) !=
        RHO_OK) {
        return RHO_ERROR_CONFIG;
    }
    accumulator->config = *config;
    accumulator->cells_per_m = 1.0f / config->rho_cell_m;
    accumulator->first_cell = 1.0f + config->rho_max_m / config->rho_cell_m;
    accumulator->magic = ACCUMULATOR_MAGIC;
    return RHO_OK;
}

/* The farthest of the points from the origin, squared; -1 where one is not usable. */
static float farthest2_m2(const struct rho_accumulator_points *points, unsigned num_points)
{
    float farthest = 0.0f;
    for (unsigned i = 0; i < num_points; i++) {
        float x_m = points->x_m[i], y_m = points->y_m[i], range2 = x_m * x_m + y_m * y_m;
        if (!rho_is_within(x_m, -RHO_LIMIT_POSITION_M, RHO_LIMIT_POSITION_M) ||
            !rho_is_within(y_m, -RHO_LIMIT_POSITION_M, RHO_LIMIT_POSITION_M)) {
            return -1.0f;
        }
        farthest = range2 > farthest ? range2 : farthest;
    }
    return farthest;
}

static int are_in_order(const struct rho_accumulator_points *points)
{
    if (points->num_scans > RHO_ACCUMULATOR_SCANS_MAX) {
        return 0;
    }
    for (unsigned scan = 1; scan < points->num_scans; scan++) {
        if (points->scan_end[scan] < points->scan_end[scan - 1u]) {
            return 0;
        }
    }
    return 1;
}

/* The square of the farthest point's distance, where they are usable. */
static enum rho_status check(const struct rho_accumulator_points *points, float *farthest2)
{
    if (points->num_scans > 0 && !points->scan_end) {
        return RHO_ERROR_NULL;
    }
    if (!are_in_order(points)) {
        return RHO_ERROR_VALUE;
    }
    unsigned num_points = points->num_scans > 0 ? points->scan_end[points->num_scans - 1u] : 0u;
    if (num_points > 0 && (!points->x_m || !points->y_m)) {
        return RHO_ERROR_NULL;
    }
    *farthest2 = farthest2_m2(points, num_points);
    return *farthest2 < 0.0f ? RHO_ERROR_VALUE : RHO_OK;
}

enum rho_status rho_accumulator_check(const struct rho_accumulator_points *points)
{
    float farthest2;
    return points ? check(points, &farthest2) : RHO_ERROR_NULL;
}

static void choose_rows(struct pass *pass, float farthest2)
{
    const struct rho_accumulator_config *config = &pass->accumulator->config;
    float inside_m = config->rho_max_m - config->rho_cell_m;
    pass->counts_points = config->votes == RHO_VOTES_POINTS;
    pass->is_narrow = pass->counts_points ? pass->num_points <= NARROW_POINTS
                                          : pass->points->num_scans <= NARROW_SCANS;
    pass->is_sparse = pass->num_points <= RHO_ACCUMULATOR_SPARSE_MAX;
    pass->may_be_outside = !(inside_m > 0.0f && farthest2 < inside_m * inside_m);
}

enum rho_status rho_accumulator_find(struct rho_accumulator *accumulator,
                                     const struct rho_accumulator_points *points,
                                     struct rho_accumulator_peak *peaks, uint32_t max_peaks,
                                     struct rho_accumulator_result *result)
{
    if (!accumulator || !points || !result || (max_peaks > 0 && !peaks)) {
        return RHO_ERROR_NULL;
    }
    if (accumulator->magic != ACCUMULATOR_MAGIC) {
        return RHO_ERROR_STATE;
    }
    float farthest2;
    enum rho_status status = check(points, &farthest2);
    if (status != RHO_OK) {
        return status;
    }
    unsigned num_points = points->num_scans > 0 ? points->scan_end[points->num_scans - 1u] : 0u;
    struct pass pass = {.accumulator = accumulator,
                        .points = points,
                        .list = {.peaks = peaks,
                                 .max_peaks = max_peaks,
                                 .min_votes = accumulator->config.min_votes,
                                 .min_share = accumulator->config.min_share},
                        .num_points = num_points,
                        .neighbours = accumulator->config.neighbours};
    choose_rows(&pass, farthest2);
    if (pass.is_sparse) {
        memset(accumulator->rows, 0, sizeof accumulator->rows);
        memset(accumulator->touched, 0, sizeof accumulator->touched);
    }
    stream(&pass);
    rho_peak_list_finish(&pass.list);
    *result = (struct rho_accumulator_result){.num_peaks = pass.list.num_peaks,
                                              .peaks_dropped = pass.list.peaks_dropped,
                                              .votes = pass.votes,
                                              .votes_max = pass.list.votes_max};
    return RHO_OK;
}

int rho_accumulator_cell(const struct rho_accumulator *accumulator, unsigned theta_cell, float x_m,
                         float y_m)
{
    int32_t cell;
    float last = (float)(accumulator->rho_cells + 1u);
    unsigned outside =
        find_cells_within(&x_m, &y_m, 1, place_of(accumulator, theta_cell), last, &cell);
    return outside ? -1 : cell - 1;
}

float rho_accumulator_theta_rad(const struct rho_accumulator *accumulator, unsigned theta_cell)
{
    return ((float)theta_cell + 0.5f) * accumulator->config.theta_cell_rad;
}

float rho_accumulator_rho_m(const struct rho_accumulator *accumulator, unsigned rho_cell)
{
    return ((float)rho_cell + 0.5f) * accumulator->config.rho_cell_m -
           accumulator->config.rho_max_m;
}
