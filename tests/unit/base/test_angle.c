/* SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "vectors/angle_vectors.h"

#define TURN 6.28318530717958647692
#define HALF_TURN (TURN / 2.0)

#define WRAP_ABSOLUTE 3e-7
#define DIFFERENCE_ABSOLUTE 8e-7
#define THETA_ABSOLUTE 4e-7
#define RHO_RELATIVE 3e-7 /* relative to the point's distance from the origin */

#define NUM(array) (sizeof(array) / sizeof((array)[0]))

/* The angle between two directions, 0 to pi. */
static double angle_between(double a, double b)
{
    return fabs(remainder(a - b, TURN));
}

static void wrapped_angles_agree_with_the_reference(void **state)
{
    (void)state;
    for (size_t i = 0; i < NUM(angle_vectors); ++i) {
        const float wrapped = rho_angle_wrap(angle_vectors[i].a_rad);

        assert_true(wrapped >= -RHO_PI && wrapped < RHO_PI);
        assert_true(angle_between(wrapped, angle_vectors[i].wrap) <= WRAP_ABSOLUTE);
    }
}

static void angle_differences_agree_with_the_reference(void **state)
{
    (void)state;
    for (size_t i = 0; i < NUM(angle_vectors); ++i) {
        const struct angle_vector *v = &angle_vectors[i];
        const float difference = rho_angle_difference(v->a_rad, v->b_rad);

        assert_true(difference >= -RHO_PI && difference < RHO_PI);
        assert_true(angle_between(difference, v->difference) <= DIFFERENCE_ABSOLUTE);
    }
}

static void wrapping_is_right_over_a_dense_sweep(void **state)
{
    (void)state;
    for (int i = -399000; i <= 399000; ++i) {
        const float angle = (float)i * 2.5e-4f;
        const float wrapped = rho_angle_wrap(angle);

        assert_true(wrapped >= -RHO_PI && wrapped < RHO_PI);
        assert_true(angle_between(wrapped, angle) <= WRAP_ABSOLUTE);
    }
}

/* Floats on both sides of every odd multiple of pi. */
static void wrapping_is_right_next_to_odd_multiples_of_pi(void **state)
{
    (void)state;
    for (int k = -31; k <= 31; k += 2) {
        float angle = (float)(k * HALF_TURN);

        for (int i = 0; i < 20; ++i) {
            angle = nextafterf(angle, -200.0f);
        }
        for (int i = 0; i < 40; ++i, angle = nextafterf(angle, 200.0f)) {
            const float wrapped = rho_angle_wrap(angle);

            assert_true(wrapped >= -RHO_PI && wrapped < RHO_PI);
            assert_true(angle_between(wrapped, angle) <= WRAP_ABSOLUTE);
        }
    }
}

static void wrapping_leaves_a_wrapped_angle_alone(void **state)
{
    const float angles[] = {0.0f, -0.0f, 1e-30f, 1.0f, -1.0f, -RHO_PI, nextafterf(RHO_PI, 0.0f)};

    (void)state;
    for (size_t i = 0; i < NUM(angles); ++i) {
        assert_true(rho_angle_wrap(angles[i]) == angles[i]);
    }
    assert_true(rho_angle_wrap(RHO_PI) < 0.0f);
}

static void angles_beyond_the_limit_give_nan(void **state)
{
    const float beyond = nextafterf(100.0f, 200.0f);
    const float bad[] = {beyond, -beyond, FLT_MAX, -FLT_MAX, INFINITY, -INFINITY, NAN};

    (void)state;
    assert_false(isnan(rho_angle_wrap(100.0f)));
    assert_false(isnan(rho_angle_wrap(-100.0f)));
    assert_false(isnan(rho_angle_difference(100.0f, -100.0f)));
    for (size_t i = 0; i < NUM(bad); ++i) {
        assert_true(isnan(rho_angle_wrap(bad[i])));
        assert_true(isnan(rho_angle_difference(bad[i], 1.0f)));
        assert_true(isnan(rho_angle_difference(1.0f, bad[i])));
        assert_int_equal(rho_angle_in_sector(bad[i], 0.0f, 1.0f), 0);
        assert_int_equal(rho_angle_in_sector(0.5f, bad[i], 1.0f), 0);
        assert_int_equal(rho_angle_in_sector(0.5f, 0.0f, bad[i]), 0);
        assert_int_equal(rho_angle_in_sector(0.5f, bad[i], bad[i]), 0);
        assert_int_equal(rho_angle_in_sector(bad[i], 0.0f, 0.0f), 0);
    }
}

