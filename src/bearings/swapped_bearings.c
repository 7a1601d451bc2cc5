/* SPDX-License-Identifier: MIT */
/*
 * swapped_bearings: targets behind two ghost tracks. One ghost has the bearings of
 * target A from one sensor and those of target B from the other; the second ghost has the reverse.
 * Target A has the bearings of the first ghost from the first sensor and those of the second ghost
 * from the second sensor. A line of crossings may hide such a target if a line of ghosts is near.
 */
#include <string.h>

#include "passive_search.h"
#include "policy.h"

/* Claims of the best candidates, copied as offering candidates changes the list's order. */
struct claims {
    unsigned count;
    uint8_t of[BEST_TRIED][RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS];
};

/*
 * The state through the first and the last crossing of candidate i's bearings from the first sensor
 * with candidate j's bearings from the second one. Returns 0 without two crossings.
 */
static int swapped_state(const struct rho_passive_search *search, const struct claims *claims,
                         unsigned i, unsigned j, const unsigned sensors[2],
                         float state_m[RHO_PASSIVE_STATES])
{
    const struct rho_batch *batch = &search->passive->batch;
    struct rho_passive_point ends[2];
    unsigned num = 0;
    for (unsigned k = 0; k < batch->num_scans; k++) {
        const unsigned a = claims->of[i][k][sensors[0]], b = claims->of[j][k][sensors[1]];
        const struct rho_passive_look *from = &search->at[k][sensors[0]];
        const struct rho_passive_look *to = &search->at[k][sensors[1]];
        struct rho_crossing_base base;
        struct rho_crossing crossing;
        if (a > 0 && b > 0 && /* indices from 1 */
            rho_crossing_set_base(&base, from->x_m, from->y_m, to->x_m, to->y_m) == RHO_OK &&
            rho_crossing_find(&base, batch->bearings[k][sensors[0]][a - 1].bearing_rad,
                              batch->bearings[k][sensors[1]][b - 1].bearing_rad,
                              search->passive->config.range_max_m,
                              &crossing) == RHO_CROSSING_MEETS) {
            ends[num > 0] = (struct rho_passive_point){
                .x_m = crossing.x_m,
                .y_m = crossing.y_m,
                .xx_m2 = rho_square(search->passive->config.range_max_m), /* at any speed */
                .scan = (uint8_t)k,
                .sensors = (uint8_t)(8u * sensors[0] + sensors[1]),
                .bearing = {(uint8_t)(a - 1u), (uint8_t)(b - 1u)}};
            num++;
        }
    }
    return num > 1 && rho_passive_connect_crossings(search, &ends[0], &ends[1], state_m);
}

static void offer_swapped_candidates(struct rho_passive_search *search, const struct claims *claims,
                                     unsigned i, unsigned j)
{
    unsigned num_sensors = search->passive->batch.num_sensors;
    float state_m[RHO_PASSIVE_STATES];
    for (unsigned a = 0; a + 1u < num_sensors; a++) {
        for (unsigned b = a + 1u; b < num_sensors; b++) {
            const unsigned sensors[2] = {a, b};
            if (swapped_state(search, claims, i, j, sensors, state_m)) {
                rho_passive_fit_nearest(search, state_m, 1);
                (void)rho_passive_offer_if_track(search, state_m);
            }
        }
    }
}

void rho_passive_offer_swapped(struct rho_passive_search *search)
{
    const struct rho_passive *passive = search->passive;
    uint8_t order[RHO_MAX_PASSIVE_CANDIDATES];
    struct claims claims;
    rho_passive_rank_candidates(passive, order);
    claims.count = passive->num_candidates < BEST_TRIED ? passive->num_candidates : BEST_TRIED;
    for (unsigned i = 0; i < claims.count; i++) {
        memcpy(claims.of[i], passive->candidates[order[i]].claim, sizeof claims.of[i]);
    }
    for (unsigned i = 0; i < claims.count; i++) {
        for (unsigned j = 0; j < claims.count; j++) {
            if (i != j) {
                offer_swapped_candidates(search, &claims, i, j);
            }
        }
    }
}
