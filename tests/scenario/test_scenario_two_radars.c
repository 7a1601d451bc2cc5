/* SPDX-License-Identifier: MIT */
/*
 * Scenario two-radars: biases and noise, detections, the common targets, late arrivals, truth. Seeds are fixed; bounds are
 * four standard deviations.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "scenario_record.h"

#define SEED 4711
#define TURN_RAD 6.283185307179586
#define SECOND_TIME_BIAS_S 0.5

static struct parameters parameters_of_scenario(void)
{
    struct parameters parameters;

    parameters_default(&parameters);
    scenario_suggest("two-radars", &parameters);
    return parameters;
}

static void set(struct parameters *parameters, enum parameter_id id, double value)
{
    parameters_suggest(parameters, id, value);
}

static void assert_mean(const char *what, double sum, double count, double sigma, double expected)
{
    print_message("%s: %.6g, expected %.6g\n", what, sum / count, expected);
    assert_true(count > 1000.0);
    assert_true(fabs(sum / count - expected) < 4.0 * sigma / sqrt(count));
}

/* What the plots of a radar's targets are off on the average is its bias, with the noise that it should have. */
static void check_radar(const struct scenario_record *record, size_t number, double sign)
{
    const struct scenario_antenna *radar = &record->antennas[number];
    const struct antenna_view *view = &record->views[number];
    double count = 0, range_m = 0, range_m2 = 0, azimuth_rad = 0, azimuth_rad2 = 0;

    for (size_t i = 0; i < view->num_sectors; i++) {
        for (size_t j = 0; j < view->sectors[i].num_plots; j++) {
            const struct antenna_plot *plot = &view->sectors[i].plots[j];

            if (plot->target_id >= 0) {
                double x_m = plot->truth.x_m - radar->x_m, y_m = plot->truth.y_m - radar->y_m;
                double off_m = plot->range_m - hypot(x_m, y_m);
                double off_rad = remainder(plot->azimuth_rad - atan2(y_m, x_m), TURN_RAD);

                assert_true(fabs(plot->truth.t_s - plot->t_s + radar->time_bias_s) < 1e-9);
                range_m += off_m;
                range_m2 += pow(off_m - sign * 50.0, 2.0);
                azimuth_rad += off_rad;
                azimuth_rad2 += pow(off_rad - sign * TURN_RAD / 3600.0, 2.0);
                count++;
            }
        }
    }
    assert_mean("range bias", range_m, count, radar->sigma_range_m, sign * 50.0);
    assert_mean("azimuth bias", azimuth_rad, count, radar->sigma_azimuth_rad,
                sign * TURN_RAD / 3600.0);
    assert_mean("range noise", range_m2 / pow(radar->sigma_range_m, 2.0), count, sqrt(2.0), 1.0);
    assert_mean("azimuth noise", azimuth_rad2 / pow(radar->sigma_azimuth_rad, 2.0), count,
                sqrt(2.0), 1.0);
}

static void test_radars_are_off_by_their_biases(void **state)
{
    struct parameters parameters = parameters_of_scenario();

    (void)state;
    set(&parameters, PARAMETER_TRUE_TIME_BIAS_S, SECOND_TIME_BIAS_S);
    struct simulation *simulation = scenario_simulate("two-radars", &parameters, SEED, 0);
    assert_int_equal(simulation->record->num_antennas, 2);
    assert_true(simulation->record->antennas[0].time_bias_s == 0.0);
    assert_true(simulation->record->antennas[1].time_bias_s == SECOND_TIME_BIAS_S);
    check_radar(simulation->record, 0, 1.0);
    check_radar(simulation->record, 1, -1.0);
    simulation_free(simulation);
}

