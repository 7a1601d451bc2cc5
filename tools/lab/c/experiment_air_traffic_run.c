/* SPDX-License-Identifier: MIT */
/* experiment_air_traffic_run: one run of one case of traffic, followed, timed and evaluated. */
#include <math.h>
#include <stdlib.h>
#include <time.h>

#include "base/common.h"
#include "experiment_air_traffic.h"
#include "scene_simulation.h"

struct scene *air_scene(const struct air_case *of)
{
    const char *sets[3 + AIR_SETS];
    char targets[40], clutter[40], duration[40];
    size_t count = 0;

    if (of->targets > 0.0) {
        snprintf(targets, sizeof targets, "targets.0.flights=%g", of->targets);
        snprintf(clutter, sizeof clutter, "clutter.0.plots=%g", of->clutter);
        snprintf(duration, sizeof duration, "duration_s=%zu", 10 * of->num_scans);
        sets[count++] = targets;
        sets[count++] = clutter;
        sets[count++] = duration;
    }
    for (size_t i = 0; i < AIR_SETS && of->sets[i]; i++) {
        sets[count++] = of->sets[i];
    }
    return scene_find("air-traffic", sets, count);
}

double air_clock_us(void)
{
    struct timespec now;

    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e6 * (double)now.tv_sec + 1e-3 * (double)now.tv_nsec;
}

/* ---- scans in, points out -------------------------------------------------------------------- */

struct rho_scan air_scan(const struct simulation *simulation, size_t index, struct pipeline *chain)
{
    const struct simulated_scan *from = &simulation->scans[index];
    size_t count = from->num_plots < RHO_MAX_PLOTS ? from->num_plots : RHO_MAX_PLOTS;
    float sigma_m = (float)simulation->sigma_m;

    for (size_t i = 0; i < count; i++) {
        chain->plots[i] = (struct rho_plot){.x_m = (float)from->plots[i].x_m,
                                            .y_m = (float)from->plots[i].y_m,
                                            .sigma_range_m = sigma_m,
                                            .sigma_cross_m = sigma_m,
                                            .sigma_up_m = sigma_m};
    }
    return (struct rho_scan){
        .time_us = llround(from->t_s * 1e6), .num_plots = (uint32_t)count, .plots = chain->plots};
}

static struct evaluation_point track_point(const struct rho_track_report *track, int32_t id)
{
    return (struct evaluation_point){.id = id,
                                     .x_m = track->state[0],
                                     .y_m = track->state[1],
                                     .vx_mps = track->state[3],
                                     .vy_mps = track->state[4],
                                     .cov_xx_m2 = track->covariance[0],
                                     .cov_yx_m2 = track->covariance[1],
                                     .cov_yy_m2 = track->covariance[2],
                                     .cov_vxx_m2ps2 = track->covariance[9],
                                     .cov_vyx_m2ps2 = track->covariance[13],
                                     .cov_vyy_m2ps2 = track->covariance[14],
                                     .is_coasting = track->status == RHO_TRACK_COASTING};
}

void air_points_add(struct air_points *points, const struct rho_report *report, int32_t first_id)
{
    for (unsigned i = 0; i < report->num_tracks; i++) {
        const struct rho_track_report *track = &report->tracks[i];
        if (track->status == RHO_TRACK_TENTATIVE) {
            continue;
        }
        points->points =
            must_grow(points->points, points->count, &points->capacity, sizeof *points->points);
        points->points[points->count++] = track_point(track, first_id + (int32_t)track->track_id);
    }
}

void air_points_truth(struct air_points *truth, const struct simulation *simulation, size_t scan)
{
    const struct truth_point *from = &simulation->truth[scan * simulation->targets_a_scan];

    truth->count = 0;
    for (size_t i = 0; i < simulation->targets_a_scan; i++) {
        truth->points =
            must_grow(truth->points, truth->count, &truth->capacity, sizeof *truth->points);
        truth->points[truth->count++] = (struct evaluation_point){.id = from[i].target_id,
                                                                  .x_m = from[i].x_m,
                                                                  .y_m = from[i].y_m,
                                                                  .vx_mps = from[i].vx_mps,
                                                                  .vy_mps = from[i].vy_mps,
                                                                  .cov_xx_m2 = NAN,
                                                                  .cov_yx_m2 = NAN,
                                                                  .cov_yy_m2 = NAN};
    }
}

/* ---- figures --------------------------------------------------------------------------------- */

static struct evaluation *evaluate(const struct simulation *simulation,
                                   const struct air_points *scans, double cutoff_m)
{
    struct evaluation *evaluation = evaluation_start(cutoff_m);
    struct air_points truth = {0};

    for (size_t i = 0; i < simulation->num_scans; i++) {
        air_points_truth(&truth, simulation, i);
        evaluation_time(evaluation, llround(simulation->scans[i].t_s * 1e6), truth.points,
                        truth.count, scans[i].points, scans[i].count);
    }
    free(truth.points);
    return evaluation;
}

struct air_figures air_figures_of(const struct evaluation *evaluation)
{
    struct evaluation_result of = evaluation_result(evaluation);

    return (struct air_figures){.gospa_m = of.gospa_m,
                                .localisation_m = of.gospa_localisation_m,
                                .missed = of.gospa_missed,
                                .false_a_scan = of.gospa_false,
                                .completeness = of.completeness,
                                .switches = (double)of.switches,
                                .fragments = (double)of.fragments,
                                .delay_scans = of.delay_scans,
                                .rmse_m = of.errors.rmse_m,
                                .nees = of.errors.nees,
                                .nees_inside = of.errors.nees_inside,
                                .velocity_ratio = of.errors.velocity_ratio,
                                .velocity_inside = of.errors.velocity_inside};
}

