/* SPDX-License-Identifier: MIT */
/* publish_clutter: messages of the echoes in the tracker's clutter map. */
#include "message_clamps.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/recurring_clutter_map.h"
#include "rhotrack/publish.h"

#define PART_ECHOES RHO_MESSAGE_CLUTTER_MAP_MAX_ECHOES

static float clamp_magnitude(float value, float most)
{
    return value > most ? most : value < -most ? -most : value;
}

static unsigned count_known_echoes(const struct rho_tracker *tracker)
{
    uint32_t place = 0;
    unsigned count = 0;
    while (rho_clutter_map_next_known(&tracker->clutter_map, &place)) {
        count++;
    }
    return count;
}

uint16_t rho_publish_num_clutter_parts(const struct rho_tracker *tracker)
{
    return (uint16_t)rho_num_parts(tracker ? count_known_echoes(tracker) : 0, PART_ECHOES);
}

enum rho_status rho_publish_clutter(const struct rho_tracker *tracker, uint16_t part,
                                    struct rho_message_clutter_map *list)
{
    if (!tracker || !list) {
        return RHO_ERROR_NULL;
    }
    const struct rho_clutter_map *map = &tracker->clutter_map;
    const unsigned echoes = count_known_echoes(tracker);
    const unsigned num_parts = rho_num_parts(echoes, PART_ECHOES);
    const float sigma_max_m = 1e6f; /* of lcm_types/echo_t.lcm */
    if (part >= num_parts) {
        return RHO_ERROR_VALUE;
    }
    list->utime = tracker->time_us;
    list->scan = list->epoch = 0;
    list->num_echoes_total = (int16_t)echoes;
    list->part = (int16_t)part;
    list->num_parts = (int16_t)num_parts;
    list->num_echoes = 0;
    const struct rho_echo *echo;
    uint32_t place = 0;
    unsigned at = 0;
    while ((echo = rho_clutter_map_next_known(map, &place))) {
        if (at++ / PART_ECHOES != part) {
            continue;
        }
        list->echoes[list->num_echoes++] = (struct rho_message_echo){
            .sensor_id = rho_clamp_sensor_id(echo->sensor_id),
            .hits = rho_clamp_to_int16(echo->hits),
            .unseen = echo->unseen,
            .x_m = clamp_magnitude(echo->x_m, RHO_LIMIT_POSITION_M),
            .y_m = clamp_magnitude(echo->y_m, RHO_LIMIT_POSITION_M),
            .vx_mps = clamp_magnitude(echo->vx_mps, RHO_LIMIT_SPEED_MPS),
            .vy_mps = clamp_magnitude(echo->vy_mps, RHO_LIMIT_SPEED_MPS),
            .sigma_range_m = clamp_magnitude(rho_sqrt(echo->along[0]), sigma_max_m),
            .sigma_cross_m = clamp_magnitude(rho_sqrt(echo->across[0]), sigma_max_m),
            .chance = rho_clutter_map_return_probability(map, echo->region, echo->hits,
                                                         echo->unseen + 1u),
        };
    }
    return RHO_OK;
}
