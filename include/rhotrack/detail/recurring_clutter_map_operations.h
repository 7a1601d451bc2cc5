/* SPDX-License-Identifier: MIT */
/*
 * recurring_clutter_map_operations: the operations on single echoes, and on the counts of their
 * returns, that src/tracker needs.
 *
 * Stack: 280 bytes at most.
 */
#ifndef RHOTRACK_RECURRING_CLUTTER_MAP_OPERATIONS_H
#define RHOTRACK_RECURRING_CLUTTER_MAP_OPERATIONS_H

#include "rhotrack/detail/recurring_clutter_map.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Line of sight from a sensor to a place: unit vector and range. */
struct echo_view {
    float along_x, along_y;
    float range_m;
};

/* Sets the initial values of a map whose bytes are all 0. */
void rho_clutter_map_init(struct rho_clutter_map *map, float v_min_mps);
/* Line of sight from a sensor, NULL for the origin, to a place. */
struct echo_view rho_clutter_map_view(const struct rho_sensor *sensor, float x_m, float y_m);
/* Azimuth of a line of sight, as a share of the circle: 0 .. 1 from -pi to pi. */
float rho_clutter_map_azimuth_turns(const struct echo_view *view);
/* Index of the region of azimuth and range in which a place lies. */
uint8_t rho_clutter_map_region_at(const struct rho_sensor *sensor, float range_max_m, float x_m,
                                  float y_m);
/* Counts, in the newest block, that a scan covered an echo. */
void rho_clutter_map_count_look(struct rho_clutter_map *map, const struct rho_echo *echo);
/* Counts, in the newest block, the return of an echo by its weight. */
void rho_clutter_map_count_return(struct rho_clutter_map *map, const struct rho_echo *echo);
/* Factor by which the counts in use decay over `turn_share` of a revolution. */
float rho_clutter_map_decay_factor(float turn_share);
/* Decays the counts in use over `turn_share` of a revolution; closes the newest block when due. */
void rho_clutter_map_age_counts(struct rho_clutter_map *map, float turn_share);
/* Takes a target's returns out of a region's counts: by class of hits, its echoes' weights. */
void rho_clutter_map_remove_returns(struct rho_clutter_map *map, unsigned region,
                                    const float returns[RHO_ECHO_HIT_CLASSES]);
/* Class of an echo by its number of hits: 0 .. RHO_ECHO_HIT_CLASSES - 1. */
unsigned rho_clutter_map_hit_class(unsigned hits);
/* Moves an echo's estimate on to a time. */
void rho_clutter_map_predict_echo(struct rho_echo *echo, int64_t time_us);
/* Updates an echo's estimate with a plot, which counts as a hit. */
void rho_clutter_map_update_echo(struct rho_echo *echo, const struct rho_sensor *sensor,
                                 const struct rho_plot *plot);
/* True where an echo has not been seen for more scans than its class of hits allows. */
int rho_clutter_map_is_echo_lost(const struct rho_echo *echo);
/* Starts an echo with one hit from a plot. */
void rho_clutter_map_start_echo(const struct rho_clutter_map *map, struct rho_echo *echo,
                                int32_t sensor_id, int64_t time_us, const struct rho_plot *plot);
/*
 * Frees places until `num` are free in the table: drops the echoes with the most misses for their
 * hits. Echoes that the newest scan saw stay.
 */
void rho_clutter_map_free_places(struct rho_clutter_map *map, uint32_t num, int64_t time_us);

#ifdef __cplusplus
}
#endif

#endif
