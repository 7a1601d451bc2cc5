/* SPDX-License-Identifier: MIT */
/*
 * accumulator_pruning: branch and bound over intervals of theta rows. src/DESIGN.md,
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
#include <string.h>

#include "accumulator_search.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"

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
        rho_accumulator_vote_few(pass, row, of.num_points);
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

void rho_accumulator_search_few(struct rho_accumulator_pass *pass, int is_pruned)
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
