/* SPDX-License-Identifier: MIT */
/*
 * Reference of the interacting multiple model filter in double precision: nine states and full
 * matrices for both models, vector updates with an inverse, mixing over a chain of three states,
 * Singer's noise by numerical integration. The library shares only the order of states and of the
 * packed triangle. The steady model has an acceleration, too, known to be 0; calm and agile targets
 * share it.
 */
#ifndef RHOTRACK_TESTS_IMM_REFERENCE_H
#define RHOTRACK_TESTS_IMM_REFERENCE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/detail/imm.h"

#define WIDE 9
#define WIDE_ROWS 7 /* three places, three velocities, a range rate */
#define STEADY 0
#define MANOEUVRE 1

/* ---- one model ------------------------------------------------------------------------------- */

struct wide_model {
    double x[WIDE], p[WIDE][WIDE];
};

/* A measurement h x with noise covariance r; y is the innovation, measured minus predicted. */
struct wide_rows {
    int num;
    double h[WIDE_ROWS][WIDE], y[WIDE_ROWS], r[WIDE_ROWS][WIDE_ROWS];
};

struct wide_step {
    double f[WIDE][WIDE], q[WIDE][WIDE];
};

/* Inverts by Gauss-Jordan with partial pivoting; returns ln |det a|. */
static inline double wide_invert_and_log_det(int n, double a[WIDE_ROWS][WIDE_ROWS],
                                             double inverse[WIDE_ROWS][WIDE_ROWS])
{
    double log_det = 0.0;

    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            inverse[i][j] = i == j ? 1.0 : 0.0;
        }
    }
    for (int k = 0; k < n; ++k) {
        int best = k;

        for (int i = k; i < n; ++i) {
            best = fabs(a[i][k]) > fabs(a[best][k]) ? i : best;
        }
        for (int j = 0; j < n; ++j) {
            const double of_a = a[k][j], of_inverse = inverse[k][j];

            a[k][j] = a[best][j];
            a[best][j] = of_a;
            inverse[k][j] = inverse[best][j];
            inverse[best][j] = of_inverse;
        }
        const double pivot = a[k][k];
        log_det += log(fabs(pivot));
        for (int j = 0; j < n; ++j) {
            a[k][j] /= pivot;
            inverse[k][j] /= pivot;
        }
        for (int i = 0; i < n; ++i) {
            const double factor = a[i][k];

            for (int j = 0; j < n && i != k; ++j) {
                a[i][j] -= factor * a[k][j];
                inverse[i][j] -= factor * inverse[k][j];
            }
        }
    }
    return log_det;
}

static inline void wide_predict(struct wide_model *m, const struct wide_step *step)
{
    double x[WIDE] = {0.0}, half[WIDE][WIDE] = {{0.0}};

    for (int i = 0; i < WIDE; ++i) {
        for (int k = 0; k < WIDE; ++k) {
            x[i] += step->f[i][k] * m->x[k];
            for (int j = 0; j < WIDE; ++j) {
                half[i][j] += step->f[i][k] * m->p[k][j];
            }
        }
    }
    memcpy(m->x, x, sizeof x);
    for (int i = 0; i < WIDE; ++i) {
        for (int j = 0; j < WIDE; ++j) {
            m->p[i][j] = step->q[i][j];
            for (int k = 0; k < WIDE; ++k) {
                m->p[i][j] += half[i][k] * step->f[j][k];
            }
        }
    }
}

/* Computes p h^T and the innovation covariance h p h^T + r. */
static inline void wide_innovation_covariance(const struct wide_model *m, const struct wide_rows *z,
                                              double ph[WIDE][WIDE_ROWS],
                                              double s[WIDE_ROWS][WIDE_ROWS])
{
    for (int a = 0; a < z->num; ++a) {
        for (int i = 0; i < WIDE; ++i) {
            ph[i][a] = 0.0;
            for (int k = 0; k < WIDE; ++k) {
                ph[i][a] += m->p[i][k] * z->h[a][k];
            }
        }
    }
    for (int a = 0; a < z->num; ++a) {
        for (int b = 0; b < z->num; ++b) {
            s[a][b] = z->r[a][b];
            for (int k = 0; k < WIDE; ++k) {
                s[a][b] += z->h[a][k] * ph[k][b];
            }
        }
    }
}

