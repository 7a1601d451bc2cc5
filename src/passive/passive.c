/* SPDX-License-Identifier: MIT */
#include "rhotrack/passive.h"

#include <string.h>

#include "passive_search.h"
#include "rhotrack/approx.h"
#include "rhotrack/types.h"

#define PASSIVE_MAGIC 0x50415353u /* "PASS" */

#define SCANS_MIN 4u
#define LINES_MAX 96u
#define VOTES_MIN 2u /* of a line */
#define DENSITY_MIN_PER_RAD 0.3f
#define SIGMA_RATIO_MAX 200.0f
#define SQRT_TWO_PI 2.50662827f

/* ---- setting up ------------------------------------------------------------------------------- */

void rho_passive_config_default(struct rho_passive_config *config)
{
    *config = (struct rho_passive_config){.scans = 8,
                                          .range_max_m = 100000.0f,
                                          .v_max_mps = 450.0f,
                                          .pd = 0.9f,
                                          .field_of_view_rad = RHO_PI,
                                          .hits_min = 0.65f,
                                          .rho_cell_m = 2000.0f,
                                          .theta_cell_rad = RHO_PI / 36.0f,
                                          .rule = RHO_GHOST_SAFE,
                                          .false_tracks_per_hour = 1.0f};
}

int rho_passive_is_usable(const struct rho_passive_config *config)
{
    return config->scans >= SCANS_MIN && config->scans <= RHO_MAX_PASSIVE_SCANS &&
           rho_is_within(config->range_max_m, 1000.0f, 500000.0f) &&
           rho_is_within(config->v_max_mps, 1.0f, RHO_LIMIT_SPEED_MPS) &&
           rho_is_within(config->pd, 0.01f, 0.999f) &&
           rho_is_within(config->field_of_view_rad, 0.01f, RHO_TWO_PI) &&
           rho_is_within(config->hits_min, 0.1f, 1.0f) &&
           rho_is_within(config->rho_cell_m, RHO_LIMIT_SIGMA_MIN, RHO_LIMIT_POSITION_M) &&
           2.0f * config->range_max_m <= config->rho_cell_m * (float)RHO_PASSIVE_RHO_CELLS &&
           rho_is_within(config->theta_cell_rad, 0.99f * RHO_PI / (float)RHO_PASSIVE_THETA_CELLS,
                         0.5f) &&
           rho_is_within(config->false_tracks_per_hour, 1.0e-6f, 1.0e6f) &&
           (unsigned)config->rule <= RHO_GHOST_SAFE;
}

/* Lines through anything that a sensor sees stay within the cells of rho. */
static float apart_max_m(const struct rho_passive_config *config)
{
    float reach_m = 0.5f * config->rho_cell_m * (float)RHO_PASSIVE_RHO_CELLS - config->range_max_m;
    float apart_m =
        2.0f * reach_m < 4.0f * RHO_LIMIT_POSITION_M ? 2.0f * reach_m : 4.0f * RHO_LIMIT_POSITION_M;
    return apart_m > RHO_CROSSING_BASE_MIN_M ? apart_m : RHO_CROSSING_BASE_MIN_M;
}

enum rho_status rho_passive_init(struct rho_passive *passive, size_t size,
                                 const struct rho_passive_config *config)
{
    if (!passive || !config) {
        return RHO_ERROR_NULL;
    }
    if (size != sizeof *passive) {
        return RHO_ERROR_SIZE;
    }
    if (!rho_passive_is_usable(config)) {
        return RHO_ERROR_CONFIG;
    }
    struct rho_passive_config kept = *config; /* it may lie within *passive */
    memset(passive, 0, sizeof *passive);
    passive->config = kept;
    passive->magic = PASSIVE_MAGIC;
    return rho_batch_init(&passive->batch, kept.scans, apart_max_m(&kept));
}

/* ---- frames ----------------------------------------------------------------------------------- */

