/* SPDX-License-Identifier: MIT */
/* scenario_beam: one target that pulls, in a beam that follows it: plots with heights, clutter in the beam. */
#include <math.h>
#include <stdlib.h>

#include "common.h"
#include "scenario_plan.h"

#define G_MPS2 9.80665
#define DEG_RAD 0.017453292519943295
#define AXES 3

static const double start_m[AXES] = {50000.0, 35000.0, 300.0};
static const double start_mps[AXES] = {-600.0, -500.0, 0.0};

/* ---- accelerations ---------------------------------------------------------------------------- */

/* From one time until before another it pulls to this side. */
struct pull {
    double from_s, to_s;
    int side;
};

#define PULLS_MAX 4
static const struct pull pulls[][PULLS_MAX] = {
    [MANEUVER_POPUP] = {{10, 14, 1}, {18, 26, -1}, {30, 34, 1}},
    [MANEUVER_WEAVE] = {{8, 12, 1}, {12, 20, -1}, {20, 28, 1}, {28, 32, -1}},
    [MANEUVER_TURN] = {{8, 14, 1}, {16, 28, -1}, {30, 36, 1}},
};

static int side_at(enum scenario_maneuver maneuver, double t_s)
{
    const double just_s = 1e-9; /* times are rounded */
    for (int i = 0; i < PULLS_MAX; i++) {
        const struct pull *pull = &pulls[maneuver][i];
        if (t_s + just_s >= pull->from_s && t_s + just_s < pull->to_s) {
            return pull->side;
        }
    }
    return 0;
}

void plan_inputs(enum scenario_maneuver maneuver, double accel_mps2, double interval_s,
                 size_t num_scans, double (*inputs_mps2)[3])
{
    double speed_mps = hypot(start_mps[0], start_mps[1]);
    double heading_rad = atan2(start_mps[1], start_mps[0]);
    for (size_t k = 0; k + 1 < num_scans; k++) {
        double pull_mps2 = accel_mps2 * side_at(maneuver, (double)k * interval_s);
        bool is_up = maneuver == MANEUVER_POPUP;
        inputs_mps2[k][0] = is_up ? 0.0 : -pull_mps2 * sin(heading_rad);
        inputs_mps2[k][1] = is_up ? 0.0 : pull_mps2 * cos(heading_rad);
        inputs_mps2[k][2] = is_up ? pull_mps2 : 0.0;
        if (maneuver == MANEUVER_TURN) {
            heading_rad += pull_mps2 / speed_mps * interval_s;
        }
    }
}

/* ---- paths ------------------------------------------------------------------------------------ */

struct beam_state {
    double place_m[AXES], velocity_mps[AXES];
};

static void put(struct truth_point *point, const struct beam_state *state)
{
    point->x_m = state->place_m[0];
    point->y_m = state->place_m[1];
    point->z_m = state->place_m[2];
    point->vx_mps = state->velocity_mps[0];
    point->vy_mps = state->velocity_mps[1];
    point->vz_mps = state->velocity_mps[2];
}

/* Both kinds of noise are drawn, so that the two motions take the same random numbers. */
static void move(struct beam_state *state, const double input_mps2[AXES],
                 const struct scenario_motion *motion, double interval_s, struct random *random)
{
    for (int i = 0; i < AXES; i++) {
        double first = random_normal(random), second = random_normal(random);
        double accel_mps2 =
            input_mps2[i] + (motion->is_physical ? motion->noise_mps2 * first : 0.0);
        state->place_m[i] += interval_s * state->velocity_mps[i];
        state->velocity_mps[i] += interval_s * accel_mps2;
        if (motion->is_physical) {
            state->place_m[i] += interval_s * interval_s / 2.0 * accel_mps2;
        } else {
            state->place_m[i] += motion->noise_m * first;
            state->velocity_mps[i] += motion->noise_mps * second;
        }
    }
}

