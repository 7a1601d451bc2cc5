/* SPDX-License-Identifier: MIT */
#include "rhotrack/initiator.h"

#include <string.h>

#include "rhotrack/detail/angle.h"
#include "search.h"

/*
 * Longest interval between scans that counts in the usual interval, in medians: a pause counts as
 * that.
 */
#define PAUSE_GAPS 3.0f

/* Smallest v_max that is accepted: velocities below are not resolved in float32. */
#define V_MAX_LEAST_MPS 0.01f

#define INITIATOR_MAGIC 0x494e4954u /* "INIT" */

/* The build fails where the RAM formula of config.h is no longer an upper bound. */
typedef char rho_assert_window_ram[sizeof(struct rho_window) <= RHO_RAM_WINDOW_BYTES ? 1 : -1];
typedef char
    rho_assert_initiator_ram[sizeof(struct rho_initiator) <= RHO_RAM_INITIATOR_BYTES ? 1 : -1];

/* ---- public ---------------------------------------------------------------------------------- */

void rho_initiator_config_default(struct rho_initiator_config *config)
{
    *config = (struct rho_initiator_config){
        .scans = RHO_MAX_SCANS < 7 ? RHO_MAX_SCANS : 7,
        .v_max_mps = 700.0f,
        .pd = 0.9f,
        .false_tracks_per_hour = 1.0f,
        .turn_mps2 = 6.0f,
        .work_max = RHO_WORK_MAX,
    };
}

int rho_initiator_is_usable_config(const struct rho_initiator_config *config)
{
    return config->scans >= 3 && config->scans <= RHO_MAX_SCANS &&
           (config->min_scans == 0 ||
            (config->min_scans >= 3 && config->min_scans <= config->scans)) &&
           rho_is_within(config->v_min_mps, 0.0f, RHO_LIMIT_SPEED_MPS) &&
           rho_is_within(config->v_max_mps, V_MAX_LEAST_MPS, RHO_LIMIT_SPEED_MPS) &&
           config->v_min_mps < config->v_max_mps && rho_is_within(config->pd, 0.01f, 0.999f) &&
           (rho_is_within(config->false_tracks_per_hour, 0.0f, 0.0f) ||
            rho_is_within(config->false_tracks_per_hour, 1e-6f, 1e6f)) &&
           rho_is_within(config->score_min_nat, -1000.0f, 1000.0f) &&
           rho_is_within(config->process_noise_mps2, 0.0f, 1000.0f) &&
           rho_is_within(config->turn_mps2, 0.0f, 1000.0f) && config->work_max <= RHO_LIMIT_WORK;
}

enum rho_status rho_initiator_init(struct rho_initiator *initiator, size_t size,
                                   const struct rho_initiator_config *config)
{
    if (!initiator || !config) {
        return RHO_ERROR_NULL;
    }
    if (size != sizeof *initiator) {
        return RHO_ERROR_SIZE;
    }
    if (!rho_initiator_is_usable_config(config)) {
        return RHO_ERROR_CONFIG;
    }
    const struct rho_extent *area = config->area_is_fixed ? &config->area : 0;
    struct rho_initiator_config copy = *config;
    enum rho_status status =
        rho_window_init(&initiator->window, sizeof initiator->window, copy.scans, area, 0.0f);
    if (status != RHO_OK) {
        return status;
    }
    memset(initiator, 0, offsetof(struct rho_initiator, window));
    initiator->config = copy;
    initiator->magic = INITIATOR_MAGIC;
    return RHO_OK;
}

static int are_different_areas(const struct rho_extent *a, const struct rho_extent *b)
{
    return !rho_is_within(a->x_min_m, b->x_min_m, b->x_min_m) ||
           !rho_is_within(a->x_max_m, b->x_max_m, b->x_max_m) ||
           !rho_is_within(a->y_min_m, b->y_min_m, b->y_min_m) ||
           !rho_is_within(a->y_max_m, b->y_max_m, b->y_max_m);
}

/* True where two configurations have windows of different sizes, or different areas. */
static int needs_new_window(const struct rho_initiator_config *a,
                            const struct rho_initiator_config *b)
{
    return a->scans != b->scans || a->area_is_fixed != b->area_is_fixed ||
           (a->area_is_fixed && are_different_areas(&a->area, &b->area));
}

enum rho_status rho_initiator_reconfigure(struct rho_initiator *initiator,
                                          const struct rho_initiator_config *config)
{
    if (!initiator || !config) {
        return RHO_ERROR_NULL;
    }
    if (initiator->magic != INITIATOR_MAGIC) {
        return RHO_ERROR_STATE;
    }
    if (!rho_initiator_is_usable_config(config)) {
        return RHO_ERROR_CONFIG;
    }
    if (needs_new_window(config, &initiator->config)) {
        const enum rho_status status =
            rho_window_init(&initiator->window, sizeof initiator->window, config->scans,
                            config->area_is_fixed ? &config->area : 0, 0.0f);
        if (status != RHO_OK) {
            return status;
        }
    }
    initiator->config = *config;
    initiator->num_candidates = 0;
    initiator->has_revolution = 0; /* the next search finds the thresholds anew */
    return RHO_OK;
}

