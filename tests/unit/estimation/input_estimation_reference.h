/* SPDX-License-Identifier: MIT */
/*
 * Two references of input estimation in double precision, independent of each other: `augmented` is
 * a Kalman filter with the input as three more states, constant and unknown; `two_stage` is the
 * paper's method, a filter without input, sensitivities and recursive least squares.
 */
#ifndef RHOTRACK_TESTS_INPUT_ESTIMATION_REFERENCE_H
#define RHOTRACK_TESTS_INPUT_ESTIMATION_REFERENCE_H

#include <math.h>
#include <string.h>

#define REF_STATES 6
#define REF_INPUTS 3
#define REF_ALL 9
#define REF_ROWS 6

struct ref_setting {
    int is_physical;
    double dt, v0, gamma, threshold;
    double density, q_position, q_velocity; /* variances added a step */
};

/* Measurements values[i] of rows[i] . x with noise covariance r. */
struct ref_measured {
    int num;
    double rows[REF_ROWS][REF_STATES], values[REF_ROWS], r[REF_ROWS][REF_ROWS];
};

struct ref_augmented {
    double x[REF_ALL], p[REF_ALL][REF_ALL];
    int present; /* one bit an axis: the input is present */
};

struct ref_two_stage {
    double x[REF_STATES], p[REF_STATES][REF_STATES];
    double m[REF_STATES][REF_INPUTS], u[REF_INPUTS], v[REF_INPUTS][REF_INPUTS];
    int present;
};

/* --- matrices of up to 9 x 9 ---------------------------------------------------------------- */

typedef double ref_matrix[REF_ALL][REF_ALL];

/* Computes c := a b, or a b^T. */
static inline void ref_product(int n, int k, int m, ref_matrix a, ref_matrix b, int transpose,
                               ref_matrix c)
{
    ref_matrix result = {{0.0}};

    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < m; ++j) {
            for (int l = 0; l < k; ++l) {
                result[i][j] += a[i][l] * (transpose ? b[j][l] : b[l][j]);
            }
        }
    }
    memcpy(c, result, sizeof result);
}

/* Inverts by Gauss-Jordan without pivoting, as a is positive definite. */
static inline void ref_invert(int n, ref_matrix a)
{
    for (int k = 0; k < n; ++k) {
        const double pivot = a[k][k];

        a[k][k] = 1.0;
        for (int j = 0; j < n; ++j) {
            a[k][j] /= pivot;
        }
        for (int i = 0; i < n; ++i) {
            const double factor = a[i][k];

            if (i != k) {
                a[i][k] = 0.0;
                for (int j = 0; j < n; ++j) {
                    a[i][j] -= factor * a[k][j];
                }
            }
        }
    }
}

static inline void ref_symmetrise(int n, ref_matrix a)
{
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < i; ++j) {
            a[i][j] = a[j][i] = 0.5 * (a[i][j] + a[j][i]);
        }
    }
}

/* Transition matrix of 6 states, or of 9 with the input. */
static inline void ref_transition(const struct ref_setting *s, int num, ref_matrix f)
{
    memset(f, 0, sizeof(ref_matrix));
    for (int i = 0; i < num; ++i) {
        f[i][i] = 1.0;
    }
    for (int axis = 0; axis < 3; ++axis) {
        f[axis][axis + 3] = s->dt;
        if (num == REF_ALL) {
            f[axis][axis + 6] = s->is_physical ? s->dt * s->dt / 2.0 : 0.0;
            f[axis + 3][axis + 6] = s->dt;
        }
    }
}

static inline void ref_add_noise(const struct ref_setting *s, ref_matrix p)
{
    for (int axis = 0; axis < 3; ++axis) {
        p[axis][axis] += s->density * pow(s->dt, 3) / 3.0 + s->q_position;
        p[axis][axis + 3] += s->density * s->dt * s->dt / 2.0;
        p[axis + 3][axis] += s->density * s->dt * s->dt / 2.0;
        p[axis + 3][axis + 3] += s->density * s->dt + s->q_velocity;
    }
}

