/* SPDX-License-Identifier: MIT */
/*
 * Scenario polar, plot by plot: is its chance what its parameters say? Seeds are fixed; bounds are four standard
 * deviations of a sample's mean, variance or chi-square.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "scenario.h"

#define SEED 4711
#define TURN_RAD 6.283185307179586

/* ---- samples ---------------------------------------------------------------------------------- */

struct sample {
    double count, sum, squares;
};

static void add(struct sample *sample, double value)
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

/* Independent normal values of mean 0 and variance 1. */
static void assert_standard_normal(const char *what, const struct sample *sample)
{
    assert_true(sample->count >= 1000.0);
    assert_within(what, mean_of(sample), 0.0, 4.0 / sqrt(sample->count));
    assert_within(what, variance_of(sample), 1.0, 4.0 * sqrt(2.0 / sample->count));
}

/* Uniform in lo .. hi: its mean, and its variance, which spreads by 2 / sqrt(5 n) of itself. */
static void assert_uniform(const char *what, const struct sample *sample, double lo, double hi)
{
    double variance = (hi - lo) * (hi - lo) / 12.0;

    assert_true(sample->count >= 1000.0);
    assert_within(what, mean_of(sample), (lo + hi) / 2.0, 4.0 * sqrt(variance / sample->count));
    assert_within(what, variance_of(sample), variance,
                  4.0 * variance * 2.0 / sqrt(5.0 * sample->count));
}

/* ---- simulations ------------------------------------------------------------------------------ */

static struct parameters parameters_of_polar(double targets, double num_scans,
                                             double clutter_per_scan)
{
    struct parameters parameters;

    parameters_default(&parameters);
    scenario_suggest("polar", &parameters);
    parameters_suggest(&parameters, PARAMETER_TARGETS, targets);
    parameters_suggest(&parameters, PARAMETER_NUM_SCANS, num_scans);
    parameters_suggest(&parameters, PARAMETER_CLUTTER_PER_SCAN, clutter_per_scan);
    return parameters;
}

static struct simulation *simulate(const struct parameters *parameters)
{
    return scenario_simulate("polar", parameters, SEED, 0);
}

/* 2000 turns of 100 clutter plots. */
static struct simulation *simulate_clutter(void)
{
    struct parameters parameters = parameters_of_polar(0, 2000, 100);

    return simulate(&parameters);
}

/* 1000 targets over 15 turns of 4 s, always seen, no clutter. */
static struct parameters parameters_of_targets(void)
{
    struct parameters parameters = parameters_of_polar(1000, 15, 0);

    parameters_suggest(&parameters, PARAMETER_TRUE_PD, 1.0);
    return parameters;
}

/* Angle in -pi .. pi. */
static double wrapped(double angle_rad)
{
    return remainder(angle_rad, TURN_RAD);
}

/* ---- clutter ---------------------------------------------------------------------------------- */

#define RANGE_BINS 10
#define AZIMUTH_BINS 16
#define BINS (RANGE_BINS * AZIMUTH_BINS)

static size_t bin_of(const struct simulated_plot *plot, const struct scenario_radar *radar)
{
    double range_share =
        (plot->range_m - radar->range_min_m) / (radar->range_max_m - radar->range_min_m);
    double azimuth_share = plot->azimuth_rad / TURN_RAD + 0.5;

    assert_true(range_share >= 0.0 && range_share < 1.0);
    assert_true(azimuth_share >= 0.0 && azimuth_share <= 1.0);
    return (size_t)(range_share * RANGE_BINS) * AZIMUTH_BINS +
           (size_t)(azimuth_share * AZIMUTH_BINS) % AZIMUTH_BINS;
}

