/* SPDX-License-Identifier: MIT */
#include "scenario_plots.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"

/* ---- plans ----------------------------------------------------------------------------------- */

struct truth_point *plan_truth(const struct scenario_plan *plan, size_t scan, size_t target)
{
    return &plan->truth[scan * plan->num_targets + target];
}

struct scenario_plan plan_allocate(size_t num_targets, size_t num_scans, double interval_s)
{
    struct scenario_plan plan = {.num_scans = num_scans,
                                 .num_targets = num_targets,
                                 .num_identities = num_targets,
                                 .interval_s = interval_s,
                                 .pd = 1.0};
    plan.truth = must_calloc(num_scans * num_targets + 1, sizeof *plan.truth);
    for (size_t scan = 0; scan < num_scans; scan++) {
        for (size_t target = 0; target < num_targets; target++) {
            struct truth_point *point = plan_truth(&plan, scan, target);
            point->t_s = (double)scan * interval_s;
            point->target_id = (int)target;
        }
    }
    return plan;
}

void plan_free(struct scenario_plan *plan)
{
    free(plan->truth);
    plan->truth = NULL;
}

struct scenario_box plan_box_of_parameters(const struct parameters *parameters)
{
    return (struct scenario_box){.x_min_m = parameters->value[PARAMETER_AREA_X_MIN_M],
                                 .x_max_m = parameters->value[PARAMETER_AREA_X_MAX_M],
                                 .y_min_m = parameters->value[PARAMETER_AREA_Y_MIN_M],
                                 .y_max_m = parameters->value[PARAMETER_AREA_Y_MAX_M]};
}

bool plan_box_holds(const struct scenario_box *box, double x_m, double y_m)
{
    return x_m >= box->x_min_m && x_m <= box->x_max_m && y_m >= box->y_min_m && y_m <= box->y_max_m;
}

void plan_set_truth(const struct scenario_plan *plan, size_t scan, size_t target,
                    struct scenario_state state)
{
    struct truth_point *point = plan_truth(plan, scan, target);
    point->x_m = state.x_m;
    point->y_m = state.y_m;
    point->vx_mps = state.vx_mps;
    point->vy_mps = state.vy_mps;
}

#define BOX_MARGIN_M 500.0

/*
 * Grows the box of the clutter around all true positions, unless the user set the area; targets of
 * longer or wider runs than the customary one would leave it.
 */
void plan_grow_clutter_box(struct scenario_plan *plan, const struct parameters *parameters)
{
    if (parameters->source[PARAMETER_AREA_X_MIN_M] > SOURCE_METHOD) {
        return;
    }
    for (size_t i = 0; i < plan->num_scans * plan->num_targets; i++) {
        const struct truth_point *point = &plan->truth[i];
        if (!plan_box_holds(&plan->box, point->x_m, point->y_m)) {
            plan->box.x_min_m = fmin(plan->box.x_min_m, point->x_m - BOX_MARGIN_M);
            plan->box.x_max_m = fmax(plan->box.x_max_m, point->x_m + BOX_MARGIN_M);
            plan->box.y_min_m = fmin(plan->box.y_min_m, point->y_m - BOX_MARGIN_M);
            plan->box.y_max_m = fmax(plan->box.y_max_m, point->y_m + BOX_MARGIN_M);
        }
    }
}

/* Of the density per km2 and the number per scan, the one from the stronger source counts. */
double plan_clutter_mean(const struct parameters *parameters, const struct scenario_box *box)
{
    double area_km2 = (box->x_max_m - box->x_min_m) * (box->y_max_m - box->y_min_m) * 1e-6;
    if (parameters->source[PARAMETER_CLUTTER_PER_KM2] >
        parameters->source[PARAMETER_CLUTTER_PER_SCAN]) {
        return parameters->value[PARAMETER_CLUTTER_PER_KM2] * area_km2;
    }
    return parameters->value[PARAMETER_CLUTTER_PER_SCAN];
}

/* ---- paths ----------------------------------------------------------------------------------- */

void plan_set_straight_path(struct scenario_plan *plan, size_t target, struct scenario_state start)
{
    for (size_t scan = 0; scan < plan->num_scans; scan++) {
        double t_s = (double)scan * plan->interval_s;
        struct scenario_state now = start;
        now.x_m += start.vx_mps * t_s;
        now.y_m += start.vy_mps * t_s;
        plan_set_truth(plan, scan, target, now);
    }
}

/* ---- plots ----------------------------------------------------------------------------------- */

void plan_add_clutter(struct simulated_scan *scan, const struct scenario_box *box, uint64_t count,
                      struct random *random)
{
    for (uint64_t i = 0; i < count; i++) {
        struct simulated_plot *plot = &scan->plots[scan->num_plots++];
        plot->x_m = random_between(random, box->x_min_m, box->x_max_m);
        plot->y_m = random_between(random, box->y_min_m, box->y_max_m);
        plot->target_id = -1;
    }
}

