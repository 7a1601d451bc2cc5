/* SPDX-License-Identifier: MIT */
/*
 * passive_prepare: values computed once before a search: places and times of the looks,
 * log-likelihood ratios of a hit and a miss, and the score that a track must reach.
 */
#include "passive_search.h"
#include "policy.h"

void rho_passive_prepare(struct rho_passive_search *search)
{
    const struct rho_batch *batch = &search->passive->batch;
    const struct rho_passive_config *config = &search->passive->config;
    float total = 0.0f, log_sigmas = 0.0f, x_m = 0.0f, y_m = 0.0f;
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            search->looks += batch->was_seen[k][s];
            x_m += batch->was_seen[k][s] ? batch->looks[k][s].x_m : 0.0f;
            y_m += batch->was_seen[k][s] ? batch->looks[k][s].y_m : 0.0f;
        }
    }
    const float looks = rho_larger((float)search->looks, 1.0f);
    search->middle_x_m = x_m / looks;
    search->middle_y_m = y_m / looks;
    int64_t first_us = batch->time_us[0];
    search->half_s = 0.5f * rho_seconds_between(first_us, batch->newest_us);
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            const struct rho_batch_look *look = &batch->looks[k][s];
            const int64_t time_us = batch->time_us[k] + look->offset_us;
            search->at[k][s] = (struct rho_passive_look){
                .step = rho_seconds_between(first_us, time_us) / search->half_s - 1.0f,
                .x_m = look->x_m - search->middle_x_m,
                .y_m = look->y_m - search->middle_y_m,
                .z_m = look->z_m};
            for (unsigned i = 0; i < batch->num_bearings[k][s]; i++) {
                float sigma_rad = batch->bearings[k][s][i].sigma_rad;
                const float sigma_slope = batch->bearings[k][s][i].sigma_slope;
                float least_rad = sigma_rad / SIGMA_RATIO_MAX;
                log_sigmas += rho_log(sigma_rad);
                if (sigma_slope > 0.0f) {
                    log_sigmas += rho_log(sigma_slope) + 0.5f * RHO_LOG_TWO_PI;
                    search->has_slopes = 1;
                }
                total += 1.0f;
                search->sigma_min_rad = rho_larger(least_rad, search->sigma_min_rad);
            }
        }
    }
    search->mean_log_sigma = log_sigmas / rho_larger(total, 1.0f);
    search->miss_nat = rho_log(1.0f - config->pd);
    rho_passive_set_density(search);
    rho_passive_mark_directions(search);
}

/* False bearings are uniform in the field of view, as many as no track claims. */
void rho_passive_set_density(struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    const struct rho_batch *batch = &passive->batch;
    const float hit_nat = search->hit_nat;
    float unclaimed = 0.0f;
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            for (unsigned i = 0; i < batch->num_bearings[k][s]; i++) {
                unclaimed += batch->bearings[k][s][i].owner.track_id == 0 &&
                                     passive->is_claimed[k][s][i] == RHO_PASSIVE_FREE
                                 ? 1.0f
                                 : 0.0f;
            }
        }
    }
    const float looks = rho_larger((float)search->looks, 1.0f);
    search->hit_nat = rho_log(passive->config.pd * passive->config.field_of_view_rad /
                              rho_larger(unclaimed / looks, FALSE_MIN));
    search->share_nat =
        search->hit_nat - search->miss_nat - 0.5f * RHO_LOG_TWO_PI - search->mean_log_sigma;
    for (unsigned i = 0; i < passive->num_candidates; i++) {
        passive->candidates[i].score_nat +=
            (float)passive->candidates[i].hits * (search->hit_nat - hit_nat);
    }
}

/*
 * The likelihood ratio of a target anywhere has the mean 1 where all bearings are false, so that it
 * reaches e^s in at most one of e^s intervals (Markov's inequality).
 */
void rho_passive_set_start_score(const struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    float interval_h = 2.0f * search->half_s / (float)(passive->batch.num_scans - 1) / 3600.0f;
    float allowed = passive->config.false_tracks_per_hour * interval_h;
    passive->start_mnat = (int32_t)(-1000.0f * rho_log(allowed));
}
