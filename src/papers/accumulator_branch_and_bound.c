/* SPDX-License-Identifier: MIT */
/*
 * accumulator_branch_and_bound: branch and bound over intervals of theta rows. src/DESIGN.md,
 * "Accumulator", derives the bound.
 *
 *     rows  0 ...                64 ...               128 ...
 *           |--------------------|--------------------|------    (1)
 *           |---------|----------|                               (2)
 *                     |----|-----|
 *                          |r r r|                               (3)
 *
 * (1) If no bin of rho has min_votes, all 64 rows are skipped. (2) Otherwise each half of the rows
 * is searched, with the points of those bins that have min_votes. (3) When few rows are left, the
 * remaining points vote in each row.
 */
#include <string.h>

#include "accumulator_peak_search.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/types.h"

#define ROWS_START 16u /* rows of theta in the first interval */
#define ROWS_MAX 1024u
#define ROWS_LEAST 2u /* rows of the shortest interval that is pruned */
/* first number of rows searched without pruning, when it does not pay; doubled each time */
#define ROWS_UNPRUNED 32u
#define BINS_MIN 64u
#define ROWS_WHOLE 2u /* intervals of at most this many rows are not halved */
/* Intervals of at most this many rows are not halved if they keep more than 3/4 of their points. */
#define ROWS_BLUNT 16u
/*
 * Intervals are made shorter if they keep more than 1/3 of all points, longer if they keep at most
 * 1/16.
 */
#define SHRINK_KEPT 3u
#define GROW_KEPT 16u
/*
 * Cost model of pruning, in units of about a nanosecond on a workstation: for bins, per interval
 * and per point; for votes, per row and per kept point.
 */
#define WORK_BINS 50u
#define WORK_BIN 2u
#define WORK_ROW 50u
#define WORK_POINT 2u
/* largest depth to which an interval is halved: log2 of ROWS_MAX, plus 1 */
#define HALVINGS_MAX 11

#define CELL uint8_t
#define NAME(f) f##_narrow
#include "accumulator_prune_points_by_coarse_votes.h"
#undef CELL
#undef NAME
#define CELL uint16_t
#define NAME(f) f##_wide
#include "accumulator_prune_points_by_coarse_votes.h"
#undef CELL
#undef NAME

struct interval {
    /* rows of theta, and the points that are left: the first num_points of room.few */
    unsigned first, num_rows, num_points;
};

struct prune {
    struct rho_accumulator_pass *pass;
    /* circle around all points, its radius in rho cells */
    float centre_x_m, centre_y_m, radius_cells;
    unsigned next_row; /* first row of the next interval */
    /* row that is filled, but not searched for peaks yet; NONE: there is none */
    unsigned last_filled;
    unsigned num_rows;     /* rows of the next interval; 1: pruning does not pay */
    unsigned num_unpruned; /* rows to search without pruning when it does not pay */
    /* cost of the current interval with pruning, compared with cost_of_rows_without_pruning() */
    unsigned work;
};

#define NONE UINT32_MAX

/* ---- points ---------------------------------------------------------------------------------- */

/* Copies the points to room.few, with the bits of their scans; each interval reorders the copy. */
static void copy_points_to_scratch(struct prune *prune)
{
    const struct rho_accumulator_points *points = prune->pass->points;
    struct rho_accumulator *accumulator = prune->pass->accumulator;
    unsigned i = 0;
    for (unsigned scan = 0; scan < points->num_scans; scan++) {
        for (; i < points->scan_end[scan]; i++) {
            accumulator->room.few.x_m[i] = points->x_m[i];
            accumulator->room.few.y_m[i] = points->y_m[i];
            accumulator->room.few.bits[i] =
                (uint16_t)(prune->pass->counts_points ? 0u : 1u << scan);
        }
    }
}

