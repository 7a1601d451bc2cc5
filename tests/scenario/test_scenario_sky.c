/* SPDX-License-Identifier: MIT */
/*
 * Plots of scenario air-traffic: are noise, misses, fades, merged plots and clutter what the parameters say? Seeds are
 * fixed; bounds are four standard deviations of a sample's mean or variance.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "traffic_scene.h"

/* ---- targets' plots --------------------------------------------------------------------------- */

static void check_noise(const struct parameters *parameters, double sigma_m, double pd)
{
    struct simulation *simulation = simulate(parameters);
    double n = (double)simulation->num_truth, seen = 0.0, sum = 0.0, squares = 0.0, product = 0.0;

    for (size_t i = 0; i < simulation->num_truth; i++) {
        const struct truth_point *truth = &simulation->truth[i];
        const struct simulated_plot *plot =
            find_plot(&simulation->scans[i / simulation->targets_a_scan], truth->target_id);
        if (plot != NULL) {
            double dx = (plot->x_m - truth->x_m) / sigma_m, dy = (plot->y_m - truth->y_m) / sigma_m;
            seen += 1.0;
            sum += dx + dy;
            squares += dx * dx + dy * dy;
            product += dx * dy;
        }
    }
    assert_within("seen", seen / n, pd, 4.0 * sqrt(pd * (1.0 - pd) / n));
    assert_within("mean error", sum / (2.0 * seen), 0.0, 4.0 / sqrt(2.0 * seen));
    assert_within("variance", squares / (2.0 * seen), 1.0, 4.0 * sqrt(1.0 / seen));
    assert_within("x and y", product / seen, 0.0, 4.0 / sqrt(seen));
    simulation_free(simulation);
}

static void plots_have_the_noise_and_rate_that_are_assumed(void **state)
{
    struct parameters parameters = parameters_of(100, 200, 0);
    (void)state;

    check_noise(&parameters, 50.0, 0.95);
    parameters_suggest(&parameters, PARAMETER_SIGMA_M, 80.0);
    parameters_suggest(&parameters, PARAMETER_PD, 0.8);
    check_noise(&parameters, 80.0, 0.8);
}

static void what_happens_can_differ_from_what_is_assumed(void **state)
{
    struct parameters parameters = parameters_of(100, 200, 0);
    struct simulation *simulation;
    (void)state;

    parameters_suggest(&parameters, PARAMETER_TRUE_SIGMA_M, 70.0);
    parameters_suggest(&parameters, PARAMETER_TRUE_PD, 0.7);
    check_noise(&parameters, 70.0, 0.7);
    simulation = simulate(&parameters);
    assert_true(fabs(simulation->sigma_m - 50.0) < 1e-9 && fabs(simulation->pd - 0.95) < 1e-9);
    simulation_free(simulation);
}

/* Runs of misses where a target is always seen but for fades. */
struct misses {
    double fades, scans, chances;
};

static struct misses count_misses(const struct simulation *simulation)
{
    struct life *lives = lives_of(simulation);
    struct misses misses = {0};

    for (size_t id = 0; id < simulation->num_targets; id++) {
        bool was_seen = true;
        for (size_t scan = lives[id].first - 1; scan < lives[id].last; scan++) {
            bool is_seen = find_plot(&simulation->scans[scan], (int)id) != NULL;
            misses.fades += was_seen && !is_seen;
            misses.scans += !is_seen;
            misses.chances += is_seen;
            was_seen = is_seen;
        }
    }
    free(lives);
    return misses;
}

static void fades_come_as_often_and_last_as_long_as_wanted(void **state)
{
    struct parameters parameters = parameters_of(200, 200, 0);
    struct simulation *simulation;
    struct misses misses;
    double rate = 1.0 - exp(-6.0 * 10.0 / 3600.0);
    (void)state;

    parameters_suggest(&parameters, PARAMETER_TRUE_PD, 1.0);
    parameters_suggest(&parameters, PARAMETER_FADES_PER_HOUR, 6.0);
    parameters_suggest(&parameters, PARAMETER_FADE_SCANS, 4.0);
    simulation = simulate(&parameters);
    misses = count_misses(simulation);
    /* fades that follow at once count as one; those cut by a life's end are shorter: 2 % each */
    assert_within("fades a scan", misses.fades / misses.chances, rate,
                  0.02 * rate + 4.0 * rate / sqrt(misses.fades));
    assert_within("scans a fade", misses.scans / misses.fades, 4.0,
                  0.16 + 4.0 * sqrt(12.0 / misses.fades));
    simulation_free(simulation);
}

/* Two side by side, always or sometimes seen. */
static struct simulation *simulate_pair(double spacing_m, double merge_m, double true_pd)
{
    struct parameters parameters;

    parameters_default(&parameters);
    scenario_suggest("parallel", &parameters);
    parameters_suggest(&parameters, PARAMETER_NUM_SCANS, 4000);
    parameters_suggest(&parameters, PARAMETER_SPACING_M, spacing_m);
    parameters_suggest(&parameters, PARAMETER_TRUE_PD, true_pd);
    parameters_suggest(&parameters, PARAMETER_CLUTTER_PER_KM2, 0);
    parameters_suggest(&parameters, PARAMETER_MERGE_M, merge_m);
    return scenario_simulate("parallel", &parameters, SEED, 0);
}

