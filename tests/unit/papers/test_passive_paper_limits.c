/* SPDX-License-Identifier: MIT */
/*
 * Limits of the paper's passive method: refused calls, full capacities, silent sensors, hostile
 * input.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "search_by_passive_paper.h"

static struct rho_passive_paper paper, before;
static struct scene scene;
static struct full_frame full;

static void init_default_paper(void)
{
    struct rho_passive_paper_config config = paper_config();
    assert_int_equal(rho_passive_paper_init(&paper, sizeof paper, &config), RHO_OK);
}

static void push_scans(unsigned from, unsigned to)
{
    for (unsigned k = from; k < to; k++) {
        assert_int_equal(push_to_paper(&paper, &scene, k), RHO_OK);
    }
}

static void search_and_check(void)
{
    assert_int_equal(rho_passive_paper_search(&paper), RHO_OK);
    assert_true(are_lines_sound(&paper));
}

/* Draws a scene, pushes and searches its first five frames, and puts the sixth into `full`. */
static void search_five_frames_and_fill_sixth(void)
{
    random_state = 3;
    scene = scene_of(2, 2, 0.05, 1.0, 0.0);
    draw_scene(&scene);
    init_default_paper();
    push_scans(0, 5);
    search_and_check();
    fill_frame(&scene, 5, &full);
    before = paper;
}

static void expect_frame_refused(enum rho_status status)
{
    uint8_t fates[sizeof full.fates];
    memcpy(fates, full.fates, sizeof fates);
    assert_int_equal(rho_passive_paper_push(&paper, &full.frame, full.fates), status);
    assert_memory_equal(&paper, &before, sizeof paper);
    assert_memory_equal(full.fates, fates, sizeof fates);
}

static void expect_config_status(const struct rho_passive_paper_config *config,
                                 enum rho_status status)
{
    memset(&paper, 0x5a, sizeof paper);
    before = paper;
    assert_int_equal(rho_passive_paper_init(&paper, sizeof paper, config), status);
    if (status != RHO_OK) {
        assert_memory_equal(&paper, &before, sizeof paper);
    }
}

#define EXPECT_FIELD(field, value, status)                                                         \
    do {                                                                                           \
        struct rho_passive_paper_config config = paper_config();                                   \
        config.field = (value);                                                                    \
        expect_config_status(&config, (status));                                                   \
    } while (0)

static void scans_votes_and_rules_out_of_range_are_refused(void **state)
{
    (void)state;
    EXPECT_FIELD(scans, 2, RHO_ERROR_CONFIG);
    EXPECT_FIELD(scans, 3, RHO_OK);
    EXPECT_FIELD(scans, RHO_MAX_PASSIVE_SCANS, RHO_OK);
    EXPECT_FIELD(scans, RHO_MAX_PASSIVE_SCANS + 1, RHO_ERROR_CONFIG);
    EXPECT_FIELD(votes_min, 0, RHO_OK);
    EXPECT_FIELD(votes_min, 255, RHO_OK);
    EXPECT_FIELD(votes_min, 256, RHO_ERROR_CONFIG);
    EXPECT_FIELD(votes, RHO_VOTES_POINTS, RHO_OK);
    EXPECT_FIELD(votes, (enum rho_accumulator_votes)(RHO_VOTES_POINTS + 1), RHO_ERROR_CONFIG);
    EXPECT_FIELD(rule, RHO_GHOST_NO_RULE, RHO_OK);
    EXPECT_FIELD(rule, RHO_GHOST_SAFE, RHO_OK);
    EXPECT_FIELD(rule, (enum rho_ghost_rule)(RHO_GHOST_SAFE + 1), RHO_ERROR_CONFIG);
    EXPECT_FIELD(rule, (enum rho_ghost_rule) - 1, RHO_ERROR_CONFIG);
}

