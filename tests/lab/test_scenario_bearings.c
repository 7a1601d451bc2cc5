/* SPDX-License-Identifier: MIT */
/*
 * The experiments' simulated passive sensors: do bearings have the distribution that was asked for?
 * Seeds are fixed; bounds are four standard deviations of a sample's mean or variance.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "scenario_plots.h"

#define SEED 4711
#define PI 3.141592653589793

/* ---- samples --------------------------------------------------------------------------------- */

struct sample {
    double count, sum, squares;
};

static void add_value(struct sample *sample, double value)
{
    sample->count += 1.0;
    sample->sum += value;
    sample->squares += value * value;
}

static double mean_of(const struct sample *sample)
{
    return sample->sum / sample->count;
}

static double variance_of(const struct sample *sample)
{
    double mean = mean_of(sample);

    return sample->squares / sample->count - mean * mean;
}

static void assert_within(const char *what, double value, double expected, double most)
{
    print_message("%s: %.5f, expected %.5f +- %.5f\n", what, value, expected, most);
    assert_true(fabs(value - expected) <= most);
}

/*
 * Uniform in lo .. hi: checks its mean and its variance, whose relative deviation is 2 / sqrt(5 n).
 */
static void assert_mean_and_variance_uniform(const char *what, const struct sample *sample,
                                             double lo, double hi)
{
    double variance = (hi - lo) * (hi - lo) / 12.0;

    assert_true(sample->count >= 1000.0);
    assert_within(what, mean_of(sample), (lo + hi) / 2.0, 4.0 * sqrt(variance / sample->count));
    assert_within(what, variance_of(sample), variance,
                  4.0 * variance * 2.0 / sqrt(5.0 * sample->count));
}

/* ---- simulations ----------------------------------------------------------------------------- */

static struct parameters passive_parameters(double pd)
{
    struct parameters parameters;

    parameters_set_defaults(&parameters);
    suggest_passive_parameters(&parameters);
    parameters_suggest(&parameters, PARAMETER_TRUE_PD, pd);
    return parameters;
}

static struct simulation *simulate(size_t num_sensors, size_t num_targets, double false_mean,
                                   const struct parameters *parameters, uint64_t run)
{
    const struct scenario_bearings of = {
        .num_sensors = num_sensors, .num_targets = num_targets, .false_mean = false_mean};

    return simulate_passive(&of, parameters, SEED, run);
}

/* A thousand targets over the default of 8 scans. */
static struct simulation *simulate_thousand_targets(double pd, double false_mean)
{
    struct parameters parameters = passive_parameters(pd);

    return simulate(2, 1000, false_mean, &parameters, 0);
}

static const struct truth_point *truth_of(const struct simulation *simulation, size_t scan,
                                          int target_id)
{
    return &simulation->truth[scan * simulation->num_targets + (size_t)target_id];
}

static double true_bearing(const struct simulation *simulation, const struct simulated_look *look,
                           size_t scan, int target_id)
{
    const struct truth_point *truth = truth_of(simulation, scan, target_id);

    return atan2(truth->y_m - simulation->passive.sensors[look->sensor].y_m,
                 truth->x_m - simulation->passive.sensors[look->sensor].x_m);
}

/* ---- numbers and places in a simulation ------------------------------------------------------ */

static void check_numbers_and_places(size_t num_sensors, size_t num_targets)
{
    static const double places_m[][2] = {{0, -10000}, {0, 10000}, {10000, 0}, {-10000, 0}};
    struct parameters parameters = passive_parameters(1.0);
    struct simulation *simulation = simulate(num_sensors, num_targets, 0.0, &parameters, 0);

    assert_true(simulation->passive.is_used && !simulation->radar.is_used);
    assert_int_equal(simulation->num_scans, 8);
    assert_int_equal(simulation->num_targets, num_targets);
    assert_int_equal(simulation->passive.num_sensors, num_sensors);
    assert_int_equal(simulation->num_looks, 8 * num_sensors);
    assert_true(fabs(simulation->passive.sigma_rad - 0.1 * PI / 180.0) < 1e-12);
    for (size_t i = 0; i < simulation->num_looks; i++) {
        assert_int_equal(simulation->looks[i].sensor, i % num_sensors);
        assert_true(fabs(simulation->looks[i].t_s - 10.0 * (double)(i / num_sensors)) < 1e-9);
    }
    for (size_t i = 0; i < num_sensors; i++) {
        assert_true(fabs(simulation->passive.sensors[i].x_m - places_m[i][0]) < 1e-9);
        assert_true(fabs(simulation->passive.sensors[i].y_m - places_m[i][1]) < 1e-9);
    }
    for (size_t i = 0; i < simulation->num_scans; i++) {
        assert_int_equal(simulation->scans[i].num_plots, 0);
    }
    simulation_free(simulation);
}

