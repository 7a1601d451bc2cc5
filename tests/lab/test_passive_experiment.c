/* SPDX-License-Identifier: MIT */
/*
 * `rhotrack experiment passive` through its functions: what its scenes hold, the fit that knows the
 * bearings, few runs of its tables against the figures of many, and which bars are missed when.
 * Seeds are fixed; bounds are four standard deviations of so few runs away from the figures of many
 * (the comment at each).
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "experiment_passive.h"
#include "experiment_passive_report.h"

#define SEED 4711
#define PI 3.141592653589793
#define DEG_RAD (PI / 180.0)

static void assert_near(double value, double expected, double most)
{
    if (!(fabs(value - expected) <= most)) {
        fail_msg("%.9g, expected %.9g +- %.3g", value, expected, most);
    }
}

/* ---- scenes ---------------------------------------------------------------------------------- */

#define SCENES 400

static struct passive_scene draw(const struct passive_setting *setting, uint64_t run)
{
    struct random random = random_start(SEED, 1, run);
    return passive_scene_draw(setting, &random);
}

struct box {
    double x_min_m, x_max_m, y_min_m, y_max_m; /* of |y| */
};

/*
 * All starts are in the box, fill it, and fly within 45 degrees of the way to the origin; returns
 * how many start at positive y.
 */
static int check_starts(enum passive_region region, struct box box)
{
    struct passive_setting setting = {2, 2, 0.1, 1.0, 0.0, region, false};
    struct box seen = {INFINITY, -INFINITY, INFINITY, -INFINITY};
    int above = 0;
    for (uint64_t run = 0; run < SCENES; run++) {
        struct passive_scene scene = draw(&setting, run);
        for (size_t target = 0; target < 2; target++) {
            struct truth_point at = passive_truth(&scene, target, 0.0);
            double off_rad =
                remainder(atan2(at.vy_mps, at.vx_mps) - atan2(-at.y_m, -at.x_m), 2 * PI);
            assert_true(fabs(off_rad) <= PI / 4.0 + 1e-9);
            assert_true(hypot(at.vx_mps, at.vy_mps) >= 150.0 &&
                        hypot(at.vx_mps, at.vy_mps) <= 350.0);
            seen.x_min_m = fmin(seen.x_min_m, at.x_m);
            seen.x_max_m = fmax(seen.x_max_m, at.x_m);
            seen.y_min_m = fmin(seen.y_min_m, fabs(at.y_m));
            seen.y_max_m = fmax(seen.y_max_m, fabs(at.y_m));
            above += at.y_m > 0.0;
        }
        passive_scene_free(&scene);
    }
    /* of 800 uniform values none in an outermost 2 %: 1e-7 */
    double dx_m = box.x_max_m - box.x_min_m, dy_m = box.y_max_m - box.y_min_m;
    assert_near(seen.x_min_m, box.x_min_m + 0.01 * dx_m, 0.01 * dx_m);
    assert_near(seen.x_max_m, box.x_max_m - 0.01 * dx_m, 0.01 * dx_m);
    assert_near(seen.y_min_m, box.y_min_m + 0.01 * dy_m, 0.01 * dy_m);
    assert_near(seen.y_max_m, box.y_max_m - 0.01 * dy_m, 0.01 * dy_m);
    return above;
}

static void targets_start_where_the_case_says(void **state)
{
    (void)state;
    /* half of 800, standard deviation 14 */
    int above = check_starts(PASSIVE_EXTENSION, (struct box){-1500.0, 1500.0, 25e3, 60e3});
    assert_in_range(above, 343, 457);
    above = check_starts(PASSIVE_NEAR, (struct box){15e3, 35e3, 0.0, 15e3});
    assert_in_range(above, 343, 457);
}

static double mean_share(const struct passive_scene *scene, double *squares)
{
    double sum = 0.0;
    for (size_t scan = 1; scan < PASSIVE_SCANS; scan++) {
        double share = (scene->times_s[scan] - scene->times_s[scan - 1]) / PASSIVE_INTERVAL_S;
        assert_true(share >= 0.3 && share <= 1.7);
        sum += share;
        *squares += share * share;
    }
    return sum;
}

