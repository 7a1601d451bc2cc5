/* SPDX-License-Identifier: MIT */
/*
 * commands: one function a command of the program, called by main with what the command line said.
 */
#ifndef RHOTRACK_TOOL_COMMANDS_H
#define RHOTRACK_TOOL_COMMANDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "settings/parameters.h"

struct command_line {
    char **arguments; /* beside the options, without the command's own name */
    int num_arguments;
    char **plot_files; /* those of them that may hold plots */
    int num_plot_files;
    const char *output;       /* -o; NULL where not given */
    const char *method;       /* --method; NULL where not given */
    const char *gate;         /* --gate */
    const char *pipeline;     /* --pipeline */
    const char *show;         /* --show; NULL where not given */
    const char *kind;         /* --kind; NULL where not given */
    const char *lcm, *log;    /* --lcm, --log; NULL where not given */
    const char *clutter_map;  /* --clutter-map; NULL where not given */
    const char *snapshot;     /* --snapshot; NULL where not given */
    const char *zone_events;  /* --zone-events; NULL where not given */
    double speed;             /* --speed; default 1; 0: without waiting */
    double seconds;           /* --for; 0 where not given */
    bool print, loop;         /* --print, --loop */
    bool commands;            /* --commands */
    uint16_t metrics;         /* --metrics, a port; 0 where not given */
    uint64_t seed;            /* --seed; default 1 */
    long runs;                /* --runs; 0 where not given */
    bool json;                /* --json */
    bool keep_going;          /* --keep-going */
    bool covariance;          /* --covariance */
    bool by_target;           /* --by-target */
    bool no_input_estimation; /* --no-input-estimation */
    bool follow;              /* --follow */
    struct parameters parameters;
    const char **settings; /* --set, --config and --columns, and after each its value, as typed */
    size_t num_settings;
    const char **scene_sets; /* --set of a scene, as typed */
    size_t num_scene_sets;
};

/* Each returns the program's exit code. */
int command_track(struct command_line *line);
int command_initiate(struct command_line *line);
int command_maintain(struct command_line *line);
int command_simulate(struct command_line *line);
int command_evaluate(struct command_line *line);
int command_plot(struct command_line *line);
int command_convert(struct command_line *line);

/* Refuses input that no origin helps, before one is looked for. Exit 2. */
void command_convert_refuse_radars(const struct command_line *line);

int command_node(struct command_line *line);
int command_publish(struct command_line *line);
int command_command(struct command_line *line);
int command_register(struct command_line *line);
int command_calibrate(struct command_line *line);
int command_config(struct command_line *line);

/*
 * experiment and bench are a program of their own, rhotrack-lab, beside this one: what ships needs
 * nothing of what measures. command_lab_name: NULL past the last one. command_lab runs it with the
 * same arguments and does not return; exit 1 where it is not there.
 */
const char *command_lab_name(size_t index);
bool command_lab_has(const char *name);
_Noreturn void command_lab(char **argv);

#endif
