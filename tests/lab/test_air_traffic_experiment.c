/* SPDX-License-Identifier: MIT */
/*
 * `experiment air-traffic` with few and short runs: are its figures those of the tracks, is the
 * limit one, can every bar be missed? Its figures of many runs stand in its page.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "experiment_air_traffic.h"
#include "poisson.h"
#include "scene_simulation.h"

#define SEED 7

static struct air_case case_of(double targets, double clutter, size_t num_scans)
{
    return (struct air_case){.name = "test",
                             .targets = targets,
                             .clutter = clutter,
                             .num_scans = num_scans,
                             .share = 1,
                             .has_limit = true};
}

static struct air_result run(const struct air_case *of)
{
    struct pipeline chain = pipeline_start();
    struct air_result result = air_run(of, SEED, 0, &chain);

    pipeline_free(&chain);
    return result;
}

/* ---- traffic --------------------------------------------------------------------------------- */

static void aircraft_are_tracked(void **state)
{
    struct air_case of = case_of(20, 100, 60);
    struct air_result result = run(&of);
    (void)state;

    print_message("complete %.3f, false %.3f a scan, delay %.2f\n", result.tracks[0].completeness,
                  result.tracks[0].false_a_scan, result.tracks[0].delay_scans);
    assert_true(result.tracks[0].completeness >= 0.9 && result.tracks[0].completeness <= 1.0);
    assert_true(result.tracks[0].false_a_scan <= 1.0);
    assert_true(result.tracks[0].delay_scans >= 2.0 && result.tracks[0].delay_scans <= 4.0);
    assert_true(result.plots > 110.0 && result.plots < 130.0);
    assert_true(result.us > 0.0 && result.max_us >= result.us);
    assert_true(fabs(result.hours - 600.0 / 3600.0) < 1e-9);
}

/* GOSPA is the sum of its parts: cutoff^2 / 2 for each that has no partner. */
static void gospa_is_the_sum_of_its_parts(void **state)
{
    struct air_case of = case_of(20, 100, 60);
    struct air_result result = run(&of);
    (void)state;

    for (size_t i = 0; i < AIR_CUTOFFS; i++) {
        const struct air_figures *figures = &result.tracks[i];
        double half_m2 = air_cutoffs_m[i] * air_cutoffs_m[i] / 2.0;
        double parts_m2 = figures->localisation_m * figures->localisation_m +
                          half_m2 * (figures->missed + figures->false_a_scan);
        assert_true(fabs(figures->gospa_m * figures->gospa_m / parts_m2 - 1.0) < 1e-6);
        assert_true(figures->gospa_m > 0.0);
    }
    assert_true(result.tracks[1].missed >= result.tracks[0].missed);
}

/* Found by scan k: 0 before a track can start, more with every scan, and all at the end. */
static void shares_found_grow(void **state)
{
    struct air_case of = case_of(30, 100, 60);
    struct air_result result = run(&of);
    (void)state;

    assert_true(result.alive[0] >= 30.0 && result.found[0] < 0.5 && result.found[1] < 0.5);
    for (size_t k = 1; k < AIR_FOUND_SCANS; k++) {
        assert_true(result.alive[k] <= result.alive[k - 1]);
    }
    assert_true(result.found[2] > 0.5 * result.alive[2]);
    assert_true(result.found[9] >= 0.95 * result.alive[9]);
}

/* ---- the limit ------------------------------------------------------------------------------- */

static void figures_are_the_limits_where_nothing_else_is_to_be_seen(void **state)
{
    struct air_case of = case_of(10, 0, 60);
    struct air_result result = run(&of);
    (void)state;

    for (size_t i = 0; i < AIR_CUTOFFS; i++) {
        print_message("gospa %.1f, limit %.1f\n", result.tracks[i].gospa_m,
                      result.limit[i].gospa_m);
        assert_true(fabs(result.tracks[i].gospa_m / result.limit[i].gospa_m - 1.0) < 0.02);
    }
}

/* The targets' plots are the same at any clutter, and so is what can be made of them. */
static void the_limit_knows_no_clutter(void **state)
{
    struct air_case clear = case_of(10, 0, 50), dense = case_of(10, 500, 50);
    struct air_result one = run(&clear), other = run(&dense);
    (void)state;

    assert_true(fabs(one.min_scans - other.min_scans) < 0.5);
    assert_memory_equal(&one.limit, &other.limit, sizeof one.limit);
    assert_true(other.limit[0].gospa_m <= other.tracks[0].gospa_m + 1.0);
}

