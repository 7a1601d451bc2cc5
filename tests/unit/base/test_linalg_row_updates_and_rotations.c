/* SPDX-License-Identifier: MIT */
/*
 * Scalar updates by rows, and rotations of the covariance, compared with full matrices in double
 * precision.
 */
#include <float.h>

#include "dense_filter.h"
#include "kalman_checks.h"

/* Tolerances in sigmas of the estimate before; largest errors seen: 1.2e-6, 2.7e-6 and 1.1e-5. */
#define UPDATE_RELATIVE 4e-6
#define TURN_RELATIVE 8e-6
#define ORDER_RELATIVE 5e-5

#define NUM_CASES 2000

static const float some_row[STATES] = {0.5f, -0.25f, 0.75f, 1.5f, -2.0f, 0.125f};

/* A state and a covariance; functions of the Kalman filter are not called in this test. */
static struct rho_kalman random_estimate(double decades)
{
    struct rho_kalman e;

    random_covariance(e.covariance, decades);
    for (int i = 0; i < STATES; ++i) {
        e.state[i] = (float)(100.0 * normal());
    }
    return e;
}

/* A row in units of the sigmas, so that each element contributes about the same. */
static void random_row(const struct rho_kalman *e, float row[STATES])
{
    for (int i = 0; i < STATES; ++i) {
        row[i] = (float)(normal() / sqrt(e->covariance[RHO_AT(i, i)]));
    }
}

static enum rho_status update_by_row(struct rho_kalman *e, const float *row, float innovation,
                                     float variance)
{
    return rho_linalg_update6_row(e->state, e->covariance, row, innovation, variance);
}

/* --- updates by rows ------------------------------------------------------------------------- */

static void a_row_update_agrees_with_the_joseph_form(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        struct rho_kalman e = random_estimate(3.0);
        const struct dense before = dense_of(e.state, e.covariance);
        struct dense expected = before;
        const float variance = (float)pow(10.0, uniform(-1.0, 2.0)), innovation = (float)normal();
        float row[STATES];

        random_row(&e, row);
        const struct dense_measurement measured = dense_row_measurement(row, innovation, variance);
        (void)dense_update(&expected, &measured);
        assert_int_equal(update_by_row(&e, row, innovation, variance), RHO_OK);
        assert_near_dense(e.state, e.covariance, &expected, &before, UPDATE_RELATIVE);
    }
}

static void a_unit_row_is_an_update_of_its_element(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        struct rho_kalman one = random_estimate(3.0), other = one;
        const struct dense before = dense_of(one.state, one.covariance);
        const int element = n % STATES;
        const float variance = one.covariance[RHO_AT(element, element)] * 0.25f;
        float row[STATES] = {0.0f};

        row[element] = 1.0f;
        assert_int_equal(update_by_row(&one, row, 30.0f, variance), RHO_OK);
        assert_int_equal(rho_linalg_update6_element(other.state, other.covariance, element, 30.0f,
                                                    variance, NULL),
                         RHO_OK);
        const struct dense expected = dense_of(other.state, other.covariance);
        assert_near_dense(one.state, one.covariance, &expected, &before, UPDATE_RELATIVE);
    }
}

struct measured_row {
    float row[STATES], value;
};

/* A measurement along a random row, within a sigma or so of the estimate. */
static struct measured_row random_row_and_measured_value(const struct rho_kalman *e)
{
    struct measured_row m;
    double value = normal();

    random_row(e, m.row);
    for (int i = 0; i < STATES; ++i) {
        value += (double)m.row[i] * e->state[i];
    }
    m.value = (float)value;
    return m;
}

static void update_by_rows_in_order(struct rho_kalman *e, const struct measured_row rows[3],
                                    const int order[3])
{
    for (int k = 0; k < 3; ++k) {
        const struct measured_row *m = &rows[order[k]];
        double innovation = m->value;

        for (int i = 0; i < STATES; ++i) {
            innovation -= (double)m->row[i] * e->state[i];
        }
        assert_int_equal(update_by_row(e, m->row, (float)innovation, 0.5f), RHO_OK);
    }
}