void plan_maneuver(struct scenario_plan *plan, enum scenario_maneuver maneuver,
                   const struct scenario_motion *motion, struct random *random)
{
    double(*inputs_mps2)[AXES] = must_calloc(plan->num_scans, sizeof *inputs_mps2);
    struct beam_state state;
    for (int i = 0; i < AXES; i++) {
        state.place_m[i] = start_m[i];
        state.velocity_mps[i] = start_mps[i];
    }
    plan_inputs(maneuver, motion->accel_mps2, plan->interval_s, plan->num_scans, inputs_mps2);
    for (size_t scan = 0; scan < plan->num_scans; scan++) {
        put(plan_truth(plan, scan, 0), &state);
        move(&state, inputs_mps2[scan], motion, plan->interval_s, random);
    }
    free(inputs_mps2);
}

/* ---- plots ------------------------------------------------------------------------------------ */

double beam_radius_m(const struct scenario_beam *beam, const struct truth_point *truth)
{
    return sqrt(truth->x_m * truth->x_m + truth->y_m * truth->y_m + truth->z_m * truth->z_m) *
           sin(beam->half_rad);
}

static struct simulated_plot detection(const struct scenario_plan *plan,
                                       const struct truth_point *truth, struct random *random)
{
    double noise[2 * AXES];
    for (int i = 0; i < 2 * AXES; i++) {
        noise[i] = (i < AXES ? plan->noise_m : plan->beam.sigma_mps) * random_normal(random);
    }
    return (struct simulated_plot){
        .target_id = truth->target_id,
        .x_m = truth->x_m + noise[0],
        .y_m = truth->y_m + noise[1],
        .z_m = truth->z_m + noise[2],
        .vx_mps = truth->vx_mps + noise[3],
        .vy_mps = truth->vy_mps + noise[4],
        .vz_mps = truth->vz_mps + noise[5],
    };
}

/* Uniform in a sphere of radius 1. */
static void draw_inside(double offset[AXES], struct random *random)
{
    double length2;
    do {
        length2 = 0.0;
        for (int i = 0; i < AXES; i++) {
            offset[i] = random_between(random, -1.0, 1.0);
            length2 += offset[i] * offset[i];
        }
    } while (length2 > 1.0);
}

/* What measures velocities makes them of places: a clutter plot's is the way from the target's last place. */
static struct simulated_plot clutter(const struct scenario_plan *plan,
                                     const struct truth_point *truth, const double last_m[AXES],
                                     struct random *random)
{
    double radius_m = beam_radius_m(&plan->beam, truth), offset[AXES];
    struct simulated_plot plot = {.target_id = -1};
    draw_inside(offset, random);
    plot.x_m = truth->x_m + radius_m * offset[0];
    plot.y_m = truth->y_m + radius_m * offset[1];
    plot.z_m = truth->z_m + radius_m * offset[2];
    plot.vx_mps = (plot.x_m - last_m[0]) / plan->interval_s;
    plot.vy_mps = (plot.y_m - last_m[1]) / plan->interval_s;
    plot.vz_mps = (plot.z_m - last_m[2]) / plan->interval_s;
    return plot;
}

/* At the first scan, where the target came from. */
static void fill_last_place(const struct scenario_plan *plan, size_t index, double last_m[AXES])
{
    const struct truth_point *at = plan_truth(plan, index > 0 ? index - 1 : 0, 0);
    double back_s = index > 0 ? 0.0 : plan->interval_s;
    last_m[0] = at->x_m - at->vx_mps * back_s;
    last_m[1] = at->y_m - at->vy_mps * back_s;
    last_m[2] = at->z_m - at->vz_mps * back_s;
}

void plan_look_of_beam(const struct scenario_plan *plan, size_t index, struct simulated_scan *scan,
                       struct random *random)
{
    const struct truth_point *truth = plan_truth(plan, index, 0);
    bool is_clean = index < plan->beam.clean_scans;
    bool is_seen = random_uniform(random) < plan->pd || is_clean;
    struct simulated_plot plot = detection(plan, truth, random);
    double last_m[AXES];
    fill_last_place(plan, index, last_m);
    scan->t_s = (double)index * plan->interval_s;
    scan->plots = must_calloc(plan->beam.num_clutter + 1, sizeof *scan->plots);
    if (is_seen) {
        scan->plots[scan->num_plots++] = plot;
    }
    for (size_t i = 0; i < plan->beam.num_clutter && !is_clean; i++) {
        scan->plots[scan->num_plots++] = clutter(plan, truth, last_m, random);
    }
    plan_shuffle(scan, random);
}

