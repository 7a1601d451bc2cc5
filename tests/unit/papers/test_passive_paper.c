/* SPDX-License-Identifier: MIT */
/*
 * Lines by the paper's passive method, compared cell by cell with dense planes in double precision,
 * and its shares of found targets and ghosts.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "passive_paper_reference.h"
#include "rhotrack/detail/bearing_crossing.h"

static struct rho_passive_paper paper;

struct agreement {
    unsigned scenes, sure, lines;
};

static void compare_lines(const struct rho_passive_paper_config *config,
                          struct agreement *agreement)
{
    assert_int_equal(search_by_paper(&paper, config, &scene), RHO_OK);
    assert_true(are_lines_sound(&paper));
    fill_planes(config);
    agreement->scenes++;
    if (!fill_heights(config, paper.votes_min)) {
        return;
    }
    agreement->sure++;
    assert_int_equal(paper.work.cells, num_confirmed);
    unsigned count = 0;
    int height;
    for (struct place at = next_line(config, &height); height > 0;
         at = next_line(config, &height)) {
        if (count < RHO_MAX_PASSIVE_LINES) {
            assert_true(count < paper.num_lines);
            expect_line(&paper.lines[count], at, height, config);
            expect_state(&paper.lines[count], at, config);
        }
        count++;
        agreement->lines++;
        if (is_doubtful) {
            return;
        }
    }
    assert_int_equal(paper.num_lines + paper.work.lines_dropped, count);
}

/* Compares random scenes, rotated and shifted, so that lines have every direction. */
static struct agreement compare_scenes(const struct scene *from,
                                       const struct rho_passive_paper_config *config, unsigned runs)
{
    struct agreement agreement = {0};
    for (unsigned run = 0; run < runs; run++) {
        scene = *from;
        draw_scene(&scene);
        double turn_rad = uniform(-PI, PI), x_m = uniform(-3e5, 3e5), y_m = uniform(-3e5, 3e5);
        move_scene(&scene, turn_rad, x_m, y_m);
        compare_lines(config, &agreement);
    }
    print_message("%u sensors: %u lines in %u scenes of %u\n", from->sensors, agreement.lines,
                  agreement.sure, agreement.scenes);
    assert_true(5 * agreement.sure >= 2 * agreement.scenes);
    assert_true(agreement.lines >= agreement.sure / 2);
    return agreement;
}

static void lines_of_two_sensors_agree_with_a_dense_plane(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 2, 0.1, 0.9, 0.5);
    struct rho_passive_paper_config config = paper_config();
    random_state = 1;
    config.votes_min = 5;
    compare_scenes(&from, &config, 40);
    config.rule = RHO_GHOST_NO_RULE;
    compare_scenes(&from, &config, 40);
    from.targets = 3;
    from.pd = 1.0;
    config.votes_min = 0;
    compare_scenes(&from, &config, 40);
}

static void lines_of_three_sensors_agree_with_dense_planes(void **state)
{
    (void)state;
    struct scene from = scene_of(3, 3, 0.1, 0.9, 0.5);
    struct rho_passive_paper_config config = paper_config();
    random_state = 2;
    config.votes_min = 5;
    compare_scenes(&from, &config, 50);
    config.rule = RHO_GHOST_NO_RULE;
    compare_scenes(&from, &config, 50);
    from.jitter_s = 7.0;
    config.votes_min = 4;
    compare_scenes(&from, &config, 30);
}

static void lines_agree_for_other_cells_and_ranges(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 2, 0.1, 1.0, 0.0);
    struct rho_passive_paper_config config = paper_config();
    random_state = 3;
    config.rho_cell_m = 1500.0f;
    config.theta_cell_rad = (float)(PI / 40.0);
    config.range_max_m = 60000.0f;
    compare_scenes(&from, &config, 40);
    config.theta_cell_rad = 0.3f; /* 10 rows, fewer than a plateau may extend */
    compare_scenes(&from, &config, 10);
}

static void votes_may_count_crossings_instead_of_scans(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 3, 0.1, 0.9, 0.5);
    struct rho_passive_paper_config config = paper_config();
    random_state = 4;
    config.votes_min = 6;
    config.votes = RHO_VOTES_POINTS;
    config.rule = RHO_GHOST_NO_RULE;
    compare_scenes(&from, &config, 40);
}

/*
 * Draws a place within 80 km seen by two of the four sensors; true if float determines its range to
 * a metre.
 */
