/* SPDX-License-Identifier: MIT */
/*
 * Witnesses: targets whose images speak for a line or against it, and when a line becomes a wall.
 * Lines and reports are made by hand, and each limit is tested from both sides.
 */
#include "rhotrack/reflectors.h"
#include "tracker_setup.h"

#define LINE_M 150.0f
#define TARGET_M 100.0f
#define IMAGE_M 200.0f
#define MANY_PLOTS 4096u

static struct rho_reflector_learning learning;
static struct rho_plot seen[MANY_PLOTS];
static uint32_t num_seen;

/* Sets a line from -50 to 50 m along x with a sigma of half a metre, from this number of pairs. */
static struct rho_learned_reflector *set_line(unsigned place, float y_m, float pairs)
{
    struct rho_learned_reflector *line = &learning.lines[place];
    memset(line, 0, sizeof *line);
    line->y_m = y_m;
    line->cos_along = 1.0f;
    line->variance[0] = 0.25f;
    line->from_m = -50.0f;
    line->to_m = 50.0f;
    line->pairs = pairs;
    line->sigma_m = 1.0f;
    line->is_taken = 1;
    return line;
}

static struct rho_learned_reflector *prepare_line(void)
{
    use_usual_configs(1);
    begin_tracker();
    assert_int_equal(rho_reflector_learning_init(&learning, sizeof learning), RHO_OK);
    memset(&report, 0, sizeof report);
    num_seen = 0;
    return set_line(0, LINE_M, 3.0f);
}

static void add_seen_plot(double x_m, double y_m)
{
    num_plots = 0;
    seen[num_seen++] = *add_plot(x_m, y_m, 1.0);
}

/* Adds a target's track with a sigma of 1 m, and its plot. */
static void add_target(uint32_t track_id, double x_m)
{
    struct rho_track_report *track = &report.tracks[report.num_tracks++];
    memset(track, 0, sizeof *track);
    track->track_id = track_id;
    track->status = RHO_TRACK_CONFIRMED;
    track->hits = 50;
    track->plot = (int32_t)num_seen;
    track->state[RHO_X] = (float)x_m;
    track->state[RHO_Y] = TARGET_M;
    track->state[RHO_VX] = 20.0f;
    track->sigma_m = 1.0f;
    for (int axis = 0; axis < 3; axis++) {
        track->covariance[RHO_AT(axis, axis)] = 1.0f;
        track->covariance[RHO_AT(axis + 3, axis + 3)] = 0.01f;
    }
    add_seen_plot(x_m, (double)TARGET_M);
}

/* Adds plots beside the image, outside its gate. */
static void add_plots_beside_image(void)
{
    for (int i = 0; i < 20; i++) {
        add_seen_plot(15.0 + 2.0 * i, (double)IMAGE_M);
        add_seen_plot(-15.0 - 2.0 * i, (double)IMAGE_M);
    }
}

static void step_learning(void)
{
    const struct rho_scan scan = {.num_plots = num_seen, .plots = seen};
    assert_true(rho_reflector_learning_is_sound(&learning));
    assert_int_equal(rho_reflector_learning_step(&learning, &tracker, &scan, &report), RHO_OK);
    report.num_tracks = 0;
    num_seen = 0;
}

/* A step with one target; with a plot at its image, and plots beside that, if asked for. */
static const struct rho_reflector_witness *look_at_one_target(int has_image, int has_others)
{
    add_target(7, 0.0);
    if (has_image) {
        add_seen_plot(0.0, (double)IMAGE_M);
    }
    if (has_others) {
        add_plots_beside_image();
    }
    step_learning();
    return &learning.lines[0].witnesses[0];
}

static void a_line_gets_witnesses_from_three_pairs_on(void **state)
{
    (void)state;
    prepare_line()->pairs = 2.0f;
    assert_int_equal(look_at_one_target(1, 0)->track_id, 0);
    prepare_line();
    assert_int_equal(look_at_one_target(1, 0)->track_id, 7);
}

/* Each look counts a plot at the image, and plots beside it on both sides. */
static void looks_count_plots_at_the_image_and_beside_it(void **state)
{
    const struct rho_reflector_witness *witness = &learning.lines[0].witnesses[0];
    (void)state;
    prepare_line();
    for (int k = 0; k < 4; k++) {
        (void)look_at_one_target(1, k < 2);
    }
    (void)look_at_one_target(0, 0);
    assert_int_equal(witness->looks, 5);
    assert_int_equal(witness->hits, 4);
    assert_int_equal(witness->other, 2);
}

