/* SPDX-License-Identifier: MIT */
/*
 * accumulator_search: public calls of the accumulator: set-up, checks of the points, and the
 * choice between two searches: all rows of theta (accumulator_rows.c), or only rows
 * and points that can reach a peak (accumulator_pruning.c).
 */
#include "rhotrack/detail/accumulator.h"

#include <string.h>

#include "accumulator_search.h"
#include "policy.h"
#include "rhotrack/types.h"

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

/* Mask of the scans that have points that may lie beyond rho_max_m: bit m for scan m. */
static unsigned scans_beyond_rho_max(const struct rho_accumulator_pass *pass)
{
    const struct rho_accumulator_config *config = &pass->accumulator->config;
    const struct rho_accumulator_points *points = pass->points;
    /* points within inside_m of the origin lie inside the cells of rho in all rows */
    float last_m = (float)pass->accumulator->rho_cells * config->rho_cell_m - config->rho_max_m;
    float least_m = last_m < config->rho_max_m ? last_m : config->rho_max_m;
    float inside_m = least_m - RHO_ACCUMULATOR_ROUNDING * config->rho_cell_m;
    float inside2 = inside_m > 0.0f ? inside_m * inside_m : 0.0f;
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
    const struct rho_accumulator_config *config = &accumulator->config;
    struct rho_accumulator_pass pass = {.accumulator = accumulator,
                                        .points = points,
                                        .list = {.peaks = peaks,
                                                 .max_peaks = max_peaks,
                                                 .min_votes = config->min_votes,
                                                 .min_share = config->min_share},
                                        .num_points = num_points,
                                        .neighbours = config->neighbours};
    /* a narrow cell of 8 bits holds the bits of 8 scans, or a count of points to 255 */
    pass.counts_points = config->votes == RHO_VOTES_POINTS;
    pass.is_narrow = pass.counts_points ? num_points <= UINT8_MAX : points->num_scans <= 8u;
    pass.is_sparse = num_points <= RHO_ACCUMULATOR_SPARSE_MAX &&
                     num_points <= accumulator->rho_cells / SPARSE_CELLS + SPARSE_POINTS;
    pass.scans_outside = scans_beyond_rho_max(&pass);
    int is_pruned = pass.is_sparse && pass.scans_outside == 0 && !config->no_pruning &&
                    config->min_votes >= PRUNED_VOTES;
    if (pass.is_sparse) {
        size_t cells = accumulator->rho_cells + RHO_ACCUMULATOR_PADDING;
        for (unsigned slot = 0; slot < 3; slot++) {
            memset(accumulator->rows[slot], 0, cells * (pass.is_narrow ? 1u : 2u));
            accumulator->num_touched[slot] = accumulator->num_reached[slot] = 0;
        }
    } else {
        memset(accumulator->room.scan, 0, sizeof accumulator->room.scan);
    }
    if (is_pruned) {
        rho_accumulator_search_pruned(&pass);
    } else {
        rho_accumulator_search_rows(&pass);
    }
    rho_peak_list_sort(&pass.list);
    *result = (struct rho_accumulator_result){.num_peaks = pass.list.num_peaks,
                                              .peaks_dropped = pass.list.peaks_dropped,
                                              .votes = pass.votes,
                                              .votes_max = pass.list.votes_max};
    return RHO_OK;
}
