/* SPDX-License-Identifier: MIT */
/*
 * Sensor biases estimated from common targets: are errors within their sigmas for any biases,
 * references and scan orders, and are unobservable biases reported as unknown? Seeds are fixed.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pipeline/pipeline.h"
#include "registration/cholesky.h"
#include "registration/register.h"
#include "registration/register_data.h"
#include "tools/scene_for_tracker.h"

#define SEED 4711
#define RUNS 12
#define DEG_RAD 0.017453292519943295

static struct pipeline chain;

static int allocate_pipeline_once(void **state)
{
    (void)state;
    chain = pipeline_allocate();
    return 0;
}

static int free_pipeline(void **state)
{
    (void)state;
    pipeline_free(&chain);
    return 0;
}

/* A run of the scene two-radars with the given changes. */
struct heard {
    struct scene *scene;
    struct scene_run *run;
    struct parameters parameters;
};

static struct heard observe_two_radars(uint64_t run, const char *const *sets, size_t num_sets)
{
    struct heard heard = {.scene = scene_load_by_name("two-radars", sets, num_sets)};

    heard.run = scene_observe(heard.scene, SEED, run);
    heard.parameters = scene_parameters(heard.scene);
    return heard;
}

static void free_observation(struct heard *heard)
{
    scene_run_free(heard->run);
    scene_free(heard->scene);
}

/* How scans are described to the estimation. */
struct telling {
    bool is_backwards;
    /* biases that each radar is described with; other fields are unused */
    struct rho_sensor biases;
    double sigma_factor; /* factor on the stated noise of plots; 0 means 1 */
};

static void add_scan(struct register_data *data, const struct scene_run *run,
                     const struct scene_scan *seen, const struct telling *telling)
{
    struct rho_sensor sensor = scene_sensor_without_biases(&run->scene->sensors[seen->sensor]);
    struct rho_scan scan;

    sensor.range_bias_m = telling->biases.range_bias_m;
    sensor.azimuth_bias_rad = telling->biases.azimuth_bias_rad;
    sensor.time_bias_s = telling->biases.time_bias_s;
    scan = scene_scan_for_tracker(run, seen, &sensor, chain.plots);
    for (uint32_t i = 0; telling->sigma_factor > 0.0 && i < scan.num_plots; i++) {
        chain.plots[i].sigma_range_m *= (float)telling->sigma_factor;
        chain.plots[i].sigma_cross_m *= (float)telling->sigma_factor;
    }
    assert_null(register_add_scan(data, &scan, &sensor));
}

static struct register_result estimate_biases(const struct heard *heard,
                                              const struct telling *telling)
{
    struct register_data *data = register_start(&heard->parameters);
    const struct scene_run *run = heard->run;

    for (size_t i = 0; i < run->num_scans; i++) {
        add_scan(data, run, &run->scans[telling->is_backwards ? run->num_scans - 1 - i : i],
                 telling);
    }
    struct register_result result = register_estimate_biases(data, &chain);
    register_free(data);
    return result;
}

static double true_bias(const struct scene_sensor *radar, size_t kind)
{
    const double biases[NUM_REGISTER_KINDS] = {radar->range_bias_m, radar->azimuth_bias_rad,
                                               radar->time_bias_s};

    return biases[kind];
}

/*
 * Every bias is estimated within most_sigmas. Returns the sum of squared errors in sigmas, of 5
 * biases.
 */
static double sum_of_squared_bias_errors(const struct heard *heard,
                                         const struct register_result *result, double most_sigmas)
{
    double sum = 0.0;

    assert_int_equal(result->num_radars, 2);
    for (size_t radar = 0; radar < 2; radar++) {
        for (size_t kind = 0; kind < NUM_REGISTER_KINDS; kind++) {
            const struct register_bias *bias = &result->radars[radar].biases[kind];
            double truth = true_bias(&heard->scene->sensors[radar], kind);
            double off = bias->value - truth;

            assert_true(bias->is_known);
            if (radar == result->reference && kind == REGISTER_TIME) {
                assert_true(bias->sigma == 0.0);
                continue;
            }
            print_message("radar %zu, kind %zu: %.6f, true %.6f, sigma %.6f\n", radar + 1, kind,
                          bias->value, truth, bias->sigma);
            assert_true(fabs(off) < most_sigmas * bias->sigma);
            sum += off * off / (bias->sigma * bias->sigma);
        }
    }
    return sum;
}

