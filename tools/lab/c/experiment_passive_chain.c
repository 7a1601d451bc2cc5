/* SPDX-License-Identifier: MIT */
#include "experiment_passive_chain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "clairvoyant_bearings.h"
#include "double_filter.h"
#include "lab_input.h"
#include "pipeline/pipeline.h"
#include "scenario_plan.h"
#include "settings/method.h"
#include "workers.h"

#define STREAM 8000    /* of the first case */
#define FIRST_FRAMES 8 /* that the filter opens with */
#define TARGETS_MAX 8
#define TRACKS_MAX 256
#define NEAR_M 1000.0
#define NEAR_SIGMAS 4.0
#define RMS_RATIO_MAX 1.08

const struct passive_chain_case passive_chain_cases[] = {
    {"2 sensors, 2 targets", 2, 2, 24, 1.0, 0.0, 0.99, 0.02},
    {"2 sensors, 4 targets, P_D 0.9, 1 false", 2, 4, 24, 0.9, 1.0, 0.97, 0.12},
    {"3 sensors, 4 targets, P_D 0.9, 1 false", 3, 4, 24, 0.9, 1.0, 0.99, 0.02},
    {"4 sensors, 6 targets, P_D 0.9, 1 false", 4, 6, 24, 0.9, 1.0, 0.99, 0.02},
    {"2 sensors, no target, 4 false", 2, 0, 60, 0.9, 4.0, NAN, 0.01},
    {"3 sensors, no target, 4 false", 3, 0, 60, 0.9, 4.0, NAN, 0.01},
};
const size_t passive_num_chain_cases = sizeof passive_chain_cases / sizeof *passive_chain_cases;

/* ---- one run --------------------------------------------------------------------------------- */

struct life {
    uint32_t track_id;
    size_t frames, paired;
};

struct run {
    const struct passive_chain_case *of;
    struct parameters parameters;
    struct simulation *simulation;
    struct pipeline *chain;
    double noise_density; /* of the filter, as the tracker has it */
    struct double_filter filters[TARGETS_MAX];
    size_t confirmed_at[TARGETS_MAX]; /* 0: not yet */
    struct life lives[TRACKS_MAX];
    size_t num_lives;
};

struct result {
    size_t tracked, found, false_tracks, pairs;
    double confirmed_sum, off_m2, filter_off_m2, wall_us;
};

static struct parameters parameters_of(const struct passive_chain_case *of)
{
    struct parameters parameters;
    parameters_default(&parameters);
    suggest_passive(&parameters);
    method_suggest(METHOD_PASSIVE, &parameters);
    parameters_suggest(&parameters, PARAMETER_NUM_SCANS, (double)of->frames);
    parameters_suggest(&parameters, PARAMETER_TRUE_PD, of->pd);
    /* slow enough to stay in front of the sensors all the time */
    parameters_suggest(&parameters, PARAMETER_V_MIN_MPS, 150.0);
    parameters_suggest(&parameters, PARAMETER_V_MAX_MPS, 250.0);
    return parameters;
}

static const struct simulated_look *look_of(const struct run *run, size_t frame, size_t sensor)
{
    return &run->simulation->looks[frame * run->of->sensors + sensor];
}

static const struct truth_point *truth_of(const struct run *run, size_t frame, size_t target)
{
    return &run->simulation->truth[frame * run->of->targets + target];
}

/* The target's own bearing in a look, or NULL. */
static const struct simulated_bearing *own_bearing(const struct simulated_look *look, size_t target)
{
    for (size_t i = 0; i < look->num_bearings; i++) {
        if (look->bearings[i].target_id == (int)target) {
            return &look->bearings[i];
        }
    }
    return NULL;
}

/* ---- the filter that knows ------------------------------------------------------------------- */

static size_t gather_own(const struct run *run, size_t target,
                         struct clairvoyant_bearing bearings[FIRST_FRAMES * SCENARIO_SENSORS_MAX])
{
    const struct scenario_passive *passive = &run->simulation->passive;
    double last_s = look_of(run, FIRST_FRAMES - 1, 0)->t_s;
    size_t count = 0;
    for (size_t i = 0; i < FIRST_FRAMES * run->of->sensors; i++) {
        const struct simulated_look *look = &run->simulation->looks[i];
        const struct simulated_bearing *own = own_bearing(look, target);
        if (own) {
            bearings[count++] = (struct clairvoyant_bearing){
                .t_s = look->t_s - last_s,
                .sensor_x_m = passive->sensors[look->sensor].x_m,
                .sensor_y_m = passive->sensors[look->sensor].y_m,
                .bearing_rad = own->bearing_rad,
                .sigma_rad = passive->sigma_rad,
            };
        }
    }
    return count;
}

