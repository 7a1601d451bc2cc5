/* SPDX-License-Identifier: MIT */
/*
 * accumulator_peak_search: public calls of the accumulator: set-up, checks of the points, and the
 * choice between two searches: all rows of theta (accumulator_row_votes_and_peaks.c), or only rows
 * and points that can reach a peak (accumulator_branch_and_bound.c).
 */
#include "rhotrack/detail/accumulator.h"

#include <string.h>

#include "accumulator_peak_search.h"
#include "rhotrack/types.h"

#define ACCUMULATOR_MAGIC 0x41434355u /* "ACCU" in ASCII */

/*
 * With at most this many points (rho cells / 8 + 64), clearing only the touched cells is faster
 * than clearing the whole row, as measured with and without pruning.
 */
#define SPARSE_CELLS 8u
#define SPARSE_POINTS 64u
/* smallest min_votes with pruning: with two votes by chance nearly every row has a cell */
#define PRUNED_VOTES 3u
/* scans that the bits of a narrow (8-bit) cell can hold */
#define NARROW_SCANS (8u * sizeof(uint8_t))
#define NARROW_POINTS UINT8_MAX

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

static int are_coordinates_valid(const struct rho_accumulator_points *points, unsigned num_points)
{
    for (unsigned i = 0; i < num_points; i++) {
        if (!rho_is_coordinate(points->x_m[i]) || !rho_is_coordinate(points->y_m[i])) {
            return 0;
        }
    }
    return 1;
}

static int are_scan_ends_in_order(const struct rho_accumulator_points *points)
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

enum rho_status rho_accumulator_check_points(const struct rho_accumulator_points *points)
{
    if (!points || (points->num_scans > 0 && !points->scan_end)) {
        return RHO_ERROR_NULL;
    }
    if (!are_scan_ends_in_order(points)) {
        return RHO_ERROR_VALUE;
    }
    unsigned num_points = count_points(points);
    if (num_points > 0 && (!points->x_m || !points->y_m)) {
        return RHO_ERROR_NULL;
    }
    return are_coordinates_valid(points, num_points) ? RHO_OK : RHO_ERROR_VALUE;
}

/*
 * Square of the distance from the origin within which points lie inside the cells of rho in all
 * rows; 0: no such distance.
 */
static float radius2_inside_all_rho_cells_m2(const struct rho_accumulator *accumulator)
{
    const struct rho_accumulator_config *config = &accumulator->config;
    float last_m = (float)accumulator->rho_cells * config->rho_cell_m - config->rho_max_m;
    float least_m = last_m < config->rho_max_m ? last_m : config->rho_max_m;
    float inside_m = least_m - RHO_ACCUMULATOR_ROUNDING * config->rho_cell_m;
    return inside_m > 0.0f ? inside_m * inside_m : 0.0f;
}

/* Mask of the scans that have points that may lie beyond rho_max_m: bit m for scan m. */
static unsigned mask_of_scans_with_points_beyond_rho_max(const struct rho_accumulator_pass *pass)
{
    const struct rho_accumulator_points *points = pass->points;
    float inside2 = radius2_inside_all_rho_cells_m2(pass->accumulator);
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

/* Chooses cells of 8 or 16 bits, sparse or dense rows, and whether rows are pruned. */
static void choose_row_format_and_pruning(struct rho_accumulator_pass *pass)
{
    const struct rho_accumulator_config *config = &pass->accumulator->config;
    pass->counts_points = config->votes == RHO_VOTES_POINTS;
    pass->is_narrow = pass->counts_points ? pass->num_points <= NARROW_POINTS
                                          : pass->points->num_scans <= NARROW_SCANS;
    pass->is_sparse =
        pass->num_points <= RHO_ACCUMULATOR_SPARSE_MAX &&
        pass->num_points <= pass->accumulator->rho_cells / SPARSE_CELLS + SPARSE_POINTS;
    pass->scans_outside = mask_of_scans_with_points_beyond_rho_max(pass);
    pass->is_pruned = pass->is_sparse && pass->scans_outside == 0 && !config->no_pruning &&
                      config->min_votes >= PRUNED_VOTES;
}

/* Clears the three rows and their lists of touched and reached cells. */
static void clear_rows(struct rho_accumulator_pass *pass)
{
    struct rho_accumulator *accumulator = pass->accumulator;
    size_t cells = accumulator->rho_cells + RHO_ACCUMULATOR_PADDING;
    for (unsigned slot = 0; slot < 3; slot++) {
        memset(accumulator->rows[slot], 0, cells * (pass->is_narrow ? 1u : 2u));
        accumulator->num_touched[slot] = accumulator->num_reached[slot] = 0;
    }
}

enum rho_status rho_accumulator_find_peaks(struct rho_accumulator *accumulator,
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
    enum rho_status status = rho_accumulator_check_points(points);
    if (status != RHO_OK) {
        return status;
    }
    unsigned num_points = count_points(points);
    if (num_points == 0) { /* without points the arrays may be NULL, so that nothing is searched */
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
    choose_row_format_and_pruning(&pass);
    if (pass.is_sparse) {
        clear_rows(&pass);
    } else {
        memset(accumulator->room.scan, 0, sizeof accumulator->room.scan);
    }
    if (pass.is_pruned) {
        rho_accumulator_search_pruned(&pass);
    } else {
        rho_accumulator_search_all_rows(&pass);
    }
    rho_peak_list_drop_weak_and_sort(&pass.list);
    *result = (struct rho_accumulator_result){.num_peaks = pass.list.num_peaks,
                                              .peaks_dropped = pass.list.peaks_dropped,
                                              .votes = pass.votes,
                                              .votes_max = pass.list.votes_max};
    return RHO_OK;
}
