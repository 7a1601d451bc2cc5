/* SPDX-License-Identifier: MIT */
/*
 * The references in double precision of targets that manoeuvre: full matrices against filters of
 * one axis at a time, written here; several models against one.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "base/random.h"
#include "double_imm.h"

#define SEED 4711
#define STEPS 60
#define T_S 0.25
#define KEEP 0.98
#define STEP_MPS2 40.0
#define STEADY_MPS2 2.0
#define STAY 0.97

static void assert_near(double value, double expected, double most)
{
    if (!(fabs(value - expected) <= most)) {
        fail_msg("%.12g, expected %.12g +- %.3g", value, expected, most);
    }
}

/* ---- one axis at a time ---------------------------------------------------------------------- */

/* Place, velocity, acceleration. */
struct axis {
    double x[3], p[3][3];
};

static void axis_predict(struct axis *axis, const double f[3][3], const double g[3], double sigma)
{
    struct axis old = *axis;
    for (int i = 0; i < 3; i++) {
        axis->x[i] = 0.0;
        for (int j = 0; j < 3; j++) {
            axis->x[i] += f[i][j] * old.x[j];
            axis->p[i][j] = g[i] * g[j] * sigma * sigma;
            for (int k = 0; k < 3; k++) {
                for (int l = 0; l < 3; l++) {
                    axis->p[i][j] += f[i][k] * old.p[k][l] * f[j][l];
                }
            }
        }
    }
}

/*
 * Scalar by scalar: element 0, then 1 where there are two. Returns -2 ln of the density, without
 * constants.
 */
static double axis_update(struct axis *axis, const double z[2], const double r[2], int count)
{
    double minus_2_log = 0.0;
    for (int m = 0; m < count; m++) {
        double s = axis->p[m][m] + r[m], off = z[m] - axis->x[m];
        struct axis old = *axis;
        minus_2_log += off * off / s + log(s);
        for (int i = 0; i < 3; i++) {
            axis->x[i] += old.p[i][m] / s * off;
            for (int j = 0; j < 3; j++) {
                axis->p[i][j] -= old.p[i][m] * old.p[m][j] / s;
            }
        }
    }
    return minus_2_log;
}

static const double steady_f[3][3] = {{1, T_S, 0}, {0, 1, 0}, {0, 0, 0}};
static const double singer_f[3][3] = {{1, T_S, T_S *T_S / 2}, {0, 1, T_S}, {0, 0, KEEP}};
static const double accel_g[3] = {T_S * T_S / 2, T_S, 0}, step_g[3] = {T_S * T_S / 2, T_S, 1};
static const double input[2] = {T_S * T_S / 2, T_S};

/* ---- measurements ---------------------------------------------------------------------------- */

#define SIGMA_M 10.0
#define SIGMA_MPS 3.0

/* Around a path that turns after 7 s; every fifth is missing. */
static struct double_measured measured_at(int step, size_t size, struct random *random)
{
    double t_s = step * T_S, late_s = fmax(0.0, t_s - 7.0);
    struct double_measured measured = {.size = size};
    double truth[6] = {3e4 - 600 * t_s + 40 * late_s * late_s,
                       2e4 - 500 * t_s,
                       300 + 20 * late_s * late_s,
                       -600 + 80 * late_s,
                       -500,
                       40 * late_s};
    for (int i = 0; i < 6; i++) {
        double sigma = i < 3 ? SIGMA_M : SIGMA_MPS;
        measured.value[i] = truth[i] + sigma * random_normal(random);
        measured.covariance[i][i] = sigma * sigma;
    }
    return measured;
}

static bool is_missing(int step)
{
    return step % 5 == 4;
}

static struct double_gaussian start_at(const struct double_measured *measured)
{
    struct double_gaussian start = {.mean = {0.0}};
    for (size_t i = 0; i < 3; i++) {
        start.mean[i] = measured->value[i];
        start.mean[i + 3] = measured->value[i + 3];
        start.covariance.at[i][i] = SIGMA_M * SIGMA_M;
        start.covariance.at[i + 3][i + 3] = 400.0;
        start.covariance.at[i + 6][i + 6] = 1e4;
    }
    return start;
}

static struct axis axis_of(const struct double_gaussian *gaussian, int of)
{
    struct axis axis;
    for (int i = 0; i < 3; i++) {
        axis.x[i] = gaussian->mean[of + 3 * i];
        for (int j = 0; j < 3; j++) {
            axis.p[i][j] = gaussian->covariance.at[of + 3 * i][of + 3 * j];
        }
    }
    return axis;
}

