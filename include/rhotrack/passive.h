/* SPDX-License-Identifier: MIT */
/*
 * passive: track initiation from bearings of two to RHO_MAX_PASSIVE_SENSORS sensors, which may move
 * and look at times of their own. Sensors at one place support each other and do not cross.
 *
 * A batch of looks is searched in four steps (src/DESIGN.md derives them):
 *
 *   1 cross     all pairs of sensors, row by row; of three sensors or more another one must have a
 *               bearing towards a crossing
 *   2 propose   two crossings are a hypothesis of constant velocity; those that most bearings agree
 *               with are fitted to the bearings (Gauss-Newton, nearest bearing of each look)
 *   3 select    the set of tracks with the highest total score in which no bearing counts twice
 *   4 repeat    1 and 2 with the bearings that no track has claimed, without the third sensor; then
 *               one selection from all candidates
 *
 * Source: the passive Hough transform paper (see bearing_crossing.h) for step 1 and the idea that
 * targets are where crossings line up; its own votes are in passive_paper.h.
 *
 * Stack: 64 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_PASSIVE_H
#define RHOTRACK_PASSIVE_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/detail/linalg.h"
#include "rhotrack/detail/recent_bearing_frames.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

struct rho_passive_config {
    uint32_t scans; /* number of scans in the batch, N: 3 .. RHO_MAX_PASSIVE_SCANS */
    /*
     * range limit of all sensors: 1000 .. 500000. If it is too small, targets beyond it are not
     * found, and ghosts within it are confirmed by the bearings of these targets
     */
    float range_max_m;
    float v_max_mps;         /* largest speed of targets: 1 .. RHO_LIMIT_SPEED_MPS */
    float pd;                /* probability that a sensor sees a target in a scan: 0.01 .. 0.999 */
    float field_of_view_rad; /* width of the sector in which false bearings occur: 0.01 .. 2 pi */
    /* rate of false tracks that reach the score start_mnat: 1e-6 .. 1e6 */
    float false_tracks_per_hour;
    /*
     * limit of the work of a search, up to RHO_LIMIT_WORK units of 100 to 200 instructions of a
     * Cortex-M4; 0: none. Beyond it middle rows are not crossed, or pairs not compared or fitted:
     * work.points_dropped and candidates_dropped tell
     */
    uint32_t work_max;
};

/* A track found by a search: position and constant velocity at the time of the newest scan. */
struct rho_passive_track {
    float x_m, y_m, vx_mps, vy_mps;
    float z_m, vz_mps;    /* of bearings with elevations; without any, is_level is 1 */
    float covariance[21]; /* covariance of x, y, vx, vy, z, vz, lower triangle */
    int32_t score_mnat;   /* log-likelihood ratio of one target against false bearings */
    /* margin: total score of all tracks minus that of the best set of tracks without this one */
    int32_t margin_mnat;
    /* sum of the squared normalised residuals of bearings and slopes */
    float chi2;
    float prior_nat;  /* of the score: ln of the share of places and speeds that they leave */
    uint16_t hits;    /* number of bearings of the track */
    uint16_t scans;   /* scans with bearings of the track: bit k for scan k, 0 the oldest */
    uint8_t is_level; /* 1: none of its bearings has an elevation */
    /* bearings of the track: for each scan and sensor the index in the batch, from 1; 0: none */
    uint8_t claim[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS];
};

/* Counters of a search, and of items left out for lack of room. All saturate. */
struct rho_passive_work {
    /* first pass: pairs of bearings crossed, and those that tell no place, or lack support */
    uint32_t crossings, ghosts;
    /* crossings beyond RHO_MAX_PASSIVE_POINTS, the unlikely, and bearings beyond work_max */
    uint32_t points_dropped;
    uint32_t hypotheses; /* pairs of crossings whose agreement with the bearings was computed */
    uint32_t fits;       /* fits of a state to bearings */
    /* beyond RHO_MAX_PASSIVE_CANDIDATES, _TRACKS where chosen; partners, fits beyond work_max */
    uint32_t candidates_dropped;
    uint32_t spent; /* units of work */
};

/* Bearings of a look, a bit each. */
#if RHO_MAX_BEARINGS <= 8
typedef uint8_t rho_bearing_set;
#elif RHO_MAX_BEARINGS <= 16
typedef uint16_t rho_bearing_set;
#elif RHO_MAX_BEARINGS <= 32
typedef uint32_t rho_bearing_set;
#else
typedef uint64_t rho_bearing_set;
#endif

/*
 * A crossing that was not pruned, with covariance, relative to the looks' centroid. Of two times,
 * it is where the bearings' rays meet, with the way of a target between them as an error.
 */
struct rho_passive_point {
    float x_m, y_m;
    float xx_m2, xy_m2, yy_m2;
    uint8_t scan;
    uint8_t sensors; /* those of its bearings: 8 a + b */
    /* for each sensor the index of its bearing towards the crossing, from 1; 0: none */
    uint8_t claim[RHO_MAX_PASSIVE_SENSORS];
    float evidence_nat; /* log-likelihood ratio of the bearings of sensors other than a and b */
};

/* A crossing's partner: both together are a hypothesis of constant velocity. */
struct rho_passive_partner {
    uint16_t agreement; /* of the bearings with it, in 1/500 of a look; 0: none, or used */
    uint16_t point;     /* index of the later crossing in points[] */
};
#define RHO_PASSIVE_PARTNERS 2u /* best ones of each crossing that are kept */

