/* SPDX-License-Identifier: MIT */
/* next_command: the command that most users want after this one. */
#ifndef RHOTRACK_TOOL_NEXT_COMMAND_H
#define RHOTRACK_TOOL_NEXT_COMMAND_H

#include <stdbool.h>

#include "commands.h"

/*
 * On a terminal: the command that most users want next, as it may be typed; words after the
 * program's name, NULL at the end, and then the settings that this one was given.
 */
void next_command_say(const struct command_line *line, const char *const *words);

/* The same for a page of files and tracks (NAME.csv), which is written beside these. */
void next_command_say_page(const struct command_line *line, char *const *files, int num_files,
                           const char *tracks);

/* A file of that name in the path's folder, in new memory; NULL where there is none. */
char *next_command_find_beside(const char *path, const char *name);

/* A CSV file has rows, and the columns of this command's --columns. */
bool next_command_can_read_file(const struct command_line *line, const char *path);

#endif
