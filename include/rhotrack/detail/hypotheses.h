/* SPDX-License-Identifier: MIT */
/*
 * hypotheses: multiple-hypothesis tracking of one track: alternative histories of the plots that
 * belong to it, kept open for a few scans.
 *
 * A hypothesis is one history of assignments: an IMM filter that was updated with its plots, and a
 * weight, ln of the likelihood that these were the target's and all others clutter. At each scan
 * every hypothesis has children: one for each of its best plots, and one for a miss. The heaviest
 * children replace their parents; of children with the same assignments in the last
 * RHO_HYPOTHESES_MEMORY scans only the heaviest one is kept. So an assignment of a clutter plot is
 * undone when the next plots do not follow it.
 *
 *     scan n            n+1              A steady track in thin clutter has one hypothesis, one
 *     h1 ---- plot 3 ---- plot 1   w  0  that meets clutter while it turns RHO_HYPOTHESES_OF_TRACK.
 *       \---- miss ------ plot 1   w -4  All tracks share one pool. Where it is empty, the tracks
 *        \--- plot 7 ---- miss     w -9  with the most hypotheses lose the least likely ones, which
 *                                        a counter counts.
 *
 * Tracks have slots in the pool. One scan is: rho_hypotheses_predict,
 * rho_hypotheses_gate_box, rho_hypotheses_score_plot for each plot near the
 * track, rho_hypotheses_commit. Between the last two the caller may assign plots to other tracks.
 *
 * Source: D. B. Reid, An algorithm for tracking multiple targets, IEEE Transactions on Automatic
 * Control 24, 1979, for one track, with the pruning of the last N scans.
 *
 * Stack: 64 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_HYPOTHESES_H
#define RHOTRACK_HYPOTHESES_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/detail/doppler_notch.h"
#include "rhotrack/detail/imm.h"
#include "rhotrack/detail/kalman.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

#define RHO_HYPOTHESES_SLOTS (RHO_MAX_TRACKS + 1) /* one more, for a track that is being started */
#define RHO_HYPOTHESES_OF_TRACK 8
/* Most plots of a scan for which one hypothesis has children. */
#define RHO_HYPOTHESES_CHILDREN 3
/* Number of last scans in whose plots two hypotheses of a track must differ. */
#define RHO_HYPOTHESES_MEMORY 3
/* Least weight relative to the best hypothesis, nat; lighter ones are removed. */
#define RHO_HYPOTHESES_WEIGHT_MIN (-17.0f)
#define RHO_HYPOTHESES_MISS (-1)

/* A plot of the scan in the gate of one hypothesis. */
struct rho_hypotheses_candidate {
    float gain_nat;
    float probability; /* probability of a manoeuvre, if the plot is the target's */
    int16_t row;
};

struct rho_hypothesis {
    struct rho_imm imm;
    int64_t time_us; /* time of the filter: a scan's, or the last plot's own */
    /* weight relative to the track's best hypothesis, whose weight is 0 */
    float weight_nat;
    float share; /* share in the mean over hypotheses: e^weight, not normalised */
    /* rows of the last scans' plots, or RHO_HYPOTHESES_MISS; the newest last */
    int16_t picks[RHO_HYPOTHESES_MEMORY];
    /* candidates, the best one first */
    struct rho_hypotheses_candidate candidates[RHO_HYPOTHESES_CHILDREN];
    uint8_t num_candidates;
};

struct rho_hypotheses_child {
    float weight_nat;
    int16_t row;
    uint8_t parent, candidate;
};

/* The pool of all tracks' hypotheses. */
struct rho_hypotheses {
    uint32_t magic;
    /* updates that were numerically impossible, and became misses; saturates */
    uint32_t updates_refused;
    uint32_t hypotheses_cut; /* hypotheses removed because the pool was full; saturates */
    uint16_t num_free;
    struct rho_imm_model model;
    /* transition of the last interval, kept as most tracks have the same interval */
    struct rho_imm_step step;
    uint8_t num_of[RHO_HYPOTHESES_SLOTS]; /* number of hypotheses of a slot; 0: the slot is free */
    /* nodes of a slot's hypotheses, the best first */
    uint16_t node_of[RHO_HYPOTHESES_SLOTS][RHO_HYPOTHESES_OF_TRACK];
    uint16_t spare[RHO_MAX_HYPOTHESES];
    /* children of one slot's hypotheses in a scan, the best first */
    struct rho_hypotheses_child children[RHO_HYPOTHESES_OF_TRACK];
    struct rho_imm scratch;
    /* of slot gate_slot: gates for isotropic noise gate_variance_m2, or predicted range rates */
    union {
        struct rho_imm_gate gates[RHO_HYPOTHESES_OF_TRACK];
        struct rho_imm_rates rates[RHO_HYPOTHESES_OF_TRACK];
    } opened;
    float gate_variance_m2; /* noise variance of the gates; 0: range rates are prepared */
    uint16_t gate_slot;
    uint8_t gate_has_z, gate_is_usable;
    struct rho_hypothesis nodes[RHO_MAX_HYPOTHESES];
};

