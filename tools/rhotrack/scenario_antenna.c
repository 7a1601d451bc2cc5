/* SPDX-License-Identifier: MIT */
#include "scenario_antenna.h"

#include <math.h>
#include <stdlib.h>

#include "common.h"

#define TURN_RAD 6.283185307179586
#define RANGE_LEAST_M 0.01 /* a file's last digit */
#define MEETING_STEPS                                                                              \
    16 /* each leaves the ratio of the angular speeds: 1e-2 at worst in practice */

/* ---- where the antenna is --------------------------------------------------------------------- */

static double direction(const struct scenario_antenna *antenna)
{
    return antenna->is_counter_clockwise ? 1.0 : -1.0;
}

double antenna_azimuth_rad(const struct scenario_antenna *antenna, double t_s)
{
    double turns = (t_s - antenna->start_s) / antenna->turn_s;

    return remainder(antenna->start_rad + direction(antenna) * TURN_RAD * (turns - floor(turns)),
                     TURN_RAD);
}

/* Where sector `index` begins: the same number every turn. */
static double border_rad(const struct scenario_antenna *antenna, size_t index)
{
    double share = (double)(index % antenna->sectors) / (double)antenna->sectors;

    return remainder(antenna->start_rad + direction(antenna) * TURN_RAD * share, TURN_RAD);
}

struct antenna_sector antenna_sector_at(const struct scenario_antenna *antenna, size_t index)
{
    double sector_s = antenna->turn_s / (double)antenna->sectors;
    struct antenna_sector sector = {.start_s = antenna->start_s + (double)index * sector_s,
                                    .end_s = antenna->start_s + (double)(index + 1) * sector_s};

    if (antenna->sectors > 1) {
        double first_rad = border_rad(antenna, index), last_rad = border_rad(antenna, index + 1);

        sector.from_rad = antenna->is_counter_clockwise ? first_rad : last_rad;
        sector.to_rad = antenna->is_counter_clockwise ? last_rad : first_rad;
    }
    return sector;
}

/* ---- targets ---------------------------------------------------------------------------------- */

/* How far the antenna, at a time of its clock, still has to turn to the target: within half a turn either way. */
static bool turns_ahead(const struct scenario_antenna *antenna,
                        const struct antenna_targets *targets, size_t target, double t_s,
                        struct truth_point *truth, double *turns)
{
    double azimuth_rad;

    if (!targets->at(targets->context, target, t_s - antenna->time_bias_s, truth)) {
        return false;
    }
    azimuth_rad = atan2(truth->y_m - antenna->y_m, truth->x_m - antenna->x_m);
    *turns = direction(antenna) *
             remainder(azimuth_rad + antenna->azimuth_bias_rad - antenna_azimuth_rad(antenna, t_s),
                       TURN_RAD) /
             TURN_RAD;
    return true;
}

bool antenna_meets(const struct scenario_antenna *antenna, const struct antenna_targets *targets,
                   size_t target, double after_s, double *t_s, struct truth_point *truth)
{
    double turns = 0.0, at_s = after_s;

    if (!turns_ahead(antenna, targets, target, at_s, truth, &turns)) {
        return false;
    }
    at_s += (turns > 0.0 ? turns : turns + 1.0) * antenna->turn_s;
    for (int i = 0; i < MEETING_STEPS; i++) {
        if (!turns_ahead(antenna, targets, target, at_s, truth, &turns)) {
            return false;
        }
        at_s += turns * antenna->turn_s;
    }
    *t_s = at_s;
    return true;
}

struct antenna_plot antenna_measure(const struct scenario_antenna *antenna, double t_s,
                                    const struct truth_point *truth, struct random *random)
{
    double x_m = truth->x_m - antenna->x_m, y_m = truth->y_m - antenna->y_m;
    double range_m = hypot(x_m, y_m);
    double noise_m = antenna->sigma_range_m * random_normal(random);
    double noise_rad = antenna->sigma_azimuth_rad * random_normal(random);
    double noise_mps = antenna->sigma_range_rate_mps * random_normal(random);
    double rate_mps = (x_m * truth->vx_mps + y_m * truth->vy_mps) / range_m;

    return (struct antenna_plot){
        .t_s = t_s,
        .target_id = truth->target_id,
        .truth = *truth,
        .range_m = fmax(RANGE_LEAST_M, range_m + antenna->range_bias_m + noise_m),
        .azimuth_rad = remainder(atan2(y_m, x_m) + antenna->azimuth_bias_rad + noise_rad, TURN_RAD),
        .range_rate_mps = antenna->has_range_rate ? rate_mps + noise_mps : 0.0};
}