static int draw_crossing_of_sure_range(struct rho_crossing_base *base, float bearing_rad[2],
                                       struct rho_crossing *crossing)
{
    double x_m = uniform(-80e3, 80e3), y_m = uniform(-80e3, 80e3);
    unsigned a = (unsigned)uniform(0.0, 3.0), b = (unsigned)uniform(a + 1.0, 4.0);
    assert_int_equal(rho_crossing_set_base(base, (float)scene.sensor_x_m[a],
                                           (float)scene.sensor_y_m[a], (float)scene.sensor_x_m[b],
                                           (float)scene.sensor_y_m[b]),
                     RHO_OK);
    bearing_rad[0] = (float)atan2(y_m - (double)base->y_a_m, x_m - (double)base->x_a_m);
    bearing_rad[1] = (float)atan2(y_m - (double)base->y_b_m, x_m - (double)base->x_b_m);
    return hypot(x_m, y_m) <= 80e3 &&
           rho_crossing_find(base, bearing_rad[0], bearing_rad[1], 100e3f, crossing) ==
               RHO_CROSSING_MEETS &&
           crossing->delta_rad >= 0.02f && crossing->delta_rad <= (float)PI - 0.02f;
}

/* Place where the float bearings meet, in double precision. */
static void exact_crossing_place(const struct rho_crossing_base *base, const float bearing_rad[2],
                                 double *x_m, double *y_m)
{
    double ca = cos((double)bearing_rad[0]), sa = sin((double)bearing_rad[0]);
    double cb = cos((double)bearing_rad[1]), sb = sin((double)bearing_rad[1]);
    double dx_m = (double)base->x_b_m - (double)base->x_a_m;
    double dy_m = (double)base->y_b_m - (double)base->y_a_m;
    double range_m = (dx_m * sb - dy_m * cb) / (ca * sb - sa * cb);
    *x_m = (double)base->x_a_m + range_m * ca;
    *y_m = (double)base->y_a_m + range_m * sa;
}

static void rho_agrees_from_either_sensor(void **state)
{
    (void)state;
    unsigned count = 0;
    double worst_m = 0.0, worst_true_m = 0.0;
    random_state = 5;
    scene = scene_of(4, 0, 0.1, 1.0, 0.0);
    while (count < 100000) {
        struct rho_crossing_base base;
        struct rho_crossing crossing;
        float bearing_rad[2];
        double x_m, y_m;
        if (!draw_crossing_of_sure_range(&base, bearing_rad, &crossing)) {
            continue;
        }
        float theta_rad = (float)uniform(0.0, PI);
        float from_a_m = rho_passive_paper_rho_m(crossing.range_a_m, bearing_rad[0], base.x_a_m,
                                                 base.y_a_m, theta_rad);
        float from_b_m = rho_passive_paper_rho_m(crossing.range_b_m, bearing_rad[1], base.x_b_m,
                                                 base.y_b_m, theta_rad);
        exact_crossing_place(&base, bearing_rad, &x_m, &y_m);
        double rho_m = x_m * cos((double)theta_rad) + y_m * sin((double)theta_rad);
        worst_m = fmax(worst_m, fabs((double)from_a_m - (double)from_b_m));
        worst_true_m = fmax(worst_true_m,
                            fmax(fabs((double)from_a_m - rho_m), fabs((double)from_b_m - rho_m)));
        count++;
    }
    print_message("rho from two sensors differs by %.3f m at most, from the truth by %.3f m\n",
                  worst_m, worst_true_m);
    assert_true(worst_m < 1.0 && worst_true_m < 1.0);
}

static void rho_of_given_places_is_right(void **state)
{
    (void)state;
    const float pi = (float)PI;
    assert_float_equal(rho_passive_paper_rho_m(5000.0f, 0.5f, 0.0f, 0.0f, 0.5f), 5000.0, 1e-2);
    assert_float_equal(rho_passive_paper_rho_m(5000.0f, -0.5f * pi, 0.0f, 10e3f, 0.5f * pi), 5000.0,
                       1e-2);
    assert_float_equal(rho_passive_paper_rho_m(5000.0f, pi, 10e3f, 7.0f, 0.0f), 5000.0, 1e-2);
    assert_float_equal(rho_passive_paper_rho_m(5000.0f, 0.0f, 10e3f, 20e3f, 0.25f * pi),
                       35000.0 / sqrt(2.0), 2e-2);
}

