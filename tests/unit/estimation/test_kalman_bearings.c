/* SPDX-License-Identifier: MIT */
/*
 * Bearings in the Kalman filter: linearisation, its error, and updates, compared with double
 * precision.
 */
#include <float.h>

#include "dense_filter_bearing_measurement.h"
#include "kalman_checks.h"

#define NUM_CASES 3000

/*
 * Tolerances in rad, relative, and in sigmas of the estimate before; largest seen: 5.5e-7, 4e-7,
 * 2e-6.
 */
#define OFF_RAD 1e-6
#define ROW_ERROR 1e-6
#define UPDATE_RELATIVE 6e-6

/* --- linearisation ---------------------------------------------------------------------------- */

/* Draws a sensor's place in whole metres, which float holds exactly. */
static void draw_place(double place[2])
{
    for (int axis = 0; axis < 2; ++axis) {
        place[axis] = floor(uniform(-3e4, 3e4));
    }
}

/* Puts the state at this range and bearing from the place, with random velocities. */
static void place_target(float state[STATES], const double place[2], double range, double bearing)
{
    for (int i = 0; i < STATES; ++i) {
        state[i] = (float)uniform(-500.0, 500.0);
    }
    state[0] = (float)(place[0] + range * cos(bearing));
    state[1] = (float)(place[1] + range * sin(bearing));
}

/* One direction in three is within a milliradian of west, where bearings wrap. */
static double random_direction_each_third_near_west(int case_number)
{
    return case_number % 3 == 0 ? DENSE_PI + uniform(-1e-3, 1e-3) : uniform(-DENSE_PI, DENSE_PI);
}

/* A bearing, linearised at a state of no variance. */
static int bearing_row(const float state[STATES], float x_m, float y_m, float bearing_rad,
                       float row[STATES], float *off_m, float *range_m)
{
    struct rho_kalman at = {.covariance = {0.0f}};
    struct rho_kalman_bearing seen;

    memcpy(at.state, state, sizeof at.state);
    if (!rho_kalman_linearise_bearing(&at, x_m, y_m, bearing_rad, 0.001f, &seen)) {
        return 0;
    }
    memcpy(row, seen.row, sizeof seen.row);
    *off_m = seen.off_m;
    *range_m = seen.range_m;
    return 1;
}

static void assert_linearised_bearing(const float state[STATES], const double place[2],
                                      double bearing)
{
    struct dense at = {.x = {state[0], state[1]}};
    const struct dense_measurement expected = dense_bearing(&at, place, bearing, 0.0);
    const double range_m = hypot(at.x[0] - place[0], at.x[1] - place[1]);
    float row[STATES], off_m, seen_range_m;

    assert_int_equal(bearing_row(state, (float)place[0], (float)place[1], (float)bearing, row,
                                 &off_m, &seen_range_m),
                     1);
    assert_float_equal(seen_range_m, range_m, 3e-7 * range_m);
    assert_float_equal(off_m, expected.y[0], OFF_RAD * range_m);
    for (int i = 0; i < STATES; ++i) {
        assert_float_equal(row[i], i < 2 ? expected.h[0][i] : 0.0, ROW_ERROR);
    }
}

static void the_linearised_bearing_agrees_with_its_derivative(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        double place[2];

        draw_place(place);
        const double direction = random_direction_each_third_near_west(n),
                     range = pow(10.0, uniform(3.0, 5.3));
        const double bearing = remainder(direction + uniform(-2.0, 2.0), 2.0 * DENSE_PI);
        float at[STATES];

        place_target(at, place, range, direction);
        assert_linearised_bearing(at, place, (float)bearing);
    }
}

/* West of the sensor the shorter way from one bearing to another may cross +-pi. */
static void bearings_to_the_west_wrap(void **state)
{
    const float at[STATES] = {-5000.0f, 3.0f};
    float row[STATES], off_m, range_m;
    const double own_rad = atan2(3.0, -5000.0);

    (void)state;
    assert_int_equal(bearing_row(at, 0.0f, 0.0f, -3.14f, row, &off_m, &range_m), 1);
    assert_float_equal(off_m, 5000.0 * (2.0 * DENSE_PI - 3.14 - own_rad), 0.02);
    assert_int_equal(bearing_row(at, 0.0f, 0.0f, 3.14f, row, &off_m, &range_m), 1);
    assert_float_equal(off_m, 5000.0 * (3.14 - own_rad), 0.02);
    assert_int_equal(bearing_row(at, 0.0f, 0.0f, (float)DENSE_PI, row, &off_m, &range_m), 1);
    assert_float_equal(off_m, 3.0, 0.02);
    assert_float_equal(row[0], 0.0, 1e-3);
    assert_float_equal(row[1], -1.0, 1e-6);
}

