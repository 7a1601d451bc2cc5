/* SPDX-License-Identifier: MIT */
/*
 * The clutter map's inside. Private to src/tracker.
 */
#ifndef RHOTRACK_CLUTTER_MAP_PARTS_H
#define RHOTRACK_CLUTTER_MAP_PARTS_H

#include "rhotrack/clutter_map.h"

#if RHO_MAX_ECHOES > 0

/* Where a sensor sees something: unit vector along its line of sight, and the region of the tables. */
struct echo_view {
    float along_x, along_y;
    float range_m;
};

void rho_clutter_map_init(struct rho_clutter_map *map, float v_min_mps);

struct echo_view rho_clutter_map_view(const struct rho_sensor *sensor, float x_m, float y_m);
float rho_clutter_map_turn(const struct echo_view *view); /* its direction as a share of a turn */
uint8_t rho_clutter_map_region(const struct rho_sensor *sensor, float range_max_m, float x_m,
                               float y_m);

/* Tables: what one scan tells, then on to the next. `share` is the part of a turn that the scan has seen. */
void rho_clutter_map_count_look(struct rho_clutter_map *map, const struct rho_echo *echo);
void rho_clutter_map_count_return(struct rho_clutter_map *map, const struct rho_echo *echo);
/* Share of what was counted that so much of a turn leaves. */
float rho_clutter_map_kept(float share);
void rho_clutter_map_move_on(struct rho_clutter_map *map, float share);

/* Takes back what plots of a target have taught: by class of hits, the shares of them that echoes explained. */
void rho_clutter_map_take_back(struct rho_clutter_map *map, unsigned region,
                               const float returns[RHO_ECHO_HIT_CLASSES]);
unsigned rho_clutter_map_hit_class(unsigned hits);

/* One echo: moves on to a time; takes a plot; is too long unseen to come back. */
void rho_clutter_map_predict(struct rho_echo *echo, int64_t time_us);
void rho_clutter_map_take(struct rho_echo *echo, const struct rho_sensor *sensor,
                          const struct rho_plot *plot);
int rho_clutter_map_is_lost(const struct rho_echo *echo);
void rho_clutter_map_begin(const struct rho_clutter_map *map, struct rho_echo *echo,
                           int32_t sensor_id, int64_t time_us, const struct rho_plot *plot);

/* Makes `num` places free, as far as there are echoes that the newest scan did not see: those missed most for their hits first. */
void rho_clutter_map_make_room(struct rho_clutter_map *map, uint32_t num, int64_t time_us);

#endif
#endif