static void an_angle_difference_goes_the_shorter_way(void **state)
{
    (void)state;
    assert_float_equal(rho_angle_difference(3.0f, -3.0f), 6.0 - TURN, 1e-6);
    assert_float_equal(rho_angle_difference(-3.0f, 3.0f), TURN - 6.0, 1e-6);
    assert_float_equal(rho_angle_difference(0.25f, 0.5f), -0.25, 0.0);
    assert_true(rho_angle_difference(1.5f, 1.5f) == 0.0f);
    assert_true(rho_angle_difference(-RHO_PI, 0.0f) == -RHO_PI);
    assert_float_equal(rho_angle_difference(0.0f, -RHO_PI), -RHO_PI, 3e-7);
}

static void sectors_contain_their_ends_and_all_between(void **state)
{
    (void)state;
    assert_int_equal(rho_angle_in_sector(0.5f, 0.5f, 1.5f), 1);
    assert_int_equal(rho_angle_in_sector(1.5f, 0.5f, 1.5f), 1);
    assert_int_equal(rho_angle_in_sector(1.0f, 0.5f, 1.5f), 1);
    assert_int_equal(rho_angle_in_sector(0.49f, 0.5f, 1.5f), 0);
    assert_int_equal(rho_angle_in_sector(1.51f, 0.5f, 1.5f), 0);
    assert_int_equal(rho_angle_in_sector(-3.0f, 0.5f, 1.5f), 0);
    /* ends exchanged: the sector is the rest of the circle */
    assert_int_equal(rho_angle_in_sector(1.0f, 1.5f, 0.5f), 0);
    assert_int_equal(rho_angle_in_sector(-3.0f, 1.5f, 0.5f), 1);
    assert_int_equal(rho_angle_in_sector(0.5f, 1.5f, 0.5f), 1);
    assert_int_equal(rho_angle_in_sector(1.5f, 1.5f, 0.5f), 1);
    /* across +-pi, and angles off by whole turns */
    assert_int_equal(rho_angle_in_sector(RHO_PI, 3.0f, -3.0f), 1);
    assert_int_equal(rho_angle_in_sector(-RHO_PI, 3.0f, 3.3f), 1);
    assert_int_equal(rho_angle_in_sector(0.0f, 3.0f, -3.0f), 0);
    assert_int_equal(rho_angle_in_sector(1.0f + 2.0f * RHO_TWO_PI, 0.5f - RHO_TWO_PI, 1.5f), 1);
}

static void a_sector_with_equal_ends_is_the_whole_circle(void **state)
{
    const float ends[][2] = {{0.0f, 0.0f},
                             {2.0f, 2.0f},
                             {-RHO_PI, RHO_PI},
                             {0.0f, RHO_TWO_PI},
                             {-1.0f, RHO_TWO_PI - 1.0f},
                             {99.0f, 99.0f}};

    (void)state;
    for (size_t i = 0; i < NUM(ends); ++i) {
        for (float angle = -7.0f; angle < 7.0f; angle += 0.01f) {
            assert_int_equal(rho_angle_in_sector(angle, ends[i][0], ends[i][1]), 1);
        }
    }
}