/* Log density of the innovation y; distance2 gets y^T S^-1 y. */
static inline double wide_log_density(const struct wide_model *m, const struct wide_rows *z,
                                      double *distance2)
{
    double ph[WIDE][WIDE_ROWS], s[WIDE_ROWS][WIDE_ROWS], inverse[WIDE_ROWS][WIDE_ROWS];

    wide_innovation_covariance(m, z, ph, s);
    const double log_det = wide_invert_and_log_det(z->num, s, inverse);
    *distance2 = 0.0;
    for (int a = 0; a < z->num; ++a) {
        for (int b = 0; b < z->num; ++b) {
            *distance2 += z->y[a] * inverse[a][b] * z->y[b];
        }
    }
    return -0.5 * (*distance2 + log_det + z->num * 1.8378770664093453);
}

static inline void wide_update(struct wide_model *m, const struct wide_rows *z)
{
    double ph[WIDE][WIDE_ROWS], s[WIDE_ROWS][WIDE_ROWS], inverse[WIDE_ROWS][WIDE_ROWS];
    double gain[WIDE][WIDE_ROWS] = {{0.0}}, rest[WIDE][WIDE], half[WIDE][WIDE] = {{0.0}};

    wide_innovation_covariance(m, z, ph, s);
    wide_invert_and_log_det(z->num, s, inverse);
    for (int i = 0; i < WIDE; ++i) {
        for (int b = 0; b < z->num; ++b) {
            for (int a = 0; a < z->num; ++a) {
                gain[i][b] += ph[i][a] * inverse[a][b];
            }
            m->x[i] += gain[i][b] * z->y[b];
        }
        for (int j = 0; j < WIDE; ++j) {
            rest[i][j] = i == j ? 1.0 : 0.0;
            for (int a = 0; a < z->num; ++a) {
                rest[i][j] -= gain[i][a] * z->h[a][j];
            }
        }
    }
    /* Joseph's form: rest p rest^T + gain r gain^T */
    for (int i = 0; i < WIDE; ++i) {
        for (int j = 0; j < WIDE; ++j) {
            for (int k = 0; k < WIDE; ++k) {
                half[i][j] += rest[i][k] * m->p[k][j];
            }
        }
    }
    for (int i = 0; i < WIDE; ++i) {
        for (int j = 0; j < WIDE; ++j) {
            m->p[i][j] = 0.0;
            for (int k = 0; k < WIDE; ++k) {
                m->p[i][j] += half[i][k] * rest[j][k];
            }
            for (int a = 0; a < z->num * z->num; ++a) {
                m->p[i][j] +=
                    gain[i][a / z->num] * z->r[a / z->num][a % z->num] * gain[j][a % z->num];
            }
        }
    }
}

/* ---- Singer's model -------------------------------------------------------------------------- */

/* Position, velocity and acceleration at t from an acceleration of 1 at time 0. */
static inline void singer_response(double t, double memory, double out[3])
{
    const double x = t / memory;
    double first = 0.0, second = 0.0, term = 1.0;

    if (fabs(x) < 0.5) { /* power series: sums of (-x)^k / (k + 1)! and / (k + 2)! */
        for (int k = 0; k < 30; ++k) {
            first += term / (k + 1);
            second += term / (k + 1) / (k + 2);
            term *= -x / (k + 1);
        }
    } else {
        first = (1.0 - exp(-x)) / x;
        second = (x - 1.0 + exp(-x)) / x / x;
    }
    out[0] = t * t * second;
    out[1] = t * first;
    out[2] = exp(-x);
}

/* Adds the integral of the response's outer product to q, by Simpson's rule over 2 n panels. */
static inline void singer_integrate(double from, double to, double memory, int n, double q[3][3])
{
    const double h = (to - from) / (2.0 * n);

    for (int k = 0; k <= 2 * n; ++k) {
        const double weight = (k == 0 || k == 2 * n ? 1.0 : k % 2 ? 4.0 : 2.0) * h / 3.0;
        double r[3];

        singer_response(from + k * h, memory, r);
        for (int i = 0; i < 9; ++i) {
            q[i / 3][i % 3] += weight * r[i / 3] * r[i % 3];
        }
    }
}

