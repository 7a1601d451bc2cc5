/* SPDX-License-Identifier: MIT */
/*
 * How targets speak for a line or against it, and which line is a wall then: lines as a snapshot
 * may have them, reports made by hand, each limit from both sides.
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

/* A line from -50 to 50 m along x, half a metre uncertain, that so many pairs have said. */
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

static struct rho_learned_reflector *prepare(void)
{
    use_usual_configs(1);
    begin_tracker();
    assert_int_equal(rho_reflector_learning_init(&learning, sizeof learning), RHO_OK);
    memset(&report, 0, sizeof report);
    num_seen = 0;
    return set_line(0, LINE_M, 3.0f);
}

static void see(double x_m, double y_m)
{
    num_plots = 0;
    seen[num_seen++] = *add_plot(x_m, y_m, 1.0);
}

/* Such a target, 1 m uncertain, and its plot. */
static void see_target(uint32_t track_id, double x_m)
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
    see(x_m, (double)TARGET_M);
}

/* Plots beside the image, where its gate does not reach. */
static void see_others(void)
{
    for (int i = 0; i < 20; i++) {
        see(15.0 + 2.0 * i, (double)IMAGE_M);
        see(-15.0 - 2.0 * i, (double)IMAGE_M);
    }
}

static void look(void)
{
    const struct rho_scan scan = {.num_plots = num_seen, .plots = seen};
    assert_true(rho_reflector_learning_is_sound(&learning));
    assert_int_equal(rho_reflector_learning_step(&learning, &tracker, &scan, &report), RHO_OK);
    report.num_tracks = 0;
    num_seen = 0;
}

/* A look at one target, with these plots behind the line. */
static const struct rho_reflector_witness *look_at(int has_image, int has_others)
{
    see_target(7, 0.0);
    if (has_image) {
        see(0.0, (double)IMAGE_M);
    }
    if (has_others) {
        see_others();
    }
    look();
    return &learning.lines[0].witnesses[0];
}

static void a_line_of_three_pairs_is_observed(void **state)
{
    (void)state;
    prepare()->pairs = 2.0f;
    assert_int_equal(look_at(1, 0)->track_id, 0);
    prepare();
    assert_int_equal(look_at(1, 0)->track_id, 7);
}

/* Plots at the image count, and plots beside it on either side. */
static void looks_count_images_and_others(void **state)
{
    const struct rho_reflector_witness *witness = &learning.lines[0].witnesses[0];
    (void)state;
    prepare();
    for (int k = 0; k < 4; k++) {
        (void)look_at(1, k < 2);
    }
    (void)look_at(0, 0);
    assert_int_equal(witness->looks, 5);
    assert_int_equal(witness->hits, 4);
    assert_int_equal(witness->other, 2);
}

/* The 24th look of a witness that had these before; the last one has no plot behind the line. */
static const struct rho_learned_reflector *judge(uint16_t looks, uint16_t hits, uint16_t other)
{
    struct rho_learned_reflector *line = prepare();
    line->witnesses[0] =
        (struct rho_reflector_witness){.track_id = 7, .looks = looks, .hits = hits, .other = other};
    (void)look_at(0, 0);
    return line;
}

static void a_witness_is_judged_at_its_24th_look(void **state)
{
    (void)state;
    assert_int_equal(judge(22, 20, 0)->witnesses_for, 0);
    assert_int_equal(learning.lines[0].witnesses[0].looks, 23);
    (void)look_at(0, 0);
    assert_int_equal(learning.lines[0].witnesses_for, 1);
    (void)look_at(0, 0); /* and once */
    assert_int_equal(learning.lines[0].witnesses_for, 1);
    assert_int_equal(learning.lines[0].witnesses[0].looks, 24);
}

/* Four plots at its image, and three for each beside it. */
static void plots_at_the_image_speak_for_a_line(void **state)
{
    static const uint16_t cases[][3] = {{4, 0, 1}, {3, 0, 0}, {10, 2, 1}, {9, 2, 0}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct rho_learned_reflector *line = judge(23, cases[i][0], cases[i][1]);
        assert_int_equal(line->witnesses_for, cases[i][2]);
        assert_int_equal(line->witnesses_against, !cases[i][2]);
    }
}

static void sixteen_witnesses_are_halved(void **state)
{
    (void)state;
    for (uint16_t before = 14; before <= 15; before++) {
        struct rho_learned_reflector *line = prepare();
        line->witnesses_for = (uint16_t)(before - 4);
        line->witnesses_against = 4;
        line->witnesses[0] = (struct rho_reflector_witness){.track_id = 7, .looks = 23, .hits = 20};
        (void)look_at(0, 0);
        assert_int_equal(line->witnesses_for, before == 14 ? 11 : 6);
        assert_int_equal(line->witnesses_against, before == 14 ? 4 : 2);
    }
}

/* As errors of a target stay for eight looks: of 0.25 m^2 of the line, and 8 (1 + 1) / 4. */
static void a_plot_at_the_image_moves_the_line(void **state)
{
    (void)state;
    prepare();
    see_target(7, 0.0);
    see(0.0, (double)IMAGE_M + 1.0);
    look();
    assert_true(fabs((double)learning.lines[0].offset_m - 0.5 * 0.25 / 4.25) < 0.003);
}