static void unequal_intervals_are_uniform_and_bearings_have_their_times(void **state)
{
    (void)state;
    struct passive_setting setting = {3, 2, 1e-6, 1.0, 0.0, PASSIVE_AHEAD, true};
    double sum = 0.0, squares = 0.0, count = SCENES * (PASSIVE_SCANS - 1);
    for (uint64_t run = 0; run < SCENES; run++) {
        struct passive_scene scene = draw(&setting, run);
        sum += mean_share(&scene, &squares);
        for (size_t i = 0; i < scene.simulation->num_looks; i++) {
            const struct simulated_look *look = &scene.simulation->looks[i];
            for (size_t j = 0; j < look->num_bearings; j++) {
                struct truth_point at = passive_truth(&scene, (size_t)look->bearings[j].target_id,
                                                      scene.times_s[i / 3]);
                double true_rad = atan2(at.y_m - scene.plan.passive.sensors[look->sensor].y_m,
                                        at.x_m - scene.plan.passive.sensors[look->sensor].x_m);
                assert_near(remainder(look->bearings[j].bearing_rad - true_rad, 2 * PI), 0.0, 1e-6);
            }
            assert_int_equal(look->num_bearings, 2);
        }
        passive_scene_free(&scene);
    }
    double mean = sum / count, variance = 1.4 * 1.4 / 12.0;
    assert_near(mean, 1.0, 4.0 * sqrt(variance / count));
    assert_near(squares / count - mean * mean, variance, 4.0 * variance * 2.0 / sqrt(5.0 * count));
}

static void equal_intervals_are_ten_seconds(void **state)
{
    (void)state;
    struct passive_setting setting = {2, 1, 0.1, 1.0, 0.0, PASSIVE_AHEAD, false};
    struct passive_scene scene = draw(&setting, 0);
    for (size_t scan = 0; scan < PASSIVE_SCANS; scan++) {
        assert_near(scene.times_s[scan], 10.0 * (double)scan, 1e-9);
    }
    assert_near(passive_middle_s(&scene), 35.0, 1e-9);
    passive_scene_free(&scene);
}

static void a_frame_holds_what_the_asked_sensors_see(void **state)
{
    (void)state;
    struct passive_setting setting = {3, 4, 0.1, 0.9, 1.0, PASSIVE_AHEAD, false};
    struct passive_scene scene = draw(&setting, 0);
    static struct passive_frame frame;
    passive_frame_fill(&frame, &scene, 5, 5u);
    assert_int_equal(frame.frame.num_scans, 2);
    assert_int_equal(frame.frame.time_us, 50000000);
    assert_int_equal(frame.frame.scans[0].sensor_id, 1);
    assert_int_equal(frame.frame.scans[1].sensor_id, 3);
    const struct simulated_look *look = passive_look(&scene, 5, 2);
    assert_int_equal(frame.frame.scans[1].num_bearings, look->num_bearings);
    for (size_t i = 0; i < look->num_bearings; i++) {
        assert_near((double)frame.frame.scans[1].bearings[i].bearing_rad,
                    look->bearings[i].bearing_rad, 1e-6);
        assert_near((double)frame.frame.scans[1].bearings[i].sigma_rad, 0.1 * DEG_RAD, 1e-9);
    }
    passive_scene_free(&scene);
}

/* ---- lines ----------------------------------------------------------------------------------- */