/*
 * Process noise of an interval for white driving noise of density 1. After forty memories the
 * response is a polynomial, which two panels integrate exactly.
 */
static inline void singer_noise(double dt, double memory, double q[3][3])
{
    const double bend = fmin(dt, 40.0 * memory);

    memset(q, 0, 9 * sizeof q[0][0]);
    if (dt > 0.0) {
        singer_integrate(0.0, bend, memory, 20 + (int)(50.0 * bend / memory), q);
        singer_integrate(bend, dt, memory, 1, q);
    }
}

/* ---- both models ----------------------------------------------------------------------------- */

struct reference {
    struct wide_model models[2];
    double probability; /* of the manoeuvring model */
    double calm;        /* calm share of the steady targets */
    double unseen_s;    /* since the last plot */
    int has_z, has_rates;
    int is_apart; /* no covariances between axes */
};

/* Process noise of gentle turns over that of calm targets, of which (1 - calm)^4 is assumed. */
static inline double reference_turn_density(const struct rho_imm_model *model)
{
    return 12.0 * model->quiet_density - model->calm_density;
}

static inline struct wide_step
reference_step(const struct reference *r, const struct rho_imm_model *model, double dt, int which)
{
    struct wide_step step = {.f = {{0.0}}};
    double response[3] = {0.0}, q[3][3] = {{0.0}};

    if (which == MANOEUVRE) {
        singer_noise(dt, model->memory_s, q);
        singer_response(dt, model->memory_s, response);
    }
    for (int i = 0; i < WIDE; ++i) {
        step.f[i][i] = i < 6 ? 1.0 : which == MANOEUVRE ? response[2] : 0.0;
    }
    for (int axis = 0; axis < 3; ++axis) {
        const double density = axis < 2 || r->has_z ? 1.0 : 0.0;

        step.f[axis][axis + 3] = dt;
        if (which == MANOEUVRE) {
            step.f[axis][axis + 6] = response[0];
            step.f[axis + 3][axis + 6] = response[1];
            for (int i = 0; i < 9; ++i) {
                step.q[axis + i / 3 * 3][axis + i % 3 * 3] =
                    density * model->drive_density * q[i / 3][i % 3];
            }
        } else if (dt > 0.0) {
            const double noise =
                density *
                (r->has_rates
                     ? model->calm_density + pow(1.0 - r->calm, 4) * reference_turn_density(model)
                     : r->calm * model->calm_density + (1.0 - r->calm) * model->quiet_density);

            step.q[axis][axis] = noise * dt * dt * dt / 3.0;
            step.q[axis][axis + 3] = step.q[axis + 3][axis] = noise * dt * dt / 2.0;
            step.q[axis + 3][axis + 3] = noise * dt;
        }
    }
    return step;
}

/* Predicts both models without mixing. */
static inline void reference_predict_unmixed(struct reference *r, const struct rho_imm_model *model,
                                             double dt)
{
    for (int which = 0; which < 2; ++which) {
        const struct wide_step step = reference_step(r, model, dt, which);

        wide_predict(&r->models[which], &step);
    }
    r->unseen_s = fmin(r->unseen_s + fmax(dt, 0.0), 65.535);
}

static inline struct wide_model reference_mixed_model(const struct wide_model models[2],
                                                      const double share[2])
{
    struct wide_model mean = {.x = {0.0}};

    for (int k = 0; k < 2; ++k) {
        for (int i = 0; i < WIDE; ++i) {
            mean.x[i] += share[k] * models[k].x[i];
        }
    }
    for (int k = 0; k < 2; ++k) {
        for (int i = 0; i < WIDE; ++i) {
            for (int j = 0; j < WIDE; ++j) {
                mean.p[i][j] += share[k] * (models[k].p[i][j] + (models[k].x[i] - mean.x[i]) *
                                                                    (models[k].x[j] - mean.x[j]));
            }
        }
    }
    return mean;
}