enum rho_status rho_passive_push(struct rho_passive *passive, const struct rho_frame *frame,
                                 uint8_t *fates)
{
    if (!passive) {
        return RHO_ERROR_NULL;
    }
    if (passive->magic != PASSIVE_MAGIC) {
        return RHO_ERROR_STATE;
    }
    enum rho_status status = rho_batch_push(&passive->batch, frame, fates);
    if (status == RHO_OK) {
        passive->num_tracks = 0;
    }
    return status;
}

enum rho_status rho_passive_accepts(const struct rho_passive *passive,
                                    const struct rho_frame *frame)
{
    if (!passive) {
        return RHO_ERROR_NULL;
    }
    return passive->magic == PASSIVE_MAGIC ? rho_batch_accepts(&passive->batch, frame)
                                           : RHO_ERROR_STATE;
}

uint32_t rho_passive_consume(struct rho_passive *passive, const struct rho_passive_track *track)
{
    return passive && track && passive->magic == PASSIVE_MAGIC
               ? rho_batch_remove(&passive->batch, track->claim)
               : 0;
}

/* ---- a search --------------------------------------------------------------------------------- */

static void set_places(struct rho_passive_search *search)
{
    const struct rho_passive *passive = search->passive;
    float n = (float)passive->batch.num_sensors;
    for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
        search->middle_x_m += passive->batch.sensors[s].x_m / n;
        search->middle_y_m += passive->batch.sensors[s].y_m / n;
    }
    for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
        search->x_m[s] = passive->batch.sensors[s].x_m - search->middle_x_m;
        search->y_m[s] = passive->batch.sensors[s].y_m - search->middle_y_m;
    }
}

static void set_times(struct rho_passive_search *search)
{
    const struct rho_passive *passive = search->passive;
    int64_t first_us = passive->batch.time_us[0],
            last_us = passive->batch.time_us[passive->batch.num_scans - 1];
    search->half_s = 0.5f * rho_seconds_between(first_us, last_us);
    for (unsigned k = 0; k < passive->batch.num_scans; k++) {
        search->step[k] =
            rho_seconds_between(first_us, passive->batch.time_us[k]) / search->half_s - 1.0f;
    }
}

/* Beside the least certain bearing the others count as if they were not much better: float32 has no more digits. */
static void set_sigma(struct rho_passive_search *search)
{
    const struct rho_passive *passive = search->passive;
    for (unsigned k = 0; k < passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
            for (unsigned i = 0; i < passive->batch.num_bearings[k][s]; i++) {
                float sigma_rad = passive->batch.bearings[k][s][i].sigma_rad / SIGMA_RATIO_MAX;
                search->sigma_min_rad =
                    sigma_rad > search->sigma_min_rad ? sigma_rad : search->sigma_min_rad;
            }
        }
    }
}

/* The density of bearings is that of the batch: a false one is as likely anywhere in the field of view. */
static void set_odds(struct rho_passive_search *search)
{
    const struct rho_passive *passive = search->passive;
    const struct rho_passive_config *config = &passive->config;
    float total = 0.0f, log_sigmas = 0.0f;
    for (unsigned k = 0; k < passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
            search->looks += passive->batch.was_seen[k][s];
            total += (float)passive->batch.num_bearings[k][s];
            for (unsigned i = 0; i < passive->batch.num_bearings[k][s]; i++) {
                log_sigmas += rho_log(passive->batch.bearings[k][s][i].sigma_rad);
            }
        }
    }
    float looks = search->looks > 0 ? (float)search->looks : 1.0f;
    float density = total / looks / config->field_of_view_rad;
    density = density > DENSITY_MIN_PER_RAD ? density : DENSITY_MIN_PER_RAD;
    search->hit_nat = rho_log(config->pd / (density * SQRT_TWO_PI));
    search->miss_nat = rho_log(1.0f - config->pd);
    search->share_nat =
        search->hit_nat - log_sigmas / (total > 0.0f ? total : 1.0f) - search->miss_nat;
}

