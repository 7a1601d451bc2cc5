/* SPDX-License-Identifier: MIT */
/* scenario_radar: what a turning radar in the origin sees: polar plots, each at its own time; scenarios polar, doppler. */
#include <math.h>
#include <stdlib.h>

#include "common.h"
#include "scenario_plan.h"

#define PI 3.141592653589793
#define RANGE_LEAST_M 0.01 /* the file's last digit */

/* The time of an azimuth within a turn: the antenna starts at +x. */
static double turn_time_s(double azimuth_rad, double interval_s)
{
    double share = azimuth_rad / (2.0 * PI);
    return interval_s * (share - floor(share));
}

static void fill_place(struct simulated_plot *plot)
{
    plot->azimuth_rad = remainder(plot->azimuth_rad, 2.0 * PI);
    plot->x_m = plot->range_m * cos(plot->azimuth_rad);
    plot->y_m = plot->range_m * sin(plot->azimuth_rad);
}

/* When the antenna meets a straight target: from where it was a round before, a few times over. */
static double meeting_s(const struct truth_point *truth, double interval_s)
{
    double offset_s = 0.0;
    for (int i = 0; i < 8; i++) {
        offset_s = turn_time_s(
            atan2(truth->y_m + truth->vy_mps * offset_s, truth->x_m + truth->vx_mps * offset_s),
            interval_s);
    }
    return offset_s;
}

static struct simulated_plot detection(const struct scenario_plan *plan,
                                       const struct truth_point *truth, struct random *random)
{
    const struct scenario_radar *radar = &plan->radar;
    struct simulated_plot plot = {.target_id = truth->target_id};
    plot.offset_s = meeting_s(truth, plan->interval_s);
    double x_m = truth->x_m + truth->vx_mps * plot.offset_s;
    double y_m = truth->y_m + truth->vy_mps * plot.offset_s;
    double range_m = hypot(x_m, y_m);
    plot.range_m = fmax(RANGE_LEAST_M, range_m + radar->sigma_range_m * random_normal(random));
    plot.azimuth_rad = atan2(y_m, x_m) + radar->sigma_azimuth_rad * random_normal(random);
    plot.range_rate_mps = (x_m * truth->vx_mps + y_m * truth->vy_mps) / range_m +
                          radar->sigma_range_rate_mps * random_normal(random);
    fill_place(&plot);
    return plot;
}

#define STATIC_SIGMA_MPS 1.0 /* leaves in the wind, waves: sd of what stands still */

/* What the radar says of a range rate. */
static double told_mps(const struct scenario_radar *radar, double rate_mps)
{
    return radar->span_mps > 0.0 ? remainder(rate_mps, radar->span_mps) : rate_mps;
}

static struct simulated_plot clutter(const struct scenario_plan *plan, struct random *random)
{
    const struct scenario_radar *radar = &plan->radar;
    struct simulated_plot plot = {.target_id = -1};
    double turn = random_uniform(random);
    plot.offset_s = turn * plan->interval_s;
    plot.azimuth_rad = turn * 2.0 * PI;
    plot.range_m = random_between(random, radar->range_min_m, radar->range_max_m);
    plot.range_rate_mps =
        random_between(random, -radar->clutter_rate_max_mps, radar->clutter_rate_max_mps);
    fill_place(&plot);
    return plot;
}

static struct simulated_plot static_clutter(const struct scenario_plan *plan, struct random *random)
{
    struct simulated_plot plot = clutter(plan, random);
    plot.range_rate_mps = STATIC_SIGMA_MPS * random_normal(random);
    return plot;
}

static int by_time(const void *a, const void *b)
{
    const struct simulated_plot *one = a, *other = b;
    return (one->offset_s > other->offset_s) - (one->offset_s < other->offset_s);
}

void plan_turn_of_radar(const struct scenario_plan *plan, size_t index, struct simulated_scan *scan,
                        struct random *random)
{
    double static_mean = plan->radar.static_mean;
    uint64_t num_clutter = random_poisson(random, plan->clutter_mean);
    uint64_t num_static = static_mean > 0.0 ? random_poisson(random, static_mean) : 0;
    scan->t_s = (double)index * plan->interval_s;
    scan->plots =
        must_calloc(plan->num_targets + num_clutter + num_static + 1, sizeof *scan->plots);
    for (size_t target = 0; target < plan->num_targets; target++) {
        struct simulated_plot plot = detection(plan, plan_truth(plan, index, target), random);
        if (random_uniform(random) < plan->pd) {
            scan->plots[scan->num_plots++] = plot;
        }
    }
    for (uint64_t i = 0; i < num_clutter; i++) {
        scan->plots[scan->num_plots++] = clutter(plan, random);
    }
    for (uint64_t i = 0; i < num_static; i++) {
        scan->plots[scan->num_plots++] = static_clutter(plan, random);
    }
    for (size_t i = 0; i < scan->num_plots; i++) {
        scan->plots[i].range_rate_mps = told_mps(&plan->radar, scan->plots[i].range_rate_mps);
    }
    qsort(scan->plots, scan->num_plots, sizeof *scan->plots, by_time);
}

