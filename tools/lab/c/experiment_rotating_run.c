/* SPDX-License-Identifier: MIT */
/* experiment_rotating_run: one case of one run, and all of them. */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "base/portable_math.h"
#include "base/random.h"
#include "experiment_rotating.h"
#include "rhotrack/measurement.h"
#include "scene_simulation.h"
#include "workers.h"

#define STREAM 0x726f74   /* of random numbers */
#define WINDOW 7          /* turns in which a target is to be found */
#define TOLERANCE_M 700.0 /* a track within is the target's: a plot's error is up to 180 m across */
#define TRACKS_MAX 512
#define TIMED_RUNS 4
#define TIMED_ROUNDS 3

const char *const rotating_names[ROTATING_CASES] = {"sectors", "whole turns", "all at once"};

struct scene *rotating_scene(void)
{
    return scene_find("rotating", NULL, 0);
}

/* ---- scans ----------------------------------------------------------------------------------- */

struct following {
    enum rotating_case of;
    const struct scene_run *run;
    const struct scene_sensor *radar;
    struct pipeline *chain;
    struct random random; /* of the noise of what is measured again */
    struct rotating_result result;
    size_t num_known;
    struct {
        uint32_t track_id;
        bool is_targets;
    } known[TRACKS_MAX]; /* confirmed tracks */
};

static struct rho_plot plot_of(const struct scene_sensor *radar, const struct scene_plot *plot,
                               double scan_s)
{
    struct rho_polar_plot polar = {.offset_us = (int32_t)lround((plot->t_s - scan_s) * 1e6),
                                   .range_m = (float)plot->range_m,
                                   .azimuth_rad = (float)plot->azimuth_rad,
                                   .sigma_range_m = (float)radar->sigma_range_m,
                                   .sigma_azimuth_rad = (float)radar->sigma_azimuth_rad};
    struct rho_plot out;

    must_succeed(rho_measurement_from_polar(&polar, 0, NULL, &out), "rho_measurement_from_polar");
    return out;
}

/* The same target, seen at the scan's time; clutter is the same at any time. */
static struct scene_plot seen_at(struct following *all, const struct scene_plot *plot,
                                 double scan_s)
{
    struct scene_plot seen = *plot;

    if (plot->target_id >= 0) {
        struct motion at = path_at(&all->run->paths[plot->target_id], scan_s);

        seen.range_m =
            hypot(at.x_m, at.y_m) + all->radar->sigma_range_m * random_normal(&all->random);
        seen.azimuth_rad = portable_wrap(atan2(at.y_m, at.x_m) + all->radar->sigma_azimuth_rad *
                                                                     random_normal(&all->random));
    }
    seen.t_s = scan_s;
    return seen;
}

/* The plots of some sectors as one scan at the end of the last. */
static struct rho_scan scan_of(struct following *all, const struct scene_scan *sectors,
                               size_t count)
{
    double scan_s = sectors[count - 1].end_s;
    struct rho_scan scan = {.time_us = llround(scan_s * 1e6),
                            .sensor_id = all->radar->sensor_id,
                            .plots = all->chain->plots};

    if (all->of == ROTATING_SECTORS) {
        scan.sector_from_rad = (float)sectors->from_rad;
        scan.sector_to_rad = (float)sectors->to_rad;
    }
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < sectors[i].num_plots && scan.num_plots < RHO_MAX_PLOTS; k++) {
            struct scene_plot plot = all->of == ROTATING_AT_ONCE
                                         ? seen_at(all, &sectors[i].plots[k], scan_s)
                                         : sectors[i].plots[k];
            all->chain->plots[scan.num_plots++] = plot_of(all->radar, &plot, scan_s);
        }
    }
    return scan;
}

/* ---- tracks ---------------------------------------------------------------------------------- */

/* The target nearest to a track; -1: none is near. */
static int target_of(const struct following *all, const struct rho_track_report *report, double t_s,
                     struct motion *truth)
{
    double least_m = TOLERANCE_M;
    int nearest = -1;

    for (size_t i = 0; i < all->run->num_paths; i++) {
        struct motion at = path_at(&all->run->paths[i], t_s);
        double off_m = hypot(report->state[0] - at.x_m, report->state[1] - at.y_m);

        if (off_m < least_m) {
            least_m = off_m;
            nearest = (int)i;
            *truth = at;
        }
    }
    return nearest;
}

