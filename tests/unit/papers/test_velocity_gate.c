/* SPDX-License-Identifier: MIT */
/*
 * Hough clutter elimination: theta* compared with all cells in double precision, and the residuals
 * by which the target's plot is chosen.
 */
#include <float.h>
#include <string.h>

#include "dense_filter.h"

#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/gate.h"

#define PLANES_ALL (RHO_GATE_PLANE_XY | RHO_GATE_PLANE_XZ | RHO_GATE_PLANE_YZ)
#define FIVE_DEGREES 0.0872664626f
#define NUM(array) (sizeof(array) / sizeof((array)[0]))

/* accuracy of the library's angles */
#define ANGLE_RAD 2e-6

static const int axes_of[RHO_GATE_PLANES][2] = {{0, 1}, {0, 2}, {1, 2}};

static double change_of_rho(const double change[2], double theta_rad)
{
    return fabs(change[0] * cos(theta_rad) + change[1] * sin(theta_rad));
}

static double centre_of(int cell, float theta_cell_rad)
{
    return (cell + 0.5) * (double)theta_cell_rad;
}

/* The best cell by trying all; of cells equal within rounding the lowest. */
static int cell_of_least_rho_change(const double change[2], float theta_cell_rad)
{
    const double size = hypot(change[0], change[1]);
    int best = 0;

    for (int cell = 1; centre_of(cell, theta_cell_rad) < RHO_PI; ++cell) {
        if (change_of_rho(change, centre_of(cell, theta_cell_rad)) <
            change_of_rho(change, centre_of(best, theta_cell_rad)) - 1e-12 * size) {
            best = cell;
        }
    }
    return best;
}

/* Expects the best cell, or, unless is_exact, another cell that is as good within ANGLE_RAD. */
static void assert_best_theta(const struct rho_gate_hough *hough, int plane,
                              const float change_mps[3], float theta_cell_rad, int is_exact)
{
    const double change[2] = {change_mps[axes_of[plane][0]], change_mps[axes_of[plane][1]]};
    const double size = hypot(change[0], change[1]);
    const double theta_rad = atan2(hough->sin_theta[plane], hough->cos_theta[plane]);
    const double best_rad =
        centre_of(cell_of_least_rho_change(change, theta_cell_rad), theta_cell_rad);

    assert_float_equal(hypot(hough->sin_theta[plane], hough->cos_theta[plane]), 1.0, 1e-6);
    if (is_exact || fabs(theta_rad - best_rad) < ANGLE_RAD) {
        assert_float_equal(theta_rad, best_rad, ANGLE_RAD);
        return;
    }
    const double cells = theta_rad / theta_cell_rad - 0.5;
    assert_float_equal(cells, round(cells), 2.0 * ANGLE_RAD / theta_cell_rad);
    assert_float_equal(change_of_rho(change, theta_rad), change_of_rho(change, best_rad),
                       ANGLE_RAD * size);
}

static struct rho_gate_hough prepared_hough(uint8_t planes, float theta_cell_rad,
                                            const float change_mps[3])
{
    const float nothing_mps[3] = {0.0f, 0.0f, 0.0f};
    struct rho_gate_hough hough;

    assert_int_equal(rho_gate_hough_init(&hough, planes, theta_cell_rad, nothing_mps, change_mps),
                     RHO_OK);
    return hough;
}

static void theta_is_that_of_the_best_of_all_cells(void **state)
{
    const float cells_rad[] = {FIVE_DEGREES, 0.7f,          0.3f,  1.0f,   1.3f,
                               RHO_HALF_PI,  0.0174532925f, 1e-3f, 0.0123f};

    (void)state;
    for (size_t k = 0; k < NUM(cells_rad); ++k) {
        for (int n = 0; n < (cells_rad[k] < 0.01f ? 300 : 3000); ++n) {
            float change_mps[3];

            for (int i = 0; i < 3; ++i) {
                const double power = uniform(-3.0, 3.0);
                change_mps[i] = (float)(pow(10.0, power) * normal());
            }
            const struct rho_gate_hough hough =
                prepared_hough(PLANES_ALL, cells_rad[k], change_mps);
            for (int plane = 0; plane < RHO_GATE_PLANES; ++plane) {
                assert_best_theta(&hough, plane, change_mps, cells_rad[k], 0);
            }
        }
    }
}

/*
 * If cells divide pi, the two cells beside the normal of a change along an axis are equally good:
 * at 90 degrees that from 85 to 90, at 0 degrees that from 0 to 5. The lower one must be chosen.
 */
