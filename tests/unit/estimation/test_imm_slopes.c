/* SPDX-License-Identifier: MIT */
/*
 * Slopes of bearings in the filter with two models, compared with full matrices in double precision
 * (imm_reference.h).
 */
#include <string.h>

#include "dense_filter.h"
#include "imm_reference.h"

#define NUM_CASES 2000
#define PI 3.14159265358979323846

/* Tolerances, in sigmas of the estimate before; largest seen: 6.7e-5, 6.5e-6. */
#define STATE_SIGMAS 3e-4
#define COVARIANCE_SIGMAS2 4e-5

static struct rho_imm_model plain_model(void)
{
    struct rho_imm_model model;

    rho_imm_model_default(&model, 30.0f, 300.0f);
    return model;
}

static struct rho_slope random_slope(void)
{
    return (struct rho_slope){.x_m = (float)floor(uniform(-3e4, 3e4)),
                              .y_m = (float)floor(uniform(-3e4, 3e4)),
                              .z_m = (float)floor(uniform(-100.0, 3000.0)),
                              .value = (float)uniform(-1.5, 1.5),
                              .sigma = (float)pow(10.0, uniform(-3.5, -1.5))};
}

/* Two models with estimates of their own, 3 to 50 km from the slope's place and near its line. */
static struct rho_imm random_imm(const struct rho_imm_model *model, const struct rho_slope *slope,
                                 int has_z)
{
    struct rho_kalman estimate;
    struct rho_imm imm;
    const double range = pow(10.0, uniform(3.5, 4.7)), direction = uniform(-PI, PI);

    random_covariance(estimate.covariance, 2.0);
    for (int i = 0; i < 6; ++i) {
        estimate.state[i] = (float)uniform(-200.0, 200.0);
    }
    estimate.state[0] = (float)((double)slope->x_m + range * cos(direction));
    estimate.state[1] = (float)((double)slope->y_m + range * sin(direction));
    estimate.state[2] = (float)((double)slope->z_m + (double)slope->value * range +
                                2.0 * (double)slope->sigma * range * normal() + 50.0 * normal());
    for (int i = 0; i < 6 && !has_z; ++i) {
        estimate.covariance[RHO_AT(2, i)] = estimate.covariance[RHO_AT(5, i)] = 0.0f;
        estimate.state[2] = estimate.state[5] = 0.0f;
    }
    rho_imm_start(&imm, model, &estimate);
    for (int k = 0; k < 2; ++k) {
        struct rho_imm_step step;

        rho_imm_prepare_step(&step, model, (float)uniform(0.5, 4.0));
        assert_int_equal(rho_imm_predict(&imm, &step), RHO_OK);
    }
    imm.probability = (float)uniform(0.05, 0.95);
    for (int i = 0; i < 2 + has_z; ++i) { /* the models differ by a fraction of a sigma */
        const double sigma = sqrt((double)imm.covariance[RHO_AT(i, i)]);

        imm.state[i] += (float)(0.3 * sigma * normal());
        imm.state[i + 6] = (float)(5.0 * normal());
    }
    return imm;
}

/* A slope in metres of height, linearised at a model's estimate. */
static struct wide_rows rows_of_slope(const struct wide_model *m, const struct rho_slope *slope)
{
    struct wide_rows z = {.num = 1};
    const double dx = m->x[0] - (double)slope->x_m, dy = m->x[1] - (double)slope->y_m;
    const double range = hypot(dx, dy), u[2] = {dx / range, dy / range};
    double along = 0.0;

    for (int i = 0; i < 2; ++i) {
        z.h[0][i] = -(double)slope->value * u[i];
        for (int j = 0; j < 2; ++j) {
            along += u[i] * u[j] * m->p[i][j];
        }
    }
    z.h[0][2] = 1.0;
    z.y[0] = (double)slope->z_m + (double)slope->value * range - m->x[2];
    z.r[0][0] = pow(slope->sigma, 2.0) * (range * range + along);
    return z;
}

static void compare_both_models(const struct rho_imm *imm, const struct reference *expected,
                                const struct reference *before, struct reference_worst *worst)
{
    reference_compare_model(imm->steady.state, imm->steady.covariance, 6, &expected->models[STEADY],
                            &before->models[STEADY], worst);
    reference_compare_model(imm->state, imm->covariance, WIDE, &expected->models[MANOEUVRE],
                            &before->models[MANOEUVRE], worst);
}

