/* SPDX-License-Identifier: MIT */
/*
 * Which two tracks are taken for a target and its image, and which line they say: reports made by
 * hand, each limit from both sides.
 */
#include "rhotrack/reflectors.h"
#include "tracker_setup.h"

static struct rho_reflector_learning learning;

/* A confirmed track of many plots, 1 m and 0.1 m/s uncertain on each axis. */
static struct rho_track_report track_at(double x_m, double y_m, int row)
{
    struct rho_track_report track = {.track_id = 1u + (uint32_t)row,
                                     .status = RHO_TRACK_CONFIRMED,
                                     .hits = 50,
                                     .plot = row,
                                     .state = {(float)x_m, (float)y_m, 0.0f, 20.0f},
                                     .sigma_m = 1.0f};
    for (int axis = 0; axis < 3; axis++) {
        track.covariance[RHO_AT(axis, axis)] = 1.0f;
        track.covariance[RHO_AT(axis + 3, axis + 3)] = 0.01f;
    }
    return track;
}

static void set_speed_variance(struct rho_track_report *track, float variance)
{
    track->covariance[RHO_AT(RHO_VX, RHO_VX)] = track->covariance[RHO_AT(RHO_VY, RHO_VY)] =
        variance;
}

/* A target 100 m before the sensor, and its image in a wall 150 m before it. */
static struct rho_track_report *target, *image;

static void begin_pair(void)
{
    use_usual_configs(1);
    begin_tracker();
    assert_int_equal(rho_reflector_learning_init(&learning, sizeof learning), RHO_OK);
    memset(&report, 0, sizeof report);
    report.num_tracks = 2;
    target = &report.tracks[0];
    image = &report.tracks[1];
    *target = track_at(0.0, 100.0, 0);
    *image = track_at(0.0, 200.0, 1);
}

static void look(void)
{
    for (int i = 0; i < 2; i++) {
        (void)add_plot((double)report.tracks[i].state[RHO_X], (double)report.tracks[i].state[RHO_Y],
                       1.0);
    }
    const struct rho_scan scan = {.num_plots = num_plots, .plots = plots};
    assert_int_equal(rho_reflector_learning_step(&learning, &tracker, &scan, &report), RHO_OK);
    num_plots = 0;
}

static unsigned num_lines(void)
{
    unsigned count = 0;
    for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS; i++) {
        count += learning.lines[i].is_taken;
    }
    return count;
}

/* The pair as it is now says a line, or none. */
static void expect_lines(unsigned count)
{
    look();
    assert_int_equal(num_lines(), count);
}

static void the_line_is_half_way(void **state)
{
    (void)state;
    begin_pair();
    expect_lines(1);
    const struct rho_learned_reflector *line = &learning.lines[0];
    assert_true(fabs((double)line->y_m - 150.0) < 1e-3 && fabs((double)line->cos_along) > 0.9999);
    /* a quarter of both variances; and 0.25 * 0.02 over the speed's square */
    assert_true(fabs((double)line->variance[0] - 0.5) < 1e-3);
    assert_true(fabs((double)line->variance[2] - 0.005 / 400.0) < 1e-7);
    assert_true(line->pairs == 1.0f);
}

/* The first row of a scan is a plot as others are; without a plot there is no pair. */
static void both_have_a_plot_of_the_scan(void **state)
{
    static const int rows[][2] = {{0, 1}, {1, 0}, {-1, 1}, {1, -1}, {2, 1}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        begin_pair();
        target->plot = rows[i][0];
        image->plot = rows[i][1];
        expect_lines(i < 2);
    }
}

static void targets_have_eight_hits_and_images_five(void **state)
{
    (void)state;
    begin_pair();
    target->hits = 7;
    expect_lines(0);
    target->hits = 8;
    expect_lines(1);
    begin_pair();
    image->hits = 4;
    expect_lines(0);
    image->hits = 5;
    expect_lines(1);
}

/* Six of their sigmas, which are root 2 m together. */
static void they_are_apart(void **state)
{
    (void)state;
    begin_pair();
    image->state[RHO_Y] = 107.0f;
    expect_lines(0);
    image->state[RHO_Y] = 110.0f;
    expect_lines(1);
}