/* States of the Markov chain, and the motion model of each. */
#define CALM 0
#define AGILE 1
#define PULLING 2
static const int chain_models[3] = {STEADY, STEADY, MANOEUVRE};

/*
 * True if the manoeuvring model is mixed back into the steady one: with calm targets it must have
 * odds of 0.16 at least.
 */
static inline int is_manoeuvre_likely_enough_to_mix_back(const struct rho_imm_model *model,
                                                         double probability)
{
    return !(model->calm_s > 0.0f) || probability >= 0.16 * (1.0 - probability);
}

/*
 * Transition probabilities of the chain, by states before and after. Agile targets and manoeuvres
 * alternate in continuous time; calm targets begin to manoeuvre at a rate of their own, not above
 * that of agile ones; agile targets that stay steady become calm.
 */
static inline void reference_change_probabilities(const struct rho_imm_model *model, double dt,
                                                  int may_manoeuvre_end, double change[3][3])
{
    const double begins = 1.0 / model->steady_s, ends = 1.0 / model->maneuver_s;
    const double moved = -expm1(-dt * (begins + ends)) / (begins + ends);
    const int has_calm = model->calm_s > 0.0f;
    const double settles = has_calm ? -expm1(-dt / model->settle_s) : 0.0;
    const double calm_begins =
        has_calm ? fmin(-expm1(-dt / fmax(model->calm_s, model->steady_s)), begins * moved)
                 : begins * moved;
    const double ended = may_manoeuvre_end ? ends * moved : 0.0, stays = 1.0 - begins * moved;
    const double rows[3][3] = {{1.0 - calm_begins, 0.0, calm_begins},
                               {stays * settles, stays * (1.0 - settles), begins * moved},
                               {0.0, ended, 1.0 - ended}};

    memcpy(change, rows, sizeof rows);
}

static inline void reference_mix(struct reference *r, const struct rho_imm_model *model, double dt,
                                 int returns)
{
    const double steady = 1.0 - r->probability;
    const double was[3] = {steady * r->calm, steady * (1.0 - r->calm), r->probability};
    double change[3][3], share[2][2] = {{0.0}}, is[3] = {0.0};
    struct wide_model mixed[2];

    reference_change_probabilities(model, dt, returns, change);
    for (int from = 0; from < 3; ++from) {
        for (int to = 0; to < 3; ++to) {
            const double passes = was[from] * change[from][to];

            is[to] += passes;
            share[chain_models[to]][chain_models[from]] += passes;
        }
    }
    for (int to = 0; to < 2; ++to) {
        const double sum = share[to][0] + share[to][1];

        share[to][0] /= sum;
        share[to][1] /= sum;
        mixed[to] = reference_mixed_model(r->models, share[to]);
    }
    r->probability = is[PULLING];
    r->calm = is[CALM] / (is[CALM] + is[AGILE]);
    for (int i = 0; i < WIDE * WIDE; ++i) {
        if (i / WIDE > 5 || i % WIDE > 5) { /* the steady model's acceleration is known to be 0 */
            mixed[STEADY].p[i / WIDE][i % WIDE] = 0.0;
            mixed[STEADY].x[i / WIDE > 5 ? i / WIDE : i % WIDE] = 0.0;
        }
        if (r->is_apart && i / WIDE % 3 != i % WIDE % 3) {
            mixed[STEADY].p[i / WIDE][i % WIDE] = mixed[MANOEUVRE].p[i / WIDE][i % WIDE] = 0.0;
        }
    }
    memcpy(r->models, mixed, sizeof mixed);
}

/*
 * Mixes and predicts. The caller decides whether manoeuvres end, as rounding near the odds of 0.16
 * would make library and reference differ.
 */
static inline void reference_predict(struct reference *r, const struct rho_imm_model *model,
                                     double dt, int returns)
{
    if (dt > 0.0) {
        reference_mix(r, model, dt, returns);
    }
    reference_predict_unmixed(r, model, dt);
}

