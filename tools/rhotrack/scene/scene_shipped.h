/* SPDX-License-Identifier: MIT */
/*
 * scene_shipped: the files of tools/scenes, compiled into the program (the Makefile writes the
 * table from them).
 */
#ifndef RHOTRACK_TOOL_SCENE_SHIPPED_H
#define RHOTRACK_TOOL_SCENE_SHIPPED_H

struct shipped_scene {
    const char *name, *text;
};

/* By name; the last one's name is NULL. */
extern const struct shipped_scene shipped_scenes[];

#endif
