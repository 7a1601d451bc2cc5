/* SPDX-License-Identifier: MIT */
/*
 * track: one target's estimate, its evidence, and its life cycle.
 *
 *              start                confirm                 miss
 *      FREE ----------> TENTATIVE <---------> CONFIRMED <----------> COASTING
 *        ^                  | drop    doubt       | drop      update    | drop, or doubt
 *        +------------------+---------------------+---------------------+
 *
 * The evidence is a sequential log-likelihood ratio, target against clutter: a plot adds ln(pd /
 * density) plus the log density of its innovation, a miss adds ln(1 - pd), but only where the
 * sensor looked. A tentative track is confirmed when the score reaches the confirm threshold and
 * dropped when it falls below Wald's lower one. A score that falls from its highest says that the
 * target has gone: by more than the odds of a target's life in a scan, and a confirmed track is in
 * doubt, tentative again; by coast_scans_max misses, or after that many misses in a row, and it is
 * dropped (later where it may hide: tracker.h). Until then plots that it goes on with confirm it
 * again, with the same identity.
 *
 * Stack: 64 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_TRACK_H
#define RHOTRACK_TRACK_H

#include <stdint.h>

#include "rhotrack/detail/clutter_map.h"
#include "rhotrack/detail/gate.h"
#include "rhotrack/detail/hypotheses.h"
#include "rhotrack/detail/input.h"
#include "rhotrack/detail/kalman.h"
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

enum rho_track_status {
    RHO_TRACK_FREE = 0,  /* an empty slot */
    RHO_TRACK_TENTATIVE, /* started, not yet confirmed; or no longer */
    RHO_TRACK_CONFIRMED, /* believed to be of a target; updated at the last look */
    RHO_TRACK_COASTING,  /* confirmed; only predicted since its last plot */
    RHO_NUM_TRACK_STATUS
};

enum rho_track_event {
    RHO_TRACK_START = 0, /* initiation found it */
    RHO_TRACK_CONFIRM,   /* the score reached the confirm threshold, or recovered */
    RHO_TRACK_UPDATE,    /* a plot was claimed */
    RHO_TRACK_MISS,      /* the sensor looked there, and no plot was claimed */
    RHO_TRACK_DOUBT,     /* the score fell so far that the target is rather gone than missed */
    RHO_TRACK_DROP,      /* the score fell below the drop threshold, or too many misses in a row */
    RHO_NUM_TRACK_EVENTS
};

/* The filter of a track, from its start to its end. */
enum rho_track_filter {
    RHO_TRACK_KALMAN = 0, /* `kalman` alone: without the two others */
    RHO_TRACK_INPUT,      /* `input`: Kalman filter with input estimation */
    RHO_TRACK_HYPOTHESES, /* a slot of the pool */
    RHO_NUM_TRACK_FILTERS
};

/* True of filters that the library is built with. */
#define RHO_HAS_FILTER(filter) (((RHO_FILTERS) >> (filter)&1) != 0)

/* True of a track with that filter: known to the compiler where there is no such, or no other. */
#define RHO_TRACK_IS_BY(track, which)                                                              \
    ((RHO_FILTERS) == 1 << (which) || (RHO_HAS_FILTER(which) && (track)->filter == (which)))