/* ---- work of a step -------------------------------------------------------------------------- */

/* Images that are looked for with six targets and three lines, 18 in all, in so many plots. */
static unsigned num_images(uint32_t num_plots_seen)
{
    unsigned count = 0;
    (void)prepare();
    (void)set_line(1, LINE_M + 30.0f, 3.0f);
    (void)set_line(2, LINE_M + 60.0f, 3.0f);
    for (uint32_t i = 0; i < 6; i++) {
        see_target(1 + i, 6.0 * i - 15.0);
    }
    while (num_seen < num_plots_seen) {
        see(-500.0, 0.0);
    }
    look();
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned k = 0; k < RHO_REFLECTOR_WITNESSES; k++) {
            count += learning.lines[i].witnesses[k].track_id > 0;
        }
    }
    return count;
}

static void a_step_looks_for_16_images(void **state)
{
    (void)state;
    if (RHO_MAX_TRACKS < 6) {
        skip();
    }
    assert_int_equal(num_images(6), 16);
    assert_int_equal(num_images(1000), 16);
}

/* Twice 32768 plots are compared with images, and those of the image that is begun. */
static void many_plots_leave_fewer_images(void **state)
{
    (void)state;
    if (RHO_MAX_TRACKS < 6) {
        skip();
    }
    assert_int_equal(num_images(MANY_PLOTS), 32768 / 4096 + 1);
}

/* ---- walls ----------------------------------------------------------------------------------- */

/* A line that is just a wall, or is in one way just none. */
static struct rho_learned_reflector *prepare_wall(void)
{
    struct rho_learned_reflector *line = prepare();
    line->witnesses_for = 4;
    line->witnesses_against = 1;
    line->late_ones = 2;
    line->off_m2 = 1.0f;
    line->distance_m2 = 1.2f * 9.0f * 2.0f; /* three times root 2 m, and a little more */
    line->variance[0] = 0.8f * 0.8f;
    return line;
}

static void expect_wall(int is_wall)
{
    struct rho_reflector wall;
    look();
    assert_int_equal(rho_reflector_learning_wall(&learning, 0, &wall), is_wall);
    assert_int_equal(tracker.num_reflectors, is_wall);
}

static void four_witnesses_make_a_wall(void **state)
{
    (void)state;
    (void)prepare_wall();
    expect_wall(1);
    struct rho_learned_reflector *line = prepare_wall();
    line->witnesses_against = 0;
    line->witnesses_for = 3;
    expect_wall(0);
}

static void they_are_four_times_as_many_as_those_against(void **state)
{
    (void)state;
    for (uint16_t against = 2; against <= 3; against++) {
        struct rho_learned_reflector *line = prepare_wall();
        line->witnesses_for = 8;
        line->witnesses_against = against;
        expect_wall(against == 2);
    }
}

static void two_of_them_came_later(void **state)
{
    (void)state;
    prepare_wall()->late_ones = 1;
    expect_wall(0);
}

static void their_distances_spread_three_times_their_errors(void **state)
{
    (void)state;
    prepare_wall()->distance_m2 = 0.8f * 9.0f * 2.0f;
    expect_wall(0);
}

static void the_line_is_known_as_well_as_tracks(void **state)
{
    (void)state;
    prepare_wall()->variance[0] = 1.3f * 1.3f;
    expect_wall(0);
    prepare_wall()->variance[2] = 1.3f * 1.3f / (50.0f * 50.0f); /* at its ends */
    expect_wall(0);
}

/* Six sigmas of 1 m off a wall that is told: the same one, or another. */
static void a_line_near_a_told_wall_is_not_learned(void **state)
{
    (void)state;
    for (int is_other = 0; is_other < 2; is_other++) {
        const float y_m = LINE_M + (is_other ? 7.5f : 5.0f);
        const struct rho_reflector told = {-200.0f, y_m, 200.0f, y_m};
        struct rho_reflector wall;
        (void)prepare_wall();
        assert_int_equal(rho_tracker_set_reflectors(&tracker, &told, 1), RHO_OK);
        look();
        assert_int_equal(rho_reflector_learning_wall(&learning, 0, &wall), is_other);
        assert_int_equal(tracker.num_reflectors, 1 + is_other);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_line_of_three_pairs_is_observed),
        cmocka_unit_test(looks_count_images_and_others),
        cmocka_unit_test(a_witness_is_judged_at_its_24th_look),
        cmocka_unit_test(plots_at_the_image_speak_for_a_line),
        cmocka_unit_test(sixteen_witnesses_are_halved),
        cmocka_unit_test(a_plot_at_the_image_moves_the_line),
        cmocka_unit_test(a_step_looks_for_16_images),
        cmocka_unit_test(many_plots_leave_fewer_images),
        cmocka_unit_test(four_witnesses_make_a_wall),
        cmocka_unit_test(they_are_four_times_as_many_as_those_against),
        cmocka_unit_test(two_of_them_came_later),
        cmocka_unit_test(their_distances_spread_three_times_their_errors),
        cmocka_unit_test(the_line_is_known_as_well_as_tracks),
        cmocka_unit_test(a_line_near_a_told_wall_is_not_learned),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
