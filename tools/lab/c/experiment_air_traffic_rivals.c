/* SPDX-License-Identifier: MIT */
/*
 * experiment_air_traffic_rivals: Stone Soup on the same plots, by
 * tests/bench/air_traffic_stonesoup.py in an interpreter that has the package:
 * $RHOTRACK_STONESOUP_PYTHON, that of `make bench-stonesoup`, or python3.
 */
#include <cjson/cJSON.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/common.h"
#include "evaluation/evaluation_input.h"
#include "experiment_air_traffic.h"
#include "scene_simulation.h"
#include "workers.h"

#define TARGETS 50
#define CLUTTER 100
#define NOT_INSTALLED 3 /* the script's exit code */

static const struct {
    const char *name, *method;
} rivals[AIR_RIVALS] = {{"Stone Soup, GNN", "gnn"}, {"Stone Soup, JPDA", "jpda"}};

/* ---- the other program ----------------------------------------------------------------------- */

/* Folder of this program, in new memory. */
static char *own_folder(void)
{
    char self[400] = ".";
    ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);

    self[length > 0 ? length : 1] = '\0';
    char *end = strrchr(self, '/');
    if (end != NULL) {
        *end = '\0';
    }
    return must_copy(self);
}

/* FOLDER/NAME where it is there, else NULL. */
static char *existing(const char *folder, const char *name)
{
    char *path = path_join(folder, name);

    if (access(path, R_OK) != 0) {
        free(path);
        return NULL;
    }
    return path;
}

static char *find_script(void)
{
    char *folder = own_folder();
    char *script = existing(folder, "../tests/bench/air_traffic_stonesoup.py");

    free(folder);
    return script;
}

static char *find_python(void)
{
    const char *said = getenv("RHOTRACK_STONESOUP_PYTHON");
    char *folder = own_folder();
    char *python = said != NULL ? must_copy(said) : existing(folder, "stonesoup/bin/python3");

    free(folder);
    return python != NULL ? python : must_copy("python3");
}

/* In the child: standard output to the pipe, complaints nowhere. */
static _Noreturn void become(char *const arguments[], int output)
{
    int nowhere = open("/dev/null", O_WRONLY);

    dup2(output, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    execvp(arguments[0], arguments);
    _exit(127);
}

/* Runs it; the text is what it prints. Returns its exit code, or -1. */
static int run(char *const arguments[], char *text, size_t bytes)
{
    int ends[2], status = 0;
    size_t length = 0;
    ssize_t count;

    if (pipe2(ends, O_CLOEXEC) != 0) {
        fail(EXIT_RUNTIME, "pipe: %s", strerror(errno));
    }
    pid_t child = fork();
    if (child == 0) {
        become(arguments, ends[1]);
    }
    close(ends[1]);
    while (child > 0 && (count = read(ends[0], text + length, bytes - 1 - length)) > 0) {
        length += (size_t)count;
    }
    text[length] = '\0';
    close(ends[0]);
    if (child < 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status)) {
        return -1;
    }
    return WEXITSTATUS(status);
}

/* ---- its figures ----------------------------------------------------------------------------- */

/* mean_ms of what it printed, in us; NAN where there is none. */
static double mean_us(const char *text)
{
    cJSON *root = cJSON_Parse(text);
    const cJSON *mean_ms = cJSON_GetObjectItem(root, "mean_ms");
    double us = cJSON_IsNumber(mean_ms) ? 1e3 * mean_ms->valuedouble : NAN;

    cJSON_Delete(root);
    return us;
}

static struct air_figures evaluate_files(const char *truth_path, const char *tracks_path)
{
    struct table *truth = table_read(truth_path, false), *tracks = table_read(tracks_path, false);
    struct parameters parameters;
    struct evaluation *evaluation;
    struct air_figures figures;

    parameters_default(&parameters);
    evaluation = evaluation_read(truth, tracks, &parameters, air_cutoffs_m[0]);
    figures = air_figures_of(evaluation);
    evaluation_free(evaluation);
    table_free(truth);
    table_free(tracks);
    return figures;
}

struct contest {
    char *script, *python;
    char *folders[AIR_RIVAL_RUNS];
    struct air_rival results[AIR_RIVALS * AIR_RIVAL_RUNS]; /* by run, rival */
    const char *missing[AIR_RIVALS * AIR_RIVAL_RUNS];
};

