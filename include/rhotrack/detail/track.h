/* SPDX-License-Identifier: MIT */
/*
 * track: state estimate, score and life cycle of one track.
 *
 *              start                confirm                 miss
 *      FREE ----------> TENTATIVE <---------> CONFIRMED <----------> COASTING
 *        ^                  | drop    doubt       | drop      update    | drop, or doubt
 *        +------------------+---------------------+---------------------+
 *
 * The track score is a sequential log-likelihood ratio, target against clutter: a plot adds ln(pd /
 * density) plus the log density of its innovation, a miss adds ln(1 - pd), but only where the
 * sensor looked. A tentative track is confirmed when the score reaches the confirm threshold and
 * dropped when it falls below Wald's lower one. From then on the probability that its target still
 * exists decides (tracker.h): it is in doubt, and tentative again, where that is low, and dropped
 * where there is hardly any left. Until then plots confirm it again, with the same identity.
 *
 * Stack: 64 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_TRACK_H
#define RHOTRACK_TRACK_H

#include <stdint.h>

#include "rhotrack/detail/gate.h"
#include "rhotrack/detail/hypotheses.h"
#include "rhotrack/detail/input_estimation.h"
#include "rhotrack/detail/kalman.h"
#include "rhotrack/detail/recurring_clutter_map.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

enum rho_track_status {
    RHO_TRACK_FREE = 0,  /* an empty slot */
    RHO_TRACK_TENTATIVE, /* started and not yet confirmed; or in doubt after it was confirmed */
    RHO_TRACK_CONFIRMED, /* believed to be of a target; updated at the last look */
    RHO_TRACK_COASTING,  /* confirmed; only predicted since its last plot */
    RHO_NUM_TRACK_STATUS
};

enum rho_track_event {
    RHO_TRACK_START = 0, /* initiation found the track */
    RHO_TRACK_CONFIRM,   /* the score reached the confirm threshold, or the target surely exists */
    RHO_TRACK_UPDATE,    /* a plot was claimed */
    RHO_TRACK_MISS,      /* the sensor looked there, and no plot was claimed */
    RHO_TRACK_DOUBT,     /* the target has probably gone, or its place is not known */
    RHO_TRACK_DROP,      /* the target has surely gone, or was none */
    RHO_NUM_TRACK_EVENTS
};

/* The filter of a track, from its start to its end. */
enum rho_track_filter {
    RHO_TRACK_KALMAN = 0, /* a plain Kalman filter, in the field `kalman` */
    RHO_TRACK_INPUT,      /* a Kalman filter with input estimation, in the field `input` */
    RHO_TRACK_HYPOTHESES, /* hypotheses over two motion models, in a slot of the pool */
    RHO_NUM_TRACK_FILTERS
};

/* True of filters that the library is built with. */
#define RHO_HAS_FILTER(filter) (((RHO_FILTERS) >> (filter)&1) != 0)

/* True of a track with this filter; constant where the build has no such filter, or no other. */
#define RHO_TRACK_IS_BY(track, which)                                                              \
    ((RHO_FILTERS) == 1 << (which) || (RHO_HAS_FILTER(which) && (track)->filter == (which)))

