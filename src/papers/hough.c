/* SPDX-License-Identifier: MIT */
/* hough: configuration of the methods, passes over rows of theta, thresholds, suppression. */
#include "rhotrack/hough.h"

#include "hough_search.h"
#include "rhotrack/detail/approx.h"

enum { HOUGH_MAGIC = 0x434c4153 }; /* "CLAS" in ASCII */

/* The build fails where the RAM formula of config.h is no longer an upper bound. */
typedef char rho_assert_hough_ram[sizeof(struct rho_hough) <= RHO_RAM_HOUGH_BYTES ? 1 : -1];

void rho_hough_config_default(struct rho_hough_config *config, enum rho_hough_method method)
{
    *config = (struct rho_hough_config){.method = method,
                                        .rho_max_m = 2.5f * (float)RHO_MAX_RHO_CELLS,
                                        .rho_cell_m = 5.0f,
                                        .theta_cell_rad = 0.001f,
                                        .eps_rho_m = 20.0f,
                                        .eps_theta_rad = 0.004f,
                                        .v_min_mps = 100.0f,
                                        .v_max_mps = 400.0f,
                                        .p_false = 0.01f,
                                        .lambda_k = 1.0f,
                                        .votes = RHO_VOTES_POINTS,
                                        .tau = 0.5f};
}

static struct rho_accumulator_config accumulator_config_of(const struct rho_hough_config *config)
{
    return (struct rho_accumulator_config){.rho_max_m = config->rho_max_m,
                                           .rho_cell_m = config->rho_cell_m,
                                           .theta_cell_rad = config->theta_cell_rad,
                                           .votes = config->votes,
                                           .min_votes = 1,
                                           .min_share = config->tau};
}

/* Cells within 2 eps, with 1/100 of a cell for rounding. */
static float cells_of_eps(float eps, float cell)
{
    return 2.0f * eps / cell + 0.01f;
}

enum rho_status rho_hough_init(struct rho_hough *hough, size_t object_size,
                               const struct rho_hough_config *config)
{
    if (!hough || !config) {
        return RHO_ERROR_NULL;
    }
    if (object_size != sizeof *hough) {
        return RHO_ERROR_SIZE;
    }
    struct rho_accumulator_config plane = accumulator_config_of(config);
    uint16_t theta_cells, rho_cells;
    if (rho_accumulator_count_cells(&plane, &theta_cells, &rho_cells) != RHO_OK ||
        (unsigned)config->method > RHO_HOUGH_NHT_C || !rho_is_within(config->p_false, 0.0f, 1.0f) ||
        !rho_is_within(config->lambda_k, 0.0f, 1.0e6f) || !rho_is_within(config->tau, 0.0f, 1.0f) ||
        !rho_is_within(config->votes_min, 0.0f, (float)UINT16_MAX) ||
        !rho_is_within(config->eps_rho_m, 0.001f, RHO_LIMIT_POSITION_M) ||
        !rho_is_within(config->eps_theta_rad, 1.0e-4f, 0.5f) ||
        !(cells_of_eps(config->eps_rho_m, config->rho_cell_m) < RHO_HOUGH_REACH_MAX + 1.0f) ||
        !(cells_of_eps(config->eps_theta_rad, config->theta_cell_rad) <
          RHO_HOUGH_REACH_MAX + 1.0f) ||
        !rho_is_within(config->v_max_mps, 0.0f, RHO_LIMIT_SPEED_MPS) ||
        !rho_is_within(config->v_min_mps, 0.0f, config->v_max_mps) ||
        !(config->v_min_mps < config->v_max_mps)) {
        return RHO_ERROR_CONFIG;
    }
    hough->config = *config;
    hough->theta_cells = theta_cells;
    hough->rho_cells = rho_cells;
    hough->theta_reach = (uint16_t)cells_of_eps(config->eps_theta_rad, config->theta_cell_rad);
    hough->rho_reach = (uint16_t)cells_of_eps(config->eps_rho_m, config->rho_cell_m);
    hough->magic = HOUGH_MAGIC;
    return RHO_OK;
}

/* True for a time within 1e9 s: its differences have a meaning in float32. */
static int is_time(float t_s)
{
    return rho_is_within(t_s, -1.0e9f, 1.0e9f);
}

