/* SPDX-License-Identifier: MIT */
/* Scenario air-traffic: do flights do what they should? Seeds are fixed; bounds are four standard deviations. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "traffic_scene.h"

/* ---- flights ---------------------------------------------------------------------------------- */

static void as_many_are_always_in_the_air(void **state)
{
    struct parameters parameters = parameters_of(50, 300, 0);
    struct simulation *simulation = simulate(&parameters);
    (void)state;

    assert_int_equal(simulation->targets_a_scan, 50);
    assert_int_equal(simulation->num_truth, 300 * 50);
    for (size_t scan = 0; scan < 300; scan++) {
        const struct truth_point *truth = truth_of_scan(simulation, scan);
        for (size_t i = 0; i < 50; i++) {
            assert_true(fabs(truth[i].t_s - 10.0 * (double)scan) < 1e-9);
            assert_true(i == 0 || truth[i].target_id > truth[i - 1].target_id);
            assert_in_range(truth[i].target_id, 0, simulation->num_targets - 1);
        }
    }
    simulation_free(simulation);
}

static void flights_last_forty_scans_and_come_and_go_all_the_time(void **state)
{
    struct parameters parameters = parameters_of(400, 400, 0);
    struct simulation *simulation = simulate(&parameters);
    struct life *lives = lives_of(simulation);
    size_t whole = 0, early = 0, late = 0;
    (void)state;

    for (size_t id = 0; id < simulation->num_targets; id++) {
        size_t scans = lives[id].last - lives[id].first + 1;
        assert_true(lives[id].last > 0);
        if (lives[id].first > 1 && lives[id].last < 400) {
            assert_true(scans >= 40);
            whole++;
        }
        early += lives[id].first > 1 && lives[id].first <= 201;
        late += lives[id].first > 201;
        for (size_t scan = lives[id].first; scan <= lives[id].last; scan++) {
            assert_non_null(find(simulation, scan - 1, (int)id));
        }
    }
    print_message("%zu whole lives; %zu and %zu begin in the halves\n", whole, early, late);
    assert_true(whole > 400);
    /* renewals of 400 flights, each some 75 scans long: as many in both halves */
    assert_true(fabs((double)early - (double)late) < 4.0 * sqrt((double)(early + late)));
    free(lives);
    simulation_free(simulation);
}

static double turn_of(const struct truth_point *from, const struct truth_point *to)
{
    return remainder(atan2(to->vy_mps, to->vx_mps) - atan2(from->vy_mps, from->vx_mps), 2.0 * PI);
}

/* Shares of the steps from scan to scan. */
struct tally {
    double steps, turning, slow, changing;
};

static void check_step(const struct truth_point *from, const struct truth_point *to,
                       struct tally *tally)
{
    double speed_mps = hypot(to->vx_mps, to->vy_mps);
    double change_mps = fabs(speed_mps - hypot(from->vx_mps, from->vy_mps));
    double turned_rad = fabs(turn_of(from, to));
    double way_m = hypot(to->x_m - from->x_m, to->y_m - from->y_m);
    double mean_mps = 0.5 * (speed_mps + hypot(from->vx_mps, from->vy_mps));

    assert_true(speed_mps >= 80.0 - 1e-6 && speed_mps <= 260.0 + 1e-6);
    assert_true(turned_rad <= 10.0 * 3.0 * DEG_RAD + 1e-9);
    assert_true(turned_rad * speed_mps <= 10.0 * 8.0 + 12.0); /* a speed change besides */
    assert_true(change_mps <= 12.0 + 1e-6);
    /* a way is no longer than its speed allows, and an arc of 30 degrees 1.2 % shorter */
    assert_true(way_m <= 10.0 * (mean_mps + 6.0) && way_m >= 0.985 * 10.0 * (mean_mps - 6.0));
    tally->steps += 1.0;
    tally->turning += turned_rad > 1e-6;
    tally->slow += speed_mps < 150.0;
    tally->changing += change_mps > 1e-6;
}

static void flights_keep_to_their_speeds_and_turn_rates(void **state)
{
    struct parameters parameters = parameters_of(200, 200, 0);
    struct simulation *simulation = simulate(&parameters);
    struct tally tally = {0};
    (void)state;

    for (size_t i = 0; i < simulation->num_truth; i++) {
        const struct truth_point *from = &simulation->truth[i];
        size_t scan = i / simulation->targets_a_scan;
        const struct truth_point *to =
            scan + 1 < 200 ? find(simulation, scan + 1, from->target_id) : NULL;
        assert_true(fabs(from->x_m) <= HALF_M && fabs(from->y_m) <= HALF_M);
        if (to != NULL) {
            check_step(from, to, &tally);
        }
    }
    print_message("turning %.3f, slow %.3f, changing speed %.3f\n", tally.turning / tally.steps,
                  tally.slow / tally.steps, tally.changing / tally.steps);
    assert_true(tally.turning > 0.1 * tally.steps && tally.turning < 0.4 * tally.steps);
    assert_true(tally.slow > 0.1 * tally.steps && tally.slow < 0.6 * tally.steps);
    assert_true(tally.changing > 0.1 * tally.steps && tally.changing < 0.7 * tally.steps);
    simulation_free(simulation);
}

static bool is_near_border(const struct truth_point *at)
{
    return fmax(fabs(at->x_m), fabs(at->y_m)) > HALF_M - 2600.0; /* a scan's way */
}

