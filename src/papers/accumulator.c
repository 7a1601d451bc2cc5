/* SPDX-License-Identifier: MIT */
/*
 * accumulator: the plane (rho, theta): its cells, the cells of points in a row of theta, and the
 * votes and peaks of rows, whose loops over points are hot. Rows and points that cannot reach a
 * peak are left out, by branch and bound over intervals of theta rows. src/DESIGN.md,
 * "Accumulator", derives the bound.
 *
 *     rows  0 ...                64 ...               128 ...
 *           |--------------------|--------------------|------    (1)
 *           |----|----|----|-----|                               (2)
 *                     |r r r|                                    (3)
 *
 * (1) If no bin of rho has min_votes, all 64 rows are skipped. (2) Otherwise each quarter of the
 * rows is searched, with the points of those bins that have min_votes. (3) When few rows are left,
 * the remaining points vote in each row.
 */
#include "rhotrack/detail/accumulator.h"

#include <string.h>

#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/votes_picture.h"

/* bound of the rounding error of a point's cell, in cells; src/DESIGN.md derives it */
#define RHO_ACCUMULATOR_ROUNDING 0.125f

/* Projection of points onto a row of theta: cell = x by_x + y by_y + first, with one guard cell. */
struct rho_accumulator_projection {
    float by_x, by_y, first;
};

struct rho_accumulator_pass {
    struct rho_accumulator *accumulator;
    const struct rho_accumulator_points *points;
    /* plane in which the votes of cells are noted; NULL: cells are listed as peaks */
    struct rho_votes_picture *plane;
    struct rho_peak_list list; /* peaks found so far; list.min_votes may rise from row to row */
    uint64_t outside;          /* points beyond rho_max_m, summed over the rows */
    unsigned num_points, theta_cell;
    struct rho_accumulator_projection place; /* onto row theta_cell */
    int counts_points, is_narrow;
    int has_outside; /* points may lie beyond rho_max_m in some rows */
};

enum rho_status rho_accumulator_count_cells(const struct rho_accumulator_config *config,
                                            uint16_t *theta_cells, uint16_t *rho_cells)
{
    if (!rho_is_within(config->rho_cell_m, RHO_LIMIT_SIGMA_MIN, RHO_LIMIT_POSITION_M) ||
        !rho_is_within(config->rho_max_m, 0.5f * config->rho_cell_m,
                       config->rho_cell_m * 0.5f * (float)RHO_MAX_RHO_CELLS) ||
        !rho_is_within(config->theta_cell_rad, 1.0e-4f, RHO_PI) ||
        (config->votes != RHO_VOTES_SCANS && config->votes != RHO_VOTES_POINTS) ||
        config->min_votes < 1 || !rho_is_within(config->min_share, 0.0f, 1.0f) ||
        config->no_pruning > 1) {
        return RHO_ERROR_CONFIG;
    }
    float rows = RHO_PI / config->theta_cell_rad;
    *theta_cells = (uint16_t)((float)(uint16_t)rows < rows ? rows + 1.0f : rows);
    *rho_cells = (uint16_t)(2.0f * config->rho_max_m / config->rho_cell_m + 0.5f);
    return RHO_OK;
}

float rho_accumulator_theta_rad(const struct rho_accumulator *accumulator, unsigned theta_cell)
{
    return ((float)theta_cell + 0.5f) * accumulator->config.theta_cell_rad;
}

static struct rho_accumulator_projection
rho_accumulator_projection(const struct rho_accumulator *accumulator, unsigned theta_cell)
{
    float theta_rad = rho_accumulator_theta_rad(accumulator, theta_cell);
    return (struct rho_accumulator_projection){rho_cos(theta_rad) * accumulator->cells_per_m,
                                               rho_sin(theta_rad) * accumulator->cells_per_m,
                                               accumulator->first_cell};
}

/* Computes the cells of rho in which n points vote, for points that all lie within rho_max_m. */
static void project_inside(const float *restrict x_m, const float *restrict y_m, unsigned n,
                           struct rho_accumulator_projection place, int32_t *restrict cells)
{
    for (unsigned i = 0; i < n; i++) {
        cells[i] = (int32_t)(x_m[i] * place.by_x + y_m[i] * place.by_y + place.first);
    }
}