/*
 * Sigmas are 3 m, 0.004 degrees and 19 ms. Over 400 runs the variance of errors in sigmas was 0.99
 * +- 0.03.
 */
static void test_bias_errors_agree_with_their_sigmas(void **state)
{
    const struct telling telling = {.is_backwards = false};
    double sum = 0.0, range_m2 = 0.0, azimuth_rad2 = 0.0;

    (void)state;
    for (uint64_t run = 0; run < RUNS; run++) {
        struct heard heard = observe_two_radars(run, NULL, 0);
        struct register_result result = estimate_biases(&heard, &telling);

        assert_true(result.targets >= 19 && result.targets <= 20);
        assert_true(result.misfit > 0.95 && result.misfit < 1.08);
        sum += sum_of_squared_bias_errors(&heard, &result, 4.5);
        for (size_t radar = 0; radar < 2; radar++) {
            const struct scene_sensor *sensor = &heard.scene->sensors[radar];
            const struct register_bias *biases = result.radars[radar].biases;

            range_m2 += pow(biases[REGISTER_RANGE].value - sensor->range_bias_m, 2.0);
            azimuth_rad2 += pow(biases[REGISTER_AZIMUTH].value - sensor->azimuth_bias_rad, 2.0);
        }
        register_result_free(&result);
        free_observation(&heard);
    }
    print_message("errors over sigmas: variance %.3f of %d\n", sum / (5 * RUNS), 5 * RUNS);
    assert_true(fabs(sum / (5 * RUNS) - 1.0) < 4.0 * sqrt(2.0 / (5 * RUNS)));
    assert_true(sqrt(range_m2 / (2 * RUNS)) < 5.0);
    assert_true(sqrt(azimuth_rad2 / (2 * RUNS)) < 0.006 * DEG_RAD);
}

/*
 * Large biases of all kinds; with the other radar as the time reference the time bias changes its
 * sign.
 */
static void test_large_biases_are_found_by_either_reference(void **state)
{
    const struct telling telling = {.is_backwards = false};

    (void)state;
    const char *sets[] = {"radars.0.range_bias_m=400", "radars.0.azimuth_bias_rad=-0.00872665",
                          "radars.1.range_bias_m=-400", "radars.1.azimuth_bias_rad=0.00872665",
                          "radars.1.time_bias_s=1.5"};
    struct heard heard = observe_two_radars(0, sets, 5);
    struct register_result result = estimate_biases(&heard, &telling);
    sum_of_squared_bias_errors(&heard, &result, 4.0);
    register_result_free(&result);

    parameters_set_assignment(&heard.parameters, "reference_sensor=2");
    result = estimate_biases(&heard, &telling);
    assert_int_equal(result.reference, 1);
    heard.scene->sensors[0].time_bias_s = -1.5;
    heard.scene->sensors[1].time_bias_s = 0.0;
    sum_of_squared_bias_errors(&heard, &result, 4.0);
    register_result_free(&result);
    free_observation(&heard);
}

/* Configured biases are added to the estimate; the order of the scans does not matter. */
static void test_configured_biases_and_scan_order_do_not_matter(void **state)
{
    const struct telling plain = {.is_backwards = false};
    const struct telling other = {
        .is_backwards = true,
        .biases = {.range_bias_m = 30.0f, .azimuth_bias_rad = -0.001f, .time_bias_s = 0.0f}};
    struct heard heard = observe_two_radars(1, NULL, 0);
    struct register_result one = estimate_biases(&heard, &plain);
    struct register_result two = estimate_biases(&heard, &other);

    (void)state;
    for (size_t radar = 0; radar < 2; radar++) {
        for (size_t kind = 0; kind < NUM_REGISTER_KINDS; kind++) {
            const struct register_bias *bias = &one.radars[radar].biases[kind];

            /* tolerance, as tracks may take other plots now and then */
            assert_true(fabs(bias->value - two.radars[radar].biases[kind].value) <=
                        0.3 * bias->sigma);
        }
    }
    register_result_free(&one);
    register_result_free(&two);
    free_observation(&heard);
}

