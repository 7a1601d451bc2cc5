/* SPDX-License-Identifier: MIT */
/*
 * imm: an interacting multiple model filter with two models: nearly constant velocity, and a
 * manoeuvre whose acceleration decays exponentially (Singer).
 *
 * `steady` is a Kalman filter [x y z vx vy vz] with little white acceleration. The manoeuvring
 * model has the accelerations too, [x y z vx vy vz ax ay az], which decay with memory_s and are
 * driven by white noise. The transitions between the models are a Markov chain in continuous time,
 * so that any interval is allowed: a prediction mixes the two estimates by the transition
 * probabilities, and an update changes the models' probabilities by their likelihoods of the plot.
 *
 * Some targets keep straight for minutes, some for seconds, so the chain has three states: a steady
 * target is calm or agile, and both share the steady filter. An agile target that stays steady
 * becomes calm (settle_s). The mean time between manoeuvres of a calm target (calm_s) is longer
 * than that of an agile one (steady_s), and its steady model has less noise. Places do not
 * distinguish calm from agile: with them `calm` changes with time and at the ends of manoeuvres
 * only. Range rates do: they show gentle turns, which agile targets then may make. A manoeuvring
 * model with negligible probability is not mixed into the steady one, whose estimate it would
 * degrade.
 *
 * As long as all noise is isotropic the axes are independent: three small filters per model. The
 * first plot with other noise couples the axes for good.
 *
 * Sources: R. A. Singer, Estimating optimal tracking filter performance for manned maneuvering
 * targets, IEEE Transactions on Aerospace and Electronic Systems 6, 1970; H. A. P. Blom, Y.
 * Bar-Shalom, The interacting multiple model algorithm for systems with Markovian switching
 * coefficients, IEEE Transactions on Automatic Control 33, 1988.
 *
 * Stack: 112 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_IMM_H
#define RHOTRACK_IMM_H

#include <stdint.h>

#include "rhotrack/detail/bearing_mix.h"
#include "rhotrack/detail/kalman.h"
#include "rhotrack/detail/linalg.h"
#include "rhotrack/detail/measurement.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

#define RHO_IMM_STATES 9

/* Indices of the accelerations, which follow the elements of kalman.h's state. */
#define RHO_AX 6
#define RHO_AY 7

/* A plot is in the gate if its NIS under either model is at most this. */
#define RHO_IMM_GATE 30.0f
/* its square root: the largest distance of a plot in the gate, in standard deviations */
#define RHO_IMM_GATE_SIGMAS 5.4772256f

/* Default mean time between manoeuvres of calm targets, such as airliners and ships. */
#define RHO_IMM_CALM_S 300.0f

/* Motion of the targets. rho_imm_model_default derives it from the largest acceleration. */
struct rho_imm_model {
    float quiet_density; /* white acceleration of the steady model, m^2/s^3: >= 0 */
    /* white acceleration of the steady model for a calm target: 0 .. quiet_density */
    float calm_density;
    float drive_density; /* white noise that drives a manoeuvre's acceleration, (m/s^2)^2/s: >= 0 */
    float memory_s;      /* time in which an acceleration decays to 1/e: > 0 */
    /* mean time between manoeuvres of an agile target, and mean duration of a manoeuvre: > 0 */
    float steady_s, maneuver_s;
    /* mean time between manoeuvres of a calm target, at least steady_s; 0: no calm targets */
    float calm_s;
    float settle_s;         /* mean time until an agile target becomes calm: > 0 if calm_s is */
    float speed_sigma_mps;  /* velocity sd of an axis that a first plot opens */
    float accel_sigma_mps2; /* acceleration sd of a new filter */
    float speed_max_mps; /* largest speed: faster hypotheses lose weight; 0 (default): no limit */
};

/* Transition of both models over one interval, computed once for all estimates. */
struct rho_imm_step {
    float dt_s;
    /* probability that an agile target manoeuvres at the end; that a manoeuvre has ended */
    float begins, ends;
    /* probability that a calm target manoeuvres; that an agile one has become calm */
    float calm_begins, settles;
    /* odds of the manoeuvring model below which it is not mixed into the steady one */
    float odds_over;
    /* steady model's noise density, of agile and of calm targets */
    float quiet_density, calm_density;
    float position_by_accel, velocity_by_accel, accel_by_accel;
    /* covariance of the manoeuvring model's process noise on an axis: p, v, a */
    float noise[RHO_TRIANGLE(3)];
    /* covariance of the steady model's process noise on an axis, for a density of 1 */
    float quiet_noise[RHO_TRIANGLE(2)];
};