static void sensors_targets_and_scans_are_as_many_as_asked_for(void **state)
{
    (void)state;
    check_numbers_and_places(2, 2);
    check_numbers_and_places(3, 2);
    check_numbers_and_places(4, 4);
}

/* ---- targets --------------------------------------------------------------------------------- */

static void targets_come_towards_the_origin_from_the_east(void **state)
{
    struct simulation *simulation = simulate_thousand_targets(1.0, 0.0);
    struct sample headings_rad = {0}, speeds_mps = {0};
    (void)state;

    for (int i = 0; i < 1000; i++) {
        const struct truth_point *start = truth_of(simulation, 0, i);
        const struct truth_point *last = truth_of(simulation, 7, i);
        double off_rad = remainder(
            atan2(start->vy_mps, start->vx_mps) - atan2(-start->y_m, -start->x_m), 2.0 * PI);

        assert_true(start->x_m >= 20000.0 && start->x_m <= 75000.0);
        assert_true(fabs(start->y_m) <= 50000.0);
        assert_true(hypot(start->x_m, start->y_m) <= 78000.0);
        assert_true(last->x_m >= 2000.0);
        assert_true(fabs(last->x_m - start->x_m - 70.0 * start->vx_mps) < 1e-6);
        assert_true(fabs(last->y_m - start->y_m - 70.0 * start->vy_mps) < 1e-6);
        assert_true(fabs(off_rad) <= PI / 4.0 + 1e-9);
        /* targets far from the sensors are never redrawn, so their places are uniform */
        if (start->x_m > 27000.0) {
            add_value(&headings_rad, off_rad);
            add_value(&speeds_mps, hypot(start->vx_mps, start->vy_mps));
        }
    }
    assert_true(headings_rad.count >= 500.0);
    assert_within("heading", mean_of(&headings_rad), 0.0,
                  4.0 * PI / 4.0 / sqrt(3.0 * headings_rad.count));
    assert_within("its variance", variance_of(&headings_rad), PI * PI / 48.0,
                  4.0 * PI * PI / 48.0 * 2.0 / sqrt(5.0 * headings_rad.count));
    assert_within("speed", mean_of(&speeds_mps), 250.0, 4.0 * 100.0 / sqrt(3.0 * speeds_mps.count));
    simulation_free(simulation);
}

/* ---- bearings -------------------------------------------------------------------------------- */

static void check_bearing_noise(double sigma_rad)
{
    struct parameters parameters = passive_parameters(1.0);
    struct sample errors = {0};
    struct simulation *simulation;

    parameters_suggest(&parameters, PARAMETER_SIGMA_RAD, sigma_rad);
    simulation = simulate(3, 500, 0.0, &parameters, 0);
    for (size_t i = 0; i < simulation->num_looks; i++) {
        const struct simulated_look *look = &simulation->looks[i];

        assert_int_equal(look->num_bearings, 500);
        for (size_t j = 0; j < look->num_bearings; j++) {
            const struct simulated_bearing *bearing = &look->bearings[j];
            double truth_rad = true_bearing(simulation, look, i / 3, bearing->target_id);

            assert_true(fabs(bearing->bearing_rad) <= PI);
            add_value(&errors, remainder(bearing->bearing_rad - truth_rad, 2.0 * PI) / sigma_rad);
        }
    }
    assert_int_equal((int)errors.count, 12000);
    assert_within("error, sigmas", mean_of(&errors), 0.0, 4.0 / sqrt(errors.count));
    assert_within("its variance", variance_of(&errors), 1.0, 4.0 * sqrt(2.0 / errors.count));
    simulation_free(simulation);
}

static void bearing_errors_have_the_configured_sigma(void **state)
{
    (void)state;
    check_bearing_noise(0.1 * PI / 180.0);
    check_bearing_noise(0.01);
}

