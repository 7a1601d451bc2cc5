/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "kalman_checks.h"
#include "vectors/kalman_vectors.h"

/* Tolerances after up to 50 steps, compared with the vector filter in double precision. */
/* in standard deviations of the estimate, in addition to STATE_RELATIVE */
#define STATE_SIGMAS 2e-3
#define STATE_RELATIVE 4e-7 /* rounding of the state itself */
#define COVARIANCE_RELATIVE 5e-4
#define NIS_RELATIVE 5e-3
#define NIS_ABSOLUTE 2e-3

/* --- comparison with the reference ----------------------------------------------------------- */

static void assert_near_reference_step(const struct rho_kalman *kalman,
                                       const struct kalman_step *step)
{
    for (int i = 0; i < STATES; ++i) {
        const double sigma = sqrt(step->diagonal[i]);

        assert_float_equal(kalman->state[i], step->state[i],
                           STATE_SIGMAS * sigma + STATE_RELATIVE * fabs(step->state[i]));
        assert_float_equal(kalman->covariance[RHO_AT(i, i)], step->diagonal[i],
                           COVARIANCE_RELATIVE * step->diagonal[i]);
    }
}

static void compare_sequence(const struct kalman_sequence *sequence)
{
    struct rho_kalman kalman;

    memcpy(kalman.state, sequence->state, sizeof kalman.state);
    memcpy(kalman.covariance, sequence->covariance, sizeof kalman.covariance);
    for (int k = 0; k < KALMAN_STEPS; ++k) {
        const struct kalman_step *step = &sequence->steps[k];
        float nis_sum = 0.0f;

        assert_int_equal(rho_kalman_predict(&kalman, step->dt_s, sequence->noise_density), RHO_OK);
        for (int i = 0; i < sequence->num_elements; ++i) {
            float nis = GUARD;

            assert_int_equal(
                rho_kalman_update(&kalman, i, step->values[i], step->variances[i], &nis), RHO_OK);
            nis_sum += nis; /* NIS of scalar updates add up to that of the vector update */
        }
        assert_near_reference_step(&kalman, step);
        assert_float_equal(nis_sum, step->nis, NIS_RELATIVE * step->nis + NIS_ABSOLUTE);
    }
    for (int i = 0; i < PACKED; ++i) {
        int row = 0;

        while (RHO_TRIANGLE(row + 1) <= i) {
            ++row;
        }
        const double scale =
            sqrt((double)sequence->last_covariance[RHO_AT(row, row)] *
                 sequence->last_covariance[RHO_AT(i - RHO_TRIANGLE(row), i - RHO_TRIANGLE(row))]);

        assert_float_equal(kalman.covariance[i], sequence->last_covariance[i],
                           COVARIANCE_RELATIVE * scale);
    }
    assert_true(is_positive_definite(&kalman));
}

static void sequences_agree_with_the_vector_filter(void **state)
{
    (void)state;
    for (size_t k = 0; k < NUM(kalman_sequences); ++k) {
        print_message("           %s\n", kalman_sequences[k].name);
        compare_sequence(&kalman_sequences[k]);
    }
}

/* --- opening of axes -------------------------------------------------------------------------- */

static void init_sets_state_and_covariance_to_zero(void **state)
{
    struct {
        float before;
        struct rho_kalman kalman;
        float after;
    } cell = {.before = GUARD, .after = GUARD};

    (void)state;
    memset(&cell.kalman, 0xff, sizeof cell.kalman);
    rho_kalman_init(&cell.kalman);
    for (int i = 0; i < STATES; ++i) {
        assert_true(cell.kalman.state[i] == 0.0f);
    }
    for (int i = 0; i < PACKED; ++i) {
        assert_true(cell.kalman.covariance[i] == 0.0f);
    }
    assert_true(cell.before == GUARD && cell.after == GUARD);
}

static void an_axis_is_open_after_it_was_opened(void **state)
{
    struct rho_kalman kalman;

    (void)state;
    rho_kalman_init(&kalman);
    for (int axis = 0; axis < 3; ++axis) {
        assert_int_equal(rho_kalman_has_axis(&kalman, axis), 0);
        assert_int_equal(rho_kalman_open_axis(&kalman, axis, -5.0f, 4.0f, 9.0f), RHO_OK);
        assert_int_equal(rho_kalman_has_axis(&kalman, axis), 1);
        assert_true(kalman.state[axis] == -5.0f && kalman.state[axis + 3] == 0.0f);
        assert_true(kalman.covariance[RHO_AT(axis, axis)] == 4.0f);
        assert_true(kalman.covariance[RHO_AT(axis + 3, axis + 3)] == 9.0f);
    }
}