struct rho_track {
    uint32_t track_id; /* 1, 2, ... in the order of starts; never used twice until 2^32 */
    uint8_t status;    /* enum rho_track_status */
    uint8_t misses_in_row;
    uint16_t hits, misses; /* since the start; saturate */
    int16_t plot;          /* row of the plot claimed in the newest scan; -1: none */
    int32_t sensor_id;     /* sensor of the last claimed plot */
    int32_t score_mnat;
    int32_t score_max_mnat; /* highest since the start */
    /* probabilities that its target exists and is visible, or exists and is hidden, at lived_us */
    float visible, hidden;
    int64_t lived_us;
    float look_nat;     /* of the looks since then: ln likelihood of a visible target over none */
    float seen_nat;     /* ln evidence of its hits that it is seen as targets are, and not seldom */
    float missed;       /* number of misses, hidden targets' less, that speak against it */
    float seen_share;   /* of targets like it the next look can see: not hidden, not blind */
    float appeared;     /* within a step: share of `visible` that was hidden before */
    float unseen;       /* looks at it since its last hit that were counted for P_D of its place */
    int64_t time_us;    /* time of the estimate: of a scan, or of the last claimed plot */
    int64_t updated_us; /* time of the last claimed plot */
    int64_t seen_us;    /* time of the last step in which it claimed a plot or bearing */
    float seen_every_s; /* smoothed time between such steps, long ones count less; 0: unknown */
    uint8_t filter;     /* enum rho_track_filter */
    /* input estimation: bearings have come since the presence of inputs was last decided */
    uint8_t is_undecided;
    uint16_t slot; /* slot in the pool of hypotheses */
    /* the estimate; of hypotheses the last merged one, since then predicted without noise */
    struct rho_kalman kalman;
    float accel_mps2[3]; /* estimate; 0 with a plain Kalman filter */
    /* of hypotheses: of the manoeuvring model; else 1 where an input is present, 0 where not */
    float maneuver_probability;
    /* Hough gate: velocities after the last two updates, and the number of updates (saturates) */
    float newest_mps[3], before_mps[3];
    uint8_t num_velocities;
    uint8_t was_confirmed; /* the track has been confirmed at least once */
    uint8_t fast_in_row;   /* updates in a row with a speed above v_max_mps; saturates */
    /*
     * for sensor learning: last innovation along the line of sight and across it, in sixteenths of
     * its sigma; has_shown bit 0: there is one; bit 1: sensor_id has missed the track since its
     * last hit
     */
    int8_t shown[2];
    uint8_t has_shown;
    uint8_t is_shared; /* two sensors have seen the track; 0 without RHO_SECTORS */
    /* the two sensors that saw the track last, the newer first, and their scan counts then */
    int32_t look_sensor_id[2];
    uint16_t look[2];
    int64_t ahead_us; /* time of the track before an out-of-sequence scan moved it back */
    /*
     * by class of hits: sum of the probabilities that the track's plots were returns of echoes in
     * the clutter map; subtracted from the map once the track is known to be of a target
     */
    float returns[RHO_ECHO_HIT_CLASSES];
    unsigned has_taken_back : 1; /* the returns were subtracted from the map */
    unsigned is_seldom : 1;      /* it was found to be seldom seen, and counted so */
    unsigned has_new_plot : 1;   /* no bearing has come since its last plot */
    unsigned has_moved : 1;      /* the track has surely left its start place */
    /* an operator started it: of a target, though it never moved; echoes there are no clutter */
    unsigned is_operators : 1;
    /* within a step: share of looks that are blind to the track (doppler_notch.h), per cent */
    uint8_t blind_percent;
    uint8_t is_frozen; /* an operator has frozen the track: it coasts, and does not end */
    float start_m[2], start_sigma_m;
    float rest_miss; /* share of looks that missed it while it rested, of the last ones mostly */
    float plot_m[2], plot_sigma_m; /* last claimed plot; sigma 0: none yet */
    /* scans with a plot of the track, and second plots near these; both are halved now and then */
    float second_looks, second_plots;
    /* older track that this one started beside, 0: none; ln of the odds that both are one target */
    uint32_t older_id;
    float one_target_nat;
    /* within a step: least probability that a younger track beside it is of its target; 1: none */
    float second_share;
    struct rho_input input;
};

/* Probability that the track's target exists, visible or hidden; despite rounding at most 1. */
static inline float rho_track_existence(const struct rho_track *track)
{
    return track->visible + track->hidden < 1.0f ? track->visible + track->hidden : 1.0f;
}

/* Status that follows by the diagram; an event without an arrow changes nothing. Constant cost. */
enum rho_track_status rho_track_next_status(enum rho_track_status status,
                                            enum rho_track_event event);
void rho_track_apply_event(struct rho_track *track, enum rho_track_event event);

/* Motion model of targets, and the filter of new tracks. Objects pointed to stay the caller's. */
struct rho_track_model {
    float speed_sigma_mps; /* sigma of the velocity on an axis with one measured position */
    /* density of white acceleration in a plain Kalman filter, m^2/s^3 (rho_kalman_predict) */
    float noise_density;
    /* new tracks have hypotheses where there is a pool, else input estimation where configured */
    struct rho_hypotheses *hypotheses;
    const struct rho_input_config *input;
};

/* A plot with its time, sensor and row. */
struct rho_track_plot {
    int64_t time_us;   /* the plot's own time */
    uint32_t measures; /* RHO_MEASURES_... */
    int32_t sensor_id;
    const struct rho_sensor *sensor; /* NULL: at the origin */
    struct rho_plot plot;            /* offset_us is ignored */
    int16_t row;                     /* row of the plot in its scan */
};

/*
 * Makes *track a TENTATIVE track with identity track_id from num_plots >= 1 plots: the first one
 * starts the filter, the others predict and update it in the order of the array. The plot of the
 * newest scan is the last one, and the estimate has its time. Plots of several sensors may be a
 * little out of order in time: a prediction back in time adds no noise.
 * Errors: NULL, VALUE (num_plots, numbers), SINGULAR, CAPACITY (the pool of hypotheses), CONFIG
 * (the filter that the model asks for is none of RHO_FILTERS); *track is unchanged. Cost: num_plots
 * filter steps. Stack: 2 KB.
 */
RHO_MUST_CHECK enum rho_status
rho_track_start(struct rho_track *track, uint32_t track_id, const struct rho_track_plot *plots,
                unsigned num_plots, const struct rho_track_model *model, int32_t score_mnat);

/* Adds a variance to a track's velocity in x and y: its target may have turned. Constant cost. */
void rho_track_loosen(struct rho_track *track, const struct rho_track_model *model,
                      float velocity_m2ps2);

/* Frees the track's hypotheses, before the track is removed. */
void rho_track_free_hypotheses(struct rho_track *track, const struct rho_track_model *model);

