/* SPDX-License-Identifier: MIT */
/*
 * scene_random: a generator of random numbers of its own for each thing in a scene: one target's
 * path, what one radar sees of it in one turn, one source of clutter in one turn. What is drawn for
 * one thing does not depend on what else there is.
 */
#ifndef RHOTRACK_TOOL_SCENE_RANDOM_H
#define RHOTRACK_TOOL_SCENE_RANDOM_H

#include "base/random.h"
#include "scene/scene_json.h"

enum stream_kind {
    STREAM_PATH = 1, /* targets of which source, element of targets[], which of its paths */
    STREAM_TARGET,   /* sensor, target, which pass of the antenna */
    STREAM_SPLIT,    /* event and sensor, target, pass */
    STREAM_MERGED,   /* sensor, first target, scan */
    STREAM_FADES,    /* event, target */
    STREAM_WORLD,    /* source of clutter: its places */
    STREAM_CLUTTER,  /* source and sensor, scan, or thing and pass */
    STREAM_BEARINGS, /* sensor, scan */
    STREAM_ARRIVAL,  /* sensor, scan */
    STREAM_START,    /* sensor: when it begins, and where its antenna points then */
    STREAM_IMAGE,    /* reflector and sensor, target, pass */
    STREAM_BODY,     /* target: where its scatterers stay */
    STREAM_LOOK      /* sensor, target, pass: of the scatterers of a body */
};

struct random scene_random_stream(uint64_t seed, uint64_t run, enum stream_kind kind,
                                  uint64_t source, uint64_t item, uint64_t part);

/* lo <= u < hi, or lo where they are the same. */
double random_in_span(struct random *random, struct json_span span);

#endif
