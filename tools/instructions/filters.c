/* SPDX-License-Identifier: MIT */
/*
 * filters: one step of a Kalman filter, or of the literature's filter with its gate, for
 * tools/gates/instructions.sh to count the instructions of. Argument: predict+3, predict+6 (updates
 * of an element each), coupled+6 (the same where a polar plot has coupled the axes), predict+polar,
 * input+hough.
 */
#include <string.h>

#include "count.h"
#include "random_draws.h"
#include "rhotrack/detail/gate.h"
#include "rhotrack/detail/input_estimation.h"
#include "rhotrack/detail/kalman.h"
#include "rhotrack/detail/measurement.h"

#define STEPS 20
#define PLOTS 5 /* the target's is the first */

static struct rho_kalman kalman;
static struct rho_measurement measurement;
static int failed;

static void must_be_ok(enum rho_status status)
{
    if (status != RHO_OK) {
        fprintf(stderr, "filters: %s\n", rho_status_name(status));
        failed = 1;
    }
}

/* ---- a step with updates ---- */

static void open_filter(float variance)
{
    static const struct rho_plot plot = {.x_m = 30000.0f,
                                         .y_m = 20000.0f,
                                         .z_m = 3000.0f,
                                         .sigma_range_m = 15.0f,
                                         .sigma_cross_m = 110.0f,
                                         .sigma_up_m = 110.0f};
    rho_kalman_init(&kalman);
    for (int axis = 0; axis < 3; axis++) {
        must_be_ok(rho_kalman_open_axis(&kalman, axis, 100.0f, variance, 1e4f));
    }
    rho_measurement_from_plot(&plot, RHO_MEASURES_Z, NULL, &measurement);
}

static void update_axes(int updates)
{
    must_be_ok(rho_kalman_predict(&kalman, 1.0f, 1.0f));
    for (int i = 0; i < updates; i++) {
        must_be_ok(rho_kalman_update(&kalman, i, 100.0f, 100.0f, NULL));
    }
}

static void update_polar(void)
{
    must_be_ok(rho_kalman_predict(&kalman, 1.0f, 1.0f));
    must_be_ok(rho_kalman_update_position(&kalman, &measurement, 1e4f));
    must_be_ok(rho_kalman_update_range_rate(&kalman, NULL, 100.0f, 1.0f));
}

/* ---- the literature's step: target and clutter of one scan ---- */

static struct rho_input_config config;
static struct rho_input input;
static float before_mps[3], newest_mps[3];
static float seen[PLOTS][RHO_KALMAN_STATES];

static void estimate_input(void)
{
    struct rho_kalman estimate;
    rho_input_decide_presence(&input, &config);
    rho_input_estimate(&input, &estimate);
    memcpy(before_mps, newest_mps, sizeof before_mps);
    memcpy(newest_mps, &estimate.state[3], sizeof newest_mps);
}

static void update_input(const float plot[RHO_KALMAN_STATES])
{
    for (int i = 0; i < RHO_KALMAN_STATES; i++) {
        must_be_ok(rho_input_update(&input, &config, i, plot[i], 1.0f));
    }
}

static void step_input(void)
{
    struct rho_gate_hough hough;
    int best = 0;
    must_be_ok(rho_input_predict(&input, &config, 0.25f));
    must_be_ok(rho_gate_hough_init(&hough,
                                   RHO_GATE_PLANE_XY | RHO_GATE_PLANE_XZ | RHO_GATE_PLANE_YZ,
                                   0.0872664626f, before_mps, newest_mps));
    float least = rho_gate_hough_residual_mps(&hough, &seen[0][3]);
    for (int i = 1; i < PLOTS; i++) {
        float off = rho_gate_hough_residual_mps(&hough, &seen[i][3]);
        if (off < least) {
            least = off;
            best = i;
        }
    }
    update_input(seen[best]);
    estimate_input();
}

/* Three scans, of which the last begins a turn on all axes: the inputs of all three are present. */
static void open_input(void)
{
    rho_input_config_default(&config);
    rho_kalman_init(&kalman);
    for (int axis = 0; axis < 3; axis++) {
        must_be_ok(rho_kalman_open_axis(&kalman, axis, 100.0f, 500.0f, 500.0f));
    }
    must_be_ok(rho_input_start(&input, &config, &kalman));
    for (int scan = 1; scan <= 4; scan++) {
        float speed_mps = scan < 3 ? 0.0f : 20.0f * (float)(scan - 2);
        for (int i = 0; i < RHO_KALMAN_STATES; i++) {
            seen[0][i] = i < 3 ? 100.0f : speed_mps;
            for (int k = 1; k < PLOTS; k++) {
                seen[k][i] = seen[0][i] + draw_uniform(500.0f, 2000.0f);
            }
        }
        if (scan < 4) {
            must_be_ok(rho_input_predict(&input, &config, 0.25f));
            update_input(seen[0]);
            estimate_input();
        }
    }
    failed |= input.present != 7;
}

/* ---- jobs ---- */

static void open_job_filter(const char *name)
{
    if (strcmp(name, "input+hough") == 0) {
        open_input();
        return;
    }
    open_filter(100.0f);
    if (strcmp(name, "coupled+6") == 0) {
        update_polar();
    }
}

__attribute__((noinline)) static void step(const char *name)
{
    if (strcmp(name, "input+hough") == 0) {
        step_input();
    } else if (strcmp(name, "predict+polar") == 0) {
        update_polar();
    } else {
        update_axes(name[strlen(name) - 1] - '0');
    }
}

int main(int argc, char **argv)
{
    static const char *const names[] = {"predict+3", "predict+6", "coupled+6", "predict+polar",
                                        "input+hough"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (argc == 2 && strcmp(argv[1], names[i]) == 0) {
            for (int k = 0; k < STEPS; k++) {
                open_job_filter(names[i]);
                count_begin();
                step(names[i]);
                count_end();
            }
            printf("\n");
            count_report();
            return failed;
        }
    }
    fprintf(stderr, "filters: no such job\n");
    return 2;
}
