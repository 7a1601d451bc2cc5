/* SPDX-License-Identifier: MIT */
/*
 * worst_bearing_search: a genetic search for the bearings that cost most in a second, in the
 * configuration of a firmware node with direction finders (tools/firmware/nodes/finders.h): `worst
 * search SEED SKIES` searches, `worst sky GENES` measures a sky that was found before
 * (genetic_search.h). Its work is that of the search for tracks.
 *
 * Four sensors look once a second each, at times of their own, and give up to RHO_MAX_BEARINGS
 * bearings a look. A sky is coded as genes: up to eight targets, their places and spacing, where
 * the sensors stand, how false bearings lie (spread, in heaps, towards the targets, or crossing
 * where no target is), whether they come back, noise, elevations.
 */
#include <string.h>

#include "random_draws.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/passive.h"
#include "rhotrack/settings.h"
#include "rhotrack/tracker.h"

static struct rho_tracker tracker;
static struct rho_passive passive;
static struct rho_report report;
static struct rho_bearing bearings[RHO_MAX_BEARINGS];

#define SENSORS 4u
#define TARGETS_MAX 8
#define SECONDS 16u /* the batch is full after RHO_MAX_PASSIVE_SCANS */

/* ---- genes ----------------------------------------------------------------------------------- */

enum gene {
    TARGETS,     /* number of targets, as a share of TARGETS_MAX */
    SEEN,        /* share of the looks that detect a target */
    RANGE_M,     /* distance of the targets from the sensors */
    SPACING_M,   /* distance from target to target */
    SPEED_SHARE, /* targets' speed, as a share of v_max */
    FALSE_SHARE, /* share of the bearings left of RHO_MAX_BEARINGS that false ones fill */
    SHAPE,       /* false bearings: SPREAD, HEAPED, ON_TARGETS or CROSSING */
    HEAPS,       /* number of heaps, or of places where false bearings cross */
    HEAP_RAD,    /* size of a heap */
    STAYS,       /* share of the false bearings that come back in the sensor's next look */
    SIGMA_RAD,
    BASE_M,     /* distance of the sensors */
    LAYOUT,     /* LINE, RING, or MASTS: two sensors at each of two places */
    APART,      /* time between two sensors' looks, as a share of a quarter of a second */
    ELEVATIONS, /* odd: bearings have elevations */
    QUIET,      /* number of first seconds without false bearings */
    DRAW,       /* seed of the random numbers */
    GENES
};

#include "genetic_search.h"

static const struct range ranges[GENES] = {
    [TARGETS] = {0.0f, 1.0f, 0},        [SEEN] = {0.2f, 1.0f, 0},
    [RANGE_M] = {1000.0f, 90000.0f, 1}, [SPACING_M] = {10.0f, 20000.0f, 1},
    [SPEED_SHARE] = {0.0f, 1.0f, 0},    [FALSE_SHARE] = {0.0f, 1.0f, 0},
    [SHAPE] = {0.0f, 3.99f, 0},         [HEAPS] = {1.0f, 16.99f, 0},
    [HEAP_RAD] = {1e-3f, 1.0f, 1},      [STAYS] = {0.0f, 1.0f, 0},
    [SIGMA_RAD] = {3e-4f, 0.1f, 1},     [BASE_M] = {200.0f, 30000.0f, 1},
    [LAYOUT] = {0.0f, 2.99f, 0},        [APART] = {0.01f, 1.0f, 0},
    [ELEVATIONS] = {0.0f, 1.99f, 0},    [QUIET] = {0.0f, 12.99f, 0},
    [DRAW] = {0.0f, 255.0f, 0},
};

/* ---- the looks of a sky ---------------------------------------------------------------------- */

enum { SPREAD, HEAPED, ON_TARGETS, CROSSING };
enum { LINE, RING, MASTS };

struct place {
    float x_m, y_m;
};

static struct place sensor_at(const struct sky *sky, unsigned sensor)
{
    const float base_m = gene_value(sky, BASE_M);
    const unsigned layout = gene_as_whole_number(sky, LAYOUT);
    if (layout == RING) {
        const float turn_rad = 0.5f * RHO_PI * (float)sensor;
        return (struct place){0.7f * base_m * rho_cos(turn_rad), 0.7f * base_m * rho_sin(turn_rad)};
    }
    return (struct place){0.0f, base_m * (float)(layout == MASTS ? sensor / 2u : sensor)};
}

static struct place target_at(const struct sky *sky, unsigned target, float t_s)
{
    const float spacing_m = gene_value(sky, SPACING_M);
    const float way_m = gene_value(sky, SPEED_SHARE) * passive.config.v_max_mps * t_s;
    const float course_rad = sky->genes[RANGE_M] & 1 ? 0.8f * (float)target : 3.0f;
    const unsigned row = target / 3u;
    return (struct place){gene_value(sky, RANGE_M) + spacing_m * (float)(target % 3u) +
                              way_m * rho_cos(course_rad),
                          spacing_m * ((float)row - 1.0f) + way_m * rho_sin(course_rad)};
}

