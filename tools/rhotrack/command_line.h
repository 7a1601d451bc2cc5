/* SPDX-License-Identifier: MIT */
/* command_line: what the user typed, as one struct; and the help that says what may be typed. */
#ifndef RHOTRACK_TOOL_COMMAND_LINE_H
#define RHOTRACK_TOOL_COMMAND_LINE_H

#include <stdio.h>

#include "commands.h"

/* One command of the program, a row of main's table. */
struct command {
    const char *name;
    int (*run)(struct command_line *line);
    const char *usage; /* arguments and the most important options */
    int min_arguments, max_arguments;
    const char *options; /* the options' letters that it takes, as in command_line.c's table */
    const char *summary; /* one line */
    const char *text;    /* paragraphs; lines end with a newline */
};

/*
 * Reads argv, argv[0] being the command's name. Errors: one line, exit 2. --help: prints and exits
 * with 0.
 */
void command_line_read(struct command_line *line, const struct command *command, int argc,
                       char **argv);

/*
 * Then: the origin of a recording or of places on the earth, where none was set; what is placed on
 * the earth; and on standard error what seems wrong with the azimuths.
 */
void command_line_find_origin(struct command_line *line);

/* Help of one command. */
void command_line_help(const struct command *command, FILE *file);

/*
 * Exit 2 where --output names one of the arguments: of commands that nobody wants to put their
 * output in an input's place.
 */
void refuse_output_as_input(const struct command_line *line);

/* -o -: standard output has the file that is written, and nothing else. */
bool is_output_to_stdout(const struct command_line *line);

/*
 * Of commands that learn from recordings and write an INI file. Exit 2 where --output names an
 * input, or something else than an INI file; where an input is given twice, whose plots would count
 * twice; where --json writes on standard output, too.
 */
void command_line_check_ini_output(const struct command_line *line, const char *command);

#endif
