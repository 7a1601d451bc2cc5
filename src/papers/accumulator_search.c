/* SPDX-License-Identifier: MIT */
/* accumulator_search: public calls of the accumulator: set-up, checks of the points, searches. */
#include "rhotrack/detail/accumulator.h"

#include "accumulator_search.h"
#include "policy.h"

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
        rho_accumulator_search_few(pass, !pass->has_outside && !accumulator->config.no_pruning &&
                                             pass->list.min_votes >= PRUNED_VOTES);
        return;
    }
    pass->is_narrow = pass->counts_points ? n <= UINT8_MAX : pass->points->num_scans <= 8u;
    for (unsigned theta_cell = 0; theta_cell < accumulator->theta_cells; theta_cell++) {
        rho_accumulator_vote_all(pass, theta_cell);
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
