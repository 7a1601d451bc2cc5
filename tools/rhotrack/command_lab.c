/* SPDX-License-Identifier: MIT */
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/common.h"
#include "commands.h"

static const char *const names[] = {"experiment", "bench"};

static const char *const experiments[] = {
    "air-traffic",     "bearings",          "claims",  "dense-windows", "doppler",    "extended",
    "extended-rivals", "false-alarms",      "fusion",  "initiation",    "low-pd",     "maneuver",
    "notch",           "papers-initiation", "passive", "polar",         "real-skies", "rotating",
    "several-radars",  "two-radars"};

enum { NUM_EXPERIMENTS = sizeof experiments / sizeof *experiments };

const char *command_lab_name(size_t index)
{
    return index < sizeof names / sizeof *names ? names[index] : NULL;
}

bool command_lab_has(const char *name)
{
    for (size_t i = 0; command_lab_name(i); i++) {
        if (strcmp(name, command_lab_name(i)) == 0) {
            return true;
        }
    }
    return false;
}

/* Finds the folder of this program's executable; in a source tree that is the build folder. */
static void find_program_folder(char folder[PATH_MAX])
{
    ssize_t length = readlink("/proc/self/exe", folder, PATH_MAX - 1);

    folder[length > 0 ? length : 0] = '\0';
    *(strrchr(folder, '/') ? strrchr(folder, '/') : folder) = '\0';
}

static bool is_experiment_name(const char *name)
{
    for (int i = 0; i < NUM_EXPERIMENTS; i++) {
        if (strcmp(name, experiments[i]) == 0) {
            return true;
        }
    }
    return false;
}

static _Noreturn void refuse_experiment_name(const char *name)
{
    char list[512] = "";
    size_t length = 0;

    for (int i = 0; i < NUM_EXPERIMENTS; i++) {
        length += (size_t)snprintf(list + length, sizeof list - length, "%s%s", i ? ", " : "",
                                   experiments[i]);
    }
    fail(EXIT_USAGE, "%s%s; there are: %s", name ? "no experiment " : "give a name",
         name ? name : "", list);
}

/* Runs the script tools/lab/NAME.py of the source tree, NAME having underscores for hyphens. */
static _Noreturn void run_experiment(char **argv)
{
    char folder[PATH_MAX], path[2 * PATH_MAX], script[64];

    if (!argv[2] || !is_experiment_name(argv[2])) {
        refuse_experiment_name(argv[2]);
    }
    snprintf(script, sizeof script, "tools/lab/%s.py", argv[2]);
    for (char *hyphen; (hyphen = strchr(script, '-'));) {
        *hyphen = '_';
    }
    find_program_folder(folder);
    snprintf(path, sizeof path, "%s/../%s", folder, script);
    if (access(path, X_OK) == 0 && setenv("BUILD", folder, 0) == 0) {
        argv[2] = path;
        execv(path, argv + 2);
    }
    fail(EXIT_RUNTIME, "experiment %s is the script %s of the source (%s)", argv[2], script,
         strerror(errno));
}

/* Replaces this process by the benchmark program rhotrack-lab in this program's folder. */
static _Noreturn void run_bench(char **argv)
{
    char folder[PATH_MAX], path[2 * PATH_MAX];

    find_program_folder(folder);
    snprintf(path, sizeof path, "%s/rhotrack-lab", folder);
    execv(path, argv);
    fail(EXIT_RUNTIME,
         "%s: the lab is a program of its own, rhotrack-lab beside this one, which `make` builds "
         "and `make install` leaves out (%s)",
         argv[1], strerror(errno));
}

void command_lab_execute(char **argv)
{
    if (strcmp(argv[1], "experiment") == 0) {
        run_experiment(argv);
    }
    run_bench(argv);
}
