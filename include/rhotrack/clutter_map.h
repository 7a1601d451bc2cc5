/* SPDX-License-Identifier: MIT */
/*
 * clutter_map: clutter that comes back to its place.
 *
 * Towers, quays, flocks of birds and sea spikes give plots again and again. Counted one by one they are no denser than other
 * clutter; but where one was, the next is likely. The map holds the echoes of the last scans, each with its place and (where
 * v_min_mps is above 0) a slow speed, and learns how often an echo that was seen n times and missed k times comes back. From
 * that follows how much denser clutter is at each new plot than elsewhere:
 *
 *     density*(z) = density(z) + sum over echoes  chance(n, k) N(z; predicted place, its noise and the plot's)
 *
 * Tracks weigh their plots against it, and new tracks start against it. Nothing is forbidden: a target that passes a tower loses
 * what the tower explains better, no more, and thresholds stay as they are. src/DESIGN.md ("Clutter that comes back") derives it.
 *
 * The tracker has one map for all its sensors; each echo is of one sensor. It is of fixed size: where it is full, the echo that
 * was missed most for its hits makes room. Plots of targets that are tracked for long teach nothing. An echo counts as known
 * after RHO_ECHO_KNOWN_HITS hits.
 *
 * Stack: 100 bytes at most.
 */
#ifndef RHOTRACK_CLUTTER_MAP_H
#define RHOTRACK_CLUTTER_MAP_H

#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/status.h"
#include "rhotrack/types.h"

/* Hits from which an echo is known: maps are saved, shown and counted from here. */
#define RHO_ECHO_KNOWN_HITS 6

/* Classes of hits (1; 2; 3 to 5; 6 and more) and of scans since the last one (1; 2; 3, 4; 5 to 8; 9 and more). */
#define RHO_ECHO_HIT_CLASSES 4
#define RHO_ECHO_GAP_CLASSES 5

#if RHO_MAX_ECHOES > 0

/* Something that gave clutter plots. */
struct rho_echo {
    int64_t time_us; /* of the estimate */
    int32_t sensor_id;
    float x_m, y_m, vx_mps, vy_mps;
    /* along and across the sensor's line of sight: variance of the place, covariance of place and speed, variance of the speed;
     * m^2, m^2/s, m^2/s^2 */
    float along[3], across[3];
    float weight;   /* chance that the plot below is the echo's */
    int16_t plot;   /* row of its best plot in the newest scan; -1: none */
    uint16_t hits;  /* saturates; 0: the place in the table is free */
    uint8_t unseen; /* scans of the sensor that looked there since the last hit */
    uint8_t
        is_target; /* a plot of it belonged to a target that has been tracked for long: it teaches nothing */
    uint8_t region;        /* of the tables below */
    uint8_t was_looked_at; /* by the newest scan */
};

/* How often echoes came back: scans that looked, and those that saw them again. */
struct rho_echo_returns {
    float looks[RHO_ECHO_HIT_CLASSES][RHO_ECHO_GAP_CLASSES];
    float returns[RHO_ECHO_HIT_CLASSES][RHO_ECHO_GAP_CLASSES];
};

#define RHO_ECHO_TABLES (RHO_ECHO_REGIONS * RHO_ECHO_REGIONS + 1)

struct rho_clutter_map {
    int64_t time_us;         /* of the newest scan that it looked at */
    float v_min_mps;         /* nothing that moves as fast is clutter; 0: only what stands is */
    uint32_t echoes_dropped; /* gave way to others; saturates */
    float rate_plots,
        exact_plots; /* of echoes, with range rates; those whose rate is just the echo's speed */
    float scans_to_blocks; /* scans until the tables below are moved on */
    uint16_t first_echo;   /* that the next scan looks for first: where work ended the last time */
    uint16_t is_looked;    /* ratios and best echoes below are those of the newest scan */
    /* by regions of range and azimuth about the sensor, and of all of them. [1], [2]: of the last scans, not believed yet: their
     * plots may turn out to be a target's */
    struct rho_echo_returns tables[3][RHO_ECHO_TABLES];
    struct rho_echo echoes[RHO_MAX_ECHOES];
    /* of the newest scan's plots: ln of density* over density (while the map is looked at: what echoes and strobes add, 1/m^2); the
     * echo that explains the plot best, and its share of that density */
    float denser[RHO_MAX_PLOTS], best_per_m2[RHO_MAX_PLOTS];
    uint16_t best_echo[RHO_MAX_PLOTS];
    /* of the newest scan: plots by direction, and the eighths of the sensor's range that they lie in, a bit each */
    uint16_t strobe_count[RHO_STROBE_BINS];
    uint8_t strobe_ranges[RHO_STROBE_BINS];
};

/*
 * Tells the map of something that stands, seen `hits` times (1 .. 65535): a tower that is known beforehand, or an echo of a saved
 * map. It is forgotten like others where it is never seen.
 *   sensor_id                     whose echo it is
 *   sigma_range_m, sigma_cross_m  how well the place is known along and across the line of sight, 0.001 .. 1e5
 * Errors: NULL, VALUE (a place that is no coordinate, a sigma or hits outside its range). The map being full is none: the echo
 * that was missed most gives way. Cost: RHO_MAX_ECHOES. Stack: 290 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_clutter_map_teach(struct rho_clutter_map *map, int32_t sensor_id,
                                                     float x_m, float y_m, float sigma_range_m,
                                                     float sigma_cross_m, uint16_t hits);

/*
 * The known echoes one by one:
 *
 *     uint32_t place = 0;
 *     while ((echo = rho_clutter_map_next(&tracker.clutter_map, &place))) ...
 *
 * NULL behind the last one, or where map or place is NULL. Cost of the whole walk: RHO_MAX_ECHOES.
 */
const struct rho_echo *rho_clutter_map_next(const struct rho_clutter_map *map, uint32_t *place);

/* 1: it stands, as far as its plots can tell; what moves is somewhere else when a saved map is loaded. 0: it moves, or is NULL. */
int rho_clutter_map_stands(const struct rho_echo *echo);

/*
 * What was learned of echoes with so many hits, missed `unseen` times: the scans that looked, and those that saw them again; what is
 * not believed yet is in. Both 0 where a region is none, or map is NULL. Saved for each region and the least hits (1, 2, 3, 6) and
 * unseen (1, 2, 3, 5, 9) of each class, and taught again, a restart keeps it.
 *   region  0 .. RHO_ECHO_TABLES - 2; RHO_ECHO_TABLES - 1: of all
 */
void rho_clutter_map_learned(const struct rho_clutter_map *map, unsigned region, unsigned hits,
                             unsigned unseen, float *looks, float *returns);

/*
 * Replaces what is believed of them.
 * Errors: NULL, VALUE (no such region, hits or unseen 0, looks outside 0 .. 1e9, returns outside 0 .. looks); nothing is changed.
 */
RHO_MUST_CHECK enum rho_status rho_clutter_map_teach_returns(struct rho_clutter_map *map,
                                                             unsigned region, unsigned hits,
                                                             unsigned unseen, float looks,
                                                             float returns);

/* Chance that an echo of so many hits that was missed `unseen` times is seen by the next scan there. Constant cost. */
float rho_clutter_map_chance(const struct rho_clutter_map *map, unsigned region, unsigned hits,
                             unsigned unseen);

/* True where the map may be worked with, wherever its bytes come from: rho_tracker_is_sound asks it. Cost: RHO_MAX_ECHOES. */
int rho_clutter_map_is_sound(const struct rho_clutter_map *map);

#endif

#endif