static void clutter_is_uniform_in_range_and_azimuth(void **state)
{
    struct simulation *simulation = simulate_clutter();
    double counts[BINS] = {0}, total = 0.0, chi_square = 0.0;
    (void)state;

    for (size_t i = 0; i < simulation->num_scans; i++) {
        const struct simulated_scan *scan = &simulation->scans[i];
        for (size_t j = 0; j < scan->num_plots; j++) {
            counts[bin_of(&scan->plots[j], &simulation->radar)] += 1.0;
        }
        total += (double)scan->num_plots;
    }
    for (size_t i = 0; i < BINS; i++) {
        double off = counts[i] - total / BINS;
        chi_square += off * off / (total / BINS);
    }
    assert_within("chi-square", chi_square, BINS - 1.0, 4.0 * sqrt(2.0 * (BINS - 1.0)));
    simulation_free(simulation);
}

static void clutter_lies_within_the_range_limits_that_were_set(void **state)
{
    struct parameters parameters = parameters_of_polar(0, 200, 100);
    struct sample ranges_m = {0};
    struct simulation *simulation;
    (void)state;

    parameters_suggest(&parameters, PARAMETER_RANGE_MIN_M, 5000.0);
    parameters_suggest(&parameters, PARAMETER_RANGE_MAX_M, 30000.0);
    simulation = simulate(&parameters);
    for (size_t i = 0; i < simulation->num_scans; i++) {
        for (size_t j = 0; j < simulation->scans[i].num_plots; j++) {
            double range_m = simulation->scans[i].plots[j].range_m;
            assert_true(range_m >= 5000.0 && range_m <= 30000.0);
            add(&ranges_m, range_m);
        }
    }
    assert_uniform("clutter's ranges", &ranges_m, 5000.0, 30000.0);
    simulation_free(simulation);
}

static void clutter_is_poisson_in_each_turn(void **state)
{
    struct simulation *simulation = simulate_clutter();
    struct sample counts = {0};
    double n = (double)simulation->num_scans;
    (void)state;

    for (size_t i = 0; i < simulation->num_scans; i++) {
        add(&counts, (double)simulation->scans[i].num_plots);
    }
    assert_within("plots a turn", mean_of(&counts), 100.0, 4.0 * sqrt(100.0 / n));
    assert_within("their variance", variance_of(&counts), 100.0, 4.0 * 100.0 * sqrt(2.0 / n));
    simulation_free(simulation);
}

static void clutter_has_any_range_rate(void **state)
{
    struct parameters parameters = parameters_of_polar(0, 200, 100);
    struct sample rates_mps = {0};
    struct simulation *simulation;
    (void)state;

    parameters_suggest(&parameters, PARAMETER_V_MAX_MPS, 300.0);
    parameters_suggest(&parameters, PARAMETER_RANGE_RATE, 1.0);
    simulation = simulate(&parameters);
    for (size_t i = 0; i < simulation->num_scans; i++) {
        for (size_t j = 0; j < simulation->scans[i].num_plots; j++) {
            double rate_mps = simulation->scans[i].plots[j].range_rate_mps;
            assert_true(fabs(rate_mps) <= 300.0);
            add(&rates_mps, rate_mps);
        }
    }
    assert_uniform("clutter's range rates", &rates_mps, -300.0, 300.0);
    simulation_free(simulation);
}

/* ---- the antenna ------------------------------------------------------------------------------ */

static void clutter_is_seen_when_the_antenna_looks_there(void **state)
{
    struct simulation *simulation = simulate_clutter();
    (void)state;

    for (size_t i = 0; i < simulation->num_scans; i++) {
        const struct simulated_scan *scan = &simulation->scans[i];
        assert_true(fabs(scan->t_s - 4.0 * (double)i) < 1e-9);
        for (size_t j = 0; j < scan->num_plots; j++) {
            const struct simulated_plot *plot = &scan->plots[j];
            double antenna_rad = TURN_RAD * plot->offset_s / simulation->interval_s;
            assert_true(fabs(wrapped(plot->azimuth_rad - antenna_rad)) < 1e-9);
        }
    }
    simulation_free(simulation);
}

