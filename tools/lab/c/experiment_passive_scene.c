/* SPDX-License-Identifier: MIT */
/*
 * The scenes of the passive experiment: the passive scenarios' chance, with targets elsewhere and
 * other times.
 */
#include <math.h>
#include <string.h>

#include "base/common.h"
#include "experiment_passive.h"
#include "lab_input.h"
#include "pipeline/pipeline.h"

#define PI 3.141592653589793
#define DEG_RAD (PI / 180.0)

static const struct scenario_region regions[] = {
    [PASSIVE_EXTENSION] = {.x_min_m = -1500.0,
                           .x_max_m = 1500.0,
                           .y_min_m = 25000.0,
                           .y_max_m = 60000.0,
                           .is_on_both_sides = true,
                           .end_x_min_m = -INFINITY},
    [PASSIVE_NEAR] = {.x_min_m = 15000.0,
                      .x_max_m = 35000.0,
                      .y_min_m = -15000.0,
                      .y_max_m = 15000.0,
                      .end_x_min_m = 2000.0},
};

/* ---- drawing --------------------------------------------------------------------------------- */

static void draw_times(struct passive_scene *scene, struct random *random)
{
    for (size_t scan = 1; scan < PASSIVE_SCANS; scan++) {
        double share = scene->of->has_unequal_intervals ? random_between(random, 0.3, 1.7) : 1.0;
        scene->times_s[scan] = scene->times_s[scan - 1] + share * PASSIVE_INTERVAL_S;
    }
}

/* The plan's scans come at equal intervals within the same time. */
static struct parameters parameters_of(const struct passive_scene *scene)
{
    const struct passive_setting *of = scene->of;
    struct parameters parameters;
    parameters_default(&parameters);
    suggest_passive(&parameters);
    parameters_suggest(&parameters, PARAMETER_NUM_SCANS, PASSIVE_SCANS);
    parameters_suggest(&parameters, PARAMETER_INTERVAL_S,
                       scene->times_s[PASSIVE_SCANS - 1] / (PASSIVE_SCANS - 1));
    parameters_suggest(&parameters, PARAMETER_SIGMA_RAD, of->sigma_deg * DEG_RAD);
    return parameters;
}

static void move_to_own_times(struct passive_scene *scene)
{
    for (size_t target = 0; target < scene->plan.num_targets; target++) {
        struct truth_point start = *plan_truth(&scene->plan, 0, target);
        for (size_t scan = 1; scan < PASSIVE_SCANS; scan++) {
            struct truth_point *point = plan_truth(&scene->plan, scan, target);
            point->t_s = scene->times_s[scan];
            point->x_m = start.x_m + start.vx_mps * scene->times_s[scan];
            point->y_m = start.y_m + start.vy_mps * scene->times_s[scan];
        }
    }
}

struct passive_scene passive_scene_draw(const struct passive_setting *of, struct random *random)
{
    struct passive_scene scene = {.of = of};
    draw_times(&scene, random);
    struct parameters parameters = parameters_of(&scene);
    const struct scenario_region *region =
        of->region == PASSIVE_AHEAD ? &scenario_ahead : &regions[of->region];
    const struct scenario_bearings drawn = {
        .num_sensors = of->sensors, .num_targets = of->targets, .false_mean = of->false_mean};
    scene.plan = plan_passive(region, &drawn, &parameters, random);
    scene.plan.pd = of->pd;
    move_to_own_times(&scene);
    scene.simulation = plan_simulate(&scene.plan, random);
    return scene;
}

void passive_scene_free(struct passive_scene *scene)
{
    simulation_free(scene->simulation);
    plan_free(&scene->plan);
}

/* ---- what is in it --------------------------------------------------------------------------- */

struct truth_point passive_truth(const struct passive_scene *scene, size_t target, double t_s)
{
    struct truth_point truth = *plan_truth(&scene->plan, 0, target);
    truth.t_s = t_s;
    truth.x_m += truth.vx_mps * t_s;
    truth.y_m += truth.vy_mps * t_s;
    return truth;
}

double passive_middle_s(const struct passive_scene *scene)
{
    return 0.5 * (scene->times_s[0] + scene->times_s[PASSIVE_SCANS - 1]);
}

