/* SPDX-License-Identifier: MIT */
#include "experiment_two_radars.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "experiment.h"
#include "workers.h"

#define DEFAULT_RUNS 50
#define DEG_RAD 0.017453292519943295

/* ---- the runs -------------------------------------------------------------------------------- */

struct experiment {
    uint64_t seed;
    struct scene *scene;
    struct radars_run *runs;
    struct pipeline chains[WORKERS_MAX];
};

static void run_one(void *context, size_t worker, size_t index)
{
    struct experiment *experiment = context;

    if (experiment->chains[worker].tracker == NULL) {
        experiment->chains[worker] = pipeline_start();
    }
    experiment->runs[index] =
        radars_run_all(experiment->scene, experiment->seed, index, &experiment->chains[worker]);
}

static void add(struct radars_figures *sum, const struct radars_figures *figures)
{
    sum->times += figures->times;
    sum->target_times += figures->target_times;
    sum->target_hours += figures->target_hours;
    sum->with_track += figures->with_track;
    sum->switches += figures->switches;
    sum->false_tracks += figures->false_tracks;
    sum->tracks += figures->tracks;
    sum->common_times += figures->common_times;
    sum->duplicates += figures->duplicates;
    sum->errors += figures->errors;
    sum->sum_m2 += figures->sum_m2;
    sum->scans += figures->scans;
    sum->late += figures->late;
}

double radars_rmse_m(const struct radars_figures *figures)
{
    return sqrt(figures->sum_m2 / figures->errors);
}

/* ---- errors of the biases -------------------------------------------------------------------- */

static int by_size(const void *a, const void *b)
{
    double one = *(const double *)a, other = *(const double *)b;

    return (one > other) - (one < other);
}

static struct radars_errors errors_of(const struct radars_run *runs, size_t num_runs, size_t kind,
                                      double *sum_squares, double *count)
{
    struct radars_errors errors = {.rms = NAN, .p95 = NAN, .worst = NAN, .mean_sigma = NAN};
    double *off = must_calloc(num_runs * RADARS + 1, sizeof *off), sum = 0.0, sigmas = 0.0;

    for (size_t i = 0; i < num_runs * RADARS; i++) {
        const struct radars_found *found = &runs[i / RADARS].found;
        double error = found->off[i % RADARS][kind], sigma = found->sigma[i % RADARS][kind];

        if (kind == REGISTER_TIME && i % RADARS == 0) {
            continue; /* the reference */
        }
        if (!found->is_any || !found->is_known[i % RADARS][kind]) {
            errors.unknown++;
            continue;
        }
        off[errors.count++] = fabs(error);
        sum += error * error;
        sigmas += sigma;
        *sum_squares += error * error / (sigma * sigma);
        *count += 1.0;
    }
    if (errors.count > 0) {
        qsort(off, errors.count, sizeof *off, by_size);
        errors.rms = sqrt(sum / (double)errors.count);
        errors.mean_sigma = sigmas / (double)errors.count;
        errors.worst = off[errors.count - 1];
        errors.p95 = off[(size_t)ceil(0.95 * (double)errors.count) - 1];
    }
    free(off);
    return errors;
}

static struct radars_summary summarise(const struct experiment *experiment, size_t num_runs)
{
    struct radars_summary summary = {
        .num_runs = num_runs, .seed = experiment->seed, .runs = experiment->runs};
    double sum = 0.0, count = 0.0;

    for (size_t run = 0; run < num_runs; run++) {
        for (size_t i = 0; i < RADARS_CASES; i++) {
            add(&summary.figures[i], &experiment->runs[run].figures[i]);
        }
    }
    for (size_t kind = 0; kind < NUM_REGISTER_KINDS; kind++) {
        summary.errors[kind] = errors_of(experiment->runs, num_runs, kind, &sum, &count);
    }
    summary.variance = sum / count;
    return summary;
}

/* ---- tables ---------------------------------------------------------------------------------- */

static double a_time(double sum, const struct radars_figures *figures)
{
    return sum / figures->common_times;
}

static double an_hour(double sum, const struct radars_figures *figures)
{
    return sum / figures->target_hours;
}