static const char *reason(int code)
{
    if (code == NOT_INSTALLED || code == 127) {
        return "The Python package stonesoup is not installed: `make bench-stonesoup` installs it; "
               "or name "
               "an interpreter that has it in RHOTRACK_STONESOUP_PYTHON.";
    }
    return "tests/bench/air_traffic_stonesoup.py failed.";
}

static void run_rival(void *context, size_t worker, size_t index)
{
    struct contest *contest = context;
    const char *folder = contest->folders[index / AIR_RIVALS];
    char text[4096], name[32], dash_o[] = "-o", dash_method[] = "--method", method[8];
    (void)worker;

    snprintf(method, sizeof method, "%s", rivals[index % AIR_RIVALS].method);
    snprintf(name, sizeof name, "%s.csv", method);
    char *plots = path_join(folder, "plots.csv"), *truth = path_join(folder, "truth.csv");
    char *tracks = path_join(folder, name);
    char *const arguments[] = {contest->python, contest->script, plots,  dash_o,
                               tracks,          dash_method,     method, NULL};
    int code = run(arguments, text, sizeof text);
    if (code == 0 && access(tracks, R_OK) == 0 && isfinite(mean_us(text))) {
        contest->results[index].us = mean_us(text);
        contest->results[index].figures = evaluate_files(truth, tracks);
    } else {
        contest->missing[index] = reason(code == 0 ? 1 : code);
    }
    free(plots);
    free(truth);
    free(tracks);
}

static const char *run_rivals(struct contest *contest, size_t num_runs)
{
    contest->script = find_script();
    contest->python = find_python();
    if (contest->script == NULL) {
        contest->missing[0] = "tests/bench/air_traffic_stonesoup.py is not there.";
    } else {
        workers_run(AIR_RIVALS * num_runs, "rivals", run_rival, contest);
    }
    free(contest->script);
    free(contest->python);
    for (size_t i = 0; i < AIR_RIVALS * num_runs; i++) {
        if (contest->missing[i] != NULL) {
            return contest->missing[i];
        }
    }
    return NULL;
}

/* ---- the same plots -------------------------------------------------------------------------- */

/* Sums; the least time. */
static void add(struct air_rival *sum, const char *name, const struct air_rival *of)
{
    sum->name = name;
    sum->us = sum->us <= 0.0 ? of->us : fmin(sum->us, of->us);
    air_figures_add(&sum->figures, &of->figures);
}

/* rhotrack, and the files for the others. */
static struct air_rival run_own(uint64_t seed, size_t run, const char *folder,
                                struct pipeline *chain)
{
    const struct air_case of = {
        .targets = TARGETS, .clutter = CLUTTER, .num_scans = AIR_RIVAL_SCANS};
    struct scene *scene = air_scene(&of);
    struct parameters parameters = scene_parameters(scene);
    struct simulation *simulation = scene_simulation(scene, seed, run);
    struct air_result result = air_simulated(&parameters, simulation, false, chain);

    scene_simulate(scene, "air-traffic", folder, seed, run);
    simulation_free(simulation);
    scene_free(scene);
    return (struct air_rival){.figures = result.tracks[0], .us = result.us};
}

struct air_rivals air_rivals_run(uint64_t seed, size_t num_runs, const char *folder,
                                 struct pipeline *chain)
{
    struct contest contest = {.script = NULL};
    struct air_rivals result = {.num_runs = num_runs < AIR_RIVAL_RUNS ? num_runs : AIR_RIVAL_RUNS};

    for (size_t run = 0; run < result.num_runs; run++) {
        char name[32];
        snprintf(name, sizeof name, "stonesoup/run-%04zu", run);
        contest.folders[run] = path_join(folder, name);
        struct air_rival own = run_own(seed, run, contest.folders[run], chain);
        add(&result.own, "rhotrack", &own);
    }
    result.missing = run_rivals(&contest, result.num_runs);
    for (size_t i = 0; i < AIR_RIVALS * result.num_runs; i++) {
        add(&result.others[i % AIR_RIVALS], rivals[i % AIR_RIVALS].name, &contest.results[i]);
    }
    air_figures_divide(&result.own.figures, (double)result.num_runs);
    for (size_t i = 0; i < AIR_RIVALS; i++) {
        air_figures_divide(&result.others[i].figures, (double)result.num_runs);
    }
    for (size_t run = 0; run < result.num_runs; run++) {
        free(contest.folders[run]);
    }
    return result;
}