static void find_middle_and_half_width(const float *values, unsigned n, float *middle, float *half)
{
    float low = values[0], high = values[0];
    for (unsigned i = 1; i < n; i++) {
        low = values[i] < low ? values[i] : low;
        high = values[i] > high ? values[i] : high;
    }
    *middle = 0.5f * (low + high);
    *half = 0.5f * (high - low);
}

/* Sets the circle that contains all points, about the middle of their extent. */
static void set_circle_around_points(struct prune *prune)
{
    const struct rho_accumulator_points *points = prune->pass->points;
    unsigned n = prune->pass->num_points;
    float half_x_m, half_y_m, farthest2 = 0.0f;
    find_middle_and_half_width(points->x_m, n, &prune->centre_x_m, &half_x_m);
    find_middle_and_half_width(points->y_m, n, &prune->centre_y_m, &half_y_m);
    for (unsigned i = 0; i < n; i++) {
        float x_m = points->x_m[i] - prune->centre_x_m, y_m = points->y_m[i] - prune->centre_y_m;
        float range2 = x_m * x_m + y_m * y_m;
        farthest2 = range2 > farthest2 ? range2 : farthest2;
    }
    prune->radius_cells = rho_sqrt(farthest2) * prune->pass->accumulator->cells_per_m;
}

/* Moves the points that are listed in room.few.bins to the front of room.few. */
static void move_listed_points_to_front(struct rho_accumulator *accumulator, unsigned num_kept)
{
    float *x_m = accumulator->room.few.x_m, *y_m = accumulator->room.few.y_m;
    uint16_t *bits = accumulator->room.few.bits;
    for (unsigned to = 0; to < num_kept; to++) {
        unsigned from = (unsigned)accumulator->room.few.bins[to];
        float x = x_m[from], y = y_m[from];
        uint16_t bit = bits[from];
        x_m[from] = x_m[to];
        y_m[from] = y_m[to];
        bits[from] = bits[to];
        x_m[to] = x;
        y_m[to] = y;
        bits[to] = bit;
    }
}

/* ---- bins ------------------------------------------------------------------------------------ */

/* Number of bins for pruning: at least four per point, so that few points share one by chance. */
static unsigned num_bins_for(unsigned num_points)
{
    unsigned num_bins = BINS_MIN;
    while (num_bins < 4u * num_points && num_bins < RHO_ACCUMULATOR_BINS) {
        num_bins *= 2u;
    }
    return num_bins;
}

/* Computes the bin of each point on a ring of num_bins bins, a power of two. */
static void compute_ring_bins_of_points(const float *restrict x_m, const float *restrict y_m,
                                        unsigned n, struct rho_accumulator_projection place,
                                        unsigned num_bins, int32_t *restrict bins)
{
    int32_t ring = (int32_t)num_bins - 1;
    for (unsigned i = 0; i < n; i++) {
        bins[i] = (int32_t)(x_m[i] * place.by_x + y_m[i] * place.by_y + place.first) & ring;
    }
}

/*
 * Projection of points to bins of rho at the middle row of an interval. All points that vote for
 * one cell in any row of the interval lie within two bin widths.
 */
static struct rho_accumulator_projection projection_of_points_to_bins(const struct prune *prune,
                                                                      struct interval of)
{
    const struct rho_accumulator *accumulator = prune->pass->accumulator;
    float theta_cell_rad = accumulator->config.theta_cell_rad;
    float theta_rad = ((float)of.first + 0.5f * (float)of.num_rows) * theta_cell_rad;
    float half_rad = 0.5f * (float)(of.num_rows - 1u) * theta_cell_rad;
    float width_cells = prune->radius_cells * half_rad + 0.5f + RHO_ACCUMULATOR_ROUNDING;
    float per_m = accumulator->cells_per_m / width_cells;
    float by_x = rho_cos(theta_rad) * per_m, by_y = rho_sin(theta_rad) * per_m;
    return (struct rho_accumulator_projection){by_x, by_y,
                                               prune->radius_cells / width_cells + 1.0f -
                                                   prune->centre_x_m * by_x -
                                                   prune->centre_y_m * by_y};
}