/*
 * Plots stated twice as accurate as they are: the sigmas of the biases follow the measured noise.
 */
static void test_bias_sigmas_follow_the_measured_noise(void **state)
{
    const struct telling plain = {.is_backwards = false}, better = {.sigma_factor = 0.5};
    struct heard heard = observe_two_radars(2, NULL, 0);
    struct register_result one = estimate_biases(&heard, &plain);
    struct register_result two = estimate_biases(&heard, &better);

    (void)state;
    print_message("misfit %.3f and %.3f\n", one.misfit, two.misfit);
    /* outliers count less: a little below 2 */
    assert_true(two.misfit > 1.6 && two.misfit < 2.1);
    assert_true(two.radars[0].biases[REGISTER_RANGE].sigma >
                0.8 * one.radars[0].biases[REGISTER_RANGE].sigma);
    sum_of_squared_bias_errors(&heard, &two, 4.5);
    register_result_free(&one);
    register_result_free(&two);
    free_observation(&heard);
}

/*
 * One target for four minutes determines no bias better than one plot; without targets nothing is
 * common.
 */
static void test_unobservable_biases_are_reported_as_unknown(void **state)
{
    const struct telling telling = {.is_backwards = false};

    (void)state;
    const char *one[] = {"targets.0.count=1", "duration_s=240"};
    struct heard heard = observe_two_radars(3, one, 2);
    struct register_result result = estimate_biases(&heard, &telling);
    assert_int_equal(result.targets, 1);
    for (size_t radar = 0; radar < 2; radar++) {
        for (size_t kind = 0; kind < REGISTER_TIME; kind++) {
            double off = result.radars[radar].biases[kind].value;

            print_message("sigma %g\n", result.radars[radar].biases[kind].sigma);
            assert_false(result.radars[radar].biases[kind].is_known);
            assert_true(off == 0.0);
        }
    }
    register_result_free(&result);
    free_observation(&heard);

    const char *nobody[] = {"targets=[]"};
    heard = observe_two_radars(4, nobody, 1);
    result = estimate_biases(&heard, &telling);
    assert_int_equal(result.targets, 0);
    assert_int_equal(result.plots, 0);
    assert_false(result.radars[1].biases[REGISTER_RANGE].is_known);
    register_result_free(&result);
    free_observation(&heard);
}

static struct rho_plot isotropic_plot_at(float x_m, float y_m, float sigma_m)
{
    return (struct rho_plot){.x_m = x_m,
                             .y_m = y_m,
                             .sigma_range_m = sigma_m,
                             .sigma_cross_m = sigma_m,
                             .sigma_up_m = sigma_m};
}

static void test_isotropic_plots_and_a_moving_radar_are_refused(void **state)
{
    struct parameters parameters;
    parameters_set_defaults(&parameters);
    struct register_data *data = register_start(&parameters);
    struct rho_plot plot = isotropic_plot_at(1000.0f, 2000.0f, 10.0f);
    struct rho_scan scan = {.sensor_id = 5, .num_plots = 1, .plots = &plot};
    struct rho_sensor sensor = {.sensor_id = 5, .pd = 0.9f, .range_max_m = 1e5f};

    (void)state;
    assert_string_equal(register_add_scan(data, &scan, &sensor),
                        "its plots are not in range and azimuth");
    plot.sigma_cross_m = 20.0f;
    assert_null(register_add_scan(data, &scan, &sensor));
    sensor.x_m = 1.0f;
    assert_non_null(strstr(register_add_scan(data, &scan, &sensor), "moves"));
    assert_int_equal(register_num_radars(data), 1);
    register_free(data);
}

