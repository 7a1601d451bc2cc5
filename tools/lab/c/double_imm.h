/* SPDX-License-Identifier: MIT */
/*
 * double_imm: references in double precision for targets that manoeuvre, with full matrices,
 * written from the textbook: a Kalman filter that can be told the input, and an interacting
 * multiple model estimator (Blom and Bar-Shalom). What the library's own are measured against; they
 * share no code.
 */
#ifndef RHOTRACK_TOOL_DOUBLE_IMM_H
#define RHOTRACK_TOOL_DOUBLE_IMM_H

#include <stdbool.h>
#include <stddef.h>

#define DOUBLE_STATES 9 /* x y z, vx vy vz, ax ay az */
#define DOUBLE_MODELS_MAX 2

struct double_matrix {
    double at[DOUBLE_STATES][DOUBLE_STATES];
};

struct double_gaussian {
    double mean[DOUBLE_STATES];
    struct double_matrix covariance;
};

struct double_model {
    struct double_matrix transition, noise;
    bool is_steady; /* without acceleration */
};

/* The first `size` elements of the state were measured: 1 to 3 of a place, 6 place and velocity. */
struct double_measured {
    size_t size;
    double value[6];
    double covariance[6][6];
};

/* ---- models of one interval ------------------------------------------------------------------ */

/*
 * Constant velocity, acceleration 0. Each interval the velocity of an axis takes a random step;
 * what that adds to place and velocity is `input` times a normal number of sd accel_mps2: (T^2 / 2,
 * T) for an acceleration that lasts it.
 */
struct double_model double_model_steady(double interval_s, const double input[2],
                                        double accel_mps2);

/* The same with noise of its own in each element: variance of the place, of the velocity. */
struct double_model double_model_noisy(double interval_s, double place_m2, double velocity_m2ps2);

/* Singer: the acceleration decays by `keep` an interval and takes random steps of sd step_mps2. */
struct double_model double_model_singer(double interval_s, double keep, double step_mps2);

/* ---- one filter ------------------------------------------------------------------------------ */

/* shift: what a known input adds to the state; NULL: nothing. */
void double_gaussian_predict(struct double_gaussian *gaussian, const struct double_model *model,
                             const double shift[DOUBLE_STATES]);

/*
 * Squared Mahalanobis distance of what was measured; *log_det (may be NULL): of the innovation's
 * covariance.
 */
double double_gaussian_distance2(const struct double_gaussian *gaussian,
                                 const struct double_measured *measured, double *log_det);

void double_gaussian_update(struct double_gaussian *gaussian,
                            const struct double_measured *measured);

/* ---- several --------------------------------------------------------------------------------- */

struct double_imm {
    size_t num_models;
    double stay; /* probability that a model lasts an interval */
    struct double_model model[DOUBLE_MODELS_MAX];
    struct double_gaussian mode[DOUBLE_MODELS_MAX];
    double probability[DOUBLE_MODELS_MAX];
};

/* All modes equally likely, at the same estimate but for the acceleration of a steady one: 0. */
void double_imm_start(struct double_imm *imm, const struct double_gaussian *start);

/* Mixes, and moves each mode on. */
void double_imm_predict(struct double_imm *imm);
void double_imm_update(struct double_imm *imm, const struct double_measured *measured);

/* Mean and covariance over the modes. */
void double_imm_estimate(const struct double_imm *imm, struct double_gaussian *estimate);

#endif