static enum rho_status check_points(const struct rho_hough *hough,
                                    const struct rho_hough_points *points)
{
    if (!hough || !points) {
        return RHO_ERROR_NULL;
    }
    if (hough->magic != HOUGH_MAGIC) {
        return RHO_ERROR_STATE;
    }
    enum rho_status status = rho_accumulator_check_points(&points->at);
    if (status != RHO_OK) {
        return status;
    }
    if (rho_hough_scan_start(points, points->at.num_scans) > 0 && !points->t_s) {
        return RHO_ERROR_NULL;
    }
    for (unsigned scan = 0; scan < points->at.num_scans; scan++) {
        uint32_t start = rho_hough_scan_start(points, scan), end = points->at.scan_end[scan];
        if (end - start > UINT16_MAX) {
            return RHO_ERROR_VALUE;
        }
        for (uint32_t i = start; i < end; i++) {
            if (!is_time(points->t_s[i])) {
                return RHO_ERROR_VALUE;
            }
        }
    }
    return RHO_OK;
}

static uint32_t count_pairs(const struct rho_hough_points *points)
{
    uint64_t pairs = 0;
    for (unsigned scan = 1; scan < points->at.num_scans; scan++) {
        uint32_t start = rho_hough_scan_start(points, scan);
        uint64_t before = start - rho_hough_scan_start(points, scan - 1u);
        pairs += before * (points->at.scan_end[scan] - start);
    }
    return pairs < UINT32_MAX ? (uint32_t)pairs : UINT32_MAX;
}

void rho_hough_count_pairs(const struct rho_hough *hough, const struct rho_hough_points *points,
                           uint32_t *pairs, uint32_t *candidates)
{
    *pairs = count_pairs(points);
    *candidates = 0;
    for (unsigned scan = 1; scan < points->at.num_scans; scan++) {
        uint32_t from = rho_hough_scan_start(points, scan), end = points->at.scan_end[scan];
        for (uint32_t i = rho_hough_scan_start(points, scan - 1u); i < from; i++) {
            for (uint32_t j = from; j < end; j++) {
                struct rho_hough_pair pair = {i, j};
                *candidates = rho_count(*candidates, rho_hough_speed_check(hough, points, pair) ==
                                                         RHO_SPEED_WITHIN);
            }
        }
    }
}

/* Number of votes rounded up to a whole number, at least 1. */
static uint32_t round_up_votes(float votes)
{
    uint32_t below = (uint32_t)votes;
    uint32_t whole = (float)below < votes ? below + 1u : below;
    return whole > 0 ? whole : 1u;
}

static enum rho_status init_accumulator(struct rho_hough *hough)
{
    struct rho_accumulator_config plane = accumulator_config_of(&hough->config);
    plane.min_votes = (uint16_t)round_up_votes(hough->config.votes_min);
    return rho_accumulator_init(&hough->work.accumulator, sizeof hough->work.accumulator, &plane);
}

/* Method HT: the accumulator lets every plot vote, and finds the peaks. */
static enum rho_status find_ht_peaks(struct rho_hough *hough, const struct rho_hough_points *points,
                                     struct rho_accumulator_peak *peaks, uint32_t max_peaks,
                                     struct rho_hough_result *result)
{
    struct rho_accumulator *accumulator = &hough->work.accumulator;
    struct rho_accumulator_result found;
    enum rho_status status = init_accumulator(hough);
    if (status == RHO_OK) {
        status = rho_accumulator_find_peaks(accumulator, &points->at, peaks, max_peaks, &found);
    }
    if (status != RHO_OK) {
        return status;
    }
    for (uint32_t i = 0; i < found.num_peaks; i++) {
        peaks[i].votes *= RHO_HOUGH_VOTE;
    }
    *result = (struct rho_hough_result){.num_peaks = found.num_peaks,
                                        .cells_dropped = found.peaks_dropped,
                                        .votes = found.votes,
                                        .votes_max = found.votes_max * RHO_HOUGH_VOTE,
                                        .passes = 1};
    return RHO_OK;
}

static struct rho_hough_rows widened_rows(const struct rho_hough *hough, struct rho_hough_rows rows,
                                          int32_t by_rows)
{
    int32_t all = hough->theta_cells, first = rows.first - by_rows;
    if (rows.count + 2 * by_rows >= all) {
        return (struct rho_hough_rows){0, all};
    }
    return (struct rho_hough_rows){first < 0 ? first + all : first, rows.count + 2 * by_rows};
}