static void the_limit_starts_at_so_many_hits(void **state)
{
    struct air_case of = case_of(20, 0, 40);
    struct scene *scene = air_scene(&of);
    struct parameters parameters = scene_parameters(scene);
    struct simulation *simulation = scene_simulation(scene, SEED, 0);
    struct pipeline chain = pipeline_start();
    (void)state;

    for (unsigned min_scans = 3; min_scans <= 5; min_scans++) {
        struct air_points *scans = calloc(simulation->num_scans, sizeof *scans);
        air_limit(&parameters, simulation, min_scans, &chain, scans);
        for (size_t scan = 0; scan + 1 < min_scans; scan++) {
            assert_int_equal(scans[scan].count, 0);
        }
        /* seen in all of the first scans, 0.95^M of 20, and flown straight */
        assert_in_range(scans[min_scans - 1].count, 5, 20);
        assert_true(scans[12].count >= 14);
        for (size_t scan = 0; scan < simulation->num_scans; scan++) {
            free(scans[scan].points);
        }
        free(scans);
    }
    pipeline_free(&chain);
    simulation_free(simulation);
    scene_free(scene);
}

/* ---- pairs, clutter -------------------------------------------------------------------------- */

/* Apart, side by side from a quarter to three quarters of the time, apart; at one speed. */
static void a_formation_meets_flies_side_by_side_and_parts(void **state)
{
    struct parameters parameters;
    struct simulation *simulation;
    (void)state;

    parameters_default(&parameters);
    scenario_suggest("formation", &parameters);
    parameters_suggest(&parameters, PARAMETER_SPACING_M, 300);
    simulation = scenario_simulate("formation", &parameters, SEED, 0);
    assert_int_equal(simulation->num_scans, 61);
    for (size_t scan = 0; scan < 61; scan++) {
        const struct truth_point *one = &simulation->truth[2 * scan], *other = one + 1;
        double off_scans = fmax(0.0, fabs((double)scan - 30.0) - 15.0);
        double spacing_m = 300.0 + off_scans * 10.0 * 2.0 * 250.0 * sin(0.08726646259971647);
        assert_true(fabs(one->y_m - other->y_m - spacing_m) < 1e-6);
        assert_true(fabs(one->x_m - other->x_m) < 1e-6);
        assert_true(fabs(hypot(one->vx_mps, one->vy_mps) - 250.0) < 1e-9);
        if (scan > 0) {
            assert_true(fabs(hypot(one->x_m - one[-2].x_m, one->y_m - one[-2].y_m) - 2500.0) <
                        1e-6);
        }
    }
    simulation_free(simulation);
}

static void pairs_are_told_apart(void **state)
{
    struct pipeline chain = pipeline_start();
    struct air_pair far = {"far apart", "parallel", 31, 5000, 0, 395, NAN};
    struct air_pair merged = {"always one plot", "parallel", 31, 150, 250, 0, NAN};
    struct air_pair_result apart = air_pair_run(&far, SEED, 0, &chain);
    struct air_pair_result one = air_pair_run(&merged, SEED, 0, &chain);
    (void)state;

    assert_true(apart.kept > 0.5 && apart.lost < 0.5 && apart.completeness > 0.85);
    assert_true(one.lost > 0.5 && one.completeness < 0.6);
    pipeline_free(&chain);
}

static void clutter_alone_gives_few_tracks(void **state)
{
    struct pipeline chain = pipeline_start();
    struct air_alarm few = {100, 1}, many = {100, 10000};
    struct air_alarm_result less = air_alarm_run(&few, SEED, 0, &chain);
    struct air_alarm_result more = air_alarm_run(&many, SEED, 0, &chain);
    (void)state;

    print_message("%.0f and %.0f tracks in %.2f hours\n", less.confirmed, more.confirmed,
                  less.hours);
    assert_true(fabs(less.hours - AIR_ALARM_SCANS / 360.0) < 1e-9);
    assert_true(less.confirmed <= 6.0 && more.confirmed >= less.confirmed + 6.0);
    assert_true(less.us > 0.0 && less.min_scans > 2.9);
    pipeline_free(&chain);
}