static void a_sector_continues_another_at_its_left_or_right_end(void **state)
{
    const unsigned left = RHO_ANGLE_CONTINUES_LEFT, right = RHO_ANGLE_CONTINUES_RIGHT;

    (void)state;
    assert_int_equal(rho_angle_continued_ends(0.0f, 1.0f, 1.0f, 1.5f, 0.0f), left);
    assert_int_equal(rho_angle_continued_ends(0.0f, 1.0f, -0.5f, 0.0f, 0.0f), right);
    assert_int_equal(rho_angle_continued_ends(0.0f, 1.0f, 1.0f, 0.0f, 0.0f), left | right);
    assert_int_equal(rho_angle_continued_ends(3.0f, -3.0f, -3.0f, -2.0f, 0.0f), left);
    assert_int_equal(rho_angle_continued_ends(0.0f, 1.0f, 1.0009f, 1.5f, 0.0f), left);
    assert_int_equal(rho_angle_continued_ends(0.0f, 1.0f, 0.9995f, 1.5f, 0.0f), left);
    assert_int_equal(rho_angle_continued_ends(0.0f, 1.0f, 1.0011f, 1.5f, 0.0f), 0);
    assert_int_equal(rho_angle_continued_ends(0.0f, 1.0f, 0.9989f, 1.5f, 0.0f), 0);
    /*
     * a gap between the sectors; the last argument is the largest gap allowed, and the nearer end
     * counts
     */
    assert_int_equal(rho_angle_continued_ends(0.0f, 1.0f, 1.2f, 1.5f, 0.0f), 0);
    assert_int_equal(rho_angle_continued_ends(0.0f, 1.0f, 1.2f, 1.5f, 0.3f), left);
    assert_int_equal(rho_angle_continued_ends(0.0f, 1.0f, -1.5f, -0.2f, 0.3f), right);
    assert_int_equal(rho_angle_continued_ends(0.0f, 5.0f, 5.5f, 6.0f, 1.0f), right);
    /*
     * sectors narrower than the tolerance: two of them are no circle, and one does not continue
     * itself
     */
    assert_int_equal(rho_angle_continued_ends(0.0f, 4e-4f, 4e-4f, 8e-4f, 0.5f), left);
    assert_int_equal(rho_angle_continued_ends(1.0f, 1.0004f, 0.9996f, 1.0f, 0.5f), right);
    assert_int_equal(rho_angle_continued_ends(0.0f, 5e-4f, 0.0f, 5e-4f, 0.5f), 0);
    /* sectors that overlap, whole circles, NAN: no continuation */
    assert_int_equal(rho_angle_continued_ends(0.0f, 1.0f, 0.5f, 1.5f, 0.3f), 0);
    assert_int_equal(rho_angle_continued_ends(0.0f, 6.1f, 0.0f, 0.2f, 0.5f), 0);
    assert_int_equal(rho_angle_continued_ends(0.0f, 1.0f, 0.0f, 1.0f, 0.5f), 0);
    assert_int_equal(rho_angle_continued_ends(0.0f, 0.0f, 0.0f, 1.0f, 0.5f), 0);
    assert_int_equal(rho_angle_continued_ends(0.0f, 1.0f, 2.0f, 2.0f, 7.0f), 0);
    assert_int_equal(rho_angle_continued_ends(NAN, 1.0f, 1.0f, 2.0f, 0.5f), 0);
    assert_float_equal(rho_angle_sector_width(3.0f, -3.0f), 2.0 * 3.14159265 - 6.0, 1e-6);
    assert_float_equal(rho_angle_sector_width(2.0f, 2.0f), 2.0 * 3.14159265, 1e-6);
}

static void random_sectors_contain_the_angles_between_their_ends(void **state)
{
    uint32_t seed = 5;

    (void)state;
    for (int i = 0; i < 100000; ++i) {
        float v[3];

        for (int k = 0; k < 3; ++k) {
            seed = seed * 1664525u + 1013904223u;
            v[k] = (float)((int32_t)(seed >> 8) - 8388608) * 2e-6f;
        }
        const double width = fmod(fmod((double)v[2] - v[1], TURN) + TURN, TURN);
        const double way = fmod(fmod((double)v[0] - v[1], TURN) + TURN, TURN);

        if (fabs(way - width) > 1e-4 && fabs(way) > 1e-4 && fabs(way - TURN) > 1e-4) {
            assert_int_equal(rho_angle_in_sector(v[0], v[1], v[2]), way < width);
        }
    }
}

