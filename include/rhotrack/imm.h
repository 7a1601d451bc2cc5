/* SPDX-License-Identifier: MIT */
/*
 * imm: a filter of two motion models that interact: constant velocity, and a manoeuvre whose acceleration is remembered for
 * a while (Singer).
 *
 * `steady` is a Kalman filter [x y z vx vy vz] with little white acceleration. The manoeuvring model has the acceleration
 * beside these, [x y z vx vy vz ax ay az], which decays with memory_s and is driven by white noise. A target changes
 * between both as a Markov chain in continuous time, so that any interval will do: at each prediction the two estimates are
 * mixed by the probabilities of a change, and at each update the models' probabilities move by how well they had predicted
 * the plot.
 *
 * Most targets keep straight for minutes, some for seconds. So the chain has three states: a steady target is calm or agile,
 * and both share the steady filter. An agile target that stays steady becomes calm (settle_s); a calm one begins to manoeuvre
 * more seldom (calm_s) than an agile one (steady_s), and its steady model is quieter. Plots do not tell calm from agile: `calm`
 * moves with time and with the ends of manoeuvres alone. A manoeuvre that is all but refuted gives nothing back to the steady
 * model, whose estimate would be the worse for it.
 *
 * While all noise was isotropic the axes are independent, and are kept so: three small filters a model (decoupled). The
 * first plot with noise of another form couples them for good.
 *
 * Sources: R. A. Singer, Estimating optimal tracking filter performance for manned maneuvering targets, IEEE Transactions
 * on Aerospace and Electronic Systems 6, 1970; H. A. P. Blom, Y. Bar-Shalom, The interacting multiple model algorithm for
 * systems with Markovian switching coefficients, IEEE Transactions on Automatic Control 33, 1988.
 *
 * Stack: 112 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_IMM_H
#define RHOTRACK_IMM_H

#include <stdint.h>

#include "rhotrack/kalman.h"
#include "rhotrack/linalg.h"
#include "rhotrack/measurement.h"
#include "rhotrack/status.h"
#include "rhotrack/types.h"

#define RHO_IMM_STATES 9

/* A plot may be the target's where its squared Mahalanobis distance from either model's prediction is at most this. */
#define RHO_IMM_GATE 30.0f

/* Calm targets keep straight for minutes, if nothing more is known: airliners, ships. */
#define RHO_IMM_CALM_S 300.0f

/* What targets may do. rho_imm_model_default derives it from the largest acceleration. */
struct rho_imm_model {
    float quiet_density; /* white acceleration of the steady model, m^2/s^3: >= 0 */
    float calm_density;  /* the same of a calm target: 0 .. quiet_density */
    float drive_density; /* white noise that drives a manoeuvre's acceleration, (m/s^2)^2/s: >= 0 */
    float memory_s;      /* time in which an acceleration decays to 1/e: > 0 */
    /* mean times between manoeuvres of an agile target, and that one takes: > 0 */
    float steady_s, maneuver_s;
    /* steady_s of a calm target, no less than that; 0: none is calm, and the chain has two states */
    float calm_s;
    float settle_s; /* mean time after which a steady target is a calm one: > 0 where calm_s is */
    float speed_sigma_mps;  /* of the velocity of an axis that was measured once */
    float accel_sigma_mps2; /* of the acceleration at the start */
    float speed_max_mps; /* hypotheses that are surely faster lose weight; 0 (default): none does */
};

/* What one interval does to every estimate, computed once. */
struct rho_imm_step {
    float dt_s;
    /* probabilities that an agile target manoeuvres at its end, and that a manoeuvre has ended */
    float begins, ends;
    float calm_begins, settles; /* that a calm target manoeuvres; that an agile one is calm */
    float odds_over;            /* manoeuvres of lower odds give nothing back to the steady model */
    float quiet_density, calm_density; /* the steady model's, of agile and calm targets */
    float position_by_accel, velocity_by_accel, accel_by_accel;
    float noise[RHO_TRIANGLE(3)];       /* of position, velocity, acceleration of an axis */
    float quiet_noise[RHO_TRIANGLE(2)]; /* of position and velocity, for a steady density of 1 */
};

struct rho_imm {
    struct rho_kalman steady;
    float state[RHO_IMM_STATES]; /* of the manoeuvring model */
    float covariance[RHO_TRIANGLE(RHO_IMM_STATES)];
    float probability; /* of the manoeuvring model */
    float calm;        /* probability that the target is calm if it is steady */
    uint8_t is_coupled;
};

/* A plot opened up once for all that look at it. The sensor stays the caller's. */
struct rho_imm_plot {
    struct rho_measurement position;
    float covariance[6]; /* of the position's noise */
    uint32_t measures;
    const struct rho_plot *plot;
    const struct rho_sensor *sensor;
};

struct rho_imm_match {
    float distance2;      /* squared Mahalanobis distance from the nearer model's prediction */
    float log_likelihood; /* ln of the plot's density, over both models */
    float probability;    /* of the manoeuvring model, if the plot is the target's */
    uint8_t num_axes;     /* that count: 2, or 3 with height */
    uint8_t has_velocity, has_range_rate; /* count, too */
};

/*
 * Models for targets that fly v_max > 0 and pull accel_max >= 0: a standing acceleration of 0.8
 * accel_max that is remembered for 0.35 v_max / accel_max, 3 s at least; 0.47 v_max / accel_max in
 * either model, 4 s at least; calm targets after 60 s, which stay so for 300 s; quiet acceleration
 * of (accel_max / 20)^2 m^2/s^3, 1 at most, calm 0.003 at most of that; at the start, speed sd
 * v_max and acceleration sd accel_max. Stack: 110 bytes.
 */