static void the_order_of_rows_does_not_matter(void **state)
{
    static const int orders[][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                    {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};

    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        const struct rho_kalman e = random_estimate(3.0);
        const struct dense before = dense_of(e.state, e.covariance);
        struct rho_kalman first = e;
        struct measured_row rows[3];

        for (int k = 0; k < 3; ++k) {
            rows[k] = random_row_and_measured_value(&e);
        }
        update_by_rows_in_order(&first, rows, orders[0]);
        const struct dense expected = dense_of(first.state, first.covariance);
        for (size_t k = 1; k < NUM(orders); ++k) {
            struct rho_kalman other = e;

            update_by_rows_in_order(&other, rows, orders[k]);
            assert_near_dense(other.state, other.covariance, &expected, &before, ORDER_RELATIVE);
        }
    }
}

static void a_row_update_raises_variances_by_rounding_at_most(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        const struct rho_kalman before = random_estimate(3.0);
        struct rho_kalman e = before;
        float row[STATES];

        random_row(&e, row);
        assert_int_equal(update_by_row(&e, row, 1.0f, n % 2 == 0 ? 1e20f : 1.0f), RHO_OK);
        for (int i = 0; i < STATES; ++i) {
            assert_true(e.covariance[RHO_AT(i, i)] <=
                        before.covariance[RHO_AT(i, i)] * (1.0f + 1.0f / 1048576.0f));
        }
    }
}

/*
 * Each measurement is 10^8 times better than the prediction: the variance along the row cancels in
 * every digit.
 */
static void a_sharp_row_leaves_a_vague_estimate_positive_definite(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        struct rho_kalman e = opened_filter(3, 1e8f, 1e8f);

        for (int k = 0; k < 20; ++k) {
            float row[STATES];

            for (int i = 0; i < STATES; ++i) {
                row[i] = n % 2 == 0 ? (float)normal() : (float)(int)uniform(-2.0, 2.0);
            }
            assert_int_equal(update_by_row(&e, row, (float)normal(), 1.0f), RHO_OK);
            assert_true(is_positive_definite(&e));
        }
    }
}

/* --- refusals ------------------------------------------------------------------------------ */

static void assert_row_update_refused(struct rho_kalman e, const float row[STATES],
                                      float innovation, float variance, enum rho_status expected)
{
    const struct rho_kalman before = e;

    assert_int_equal(update_by_row(&e, row, innovation, variance), expected);
    assert_changed_nothing(&e, &before);
}

static void a_row_update_refuses_bad_numbers(void **state)
{
    const struct rho_kalman e = opened_filter(3, 4.0f, 9.0f);
    const float no_variance[] = {0.0f, -0.0f, -1.0f, NAN, INFINITY, -INFINITY};
    const float no_innovation[] = {NAN, INFINITY, -INFINITY, FLT_MAX, 1e25f};
    const float no_element[] = {NAN, INFINITY, -INFINITY, FLT_MAX};

    (void)state;
    for (size_t k = 0; k < NUM(no_variance); ++k) {
        assert_row_update_refused(e, some_row, 1.0f, no_variance[k], RHO_ERROR_SINGULAR);
    }
    for (size_t k = 0; k < NUM(no_innovation); ++k) {
        assert_row_update_refused(e, some_row, no_innovation[k], 1.0f, RHO_ERROR_VALUE);
    }
    for (size_t k = 0; k < NUM(no_element); ++k) {
        for (int i = 0; i < STATES; ++i) {
            float row[STATES];

            memcpy(row, some_row, sizeof row);
            row[i] = no_element[k];
            assert_row_update_refused(e, row, 1.0f, 1.0f, RHO_ERROR_SINGULAR);
        }
    }
}

