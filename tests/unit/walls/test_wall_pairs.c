/* SPDX-License-Identifier: MIT */
/*
 * Which two tracks count as a target and its image in a wall, and the line they give. Reports are
 * made by hand, and each limit is tested from both sides.
 */
#include "rhotrack/reflectors.h"
#include "tracker_setup.h"

static struct rho_reflector_learning learning;

/* A confirmed track of many plots with sigmas of 1 m and 0.1 m/s. */
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

/* A target 100 m before the sensor, and its image in a wall at 150 m. */
static struct rho_track_report *target, *image;

static void prepare_pair(void)
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

static void step_learning(void)
{
    for (int i = 0; i < 2; i++) {
        (void)add_plot((double)report.tracks[i].state[RHO_X], (double)report.tracks[i].state[RHO_Y],
                       1.0);
    }
    const struct rho_scan scan = {.num_plots = num_plots, .plots = plots};
    assert_int_equal(rho_reflector_learning_step(&learning, &tracker, &scan, &report), RHO_OK);
    num_plots = 0;
}

static unsigned count_lines(void)
{
    unsigned count = 0;
    for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS; i++) {
        count += learning.lines[i].is_taken;
    }
    return count;
}

/* Runs a step with the pair as it is; expects this number of lines. */
static void expect_lines_after_step(unsigned count)
{
    step_learning();
    assert_int_equal(count_lines(), count);
}

static void the_line_is_half_way_between_target_and_image(void **state)
{
    (void)state;
    prepare_pair();
    expect_lines_after_step(1);
    const struct rho_learned_reflector *line = &learning.lines[0];
    assert_true(fabs((double)line->y_m - 150.0) < 1e-3 && fabs((double)line->cos_along) > 0.9999);
    /*
     * variance: a quarter of both places' variances; of the direction 0.25 * 0.02 over the squared
     * speed
     */
    assert_true(fabs((double)line->variance[0] - 0.5) < 1e-3);
    assert_true(fabs((double)line->variance[2] - 0.005 / 400.0) < 1e-7);
    assert_true(line->pairs == 1.0f);
}

/* Row 0 is a plot like others; -1 is no plot, and row 2 does not exist. */
static void a_pair_needs_plots_of_both_tracks_in_the_scan(void **state)
{
    static const int rows[][2] = {{0, 1}, {1, 0}, {-1, 1}, {1, -1}, {2, 1}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        prepare_pair();
        target->plot = rows[i][0];
        image->plot = rows[i][1];
        expect_lines_after_step(i < 2);
    }
}

static void a_pair_needs_eight_hits_of_the_target_and_five_of_the_image(void **state)
{
    (void)state;
    prepare_pair();
    target->hits = 7;
    expect_lines_after_step(0);
    target->hits = 8;
    expect_lines_after_step(1);
    prepare_pair();
    image->hits = 4;
    expect_lines_after_step(0);
    image->hits = 5;
    expect_lines_after_step(1);
}

/* Six sigmas of the difference, which is known to root 2 m. */
static void a_pair_must_be_six_sigmas_apart(void **state)
{
    (void)state;
    prepare_pair();
    image->state[RHO_Y] = 107.0f;
    expect_lines_after_step(0);
    image->state[RHO_Y] = 110.0f;
    expect_lines_after_step(1);
}

/* Along the line and in speed the difference must be within chi-square 9.2. */
static void target_and_image_must_be_abreast_and_equally_fast(void **state)
{
    (void)state;
    prepare_pair();
    image->state[RHO_X] = 5.0f; /* chi-square 25 / 2.1 */
    expect_lines_after_step(0);
    image->state[RHO_X] = 4.0f;
    expect_lines_after_step(1);
    prepare_pair();
    image->state[RHO_VX] = 20.5f; /* chi-square 0.25 / 0.02 */
    expect_lines_after_step(0);
    image->state[RHO_VX] = 20.4f;
    expect_lines_after_step(1);
}