int rho_initiator_accepts(const struct rho_initiator *initiator, int64_t time_us)
{
    return initiator->magic == INITIATOR_MAGIC && rho_window_accepts(&initiator->window, time_us);
}

enum rho_status rho_initiator_push(struct rho_initiator *initiator, const struct rho_scan *scan,
                                   const struct rho_sensor *sensor, uint8_t *fates,
                                   uint32_t *left_unused)
{
    if (!initiator) {
        return RHO_ERROR_NULL;
    }
    if (initiator->magic != INITIATOR_MAGIC) {
        return RHO_ERROR_STATE;
    }
    /*
     * the oldest scan is added to the clutter memory before it is overwritten, unless the push will
     * be refused
     */
    if (RHO_MAX_CLUTTER_CELLS > 0 && initiator->window.num_scans == initiator->config.scans &&
        rho_window_check_push(&initiator->window, scan, fates, left_unused) == RHO_OK &&
        !rho_window_is_next_sector_of_newest_scan(&initiator->window, scan, sensor)) {
        rho_initiator_remember_oldest_scan(initiator);
    }
    enum rho_status status = rho_window_push(&initiator->window, scan, sensor, fates, left_unused);
    if (status == RHO_OK) {
        initiator->num_candidates = 0;
        /*
         * the thresholds of a revolution do not hold for a sector that changes which quantities it
         * measures
         */
        initiator->has_revolution &=
            initiator->window.is_continued && !initiator->window.is_remeasured;
    }
    return status;
}

/* ---- the window as a search sees it ---------------------------------------------------------- */

static int measures_heights_or_rates(const struct search *search)
{
    uint32_t measures = 0;
    for (unsigned m = 0; m < search->num_scans; m++) {
        measures |= rho_window_scan_at(&search->initiator->window, m)->measures;
    }
    return (measures & (RHO_MEASURES_Z | RHO_MEASURES_RANGE_RATE)) != 0;
}

/*
 * True where every plot has the same noise along and across the line of sight, and no scan measures
 * heights or range rates.
 */
static int has_only_isotropic_positions(const struct search *search)
{
    for (unsigned m = 0; m < search->num_scans; m++) {
        const struct rho_window_scan *scan = rho_window_scan_at(&search->initiator->window, m);
        if (!scan->is_isotropic) {
            return 0;
        }
    }
    return !search->has_more;
}

/*
 * Usual time between scans: the mean interval, with pauses limited to PAUSE_GAPS times the median.
 */
static float usual_scan_interval_s(const struct search *search)
{
    float gaps[RHO_MAX_SCANS] = {0.0f};
    unsigned n = 0;
    for (unsigned m = 1; m < search->num_scans; m++) {
        float gap_s = search->time_s[m] - search->time_s[m - 1u];
        unsigned place = n++;
        while (place > 0 && gaps[place - 1u] > gap_s) {
            gaps[place] = gaps[place - 1u];
            place--;
        }
        gaps[place] = gap_s;
    }
    float most_s = PAUSE_GAPS * gaps[n / 2u], sum_s = 0.0f;
    for (unsigned i = 0; i < n; i++) {
        sum_s += gaps[i] < most_s ? gaps[i] : most_s;
    }
    return n > 0 ? sum_s / (float)n : 0.0f;
}

/*
 * Sets the scans' times relative to the newest, and the usual interval. The sides of an area that
 * is not given become at least as long as the travel of the fastest target within the window.
 */
static void set_scan_times_interval_and_least_area_side(struct search *search)
{
    struct rho_window *window = &search->initiator->window;
    int64_t newest_us = rho_window_scan_at(window, search->num_scans - 1u)->time_us;
    for (unsigned m = 0; m < search->num_scans; m++) {
        search->time_s[m] = rho_seconds_between(newest_us, rho_window_scan_at(window, m)->time_us);
    }
    search->interval_s = usual_scan_interval_s(search);
    if (!window->area_is_fixed) {
        window->side_min_m = search->interval_s * (float)(search->num_scans - 1u) *
                             search->initiator->config.v_max_mps;
    }
}

/* Sector width of the newest scan over the widest of the window: its share of a revolution. */
static float revolution_share_of_newest(struct search *search)
{
    float newest_rad = 0.0f, widest_rad = 0.0f;
    for (unsigned m = 0; m < search->num_scans; m++) {
        const struct rho_window_scan *scan = rho_window_scan_at(&search->initiator->window, m);
        newest_rad = rho_angle_sector_width(scan->sector_from_rad, scan->sector_to_rad);
        widest_rad = newest_rad > widest_rad ? newest_rad : widest_rad;
    }
    return newest_rad / widest_rad;
}