/*
 * Vector update of n states; also returns the gain, the innovation and the inverse of its
 * covariance.
 */
static inline void ref_update(int n, double *x, ref_matrix p, const struct ref_measured *z,
                              ref_matrix gain, ref_matrix inverse, double innovation[REF_ROWS])
{
    ref_matrix h = {{0.0}}, ph, rest;

    for (int a = 0; a < z->num; ++a) {
        innovation[a] = z->values[a];
        for (int i = 0; i < REF_STATES; ++i) {
            h[a][i] = z->rows[a][i];
            innovation[a] -= z->rows[a][i] * x[i];
        }
    }
    ref_product(n, n, z->num, p, h, 1, ph);
    ref_product(z->num, n, z->num, h, ph, 0, inverse);
    for (int a = 0; a < z->num; ++a) {
        for (int b = 0; b < z->num; ++b) {
            inverse[a][b] += z->r[a][b];
        }
    }
    ref_invert(z->num, inverse);
    ref_product(n, z->num, z->num, ph, inverse, 0, gain);
    ref_product(n, z->num, n, gain, ph, 1, rest);
    for (int i = 0; i < n; ++i) {
        for (int a = 0; a < z->num; ++a) {
            x[i] += gain[i][a] * innovation[a];
        }
        for (int j = 0; j < n; ++j) {
            p[i][j] -= rest[i][j];
        }
    }
    ref_symmetrise(n, p);
}

/* --- augmented filter ------------------------------------------------------------------------ */

static inline void ref_augmented_forget_axis(struct ref_augmented *a, int axis, double v0)
{
    for (int i = 0; i < REF_ALL; ++i) {
        a->p[i][6 + axis] = a->p[6 + axis][i] = 0.0;
    }
    a->x[6 + axis] = 0.0;
    a->p[6 + axis][6 + axis] = v0;
}

static inline void ref_augmented_start(struct ref_augmented *a, const double x[6],
                                       double position_variance, double velocity_variance,
                                       double v0)
{
    memset(a, 0, sizeof *a);
    for (int i = 0; i < 6; ++i) {
        a->x[i] = x[i];
        a->p[i][i] = i < 3 ? position_variance : velocity_variance;
    }
    for (int axis = 0; axis < 3; ++axis) {
        ref_augmented_forget_axis(a, axis, v0);
    }
}

/*
 * Widens the input's covariance V by 1 / gamma. The sensitivity M = cov(x, u) V^-1 and the
 * covariance B without input stay: p = [B + M V M^T, M V; V M^T, V].
 */
static inline void ref_augmented_divide_input_covariance_by_gamma(struct ref_augmented *a,
                                                                  const struct ref_setting *s)
{
    ref_matrix v = {{0.0}}, c = {{0.0}}, m, taken, factor = {{0.0}};

    for (int i = 0; i < 3; ++i) {
        const double before = a->p[6 + i][6 + i];
        factor[i][i] = a->present >> i & 1 ? sqrt(fmin(before / s->gamma, s->v0) / before) : 1.0;
        for (int j = 0; j < 3; ++j) {
            v[i][j] = a->p[6 + i][6 + j];
        }
        for (int j = 0; j < 6; ++j) {
            c[j][i] = a->p[j][6 + i];
        }
    }
    ref_matrix inverse;
    memcpy(inverse, v, sizeof v);
    ref_invert(3, inverse);
    ref_product(6, 3, 3, c, inverse, 0, m);
    ref_product(6, 3, 6, m, c, 1, taken);
    ref_product(3, 3, 3, factor, v, 0, v);
    ref_product(3, 3, 3, v, factor, 0, v);
    ref_product(6, 3, 3, m, v, 0, c);
    ref_matrix given;
    ref_product(6, 3, 6, m, c, 1, given);
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) {
            a->p[i][j] += given[i][j] - taken[i][j];
        }
        for (int j = 0; j < 3; ++j) {
            a->p[i][6 + j] = a->p[6 + j][i] = c[i][j];
        }
    }
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            a->p[6 + i][6 + j] = v[i][j];
        }
    }
}