/* Aircraft keep 5 nautical miles apart. Each is always in one radar's reach, and in both for most of its time; detections are the radars' P_D. */
static void test_aircraft_are_common(void **state)
{
    struct parameters parameters = parameters_of_scenario();
    struct simulation *simulation = scenario_simulate("two-radars", &parameters, SEED, 1);
    const struct scenario_record *record = simulation->record;
    double common = 0, reach[2] = {0}, seen[2] = {0};

    (void)state;
    assert_int_equal(simulation->num_truth, simulation->num_times * 20);
    for (size_t i = 0; i < simulation->num_truth; i++) {
        const struct truth_point *at = &simulation->truth[i];
        double first_m = hypot(at->x_m, at->y_m), second_m = hypot(at->x_m - 80000.0, at->y_m);
        bool first = first_m<150000.0, second = second_m> 1000.0 && second_m < 100000.0;

        assert_true(first || second);
        assert_int_equal(at->target_id, (int)(i % 20));
        assert_true(i < 20 || at->t_s > simulation->truth[i - 20].t_s);
        for (size_t j = i - i % 20; j < i; j++) { /* looked at each 5 s, at 500 m/s at most */
            assert_true(hypot(at->x_m - simulation->truth[j].x_m,
                              at->y_m - simulation->truth[j].y_m) > 9260.0 - 1250.0);
        }
        common += first && second;
        reach[0] += first_m > 2000.0 && first;
        reach[1] += second;
    }
    assert_true(common / (double)simulation->num_truth > 0.78);
    for (size_t a = 0; a < 2; a++) {
        const struct antenna_view *view = &record->views[a];
        double turns = (double)view->num_sectors / 32.0;
        double looks = reach[a] / (double)simulation->num_times * turns;

        for (size_t i = 0; i < view->num_sectors; i++) {
            for (size_t j = 0; j < view->sectors[i].num_plots; j++) {
                seen[a] += view->sectors[i].plots[j].target_id >= 0;
            }
        }
        print_message("radar %zu: %g plots of %.0f looks\n", a + 1, seen[a], looks);
        assert_true(fabs(seen[a] / looks - record->antennas[a].pd) < 4.0 * 0.4 / sqrt(looks));
    }
    simulation_free(simulation);
}

/* Scans come in the order of arrival, each once, a fifth of them 300 ms after their end. */
static void test_a_share_arrives_late(void **state)
{
    struct parameters parameters = parameters_of_scenario();
    struct simulation *simulation = scenario_simulate("two-radars", &parameters, SEED, 2);
    const struct scenario_record *record = simulation->record;
    double late = 0, count = (double)record->num_arrivals;

    (void)state;
    assert_true(record->has_received);
    assert_int_equal(record->num_arrivals,
                     record->views[0].num_sectors + record->views[1].num_sectors);
    for (size_t i = 0; i < record->num_arrivals; i++) {
        const struct record_arrival *arrival = &record->arrivals[i];
        double after_s = arrival->received_s - (double)record_scan_us(record, arrival) * 1e-6;

        assert_true(i == 0 || arrival->received_s >= record->arrivals[i - 1].received_s);
        assert_true(fabs(after_s) < 2e-6 || fabs(after_s - 0.3) < 2e-6);
        late += after_s > 0.1;
    }
    assert_true(fabs(late / count - 0.2) < 4.0 * 0.4 / sqrt(count));
    simulation_free(simulation);

    set(&parameters, PARAMETER_LATE_SHARE, 0.0);
    set(&parameters, PARAMETER_SECTORS_PER_TURN, 1.0);
    simulation = scenario_simulate("two-radars", &parameters, SEED, 2);
    assert_false(simulation->record->has_received);
    assert_int_equal(simulation->record->views[0].num_sectors, 60);
    assert_true(simulation->record->views[0].sectors[3].from_rad ==
                simulation->record->views[0].sectors[3].to_rad);
    simulation_free(simulation);
}

/* A clock that is off: the file says when scans arrived, by the true time; the truth has the scans' true ends. */
static void test_a_clock_that_is_off(void **state)
{
    struct parameters parameters = parameters_of_scenario();

    (void)state;
    set(&parameters, PARAMETER_LATE_SHARE, 0.0);
    set(&parameters, PARAMETER_SECTORS_PER_TURN, 1.0);
    set(&parameters, PARAMETER_TRUE_TIME_BIAS_S, -SECOND_TIME_BIAS_S);
    struct simulation *simulation = scenario_simulate("two-radars", &parameters, SEED, 2);
    const struct scenario_record *record = simulation->record;

    assert_true(record->has_received);
    for (size_t i = 0; i < record->num_arrivals; i++) {
        const struct record_arrival *arrival = &record->arrivals[i];
        double bias_s = arrival->antenna == 1 ? -SECOND_TIME_BIAS_S : 0.0;
        double said_s = (double)record_scan_us(record, arrival) * 1e-6;

        assert_true(fabs(arrival->received_s - (said_s - bias_s)) < 2e-6);
        assert_true(fabs(simulation->truth[i * simulation->num_targets].t_s - arrival->received_s) <
                    2e-6);
    }
    simulation_free(simulation);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_radars_are_off_by_their_biases),
        cmocka_unit_test(test_aircraft_are_common),
        cmocka_unit_test(test_a_share_arrives_late),
        cmocka_unit_test(test_a_clock_that_is_off),
    };

    return cmocka_run_group_tests_name("scenario_two_radars", tests, NULL, NULL);
}