/* Means to 1e-7, covariances to 1e-9 of themselves; nothing between axes. */
static void assert_same(const struct double_gaussian *gaussian, const struct axis axes[3])
{
    for (int i = 0; i < DOUBLE_STATES; i++) {
        assert_near(gaussian->mean[i], axes[i % 3].x[i / 3], 1e-7);
        for (int j = 0; j < DOUBLE_STATES; j++) {
            double expected = i % 3 == j % 3 ? axes[i % 3].p[i / 3][j / 3] : 0.0;
            double scale = sqrt(axes[i % 3].p[i / 3][i / 3] * axes[j % 3].p[j / 3][j / 3]);
            assert_near(gaussian->covariance.at[i][j], expected, 1e-9 * (scale + 1e-3));
        }
    }
}

/* ---- one filter ------------------------------------------------------------------------------ */

static void filter_beside_axes(size_t size, const double f[3][3], const double g[3], double sigma,
                               const struct double_model *model)
{
    struct random random = random_start(SEED, 1, size);
    struct double_measured measured = measured_at(0, size, &random);
    struct double_gaussian track = start_at(&measured);
    struct axis axes[3] = {axis_of(&track, 0), axis_of(&track, 1), axis_of(&track, 2)};
    for (int step = 1; step < STEPS; step++) {
        double distance2, log_det, expected = 0.0;
        measured = measured_at(step, size, &random);
        double_gaussian_predict(&track, model, NULL);
        distance2 = double_gaussian_distance2(&track, &measured, &log_det);
        for (int i = 0; i < 3; i++) {
            double z[2] = {measured.value[i], measured.value[i + 3]};
            double r[2] = {SIGMA_M * SIGMA_M, SIGMA_MPS * SIGMA_MPS};
            axis_predict(&axes[i], f, g, sigma);
            struct axis tried = axes[i];
            expected += axis_update(&tried, z, r, size == 6 ? 2 : 1);
            axes[i] = is_missing(step) ? axes[i] : tried;
        }
        assert_near(distance2 + log_det, expected, 1e-9 * (1.0 + fabs(expected)));
        if (!is_missing(step)) {
            double_gaussian_update(&track, &measured);
        }
        assert_same(&track, (const struct axis *)axes);
    }
}

static void full_matrices_are_three_axes(void **state)
{
    (void)state;
    struct double_model steady = double_model_steady(T_S, input, STEADY_MPS2);
    struct double_model singer = double_model_singer(T_S, KEEP, STEP_MPS2);
    for (size_t size = 3; size <= 6; size += 3) {
        filter_beside_axes(size, steady_f, accel_g, STEADY_MPS2, &steady);
        filter_beside_axes(size, singer_f, step_g, STEP_MPS2, &singer);
    }
}

static void noise_of_its_own_is_added_to_each_element(void **state)
{
    (void)state;
    struct double_model model = double_model_noisy(T_S, 4.0, 9.0);
    struct double_gaussian track = {.mean = {0.0}};
    double_gaussian_predict(&track, &model, NULL);
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) {
            assert_near(track.covariance.at[i][j], i != j ? 0.0 : i < 3 ? 4.0 : 9.0, 0.0);
        }
    }
}

static void a_known_input_shifts_the_mean_alone(void **state)
{
    (void)state;
    struct double_model model = double_model_steady(T_S, input, STEADY_MPS2);
    struct random random = random_start(SEED, 2, 0);
    struct double_measured measured = measured_at(0, 3, &random);
    struct double_gaussian with = start_at(&measured), without = with;
    double shift[DOUBLE_STATES] = {1.0, -2.0, 3.0, 4.0, 5.0, -6.0};
    double_gaussian_predict(&with, &model, shift);
    double_gaussian_predict(&without, &model, NULL);
    for (int i = 0; i < DOUBLE_STATES; i++) {
        assert_near(with.mean[i] - without.mean[i], shift[i], 1e-9);
    }
    assert_memory_equal(&with.covariance, &without.covariance, sizeof with.covariance);
}

