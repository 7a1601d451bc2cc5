/* SPDX-License-Identifier: MIT */
/*
 * experiment_air_traffic_rivals: Stone Soup on the same plots, by tests/bench/air_traffic_stonesoup.py in an interpreter
 * that has the package: $RHOTRACK_STONESOUP_PYTHON, that of `make bench-stonesoup`, or python3.
 */
#include <cjson/cJSON.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common.h"
#include "evaluation_input.h"
#include "experiment_air_traffic.h"
#include "simulation_output.h"

#define TARGETS 50
#define CLUTTER 100
#define NOT_INSTALLED 3 /* the script's exit code */

static const struct {
    const char *name, *method;
} rivals[AIR_RIVALS] = {{"Stone Soup, GNN", "gnn"}, {"Stone Soup, JPDA", "jpda"}};

/* ---- the other program ------------------------------------------------------------------------ */

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
    char *script = existing(".", "tests/bench/air_traffic_stonesoup.py");

    if (script == NULL) {
        script = existing(folder, "../tests/bench/air_traffic_stonesoup.py");
    }
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

/* Runs it, its standard output into the text, its complaints nowhere. Returns the exit code, or -1. */
static int run(char *const arguments[], char *text, size_t bytes)
{
    int ends[2], status = 0;
    size_t length = 0;
    ssize_t count;

    if (pipe(ends) != 0) {
        fail(EXIT_RUNTIME, "pipe: %s", strerror(errno));
    }
    pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], STDOUT_FILENO);
        if (freopen("/dev/null", "w", stderr) != NULL) {
            execvp(arguments[0], arguments);
        }
        _exit(127);
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

/* ---- its figures ------------------------------------------------------------------------------ */

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
    struct evaluation *evaluation = evaluation_read(truth, tracks, air_cutoffs_m[0]);
    struct air_figures figures = air_figures_of(evaluation);

    evaluation_free(evaluation);
    table_free(truth);
    table_free(tracks);
    return figures;
}

static const char *run_rival(const char *folder, const char *script, const char *python,
                             const char *method, struct air_rival *rival)
{
    char text[4096], name[32];
    snprintf(name, sizeof name, "%s.csv", method);
    char *plots = path_join(folder, "plots.csv"), *truth = path_join(folder, "truth.csv");
    char *tracks = path_join(folder, name);
    char *const arguments[] = {(char *)(uintptr_t)python,
                               (char *)(uintptr_t)script,
                               plots,
                               "-o",
                               tracks,
                               "--method",
                               (char *)(uintptr_t)method,
                               NULL};
    const char *missing = NULL;
    int code = run(arguments, text, sizeof text);

    if (code == 0) {
        rival->us = mean_us(text);
        rival->figures = evaluate_files(truth, tracks);
    } else {
        missing =
            code == NOT_INSTALLED || code == 127
                ? "the Python package stonesoup is not installed: `make bench-stonesoup` installs "
                  "it; or name an interpreter that has it in RHOTRACK_STONESOUP_PYTHON"
                : "tests/bench/air_traffic_stonesoup.py failed";
    }
    free(plots);
    free(truth);
    free(tracks);
    return missing;
}

struct air_rivals air_rivals_run(uint64_t seed, const char *folder, struct chain *chain)
{
    struct air_case of = {.targets = TARGETS,
                          .clutter = CLUTTER,
                          .num_scans = AIR_RIVAL_SCANS,
                          .settings = {{0, NAN}}};
    struct parameters parameters = air_parameters(&of);
    struct simulation *simulation = scenario_simulate("air-traffic", &parameters, seed, 0);
    struct air_rivals result = {.clutter = CLUTTER, .targets = TARGETS};
    char *files = path_join(folder, "stonesoup"), *script = find_script(), *python = find_python();
    struct air_result own = air_simulated(&parameters, simulation, false, chain);

    result.own = (struct air_rival){"rhotrack", own.tracks[0], own.us};
    simulation_write("air-traffic", simulation, &parameters, files);
    result.missing = script == NULL ? "tests/bench/air_traffic_stonesoup.py is not there" : NULL;
    for (size_t i = 0; i < AIR_RIVALS && result.missing == NULL; i++) {
        result.others[i].name = rivals[i].name;
        result.missing = run_rival(files, script, python, rivals[i].method, &result.others[i]);
    }
    simulation_free(simulation);
    free(files);
    free(script);
    free(python);
    return result;
}
