/* SPDX-License-Identifier: MIT */
/* Scenarios doppler and rotating, and their experiments with few runs and a fixed seed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>

#include "experiment_doppler.h"
#include "experiment_rotating.h"
#include "scenario_record.h"

#define SEED 4711

static struct parameters parameters_of(const char *name)
{
    struct parameters parameters;
    parameters_default(&parameters);
    scenario_suggest(name, &parameters);
    return parameters;
}

static void assert_near(double value, double wanted, double tolerance)
{
    if (!(fabs(value - wanted) <= tolerance)) {
        fail_msg("%g is not within %g of %g", value, tolerance, wanted);
    }
}

/* ---- doppler ---------------------------------------------------------------------------------- */

/* 15 turns of 400: counts within four standard deviations, range rates of what stands have a standard deviation of 1. */
static void clutter_that_stands_is_added(void **state)
{
    (void)state;
    struct parameters parameters = parameters_of("doppler");
    parameters_suggest(&parameters, PARAMETER_TARGETS, 0.0);
    parameters_suggest(&parameters, PARAMETER_CLUTTER_PER_SCAN, 0.0);
    parameters_suggest(&parameters, PARAMETER_STATIC_CLUTTER, 400.0);
    struct simulation *simulation = scenario_simulate("doppler", &parameters, SEED, 0);
    double count = 0.0, squares = 0.0;
    for (size_t scan = 0; scan < simulation->num_scans; scan++) {
        for (size_t i = 0; i < simulation->scans[scan].num_plots; i++) {
            squares += pow(simulation->scans[scan].plots[i].range_rate_mps, 2.0);
            count += 1.0;
        }
    }
    assert_near(count, 6000.0, 4.0 * sqrt(6000.0));
    assert_near(squares / count, 1.0, 4.0 * sqrt(2.0 / count));
    simulation_free(simulation);
}

/* Everything else is as without a span. */
static void a_span_folds_range_rates_and_nothing_else(void **state)
{
    (void)state;
    struct parameters parameters = parameters_of("doppler");
    struct simulation *whole = scenario_simulate("doppler", &parameters, SEED, 0);
    parameters_suggest(&parameters, PARAMETER_RANGE_RATE_SPAN_MPS, 60.0);
    struct simulation *folded = scenario_simulate("doppler", &parameters, SEED, 0);
    size_t changed = 0;
    for (size_t scan = 0; scan < whole->num_scans; scan++) {
        assert_int_equal(whole->scans[scan].num_plots, folded->scans[scan].num_plots);
        for (size_t i = 0; i < whole->scans[scan].num_plots; i++) {
            const struct simulated_plot *a = &whole->scans[scan].plots[i];
            const struct simulated_plot *b = &folded->scans[scan].plots[i];
            double turns = (a->range_rate_mps - b->range_rate_mps) / 60.0;
            assert_true(a->range_m == b->range_m && a->azimuth_rad == b->azimuth_rad);
            assert_true(fabs(b->range_rate_mps) <= 30.0);
            assert_near(turns, nearbyint(turns), 1e-9);
            changed += fabs(turns) > 0.5;
        }
    }
    assert_true(changed > 500);
    simulation_free(whole);
    simulation_free(folded);
}

/* 0.97 of the targets have a track after five turns without range rates and with ten times the clutter and them, 0.95 with
 * a span; 18 targets: four standard deviations are .19. */
static void range_rates_bear_ten_times_the_clutter(void **state)
{
    (void)state;
    static const double clutter[] = {100.0, 1000.0, 1000.0};
    for (size_t i = 0; i < sizeof clutter / sizeof clutter[0]; i++) {
        struct doppler_figures figures =
            doppler_measure(&doppler_cases[i], clutter[i], 0.0, SEED, 6);
        print_message("%s, %g a turn: Pd %.3f, after five %.3f, at %.2f, rmse %.0f m\n",
                      figures.of->name, clutter[i], figures.found, figures.prompt,
                      figures.confirm_at, figures.rmse_m);
        assert_true(figures.found >= 0.8 && figures.prompt >= 0.77);
        assert_true(figures.false_a_run <= 0.5 && figures.false_tracks <= 0.5);
        assert_near(figures.rmse_m, 170.0, 60.0);
    }
    struct doppler_figures without = doppler_measure(&doppler_cases[0], 1000.0, 0.0, SEED, 2);
    assert_true(without.prompt <= 0.5); /* 0 of 2000 a turn */
}

