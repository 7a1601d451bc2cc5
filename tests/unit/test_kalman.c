/* SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "../vectors/kalman_vectors.h"
#include "rhotrack/kalman.h"

#define STATES RHO_KALMAN_STATES
#define PACKED RHO_TRIANGLE(RHO_KALMAN_STATES)
#define NUM(array) (sizeof(array) / sizeof((array)[0]))
#define GUARD (-777.25f)

/* Against 50 steps of the vector filter in double precision. */
#define STATE_SIGMAS 2e-3       /* of the estimate's standard deviation, and beside it */
#define STATE_RELATIVE 4e-7     /* of the state itself: its rounding */
#define COVARIANCE_RELATIVE 5e-4
#define NIS_RELATIVE 5e-3
#define NIS_ABSOLUTE 2e-3

static void assert_changed_nothing(const struct rho_kalman *kalman, const struct rho_kalman *before)
{
    assert_memory_equal(kalman, before, sizeof *before);
}

/* Cholesky in double precision of the open elements: the judge of definiteness. */
static int is_positive_definite(const struct rho_kalman *kalman)
{
    double l[STATES][STATES] = {{0.0}};

    for (int i = 0; i < STATES; ++i) {
        for (int j = 0; j <= i; ++j) {
            double rest = kalman->covariance[RHO_AT(i, j)];

            for (int k = 0; k < j; ++k) {
                rest -= l[i][k] * l[j][k];
            }
            if (i == j && kalman->covariance[RHO_AT(i, i)] == 0.0f) {
                continue;
            }
            if (i == j && !(rest > 0.0)) {
                return 0;
            }
            l[i][j] = i == j ? sqrt(rest) : (l[j][j] > 0.0 ? rest / l[j][j] : 0.0);
        }
    }
    return 1;
}

static void assert_sane(const struct rho_kalman *kalman)
{
    for (int i = 0; i < STATES; ++i) {
        const float variance = kalman->covariance[RHO_AT(i, i)];

        assert_true(isfinite(kalman->state[i]));
        assert_true(variance == 0.0f || (variance >= RHO_KALMAN_VARIANCE_MIN &&
                                         variance <= RHO_KALMAN_VARIANCE_MAX));
    }
    for (int i = 0; i < PACKED; ++i) {
        assert_true(isfinite(kalman->covariance[i]));
    }
}

static struct rho_kalman opened(int num_axes, float position_variance, float velocity_variance)
{
    struct rho_kalman kalman;

    rho_kalman_init(&kalman);
    for (int axis = 0; axis < num_axes; ++axis) {
        assert_int_equal(rho_kalman_open_axis(&kalman, axis, 100.0f * (float)(axis + 1),
                                              position_variance, velocity_variance), RHO_OK);
    }
    return kalman;
}

/* --- against the reference ----------------------------------------------------------------- */

static void assert_step(const struct rho_kalman *kalman, const struct kalman_step *step)
{
    for (int i = 0; i < STATES; ++i) {
        const double sigma = sqrt(step->diagonal[i]);

        assert_float_equal(kalman->state[i], step->state[i],
                           STATE_SIGMAS * sigma + STATE_RELATIVE * fabs(step->state[i]));
        assert_float_equal(kalman->covariance[RHO_AT(i, i)], step->diagonal[i],
                           COVARIANCE_RELATIVE * step->diagonal[i]);
    }
}

static void run_sequence(const struct kalman_sequence *sequence)
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

            assert_int_equal(rho_kalman_update(&kalman, i, step->values[i], step->variances[i],
                                               &nis), RHO_OK);
            nis_sum += nis; /* the chain rule: the scalar ones add up to the vector's */
        }
        assert_step(&kalman, step);
        assert_float_equal(nis_sum, step->nis, NIS_RELATIVE * step->nis + NIS_ABSOLUTE);
    }
    for (int i = 0; i < PACKED; ++i) {
        int row = 0;

        while (RHO_TRIANGLE(row + 1) <= i) {
            ++row;
        }
        const double scale = sqrt((double)sequence->last_covariance[RHO_AT(row, row)] *
                                  sequence->last_covariance[RHO_AT(i - RHO_TRIANGLE(row),
                                                                   i - RHO_TRIANGLE(row))]);

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
        run_sequence(&kalman_sequences[k]);
    }
}