static void close_targets_give_one_plot_between_them(void **state)
{
    struct simulation *simulation = simulate_pair(80.0, 100.0, 1.0);
    double sum = 0.0, squares = 0.0;
    (void)state;

    for (size_t scan = 0; scan < 4000; scan++) {
        double dy;
        assert_int_equal(simulation->scans[scan].num_plots, 1);
        assert_int_equal(simulation->scans[scan].plots[0].target_id, 0);
        dy = (simulation->scans[scan].plots[0].y_m - 40.0) / 10.0;
        sum += dy;
        squares += dy * dy;
    }
    assert_within("place", sum / 4000.0, 0.0, 4.0 / sqrt(4000.0));
    assert_within("variance", squares / 4000.0, 1.0, 4.0 * sqrt(2.0 / 4000.0));
    simulation_free(simulation);
}

static void merged_targets_are_seen_if_either_is(void **state)
{
    struct simulation *simulation = simulate_pair(80.0, 100.0, 0.6);
    double seen = 0.0, first = 0.0;
    (void)state;

    for (size_t scan = 0; scan < 4000; scan++) {
        assert_true(simulation->scans[scan].num_plots <= 1);
        seen += (double)simulation->scans[scan].num_plots;
        first += find_plot(&simulation->scans[scan], 0) != NULL;
    }
    assert_within("seen", seen / 4000.0, 0.84, 4.0 * sqrt(0.84 * 0.16 / 4000.0));
    assert_within("the first's", first / 4000.0, 0.6, 4.0 * sqrt(0.6 * 0.4 / 4000.0));
    simulation_free(simulation);
}

static void targets_apart_give_their_own_plots(void **state)
{
    struct simulation *apart = simulate_pair(120.0, 100.0, 1.0);
    struct simulation *never = simulate_pair(80.0, 0.0, 1.0);
    (void)state;

    for (size_t scan = 0; scan < 4000; scan++) {
        assert_int_equal(apart->scans[scan].num_plots, 2);
        assert_int_equal(never->scans[scan].num_plots, 2);
    }
    simulation_free(apart);
    simulation_free(never);
}

/* Every plot of a busy sky stands for the targets that are linked by less than merge_m, and nobody else. */
static void groups_of_many_targets_give_one_plot_each(void **state)
{
    struct parameters parameters = parameters_of(600, 2, 0);
    struct simulation *simulation;
    size_t alone = 0;
    (void)state;

    parameters_suggest(&parameters, PARAMETER_TRUE_PD, 1.0);
    parameters_suggest(&parameters, PARAMETER_MERGE_M, 5000.0);
    simulation = simulate(&parameters);
    for (size_t i = 0; i < 600; i++) {
        const struct truth_point *one = &simulation->truth[i];
        bool is_alone = true;
        for (size_t j = 0; j < 600; j++) {
            const struct truth_point *other = &simulation->truth[j];
            is_alone &= i == j || hypot(one->x_m - other->x_m, one->y_m - other->y_m) >= 5000.0;
        }
        if (is_alone) {
            const struct simulated_plot *plot = find_plot(&simulation->scans[0], one->target_id);
            assert_non_null(plot);
            assert_true(hypot(plot->x_m - one->x_m, plot->y_m - one->y_m) < 300.0);
            alone++;
        }
    }
    print_message("%zu of 600 alone, %zu plots\n", alone, simulation->scans[0].num_plots);
    assert_true(alone > 300 && alone < 560);
    /* the others are in groups of two or more */
    assert_true(simulation->scans[0].num_plots > alone &&
                simulation->scans[0].num_plots <= alone + (600 - alone) / 2);
    simulation_free(simulation);
}

/* ---- the others' plots ------------------------------------------------------------------------ */

static void clutter_is_poisson_and_uniform(void **state)
{
    struct parameters parameters = parameters_of(10, 1000, 100);
    struct simulation *simulation = simulate(&parameters);
    double sum = 0.0, squares = 0.0, quarters[4] = {0};
    (void)state;

    for (size_t scan = 0; scan < 1000; scan++) {
        double count = (double)count_false(&simulation->scans[scan]);
        sum += count;
        squares += count * count;
        for (size_t i = 0; i < simulation->scans[scan].num_plots; i++) {
            const struct simulated_plot *plot = &simulation->scans[scan].plots[i];
            assert_true(fabs(plot->x_m) <= HALF_M + 500.0 && fabs(plot->y_m) <= HALF_M + 500.0);
            quarters[2 * (plot->x_m > 0.0) + (plot->y_m > 0.0)] += plot->target_id < 0;
        }
    }
    assert_within("clutter a scan", sum / 1000.0, 100.0, 4.0 * sqrt(100.0 / 1000.0));
    assert_within("its variance", squares / 1000.0 - sum * sum / 1e6, 100.0,
                  4.0 * 100.0 * sqrt(2.0 / 1000.0));
    for (int i = 0; i < 4; i++) {
        assert_within("in a quarter", quarters[i], sum / 4.0, 4.0 * sqrt(sum / 4.0));
    }
    simulation_free(simulation);
}