static void lines_are_apart_by_the_smaller_angle(void **state)
{
    (void)state;
    /*
     * north along x = 1 km: theta 0; and turned by a little either way, where theta wraps and rho
     * changes its sign
     */
    struct passive_line north = passive_line_of(1000.0, 5.0, 0.0, 200.0);
    struct passive_line right = passive_line_of(1000.0, 0.0, sin(0.01), cos(0.01));
    struct passive_line left = passive_line_of(1000.0, 0.0, -sin(0.01), cos(0.01));
    assert_near(fabs(remainder(north.theta_rad, PI)), 0.0, 1e-12);
    assert_near(fabs(north.rho_m), 1000.0, 1e-9);
    assert_near(passive_line_off(&left, &right).theta_rad, 0.02, 1e-12);
    assert_near(passive_line_off(&left, &right).rho_m, 0.0, 1e-6);
    assert_near(passive_line_off(&north, &left).theta_rad, 0.01, 1e-12);
    assert_near(passive_line_off(&north, &right).rho_m, 1000.0 * (1.0 - cos(0.01)), 1e-6);
    struct passive_line back = passive_line_of(1000.0, 5.0, 0.0, -200.0);
    assert_near(passive_line_off(&north, &back).theta_rad, 0.0, 1e-12);
    assert_near(passive_line_off(&north, &back).rho_m, 0.0, 1e-9);
}

/* ---- the fit that knows ---------------------------------------------------------------------- */

#define FIT_BEARINGS 16

static void look_at(struct clairvoyant_bearing bearings[FIT_BEARINGS], const double state[4],
                    struct random *random, double sigma_rad)
{
    for (int i = 0; i < FIT_BEARINGS; i++) {
        struct clairvoyant_bearing *bearing = &bearings[i];
        *bearing = (struct clairvoyant_bearing){.t_s = 10.0 * (i / 2) - 35.0,
                                                .sensor_y_m = i % 2 ? 10e3 : -10e3,
                                                .sigma_rad = sigma_rad};
        bearing->bearing_rad = atan2(state[1] + bearing->t_s * state[3] - bearing->sensor_y_m,
                                     state[0] + bearing->t_s * state[2]) +
                               sigma_rad * random_normal(random);
    }
}

static void exact_bearings_give_the_truth(void **state)
{
    (void)state;
    const double truth[4] = {40e3, 5e3, -220.0, 60.0}, start[4] = {43e3, 2e3, -100.0, 0.0};
    struct clairvoyant_bearing bearings[FIT_BEARINGS];
    struct random random = random_start(SEED, 2, 0);
    look_at(bearings, truth, &random, 1e-9);
    struct clairvoyant_course course = clairvoyant_bearings_fit(bearings, FIT_BEARINGS, start);
    for (int i = 0; i < 4; i++) {
        assert_near(course.state[i], truth[i], i < 2 ? 0.01 : 0.001);
    }
}

/* Chi-square of 4 degrees of freedom: mean 4, variance 8. */
static void its_covariance_is_that_of_its_errors(void **state)
{
    (void)state;
    const double truth[4] = {40e3, 5e3, -220.0, 60.0};
    double sum = 0.0;
    for (uint64_t run = 0; run < 1000; run++) {
        struct clairvoyant_bearing bearings[FIT_BEARINGS];
        struct random random = random_start(SEED, 3, run);
        look_at(bearings, truth, &random, 0.1 * DEG_RAD);
        struct clairvoyant_course course = clairvoyant_bearings_fit(bearings, FIT_BEARINGS, truth);
        double off[4];
        for (int i = 0; i < 4; i++) {
            off[i] = course.state[i] - truth[i];
        }
        sum += clairvoyant_nees(off, (const double(*)[4])course.covariance);
    }
    assert_near(sum / 1000.0, 4.0, 4.0 * sqrt(8.0 / 1000.0));
}

static void nees_weighs_by_the_inverse(void **state)
{
    (void)state;
    const double covariance[4][4] = {
        {4.0, 2.0, 0.0, 0.0}, {2.0, 2.0, 0.0, 0.0}, {0.0, 0.0, 9.0, 0.0}, {0.0, 0.0, 0.0, 25.0}};
    const double off[4] = {2.0, 0.0, 3.0, 10.0};
    /* inverse of the first two: 0.5, -0.5; -0.5, 1 */
    assert_near(clairvoyant_nees(off, covariance), 2.0 + 1.0 + 4.0, 1e-12);
}