/* Density of clutter, as natural logarithms, for each dimension that plots may have. */
struct rho_hypotheses_clutter {
    float log_per_m2;         /* ln of the density in x and y */
    float log_per_m;          /* ln of the density in height */
    float log_per_mps;        /* ln of the density in each velocity component */
    float log_per_range_rate; /* ln of the density in range rate, per m/s */
};

/* Box of the gates of all hypotheses of a track, without the margin for a plot's sigma and time. */
struct rho_hypotheses_box {
    float x_min_m, x_max_m, y_min_m, y_max_m;
    float z_min_m, z_max_m; /* limits of z, for tracks with a height */
    /* largest speed and acceleration, with uncertainty; < 0 until a plot's own time needs them */
    float speed_max_mps, accel_max_mps2;
    float sigma_factor; /* factor of the plots' sigmas, as learned for their sensor */
};

/* A scan whose plots extend a track's hypotheses. */
struct rho_hypotheses_scan {
    int64_t time_us;
    uint32_t measures;
    const struct rho_plot *plots;
    const struct rho_sensor *sensor; /* sensor of the scan; NULL: one at the origin */
    /* ln(1 - pd), the weight of a miss; 0 where the sensor did not look */
    float log_miss;
    /* what a miss tells of the range rate: of a sensor blind at some, of rest; NULL: nothing */
    const struct rho_notch_look *look;
    /* claiming track of each row of plots, -1: none; own: this track. NULL: all are free */
    const int16_t *claims;
    int16_t own;
};

struct rho_hypotheses_outcome {
    int16_t row; /* row of the best hypothesis' plot; RHO_HYPOTHESES_MISS: none */
    /* ln of the scan's likelihood with the track's target, over that of clutter alone */
    float gain_nat;
};

struct rho_hypotheses_estimate {
    struct rho_kalman kalman; /* mean over all hypotheses and models, with their spread */
    float accel_mps2[3];
    float maneuver_probability;
};

/*
 * Initialises an empty pool; object_size: sizeof *pool; the model is copied. Errors: SIZE, CONFIG.
 * Cost: clears the object. Stack: 240 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_hypotheses_init(struct rho_hypotheses *pool, size_t object_size,
                                                   const struct rho_imm_model *model);

/*
 * Sets the motion model, except for calm_s, whose learned value is kept. Errors: CONFIG; nothing
 * is changed. Cost: one rho_imm_prepare_step. Stack: 300 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_hypotheses_set_model(struct rho_hypotheses *pool,
                                                        const struct rho_imm_model *model);

/*
 * Sets the model's calm_s, > 0, the mean time between manoeuvres of calm targets, if the model has
 * such targets. Cost: one rho_imm_prepare_step where calm_s changes. Stack: 160 bytes.
 */
void rho_hypotheses_set_calm_s(struct rho_hypotheses *pool, float calm_s);

/*
 * Opens a slot with one hypothesis that starts from an estimate. Errors: CAPACITY (all slots
 * taken, or the pool full, and no other track with a hypothesis to spare). Cost: RHO_MAX_TRACKS.
 * Stack: 170 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_hypotheses_open(struct rho_hypotheses *pool,
                                                   const struct rho_kalman *estimate,
                                                   int64_t time_us, uint16_t *slot);

/*
 * Adds a hypothesis with an estimate and a weight < 0, relative to the best one's, to an open slot.
 * It takes the place of the lightest one of a full slot, and none in a full pool. Stack: 170 bytes.
 */
void rho_hypotheses_add(struct rho_hypotheses *pool, uint16_t slot,
                        const struct rho_kalman *estimate, int64_t time_us, float weight_nat);

/* Frees a slot and its hypotheses; does nothing for a slot that is not open. */
void rho_hypotheses_close(struct rho_hypotheses *pool, uint16_t slot);

/* Number of hypotheses of a slot; 0 where the slot is not open. Constant cost. */
unsigned rho_hypotheses_count(const struct rho_hypotheses *pool, uint16_t slot);

/* One hypothesis of an open slot, the best at 0; NULL beyond. Constant cost. */
const struct rho_hypothesis *rho_hypotheses_at(const struct rho_hypotheses *pool, uint16_t slot,
                                               unsigned index);

/*
 * Moves all hypotheses of a slot to time_us. A hypothesis that cannot be moved is removed. Errors:
 * STATE (slot), VALUE (none is left: the slot is closed). Cost: rho_imm_predict each, and
 * rho_imm_prepare_step wherever the interval differs from the last one: once a scan, except for
 * hypotheses whose last plot had an own time. Stack: 490 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_hypotheses_predict(struct rho_hypotheses *pool, uint16_t slot,
                                                      int64_t time_us);

/* Adds a variance to the velocity in x and y, in both models of all hypotheses of a slot. */
void rho_hypotheses_loosen(struct rho_hypotheses *pool, uint16_t slot, float velocity_m2ps2);