static void assert_lowest_cell_chosen(float along, float across, int is_second)
{
    const float change_mps[3] = {is_second ? across : along, is_second ? along : across, 0.0f};
    const struct rho_gate_hough hough = prepared_hough(RHO_GATE_PLANE_XY, FIVE_DEGREES, change_mps);
    const double theta_rad = atan2(hough.sin_theta[0], hough.cos_theta[0]);

    assert_float_equal(theta_rad, (is_second ? 2.5 : 87.5) * acos(-1.0) / 180.0, ANGLE_RAD);
}

static void of_equally_good_cells_the_lowest_is_chosen(void **state)
{
    const float lengths[] = {1e-30f, 1e-3f, 1.0f, 77.0f, 1e10f, 1e37f};
    const float tilts[] = {0.0f, 1e-9f, 1e-7f, 5e-7f, -1e-9f, -1e-7f, -5e-7f};

    (void)state;
    for (size_t k = 0; k < NUM(lengths); ++k) {
        for (size_t n = 0; n < NUM(tilts); ++n) {
            for (int is_second = 0; is_second <= 1; ++is_second) {
                assert_lowest_cell_chosen(lengths[k], tilts[n] * lengths[k], is_second);
                assert_lowest_cell_chosen(-lengths[k], tilts[n] * lengths[k], is_second);
            }
        }
    }
}

static void theta_is_the_best_for_all_directions_and_cell_sizes(void **state)
{
    (void)state;
    for (int n = 0; n < 20000; ++n) {
        const double direction = uniform(-3.2, 3.2), logarithm = uniform(log(2e-3), log(1.57));
        const float change_mps[3] = {(float)(20.0 * cos(direction)), (float)(20.0 * sin(direction)),
                                     0.0f};
        const float theta_cell_rad = (float)exp(logarithm);
        const struct rho_gate_hough hough =
            prepared_hough(RHO_GATE_PLANE_XY, theta_cell_rad, change_mps);

        assert_best_theta(&hough, 0, change_mps, theta_cell_rad, 0);
    }
}

static void without_a_change_of_velocity_the_lowest_cell_is_chosen(void **state)
{
    const float velocity_mps[3] = {-600.0f, -500.0f, 20.0f};
    struct rho_gate_hough hough;

    (void)state;
    assert_int_equal(rho_gate_hough_init(&hough, PLANES_ALL, 0.3f, velocity_mps, velocity_mps),
                     RHO_OK);
    for (int plane = 0; plane < RHO_GATE_PLANES; ++plane) {
        assert_float_equal(hough.cos_theta[plane], cos(0.15), 1e-6);
        assert_float_equal(hough.sin_theta[plane], sin(0.15), 1e-6);
    }
}

static void residuals_are_sums_of_rho_over_the_chosen_planes(void **state)
{
    (void)state;
    for (int n = 0; n < 2000; ++n) {
        const uint8_t planes = (uint8_t)(1 + n % 7);
        float before_mps[3], newest_mps[3], plot_mps[3];
        struct rho_gate_hough hough;
        double expected = 0.0;

        for (int i = 0; i < 3; ++i) {
            const double at = 300.0 * normal(), change = 5.0 * normal(), off = 500.0 * normal();

            before_mps[i] = (float)at;
            newest_mps[i] = (float)(at + change);
            plot_mps[i] = (float)(at + off);
        }
        assert_int_equal(rho_gate_hough_init(&hough, planes, FIVE_DEGREES, before_mps, newest_mps),
                         RHO_OK);
        for (int plane = 0; plane < RHO_GATE_PLANES; ++plane) {
            const int a = axes_of[plane][0], b = axes_of[plane][1];
            const double change[2] = {(double)newest_mps[a] - before_mps[a],
                                      (double)newest_mps[b] - before_mps[b]};
            const double off[2] = {(double)plot_mps[a] - newest_mps[a],
                                   (double)plot_mps[b] - newest_mps[b]};

            if (planes >> plane & 1) {
                expected += change_of_rho(
                    off, centre_of(cell_of_least_rho_change(change, FIVE_DEGREES), FIVE_DEGREES));
            }
        }
        assert_float_equal(rho_gate_hough_distance_mps(&hough, plot_mps), expected, 2e-3);
    }
}

