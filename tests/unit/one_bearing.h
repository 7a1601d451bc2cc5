/* SPDX-License-Identifier: MIT */
/* one_bearing: a look whose only bearing is surely the target's, or weighed against a miss. */
#ifndef TESTS_UNIT_ONE_BEARING_H
#define TESTS_UNIT_ONE_BEARING_H

#include "rhotrack/detail/bearing_mix.h"

struct one_bearing {
    struct rho_bearing bearings[RHO_MAX_BEARINGS];
    struct rho_bearing_scan scan;
    struct rho_weighed_bearings look;
};

/* A look from (x, y) at time_us with one bearing, in its row; miss: weight of a miss beside 1. */
static inline const struct rho_weighed_bearings *one_bearing_in_row(struct one_bearing *at, int row,
                                                                    int64_t time_us, float x_m,
                                                                    float y_m, float bearing_rad,
                                                                    float sigma_rad, float miss)
{
    *at = (struct one_bearing){.scan = {.time_us = time_us, .x_m = x_m, .y_m = y_m}};
    at->bearings[row] = (struct rho_bearing){.bearing_rad = bearing_rad, .sigma_rad = sigma_rad};
    at->scan.bearings = at->bearings;
    at->scan.num_bearings = (uint32_t)row + 1;
    at->look.scan = &at->scan;
    at->look.miss = miss;
    at->look.weight[row] = 1.0f;
    return &at->look;
}

static inline const struct rho_weighed_bearings *one_bearing(struct one_bearing *at,
                                                             int64_t time_us, float x_m, float y_m,
                                                             float bearing_rad, float sigma_rad)
{
    return one_bearing_in_row(at, 0, time_us, x_m, y_m, bearing_rad, sigma_rad, 0.0f);
}

#ifdef RHOTRACK_IMM_H
/* Updates a filter with a bearing that is surely the target's; *gain_nat: ln of its density. */
static inline enum rho_status update_imm_by_bearing(struct rho_imm *imm, float x_m, float y_m,
                                                    float bearing_rad, float sigma_rad,
                                                    float *gain_nat)
{
    struct rho_bearing_mix mixes[2] = {{.hit = 0.0f}, {.hit = 0.0f}};
    struct one_bearing at;
    const struct rho_weighed_bearings *look = one_bearing(&at, 0, x_m, y_m, bearing_rad, sigma_rad);
    rho_imm_mix_bearing(imm, look, 0, mixes);
    return rho_imm_update_bearings(imm, look, mixes, gain_nat);
}
#endif

#ifdef RHOTRACK_TRACK_H
/* A bearing for a track; row -1: one that the track does not claim. */
struct track_bearing {
    int64_t time_us;
    int32_t sensor_id;
    float x_m, y_m, bearing_rad, sigma_rad;
    int16_t row;
};

static inline enum rho_status update_track_by_bearing(struct rho_track *track,
                                                      const struct track_bearing *bearing,
                                                      const struct rho_track_model *model,
                                                      int32_t gain_mnat)
{
    if (!bearing) {
        return rho_track_update_bearings(track, NULL, 0, 1, model, gain_mnat);
    }
    const int16_t row = bearing->row < 0 ? 0 : bearing->row;
    struct one_bearing at;
    const struct rho_weighed_bearings *look =
        one_bearing_in_row(&at, row, bearing->time_us, bearing->x_m, bearing->y_m,
                           bearing->bearing_rad, bearing->sigma_rad, 0.0f);
    at.scan.sensor_id = bearing->sensor_id;
    return rho_track_update_bearings(track, look, row, bearing->row >= 0, model, gain_mnat);
}
#endif

#endif
