/* SPDX-License-Identifier: MIT */
#include "scene/scene_persistent.h"

#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "base/portable_math.h"

bool folded_motion_at(const struct scene_mover *mover, const struct scene_sensor *sensor,
                      double t_s, struct motion *at)
{
    double dx_m, dy_m, range_m;

    if (mover->path) {
        *at = path_motion_at(mover->path, t_s);
    } else {
        *at = (struct motion){.x_m = mover->x_m + mover->vx_mps * t_s,
                              .y_m = mover->y_m + mover->vy_mps * t_s,
                              .vx_mps = mover->vx_mps,
                              .vy_mps = mover->vy_mps};
    }
    if (mover->circle_m > 0.0) {
        double angle_rad = mover->circle_rad + mover->circle_radps * t_s;
        double c = mover->circle_m * portable_cos(angle_rad),
               s = mover->circle_m * portable_sin(angle_rad);

        at->x_m += c;
        at->y_m += s;
        at->vx_mps -= mover->circle_radps * s;
        at->vy_mps += mover->circle_radps * c;
    }
    if (t_s < mover->from_s || t_s >= mover->until_s) {
        return false;
    }
    if (!(mover->unambiguous_m > 0.0)) {
        return true;
    }
    dx_m = at->x_m - sensor->x_m;
    dy_m = at->y_m - sensor->y_m;
    range_m = portable_hypot(dx_m, dy_m);
    if (range_m <= mover->unambiguous_m) {
        return false;
    }
    at->x_m -= dx_m * (mover->unambiguous_m / range_m);
    at->y_m -= dy_m * (mover->unambiguous_m / range_m);
    return range_m < 2.0 * mover->unambiguous_m;
}

static const struct scene_sensor *first_radar_in_mask(const struct scene *scene, uint32_t sensors)
{
    for (size_t i = 0; i < scene->num_radars; i++) {
        if (sensors >> i & 1) {
            return &scene->sensors[i];
        }
    }
    return &scene->sensors[0];
}

/*
 * Draws a position uniformly over the area of the clutter: its box, else its sector of ranges about
 * its first radar, else the scene's area.
 */
static void draw_clutter_place(const struct scene *scene, const struct scene_clutter *clutter,
                               struct random *random, double *x_m, double *y_m)
{
    const struct scene_sensor *sensor = first_radar_in_mask(scene, clutter->sensors);
    const double *box_m = clutter->has_box ? clutter->box_m : scene->area_m;

    if (clutter->has_box || sensor->is_cartesian) {
        *x_m = random_between(random, box_m[0], box_m[1]);
        *y_m = random_between(random, box_m[2], box_m[3]);
    } else {
        const struct scene_coverage *within =
            clutter->within.has_sector ? &clutter->within : &sensor->coverage;
        struct json_span range =
            clutter->within.range_m.lo < 0.0 ? sensor->coverage.range_m : clutter->within.range_m;
        double range_m = sqrt(random_between(random, range.lo * range.lo, range.hi * range.hi));
        double from_rad = within->has_sector ? within->from_rad : -PORTABLE_PI;
        double to_rad = within->has_sector ? within->to_rad : PORTABLE_PI;
        double azimuth_rad;

        to_rad += to_rad <= from_rad ? PORTABLE_TURN : 0.0;
        azimuth_rad = random_between(random, from_rad, to_rad);
        *x_m = sensor->x_m + range_m * portable_cos(azimuth_rad);
        *y_m = sensor->y_m + range_m * portable_sin(azimuth_rad);
    }
}

/*
 * Draws a bird of a flock: it flies a circle of its own whose centre moves with the flock, with
 * Gaussian offsets of the centres.
 */
static void draw_bird(const struct scene_clutter *clutter, struct random *random,
                      struct scene_mover *mover)
{
    double speed_mps = clutter->speed_mps * (0.5 + random_uniform(random));
    double side = random_uniform(random) < 0.5 ? -1.0 : 1.0;