/*
 * Predicts a track to time_us; without process noise where that is before the estimate's time, as
 * after a plot late in the scan of another sensor. Errors: NULL, VALUE (a covariance beyond its
 * limit): the track is unchanged, but may have lost all its hypotheses, and must be ended then.
 * Stack: 550 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_track_predict(struct rho_track *track, int64_t time_us,
                                                 const struct rho_track_model *model);

/*
 * Moves a track, which an out-of-sequence scan moved back and updated, forward to its former time
 * time_us without process noise. Errors and costs as rho_track_predict. Stack: 580 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_track_return(struct rho_track *track, int64_t time_us,
                                                const struct rho_track_model *model);

/*
 * Updates a track with a plot: predicts to the plot's time, and updates with its position, velocity
 * and range rate, as far as measured, by scalar updates; a first z opens the third axis. The
 * estimate stays at the plot's time. gain_mnat is added to the score, and the hit is counted.
 * Errors: NULL, VALUE, SINGULAR: the track is unchanged; but hypotheses have moved to the plot's
 * time, or are lost where that was refused. Cost: a prediction where the plot has its own time, and
 * 2 to 7 scalar updates. Stack: 1.4 KB.
 */
RHO_MUST_CHECK enum rho_status rho_track_update_by_plot(struct rho_track *track,
                                                        const struct rho_track_plot *plot,
                                                        const struct rho_track_model *model,
                                                        int32_t gain_mnat);

/*
 * Ends a scan for a track with hypotheses whose plots were scored (rho_hypotheses_commit): the plot
 * of the best hypothesis is claimed, and the score changes by the likelihood of all hypotheses.
 * `plot` is -1 where the best hypothesis has no plot, or its plot is refused.
 * Errors: NULL, STATE (another filter). Stack: 880 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_track_commit_scan(struct rho_track *track,
                                                     const struct rho_hypotheses_scan *scan,
                                                     int32_t sensor_id,
                                                     const struct rho_track_model *model);

/*
 * At the end of a step: merges the hypotheses into `kalman`, acceleration and manoeuvre
 * probability, at time_us. With input estimation, decides which inputs are present after the step's
 * bearings. A plain Kalman filter is not changed. Stack: 890 bytes.
 */
void rho_track_merge_estimates(struct rho_track *track, int64_t time_us,
                               const struct rho_track_model *model);

/* The prediction for a gate, widened as an input may have begun since. Stack: 140 bytes. */
void rho_track_estimate_for_gate(const struct rho_track *track, struct rho_kalman *expected);

/* White acceleration, m^2/s^3, between an estimate for a gate and an own time. Constant cost. */
float rho_track_noise_density(const struct rho_track *track, const struct rho_track_model *model);

/*
 * Scores bearing i of a look by all models and hypotheses of a track, as plots are, or by its one
 * filter: returns 1 where it is in the gate, and fills its density, and the mean variance of what
 * explains it. Weights of the look are not read. Stack: 870 bytes.
 */
int rho_track_score_bearing(const struct rho_track *track, const struct rho_track_model *model,
                            const struct rho_weighed_bearings *look, unsigned i, float *density,
                            float *variance_rad2);

/*
 * Makes *track a TENTATIVE track with identity track_id from an estimate at time_us by `hits`
 * scans, with the filter that the model asks for; sensor_id is one of the sensors of these scans.
 * Errors: NULL, CONFIG (the filter is none of RHO_FILTERS), CAPACITY (the pool of hypotheses),
 * VALUE (x or y not open, no hits); *track is unchanged. Constant cost. Stack: 1.5 KB.
 */
RHO_MUST_CHECK enum rho_status
rho_track_start_estimate(struct rho_track *track, uint32_t track_id,
                         const struct rho_kalman *estimate, int64_t time_us, int32_t sensor_id,
                         uint16_t hits, const struct rho_track_model *model, int32_t score_mnat);

/*
 * Updates a track with the bearings of a look of weights above 0, by their mix: predicts to the
 * time of the one in `row`, and updates by a scalar update. The track claims that one if
 * is_claimed. Bearings of several sensors in one step count as one hit: the first one, while plot
 * is -1. gain_mnat is added to the score. rho_track_merge_estimates decides which inputs are
 * present. Errors: NULL, VALUE, SINGULAR: the track is unchanged, but for the time of its
 * hypotheses. Cost: two predictions and an update, and a prediction a bearing. Stack: 1.5 KB.
 */
RHO_MUST_CHECK enum rho_status rho_track_update_bearings(struct rho_track *track,
                                                         const struct rho_weighed_bearings *look,
                                                         int16_t row, int is_claimed,
                                                         const struct rho_track_model *model,
                                                         int32_t gain_mnat);

/* Keeps a claimed plot's place, for bearings to be compared with it. Constant cost. */
void rho_track_keep_plot(struct rho_track *track, const struct rho_plot *plot);

/* Adds evidence of either sign to the score, without counting a hit or miss. Constant cost. */
void rho_track_add_score(struct rho_track *track, int32_t gain_mnat);

/* Counts a miss: subtracts loss_mnat >= 0 from the score; confirmed tracks coast. Constant cost. */
void rho_track_count_miss(struct rho_track *track, int32_t loss_mnat);

RHO_END_C

#endif
