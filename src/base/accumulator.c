/* SPDX-License-Identifier: MIT */
#include "rhotrack/accumulator.h"

#include <string.h>

#include "accumulator_pass.h"
#include "rhotrack/angle.h"
#include "rhotrack/approx.h"
#include "rhotrack/types.h"

#define ACCUMULATOR_MAGIC 0x41434355u /* "ACCU" */

#define THETA_CELL_MIN_RAD 1.0e-4f
/* So few points that what they touch is less work than the row; measured, with and without pruning. */
#define SPARSE_CELLS 8u
#define SPARSE_POINTS 64u
#define PRUNED_VOTES 3u /* two votes meet by chance nearly everywhere */
#define NARROW_SCANS 8u
#define NARROW_POINTS 255u

/* The build fails where the RAM formula of config.h is no longer an upper bound. */
typedef char rho_assert_accumulator_ram[sizeof(struct rho_accumulator) <= RHO_RAM_ACCUMULATOR_BYTES
                                            ? 1
                                            : -1];

/* ---- cells of points -------------------------------------------------------------------------- */

struct rho_accumulator_place rho_accumulator_place(const struct rho_accumulator *accumulator,
                                                   unsigned theta_cell)
{
    float theta_rad = rho_accumulator_theta_rad(accumulator, theta_cell);
    return (struct rho_accumulator_place){rho_cos(theta_rad) * accumulator->cells_per_m,
                                          rho_sin(theta_rad) * accumulator->cells_per_m,
                                          accumulator->first_cell};
}

void rho_accumulator_cells(const float *restrict x_m, const float *restrict y_m, unsigned n,
                           struct rho_accumulator_place place, int32_t *restrict cells)
{
    for (unsigned i = 0; i < n; i++) {
        cells[i] = (int32_t)(x_m[i] * place.by_x + y_m[i] * place.by_y + place.first);
    }
}

