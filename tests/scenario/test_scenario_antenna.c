/* SPDX-License-Identifier: MIT */
/*
 * What a turning antenna sees: when it meets moving targets, in which sector, with which noise and biases. Seeds are fixed;
 * bounds are four standard deviations.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "scenario_antenna.h"

#define TURN_RAD 6.283185307179586
#define NUM_TARGETS 40
#define NUM_TURNS 100

/* Straight at 300 m/s, some 10 to 90 km from the origin; the last one is there from 100 s to 200 s alone. */
static bool fly(const void *context, size_t target, double t_s, struct truth_point *truth)
{
    struct random random = random_start(7, 0, target);
    double heading_rad = random_between(&random, 0.0, TURN_RAD);
    double x_m = random_between(&random, -60000.0, 60000.0);
    double y_m = random_between(&random, -60000.0, 60000.0);

    (void)context;
    *truth = (struct truth_point){.t_s = t_s,
                                  .target_id = (int)target,
                                  .x_m = x_m + 300.0 * cos(heading_rad) * t_s,
                                  .y_m = y_m + 300.0 * sin(heading_rad) * t_s,
                                  .vx_mps = 300.0 * cos(heading_rad),
                                  .vy_mps = 300.0 * sin(heading_rad)};
    return target + 1 < NUM_TARGETS || (t_s >= 100.0 && t_s <= 200.0);
}

static const struct antenna_targets targets = {.count = NUM_TARGETS, .at = fly};

static struct scenario_antenna antenna_of(bool is_counter_clockwise)
{
    return (struct scenario_antenna){.sensor_id = 3,
                                     .x_m = 1000.0,
                                     .y_m = -2000.0,
                                     .turn_s = 4.0,
                                     .start_s = 1.7,
                                     .start_rad = 2.5,
                                     .is_counter_clockwise = is_counter_clockwise,
                                     .sectors = 32,
                                     .pd = 1.0,
                                     .range_min_m = 5000.0,
                                     .range_max_m = 60000.0,
                                     .has_range_rate = true};
}

static double turned_rad(double from_rad, double to_rad)
{
    return remainder(to_rad - from_rad, TURN_RAD);
}

/* Without noise every plot is where the target and the antenna are at that time, and in the sector of that time. */
static void check_exact(const struct scenario_antenna *antenna)
{
    struct random random = random_start(1, 2, 3);
    struct antenna_view view = antenna_watch(antenna, &targets, NUM_TURNS, &random);
    size_t seen = 0;

    assert_int_equal(view.num_sectors, 32 * NUM_TURNS);
    for (size_t i = 0; i < view.num_sectors; i++) {
        const struct antenna_sector *sector = &view.sectors[i];

        for (size_t j = 0; j < sector->num_plots; j++) {
            const struct antenna_plot *plot = &sector->plots[j];
            double true_s = plot->t_s - antenna->time_bias_s;
            struct truth_point truth;

            assert_true(fly(NULL, (size_t)plot->target_id, true_s, &truth));
            double x_m = truth.x_m - antenna->x_m, y_m = truth.y_m - antenna->y_m;
            assert_true(fabs(hypot(x_m, y_m) + antenna->range_bias_m - plot->range_m) < 1e-6);
            assert_true(fabs(turned_rad(atan2(y_m, x_m) + antenna->azimuth_bias_rad,
                                        plot->azimuth_rad)) < 1e-9);
            assert_true(fabs(turned_rad(antenna_azimuth_rad(antenna, plot->t_s),
                                        plot->azimuth_rad)) < 1e-9);
            assert_true(fabs(plot->truth.x_m - truth.x_m) < 1e-6);
            assert_true(plot->t_s >= sector->start_s && plot->t_s < sector->end_s);
            assert_true(turned_rad(sector->from_rad, plot->azimuth_rad) > -1e-9);
            assert_true(turned_rad(plot->azimuth_rad, sector->to_rad) > -1e-9);
            assert_true(plot->range_m - antenna->range_bias_m >= antenna->range_min_m &&
                        plot->range_m - antenna->range_bias_m <= antenna->range_max_m);
            seen++;
        }
    }
    assert_true(seen > NUM_TARGETS * NUM_TURNS / 4);
    antenna_view_free(&view);
}

static void test_meets_targets_when_it_points_there(void **state)
{
    struct scenario_antenna antenna = antenna_of(false);

    (void)state;
    check_exact(&antenna);
    antenna.is_counter_clockwise = true;
    check_exact(&antenna);
    antenna.range_bias_m = 50.0;
    antenna.azimuth_bias_rad = -0.002;
    antenna.time_bias_s = 0.3;
    check_exact(&antenna);
}

/* A target in reach all the time is met once a turn but for what it moves round meanwhile; one that is there for 100 s of
 * 4 s turns 25 times. */
static void test_meets_each_once_a_turn(void **state)
{
    struct scenario_antenna antenna = antenna_of(false);
    struct random random = random_start(1, 2, 3);
    size_t counts[NUM_TARGETS] = {0};
    double last_s[NUM_TARGETS];

    (void)state;
    memset(last_s, 0, sizeof last_s);
    antenna.range_min_m = 0.0;
    antenna.range_max_m = 1e6;
    struct antenna_view view = antenna_watch(&antenna, &targets, NUM_TURNS, &random);
    for (size_t i = 0; i < view.num_sectors; i++) {
        for (size_t j = 0; j < view.sectors[i].num_plots; j++) {
            const struct antenna_plot *plot = &view.sectors[i].plots[j];
            double gap_s = plot->t_s - last_s[plot->target_id];

            assert_true(counts[plot->target_id] == 0 || (gap_s > 3.5 && gap_s < 4.5));
            last_s[plot->target_id] = plot->t_s;
            counts[plot->target_id]++;
        }
    }
    for (size_t target = 0; target + 1 < NUM_TARGETS; target++) {
        assert_true(counts[target] >= NUM_TURNS - 1 && counts[target] <= NUM_TURNS + 1);
    }
    assert_true(counts[NUM_TARGETS - 1] >= 24 && counts[NUM_TARGETS - 1] <= 26);
    antenna_view_free(&view);
}