/* --- axes ---------------------------------------------------------------------------------- */

static void init_measures_nothing(void **state)
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
    rho_kalman_init(NULL);
}

static void axes_are_open_once_opened(void **state)
{
    struct rho_kalman kalman;

    (void)state;
    rho_kalman_init(&kalman);
    for (int axis = 0; axis < 3; ++axis) {
        assert_int_equal(rho_kalman_is_open(&kalman, axis), 0);
        assert_int_equal(rho_kalman_open_axis(&kalman, axis, -5.0f, 4.0f, 9.0f), RHO_OK);
        assert_int_equal(rho_kalman_is_open(&kalman, axis), 1);
        assert_true(kalman.state[axis] == -5.0f && kalman.state[axis + 3] == 0.0f);
        assert_true(kalman.covariance[RHO_AT(axis, axis)] == 4.0f);
        assert_true(kalman.covariance[RHO_AT(axis + 3, axis + 3)] == 9.0f);
    }
    assert_int_equal(rho_kalman_is_open(&kalman, -1), 0);
    assert_int_equal(rho_kalman_is_open(&kalman, 3), 0);
    assert_int_equal(rho_kalman_is_open(&kalman, INT32_MAX), 0);
    assert_int_equal(rho_kalman_is_open(&kalman, INT32_MIN), 0);
    assert_int_equal(rho_kalman_is_open(NULL, 0), 0);
}

static void opening_an_axis_uncouples_it(void **state)
{
    struct rho_kalman kalman;

    (void)state;
    memcpy(kalman.state, kalman_sequences[3].state, sizeof kalman.state);
    memcpy(kalman.covariance, kalman_sequences[3].covariance, sizeof kalman.covariance);
    const struct rho_kalman before = kalman;
    assert_int_equal(rho_kalman_open_axis(&kalman, 1, 7.0f, 2.0f, 3.0f), RHO_OK);
    for (int i = 0; i < STATES; ++i) {
        for (int j = 0; j < i; ++j) {
            const int is_touched = i % 3 == 1 || j % 3 == 1;

            assert_true(kalman.covariance[RHO_AT(i, j)] ==
                        (is_touched ? 0.0f : before.covariance[RHO_AT(i, j)]));
        }
    }
    assert_true(kalman.state[0] == before.state[0] && kalman.state[5] == before.state[5]);
}

static void open_axis_refuses_bad_arguments(void **state)
{
    const float bad_variances[] = {0.0f, -1.0f, NAN, INFINITY, -INFINITY,
                                   nextafterf(RHO_KALMAN_VARIANCE_MIN, 0.0f),
                                   nextafterf(RHO_KALMAN_VARIANCE_MAX, INFINITY)};
    const float bad_positions[] = {NAN, INFINITY, -INFINITY};
    const int bad_axes[] = {-1, 3, INT32_MAX, INT32_MIN};
    struct rho_kalman kalman = opened(2, 4.0f, 9.0f);
    const struct rho_kalman before = kalman;

    (void)state;
    assert_int_equal(rho_kalman_open_axis(NULL, 0, 0.0f, 1.0f, 1.0f), RHO_ERROR_NULL);
    for (size_t i = 0; i < NUM(bad_variances); ++i) {
        assert_int_equal(rho_kalman_open_axis(&kalman, 0, 0.0f, bad_variances[i], 1.0f),
                         RHO_ERROR_VALUE);
        assert_int_equal(rho_kalman_open_axis(&kalman, 0, 0.0f, 1.0f, bad_variances[i]),
                         RHO_ERROR_VALUE);
    }
    for (size_t i = 0; i < NUM(bad_positions); ++i) {
        assert_int_equal(rho_kalman_open_axis(&kalman, 0, bad_positions[i], 1.0f, 1.0f),
                         RHO_ERROR_VALUE);
    }
    for (size_t i = 0; i < NUM(bad_axes); ++i) {
        assert_int_equal(rho_kalman_open_axis(&kalman, bad_axes[i], 0.0f, 1.0f, 1.0f),
                         RHO_ERROR_VALUE);
    }
    assert_changed_nothing(&kalman, &before);
    assert_int_equal(rho_kalman_open_axis(&kalman, 0, 0.0f, RHO_KALMAN_VARIANCE_MIN,
                                          RHO_KALMAN_VARIANCE_MAX), RHO_OK);
}