static void assert_bearing_undefined(const float state[STATES])
{
    float row[STATES] = {GUARD, GUARD, GUARD, GUARD, GUARD, GUARD}, off_m = GUARD, range_m = GUARD;

    assert_int_equal(bearing_row(state, 100.0f, 200.0f, 1.0f, row, &off_m, &range_m), 0);
    for (int i = 0; i < STATES; ++i) {
        assert_true(row[i] == GUARD);
    }
    assert_true(off_m == GUARD && range_m == GUARD);
}

static void a_state_at_the_sensor_has_no_bearing(void **state)
{
    const float bad[] = {NAN, INFINITY, -INFINITY, FLT_MAX, 3e19f};
    float at[STATES] = {100.0f, 200.0f}, row[STATES], off_m, range_m;

    (void)state;
    assert_bearing_undefined(at);
    at[0] = 100.7f;
    at[1] = 199.3f;
    assert_bearing_undefined(at);
    for (size_t k = 0; k < NUM(bad); ++k) {
        for (int axis = 0; axis < 2; ++axis) {
            at[axis] = bad[k];
            at[1 - axis] = 250.0f;
            assert_bearing_undefined(at);
        }
    }
    at[0] = 101.0f;
    at[1] = 200.0f;
    assert_int_equal(bearing_row(at, 100.0f, 200.0f, 1.0f, row, &off_m, &range_m), 1);
    assert_float_equal(range_m, 1.0, 1e-6);
}

static void bearings_and_sigmas_out_of_range_are_invalid(void **state)
{
    const float pi = 3.14159274f; /* the float nearest to pi, which is larger */
    const float good_rad[] = {0.0f, pi, -pi, 1e-30f},
                bad_rad[] = {3.1415930f, -3.1415930f, NAN, INFINITY, -INFINITY};
    const float good_sigma[] = {RHO_LIMIT_SIGMA_RAD_MIN, 0.002f, RHO_LIMIT_SIGMA_RAD_MAX};
    const float bad_sigma[] = {0.0f, -0.002f, 0.99e-6f, 0.5001f, NAN, INFINITY};

    (void)state;
    for (size_t i = 0; i < NUM(good_sigma); ++i) {
        for (size_t k = 0; k < NUM(good_rad); ++k) {
            assert_true(rho_bearing_is_valid(
                &(struct rho_bearing){.bearing_rad = good_rad[k], .sigma_rad = good_sigma[i]}));
        }
        for (size_t k = 0; k < NUM(bad_rad); ++k) {
            assert_false(rho_bearing_is_valid(
                &(struct rho_bearing){.bearing_rad = bad_rad[k], .sigma_rad = good_sigma[i]}));
        }
    }
    for (size_t k = 0; k < NUM(bad_sigma); ++k) {
        assert_false(rho_bearing_is_valid(&(struct rho_bearing){.sigma_rad = bad_sigma[k]}));
    }
}

/* --- error of the linearisation -------------------------------------------------------------- */

/* Variance of the linearisation error in metres across, from places drawn from the covariance. */
static double sampled_nonlinearity_variance_m2(const struct dense *d, double range, int draws)
{
    const double l00 = sqrt(d->p[0][0]), l10 = d->p[1][0] / l00;
    const double l11 = sqrt(d->p[1][1] - l10 * l10), here[2] = {0.0, 0.0};
    double sum = 0.0, squares = 0.0;

    for (int n = 0; n < draws; ++n) {
        const double a = normal(), b = normal();
        const double dx = l00 * a, dy = l10 * a + l11 * b;
        const double moved[DENSE] = {d->x[0] + dx, d->x[1] + dy};
        const double off = dense_bearing_of(moved, here) - dense_bearing_of(d->x, here);
        const double rest =
            range * remainder(off, 2.0 * DENSE_PI) - (-d->x[1] * dx + d->x[0] * dy) / range;
        sum += rest;
        squares += rest * rest;
    }
    return squares / draws - sum * sum / draws / draws;
}

/*
 * The place is uncertain by 3 % of the range; the variance added to the bearing's must be that of
 * drawn places.
 */
