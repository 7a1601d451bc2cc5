/* SPDX-License-Identifier: MIT */
#include "rhotrack/initiator.h"

#include <string.h>

#include "candidates.h"
#include "clutter_density.h"
#include "kernels.h"
#include "policy.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "target_model.h"

#define INITIATOR_MAGIC 0x494e4954u /* "INIT" */

/* The build fails where the RAM formula of config.h is no longer an upper bound. */
typedef char rho_assert_window_ram[sizeof(struct rho_window) <= RHO_RAM_WINDOW_BYTES ? 1 : -1];
typedef char
    rho_assert_initiator_ram[sizeof(struct rho_initiator) <= RHO_RAM_INITIATOR_BYTES ? 1 : -1];

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
    /* velocities below 0.01 m/s are not resolved in float32 */
    return config->scans >= 3 && config->scans <= RHO_MAX_SCANS &&
           (config->min_scans == 0 ||
            (config->min_scans >= 3 && config->min_scans <= config->scans)) &&
           rho_is_within(config->v_min_mps, 0.0f, RHO_LIMIT_SPEED_MPS) &&
           rho_is_within(config->v_max_mps, 0.01f, RHO_LIMIT_SPEED_MPS) &&
           config->v_min_mps < config->v_max_mps && rho_is_within(config->pd, 0.01f, 0.999f) &&
           (rho_is_equal(config->false_tracks_per_hour, 0.0f) ||
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
        rho_window_init(&initiator->window, sizeof initiator->window, copy.scans, area);
    if (status != RHO_OK) {
        return status;
    }
    memset(initiator, 0, offsetof(struct rho_initiator, window));
    initiator->config = copy;
    initiator->magic = INITIATOR_MAGIC;
    return RHO_OK;
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
    const struct rho_initiator_config *was = &initiator->config;
    if (config->scans != was->scans || config->area_is_fixed != was->area_is_fixed ||
        (config->area_is_fixed && (!rho_is_equal(config->area.x_min_m, was->area.x_min_m) ||
                                   !rho_is_equal(config->area.x_max_m, was->area.x_max_m) ||
                                   !rho_is_equal(config->area.y_min_m, was->area.y_min_m) ||
                                   !rho_is_equal(config->area.y_max_m, was->area.y_max_m)))) {
        const enum rho_status status =
            rho_window_init(&initiator->window, sizeof initiator->window, config->scans,
                            config->area_is_fixed ? &config->area : 0);
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
    /* before the oldest scan is overwritten, unless the push will be refused */
    if (RHO_MAX_CLUTTER_CELLS > 0 && initiator->window.num_scans == initiator->config.scans &&
        rho_window_check_push(&initiator->window, scan, fates, left_unused) == RHO_OK &&
        !rho_window_continues_newest(&initiator->window, scan, sensor)) {
        rho_clutter_memory_add(initiator);
    }
    enum rho_status status = rho_window_push(&initiator->window, scan, sensor, fates, left_unused);
    if (status == RHO_OK) {
        initiator->num_candidates = 0;
        /* a sector that changes the quantities measured needs thresholds of its own */
        initiator->has_revolution &=
            initiator->window.is_continued && !initiator->window.is_remeasured;
    }
    return status;
}

/*
 * Sets the scans' times relative to the newest, and the usual interval: the mean, with pauses
 * limited to PAUSE_GAPS times the median. The sides of an area that is not given become at least as
 * long as the travel of the fastest target within the window.
 */
static void set_scan_times(struct search *search)
{
    struct rho_window *window = &search->initiator->window;
    const int64_t newest_us = rho_search_scan(search, search->num_scans - 1u)->time_us;
    float gaps[RHO_MAX_SCANS] = {0.0f}; /* in ascending order */
    unsigned n = 0;
    for (unsigned m = 0; m < search->num_scans; m++) {
        search->time_s[m] = rho_seconds_between(newest_us, rho_search_scan(search, m)->time_us);
        if (m > 0) {
            float gap_s = search->time_s[m] - search->time_s[m - 1u];
            unsigned place = n++;
            while (place > 0 && gaps[place - 1u] > gap_s) {
                gaps[place] = gaps[place - 1u];
                place--;
            }
            gaps[place] = gap_s;
        }
    }
    float most_s = PAUSE_GAPS * gaps[n / 2u], sum_s = 0.0f;
    for (unsigned i = 0; i < n; i++) {
        sum_s += gaps[i] < most_s ? gaps[i] : most_s;
    }
    search->interval_s = n > 0 ? sum_s / (float)n : 0.0f;
    if (!window->area_is_fixed) {
        window->side_min_m = search->interval_s * (float)(search->num_scans - 1u) *
                             search->initiator->config.v_max_mps;
    }
}

/* Sets the scans that must vote, the gate, the kind of noise, the newest sector and the times. */
static void set_up_search(struct search *search)
{
    struct rho_initiator *initiator = search->initiator;
    const int is_newest = search->kind == RHO_SEARCH_NEWEST;
    float newest_rad = 0.0f, widest_rad = 0.0f;
    uint32_t measures = 0;
    int is_isotropic = 1;
    for (unsigned m = 0; m < search->num_scans; m++) {
        const struct rho_window_scan *scan = rho_search_scan(search, m);
        measures |= scan->measures;
        is_isotropic = is_isotropic && scan->is_isotropic;
        if (RHO_SECTORS) {
            newest_rad = rho_angle_sector_width(scan->sector_from_rad, scan->sector_to_rad);
            widest_rad = newest_rad > widest_rad ? newest_rad : widest_rad;
        }
    }
    search->wanted_mask = is_newest ? 1u << (search->num_scans - 1u) : 0u;
    search->scans_seen = (float)search->num_scans;
    search->has_more = (measures & (RHO_MEASURES_Z | RHO_MEASURES_RANGE_RATE)) != 0;
    search->gate_chi2 = search->has_more ? RHO_GATE_CHI2_4D : RHO_GATE_CHI2_2D;
    search->has_one_noise = is_isotropic && !search->has_more;
    rho_target_assume_turns(search, 0);
    if (RHO_SECTORS) {
        /*
         * the newest scan counts by its share of a revolution. Where an earlier sector of the same
         * revolution was searched, its density map and thresholds hold
         */
        search->scans_seen = (float)(search->num_scans - 1u) + newest_rad / widest_rad;
        search->is_continued =
            is_newest && initiator->window.is_continued && initiator->has_revolution;
        initiator->has_revolution = (uint16_t)is_newest;
        if (is_newest && (search->is_continued || !initiator->window.is_continued)) {
            search->newest = &initiator->window.newest;
        }
    }
    set_scan_times(search);
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
    set_up_search(&search);
    rho_target_model_set(&search);
    rho_density_begin(&search);
    rho_vote_gates_bound(&search);
    rho_thresholds_set(&search);
    if (search.num_scans >= 3 && search.num_scans >= search.min_scans) {
        rho_kernels_try_straight(&search);
        /* turning targets have the work that straight ones left */
        if (kind == RHO_SEARCH_NEWEST && initiator->config.turn_mps2 > 0.0f && !search.is_partial &&
            search.min_scans < search.num_scans) {
            /* one vote more than for straight targets, as clutter forms turns more easily */
            search.min_scans++;
            search.log_turning = rho_thresholds_log_turn(&search);
            rho_target_assume_turns(&search, 1);
            /* turns widen the gates beyond the bound that noise gives */
            search.sigma_least_m = 0.0f;
            rho_kernels_try_turning(&search);
            search.min_scans--;
        }
        rho_candidates_select(&search);
        if (search.keeps_rate) {
            rho_candidates_rescore(&search);
        }
    }
    rho_search_record_work(&search);
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
