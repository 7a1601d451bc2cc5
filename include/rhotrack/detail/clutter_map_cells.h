/* SPDX-License-Identifier: MIT */
/*
 * clutter_map_cells: the operations on echoes and their statistics that src/tracker needs.
 *
 * Stack: 280 bytes at most.
 */
#ifndef RHOTRACK_CLUTTER_MAP_CELLS_H
#define RHOTRACK_CLUTTER_MAP_CELLS_H

#include "rhotrack/detail/clutter_map.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A place as a sensor sees it: unit vector of the line of sight, and range. */
struct echo_view {
    float along_x, along_y;
    float range_m;
};

void rho_clutter_map_init(struct rho_clutter_map *map, float v_min_mps);

struct echo_view rho_clutter_map_view(const struct rho_sensor *sensor, float x_m, float y_m);
float rho_clutter_map_direction(
    const struct echo_view *view); /* its direction, 0 .. 1 of a circle */
uint8_t rho_clutter_map_region(const struct rho_sensor *sensor, float range_max_m, float x_m,
                               float y_m);

/*
 * Statistics: counts of one scan, then the next. `share` is the part of a revolution that it saw.
 */
void rho_clutter_map_count_look(struct rho_clutter_map *map, const struct rho_echo *echo);
void rho_clutter_map_count_return(struct rho_clutter_map *map, const struct rho_echo *echo);
/* The share of old counts that remains after that part of a revolution. */
float rho_clutter_map_remaining(float share);
void rho_clutter_map_age(struct rho_clutter_map *map, float share);

/* Removes counts by plots of a target: by class of hits, the sum of the weights of its echoes. */
void rho_clutter_map_remove_returns(struct rho_clutter_map *map, unsigned region,
                                    const float returns[RHO_ECHO_HIT_CLASSES]);
unsigned rho_clutter_map_hit_class(unsigned hits);

/* One echo: predicts it; updates it with a plot; true where it has not been seen for too long. */
void rho_clutter_map_predict_echo(struct rho_echo *echo, int64_t time_us);
void rho_clutter_map_update_echo(struct rho_echo *echo, const struct rho_sensor *sensor,
                                 const struct rho_plot *plot);
int rho_clutter_map_is_echo_lost(const struct rho_echo *echo);
void rho_clutter_map_start_echo(const struct rho_clutter_map *map, struct rho_echo *echo,
                                int32_t sensor_id, int64_t time_us, const struct rho_plot *plot);

/*
 * Frees `num` places in the table, the echoes with the most misses for their hits first. Echoes
 * that the newest scan saw stay.
 */
void rho_clutter_map_make_room(struct rho_clutter_map *map, uint32_t num, int64_t time_us);

#ifdef __cplusplus
}
#endif

#endif
