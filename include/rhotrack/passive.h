/* SPDX-License-Identifier: MIT */
/*
 * passive: track initiation from bearings of two to RHO_MAX_PASSIVE_SENSORS sensors that stand
 * still.
 *
 * Every pair of bearings of two sensors crosses somewhere, at a target or at a ghost. A batch of
 * scans is searched in five steps:
 *
 *   1 cross     all pairs of sensors, scan by scan; ghosts are pruned (ghost), and with three
 *               sensors or more a crossing needs a bearing of a third sensor
 *   2 vote      crossings vote for lines (rho, theta), spread according to their covariance; the
 *               votes of a cell are distinct scans
 *   3 propose   pairs of a line's crossings give constant velocities; those that most bearings
 *               agree with are fitted to the bearings (Gauss-Newton, nearest bearing of each scan
 *               and sensor)
 *   4 select    the set of tracks with the highest total score if no bearing counts twice
 *   5 repeat    with the bearings that no track has claimed, with fewer votes and without the
 *               third sensor; then one selection from all candidates
 *
 * Source: the passive Hough transform paper (see crossing.h) for steps 1 and 2, in which lines of
 * crossings are the tracks. A line has no time, and ghosts form lines too: src/DESIGN.md derives
 * steps 3 to 5.
 *
 * Stack: 64 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_PASSIVE_H
#define RHOTRACK_PASSIVE_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/detail/batch.h"
#include "rhotrack/detail/ghost.h"
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

struct rho_passive_config {
    uint32_t scans; /* N, the batch: 4 .. RHO_MAX_PASSIVE_SCANS */
    /*
     * range limit of all sensors: 1000 .. 500000. If it is too small, targets beyond it are not
     * found, and ghosts within it are confirmed by their bearings
     */
    float range_max_m;
    float v_max_mps;         /* of targets: 1 .. RHO_LIMIT_SPEED_MPS */
    float pd;                /* probability that a sensor sees a target in a scan: 0.01 .. 0.999 */
    float field_of_view_rad; /* of false bearings: 0.01 .. 2 pi */
    /*
     * smallest share of hits in the looks whose sector contained the track: 0.1 .. 1; half of it
     * is required of all looks
     */
    float hits_min;
    /* at least 2 (range_max_m + the farthest sensor) / RHO_PASSIVE_RHO_CELLS */
    float rho_cell_m;
    float theta_cell_rad;        /* at least pi / RHO_PASSIVE_THETA_CELLS */
    enum rho_ghost_rule rule;    /* of step 1 */
    float false_tracks_per_hour; /* rate of false tracks at start_mnat: 1e-6 .. 1e6 */
};

/* A track found: constant velocity, at the newest scan's time. */
struct rho_passive_track {
    float x_m, y_m, vx_mps, vy_mps;
    float covariance[10]; /* of these four, lower triangle */
    int32_t score_mnat;   /* log-likelihood ratio: one target's bearings against false ones */
    int32_t margin_mnat; /* total score of the tracks minus that of the best set without this one */
    float chi2;          /* of the bearings, hits - 4 degrees of freedom */
    uint16_t hits;       /* bearings */
    uint16_t scans;      /* bit k: a bearing of scan k, 0 the oldest */
    /* by scan and sensor: index of the bearing among those held, from 1; 0: none */
    uint8_t claim[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS];
};

/* Counters of a search, and of what exceeded a capacity. All saturate. */
struct rho_passive_work {
    uint32_t crossings, ghosts; /* of the first pass: all pairs of bearings; pruned before voting */
    uint32_t points_dropped;    /* crossings beyond RHO_MAX_PASSIVE_POINTS: the least certain */
    uint32_t line_points_dropped; /* of a line beyond 160: those of the last sensor pairs */
    uint32_t peaks;               /* lines searched */
    uint32_t hypotheses;          /* pairs of crossings scored */
    uint32_t fits;                /* repeated only if forgotten */
    uint32_t candidates_dropped;  /* beyond RHO_MAX_PASSIVE_CANDIDATES */
};

/* A crossing that was not pruned; the origin is the sensors' centroid. */
struct rho_passive_point {
    float x_m, y_m;
    float xx_m2, xy_m2, yy_m2;
    uint16_t scan;
    uint16_t reserved; /* 0 */
};

/* A pair of crossings that was fitted: their indices in points. */
struct rho_passive_fitted {
    uint16_t a, b; /* equal: no pair */
    uint16_t when; /* candidates removed before; UINT16_MAX: the fit was no track */
};

