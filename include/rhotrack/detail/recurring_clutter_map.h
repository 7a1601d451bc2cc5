/* SPDX-License-Identifier: MIT */
/*
 * recurring_clutter_map: the places that return clutter again and again.
 *
 * Towers, quays, flocks of birds and sea spikes give plots again and again. Counted one by one they
 * are no denser than other clutter, but the next plot is likely where the last one was. The map
 * holds the echoes of the last scans, each with its place and (where v_min_mps is above 0) a slow
 * speed, and learns how often an echo with n hits returns after k misses. From that follows the
 * clutter density at each new plot:
 *
 *     density*(z) = density(z) + sum over echoes of p(n, k) N(z; predicted place, noise)
 *
 * p is the probability of a return, and the noise is that of the echo and the plot. Scores of
 * tracks and of new tracks are ratios to this density. No plot is blanked: a target that passes a
 * tower loses the plots that the tower explains better, and thresholds do not change. src/DESIGN.md
 * ("Clutter that comes back") derives it.
 *
 * Where targets may stand, what never moved is held for clutter, unless the tracker's config says
 * RHO_STANDING_TARGETS, or an operator starts a track there (operator.h).
 *
 * The tracker has one map for all its sensors; each echo belongs to one sensor. The map is of fixed
 * size: a full map drops the echo with the most misses for its hits. Plots of targets that are
 * tracked for long are not counted. An echo counts as known after RHO_ECHO_KNOWN_HITS hits.
 *
 * Stack: 280 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_RECURRING_CLUTTER_MAP_H
#define RHOTRACK_RECURRING_CLUTTER_MAP_H

#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

/* Hits from which an echo counts as known: only known echoes are saved, shown and counted. */
#define RHO_ECHO_KNOWN_HITS 6

/*
 * Number of classes of an echo's hits (1; 2; 3 to 5; 6 and more), and of scans since its last hit
 * (1; 2; 3, 4; 5 to 8; 9 and more).
 */
#define RHO_ECHO_HIT_CLASSES 4
#define RHO_ECHO_GAP_CLASSES 5

/* An echo: a place that returns clutter again and again. */
struct rho_echo {
    int64_t time_us; /* time of the estimate */
    int32_t sensor_id;
    float x_m, y_m, vx_mps, vy_mps;
    /*
     * along and across the sensor's line of sight: variance of the place, covariance of place and
     * speed, variance of the speed; m^2, m^2/s, m^2/s^2
     */
    float along[3], across[3];
    float weight;   /* probability that `plot` is of this echo */
    int16_t plot;   /* row of the echo's best plot in the newest scan; -1: none */
    uint16_t hits;  /* plots of the echo so far, saturating; 0: this place in the table is free */
    uint8_t unseen; /* scans of the sensor since the last hit that covered the echo */
    /* a plot of the echo was a target's, tracked for long; its looks and returns are not counted */
    uint8_t is_target;
    uint8_t region; /* index of the echo's region in the map's tables; UINT8_MAX: not known yet */
    uint8_t was_looked_at; /* the newest scan covered the echo */
};

/*
 * Counts of scans that covered echoes, and of scans that saw them again, by classes of hits and of
 * scans since the last hit.
 */
struct rho_echo_returns {
    float looks[RHO_ECHO_HIT_CLASSES][RHO_ECHO_GAP_CLASSES];
    float returns[RHO_ECHO_HIT_CLASSES][RHO_ECHO_GAP_CLASSES];
};

/* Lengths of the map's arrays. A build without it (RHO_MAX_ECHOES 0) never uses them. */
#define RHO_ECHO_PLACES (RHO_MAX_ECHOES > 0 ? RHO_MAX_ECHOES : 1)
#define RHO_ECHO_PLOTS (RHO_MAX_ECHOES > 0 ? RHO_MAX_PLOTS : 1)
#define RHO_ECHO_STROBES (RHO_MAX_ECHOES > 0 ? RHO_STROBE_BINS : 1)
#define RHO_ECHO_TABLES ((RHO_MAX_ECHOES > 0 ? RHO_ECHO_REGIONS * RHO_ECHO_REGIONS : 1) + 1)