/* The mean speed must be five times its sigma across, which is root 2 m/s. */
static void a_pair_too_slow_for_a_direction_makes_no_line(void **state)
{
    (void)state;
    prepare_pair();
    set_speed_variance(target, 4.0f);
    set_speed_variance(image, 4.0f);
    target->state[RHO_VX] = image->state[RHO_VX] = 6.0f;
    expect_lines_after_step(0);
    target->state[RHO_VX] = image->state[RHO_VX] = 8.0f;
    expect_lines_after_step(1);
}

/* Sensor and target must be on one side of the line and the image on the other. */
static void the_line_must_separate_the_image_from_sensor_and_target(void **state)
{
    (void)state;
    prepare_pair();
    image->hits = 7; /* too few hits to be a target */
    target->state[RHO_Y] = 200.0f;
    image->state[RHO_Y] = 100.0f;
    expect_lines_after_step(0);
    target->state[RHO_Y] = -100.0f;
    expect_lines_after_step(0); /* the line would go through the sensor */
    image->state[RHO_Y] = -200.0f;
    expect_lines_after_step(1);
}

/* Sigmas of both lines together are 1 m across and 0.005 rad in direction. */
static void a_pair_within_three_sigmas_of_a_line_joins_it(void **state)
{
    static const struct {
        float off_m, turned;
        unsigned lines;
    } cases[] = {{2.5f, 0.0f, 1}, {3.5f, 0.0f, 2}, {0.0f, 0.012f, 1}, {0.0f, 0.02f, 2}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        prepare_pair();
        expect_lines_after_step(1);
        target->state[RHO_Y] += cases[i].off_m;
        image->state[RHO_Y] += cases[i].off_m;
        target->state[RHO_VY] = image->state[RHO_VY] = 20.0f * cases[i].turned;
        expect_lines_after_step(cases[i].lines);
        assert_true(learning.lines[0].pairs == (cases[i].lines > 1 ? 1.0f : 2.0f));
    }
}

/*
 * A target's errors last eight looks, so that the line's variance of 0.5 m^2 is updated with eight
 * times as much.
 */
static void a_pair_moves_its_line_with_a_gain_of_a_ninth(void **state)
{
    (void)state;
    prepare_pair();
    step_learning();
    target->state[RHO_Y] += 1.8f;
    image->state[RHO_Y] += 1.8f;
    step_learning();
    assert_true(fabs((double)learning.lines[0].offset_m - 0.2) < 0.01);
    assert_true(fabs((double)learning.lines[0].variance[0] - 0.5 * 8.0 / 9.0) < 0.01);
}

/* Pairs are compared in the order of the rows; the next step goes on where this one stopped. */
static void a_step_compares_256_pairs_and_the_next_one_goes_on(void **state)
{
    (void)state;
    if (RHO_MAX_TRACKS < 32) {
        skip();
    }
    for (uint32_t row = 6; row < 16; row++) {
        prepare_pair();
        const struct rho_track_report of = *target, its = *image;
        report.num_tracks = 32;
        for (uint32_t i = 0; i < 32; i++) {
            report.tracks[i] = of;
            report.tracks[i].plot = -1;
        }
        report.tracks[row] = of;
        report.tracks[31] = its;
        for (unsigned step = 0; step < 4; step++) {
            step_learning();
            assert_int_equal(count_lines(), step >= row / 8);
        }
        step_learning(); /* the pairs begin anew */
        assert_true(learning.lines[0].pairs == (row < 8 ? 2.0f : 1.0f));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_line_is_half_way_between_target_and_image),
        cmocka_unit_test(a_pair_needs_plots_of_both_tracks_in_the_scan),
        cmocka_unit_test(a_pair_needs_eight_hits_of_the_target_and_five_of_the_image),
        cmocka_unit_test(a_pair_must_be_six_sigmas_apart),
        cmocka_unit_test(target_and_image_must_be_abreast_and_equally_fast),
        cmocka_unit_test(a_pair_too_slow_for_a_direction_makes_no_line),
        cmocka_unit_test(the_line_must_separate_the_image_from_sensor_and_target),
        cmocka_unit_test(a_pair_within_three_sigmas_of_a_line_joins_it),
        cmocka_unit_test(a_pair_moves_its_line_with_a_gain_of_a_ninth),
        cmocka_unit_test(a_step_compares_256_pairs_and_the_next_one_goes_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