static void a_row_update_refuses_a_bad_estimate(void **state)
{
    const float bad[] = {NAN, INFINITY, -INFINITY};

    (void)state;
    for (size_t k = 0; k < NUM(bad); ++k) {
        for (int i = 0; i < STATES; ++i) {
            struct rho_kalman e = opened_filter(3, 4.0f, 9.0f);

            e.state[i] = bad[k];
            assert_row_update_refused(e, some_row, 1.0f, 1.0f, RHO_ERROR_VALUE);
        }
        for (int place = 0; place < PACKED; ++place) {
            struct rho_kalman e = opened_filter(3, 4.0f, 9.0f);

            e.covariance[place] = bad[k];
            assert_row_update_refused(e, some_row, 1.0f, 1.0f, RHO_ERROR_SINGULAR);
        }
    }
}

/*
 * The variance along the row is negative though each element's is not; then sums and quotients
 * overflow float.
 */
static void a_row_update_refuses_variances_it_cannot_divide_by(void **state)
{
    struct rho_kalman e = opened_filter(3, 4.0f, 9.0f);
    const float sum[STATES] = {1.0f, 1.0f}, nothing[STATES] = {0.0f};

    (void)state;
    e.covariance[RHO_AT(1, 0)] = -5.0f;
    assert_row_update_refused(e, sum, 1.0f, 1.0f, RHO_ERROR_SINGULAR);
    assert_row_update_refused(e, sum, 1.0f, 1e6f, RHO_ERROR_SINGULAR);
    e = opened_filter(3, 4.0f, 9.0f);
    assert_row_update_refused(e, nothing, 1.0f, FLT_TRUE_MIN, RHO_ERROR_SINGULAR);
    e.covariance[0] = FLT_MAX;
    assert_row_update_refused(e, sum, 1.0f, FLT_MAX, RHO_ERROR_SINGULAR);
}

/* --- rotations ------------------------------------------------------------------------------- */

struct plane {
    int a, b;
    float c, s;
};

/* The n-th of all thirty pairs of elements, with a random angle or, one in seven, a right one. */
static struct plane rotation_plane(int n)
{
    const int a = n % STATES, b = (a + 1 + n / STATES % (STATES - 1)) % STATES;
    const double angle = n % 7 == 0 ? (n % 4) * 1.5707963267948966 : uniform(-4.0, 4.0);

    return (struct plane){a, b, (float)cos(angle), (float)sin(angle)};
}

static void rotate_covariance(struct rho_kalman *e, const struct plane *plane)
{
    rho_linalg_rotate6(e->covariance, plane->a, plane->b, plane->c, plane->s);
}

static struct dense rotated_in_double_precision(const struct rho_kalman *e,
                                                const struct plane *plane)
{
    struct dense d = dense_of(e->state, e->covariance);
    double g[DENSE][DENSE] = {{0.0}};

    for (int i = 0; i < DENSE; ++i) {
        g[i][i] = 1.0;
    }
    g[plane->a][plane->a] = g[plane->b][plane->b] = plane->c;
    g[plane->a][plane->b] = plane->s;
    g[plane->b][plane->a] = -(double)plane->s;
    dense_transform(d.p, g);
    return d;
}

/*
 * The covariance with both variances of the plane set to the larger: the scale of rounding errors.
 */
static struct dense tolerance_scale_of_rotation(const struct rho_kalman *e,
                                                const struct plane *plane)
{
    struct dense d = dense_of(e->state, e->covariance);
    const double largest = fmax(d.p[plane->a][plane->a], d.p[plane->b][plane->b]);

    d.p[plane->a][plane->a] = d.p[plane->b][plane->b] = largest;
    return d;
}

static void a_rotation_agrees_with_the_matrix_product(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        struct rho_kalman e = random_estimate(2.0);
        const struct plane plane = rotation_plane(n);
        const struct dense expected = rotated_in_double_precision(&e, &plane),
                           measure = tolerance_scale_of_rotation(&e, &plane);

        rotate_covariance(&e, &plane);
        assert_near_dense(e.state, e.covariance, &expected, &measure, TURN_RELATIVE);
    }
}