/* A track that is followed already, for rho_passive_challenge. */
struct rho_passive_known {
    uint32_t track_id;
    float x_m, y_m, vx_mps, vy_mps; /* at the time of the newest frame */
    float z_m, vz_mps;              /* 0 with is_level */
    uint8_t is_level;               /* 1: its height is not known */
    uint8_t is_safe;                /* 1: its bearings are its own, and start no other track */
    uint8_t is_beaten;              /* result, 1: the best set of tracks is without it */
};

/* A fitted hypothesis of a track: position at mid-batch, and displacement in half the batch. */
struct rho_passive_candidate {
    float state_m[6]; /* x, y and their displacements, z and its */
    float score_nat;
    uint16_t hits;
    uint16_t known; /* 1 + index of the known track that it is; 0: a new one */
    uint8_t claim[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS];
};

/* Tracks that are fitted together, so that no two of them claim one bearing. */
struct rho_passive_set {
    uint16_t num;
    float total_nat; /* sum of the scores of the tracks */
    struct rho_passive_candidate tracks[RHO_MAX_PASSIVE_TRACKS];
    float chi2[RHO_MAX_PASSIVE_TRACKS];
    /* index of the candidate that each track started from */
    uint8_t candidate[RHO_MAX_PASSIVE_TRACKS];
    uint8_t is_track[RHO_MAX_PASSIVE_TRACKS];
};

struct rho_passive {
    uint32_t magic;
    struct rho_passive_config config;
    /* number of tracks found by the last search; they are sorted by score, best first */
    uint16_t num_tracks;
    uint16_t num_candidates;
    /*
     * score that a new track must reach: false tracks reach it at the rate false_tracks_per_hour at
     * most, as the mean likelihood ratio of a target anywhere is 1 where there is none
     * (src/DESIGN.md)
     */
    int32_t start_mnat;
    uint32_t num_points;
    struct rho_passive_work work;
    struct rho_passive_track tracks[RHO_MAX_PASSIVE_TRACKS];
    struct rho_batch batch;
    /* of each bearing, during a search: 0 free, 1 a chosen candidate's, 2 another track's */
    uint8_t is_claimed[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS][RHO_MAX_BEARINGS];
    /* from here on: scratch memory of a search */
    /*
     * of each look the bearings within 6 sigmas of a direction; bins count around |x| + |y| = 1
     * from south
     */
    rho_bearing_set nearby[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS][RHO_PASSIVE_BINS];
    struct rho_passive_point points[RHO_MAX_PASSIVE_POINTS];
    struct rho_passive_partner partners[RHO_MAX_PASSIVE_POINTS][RHO_PASSIVE_PARTNERS];
    struct rho_passive_candidate candidates[RHO_MAX_PASSIVE_CANDIDATES];
    /* number of bearings that two candidates both claim, a lower triangle */
    uint8_t shared[RHO_TRIANGLE(RHO_MAX_PASSIVE_CANDIDATES)];
    struct rho_passive_set best;
};

/*
 * Defaults: scans 8, range 100 km, v_max 450 m/s, pd 0.9, field of view pi, RHO_WORK_MAX. Constant
 * cost.
 */
void rho_passive_config_default(struct rho_passive_config *config);

/*
 * Initialises the passive initiator with an empty batch; the config is copied.
 *   object_size   sizeof(struct rho_passive) of the caller
 * Errors: NULL, SIZE, CONFIG (a field outside its range). Cost: sizeof(passive). Stack: 170 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_passive_init(struct rho_passive *passive, size_t object_size,
                                                const struct rho_passive_config *config);

/*
 * Status of a push of the frame: NULL, STATE (not initialised), or that of rho_batch_accepts.
 * Stack: 90 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_passive_accepts(const struct rho_passive *passive,
                                                   const struct rho_frame *frame);

/*
 * Adds a frame of bearings to the batch by rho_batch_push, and discards the tracks of the last
 * search. Errors: those of rho_batch_push. Stack: 240 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_passive_push(struct rho_passive *passive,
                                                const struct rho_frame *frame, uint8_t *fates);

/*
 * Gives the bearings of a track of the last search to the track that was started from it. Returns
 * the number of those that nobody had.
 */
uint32_t rho_passive_give(struct rho_passive *passive, const struct rho_passive_track *track,
                          uint32_t track_id);

/*
 * Searches the batch for tracks, from bearings without an owner. Results: passive->tracks[0 ..
 * num_tracks - 1]. Errors: NULL, STATE (not initialised). Fewer than 3 rows, or one sensor: RHO_OK
 * and no track. Cost: work_max, fits of known tracks, and the choice among candidates. Stack: 3.5
 * KB (embedded profile).
 */
RHO_MUST_CHECK enum rho_status rho_passive_search(struct rho_passive *passive);

/*
 * Searches all bearings for the best set of tracks, known and new, and says which known ones it
 * lacks: a track that began with bearings of several targets gives way to theirs. Bearings of other
 * owners are left out. Results: as of rho_passive_search, known[].is_beaten. Errors: NULL, STATE,
 * CAPACITY (more than RHO_MAX_PASSIVE_TRACKS that are not safe). Stack: 2.9 KB (embedded profile).
 */
RHO_MUST_CHECK enum rho_status rho_passive_challenge(struct rho_passive *passive,
                                                     struct rho_passive_known *known,
                                                     uint32_t num_known);

/* Pairs of sensors that both gave the track a bearing. Cost: all claims. */
unsigned rho_passive_sensor_pairs(const struct rho_passive_track *track);

/*
 * True where counts, indices and numbers of an object of unknown origin are within their limits, as
 * rho_snapshot_load asks. Cost: all bearings held. Stack: 250 bytes.
 */
int rho_passive_is_sound(const struct rho_passive *passive);

RHO_END_C

#endif