/* ---- rotating --------------------------------------------------------------------------------- */

/* As many sectors as asked for, one after the other, clockwise; each plot in its own, but for the noise of its azimuth. */
static void sectors_follow_each_other(void **state)
{
    (void)state;
    struct parameters parameters = parameters_of("rotating");
    struct simulation *simulation = scenario_simulate("rotating", &parameters, SEED, 0);
    const struct antenna_view *view = &simulation->record->views[0];
    size_t of_targets = 0, empty = 0;
    assert_int_equal(view->num_sectors, 15 * 32);
    assert_int_equal(simulation->num_times, 15 * 32);
    for (size_t i = 0; i < view->num_sectors; i++) {
        const struct antenna_sector *sector = &view->sectors[i];
        assert_near(sector->end_s, 0.125 * (double)(i + 1), 1e-9);
        assert_near(remainder(sector->from_rad + 0.19634954 * (double)(i + 1), 6.283185307), 0.0,
                    1e-6);
        for (size_t k = 0; k < sector->num_plots; k++) {
            assert_true(sector->plots[k].t_s >= sector->start_s &&
                        sector->plots[k].t_s <= sector->end_s);
            of_targets += sector->plots[k].target_id >= 0;
        }
        empty += sector->num_plots == 0;
    }
    assert_in_range(of_targets, 42, 48); /* 45 of three targets, 0.99 */
    assert_in_range(empty, 5, 60);       /* e^-3 of 480 */
    simulation_free(simulation);
}

/* Between 20 and 60 km; of the first and third straight, the second turned by 2 m/s^2 for 20 s. */
static void flights_stay_and_turn_gently(void **state)
{
    (void)state;
    struct parameters parameters = rotating_parameters();
    struct antenna_view view;
    struct rotating_scene scene = rotating_scene_of(&parameters, SEED, 0, &view);
    for (size_t i = 0; i < scene.num_flights; i++) {
        double most_mps2 = 0.0, path_m = 0.0, dt_s = 0.1;
        for (double t_s = 0.0; t_s < 60.0; t_s += dt_s) {
            struct truth_point a = rotating_truth(&scene, i, t_s);
            struct truth_point b = rotating_truth(&scene, i, t_s + dt_s);
            double range_m = hypot(a.x_m, a.y_m);
            assert_true(range_m >= 19900.0 && range_m <= 60100.0);
            most_mps2 = fmax(most_mps2, hypot(b.vx_mps - a.vx_mps, b.vy_mps - a.vy_mps) / dt_s);
            path_m += hypot(b.x_m - a.x_m, b.y_m - a.y_m);
            assert_near((b.x_m - a.x_m) / dt_s, (a.vx_mps + b.vx_mps) / 2.0, 0.1);
        }
        assert_near(path_m, 60.0 * scene.flights[i].speed_mps, 50.0);
        assert_near(most_mps2, i % 2 == 1 ? 2.0 : 0.0, 0.01);
    }
    antenna_view_free(&view);
    rotating_free(&scene);
}

/* 1.000 found and tracked by whole turns and at once; rmse 113 and 93 m. */
static void whole_turns_are_followed(void **state)
{
    (void)state;
    struct rotating_figures *figures = rotating_measure(SEED, 4);
    for (size_t i = ROTATING_TURNS; i < ROTATING_CASES; i++) {
        assert_true(figures[i].found >= 0.8 && figures[i].tracked >= 0.9);
        assert_true(figures[i].false_a_run <= 0.5);
    }
    assert_near(figures[ROTATING_TURNS].rmse_m, 113.0, 40.0);
    assert_near(figures[ROTATING_AT_ONCE].rmse_m, 93.0, 35.0);
    /* a plot waits for its sector, or its turn, to end, and for the step */
    assert_true(figures[ROTATING_SECTORS].latency_max_ms > 120.0);
    assert_true(figures[ROTATING_SECTORS].latency_max_ms < 200.0);
    assert_true(figures[ROTATING_TURNS].latency_max_ms > 3900.0);
    assert_true(figures[ROTATING_SECTORS].step_max_us > 0.0);
    rotating_figures_free(figures);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clutter_that_stands_is_added),
        cmocka_unit_test(a_span_folds_range_rates_and_nothing_else),
        cmocka_unit_test(range_rates_bear_ten_times_the_clutter),
        cmocka_unit_test(sectors_follow_each_other),
        cmocka_unit_test(flights_stay_and_turn_gently),
        cmocka_unit_test(whole_turns_are_followed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
