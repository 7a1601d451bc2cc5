/* SPDX-License-Identifier: MIT */
/*
 * initiator: the default track initiation: finds tracks among the plots of the last scans.
 *
 * A kernel-centric, time-aware Hough transform. Every pair of plots far apart in time is a kernel:
 * a straight track with a direction and a speed. Each scan between votes for the kernel with the
 * plot nearest to the place that the kernel predicts for that scan, if one lies in the gate of the
 * plots' noise. Votes are a bit mask of scans, so that no scan counts twice.
 * Kernels with enough votes are fitted (weighted least squares), every scan is associated again
 * with the fitted track, and the candidate is scored: the logarithm of the likelihood that these
 * plots are one target's over the likelihood that they are clutter of the local density. Candidates
 * are accepted best first; one that shares more than one plot with a better one is fitted again to
 * the plots that are left.
 *
 * Every plot counts with its own time and covariance, and with its height and range rate where
 * measured. After every scan the thresholds and M follow from the wanted false-track rate and from
 * the clutter in the window.
 *
 * src/DESIGN.md derives the gates, the score, the rate and the densities up to which this can work.
 * Source: Fan et al., "Neutrosophic Hough Transform-Based Track Initiation Method for Multiple
 * Target Tracking" (votes in parameter space by kernels of time-ordered scans); the score is the
 * integrated likelihood ratio over all straight tracks with speeds between v_min_mps and v_max_mps.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_INITIATOR_H
#define RHOTRACK_INITIATOR_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/detail/window.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

struct rho_initiator_config {
    uint16_t scans; /* N, scans in the window: 3 .. RHO_MAX_SCANS */
    /*
     * M, scans that must vote for a track: 3 .. N; 0: chosen from the clutter, by positions alone,
     * so that for a batch with range rates it may be larger than necessary
     */
    uint16_t min_scans;
    /* speeds of targets, 0 <= v_min < v_max, 0.01 <= v_max <= RHO_LIMIT_SPEED_MPS */
    float v_min_mps, v_max_mps;
    float pd; /* probability that a scan sees the target: 0.01 .. 0.999 */
    /*
     * wanted false-track rate of searches after every scan, 1e-6 .. 1e6: thresholds and M follow
     * from it; 0: score_min_nat is the threshold
     */
    float false_tracks_per_hour;
    float score_min_nat; /* least score of a candidate; always used for a batch */
    /*
     * standard deviation of accelerations that are constant within a scan interval, in the gates
     * and scores of positions; 0: none. Range rates are gated and scored without it
     */
    float process_noise_mps2;
    /*
     * standard deviation of accelerations in the plane that are constant over the window: the
     * search after every scan also finds targets that turn or change speed; 0: straight ones alone
     */
    float turn_mps2;
    /* limit of the work of a search, up to 1e8 units; in a batch for each last scan; 0: none */
    uint32_t work_max;
    int area_is_fixed;      /* 1: `area` is used; 0: the extent of recent plots */
    struct rho_extent area; /* rectangle over which clutter and births are spread */
};

/* A candidate track: the plots that voted for it, and their fit at the newest scan's time. */
struct rho_candidate {
    uint16_t mask; /* bit m: the scan of age order m voted */
    uint16_t hits; /* number of votes */
    /*
     * by age order of the scans: index of the scan's plot where the mask's bit is set, else 0. The
     * length is odd, so that nothing is padded
     */
    uint16_t plot[RHO_MAX_SCANS / 2 * 2 + 1];
    uint8_t has_z;      /* 1: z_m and vz_mps are fitted, as two plots or more have heights */
    uint8_t is_turning; /* 1: the fit has an acceleration; x_m .. vy_mps are from it */
    int32_t score_mnat;
    float x_m, y_m, vx_mps, vy_mps;
    float z_m, vz_mps; /* fitted height and climb rate; 0 unless has_z */
};

/* Work of the last search, and candidates dropped for lack of room or work. Counters saturate. */
struct rho_initiator_work {
    uint32_t seeds; /* kernels tried */
    struct rho_window_work window;
    uint32_t fits;               /* least-squares fits */
    uint32_t candidates_dropped; /* candidates beyond RHO_MAX_CANDIDATES, or beyond work_max */
};

/* Plot of the newest scan with which a search begins: its cost class, then its index. */
struct rho_initiator_resume {
    uint16_t cost_class, plot;
};

#define RHO_INITIATOR_CLASSES 16u

