/* SPDX-License-Identifier: MIT */
/*
 * clutter_map_sound: whether a map of unknown origin (a snapshot) can be worked with.
 */
#include "rhotrack/clutter_map.h"

#if RHO_MAX_ECHOES > 0

static int is_sound_table(const struct rho_echo_returns *table)
{
    for (unsigned c = 0; c < RHO_ECHO_HIT_CLASSES; c++) {
        for (unsigned g = 0; g < RHO_ECHO_GAP_CLASSES; g++) {
            if (!rho_is_within(table->looks[c][g], 0.0f, 1e9f) ||
                !rho_is_within(table->returns[c][g], -1e9f, 1e9f)) {
                return 0;
            }
        }
    }
    return 1;
}

static int is_sound_axis(const float axis[3])
{
    return rho_are_finite(axis, 3) && axis[0] > 0.0f && axis[2] >= 0.0f;
}

static int is_sound_echo(const struct rho_echo *echo)
{
    const float place[4] = {echo->x_m, echo->y_m, echo->vx_mps, echo->vy_mps};
    return rho_is_stored_time(echo->time_us) && rho_are_finite(place, 4) &&
           is_sound_axis(echo->along) && is_sound_axis(echo->across) &&
           rho_is_within(echo->weight, 0.0f, 1e9f) && echo->plot < RHO_MAX_PLOTS &&
           (echo->region < RHO_ECHO_TABLES - 1 || echo->region == UINT8_MAX);
}

int rho_clutter_map_is_sound(const struct rho_clutter_map *map)
{
    if (!rho_is_stored_time(map->time_us) || map->first_echo >= RHO_MAX_ECHOES ||
        !rho_is_within(map->v_min_mps, 0.0f, RHO_LIMIT_SPEED_MPS) ||
        !rho_is_within(map->rate_plots, 0.0f, 1e9f) ||
        !rho_is_within(map->exact_plots, 0.0f, map->rate_plots) ||
        !rho_are_finite(&map->scans_to_blocks, 1)) {
        return 0;
    }
    for (unsigned block = 0; block < 3; block++) {
        for (unsigned region = 0; region < RHO_ECHO_TABLES; region++) {
            if (!is_sound_table(&map->tables[block][region])) {
                return 0;
            }
        }
    }
    for (unsigned i = 0; i < RHO_MAX_ECHOES; i++) {
        if (map->echoes[i].hits > 0 && !is_sound_echo(&map->echoes[i])) {
            return 0;
        }
    }
    return 1;
}

#else

typedef int rho_clutter_map_is_left_out_of_sound; /* a file must not be empty */

#endif