/* One is not before the other, nor faster, by more than chi2 9.2. */
static void they_are_beside_each_other_and_as_fast(void **state)
{
    (void)state;
    begin_pair();
    image->state[RHO_X] = 5.0f; /* 25 over 2.1 */
    expect_lines(0);
    image->state[RHO_X] = 4.0f;
    expect_lines(1);
    begin_pair();
    image->state[RHO_VX] = 20.5f; /* 0.25 over 0.02 */
    expect_lines(0);
    image->state[RHO_VX] = 20.4f;
    expect_lines(1);
}

/* Half the speed's sigma across, root 2 m/s, five times. */
static void slow_ones_say_no_direction(void **state)
{
    (void)state;
    begin_pair();
    set_speed_variance(target, 4.0f);
    set_speed_variance(image, 4.0f);
    target->state[RHO_VX] = image->state[RHO_VX] = 6.0f;
    expect_lines(0);
    target->state[RHO_VX] = image->state[RHO_VX] = 8.0f;
    expect_lines(1);
}

/* Sensor and target are on one side of the line, the image is on the other. */
static void the_image_is_behind(void **state)
{
    (void)state;
    begin_pair();
    image->hits = 7; /* it is no target */
    target->state[RHO_Y] = 200.0f;
    image->state[RHO_Y] = 100.0f;
    expect_lines(0);
    target->state[RHO_Y] = -100.0f;
    expect_lines(0); /* the line goes through the sensor */
    image->state[RHO_Y] = -200.0f;
    expect_lines(1);
}

/* Three sigmas of both lines, 1 m together, off it; and 0.005 rad together, off its direction. */
static void a_pair_near_a_line_is_on_it(void **state)
{
    static const struct {
        float off_m, turned;
        unsigned lines;
    } cases[] = {{2.5f, 0.0f, 1}, {3.5f, 0.0f, 2}, {0.0f, 0.012f, 1}, {0.0f, 0.02f, 2}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        begin_pair();
        expect_lines(1);
        target->state[RHO_Y] += cases[i].off_m;
        image->state[RHO_Y] += cases[i].off_m;
        target->state[RHO_VY] = image->state[RHO_VY] = 20.0f * cases[i].turned;
        expect_lines(cases[i].lines);
        assert_true(learning.lines[0].pairs == (cases[i].lines > 1 ? 1.0f : 2.0f));
    }
}

/* As errors of a target stay for eight looks: 0.5 m^2 of the line, and eight times as much. */
static void a_pair_moves_its_line_by_a_ninth(void **state)
{
    (void)state;
    begin_pair();
    look();
    target->state[RHO_Y] += 1.8f;
    image->state[RHO_Y] += 1.8f;
    look();
    assert_true(fabs((double)learning.lines[0].offset_m - 0.2) < 0.01);
    assert_true(fabs((double)learning.lines[0].variance[0] - 0.5 * 8.0 / 9.0) < 0.01);
}

/* 256 in the order of the rows; the next step goes on with those that follow. */
static void a_step_compares_256_pairs(void **state)
{
    (void)state;
    if (RHO_MAX_TRACKS < 32) {
        skip();
    }
    for (uint32_t row = 6; row < 16; row++) {
        begin_pair();
        const struct rho_track_report of = *target, its = *image;
        report.num_tracks = 32;
        for (uint32_t i = 0; i < 32; i++) {
            report.tracks[i] = of;
            report.tracks[i].plot = -1;
        }
        report.tracks[row] = of;
        report.tracks[31] = its;
        for (unsigned step = 0; step < 4; step++) {
            look();
            assert_int_equal(num_lines(), step >= row / 8);
        }
        look(); /* they begin anew */
        assert_true(learning.lines[0].pairs == (row < 8 ? 2.0f : 1.0f));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_line_is_half_way),
        cmocka_unit_test(both_have_a_plot_of_the_scan),
        cmocka_unit_test(targets_have_eight_hits_and_images_five),
        cmocka_unit_test(they_are_apart),
        cmocka_unit_test(they_are_beside_each_other_and_as_fast),
        cmocka_unit_test(slow_ones_say_no_direction),
        cmocka_unit_test(the_image_is_behind),
        cmocka_unit_test(a_pair_near_a_line_is_on_it),
        cmocka_unit_test(a_pair_moves_its_line_by_a_ninth),
        cmocka_unit_test(a_step_compares_256_pairs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
