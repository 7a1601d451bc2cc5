/* SPDX-License-Identifier: MIT */
/*
 * hypotheses: keeps open for a few scans which plots were a track's (multiple-hypothesis tracking
 * of one track).
 *
 * A hypothesis is one history of assignments: an imm filter that took those plots, and a weight, ln
 * of the likelihood that they were the target's and all others clutter. At each scan every
 * hypothesis has children: one for each of its best plots, and one for a miss. The heaviest go on;
 * of those with the same assignments in the last RHO_HYPOTHESES_MEMORY scans only one. So a clutter
 * plot that was taken for the target's is undone when the next plots do not follow it.
 *
 *     scan n            n+1              A steady track in thin clutter has one hypothesis, one that
 *     h1 ---- plot 3 ---- plot 1   w  0  meets clutter while it turns RHO_HYPOTHESES_OF_TRACK.
 *       \---- miss ------ plot 1   w -4  All tracks share one pool. Where it is empty, the tracks
 *        \--- plot 7 ---- miss     w -9  with the most hypotheses lose the least likely ones, and
 *                                        a counter moves.
 *
 * Tracks have slots in the pool. One scan is: rho_hypotheses_predict, rho_hypotheses_begin_scan,
 * rho_hypotheses_score_plot for each plot near the track, rho_hypotheses_commit. Between the last
 * two the caller may assign plots to other tracks.
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
#include "rhotrack/detail/imm.h"
#include "rhotrack/detail/kalman.h"
#include "rhotrack/detail/notch.h"
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

#define RHO_HYPOTHESES_SLOTS                                                                       \
    (RHO_MAX_TRACKS + 1) /* one more, for a track that is yet to get its place */
#define RHO_HYPOTHESES_OF_TRACK 8
#define RHO_HYPOTHESES_CHILDREN 3          /* plots of a scan that one hypothesis goes on with */
#define RHO_HYPOTHESES_MEMORY 3            /* scans in which two hypotheses must differ */
#define RHO_HYPOTHESES_WEIGHT_MIN (-20.0f) /* beside the best one; less is given up */
#define RHO_HYPOTHESES_MISS (-1)

/* A plot of the scan, for one hypothesis. */
struct rho_hypotheses_candidate {
    float gain_nat;
    float probability; /* of a manoeuvre, if it is the target's */
    int16_t row;
};

struct rho_hypothesis {
    struct rho_imm imm;
    int64_t time_us;                      /* of the filter: a scan's, or the last plot's own */
    float weight_nat;                     /* 0: the best of its track */
    float share;                          /* e^weight */
    int16_t picks[RHO_HYPOTHESES_MEMORY]; /* rows of the last scans' plots, the newest last */
    struct rho_hypotheses_candidate candidates[RHO_HYPOTHESES_CHILDREN]; /* the best one first */
    uint8_t num_candidates;
};

struct rho_hypotheses_child {
    float weight_nat;
    int16_t row;
    uint8_t parent, candidate;
};

/* The pool. */
struct rho_hypotheses {
    uint32_t magic;
    /* numerically impossible: the hypothesis took a miss instead; saturates */
    uint32_t updates_refused;
    uint32_t hypotheses_cut; /* given up for want of room; saturates */
    uint16_t num_free;
    struct rho_imm_model model;
    struct rho_imm_step step;             /* of the last interval: most tracks have the same one */
    uint8_t num_of[RHO_HYPOTHESES_SLOTS]; /* hypotheses of a slot; 0: free */
    uint16_t node_of[RHO_HYPOTHESES_SLOTS][RHO_HYPOTHESES_OF_TRACK]; /* the best first */
    uint16_t spare[RHO_MAX_HYPOTHESES];
    struct rho_hypotheses_child children[RHO_HYPOTHESES_OF_TRACK]; /* of a scan: the best first */
    struct rho_imm scratch;
    /*
     * of the slot that is looked at: for plots of this isotropic noise; or for those with range
     * rates
     */
    union {
        struct rho_imm_gate gates[RHO_HYPOTHESES_OF_TRACK];
        struct rho_imm_rates rates[RHO_HYPOTHESES_OF_TRACK];
    } opened;
    float gate_variance_m2; /* 0: rates */
    uint16_t gate_slot;
    uint8_t gate_has_z, gate_is_usable;
    struct rho_hypothesis nodes[RHO_MAX_HYPOTHESES];
};