static void targets_are_detected_with_probability_true_pd(void **state)
{
    struct simulation *simulation = simulate_thousand_targets(0.9, 1.0);
    double seen = 0.0, n = (double)simulation->num_looks * 1000.0;
    (void)state;

    for (size_t i = 0; i < simulation->num_looks; i++) {
        unsigned char times[1000] = {0};

        for (size_t j = 0; j < simulation->looks[i].num_bearings; j++) {
            int target_id = simulation->looks[i].bearings[j].target_id;

            assert_in_range(target_id + 1, 0, 1000);
            if (target_id >= 0) {
                assert_false(times[target_id]++);
                seen += 1.0;
            }
        }
    }
    assert_within("detection rate", seen / n, 0.9, 4.0 * sqrt(0.9 * 0.1 / n));
    simulation_free(simulation);
}

static void false_bearings_are_poisson_and_uniform_ahead(void **state)
{
    struct parameters parameters = passive_parameters(0.9);
    struct sample counts = {0}, bearings_rad = {0};
    struct simulation *simulation;
    (void)state;

    parameters_suggest(&parameters, PARAMETER_NUM_SCANS, 3000);
    simulation = simulate(2, 0, 1.0, &parameters, 0);
    for (size_t i = 0; i < simulation->num_looks; i++) {
        add_value(&counts, (double)simulation->looks[i].num_bearings);
        for (size_t j = 0; j < simulation->looks[i].num_bearings; j++) {
            double bearing_rad = simulation->looks[i].bearings[j].bearing_rad;

            assert_int_equal(simulation->looks[i].bearings[j].target_id, -1);
            assert_true(fabs(bearing_rad) <= PI / 2.0);
            add_value(&bearings_rad, bearing_rad);
        }
    }
    assert_within("false bearings a look", mean_of(&counts), 1.0, 4.0 / sqrt(counts.count));
    /* the variance of a Poisson sample deviates by sqrt((m + 2 m^2) / n) */
    assert_within("their variance", variance_of(&counts), 1.0, 4.0 * sqrt(3.0 / counts.count));
    assert_mean_and_variance_uniform("false bearings", &bearings_rad, -PI / 2.0, PI / 2.0);
    simulation_free(simulation);
}

/* Target 0 is equally often at each of the ten positions of a look. */
static void bearings_of_a_look_come_in_random_order(void **state)
{
    struct parameters parameters = passive_parameters(1.0);
    struct sample places = {0};
    struct simulation *simulation;
    (void)state;

    for (uint64_t run = 0; run < 200; run++) {
        simulation = simulate(2, 10, 0.0, &parameters, run);
        for (size_t i = 0; i < simulation->num_looks; i++) {
            size_t j = 0;
            while (simulation->looks[i].bearings[j].target_id != 0) {
                j++;
            }
            add_value(&places, (double)j);
        }
        simulation_free(simulation);
    }
    assert_within("place", mean_of(&places), 4.5, 4.0 * sqrt(8.25 / places.count));
    assert_within("its variance", variance_of(&places), 8.25, 4.0 * 8.25 / sqrt(places.count));
}

static void the_same_seed_gives_the_same_bearings(void **state)
{
    struct parameters parameters = passive_parameters(0.9);
    struct simulation *one = simulate(2, 4, 1.0, &parameters, 0);
    struct simulation *again = simulate(2, 4, 1.0, &parameters, 0);
    struct simulation *other = simulate(2, 4, 1.0, &parameters, 1);
    (void)state;

    for (size_t i = 0; i < one->num_looks; i++) {
        assert_int_equal(one->looks[i].num_bearings, again->looks[i].num_bearings);
        for (size_t j = 0; j < one->looks[i].num_bearings; j++) {
            const struct simulated_bearing *first = &one->looks[i].bearings[j];
            const struct simulated_bearing *second = &again->looks[i].bearings[j];

            assert_int_equal(first->target_id, second->target_id);
            assert_memory_equal(&first->bearing_rad, &second->bearing_rad, sizeof(double));
        }
    }
    assert_true(fabs(one->truth[0].x_m - other->truth[0].x_m) > 1.0);
    simulation_free(one);
    simulation_free(again);
    simulation_free(other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sensors_targets_and_scans_are_as_many_as_asked_for),
        cmocka_unit_test(targets_come_towards_the_origin_from_the_east),
        cmocka_unit_test(bearing_errors_have_the_configured_sigma),
        cmocka_unit_test(targets_are_detected_with_probability_true_pd),
        cmocka_unit_test(false_bearings_are_poisson_and_uniform_ahead),
        cmocka_unit_test(bearings_of_a_look_come_in_random_order),
        cmocka_unit_test(the_same_seed_gives_the_same_bearings),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
