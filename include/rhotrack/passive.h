/* SPDX-License-Identifier: MIT */
/*
 * passive: track initiation from bearings of two to RHO_MAX_PASSIVE_SENSORS sensors that stand still.
 *
 * Every pair of bearings of two sensors crosses somewhere, at a target or at a ghost. A batch of scans is searched in five
 * steps:
 *
 *   1 cross     all pairs of sensors, scan by scan; ghosts are pruned (ghost), and with three sensors or more a crossing
 *               needs a bearing of a third one
 *   2 vote      crossings vote for lines (rho, theta), spread as far as their covariance says; a cell's votes are
 *               distinct scans
 *   3 propose   pairs of a line's crossings give constant velocities; those that most bearings agree with are fitted to
 *               the bearings (Gauss-Newton, nearest bearing of each scan and sensor)
 *   4 select    the tracks whose log-odds add up to the most when no bearing counts twice, all at once
 *   5 again     on the bearings that nobody has claimed, with fewer votes and without the third sensor; then one
 *               selection of all
 *
 * Source: the passive Hough transform paper (see crossing.h) for steps 1 and 2; it takes lines of crossings for tracks. A
 * line knows no time, and straight lines of ghosts pass: steps 3 to 5 are what src/DESIGN.md derives instead.
 *
 * Stack: 64 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_PASSIVE_H
#define RHOTRACK_PASSIVE_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/batch.h"
#include "rhotrack/config.h"
#include "rhotrack/ghost.h"
#include "rhotrack/status.h"
#include "rhotrack/types.h"

struct rho_passive_config {
    uint32_t scans; /* N, the batch: 4 .. RHO_MAX_PASSIVE_SCANS */
    /* no sensor sees farther: 1000 .. 500000. Too small, targets beyond are not to be had, and ghosts explain their
     * bearings with a margin */
    float range_max_m;
    float v_max_mps;         /* of targets: 1 .. RHO_LIMIT_SPEED_MPS */
    float pd;                /* probability that a sensor sees a target in a scan: 0.01 .. 0.999 */
    float field_of_view_rad; /* that false bearings are spread over: 0.01 .. 2 pi */
    /* share of the looks that a track has a bearing of, of those whose sectors it was in: 0.1 .. 1; and half as much of
     * all */
    float hits_min;
    float
        rho_cell_m; /* 2 (range_max_m + the farthest sensor) over it: at most RHO_PASSIVE_RHO_CELLS */
    float theta_cell_rad;        /* pi over it: at most RHO_PASSIVE_THETA_CELLS */
    enum rho_ghost_rule rule;    /* of step 1 */
    float false_tracks_per_hour; /* that start_mnat allows by chance: 1e-6 .. 1e6 */
};

/* A track found: constant velocity, at the newest scan's time. */
struct rho_passive_track {
    float x_m, y_m, vx_mps, vy_mps;
    float covariance[10]; /* of these four, lower triangle */
    int32_t score_mnat;   /* log-odds that its bearings are one target's */
    int32_t
        margin_mnat; /* what the tracks together are worth more than the best others without this one */
    float chi2;      /* of the bearings, hits - 4 degrees of freedom */
    uint16_t hits;  /* bearings */
    uint16_t scans; /* bit k: a bearing of scan k, 0 the oldest */
    /* by scan and sensor: the bearing's place among those held of that scan and sensor, from 1; 0: none */
    uint8_t claim[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS];
};

/* What a search did, and what its capacities cut. All saturate. */
struct rho_passive_work {
    uint32_t crossings,
        ghosts;              /* of the first pass: all pairs of bearings; removed before voting */
    uint32_t points_dropped; /* crossings beyond RHO_MAX_PASSIVE_POINTS: the least certain */
    uint32_t line_points_dropped; /* of a line beyond 160: the last pairs of sensors' */
    uint32_t peaks;               /* lines looked at */
    uint32_t hypotheses;          /* pairs of crossings scored */
    uint32_t fits;                /* a pair's once, as long as that is known */
    uint32_t candidates_dropped;  /* beyond RHO_MAX_PASSIVE_CANDIDATES */
};

/* A crossing that was not pruned; places from the sensors' middle. */
struct rho_passive_point {
    float x_m, y_m;
    float xx_m2, xy_m2, yy_m2;
    uint16_t scan;
    uint16_t reserved; /* 0 */
};