struct rho_track {
    uint32_t track_id; /* 1, 2, ... in the order of starts; never used twice until 2^32 */
    uint8_t status;    /* enum rho_track_status */
    uint8_t misses_in_row;
    uint16_t hits, misses; /* since the start; saturate */
    int16_t plot;          /* row of the plot claimed in the newest scan; -1: none */
    int32_t sensor_id;     /* of the last claimed plot */
    int32_t score_mnat;
    int32_t score_max_mnat; /* highest since the start */
    int64_t time_us;        /* of the estimate: a scan's, or the last claimed plot's own */
    int64_t updated_us;     /* of the last claimed plot, its own */
    int64_t seen_us;        /* of the last step in which it claimed a plot or bearing */
    float seen_every_s;     /* time between such steps: the shorter ones; 0: not known yet */
    uint8_t filter;         /* enum rho_track_filter */
    /* input: bearings were taken since it was decided which inputs there are */
    uint8_t is_undecided;
    uint16_t slot; /* in the pool of hypotheses */
    /* the estimate; of hypotheses, since the last rho_track_merge_estimates, moved on roughly */
    struct rho_kalman kalman;
    float accel_mps2[3];        /* estimated; 0 of a plain Kalman filter */
    float maneuver_probability; /* of hypotheses; else 1 where an input is present, 0 where not */
    /*
     * velocity after the last update and the one before, and how many there were (saturates): the
     * Hough gate's
     */
    float newest_mps[3], before_mps[3];
    uint8_t num_velocities;
    uint8_t was_confirmed; /* has been confirmed */
    uint8_t fast_in_row; /* updates in a row with a speed beyond the fastest target's; saturates */
    /*
     * what its sensor is learned from: the last innovation, along the line of sight and across, in
     * sixteenths of its sigma; and bit 0: there is one; bit 1: sensor_id has missed it since it saw
     * it
     */
    int8_t shown[2];
    uint8_t has_shown;
    uint8_t is_shared; /* two sensors have seen it; 0 without RHO_SECTORS */
    /*
     * of the two sensors that saw it last, the newer first: the tracker's count of their scans then
     */
    int32_t look_sensor_id[2];
    uint16_t look[2];
    int64_t ahead_us; /* while a late scan is stepped: the time from which it was moved back */
    /*
     * by class of hits: how far echoes of the clutter map explained its plots, until the map has
     * been told that they are a target's
     */
    float returns[RHO_ECHO_HIT_CLASSES];
    uint8_t has_taken_back; /* the map has been told */
    uint8_t has_moved;      /* the track was surely elsewhere than where it started */
    /* scratch of a step: share of looks of its sensor that are blind to the track (notch.h) */
    uint8_t blind_percent;
    uint8_t is_frozen; /* by an operator: it coasts, and does not end */
    float start_m[2], start_sigma_m;
    /* its second plots: scans in which it had a plot, and others near it; both fade */
    float second_looks, second_plots;
    /*
     * an older track that it started beside, 0: none; ln of how much likelier both are one target
     * than two
     */
    uint32_t older_id;
    float one_target_nat;
    float second_share; /* scratch of a step: how far the track has all its second plots itself */
    struct rho_input input;
};

/* Thresholds that a track's evidence is held against. */
struct rho_track_limits {
    int32_t confirm_mnat;   /* confirmed at or above */
    int32_t tentative_mnat; /* a track below that never was confirmed is dropped */
    int32_t doubt_mnat;     /* one so far below its highest score is tentative; 0: any is */
    int32_t fall_mnat; /* one that was confirmed, so far below its highest score, is dropped; > 0 */
    uint8_t misses_in_row_max; /* the track ends at so many misses in a row */
};

/*
 * The life cycle above as a pure function; an event that a status does not know changes nothing.
 * Constant cost.
 */
enum rho_track_status rho_track_next_status(enum rho_track_status status,
                                            enum rho_track_event event);

/*
 * How targets may move, and the filter that follows them. Objects pointed to stay the caller's.
 */
struct rho_track_model {
    float speed_sigma_mps; /* of the velocity on an axis that was measured once */
    /* white acceleration of a plain Kalman filter, m^2/s^3 (rho_kalman_predict) */
    float noise_density;
    /*
     * tracks are started with hypotheses where there is a pool, else with input estimation where it
     * is configured
     */
    struct rho_hypotheses *hypotheses;
    const struct rho_input_config *input;
};

/* A plot, when it was seen, and by whom. */
struct rho_track_plot {
    int64_t time_us;   /* its own */
    uint32_t measures; /* RHO_MEASURES_... */
    int32_t sensor_id;
    const struct rho_sensor *sensor; /* NULL: at the origin */
    struct rho_plot plot;            /* offset_us is ignored */
    int16_t row;                     /* in its scan */
};

/*
 * Makes *track a TENTATIVE track with identity track_id from its num_plots >= 1 plots: the first
 * opens the filter, the others predict and update it in the order of the array; the newest scan's
 * plot comes last. The estimate's time is that plot's own. Plots of several sensors may be a little
 * out of order in time: going back adds no noise.
 * Errors: NULL, VALUE (num_plots, numbers), SINGULAR, CAPACITY (the pool of hypotheses), CONFIG
 * (the filter that the model asks for is none of RHO_FILTERS); *track is unchanged. Cost: num_plots
 * filter steps. Stack: 1.9 KB.
 */
RHO_MUST_CHECK enum rho_status
rho_track_start(struct rho_track *track, uint32_t track_id, const struct rho_track_plot *plots,
                unsigned num_plots, const struct rho_track_model *model, int32_t score_mnat);

/* Frees the track's hypotheses, before the track is forgotten. */
void rho_track_end(struct rho_track *track, const struct rho_track_model *model);