/* How dense clutter is, in each of the dimensions that may count: ln. */
struct rho_hypotheses_clutter {
    float log_per_m2;         /* of the plane */
    float log_per_m;          /* of height */
    float log_per_mps;        /* of each velocity */
    float log_per_range_rate; /* m/s */
};

/* Plots outside of the box need not be scored. It grows with a plot's sigma and own time. */
struct rho_hypotheses_box {
    float x_min_m, x_max_m, y_min_m, y_max_m;
    float z_min_m, z_max_m; /* of tracks with a height */
    /*
     * of all hypotheses, with their uncertainty; below 0 until a plot with a time of its own asks
     * for them
     */
    float speed_max_mps, accel_max_mps2;
    float sigma_factor; /* of the plots' sigmas, as learned of their sensor */
};

/* A scan that a track commits itself to. */
struct rho_hypotheses_scan {
    int64_t time_us;
    uint32_t measures;
    const struct rho_plot *plots;
    const struct rho_sensor *sensor; /* NULL: at the origin */
    float log_miss;                  /* ln(1 - pd); 0 where the sensor did not look */
    /* where it looked, and is blind at some range rates; NULL: at none */
    const struct rho_notch_look *look;
    /*
     * plots of others: row of plots to track, or -1 for no track's; own is this track. NULL: all
     * are free
     */
    const int16_t *claims;
    int16_t own;
};

struct rho_hypotheses_outcome {
    int16_t row;    /* of the best hypothesis' plot; RHO_HYPOTHESES_MISS: none */
    float gain_nat; /* ln of the scan's likelihood with this track's target, over clutter alone */
};

struct rho_hypotheses_estimate {
    struct rho_kalman kalman; /* mean over all hypotheses and models, with their spread */
    float accel_mps2[3];
    float maneuver_probability;
};

/* Prepares an empty pool; the model is copied. Errors: NULL, SIZE, CONFIG. Cost: clears the object.
 * Stack: 240 bytes. */
RHO_MUST_CHECK enum rho_status rho_hypotheses_init(struct rho_hypotheses *pool, size_t size,
                                                   const struct rho_imm_model *model);

/* From now on this model, but for calm_s, which stays as it was learned. Errors: NULL, CONFIG;
 * nothing is changed. Cost: one rho_imm_step_open. Stack: 300 bytes. */
RHO_MUST_CHECK enum rho_status rho_hypotheses_set_model(struct rho_hypotheses *pool,
                                                        const struct rho_imm_model *model);

/* From now on the model's calm_s, > 0, where it has calm targets. Cost: one rho_imm_step_open where
 * it is another one. Stack: 160 bytes. */
void rho_hypotheses_set_calm(struct rho_hypotheses *pool, float calm_s);

/*
 * Opens a slot with one hypothesis that starts from an estimate. Errors: NULL, STATE, CAPACITY (all
 * slots taken, or no hypothesis that another track could give up). Cost: RHO_MAX_TRACKS.
 * Stack: 150 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_hypotheses_open(struct rho_hypotheses *pool,
                                                   const struct rho_kalman *estimate,
                                                   int64_t time_us, uint16_t *slot);

/* Gives a slot and its hypotheses back; one that is not open is left alone. */
void rho_hypotheses_close(struct rho_hypotheses *pool, uint16_t slot);

/* Hypotheses of a slot; 0 where it is not open. Constant cost. */
unsigned rho_hypotheses_count(const struct rho_hypotheses *pool, uint16_t slot);

/* One hypothesis of an open slot, the best at 0; NULL beyond. Constant cost. */
const struct rho_hypothesis *rho_hypotheses_at(const struct rho_hypotheses *pool, uint16_t slot,
                                               unsigned index);

/*
 * Moves all hypotheses of a slot to time_us. One that cannot be moved on is given up. Errors: NULL,
 * STATE (slot), VALUE (none is left: the slot is closed). Cost: rho_imm_predict each, and
 * rho_imm_step_open wherever the interval is another than the last one asked for: once a scan, but
 * for hypotheses that took a plot at its own time. Stack: 490 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_hypotheses_predict(struct rho_hypotheses *pool, uint16_t slot,
                                                      int64_t time_us);

/*
 * The same without noise, and without change: on to where they had been before they were moved
 * back.
 * Errors as above. Stack: 490 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_hypotheses_return(struct rho_hypotheses *pool, uint16_t slot,
                                                     int64_t time_us);

/*
 * Begins a scan: no plot has been scored. *box (may be NULL) is filled. Cost: 70 instructions a
 * hypothesis and model.
 * Stack: 240 bytes.
 */
