/* SPDX-License-Identifier: MIT */
/*
 * one_track_hypotheses: the step of one track by hypotheses, the default gate;
 * tools/gates/instructions.sh counts its instructions. The target flies straight, clutter is
 * uniform in its gate, and each scan has the same number of plots.
 *
 * Arguments: plots in the gate, including the target's; 0 for isotropic noise, 1 for noise along a
 * line of sight. Prints the mean numbers of hypotheses and of plots in a gate per scan.
 */
#include <stdlib.h>

#include "count.h"
#include "random_draws.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/hypotheses.h"

#define SCANS 100 /* a mean over 100 scans has two decimals */
#define PLOTS_MAX 32
#define INTERVAL_US 250000
#define SIGMA_M 10.0f
#define GATE_M 85.0f /* 5.5 standard deviations of the innovation */
#define PD 0.9f

static struct rho_hypotheses pool;
static struct rho_plot plots[PLOTS_MAX];
static struct rho_hypotheses_clutter clutter;
static struct rho_hypotheses_estimate estimate;
static uint16_t slot;
static float log_pd, log_miss; /* log P_D and log(1 - P_D), as the tracker computes once a scan */
static int num_plots, num_in_gate, num_hypotheses;

static void draw_in_ball(float radius, float out[3])
{
    float size2;
    do {
        size2 = 0.0f;
        for (int i = 0; i < 3; i++) {
            out[i] = draw_uniform(-1.0f, 1.0f);
            size2 += out[i] * out[i];
        }
    } while (size2 > 1.0f);
    for (int i = 0; i < 3; i++) {
        out[i] *= radius;
    }
}

static void draw_target_and_clutter_plots(int scan, float sigma_cross_m)
{
    const float t_s = 0.25f * (float)scan;
    const float target_m[3] = {50000.0f - 600.0f * t_s, 35000.0f - 500.0f * t_s, 300.0f};
    for (int i = 0; i < num_plots; i++) {
        float off_m[3] = {0.0f, 0.0f, 0.0f};
        for (int axis = 0; i == 0 && axis < 3; axis++) {
            off_m[axis] = draw_normal(SIGMA_M);
        }
        if (i > 0) {
            draw_in_ball(GATE_M, off_m);
        }
        plots[i] = (struct rho_plot){.x_m = target_m[0] + off_m[0],
                                     .y_m = target_m[1] + off_m[1],
                                     .z_m = target_m[2] + off_m[2],
                                     .sigma_range_m = SIGMA_M,
                                     .sigma_cross_m = sigma_cross_m,
                                     .sigma_up_m = sigma_cross_m};
    }
}

/* Runs a whole step, from the prediction to the reported estimate; 0 when all calls succeed. */
static int failed_to_step_hypotheses(int64_t time_us)
{
    const struct rho_hypotheses_scan scan = {
        .time_us = time_us, .measures = RHO_MEASURES_Z, .plots = plots, .log_miss = log_miss};
    struct rho_hypotheses_box reach;
    struct rho_hypotheses_outcome outcome;
    struct rho_imm_plot seen;
    float gain_nat;
    int failed = rho_hypotheses_predict(&pool, slot, time_us) != RHO_OK;
    rho_hypotheses_gate_box(&pool, slot, &reach);
    for (int i = 0; i < num_plots; i++) {
        if (rho_hypotheses_is_in_box(&pool, slot, &reach, &plots[i], RHO_MEASURES_Z)) {
            rho_imm_prepare_plot(&seen, &plots[i], RHO_MEASURES_Z, NULL);
            num_in_gate += rho_hypotheses_score_plot(&pool, slot, &seen, time_us, (int16_t)i,
                                                     log_pd, &clutter, &gain_nat);
        }
    }
    failed |= rho_hypotheses_commit(&pool, slot, &scan, &outcome) != RHO_OK;
    return failed | (rho_hypotheses_estimate(&pool, slot, time_us, &estimate) != RHO_OK);
}

static int failed_to_start_hypotheses(void)
{
    const float place_m[3] = {50000.0f, 35000.0f, 300.0f}, speed_mps[3] = {-600.0f, -500.0f, 0.0f};
    struct rho_imm_model model;
    struct rho_kalman kalman;
    int failed = 0;
    rho_kalman_init(&kalman);
    for (int axis = 0; axis < 3; axis++) {
        failed |= rho_kalman_open_axis(&kalman, axis, place_m[axis], SIGMA_M * SIGMA_M, 1e4f);
        kalman.state[3 + axis] = speed_mps[axis];
    }
    rho_imm_model_default(&model, 118.0f, 1000.0f);
    failed |= rho_hypotheses_init(&pool, sizeof pool, &model);
    return failed | (rho_hypotheses_open(&pool, &kalman, 0, &slot) != RHO_OK);
}

int main(int argc, char **argv)
{
    num_plots = argc == 3 ? atoi(argv[1]) : 0;
    if (num_plots < 1 || num_plots > PLOTS_MAX) {
        fprintf(stderr, "one_track_hypotheses: give 1 .. %d plots, and 0 or 1\n", PLOTS_MAX);
        return 2;
    }
    const float volume_m3 = 4.0f / 3.0f * RHO_PI * GATE_M * GATE_M * GATE_M;
    clutter.log_per_m2 = rho_log((num_plots > 1 ? (float)num_plots - 1.0f : 0.1f) / volume_m3);
    log_pd = rho_log(PD);
    log_miss = rho_log(1.0f - PD);
    int failed = failed_to_start_hypotheses();
    for (int scan = 1; scan <= SCANS && !failed; scan++) {
        draw_target_and_clutter_plots(scan, atoi(argv[2]) ? 1.2f * SIGMA_M : SIGMA_M);
        count_begin();
        failed |= failed_to_step_hypotheses((int64_t)INTERVAL_US * scan);
        count_end();
        num_hypotheses += (int)rho_hypotheses_count(&pool, slot);
    }
    printf("%d.%02d hypotheses, %d.%02d plots in the gate\n", num_hypotheses / SCANS,
           num_hypotheses % SCANS, num_in_gate / SCANS, num_in_gate % SCANS);
    count_print_totals();
    return failed;
}