/*
 * Drops the points of an interval that cannot be part of a cell with min_votes in any of its rows.
 */
static void drop_hopeless_points(const struct prune *prune, struct interval *of)
{
    struct rho_accumulator_pass *pass = prune->pass;
    struct rho_accumulator *accumulator = pass->accumulator;
    unsigned n = of->num_points, num_bins = num_bins_for(n), least = pass->list.min_votes;
    if (n < least || (!pass->counts_points && pass->points->num_scans < least)) {
        of->num_points = 0;
        return;
    }
    compute_ring_bins_of_points(accumulator->room.few.x_m, accumulator->room.few.y_m, n,
                                projection_of_points_to_bins(prune, *of), num_bins,
                                accumulator->room.few.bins);
    of->num_points = pass->is_narrow ? list_points_that_may_peak_narrow(pass, n, num_bins)
                                     : list_points_that_may_peak_wide(pass, n, num_bins);
    if (of->num_points < n) {
        move_listed_points_to_front(accumulator, of->num_points);
    }
}

/* ---- rows ------------------------------------------------------------------------------------ */

/*
 * Lists the peaks of the row filled last, once the row after it is filled: rows that are skipped
 * are cleared, and after the last row comes the first one, reversed.
 */
static void find_peaks_of_last_filled_row(struct prune *prune, unsigned next)
{
    struct rho_accumulator_pass *pass = prune->pass;
    unsigned row = prune->last_filled, slot = (row + 1u) % 3u;
    if (row == NONE) {
        return;
    }
    if (row + 1u == pass->accumulator->theta_cells) {
        rho_accumulator_fill_row(pass, slot, 0, 1);
    } else if (next != row + 1u) {
        rho_accumulator_clear_sparse_row(pass, slot);
    }
    rho_accumulator_find_row_peaks(pass, row);
}

/*
 * Before the first row after a gap: searches the row filled last, and sets the row above to its
 * votes: none, as it was skipped, or for row 0 those of the last row, reversed.
 */
static void search_last_filled_row_and_set_row_above(struct prune *prune, unsigned row)
{
    if (prune->last_filled == NONE || prune->last_filled + 1u != row) {
        find_peaks_of_last_filled_row(prune, row);
        prune->last_filled = NONE;
        if (row == 0) {
            rho_accumulator_fill_row(prune->pass, 2, prune->pass->accumulator->theta_cells - 1u, 1);
        } else {
            rho_accumulator_clear_sparse_row(prune->pass, (row - 1u) % 3u);
        }
    }
}

/* Fills a row with the votes of the first num_points points, then searches the row before it. */
static void fill_row_and_find_peaks_of_row_before(struct prune *prune, unsigned row,
                                                  unsigned num_points)
{
    search_last_filled_row_and_set_row_above(prune, row);
    if (num_points == prune->pass->num_points) {
        rho_accumulator_fill_row(prune->pass, row % 3u, row, 0);
    } else {
        rho_accumulator_fill_row_with_kept(prune->pass, row % 3u, row, num_points);
    }
    find_peaks_of_last_filled_row(prune, row);
    prune->last_filled = row;
}

/* ---- intervals ------------------------------------------------------------------------------- */

/*
 * Cost of searching rows with the votes of all points, half a unit per point less than with kept
 * points.
 */
static unsigned cost_of_rows_without_pruning(const struct prune *prune, unsigned num_rows)
{
    return num_rows * (WORK_ROW + prune->pass->num_points * 3u / 2u);
}

/* Fills each row of an interval with its points, and lists the peaks of the rows before. */
static void fill_and_search_interval_rows(struct prune *prune, struct interval of)
{
    prune->work += of.num_rows * (WORK_ROW + WORK_POINT * of.num_points);
    for (unsigned row = of.first; row < of.first + of.num_rows; row++) {
        fill_row_and_find_peaks_of_row_before(prune, row, of.num_points);
    }
}

