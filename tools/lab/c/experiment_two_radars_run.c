/* SPDX-License-Identifier: MIT */
/*
 * experiment_two_radars_run: one run: register, then the tracker over the same plots in all cases.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "evaluation/evaluation.h"
#include "experiment_two_radars.h"
#include "scene_simulation.h"

#define LOOK_S 1.0      /* tracks are looked at so often */
#define BORDER_M 2000.0 /* so near to the end of a radar's reach a target counts for nothing */

const struct radars_case radars_cases[RADARS_CASES] = {
    {"radar 1 alone, biases known", 1, BIASES_KNOWN, false},
    {"radar 2 alone, biases known", 2, BIASES_KNOWN, false},
    {"both, biases left", 3, BIASES_LEFT, false},
    {"both, biases of register", 3, BIASES_FOUND, false},
    {"both, biases known", 3, BIASES_KNOWN, false},
    {"both, known, scans as they arrive", 3, BIASES_KNOWN, true},
};

struct scene *radars_scene(void)
{
    return scene_find("two-radars", NULL, 0);
}

/* ---- register -------------------------------------------------------------------------------- */

struct register_result radars_register(const struct scene_run *run,
                                       const struct parameters *parameters, struct pipeline *chain)
{
    struct register_data *data = register_start(parameters);
    struct register_result result;

    for (size_t i = 0; i < run->num_scans; i++) {
        struct rho_sensor sensor = scene_known_sensor(&run->scene->sensors[run->scans[i].sensor]);
        struct rho_scan scan = scene_scan(run, &run->scans[i], &sensor, chain->plots);
        const char *wrong = register_add(data, &scan, &sensor);

        if (wrong) {
            fail(EXIT_RUNTIME, "two-radars: sensor %d: %s", (int)sensor.sensor_id, wrong);
        }
    }
    result = register_estimate(data, chain);
    register_free(data);
    return result;
}

static double true_bias(const struct scene_sensor *radar, size_t kind)
{
    const double biases[NUM_REGISTER_KINDS] = {radar->range_bias_m, radar->azimuth_bias_rad,
                                               radar->time_bias_s};

    return biases[kind];
}

static struct radars_found found_of(const struct scene *scene, const struct register_result *result)
{
    struct radars_found found = {.is_any = result->targets > 0,
                                 .targets = (double)result->targets,
                                 .misfit = result->misfit};

    for (size_t i = 0; i < RADARS; i++) {
        for (size_t kind = 0; kind < NUM_REGISTER_KINDS; kind++) {
            const struct register_bias *bias = &result->radars[i].biases[kind];

            found.is_known[i][kind] = bias->is_known;
            found.off[i][kind] = bias->value - true_bias(&scene->sensors[i], kind);
            found.sigma[i][kind] = bias->sigma;
        }
    }
    return found;
}

/* ---- tracks ---------------------------------------------------------------------------------- */

struct looking {
    const struct radars_case *of;
    const struct scene_run *run;
    struct pipeline *chain;
    struct radars_figures *figures;
    struct evaluation *evaluation;
    double cutoff_m, looked_s;
    struct motion *truth; /* of all targets, at the time that is looked at */
    struct evaluation_point *targets, *tracks;
    size_t num_targets, num_tracks;
    bool *is_common; /* of the targets */
};

/* Bits: 1 the first radar, 2 the second. */
static unsigned seen_by(const struct scene *scene, const struct motion *at)
{
    unsigned seen = 0;

    for (unsigned i = 0; i < RADARS; i++) {
        const struct scene_sensor *radar = &scene->sensors[i];
        double range_m = hypot(at->x_m - radar->x_m, at->y_m - radar->y_m);

        if (range_m >= radar->coverage.range_m.lo + BORDER_M &&
            range_m <= radar->coverage.range_m.hi - BORDER_M) {
            seen |= 1u << i;
        }
    }
    return seen;
}

/* Targets at a time that the case's radars see. */
static void take_targets(struct looking *looking, double t_s)
{
    looking->num_targets = 0;
    for (size_t i = 0; i < looking->run->num_paths; i++) {
        struct motion at = looking->truth[i] = path_at(&looking->run->paths[i], t_s);
        unsigned seen = seen_by(looking->run->scene, &at);

        if (seen & looking->of->radars) {
            looking->is_common[looking->num_targets] = seen == 3u;
            looking->targets[looking->num_targets++] =
                (struct evaluation_point){.id = (int32_t)i,
                                          .x_m = at.x_m,
                                          .y_m = at.y_m,
                                          .vx_mps = at.vx_mps,
                                          .vy_mps = at.vy_mps};
        }
    }
}