static void a_rotation_there_and_back_restores_the_covariance(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        const struct rho_kalman e = random_estimate(2.0);
        const struct plane there = rotation_plane(n);
        const struct plane back = {there.a, there.b, there.c, -there.s};
        /* elements exchanged: the opposite rotation, as `back` */
        const struct plane swapped = {there.b, there.a, there.c, there.s};
        const struct dense expected = dense_of(e.state, e.covariance);
        const struct dense measure = tolerance_scale_of_rotation(&e, &there);
        struct rho_kalman one = e, other = e;

        rotate_covariance(&one, &there);
        rotate_covariance(&one, &back);
        rotate_covariance(&other, &there);
        rotate_covariance(&other, &swapped);
        assert_near_dense(one.state, one.covariance, &expected, &measure, TURN_RELATIVE);
        assert_near_dense(other.state, other.covariance, &expected, &measure, TURN_RELATIVE);
    }
}

/* Rounding raises both variances by a little, by a bounded share of the larger, and lowers none. */
static void a_rotation_raises_variances_by_rounding_but_never_lowers_them(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        struct rho_kalman e = random_estimate(4.0);
        const struct plane plane = rotation_plane(n);
        const struct dense exact = rotated_in_double_precision(&e, &plane),
                           measure = tolerance_scale_of_rotation(&e, &plane);
        const double most = measure.p[plane.a][plane.a] * 2.5 / 4194304.0;

        rotate_covariance(&e, &plane);
        const int elements[] = {plane.a, plane.b};
        for (int k = 0; k < 2; ++k) {
            const int i = elements[k];

            assert_true(e.covariance[RHO_AT(i, i)] > exact.p[i][i]);
            assert_true(e.covariance[RHO_AT(i, i)] < exact.p[i][i] + most);
        }
    }
}

/* The frame turns 200 times; one sigma is 10^4 times smaller than the others. */
static void many_rotations_leave_the_covariance_positive_definite(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES / 20; ++n) {
        struct rho_kalman e = opened_filter(3, 1e8f, 1e8f);

        e.covariance[RHO_AT(n % STATES, n % STATES)] = 1.0f;
        for (int k = 0; k < 200; ++k) {
            const struct plane plane = rotation_plane(k + n);

            rotate_covariance(&e, &plane);
            assert_true(is_positive_definite(&e));
        }
    }
}

static void zero_covariances_stay_zero_when_rotated(void **state)
{
    struct rho_kalman e = opened_filter(1, 4.0f, 9.0f);
    const struct rho_kalman before = e;
    const struct plane plane = {1, 2, 0.6f, 0.8f}, velocities = {4, 5, 0.6f, 0.8f};

    (void)state;
    rotate_covariance(&e, &plane);
    rotate_covariance(&e, &velocities);
    for (int i = 0; i < PACKED; ++i) {
        assert_true(e.covariance[i] == before.covariance[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_row_update_agrees_with_the_joseph_form),
        cmocka_unit_test(a_unit_row_is_an_update_of_its_element),
        cmocka_unit_test(the_order_of_rows_does_not_matter),
        cmocka_unit_test(a_row_update_raises_variances_by_rounding_at_most),
        cmocka_unit_test(a_sharp_row_leaves_a_vague_estimate_positive_definite),
        cmocka_unit_test(a_row_update_refuses_bad_numbers),
        cmocka_unit_test(a_row_update_refuses_a_bad_estimate),
        cmocka_unit_test(a_row_update_refuses_variances_it_cannot_divide_by),
        cmocka_unit_test(a_rotation_agrees_with_the_matrix_product),
        cmocka_unit_test(a_rotation_there_and_back_restores_the_covariance),
        cmocka_unit_test(a_rotation_raises_variances_by_rounding_but_never_lowers_them),
        cmocka_unit_test(many_rotations_leave_the_covariance_positive_definite),
        cmocka_unit_test(zero_covariances_stay_zero_when_rotated),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
