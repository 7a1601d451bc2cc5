/* SPDX-License-Identifier: MIT */
/*
 * command_line: parses a command's options and arguments into one struct; help texts of commands.
 */
#ifndef RHOTRACK_TOOL_COMMAND_LINE_H
#define RHOTRACK_TOOL_COMMAND_LINE_H

#include <stdio.h>

#include "commands.h"

/* One command of the program, a row of the table in main.c. */
struct command {
    const char *name;
    int (*run)(struct command_line *line);
    const char *usage; /* arguments and main options for the usage line */
    int min_arguments, max_arguments;
    /* letters of the options that the command accepts, as in the table of command_line.c */
    const char *options;
    const char *summary; /* one line for the list of commands */
    const char *text;    /* paragraphs of the command's help; lines end with a newline */
};

/*
 * Parses argv, where argv[0] is the command's name. On errors prints one line and exits with 2; on
 * --help prints the help and exits with 0.
 */
void command_line_read(struct command_line *line, const struct command *command, int argc,
                       char **argv);

/*
 * Call after command_line_read. Takes the origin of the local frame from the inputs where none is
 * set, converts sensors' latitudes and longitudes to local places, and warns on standard error of
 * azimuths that look clockwise.
 */
void command_line_set_places(struct command_line *line);

/* Exit 2 where --output names one of the inputs, for commands that must not overwrite an input. */
void refuse_output_that_is_an_input(const struct command_line *line);

/* True for -o -: standard output gets the output file alone, so that no report may go there. */
bool is_output_explicitly_stdout(const struct command_line *line);

/*
 * Checks the options of commands that write an INI file. Exit 2 where --output names an input or
 * ends like another format, where an input is given twice (its plots would count twice), or where
 * both --json and -o - write to standard output.
 */
void command_line_check_ini_output(const struct command_line *line, const char *command);

#endif