static void open_filter(struct run *run, size_t target)
{
    struct clairvoyant_bearing bearings[FIRST_FRAMES * SCENARIO_SENSORS_MAX];
    const struct truth_point *truth = truth_of(run, FIRST_FRAMES - 1, target);
    const double start[4] = {truth->x_m, truth->y_m, truth->vx_mps, truth->vy_mps};
    size_t count = gather_own(run, target, bearings);
    struct clairvoyant_course course = clairvoyant_bearings_fit(bearings, count, start);
    struct double_filter *filter = &run->filters[target];
    filter->t_s = truth->t_s;
    memcpy(filter->state, course.state, sizeof filter->state);
    memcpy(filter->covariance, course.covariance, sizeof filter->covariance);
}

static void step_filter(struct run *run, size_t frame, size_t target)
{
    const struct scenario_passive *passive = &run->simulation->passive;
    struct double_filter *filter = &run->filters[target];
    if (frame + 1 == FIRST_FRAMES) {
        open_filter(run, target);
    }
    if (frame + 1 <= FIRST_FRAMES) {
        return;
    }
    double_filter_predict(filter, look_of(run, frame, 0)->t_s, run->noise_density);
    for (size_t sensor = 0; sensor < run->of->sensors; sensor++) {
        const struct simulated_bearing *own = own_bearing(look_of(run, frame, sensor), target);
        if (own) {
            double_filter_update_bearing(filter, passive->sensors[sensor].x_m,
                                         passive->sensors[sensor].y_m, own->bearing_rad,
                                         passive->sigma_rad);
        }
    }
}

/* ---- tracks beside targets ------------------------------------------------------------------- */

static struct life *life_of(struct run *run, uint32_t track_id)
{
    for (size_t i = 0; i < run->num_lives; i++) {
        if (run->lives[i].track_id == track_id) {
            return &run->lives[i];
        }
    }
    if (run->num_lives == TRACKS_MAX) {
        fail(EXIT_RUNTIME, "more than %d tracks in a run of %s", TRACKS_MAX, run->of->name);
    }
    run->lives[run->num_lives].track_id = track_id;
    return &run->lives[run->num_lives++];
}

static double off_m(const struct rho_track_report *track, const struct truth_point *truth)
{
    return hypot((double)track->state[0] - truth->x_m, (double)track->state[1] - truth->y_m);
}

/* The nearest believed track that is near enough, or NULL. */
static const struct rho_track_report *track_of(const struct run *run,
                                               const struct truth_point *truth)
{
    const struct rho_report *report = run->chain->report;
    const struct rho_track_report *nearest = NULL;
    for (int i = 0; i < report->num_tracks; i++) {
        const struct rho_track_report *track = &report->tracks[i];
        if (track->status != RHO_TRACK_TENTATIVE &&
            off_m(track, truth) < fmax(NEAR_M, NEAR_SIGMAS * (double)track->sigma_m) &&
            (!nearest || off_m(track, truth) < off_m(nearest, truth))) {
            nearest = track;
        }
    }
    return nearest;
}

static void compare(struct run *run, size_t frame, size_t target, struct result *result)
{
    const struct truth_point *truth = truth_of(run, frame, target);
    const struct rho_track_report *track = track_of(run, truth);
    const struct double_filter *filter = &run->filters[target];
    if (!track) {
        return;
    }
    life_of(run, track->track_id)->paired++;
    run->confirmed_at[target] =
        run->confirmed_at[target] > 0 ? run->confirmed_at[target] : frame + 1;
    result->tracked += frame + 1 == run->of->frames;
    result->pairs++;
    result->off_m2 += pow(off_m(track, truth), 2.0);
    result->filter_off_m2 +=
        pow(filter->state[0] - truth->x_m, 2.0) + pow(filter->state[1] - truth->y_m, 2.0);
}