/* Slots of a hash table: at least twice the entries, a power of two; small ones clear faster. */
static uint32_t hash_size_for(uint32_t entries)
{
    uint32_t size = 256;
    while (size < RHO_MAX_HOUGH_CELLS && size / 2u < entries) {
        size *= 2u;
    }
    return size;
}

static struct rho_hough_pass begin_pass(struct rho_hough *hough,
                                        const struct rho_hough_points *points,
                                        enum rho_hough_component component, int32_t first,
                                        int32_t count)
{
    struct rho_hough_pass pass = {.hough = hough,
                                  .points = points,
                                  .wanted = {first, count},
                                  .component = component,
                                  .table_size = hash_size_for(count_pairs(points)),
                                  .stops_when_full = count > 1};
    int is_spread = hough->config.method == RHO_HOUGH_NHT_C;
    float cell_rad = hough->config.theta_cell_rad;
    pass.voting = widened_rows(hough, pass.wanted, is_spread ? hough->theta_reach : 0);
    /* two rows more: one for the part of a cell in 2 eps, one as the last row may be narrower */
    pass.held = widened_rows(hough, pass.voting,
                             rho_hough_uses_kernels(hough) ? hough->theta_reach + 2 : 0);
    /* the normals at the borders of the held rows, one row more at either end */
    float from_rad = (float)(pass.held.first - 1) * cell_rad;
    float to_rad = (float)(pass.held.first + pass.held.count + 1) * cell_rad;
    /* as lines at theta + pi are lines at theta, only sectors below half a turn reject lines */
    pass.can_reject = to_rad - from_rad < RHO_PI;
    pass.from_x = rho_cos(from_rad);
    pass.from_y = rho_sin(from_rad);
    pass.to_x = rho_cos(to_rad);
    pass.to_y = rho_sin(to_rad);
    return pass;
}

/*
 * Votes of all rows, in as many passes as the tables need, into the list of peaks, or into the
 * plane where list is NULL. A pass that overflows is repeated with half its rows; one that leaves
 * two thirds of its tables free doubles them.
 */
static void run_passes(struct rho_hough *hough, const struct rho_hough_points *points,
                       enum rho_hough_component component, struct rho_votes_picture *plane,
                       struct rho_peak_list *list, struct rho_hough_result *result)
{
    int32_t all = hough->theta_cells, rows = all;
    *result = (struct rho_hough_result){.pairs = count_pairs(points)};
    for (int32_t first = 0; first < all;) {
        int32_t count = all - first < rows ? all - first : rows;
        struct rho_hough_pass pass = begin_pass(hough, points, component, first, count);
        const struct rho_hough_result *found = &pass.found;
        pass.plane = plane;
        rho_hough_vote_pairs(&pass);
        if (pass.is_full && count > 1) {
            rows = count / 2;
            continue;
        }
        rho_hough_collect_cells(&pass, list);
        result->candidates = found->candidates; /* all passes count the same candidates */
        result->votes = rho_count(result->votes, found->votes);
        result->cells = rho_count(result->cells, found->cells);
        result->votes_dropped = rho_count(result->votes_dropped, found->votes_dropped);
        result->kernels_dropped = rho_count(result->kernels_dropped, found->kernels_dropped);
        result->passes++;
        first += count;
        int has_room = pass.num_cells < RHO_MAX_HOUGH_CELLS / 3u &&
                       pass.most_kernels < RHO_MAX_HOUGH_KERNELS / 3u;
        rows = has_room && rows < all ? 2 * rows : rows;
    }
}