/* A fitted hypothesis: position at mid-batch, and displacement in half the batch. */
struct rho_passive_candidate {
    float state_m[4];
    float score_nat;
    uint32_t hits;
    uint8_t claim[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS];
};

/* Tracks that are fitted together, no bearing in two of them. */
struct rho_passive_set {
    uint16_t num;
    float total_nat; /* of the scores */
    struct rho_passive_candidate tracks[RHO_MAX_PASSIVE_TRACKS];
    float chi2[RHO_MAX_PASSIVE_TRACKS];
    uint8_t candidate[RHO_MAX_PASSIVE_TRACKS]; /* index of the candidate */
    uint8_t is_track[RHO_MAX_PASSIVE_TRACKS];
};

struct rho_passive {
    uint32_t magic;
    struct rho_passive_config config;
    uint16_t num_tracks; /* found by the last search, the best score first */
    uint16_t num_candidates;
    /*
     * False tracks reach a score below this more often than false_tracks_per_hour: the four
     * bearings of two crossings always fit a state, and there are many pairs of crossings
     * (src/DESIGN.md).
     */
    int32_t start_mnat;
    uint32_t num_points;
    struct rho_passive_work work;
    struct rho_passive_track tracks[RHO_MAX_PASSIVE_TRACKS];
    struct rho_batch batch;
    uint8_t is_claimed[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS][RHO_MAX_BEARINGS];
    /* scratch of a search */
    /*
     * bins of direction, around |x| + |y| = 1 from south: bit set if a bearing is within 9 sigmas
     */
    uint32_t directions[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS][RHO_PASSIVE_BINS / 32];
    uint16_t cells[RHO_PASSIVE_THETA_CELLS][RHO_PASSIVE_RHO_CELLS]; /* a bit per scan */
    struct rho_passive_point points[RHO_MAX_PASSIVE_POINTS];
    struct rho_passive_fitted fitted[RHO_PASSIVE_PAIRS];
    struct rho_passive_candidate candidates[RHO_MAX_PASSIVE_CANDIDATES];
    uint8_t shared[RHO_MAX_PASSIVE_CANDIDATES][RHO_MAX_PASSIVE_CANDIDATES]; /* bearings */
    struct rho_passive_set best, other, spare;
};

/*
 * scans 8, range 100 km, v_max 450 m/s, pd 0.9, field of view pi, hits_min 0.65, cells of 2 km and
 * 5 degrees, the safe rule. Constant cost.
 */
void rho_passive_config_default(struct rho_passive_config *config);

/*
 * Prepares an empty batch; the config is copied.
 *   size   sizeof(struct rho_passive) of the caller
 * Errors: NULL, SIZE, CONFIG (any field outside its range). Cost: sizeof(passive) bytes cleared.
 * Stack: 170 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_passive_init(struct rho_passive *passive, size_t size,
                                                const struct rho_passive_config *config);

/*
 * Whether rho_passive_push takes the frame: STATE (not initialised), and the errors of
 * rho_batch_accepts.
 */
RHO_MUST_CHECK enum rho_status rho_passive_accepts(const struct rho_passive *passive,
                                                   const struct rho_frame *frame);

/*
 * Takes a frame: rho_batch_push of the batch, and its errors. The tracks of the last search are
 * gone. Stack: 160 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_passive_push(struct rho_passive *passive,
                                                const struct rho_frame *frame, uint8_t *fates);

/*
 * Removes the bearings of a found track from the batch: a later search starts no other track from
 * them.
 * Once a track of the last search. Returns how many these were.
 */
uint32_t rho_passive_consume(struct rho_passive *passive, const struct rho_passive_track *track);

/*
 * Searches the batch. Results: passive->tracks[0 .. num_tracks - 1].
 * Errors: NULL, STATE (not initialised). Fewer than 4 frames, or one sensor: RHO_OK and no track.
 * Cost: src/DESIGN.md. Stack: 3.5 KB (embedded profile).
 */
RHO_MUST_CHECK enum rho_status rho_passive_search(struct rho_passive *passive);

/*
 * Pairs of sensors that both gave the track a bearing. Cost: RHO_MAX_PASSIVE_SCANS x
 * RHO_MAX_PASSIVE_SENSORS.
 */
unsigned rho_passive_sensor_pairs(const struct rho_passive_track *track);

/*
 * True if the object is valid, whatever its bytes come from (a snapshot, memory that outlived a
 * reset): counts and indices are within their arrays, numbers within their limits.
 * rho_snapshot_load asks it. Cost: all bearings held. Stack: 250 bytes.
 */
int rho_passive_is_sound(const struct rho_passive *passive);

#ifdef __cplusplus
}
#endif

#endif