static void count_lives(struct run *run)
{
    const struct rho_report *report = run->chain->report;
    for (int i = 0; i < report->num_tracks; i++) {
        if (report->tracks[i].status != RHO_TRACK_TENTATIVE) {
            life_of(run, report->tracks[i].track_id)->frames++;
        }
    }
}

/* ---- frames ---------------------------------------------------------------------------------- */

static void step(struct run *run, size_t frame, struct result *result)
{
    struct rho_bearing_scan scans[SCENARIO_SENSORS_MAX];
    struct rho_bearing *bearings[SCENARIO_SENSORS_MAX] = {NULL};
    for (size_t sensor = 0; sensor < run->of->sensors; sensor++) {
        const struct simulated_look *look = look_of(run, frame, sensor);
        bearings[sensor] = must_calloc(look->num_bearings + 1, sizeof *bearings[sensor]);
        scans[sensor] =
            lab_look(&run->simulation->passive, look, bearings[sensor], look->num_bearings);
    }
    struct rho_frame whole = {
        .time_us = scans[0].time_us, .num_scans = (uint32_t)run->of->sensors, .scans = scans};
    int64_t start_us = clock_us();
    pipeline_step_frame(run->chain, &whole);
    result->wall_us += (double)(clock_us() - start_us);
    for (size_t sensor = 0; sensor < run->of->sensors; sensor++) {
        free(bearings[sensor]);
    }
    count_lives(run);
    for (size_t target = 0; target < run->of->targets; target++) {
        step_filter(run, frame, target);
        compare(run, frame, target, result);
    }
}

static void conclude(const struct run *run, struct result *result)
{
    for (size_t i = 0; i < run->num_lives; i++) {
        result->false_tracks += 2 * run->lives[i].paired < run->lives[i].frames;
    }
    for (size_t target = 0; target < run->of->targets; target++) {
        result->found += run->confirmed_at[target] > 0;
        result->confirmed_sum += (double)run->confirmed_at[target];
    }
}

static struct result make_run(const struct passive_chain_case *of, struct pipeline *chain,
                              uint64_t seed, uint64_t number)
{
    struct result result = {0};
    struct run *run = must_calloc(1, sizeof *run);
    run->of = of;
    run->chain = chain;
    run->parameters = parameters_of(of);
    const struct scenario_bearings drawn = {
        .num_sensors = of->sensors, .num_targets = of->targets, .false_mean = of->false_mean};
    run->simulation = simulate_passive(&drawn, &run->parameters, seed, number);
    /* half of the largest acceleration, kept up for a second: the tracker's */
    run->noise_density = pow(0.5 * run->parameters.value[PARAMETER_ACCEL_MAX_MPS2], 2.0);
    pipeline_open(chain, &run->parameters);
    pipeline_open_passive(chain, &run->parameters);
    for (size_t frame = 0; frame < of->frames; frame++) {
        step(run, frame, &result);
    }
    conclude(run, &result);
    simulation_free(run->simulation);
    free(run);
    return result;
}

/* ---- all runs -------------------------------------------------------------------------------- */

struct batch {
    uint64_t seed;
    size_t num_runs; /* of each case */
    struct result *results;
    struct pipeline chains[WORKERS_MAX];
};

static void run_one(void *context, size_t worker, size_t index)
{
    struct batch *batch = context;
    size_t number = index / batch->num_runs;
    if (!batch->chains[worker].tracker) {
        batch->chains[worker] = pipeline_start();
    }
    batch->results[index] =
        make_run(&passive_chain_cases[number], &batch->chains[worker], batch->seed,
                 (STREAM + number) * 1000000 + index % batch->num_runs);
}

static struct passive_chain_summary summarise(const struct passive_chain_case *of,
                                              const struct result *results, size_t num_runs)
{
    struct result sum = {0};
    for (size_t i = 0; i < num_runs; i++) {
        sum.tracked += results[i].tracked;
        sum.found += results[i].found;
        sum.false_tracks += results[i].false_tracks;
        sum.pairs += results[i].pairs;
        sum.confirmed_sum += results[i].confirmed_sum;
        sum.off_m2 += results[i].off_m2;
        sum.filter_off_m2 += results[i].filter_off_m2;
        sum.wall_us += results[i].wall_us;
    }
    return (struct passive_chain_summary){
        .tracked = (double)sum.tracked / (double)(of->targets * num_runs),
        .confirmed_at = sum.confirmed_sum / (double)sum.found,
        .false_tracks = (double)sum.false_tracks / (double)num_runs,
        .rms_m = sqrt(sum.off_m2 / (double)sum.pairs),
        .filter_rms_m = sqrt(sum.filter_off_m2 / (double)sum.pairs),
        .frame_us = sum.wall_us / (double)(of->frames * num_runs),
    };
}