static inline void reference_start(struct reference *r, const struct rho_imm_model *model,
                                   const struct rho_kalman *estimate)
{
    memset(r, 0, sizeof *r);
    r->has_z = estimate->covariance[RHO_AT(2, 2)] > 0.0f;
    r->is_apart = 1;
    r->probability = 0.5;
    r->calm = (double)model->calm_s / ((double)model->calm_s + 300.0);
    for (int which = 0; which < 2; ++which) {
        struct wide_model *m = &r->models[which];

        for (int i = 0; i < 6; ++i) {
            m->x[i] = estimate->state[i];
            for (int j = 0; j < 6; ++j) {
                m->p[i][j] = estimate->covariance[RHO_AT(i, j)];
                if (i % 3 != j % 3 && m->p[i][j] != 0.0) {
                    r->is_apart = 0;
                }
            }
        }
        for (int axis = 0; which == MANOEUVRE && axis < 2 + r->has_z; ++axis) {
            m->p[6 + axis][6 + axis] = pow(model->accel_sigma_mps2, 2);
        }
    }
}

/* ---- plots ----------------------------------------------------------------------------------- */

/* A plot, what is measured of it, and the sensor. */
struct reference_plot {
    const struct rho_plot *plot;
    uint32_t measures;
    const struct rho_sensor *sensor;
};

static inline void reference_plot_noise(const struct reference_plot *seen, double r[3][3])
{
    const struct rho_plot *plot = seen->plot;
    const int axes = seen->measures & RHO_MEASURES_Z ? 3 : 2;
    const double sigma[3] = {plot->sigma_range_m, plot->sigma_cross_m, plot->sigma_up_m};
    const double d[3] = {plot->x_m - (seen->sensor ? (double)seen->sensor->x_m : 0.0),
                         plot->y_m - (seen->sensor ? (double)seen->sensor->y_m : 0.0),
                         axes == 3 ? plot->z_m - (seen->sensor ? (double)seen->sensor->z_m : 0.0)
                                   : 0.0};
    const double ground = hypot(d[0], d[1]), range = hypot(ground, d[2]);
    const double axis[3][3] = {
        {d[0] / range, d[1] / range, d[2] / range},
        {-d[1] / ground, d[0] / ground, 0.0},
        {-d[2] * d[0] / range / ground, -d[2] * d[1] / range / ground, ground / range}};

    memset(r, 0, 9 * sizeof r[0][0]);
    for (int k = 0; k < axes; ++k) {
        for (int i = 0; i < axes; ++i) {
            for (int j = 0; j < axes; ++j) {
                r[i][j] += sigma[k] * sigma[k] * axis[k][i] * axis[k][j];
            }
        }
    }
}

static inline int reference_is_isotropic(const struct reference_plot *seen)
{
    const struct rho_plot *plot = seen->plot;

    return plot->sigma_range_m == plot->sigma_cross_m &&
           (!(seen->measures & RHO_MEASURES_Z) || plot->sigma_range_m == plot->sigma_up_m);
}

static inline void reference_add_place(const struct reference *r, const struct wide_model *m,
                                       const struct reference_plot *seen, struct wide_rows *z)
{
    const double place[3] = {seen->plot->x_m, seen->plot->y_m, seen->plot->z_m};
    const int axes = r->has_z && (seen->measures & RHO_MEASURES_Z) ? 3 : 2;
    double noise[3][3];

    reference_plot_noise(seen, noise);
    for (int i = 0; i < axes; ++i) {
        z->h[i][i] = 1.0;
        z->y[i] = place[i] - m->x[i];
        for (int j = 0; j < axes; ++j) {
            z->r[i][j] = noise[i][j];
        }
    }
    z->num = axes;
}

static inline void reference_add_velocity(const struct wide_model *m,
                                          const struct reference_plot *seen, struct wide_rows *z)
{
    const double velocity[3] = {seen->plot->vx_mps, seen->plot->vy_mps, seen->plot->vz_mps};
    const int axes = z->num;

    for (int i = 0; i < axes; ++i) {
        z->h[axes + i][3 + i] = 1.0;
        z->y[axes + i] = velocity[i] - m->x[3 + i];
        z->r[axes + i][axes + i] = pow(seen->plot->sigma_mps, 2);
    }
    z->num = 2 * axes;
}