/* A track of a target that does not count, at a border, counts for nothing either. */
static bool is_at_border(const struct looking *looking, double x_m, double y_m)
{
    double nearest_m = INFINITY;
    bool is_counted = false;

    for (size_t i = 0; i < looking->run->num_paths; i++) {
        const struct motion *at = &looking->truth[i];
        double distance_m = hypot(x_m - at->x_m, y_m - at->y_m);

        if (distance_m < nearest_m) {
            nearest_m = distance_m;
            is_counted = (looking->of->radars & seen_by(looking->run->scene, at)) != 0;
        }
    }
    return nearest_m <= looking->cutoff_m && !is_counted;
}

static void take_tracks(struct looking *looking)
{
    const struct rho_report *report = looking->chain->report;

    looking->num_tracks = 0;
    for (unsigned i = 0; i < report->num_tracks; i++) {
        const struct rho_track_report *from = &report->tracks[i];
        double x_m = (double)from->state[0], y_m = (double)from->state[1];

        if (from->status != RHO_TRACK_TENTATIVE && !is_at_border(looking, x_m, y_m)) {
            looking->tracks[looking->num_tracks++] =
                (struct evaluation_point){.id = (int32_t)from->track_id,
                                          .x_m = x_m,
                                          .y_m = y_m,
                                          .vx_mps = (double)from->state[3],
                                          .vy_mps = (double)from->state[4],
                                          .cov_xx_m2 = NAN,
                                          .cov_yx_m2 = NAN,
                                          .cov_yy_m2 = NAN};
        }
    }
}

/* The nearest target within the cutoff; num_targets: none. */
static size_t nearest_target(const struct looking *looking, const struct evaluation_point *track,
                             double *distance_m)
{
    size_t nearest = looking->num_targets;

    *distance_m = looking->cutoff_m;
    for (size_t i = 0; i < looking->num_targets; i++) {
        double d_m =
            hypot(track->x_m - looking->targets[i].x_m, track->y_m - looking->targets[i].y_m);

        if (d_m <= *distance_m) {
            *distance_m = d_m;
            nearest = i;
        }
    }
    return nearest;
}

/* Where both radars see: how many tracks a target has, and how far off the nearest is. */
static void compare_common(struct looking *looking)
{
    size_t *counts = must_calloc(looking->num_targets + 1, sizeof *counts);
    double *least_m = must_calloc(looking->num_targets + 1, sizeof *least_m);

    for (size_t i = 0; i < looking->num_tracks; i++) {
        double distance_m;
        size_t target = nearest_target(looking, &looking->tracks[i], &distance_m);

        if (target < looking->num_targets) {
            least_m[target] = counts[target] == 0 ? distance_m : fmin(least_m[target], distance_m);
            counts[target]++;
        }
    }
    for (size_t i = 0; i < looking->num_targets; i++) {
        if (!looking->is_common[i]) {
            continue;
        }
        looking->figures->common_times += 1.0;
        if (counts[i] > 0) {
            looking->figures->duplicates += (double)(counts[i] - 1);
            looking->figures->errors += 1.0;
            looking->figures->sum_m2 += least_m[i] * least_m[i];
        }
    }
    free(counts);
    free(least_m);
}

static void look(struct looking *looking, int64_t time_us)
{
    double t_s = (double)time_us * 1e-6;

    if (t_s < looking->looked_s + LOOK_S) {
        return;
    }
    take_targets(looking, t_s);
    take_tracks(looking);
    looking->figures->times += 1.0;
    looking->figures->target_times += (double)looking->num_targets;
    if (looking->looked_s > -INFINITY) {
        looking->figures->target_hours +=
            (double)looking->num_targets * (t_s - looking->looked_s) / 3600.0;
    }
    looking->looked_s = t_s;
    compare_common(looking);
    evaluation_time(looking->evaluation, time_us, looking->targets, looking->num_targets,
                    looking->tracks, looking->num_tracks);
}

static void finish(struct looking *looking)
{
    struct evaluation_result result = evaluation_result(looking->evaluation);
    struct radars_figures *figures = looking->figures;
    const struct rho_tracker_counters *counters = &looking->chain->tracker->counters;

    figures->with_track = result.completeness * figures->target_times;
    figures->switches = (double)result.switches;
    figures->false_tracks = (double)result.false_tracks;
    figures->tracks = (double)result.tracks;
    figures->late = (double)counters->scans_late;
    evaluation_free(looking->evaluation);
    free(looking->truth);
    free(looking->targets);
    free(looking->tracks);
    free(looking->is_common);
}