static void cells_too_small_for_the_range_are_refused(void **state)
{
    (void)state;
    float least_m = 2.0f * 100000.0f / (float)RHO_PAPER_RHO_CELLS;
    EXPECT_FIELD(rho_cell_m, 0.99f * least_m, RHO_ERROR_CONFIG);
    EXPECT_FIELD(rho_cell_m, 1.01f * least_m, RHO_OK);
    EXPECT_FIELD(rho_cell_m, 0.0f, RHO_ERROR_CONFIG);
    EXPECT_FIELD(rho_cell_m, -1000.0f, RHO_ERROR_CONFIG);
    EXPECT_FIELD(rho_cell_m, RHO_LIMIT_POSITION_M, RHO_OK);
    EXPECT_FIELD(range_max_m, 999.0f, RHO_ERROR_CONFIG);
    EXPECT_FIELD(range_max_m, 1000.0f, RHO_OK);
    EXPECT_FIELD(range_max_m, 500.0f * RHO_PAPER_RHO_CELLS, RHO_OK);
    EXPECT_FIELD(range_max_m, 501.0f * RHO_PAPER_RHO_CELLS, RHO_ERROR_CONFIG);
    EXPECT_FIELD(theta_cell_rad, (float)(PI / (RHO_PAPER_THETA_CELLS + 0.6)), RHO_ERROR_CONFIG);
    EXPECT_FIELD(theta_cell_rad, (float)(PI / (RHO_PAPER_THETA_CELLS + 0.4)), RHO_OK);
    EXPECT_FIELD(theta_cell_rad, 0.5f, RHO_OK);
    EXPECT_FIELD(theta_cell_rad, 0.51f, RHO_ERROR_CONFIG);
    EXPECT_FIELD(theta_cell_rad, 0.0f, RHO_ERROR_CONFIG);
    EXPECT_FIELD(theta_cell_rad, -0.1f, RHO_ERROR_CONFIG);
}

static void parameters_that_are_not_finite_are_refused(void **state)
{
    (void)state;
    const float bad[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        EXPECT_FIELD(range_max_m, bad[i], RHO_ERROR_CONFIG);
        EXPECT_FIELD(rho_cell_m, bad[i], RHO_ERROR_CONFIG);
        EXPECT_FIELD(theta_cell_rad, bad[i], RHO_ERROR_CONFIG);
    }
}

static void the_default_configuration_is_that_of_the_header(void **state)
{
    (void)state;
    struct rho_passive_paper_config config = paper_config();
    assert_int_equal(config.scans, 8);
    assert_int_equal(config.votes_min, 0);
    assert_int_equal(config.votes, RHO_VOTES_SCANS);
    assert_int_equal(config.rule, RHO_GHOST_LITERAL);
    assert_float_equal(config.range_max_m, 100e3, 0.0);
    assert_float_equal(config.rho_cell_m, 1000.0, 0.0);
    assert_float_equal(config.theta_cell_rad, 2.0 * DEG_RAD, 1e-6);
    expect_config_status(&config, RHO_OK);
}

static void an_object_can_be_initialised_with_its_own_configuration(void **state)
{
    (void)state;
    search_five_frames_and_fill_sixth();
    assert_int_equal(rho_passive_paper_init(&paper, sizeof paper, &paper.config), RHO_OK);
    assert_int_equal(paper.config.scans, 8);
    assert_int_equal(paper.batch.num_scans + paper.batch.num_sensors + paper.num_lines, 0);
}

/* The memory that a node must reserve for the object. */
static void the_object_has_a_bounded_size(void **state)
{
    (void)state;
    print_message("%zu bytes\n", sizeof paper);
    assert_true(sizeof paper < (RHO_MAX_BEARINGS > 16  ? 200u
                                : RHO_MAX_BEARINGS > 8 ? 128u
                                                       : 48u) *
                                   1024u);
}

