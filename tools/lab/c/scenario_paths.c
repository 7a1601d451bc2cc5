/* SPDX-License-Identifier: MIT */
/* scenario_paths: the paths of the targets of the named scenarios. */
#include <math.h>

#include "base/common.h"
#include "scenario_plots.h"

#define DEG_RAD 0.017453292519943295
#define PAIR_MPS 250.0
#define CROSSING_RAD (10.0 * DEG_RAD) /* angle between two crossing paths */

static size_t parameter_as_count(const struct parameters *parameters, enum parameter_id id)
{
    return (size_t)(parameters->value[id] + 0.5);
}

static struct scenario_plan start_plan_by_parameters(const struct parameters *parameters,
                                                     size_t num_targets)
{
    return plan_allocate(num_targets, parameter_as_count(parameters, PARAMETER_NUM_SCANS),
                         parameters->value[PARAMETER_INTERVAL_S]);
}

struct scenario_plan plan_crossing(const struct parameters *parameters, struct random *random)
{
    (void)random;
    struct scenario_plan plan = start_plan_by_parameters(parameters, 3);
    plan_set_straight_path(&plan, 0, (struct scenario_state){300, 280.0, 400, 49.0});
    plan_set_straight_path(&plan, 1, (struct scenario_state){3000, -173.2, 300, -100.0});
    plan_set_straight_path(&plan, 2, (struct scenario_state){2100, -173.2, 1300, -100.0});
    return plan;
}

struct scenario_plan plan_parallel(const struct parameters *parameters, struct random *random)
{
    (void)random;
    struct scenario_plan plan = start_plan_by_parameters(parameters, 2);
    plan_set_straight_path(&plan, 0, (struct scenario_state){-1500, PAIR_MPS, 0, 0});
    plan_set_straight_path(
        &plan, 1,
        (struct scenario_state){-1500, PAIR_MPS, parameters->value[PARAMETER_SPACING_M], 0});
    return plan;
}

/* Two targets that meet in the origin at half time. */
struct scenario_plan plan_pair_crossing_at_origin(const struct parameters *parameters,
                                                  struct random *random)
{
    (void)random;
    struct scenario_plan plan = start_plan_by_parameters(parameters, 2);
    double half_s = plan.interval_s * ((double)plan.num_scans - 1.0) / 2.0;
    for (size_t target = 0; target < 2; target++) {
        double heading_rad = CROSSING_RAD * (target == 0 ? 0.5 : -0.5);
        double vx_mps = PAIR_MPS * cos(heading_rad);
        double vy_mps = PAIR_MPS * sin(heading_rad);
        plan_set_straight_path(
            &plan, target,
            (struct scenario_state){-vx_mps * half_s, vx_mps, -vy_mps * half_s, vy_mps});
    }
    return plan;
}

/*
 * The state of one of two targets at t_s, on side 1 or -1 of their formation: parallel from join_s
 * to part_s, converging before and diverging after.
 */
static struct scenario_state formation_state_at(const struct parameters *parameters, double t_s,
                                                double join_s, double part_s, double side)
{
    double speed_mps = PAIR_MPS, angle_rad = CROSSING_RAD / 2.0;
    double before_s = fmax(0.0, join_s - t_s), after_s = fmax(0.0, t_s - part_s);
    double away_mps = speed_mps * sin(angle_rad), along_mps = speed_mps * cos(angle_rad);
    bool is_together = t_s >= join_s && t_s <= part_s;

    return (struct scenario_state){
        .x_m = speed_mps * (fmin(fmax(t_s, join_s), part_s) - join_s) +
               along_mps * (after_s - before_s),
        .vx_mps = is_together ? speed_mps : along_mps,
        .y_m =
            side * (parameters->value[PARAMETER_SPACING_M] / 2.0 + away_mps * (before_s + after_s)),
        .vy_mps = is_together    ? 0.0
                  : t_s < join_s ? -side * away_mps
                                 : side * away_mps,
    };
}

struct scenario_plan plan_formation(const struct parameters *parameters, struct random *random)
{
    (void)random;
    struct scenario_plan plan = start_plan_by_parameters(parameters, 2);
    double last_s = plan.interval_s * ((double)plan.num_scans - 1.0);
    for (size_t scan = 0; scan < plan.num_scans; scan++) {
        double t_s = plan.interval_s * (double)scan;
        for (size_t target = 0; target < 2; target++) {
            plan_set_truth(&plan, scan, target,
                           formation_state_at(parameters, t_s, 0.25 * last_s, 0.75 * last_s,
                                              target == 0 ? 1.0 : -1.0));
        }
    }
    return plan;
}

/*
 * Draws place, heading and speed until the whole straight path lies in the area; exit 2 after 10000
 * attempts.
 */
static struct scenario_state draw_straight_path_in_area(const struct parameters *parameters,
                                                        double duration_s, struct random *random)
{
    struct scenario_box box = plan_box_of_parameters(parameters);
    for (int i = 0; i < 10000; i++) {
        double speed_mps = random_between(random, parameters->value[PARAMETER_V_MIN_MPS],
                                          parameters->value[PARAMETER_V_MAX_MPS]);
        double heading_rad = random_between(random, 0.0, 360.0 * DEG_RAD);
        struct scenario_state state = {.x_m = random_between(random, box.x_min_m, box.x_max_m),
                                       .vx_mps = speed_mps * cos(heading_rad),
                                       .y_m = random_between(random, box.y_min_m, box.y_max_m),
                                       .vy_mps = speed_mps * sin(heading_rad)};
        if (plan_box_holds(&box, state.x_m + state.vx_mps * duration_s,
                           state.y_m + state.vy_mps * duration_s)) {
            return state;
        }
    }
    fail(EXIT_USAGE, "scenario traffic: no target can stay inside the area for the whole run; "
                     "take fewer scans or a larger area");
}

struct scenario_plan plan_traffic(const struct parameters *parameters, struct random *random)
{
    struct scenario_plan plan =
        start_plan_by_parameters(parameters, parameter_as_count(parameters, PARAMETER_TARGETS));
    double duration_s = plan.interval_s * ((double)plan.num_scans - 1.0);
    for (size_t target = 0; target < plan.num_targets; target++) {
        plan_set_straight_path(&plan, target,
                               draw_straight_path_in_area(parameters, duration_s, random));
    }
    return plan;
}