static inline void ref_augmented_predict(struct ref_augmented *a, const struct ref_setting *s)
{
    ref_matrix f, half;
    double x[REF_ALL] = {0.0};

    if (s->gamma < 1.0) {
        ref_augmented_divide_input_covariance_by_gamma(a, s);
    }
    ref_transition(s, REF_ALL, f);
    ref_product(REF_ALL, REF_ALL, REF_ALL, f, a->p, 0, half);
    ref_product(REF_ALL, REF_ALL, REF_ALL, half, f, 1, a->p);
    for (int i = 0; i < REF_ALL; ++i) {
        for (int j = 0; j < REF_ALL; ++j) {
            x[i] += f[i][j] * a->x[j];
        }
    }
    memcpy(a->x, x, sizeof x);
    ref_add_noise(s, a->p);
}

static inline void ref_augmented_update(struct ref_augmented *a, const struct ref_measured *z)
{
    ref_matrix gain, inverse;
    double innovation[REF_ROWS];

    ref_update(REF_ALL, a->x, a->p, z, gain, inverse, innovation);
}

/* Removes an input's effect: an update with a noiseless measurement that it was 0. */
static inline void ref_augmented_remove_input(struct ref_augmented *a, int k)
{
    double column[REF_ALL];
    const double pivot = a->p[k][k], value = a->x[k];

    for (int i = 0; i < REF_ALL; ++i) {
        column[i] = a->p[i][k];
    }
    for (int i = 0; i < REF_ALL; ++i) {
        a->x[i] -= column[i] / pivot * value;
        for (int j = 0; j < REF_ALL; ++j) {
            a->p[i][j] -= column[i] * column[j] / pivot;
        }
    }
}

/*
 * Drops inputs below the threshold, the least significant first. Returns how many sigmas the
 * closest decision was from the threshold.
 */
static inline double ref_augmented_drop_inputs_and_margin_sigmas(struct ref_augmented *a,
                                                                 const struct ref_setting *s)
{
    double margin = 1e9;
    int left = 7;

    while (left) {
        int weakest = -1;
        double least = 0.0;

        for (int axis = 0; axis < 3; ++axis) {
            const double sigmas = fabs(a->x[6 + axis]) / sqrt(a->p[6 + axis][6 + axis]);

            if (left >> axis & 1 && (weakest < 0 || sigmas < least)) {
                weakest = axis;
                least = sigmas;
            }
        }
        margin = fmin(margin, fabs(least - s->threshold));
        if (least > s->threshold) {
            break;
        }
        if (!(a->present >> weakest & 1)) {
            ref_augmented_remove_input(a, 6 + weakest);
        }
        ref_augmented_forget_axis(a, weakest, s->v0);
        left &= ~(1 << weakest);
    }
    a->present = left;
    return margin;
}

/* --- the paper's two stages ------------------------------------------------------------------ */

static inline void ref_two_stage_start(struct ref_two_stage *t, const double x[6],
                                       double position_variance, double velocity_variance,
                                       double v0)
{
    memset(t, 0, sizeof *t);
    for (int i = 0; i < 6; ++i) {
        t->x[i] = x[i];
        t->p[i][i] = i < 3 ? position_variance : velocity_variance;
    }
    for (int axis = 0; axis < 3; ++axis) {
        t->v[axis][axis] = v0;
    }
}

static inline void ref_two_stage_predict(struct ref_two_stage *t, const struct ref_setting *s)
{
    ref_matrix f, p = {{0.0}}, m = {{0.0}};
    double x[6] = {0.0};

    ref_transition(s, 6, f);
    for (int i = 0; i < 6; ++i) {
        memcpy(p[i], t->p[i], sizeof t->p[i]);
        memcpy(m[i], t->m[i], sizeof t->m[i]);
    }
    ref_product(6, 6, 6, f, p, 0, p);
    ref_product(6, 6, 6, p, f, 1, p);
    ref_product(6, 6, 3, f, m, 0, m);
    ref_add_noise(s, p);
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) {
            x[i] += f[i][j] * t->x[j];
        }
        memcpy(t->p[i], p[i], sizeof t->p[i]);
        memcpy(t->m[i], m[i], sizeof t->m[i]);
    }
    memcpy(t->x, x, sizeof x);
    for (int axis = 0; axis < 3; ++axis) {
        t->m[axis][axis] += s->is_physical ? s->dt * s->dt / 2.0 : 0.0;
        t->m[axis + 3][axis] += s->dt;
    }
}