/*
 * Computes the cells of rho in which n points vote; points beyond rho_max_m get the guard cells 0
 * and `last`. Returns the number of such points.
 */
static unsigned clamp_cells(const float *restrict x_m, const float *restrict y_m, unsigned n,
                            struct rho_accumulator_projection place, float last,
                            int32_t *restrict cells)
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

int rho_accumulator_cell_of_point(const struct rho_accumulator *accumulator, unsigned theta_cell,
                                  float x_m, float y_m)
{
    int32_t cell;
    float last = (float)(accumulator->rho_cells + 1u);
    unsigned outside = clamp_cells(
        &x_m, &y_m, 1, rho_accumulator_projection(accumulator, theta_cell), last, &cell);
    return outside ? -1 : cell - 1;
}

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
        pass->outside += clamp_cells(x_m, y_m, n, pass->place, last, cells);
    } else {
        project_inside(x_m, y_m, n, pass->place, cells);
    }
}

/* Lets the first n points of the scratch vote in a row of theta, empty before and after. */
static void vote_few(struct rho_accumulator_pass *pass, unsigned theta_cell, unsigned n)
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

/* Lets all points vote in a row of theta. */
static void vote_all(struct rho_accumulator_pass *pass, unsigned theta_cell)
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

#define LEVELS 5u /* of parts within the longest interval */
#define INTERVAL_ROWS (PARTS * PARTS * PARTS * PARTS * PARTS)

/*
 * Sets are_enough[b] where bins b .. b + 2 have min_votes, points or scans. Returns whether any is
 * set.
 */
static int mark_triples(const struct rho_accumulator_pass *pass, const uint16_t *restrict votes,
                        uint16_t *restrict are_enough, unsigned num_bins)
{
    const int counts_points = pass->counts_points;
    const unsigned min_votes = pass->list.min_votes;
    uint16_t any = 0;
    for (unsigned i = 0; i < num_bins; i++) {
        uint16_t v = (uint16_t)(votes[i] | votes[i + 1u] | votes[i + 2u]);
        v = (uint16_t)(v - ((v >> 1) & 0x5555u));
        v = (uint16_t)((v & 0x3333u) + ((v >> 2) & 0x3333u));
        v = (uint16_t)((v + (v >> 4)) & 0x0f0fu);
        v = (uint16_t)((v + (v >> 8)) & 0x1fu);
        v = counts_points ? (uint16_t)(votes[i] + votes[i + 1u] + votes[i + 2u]) : v;
        are_enough[i] = v >= (uint16_t)min_votes;
        any |= are_enough[i];
    }
    return any;
}

/*
 * Lists in bins[] the points that may reach min_votes, by their coarse bins of rho. These are a
 * ring: rho values that differ by its whole length share a bin. Returns the number of points.
 */
static unsigned list_kept_points(struct rho_accumulator_pass *pass, unsigned n, unsigned num_bins)
{
    struct rho_accumulator *accumulator = pass->accumulator;
    const uint16_t *bits = accumulator->few.bits;
    uint16_t *votes = accumulator->few.votes, *are_enough = accumulator->few.are_enough;
    int32_t *bins = accumulator->few.bins;
    unsigned num_kept = 0;
    memset(votes, 0, num_bins * sizeof *votes);
    for (unsigned i = 0; i < n; i++) {
        uint16_t *bin = &votes[bins[i]];
        *bin = (uint16_t)(pass->counts_points ? *bin + 1u : *bin | bits[i]);
    }
    votes[num_bins] = votes[0];
    votes[num_bins + 1u] = votes[1];
    if (!mark_triples(pass, votes, are_enough + 2, num_bins)) {
        return 0;
    }
    are_enough[0] = are_enough[num_bins];
    are_enough[1] = are_enough[num_bins + 1u];
    /* a point is kept where one of its three bins is marked */
    for (unsigned i = 0; i < n; i++) {
        const uint16_t *at = are_enough + bins[i];
        bins[num_kept] = (int32_t)i;
        num_kept += (at[0] | at[1] | at[2]) != 0;
    }
    return num_kept;
}

struct interval {
    /* rows of theta, and the points left: the first num_points of few */
    unsigned first, num_rows, num_points;
};

struct prune {
    struct rho_accumulator_pass *pass;
    /* circle around all points, its radius in rho cells */
    float centre_x_m, centre_y_m, radius_cells;
};