/* Sectors follow one another in time and angle, the way the antenna turns, and close the circle. */
static void test_sectors_close_the_circle(void **state)
{
    for (int is_counter_clockwise = 0; is_counter_clockwise < 2; is_counter_clockwise++) {
        struct scenario_antenna antenna = antenna_of(is_counter_clockwise);

        for (size_t i = 0; i < 70; i++) {
            struct antenna_sector one = antenna_sector_at(&antenna, i);
            struct antenna_sector next = antenna_sector_at(&antenna, i + 1);

            assert_true(fabs(one.end_s - next.start_s) < 1e-12);
            assert_true(fabs(one.end_s - one.start_s - 0.125) < 1e-12);
            assert_true(fabs(turned_rad(one.from_rad, one.to_rad) - TURN_RAD / 32.0) < 1e-9);
            assert_true(is_counter_clockwise ? one.to_rad == next.from_rad
                                             : one.from_rad == next.to_rad);
            assert_true(antenna_sector_at(&antenna, i + 32).from_rad == one.from_rad);
        }
    }
    struct scenario_antenna whole = antenna_of(false);
    whole.sectors = 1;
    assert_true(antenna_sector_at(&whole, 5).from_rad == antenna_sector_at(&whole, 5).to_rad);
    (void)state;
}

static void assert_normal(const char *what, const double sums[2], double count)
{
    double mean = sums[0] / count, variance = sums[1] / count - mean * mean;

    print_message("%s: mean %.4f, variance %.4f of %g\n", what, mean, variance, count);
    assert_true(fabs(mean) < 4.0 / sqrt(count));
    assert_true(fabs(variance - 1.0) < 4.0 * sqrt(2.0 / count));
}

static void assert_same(const struct antenna_plot *one, const struct antenna_plot *other)
{
    assert_true(one->target_id == other->target_id && one->t_s == other->t_s &&
                one->range_m == other->range_m && one->azimuth_rad == other->azimuth_rad &&
                one->range_rate_mps == other->range_rate_mps);
}

/* Noise beside the biases, detections, clutter; and clutter changes no target's plot. */
static void test_chance_is_what_it_says(void **state)
{
    struct scenario_antenna antenna = antenna_of(false);
    double range[2] = {0}, azimuth[2] = {0}, rate[2] = {0}, seen = 0, clutter = 0;

    (void)state;
    antenna.pd = 0.8;
    antenna.range_max_m = 1e6;
    antenna.range_min_m = 0.0;
    antenna.sigma_range_m = 40.0;
    antenna.sigma_azimuth_rad = 0.002;
    antenna.sigma_range_rate_mps = 2.0;
    antenna.range_bias_m = -50.0;
    antenna.azimuth_bias_rad = 0.00175;
    struct random random = random_start(1, 2, 3);
    struct antenna_view clean = antenna_watch(&antenna, &targets, NUM_TURNS, &random);
    antenna.clutter_mean = 30.0;
    antenna.clutter_rate_max_mps = 100.0;
    random = random_start(1, 2, 3);
    struct antenna_view view = antenna_watch(&antenna, &targets, NUM_TURNS, &random);
    for (size_t i = 0; i < view.num_sectors; i++) {
        size_t row = 0;

        for (size_t j = 0; j < view.sectors[i].num_plots; j++) {
            const struct antenna_plot *plot = &view.sectors[i].plots[j];

            if (plot->target_id < 0) {
                clutter++;
                continue;
            }
            assert_same(plot, &clean.sectors[i].plots[row++]);
            double x_m = plot->truth.x_m - 1000.0, y_m = plot->truth.y_m + 2000.0;
            double range_m = hypot(x_m, y_m);
            double off[3] = {(plot->range_m - range_m + 50.0) / 40.0,
                             turned_rad(atan2(y_m, x_m) + 0.00175, plot->azimuth_rad) / 0.002,
                             (plot->range_rate_mps -
                              (x_m * plot->truth.vx_mps + y_m * plot->truth.vy_mps) / range_m) /
                                 2.0};
            range[0] += off[0];
            range[1] += off[0] * off[0];
            azimuth[0] += off[1];
            azimuth[1] += off[1] * off[1];
            rate[0] += off[2];
            rate[1] += off[2] * off[2];
            seen++;
        }
        assert_int_equal(row, clean.sectors[i].num_plots);
    }
    assert_normal("range", range, seen);
    assert_normal("azimuth", azimuth, seen);
    assert_normal("range rate", rate, seen);
    double looks = NUM_TURNS * (NUM_TARGETS - 1) + 25.0;
    assert_true(fabs(seen / looks - 0.8) < 4.0 * sqrt(0.16 / looks) + 1.0 / NUM_TURNS);
    assert_true(fabs(clutter - 30.0 * NUM_TURNS) < 4.0 * sqrt(30.0 * NUM_TURNS));
    antenna_view_free(&clean);
    antenna_view_free(&view);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_meets_targets_when_it_points_there),
        cmocka_unit_test(test_meets_each_once_a_turn),
        cmocka_unit_test(test_sectors_close_the_circle),
        cmocka_unit_test(test_chance_is_what_it_says),
    };

    return cmocka_run_group_tests_name("scenario_antenna", tests, NULL, NULL);
}