/* Sets a scene that all sensors see without noise or misses. */
static void set_scene(unsigned sensors, unsigned targets, const struct target *target)
{
    scene = scene_of(sensors, targets, 1e-6, 1.0, 0.0);
    scene.sigma_from_rad = scene.sigma_to_rad = RHO_LIMIT_SIGMA_RAD_MIN;
    set_scan_times(&scene);
    memcpy(scene.target, target, targets * sizeof *target);
    see_all_looks(&scene);
}

static void search_with_rule(enum rho_ghost_rule rule, unsigned votes_min)
{
    struct rho_passive_paper_config config = paper_config();
    config.rule = rule;
    config.votes_min = (uint16_t)votes_min;
    assert_int_equal(search_by_paper(&paper, &config, &scene), RHO_OK);
    assert_true(are_lines_sound(&paper));
}

static unsigned count_lines_near_path(const struct target *target)
{
    unsigned count = 0;
    for (unsigned i = 0; i < paper.num_lines; i++) {
        count += (unsigned)is_near_path(&paper.lines[i], target);
    }
    return count;
}

/* Sets a target that moves along the middle of a cell, so that all its crossings vote there. */
static struct target set_scene_of_cell(unsigned sensors, double theta_deg, double rho_m)
{
    double c = cos(theta_deg * DEG_RAD), s = sin(theta_deg * DEG_RAD);
    double x_m = sensors == 3 ? 10e3 / 3.0 : 0.0; /* mean of the sensors' places */
    const struct target target = {x_m + rho_m * c + 40e3 * s, rho_m * s - 40e3 * c, -300.0 * s,
                                  300.0 * c};
    set_scene(sensors, 1, &target);
    return target;
}

static void a_target_gives_one_line_with_its_state(void **state)
{
    (void)state;
    for (unsigned sensors = 2; sensors <= 3; sensors++) {
        struct target target = set_scene_of_cell(sensors, 67.0, 14.5e3);
        search_with_rule(RHO_GHOST_LITERAL, 0);
        const struct rho_passive_paper_line *line = &paper.lines[0];
        assert_int_equal(paper.num_lines, 1);
        assert_float_equal(line->theta_rad, 67.0 * DEG_RAD, 1e-6);
        assert_float_equal(line->rho_m,
                           14.5e3 + (sensors == 3 ? 10e3 / 3.0 * cos(67.0 * DEG_RAD) : 0.0), 0.1);
        assert_int_equal(line->votes, 8);
        assert_int_equal(line->votes_sum, sensors == 2 ? 8 : 24);
        assert_int_equal(line->scans, 0xff);
        assert_int_equal(line->crossings, sensors == 2 ? 8 : 24);
        assert_true(line->has_state);
        assert_float_equal(line->x_m, target_x_m(&target, 70.0), 2.0);
        assert_float_equal(line->y_m, target_y_m(&target, 70.0), 2.0);
        assert_float_equal(line->vx_mps, target.vx_mps, 0.1);
        assert_float_equal(line->vy_mps, target.vy_mps, 0.1);
    }
}

/* The ridge of a target far off is steep: over four cells of theta it leaves three of rho. */
static void a_far_target_gives_one_line(void **state)
{
    (void)state;
    for (int i = 0; i < 40; i++) {
        const double turn_rad = (i - 20) * 0.04;
        const struct target target = {70e3 * cos(turn_rad), 70e3 * sin(turn_rad),
                                      -250.0 * cos(turn_rad), -250.0 * sin(turn_rad)};
        set_scene(2, 1, &target);
        search_with_rule(RHO_GHOST_LITERAL, 5);
        assert_int_equal(paper.num_lines, 1);
        assert_int_equal(count_lines_near_path(&target), 1);
    }
}

/* Targets fly nearly along y: theta is near 0 or pi, whose cells belong to the same lines. */
static void a_line_at_the_end_of_theta_is_found_once(void **state)
{
    (void)state;
    for (int i = 0; i < 40; i++) {
        const struct target target = {37.1e3 + 113.0 * i, 9e3, 20.0 - i, 250.0};
        set_scene(2, 1, &target);
        search_with_rule(RHO_GHOST_LITERAL, 6);
        assert_int_equal(paper.num_lines, 1);
        assert_int_equal(count_lines_near_path(&target), 1);
        assert_in_range(paper.lines[0].votes, 7, 8);
    }
}

