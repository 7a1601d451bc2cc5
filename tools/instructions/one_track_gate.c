/* SPDX-License-Identifier: MIT */
/*
 * one_track_gate: a step of one track alone; tools/gates/instructions.sh counts its
 * instructions. The step is prediction, gating of all plots and the update with the chosen plot,
 * without assignment, life cycle and report.
 *
 * Arguments: the gate, nearest or hough (with input estimation); polar or cartesian; the number of
 * plots, including the target's own. Prints the mean number of plots in the gate per step.
 */
#include <stdlib.h>
#include <string.h>

#include "count.h"
#include "rhotrack/detail/gate.h"
#include "rhotrack/detail/track.h"
#include "scene.h"

#define START_STEPS 6
#define STEPS 100 /* a mean over 100 steps has two decimals */
#define PLOTS_MAX 10
#define SPEED_SIGMA_MPS 700.0f
#define NOISE_DENSITY 25.0f

static struct rho_track track;
static struct rho_input_config input;
static struct rho_track_model model = {.speed_sigma_mps = SPEED_SIGMA_MPS,
                                       .noise_density = NOISE_DENSITY};
static struct rho_track_plot plots[PLOTS_MAX];
static int num_plots, num_in_gate;

static void draw_plots(int step, int is_polar, int count)
{
    struct target target = target_at(0, INTERVAL_S * (float)step);
    num_plots = count;
    for (int i = 0; i < count; i++) {
        plots[i] = (struct rho_track_plot){.time_us = (int64_t)(1e6f * INTERVAL_S) * step,
                                           .measures = measured_quantities_of(is_polar),
                                           .sensor_id = sensor.sensor_id,
                                           .sensor = &sensor,
                                           .plot = draw_plot(&target, is_polar, i > 0),
                                           .row = (int16_t)i};
    }
}

/* The plot in the gate that is likeliest or, by the Hough gate, bends the velocity's line least. */
static int choose_plot_in_gate(int by_hough_gate)
{
    struct rho_kalman expected;
    struct rho_gate gate;
    struct rho_gate_hough hough;
    struct rho_gate_result result;
    float least = 1e9f;
    int best = 0;
    rho_track_estimate_for_gate(&track, &expected);
    rho_gate_open(&gate, &expected, model.input ? input.noise_density : NOISE_DENSITY, &sensor,
                  plots[0].measures);
    if (by_hough_gate) {
        failed |=
            rho_gate_hough_init(&hough, RHO_GATE_PLANE_XY | RHO_GATE_PLANE_XZ | RHO_GATE_PLANE_YZ,
                                0.0872664626f, track.before_mps, track.newest_mps) != RHO_OK;
    }
    for (int i = 0; i < num_plots; i++) {
        const struct rho_plot *plot = &plots[i].plot;
        if (rho_gate_test(&gate, plot, &result)) {
            const float velocity_mps[3] = {plot->vx_mps, plot->vy_mps, plot->vz_mps};
            float cost = by_hough_gate ? rho_gate_hough_distance_mps(&hough, velocity_mps)
                                       : result.distance2 + result.log_det;
            num_in_gate++;
            if (cost < least) {
                least = cost;
                best = i;
            }
        }
    }
    return best;
}

static void predict_and_update_track(int by_hough_gate)
{
    failed |= rho_track_predict(&track, plots[0].time_us, &model) != RHO_OK;
    failed |= rho_track_update_by_plot(&track, &plots[choose_plot_in_gate(by_hough_gate)], &model,
                                       1000) != RHO_OK;
}

int main(int argc, char **argv)
{
    int count = argc == 4 ? atoi(argv[3]) : 0;
    if (count < 1 || count > PLOTS_MAX) {
        fprintf(stderr, "track: give nearest or hough, polar or cartesian, 1 .. %d plots\n",
                PLOTS_MAX);
        return 2;
    }
    int by_hough = strcmp(argv[1], "hough") == 0, is_polar = strcmp(argv[2], "polar") == 0;
    rho_input_config_default(&input);
    model.input = by_hough ? &input : NULL;
    draw_plots(0, is_polar, 1);
    failed |= rho_track_start(&track, 1, plots, 1, &model, 0) != RHO_OK;
    for (int i = 1; i <= START_STEPS + STEPS && !failed; i++) {
        int is_start = i <= START_STEPS;
        draw_plots(i, is_polar, is_start ? 1 : count);
        if (is_start) {
            predict_and_update_track(0);
            num_in_gate = 0;
            continue;
        }
        count_begin();
        predict_and_update_track(by_hough);
        count_end();
    }
    printf("%d.%02d plots in the gate\n", num_in_gate / STEPS, num_in_gate % STEPS);
    count_print_totals();
    return failed;
}