/* The plots nearer to `from` than radius_m. */
static size_t count_near(const struct simulation *simulation, const struct simulated_plot *from,
                         double radius_m)
{
    size_t count = 0;

    for (size_t scan = 0; scan < simulation->num_scans; scan++) {
        for (size_t i = 0; i < simulation->scans[scan].num_plots; i++) {
            const struct simulated_plot *plot = &simulation->scans[scan].plots[i];
            count += hypot(plot->x_m - from->x_m, plot->y_m - from->y_m) < radius_m;
        }
    }
    return count;
}

static void hot_spots_are_discs_of_20_km(void **state)
{
    struct parameters parameters = parameters_of(0, 200, 0);
    struct simulation *simulation;
    double total = 0.0, corner = 0.0;
    (void)state;

    parameters_suggest(&parameters, PARAMETER_SPOTS, 1);
    parameters_suggest(&parameters, PARAMETER_SPOT_CLUTTER, 30);
    simulation = simulate(&parameters);
    double x_m = 0.0, y_m = 0.0, squares = 0.0;
    for (size_t scan = 0; scan < 200; scan++) {
        for (size_t i = 0; i < simulation->scans[scan].num_plots; i++) {
            x_m += simulation->scans[scan].plots[i].x_m;
            y_m += simulation->scans[scan].plots[i].y_m;
            total += 1.0;
        }
    }
    assert_within("plots", total / 200.0, 30.0, 4.0 * sqrt(30.0 / 200.0));
    for (size_t scan = 0; scan < 200; scan++) {
        for (size_t i = 0; i < simulation->scans[scan].num_plots; i++) {
            const struct simulated_plot *plot = &simulation->scans[scan].plots[i];
            double far_m = hypot(plot->x_m - x_m / total, plot->y_m - y_m / total);
            assert_true(far_m < 20000.0 + 1000.0);
            squares += far_m * far_m;
            corner += far_m > 18000.0;
        }
    }
    /* uniform: r^2 is uniform up to R^2 */
    assert_within("r^2", squares / total / 4e8, 0.5, 4.0 * sqrt(1.0 / 12.0 / total) + 0.005);
    assert_within("its rim", corner / total, 0.19, 4.0 * sqrt(0.19 * 0.81 / total) + 0.02);
    simulation_free(simulation);
}

static void more_spots_have_so_many_plots_each(void **state)
{
    struct parameters parameters = parameters_of(0, 200, 0);
    struct simulation *simulation;
    double total = 0.0;
    (void)state;

    parameters_suggest(&parameters, PARAMETER_SPOTS, 7);
    parameters_suggest(&parameters, PARAMETER_SPOT_CLUTTER, 10);
    simulation = simulate(&parameters);
    for (size_t scan = 0; scan < 200; scan++) {
        total += (double)simulation->scans[scan].num_plots;
    }
    assert_within("plots", total / 200.0, 70.0, 4.0 * sqrt(70.0 / 200.0));
    simulation_free(simulation);
}

static void persistent_sources_stand_and_are_seen_nine_times_of_ten(void **state)
{
    struct parameters parameters = parameters_of(0, 400, 0);
    struct simulation *simulation;
    double total = 0.0;
    (void)state;

    parameters_suggest(&parameters, PARAMETER_PERSISTENT_SOURCES, 25);
    simulation = simulate(&parameters);
    for (size_t scan = 0; scan < 400; scan++) {
        assert_true(simulation->scans[scan].num_plots <= 25);
        total += (double)simulation->scans[scan].num_plots;
    }
    assert_within("plots", total / 400.0, 22.5, 4.0 * sqrt(25.0 * 0.09 / 400.0));
    for (size_t i = 0; i < simulation->scans[0].num_plots; i++) {
        /* within seven sigmas of one of its plots: every plot of the source, nobody else's */
        size_t near = count_near(simulation, &simulation->scans[0].plots[i], 7.0 * 50.0);
        assert_in_range(near, 360 - 24, 360 + 24);
    }
    simulation_free(simulation);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plots_have_the_noise_and_rate_that_are_assumed),
        cmocka_unit_test(what_happens_can_differ_from_what_is_assumed),
        cmocka_unit_test(fades_come_as_often_and_last_as_long_as_wanted),
        cmocka_unit_test(close_targets_give_one_plot_between_them),
        cmocka_unit_test(merged_targets_are_seen_if_either_is),
        cmocka_unit_test(targets_apart_give_their_own_plots),
        cmocka_unit_test(groups_of_many_targets_give_one_plot_each),
        cmocka_unit_test(clutter_is_poisson_and_uniform),
        cmocka_unit_test(hot_spots_are_discs_of_20_km),
        cmocka_unit_test(more_spots_have_so_many_plots_each),
        cmocka_unit_test(persistent_sources_stand_and_are_seen_nine_times_of_ten),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
