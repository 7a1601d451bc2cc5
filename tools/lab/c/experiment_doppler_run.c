/* SPDX-License-Identifier: MIT */
/*
 * experiment_doppler_run: cases over many runs, and the clutter that can be borne without range
 * rates.
 */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "experiment_doppler.h"
#include "scene_simulation.h"
#include "workers.h"

const struct polar_case doppler_cases[DOPPLER_CASES] = {
    {"no range rate", false, false, 0.0},
    {"range rate", false, true, 0.0},
    {"range rate, span 100 m/s", false, true, 100.0},
    {"range rate, span 30 m/s", false, true, 30.0},
};

const double doppler_clutter[DOPPLER_LEVELS] = {50.0, 75.0, 100.0, 150.0, 200.0, 300.0, 400.0};

/* ---- one case at one level ------------------------------------------------------------------- */

struct measuring {
    const struct polar_case *of;
    const struct scene *scene;
    struct parameters parameters;
    uint64_t seed;
    struct polar_result *results; /* by run */
    struct pipeline chains[WORKERS_MAX];
};

static void run_one(void *context, size_t worker, size_t run)
{
    struct measuring *measuring = context;
    struct simulation *simulation = scene_simulation(measuring->scene, measuring->seed, run);
    struct pipeline *chain = &measuring->chains[worker];

    if (chain->tracker == NULL) {
        *chain = pipeline_start();
    }
    measuring->results[run] = polar_run(measuring->of, &measuring->parameters, simulation, chain);
    simulation_free(simulation);
}

static struct doppler_figures figures_of(const struct measuring *measuring, size_t num_runs)
{
    struct doppler_figures figures = {.of = measuring->of};
    double targets = 0.0, found_by_tracker = 0.0, m2 = 0.0, m2ps2 = 0.0, count = 0.0;

    for (size_t run = 0; run < num_runs; run++) {
        const struct polar_result *result = &measuring->results[run];

        targets += result->targets;
        figures.found += result->found;
        figures.false_a_run += result->false_candidates / (double)num_runs;
        figures.search_ms += result->search_us / 1e3 / (double)num_runs;
        figures.prompt += result->prompt;
        figures.tracked += result->tracked;
        figures.false_tracks += result->false_tracks / (double)num_runs;
        figures.confirm_at += result->confirm_at;
        found_by_tracker += result->confirmed;
        for (size_t turn = 0; turn < POLAR_TURNS_MAX; turn++) {
            m2 += result->errors.sum_m2[turn];
            m2ps2 += result->errors.sum_m2ps2[turn];
            count += (double)result->errors.count[turn];
        }
    }
    figures.found /= targets;
    figures.prompt /= targets;
    figures.tracked /= targets;
    figures.confirm_at /= found_by_tracker;
    figures.rmse_m = sqrt(m2 / count);
    figures.rmse_mps = sqrt(m2ps2 / count);
    return figures;
}

struct doppler_figures doppler_measure(const struct polar_case *of, double clutter,
                                       double static_clutter, uint64_t seed, size_t num_runs)
{
    char moving[40], still[40];
    const char *sets[] = {moving, still};

    snprintf(moving, sizeof moving, "clutter.0.plots=%g", clutter);
    snprintf(still, sizeof still, "clutter.1.plots=%g", static_clutter);
    struct scene *scene = scene_find("doppler", sets, 2);
    struct measuring measuring = {
        .of = of, .scene = scene, .parameters = scene_parameters(scene), .seed = seed};

    parameters_suggest(&measuring.parameters, PARAMETER_CLUTTER_PER_SCAN, clutter);
    measuring.results = must_calloc(num_runs, sizeof *measuring.results);
    workers_run(num_runs, "runs", run_one, &measuring);
    struct doppler_figures figures = figures_of(&measuring, num_runs);
    figures.clutter = clutter;
    figures.static_clutter = static_clutter;
    for (size_t i = 0; i < WORKERS_MAX; i++) {
        pipeline_free(&measuring.chains[i]);
    }
    free(measuring.results);
    scene_free(scene);
    return figures;
}

bool doppler_meets(const struct doppler_figures *figures)
{
    return figures->found >= DOPPLER_PD_MIN && figures->prompt >= DOPPLER_PD_MIN &&
           figures->false_a_run <= DOPPLER_FALSE_MAX && figures->false_tracks <= DOPPLER_FALSE_MAX;
}

/* ---- the limit, and beyond ------------------------------------------------------------------- */

static void find_limit(struct doppler_result *result, uint64_t seed, size_t num_runs)
{
    for (size_t i = 0; i < DOPPLER_LEVELS; i++) {
        struct doppler_figures *level = &result->levels[result->num_levels++];

        *level = doppler_measure(&doppler_cases[0], doppler_clutter[i], 0.0, seed, num_runs);
        if (!doppler_meets(level)) {
            return;
        }
        result->limit = level->clutter;
    }
}

/*
 * Beyond the limit the others take most of the time, and have no bars: a quarter of the runs is
 * enough.
 */
static bool is_judged(size_t of)
{
    return of == 1 || of == 2;
}

struct doppler_result doppler_run(uint64_t seed, size_t num_runs)
{
    struct doppler_result result = {.num_levels = 0};

    find_limit(&result, seed, num_runs);
    double limit = result.limit > 0.0 ? result.limit : doppler_clutter[0];
    double beyond = DOPPLER_TIMES * limit;
    size_t few = (num_runs + 3) / 4;
    for (size_t i = 0; i < DOPPLER_CASES; i++) {
        result.at_limit[i] = doppler_measure(&doppler_cases[i], limit, 0.0, seed, num_runs);
        result.beyond[i] =
            doppler_measure(&doppler_cases[i], beyond, 0.0, seed, is_judged(i) ? num_runs : few);
    }
    result.still = doppler_measure(&doppler_cases[1], beyond / 2.0, beyond / 2.0, seed, few);
    return result;
}