/*
 * Sets whether the newest input is a sector, and whether an earlier sector of the same revolution
 * was searched, whose density map and thresholds then hold.
 */
static void set_whether_sector_continues_revolution(struct search *search)
{
    struct rho_initiator *initiator = search->initiator;
    const int is_newest = search->kind == RHO_SEARCH_NEWEST;
    search->scans_seen = (float)(search->num_scans - 1u) + revolution_share_of_newest(search);
    search->is_continued = is_newest && initiator->window.is_continued && initiator->has_revolution;
    initiator->has_revolution = (uint16_t)is_newest;
    if (is_newest && (search->is_continued || !initiator->window.is_continued)) {
        search->newest = &initiator->window.newest;
    }
}

static void set_up_search_gate_sector_and_times(struct search *search)
{
    search->wanted_mask = search->kind == RHO_SEARCH_NEWEST ? 1u << (search->num_scans - 1u) : 0u;
    search->scans_seen = (float)search->num_scans;
    search->has_more = measures_heights_or_rates(search);
    search->gate_chi2 = search->has_more ? RHO_GATE_CHI2_4D : RHO_GATE_CHI2_2D;
    search->has_one_noise = has_only_isotropic_positions(search);
    rho_initiator_assume_turning_targets(search, 0);
    if (RHO_SECTORS) {
        set_whether_sector_continues_revolution(search);
    }
    set_scan_times_interval_and_least_area_side(search);
}

/* ---- search ---------------------------------------------------------------------------------- */

/* Searches for turning targets with the work that straight ones have left. */
static void try_turning_targets(struct search *search)
{
    const unsigned min_scans = search->min_scans;
    if (search->kind != RHO_SEARCH_NEWEST || !(search->initiator->config.turn_mps2 > 0.0f) ||
        search->is_partial) {
        return;
    }
    /* one vote more than for straight targets, as clutter forms turns more easily */
    search->min_scans++;
    if (search->min_scans <= search->num_scans) {
        search->log_turning = rho_initiator_log_turn_prior(search);
        rho_initiator_assume_turning_targets(search, 1);
        /* turns widen the gates beyond the bound that noise gives */
        search->sigma_least_m = 0.0f;
        rho_initiator_try_turning_kernels_with_work_left(search);
    }
    search->min_scans = min_scans;
}

enum rho_status rho_initiator_search(struct rho_initiator *initiator, enum rho_search kind)
{
    return rho_initiator_search_within(initiator, kind, initiator ? initiator->config.work_max : 0);
}

enum rho_status rho_initiator_search_within(struct rho_initiator *initiator, enum rho_search kind,
                                            uint32_t work_max)
{
    if (!initiator) {
        return RHO_ERROR_NULL;
    }
    if (initiator->magic != INITIATOR_MAGIC) {
        return RHO_ERROR_STATE;
    }
    struct search search = {
        .initiator = initiator,
        .kind = kind,
        .work_max = work_max,
        .num_scans = initiator->window.num_scans,
        .skip_flags = RHO_WINDOW_INITIATED,
        .keeps_rate = kind == RHO_SEARCH_NEWEST && initiator->config.false_tracks_per_hour > 0.0f,
    };
    initiator->num_candidates = 0;
    memset(&initiator->work, 0, sizeof initiator->work);
    initiator->budget.work = 0;
    if (search.num_scans == 0) {
        return RHO_OK;
    }
    set_up_search_gate_sector_and_times(&search);
    rho_initiator_set_process_noise(&search);
    rho_initiator_measure_or_keep_density(&search);
    rho_initiator_bound_noise_per_metre_of_range(&search);
    rho_initiator_set_pd_and_birth_prior(&search);
    rho_initiator_set_min_scans_and_thresholds(&search);
    if (search.num_scans >= 3 && search.num_scans >= search.min_scans) {
        rho_initiator_try_straight_kernels(&search);
        try_turning_targets(&search);
        rho_initiator_select_candidates(&search);
        if (search.keeps_rate) {
            rho_initiator_rescore_and_drop_weak(&search);
        }
    }
    rho_initiator_record_work_and_resume_place(&search);
    return RHO_OK;
}

unsigned rho_initiator_consume(struct rho_initiator *initiator,
                               const struct rho_candidate *candidate)
{
    unsigned used = 0;
    for (unsigned m = 0; m < initiator->window.num_scans; m++) {
        struct rho_window_scan *scan = rho_window_scan_at(&initiator->window, m);
        if (!((unsigned)candidate->mask >> m & 1u) ||
            (scan->marks[candidate->plot[m]] & RHO_WINDOW_INITIATED)) {
            continue;
        }
        scan->marks[candidate->plot[m]] |= RHO_WINDOW_INITIATED;
        scan->num_unused--;
        used++;
    }
    return used;
}