/* Adds a row for the range rate, linearised; the linearisation error counts as noise. */
static inline void reference_add_range_rate(const struct reference *r, const struct wide_model *m,
                                            const struct reference_plot *seen, struct wide_rows *z)
{
    const double from[3] = {seen->sensor ? seen->sensor->x_m : 0.0,
                            seen->sensor ? seen->sensor->y_m : 0.0,
                            seen->sensor ? seen->sensor->z_m : 0.0};
    const int axes = r->has_z ? 3 : 2;
    double range2 = 0.0, product = 0.0, spread2 = 0.0, speed2 = 0.0;

    for (int i = 0; i < axes; ++i) {
        range2 += pow(m->x[i] - from[i], 2);
        product += (m->x[i] - from[i]) * m->x[i + 3];
        spread2 += m->p[i][i];
        speed2 += m->x[i + 3] * m->x[i + 3];
    }
    const double range = sqrt(range2);
    for (int i = 0; i < axes; ++i) {
        z->h[z->num][i + 3] = (m->x[i] - from[i]) / range;
        z->h[z->num][i] = m->x[i + 3] / range - product * (m->x[i] - from[i]) / (range * range2);
    }
    z->y[z->num] = seen->plot->range_rate_mps - product / range;
    z->r[z->num][z->num] =
        pow(seen->plot->sigma_range_rate_mps, 2) + 0.5 * speed2 * pow(spread2 / range2, 2);
    z->num++;
}

/*
 * Bayes for calm targets against gentle turns, by a range rate's innovation under the steady model;
 * e^v is (1 + v / 16)^16, v up to 50. Plots within four seconds say the same.
 */
static inline void reference_update_calm(struct reference *r, const struct rho_imm_model *model,
                                         const struct wide_rows *rate)
{
    const double turned = reference_turn_density(model) * r->unseen_s;
    const double agile = 1.0 - r->calm;
    double variance = rate->r[0][0];

    for (int i = 0; i < WIDE * WIDE; ++i) {
        variance +=
            rate->h[0][i / WIDE] * rate->h[0][i % WIDE] * r->models[STEADY].p[i / WIDE][i % WIDE];
    }
    if (!(agile < 2e-3 && pow(rate->y[0], 2) < variance)) {
        const double calm = fmax(rate->r[0][0], variance - pow(agile, 4) * turned);
        const double turns = calm + turned;
        const double gain = fmin(50.0, 0.5 * pow(rate->y[0], 2) * (1.0 / calm - 1.0 / turns));
        const double odds = sqrt(calm / turns) * pow(1.0 + gain / 16.0, 16.0);
        const double news = fmin(1.0, r->unseen_s / 4.0);

        r->calm = fmin(0.999, r->calm / (r->calm + agile * (1.0 - news + news * odds)));
    }
    r->has_rates = 1;
}

struct reference_match {
    double distance2[2], log_likelihood, probability;
    double nearest2; /* the smaller one of both models */
};

static inline void reference_combine_densities(double probability, const double log_density[2],
                                               struct reference_match *match)
{
    const double best = fmax(log_density[0], log_density[1]);
    const double steady = (1.0 - probability) * exp(log_density[0] - best);
    const double manoeuvre = probability * exp(log_density[1] - best);

    match->log_likelihood = best + log(steady + manoeuvre);
    match->probability = manoeuvre / (steady + manoeuvre);
}

static inline double reference_density_by_model(const struct reference *r,
                                                const struct wide_model *m,
                                                const struct reference_plot *seen,
                                                double *distance2)
{
    struct wide_rows z = {.num = 0};

    reference_add_place(r, m, seen, &z);
    if (seen->measures & RHO_MEASURES_VELOCITY) {
        reference_add_velocity(m, seen, &z);
    }
    if (seen->measures & RHO_MEASURES_RANGE_RATE) {
        reference_add_range_rate(r, m, seen, &z);
    }
    return wide_log_density(m, &z, distance2);
}

static inline struct reference_match reference_match_plot(const struct reference *r,
                                                          const struct reference_plot *seen)
{
    struct reference_match match;
    double log_density[2];

    for (int which = 0; which < 2; ++which) {
        log_density[which] =
            reference_density_by_model(r, &r->models[which], seen, &match.distance2[which]);
    }
    reference_combine_densities(r->probability, log_density, &match);
    match.nearest2 = fmin(match.distance2[0], match.distance2[1]);
    return match;
}