struct rho_clutter_map {
    int64_t time_us; /* time of the newest scan */
    float v_min_mps; /* lowest speed of targets: clutter moves more slowly; 0: clutter stands */
    uint32_t echoes_dropped; /* echoes dropped for others, or for lack of room; saturates */
    /* plots of echoes with range rates; those that have the range rate of the echo's own speed */
    float rate_plots, exact_plots;
    float scans_to_blocks; /* revolutions until the newest block of counts is closed */
    /* place in the table with which the next scan begins, where the last scan's work ended */
    uint16_t first_echo;
    uint16_t is_looked; /* `denser`, `best_per_m2` and `best_echo` are those of the newest scan */
    /*
     * counts of looks and returns, by regions of range and azimuth about the sensor, and last over
     * all regions. [0] is used; [1] and [2] are blocks of the last revolutions, used later, as
     * their plots may turn out to be of targets
     */
    struct rho_echo_returns tables[3][RHO_ECHO_TABLES];
    struct rho_echo echoes[RHO_ECHO_PLACES];
    /*
     * by plots of the newest scan: ln of the ratio of the density with echoes to that without
     * (during the update: the density of echoes and strobes, 1/m^2); the echo that explains the
     * plot best, and the density that it adds
     */
    float denser[RHO_ECHO_PLOTS], best_per_m2[RHO_ECHO_PLOTS];
    uint16_t best_echo[RHO_ECHO_PLOTS];
    /* by direction: plots of the newest scan; eighths of the sensor's range with plots, as bits */
    uint16_t strobe_count[RHO_ECHO_STROBES];
    uint8_t strobe_ranges[RHO_ECHO_STROBES];
};

/*
 * Adds a standing echo with `hits` hits (1 .. 65535): a tower that is known beforehand, or an echo
 * of a saved map. It is dropped like others where it is never seen.
 *   sensor_id                     the sensor of the echo
 *   sigma_range_m, sigma_cross_m  of the place, along and across the line of sight, 0.001 .. 1e5
 * Errors: NULL, VALUE (a place that is no coordinate, a sigma or hits outside its range). In a full
 * map the echo with the most misses for its hits is dropped; where the newest scan saw every echo
 * of a full map, the new echo is not added. Either is RHO_OK, and echoes_dropped counts it.
 * Cost: RHO_MAX_ECHOES. Stack: 290 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_clutter_map_teach(struct rho_clutter_map *map, int32_t sensor_id,
                                                     float x_m, float y_m, float sigma_range_m,
                                                     float sigma_cross_m, uint16_t hits);

/*
 * The known echoes one by one:
 *
 *     uint32_t place = 0;
 *     while ((echo = rho_clutter_map_next_known(&tracker.clutter_map, &place))) ...
 *
 * NULL behind the last one, or where map or place is NULL. Cost of the whole walk: RHO_MAX_ECHOES.
 */
const struct rho_echo *rho_clutter_map_next_known(const struct rho_clutter_map *map,
                                                  uint32_t *place);

/* 1: the echo stands, as far as its plots tell, and may be saved. 0: it moves, or is NULL. */
int rho_clutter_map_is_echo_standing(const struct rho_echo *echo);

/*
 * Statistics of echoes with this number of hits after `unseen` misses: the scans that covered them,
 * and the scans that saw them again; the last scans are included. Both 0 for an invalid region, or
 * a map that is NULL. To keep them over a restart, save them for each region and the least hits (1,
 * 2, 3, 6) and unseen (1, 2, 3, 5, 9) of each class, and restore them by
 * rho_clutter_map_teach_returns.
 *   region  0 .. RHO_ECHO_TABLES - 2; RHO_ECHO_TABLES - 1: over all regions
 */
void rho_clutter_map_learned_looks_and_returns(const struct rho_clutter_map *map, unsigned region,
                                               unsigned hits, unsigned unseen, float *looks,
                                               float *returns);

/*
 * Replaces the statistics of echoes with this number of hits after `unseen` misses. Errors: NULL,
 * VALUE (no such region, hits or unseen 0, looks outside 0 .. 1e9, returns outside 0 .. looks).
 */
RHO_MUST_CHECK enum rho_status rho_clutter_map_teach_returns(struct rho_clutter_map *map,
                                                             unsigned region, unsigned hits,
                                                             unsigned unseen, float looks,
                                                             float returns);

/* Probability that an echo with so many hits returns after `unseen` misses. Constant cost. */
float rho_clutter_map_return_probability(const struct rho_clutter_map *map, unsigned region,
                                         unsigned hits, unsigned unseen);

/*
 * Keeps standing known echoes, as if they were taught, and the statistics, and forgets the other
 * echoes: after a change of the sensors' clock. Cost: RHO_MAX_ECHOES. Stack: 160 bytes.
 */
void rho_clutter_map_restart(struct rho_clutter_map *map);

/* True where a map of unknown origin (a snapshot) is consistent. Cost: RHO_MAX_ECHOES. */
int rho_clutter_map_is_sound(const struct rho_clutter_map *map);

/* Operations on single echoes, and on the counts of their returns, for src/tracker. */

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

RHO_END_C

#endif