static float middle_of(const float *values, unsigned n)
{
    float low = values[0], high = values[0];
    for (unsigned i = 1; i < n; i++) {
        low = values[i] < low ? values[i] : low;
        high = values[i] > high ? values[i] : high;
    }
    return 0.5f * (low + high);
}

/* Computes the bin of each point on a ring of num_bins bins, a power of two. */
static void find_ring_bins(const float *restrict x_m, const float *restrict y_m, unsigned n,
                           struct rho_accumulator_projection place, unsigned num_bins,
                           int32_t *restrict bins)
{
    int32_t ring = (int32_t)num_bins - 1;
    for (unsigned i = 0; i < n; i++) {
        bins[i] = (int32_t)(x_m[i] * place.by_x + y_m[i] * place.by_y + place.first) & ring;
    }
}

/*
 * Drops the points of an interval that cannot be part of a cell with min_votes in any of its rows:
 * all points that vote for one cell in any row lie within two bin widths at the middle row.
 */
static void drop_hopeless_points(const struct prune *prune, struct interval *of)
{
    struct rho_accumulator_pass *pass = prune->pass;
    struct rho_accumulator *accumulator = pass->accumulator;
    float *x_m = accumulator->few.x_m, *y_m = accumulator->few.y_m;
    int32_t *bins = accumulator->few.bins;
    uint16_t *bits = accumulator->few.bits;
    unsigned n = of->num_points, num_bins = BINS_MIN, least = pass->list.min_votes;
    if (n < least || (!pass->counts_points && pass->points->num_scans < least)) {
        of->num_points = 0;
        return;
    }
    /* at least four bins a point, so that few points share one by chance */
    while (num_bins < 4u * n && num_bins < RHO_ACCUMULATOR_BINS) {
        num_bins *= 2u;
    }
    float theta_cell_rad = accumulator->config.theta_cell_rad;
    float theta_rad = ((float)of->first + 0.5f * (float)of->num_rows) * theta_cell_rad;
    float half_rad = 0.5f * (float)(of->num_rows - 1u) * theta_cell_rad;
    float width_cells = prune->radius_cells * half_rad + 0.5f + RHO_ACCUMULATOR_ROUNDING;
    float per_m = accumulator->cells_per_m / width_cells;
    float by_x = rho_cos(theta_rad) * per_m, by_y = rho_sin(theta_rad) * per_m;
    struct rho_accumulator_projection place = {by_x, by_y,
                                               prune->radius_cells / width_cells + 1.0f -
                                                   prune->centre_x_m * by_x -
                                                   prune->centre_y_m * by_y};
    find_ring_bins(x_m, y_m, n, place, num_bins, bins);
    of->num_points = list_kept_points(pass, n, num_bins);
    /* the points left, listed in bins[], change places with those at the front */
    for (unsigned to = 0; of->num_points < n && to < of->num_points; to++) {
        unsigned from = (unsigned)bins[to];
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

/* Lets the points of an interval vote in each of its rows. */
static void search_rows(struct rho_accumulator_pass *pass, struct interval of)
{
    for (unsigned row = of.first; row < of.first + of.num_rows; row++) {
        vote_few(pass, row, of.num_points);
    }
}

/* Searches an interval by parts, depth first, as long as points are left. */
static void search_interval(const struct prune *prune, struct interval whole)
{
    struct interval stack[LEVELS * (PARTS - 1u) + 1u];
    unsigned depth = 0;
    stack[depth++] = whole;
    while (depth > 0) {
        struct interval of = stack[--depth];
        drop_hopeless_points(prune, &of);
        if (of.num_points > 0 && of.num_rows <= ROWS_LEAST) {
            search_rows(prune->pass, of);
        } else if (of.num_points > 0) {
            unsigned part = (of.num_rows + PARTS - 1u) / PARTS;
            part = part > ROWS_LEAST ? part : ROWS_LEAST;
            for (unsigned end = of.num_rows; end > 0;) {
                unsigned rest = end % part, num_rows = rest > 0 ? rest : part;
                end -= num_rows;
                stack[depth++] = (struct interval){of.first + end, num_rows, of.num_points};
            }
        }
    }
}

/* Searches interval by interval; all points lie within rho_max_m. */
static void search_intervals(struct rho_accumulator_pass *pass)
{
    const struct rho_accumulator_points *points = pass->points;
    const unsigned n = pass->num_points, num_rows = pass->accumulator->theta_cells;
    struct prune prune = {.pass = pass,
                          .centre_x_m = middle_of(points->x_m, n),
                          .centre_y_m = middle_of(points->y_m, n)};
    float farthest2 = 0.0f;
    for (unsigned i = 0; i < n; i++) {
        float x_m = points->x_m[i] - prune.centre_x_m, y_m = points->y_m[i] - prune.centre_y_m;
        float range2 = x_m * x_m + y_m * y_m;
        farthest2 = range2 > farthest2 ? range2 : farthest2;
    }
    prune.radius_cells = rho_sqrt(farthest2) * pass->accumulator->cells_per_m;
    for (unsigned first = 0; first < num_rows; first += INTERVAL_ROWS) {
        unsigned left = num_rows - first;
        search_interval(&prune,
                        (struct interval){first, left < INTERVAL_ROWS ? left : INTERVAL_ROWS, n});
    }
}

/*
 * Lets points that the scratch has room for vote in all rows of theta, or, with is_pruned, only in
 * those that can have peaks, which needs all points within rho_max_m.
 */
static void search_few(struct rho_accumulator_pass *pass, int is_pruned)
{
    const struct rho_accumulator_points *points = pass->points;
    struct rho_accumulator *accumulator = pass->accumulator;
    /* pruning reorders this copy of the points */
    for (unsigned scan = 0, i = 0; scan < points->num_scans; scan++) {
        for (; i < points->scan_end[scan]; i++) {
            accumulator->few.x_m[i] = points->x_m[i];
            accumulator->few.y_m[i] = points->y_m[i];
            accumulator->few.bits[i] = (uint16_t)(1u << scan);
        }
    }
    memset(accumulator->row, 0, sizeof accumulator->row);
    if (is_pruned) {
        search_intervals(pass);
    } else {
        search_rows(pass, (struct interval){0, accumulator->theta_cells, pass->num_points});
    }
}

enum { ACCUMULATOR_MAGIC = 0x41434355 }; /* "ACCU" in ASCII */

/* The build fails where the RAM formula of config.h is no longer an upper bound. */
typedef char rho_assert_accumulator_ram[sizeof(struct rho_accumulator) <= RHO_RAM_ACCUMULATOR_BYTES
                                            ? 1
                                            : -1];

enum rho_status rho_accumulator_init(struct rho_accumulator *accumulator, size_t object_size,
                                     const struct rho_accumulator_config *config)
{
    if (!accumulator || !config) {
        return RHO_ERROR_NULL;
    }
    if (object_size != sizeof *accumulator) {
        return RHO_ERROR_SIZE;
    }
    if (rho_accumulator_count_cells(config, &accumulator->theta_cells, &accumulator->rho_cells) !=
        RHO_OK) {
        return RHO_ERROR_CONFIG;
    }
    accumulator->config = *config;
    accumulator->cells_per_m = 1.0f / config->rho_cell_m;
    accumulator->first_cell = 1.0f + config->rho_max_m / config->rho_cell_m;
    accumulator->magic = ACCUMULATOR_MAGIC;
    return RHO_OK;
}

static unsigned count_points(const struct rho_accumulator_points *points)
{
    return points->num_scans > 0 ? points->scan_end[points->num_scans - 1u] : 0u;
}

enum rho_status rho_accumulator_check_points(const struct rho_accumulator_points *points)
{
    if (!points || (points->num_scans > 0 && !points->scan_end)) {
        return RHO_ERROR_NULL;
    }
    if (points->num_scans > RHO_ACCUMULATOR_SCANS_MAX) {
        return RHO_ERROR_VALUE;
    }
    for (unsigned scan = 1; scan < points->num_scans; scan++) {
        if (points->scan_end[scan] < points->scan_end[scan - 1u]) {
            return RHO_ERROR_VALUE;
        }
    }
    unsigned num_points = count_points(points);
    if (num_points > 0 && (!points->x_m || !points->y_m)) {
        return RHO_ERROR_NULL;
    }
    for (unsigned i = 0; i < num_points; i++) {
        if (!rho_is_coordinate(points->x_m[i]) || !rho_is_coordinate(points->y_m[i])) {
            return RHO_ERROR_VALUE;
        }
    }
    return RHO_OK;
}

/* False where all points lie inside the cells of rho in all rows. */
static int may_be_outside(const struct rho_accumulator_pass *pass)
{
    const struct rho_accumulator_config *config = &pass->accumulator->config;
    const struct rho_accumulator_points *points = pass->points;
    float last_m = (float)pass->accumulator->rho_cells * config->rho_cell_m - config->rho_max_m;
    float least_m = last_m < config->rho_max_m ? last_m : config->rho_max_m;
    float inside_m = least_m - RHO_ACCUMULATOR_ROUNDING * config->rho_cell_m;
    float inside2 = inside_m > 0.0f ? inside_m * inside_m : 0.0f, farthest2 = 0.0f;
    for (unsigned i = 0; i < pass->num_points; i++) {
        float range2 = points->x_m[i] * points->x_m[i] + points->y_m[i] * points->y_m[i];
        farthest2 = range2 > farthest2 ? range2 : farthest2;
    }
    return !(farthest2 < inside2);
}

/* Lets all points vote, for the pass' list or plane. */
static void search(struct rho_accumulator_pass *pass)
{
    const struct rho_accumulator *accumulator = pass->accumulator;
    const unsigned n = count_points(pass->points);
    if (n == 0) {
        return; /* the arrays of points may be NULL */
    }
    pass->num_points = n;
    pass->counts_points = accumulator->config.votes == RHO_VOTES_POINTS;
    pass->has_outside = may_be_outside(pass);
    if (n <= RHO_ACCUMULATOR_SPARSE_MAX &&
        n <= accumulator->rho_cells / SPARSE_CELLS + SPARSE_POINTS) {
        search_few(pass, !pass->has_outside && !accumulator->config.no_pruning &&
                             pass->list.min_votes >= PRUNED_VOTES);
        return;
    }
    pass->is_narrow = pass->counts_points ? n <= UINT8_MAX : pass->points->num_scans <= 8u;
    for (unsigned theta_cell = 0; theta_cell < accumulator->theta_cells; theta_cell++) {
        vote_all(pass, theta_cell);
    }
}

static enum rho_status check_search(const struct rho_accumulator *accumulator,
                                    const struct rho_accumulator_points *points)
{
    if (!accumulator || !points) {
        return RHO_ERROR_NULL;
    }
    return accumulator->magic == ACCUMULATOR_MAGIC ? rho_accumulator_check_points(points)
                                                   : RHO_ERROR_STATE;
}

enum rho_status rho_accumulator_find_peaks(struct rho_accumulator *accumulator,
                                           const struct rho_accumulator_points *points,
                                           struct rho_accumulator_peak *peaks, uint32_t max_peaks,
                                           struct rho_accumulator_result *result)
{
    enum rho_status status = check_search(accumulator, points);
    if (status != RHO_OK) {
        return status;
    }
    if (!result || (max_peaks > 0 && !peaks)) {
        return RHO_ERROR_NULL;
    }
    struct rho_accumulator_pass pass = {.accumulator = accumulator,
                                        .points = points,
                                        .list = {.peaks = peaks,
                                                 .max_peaks = max_peaks,
                                                 .min_votes = accumulator->config.min_votes,
                                                 .min_share = accumulator->config.min_share}};
    search(&pass);
    rho_peak_list_sort(&pass.list);
    const uint64_t votes = (uint64_t)pass.num_points * accumulator->theta_cells - pass.outside;
    *result =
        (struct rho_accumulator_result){.num_peaks = pass.list.num_peaks,
                                        .peaks_dropped = pass.list.peaks_dropped,
                                        .votes = votes < UINT32_MAX ? (uint32_t)votes : UINT32_MAX,
                                        .votes_max = pass.list.votes_max};
    return RHO_OK;
}

enum rho_status rho_accumulator_plane(struct rho_accumulator *accumulator,
                                      const struct rho_accumulator_points *points,
                                      struct rho_votes_picture *plane)
{
    enum rho_status status = check_search(accumulator, points);
    if (status == RHO_OK) {
        status = rho_votes_picture_init(plane, accumulator->theta_cells, accumulator->rho_cells);
    }
    if (status == RHO_OK) {
        struct rho_accumulator_pass pass = {
            .accumulator = accumulator, .points = points, .plane = plane, .list = {.min_votes = 1}};
        search(&pass);
    }
    return status;
}