static void add_plot_if_detected(const struct scenario_plan *plan, struct simulated_scan *scan,
                                 const struct truth_point *truth, double pd, struct random *random)
{
    bool is_seen = random_uniform(random) < pd;
    double noise_x_m = plan->noise_m * random_normal(random);
    double noise_y_m = plan->noise_m * random_normal(random);
    if (is_seen) {
        scan->plots[scan->num_plots++] = (struct simulated_plot){.x_m = truth->x_m + noise_x_m,
                                                                 .y_m = truth->y_m + noise_y_m,
                                                                 .target_id = truth->target_id};
    }
}

void plan_shuffle_plots(struct simulated_scan *scan, struct random *random)
{
    for (size_t i = scan->num_plots; i > 1; i--) {
        size_t j = random_below(random, i);
        struct simulated_plot swapped = scan->plots[i - 1];
        scan->plots[i - 1] = scan->plots[j];
        scan->plots[j] = swapped;
    }
}

/* True if there are two targets closer than merge_m; either may then give one plot between them. */
static bool add_merged_plot(const struct scenario_plan *plan, struct simulated_scan *scan,
                            const struct truth_point *truth, struct random *random)
{
    struct truth_point middle = truth[0];

    if (plan->num_targets != 2 ||
        hypot(truth[0].x_m - truth[1].x_m, truth[0].y_m - truth[1].y_m) >= plan->merge_m) {
        return false;
    }
    middle.x_m = 0.5 * (truth[0].x_m + truth[1].x_m);
    middle.y_m = 0.5 * (truth[0].y_m + truth[1].y_m);
    add_plot_if_detected(plan, scan, &middle, 1.0 - (1.0 - plan->pd) * (1.0 - plan->pd), random);
    return true;
}

static void simulate_scan(const struct scenario_plan *plan, size_t index,
                          struct simulated_scan *scan, struct random *random)
{
    uint64_t num_clutter = random_poisson(random, plan->clutter_mean);
    uint64_t num_spot = random_poisson(random, plan->spot_mean);
    scan->t_s = (double)index * plan->interval_s;
    scan->plots = must_calloc(plan->num_targets + num_clutter + num_spot + 1, sizeof *scan->plots);
    if (!add_merged_plot(plan, scan, plan_truth(plan, index, 0), random)) {
        for (size_t target = 0; target < plan->num_targets; target++) {
            add_plot_if_detected(plan, scan, plan_truth(plan, index, target), plan->pd, random);
        }
    }
    plan_add_clutter(scan, &plan->box, num_clutter, random);
    plan_add_clutter(scan, &plan->spot, num_spot, random);
    plan_shuffle_plots(scan, random);
}

struct simulation *plan_simulate(const struct scenario_plan *plan, struct random *random)
{
    struct simulation *simulation = must_calloc(1, sizeof *simulation);
    simulation->num_scans = plan->num_scans;
    simulation->num_targets = plan->num_identities;
    simulation->targets_a_scan = plan->num_targets;
    simulation->num_truth = plan->num_scans * plan->num_targets;
    simulation->sigma_m = plan->sigma_m;
    simulation->area = plan->box;
    simulation->interval_s = plan->interval_s;
    simulation->passive = plan->passive;
    simulation->num_looks = plan->num_scans * plan->passive.num_sensors;
    simulation->looks = must_calloc(simulation->num_looks + 1, sizeof *simulation->looks);
    simulation->scans = must_calloc(plan->num_scans, sizeof *simulation->scans);
    simulation->truth = must_calloc(simulation->num_truth + 1, sizeof *simulation->truth);
    memcpy(simulation->truth, plan->truth, simulation->num_truth * sizeof *simulation->truth);
    for (size_t scan = 0; scan < plan->num_scans; scan++) {
        if (plan->passive.is_used) {
            size_t first = scan * plan->passive.num_sensors;
            simulation->scans[scan].t_s = (double)scan * plan->interval_s;
            plan_simulate_looks(plan, scan, &simulation->looks[first], random);
        } else {
            simulate_scan(plan, scan, &simulation->scans[scan], random);
        }
    }
    return simulation;
}

void simulation_free(struct simulation *simulation)
{
    for (size_t scan = 0; scan < simulation->num_scans; scan++) {
        free(simulation->scans[scan].plots);
    }
    for (size_t look = 0; look < simulation->num_looks; look++) {
        free(simulation->looks[look].bearings);
    }
    free(simulation->looks);
    free(simulation->scans);
    free(simulation->truth);
    free(simulation);
}