static void flights_come_over_the_border_and_from_the_ground(void **state)
{
    struct parameters parameters = parameters_of(400, 200, 0);
    struct simulation *simulation = simulate(&parameters);
    struct life *lives = lives_of(simulation);
    double begun = 0.0, entered = 0.0, slow = 0.0, ended = 0.0, left = 0.0, landed = 0.0;
    (void)state;

    for (size_t id = 0; id < simulation->num_targets; id++) {
        const struct truth_point *first = find(simulation, lives[id].first - 1, (int)id);
        const struct truth_point *last = find(simulation, lives[id].last - 1, (int)id);
        if (lives[id].first > 1) {
            begun += 1.0;
            entered += is_near_border(first);
            slow += hypot(first->vx_mps, first->vy_mps) < 80.0 + 12.0;
        }
        if (lives[id].last < 200) {
            ended += 1.0;
            left += is_near_border(last);
            landed += hypot(last->vx_mps, last->vy_mps) < 80.0 + 12.0;
        }
    }
    print_message("begun %.0f: border %.0f, ground %.0f; ended %.0f: border %.0f, ground %.0f\n",
                  begun, entered, slow, ended, left, landed);
    assert_true(entered > 0.2 * begun && slow > 0.2 * begun && entered + slow >= begun - 1.0);
    assert_true(left > 0.2 * ended && landed > 0.2 * ended && left + landed >= ended - 1.0);
    free(lives);
    simulation_free(simulation);
}

/* Pairs that are within 1 km at some scan. */
static size_t count_meetings(double crossing_share)
{
    struct parameters parameters = parameters_of(50, 360, 0);
    struct simulation *simulation;
    size_t count = 0;

    parameters_suggest(&parameters, PARAMETER_CROSSING_SHARE, crossing_share);
    simulation = simulate(&parameters);
    for (size_t scan = 0; scan < simulation->num_scans; scan++) {
        const struct truth_point *truth = truth_of_scan(simulation, scan);
        for (size_t i = 0; i < 50; i++) {
            for (size_t j = 0; j < i; j++) {
                count += hypot(truth[i].x_m - truth[j].x_m, truth[i].y_m - truth[j].y_m) < 1000.0;
            }
        }
    }
    simulation_free(simulation);
    return count;
}

static void a_share_of_flights_meets_another(void **state)
{
    size_t some = count_meetings(0.5), none = count_meetings(0.0);
    (void)state;

    print_message("%zu scans of pairs within 1 km, %zu where nobody is sent to meet\n", some, none);
    assert_true(some >= 40 && none <= some / 3);
}

/* ---- formation -------------------------------------------------------------------------------- */

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
        double spacing_m = 300.0 + off_scans * 10.0 * 2.0 * 250.0 * sin(5.0 * DEG_RAD);
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

/* ---- seeds ------------------------------------------------------------------------------------ */

static void assert_same_bytes(const struct simulation *one, const struct simulation *other)
{
    assert_int_equal(one->num_truth, other->num_truth);
    assert_memory_equal(one->truth, other->truth, one->num_truth * sizeof *one->truth);
    for (size_t scan = 0; scan < one->num_scans; scan++) {
        assert_int_equal(one->scans[scan].num_plots, other->scans[scan].num_plots);
        assert_memory_equal(one->scans[scan].plots, other->scans[scan].plots,
                            one->scans[scan].num_plots * sizeof *one->scans[scan].plots);
    }
}

static void a_seed_gives_the_same_bytes_again(void **state)
{
    struct parameters parameters = parameters_of(50, 60, 100);
    struct simulation *one, *again, *other_seed, *other_run;
    (void)state;

    parameters_suggest(&parameters, PARAMETER_FADES_PER_HOUR, 4);
    parameters_suggest(&parameters, PARAMETER_SPOTS, 3);
    parameters_suggest(&parameters, PARAMETER_SPOT_CLUTTER, 10);
    parameters_suggest(&parameters, PARAMETER_PERSISTENT_SOURCES, 10);
    parameters_suggest(&parameters, PARAMETER_MERGE_M, 1000);
    one = simulate(&parameters);
    again = simulate(&parameters);
    other_seed = scenario_simulate("air-traffic", &parameters, SEED + 1, 0);
    other_run = scenario_simulate("air-traffic", &parameters, SEED, 1);
    assert_same_bytes(one, again);
    assert_true(fabs(one->truth[0].x_m - other_seed->truth[0].x_m) > 1.0);
    assert_true(fabs(one->truth[0].x_m - other_run->truth[0].x_m) > 1.0);
    simulation_free(one);
    simulation_free(again);
    simulation_free(other_seed);
    simulation_free(other_run);
}

/* So that experiments compare levels of clutter on the same targets. */
static void clutter_leaves_the_targets_plots_as_they_are(void **state)
{
    struct parameters few = parameters_of(50, 30, 10), many = parameters_of(50, 30, 500);
    struct simulation *one = simulate(&few), *other = simulate(&many);
    (void)state;

    for (size_t i = 0; i < one->num_truth; i++) {
        size_t scan = i / 50;
        int id = one->truth[i].target_id;
        const struct simulated_plot *first = find_plot(&one->scans[scan], id);
        const struct simulated_plot *second = find_plot(&other->scans[scan], id);
        assert_true((first == NULL) == (second == NULL));
        if (first != NULL) {
            assert_memory_equal(first, second, sizeof *first);
        }
    }
    simulation_free(one);
    simulation_free(other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_many_are_always_in_the_air),
        cmocka_unit_test(flights_last_forty_scans_and_come_and_go_all_the_time),
        cmocka_unit_test(flights_keep_to_their_speeds_and_turn_rates),
        cmocka_unit_test(flights_come_over_the_border_and_from_the_ground),
        cmocka_unit_test(a_share_of_flights_meets_another),
        cmocka_unit_test(a_formation_meets_flies_side_by_side_and_parts),
        cmocka_unit_test(a_seed_gives_the_same_bytes_again),
        cmocka_unit_test(clutter_leaves_the_targets_plots_as_they_are),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