static void null_pointers_are_refused(void **state)
{
    (void)state;
    search_five_frames_and_fill_sixth();
    assert_int_equal(rho_passive_paper_init(NULL, sizeof paper, &paper.config), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_paper_init(&paper, sizeof paper, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_paper_push(NULL, &full.frame, full.fates), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_paper_push(&paper, NULL, full.fates), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_paper_push(&paper, &full.frame, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_paper_search(NULL), RHO_ERROR_NULL);
    full.scans[1].bearings = NULL;
    expect_frame_refused(RHO_ERROR_NULL);
    full.frame.scans = NULL;
    expect_frame_refused(RHO_ERROR_NULL);
}

static void a_wrong_object_size_is_refused(void **state)
{
    (void)state;
    search_five_frames_and_fill_sixth();
    assert_int_equal(rho_passive_paper_init(&paper, sizeof paper - 1, &before.config),
                     RHO_ERROR_SIZE);
    assert_int_equal(rho_passive_paper_init(&paper, 0, &before.config), RHO_ERROR_SIZE);
    assert_memory_equal(&paper, &before, sizeof paper);
}

static void an_object_without_init_is_refused(void **state)
{
    (void)state;
    search_five_frames_and_fill_sixth();
    memset(&paper, 0, sizeof paper);
    before = paper;
    expect_frame_refused(RHO_ERROR_STATE);
    assert_int_equal(rho_passive_paper_search(&paper), RHO_ERROR_STATE);
    assert_memory_equal(&paper, &before, sizeof paper);
}

static void a_refused_frame_keeps_the_lines_found(void **state)
{
    (void)state;
    search_five_frames_and_fill_sixth();
    assert_true(paper.num_lines > 0);
    full.frame.time_us = paper.batch.time_us[4];
    expect_frame_refused(RHO_ERROR_STATE);
    full.frame.time_us++;
    full.scans[1].sensor_id = full.scans[0].sensor_id;
    expect_frame_refused(RHO_ERROR_VALUE);
    full.scans[1].sensor_id++;
    full.scans[1].x_m = NAN;
    expect_frame_refused(RHO_ERROR_VALUE);
    fill_frame(&scene, 5, &full);
    assert_int_equal(rho_passive_paper_push(&paper, &full.frame, full.fates), RHO_OK);
    assert_int_equal(paper.num_lines, 0);
}

/* An array that nobody set once took no bearing, and the search found no line, without a word. */
static void fates_that_were_not_set_are_refused(void **state)
{
    (void)state;
    search_five_frames_and_fill_sixth();
    memset(full.fates, 0, sizeof full.fates);
    expect_frame_refused(RHO_ERROR_VALUE);
    memset(full.fates, 0xa5, sizeof full.fates);
    expect_frame_refused(RHO_ERROR_VALUE);
    full.fates[0] = RHO_FATE_HELD;
    expect_frame_refused(RHO_ERROR_VALUE);
    /* bearings that tracks claim may be among them */
    memset(full.fates, RHO_FATE_CLAIMED, sizeof full.fates);
    full.fates[3] = RHO_FATE_HELD;
    assert_int_equal(rho_passive_paper_push(&paper, &full.frame, full.fates), RHO_OK);
    assert_int_equal(paper.batch.num_bearings[5][0], 0);
    assert_int_equal(paper.batch.num_bearings[5][1], 1);
    /* sensors that looked and saw nothing */
    fill_frame(&scene, 6, &full);
    full.scans[0].num_bearings = full.scans[1].num_bearings = 0;
    memset(full.fates, 0xa5, sizeof full.fates);
    assert_int_equal(rho_passive_paper_push(&paper, &full.frame, full.fates), RHO_OK);
}

/* 256 cells of 1 km hold 100 km of range and half of a base of 56 km to either side. */
static void sensors_too_far_apart_for_the_cells_are_refused(void **state)
{
    (void)state;
    search_five_frames_and_fill_sixth();
    full.scans[1].sensor_id = 99;
    full.scans[1].x_m = 0.0f;
    full.scans[1].y_m = -10e3f + 56.1e3f;
    expect_frame_refused(RHO_ERROR_VALUE);
    full.scans[1].y_m = -10e3f + 55.9e3f;
    assert_int_equal(rho_passive_paper_push(&paper, &full.frame, full.fates), RHO_OK);
}

static void fewer_than_three_frames_make_no_line(void **state)
{
    (void)state;
    search_five_frames_and_fill_sixth();
    init_default_paper();
    search_and_check();
    assert_int_equal(paper.num_lines, 0);
    push_scans(0, 2);
    search_and_check();
    assert_int_equal(paper.num_lines, 0);
    push_scans(2, 3);
    search_and_check();
    assert_true(paper.num_lines > 0);
}

static void one_sensor_makes_no_line(void **state)
{
    (void)state;
    search_five_frames_and_fill_sixth();
    for (unsigned k = 0; k < scene.scans; k++) {
        scene.look[k][1].is_absent = 1;
    }
    init_default_paper();
    push_scans(0, 8);
    search_and_check();
    assert_int_equal(paper.num_lines, 0);
    assert_int_equal(paper.work.crossings, 0);
}

/* Pairs with the silent sensor confirm nothing, until its last scan has left the batch. */
static void no_line_until_a_silent_sensors_scans_have_left_the_batch(void **state)
{
    (void)state;
    random_state = 4;
    scene = scene_of(3, 2, 0.05, 1.0, 0.0);
    scene.scans = 10;
    draw_scene(&scene);
    for (unsigned k = 2; k < scene.scans; k++) {
        scene.look[k][2].is_absent = 1;
    }
    init_default_paper();
    push_scans(0, 9);
    search_and_check();
    assert_int_equal(paper.num_lines, 0);
    push_scans(9, 10);
    search_and_check();
    assert_true(paper.num_lines > 0);
    struct rho_passive_paper_line first = paper.lines[0];
    scene.sensors = 2;
    init_default_paper();
    push_scans(2, 10);
    search_and_check();
    assert_memory_equal(&paper.lines[0], &first, sizeof first);
}

static void lines_of_one_scan_have_no_state(void **state)
{
    (void)state;
    struct rho_passive_paper_config config = paper_config();
    search_five_frames_and_fill_sixth();
    for (unsigned k = 0; k < scene.scans; k++) {
        scene.look[k][0].count = k == 3 ? scene.look[k][0].count : 0;
    }
    config.votes_min = 1;
    assert_int_equal(search_by_paper(&paper, &config, &scene), RHO_OK);
    assert_true(are_lines_sound(&paper));
    assert_true(paper.num_lines > 0);
    for (unsigned i = 0; i < paper.num_lines; i++) {
        const struct rho_passive_paper_line *line = &paper.lines[i];
        assert_int_equal(line->has_state, 0);
        assert_int_equal(line->scans, 1u << 3);
        assert_true(line->x_m * line->x_m + line->vx_mps * line->vx_mps < 1e-9f);
    }
}

/* Adds bearings that all cross those of the other sensor within 100 km. */
static void fill_scans_with_bearings(void)
{
    for (unsigned k = 0; k < scene.scans; k++) {
        for (unsigned i = 0; i < RHO_MAX_BEARINGS; i++) {
            double along = i / (double)RHO_MAX_BEARINGS;
            add_bearing(&scene.look[k][0], 0.11 + 0.1 * along, 0.001, -1);
            add_bearing(&scene.look[k][1], -0.11 - 0.1 * along, 0.001, -1);
        }
    }
}

static void crossings_and_lines_beyond_the_capacity_are_counted(void **state)
{
    (void)state;
    uint32_t crossings = RHO_MAX_PASSIVE_SCANS * RHO_MAX_BEARINGS * RHO_MAX_BEARINGS;
    uint32_t held = crossings < RHO_MAX_PAPER_CROSSINGS ? crossings : RHO_MAX_PAPER_CROSSINGS;
    struct rho_passive_paper_config config = paper_config();
    config.scans = RHO_MAX_PASSIVE_SCANS;
    config.votes_min = 1;
    config.rule = RHO_GHOST_NO_RULE;
    scene = scene_of(2, 0, 0.1, 1.0, 0.0);
    scene.scans = RHO_MAX_PASSIVE_SCANS;
    set_scan_times(&scene);
    fill_scans_with_bearings();
    assert_int_equal(search_by_paper(&paper, &config, &scene), RHO_OK);
    assert_true(are_lines_sound(&paper));
    assert_int_equal(paper.work.crossings, crossings);
    assert_int_equal(paper.work.ghosts, 0);
    assert_int_equal(paper.work.points_dropped, crossings - held);
    assert_int_equal(paper.work.votes, 90 * held);
    assert_int_equal(paper.num_lines, RHO_MAX_PASSIVE_LINES);
    assert_true(paper.work.lines_dropped > 0);
    assert_int_equal(paper.lines[0].votes, (held + RHO_MAX_BEARINGS * RHO_MAX_BEARINGS - 1) /
                                               (RHO_MAX_BEARINGS * RHO_MAX_BEARINGS));
}

/* All crossings are in one cell of a row, more than a byte can count. */
static void votes_of_crossings_saturate_at_255(void **state)
{
    (void)state;
    struct rho_passive_paper_config config = paper_config();
    unsigned count = RHO_MAX_BEARINGS * RHO_MAX_BEARINGS * 8;
    config.votes = RHO_VOTES_POINTS;
    config.rule = RHO_GHOST_NO_RULE;
    config.votes_min = 255;
    config.rho_cell_m = 50000.0f;
    scene = scene_of(2, 0, 0.1, 1.0, 0.0);
    set_scan_times(&scene);
    fill_scans_with_bearings();
    assert_int_equal(search_by_paper(&paper, &config, &scene), RHO_OK);
    assert_true(are_lines_sound(&paper));
    assert_true(count > 255);
    assert_true(paper.num_lines > 0);
    assert_int_equal(paper.lines[0].votes, 255);
    assert_int_equal(paper.lines[0].votes_sum, 254);
    assert_true(paper.lines[0].crossings > 255);
}

/* Extreme bearings, misses and times: any result has sound lines. */
static void hostile_frames_give_sound_lines(void **state)
{
    (void)state;
    static const float odd[] = {0.0f, 3.14159274f, -3.14159274f, 1.57079637f, 1e-7f, NAN, INFINITY};
    random_state = 9;
    for (unsigned run = 0; run < 300; run++) {
        struct rho_passive_paper_config config = paper_config();
        config.votes_min = (uint16_t)uniform(0.0, 5.0);
        config.rule = (enum rho_ghost_rule)uniform(0.0, 3.0);
        config.votes = (enum rho_accumulator_votes)uniform(0.0, 2.0);
        config.theta_cell_rad = (float)uniform(0.035, 0.5);
        config.rho_cell_m = 1200.0f; /* eight sensors are 40 km apart */
        scene = scene_of(RHO_MAX_PASSIVE_SENSORS, 2, 5.0, 0.7, 3.0);
        draw_scene(&scene);
        for (unsigned k = 0; k < scene.scans; k++) {
            struct look *look = &scene.look[k][run % RHO_MAX_PASSIVE_SENSORS];
            look->is_absent = uniform(0.0, 1.0) < 0.2;
            for (unsigned i = 0; i < look->count; i += 2) {
                look->bearings[i].bearing_rad = odd[(unsigned)uniform(0.0, 7.0)];
            }
            scene.time_s[k] = run % 3 == 0 ? k * 1e-6 : run % 3 == 1 ? k * 1e9 : k * 10.0;
        }
        assert_int_equal(search_by_paper(&paper, &config, &scene), RHO_OK);
        assert_true(are_lines_sound(&paper));
    }
}

static void a_repeated_search_gives_the_same_bytes(void **state)
{
    (void)state;
    search_five_frames_and_fill_sixth();
    push_scans(5, 8);
    search_and_check();
    before = paper;
    search_and_check();
    assert_memory_equal(paper.lines, before.lines, sizeof paper.lines);
    assert_memory_equal(&paper.work, &before.work, sizeof paper.work);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scans_votes_and_rules_out_of_range_are_refused),
        cmocka_unit_test(cells_too_small_for_the_range_are_refused),
        cmocka_unit_test(parameters_that_are_not_finite_are_refused),
        cmocka_unit_test(the_default_configuration_is_that_of_the_header),
        cmocka_unit_test(an_object_can_be_initialised_with_its_own_configuration),
        cmocka_unit_test(the_object_has_a_bounded_size),
        cmocka_unit_test(null_pointers_are_refused),
        cmocka_unit_test(a_wrong_object_size_is_refused),
        cmocka_unit_test(an_object_without_init_is_refused),
        cmocka_unit_test(a_refused_frame_keeps_the_lines_found),
        cmocka_unit_test(fates_that_were_not_set_are_refused),
        cmocka_unit_test(sensors_too_far_apart_for_the_cells_are_refused),
        cmocka_unit_test(fewer_than_three_frames_make_no_line),
        cmocka_unit_test(one_sensor_makes_no_line),
        cmocka_unit_test(no_line_until_a_silent_sensors_scans_have_left_the_batch),
        cmocka_unit_test(lines_of_one_scan_have_no_state),
        cmocka_unit_test(crossings_and_lines_beyond_the_capacity_are_counted),
        cmocka_unit_test(votes_of_crossings_saturate_at_255),
        cmocka_unit_test(hostile_frames_give_sound_lines),
        cmocka_unit_test(a_repeated_search_gives_the_same_bytes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