/* ---- the tables ------------------------------------------------------------------------------ */

#define TABLE_RUNS 20

static size_t case_named(const char *name)
{
    for (size_t i = 0; i < passive_num_default_cases; i++) {
        if (strcmp(passive_default_cases[i].name, name) == 0) {
            return i;
        }
    }
    fail_msg("no case %s", name);
    return 0;
}

static void pruning_is_counted_by_rule(void **state)
{
    (void)state;
    struct passive_pruning_run sum = {0};
    for (uint64_t run = 0; run < 100; run++) {
        struct random random = random_start(SEED, 4, run);
        struct passive_pruning_run one = passive_pruning_run(&passive_pruning_cases[0], &random);
        assert_int_equal(one.targets, 2 * PASSIVE_SCANS);
        assert_int_equal(one.ghosts, 2 * PASSIVE_SCANS);
        for (int rule = 0; rule < PASSIVE_RULES; rule++) {
            assert_int_equal(one.targets_lost[rule], 0);
            sum.ghosts_removed[rule] += one.ghosts_removed[rule];
        }
        assert_true(one.ghosts_removed[RHO_GHOST_LITERAL] >= one.ghosts_removed[RHO_GHOST_NO_RULE]);
        assert_int_equal(one.ghosts_removed[RHO_GHOST_LITERAL], one.ghosts_removed[RHO_GHOST_SAFE]);
    }
    /* 0.39 and 0.78 of 1600; scans of a run are alike: as of 100 to 200 independent scenes */
    assert_in_range(sum.ghosts_removed[RHO_GHOST_NO_RULE], 370, 880);
    assert_in_range(sum.ghosts_removed[RHO_GHOST_LITERAL], 1000, 1500);
}

static void the_papers_method_finds_what_it_did_elsewhere(void **state)
{
    (void)state;
    const struct passive_paper_case *of = &passive_paper_cases[0];
    struct rho_passive_paper *paper = malloc(sizeof *paper);
    size_t found[2] = {0, 0}, ghosts[2] = {0, 0};
    assert_non_null(paper);
    for (uint64_t run = 0; run < TABLE_RUNS; run++) {
        struct random random = random_start(SEED, 5, run);
        struct passive_paper_run one = passive_paper_run(of, paper, &random);
        assert_int_equal(one.targets, 2);
        assert_int_equal(one.by_rule[RHO_GHOST_SAFE].found, 0); /* not asked for */
        for (int rule = 0; rule < 2; rule++) {
            assert_true(one.by_rule[rule].found <= 2);
            found[rule] += one.by_rule[rule].found;
            ghosts[rule] += one.by_rule[rule].ghosts;
        }
    }
    free(paper);
    assert_in_range(found[0], 29, 40);  /* 0.93 of 40 */
    assert_in_range(found[1], 30, 40);  /* 0.95 */
    assert_in_range(ghosts[0], 17, 80); /* 2.3 a run, standard deviation 1.7 */
    assert_in_range(ghosts[1], 0, 20);  /* 0.35 */
}

static void the_default_finds_three_sensors_targets(void **state)
{
    (void)state;
    const struct passive_default_case *of =
        &passive_default_cases[case_named("3s 4t .1 P_D .9 FA 1")];
    struct rho_passive *passive = malloc(sizeof *passive);
    size_t found = 0, ghosts = 0, own = 0;
    double off_m2 = 0.0, fit_off_m2 = 0.0, own_nees = 0.0;
    assert_non_null(passive);
    for (uint64_t run = 0; run < TABLE_RUNS; run++) {
        struct random random = random_start(SEED, 6, run);
        struct passive_default_run one = passive_default_run(of, passive, &random);
        found += one.found;
        ghosts += one.ghosts;
        assert_true(one.search_us > 0.0);
        for (size_t i = 0; i < one.found; i++) {
            const struct passive_hit *hit = &one.hits[i];
            off_m2 += hit->off_m * hit->off_m;
            fit_off_m2 += hit->fit_off_m * hit->fit_off_m;
            own += hit->is_own;
            own_nees += hit->is_own ? hit->nees : 0.0;
        }
    }
    free(passive);
    assert_in_range(found, 78, 80); /* 0.999 of 80 */
    assert_in_range(ghosts, 0, 1);  /* 0.000 a run */
    assert_in_range(own, 55, 79);   /* 0.87 of the found */
    assert_near(sqrt(off_m2 / fit_off_m2), 1.03, 0.15);
    assert_near(own_nees / (double)own, 4.1, 4.0 * sqrt(8.0 / (double)own));
}