/* Whether halving an interval can save more than the bins of its halves cost. */
static int is_worth_halving(struct interval of, unsigned num_before)
{
    return of.num_rows > ROWS_WHOLE &&
           (of.num_rows > ROWS_BLUNT || 4u * of.num_points <= 3u * num_before);
}

/*
 * Searches an interval depth-first by halving it. Returns the number of points that the whole
 * interval keeps.
 */
static unsigned search_interval_count_kept_points(struct prune *prune, struct interval whole)
{
    struct interval stack[HALVINGS_MAX + 1];
    unsigned depth = 0, num_kept = 0;
    stack[depth++] = whole;
    while (depth > 0) {
        struct interval of = stack[--depth];
        unsigned num_before = of.num_points, num_left = of.num_rows / 2u;
        prune->work += WORK_BINS + WORK_BIN * num_before;
        drop_hopeless_points(prune, &of);
        num_kept = of.num_rows == whole.num_rows ? of.num_points : num_kept;
        if (of.num_points > 0 && is_worth_halving(of, num_before)) {
            stack[depth++] =
                (struct interval){of.first + num_left, of.num_rows - num_left, of.num_points};
            stack[depth++] = (struct interval){of.first, num_left, of.num_points};
        } else if (of.num_points > 0) {
            fill_and_search_interval_rows(prune, of);
        }
    }
    return num_kept;
}

/*
 * Searches the next interval of rows. Its length is doubled while nearly all points are dropped,
 * and halved if few are: at the best length an interval costs about as much as its halves. If an
 * interval cost more than its rows without pruning, or even ROWS_LEAST rows keep many points, all
 * points vote in the next rows before pruning is tried again.
 */
static void search_interval_and_adapt_length(struct prune *prune, unsigned rows_left)
{
    unsigned n = prune->pass->num_points, num_rows = prune->num_rows;
    int is_pruned = num_rows >= ROWS_LEAST;
    num_rows = is_pruned ? num_rows : prune->num_unpruned;
    num_rows = num_rows < rows_left ? num_rows : rows_left;
    struct interval of = {prune->next_row, num_rows, n};
    prune->next_row += num_rows;
    if (!is_pruned) {
        fill_and_search_interval_rows(prune, of);
        prune->num_rows = ROWS_LEAST;
        prune->num_unpruned += prune->num_unpruned < ROWS_MAX ? prune->num_unpruned : 0u;
        return;
    }
    prune->work = 0;
    unsigned num_kept = search_interval_count_kept_points(prune, of);
    if (prune->work > cost_of_rows_without_pruning(prune, num_rows)) {
        prune->num_rows = 1;
        return;
    }
    if (SHRINK_KEPT * num_kept > n) {
        prune->num_rows /= 2u;
        return;
    }
    prune->num_unpruned = ROWS_UNPRUNED;
    if (GROW_KEPT * num_kept <= n && prune->num_rows < ROWS_MAX) {
        prune->num_rows *= 2u;
    }
}

void rho_accumulator_search_pruned(struct rho_accumulator_pass *pass)
{
    struct prune prune = {
        .pass = pass, .last_filled = NONE, .num_rows = ROWS_START, .num_unpruned = ROWS_UNPRUNED};
    unsigned num_rows = pass->accumulator->theta_cells;
    if (pass->num_points == 0) {
        return;
    }
    copy_points_to_scratch(&prune);
    set_circle_around_points(&prune);
    while (prune.next_row < num_rows) {
        search_interval_and_adapt_length(&prune, num_rows - prune.next_row);
    }
    find_peaks_of_last_filled_row(&prune, NONE);
    /* all points are within rho_max_m where rows are pruned */
    pass->votes = pass->num_points * num_rows;
}