unsigned rho_accumulator_cells_within(const float *restrict x_m, const float *restrict y_m,
                                      unsigned n, struct rho_accumulator_place place, float last,
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

/* ---- public ----------------------------------------------------------------------------------- */

static int is_usable(const struct rho_accumulator_config *config)
{
    return rho_is_within(config->rho_cell_m, RHO_LIMIT_SIGMA_MIN, RHO_LIMIT_POSITION_M) &&
           rho_is_within(config->rho_max_m, 0.5f * config->rho_cell_m,
                         config->rho_cell_m * 0.5f * (float)RHO_MAX_RHO_CELLS) &&
           rho_is_within(config->theta_cell_rad, THETA_CELL_MIN_RAD, RHO_PI) &&
           /* the neighbours of a single row would be itself */
           (config->neighbours == 0 || config->theta_cell_rad < RHO_PI) &&
           (config->votes == RHO_VOTES_SCANS || config->votes == RHO_VOTES_POINTS) &&
           config->min_votes >= 1 && rho_is_within(config->min_share, 0.0f, 1.0f) &&
           config->no_pruning <= 1 &&
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

static int are_believed(const struct rho_accumulator_points *points, unsigned num_points)
{
    for (unsigned i = 0; i < num_points; i++) {
        if (!rho_is_coordinate(points->x_m[i]) || !rho_is_coordinate(points->y_m[i])) {
            return 0;
        }
    }
    return 1;
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

static unsigned count_points(const struct rho_accumulator_points *points)
{
    return points->num_scans > 0 ? points->scan_end[points->num_scans - 1u] : 0u;
}

enum rho_status rho_accumulator_check(const struct rho_accumulator_points *points)
{
    if (!points || (points->num_scans > 0 && !points->scan_end)) {
        return RHO_ERROR_NULL;
    }
    if (!are_in_order(points)) {
        return RHO_ERROR_VALUE;
    }
    unsigned num_points = count_points(points);
    if (num_points > 0 && (!points->x_m || !points->y_m)) {
        return RHO_ERROR_NULL;
    }
    return are_believed(points, num_points) ? RHO_OK : RHO_ERROR_VALUE;
}

/* The square of a distance from the origin within which no point is outside any row; 0 where there is none. */
static float inside2_m2(const struct rho_accumulator *accumulator)
{
    const struct rho_accumulator_config *config = &accumulator->config;
    float last_m = (float)accumulator->rho_cells * config->rho_cell_m - config->rho_max_m;
    float least_m = last_m < config->rho_max_m ? last_m : config->rho_max_m;
    float inside_m = least_m - RHO_ACCUMULATOR_ROUNDING * config->rho_cell_m;
    return inside_m > 0.0f ? inside_m * inside_m : 0.0f;
}

/* Which scans have points that may lie beyond rho_max_m: a bit each. */
static unsigned scans_outside(const struct rho_accumulator_pass *pass)
{
    const struct rho_accumulator_points *points = pass->points;
    float inside2 = inside2_m2(pass->accumulator);
    unsigned i = 0, scans = 0;
    for (unsigned scan = 0; scan < points->num_scans; scan++) {
        float farthest2 = 0.0f;
        for (; i < points->scan_end[scan]; i++) {
            float range2 = points->x_m[i] * points->x_m[i] + points->y_m[i] * points->y_m[i];
            farthest2 = range2 > farthest2 ? range2 : farthest2;
        }
        scans |= farthest2 < inside2 ? 0u : 1u << scan;
    }
    return scans;
}

static void choose_rows(struct rho_accumulator_pass *pass)
{
    const struct rho_accumulator_config *config = &pass->accumulator->config;
    pass->counts_points = config->votes == RHO_VOTES_POINTS;
    pass->is_narrow = pass->counts_points ? pass->num_points <= NARROW_POINTS
                                          : pass->points->num_scans <= NARROW_SCANS;
    pass->is_sparse =
        pass->num_points <= RHO_ACCUMULATOR_SPARSE_MAX &&
        pass->num_points <= pass->accumulator->rho_cells / SPARSE_CELLS + SPARSE_POINTS;
    pass->scans_outside = scans_outside(pass);
    pass->is_pruned = pass->is_sparse && pass->scans_outside == 0 && !config->no_pruning &&
                      config->min_votes >= PRUNED_VOTES;
}

/* Rows of few points are emptied by what touched them: at first nothing did. */
static void empty(struct rho_accumulator_pass *pass)
{
    struct rho_accumulator *accumulator = pass->accumulator;
    size_t cells = accumulator->rho_cells + RHO_ACCUMULATOR_PADDING;
    for (unsigned slot = 0; slot < 3; slot++) {
        memset(accumulator->rows[slot], 0, cells * (pass->is_narrow ? 1u : 2u));
        accumulator->num_touched[slot] = accumulator->num_reached[slot] = 0;
    }
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
    enum rho_status status = rho_accumulator_check(points);
    if (status != RHO_OK) {
        return status;
    }
    unsigned num_points = count_points(points);
    if (num_points == 0) { /* the arrays may be NULL */
        memset(result, 0, sizeof *result);
        return RHO_OK;
    }
    struct rho_accumulator_pass pass = {.accumulator = accumulator,
                                        .points = points,
                                        .list = {.peaks = peaks,
                                                 .max_peaks = max_peaks,
                                                 .min_votes = accumulator->config.min_votes,
                                                 .min_share = accumulator->config.min_share},
                                        .num_points = num_points,
                                        .neighbours = accumulator->config.neighbours};
    choose_rows(&pass);
    if (pass.is_sparse) {
        empty(&pass);
    } else {
        memset(accumulator->room.scan, 0, sizeof accumulator->room.scan);
    }
    if (pass.is_pruned) {
        rho_accumulator_prune(&pass);
    } else {
        rho_accumulator_stream(&pass);
    }
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
    unsigned outside = rho_accumulator_cells_within(
        &x_m, &y_m, 1, rho_accumulator_place(accumulator, theta_cell), last, &cell);
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