/*
 * Updates with place and velocity at once, then with the range rate, linearised at the new
 * estimate; a first height opens the axis at the end.
 */
static inline void reference_update(struct reference *r, const struct rho_imm_model *model,
                                    const struct reference_plot *seen, double manoeuvre_probability)
{
    const int opens = !r->has_z && (seen->measures & RHO_MEASURES_Z);

    r->is_apart =
        r->is_apart && reference_is_isotropic(seen) && !(seen->measures & RHO_MEASURES_RANGE_RATE);
    for (int which = 0; which < 2; ++which) {
        struct wide_model *m = &r->models[which];
        struct wide_rows z = {.num = 0}, rate = {.num = 0};

        reference_add_place(r, m, seen, &z);
        if (seen->measures & RHO_MEASURES_VELOCITY) {
            reference_add_velocity(m, seen, &z);
        }
        wide_update(m, &z);
        if (seen->measures & RHO_MEASURES_RANGE_RATE) {
            reference_add_range_rate(r, m, seen, &rate);
            if (which == STEADY && model->calm_s > 0.0f) {
                reference_update_calm(r, model, &rate);
            }
            wide_update(m, &rate);
        }
        if (opens) {
            double noise[3][3];

            reference_plot_noise(seen, noise);
            m->x[2] = seen->plot->z_m;
            m->p[2][2] = noise[2][2];
            m->p[5][5] = pow(model->speed_sigma_mps, 2);
            m->p[8][8] = which == MANOEUVRE ? pow(model->accel_sigma_mps2, 2) : 0.0;
        }
    }
    r->has_z = r->has_z || opens;
    r->probability = manoeuvre_probability;
    r->unseen_s = 0.0;
}

/*
 * Updates with a bearing, in metres across the line of sight; the linearisation error counts as
 * noise. Returns the log density a radian over both models.
 */
static inline double reference_update_bearing_and_log_density(struct reference *r, double x,
                                                              double y, double bearing,
                                                              double sigma)
{
    struct wide_rows z[2] = {{.num = 1}, {.num = 1}};
    struct reference_match match;
    double log_density[2], distance2;

    for (int which = 0; which < 2; ++which) {
        const struct wide_model *m = &r->models[which];
        const double dx = m->x[0] - x, dy = m->x[1] - y, range = hypot(dx, dy);
        const double ux = dx / range, uy = dy / range;
        const double along =
            ux * ux * m->p[0][0] + 2.0 * ux * uy * m->p[0][1] + uy * uy * m->p[1][1];
        const double across =
            uy * uy * m->p[0][0] - 2.0 * ux * uy * m->p[0][1] + ux * ux * m->p[1][1];
        const double both = ux * uy * (m->p[1][1] - m->p[0][0]) + (ux * ux - uy * uy) * m->p[0][1];

        z[which].h[0][0] = -uy;
        z[which].h[0][1] = ux;
        z[which].y[0] = range * remainder(bearing - atan2(dy, dx), 6.283185307179586);
        z[which].r[0][0] = pow(sigma * range, 2) + (across * along + both * both) / (range * range);
        log_density[which] = wide_log_density(m, &z[which], &distance2) + log(range);
    }
    reference_combine_densities(r->probability, log_density, &match);
    wide_update(&r->models[0], &z[0]);
    wide_update(&r->models[1], &z[1]);
    r->is_apart = 0;
    r->probability = match.probability;
    return match.log_likelihood;
}

/* ---- comparison ------------------------------------------------------------------------------ */