/*
 * Effects of the limit on work. A unit is a plot compared or a row of bins, 20 to 90 instructions;
 * a kernel is 2, a look-up 3, a fit 400. All saturate, and only rho_initiator_init clears them.
 * work is at most work_max (of a batch: for each scan that kernels end in) plus
 * RHO_INITIATOR_WORK_BEYOND, as work that was begun is finished. Thresholds and the density map are
 * not included; their cost follows from the capacities alone.
 */
#define RHO_INITIATOR_WORK_BEYOND                                                                  \
    ((16u + 30u * RHO_MAX_SCANS) * (RHO_MAX_PLOTS + RHO_MAX_BINS) + 4000u * RHO_MAX_SCANS)
struct rho_initiator_budget {
    uint32_t work, work_worst; /* units of work of the last search, and of the worst one */
    uint32_t partial_steps;   /* searches that left out plots, or candidates (candidates_dropped) */
    uint32_t plots_not_tried; /* newest plots whose kernels were not all tried */
    struct rho_initiator_resume resume; /* plot with which the next search begins */
};

/*
 * Clutter density in the window of the last search. u and v are x and y. They are range and azimuth
 * where all plots are of one radar, or of a few with a map each, the noise is anisotropic, and
 * plots are spread evenly in range rather than on the ground.
 */
struct rho_density_map {
    float mean;        /* mean density: plots a scan and unit of `content` */
    float prior_plots; /* weight of the mean against the count of a cell */
    /* scans that the map counts; a revolution that has only begun counts by its share */
    float scans;
    float content; /* content of the whole map: m^2, or m rad */
    /* place of the radar; azimuth from which azimuths of the map count */
    float sensor_x_m, sensor_y_m, middle_rad;
    float u0, v0, width, height;
    uint8_t is_polar, columns, rows;
    int32_t sensor_id; /* sensor whose plots the map counts, where there are several maps */
    /* plots of the window by cell, saturating: row * columns + column, u along the columns */
    uint16_t count[RHO_MAX_DENSITY_CELLS * RHO_MAX_DENSITY_CELLS];
};

#define RHO_CLUTTER_MEMORY_CELLS                                                                   \
    (RHO_MAX_CLUTTER_CELLS > 0 ? RHO_MAX_CLUTTER_CELLS * RHO_MAX_CLUTTER_CELLS : 1)

/*
 * Clutter memory: plots of the last hundred scans that left the window without starting a track, by
 * cells. Not used in a build without RHO_MAX_CLUTTER_CELLS.
 */
struct rho_clutter_memory {
    float x_min_m, y_min_m, columns_per_m, rows_per_m;
    uint32_t num_scans;                       /* scans counted; 0: none has left the window yet */
    uint16_t count[RHO_CLUTTER_MEMORY_CELLS]; /* plots by cell: row * cells a side + column */
};

enum rho_search {
    RHO_SEARCH_BATCH,  /* every track with min_scans votes anywhere in the window */
    RHO_SEARCH_NEWEST, /* tracks with a vote of the newest scan: for use after every push */
};

struct rho_initiator {
    uint32_t magic;
    uint16_t num_candidates; /* candidates found by the last search, best first */
    uint16_t min_scans;      /* M in use at the last search */
    /* scores that started and confirmed a track in the last search */
    int32_t start_mnat, confirm_mnat;
    struct rho_initiator_config config;
    struct rho_initiator_work work;
    float density_per_m2; /* clutter density in the last search, plots a scan: mean over the area */
    /* density maps in use. 1: one for all sensors; several: one a sensor; 0: before any search */
    uint16_t num_maps;
    /* density map and thresholds are those of the newest scan's revolution */
    uint16_t has_revolution;
    struct rho_density_map density[RHO_MAX_DENSITY_MAPS];
    /* by age order of the scans: plots a scan of the sensor over the mean of all; 0: no scan */
    float sensor_ratio[RHO_MAX_SCANS];
    int32_t sensor_id[RHO_MAX_SCANS];
    struct rho_clutter_memory memory;
    struct rho_initiator_budget budget;
    /* limit of thin clutter: 0.9 times the fewest clutter plots in a sampled plot's noise */
    float thin_clutter;
    /* by a set's first scan: hits that it needs where clutter is not thin */
    uint8_t span_hits[RHO_MAX_SCANS];
    /* by plots of the scan that is searched: classes of near plots, used during a search alone */
    uint8_t cost_class[RHO_MAX_PLOTS];
    struct rho_candidate candidates[RHO_MAX_CANDIDATES];
    struct rho_window window;
};

