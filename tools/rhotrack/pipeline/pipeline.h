/* SPDX-License-Identifier: MIT */
/* pipeline: the library's node (rhotrack/node.h), in allocated memory and with parameters. */
#ifndef RHOTRACK_TOOL_PIPELINE_H
#define RHOTRACK_TOOL_PIPELINE_H

#include "rhotrack/node.h"
#include "settings/parameters.h"

/* Values of the parameter initiators: enum rho_node_windows. */
enum {
    INITIATORS_PAIRS = RHO_NODE_PAIRS,
    INITIATORS_SENSOR = RHO_NODE_SINGLE,
    INITIATORS_ONE = RHO_NODE_ONE
};

struct pipeline {
    struct rho_node *node;
    void **storage; /* further initiation windows of the node */
    size_t num_storage, storage_room;
    /* live input, where strangers may send; set before pipeline_open, with the two below */
    bool is_live;
    int32_t epoch;
    bool takes_commands;
    bool is_open, has_bearings; /* pipeline_open and pipeline_open_passive were called */
    struct rho_plot *plots;     /* RHO_MAX_PLOTS, memory for the caller's scans */
};

struct pipeline pipeline_allocate(void);
void pipeline_free(struct pipeline *pipeline);

/* Options that choose methods; each may be NULL. */
struct pipeline_options {
    const char *gate, *method;
    const char *pipeline; /* "paper": the papers' methods from plots and bearings to tracks */
};

/*
 * Sets the parameters gate, method and bearings_method from options, and suggests the methods'
 * customary values. Exit 2 for a gate that the tracker lacks.
 */
void pipeline_options_to_parameters(struct parameters *parameters,
                                    const struct pipeline_options *options);

/* Prepares the node for a first scan; tracks of an earlier run are dropped, zones are kept. */
void pipeline_open(struct pipeline *pipeline, const struct parameters *parameters);

/* Initialises the initiation of tracks from bearings; after pipeline_open. */
void pipeline_open_passive(struct pipeline *pipeline, const struct parameters *parameters);

/*
 * Applies other parameters from the next step on; tracks and learned values are kept. Initiation
 * from bearings and the papers' methods keep the parameters that they were opened with.
 */
void pipeline_reconfigure(struct pipeline *pipeline, const struct parameters *parameters);

/* Gives the node storage for this number of further windows. */
void pipeline_add_storage(struct pipeline *pipeline, unsigned num_windows);

/* Gives the node storage for the window of one more radar, if it wants some; before each step. */
void pipeline_give_storage(struct pipeline *pipeline);

/*
 * Says once on standard error that radars share a window for want of further ones; after each step.
 */
void pipeline_warn_shared_windows(const struct pipeline *pipeline, uint32_t shared_before,
                                  int32_t sensor_id);

/* Steps a scan completely; the result is in node->report. */
void pipeline_step(struct pipeline *pipeline, const struct rho_scan *scan);
/*
 * Steps the looks of a frame of bearings, in the order of time. node->report is then the last
 * one's, with the fates of all bearings, in the frame's order, and the tracks that ended in any of
 * them.
 *   after_look  called after each step, with the context; NULL: nothing
 */
void pipeline_step_frame(struct pipeline *pipeline, const struct rho_frame *frame,
                         void (*after_look)(void *context), void *context);

/* The node's zones, learning of walls and method for bearings; NULL where there are none. */
const struct rho_zones *pipeline_zones(const struct pipeline *pipeline);
const struct rho_reflector_learning *pipeline_learning(const struct pipeline *pipeline);
struct rho_paper_starts *pipeline_paper_starts(const struct pipeline *pipeline);
struct rho_passive_paper *pipeline_passive_paper(const struct pipeline *pipeline);

#endif
