/* SPDX-License-Identifier: MIT */
/*
 * commands: the commands of the program, one function each, and the parsed command
 * line.
 */
#ifndef RHOTRACK_TOOL_COMMANDS_H
#define RHOTRACK_TOOL_COMMANDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "settings/parameters.h"

struct command_line {
    char **arguments; /* arguments without options and the command's name */
    int num_arguments;
    char **plot_files; /* the arguments that may hold plots */
    int num_plot_files;
    const char *output;       /* -o; NULL where not given */
    const char *method;       /* --method; NULL where not given */
    const char *gate;         /* --gate; NULL where not given */
    const char *pipeline;     /* --pipeline; NULL where not given */
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
    const char *commanders;   /* --commands-from; NULL where not given */
    bool standby;             /* --standby */
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

/* Each command runs with the parsed command line, and returns the program's exit code. */
int command_track(struct command_line *line);
int command_initiate(struct command_line *line);
int command_maintain(struct command_line *line);
int command_simulate(struct command_line *line);
int command_evaluate(struct command_line *line);
int command_plot(struct command_line *line);
int command_convert(struct command_line *line);

/*
 * Exit 2 where a recording of radar plots is to become tracks (GeoJSON, CAT062). Called before the
 * origin is looked for, which would not help.
 */
void convert_refuse_radar(const struct command_line *line);

int command_node(struct command_line *line);
int command_publish(struct command_line *line);
int command_command(struct command_line *line);
int command_register(struct command_line *line);
int command_calibrate(struct command_line *line);
int command_config(struct command_line *line);

/*
 * The commands experiment and bench. bench is the separate program rhotrack-lab in the same folder,
 * and experiments are scripts of the source tree: the shipped program needs nothing of them.
 * command_lab_name returns NULL past the last name. command_lab_execute executes the
 * script or program with the same arguments and does not return; exit 1 where it is missing.
 */
const char *command_lab_name(size_t index);
bool command_lab_has(const char *name);
_Noreturn void command_lab_execute(char **argv);

#endif