    mover->x_m = clutter->x_m + clutter->radius_m * random_normal(random);
    mover->y_m = clutter->y_m + clutter->radius_m * random_normal(random);
    mover->vx_mps = clutter->vx_mps;
    mover->vy_mps = clutter->vy_mps;
    mover->circle_m = clutter->radius_m * random_between(random, 0.2, 1.0);
    mover->circle_rad = random_between(random, -PORTABLE_PI, PORTABLE_PI);
    mover->circle_radps = side * speed_mps / mover->circle_m;
}

static void draw_sea_spike(const struct scene *scene, const struct scene_clutter *clutter,
                           struct random *random, struct scene_mover *mover)
{
    double heading_rad;

    draw_clutter_place(scene, clutter, random, &mover->x_m, &mover->y_m);
    heading_rad = random_between(random, -PORTABLE_PI, PORTABLE_PI);
    mover->vx_mps = clutter->speed_mps * portable_cos(heading_rad);
    mover->vy_mps = clutter->speed_mps * portable_sin(heading_rad);
    mover->from_s = random_between(random, fmax(-clutter->life_s.hi, clutter->from_s),
                                   fmin(scene->duration_s, clutter->until_s));
    mover->until_s = mover->from_s + random_in_span(random, clutter->life_s);
    mover->x_m -= mover->vx_mps * mover->from_s;
    mover->y_m -= mover->vy_mps * mover->from_s;
}

/* Number of sea spikes: drawn, or the fixed one. */
static size_t draw_num_spikes(const struct scene *scene, const struct scene_clutter *clutter,
                              struct random *random)
{
    double from_s = fmax(-clutter->life_s.hi, clutter->from_s);
    double until_s = fmin(scene->duration_s, clutter->until_s);

    if (clutter->kind == CLUTTER_SPIKES) {
        return random_poisson(random, fmin(1e6, clutter->per_s * fmax(0.0, until_s - from_s)));
    }
    return clutter->kind == CLUTTER_STANDING || clutter->kind == CLUTTER_FLOCK ? clutter->count : 0;
}

struct scene_mover *draw_persistent_clutter(const struct scene *scene, size_t source, uint64_t seed,
                                            uint64_t run, size_t *count, struct scene_path **paths,
                                            size_t *num_paths)
{
    const struct scene_clutter *clutter = &scene->clutter[source];
    struct random random = scene_random_stream(seed, run, STREAM_WORLD, source, 0, 0);
    struct scene_mover *movers;

    *paths = NULL;
    *num_paths = 0;
    if (clutter->kind == CLUTTER_SECOND_TIME) {
        *paths = targets_draw_paths(&clutter->targets, scene->name, scene->duration_s, seed, run,
                                    source + 1, num_paths);
        *count = *num_paths;
    } else {
        *count = draw_num_spikes(scene, clutter, &random);
    }
    movers = must_calloc(*count + 1, sizeof *movers);
    for (size_t i = 0; i < *count; i++) {
        struct scene_mover *mover = &movers[i];
        struct random own = scene_random_stream(seed, run, STREAM_WORLD, source, i, 1);

        *mover = (struct scene_mover){.from_s = clutter->from_s,
                                      .until_s = clutter->until_s,
                                      .unambiguous_m = clutter->unambiguous_m,
                                      .pd = clutter->pd,
                                      .target_id = -1};
        if (clutter->kind == CLUTTER_STANDING) {
            draw_clutter_place(scene, clutter, &own, &mover->x_m, &mover->y_m);
            if (clutter->places_m) {
                mover->x_m = clutter->places_m[i][0];
                mover->y_m = clutter->places_m[i][1];
            }
        } else if (clutter->kind == CLUTTER_FLOCK) {
            draw_bird(clutter, &own, mover);
        } else if (clutter->kind == CLUTTER_SPIKES) {
            draw_sea_spike(scene, clutter, &own, mover);
        } else {
            mover->path = &(*paths)[i];
            mover->from_s = fmax(mover->from_s, mover->path->from_s);
            mover->until_s = fmin(mover->until_s, mover->path->until_s);
        }
    }
    return movers;
}
