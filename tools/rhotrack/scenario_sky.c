/* SPDX-License-Identifier: MIT */
/*
 * scenario_sky: what a radar makes of many targets: misses that come one by one or in fades, one plot of targets that are
 * close, clutter that is everywhere, in hot spots, and from things that stand on the ground.
 *
 * Paths, detections and clutter have generators of their own: more clutter leaves the targets' plots as they are.
 */
#include <math.h>
#include <stdlib.h>

#include "common.h"
#include "scenario_plan.h"

#define SPOT_RADIUS_M 20000.0
#define SOURCE_PD 0.9

enum { STREAM_DETECTIONS = 1, STREAM_CLUTTER, STREAM_SHUFFLE };

/* ---- what stays over the scans ---------------------------------------------------------------- */

static struct sky_place place_in(const struct scenario_box *box, double margin_m,
                                 struct random *random)
{
    double x_m = fmin(margin_m, (box->x_max_m - box->x_min_m) / 2.0);
    double y_m = fmin(margin_m, (box->y_max_m - box->y_min_m) / 2.0);

    return (struct sky_place){random_between(random, box->x_min_m + x_m, box->x_max_m - x_m),
                              random_between(random, box->y_min_m + y_m, box->y_max_m - y_m)};
}

static struct sky_place *places_in(const struct scenario_box *box, double margin_m, size_t count,
                                   struct random *random)
{
    struct sky_place *places = must_calloc(count + 1, sizeof *places);

    for (size_t i = 0; i < count; i++) {
        places[i] = place_in(box, margin_m, random);
    }
    return places;
}

/* Scans of a fade: geometric, 1 or more. */
static unsigned fade_length(double mean_scans, struct random *random)
{
    unsigned length = 1;

    while (random_uniform(random) < 1.0 - 1.0 / mean_scans) {
        length++;
    }
    return length;
}

static unsigned char *draw_fades(const struct scenario_plan *plan, double per_hour,
                                 double mean_scans, struct random *random)
{
    unsigned char *is_faded = must_calloc(plan->num_scans * plan->num_targets + 1, 1);
    unsigned *left = must_calloc(plan->num_identities + 1, sizeof *left);
    double start_pd = 1.0 - exp(-per_hour * plan->interval_s / 3600.0);

    for (size_t i = 0; i < plan->num_scans * plan->num_targets; i++) {
        unsigned *of = &left[plan->truth[i].target_id];
        if (random_uniform(random) < start_pd && *of == 0) {
            *of = fade_length(mean_scans, random);
        }
        is_faded[i] = *of > 0;
        *of -= *of > 0;
    }
    free(left);
    return is_faded;
}

void plan_sky(struct scenario_plan *plan, const struct parameters *parameters,
              struct random *random)
{
    struct random spots = random_start(random_bits(random), 0, 0);
    struct random sources = random_start(random_bits(random), 0, 0);
    struct random fades = random_start(random_bits(random), 0, 0);
    struct scenario_sky *sky = &plan->sky;

    *sky = (struct scenario_sky){.is_used = true,
                                 .seed = random_bits(random),
                                 .merge_m = parameters->value[PARAMETER_MERGE_M],
                                 .num_spots = (size_t)parameters->value[PARAMETER_SPOTS],
                                 .spot_mean = parameters->value[PARAMETER_SPOT_CLUTTER],
                                 .num_sources =
                                     (size_t)parameters->value[PARAMETER_PERSISTENT_SOURCES]};
    sky->spots = places_in(&plan->box, SPOT_RADIUS_M, sky->num_spots, &spots);
    sky->sources = places_in(&plan->box, 0.0, sky->num_sources, &sources);
    sky->is_faded = draw_fades(plan, parameters->value[PARAMETER_FADES_PER_HOUR],
                               parameters->value[PARAMETER_FADE_SCANS], &fades);
}

void sky_free(struct scenario_sky *sky)
{
    free(sky->spots);
    free(sky->sources);
    free(sky->is_faded);
    *sky = (struct scenario_sky){.is_used = false};
}

/* ---- targets' plots --------------------------------------------------------------------------- */

/* A target in one scan. Targets of one group give one plot. */
struct echo {
    const struct truth_point *truth;
    size_t group; /* the least index of the targets that are close, over others */
    bool is_seen;
    double noise_x_m, noise_y_m;
};

struct by_x {
    double x_m;
    size_t index;
};

static int by_x(const void *a, const void *b)
{
    const struct by_x *one = a, *other = b;

    return (one->x_m > other->x_m) - (one->x_m < other->x_m);
}

static size_t group_of(const struct echo *echoes, size_t index)
{
    while (echoes[index].group != index) {
        index = echoes[index].group;
    }
    return index;
}

static void join(struct echo *echoes, size_t one, size_t other, double merge_m)
{
    const struct truth_point *a = echoes[one].truth, *b = echoes[other].truth;
    size_t first = group_of(echoes, one), second = group_of(echoes, other);

    if (hypot(a->x_m - b->x_m, a->y_m - b->y_m) >= merge_m) {
        return;
    }
    if (first < second) {
        echoes[second].group = first;
    } else {
        echoes[first].group = second;
    }
}

/* Pairs whose x differ by less are neighbours in the order of x. */
static void join_close(struct echo *echoes, size_t count, double merge_m)
{
    struct by_x *order = must_calloc(count + 1, sizeof *order);

    for (size_t i = 0; i < count; i++) {
        order[i] = (struct by_x){echoes[i].truth->x_m, i};
    }
    qsort(order, count, sizeof *order, by_x);
    for (size_t i = 0; i < count; i++) {
        for (size_t j = i + 1; j < count && order[j].x_m - order[i].x_m < merge_m; j++) {
            join(echoes, order[i].index, order[j].index, merge_m);
        }
    }
    free(order);
}

