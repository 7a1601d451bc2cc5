/* SPDX-License-Identifier: MIT */
/* next_command: suggests on a terminal the command that most users run after this one. */
#ifndef RHOTRACK_TOOL_NEXT_COMMAND_H
#define RHOTRACK_TOOL_NEXT_COMMAND_H

#include <stdbool.h>

#include "commands.h"

/*
 * Prints a suggested command line on standard error, if that is a terminal: the program's name, the
 * words (up to NULL), and the settings that this run was given, quoted for the shell.
 */
void next_command_print(const struct command_line *line, const char *const *words);

/* Suggests `plot tracks FILES TRACKS -o PAGE`: an HTML page beside the tracks file NAME.csv. */
void next_command_print_page(const struct command_line *line, char *const *files, int num_files,
                             const char *tracks);

/* Path of a regular file of that name in the same folder as `path`, in new memory; NULL: none. */
char *next_command_find_beside(const char *path, const char *name);

/* True where a CSV file has a header and a row, and the columns that --columns of this run maps. */
bool next_command_can_read(const struct command_line *line, const char *path);

#endif