static void plots_of_a_turn_come_in_its_time(void **state)
{
    struct parameters parameters = parameters_of_polar(100, 15, 100);
    struct simulation *simulation = simulate(&parameters);
    (void)state;

    for (size_t i = 0; i < simulation->num_scans; i++) {
        const struct simulated_scan *scan = &simulation->scans[i];
        for (size_t j = 0; j < scan->num_plots; j++) {
            double offset_s = scan->plots[j].offset_s;
            assert_true(offset_s >= 0.0 && offset_s <= simulation->interval_s);
            assert_true(j == 0 || offset_s >= scan->plots[j - 1].offset_s);
        }
    }
    simulation_free(simulation);
}

static void a_plot_has_its_place_beside_range_and_azimuth(void **state)
{
    struct parameters parameters = parameters_of_polar(100, 15, 100);
    struct simulation *simulation = simulate(&parameters);
    (void)state;

    for (size_t i = 0; i < simulation->num_scans; i++) {
        for (size_t j = 0; j < simulation->scans[i].num_plots; j++) {
            const struct simulated_plot *plot = &simulation->scans[i].plots[j];
            assert_true(fabs(plot->azimuth_rad) <= TURN_RAD / 2.0);
            assert_true(fabs(plot->x_m - plot->range_m * cos(plot->azimuth_rad)) < 1e-6);
            assert_true(fabs(plot->y_m - plot->range_m * sin(plot->azimuth_rad)) < 1e-6);
        }
    }
    simulation_free(simulation);
}

/* ---- detections ------------------------------------------------------------------------------- */

/* Where a target is when its plot is made. */
struct meeting {
    double range_m, azimuth_rad, range_rate_mps;
};

static const struct truth_point *truth_of(const struct simulation *simulation, size_t scan,
                                          int target_id)
{
    const struct truth_point *truth =
        &simulation->truth[scan * simulation->num_targets + (size_t)target_id];

    assert_int_equal(truth->target_id, target_id);
    return truth;
}

static struct meeting meeting_of(const struct truth_point *truth, double offset_s)
{
    double x_m = truth->x_m + truth->vx_mps * offset_s;
    double y_m = truth->y_m + truth->vy_mps * offset_s;
    double range_m = hypot(x_m, y_m);

    return (struct meeting){.range_m = range_m,
                            .azimuth_rad = atan2(y_m, x_m),
                            .range_rate_mps =
                                (x_m * truth->vx_mps + y_m * truth->vy_mps) / range_m};
}

/* Errors of all detections, in units of their stated sigmas. */
struct errors {
    struct sample range, azimuth, range_rate, range_times_azimuth, range_times_rate;
};

static void add_errors(struct errors *errors, const struct scenario_radar *radar,
                       const struct simulated_plot *plot, const struct meeting *meeting)
{
    double range = (plot->range_m - meeting->range_m) / radar->sigma_range_m;
    double azimuth = wrapped(plot->azimuth_rad - meeting->azimuth_rad) / radar->sigma_azimuth_rad;
    double rate = (plot->range_rate_mps - meeting->range_rate_mps) / radar->sigma_range_rate_mps;

    add(&errors->range, range);
    add(&errors->azimuth, azimuth);
    add(&errors->range_rate, rate);
    add(&errors->range_times_azimuth, range * azimuth);
    add(&errors->range_times_rate, range * rate);
}

static struct errors errors_of(const struct simulation *simulation)
{
    struct errors errors = {0};

    for (size_t i = 0; i < simulation->num_scans; i++) {
        for (size_t j = 0; j < simulation->scans[i].num_plots; j++) {
            const struct simulated_plot *plot = &simulation->scans[i].plots[j];
            struct meeting meeting =
                meeting_of(truth_of(simulation, i, plot->target_id), plot->offset_s);
            add_errors(&errors, &simulation->radar, plot, &meeting);
        }
    }
    return errors;
}