static void the_noise_added_is_the_variance_of_the_linearisation_error(void **state)
{
    (void)state;
    for (int n = 0; n < 12; ++n) {
        struct rho_kalman kalman = opened_filter(2, 9e4f, 100.0f);
        struct rho_kalman_bearing seen;
        const double here[2] = {0.0, 0.0};

        place_target(kalman.state, here, 1e4, random_direction_each_third_near_west(n));
        kalman.covariance[RHO_AT(1, 1)] = (float)uniform(1e4, 1.2e5);
        kalman.covariance[RHO_AT(1, 0)] =
            (float)(uniform(-0.9, 0.9) * 300.0 * sqrt((double)kalman.covariance[RHO_AT(1, 1)]));
        const struct dense d = dense_of(kalman.state, kalman.covariance);
        const double expected = sampled_nonlinearity_variance_m2(&d, hypot(d.x[0], d.x[1]), 40000);
        assert_int_equal(rho_kalman_linearise_bearing(&kalman, 0.0f, 0.0f, 1.0f, 1e-5f, &seen), 1);
        assert_float_equal(seen.variance_m2, expected + 0.01, 0.08 * expected);
    }
}

/* --- updates ---------------------------------------------------------------------------------- */

/* A correlated estimate with sigmas of 1 to 100, 3 to 160 km from the place. */
static struct rho_kalman random_estimate(const double place[2], int case_number)
{
    struct rho_kalman kalman;

    const double range = pow(10.0, uniform(3.5, 5.2)),
                 direction = random_direction_each_third_near_west(case_number);

    random_covariance(kalman.covariance, 2.0);
    place_target(kalman.state, place, range, direction);
    return kalman;
}

/*
 * As assert_near_dense, with an additional tolerance of `rounding` sigmas for states, for the
 * rounding of the bearing itself.
 */
static void assert_near_updated(const struct rho_kalman *kalman, const struct dense *expected,
                                const struct dense *before, double rounding)
{
    for (int i = 0; i < STATES; ++i) {
        const double sigma = sqrt(before->p[i][i]);

        assert_float_equal(kalman->state[i], expected->x[i],
                           (UPDATE_RELATIVE + rounding) * sigma +
                               DENSE_ROUNDING * fabs(expected->x[i]));
        for (int j = 0; j <= i; ++j) {
            assert_float_equal(kalman->covariance[RHO_AT(i, j)], expected->p[i][j],
                               UPDATE_RELATIVE * sigma * sqrt(before->p[j][j]));
        }
    }
}

/* Square root of h p h^T + r. */
static double innovation_sigma(const struct dense *d, const struct dense_measurement *m)
{
    double sum = m->r[0][0];

    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
            sum += m->h[0][i] * m->h[0][j] * d->p[i][j];
        }
    }
    return sqrt(sum);
}

static void updates_agree_with_the_joseph_form(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        double place[2];

        draw_place(place);
        struct rho_kalman kalman = random_estimate(place, n);
        const struct dense before = dense_of(kalman.state, kalman.covariance);
        struct dense expected = before;
        const float sigma = (float)pow(10.0, uniform(-5.0, -1.5));
        const double off = 3.0 * (double)sigma * normal();
        const float bearing =
            (float)remainder(dense_bearing_of(before.x, place) + off, 2.0 * DENSE_PI);
        const struct dense_measurement m = dense_bearing(&before, place, bearing, sigma);
        const double range = hypot(before.x[0] - place[0], before.x[1] - place[1]);

        dense_update(&expected, &m);
        assert_int_equal(
            rho_kalman_update_bearing(&kalman, (float)place[0], (float)place[1], bearing, sigma),
            RHO_OK);
        assert_near_updated(&kalman, &expected, &before,
                            OFF_RAD * range / innovation_sigma(&before, &m));
        assert_true(is_positive_definite(&kalman));
    }
}

/* Variance of the place across a line of this bearing, in double precision. */
static double across_variance(const struct rho_kalman *kalman, double bearing)
{
    const struct dense d = dense_of(kalman->state, kalman->covariance);
    const double row[2] = {-sin(bearing), cos(bearing)};

    return row[0] * row[0] * d.p[0][0] + 2.0 * row[0] * row[1] * d.p[0][1] +
           row[1] * row[1] * d.p[1][1];
}

/*
 * With the smallest sigma allowed, the variance across the line of sight after the update is that
 * of the sensor, at any range.
 */