/* A pair of crossings that was fitted: their places in points. */
struct rho_passive_fitted {
    uint16_t a, b; /* the same: none */
    uint16_t when; /* candidates taken away by then; UINT16_MAX: it was no track */
};

/* A fitted hypothesis: place at mid-batch, and half the way flown in the batch. */
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
    uint8_t candidate[RHO_MAX_PASSIVE_TRACKS]; /* that each was */
    uint8_t is_track[RHO_MAX_PASSIVE_TRACKS];
};

struct rho_passive {
    uint32_t magic;
    struct rho_passive_config config;
    uint16_t num_tracks; /* found by the last search, the best score first */
    uint16_t num_candidates;
    /*
     * A track with less may be chance, more often than false_tracks_per_hour: two crossings make a state that their four
     * bearings fit, whatever they are, and there are so many pairs of crossings (src/DESIGN.md).
     */
    int32_t start_mnat;
    uint32_t num_points;
    struct rho_passive_work work;
    struct rho_passive_track tracks[RHO_MAX_PASSIVE_TRACKS];
    struct rho_batch batch;
    uint8_t is_claimed[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS][RHO_MAX_BEARINGS];
    /* scratch of a search */
    /* by direction, round |x| + |y| = 1 from south: a bit where a bearing is within nine sigmas */
    uint32_t directions[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS][RHO_PASSIVE_BINS / 32];
    uint16_t cells[RHO_PASSIVE_THETA_CELLS][RHO_PASSIVE_RHO_CELLS]; /* a bit a scan */
    struct rho_passive_point points[RHO_MAX_PASSIVE_POINTS];
    struct rho_passive_fitted fitted[RHO_PASSIVE_PAIRS];
    struct rho_passive_candidate candidates[RHO_MAX_PASSIVE_CANDIDATES];
    uint8_t shared[RHO_MAX_PASSIVE_CANDIDATES][RHO_MAX_PASSIVE_CANDIDATES]; /* bearings */
    struct rho_passive_set best, other, spare;
};

/* scans 8, range 100 km, v_max 450 m/s, pd 0.9, field of view pi, hits_min 0.65, cells of 2 km and 5 degrees, the safe
 * rule. Constant cost. */
void rho_passive_config_default(struct rho_passive_config *config);

/*
 * Prepares an empty batch; the config is copied.
 *   size   sizeof(struct rho_passive) of the caller
 * Errors: NULL, SIZE, CONFIG (any field outside its range). Cost: sizeof(passive) bytes cleared. Stack: 170 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_passive_init(struct rho_passive *passive, size_t size,
                                                const struct rho_passive_config *config);

/* Whether rho_passive_push takes the frame: STATE (not initialised), and the errors of rho_batch_accepts. */
RHO_MUST_CHECK enum rho_status rho_passive_accepts(const struct rho_passive *passive,
                                                   const struct rho_frame *frame);

/*
 * Takes a frame: rho_batch_push of the batch, and its errors. The tracks of the last search are gone. Stack: 160 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_passive_push(struct rho_passive *passive,
                                                const struct rho_frame *frame, uint8_t *fates);

/*
 * Takes a found track's bearings out of the batch: a later search starts no other track from them. Once a track of the
 * last search. Returns how many these were.
 */
uint32_t rho_passive_consume(struct rho_passive *passive, const struct rho_passive_track *track);

/*
 * Searches the batch. Results: passive->tracks[0 .. num_tracks - 1].
 * Errors: NULL, STATE (not initialised). Fewer than 4 frames, or one sensor: RHO_OK and no track.
 * Cost: src/DESIGN.md. Stack: 3.5 KB (embedded profile).
 */
RHO_MUST_CHECK enum rho_status rho_passive_search(struct rho_passive *passive);

/* Pairs of sensors that both gave the track a bearing. Cost: RHO_MAX_PASSIVE_SCANS x RHO_MAX_PASSIVE_SENSORS. */
unsigned rho_passive_sensor_pairs(const struct rho_passive_track *track);

/*
 * True where the object may be worked with, wherever its bytes come from (a snapshot, memory that outlived a reset): counts and
 * places are within what they count, numbers within their limits. rho_snapshot_load asks it. Cost: all bearings held. Stack: 250 bytes.
 */
int rho_passive_is_sound(const struct rho_passive *passive);

#endif