/* Simulated with the parameters, judged by these sigmas, which the radar must state too. */
static void check_noise(const struct parameters *parameters, double sigma_range_m,
                        double sigma_azimuth_rad, double sigma_range_rate_mps)
{
    struct simulation *simulation = simulate(parameters);
    const struct scenario_radar *radar = &simulation->radar;
    struct errors errors;

    assert_true(fabs(radar->sigma_range_m - sigma_range_m) < 1e-12);
    assert_true(fabs(radar->sigma_azimuth_rad - sigma_azimuth_rad) < 1e-12);
    assert_true(fabs(radar->sigma_range_rate_mps - sigma_range_rate_mps) < 1e-12);
    errors = errors_of(simulation);
    assert_standard_normal("range", &errors.range);
    assert_standard_normal("azimuth", &errors.azimuth);
    assert_standard_normal("range rate", &errors.range_rate);
    /* independent: their products have mean 0 and variance 1 */
    assert_within("range and azimuth", mean_of(&errors.range_times_azimuth), 0.0,
                  4.0 / sqrt(errors.range.count));
    assert_within("range and rate", mean_of(&errors.range_times_rate), 0.0,
                  4.0 / sqrt(errors.range.count));
    simulation_free(simulation);
}

static void detections_have_the_customary_noise(void **state)
{
    struct parameters parameters = parameters_of_targets();
    (void)state;

    parameters_suggest(&parameters, PARAMETER_RANGE_RATE, 1.0);
    check_noise(&parameters, 15.0, 0.003, 1.0);
}

static void detections_have_the_noise_that_was_set(void **state)
{
    struct parameters parameters = parameters_of_targets();
    (void)state;

    parameters_suggest(&parameters, PARAMETER_RANGE_RATE, 1.0);
    parameters_suggest(&parameters, PARAMETER_SIGMA_RANGE_M, 40.0);
    parameters_suggest(&parameters, PARAMETER_SIGMA_AZIMUTH_RAD, 0.001);
    parameters_suggest(&parameters, PARAMETER_SIGMA_RANGE_RATE_MPS, 2.5);
    check_noise(&parameters, 40.0, 0.001, 2.5);
}

static void check_detection_rate(double true_pd)
{
    struct parameters parameters = parameters_of_targets();
    struct simulation *simulation;
    struct sample counts = {0};
    double n;

    parameters_suggest(&parameters, PARAMETER_TRUE_PD, true_pd);
    simulation = simulate(&parameters);
    n = (double)(simulation->num_scans * simulation->num_targets);
    for (size_t i = 0; i < simulation->num_scans; i++) {
        add(&counts, (double)simulation->scans[i].num_plots);
    }
    assert_within("detection rate", counts.sum / n, true_pd,
                  4.0 * sqrt(true_pd * (1.0 - true_pd) / n));
    simulation_free(simulation);
}

static void targets_are_seen_as_often_as_true_pd_says(void **state)
{
    (void)state;
    check_detection_rate(1.0);
    check_detection_rate(0.99);
    check_detection_rate(0.7);
}

static void a_target_is_seen_once_a_turn(void **state)
{
    struct parameters parameters = parameters_of_targets();
    struct simulation *simulation = simulate(&parameters);
    (void)state;

    for (size_t i = 0; i < simulation->num_scans; i++) {
        unsigned char seen[1000] = {0};
        assert_int_equal(simulation->scans[i].num_plots, 1000);
        for (size_t j = 0; j < 1000; j++) {
            assert_in_range(simulation->scans[i].plots[j].target_id, 0, 999);
            assert_false(seen[simulation->scans[i].plots[j].target_id]++);
        }
    }
    simulation_free(simulation);
}

/*
 * Within the turn the target goes over the azimuth 0, where turns begin: the antenna meets it twice, or only in the
 * next turn.
 */