/*
 * Two of its targets meet at mid-batch, where each one's track once was taken for the other's: NEES
 * 70 000, 87 degrees.
 */
static void targets_that_meet_at_mid_batch_have_their_own_tracks(void **state)
{
    (void)state;
    size_t number = case_named("4s 6t .1 P_D .9 FA 1");
    struct rho_passive *passive = malloc(sizeof *passive);
    assert_non_null(passive);
    struct random random = random_start(1, 7000 + number, 343); /* of the command's own runs */
    struct passive_default_run one =
        passive_default_run(&passive_default_cases[number], passive, &random);
    free(passive);
    assert_int_equal(one.found, 6);
    for (size_t i = 0; i < one.found; i++) {
        assert_true(one.hits[i].nees < 30.0);
        assert_true(one.hits[i].line_off.theta_rad < 10.0 * DEG_RAD);
    }
}

static void no_target_is_found_where_there_is_none(void **state)
{
    (void)state;
    const struct passive_default_case *of = &passive_default_cases[case_named("2s no target FA 4")];
    struct rho_passive *passive = malloc(sizeof *passive);
    assert_non_null(passive);
    for (uint64_t run = 0; run < TABLE_RUNS; run++) {
        struct random random = random_start(SEED, 7, run);
        struct passive_default_run one = passive_default_run(of, passive, &random);
        assert_int_equal(one.found, 0);
        assert_int_equal(one.ghosts, 0);
    }
    free(passive);
}

/* ---- bars ------------------------------------------------------------------------------------ */

/* A report in which all is as the reference says. */
static struct passive_report *ideal_report(size_t default_runs)
{
    struct passive_report *report = calloc(1, sizeof *report);
    report->pruning = calloc(passive_num_pruning_cases, sizeof *report->pruning);
    report->paper = calloc(passive_num_paper_cases, sizeof *report->paper);
    report->defaults = calloc(passive_num_default_cases, sizeof *report->defaults);
    report->default_runs = default_runs;
    for (size_t i = 0; i < passive_num_pruning_cases; i++) {
        memcpy(report->pruning[i].by_rule, passive_pruning_cases[i].reference,
               sizeof report->pruning[i].by_rule);
    }
    for (size_t i = 0; i < passive_num_paper_cases; i++) {
        memcpy(report->paper[i].by_rule, passive_paper_cases[i].reference,
               sizeof report->paper[i].by_rule);
    }
    for (size_t i = 0; i < passive_num_default_cases; i++) {
        report->defaults[i].found = passive_default_cases[i].reference;
        report->defaults[i].rms_m = report->defaults[i].fit_rms_m = 100.0;
        report->defaults[i].search_ms = 5.0;
    }
    report->clean_nees = report->own_nees = report->nees = (struct passive_nees){4.0, 1000};
    return report;
}

static int judge(struct passive_report *report)
{
    passive_judge(report);
    int missed = report->verdicts.missed;
    verdicts_free(&report->verdicts);
    return missed;
}

static void free_report(struct passive_report *report)
{
    free(report->pruning);
    free(report->paper);
    free(report->defaults);
    free(report);
}