/* ---- all plots -------------------------------------------------------------------------------- */

struct watch {
    const struct scenario_antenna *antenna;
    const struct antenna_targets *targets;
    double end_s;
    struct random *random;
    struct antenna_plot *plots;
    size_t num_plots, room;
};

static void keep(struct watch *watch, struct antenna_plot plot)
{
    watch->plots = must_grow(watch->plots, watch->num_plots, &watch->room, sizeof *watch->plots);
    watch->plots[watch->num_plots++] = plot;
}

static bool is_in_reach(const struct scenario_antenna *antenna, const struct truth_point *truth)
{
    double range_m = hypot(truth->x_m - antenna->x_m, truth->y_m - antenna->y_m);

    return range_m > 0.0 && range_m >= antenna->range_min_m && range_m <= antenna->range_max_m;
}

#define AGAIN_TURNS 0.5        /* a target that has just been met is not met again before */
#define ABSENT_TURNS (1. / 16) /* one that is not there is looked for again then */

static void watch_target(struct watch *watch, size_t target)
{
    const struct scenario_antenna *antenna = watch->antenna;
    double after_s = antenna->start_s, t_s;
    struct truth_point truth;

    while (after_s < watch->end_s) {
        if (!antenna_meets(antenna, watch->targets, target, after_s, &t_s, &truth)) {
            after_s += ABSENT_TURNS * antenna->turn_s;
            continue;
        }
        /* a target that runs before the antenna may have been met just before */
        if (t_s >= antenna->start_s && t_s < watch->end_s && is_in_reach(antenna, &truth)) {
            bool is_seen = random_uniform(watch->random) < antenna->pd;
            struct antenna_plot plot = antenna_measure(antenna, t_s, &truth, watch->random);

            if (is_seen) {
                keep(watch, plot);
            }
        }
        after_s = t_s + AGAIN_TURNS * antenna->turn_s;
    }
}

static void watch_clutter(struct watch *watch, size_t num_turns)
{
    const struct scenario_antenna *antenna = watch->antenna;

    for (size_t turn = 0; turn < num_turns; turn++) {
        uint64_t count = random_poisson(watch->random, antenna->clutter_mean);

        for (uint64_t i = 0; i < count; i++) {
            double turns = (double)turn + random_uniform(watch->random);
            struct antenna_plot plot = {.t_s = antenna->start_s + turns * antenna->turn_s,
                                        .target_id = -1};
            double rate_mps = random_between(watch->random, -antenna->clutter_rate_max_mps,
                                             antenna->clutter_rate_max_mps);

            plot.range_m = fmax(RANGE_LEAST_M, random_between(watch->random, antenna->range_min_m,
                                                              antenna->range_max_m));
            plot.azimuth_rad = antenna_azimuth_rad(antenna, plot.t_s);
            plot.range_rate_mps = antenna->has_range_rate ? rate_mps : 0.0;
            keep(watch, plot);
        }
    }
}

static int by_time(const void *a, const void *b)
{
    const struct antenna_plot *one = a, *other = b;

    return (one->t_s > other->t_s) - (one->t_s < other->t_s);
}

struct antenna_view antenna_watch(const struct scenario_antenna *antenna,
                                  const struct antenna_targets *targets, size_t num_turns,
                                  struct random *random)
{
    struct watch watch = {.antenna = antenna, .targets = targets, .random = random};
    struct antenna_view view = {.num_sectors = num_turns * antenna->sectors};
    size_t taken = 0;

    watch.end_s = antenna->start_s + (double)num_turns * antenna->turn_s;
    for (size_t target = 0; target < targets->count; target++) {
        watch_target(&watch, target);
    }
    watch_clutter(&watch, num_turns);
    if (watch.num_plots > 0) {
        qsort(watch.plots, watch.num_plots, sizeof *watch.plots, by_time);
    }
    view.plots = watch.plots;
    view.sectors = must_calloc(view.num_sectors + 1, sizeof *view.sectors);
    for (size_t i = 0; i < view.num_sectors; i++) {
        struct antenna_sector *sector = &view.sectors[i];
        size_t first = taken;

        *sector = antenna_sector_at(antenna, i);
        while (taken < watch.num_plots &&
               (watch.plots[taken].t_s < sector->end_s || i + 1 == view.num_sectors)) {
            taken++;
        }
        sector->plots = watch.plots ? watch.plots + first : NULL;
        sector->num_plots = taken - first;
    }
    return view;
}

void antenna_view_free(struct antenna_view *view)
{
    free(view->sectors);
    free(view->plots);
    *view = (struct antenna_view){.num_sectors = 0};
}