/* The radar of a refused scan was once added: its lack of plots then made it the reference. */
static void a_refused_scan_adds_no_radar(void **state)
{
    struct parameters parameters;
    parameters_set_defaults(&parameters);
    struct register_data *data = register_start(&parameters);
    struct rho_plot plot = isotropic_plot_at(1000.0f, 2000.0f, 10.0f);
    struct rho_scan scan = {.time_us = 1, .sensor_id = 5, .num_plots = 1, .plots = &plot};
    struct rho_sensor sensor = {.sensor_id = 5, .pd = 0.9f, .range_max_m = 1e5f};

    (void)state;
    assert_non_null(register_add_scan(data, &scan, &sensor));
    assert_int_equal(register_num_radars(data), 0);
    assert_int_equal(data->start_us, 0);
    plot.sigma_cross_m = 20.0f;
    scan.time_us = 7000000;
    assert_null(register_add_scan(data, &scan, &sensor));
    assert_int_equal(register_num_radars(data), 1);
    assert_int_equal(data->start_us, 7000000);
    register_free(data);
}

/* A radar of the lowest number whose scans have no plots leaves the biases of the others known. */
static void a_radar_without_plots_is_no_reference(void **state)
{
    const struct telling telling = {.is_backwards = false};
    struct heard heard = observe_two_radars(0, NULL, 0);
    struct register_data *data = register_start(&heard.parameters);
    const struct rho_sensor silent = {.sensor_id = -3, .pd = 0.9f, .range_max_m = 1e5f};
    const struct rho_scan empty = {.sensor_id = -3};
    struct register_result result;

    (void)state;
    assert_null(register_add_scan(data, &empty, &silent));
    for (size_t i = 0; i < heard.run->num_scans; i++) {
        add_scan(data, heard.run, &heard.run->scans[i], &telling);
    }
    result = register_estimate_biases(data, &chain);
    assert_int_equal(result.num_radars, 3);
    assert_int_equal(result.reference, 1);
    for (size_t kind = 0; kind < NUM_REGISTER_KINDS; kind++) {
        assert_false(result.radars[0].biases[kind].is_known);
        assert_true(result.radars[1].biases[kind].is_known);
        assert_true(result.radars[2].biases[kind].is_known);
    }
    register_result_free(&result);
    register_free(data);
    free_observation(&heard);
}

static void test_cholesky_inverse_and_failure(void **state)
{
    double matrix[9] = {4, 0, 0, 2, 5, 0, -2, 1, 6}, v[3] = {2, 13, 12}, work[3];
    double singular[4] = {1, 0, 1, 1};

    (void)state;
    assert_true(cholesky_factor(matrix, 3));
    cholesky_solve(matrix, 3, v);
    double back[3] = {4 * v[0] + 2 * v[1] - 2 * v[2], 2 * v[0] + 5 * v[1] + v[2],
                      -2 * v[0] + v[1] + 6 * v[2]};
    assert_true(fabs(back[0] - 2) < 1e-12 && fabs(back[1] - 13) < 1e-12 &&
                fabs(back[2] - 12) < 1e-12);
    /* inverse: cofactors over the determinant of 64 */
    assert_true(fabs(cholesky_inverse_diagonal(matrix, 3, 0, work) - 29.0 / 64.0) < 1e-12);
    assert_true(fabs(cholesky_inverse_diagonal(matrix, 3, 2, work) - 16.0 / 64.0) < 1e-12);
    assert_false(cholesky_factor(singular, 2));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bias_errors_agree_with_their_sigmas),
        cmocka_unit_test(test_large_biases_are_found_by_either_reference),
        cmocka_unit_test(test_configured_biases_and_scan_order_do_not_matter),
        cmocka_unit_test(test_bias_sigmas_follow_the_measured_noise),
        cmocka_unit_test(test_unobservable_biases_are_reported_as_unknown),
        cmocka_unit_test(test_isotropic_plots_and_a_moving_radar_are_refused),
        cmocka_unit_test(a_refused_scan_adds_no_radar),
        cmocka_unit_test(a_radar_without_plots_is_no_reference),
        cmocka_unit_test(test_cholesky_inverse_and_failure),
    };

    return cmocka_run_group_tests_name("register", tests, allocate_pipeline_once, free_pipeline);
}
