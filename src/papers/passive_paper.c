/* SPDX-License-Identifier: MIT */
/* passive_paper: configuration, frames, and the sequence of steps of a search. */
#include "rhotrack/passive_paper.h"

#include <string.h>

#include "passive_paper_search.h"
#include "rhotrack/detail/approx.h"

void rho_passive_paper_config_default(struct rho_passive_paper_config *config)
{
    *config = (struct rho_passive_paper_config){.scans = 8,
                                                .range_max_m = 100000.0f,
                                                .rho_cell_m = 1000.0f,
                                                .theta_cell_rad = RHO_PI / 90.0f,
                                                .votes = RHO_VOTES_SCANS,
                                                .rule = RHO_GHOST_LITERAL};
}

unsigned rho_passive_paper_theta_rows(const struct rho_passive_paper_config *config)
{
    return (unsigned)(RHO_PI / config->theta_cell_rad + 0.5f);
}

enum rho_status rho_passive_paper_init(struct rho_passive_paper *paper, size_t object_size,
                                       const struct rho_passive_paper_config *config)
{
    if (!paper || !config) {
        return RHO_ERROR_NULL;
    }
    if (object_size != sizeof *paper) {
        return RHO_ERROR_SIZE;
    }
    float plane_m = config->rho_cell_m * (float)RHO_PAPER_RHO_CELLS;
    if (config->scans < RHO_BATCH_SCANS_MIN || config->scans > RHO_MAX_PASSIVE_SCANS ||
        config->votes_min > UINT8_MAX || !rho_is_within(config->range_max_m, 1000.0f, 500000.0f) ||
        !rho_is_within(config->rho_cell_m, RHO_LIMIT_SIGMA_MIN, RHO_LIMIT_POSITION_M) ||
        !(2.0f * config->range_max_m <= plane_m) ||
        !rho_is_within(config->theta_cell_rad, 1.0e-4f, 0.5f) ||
        rho_passive_paper_theta_rows(config) > RHO_PAPER_THETA_CELLS ||
        (unsigned)config->votes > RHO_VOTES_POINTS || (unsigned)config->rule > RHO_GHOST_SAFE) {
        return RHO_ERROR_CONFIG;
    }
    /* the caller's config may lie within *paper, which is cleared */
    struct rho_passive_paper_config kept = *config;
    memset(paper, 0, sizeof *paper);
    paper->config = kept;
    paper->magic = RHO_PASSIVE_PAPER_MAGIC;
    /*
     * A crossing is within range_max of two sensors, so from the centroid range_max plus half their
     * largest distance, with more than four sensors (n - 2) / n of it (rho_batch_accepts).
     */
    float reach_m = 0.5f * kept.rho_cell_m * (float)RHO_PAPER_RHO_CELLS - kept.range_max_m;
    float apart_m = 2.0f * reach_m;
    apart_m = apart_m < 4.0f * RHO_LIMIT_POSITION_M ? apart_m : 4.0f * RHO_LIMIT_POSITION_M;
    apart_m = apart_m > RHO_CROSSING_BASE_MIN_M ? apart_m : RHO_CROSSING_BASE_MIN_M;
    return rho_batch_init(&paper->batch, kept.scans, apart_m);
}

/* False for an array that the caller did not set: a value that is no fate, or no bearing HELD. */
static int are_fates_set(const struct rho_frame *frame, const uint8_t *fates)
{
    uint32_t num = 0, held = 0;
    for (uint32_t k = 0; k < frame->num_scans; k++) {
        num = rho_count(num, frame->scans[k].num_bearings);
    }
    for (uint32_t i = 0; i < num; i++) {
        if (fates[i] >= RHO_NUM_FATES) {
            return 0;
        }
        held += fates[i] == RHO_FATE_HELD;
    }
    return num == 0 || held > 0;
}

enum rho_status rho_passive_paper_push(struct rho_passive_paper *paper,
                                       const struct rho_frame *frame, uint8_t *fates)
{
    if (!paper) {
        return RHO_ERROR_NULL;
    }
    if (paper->magic != RHO_PASSIVE_PAPER_MAGIC) {
        return RHO_ERROR_STATE;
    }
    enum rho_status status = rho_batch_accepts(&paper->batch, frame);
    if (status == RHO_OK && fates && !are_fates_set(frame, fates)) {
        return RHO_ERROR_VALUE;
    }
    if (status == RHO_OK) {
        status = rho_batch_push(&paper->batch, frame, fates, 0);
    }
    if (status == RHO_OK) {
        paper->num_lines = 0;
    }
    return status;
}

int rho_passive_paper_begin(struct rho_passive_paper *paper,
                            struct rho_passive_paper_search *search)
{
    *search = (struct rho_passive_paper_search){
        .paper = paper, .rows = (int)rho_passive_paper_theta_rows(&paper->config)};
    rho_passive_paper_list_sensors(&paper->batch, search);
    paper->votes_min = paper->config.votes_min > 0
                           ? paper->config.votes_min
                           : (uint16_t)((4u * paper->batch.num_scans + 4u) / 5u);
    return paper->batch.num_scans >= RHO_BATCH_SCANS_MIN && search->num_sensors >= 2;
}

enum rho_status rho_passive_paper_search(struct rho_passive_paper *paper)
{
    if (!paper) {
        return RHO_ERROR_NULL;
    }
    if (paper->magic != RHO_PASSIVE_PAPER_MAGIC) {
        return RHO_ERROR_STATE;
    }
    struct rho_passive_paper_search search;
    memset(&paper->work, 0, sizeof paper->work);
    paper->num_lines = 0;
    if (!rho_passive_paper_begin(paper, &search)) {
        return RHO_OK;
    }
    const struct rho_batch *batch = &paper->batch;
    int64_t first_us = batch->time_us[0];
    search.half_s = 0.5f * rho_seconds_between(first_us, batch->newest_us);
    for (unsigned k = 0; k < batch->num_scans; k++) {
        search.step[k] = rho_seconds_between(first_us, batch->time_us[k]) / search.half_s - 1.0f;
    }
    rho_passive_paper_vote_pairs(&search);
    rho_passive_paper_pick_lines(&search);
    rho_passive_paper_fit_lines(&search);
    return RHO_OK;
}
