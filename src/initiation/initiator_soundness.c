/* SPDX-License-Identifier: MIT */
/* initiator_soundness: checks that an initiator of unknown origin (a snapshot) is consistent. */
#include "candidates.h"

static int is_sound_score(int32_t mnat)
{
    return mnat >= -SCORE_MAX_MNAT && mnat <= SCORE_MAX_MNAT;
}

static int is_finite_above_0(float v)
{
    return v > 0.0f && rho_are_finite(&v, 1);
}

static int is_sound_density_map(const struct rho_density_map *map)
{
    return map->columns >= 1 && map->columns <= RHO_MAX_DENSITY_CELLS && map->rows >= 1 &&
           map->rows <= RHO_MAX_DENSITY_CELLS && is_finite_above_0(map->mean) &&
           is_finite_above_0(map->prior_plots) && is_finite_above_0(map->content) &&
           map->scans > 0.0f && rho_is_within(map->scans, 0.0f, (float)RHO_MAX_SCANS) &&
           rho_is_coordinate(map->sensor_x_m) && rho_is_coordinate(map->sensor_y_m) &&
           rho_is_within(map->middle_rad, -10.0f, 10.0f) && rho_are_finite(&map->u0, 1) &&
           rho_are_finite(&map->v0, 1) && rho_is_within(map->width, 0.0f, 1e30f) &&
           rho_is_within(map->height, 0.0f, 1e30f);
}

/* True where the window holds the plots of a candidate, and its score is in range. */
static int is_sound_candidate(const struct rho_initiator *initiator,
                              const struct rho_candidate *candidate)
{
    const struct rho_window *window = &initiator->window;
    if ((uint32_t)candidate->mask >> window->num_scans != 0 ||
        !is_sound_score(candidate->score_mnat)) {
        return 0;
    }
    for (unsigned m = 0; m < window->num_scans; m++) {
        const struct rho_window_scan *scan = &window->ring[(window->first + m) % window->scans_max];
        if (((unsigned)candidate->mask >> m & 1u) && candidate->plot[m] >= scan->num_plots) {
            return 0;
        }
    }
    return 1;
}

int rho_initiator_is_sound(const struct rho_initiator *initiator)
{
    const struct rho_initiator_config *config = &initiator->config;
    const struct rho_clutter_memory *memory = &initiator->memory;
    const unsigned num_scans = initiator->window.num_scans;
    if (!rho_initiator_is_usable_config(config) || !rho_window_is_sound(&initiator->window) ||
        initiator->window.scans_max != config->scans ||
        (initiator->window.area_is_fixed != 0) != (config->area_is_fixed != 0) ||
        !rho_initiator_accepts(initiator, INT64_MAX)) {
        return 0;
    }
    if (initiator->num_candidates > RHO_MAX_CANDIDATES || initiator->min_scans > RHO_MAX_SCANS ||
        !is_sound_score(initiator->start_mnat) || !is_sound_score(initiator->confirm_mnat) ||
        !rho_are_finite(&initiator->density_per_m2, 1) ||
        initiator->num_maps > RHO_MAX_DENSITY_MAPS ||
        !rho_are_finite(initiator->sensor_ratio, RHO_MAX_SCANS) ||
        initiator->budget.resume.cost_class >= RHO_INITIATOR_CLASSES ||
        initiator->budget.resume.plot >= RHO_MAX_PLOTS) {
        return 0;
    }
    if (RHO_MAX_CLUTTER_CELLS > 0 &&
        !(rho_are_finite(&memory->x_min_m, 1) && rho_are_finite(&memory->y_min_m, 1) &&
          rho_is_within(memory->columns_per_m, 0.0f, 1e6f) &&
          rho_is_within(memory->rows_per_m, 0.0f, 1e6f))) {
        return 0;
    }
    /* a revolution that has begun has the density map and M of its first sector */
    if (RHO_SECTORS && initiator->has_revolution &&
        (num_scans == 0 || initiator->num_maps == 0 ||
         initiator->min_scans < (num_scans < 3 ? num_scans : 3u))) {
        return 0;
    }
    /* before the first search there is no map */
    for (unsigned i = 0; i < initiator->num_maps; i++) {
        if (!is_sound_density_map(&initiator->density[i])) {
            return 0;
        }
    }
    for (unsigned i = 0; i < initiator->num_candidates; i++) {
        if (!is_sound_candidate(initiator, &initiator->candidates[i])) {
            return 0;
        }
    }
    return 1;
}