/*
 * Moves all hypotheses of a slot to time_us without process noise and without transitions between
 * models: on to the time from which they had been moved back.
 * Errors: as rho_hypotheses_predict. Stack: 490 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_hypotheses_move(struct rho_hypotheses *pool, uint16_t slot,
                                                   int64_t time_us);

/* Begins a scan, and fills *box (may be NULL). Cost: 70 instructions a filter. Stack: 240 bytes. */
void rho_hypotheses_gate_box(struct rho_hypotheses *pool, uint16_t slot,
                             struct rho_hypotheses_box *box);

/*
 * True where a plot of a scan that measures `measures` may be in the gate of a hypothesis of the
 * slot. rho_hypotheses_gate_box must have filled *box since the slot's last prediction; the first
 * plot with an own time completes it. Constant cost otherwise. Stack: 170 bytes.
 */
int rho_hypotheses_is_in_box(const struct rho_hypotheses *pool, uint16_t slot,
                             struct rho_hypotheses_box *box, const struct rho_plot *plot,
                             uint32_t measures);

/*
 * Margin about *box for plots with sigmas of at most sigma_max_m and own times of at most
 * offset_max_s either way. Cost as rho_hypotheses_is_in_box, stack as above.
 */
float rho_hypotheses_box_margin_m(const struct rho_hypotheses *pool, uint16_t slot,
                                  struct rho_hypotheses_box *box, float sigma_max_m,
                                  float offset_max_s);

/*
 * Scores a plot with every hypothesis, at the plot's own time time_us; each hypothesis keeps its
 * RHO_HYPOTHESES_CHILDREN best plots as candidates, of equals the earlier ones. Returns 1 where the
 * plot is in the gate of any hypothesis; *best_weight_nat is then the weight of the best hypothesis
 * with the plot: ln of pd times the plot's density over the clutter's, plus the hypothesis' weight.
 * Cost: rho_imm_score_plot a hypothesis, and rho_imm_predict_unmixed for a plot
 * with an own time. Stack: 820 bytes.
 */
int rho_hypotheses_score_plot(struct rho_hypotheses *pool, uint16_t slot,
                              const struct rho_imm_plot *seen, int64_t time_us, int16_t row,
                              float log_pd, const struct rho_hypotheses_clutter *clutter,
                              float *best_weight_nat);

/* True where any plot of this scan is in the gate of any hypothesis of the slot. */
int rho_hypotheses_has_candidates(const struct rho_hypotheses *pool, uint16_t slot);

/*
 * Ends the scan: the heaviest children of all hypotheses replace their parents. Plots that
 * scan->claims gives to other tracks are left out. An update that is numerically impossible becomes
 * a miss (updates_refused). Errors: STATE (slot).
 * Cost: rho_imm_update for each of at most RHO_HYPOTHESES_OF_TRACK. Stack: 850 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_hypotheses_commit(struct rho_hypotheses *pool, uint16_t slot,
                                                     const struct rho_hypotheses_scan *scan,
                                                     struct rho_hypotheses_outcome *outcome);

/*
 * Updates all hypotheses with a plot that is known to be the target's, at its own time. Errors:
 * STATE (slot), and those of rho_imm_update where it fails for all hypotheses: these are then
 * predicted to the plot's time, or unchanged if that is too far back. Stack: 800 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_hypotheses_update(struct rho_hypotheses *pool, uint16_t slot,
                                                     const struct rho_imm_plot *seen,
                                                     int64_t time_us);

/*
 * Scores bearing i of a look with all hypotheses, moved to its time: returns 1 where it is in the
 * gate of one, and fills its density a radian, and the mean variance of what explains it. Weights
 * of the look are not read. Cost: 450 instructions a hypothesis, and rho_imm_predict_unmixed at
 * another time. Stack: 600 bytes.
 */
int rho_hypotheses_score_bearing(struct rho_hypotheses *pool, uint16_t slot,
                                 const struct rho_weighed_bearings *look, unsigned i,
                                 float *density, float *variance_rad2);

/*
 * Updates all hypotheses, moved to time_us, with a look's bearings of weights above 0, and their
 * weights by the likelihood of the look; those much lighter than the best are removed. Errors: as
 * rho_hypotheses_update. Stack: 900 bytes.
 */
RHO_MUST_CHECK enum rho_status
rho_hypotheses_update_bearings(struct rho_hypotheses *pool, uint16_t slot, int64_t time_us,
                               const struct rho_weighed_bearings *look);

/*
 * Fills *estimate with the mean over all hypotheses of a slot, moved to time_us. Errors:
 * STATE (slot), VALUE (no hypothesis can be moved to time_us); *estimate is unchanged. Cost: 450
 * instructions a hypothesis, without heights 300. Stack: 800 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_hypotheses_estimate(struct rho_hypotheses *pool, uint16_t slot,
                                                       int64_t time_us,
                                                       struct rho_hypotheses_estimate *estimate);

/*
 * True where a pool of unknown origin (a snapshot, memory that survived a reset) is safe to use:
 * counts and indices are consistent, and numbers within their limits. Called by rho_snapshot_load.
 * Cost: all nodes. Stack: 500 bytes.
 */
int rho_hypotheses_is_sound(const struct rho_hypotheses *pool);

RHO_END_C

#endif
