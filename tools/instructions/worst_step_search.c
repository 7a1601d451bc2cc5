/* SPDX-License-Identifier: MIT */
/*
 * worst_step_search: a genetic search for the scans that cost a step of the tracker the most
 * instructions, in the configuration of a firmware node (tools/firmware/nodes): `worst search SEED
 * SKIES` searches, `worst sky GENES` measures a sky that was found before (genetic_search.h).
 *
 * A sky, a series of scans, is coded as genes: the number of targets and their spacing, how clutter
 * lies (spread, in heaps, on lines, on the targets), whether it comes back in the next scan, noise,
 * measured quantities, plots' own times, sensors.
 */
#include <string.h>

#include "count.h"
#include "node_settings_defaults.h"
#include "random_draws.h"
#include "rhotrack/body.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/tracker.h"

static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_report report;
static struct rho_plot plots[RHO_MAX_PLOTS], before[RHO_MAX_PLOTS];

/* ---- genes ----------------------------------------------------------------------------------- */

enum gene {
    TARGETS,       /* number of targets, as a share of RHO_MAX_TRACKS */
    TARGET_PLOTS,  /* plots of each target */
    TARGET_SIGMAS, /* spread of a target's plots, in standard deviations of range */
    SPACING_M,     /* distance from target to target */
    SPEED_SHARE,   /* targets' speed, as a share of v_max */
    SEEN,          /* share of the scans that detect a target */
    PLOTS,         /* plots of a scan with clutter, as a share of RHO_MAX_PLOTS */
    SHAPE,         /* shape of the clutter: SPREAD, HEAPED, LINED or ON_TARGETS */
    HEAPS,         /* number of heaps or lines of clutter */
    HEAP_M,        /* size of a heap, or distance of the lines */
    STAYS,         /* share of the clutter that comes back in the next scan */
    DRIFTS,        /* odd: clutter that comes back has moved at its velocity */
    PLACE,         /* x of the first target, as a share of the sensor's range */
    SIGMA_RANGE_M,
    SIGMA_RAD,
    SIGMA_RATE_MPS,
    MEASURES,
    SPAN_MPS,  /* ambiguity span of range rates; 1000 and above: not ambiguous */
    RATE_MPS,  /* standard deviation of the clutter's velocity on each axis */
    OWN_TIMES, /* odd: plots have times of their own */
    INTERVAL,  /* time between scans, as a share of NODE_INTERVAL_S */
    SENSORS,
    QUIET, /* number of first scans without clutter */
    DRAW,  /* seed of the random numbers */
    GENES
};

#include "genetic_search.h"

static const struct range ranges[GENES] = {
    [TARGETS] = {0.0f, 1.0f, 0},        [TARGET_PLOTS] = {1.0f, 8.99f, 0},
    [TARGET_SIGMAS] = {0.01f, 5.0f, 1}, [SPACING_M] = {1.0f, 30000.0f, 1},
    [SPEED_SHARE] = {0.0f, 1.1f, 0},    [SEEN] = {0.2f, 1.0f, 0},
    [PLOTS] = {0.0f, 1.0f, 0},          [SHAPE] = {0.0f, 3.99f, 0},
    [HEAPS] = {1.0f, 16.99f, 0},        [HEAP_M] = {0.1f, 30000.0f, 1},
    [STAYS] = {0.0f, 1.0f, 0},          [DRIFTS] = {0.0f, 1.99f, 0},
    [PLACE] = {0.01f, 0.9f, 0},         [SIGMA_RANGE_M] = {0.1f, 3000.0f, 1},
    [SIGMA_RAD] = {1e-4f, 0.3f, 1},     [SIGMA_RATE_MPS] = {0.05f, 100.0f, 1},
    [MEASURES] = {0.0f, 7.99f, 0},      [SPAN_MPS] = {2.0f, 2000.0f, 1},
    [RATE_MPS] = {0.1f, 1000.0f, 1},    [OWN_TIMES] = {0.0f, 1.99f, 0},
    [INTERVAL] = {0.1f, 2.0f, 1},       [SENSORS] = {1.0f, 4.99f, 0},
    [QUIET] = {0.0f, 12.99f, 0},        [DRAW] = {0.0f, 255.0f, 0},
};

/* ---- the scans of a sky ---------------------------------------------------------------------- */

enum { SPREAD, HEAPED, LINED, ON_TARGETS };
#define SCANS 24

struct place {
    float x_m, y_m, vx_mps, vy_mps;
};