void rho_imm_model_default(struct rho_imm_model *model, float accel_max_mps2, float v_max_mps);

/* True where every field is finite and within its range. */
int rho_imm_model_is_usable(const struct rho_imm_model *model);

/*
 * Fills *step for an interval, -1e5 .. 1e5 s. Backwards there is no noise and no change. Cost: about 750 instructions, and
 * 100 for each doubling beyond memory_s / 2. Stack: 160 bytes.
 */
void rho_imm_step_open(struct rho_imm_step *step, const struct rho_imm_model *model, float dt_s);

/*
 * Both models start from an estimate, each as likely as the other, calm as likely as agile where the model has calm targets;
 * acceleration 0 with the model's sd.
 */
void rho_imm_start(struct rho_imm *imm, const struct rho_imm_model *model,
                   const struct rho_kalman *estimate);

/*
 * Mixes the models and moves both on. Errors: VALUE (a result not finite, or beyond RHO_KALMAN_VARIANCE_MAX): then the
 * object is of no more use. Cost: about 800 instructions, coupled with a height 1 400.
 * Stack: 330 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_imm_predict(struct rho_imm *imm,
                                               const struct rho_imm_step *step);

/* The same without mixing: to a plot's own time, or back from it. Stack: 330 bytes. */
RHO_MUST_CHECK enum rho_status rho_imm_move(struct rho_imm *imm, const struct rho_imm_step *step);

/* Opens a valid plot of a scan that measures `measures`, seen from `sensor` (NULL: the origin). Both stay the caller's. */
void rho_imm_open_plot(struct rho_imm_plot *seen, const struct rho_plot *plot, uint32_t measures,
                       const struct rho_sensor *sensor);

/*
 * Weighs a plot at the estimate's time: returns 1 and fills *match where it is in the gate of either model, else 0. Height,
 * velocity and range rate count as far as both have them.
 * Cost: about 250 instructions, coupled or with own covariance 500. Stack: 710 bytes.
 */
int rho_imm_weigh(const struct rho_imm *imm, const struct rho_imm_plot *seen,
                  struct rho_imm_match *match);

/* What an estimate expects of a sensor's range rates: the same for all plots of its time. */
struct rho_imm_rates {
    float expected_mps[2]; /* by both models */
    float variance
        [2]; /* of what is expected; < 0: the model is in the sensor's own place, and expects nothing */
    float projected[2][RHO_KALMAN_STATES]; /* covariances with the state */
};

/* Fills *rates. Cost: 1 400 instructions, without a height 400. Stack: 320 bytes. */
void rho_imm_open_rates(struct rho_imm_rates *rates, const struct rho_imm *imm,
                        const struct rho_sensor *sensor);

/* rho_imm_weigh with the rates of the estimate and of the plot's sensor; they count where the plot has a range rate: else they may
 * be anything. Stack: 620 bytes. */
int rho_imm_weigh_with(const struct rho_imm *imm, const struct rho_imm_rates *rates,
                       const struct rho_imm_plot *seen, struct rho_imm_match *match);

/* What weighing plots of one isotropic noise, places alone, has in common while the axes are independent. */
struct rho_imm_gate {
    float centre_m[2][3]; /* of both models */
    float half_inverse
        [2][3]; /* of the innovations' variances, 1 / 2 S; 0 where an axis does not count */
    float log_factor
        [2]; /* ln of the model's probability and of its density where the distance is 0 */
    uint8_t num_axes;
};

/* Fills *gate; 0 where it cannot be: coupled axes, densities that are no numbers. Cost: 250 instructions. */
int rho_imm_open_gate(struct rho_imm_gate *gate, const struct rho_imm *imm, float variance_m2,
                      int has_z);

/*
 * As rho_imm_weigh for a plot of that noise: ln of its density and the manoeuvring model's probability. Returns 0 also for one that is surely no likelier than `enough` (-FLT_MAX: all
 * are wanted), which saves most of the work. Cost: 45 instructions outside of the gate, 150 inside.
 */
int rho_imm_weigh_in(const struct rho_imm_gate *gate, const float place_m[3], float enough,
                     float *log_likelihood, float *probability);

/*
 * Updates both models with a plot that was weighed, and takes the match's probability. A first z opens the third axis.
 * Errors: as rho_kalman_update; then the object is of no more use: work on a copy.
 * Cost: about 400 instructions, coupled 4 500, without a height 1 600. Stack: 600 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_imm_update(struct rho_imm *imm,
                                              const struct rho_imm_model *model,
                                              const struct rho_imm_plot *seen,
                                              const struct rho_imm_match *match);

/*
 * Updates both models with a bearing from a place, and their probabilities by how well they had predicted it. *gain_nat gets
 * ln of the bearing's density in metres across the line of sight. An estimate nearer than a metre to the place has no
 * bearing: nothing is done, *gain_nat is 0, RHO_OK. Errors: as rho_imm_update. Stack: 600 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_imm_update_bearing(struct rho_imm *imm, float x_m, float y_m,
                                                      float bearing_rad, float sigma_rad,
                                                      float *gain_nat);

/* The mean over both models and its covariance, with the spread between them; accel_mps2 (may be NULL) the same. */
void rho_imm_estimate(const struct rho_imm *imm, struct rho_kalman *estimate, float accel_mps2[3]);

#endif