/* ---- the scenario ----------------------------------------------------------------------------- */

/* Anywhere between 20 and 60 km, any heading, drawn again until the whole straight path lies there. */
struct scenario_state plan_straight_around(const struct parameters *parameters, double duration_s,
                                           struct random *random)
{
    for (int i = 0; i < 10000; i++) {
        double range_m =
            sqrt(random_between(random, POLAR_NEAR_M * POLAR_NEAR_M, POLAR_FAR_M * POLAR_FAR_M));
        double azimuth_rad = random_between(random, 0.0, 2.0 * PI);
        double heading_rad = random_between(random, 0.0, 2.0 * PI);
        double speed_mps = random_between(random, parameters->value[PARAMETER_V_MIN_MPS],
                                          parameters->value[PARAMETER_V_MAX_MPS]);
        struct scenario_state state = {.x_m = range_m * cos(azimuth_rad),
                                       .vx_mps = speed_mps * cos(heading_rad),
                                       .y_m = range_m * sin(azimuth_rad),
                                       .vy_mps = speed_mps * sin(heading_rad)};
        double closing = state.x_m * state.vx_mps + state.y_m * state.vy_mps;
        double nearest_s = fmin(fmax(-closing / (speed_mps * speed_mps), 0.0), duration_s);
        double nearest_m =
            hypot(state.x_m + state.vx_mps * nearest_s, state.y_m + state.vy_mps * nearest_s);
        double last_m =
            hypot(state.x_m + state.vx_mps * duration_s, state.y_m + state.vy_mps * duration_s);
        if (nearest_m >= POLAR_NEAR_M && last_m <= POLAR_FAR_M) {
            return state;
        }
    }
    fail(EXIT_USAGE, "scenarios polar, doppler and rotating: no target can stay within 20 to 60 km "
                     "for the whole run; "
                     "take fewer scans or slower targets");
}

/* A turn is a scan, and scan_interval_s is to say so. */
static void check_turn(const struct parameters *parameters)
{
    double max_s = parameters_text(PARAMETER_SCAN_INTERVAL_S).max;
    if (parameters->value[PARAMETER_INTERVAL_S] > max_s) {
        fail(EXIT_USAGE,
             "scenarios polar and doppler: a turn of interval_s %.9g is longer than a scan, %.9g s",
             parameters->value[PARAMETER_INTERVAL_S], max_s);
    }
}

struct scenario_plan plan_polar(const struct parameters *parameters, struct random *random)
{
    check_turn(parameters);
    struct scenario_plan plan = plan_start((size_t)parameters->value[PARAMETER_TARGETS],
                                           (size_t)parameters->value[PARAMETER_NUM_SCANS],
                                           parameters->value[PARAMETER_INTERVAL_S]);
    for (size_t target = 0; target < plan.num_targets; target++) {
        /* also the last turn takes its time */
        plan_straight(
            &plan, target,
            plan_straight_around(parameters, plan.interval_s * (double)plan.num_scans, random));
    }
    plan.radar = (struct scenario_radar){
        .is_used = true,
        .has_range_rate = parameters->value[PARAMETER_RANGE_RATE] > 0.0,
        .sigma_range_m = parameters->value[PARAMETER_SIGMA_RANGE_M],
        .sigma_azimuth_rad = parameters->value[PARAMETER_SIGMA_AZIMUTH_RAD],
        .sigma_range_rate_mps = parameters->value[PARAMETER_SIGMA_RANGE_RATE_MPS],
        .range_min_m = parameters->value[PARAMETER_RANGE_MIN_M],
        .range_max_m = parameters->value[PARAMETER_RANGE_MAX_M],
        .clutter_rate_max_mps = parameters->value[PARAMETER_V_MAX_MPS],
    };
    return plan;
}

struct scenario_plan plan_doppler(const struct parameters *parameters, struct random *random)
{
    struct scenario_plan plan = plan_polar(parameters, random);
    plan.radar.static_mean = parameters->value[PARAMETER_STATIC_CLUTTER];
    plan.radar.span_mps = parameters->value[PARAMETER_RANGE_RATE_SPAN_MPS];
    return plan;
}

void suggest_radar(struct parameters *parameters, double range_max_m)
{
    parameters_suggest(parameters, PARAMETER_STATIC_CLUTTER, 0);
    parameters_suggest(parameters, PARAMETER_SECTORS_PER_TURN, 32);
    parameters_suggest(parameters, PARAMETER_RANGE_MIN_M, 1000);
    parameters_suggest(parameters, PARAMETER_RANGE_MAX_M, range_max_m);
}