struct grid radars_tracks_grid(const struct radars_summary *summary)
{
    struct grid grid =
        grid_start(1, "tracks|rmse m|duplicates a target|switches a target and hour|completeness|"
                      "false tracks a run|scans refused as late %");

    for (size_t i = 0; i < RADARS_CASES; i++) {
        const struct radars_figures *figures = &summary->figures[i];

        grid_row(&grid, "%s|%.1f|%.4f|%.3f|%.3f|%.2f|%.1f", radars_cases[i].name,
                 radars_rmse_m(figures), a_time(figures->duplicates, figures),
                 an_hour(figures->switches, figures), figures->with_track / figures->target_times,
                 figures->false_tracks / (double)summary->num_runs,
                 100.0 * figures->late / figures->scans);
    }
    return grid;
}

struct grid radars_biases_grid(const struct radars_summary *summary)
{
    static const struct {
        const char *name;
        double unit;
        int digits;
    } kinds[NUM_REGISTER_KINDS] = {
        {"range, m", 1.0, 2}, {"azimuth, deg", DEG_RAD, 4}, {"time, ms", 1e-3, 1}};
    struct grid grid =
        grid_start(1, "bias|estimates|not known|rms error|95 % within|worst|mean sigma");

    for (size_t kind = 0; kind < NUM_REGISTER_KINDS; kind++) {
        const struct radars_errors *errors = &summary->errors[kind];
        const double values[4] = {errors->rms, errors->p95, errors->worst, errors->mean_sigma};
        char texts[4][GRID_NUMBER];
        const char *cells[4];

        for (int i = 0; i < 4; i++) {
            cells[i] = grid_number(texts[i], kinds[kind].digits, values[i] / kinds[kind].unit);
        }
        grid_row(&grid, "%s|%zu|%zu|%s|%s|%s|%s", kinds[kind].name, errors->count, errors->unknown,
                 cells[0], cells[1], cells[2], cells[3]);
    }
    return grid;
}

/*
 * Late scans update tracks: what is lost is seen in how many targets have one, and in identities
 * that change.
 */
static void judge_arrived(const struct radars_summary *summary, struct verdicts *verdicts)
{
    const struct radars_figures *known = &summary->figures[CASE_KNOWN];
    const struct radars_figures *arrived = &summary->figures[CASE_ARRIVED];

    verdicts_at_most(verdicts, radars_rmse_m(arrived) / radars_rmse_m(known), 1.05,
                     "scans as they arrive: rmse over that in order");
    verdicts_at_most(verdicts,
                     known->with_track / known->target_times -
                         arrived->with_track / arrived->target_times,
                     0.02, "scans as they arrive: completeness behind that in order");
    verdicts_at_most(verdicts, an_hour(arrived->switches, arrived), 0.05,
                     "scans as they arrive: switches a target and hour");
}

static struct verdicts judge(const struct radars_summary *summary)
{
    struct verdicts verdicts = verdicts_start();
    const struct radars_figures *found = &summary->figures[CASE_FOUND];
    const struct radars_errors *errors = summary->errors;
    double alone_m = fmin(radars_rmse_m(&summary->figures[CASE_FIRST]),
                          radars_rmse_m(&summary->figures[CASE_SECOND]));

    verdicts_at_most(&verdicts, errors[REGISTER_RANGE].worst, 10.0,
                     "register: range bias, worst error, m");
    verdicts_at_most(&verdicts, errors[REGISTER_AZIMUTH].worst / DEG_RAD, 0.02,
                     "register: azimuth bias, worst error, degrees");
    verdicts_at_most(&verdicts,
                     (double)(errors[REGISTER_RANGE].unknown + errors[REGISTER_AZIMUTH].unknown +
                              errors[REGISTER_TIME].unknown),
                     0.0, "register: biases said to be not known");
    verdicts_at_most(&verdicts, fabs(summary->variance - 1.0), 0.25,
                     "register: variance of errors over sigmas, off 1");
    verdicts_at_most(&verdicts, a_time(found->duplicates, found), 0.02,
                     "biases of register: duplicates a target");
    verdicts_at_most(&verdicts, an_hour(found->switches, found), 0.05,
                     "biases of register: switches a target and hour");
    verdicts_at_most(&verdicts, radars_rmse_m(found) / alone_m, 1.0,
                     "biases of register: rmse over the better radar's alone, biases known");
    judge_arrived(summary, &verdicts);
    return verdicts;
}