/* ---- scans ----------------------------------------------------------------------------------- */

static int by_time(const void *a, const void *b)
{
    const struct scene_scan *one = a, *other = b;

    if (one->end_s < other->end_s || one->end_s > other->end_s) {
        return one->end_s > other->end_s ? 1 : -1;
    }
    return (one->sensor > other->sensor) - (one->sensor < other->sensor);
}

static struct scene_scan *order_scans(const struct scene_run *run, bool is_as_arrived)
{
    struct scene_scan *scans = must_calloc(run->num_scans + 1, sizeof *scans);

    memcpy(scans, run->scans, run->num_scans * sizeof *scans);
    if (!is_as_arrived && run->num_scans > 0) {
        qsort(scans, run->num_scans, sizeof *scans, by_time);
    }
    return scans;
}

static struct rho_sensor sensor_of(const struct radars_case *of, const struct scene_sensor *told,
                                   const struct radars_found *found, size_t radar)
{
    struct rho_sensor sensor = scene_known_sensor(told);
    double biases[NUM_REGISTER_KINDS] = {0};

    for (size_t kind = 0; kind < NUM_REGISTER_KINDS; kind++) {
        if (of->biases == BIASES_KNOWN) {
            biases[kind] = true_bias(told, kind);
        } else if (of->biases == BIASES_FOUND && found->is_known[radar][kind]) {
            biases[kind] = true_bias(told, kind) + found->off[radar][kind];
        }
    }
    sensor.range_bias_m = (float)biases[REGISTER_RANGE];
    sensor.azimuth_bias_rad = (float)biases[REGISTER_AZIMUTH];
    sensor.time_bias_s = (float)biases[REGISTER_TIME];
    return sensor;
}

static void open_looking(struct looking *looking, const struct parameters *parameters)
{
    size_t count = looking->run->num_paths;

    looking->cutoff_m = parameters->value[PARAMETER_GOSPA_CUTOFF_M];
    looking->looked_s = -INFINITY;
    looking->evaluation = evaluation_start(looking->cutoff_m);
    looking->truth = must_calloc(count + 1, sizeof *looking->truth);
    looking->targets = must_calloc(count + 1, sizeof *looking->targets);
    looking->is_common = must_calloc(count + 1, sizeof *looking->is_common);
    looking->tracks = must_calloc(RHO_MAX_TRACKS, sizeof *looking->tracks);
}

static struct radars_figures run_case(const struct radars_case *of, const struct scene_run *run,
                                      const struct parameters *parameters,
                                      const struct radars_found *found, struct pipeline *chain)
{
    struct radars_figures figures = {0};
    struct scene_scan *scans = order_scans(run, of->is_as_arrived);
    struct looking looking = {.of = of, .run = run, .chain = chain, .figures = &figures};
    struct rho_sensor sensors[RADARS];

    open_looking(&looking, parameters);
    pipeline_open(chain, parameters);
    for (size_t i = 0; i < RADARS; i++) {
        sensors[i] = sensor_of(of, &run->scene->sensors[i], found, i);
        must_succeed(rho_tracker_set_sensor(chain->tracker, &sensors[i]), "sensor");
    }
    for (size_t i = 0; i < run->num_scans; i++) {
        size_t radar = scans[i].sensor;

        if (of->radars & 1u << radar) {
            struct rho_scan scan = scene_scan(run, &scans[i], &sensors[radar], chain->plots);

            pipeline_step(chain, &scan);
            figures.scans += 1.0;
            look(&looking, scan.time_us);
        }
    }
    finish(&looking);
    free(scans);
    return figures;
}

struct radars_run radars_run_all(const struct scene *scene, uint64_t seed, uint64_t run,
                                 struct pipeline *chain)
{
    struct parameters parameters = scene_parameters(scene);
    struct scene_run *seen = scene_observe(scene, seed, run);
    struct register_result result = radars_register(seen, &parameters, chain);
    struct radars_run out = {.found = found_of(scene, &result)};

    for (size_t i = 0; i < RADARS_CASES; i++) {
        out.figures[i] = run_case(&radars_cases[i], seen, &parameters, &out.found, chain);
    }
    register_result_free(&result);
    scene_run_free(seen);
    return out;
}
