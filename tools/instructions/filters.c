/* SPDX-License-Identifier: MIT */
/*
 * filters: one step of a Kalman filter, or of the literature's filter with its gate;
 * tools/gates/instructions.sh counts its instructions. The argument names the step: predict+3 and
 * predict+6 (a prediction and 3 or 6 updates of one state element each), coupled+6 (6 updates after
 * a polar plot has coupled the axes), predict+polar, input+hough.
 */
#include <string.h>

#include "count.h"
#include "random_draws.h"
#include "rhotrack/detail/gate.h"
#include "rhotrack/detail/input_estimation.h"
#include "rhotrack/detail/kalman.h"
#include "rhotrack/detail/measurement.h"

#define STEPS 20
#define PLOTS 5 /* the first one is the target's */

static struct rho_kalman kalman;
static struct rho_measurement measurement;
static int failed;

/* Prints the name of a status that is an error and makes the program's exit code 1. */
static void note_failure_unless_ok(enum rho_status status)
{
    if (status != RHO_OK) {
        fprintf(stderr, "filters: %s\n", rho_status_name(status));
        failed = 1;
    }
}

/* ---- a step with updates ---- */

static void prepare_filter_and_measurement(float position_variance_m2)
{
    static const struct rho_plot plot = {.x_m = 30000.0f,
                                         .y_m = 20000.0f,
                                         .z_m = 3000.0f,
                                         .sigma_range_m = 15.0f,
                                         .sigma_cross_m = 110.0f,
                                         .sigma_up_m = 110.0f};
    rho_kalman_init(&kalman);
    for (int axis = 0; axis < 3; axis++) {
        note_failure_unless_ok(
            rho_kalman_open_axis(&kalman, axis, 100.0f, position_variance_m2, 1e4f));
    }
    rho_measurement_from_plot(&plot, RHO_MEASURES_Z, NULL, &measurement);
}

static void predict_and_update_elements(int num_elements)
{
    note_failure_unless_ok(rho_kalman_predict(&kalman, 1.0f, 1.0f));
    for (int i = 0; i < num_elements; i++) {
        note_failure_unless_ok(rho_kalman_update(&kalman, i, 100.0f, 100.0f, NULL));
    }
}

static void step_by_polar_plot(void)
{
    note_failure_unless_ok(rho_kalman_predict(&kalman, 1.0f, 1.0f));
    note_failure_unless_ok(rho_kalman_update_position(&kalman, &measurement, 1e4f));
    note_failure_unless_ok(rho_kalman_update_range_rate(&kalman, NULL, 100.0f, 1.0f));
}

/* ---- a step with input estimation: a target's plot and clutter plots of one scan ---- */

static struct rho_input_config config;
static struct rho_input input;
static float before_mps[3], newest_mps[3];
static float seen[PLOTS][RHO_KALMAN_STATES];

static void estimate_state(void)
{
    struct rho_kalman estimate;
    rho_input_decide(&input, &config);
    rho_input_estimate(&input, &estimate);
    memcpy(before_mps, newest_mps, sizeof before_mps);
    memcpy(newest_mps, &estimate.state[3], sizeof newest_mps);
}

static void update_input_filter_by_plot(const float plot[RHO_KALMAN_STATES])
{
    for (int i = 0; i < RHO_KALMAN_STATES; i++) {
        note_failure_unless_ok(rho_input_update_element(&input, &config, i, plot[i], 1.0f));
    }
}

static void step_input_filter(void)
{
    struct rho_gate_hough hough;
    int best = 0;
    note_failure_unless_ok(rho_input_predict(&input, &config, 0.25f));
    note_failure_unless_ok(
        rho_gate_hough_init(&hough, RHO_GATE_PLANE_XY | RHO_GATE_PLANE_XZ | RHO_GATE_PLANE_YZ,
                            0.0872664626f, before_mps, newest_mps));
    float least = rho_gate_hough_distance_mps(&hough, &seen[0][3]);
    for (int i = 1; i < PLOTS; i++) {
        float off = rho_gate_hough_distance_mps(&hough, &seen[i][3]);
        if (off < least) {
            least = off;
            best = i;
        }
    }
    update_input_filter_by_plot(seen[best]);
    estimate_state();
}

/* Starts the filter with three scans; the last begins a turn, so that all axes have an input. */
static void start_input_filter(void)
{
    rho_input_config_default(&config);
    rho_kalman_init(&kalman);
    for (int axis = 0; axis < 3; axis++) {
        note_failure_unless_ok(rho_kalman_open_axis(&kalman, axis, 100.0f, 500.0f, 500.0f));
    }
    note_failure_unless_ok(rho_input_start(&input, &config, &kalman));
    for (int scan = 1; scan <= 4; scan++) {
        float speed_mps = scan < 3 ? 0.0f : 20.0f * (float)(scan - 2);
        for (int i = 0; i < RHO_KALMAN_STATES; i++) {
            seen[0][i] = i < 3 ? 100.0f : speed_mps;
            for (int k = 1; k < PLOTS; k++) {
                seen[k][i] = seen[0][i] + draw_uniform(500.0f, 2000.0f);
            }
        }
        if (scan < 4) {
            note_failure_unless_ok(rho_input_predict(&input, &config, 0.25f));
            update_input_filter_by_plot(seen[0]);
            estimate_state();
        }
    }
    failed |= input.present != 7;
}

/* ---- jobs ---- */

static void prepare_filter_of_job(const char *job)
{
    if (strcmp(job, "input+hough") == 0) {
        start_input_filter();
        return;
    }
    prepare_filter_and_measurement(100.0f);
    if (strcmp(job, "coupled+6") == 0) {
        step_by_polar_plot();
    }
}

__attribute__((noinline)) static void run_step_of_job(const char *job)
{
    if (strcmp(job, "input+hough") == 0) {
        step_input_filter();
    } else if (strcmp(job, "predict+polar") == 0) {
        step_by_polar_plot();
    } else {
        predict_and_update_elements(job[strlen(job) - 1] - '0');
    }
}

int main(int argc, char **argv)
{
    static const char *const names[] = {"predict+3", "predict+6", "coupled+6", "predict+polar",
                                        "input+hough"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (argc == 2 && strcmp(argv[1], names[i]) == 0) {
            for (int k = 0; k < STEPS; k++) {
                prepare_filter_of_job(names[i]);
                count_begin();
                run_step_of_job(names[i]);
                count_end();
            }
            printf("\n");
            count_print_totals();
            return failed;
        }
    }
    fprintf(stderr, "filters: no such job\n");
    return 2;
}