void air_figures_add(struct air_figures *sum, const struct air_figures *of)
{
    sum->gospa_m += of->gospa_m * of->gospa_m;
    sum->localisation_m += of->localisation_m * of->localisation_m;
    sum->missed += of->missed;
    sum->false_a_scan += of->false_a_scan;
    sum->completeness += of->completeness;
    sum->switches += of->switches;
    sum->fragments += of->fragments;
    sum->delay_scans += of->delay_scans;
    sum->rmse_m += of->rmse_m * of->rmse_m;
    sum->nees += of->nees;
    sum->nees_inside += of->nees_inside;
    sum->velocity_ratio += of->velocity_ratio;
    sum->velocity_inside += of->velocity_inside;
}

void air_figures_divide(struct air_figures *sum, double runs)
{
    sum->gospa_m = sqrt(sum->gospa_m / runs);
    sum->localisation_m = sqrt(sum->localisation_m / runs);
    sum->missed /= runs;
    sum->false_a_scan /= runs;
    sum->completeness /= runs;
    sum->switches /= runs;
    sum->fragments /= runs;
    sum->delay_scans /= runs;
    sum->rmse_m = sqrt(sum->rmse_m / runs);
    sum->nees /= runs;
    sum->nees_inside /= runs;
    sum->velocity_ratio /= runs;
    sum->velocity_inside /= runs;
}

static void count_found(const struct evaluation *evaluation, struct air_result *result)
{
    size_t count = 0;
    struct evaluation_target *targets = evaluation_by_target(evaluation, &count);

    for (size_t i = 0; i < count; i++) {
        for (size_t scan = 0; scan < AIR_FOUND_SCANS && scan < targets[i].scans; scan++) {
            result->alive[scan] += 1.0;
            result->found[scan] += targets[i].paired > 0 && targets[i].delay_scans <= scan;
        }
    }
    free(targets);
}

static void evaluate_tracks(const struct simulation *simulation, const struct air_points *scans,
                            struct air_result *result)
{
    for (size_t i = 0; i < AIR_CUTOFFS; i++) {
        struct evaluation *evaluation = evaluate(simulation, scans, air_cutoffs_m[i]);
        result->tracks[i] = air_figures_of(evaluation);
        if (i == 0) {
            struct evaluation_result of = evaluation_result(evaluation);
            result->false_tracks = (double)of.false_tracks;
            result->hours = (double)simulation->num_scans * simulation->interval_s / 3600.0;
            count_found(evaluation, result);
        }
        evaluation_free(evaluation);
    }
}

/* ---- one run --------------------------------------------------------------------------------- */

/* Steps through the recording; returns the hits that started tracks in most scans. */
static unsigned follow(const struct parameters *parameters, const struct simulation *simulation,
                       struct pipeline *chain, struct air_points *scans, struct air_result *result)
{
    unsigned counts[RHO_MAX_SCANS + 1] = {0}, best = 0;

    pipeline_open(chain, parameters);
    for (size_t i = 0; i < simulation->num_scans; i++) {
        struct rho_scan scan = air_scan(simulation, i, chain);
        double start_us = air_clock_us();
        pipeline_step(chain, &scan);
        double us = air_clock_us() - start_us;
        result->us += us / (double)simulation->num_scans;
        result->max_us = fmax(result->max_us, us);
        result->plots += (double)scan.num_plots / (double)simulation->num_scans;
        counts[chain->initiator->min_scans]++;
        scans[i].count = 0;
        air_points_add(&scans[i], chain->report, 0);
    }
    for (unsigned i = 3; i <= RHO_MAX_SCANS; i++) {
        best = counts[i] > counts[best] || best == 0 ? i : best;
    }
    return best;
}

static void free_scans(struct air_points *scans, size_t num_scans)
{
    for (size_t i = 0; i < num_scans; i++) {
        free(scans[i].points);
    }
    free(scans);
}

struct air_result air_simulated(const struct parameters *parameters,
                                const struct simulation *simulation, bool has_limit,
                                struct pipeline *chain)
{
    struct air_points *scans = must_calloc(simulation->num_scans, sizeof *scans);
    struct air_result result = {0};
    unsigned min_scans = follow(parameters, simulation, chain, scans, &result);

    result.min_scans = min_scans;
    evaluate_tracks(simulation, scans, &result);
    if (has_limit) {
        air_limit(parameters, simulation, min_scans, chain, scans);
        for (size_t i = 0; i < AIR_CUTOFFS; i++) {
            struct evaluation *evaluation = evaluate(simulation, scans, air_cutoffs_m[i]);
            result.limit[i] = air_figures_of(evaluation);
            evaluation_free(evaluation);
        }
    }
    free_scans(scans, simulation->num_scans);
    return result;
}

struct air_result air_run(const struct air_case *of, uint64_t seed, uint64_t run,
                          struct pipeline *chain)
{
    struct scene *scene = air_scene(of);
    struct parameters parameters = scene_parameters(scene);
    struct simulation *simulation = scene_simulation(scene, seed, run);
    struct air_result result = air_simulated(&parameters, simulation, of->has_limit, chain);

    simulation_free(simulation);
    scene_free(scene);
    if (of->group == AIR_OPERATION) {
        struct air_alarm alone = {of->clutter, parameters.value[PARAMETER_FALSE_TRACKS_PER_HOUR]};
        struct air_alarm_result alarms = air_alarm_run(&alone, seed, run, chain);
        result.alarms = alarms.confirmed;
        result.alarm_hours = alarms.hours;
    }
    return result;
}