/* Compares lines, where (rho, 0) and (-rho, pi) are the same one. */
static void assert_line(struct rho_line line, double rho_m, double theta_rad,
                        double tolerance_scale_m)
{
    double theta_error = line.theta_rad - theta_rad;

    if (fabs(theta_error) > HALF_TURN / 2.0) {
        theta_error -= copysign(HALF_TURN, theta_error);
        rho_m = -rho_m;
    }
    assert_true(line.theta_rad >= 0.0f && line.theta_rad < RHO_PI);
    assert_true(fabs(theta_error) <= THETA_ABSOLUTE);
    assert_true(fabs(line.rho_m - rho_m) <= RHO_RELATIVE * tolerance_scale_m);
}

static void lines_of_place_and_direction_agree_with_the_reference(void **state)
{
    (void)state;
    for (size_t i = 0; i < NUM(line_vectors); ++i) {
        const struct line_vector *v = &line_vectors[i];

        assert_line(rho_angle_line(v->x_m, v->y_m, v->dx, v->dy), v->rho_m, v->theta_rad,
                    hypot(v->x_m, v->y_m));
    }
}

static void lines_along_the_axes_have_exact_rho_and_theta(void **state)
{
    (void)state;
    assert_line(rho_angle_line(5.0f, 2.0f, 1.0f, 0.0f), 2.0, HALF_TURN / 2.0, 1.0);
    assert_line(rho_angle_line(5.0f, 2.0f, -1.0f, 0.0f), 2.0, HALF_TURN / 2.0, 1.0);
    assert_line(rho_angle_line(5.0f, 2.0f, 0.0f, 1.0f), 5.0, 0.0, 1.0);
    assert_line(rho_angle_line(5.0f, 2.0f, 0.0f, -1.0f), 5.0, 0.0, 1.0);
    assert_line(rho_angle_line(5.0f, 2.0f, -0.0f, 1.0f), 5.0, 0.0, 1.0);
    assert_line(rho_angle_line(-5.0f, 2.0f, -0.0f, -1.0f), -5.0, 0.0, 1.0);
    /* nearly vertical, theta rounds to pi: returned as theta 0 */
    assert_line(rho_angle_line(5.0f, 0.0f, -1e-12f, -1.0f), 5.0, 0.0, 5.0);
    assert_line(rho_angle_line(5.0f, 0.0f, -1e-12f, 1.0f), 5.0, 0.0, 5.0);
}

/*
 * A direction and its opposite give the same line; a point mirrored in the origin changes the sign
 * of rho.
 */
static void opposite_directions_are_one_line_and_mirroring_negates_rho(void **state)
{
    (void)state;
    for (int i = 0; i < 360; ++i) {
        const float dx = cosf((float)i * 0.01745f + 0.01f), dy = sinf((float)i * 0.01745f + 0.01f);
        const struct rho_line line = rho_angle_line(300.0f, 400.0f, dx, dy);
        const struct rho_line back = rho_angle_line(300.0f, 400.0f, -dx, -dy);
        const struct rho_line mirror = rho_angle_line(-300.0f, -400.0f, dx, dy);

        assert_line(back, line.rho_m, line.theta_rad, 500.0);
        assert_line(mirror, -(double)line.rho_m, line.theta_rad, 500.0);
    }
}

static void a_line_of_zero_or_not_finite_direction_is_nan(void **state)
{
    const float bad[][2] = {{0.0f, 0.0f},     {-0.0f, 0.0f},     {NAN, 1.0f}, {1.0f, NAN},
                            {INFINITY, 1.0f}, {1.0f, -INFINITY}, {NAN, NAN},  {INFINITY, INFINITY}};

    (void)state;
    for (size_t i = 0; i < NUM(bad); ++i) {
        const struct rho_line line = rho_angle_line(1.0f, 2.0f, bad[i][0], bad[i][1]);

        assert_true(isnan(line.rho_m));
        assert_true(isnan(line.theta_rad));
    }
    assert_true(isnan(rho_angle_line(NAN, 1.0f, 1.0f, 1.0f).rho_m));
}

static void theta_cells_divide_half_a_turn_evenly(void **state)
{
    (void)state;
    for (int32_t n = 1; n <= 720; ++n) {
        for (int32_t k = 0; k < n; ++k) {
            const float middle = (float)((k + 0.5) * HALF_TURN / n);

            assert_int_equal(rho_angle_clamped_theta_cell(middle, n), k);
        }
    }
}