struct rho_imm {
    struct rho_kalman steady;
    float state[RHO_IMM_STATES]; /* state and covariance of the manoeuvring model */
    float covariance[RHO_TRIANGLE(RHO_IMM_STATES)];
    float probability; /* probability of the manoeuvring model */
    float calm;        /* probability that the target is calm if it is steady */
    uint8_t is_coupled;
    uint8_t has_rates;  /* 1: range rates tell calm targets from gentle turns */
    uint16_t unseen_ms; /* time since the last plot, 65535 at most */
};

/* A plot prepared for scoring and updates. Plot and sensor are referred to, not copied. */
struct rho_imm_plot {
    struct rho_measurement position;
    float covariance[6]; /* covariance of the position's noise, a triangle */
    uint32_t measures;
    const struct rho_plot *plot;
    const struct rho_sensor *sensor;
};

struct rho_imm_match {
    float nis;            /* the smaller normalised innovation squared of both models */
    float log_likelihood; /* ln of the plot's density, over both models */
    /* posterior probability of the manoeuvring model, if the plot is the target's */
    float probability;
    uint8_t num_axes; /* axes of the position that were scored: 2, or 3 with height */
    uint8_t has_velocity, has_range_rate; /* 1: the plot's velocity, its range rate were scored */
};

/*
 * Fills *model with the defaults for targets with speed up to v_max > 0 and acceleration up to
 * accel_max >= 0: a stationary acceleration sd of 0.8 accel_max with memory_s 0.35 v_max /
 * accel_max, 3 s at least; mean times steady_s and maneuver_s 0.47 v_max / accel_max, 4 s at least;
 * settle_s 60 s, calm_s 300 s; quiet_density (accel_max / 20)^2 m^2/s^3, 1 at most; calm_density
 * the same, 0.003 at most; speed sd v_max and acceleration sd accel_max at the start of a filter.
 * Stack: 110 bytes.
 */
void rho_imm_model_default(struct rho_imm_model *model, float accel_max_mps2, float v_max_mps);

/* True where every field is finite and within its range. */
int rho_imm_model_is_usable(const struct rho_imm_model *model);

/*
 * Fills *step for an interval, -1e5 .. 1e5 s; a negative one has no noise and no transitions. Cost:
 * about 750 instructions, 100 more for each doubling beyond memory_s / 2. Stack: 160 bytes.
 */
void rho_imm_prepare_step(struct rho_imm_step *step, const struct rho_imm_model *model, float dt_s);

/*
 * Starts both models from an estimate, with probability 1/2 each and acceleration 0 with the
 * model's sd. A new target is calm with probability calm_s / (calm_s + RHO_IMM_CALM_S).
 */
void rho_imm_start(struct rho_imm *imm, const struct rho_imm_model *model,
                   const struct rho_kalman *estimate);

/*
 * Mixes the models and predicts both. Errors: VALUE (a result not finite, or beyond
 * RHO_VARIANCE_MAX): then the object must not be used any more.
 * Cost: about 800 instructions, coupled with a height 1 400. Stack: 336 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_imm_predict(struct rho_imm *imm,
                                               const struct rho_imm_step *step);

/* Predicts both models without mixing them: to a plot's own time, or back. Stack: 336 bytes. */
RHO_MUST_CHECK enum rho_status rho_imm_predict_unmixed(struct rho_imm *imm,
                                                       const struct rho_imm_step *step);

/*
 * Prepares a valid plot of a scan that measures `measures`, seen from `sensor` (NULL: the origin),
 * for scoring and updates. Plot and sensor are referred to, not copied. Stack: 128 bytes.
 */
void rho_imm_prepare_plot(struct rho_imm_plot *seen, const struct rho_plot *plot, uint32_t measures,
                          const struct rho_sensor *sensor);

/*
 * Scores a plot at the estimate's time: returns 1 and fills *match if it is in the gate of either
 * model, else 0. Height, velocity and range rate are scored if plot and estimate have them.
 * Cost: about 250 instructions, coupled or with own covariance 500. Stack: 710 bytes.
 */
int rho_imm_score_plot(const struct rho_imm *imm, const struct rho_imm_plot *seen,
                       struct rho_imm_match *match);