static void opening_an_axis_again_removes_its_correlations(void **state)
{
    struct rho_kalman kalman;

    (void)state;
    memcpy(kalman.state, kalman_sequences[3].state, sizeof kalman.state);
    memcpy(kalman.covariance, kalman_sequences[3].covariance, sizeof kalman.covariance);
    const struct rho_kalman before = kalman;
    assert_int_equal(rho_kalman_open_axis(&kalman, 1, 7.0f, 2.0f, 3.0f), RHO_OK);
    assert_true(kalman.state[1] == 7.0f && kalman.state[4] == 0.0f);
    assert_true(kalman.state[2] == before.state[2] && kalman.state[3] == before.state[3]);
    for (int i = 0; i < STATES; ++i) {
        for (int j = 0; j < i; ++j) {
            const int is_touched = i % 3 == 1 || j % 3 == 1;

            assert_true(kalman.covariance[RHO_AT(i, j)] ==
                        (is_touched ? 0.0f : before.covariance[RHO_AT(i, j)]));
        }
    }
    assert_true(kalman.state[0] == before.state[0] && kalman.state[5] == before.state[5]);
}

static void a_closed_axis_stays_zero(void **state)
{
    struct rho_kalman kalman = opened_filter(2, 4.0f, 9.0f);

    (void)state;
    for (int k = 0; k < 20; ++k) {
        float nis = GUARD;

        assert_int_equal(rho_kalman_predict(&kalman, 1.5f, 3.0f), RHO_OK);
        assert_int_equal(rho_kalman_update(&kalman, 0, 5.0f, 2.0f, NULL), RHO_OK);
        const struct rho_kalman before = kalman;
        assert_int_equal(rho_kalman_update(&kalman, 2, 6.0f, 4.0f, &nis), RHO_OK);
        assert_int_equal(rho_kalman_update(&kalman, 5, 6.0f, 4.0f, NULL), RHO_OK);
        for (int i = 0; i < STATES; ++i) {
            assert_true(kalman.covariance[RHO_AT(2, i)] == 0.0f);
            assert_true(kalman.covariance[RHO_AT(5, i)] == 0.0f);
            assert_true(kalman.state[i] == before.state[i]);
        }
        assert_true(kalman.state[2] == 0.0f && kalman.state[5] == 0.0f);
        assert_true(nis == 9.0f);
        assert_int_equal(rho_kalman_has_axis(&kalman, 2), 0);
    }
}

/* --- prediction ---------------------------------------------------------------------------- */

static void a_prediction_of_no_time_changes_nothing(void **state)
{
    struct rho_kalman kalman = opened_filter(3, 4.0f, 9.0f);
    const struct rho_kalman before = kalman;

    (void)state;
    assert_int_equal(rho_kalman_predict(&kalman, 0.0f, 100.0f), RHO_OK);
    assert_int_equal(rho_kalman_predict(&kalman, -0.0f, 100.0f), RHO_OK);
    assert_changed_nothing(&kalman, &before);
}

static void one_long_prediction_equals_many_short_ones(void **state)
{
    struct rho_kalman once = opened_filter(3, 25.0f, 400.0f), often = once;

    (void)state;
    for (int i = 0; i < 3; ++i) {
        once.state[i + 3] = often.state[i + 3] = 12.5f * (float)(i + 1);
    }
    assert_int_equal(rho_kalman_predict(&once, 16.0f, 2.0f), RHO_OK);
    for (int k = 0; k < 64; ++k) {
        assert_int_equal(rho_kalman_predict(&often, 0.25f, 2.0f), RHO_OK);
    }
    for (int i = 0; i < STATES; ++i) {
        assert_float_equal(once.state[i], often.state[i], 1e-6 * fabs(once.state[i]));
    }
    for (int i = 0; i < PACKED; ++i) {
        assert_float_equal(once.covariance[i], often.covariance[i], 2e-4 * once.covariance[i]);
    }
}