static void slopes_update_both_models(void **state)
{
    const struct rho_imm_model model = plain_model();
    struct reference_worst worst = {0};

    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        const struct rho_slope slope = random_slope();
        struct rho_imm imm = random_imm(&model, &slope, 1);
        const struct rho_imm was = imm;
        const struct reference before = reference_of(&imm);
        struct reference expected = before;

        for (int which = 0; which < 2; ++which) {
            const struct wide_rows z = rows_of_slope(&expected.models[which], &slope);

            wide_update(&expected.models[which], &z);
        }
        assert_int_equal(rho_imm_update_slope(&imm, &model, &slope), RHO_OK);
        compare_both_models(&imm, &expected, &before, &worst);
        assert_true(imm.probability == was.probability && imm.calm == was.calm);
        assert_int_equal(imm.unseen_ms, was.unseen_ms);
        assert_int_equal(imm.is_coupled, 1);
    }
    print_message("largest errors: %.2g, %.2g\n", worst.state, worst.covariance);
    assert_true(worst.state < STATE_SIGMAS && worst.covariance < COVARIANCE_SIGMAS2);
}

/* The axes of both models are apart until the slope couples them. */
static void a_slope_couples_axes_that_were_apart(void **state)
{
    const struct rho_imm_model model = plain_model();
    const struct rho_slope slope = {.value = 0.5f, .sigma = 0.01f};
    struct rho_kalman estimate;
    struct rho_imm_step step;
    struct rho_imm imm;
    struct reference_worst worst = {0};

    (void)state;
    rho_kalman_init(&estimate);
    for (int axis = 0; axis < 3; ++axis) {
        assert_int_equal(rho_kalman_open_axis(&estimate, axis, axis < 2 ? 3000.0f : 2000.0f,
                                              1e4f * (float)(axis + 1), 100.0f),
                         RHO_OK);
    }
    rho_imm_start(&imm, &model, &estimate);
    assert_int_equal(imm.is_coupled, 0);
    struct reference expected = reference_of(&imm);
    const struct reference before = expected;
    for (int which = 0; which < 2; ++which) {
        const struct wide_rows z = rows_of_slope(&expected.models[which], &slope);

        wide_update(&expected.models[which], &z);
    }
    assert_int_equal(rho_imm_update_slope(&imm, &model, &slope), RHO_OK);
    assert_int_equal(imm.is_coupled, 1);
    compare_both_models(&imm, &expected, &before, &worst);
    assert_true(worst.state < STATE_SIGMAS && worst.covariance < COVARIANCE_SIGMAS2);
    /* the next step moves all covariances */
    expected.is_apart = 0;
    rho_imm_prepare_step(&step, &model, 2.0f);
    reference_predict(&expected, &model, 2.0, 1);
    assert_int_equal(rho_imm_predict(&imm, &step), RHO_OK);
    compare_both_models(&imm, &expected, &expected, &worst);
    assert_true(worst.state < STATE_SIGMAS && worst.covariance < COVARIANCE_SIGMAS2);
}

/* Height of a slope at a model's range, and its variance by the range's and the slope's. */
static double first_height(const struct wide_model *own, const struct rho_slope *slope,
                           double *variance)
{
    const struct wide_rows z = rows_of_slope(own, slope);

    *variance = z.r[0][0];
    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
            *variance += z.h[0][i] * z.h[0][j] * own->p[i][j];
        }
    }
    return z.y[0];
}