static struct echo *draw_echoes(const struct scenario_plan *plan, size_t index)
{
    struct random random = random_start(plan->sky.seed, STREAM_DETECTIONS, index);
    struct echo *echoes = must_calloc(plan->num_targets + 1, sizeof *echoes);

    for (size_t i = 0; i < plan->num_targets; i++) {
        bool is_faded = plan->sky.is_faded[index * plan->num_targets + i];
        echoes[i] = (struct echo){.truth = plan_truth(plan, index, i),
                                  .group = i,
                                  .is_seen = random_uniform(&random) < plan->pd && !is_faded};
        echoes[i].noise_x_m = plan->noise_m * random_normal(&random);
        echoes[i].noise_y_m = plan->noise_m * random_normal(&random);
    }
    return echoes;
}

/* The plot of a group: at the mean place of its targets, with one's noise and number, if any of them is seen. */
static void add_group(struct simulated_scan *scan, const struct echo *echoes, size_t num_targets,
                      size_t group)
{
    struct simulated_plot plot = {.target_id = -1};
    double count = 0.0;

    for (size_t i = group; i < num_targets; i++) {
        const struct echo *echo = &echoes[i];
        if (group_of(echoes, i) == group) {
            plot.x_m += echo->truth->x_m;
            plot.y_m += echo->truth->y_m;
            count += 1.0;
            if (echo->is_seen && plot.target_id < 0) {
                plot.target_id = echo->truth->target_id;
            }
        }
    }
    plot.x_m = plot.x_m / count + echoes[group].noise_x_m;
    plot.y_m = plot.y_m / count + echoes[group].noise_y_m;
    if (plot.target_id >= 0) {
        scan->plots[scan->num_plots++] = plot;
    }
}

static void add_single(struct simulated_scan *scan, const struct echo *echo)
{
    if (echo->is_seen) {
        scan->plots[scan->num_plots++] =
            (struct simulated_plot){.x_m = echo->truth->x_m + echo->noise_x_m,
                                    .y_m = echo->truth->y_m + echo->noise_y_m,
                                    .target_id = echo->truth->target_id};
    }
}

static void add_targets(const struct scenario_plan *plan, size_t index, struct simulated_scan *scan)
{
    struct echo *echoes = draw_echoes(plan, index);
    bool *is_shared = must_calloc(plan->num_targets + 1, sizeof *is_shared);

    if (plan->sky.merge_m > 0.0) {
        join_close(echoes, plan->num_targets, plan->sky.merge_m);
    }
    for (size_t i = 0; i < plan->num_targets; i++) {
        is_shared[group_of(echoes, i)] |= group_of(echoes, i) != i;
    }
    for (size_t i = 0; i < plan->num_targets; i++) {
        if (is_shared[i]) {
            add_group(scan, echoes, plan->num_targets, i);
        } else if (echoes[i].group == i) {
            add_single(scan, &echoes[i]);
        }
    }
    free(is_shared);
    free(echoes);
}

/* ---- the others' plots ------------------------------------------------------------------------ */

static void add_false(struct simulated_scan *scan, double x_m, double y_m)
{
    scan->plots[scan->num_plots++] =
        (struct simulated_plot){.x_m = x_m, .y_m = y_m, .target_id = -1};
}

/* Uniform in the disc. */
static void add_spot_plot(const struct sky_place *spot, struct simulated_scan *scan,
                          struct random *random)
{
    double dx_m, dy_m;

    do {
        dx_m = random_between(random, -SPOT_RADIUS_M, SPOT_RADIUS_M);
        dy_m = random_between(random, -SPOT_RADIUS_M, SPOT_RADIUS_M);
    } while (hypot(dx_m, dy_m) > SPOT_RADIUS_M);
    add_false(scan, spot->x_m + dx_m, spot->y_m + dy_m);
}

static void add_source_plot(const struct scenario_plan *plan, const struct sky_place *source,
                            struct simulated_scan *scan, struct random *random)
{
    bool is_seen = random_uniform(random) < SOURCE_PD;
    double noise_x_m = plan->noise_m * random_normal(random);
    double noise_y_m = plan->noise_m * random_normal(random);

    if (is_seen) {
        add_false(scan, source->x_m + noise_x_m, source->y_m + noise_y_m);
    }
}

void plan_look_at_sky(const struct scenario_plan *plan, size_t index, struct simulated_scan *scan)
{
    const struct scenario_sky *sky = &plan->sky;
    struct random random = random_start(sky->seed, STREAM_CLUTTER, index);
    struct random shuffle = random_start(sky->seed, STREAM_SHUFFLE, index);
    uint64_t num_clutter = random_poisson(&random, plan->clutter_mean);
    uint64_t num_spot = random_poisson(&random, sky->spot_mean * (double)sky->num_spots);

    scan->t_s = (double)index * plan->interval_s;
    scan->plots = must_calloc(plan->num_targets + num_clutter + num_spot + sky->num_sources + 1,
                              sizeof *scan->plots);
    add_targets(plan, index, scan);
    plan_clutter(scan, &plan->box, num_clutter, &random);
    for (uint64_t i = 0; i < num_spot; i++) {
        add_spot_plot(&sky->spots[random_below(&random, sky->num_spots)], scan, &random);
    }
    for (size_t i = 0; i < sky->num_sources; i++) {
        add_source_plot(plan, &sky->sources[i], scan, &random);
    }
    plan_shuffle(scan, &shuffle);
}