static void every_bar_can_be_missed(void **state)
{
    (void)state;
    struct passive_report *report = ideal_report(100);
    size_t timed = case_named("3s 4t .1 P_D .9 FA 1"), pair = case_named("2s 4t .1 P_D .9 FA 1");
    double *const figures[] = {
        &report->pruning[0].by_rule[RHO_GHOST_LITERAL].ghosts,
        &report->pruning[0].by_rule[RHO_GHOST_LITERAL].targets,
        &report->pruning[3].by_rule[RHO_GHOST_SAFE].targets,
        &report->paper[1].by_rule[RHO_GHOST_NO_RULE].share,
        &report->paper[4].by_rule[RHO_GHOST_SAFE].ghosts_a_run,
        &report->defaults[pair].found.share,
        &report->defaults[pair].found.ghosts_a_run,
        &report->defaults[pair].rms_m,
        &report->defaults[timed].search_ms,
        &report->clean_nees.mean,
        &report->own_nees.mean,
    };
    const double bad[] = {0.73, 0.001, 0.0031, 0.76, 5.67, 0.93, 0.13, 108.5, 10.1, 3.4, 4.8};
    assert_int_equal(judge(report), 0);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        double good = *figures[i];
        *figures[i] = bad[i];
        if (judge(report) != 1) {
            fail_msg("figure %zu does not miss its bar", i);
        }
        *figures[i] = good;
    }
    free_report(report);
}

static void time_is_judged_from_100_runs_on(void **state)
{
    (void)state;
    struct passive_report *report = ideal_report(99);
    report->defaults[case_named("3s 4t .1 P_D .9 FA 1")].search_ms = 50.0;
    assert_int_equal(judge(report), 0);
    report->default_runs = 100;
    assert_int_equal(judge(report), 1);
    free_report(report);
}

/* ---- figures --------------------------------------------------------------------------------- */

static void the_figures_scenes_show_what_the_papers_do(void **state)
{
    (void)state;
    struct passive_figure figures[PASSIVE_FIGURES];
    passive_figures_make(figures);
    assert_int_equal(figures[0].crossings, 2 * PASSIVE_SCANS);
    assert_int_equal(figures[0].ghosts, PASSIVE_SCANS);
    assert_true(figures[0].lines.found == 2 && figures[0].lines.ghosts >= 1);
    assert_int_equal(figures[1].crossings, 2 * PASSIVE_SCANS);
    assert_int_equal(figures[1].ghosts, 0);
    assert_true(figures[1].lines.found == 2 && figures[1].lines.ghosts == 0);
    size_t ghosts = 0;
    for (int i = 2; i < 5; i++) {
        assert_int_equal(figures[i].crossings, 2 * PASSIVE_SCANS);
        ghosts += figures[i].ghosts;
    }
    assert_true(figures[2].lines.ghosts + figures[3].lines.ghosts >= 2);
    assert_int_equal(figures[5].crossings, 6 * PASSIVE_SCANS);
    assert_int_equal(figures[5].ghosts, ghosts);
    assert_true(figures[5].lines.found == 2 && figures[5].lines.ghosts == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(targets_start_where_the_case_says),
        cmocka_unit_test(unequal_intervals_are_uniform_and_bearings_have_their_times),
        cmocka_unit_test(equal_intervals_are_ten_seconds),
        cmocka_unit_test(a_frame_holds_what_the_asked_sensors_see),
        cmocka_unit_test(lines_are_apart_by_the_smaller_angle),
        cmocka_unit_test(exact_bearings_give_the_truth),
        cmocka_unit_test(its_covariance_is_that_of_its_errors),
        cmocka_unit_test(nees_weighs_by_the_inverse),
        cmocka_unit_test(pruning_is_counted_by_rule),
        cmocka_unit_test(the_papers_method_finds_what_it_did_elsewhere),
        cmocka_unit_test(the_default_finds_three_sensors_targets),
        cmocka_unit_test(targets_that_meet_at_mid_batch_have_their_own_tracks),
        cmocka_unit_test(no_target_is_found_where_there_is_none),
        cmocka_unit_test(every_bar_can_be_missed),
        cmocka_unit_test(time_is_judged_from_100_runs_on),
        cmocka_unit_test(the_figures_scenes_show_what_the_papers_do),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