enum rho_status rho_hough_find(struct rho_hough *hough, const struct rho_hough_points *points,
                               struct rho_accumulator_peak *peaks, uint32_t max_peaks,
                               struct rho_hough_result *result)
{
    enum rho_status status = check_points(hough, points);
    if (status != RHO_OK) {
        return status;
    }
    if (!result || (max_peaks > 0 && !peaks)) {
        return RHO_ERROR_NULL;
    }
    if (hough->config.method == RHO_HOUGH_HT) {
        status = find_ht_peaks(hough, points, peaks, max_peaks, result);
    } else {
        struct rho_peak_list list = {
            .peaks = peaks,
            .max_peaks = max_peaks,
            .min_votes = round_up_votes(hough->config.votes_min * (float)RHO_HOUGH_VOTE),
            .min_share = hough->config.tau};
        run_passes(hough, points, RHO_HOUGH_VOTES, NULL, &list, result);
        rho_peak_list_sort(&list);
        result->num_peaks = list.num_peaks;
        result->cells_dropped = list.peaks_dropped;
        result->votes_max = list.votes_max;
    }
    if (status == RHO_OK && !hough->config.keeps_all_cells) {
        const struct rho_peak_distance distance = {.theta_cells = hough->theta_cells,
                                                   .rho_cells = hough->rho_cells,
                                                   .theta = hough->theta_reach,
                                                   .rho = hough->rho_reach};
        result->num_peaks = rho_peak_list_suppress(peaks, result->num_peaks, &distance);
    }
    return status;
}

/* Method HT: the accumulator notes its votes, in units of 1 / RHO_HOUGH_VOTE. */
static enum rho_status note_ht_votes(struct rho_hough *hough, const struct rho_hough_points *points,
                                     struct rho_votes_picture *plane)
{
    enum rho_status status = init_accumulator(hough);
    if (status == RHO_OK) {
        status = rho_accumulator_plane(&hough->work.accumulator, &points->at, plane);
    }
    for (unsigned i = 0; status == RHO_OK && i < (unsigned)plane->height * plane->width; i++) {
        plane->votes[i] *= RHO_HOUGH_VOTE;
    }
    return status;
}

enum rho_status rho_hough_plane(struct rho_hough *hough, const struct rho_hough_points *points,
                                enum rho_hough_component component, struct rho_votes_picture *plane)
{
    struct rho_hough_result result;
    enum rho_status status = check_points(hough, points);
    if (status != RHO_OK) {
        return status;
    }
    if ((unsigned)component >= RHO_NUM_HOUGH_COMPONENTS ||
        (component != RHO_HOUGH_VOTES && !rho_hough_uses_kernels(hough))) {
        return RHO_ERROR_VALUE;
    }
    if (hough->config.method == RHO_HOUGH_HT) {
        return note_ht_votes(hough, points, plane);
    }
    status = rho_votes_picture_init(plane, hough->theta_cells, hough->rho_cells);
    if (status == RHO_OK) {
        run_passes(hough, points, component, plane, NULL, &result);
    }
    return status;
}

/* Index of the scan that a plot belongs to; num_scans: no scan. */
static unsigned scan_of_plot(const struct rho_hough_points *points, uint32_t plot)
{
    unsigned scan = 0;
    while (scan < points->at.num_scans && plot >= points->at.scan_end[scan]) {
        scan++;
    }
    return scan;
}

enum rho_status rho_hough_vote(const struct rho_hough *hough, const struct rho_hough_points *points,
                               uint32_t first, uint32_t second,
                               struct rho_hough_memberships *memberships)
{
    const enum rho_status status = check_points(hough, points);
    if (status != RHO_OK) {
        return status;
    }
    if (!memberships) {
        return RHO_ERROR_NULL;
    }
    const unsigned scan = scan_of_plot(points, second);
    if (scan == points->at.num_scans || scan_of_plot(points, first) + 1u != scan) {
        return RHO_ERROR_VALUE;
    }
    *memberships =
        rho_hough_memberships_of_pair(hough, points, scan, (struct rho_hough_pair){first, second});
    return RHO_OK;
}

enum rho_status rho_hough_track(struct rho_hough *hough, const struct rho_hough_points *points,
                                unsigned theta_cell, unsigned rho_cell, float at_s,
                                struct rho_hough_track *track)
{
    enum rho_status status = check_points(hough, points);
    if (status != RHO_OK) {
        return status;
    }
    if (!track) {
        return RHO_ERROR_NULL;
    }
    if (theta_cell >= hough->theta_cells || rho_cell >= hough->rho_cells || !is_time(at_s)) {
        return RHO_ERROR_VALUE;
    }
    if (hough->config.method == RHO_HOUGH_HT) {
        status = init_accumulator(hough);
    }
    if (status == RHO_OK) {
        rho_hough_fit_track_to_voters(hough, points, theta_cell, rho_cell, at_s, track);
    }
    return status;
}