/* A reference with the library's present estimate, to compare the next step alone. */
static inline struct reference reference_of(const struct rho_imm *imm)
{
    struct reference r = {.probability = imm->probability,
                          .calm = imm->calm,
                          .unseen_s = 1e-3 * imm->unseen_ms,
                          .has_rates = imm->has_rates,
                          .has_z = imm->covariance[RHO_AT(2, 2)] > 0.0f,
                          .is_apart = !imm->is_coupled};

    for (int i = 0; i < WIDE; ++i) {
        r.models[MANOEUVRE].x[i] = imm->state[i];
        r.models[STEADY].x[i] = i < 6 ? imm->steady.state[i] : 0.0;
        for (int j = 0; j < WIDE; ++j) {
            r.models[MANOEUVRE].p[i][j] = imm->covariance[RHO_AT(i, j)];
            r.models[STEADY].p[i][j] = i < 6 && j < 6 ? imm->steady.covariance[RHO_AT(i, j)] : 0.0;
        }
    }
    return r;
}

/* Largest differences between library and reference seen so far. */
struct reference_worst {
    double state;      /* in sigmas, beyond the relative rounding of a state */
    double covariance; /* in products of two sigmas */
    double probability, log_likelihood, distance2, calm;
};

#define REFERENCE_ROUNDING 5e-7 /* relative rounding of a state: eight units of float */

/*
 * Differences are in sigmas of `before` or of `m`, the larger ones, as rounding errors are
 * proportional to the larger estimate.
 */
static inline void reference_compare_model(const float *state, const float *covariance, int num,
                                           const struct wide_model *m,
                                           const struct wide_model *before,
                                           struct reference_worst *worst)
{
    double sigma[WIDE];

    for (int i = 0; i < num; ++i) {
        const double off = fabs(state[i] - m->x[i]) - REFERENCE_ROUNDING * fabs(m->x[i]);

        sigma[i] = sqrt(fmax(m->p[i][i], before->p[i][i]));
        if (!(sigma[i] > 0.0)) {
            assert_true(state[i] == 0.0f && covariance[RHO_AT(i, i)] == 0.0f);
            continue;
        }
        worst->state = fmax(worst->state, off / sigma[i]);
        for (int j = 0; j <= i; ++j) {
            const double scale = sigma[i] * sigma[j];

            if (scale > 0.0) {
                worst->covariance =
                    fmax(worst->covariance, fabs(covariance[RHO_AT(i, j)] - m->p[i][j]) / scale);
            } else {
                assert_true(covariance[RHO_AT(i, j)] == 0.0f);
            }
        }
    }
}

/* Compares both models one step after `before`. */
static inline void reference_compare(const struct rho_imm *imm, const struct reference *r,
                                     const struct reference *before, struct reference_worst *worst)
{
    reference_compare_model(imm->steady.state, imm->steady.covariance, 6, &r->models[STEADY],
                            &before->models[STEADY], worst);
    reference_compare_model(imm->state, imm->covariance, WIDE, &r->models[MANOEUVRE],
                            &before->models[MANOEUVRE], worst);
    worst->probability = fmax(worst->probability, fabs(imm->probability - r->probability));
    worst->calm = fmax(worst->calm, fabs(imm->calm - r->calm));
    assert_true(isfinite(worst->state) && isfinite(worst->covariance) &&
                isfinite(worst->probability) && isfinite(worst->calm));
}

/* Compares the mean over both models, and its acceleration. */
static inline void reference_compare_mean(const struct rho_imm *imm, const struct reference *r,
                                          struct reference_worst *worst)
{
    const double share[2] = {1.0 - r->probability, r->probability};
    const struct wide_model mean = reference_mixed_model(r->models, share);
    struct rho_kalman estimate;
    float accel_mps2[3];

    rho_imm_estimate(imm, &estimate, accel_mps2);
    reference_compare_model(estimate.state, estimate.covariance, 6, &mean, &mean, worst);
    for (int i = 0; i < 3; ++i) {
        if (mean.p[6 + i][6 + i] > 0.0) {
            worst->state = fmax(worst->state,
                                fabs(accel_mps2[i] - mean.x[6 + i]) / sqrt(mean.p[6 + i][6 + i]));
        } else {
            assert_true(accel_mps2[i] == 0.0f);
        }
    }
    worst->probability = fmax(worst->probability, fabs(imm->probability - r->probability));
    worst->calm = fmax(worst->calm, fabs(imm->calm - r->calm));
    assert_true(isfinite(worst->state) && isfinite(worst->covariance) &&
                isfinite(worst->probability) && isfinite(worst->calm));
}

#endif