/*
 * Predicts to time_us. Where that is before the estimate's (a plot of another sensor was later
 * within its scan), it goes back without noise. Errors: NULL, VALUE (a covariance beyond its
 * limit); unchanged, but one of hypotheses may have lost them all: end it. Stack: 550 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_track_predict(struct rho_track *track, int64_t time_us,
                                                 const struct rho_track_model *model);

/*
 * Moves a track on to time_us without noise: back to where it had been before it was moved back,
 * with what it has learned there.
 * Errors and costs as rho_track_predict. Stack: 570 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_track_return(struct rho_track *track, int64_t time_us,
                                                const struct rho_track_model *model);

/*
 * Updates with a plot: predicts to its own time, and takes its position, velocity and range rate,
 * as far as measured, by scalar updates; a first z opens the third axis. The estimate stays at the
 * plot's time. gain_mnat is added to the score.
 * Errors: NULL, VALUE, SINGULAR: the track is unchanged; but hypotheses have moved to the plot's
 * time, or are lost where that was refused. Cost: a prediction where the plot has an own time, and
 * 2 to 7 scalar updates. Stack: 1.4 KB.
 */
RHO_MUST_CHECK enum rho_status rho_track_update(struct rho_track *track,
                                                const struct rho_track_plot *plot,
                                                const struct rho_track_model *model,
                                                int32_t gain_mnat);

/*
 * A track with hypotheses ends a scan whose plots it has scored (rho_hypotheses_commit): its best
 * hypothesis' plot is claimed, if it has one, and the score changes by the likelihood of all. Then,
 * or where the plot is refused, `plot` is -1.
 * Errors: NULL, STATE (another filter). Stack: 880 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_track_commit(struct rho_track *track,
                                                const struct rho_hypotheses_scan *scan,
                                                int32_t sensor_id,
                                                const struct rho_track_model *model);

/*
 * At the end of a step: `kalman`, acceleration and manoeuvre as all hypotheses have them, at
 * time_us. With input estimation, the inputs are decided on by all of the step's bearings. Else
 * nothing. Stack: 890 bytes.
 */
void rho_track_merge_estimates(struct rho_track *track, int64_t time_us,
                               const struct rho_track_model *model);

/* The prediction as a gate has to see it: an input may have begun since. Stack: 140 bytes. */
void rho_track_expect(const struct rho_track *track, struct rho_kalman *expected);

/* A bearing, when it was seen, and from where. */
struct rho_track_bearing {
    int64_t time_us; /* its own */
    int32_t sensor_id;
    float x_m, y_m; /* the sensor's place */
    float bearing_rad, sigma_rad;
    int16_t row; /* in its scan */
};

/*
 * Makes *track a TENTATIVE track with identity track_id from an estimate at time_us that hits scans
 * have made, with the filter that the model asks for; sensor_id is one of those that saw it.
 * Errors: NULL, CONFIG (the filter is none of RHO_FILTERS), CAPACITY (the pool of hypotheses),
 * VALUE (x or y not open, no hits); *track is unchanged. Constant cost. Stack: 1.5 KB.
 */
RHO_MUST_CHECK enum rho_status
rho_track_start_estimate(struct rho_track *track, uint32_t track_id,
                         const struct rho_kalman *estimate, int64_t time_us, int32_t sensor_id,
                         uint16_t hits, const struct rho_track_model *model, int32_t score_mnat);

/*
 * Updates with a bearing: predicts to its own time, and takes it by a scalar update. Bearings of
 * several sensors in one step count as one hit: the first, while plot is -1. gain_mnat is added to
 * the score. Inputs are decided on by rho_track_merge_estimates.
 * Errors: NULL, VALUE, SINGULAR: the track is unchanged, but for the time of its hypotheses.
 * Cost: two predictions and an update. Stack: 1.2 KB.
 */
RHO_MUST_CHECK enum rho_status rho_track_update_bearing(struct rho_track *track,
                                                        const struct rho_track_bearing *bearing,
                                                        const struct rho_track_model *model,
                                                        int32_t gain_mnat);

/* Takes loss_mnat >= 0 from the score, for a sensor that looked and saw nothing. Constant cost. */
void rho_track_lower_score(struct rho_track *track, int32_t loss_mnat);

/*
 * Counts a scan that looked and saw nothing; loss_mnat >= 0 is taken from the score. Constant cost.
 */
void rho_track_miss(struct rho_track *track, int32_t loss_mnat);

/*
 * Applies the limits to the evidence: confirm, make tentative, confirm again, and drop.
 * Returns the status, RHO_TRACK_FREE where it ended. Constant cost.
 */
enum rho_track_status rho_track_apply_thresholds(struct rho_track *track,
                                                 const struct rho_track_limits *limits);

#ifdef __cplusplus
}
#endif

#endif