/* Range rates that both models predict for a sensor and all plots at the estimate's time. */
struct rho_imm_rates {
    float expected_mps[2]; /* range rate predicted by each model */
    /* variance of the predicted range rate; < 0: none, the position is the sensor's */
    float variance[2];
    /* covariances of the predicted range rate with the state */
    float projected[2][RHO_KALMAN_STATES];
};

/* Fills *rates. Cost: 1 400 instructions, without a height 400. Stack: 328 bytes. */
void rho_imm_predict_range_rates(struct rho_imm_rates *rates, const struct rho_imm *imm,
                                 const struct rho_sensor *sensor);

/*
 * Scores a plot as rho_imm_score_plot does, with range rates that were predicted
 * for its sensor; they are not read for a plot without a range rate. Stack: 620 bytes.
 */
int rho_imm_score_with_rates(const struct rho_imm *imm, const struct rho_imm_rates *rates,
                             const struct rho_imm_plot *seen, struct rho_imm_match *match);

/*
 * Gates of both models for plots of a position alone, all with one isotropic noise, while the axes
 * are independent: the part of scoring that such plots have in common.
 */
struct rho_imm_gate {
    float centre_m[2][3];     /* centres: positions predicted by each model */
    float half_inverse[2][3]; /* 1 / (2 S) of each axis; 0: the axis is not scored */
    float log_factor[2];      /* ln of a model's probability times its density at NIS 0 */
    uint8_t num_axes;
};

/*
 * Fills *gate for plots of position noise variance_m2 on each axis. Returns 0 if the axes are
 * coupled, or a density is not finite. Cost: 250 instructions.
 */
int rho_imm_prepare_gate(struct rho_imm_gate *gate, const struct rho_imm *imm, float variance_m2,
                         int has_z);

/*
 * Scores a position of the gate's noise: returns 1 and fills ln of its density and the manoeuvring
 * model's probability if it is in the gate of either model. Returns 0 also if the density is
 * certainly at most e^log_likelihood_to_exceed (-FLT_MAX: no limit), which saves most of the work.
 * Cost: 45 instructions outside of the gate, 150 inside.
 */
int rho_imm_score_in_gate(const struct rho_imm_gate *gate, const float place_m[3],
                          float log_likelihood_to_exceed, float *log_likelihood,
                          float *probability);

/*
 * Updates both models with a plot that was scored, and sets the manoeuvring model's probability to
 * the match's. A first z opens the third axis.
 * Errors: as rho_kalman_update; then the object must not be used any more: work on a copy.
 * Cost: about 400 instructions, coupled 4 500, without a height 1 600. Stack: 600 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_imm_update(struct rho_imm *imm,
                                              const struct rho_imm_model *model,
                                              const struct rho_imm_plot *seen,
                                              const struct rho_imm_match *match);

/*
 * Scores bearing i of a look at the estimate's time: returns 1 where it is in the gate of either
 * model, and fills its density a radian, and the mean variance of the models that explain it.
 * Stack: 510 bytes.
 */
int rho_imm_score_bearing(const struct rho_imm *imm, const struct rho_weighed_bearings *look,
                          unsigned i, float *density, float *variance_rad2);

/*
 * Adds bearing i of a look to the mixes of both models, at the estimate's time; an estimate nearer
 * than a metre to the sensor has no bearing, and nothing is added. Stack: 500 bytes.
 */
void rho_imm_mix_bearing(const struct rho_imm *imm, const struct rho_weighed_bearings *look,
                         unsigned i, struct rho_bearing_mix mixes[2]);

/*
 * Updates each model with its mix of a look's bearings, and their probabilities by the likelihoods
 * of the look; *gain_nat gets ln of it. Errors: as rho_imm_update. Stack: 600 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_imm_update_bearings(struct rho_imm *imm,
                                                       const struct rho_weighed_bearings *look,
                                                       const struct rho_bearing_mix mixes[2],
                                                       float *gain_nat);

/*
 * Updates both models with a slope, or gives them a height where they have none; it tells nothing
 * of their probabilities. Where it cannot be linearised, nothing is done, RHO_OK. Errors: as
 * rho_imm_update. Stack: 600 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_imm_update_slope(struct rho_imm *imm,
                                                    const struct rho_imm_model *model,
                                                    const struct rho_slope *slope);

/*
 * Fills *estimate with the mean over both models and its covariance, which includes the spread
 * between the models; accel_mps2 (may be NULL) gets the mean acceleration.
 */
void rho_imm_estimate(const struct rho_imm *imm, struct rho_kalman *estimate, float accel_mps2[3]);

RHO_END_C

#endif