void rho_hypotheses_begin_scan(struct rho_hypotheses *pool, uint16_t slot,
                               struct rho_hypotheses_box *box);

/*
 * True where a plot of a scan that measures `measures` may be in the gate of a hypothesis of the
 * slot, whose box rho_hypotheses_begin_scan has filled since its last prediction; *box takes more
 * in for the first plot with a time of its own.
 * Constant cost but for that. Stack: 170 bytes.
 */
int rho_hypotheses_is_in_box(const struct rho_hypotheses *pool, uint16_t slot,
                             struct rho_hypotheses_box *box, const struct rho_plot *plot,
                             uint32_t measures);

/*
 * How far beyond *box plots may be whose noise is sigma_m at most, and their own times offset_s
 * either way. The same cost, stack as above.
 */
float rho_hypotheses_box_margin_m(const struct rho_hypotheses *pool, uint16_t slot,
                                  struct rho_hypotheses_box *box, float sigma_m, float offset_s);

/*
 * Scores a plot of time_us, its own, with every hypothesis; each keeps its RHO_HYPOTHESES_CHILDREN
 * best, of equals those that came first. Returns 1 where the plot is in the gate of any, and then
 * in *gain_nat the weight of the best hypothesis with the plot: ln of pd times the plot's density
 * over the clutter's, plus that hypothesis' weight. Cost: rho_imm_score_plot a hypothesis, and
 * rho_imm_predict_unmixed for a plot with an own time. Stack: 820 bytes.
 */
int rho_hypotheses_score_plot(struct rho_hypotheses *pool, uint16_t slot,
                              const struct rho_imm_plot *seen, int64_t time_us, int16_t row,
                              float log_pd, const struct rho_hypotheses_clutter *clutter,
                              float *gain_nat);

/* True where any plot of this scan is in the gate. */
int rho_hypotheses_has_candidates(const struct rho_hypotheses *pool, uint16_t slot);

/*
 * Ends the scan: the heaviest children of all hypotheses go on. Plots that scan->claims gives to
 * other tracks are left out. An update that is refused becomes a miss (updates_refused). Errors:
 * NULL, STATE (slot).
 * Cost: rho_imm_update for each of at most RHO_HYPOTHESES_OF_TRACK. Stack: 850 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_hypotheses_commit(struct rho_hypotheses *pool, uint16_t slot,
                                                     const struct rho_hypotheses_scan *scan,
                                                     struct rho_hypotheses_outcome *outcome);

/*
 * All hypotheses take a plot that is known to be the target's, at its own time. Errors: NULL, STATE
 * (slot), and those of rho_imm_update where no hypothesis could take it: then they are as they were
 * predicted to its time, or where they were if that is too far back. Stack: 800 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_hypotheses_update(struct rho_hypotheses *pool, uint16_t slot,
                                                     const struct rho_imm_plot *seen,
                                                     int64_t time_us);

/*
 * The same with a bearing from a place: hypotheses' weights change by its likelihood, and those
 * much lighter than the best are removed. Stack: 800 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_hypotheses_update_bearing(struct rho_hypotheses *pool,
                                                             uint16_t slot, int64_t time_us,
                                                             float x_m, float y_m,
                                                             float bearing_rad, float sigma_rad);

/*
 * The mean over all hypotheses, moved to time_us. Errors: NULL, STATE (slot), VALUE (none can be
 * moved there); *estimate is unchanged. Cost: 450 instructions a hypothesis, without heights 300.
 * Stack: 800 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_hypotheses_estimate(struct rho_hypotheses *pool, uint16_t slot,
                                                       int64_t time_us,
                                                       struct rho_hypotheses_estimate *estimate);

/*
 * True where the object may be worked with, wherever its bytes come from (a snapshot, memory that
 * outlived a reset): counts and places are within what they count, numbers within their limits.
 * rho_snapshot_load asks it. Cost: all nodes. Stack: 500 bytes.
 */
int rho_hypotheses_is_sound(const struct rho_hypotheses *pool);

#ifdef __cplusplus
}
#endif

#endif