const struct simulated_look *passive_look(const struct passive_scene *scene, size_t scan,
                                          size_t sensor)
{
    return &scene->simulation->looks[scan * scene->of->sensors + sensor];
}

void passive_frame_fill(struct passive_frame *frame, const struct passive_scene *scene, size_t scan,
                        unsigned sensors)
{
    memset(frame, 0, sizeof *frame);
    memset(frame->fates, RHO_FATE_HELD, sizeof frame->fates);
    frame->frame.time_us = llround(scene->times_s[scan] * 1e6);
    frame->frame.scans = frame->scans;
    for (size_t sensor = 0; sensor < scene->of->sensors; sensor++) {
        const struct simulated_look *look = passive_look(scene, scan, sensor);
        if ((sensors >> sensor & 1u) == 0) {
            continue;
        }
        struct rho_bearing_scan *own = &frame->scans[frame->frame.num_scans++];
        *own = lab_look(&scene->plan.passive, look, frame->bearings[sensor], PASSIVE_LOOK_MAX);
        own->time_us = frame->frame.time_us;
    }
}

/* ---- lines ----------------------------------------------------------------------------------- */

struct passive_line passive_line_of(double x_m, double y_m, double vx_mps, double vy_mps)
{
    double theta_rad = atan2(vx_mps, -vy_mps);
    theta_rad += theta_rad < 0.0 ? PI : 0.0;
    return (struct passive_line){x_m * cos(theta_rad) + y_m * sin(theta_rad), theta_rad};
}

struct passive_line passive_line_off(const struct passive_line *a, const struct passive_line *b)
{
    double theta_rad = fabs(a->theta_rad - b->theta_rad);
    bool is_turned = theta_rad > PI / 2.0;
    return (struct passive_line){
        .rho_m = is_turned ? fabs(a->rho_m + b->rho_m) : fabs(a->rho_m - b->rho_m),
        .theta_rad = is_turned ? PI - theta_rad : theta_rad,
    };
}

/* ---- crossings ------------------------------------------------------------------------------- */

static size_t bearings_of(const struct simulated_look *look, float bearings_rad[RHO_MAX_BEARINGS])
{
    size_t count = look->num_bearings < RHO_MAX_BEARINGS ? look->num_bearings : RHO_MAX_BEARINGS;
    for (size_t i = 0; i < count; i++) {
        bearings_rad[i] = (float)look->bearings[i].bearing_rad;
    }
    return count;
}

struct rho_crossing_base passive_base(const struct passive_scene *scene, size_t a, size_t b)
{
    struct rho_crossing_base base;
    must_succeed(rho_crossing_set_base(&base, (float)scene->plan.passive.sensors[a].x_m,
                                       (float)scene->plan.passive.sensors[a].y_m,
                                       (float)scene->plan.passive.sensors[b].x_m,
                                       (float)scene->plan.passive.sensors[b].y_m),
                 "crossing");
    return base;
}

struct rho_ghost_matrix passive_matrix(const struct passive_scene *scene, size_t scan, size_t a,
                                       size_t b, enum rho_ghost_rule rule)
{
    float bearings_a_rad[RHO_MAX_BEARINGS], bearings_b_rad[RHO_MAX_BEARINGS];
    size_t num_a = bearings_of(passive_look(scene, scan, a), bearings_a_rad);
    size_t num_b = bearings_of(passive_look(scene, scan, b), bearings_b_rad);
    struct rho_crossing_base base = passive_base(scene, a, b);
    struct rho_ghost_matrix matrix;
    must_succeed(rho_ghost_fill(&matrix, &base, bearings_a_rad, (unsigned)num_a, bearings_b_rad,
                                (unsigned)num_b, (float)PASSIVE_RANGE_MAX_M),
                 "ghost");
    rho_ghost_prune(&matrix, rule);
    return matrix;
}

bool passive_is_target(const struct passive_scene *scene, size_t scan, size_t a, size_t i, size_t b,
                       size_t j)
{
    int target = passive_look(scene, scan, a)->bearings[i].target_id;
    return target >= 0 && target == passive_look(scene, scan, b)->bearings[j].target_id;
}
