/* SPDX-License-Identifier: MIT */
/*
 * scene_random_streams: random numbers of simulated scenes: a separate stream for each target's
 * path, each pass of a sensor over a target, each clutter source in each turn. The numbers of one
 * stream do not depend on what else is in the scene.
 */
#ifndef RHOTRACK_TOOL_SCENE_RANDOM_STREAMS_H
#define RHOTRACK_TOOL_SCENE_RANDOM_STREAMS_H

#include "base/random.h"
#include "scene/json_value_reader.h"

enum stream_kind {
    /*
     * random paths; arguments: source of targets (0: the scene's own), element of targets[], path
     * within it
     */
    STREAM_PATH = 1,
    /* detection and noise of a target; arguments: sensor, target, pass of the antenna */
    STREAM_TARGET,
    STREAM_SPLIT,  /* split plots; arguments: event and sensor, target, pass */
    STREAM_MERGED, /* unused; keeps the numbers of the streams below */
    STREAM_FADES,  /* times of fades; arguments: event, target */
    STREAM_WORLD,  /* positions of persistent clutter; arguments: clutter source, object */
    /* clutter plots; arguments: clutter source and sensor, then scan, or object and pass */
    STREAM_CLUTTER,
    STREAM_BEARINGS, /* false bearings; arguments: sensor, scan */
    STREAM_ARRIVAL,  /* late arrival of scans; arguments: sensor, scan */
    STREAM_START,    /* start time of a sensor, and its antenna's azimuth then; argument: sensor */
    STREAM_IMAGE,    /* mirror images; arguments: reflector and sensor, target, pass */
    STREAM_BODY,     /* fixed scatterer positions of a body; argument: target */
    STREAM_LOOK      /* scatterers of a body at one look; arguments: sensor, target, pass */
};

struct random scene_random_stream(uint64_t seed, uint64_t run, enum stream_kind kind,
                                  uint64_t source, uint64_t item, uint64_t part);

/* A uniform random number, lo <= u < hi; lo where both are equal. */
double random_in_span(struct random *random, struct json_span span);

#endif
