/* SPDX-License-Identifier: MIT */
/*
 * restored_commands: the areas, settings and frozen tracks that an operator's commands have left in
 * a snapshot. One of them may blind a node, so a node that begins with a snapshot names them. One
 * that takes no commands goes on without them: nobody could take them back, and its configuration
 * is then all that it is told. They are named in the words of `rhotrack command`, so that none is
 * lost for good.
 */
#ifndef RHOTRACK_TOOL_RESTORED_COMMANDS_H
#define RHOTRACK_TOOL_RESTORED_COMMANDS_H

#include <stdio.h>

#include "rhotrack/node.h"
#include "settings/parameters.h"

/*
 * Prints a line for each area and setting of a restored node, for its frozen tracks, and for
 * whether the node, by its options, goes on with them. Returns the number of lines; 0: there are
 * none.
 */
unsigned restored_commands_print(const struct rho_node *node, const char *path, FILE *to);

/*
 * Takes back all areas, thaws all tracks, and gives the sensors' descriptions the ranges and pd of
 * these parameters.
 */
void restored_commands_undo(struct rho_tracker *tracker, const struct parameters *parameters);

#endif
