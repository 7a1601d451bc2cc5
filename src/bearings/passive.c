/* SPDX-License-Identifier: MIT */
/*
 * passive: configuration, frames, and the sequence of phases of a search (rho_passive_search). Each
 * phase is a file of its own; passive_search.h lists them.
 */
#include "rhotrack/passive.h"

#include <string.h>

#include "passive_search.h"

enum { PASSIVE_MAGIC = 0x50415353 }; /* "PASS" in ASCII */

void rho_passive_config_default(struct rho_passive_config *config)
{
    *config = (struct rho_passive_config){.scans = 8,
                                          .range_max_m = 100000.0f,
                                          .v_max_mps = 450.0f,
                                          .pd = 0.9f,
                                          .field_of_view_rad = RHO_PI,
                                          .false_tracks_per_hour = 1.0f,
                                          .work_max = RHO_WORK_MAX};
}

static int is_usable(const struct rho_passive_config *config)
{
    return config->scans >= RHO_BATCH_SCANS_MIN && config->scans <= RHO_MAX_PASSIVE_SCANS &&
           rho_is_within(config->range_max_m, 1000.0f, 500000.0f) &&
           rho_is_within(config->v_max_mps, 1.0f, RHO_LIMIT_SPEED_MPS) &&
           rho_is_within(config->pd, 0.01f, 0.999f) &&
           rho_is_within(config->field_of_view_rad, 0.01f, RHO_TWO_PI) &&
           rho_is_within(config->false_tracks_per_hour, 1.0e-6f, 1.0e6f) &&
           config->work_max <= RHO_LIMIT_WORK;
}

enum rho_status rho_passive_init(struct rho_passive *passive, size_t object_size,
                                 const struct rho_passive_config *config)
{
    if (!passive || !config) {
        return RHO_ERROR_NULL;
    }
    if (object_size != sizeof *passive) {
        return RHO_ERROR_SIZE;
    }
    if (!is_usable(config)) {
        return RHO_ERROR_CONFIG;
    }
    /* the caller's config may lie within *passive, which is cleared */
    struct rho_passive_config kept = *config;
    memset(passive, 0, sizeof *passive);
    passive->config = kept;
    passive->magic = PASSIVE_MAGIC;
    return rho_batch_init(&passive->batch, kept.scans, 4.0f * RHO_LIMIT_POSITION_M);
}

enum rho_status rho_passive_push(struct rho_passive *passive, const struct rho_frame *frame,
                                 uint8_t *fates)
{
    if (!passive) {
        return RHO_ERROR_NULL;
    }
    if (passive->magic != PASSIVE_MAGIC) {
        return RHO_ERROR_STATE;
    }
    enum rho_status status = rho_batch_push(&passive->batch, frame, fates, 0);
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

uint32_t rho_passive_give(struct rho_passive *passive, const struct rho_passive_track *track,
                          uint32_t track_id)
{
    uint32_t given = 0;
    if (!passive || !track || passive->magic != PASSIVE_MAGIC || track->hits == 0) {
        return 0;
    }
    /* as the fit has them, which pays for its place among all: later ones are expected by it */
    const float each_nat =
        (track->prior_nat - 0.5f * track->chi2) / (float)track->hits - 0.5f * RHO_LOG_TWO_PI;
    for (unsigned k = 0; k < passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
            const unsigned place = track->claim[k][s];
            if (place > 0 && place <= passive->batch.num_bearings[k][s]) {
                struct rho_batch_bearing *bearing = &passive->batch.bearings[k][s][place - 1u];
                given += (uint32_t)rho_batch_is_unclaimed(bearing);
                bearing->owner =
                    (struct rho_batch_owner){track_id, each_nat - rho_log(bearing->sigma_rad)};
            }
        }
    }
    return given;
}

/*
 * A pass over the unclaimed bearings: crossings, pairs of them, and fits, each with a third of the
 * pass's work. The first pass has half of what is left, the second the rest.
 */
static void find_candidates(struct rho_passive_search *search)
{
    const uint32_t work_max = search->passive->config.work_max;
    const uint32_t spent = search->passive->work.spent;
    const uint32_t left = work_max > spent ? work_max - spent : 0;
    search->work_share = left / (search->is_second ? 3u : 6u);
    rho_passive_allow(search, search->work_share);
    rho_passive_find_crossings(search);
    rho_passive_fit_pairs(search);
}

enum rho_status rho_passive_challenge(struct rho_passive *passive, struct rho_passive_known *known,
                                      uint32_t num_known)
{
    uint32_t num_challenged = 0;
    if (!passive || (num_known > 0 && !known)) {
        return RHO_ERROR_NULL;
    }
    if (passive->magic != PASSIVE_MAGIC) {
        return RHO_ERROR_STATE;
    }
    for (uint32_t i = 0; i < num_known; i++) {
        known[i].is_beaten = 0;
        num_challenged += !known[i].is_safe;
    }
    if (num_challenged > RHO_MAX_PASSIVE_TRACKS || num_known >= UINT16_MAX) {
        return RHO_ERROR_CAPACITY;
    }
    struct rho_passive_search search = {.passive = passive, .known = known, .num_known = num_known};
    memset(&passive->work, 0, sizeof passive->work);
    passive->num_tracks = passive->num_candidates = 0;
    passive->start_mnat = 0;
    if (passive->batch.num_scans < RHO_BATCH_SCANS_MIN || passive->batch.num_sensors < 2) {
        return RHO_OK;
    }
    rho_passive_block_bearings(&search);
    rho_passive_prepare(&search);
    rho_passive_list_known(&search);

    /* first pass: only crossings that a third sensor supports */
    find_candidates(&search);
    rho_passive_claim_best_set(&search);
    rho_passive_set_density(&search);
    rho_passive_set_start_score(&search);

    /* second pass: all crossings of the bearings that no track of the first pass has claimed */
    search.is_second = 1;
    find_candidates(&search);
    for (unsigned i = 0; i < passive->best.num; i++) {
        rho_passive_mark_claims(passive, &passive->best.tracks[i], RHO_PASSIVE_FREE);
    }

    /* the final selection is from the candidates of both passes */
    rho_passive_select_tracks(&search);
    return RHO_OK;
}

enum rho_status rho_passive_search(struct rho_passive *passive)
{
    return rho_passive_challenge(passive, 0, 0);
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

int rho_passive_is_sound(const struct rho_passive *passive)
{
    return is_usable(&passive->config) && rho_batch_is_sound(&passive->batch) &&
           passive->batch.scans_max == passive->config.scans &&
           passive->num_tracks <= RHO_MAX_PASSIVE_TRACKS && passive->magic == PASSIVE_MAGIC;
}