/* Each model gets the height of the line of sight at its own range. */
static void a_first_slope_gives_both_models_a_height(void **state)
{
    const struct rho_imm_model model = plain_model();

    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        const struct rho_slope slope = random_slope();
        struct rho_imm imm = random_imm(&model, &slope, 0);
        const struct reference before = reference_of(&imm);
        const struct wide_model *wide = &before.models[MANOEUVRE];

        assert_true(imm.covariance[RHO_AT(2, 2)] == 0.0f && wide->x[2] == 0.0);
        assert_int_equal(rho_imm_update_slope(&imm, &model, &slope), RHO_OK);
        const float *covariances[2] = {
            [STEADY] = imm.steady.covariance, [MANOEUVRE] = imm.covariance};
        const float heights[2] = {[STEADY] = imm.steady.state[2], [MANOEUVRE] = imm.state[2]};
        for (int which = 0; which < 2; ++which) {
            const struct wide_model *own = &before.models[which];
            const double range =
                hypot(own->x[0] - (double)slope.x_m, own->x[1] - (double)slope.y_m);
            double variance;
            const double height = first_height(own, &slope, &variance);

            assert_float_equal(heights[which], height, 6e-7 * range);
            assert_float_equal(covariances[which][RHO_AT(2, 2)], variance, 1e-5 * variance);
            assert_float_equal(covariances[which][RHO_AT(5, 5)], pow(model.speed_sigma_mps, 2.0),
                               1.0);
            for (int i = 0; i < 2; ++i) { /* the height errs with the range */
                const struct wide_rows z = rows_of_slope(own, &slope);
                const double with_z = -z.h[0][0] * own->p[0][i] - z.h[0][1] * own->p[1][i];

                assert_float_equal(covariances[which][RHO_AT(2, i)], with_z,
                                   1e-5 * sqrt(variance * own->p[i][i]));
            }
        }
        assert_float_equal(imm.covariance[RHO_AT(8, 8)], pow(model.accel_sigma_mps2, 2.0), 0.1);
        assert_true(imm.state[5] == 0.0f && imm.state[8] == 0.0f && imm.steady.state[5] == 0.0f);
        assert_true(imm.state[0] == (float)wide->x[0] && imm.state[1] == (float)wide->x[1]);
    }
}

static void nothing_is_done_without_a_slope_or_within_a_metre(void **state)
{
    const struct rho_imm_model model = plain_model();

    (void)state;
    for (int has_z = 0; has_z <= 1; ++has_z) {
        struct rho_slope slope = random_slope();
        struct rho_imm imm = random_imm(&model, &slope, has_z);
        const struct rho_imm was = imm;
        const float none[] = {0.0f, -0.01f, NAN};

        for (int k = 0; k < 3; ++k) {
            slope.sigma = none[k];
            assert_int_equal(rho_imm_update_slope(&imm, &model, &slope), RHO_OK);
            assert_memory_equal(&imm, &was, sizeof imm);
        }
        slope.sigma = 0.01f;
        slope.x_m = imm.state[0] + 0.5f;
        slope.y_m = imm.state[1];
        assert_int_equal(rho_imm_update_slope(&imm, &model, &slope), RHO_OK);
        assert_memory_equal(&imm, &was, sizeof imm);
        slope.x_m = imm.steady.state[0];
        slope.y_m = imm.steady.state[1] + 0.5f;
        assert_int_equal(rho_imm_update_slope(&imm, &model, &slope), RHO_OK);
        assert_memory_equal(&imm, &was, sizeof imm);
    }
}

/* Values that are not finite are refused, or leave finite estimates. */
static void hostile_slopes_leave_finite_estimates_or_errors(void **state)
{
    const struct rho_imm_model model = plain_model();
    const float bad[] = {NAN, INFINITY, -INFINITY, 3e38f, -1e30f};

    (void)state;
    for (int n = 0; n < 2 * 5 * 5; ++n) {
        struct rho_slope slope = random_slope();
        struct rho_imm imm = random_imm(&model, &slope, n % 2);
        float *const field[5] = {&slope.x_m, &slope.y_m, &slope.z_m, &slope.value, &slope.sigma};

        *field[n / 2 % 5] = bad[n / 10];
        if (rho_imm_update_slope(&imm, &model, &slope) == RHO_OK) {
            for (int i = 0; i < WIDE; ++i) {
                assert_true(isfinite(imm.state[i]));
                assert_true(isfinite(imm.covariance[RHO_AT(i, i)]));
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slopes_update_both_models),
        cmocka_unit_test(a_slope_couples_axes_that_were_apart),
        cmocka_unit_test(a_first_slope_gives_both_models_a_height),
        cmocka_unit_test(nothing_is_done_without_a_slope_or_within_a_metre),
        cmocka_unit_test(hostile_slopes_leave_finite_estimates_or_errors),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