/* A witness with these counts has one look more, without any plot behind the line. */
static const struct rho_learned_reflector *line_after_last_look(uint16_t looks, uint16_t hits,
                                                                uint16_t other)
{
    struct rho_learned_reflector *line = prepare_line();
    line->witnesses[0] =
        (struct rho_reflector_witness){.track_id = 7, .looks = looks, .hits = hits, .other = other};
    (void)look_at_one_target(0, 0);
    return line;
}

static void a_witness_is_judged_at_its_24th_look(void **state)
{
    (void)state;
    assert_int_equal(line_after_last_look(22, 20, 0)->witnesses_for, 0);
    assert_int_equal(learning.lines[0].witnesses[0].looks, 23);
    (void)look_at_one_target(0, 0);
    assert_int_equal(learning.lines[0].witnesses_for, 1);
    (void)look_at_one_target(0, 0); /* a witness is judged once only */
    assert_int_equal(learning.lines[0].witnesses_for, 1);
    assert_int_equal(learning.lines[0].witnesses[0].looks, 24);
}

/* It needs four plots at its image, and three for each one beside it. */
static void a_witness_is_for_a_line_by_its_plots_at_the_image(void **state)
{
    static const uint16_t cases[][3] = {{4, 0, 1}, {3, 0, 0}, {10, 2, 1}, {9, 2, 0}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct rho_learned_reflector *line =
            line_after_last_look(23, cases[i][0], cases[i][1]);
        assert_int_equal(line->witnesses_for, cases[i][2]);
        assert_int_equal(line->witnesses_against, !cases[i][2]);
    }
}

static void counts_of_sixteen_witnesses_are_halved(void **state)
{
    (void)state;
    for (uint16_t before = 14; before <= 15; before++) {
        struct rho_learned_reflector *line = prepare_line();
        line->witnesses_for = (uint16_t)(before - 4);
        line->witnesses_against = 4;
        line->witnesses[0] = (struct rho_reflector_witness){.track_id = 7, .looks = 23, .hits = 20};
        (void)look_at_one_target(0, 0);
        assert_int_equal(line->witnesses_for, before == 14 ? 11 : 6);
        assert_int_equal(line->witnesses_against, before == 14 ? 4 : 2);
    }
}

/*
 * A target's errors last eight looks: the line's variance of 0.25 m^2 is updated with 8 (1 + 1) / 4
 * m^2.
 */
static void a_plot_at_the_image_moves_the_line(void **state)
{
    (void)state;
    prepare_line();
    add_target(7, 0.0);
    add_seen_plot(0.0, (double)IMAGE_M + 1.0);
    step_learning();
    assert_true(fabs((double)learning.lines[0].offset_m - 0.5 * 0.25 / 4.25) < 0.003);
}

/* Work of a step */

/*
 * Number of images looked for, of 18 from six targets and three lines, in a scan of this many
 * plots.
 */
static unsigned count_images_looked_for(uint32_t num_plots_seen)
{
    unsigned count = 0;
    (void)prepare_line();
    (void)set_line(1, LINE_M + 30.0f, 3.0f);
    (void)set_line(2, LINE_M + 60.0f, 3.0f);
    for (uint32_t i = 0; i < 6; i++) {
        add_target(1 + i, 6.0 * i - 15.0);
    }
    while (num_seen < num_plots_seen) {
        add_seen_plot(-500.0, 0.0);
    }
    step_learning();
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned k = 0; k < RHO_REFLECTOR_WITNESSES; k++) {
            count += learning.lines[i].witnesses[k].track_id > 0;
        }
    }
    return count;
}

static void a_step_looks_for_at_most_16_images(void **state)
{
    (void)state;
    if (RHO_MAX_TRACKS < 6) {
        skip();
    }
    assert_int_equal(count_images_looked_for(6), 16);
    assert_int_equal(count_images_looked_for(1000), 16);
}

/*
 * A step compares 32768 plots with images, and completes the image at which that number is reached.
 */