/* The velocity of an accelerating target changes along its line; clutter is off that line. */
static void an_accelerating_target_has_a_smaller_residual_than_clutter(void **state)
{
    int right = 0;

    (void)state;
    for (int n = 0; n < 1000; ++n) {
        float before_mps[3], newest_mps[3], target_mps[3];
        struct rho_gate_hough hough;
        int best = -1;

        for (int i = 0; i < 3; ++i) {
            const double v = 400.0 * normal(), change = 15.0 * normal(), noise = normal();

            before_mps[i] = (float)v;
            newest_mps[i] = (float)(v + change);
            target_mps[i] = (float)(v + 2.0 * change + noise);
        }
        assert_int_equal(
            rho_gate_hough_init(&hough, PLANES_ALL, FIVE_DEGREES, before_mps, newest_mps), RHO_OK);
        float least = rho_gate_hough_distance_mps(&hough, target_mps);
        for (int k = 0; k < 4; ++k) {
            float clutter_mps[3];

            for (int i = 0; i < 3; ++i) {
                clutter_mps[i] = newest_mps[i] + (float)uniform(-2000.0, 2000.0);
            }
            const float off = rho_gate_hough_distance_mps(&hough, clutter_mps);
            if (off < least) {
                least = off;
                best = k;
            }
        }
        right += best < 0;
    }
    assert_in_range(right, 990, 1000);
}

static void assert_init_refused(uint8_t planes, float theta_cell_rad, const float before_mps[3],
                                const float newest_mps[3], enum rho_status expected)
{
    struct rho_gate_hough hough, before;

    memset(&hough, 0x5a, sizeof hough);
    before = hough;
    assert_int_equal(rho_gate_hough_init(&hough, planes, theta_cell_rad, before_mps, newest_mps),
                     expected);
    assert_memory_equal(&hough, &before, sizeof hough);
}

static void bad_arguments_are_refused(void **state)
{
    const float good[3] = {1.0f, 2.0f, 3.0f};
    const float bad_cells[] = {0.0f, -0.1f, 0.99e-3f, 1.571f, NAN, INFINITY, -INFINITY};
    const float bad[] = {NAN, INFINITY, -INFINITY};

    (void)state;
    assert_int_equal(rho_gate_hough_init(NULL, 1, 0.1f, good, good), RHO_ERROR_NULL);
    assert_init_refused(1, 0.1f, NULL, good, RHO_ERROR_NULL);
    assert_init_refused(1, 0.1f, good, NULL, RHO_ERROR_NULL);
    assert_init_refused(0, 0.1f, good, good, RHO_ERROR_VALUE);
    assert_init_refused(8, 0.1f, good, good, RHO_ERROR_VALUE);
    for (size_t k = 0; k < NUM(bad_cells); ++k) {
        assert_init_refused(1, bad_cells[k], good, good, RHO_ERROR_VALUE);
    }
    for (size_t k = 0; k < NUM(bad); ++k) {
        for (int i = 0; i < 3; ++i) {
            float velocity_mps[3] = {1.0f, 2.0f, 3.0f};

            velocity_mps[i] = bad[k];
            assert_init_refused(1, 0.1f, velocity_mps, good, RHO_ERROR_VALUE);
            assert_init_refused(1, 0.1f, good, velocity_mps, RHO_ERROR_VALUE);
        }
    }
    struct rho_gate_hough finest;
    assert_int_equal(rho_gate_hough_init(&finest, 1, 1.01e-3f, good, good), RHO_OK);
    const float most[3] = {FLT_MAX, 0.0f, 0.0f}, least[3] = {-FLT_MAX, 0.0f, 0.0f};
    assert_init_refused(1, 0.1f, least, most, RHO_ERROR_VALUE);
}

static void a_plot_with_nan_is_never_nearest(void **state)
{
    const float change_mps[3] = {1.0f, 2.0f, 3.0f}, plot_mps[3] = {NAN, 2.0f, 3.0f};
    const struct rho_gate_hough hough = prepared_hough(PLANES_ALL, 0.1f, change_mps);

    (void)state;
    assert_false(rho_gate_hough_distance_mps(&hough, plot_mps) <= FLT_MAX);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(theta_is_that_of_the_best_of_all_cells),
        cmocka_unit_test(of_equally_good_cells_the_lowest_is_chosen),
        cmocka_unit_test(theta_is_the_best_for_all_directions_and_cell_sizes),
        cmocka_unit_test(without_a_change_of_velocity_the_lowest_cell_is_chosen),
        cmocka_unit_test(residuals_are_sums_of_rho_over_the_chosen_planes),
        cmocka_unit_test(an_accelerating_target_has_a_smaller_residual_than_clutter),
        cmocka_unit_test(bad_arguments_are_refused),
        cmocka_unit_test(a_plot_with_nan_is_never_nearest),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