/*
 * Equations (11) to (13) with n = h m: v := v - v n' (n v n' + s)^-1 n v, u := u + v n' s^-1
 * (innovation - n u).
 */
static inline void ref_two_stage_estimate_input(struct ref_two_stage *t, int num, ref_matrix n,
                                                ref_matrix inverse, const double innovation[])
{
    ref_matrix v = {{0.0}}, nv, total, s, gain, taken, back = {{0.0}};

    for (int i = 0; i < 3; ++i) {
        memcpy(v[i], t->v[i], sizeof t->v[i]);
        for (int a = 0; a < num; ++a) {
            back[i][a] = n[a][i];
        }
    }
    memcpy(s, inverse, sizeof s);
    ref_invert(num, s);
    ref_product(num, 3, 3, n, v, 0, nv);
    ref_product(num, 3, num, nv, n, 1, total);
    for (int a = 0; a < num; ++a) {
        for (int b = 0; b < num; ++b) {
            total[a][b] += s[a][b];
        }
    }
    ref_invert(num, total);
    ref_product(num, num, 3, total, nv, 0, taken);
    ref_product(3, num, 3, back, taken, 0, taken);
    ref_product(3, 3, 3, v, taken, 0, taken);
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            v[i][j] -= taken[i][j];
        }
    }
    ref_symmetrise(3, v);
    ref_product(3, 3, num, v, back, 0, gain);
    ref_product(3, num, num, gain, inverse, 0, gain);
    double u[3];
    memcpy(u, t->u, sizeof u);
    for (int i = 0; i < 3; ++i) {
        for (int a = 0; a < num; ++a) {
            t->u[i] +=
                gain[i][a] * (innovation[a] - n[a][0] * u[0] - n[a][1] * u[1] - n[a][2] * u[2]);
        }
        memcpy(t->v[i], v[i], sizeof t->v[i]);
    }
}

static inline void ref_two_stage_update(struct ref_two_stage *t, const struct ref_measured *z)
{
    ref_matrix p = {{0.0}}, m = {{0.0}}, h = {{0.0}}, n, gain, inverse, taken;
    double innovation[REF_ROWS];

    for (int i = 0; i < 6; ++i) {
        memcpy(p[i], t->p[i], sizeof t->p[i]);
        memcpy(m[i], t->m[i], sizeof t->m[i]);
    }
    for (int a = 0; a < z->num; ++a) {
        memcpy(h[a], z->rows[a], sizeof z->rows[a]);
    }
    ref_product(z->num, 6, 3, h, m, 0, n);
    ref_update(6, t->x, p, z, gain, inverse, innovation);
    ref_product(6, z->num, 3, gain, n, 0, taken);
    for (int i = 0; i < 6; ++i) {
        memcpy(t->p[i], p[i], sizeof t->p[i]);
        for (int j = 0; j < 3; ++j) {
            t->m[i][j] -= taken[i][j];
        }
    }
    ref_two_stage_estimate_input(t, z->num, n, inverse, innovation);
}

/* The estimate with input, equations (14) to (18): x + M u, P + M V M^T. */
static inline void ref_two_stage_correct(const struct ref_two_stage *t, double x[6], double p[6][6])
{
    for (int i = 0; i < 6; ++i) {
        x[i] = t->x[i];
        for (int a = 0; a < 3; ++a) {
            x[i] += t->m[i][a] * t->u[a];
        }
        for (int j = 0; j < 6; ++j) {
            p[i][j] = t->p[i][j];
            for (int a = 0; a < 3; ++a) {
                for (int b = 0; b < 3; ++b) {
                    p[i][j] += t->m[i][a] * t->v[a][b] * t->m[j][b];
                }
            }
        }
    }
}

#endif