static void know(struct following *all, uint32_t track_id, bool is_targets)
{
    size_t i = 0;

    while (i < all->num_known && all->known[i].track_id != track_id) {
        i++;
    }
    if (i == TRACKS_MAX) {
        fail(EXIT_RUNTIME, "more than %d confirmed tracks in a run", TRACKS_MAX);
    }
    if (i == all->num_known) {
        all->known[all->num_known++].track_id = track_id;
        all->known[i].is_targets = false;
    }
    all->known[i].is_targets = all->known[i].is_targets || is_targets;
}

/* Looks at the report; returns how many targets have a confirmed track. */
static int look(struct following *all, double t_s)
{
    const struct rho_report *report = all->chain->report;
    bool is_tracked[64] = {false};
    int tracked = 0;

    for (unsigned i = 0; i < report->num_tracks; i++) {
        const struct rho_track_report *track = &report->tracks[i];
        struct motion truth = {0};

        if (track->status != RHO_TRACK_CONFIRMED && track->status != RHO_TRACK_COASTING) {
            continue;
        }
        int target = target_of(all, track, t_s, &truth);
        know(all, track->track_id, target >= 0);
        if (target < 0) {
            continue;
        }
        tracked += target < 64 && !is_tracked[target];
        is_tracked[target % 64] = true;
        if (track->plot >= 0) {
            all->result.sum_m2 +=
                pow(track->state[0] - truth.x_m, 2.0) + pow(track->state[1] - truth.y_m, 2.0);
            all->result.sum_m2ps2 +=
                pow(track->state[3] - truth.vx_mps, 2.0) + pow(track->state[4] - truth.vy_mps, 2.0);
            all->result.count++;
        }
    }
    return tracked;
}

/* ---- one case -------------------------------------------------------------------------------- */

static void open_chain(struct pipeline *chain, const struct parameters *parameters)
{
    struct rho_sensor sensor;

    pipeline_open(chain, parameters);
    parameters_to_any_sensor(parameters, 1, &sensor);
    must_succeed(rho_tracker_set_sensor(chain->tracker, &sensor), "sensor");
}

static void time_step(struct following *all, const struct rho_scan *scan, double *step_us)
{
    int64_t start_us = clock_us();

    pipeline_step(all->chain, scan);
    *step_us = fmin(*step_us, (double)(clock_us() - start_us));
    all->result.step_max_us = fmax(all->result.step_max_us, *step_us);
    for (unsigned i = 0; i < scan->num_plots; i++) {
        all->result.latency_max_us =
            fmax(all->result.latency_max_us, *step_us - (double)scan->plots[i].offset_us);
    }
}

struct rotating_result rotating_follow(enum rotating_case of, const struct parameters *parameters,
                                       const struct scene_run *run, struct pipeline *chain,
                                       double *step_us)
{
    const struct scene_sensor *radar = &run->scene->sensors[0];
    struct following all = {.of = of,
                            .run = run,
                            .radar = radar,
                            .chain = chain,
                            .random = random_start(run->seed, STREAM, run->run)};
    size_t sectors = radar->sectors, count = of == ROTATING_SECTORS ? 1 : sectors;

    open_chain(chain, parameters);
    all.result.targets = (int)run->num_paths;
    for (size_t first = 0; first + count <= run->num_scans; first += count) {
        struct rho_scan scan = scan_of(&all, &run->scans[first], count);

        time_step(&all, &scan, &step_us[first]);
        all.result.tracked = look(&all, run->scans[first + count - 1].end_s);
        if (first + count == WINDOW * sectors) {
            all.result.found = all.result.tracked;
        }
    }
    for (size_t i = 0; i < all.num_known; i++) {
        all.result.false_tracks += !all.known[i].is_targets;
    }
    return all.result;
}

/* ---- all runs -------------------------------------------------------------------------------- */

struct measuring {
    const struct scene *scene;
    struct parameters parameters;
    uint64_t seed;
    struct rotating_result *results; /* by run, case */
    struct pipeline chains[WORKERS_MAX];
};