/*
 * Two targets mirrored in the x axis, seen from (0, +-10 km), have a ghost that moves straight
 * along that axis. With a third sensor on it the pairs have different ghosts.
 */
static void a_ghost_confirmed_by_one_pair_is_no_line_of_three_sensors(void **state)
{
    (void)state;
    const struct target targets[2] = {{52e3, 6e3, -280.0, -20.0}, {52e3, -6e3, -280.0, 20.0}};
    const struct target ghost = {40e3, 0.0, -1.0, 0.0};
    for (unsigned sensors = 2; sensors <= 3; sensors++) {
        set_scene(sensors, 2, targets);
        search_with_rule(RHO_GHOST_NO_RULE, 7);
        assert_true(count_lines_near_path(&targets[0]) > 0);
        assert_true(count_lines_near_path(&targets[1]) > 0);
        assert_int_equal(count_lines_near_path(&ghost) > 0, sensors == 2);
    }
}

static void a_line_needs_the_votes_of_every_pair(void **state)
{
    (void)state;
    set_scene_of_cell(3, 67.0, 14.5e3);
    scene.look[2][1].count = scene.look[5][1].count = 0; /* pairs with sensor 1 have 6 scans */
    search_with_rule(RHO_GHOST_LITERAL, 6);
    assert_int_equal(paper.num_lines, 1);
    assert_int_equal(paper.lines[0].votes, 6);
    assert_int_equal(paper.lines[0].votes_sum, 6 + 6 + 8);
    assert_int_equal(paper.lines[0].crossings, 6 + 6 + 8);
    search_with_rule(RHO_GHOST_LITERAL, 7);
    assert_int_equal(paper.num_lines, 0);
    assert_int_equal(paper.work.cells, 0);
}

static void by_default_four_fifths_of_the_scans_make_a_line(void **state)
{
    (void)state;
    const unsigned votes_min[5] = {4, 4, 5, 6, 7};
    for (unsigned scans = 4; scans <= 8; scans++) {
        set_scene_of_cell(2, 67.0, 14.5e3);
        scene.scans = scans;
        search_with_rule(RHO_GHOST_LITERAL, 0);
        assert_int_equal(paper.votes_min, votes_min[scans - 4]);
        assert_int_equal(paper.num_lines, 1);
        for (unsigned k = 0; k < scans - votes_min[scans - 4]; k++) {
            scene.look[k][0].count = 0;
        }
        search_with_rule(RHO_GHOST_LITERAL, 0);
        assert_int_equal(paper.num_lines, 1);
        assert_int_equal(paper.lines[0].votes, votes_min[scans - 4]);
        scene.look[scans - 1][1].count = 0;
        search_with_rule(RHO_GHOST_LITERAL, 0);
        assert_int_equal(paper.num_lines, 0);
    }
}

static void the_ghost_rule_decides_which_crossings_vote(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 2, 0.1, 1.0, 0.0);
    unsigned ghosts[3];
    random_state = 6;
    scene = from;
    draw_scene(&scene);
    for (int rule = RHO_GHOST_NO_RULE; rule <= RHO_GHOST_SAFE; rule++) {
        search_with_rule((enum rho_ghost_rule)rule, 0);
        ghosts[rule] = paper.work.ghosts;
        assert_int_equal(paper.work.crossings, 32);
        assert_int_equal(paper.work.votes, 90 * (32 - paper.work.ghosts));
    }
    assert_true(ghosts[RHO_GHOST_NO_RULE] < ghosts[RHO_GHOST_LITERAL]);
    assert_int_equal(ghosts[RHO_GHOST_LITERAL], 16);
    assert_int_equal(ghosts[RHO_GHOST_SAFE], 16);
}

/*
 * Scene and expected figures: share of targets with a line near their path, and other lines a run.
 */
struct figures {
    unsigned sensors, targets;
    double sigma_deg, pd, false_bearings;
    unsigned votes_min;
    enum rho_ghost_rule rule;
    double found, ghosts;
};