static void a_sensor_of_the_smallest_sigma_sets_the_variance_across(void **state)
{
    (void)state;
    for (int n = 0; n < 300; ++n) {
        double place[2];

        draw_place(place);
        const double range = pow(10.0, uniform(3.0, 5.0));
        struct rho_kalman kalman = opened_filter(2, 1.0f, 4.0f);

        place_target(kalman.state, place, range, random_direction_each_third_near_west(n));
        const struct dense before = dense_of(kalman.state, kalman.covariance);
        const double bearing = dense_bearing_of(before.x, place);
        const double noise = dense_bearing(&before, place, bearing, 1e-6).r[0][0];
        assert_int_equal(rho_kalman_update_bearing(&kalman, (float)place[0], (float)place[1],
                                                   (float)bearing, 1e-6f),
                         RHO_OK);
        const double expected = noise / (1.0 + noise);
        assert_true(noise > 0.9e-12 * range * range && noise < 2e-2);
        assert_float_equal(across_variance(&kalman, bearing), expected, 0.1 * expected + 3e-6);
        assert_true(is_positive_definite(&kalman));
    }
}

/*
 * The place is known to a kilometre along the line of sight and to a decimetre across; 80 updates
 * are accepted and leave the covariance positive definite.
 */
static void many_sharp_bearings_leave_the_covariance_positive_definite(void **state)
{
    (void)state;
    for (int n = 0; n < 200; ++n) {
        const double place[2] = {0.0, 0.0};
        const float sigma = n % 2 ? 1e-6f : 1e-4f;
        const double range = pow(10.0, uniform(4.0, 5.0)),
                     direction = random_direction_each_third_near_west(n);
        struct rho_kalman kalman = opened_filter(2, 1e8f, 1e5f);

        place_target(kalman.state, place, range, direction);
        for (int k = 0; k < 80; ++k) {
            const struct dense at = dense_of(kalman.state, kalman.covariance);
            const double bearing = dense_bearing_of(at.x, place) + (double)sigma * normal();

            assert_int_equal(rho_kalman_update_bearing(&kalman, 0.0f, 0.0f,
                                                       (float)remainder(bearing, 2.0 * DENSE_PI),
                                                       sigma),
                             RHO_OK);
            assert_finite_with_variances_in_limits(&kalman);
            assert_true(is_positive_definite(&kalman));
            assert_int_equal(rho_kalman_predict(&kalman, 1.0f, 1.0f), RHO_OK);
            assert_true(is_positive_definite(&kalman));
        }
    }
}

static void bearings_leave_a_closed_axis_zero(void **state)
{
    struct rho_kalman kalman = opened_filter(2, 1e6f, 1e4f);

    (void)state;
    for (int k = 0; k < 40; ++k) {
        assert_int_equal(rho_kalman_update_bearing(&kalman, -2e4f, 0.0f, 0.01f, 0.002f), RHO_OK);
        assert_int_equal(rho_kalman_update_bearing(&kalman, 0.0f, -2e4f, 1.56f, 0.002f), RHO_OK);
        assert_int_equal(rho_kalman_predict(&kalman, 2.0f, 1.0f), RHO_OK);
        assert_true(kalman.state[2] == 0.0f && kalman.state[5] == 0.0f);
        for (int i = 0; i < STATES; ++i) {
            assert_true(kalman.covariance[RHO_AT(2, i)] == 0.0f);
            assert_true(kalman.covariance[RHO_AT(5, i)] == 0.0f);
        }
    }
    /* rays from (-20 km, 0) and (0, -20 km) that cross at about (218, 202) m */
    assert_float_equal(kalman.state[0], 218.0, 5.0);
    assert_float_equal(kalman.state[1], 202.0, 5.0);
}

/*
 * For a target due east a bearing to the north moves the estimate north, and not along the line of
 * sight.
 */
static void a_bearing_update_agrees_with_a_result_by_hand(void **state)
{
    struct rho_kalman kalman = opened_filter(2, 4.0f, 9.0f);

    (void)state;
    kalman.state[0] = 10000.0f;
    kalman.state[1] = 0.0f;
    /* innovation of 2 m, sigmas of 2 m in track and bearing: the state moves half way */
    assert_int_equal(rho_kalman_update_bearing(&kalman, 0.0f, 0.0f, 2e-4f, 2e-4f), RHO_OK);
    assert_float_equal(kalman.state[0], 10000.0, 1e-3);
    assert_float_equal(kalman.state[1], 1.0, 1e-3);
    assert_float_equal(kalman.covariance[RHO_AT(0, 0)], 4.0, 1e-4);
    assert_float_equal(kalman.covariance[RHO_AT(1, 1)], 2.0, 1e-4);
}