/*
 * Defaults: scans 7, min_scans 0, v_min 0, v_max 700 m/s, pd 0.9, 1 false track an hour, score_min
 * 0 nat, no process noise, turns of 6 m/s^2, RHO_WORK_MAX, area from the plots; scans is cut to
 * RHO_MAX_SCANS. Constant cost.
 */
void rho_initiator_config_default(struct rho_initiator_config *config);

/*
 * Prepares an empty initiator; the config is copied.
 *   size   sizeof(struct rho_initiator) of the caller
 * Errors: NULL, SIZE, CONFIG (a field out of range). Cost: sizeof(initiator). Stack: 168 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_initiator_init(struct rho_initiator *initiator, size_t size,
                                                  const struct rho_initiator_config *config);

/*
 * Gives an initiator another configuration, from the next search on. Where scans or area are other
 * ones the window begins anew; what was learned of clutter stays.
 * Errors: NULL, STATE (not initialised), CONFIG (as rho_initiator_init); nothing is changed. Cost:
 * constant, or the window cleared. Stack: 150 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_initiator_reconfigure(struct rho_initiator *initiator,
                                                         const struct rho_initiator_config *config);

/* True where the initiator is initialised and holds no scan newer than time_us. Constant cost. */
int rho_initiator_accepts(const struct rho_initiator *initiator, int64_t time_us);

/* rho_window_push on the initiator's window, which clears old candidates. Stack: 288 bytes. */
RHO_MUST_CHECK enum rho_status rho_initiator_push(struct rho_initiator *initiator,
                                                  const struct rho_scan *scan,
                                                  const struct rho_sensor *sensor, uint8_t *fates,
                                                  uint32_t *left_unused);

/*
 * Searches the window. Results: initiator->candidates[0 .. num_candidates - 1], best first,
 * deterministic. Errors: NULL, STATE (not initialised). Fewer than min_scans scans held: RHO_OK and
 * no candidate. Cost: work_max, and thresholds for false_tracks_per_hour: 0.3 to 0.9 million
 * instructions, twice where there are likely candidates. The work without a limit grows with
 * density, not with area: the newest plots times the plots within v_max x time of each in the N - M
 * + 1 scans before, a look-up each; where plots lie within their noise of one another, all pairs
 * times all plots. With work_max the newest plots with the fewest near plots come first, and the
 * counters of `budget` tell the plots that are left out. Kernels of turning targets come last, only
 * where nothing was left out, and take no more work than the others; plots that they leave out are
 * not counted. Stack: 3.3 KB (embedded profile).
 */
RHO_MUST_CHECK enum rho_status rho_initiator_search(struct rho_initiator *initiator,
                                                    enum rho_search search);

/*
 * As rho_initiator_search, with work_max instead of the configuration's: the work that a step has
 * left. Stack: 3.3 KB (embedded profile).
 */
RHO_MUST_CHECK enum rho_status rho_initiator_search_within(struct rho_initiator *initiator,
                                                           enum rho_search kind, uint32_t work_max);

/*
 * Marks the plots of a candidate of the last search as used: they leave all later searches.
 * Returns how many were not used before. candidate is not checked against num_candidates. Cost: N.
 */
unsigned rho_initiator_consume(struct rho_initiator *initiator,
                               const struct rho_candidate *candidate);

/*
 * Density of a sensor's plots near a place, plots a m^2 and scan, as of the last search: the count
 * of the map's cell, shrunk towards the mean as far as the counts of the cells are Poisson, or the
 * density of the last hundred scans there, where that is larger (RHO_MAX_CLUTTER_CELLS); times the
 * ratio of the sensor's plots to those of all sensors, or from a map of its own. A sensor without a
 * scan in the window counts as the mean. 0 before the first search. Cost: RHO_MAX_SCANS, for a map
 * about a radar an arctangent and a square root. Stack: 110 bytes.
 */
float rho_initiator_density(const struct rho_initiator *initiator, int32_t sensor_id, float x_m,
                            float y_m);

/*
 * True where counts, indices and numbers of an object of unknown origin are within their limits, as
 * rho_snapshot_load asks. Cost: all plots held. Stack: 250 bytes.
 */
int rho_initiator_is_sound(const struct rho_initiator *initiator);

RHO_END_C

#endif