static struct place target_at(const struct sky *sky, unsigned target, float t_s)
{
    const float spacing_m = gene_value(sky, SPACING_M);
    const float speed_mps = gene_value(sky, SPEED_SHARE) * NODE_V_MAX_MPS;
    const float course_rad = sky->genes[PLACE] & 1 ? 0.7f * (float)target : 0.3f;
    struct place at = {.vx_mps = speed_mps * rho_cos(course_rad),
                       .vy_mps = speed_mps * rho_sin(course_rad)};
    at.x_m = gene_value(sky, PLACE) * NODE_RANGE_MAX_M + spacing_m * (float)(target % 6u) +
             at.vx_mps * t_s;
    at.y_m = spacing_m * (float)(target / 6u) + at.vy_mps * t_s;
    return at;
}

static uint32_t measured_quantities_of(const struct sky *sky)
{
    const unsigned of = gene_as_whole_number(sky, MEASURES);
    return (of & 1u ? RHO_MEASURES_RANGE_RATE : 0u) | (of & 2u ? RHO_MEASURES_Z : 0u) |
           (of & 4u ? RHO_MEASURES_VELOCITY : 0u);
}

static struct rho_plot make_plot_at(const struct sky *sky, const struct place *at)
{
    const float range_m = rho_sqrt(at->x_m * at->x_m + at->y_m * at->y_m) + 1.0f;
    const float sigma_m = gene_value(sky, SIGMA_RANGE_M);
    const float own_s = sky->genes[OWN_TIMES] & 1 ? draw_uniform(0.0f, 0.9f) * NODE_INTERVAL_S : 0;
    return (struct rho_plot){
        .offset_us = (int32_t)(1e6f * own_s),
        .x_m = at->x_m,
        .y_m = at->y_m,
        .z_m = 100.0f,
        .vx_mps = at->vx_mps,
        .vy_mps = at->vy_mps,
        .range_rate_mps = (at->vx_mps * at->x_m + at->vy_mps * at->y_m) / range_m,
        .sigma_range_m = sigma_m,
        .sigma_cross_m = gene_value(sky, SIGMA_RAD) * range_m + 0.1f,
        .sigma_up_m = sigma_m,
        .sigma_mps = gene_value(sky, SIGMA_RATE_MPS),
        .sigma_range_rate_mps = gene_value(sky, SIGMA_RATE_MPS),
    };
}

static unsigned num_targets(const struct sky *sky)
{
    return (unsigned)(gene_value(sky, TARGETS) * RHO_MAX_TRACKS);
}

/* Writes the plots of detected targets and returns how many there are. */
static unsigned add_target_plots(const struct sky *sky, float t_s)
{
    const unsigned each = gene_as_whole_number(sky, TARGET_PLOTS), targets = num_targets(sky);
    unsigned count = 0;
    for (unsigned i = 0; i < targets; i++) {
        const struct place at = target_at(sky, i, t_s);
        const int is_seen = draw_uniform(0.0f, 1.0f) < gene_value(sky, SEEN);
        for (unsigned k = 0; is_seen && k < each && count < RHO_MAX_PLOTS; k++) {
            struct rho_plot plot = make_plot_at(sky, &at);
            const float spread_m = gene_value(sky, TARGET_SIGMAS) * plot.sigma_range_m;
            plot.x_m += draw_normal(spread_m);
            plot.y_m += draw_normal(spread_m);
            plots[count++] = plot;
        }
    }
    return count;
}

static struct place draw_place_of_clutter(const struct sky *sky, float t_s)
{
    const unsigned shape = gene_as_whole_number(sky, SHAPE),
                   heaps = gene_as_whole_number(sky, HEAPS);
    const unsigned targets = num_targets(sky);
    const unsigned heap = (unsigned)draw_uniform(0.0f, (float)heaps);
    const float heap_m = gene_value(sky, HEAP_M), rate_mps = gene_value(sky, RATE_MPS);
    struct place at = {.vx_mps = draw_normal(rate_mps), .vy_mps = draw_normal(rate_mps)};
    if (shape == SPREAD) {
        at.x_m = draw_uniform(-NODE_RANGE_MAX_M, NODE_RANGE_MAX_M);
        at.y_m = draw_uniform(-NODE_RANGE_MAX_M, NODE_RANGE_MAX_M);
    } else if (shape == LINED) {
        at.x_m = draw_uniform(0.0f, NODE_RANGE_MAX_M);
        at.y_m = heap_m * (float)heap;
    } else {
        const struct place middle =
            target_at(sky, shape == ON_TARGETS && targets > 0 ? heap % targets : 7u * heap, t_s);
        at.x_m = middle.x_m + draw_normal(heap_m);
        at.y_m = middle.y_m + draw_normal(heap_m);
    }
    return at;
}