/* Noise that couples axes: turned by an angle, the update turns with it. */
static void coupled_noise_turns_with_its_frame(void **state)
{
    (void)state;
    double c = cos(0.7), s = sin(0.7), along = 15.0 * 15.0, across = 180.0 * 180.0;
    struct double_measured straight = {.size = 2, .value = {100.0, -250.0}};
    straight.covariance[0][0] = along;
    straight.covariance[1][1] = across;
    struct double_measured turned = {.size = 2,
                                     .value = {c * 100.0 + s * 250.0, s * 100.0 - c * 250.0}};
    turned.covariance[0][0] = c * c * along + s * s * across;
    turned.covariance[1][1] = s * s * along + c * c * across;
    turned.covariance[0][1] = turned.covariance[1][0] = c * s * (along - across);
    struct double_gaussian a = {.mean = {0.0}}, b;
    for (int i = 0; i < 3; i++) {
        a.covariance.at[i][i] = 1e4;
        a.covariance.at[i + 3][i + 3] = 1e2;
        a.covariance.at[i][i + 3] = a.covariance.at[i + 3][i] = 500.0;
    }
    b = a;
    assert_near(double_gaussian_distance2(&b, &turned, NULL),
                double_gaussian_distance2(&a, &straight, NULL), 1e-9);
    double_gaussian_update(&a, &straight);
    double_gaussian_update(&b, &turned);
    for (int i = 0; i < 6; i += 3) {
        assert_near(b.mean[i], c * a.mean[i] - s * a.mean[i + 1], 1e-9);
        assert_near(b.mean[i + 1], s * a.mean[i] + c * a.mean[i + 1], 1e-9);
    }
    assert_near(a.mean[0], 100.0 * 1e4 / (1e4 + along), 1e-9);
    assert_near(a.mean[4], -250.0 * 500.0 / (1e4 + across), 1e-9);
}

/* ---- several --------------------------------------------------------------------------------- */

static struct double_imm imm_of(void)
{
    return (struct double_imm){.num_models = 2,
                               .stay = STAY,
                               .model = {double_model_steady(T_S, input, STEADY_MPS2),
                                         double_model_singer(T_S, KEEP, STEP_MPS2)}};
}

static void one_model_is_its_filter(void **state)
{
    (void)state;
    struct random random = random_start(SEED, 3, 0);
    struct double_measured measured = measured_at(0, 6, &random);
    struct double_gaussian track = start_at(&measured), estimate;
    struct double_imm one = {.num_models = 1, .model = {double_model_singer(T_S, KEEP, STEP_MPS2)}};
    double_imm_start(&one, &track);
    for (int step = 1; step < STEPS; step++) {
        measured = measured_at(step, 6, &random);
        double_imm_predict(&one);
        double_gaussian_predict(&track, &one.model[0], NULL);
        if (!is_missing(step)) {
            double_imm_update(&one, &measured);
            double_gaussian_update(&track, &measured);
        }
        double_imm_estimate(&one, &estimate);
        assert_memory_equal(estimate.mean, track.mean, sizeof track.mean);
        assert_near(one.probability[0], 1.0, 0.0);
    }
}

static void two_equal_models_are_one(void **state)
{
    (void)state;
    struct random random = random_start(SEED, 4, 0);
    struct double_measured measured = measured_at(0, 3, &random);
    struct double_gaussian track = start_at(&measured), estimate;
    struct double_imm two = imm_of();
    two.model[0] = two.model[1];
    double_imm_start(&two, &track);
    for (int step = 1; step < STEPS; step++) {
        measured = measured_at(step, 3, &random);
        double_imm_predict(&two);
        double_imm_update(&two, &measured);
        double_gaussian_predict(&track, &two.model[0], NULL);
        double_gaussian_update(&track, &measured);
        double_imm_estimate(&two, &estimate);
        for (int i = 0; i < DOUBLE_STATES; i++) {
            assert_near(estimate.mean[i], track.mean[i], 1e-7);
        }
        assert_near(two.probability[0], 0.5, 1e-9);
    }
}

/* The same estimator of one axis. */
struct axis_imm {
    struct axis mode[2];
    double mu[2];
};

static void mix_axis(struct axis_imm *imm, const double weight[2][2])
{
    struct axis old[2] = {imm->mode[0], imm->mode[1]};
    for (int to = 0; to < 2; to++) {
        struct axis *mixed = &imm->mode[to];
        double a = weight[0][to], b = weight[1][to];
        for (int i = 0; i < 3; i++) {
            mixed->x[i] = a * old[0].x[i] + b * old[1].x[i];
            for (int j = 0; j < 3; j++) {
                mixed->p[i][j] = a * old[0].p[i][j] + b * old[1].p[i][j] +
                                 a * b * (old[0].x[i] - old[1].x[i]) * (old[0].x[j] - old[1].x[j]);
            }
        }
    }
}