static float bearing_of(struct place from, struct place to)
{
    return rho_atan2(to.y_m - from.y_m, to.x_m - from.x_m);
}

static unsigned num_targets(const struct sky *sky)
{
    return (unsigned)(gene_value(sky, TARGETS) * TARGETS_MAX + 0.5f);
}

/* The direction of a false bearing, before noise. */
static float false_bearing(const struct sky *sky, struct place from, float t_s)
{
    const unsigned shape = gene_as_whole_number(sky, SHAPE), targets = num_targets(sky);
    const unsigned heap = (unsigned)draw_uniform(0.0f, gene_value(sky, HEAPS));
    if (shape == HEAPED) {
        return -1.2f + 0.15f * (float)heap + draw_normal(gene_value(sky, HEAP_RAD));
    }
    if (shape == ON_TARGETS && targets > 0) {
        return bearing_of(from, target_at(sky, heap % targets, t_s)) +
               draw_normal(gene_value(sky, HEAP_RAD));
    }
    if (shape == CROSSING) { /* where the next targets would be */
        return bearing_of(from, target_at(sky, targets + heap, t_s));
    }
    return draw_uniform(-0.5f * RHO_PI, 0.5f * RHO_PI);
}

static void add_bearing(const struct sky *sky, struct rho_bearing_scan *scan, float true_rad)
{
    const float sigma_rad = gene_value(sky, SIGMA_RAD);
    const int has_elevation = sky->genes[ELEVATIONS] & 1;
    bearings[scan->num_bearings++] =
        (struct rho_bearing){.bearing_rad = rho_angle_wrap(true_rad + draw_normal(sigma_rad)),
                             .sigma_rad = sigma_rad,
                             .elevation_rad = has_elevation ? 0.1f + draw_normal(sigma_rad) : 0.0f,
                             .sigma_elevation_rad = has_elevation ? sigma_rad : 0.0f};
}

/* The bearings of a sensor's look; false ones of its last look are in before. */
static struct rho_bearing_scan draw_look(const struct sky *sky, unsigned sensor, unsigned second)
{
    static float before[SENSORS][RHO_MAX_BEARINGS];
    const struct place from = sensor_at(sky, sensor);
    const float t_s = (float)second + 0.25f * gene_value(sky, APART) * (float)sensor;
    struct rho_bearing_scan scan = {.time_us = (int64_t)(1e6f * t_s) + 1,
                                    .sensor_id = (int32_t)sensor + 1,
                                    .x_m = from.x_m,
                                    .y_m = from.y_m,
                                    .bearings = bearings};
    for (unsigned i = 0; i < num_targets(sky); i++) {
        if (draw_uniform(0.0f, 1.0f) < gene_value(sky, SEEN)) {
            add_bearing(sky, &scan, bearing_of(from, target_at(sky, i, t_s)));
        }
    }
    const unsigned room = RHO_MAX_BEARINGS - scan.num_bearings;
    const unsigned num_false = second < gene_as_whole_number(sky, QUIET)
                                   ? 0
                                   : (unsigned)(gene_value(sky, FALSE_SHARE) * (float)room + 0.5f);
    for (unsigned i = 0; i < num_false; i++) {
        if (second == 0 || !(draw_uniform(0.0f, 1.0f) < gene_value(sky, STAYS))) {
            before[sensor][i] = false_bearing(sky, from, t_s);
        }
        add_bearing(sky, &scan, before[sensor][i]);
    }
    return scan;
}

/* ---- the cost of a sky ----------------------------------------------------------------------- */

static int open_tracker(void)
{
    struct rho_settings settings;
    struct rho_node_config config;
    node_settings(&settings, &config);
    return rho_tracker_init(&tracker, sizeof tracker, &config.tracker) == RHO_OK &&
           rho_passive_init(&passive, sizeof passive, &config.passive) == RHO_OK;
}

static uint32_t count_look_instructions(const struct rho_bearing_scan *scan)
{
    const uint32_t from = count_instructions_now();
    count_begin();
    failed |= rho_tracker_step_bearings(&tracker, &passive, scan, &report) != RHO_OK;
    count_end();
    return count_instructions_between(from, count_instructions_now());
}

static void measure_sky(struct sky *sky)
{
    sky->instructions = sky->work = 0;
    draw_state = 1u + 7919u * sky->genes[DRAW];
    failed |= !open_tracker();
    for (unsigned second = 0; second < SECONDS && !failed; second++) {
        uint32_t instructions = 0;
        for (unsigned sensor = 0; sensor < SENSORS && !failed; sensor++) {
            const struct rho_bearing_scan scan = draw_look(sky, sensor, second);
            instructions += count_look_instructions(&scan);
        }
        if (instructions > sky->instructions) {
            sky->instructions = instructions;
            sky->work = passive.work.spent;
        }
    }
}

int main(int argc, char **argv)
{
    return search_main(argc, argv);
}