static void expect_figures(const struct figures *expected, unsigned runs)
{
    struct scene from = scene_of(expected->sensors, expected->targets, expected->sigma_deg,
                                 expected->pd, expected->false_bearings);
    double found = 0.0, ghosts = 0.0, ghosts2 = 0.0;
    for (unsigned run = 0; run < runs; run++) {
        scene = from;
        draw_scene(&scene);
        search_with_rule(expected->rule, expected->votes_min);
        unsigned others = paper.num_lines;
        for (unsigned i = 0; i < paper.num_lines; i++) {
            int is_any = 0;
            for (unsigned target = 0; target < scene.targets; target++) {
                is_any |= is_near_path(&paper.lines[i], &scene.target[target]);
            }
            others -= (unsigned)is_any;
        }
        for (unsigned target = 0; target < scene.targets; target++) {
            found += count_lines_near_path(&scene.target[target]) > 0;
        }
        ghosts += others;
        ghosts2 += others * (double)others;
    }
    double n = (double)runs * expected->targets;
    double mean = ghosts / runs, deviation = sqrt(ghosts2 / runs - mean * mean);
    print_message("%u sensors, %u targets, %.2f deg, T %u, rule %d: found %.3f (%.3f), ghosts a "
                  "run %.2f (%.2f)\n",
                  expected->sensors, expected->targets, expected->sigma_deg, expected->votes_min,
                  expected->rule, found / n, expected->found, mean, expected->ghosts);
    assert_true(fabs(found / n - expected->found) <=
                4.0 * sqrt(expected->found * (1.0 - expected->found) / n));
    assert_true(fabs(mean - expected->ghosts) <= 4.0 * deviation / sqrt(runs));
}

/* Expected figures are from 4000 runs. */
static void shares_found_and_ghosts_agree_with_known_figures(void **state)
{
    (void)state;
    static const struct figures figures[] = {
        {2, 2, 0.05, 1.0, 0.0, 7, RHO_GHOST_NO_RULE, 0.916, 2.29},
        {2, 2, 0.05, 1.0, 0.0, 7, RHO_GHOST_LITERAL, 0.927, 0.21},
        {2, 2, 0.1, 1.0, 0.0, 7, RHO_GHOST_NO_RULE, 0.832, 2.28},
        {2, 2, 0.1, 1.0, 0.0, 7, RHO_GHOST_LITERAL, 0.831, 0.23},
        {2, 2, 0.2, 1.0, 0.0, 6, RHO_GHOST_LITERAL, 0.769, 0.50},
        {2, 2, 0.5, 1.0, 0.0, 5, RHO_GHOST_LITERAL, 0.586, 1.32},
        {2, 2, 0.1, 0.9, 1.0, 5, RHO_GHOST_NO_RULE, 0.854, 5.29},
        {2, 2, 0.1, 0.9, 1.0, 5, RHO_GHOST_LITERAL, 0.672, 0.74},
        {2, 2, 0.1, 0.9, 1.0, 5, RHO_GHOST_SAFE, 0.850, 4.13},
        {3, 2, 0.1, 1.0, 0.0, 7, RHO_GHOST_NO_RULE, 0.357, 0.19},
        {3, 2, 0.1, 1.0, 0.0, 7, RHO_GHOST_LITERAL, 0.348, 0.02},
        {3, 4, 0.1, 0.9, 1.0, 5, RHO_GHOST_LITERAL, 0.396, 0.88},
    };
    random_state = 7;
    for (unsigned i = 0; i < sizeof figures / sizeof figures[0]; i++) {
        expect_figures(&figures[i], 200);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_of_two_sensors_agree_with_a_dense_plane),
        cmocka_unit_test(lines_of_three_sensors_agree_with_dense_planes),
        cmocka_unit_test(lines_agree_for_other_cells_and_ranges),
        cmocka_unit_test(votes_may_count_crossings_instead_of_scans),
        cmocka_unit_test(rho_agrees_from_either_sensor),
        cmocka_unit_test(rho_of_given_places_is_right),
        cmocka_unit_test(a_target_gives_one_line_with_its_state),
        cmocka_unit_test(a_far_target_gives_one_line),
        cmocka_unit_test(a_line_at_the_end_of_theta_is_found_once),
        cmocka_unit_test(a_ghost_confirmed_by_one_pair_is_no_line_of_three_sensors),
        cmocka_unit_test(a_line_needs_the_votes_of_every_pair),
        cmocka_unit_test(by_default_four_fifths_of_the_scans_make_a_line),
        cmocka_unit_test(the_ghost_rule_decides_which_crossings_vote),
        cmocka_unit_test(shares_found_and_ghosts_agree_with_known_figures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