static void a_closed_axis_stays_zero(void **state)
{
    struct rho_kalman kalman = opened(2, 4.0f, 9.0f);

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
        assert_int_equal(rho_kalman_is_open(&kalman, 2), 0);
    }
}

/* --- prediction ---------------------------------------------------------------------------- */

static void no_time_changes_nothing(void **state)
{
    struct rho_kalman kalman = opened(3, 4.0f, 9.0f);
    const struct rho_kalman before = kalman;

    (void)state;
    assert_int_equal(rho_kalman_predict(&kalman, 0.0f, 100.0f), RHO_OK);
    assert_int_equal(rho_kalman_predict(&kalman, -0.0f, 100.0f), RHO_OK);
    assert_changed_nothing(&kalman, &before);
}

static void one_long_step_equals_several_short_ones(void **state)
{
    struct rho_kalman once = opened(3, 25.0f, 400.0f), often = once;

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

static void forth_and_back_is_the_identity(void **state)
{
    struct rho_kalman kalman = opened(3, 25.0f, 400.0f);

    (void)state;
    kalman.state[3] = 250.0f;
    const struct rho_kalman before = kalman;
    assert_int_equal(rho_kalman_predict(&kalman, 4.0f, 0.0f), RHO_OK);
    assert_float_equal(kalman.state[0], 1100.0, 1e-3);
    assert_int_equal(rho_kalman_predict(&kalman, -4.0f, 0.0f), RHO_OK);
    assert_float_equal(kalman.state[0], before.state[0], 1e-3);
    for (int i = 0; i < 3; ++i) { /* rounding is of the size of dt^2 times the velocity's variance */
        assert_float_equal(kalman.covariance[RHO_AT(i, i)], 25.0, 0.1);
        assert_float_equal(kalman.covariance[RHO_AT(i + 3, i)], 0.0, 1e-3);
        assert_true(kalman.covariance[RHO_AT(i + 3, i + 3)] == 400.0f);
    }
    assert_true(is_positive_definite(&kalman));
}

static void going_back_adds_no_noise(void **state)
{
    struct rho_kalman noisy = opened(3, 25.0f, 400.0f), quiet = noisy;

    (void)state;
    assert_int_equal(rho_kalman_predict(&noisy, -3.0f, 1000.0f), RHO_OK);
    assert_int_equal(rho_kalman_predict(&quiet, -3.0f, 0.0f), RHO_OK);
    assert_changed_nothing(&noisy, &quiet);
}

static void assert_predict_refuses(struct rho_kalman kalman, float dt_s, float noise_density)
{
    const struct rho_kalman before = kalman;

    assert_int_equal(rho_kalman_predict(&kalman, dt_s, noise_density), RHO_ERROR_VALUE);
    assert_changed_nothing(&kalman, &before);
}

static void predict_refuses_bad_arguments(void **state)
{
    const struct rho_kalman kalman = opened(3, 1.0f, 1.0f);
    const float bad_times[] = {NAN, INFINITY, -INFINITY, 1.0001e5f, -1.0001e5f, FLT_MAX};
    const float bad_densities[] = {NAN, INFINITY, -INFINITY, -1e-9f, -FLT_MAX};

    (void)state;
    assert_int_equal(rho_kalman_predict(NULL, 1.0f, 1.0f), RHO_ERROR_NULL);
    for (size_t i = 0; i < NUM(bad_times); ++i) {
        assert_predict_refuses(kalman, bad_times[i], 1.0f);
    }
    for (size_t i = 0; i < NUM(bad_densities); ++i) {
        assert_predict_refuses(kalman, 1.0f, bad_densities[i]);
        assert_predict_refuses(kalman, 0.0f, bad_densities[i]);
    }
}

static void predict_refuses_results_beyond_the_limit(void **state)
{
    (void)state;
    assert_predict_refuses(opened(3, 1.0f, 1e4f), 1e5f, 0.0f);     /* position: 1e14 */
    assert_predict_refuses(opened(3, 1.0f, 1e4f), -1e5f, 0.0f);
    assert_predict_refuses(opened(1, 1.0f, 1e12f), 0.001f, 1e7f);  /* velocity */
    assert_predict_refuses(opened(3, 1.0f, 1.0f), 1.0f, FLT_MAX);
    assert_predict_refuses(opened(3, 1.0f, 1.0f), 1e5f, 1.0f);
    for (int axis = 0; axis < 3; ++axis) {
        struct rho_kalman kalman = opened(3, 1.0f, 1.0f);

        kalman.state[axis] = FLT_MAX;
        kalman.state[axis + 3] = FLT_MAX;
        assert_predict_refuses(kalman, 1.0f, 1.0f);
    }
}

static void predict_refuses_a_bad_estimate(void **state)
{
    const float bad[] = {NAN, INFINITY, -INFINITY};

    (void)state;
    for (size_t k = 0; k < NUM(bad); ++k) {
        for (int i = 0; i < STATES; ++i) {
            struct rho_kalman kalman = opened(3, 1.0f, 1.0f);

            kalman.state[i] = bad[k];
            assert_predict_refuses(kalman, 1.0f, 1.0f);
            kalman = opened(3, 1.0f, 1.0f);
            kalman.covariance[RHO_AT(i, i)] = i < 3 && bad[k] < 0.0f ? NAN : bad[k];
            assert_predict_refuses(kalman, 1.0f, 1.0f);
        }
        struct rho_kalman kalman = opened(3, 1.0f, 1.0f);
        kalman.covariance[RHO_AT(3, 0)] = bad[k] < 0.0f ? NAN : bad[k];
        assert_predict_refuses(kalman, 1.0f, 1.0f);
    }
}

/* --- update -------------------------------------------------------------------------------- */

static void an_update_by_hand(void **state)
{
    struct rho_kalman kalman = opened(1, 12.0f, 9.0f);
    float nis[2] = {0.0f, GUARD};

    (void)state;
    assert_int_equal(rho_kalman_update(&kalman, 0, 108.0f, 4.0f, nis), RHO_OK);
    assert_float_equal(kalman.state[0], 106.0, 1e-5);
    assert_float_equal(kalman.covariance[0], 3.0, 1e-5);
    assert_float_equal(nis[0], 4.0, 1e-6);
    assert_true(nis[1] == GUARD);
    assert_true(kalman.state[3] == 0.0f && kalman.covariance[RHO_AT(3, 3)] == 9.0f);
}

static void assert_update_refuses(struct rho_kalman kalman, int element, float value,
                                  float variance, enum rho_status expected)
{
    const struct rho_kalman before = kalman;
    float nis = GUARD;

    assert_int_equal(rho_kalman_update(&kalman, element, value, variance, &nis), expected);
    assert_changed_nothing(&kalman, &before);
    assert_true(nis == GUARD);
}

static void update_refuses_bad_arguments(void **state)
{
    const struct rho_kalman kalman = opened(3, 1.0f, 1.0f);
    const float bad_values[] = {NAN, INFINITY, -INFINITY, FLT_MAX, -FLT_MAX};
    const float bad_variances[] = {0.0f, -0.0f, -1.0f, NAN, INFINITY, -INFINITY};
    const int bad_elements[] = {-1, STATES, INT32_MAX, INT32_MIN};

    (void)state;
    assert_int_equal(rho_kalman_update(NULL, 0, 1.0f, 1.0f, NULL), RHO_ERROR_NULL);
    for (size_t i = 0; i < NUM(bad_values); ++i) {
        assert_update_refuses(kalman, 1, bad_values[i], 1.0f, RHO_ERROR_VALUE);
    }
    for (size_t i = 0; i < NUM(bad_variances); ++i) {
        assert_update_refuses(kalman, 1, 1.0f, bad_variances[i], RHO_ERROR_VALUE);
    }
    for (size_t i = 0; i < NUM(bad_elements); ++i) {
        assert_update_refuses(kalman, bad_elements[i], 1.0f, 1.0f, RHO_ERROR_VALUE);
    }
}

static void update_refuses_a_bad_estimate(void **state)
{
    const float bad[] = {NAN, INFINITY, -INFINITY};

    (void)state;
    for (size_t k = 0; k < NUM(bad); ++k) {
        for (int i = 0; i < STATES; ++i) {
            struct rho_kalman kalman = opened(3, 1.0f, 1.0f);

            kalman.covariance[RHO_AT(i, i)] = bad[k];
            assert_update_refuses(kalman, i, 1.0f, 1.0f, RHO_ERROR_SINGULAR);
            kalman = opened(3, 1.0f, 1.0f);
            kalman.state[i] = bad[k];
            assert_update_refuses(kalman, 2, 1.0f, 1.0f, RHO_ERROR_VALUE);
        }
    }
    struct rho_kalman kalman = opened(3, 1.0f, 1.0f);
    kalman.covariance[RHO_AT(1, 1)] = -2.0f;
    assert_update_refuses(kalman, 1, 1.0f, 3.0f, RHO_ERROR_SINGULAR);
}

static void updates_keep_the_variance_floor(void **state)
{
    (void)state;
    for (int element = 0; element < STATES; ++element) {
        struct rho_kalman kalman = opened(3, 1.0f, 1.0f);

        assert_int_equal(rho_kalman_update(&kalman, element, 1.0f, 1e-30f, NULL), RHO_OK);
        assert_true(kalman.covariance[RHO_AT(element, element)] == RHO_KALMAN_VARIANCE_MIN);
        assert_sane(&kalman);
        assert_true(is_positive_definite(&kalman));
    }
}

/* --- hard cases ---------------------------------------------------------------------------- */

/* Measured 5e8 times better than predicted: every digit of the velocity's variance cancels. */
static void a_vague_start_with_a_sharp_sensor(void **state)
{
    const float vague = 5e8f;
    struct rho_kalman kalman = opened(3, vague, vague);

    (void)state;
    for (int k = 0; k < 60; ++k) {
        if (k > 0) {
            assert_int_equal(rho_kalman_predict(&kalman, 1.0f, 0.0f), RHO_OK);
            assert_true(is_positive_definite(&kalman));
        }
        for (int axis = 0; axis < 3; ++axis) {
            const float position = 1000.0f + 30.0f * (float)(axis + 1) * (float)k;

            assert_int_equal(rho_kalman_update(&kalman, axis, position, 1.0f, NULL), RHO_OK);
            assert_true(is_positive_definite(&kalman));
        }
        assert_sane(&kalman);
    }
    /* A straight line through 60 points of variance 1: 4 / n and 12 / n^3. */
    for (int axis = 0; axis < 3; ++axis) {
        assert_float_equal(kalman.state[axis + 3], 30.0 * (axis + 1), 0.01);
        assert_float_equal(kalman.state[axis], 1000.0 + 30.0 * (axis + 1) * 59, 0.01);
        assert_in_range(kalman.covariance[RHO_AT(axis, axis)] * 60e3f, 3800, 4200);
        assert_in_range(kalman.covariance[RHO_AT(axis + 3, axis + 3)] * 216e6f, 11000, 13000);
    }
}

static uint32_t seed;

static float random_power(float lowest, float highest)
{
    seed = seed * 1664525u + 1013904223u;
    return powf(10.0f, lowest + (highest - lowest) * (float)(seed >> 8) / 16777216.0f);
}

static int random_below(int n)
{
    seed = seed * 1664525u + 1013904223u;
    return (int)(((uint64_t)seed * (uint64_t)n) >> 32);
}

/* One call in ten is nonsense, the others span all that is allowed. */
static float hostile(float usual)
{
    static const float nonsense[] = {NAN, INFINITY, -INFINITY, FLT_MAX, -FLT_MAX,
                                     FLT_TRUE_MIN, 0.0f, -1.0f};

    return random_below(10) == 0 ? nonsense[random_below(NUM(nonsense))] : usual;
}

static enum rho_status hostile_call(struct rho_kalman *kalman)
{
    const float sign = random_below(4) == 0 ? -1.0f : 1.0f;
    float nis;

    switch (random_below(20)) {
    case 0:
        return rho_kalman_open_axis(kalman, random_below(4), hostile(random_power(-3.0f, 7.0f)),
                                    hostile(random_power(-9.0f, 12.0f)),
                                    hostile(random_power(-9.0f, 12.0f)));
    case 1:
    case 2:
    case 3:
    case 4:
    case 5:
        return rho_kalman_predict(kalman, hostile(sign * random_power(-4.0f, 5.0f)),
                                  hostile(random_power(-6.0f, 6.0f)));
    default:
        return rho_kalman_update(kalman, random_below(7) - (random_below(50) == 0),
                                 hostile(sign * random_power(-3.0f, 7.0f)),
                                 hostile(random_power(-12.0f, 12.0f)), &nis);
    }
}

static void a_million_hostile_calls(void **state)
{
    struct rho_kalman kalman;
    int accepted = 0;

    (void)state;
    seed = 99;
    rho_kalman_init(&kalman);
    for (int i = 0; i < 1000000; ++i) {
        const struct rho_kalman before = kalman;
        const enum rho_status status = hostile_call(&kalman);

        accepted += status == RHO_OK;
        if (status != RHO_OK) {
            assert_changed_nothing(&kalman, &before);
        }
        assert_sane(&kalman);
        assert_true(is_positive_definite(&kalman));
    }
    assert_in_range(accepted, 500000, 900000); /* neither all refused nor none */
}

static void the_same_calls_give_the_same_bits(void **state)
{
    struct rho_kalman one, other;

    (void)state;
    memset(&one, 0x11, sizeof one);
    memset(&other, 0xee, sizeof other);
    struct rho_kalman *const kalmans[] = {&one, &other};
    for (int k = 0; k < 2; ++k) {
        seed = 4711;
        rho_kalman_init(kalmans[k]);
        for (int i = 0; i < 5000; ++i) {
            (void)!hostile_call(kalmans[k]);
        }
    }
    assert_memory_equal(&one, &other, sizeof one);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sequences_agree_with_the_vector_filter),
        cmocka_unit_test(init_measures_nothing),
        cmocka_unit_test(axes_are_open_once_opened),
        cmocka_unit_test(opening_an_axis_uncouples_it),
        cmocka_unit_test(open_axis_refuses_bad_arguments),
        cmocka_unit_test(a_closed_axis_stays_zero),
        cmocka_unit_test(no_time_changes_nothing),
        cmocka_unit_test(one_long_step_equals_several_short_ones),
        cmocka_unit_test(forth_and_back_is_the_identity),
        cmocka_unit_test(going_back_adds_no_noise),
        cmocka_unit_test(predict_refuses_bad_arguments),
        cmocka_unit_test(predict_refuses_results_beyond_the_limit),
        cmocka_unit_test(predict_refuses_a_bad_estimate),
        cmocka_unit_test(an_update_by_hand),
        cmocka_unit_test(update_refuses_bad_arguments),
        cmocka_unit_test(update_refuses_a_bad_estimate),
        cmocka_unit_test(updates_keep_the_variance_floor),
        cmocka_unit_test(a_vague_start_with_a_sharp_sensor),
        cmocka_unit_test(a_million_hostile_calls),
        cmocka_unit_test(the_same_calls_give_the_same_bits),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