struct passive_chain_summary *passive_chain_make(uint64_t seed, size_t num_runs)
{
    struct batch *batch = must_calloc(1, sizeof *batch);
    struct passive_chain_summary *summaries =
        must_calloc(passive_num_chain_cases, sizeof *summaries);
    batch->seed = seed;
    batch->num_runs = num_runs;
    batch->results = must_calloc(passive_num_chain_cases * num_runs, sizeof *batch->results);
    workers_run(passive_num_chain_cases * num_runs, "runs", run_one, batch);
    for (size_t i = 0; i < passive_num_chain_cases; i++) {
        summaries[i] = summarise(&passive_chain_cases[i], &batch->results[i * num_runs], num_runs);
    }
    for (size_t i = 0; i < WORKERS_MAX; i++) {
        pipeline_free(&batch->chains[i]);
    }
    free(batch->results);
    free(batch);
    return summaries;
}

/* ---- what it comes to ------------------------------------------------------------------------ */

void passive_chain_judge(const struct passive_chain_summary *summaries, struct verdicts *verdicts)
{
    for (size_t i = 0; i < passive_num_chain_cases; i++) {
        const struct passive_chain_case *of = &passive_chain_cases[i];
        verdicts_at_most(verdicts, summaries[i].false_tracks, of->false_max,
                         "chain, %s: false tracks a run", of->name);
        if (of->targets > 0) {
            verdicts_at_least(verdicts, summaries[i].tracked, of->tracked_min,
                              "chain, %s: tracked at the end", of->name);
            verdicts_at_most(verdicts, summaries[i].rms_m / summaries[i].filter_rms_m,
                             RMS_RATIO_MAX, "chain, %s: rms error over the filter's that knows",
                             of->name);
        }
    }
}

struct grid passive_chain_grid(const struct passive_chain_summary *summaries)
{
    struct grid grid = grid_start(1, "bearings through the tracker|frames|tracked at the end|"
                                     "confirmed at frame|false tracks a run|rms km|filter's|ratio|"
                                     "us a frame");
    for (size_t i = 0; i < passive_num_chain_cases; i++) {
        const struct passive_chain_summary *is = &summaries[i];
        char text[7][GRID_NUMBER];
        grid_row(&grid, "%s|%zu|%s|%s|%s|%s|%s|%s|%s", passive_chain_cases[i].name,
                 passive_chain_cases[i].frames, grid_number(text[0], 3, is->tracked),
                 grid_number(text[1], 2, is->confirmed_at),
                 grid_number(text[2], 3, is->false_tracks),
                 grid_number(text[3], 3, is->rms_m / 1e3),
                 grid_number(text[4], 3, is->filter_rms_m / 1e3),
                 grid_number(text[5], 3, is->rms_m / is->filter_rms_m),
                 grid_number(text[6], 0, is->frame_us));
    }
    return grid;
}

cJSON *passive_chain_json(const struct passive_chain_summary *summaries)
{
    cJSON *list = cJSON_CreateArray();
    for (size_t i = 0; i < passive_num_chain_cases; i++) {
        const struct passive_chain_case *of = &passive_chain_cases[i];
        cJSON *object = cJSON_CreateObject();
        cJSON_AddStringToObject(object, "case", of->name);
        json_add_number(object, "sensors", (double)of->sensors);
        json_add_number(object, "targets", (double)of->targets);
        json_add_number(object, "frames", (double)of->frames);
        json_add_number(object, "tracked", summaries[i].tracked);
        json_add_number(object, "confirmed_at_frame", summaries[i].confirmed_at);
        json_add_number(object, "false_tracks_per_run", summaries[i].false_tracks);
        json_add_number(object, "rms_m", summaries[i].rms_m);
        json_add_number(object, "filter_rms_m", summaries[i].filter_rms_m);
        json_add_number(object, "frame_us", summaries[i].frame_us);
        cJSON_AddItemToArray(list, object);
    }
    return list;
}