/*
 * Fills the scan with clutter up to its number of plots and returns how many plots it then has. A
 * share of the clutter repeats a plot of the scan before, in place or moved at its velocity.
 */
static unsigned add_clutter_after_target_plots(const struct sky *sky, unsigned num_target_plots,
                                               unsigned scan, float t_s, float interval_s)
{
    const unsigned most = (unsigned)(gene_value(sky, PLOTS) * RHO_MAX_PLOTS);
    unsigned count = num_target_plots;
    for (; scan >= gene_as_whole_number(sky, QUIET) && count < most; count++) {
        if (draw_uniform(0.0f, 1.0f) < gene_value(sky, STAYS) && before[count].sigma_range_m > 0) {
            const float moved_s = sky->genes[DRIFTS] & 1 ? interval_s : 0.0f;
            plots[count] = before[count];
            plots[count].x_m += moved_s * plots[count].vx_mps;
            plots[count].y_m += moved_s * plots[count].vy_mps;
        } else {
            const struct place at = draw_place_of_clutter(sky, t_s);
            plots[count] = make_plot_at(sky, &at);
        }
    }
    memcpy(before, plots, count * sizeof *plots);
    return count;
}

/* ---- the cost of a sky ----------------------------------------------------------------------- */

static int open_tracker_of_sky(const struct sky *sky)
{
    struct rho_settings settings;
    struct rho_node_config config;
    node_settings(&settings, &config);
    memset(before, 0, sizeof before);
    int is_open =
        rho_tracker_init(&tracker, sizeof tracker, &config.tracker) == RHO_OK &&
        rho_initiator_init(&initiator, sizeof initiator, &config.initiator) == RHO_OK &&
        (NODE_BODY_MAX_M <= 0.0f || rho_tracker_set_body_max(&tracker, NODE_BODY_MAX_M) == RHO_OK);
    for (unsigned i = 0; i < gene_as_whole_number(sky, SENSORS) && i < RHO_MAX_SENSORS && is_open;
         i++) {
        struct rho_sensor sensor = {.sensor_id = (int32_t)i + 1,
                                    .pd = 0.9f,
                                    .x_m = 3000.0f * (float)i,
                                    .range_max_m = NODE_RANGE_MAX_M};
#if RHO_AMBIGUOUS_RANGE_RATES
        const float span_mps = gene_value(sky, SPAN_MPS);
        sensor.range_rate_span_mps = span_mps < 1000.0f ? span_mps : 0.0f;
#endif
        is_open = rho_tracker_set_sensor(&tracker, &sensor) == RHO_OK;
    }
    return is_open;
}

static uint32_t count_step_instructions(const struct rho_scan *scan)
{
    const uint32_t from = count_instructions_now();
    count_begin();
    failed |= rho_tracker_step(&tracker, &initiator, scan, &report) != RHO_OK;
    count_end();
    return count_instructions_between(from, count_instructions_now());
}

/* Tracks through the scans of a sky and stores instructions and work of its worst step. */
static void measure_sky(struct sky *sky)
{
    const float interval_s = gene_value(sky, INTERVAL) * NODE_INTERVAL_S;
    const float middle_s = 0.5f * SCANS * interval_s;
    sky->instructions = sky->work = 0;
    draw_state = 1u + 7919u * sky->genes[DRAW];
    failed |= !open_tracker_of_sky(sky);
    for (unsigned i = 0; i < SCANS && !failed; i++) {
        const float t_s = interval_s * (float)i - middle_s;
        const unsigned targets = add_target_plots(sky, t_s);
        const struct rho_scan scan = {
            .time_us = (int64_t)(1e6f * interval_s) * i,
            .sensor_id = (int32_t)(i % gene_as_whole_number(sky, SENSORS)) + 1,
            .measures = measured_quantities_of(sky),
            .num_plots = add_clutter_after_target_plots(sky, targets, i, t_s, interval_s),
            .plots = plots,
        };
        const uint32_t instructions = count_step_instructions(&scan);
        if (instructions > sky->instructions) {
            sky->instructions = instructions;
            sky->work = tracker.work.work;
        }
    }
}

int main(int argc, char **argv)
{
    return search_main(argc, argv);
}
