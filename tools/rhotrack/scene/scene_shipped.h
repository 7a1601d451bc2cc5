/* SPDX-License-Identifier: MIT */
/*
 * scene_shipped: table of the scene files of tools/scenes, compiled into the program
 * by the Makefile.
 */
#ifndef RHOTRACK_TOOL_SCENE_SHIPPED_H
#define RHOTRACK_TOOL_SCENE_SHIPPED_H

struct shipped_scene {
    const char *name, *text;
};

/* The shipped scenes, sorted by name; the last entry's name is NULL. */
extern const struct shipped_scene shipped_scenes[];

#endif