static int crosses_the_start(const struct truth_point *truth, double interval_s)
{
    double first_rad = meeting_of(truth, 0.0).azimuth_rad;
    double last_rad = meeting_of(truth, interval_s).azimuth_rad;

    return (first_rad < 0.0) != (last_rad < 0.0) && fabs(first_rad) < 1.0;
}

static void targets_are_seen_when_the_antenna_meets_them(void **state)
{
    struct parameters parameters = parameters_of_targets();
    struct simulation *simulation = simulate(&parameters);
    size_t crossing = 0;
    (void)state;

    for (size_t i = 0; i < simulation->num_scans; i++) {
        for (size_t j = 0; j < simulation->scans[i].num_plots; j++) {
            const struct simulated_plot *plot = &simulation->scans[i].plots[j];
            const struct truth_point *truth = truth_of(simulation, i, plot->target_id);
            double antenna_rad = TURN_RAD * plot->offset_s / simulation->interval_s;
            double target_rad = meeting_of(truth, plot->offset_s).azimuth_rad;
            if (crosses_the_start(truth, simulation->interval_s)) {
                crossing++;
            } else {
                assert_true(fabs(wrapped(target_rad - antenna_rad)) < 1e-9);
            }
        }
    }
    /* at 250 m/s over a circle of 40 km that is 1 in 400 */
    assert_true(crossing < 15000 / 100);
    simulation_free(simulation);
}

/* ---- paths ------------------------------------------------------------------------------------ */

static void targets_stay_between_20_and_60_km(void **state)
{
    struct parameters parameters = parameters_of_targets();
    struct simulation *simulation = simulate(&parameters);
    (void)state;

    for (size_t i = 0; i < simulation->num_truth; i++) {
        for (double offset_s = 0.0; offset_s <= 4.0; offset_s += 0.5) {
            double range_m = meeting_of(&simulation->truth[i], offset_s).range_m;
            assert_true(range_m >= 20000.0 - 1e-6 && range_m <= 60000.0 + 1e-6);
        }
    }
    simulation_free(simulation);
}

static void targets_start_all_round_and_all_through_the_ring(void **state)
{
    struct parameters parameters = parameters_of_targets();
    struct simulation *simulation = simulate(&parameters);
    size_t octants[8] = {0}, near = 0, far = 0;
    (void)state;

    for (size_t i = 0; i < simulation->num_targets; i++) {
        struct meeting start = meeting_of(&simulation->truth[i], 0.0);
        octants[(size_t)((start.azimuth_rad / TURN_RAD + 0.5) * 8.0) % 8]++;
        near += start.range_m < 25000.0;
        far += start.range_m > 55000.0;
    }
    for (size_t i = 0; i < 8; i++) {
        /* 125 of 1000 in each, standard deviation 10.5 */
        assert_in_range(octants[i], 125 - 42, 125 + 42);
    }
    /* 5 km of the 40, by area 7 and 18 % but for the paths that would leave */
    assert_true(near >= 20 && far >= 40);
    simulation_free(simulation);
}

static void targets_fly_straight_at_speeds_between_the_limits(void **state)
{
    struct parameters parameters = parameters_of_targets();
    struct simulation *simulation = simulate(&parameters);
    size_t num = simulation->num_targets, fast = 0;
    (void)state;

    for (size_t i = 0; i < simulation->num_truth; i++) {
        const struct truth_point *now = &simulation->truth[i], *start = &simulation->truth[i % num];
        double speed_mps = hypot(now->vx_mps, now->vy_mps);
        double t_s = 4.0 * (double)(i / num);
        assert_true(speed_mps >= 100.0 - 1e-9 && speed_mps <= 400.0 + 1e-9);
        assert_true(fabs(now->t_s - t_s) < 1e-9);
        assert_true(fabs(now->x_m - start->x_m - start->vx_mps * t_s) < 1e-6);
        assert_true(fabs(now->y_m - start->y_m - start->vy_mps * t_s) < 1e-6);
        fast += i < num && speed_mps > 250.0;
    }
    assert_true(fast > num / 4 && fast < num * 3 / 4);
    simulation_free(simulation);
}