/* ---- output ---------------------------------------------------------------------------------- */

static cJSON *case_json(const struct radars_summary *summary, size_t number)
{
    const struct radars_figures *figures = &summary->figures[number];
    cJSON *object = cJSON_CreateObject();

    cJSON_AddStringToObject(object, "case", radars_cases[number].name);
    json_add_number(object, "rmse_m", radars_rmse_m(figures));
    json_add_number(object, "duplicates_per_target", a_time(figures->duplicates, figures));
    json_add_number(object, "switches_per_target_hour", an_hour(figures->switches, figures));
    json_add_number(object, "completeness", figures->with_track / figures->target_times);
    json_add_number(object, "false_tracks_per_run",
                    figures->false_tracks / (double)summary->num_runs);
    json_add_number(object, "scans_late_share", figures->late / figures->scans);
    return object;
}

static cJSON *errors_json(const struct radars_errors *errors)
{
    cJSON *object = cJSON_CreateObject();

    cJSON_AddNumberToObject(object, "estimates", (double)errors->count);
    cJSON_AddNumberToObject(object, "not_known", (double)errors->unknown);
    json_add_number(object, "rms", errors->rms);
    json_add_number(object, "p95", errors->p95);
    json_add_number(object, "worst", errors->worst);
    json_add_number(object, "mean_sigma", errors->mean_sigma);
    return object;
}

static void print_as_json(const struct radars_summary *summary, struct verdicts *verdicts)
{
    cJSON *root = json_experiment("two-radars", summary->num_runs, summary->seed), *list;

    list = cJSON_AddArrayToObject(root, "cases");
    for (size_t i = 0; i < RADARS_CASES; i++) {
        cJSON_AddItemToArray(list, case_json(summary, i));
    }
    cJSON_AddItemToObject(root, "range_bias_m", errors_json(&summary->errors[REGISTER_RANGE]));
    cJSON_AddItemToObject(root, "azimuth_bias_rad",
                          errors_json(&summary->errors[REGISTER_AZIMUTH]));
    cJSON_AddItemToObject(root, "time_bias_s", errors_json(&summary->errors[REGISTER_TIME]));
    json_add_number(root, "errors_over_sigmas_variance", summary->variance);
    verdicts_to_json(verdicts, root);
    json_print(root);
}

static void print_tables(const struct radars_summary *summary, const struct verdicts *verdicts)
{
    struct grid biases = radars_biases_grid(summary), tracks = radars_tracks_grid(summary);

    printf("Two radars that do not know of each other, 20 aircraft, 10 minutes: %zu runs, seed "
           "%llu\n\n",
           summary->num_runs, (unsigned long long)summary->seed);
    grid_print(&biases, stdout);
    printf("\n");
    grid_print(&tracks, stdout);
    printf("\n");
    verdicts_print(verdicts, stdout);
    grid_free(&biases);
    grid_free(&tracks);
}

int experiment_two_radars(const struct command_line *line)
{
    size_t num_runs = line->runs > 0 ? (size_t)line->runs : DEFAULT_RUNS;
    struct experiment *experiment = must_calloc(1, sizeof *experiment);
    struct radars_summary summary;
    struct verdicts verdicts;

    experiment->seed = line->seed;
    experiment->scene = radars_scene();
    experiment->runs = must_calloc(num_runs, sizeof *experiment->runs);
    workers_run(num_runs, "runs", run_one, experiment);
    summary = summarise(experiment, num_runs);
    verdicts = judge(&summary);
    radars_page(&summary, &verdicts,
                line->output != NULL ? line->output : "build/experiment/two-radars");
    if (line->json) {
        print_as_json(&summary, &verdicts);
    } else {
        print_tables(&summary, &verdicts);
    }
    verdicts_free(&verdicts);
    for (size_t i = 0; i < WORKERS_MAX; i++) {
        pipeline_free(&experiment->chains[i]);
    }
    scene_free(experiment->scene);
    free(experiment->runs);
    free(experiment);
    return 0;
}