static void axis_step(struct axis_imm *imm, double z_m, bool is_seen)
{
    double c[2], weight[2][2], minus_2_log[2] = {0.0, 0.0};
    double z[2] = {z_m, 0.0}, r[2] = {SIGMA_M * SIGMA_M, 0.0};
    for (int to = 0; to < 2; to++) {
        c[to] = STAY * imm->mu[to] + (1.0 - STAY) * imm->mu[1 - to];
        weight[to][to] = STAY * imm->mu[to] / c[to];
        weight[1 - to][to] = 1.0 - weight[to][to];
    }
    mix_axis(imm, (const double(*)[2])weight);
    axis_predict(&imm->mode[0], steady_f, accel_g, STEADY_MPS2);
    axis_predict(&imm->mode[1], singer_f, step_g, STEP_MPS2);
    for (int m = 0; m < 2 && is_seen; m++) {
        minus_2_log[m] = axis_update(&imm->mode[m], z, r, 1);
    }
    double odds = c[1] / c[0] * exp((minus_2_log[0] - minus_2_log[1]) / 2.0);
    imm->mu[0] = 1.0 / (1.0 + odds);
    imm->mu[1] = 1.0 - imm->mu[0];
}

/* Where x alone is measured, the other axes are the same in both modes: nothing couples them. */
static void two_models_are_mixed_and_weighed(void **state)
{
    (void)state;
    struct random random = random_start(SEED, 5, 0);
    struct double_measured measured = measured_at(0, 1, &random);
    struct double_gaussian start = start_at(&measured), estimate;
    struct double_imm imm = imm_of();
    struct axis_imm axis = {.mode = {axis_of(&start, 0), axis_of(&start, 0)}, .mu = {0.5, 0.5}};
    double least = 1.0, most = 0.0;
    axis.mode[0].p[2][2] = 0.0;
    double_imm_start(&imm, &start);
    for (int step = 1; step < STEPS; step++) {
        measured = measured_at(step, 1, &random);
        double_imm_predict(&imm);
        if (!is_missing(step)) {
            double_imm_update(&imm, &measured);
        }
        axis_step(&axis, measured.value[0], !is_missing(step));
        assert_near(imm.probability[0], axis.mu[0], 1e-9);
        double_imm_estimate(&imm, &estimate);
        for (int i = 0; i < 3; i++) {
            assert_near(estimate.mean[3 * i],
                        axis.mu[0] * axis.mode[0].x[i] + axis.mu[1] * axis.mode[1].x[i], 1e-7);
        }
        least = fmin(least, axis.mu[0]);
        most = fmax(most, axis.mu[0]);
    }
    assert_true(least < 0.2 && most > 0.6); /* both had their turns */
}

static void turn(double v[3])
{
    double c = cos(0.7), s = sin(0.7), x = v[0];
    v[0] = c * x - s * v[1];
    v[1] = s * x + c * v[1];
}

/* Isotropic noise: what the modes' spread does between axes does not depend on where they point. */
static void a_turned_frame_gives_the_same_tracks(void **state)
{
    (void)state;
    struct random random = random_start(SEED, 6, 0);
    struct double_measured measured = measured_at(0, 3, &random);
    struct double_gaussian start = start_at(&measured), estimate, turned_estimate;
    struct double_imm imm = imm_of(), turned = imm_of();
    double_imm_start(&imm, &start);
    turn(start.mean);
    turn(start.mean + 3);
    double_imm_start(&turned, &start);
    for (int step = 1; step < STEPS; step++) {
        measured = measured_at(step, 3, &random);
        double_imm_predict(&imm);
        double_imm_update(&imm, &measured);
        turn(measured.value);
        double_imm_predict(&turned);
        double_imm_update(&turned, &measured);
        assert_near(turned.probability[0], imm.probability[0], 1e-9);
        double_imm_estimate(&imm, &estimate);
        double_imm_estimate(&turned, &turned_estimate);
        for (int i = 0; i < DOUBLE_STATES; i += 3) {
            turn(estimate.mean + i);
            for (int j = i; j < i + 3; j++) {
                assert_near(turned_estimate.mean[j], estimate.mean[j], 1e-7);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(full_matrices_are_three_axes),
        cmocka_unit_test(noise_of_its_own_is_added_to_each_element),
        cmocka_unit_test(a_known_input_shifts_the_mean_alone),
        cmocka_unit_test(coupled_noise_turns_with_its_frame),
        cmocka_unit_test(one_model_is_its_filter),
        cmocka_unit_test(two_equal_models_are_one),
        cmocka_unit_test(two_models_are_mixed_and_weighed),
        cmocka_unit_test(a_turned_frame_gives_the_same_tracks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