/* --- refusals --------------------------------------------------------------------------------- */

static void an_estimate_at_the_sensors_place_is_not_updated(void **state)
{
    struct rho_kalman kalman = opened_filter(2, 4.0f, 9.0f);
    struct rho_kalman_bearing seen, guard;

    (void)state;
    kalman.state[0] = 1200.5f;
    kalman.state[1] = -3400.5f;
    const struct rho_kalman before = kalman;
    memset(&guard, 0x5a, sizeof guard);
    seen = guard;
    assert_int_equal(rho_kalman_linearise_bearing(&kalman, 1200.0f, -3400.0f, 1.0f, 0.1f, &seen),
                     0);
    assert_memory_equal(&seen, &guard, sizeof seen);
    assert_int_equal(rho_kalman_update_bearing(&kalman, 1200.0f, -3400.0f, 1.0f, 0.1f), RHO_OK);
    assert_changed_nothing(&kalman, &before);
    assert_int_equal(rho_kalman_update_bearing(&kalman, 1202.0f, -3400.0f, 1.0f, 0.1f), RHO_OK);
    assert_true(kalman.state[1] != before.state[1]);
}

static void assert_bearing_refused(struct rho_kalman kalman, float bearing, float sigma,
                                   enum rho_status expected)
{
    const struct rho_kalman before = kalman;

    assert_int_equal(rho_kalman_update_bearing(&kalman, 5000.0f, 0.0f, bearing, sigma), expected);
    assert_changed_nothing(&kalman, &before);
}

static void bearing_updates_refuse_bad_arguments(void **state)
{
    /* 1e4 rad is beyond the largest angle */
    const float bad_bearings[] = {NAN, INFINITY, -INFINITY, FLT_MAX, 1e4f};
    const float bad_sigmas[] = {0.0f, -0.0f, -0.1f, NAN, INFINITY, -INFINITY, FLT_MAX};
    struct rho_kalman kalman = opened_filter(2, 4.0f, 9.0f);

    (void)state;
    for (size_t k = 0; k < NUM(bad_bearings); ++k) {
        assert_bearing_refused(kalman, bad_bearings[k], 0.1f, RHO_ERROR_VALUE);
    }
    for (size_t k = 0; k < NUM(bad_sigmas); ++k) {
        assert_bearing_refused(kalman, 1.0f, bad_sigmas[k], RHO_ERROR_VALUE);
    }
    for (int i = 0; i < 2; ++i) {
        kalman = opened_filter(2, 4.0f, 9.0f);
        kalman.covariance[RHO_AT(i, i)] = NAN;
        assert_bearing_refused(kalman, 1.0f, 0.1f, RHO_ERROR_VALUE);
    }
    kalman = opened_filter(2, 4.0f, 9.0f);
    kalman.covariance[RHO_AT(3, 3)] = INFINITY; /* a velocity, which the bearing does not measure */
    kalman.covariance[RHO_AT(3, 0)] = INFINITY;
    assert_bearing_refused(kalman, 1.0f, 0.1f, RHO_ERROR_SINGULAR);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_linearised_bearing_agrees_with_its_derivative),
        cmocka_unit_test(bearings_to_the_west_wrap),
        cmocka_unit_test(a_state_at_the_sensor_has_no_bearing),
        cmocka_unit_test(bearings_and_sigmas_out_of_range_are_invalid),
        cmocka_unit_test(the_noise_added_is_the_variance_of_the_linearisation_error),
        cmocka_unit_test(updates_agree_with_the_joseph_form),
        cmocka_unit_test(a_bearing_update_agrees_with_a_result_by_hand),
        cmocka_unit_test(a_sensor_of_the_smallest_sigma_sets_the_variance_across),
        cmocka_unit_test(many_sharp_bearings_leave_the_covariance_positive_definite),
        cmocka_unit_test(bearings_leave_a_closed_axis_zero),
        cmocka_unit_test(an_estimate_at_the_sensors_place_is_not_updated),
        cmocka_unit_test(bearing_updates_refuse_bad_arguments),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