/* ---- range rates, seeds ----------------------------------------------------------------------- */

static void assert_same_plot(const struct simulated_plot *one, const struct simulated_plot *other)
{
    assert_int_equal(one->target_id, other->target_id);
    assert_memory_equal(&one->offset_s, &other->offset_s, sizeof one->offset_s);
    assert_memory_equal(&one->range_m, &other->range_m, sizeof one->range_m);
    assert_memory_equal(&one->azimuth_rad, &other->azimuth_rad, sizeof one->azimuth_rad);
    assert_memory_equal(&one->range_rate_mps, &other->range_rate_mps, sizeof one->range_rate_mps);
}

static void assert_same_plots(const struct simulation *one, const struct simulation *other)
{
    assert_int_equal(one->num_scans, other->num_scans);
    for (size_t i = 0; i < one->num_scans; i++) {
        assert_int_equal(one->scans[i].num_plots, other->scans[i].num_plots);
        for (size_t j = 0; j < one->scans[i].num_plots; j++) {
            assert_same_plot(&one->scans[i].plots[j], &other->scans[i].plots[j]);
        }
    }
}

static void range_rates_are_measured_where_wanted_alone(void **state)
{
    struct parameters parameters = parameters_of_polar(3, 15, 100);
    struct simulation *without, *with;
    (void)state;

    without = simulate(&parameters);
    parameters_suggest(&parameters, PARAMETER_RANGE_RATE, 1.0);
    with = simulate(&parameters);
    assert_true(without->radar.is_used && !without->radar.has_range_rate);
    assert_true(with->radar.is_used && with->radar.has_range_rate);
    assert_same_plots(without, with);
    simulation_free(without);
    simulation_free(with);
}

static void a_seed_gives_the_same_plots_again(void **state)
{
    struct parameters parameters = parameters_of_polar(3, 15, 100);
    struct simulation *one = simulate(&parameters), *again = simulate(&parameters);
    struct simulation *other_seed = scenario_simulate("polar", &parameters, SEED + 1, 0);
    struct simulation *other_run = scenario_simulate("polar", &parameters, SEED, 1);
    double x_m = one->truth[0].x_m;
    (void)state;

    assert_same_plots(one, again);
    assert_true(fabs(x_m - other_seed->truth[0].x_m) > 1.0);
    assert_true(fabs(x_m - other_run->truth[0].x_m) > 1.0);
    simulation_free(one);
    simulation_free(again);
    simulation_free(other_seed);
    simulation_free(other_run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clutter_is_uniform_in_range_and_azimuth),
        cmocka_unit_test(clutter_lies_within_the_range_limits_that_were_set),
        cmocka_unit_test(clutter_is_poisson_in_each_turn),
        cmocka_unit_test(clutter_has_any_range_rate),
        cmocka_unit_test(clutter_is_seen_when_the_antenna_looks_there),
        cmocka_unit_test(plots_of_a_turn_come_in_its_time),
        cmocka_unit_test(a_plot_has_its_place_beside_range_and_azimuth),
        cmocka_unit_test(detections_have_the_customary_noise),
        cmocka_unit_test(detections_have_the_noise_that_was_set),
        cmocka_unit_test(targets_are_seen_as_often_as_true_pd_says),
        cmocka_unit_test(a_target_is_seen_once_a_turn),
        cmocka_unit_test(targets_are_seen_when_the_antenna_meets_them),
        cmocka_unit_test(targets_stay_between_20_and_60_km),
        cmocka_unit_test(targets_start_all_round_and_all_through_the_ring),
        cmocka_unit_test(targets_fly_straight_at_speeds_between_the_limits),
        cmocka_unit_test(range_rates_are_measured_where_wanted_alone),
        cmocka_unit_test(a_seed_gives_the_same_plots_again),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