static double *no_times(size_t count)
{
    double *step_us = must_calloc(count + 1, sizeof *step_us);

    for (size_t i = 0; i < count; i++) {
        step_us[i] = INFINITY;
    }
    return step_us;
}

static void run_one(void *context, size_t worker, size_t run)
{
    struct measuring *measuring = context;
    struct scene_run *seen = scene_observe(measuring->scene, measuring->seed, run);

    if (measuring->chains[worker].tracker == NULL) {
        measuring->chains[worker] = pipeline_start();
    }
    for (size_t i = 0; i < ROTATING_CASES; i++) {
        double *step_us = no_times(seen->num_scans);

        measuring->results[run * ROTATING_CASES + i] =
            rotating_follow((enum rotating_case)i, &measuring->parameters, seen,
                            &measuring->chains[worker], step_us);
        free(step_us);
    }
    scene_run_free(seen);
}

/* Alone, the least of some rounds for each step: what other programs take does not count. */
static void time_steps(struct measuring *measuring, struct rotating_figures *figures)
{
    for (uint64_t run = 0; run < TIMED_RUNS; run++) {
        struct scene_run *seen = scene_observe(measuring->scene, measuring->seed, run);

        for (size_t i = 0; i < ROTATING_CASES; i++) {
            double *step_us = no_times(seen->num_scans);
            struct rotating_result result = {0};

            for (int round = 0; round < TIMED_ROUNDS; round++) {
                result = rotating_follow((enum rotating_case)i, &measuring->parameters, seen,
                                         &measuring->chains[0], step_us);
            }
            figures[i].step_max_us = fmax(figures[i].step_max_us, result.step_max_us);
            figures[i].latency_max_ms =
                fmax(figures[i].latency_max_ms, result.latency_max_us * 1e-3);
            if (run == 0) {
                figures[i].step_us = step_us;
                figures[i].num_sectors = seen->num_scans;
            } else {
                free(step_us);
            }
        }
        scene_run_free(seen);
    }
}

static struct rotating_figures figures_of(const struct measuring *measuring, size_t of,
                                          size_t num_runs)
{
    const struct scene_sensor *radar = &measuring->scene->sensors[0];
    struct rotating_figures figures = {.sector_s = radar->turn_s / (double)radar->sectors};
    double targets = 0.0, m2 = 0.0, m2ps2 = 0.0, count = 0.0;

    for (size_t run = 0; run < num_runs; run++) {
        const struct rotating_result *result = &measuring->results[run * ROTATING_CASES + of];

        targets += result->targets;
        figures.found += result->found;
        figures.tracked += result->tracked;
        figures.false_a_run += result->false_tracks / (double)num_runs;
        m2 += result->sum_m2;
        m2ps2 += result->sum_m2ps2;
        count += (double)result->count;
    }
    figures.found /= targets;
    figures.tracked /= targets;
    figures.rmse_m = sqrt(m2 / count);
    figures.rmse_mps = sqrt(m2ps2 / count);
    return figures;
}

struct rotating_figures *rotating_measure(uint64_t seed, size_t num_runs)
{
    struct scene *scene = rotating_scene();
    struct measuring measuring = {
        .scene = scene, .parameters = scene_parameters(scene), .seed = seed};
    struct rotating_figures *figures = must_calloc(ROTATING_CASES, sizeof *figures);

    measuring.results = must_calloc(num_runs * ROTATING_CASES, sizeof *measuring.results);
    workers_run(num_runs, "runs", run_one, &measuring);
    for (size_t i = 0; i < ROTATING_CASES; i++) {
        figures[i] = figures_of(&measuring, i, num_runs);
    }
    if (measuring.chains[0].tracker == NULL) {
        measuring.chains[0] = pipeline_start();
    }
    time_steps(&measuring, figures);
    for (size_t i = 0; i < WORKERS_MAX; i++) {
        pipeline_free(&measuring.chains[i]);
    }
    free(measuring.results);
    scene_free(scene);
    return figures;
}

void rotating_figures_free(struct rotating_figures *figures)
{
    for (size_t i = 0; i < ROTATING_CASES; i++) {
        free(figures[i].step_us);
    }
    free(figures);
}