/* ---- the scenarios ---------------------------------------------------------------------------- */

/* The number of clutter plots is not by chance, nor by area. */
static size_t count_clutter(const struct parameters *parameters)
{
    double count = parameters->value[PARAMETER_CLUTTER_PER_SCAN];
    if (parameters_is_set(parameters, PARAMETER_CLUTTER_PER_KM2)) {
        fail(EXIT_USAGE, "scenarios popup, weave and hard-turn take clutter_per_scan, not "
                         "clutter_per_km2");
    }
    if (count != floor(count)) {
        fail(EXIT_USAGE,
             "scenarios popup, weave and hard-turn: clutter_per_scan %.9g is not a whole number",
             count);
    }
    return (size_t)count;
}

static struct scenario_plan plan_beam(const struct parameters *parameters,
                                      enum scenario_maneuver maneuver, struct random *random)
{
    const double *value = parameters->value;
    struct scenario_plan plan =
        plan_start(1, (size_t)value[PARAMETER_NUM_SCANS], value[PARAMETER_INTERVAL_S]);
    struct scenario_motion motion = {.accel_mps2 = value[PARAMETER_ACCEL_G] * G_MPS2,
                                     .is_physical = value[PARAMETER_TRUE_MODEL] > 0.0,
                                     .noise_mps2 = value[PARAMETER_TRUE_NOISE_MPS2],
                                     .noise_m = value[PARAMETER_TRUE_NOISE_M],
                                     .noise_mps = value[PARAMETER_TRUE_NOISE_MPS]};
    plan.beam = (struct scenario_beam){
        .is_used = true,
        .has_velocity = value[PARAMETER_VELOCITY] > 0.0,
        .sigma_mps = value[PARAMETER_SIGMA_MPS],
        .half_rad = value[PARAMETER_BEAM_DEG] / 2.0 * DEG_RAD,
        .num_clutter = count_clutter(parameters),
        .clean_scans = (size_t)value[PARAMETER_CLEAN_SCANS],
    };
    plan_maneuver(&plan, maneuver, &motion, random);
    return plan;
}

struct scenario_plan plan_popup(const struct parameters *parameters, struct random *random)
{
    return plan_beam(parameters, MANEUVER_POPUP, random);
}

struct scenario_plan plan_weave(const struct parameters *parameters, struct random *random)
{
    return plan_beam(parameters, MANEUVER_WEAVE, random);
}

struct scenario_plan plan_hard_turn(const struct parameters *parameters, struct random *random)
{
    return plan_beam(parameters, MANEUVER_TURN, random);
}

void suggest_beam(struct parameters *parameters)
{
    parameters_suggest(parameters, PARAMETER_ACCEL_G, 10.0);
    double accel_mps2 = parameters->value[PARAMETER_ACCEL_G] * G_MPS2;
    double fastest_mps =
        hypot(hypot(start_mps[0], start_mps[1]), 4.0 * accel_mps2); /* pulls of 4 s */
    /* a fifth more than it pulls */
    parameters_suggest(parameters, PARAMETER_ACCEL_MAX_MPS2, 1.2 * accel_mps2);
    parameters_suggest(parameters, PARAMETER_V_MAX_MPS, fmax(1000.0, fastest_mps));
    parameters_suggest(parameters, PARAMETER_VELOCITY, 0.0);
    parameters_suggest(parameters, PARAMETER_BEAM_DEG, 1.2);
    parameters_suggest(parameters, PARAMETER_CLEAN_SCANS, 3.0);
    parameters_suggest(parameters, PARAMETER_TRUE_MODEL, 1.0);
    parameters_suggest(parameters, PARAMETER_TRUE_NOISE_MPS2, 2.0);
    parameters_suggest(parameters, PARAMETER_TRUE_NOISE_M, 1.0);
    parameters_suggest(parameters, PARAMETER_TRUE_NOISE_MPS, 1.0);
}