static void many_plots_allow_fewer_images_a_step(void **state)
{
    (void)state;
    if (RHO_MAX_TRACKS < 6) {
        skip();
    }
    assert_int_equal(count_images_looked_for(MANY_PLOTS), 32768 / 4096 + 1);
}

/* Walls */

/* Prepares a line that is just good enough for a wall. */
static struct rho_learned_reflector *prepare_wall(void)
{
    struct rho_learned_reflector *line = prepare_line();
    line->witnesses_for = 4;
    line->witnesses_against = 1;
    line->late_ones = 2;
    line->off_m2 = 1.0f;
    line->distance_m2 = 1.2f * 9.0f * 2.0f; /* just above three times root 2 m */
    line->variance[0] = 0.8f * 0.8f;
    return line;
}

static void expect_wall_after_step(int is_wall)
{
    struct rho_reflector wall;
    step_learning();
    assert_int_equal(rho_reflector_learning_wall(&learning, 0, &wall), is_wall);
    assert_int_equal(tracker.num_reflectors, is_wall);
}

static void a_wall_needs_four_witnesses(void **state)
{
    (void)state;
    (void)prepare_wall();
    expect_wall_after_step(1);
    struct rho_learned_reflector *line = prepare_wall();
    line->witnesses_against = 0;
    line->witnesses_for = 3;
    expect_wall_after_step(0);
}

static void a_wall_needs_four_times_as_many_witnesses_for_as_against(void **state)
{
    (void)state;
    for (uint16_t against = 2; against <= 3; against++) {
        struct rho_learned_reflector *line = prepare_wall();
        line->witnesses_for = 8;
        line->witnesses_against = against;
        expect_wall_after_step(against == 2);
    }
}

static void a_wall_needs_two_witnesses_that_came_later(void **state)
{
    (void)state;
    prepare_wall()->late_ones = 1;
    expect_wall_after_step(0);
}

static void a_wall_needs_distances_that_spread_three_times_their_errors(void **state)
{
    (void)state;
    prepare_wall()->distance_m2 = 0.8f * 9.0f * 2.0f;
    expect_wall_after_step(0);
}

static void a_wall_needs_a_line_as_certain_as_tracks(void **state)
{
    (void)state;
    prepare_wall()->variance[0] = 1.3f * 1.3f;
    expect_wall_after_step(0);
    prepare_wall()->variance[2] = 1.3f * 1.3f / (50.0f * 50.0f); /* uncertain at the line's ends */
    expect_wall_after_step(0);
}

/*
 * A configured wall 5 m from the line is the same wall, one 7.5 m away (more than six sigmas) is
 * another.
 */
static void a_line_near_a_configured_wall_is_not_learned(void **state)
{
    (void)state;
    for (int is_other = 0; is_other < 2; is_other++) {
        const float y_m = LINE_M + (is_other ? 7.5f : 5.0f);
        const struct rho_reflector told = {-200.0f, y_m, 200.0f, y_m};
        struct rho_reflector wall;
        (void)prepare_wall();
        assert_int_equal(rho_tracker_set_reflectors(&tracker, &told, 1), RHO_OK);
        step_learning();
        assert_int_equal(rho_reflector_learning_wall(&learning, 0, &wall), is_other);
        assert_int_equal(tracker.num_reflectors, 1 + is_other);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_line_gets_witnesses_from_three_pairs_on),
        cmocka_unit_test(looks_count_plots_at_the_image_and_beside_it),
        cmocka_unit_test(a_witness_is_judged_at_its_24th_look),
        cmocka_unit_test(a_witness_is_for_a_line_by_its_plots_at_the_image),
        cmocka_unit_test(counts_of_sixteen_witnesses_are_halved),
        cmocka_unit_test(a_plot_at_the_image_moves_the_line),
        cmocka_unit_test(a_step_looks_for_at_most_16_images),
        cmocka_unit_test(many_plots_allow_fewer_images_a_step),
        cmocka_unit_test(a_wall_needs_four_witnesses),
        cmocka_unit_test(a_wall_needs_four_times_as_many_witnesses_for_as_against),
        cmocka_unit_test(a_wall_needs_two_witnesses_that_came_later),
        cmocka_unit_test(a_wall_needs_distances_that_spread_three_times_their_errors),
        cmocka_unit_test(a_wall_needs_a_line_as_certain_as_tracks),
        cmocka_unit_test(a_line_near_a_configured_wall_is_not_learned),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
