/* SPDX-License-Identifier: MIT */
#include "rhotrack/initiator.h"

#include <string.h>

#include "initiator_search.h"

/* A pause counts as so many usual intervals. */
#define PAUSE_GAPS 3.0f

/* Slower "fastest targets" would leave no room for velocities in float32. */
#define V_MAX_LEAST_MPS 0.01f

#define INITIATOR_MAGIC 0x494e4954u /* "INIT" */

/* The build fails where the RAM formula of config.h is no longer an upper bound. */
typedef char rho_assert_window_ram[sizeof(struct rho_window) <= RHO_RAM_WINDOW_BYTES ? 1 : -1];
typedef char
    rho_assert_initiator_ram[sizeof(struct rho_initiator) <= RHO_RAM_INITIATOR_BYTES ? 1 : -1];

/* ---- public ----------------------------------------------------------------------------------- */

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

int rho_initiator_is_usable(const struct rho_initiator_config *config)
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
    if (!rho_initiator_is_usable(config)) {
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
#if RHO_MAX_CLUTTER_CELLS > 0
    /* what leaves is remembered before it is overwritten, unless the push is going to be refused */
    if (initiator->window.num_scans == initiator->config.scans &&
        rho_window_check_push(&initiator->window, scan, fates, left_unused) == RHO_OK &&
        !rho_window_goes_on(&initiator->window, scan, sensor)) {
        rho_initiator_remember(initiator);
    }
#endif
    enum rho_status status = rho_window_push(&initiator->window, scan, sensor, fates, left_unused);
    if (status == RHO_OK) {
        initiator->num_candidates = 0;
#if RHO_SECTORS
        /* other dimensions have other thresholds */
        initiator->has_turn &= initiator->window.is_continued && !initiator->window.is_remeasured;
#endif
    }
    return status;
}

static int has_more(const struct search *search)
{
    uint32_t measures = 0;
    for (unsigned m = 0; m < search->num_scans; m++) {
        measures |= rho_window_scan_at(&search->initiator->window, m)->measures;
    }
    return (measures & (RHO_MEASURES_Z | RHO_MEASURES_RANGE_RATE)) != 0;
}

/* Noise of one axis in every scan, and nothing else measured: the fast path. */
static int is_isotropic(const struct search *search)
{
    for (unsigned m = 0; m < search->num_scans; m++) {
        const struct rho_window_scan *scan = rho_window_scan_at(&search->initiator->window, m);
        if (!scan->is_isotropic) {
            return 0;
        }
    }
    return !search->has_more;
}

/* The usual time between scans: their mean, in which a pause counts as PAUSE_GAPS times the median. */
static float usual_interval_s(const struct search *search)
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

/* Times relative to the newest scan, and the least side of an area that is not given: what a target crosses
 * meanwhile. */
static void lay_times(struct search *search)
{
    struct rho_window *window = &search->initiator->window;
    int64_t newest_us = rho_window_scan_at(window, search->num_scans - 1u)->time_us;
    for (unsigned m = 0; m < search->num_scans; m++) {
        search->time_s[m] = rho_seconds_between(newest_us, rho_window_scan_at(window, m)->time_us);
    }
    search->interval_s = usual_interval_s(search);
    if (!window->area_is_fixed) {
        window->side_min_m = search->interval_s * (float)(search->num_scans - 1u) *
                             search->initiator->config.v_max_mps;
    }
}

#if RHO_SECTORS
/* Of a turn that is only begun, its share of the widest of the window's. */
static float share_of_newest(struct search *search)
{
    struct rho_window *window = &search->initiator->window;
    const float newest_rad = rho_window_scan_at(window, search->num_scans - 1u)->newest.width_rad;
    float widest_rad = newest_rad;
    for (unsigned m = 0; m < search->num_scans; m++) {
        const float width_rad = rho_window_scan_at(window, m)->newest.width_rad;
        widest_rad = width_rad > widest_rad ? width_rad : widest_rad;
    }
    return newest_rad / widest_rad;
}

static void use_turn(struct search *search)
{
    search->scans_seen = (float)(search->num_scans - 1u) + share_of_newest(search);
    /* a further sector of a turn, whose first one had everything measured and decided */
    search->is_continued = search->kind == RHO_SEARCH_NEWEST &&
                           search->initiator->window.is_continued && search->initiator->has_turn;
    search->initiator->has_turn = search->kind == RHO_SEARCH_NEWEST;
    if (search->kind == RHO_SEARCH_NEWEST &&
        (search->is_continued || !search->initiator->window.is_continued)) {
        search->newest =
            &rho_window_scan_at(&search->initiator->window, search->num_scans - 1u)->newest;
    }
}

/* Those of the sector before hold for the whole turn. */
static int keeps_thresholds(struct search *search)
{
    const struct rho_initiator *initiator = search->initiator;
    if (search->is_continued) {
        search->min_scans = initiator->min_scans;
        search->score_min_nat = (float)initiator->start_mnat * 0.001f;
    }
    return search->is_continued;
}
#endif

/* Without a rate to keep, the one threshold starts tracks and is enough to believe them. */
static void set_thresholds(struct search *search)
{
#if RHO_SECTORS
    if (keeps_thresholds(search)) {
        return;
    }
#endif
    struct rate rate = {.start_nat = search->initiator->config.score_min_nat,
                        .confirm_nat = search->initiator->config.score_min_nat,
                        .min_scans = search->min_scans};
    if (search->keeps_rate && search->num_scans >= 3) {
        rho_initiator_find_rate(search, &rate);
        search->min_scans = rate.min_scans;
    }
    rho_initiator_use_rate(search, &rate);
    search->initiator->min_scans = (uint16_t)search->min_scans;
}

/*
 * What all kernels of plots as straight targets have them leave of the work is for those that turn.
 */
static void try_turns(struct search *search)
{
    const unsigned min_scans = search->min_scans;
    if (search->kind != RHO_SEARCH_NEWEST || !(search->initiator->config.turn_mps2 > 0.0f) ||
        search->is_partial) {
        return;
    }
    search->min_scans++; /* clutter makes them more easily */
    if (search->min_scans <= search->num_scans) {
        search->log_turning = rho_initiator_log_turning(search);
        rho_initiator_let_turn(search, 1);
        search->sigma_least_m = 0.0f; /* gates are wider than noise */
        rho_initiator_try_turning_kernels(search);
    }
    search->min_scans = min_scans;
}

static void run(struct search *search)
{
    set_thresholds(search);
    if (search->num_scans < 3 || search->num_scans < search->min_scans) {
        return;
    }
    rho_initiator_try_kernels(search);
    try_turns(search);
    rho_initiator_select(search);
    rho_initiator_let_turn(search, 0);
    if (search->keeps_rate) {
        rho_initiator_judge(search);
    }
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
    search.wanted_mask = kind == RHO_SEARCH_NEWEST ? 1u << (search.num_scans - 1u) : 0u;
    search.has_more = has_more(&search);
    search.reach_chi2 = search.has_more ? RHO_GATE_CHI2_4D : RHO_GATE_CHI2_2D;
    search.has_one_noise = is_isotropic(&search);
    rho_initiator_let_turn(&search, 0);
#if RHO_SECTORS
    use_turn(&search);
#endif
    lay_times(&search);
    rho_initiator_prepare_process(&search);
    rho_initiator_prepare(&search);
    run(&search);
    rho_initiator_close_budget(&search);
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