static void prediction_forth_and_back_without_noise_restores_the_filter(void **state)
{
    struct rho_kalman kalman = opened_filter(3, 25.0f, 400.0f);

    (void)state;
    kalman.state[3] = 250.0f;
    const struct rho_kalman before = kalman;
    assert_int_equal(rho_kalman_predict(&kalman, 4.0f, 0.0f), RHO_OK);
    assert_float_equal(kalman.state[0], 1100.0, 1e-3);
    assert_int_equal(rho_kalman_predict(&kalman, -4.0f, 0.0f), RHO_OK);
    assert_float_equal(kalman.state[0], before.state[0], 1e-3);
    for (int i = 0; i < 3; ++i) { /* rounding errors are about dt^2 times the velocity variance */
        assert_float_equal(kalman.covariance[RHO_AT(i, i)], 25.0, 0.1);
        assert_float_equal(kalman.covariance[RHO_AT(i + 3, i)], 0.0, 1e-3);
        assert_true(kalman.covariance[RHO_AT(i + 3, i + 3)] == 400.0f);
    }
    assert_true(is_positive_definite(&kalman));
}

static void prediction_back_in_time_adds_no_noise(void **state)
{
    struct rho_kalman noisy = opened_filter(3, 25.0f, 400.0f), quiet = noisy;

    (void)state;
    assert_int_equal(rho_kalman_predict(&noisy, -3.0f, 1000.0f), RHO_OK);
    assert_int_equal(rho_kalman_predict(&quiet, -3.0f, 0.0f), RHO_OK);
    assert_changed_nothing(&noisy, &quiet);
}

/* --- updates ---------------------------------------------------------------------------------- */

static void an_update_agrees_with_a_result_by_hand(void **state)
{
    struct rho_kalman kalman = opened_filter(1, 12.0f, 9.0f);
    float nis[2] = {0.0f, GUARD};

    (void)state;
    assert_int_equal(rho_kalman_update(&kalman, 0, 108.0f, 4.0f, nis), RHO_OK);
    assert_float_equal(kalman.state[0], 106.0, 1e-5);
    assert_float_equal(kalman.covariance[0], 3.0, 1e-5);
    assert_float_equal(nis[0], 4.0, 1e-6);
    assert_true(nis[1] == GUARD);
    assert_true(kalman.state[3] == 0.0f && kalman.covariance[RHO_AT(3, 3)] == 9.0f);
}

/* Open axes get the variance given and all covariances become 0; the state stays. */
static void setting_equal_variances_removes_all_covariances(void **state)
{
    (void)state;
    struct rho_kalman filter;
    rho_kalman_init(&filter);
    assert_int_equal(rho_kalman_open_axis(&filter, 0, 7.0f, 4.0f, 9.0f), RHO_OK);
    assert_int_equal(rho_kalman_open_axis(&filter, 2, 8.0f, 4.0f, 9.0f), RHO_OK);
    assert_int_equal(rho_kalman_predict(&filter, 2.0f, 1.0f), RHO_OK);
    const struct rho_kalman before = filter;
    rho_kalman_set_equal_variances(&filter, 500.0f);
    assert_memory_equal(filter.state, before.state, sizeof filter.state);
    for (int i = 0; i < RHO_KALMAN_STATES; i++) {
        for (int j = 0; j <= i; j++) {
            const float expected = i == j && i % 3 != 1 ? 500.0f : 0.0f;
            assert_float_equal(filter.covariance[RHO_AT(i, j)], expected, 0.0f);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(setting_equal_variances_removes_all_covariances),
        cmocka_unit_test(sequences_agree_with_the_vector_filter),
        cmocka_unit_test(init_sets_state_and_covariance_to_zero),
        cmocka_unit_test(an_axis_is_open_after_it_was_opened),
        cmocka_unit_test(opening_an_axis_again_removes_its_correlations),
        cmocka_unit_test(a_closed_axis_stays_zero),
        cmocka_unit_test(a_prediction_of_no_time_changes_nothing),
        cmocka_unit_test(one_long_prediction_equals_many_short_ones),
        cmocka_unit_test(prediction_forth_and_back_without_noise_restores_the_filter),
        cmocka_unit_test(prediction_back_in_time_adds_no_noise),
        cmocka_unit_test(an_update_agrees_with_a_result_by_hand),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