static void thetas_out_of_range_are_in_the_nearest_cell(void **state)
{
    const int32_t counts[] = {1, 2, 180, 16777217, INT32_MAX};

    (void)state;
    for (size_t i = 0; i < NUM(counts); ++i) {
        const int32_t n = counts[i];

        assert_int_equal(rho_angle_clamped_theta_cell(0.0f, n), 0);
        assert_int_equal(rho_angle_clamped_theta_cell(-1e-6f, n), 0);
        assert_int_equal(rho_angle_clamped_theta_cell(-FLT_MAX, n), 0);
        assert_int_equal(rho_angle_clamped_theta_cell(-INFINITY, n), 0);
        assert_int_equal(rho_angle_clamped_theta_cell(NAN, n), 0);
        assert_int_equal(rho_angle_clamped_theta_cell(RHO_PI, n), n - 1);
        assert_int_equal(rho_angle_clamped_theta_cell(4.0f, n), n - 1);
        assert_int_equal(rho_angle_clamped_theta_cell(FLT_MAX, n), n - 1);
        assert_int_equal(rho_angle_clamped_theta_cell(INFINITY, n), n - 1);
        assert_in_range(rho_angle_clamped_theta_cell(nextafterf(RHO_PI, 0.0f), n), 0, n - 1);
    }
    assert_int_equal(rho_angle_clamped_theta_cell(nextafterf(RHO_PI, 0.0f), 180), 179);
    assert_int_equal(rho_angle_clamped_theta_cell(1.0f, 0), 0);
    assert_int_equal(rho_angle_clamped_theta_cell(1.0f, -5), 0);
    assert_int_equal(rho_angle_clamped_theta_cell(1.0f, INT32_MIN), 0);
}

static void ends_of_sectors_are_within_one_turn_of_zero(void **state)
{
    const float most_rad = RHO_TWO_PI, beyond_rad = nextafterf(RHO_TWO_PI, INFINITY);

    (void)state;
    assert_true(rho_angle_is_valid_sector(-most_rad, most_rad));
    assert_true(rho_angle_is_valid_sector(1.0f, 1.0f));
    assert_false(rho_angle_is_valid_sector(beyond_rad, 0.0f));
    assert_false(rho_angle_is_valid_sector(0.0f, beyond_rad));
    assert_false(rho_angle_is_valid_sector(-beyond_rad, 0.0f));
    assert_false(rho_angle_is_valid_sector(0.0f, NAN));
    assert_false(rho_angle_is_valid_sector(INFINITY, 0.0f));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrapped_angles_agree_with_the_reference),
        cmocka_unit_test(angle_differences_agree_with_the_reference),
        cmocka_unit_test(wrapping_is_right_over_a_dense_sweep),
        cmocka_unit_test(wrapping_is_right_next_to_odd_multiples_of_pi),
        cmocka_unit_test(wrapping_leaves_a_wrapped_angle_alone),
        cmocka_unit_test(angles_beyond_the_limit_give_nan),
        cmocka_unit_test(an_angle_difference_goes_the_shorter_way),
        cmocka_unit_test(sectors_contain_their_ends_and_all_between),
        cmocka_unit_test(a_sector_with_equal_ends_is_the_whole_circle),
        cmocka_unit_test(a_sector_continues_another_at_its_left_or_right_end),
        cmocka_unit_test(random_sectors_contain_the_angles_between_their_ends),
        cmocka_unit_test(lines_of_place_and_direction_agree_with_the_reference),
        cmocka_unit_test(lines_along_the_axes_have_exact_rho_and_theta),
        cmocka_unit_test(opposite_directions_are_one_line_and_mirroring_negates_rho),
        cmocka_unit_test(a_line_of_zero_or_not_finite_direction_is_nan),
        cmocka_unit_test(theta_cells_divide_half_a_turn_evenly),
        cmocka_unit_test(thetas_out_of_range_are_in_the_nearest_cell),
        cmocka_unit_test(ends_of_sectors_are_within_one_turn_of_zero),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