static void set_cells(struct rho_passive_search *search)
{
    const struct rho_passive_config *config = &search->passive->config;
    search->theta_cells = (uint16_t)(RHO_PI / config->theta_cell_rad + 0.5f);
    search->rho_cells = RHO_PASSIVE_RHO_CELLS;
    for (unsigned i = 0; i < search->theta_cells; i++) {
        float theta_rad = ((float)i + 0.5f) * RHO_PI / (float)search->theta_cells;
        search->cosine[i] = rho_cos(theta_rad);
        search->sine[i] = rho_sin(theta_rad);
    }
}

/* Scans that two sensors or more reported in: only these have crossings, and votes. */
static unsigned count_crossed(const struct rho_batch *batch)
{
    unsigned count = 0;
    for (unsigned k = 0; k < batch->num_scans; k++) {
        unsigned seen = 0;
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            seen += batch->was_seen[k][s];
        }
        count += seen >= 2;
    }
    return count;
}

/* One pass over the lines of the bearings that are there. */
static void pass(struct rho_passive_search *search, float votes_share)
{
    struct rho_passive_line line;
    float votes = votes_share * (float)count_crossed(&search->passive->batch);
    unsigned votes_min = (unsigned)votes + ((float)(unsigned)votes < votes ? 1u : 0u);
    votes_min = votes_min > VOTES_MIN ? votes_min : VOTES_MIN;
    rho_passive_cross(search);
    rho_passive_vote(search);
    for (unsigned i = 0; i < LINES_MAX && rho_passive_next_line(search, votes_min, &line); i++) {
        search->passive->work.peaks = rho_count(search->passive->work.peaks, 1);
        rho_passive_propose(search, &line);
    }
}

/*
 * Evidence beyond the four bearings of two crossings: its likelihood ratio has the mean 1 where all is chance, so that it
 * reaches e^s once in e^s pairs of crossings, at most. Pairs with the newest frame's are new at each search.
 */
static void set_start(const struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    float points = (float)(passive->work.crossings - passive->work.ghosts);
    float pairs = 0.5f * points * points + 1.0f;
    float interval_h = 2.0f * search->half_s / (float)(passive->batch.num_scans - 1) / 3600.0f;
    float allowed = passive->config.false_tracks_per_hour * interval_h;
    float start_nat =
        4.0f * (search->share_nat + search->miss_nat) + rho_log(pairs) - rho_log(allowed);
    passive->start_mnat = (int32_t)(1000.0f * start_nat);
}

enum rho_status rho_passive_search(struct rho_passive *passive)
{
    if (!passive) {
        return RHO_ERROR_NULL;
    }
    if (passive->magic != PASSIVE_MAGIC) {
        return RHO_ERROR_STATE;
    }
    struct rho_passive_search search = {.passive = passive};
    memset(&passive->work, 0, sizeof passive->work);
    memset(passive->is_claimed, 0, sizeof passive->is_claimed);
    passive->num_tracks = passive->num_candidates = 0;
    passive->start_mnat = 0;
    rho_batch_close_ranks(&passive->batch);
    if (passive->batch.num_scans < SCANS_MIN || passive->batch.num_sensors < 2) {
        return RHO_OK;
    }
    set_places(&search);
    set_times(&search);
    set_odds(&search);
    set_sigma(&search);
    set_cells(&search);
    rho_passive_mark_bearings(&search);
    pass(&search, 0.6f);
    rho_passive_claim_best(&search);
    set_start(&search);
    search.is_second = 1;
    pass(&search, 0.5f);
    memset(passive->is_claimed, 0, sizeof passive->is_claimed);
    rho_passive_mix(&search);
    rho_passive_select(&search);
    return RHO_OK;
}

unsigned rho_passive_sensor_pairs(const struct rho_passive_track *track)
{
    unsigned sensors = 0;

    for (unsigned sensor = 0; sensor < RHO_MAX_PASSIVE_SENSORS; sensor++) {
        unsigned claims = 0;

        for (unsigned scan = 0; scan < RHO_MAX_PASSIVE_SCANS; scan++) {
            claims |= track->claim[scan][sensor];
        }
        sensors += claims != 0;
    }
    return sensors * (sensors - 1) / 2;
}