/* Exact limits (Garwood's): of 0 0 .. 3.69, of 10 4.795 .. 18.39. */
static void limits_of_a_poisson_mean(void **state)
{
    (void)state;

    assert_true(fabs(poisson_low(0.0)) < 1e-9 && fabs(poisson_high(0.0) - 3.69) < 0.06);
    assert_true(fabs(poisson_low(10.0) - 4.795) < 0.02);
    assert_true(fabs(poisson_high(10.0) - 18.39) < 0.02);
}

/* ---- verdicts -------------------------------------------------------------------------------- */

/* All figures as good as can be, or as bad. */
static struct air_report report_of(bool is_good)
{
    struct air_report report = {.num_runs = 1, .parts = AIR_PART_ALL, .pair_runs = 1};
    double gospa_m = is_good ? 100.0 : 1000.0;

    report.results = calloc(air_num_cases(), sizeof *report.results);
    for (size_t i = 0; i < air_num_cases(); i++) {
        struct air_result *of = &report.results[i];
        of->us = is_good ? 1.0 : 1e6;
        for (size_t k = 0; k < AIR_CUTOFFS; k++) {
            of->tracks[k] = (struct air_figures){
                .gospa_m = gospa_m, .completeness = is_good, .false_a_scan = is_good ? 0.0 : 100.0};
            of->limit[k].gospa_m = 100.0;
        }
    }
    for (size_t i = 0; i < AIR_PAIRS; i++) {
        report.pairs[i] = (struct air_pair_result){.kept = is_good, .lost = !is_good};
    }
    for (size_t i = 0; i < AIR_ALARMS; i++) {
        report.alarms[i] = (struct air_alarm_result){
            .hours = 100.0, .confirmed = (is_good ? 100.0 : 300.0) * air_alarms[i].wanted_per_hour};
    }
    report.rivals.own = (struct air_rival){"own", {.gospa_m = gospa_m}, is_good ? 1.0 : 100.0};
    for (size_t i = 0; i < AIR_RIVALS; i++) {
        report.rivals.others[i] = (struct air_rival){"other", {.gospa_m = 200.0}, 1000.0};
    }
    return report;
}

static void every_bar_can_be_held_and_missed(void **state)
{
    struct air_report good = report_of(true), bad = report_of(false);
    (void)state;

    air_judge(&good);
    air_judge(&bad);
    assert_int_equal(good.verdicts.missed, 0);
    /* a rate is too high or too low, not both */
    assert_int_equal(bad.verdicts.held, AIR_ALARMS);
    assert_int_equal(bad.verdicts.missed + AIR_ALARMS, good.verdicts.held);
    assert_int_equal(good.verdicts.held, 12 + 2 + AIR_PAIRS + 2 * AIR_ALARMS + 2 * AIR_RIVALS);
    air_report_free(&good);
    air_report_free(&bad);
}

static void too_few_false_tracks_are_seen_too(void **state)
{
    struct air_report report = report_of(true);
    (void)state;

    report.parts = AIR_PART_CLUTTER;
    report.alarms[0].confirmed = 10.0;
    report.alarms[1].hours = 0.5; /* too few to judge */
    air_judge(&report);
    assert_int_equal(report.verdicts.missed, 1);
    assert_int_equal(report.verdicts.held, 2 * AIR_ALARMS - 3);
    air_report_free(&report);
}

static void parts_have_names(void **state)
{
    (void)state;

    assert_int_equal(air_part_named("grid") | air_part_named("stress") |
                         air_part_named("operation") | air_part_named("pairs") |
                         air_part_named("clutter") | air_part_named("rivals"),
                     AIR_PART_ALL);
    assert_int_equal(air_part_named("gnn"), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(aircraft_are_tracked),
        cmocka_unit_test(gospa_is_the_sum_of_its_parts),
        cmocka_unit_test(shares_found_grow),
        cmocka_unit_test(figures_are_the_limits_where_nothing_else_is_to_be_seen),
        cmocka_unit_test(the_limit_knows_no_clutter),
        cmocka_unit_test(the_limit_starts_at_so_many_hits),
        cmocka_unit_test(a_formation_meets_flies_side_by_side_and_parts),
        cmocka_unit_test(pairs_are_told_apart),
        cmocka_unit_test(clutter_alone_gives_few_tracks),
        cmocka_unit_test(limits_of_a_poisson_mean),
        cmocka_unit_test(every_bar_can_be_held_and_missed),
        cmocka_unit_test(too_few_false_tracks_are_seen_too),
        cmocka_unit_test(parts_have_names),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
