/* SPDX-License-Identifier: MIT */
/*
 * node_parts: the parts of a node that a build may lack, as pointers that are constants NULL there,
 * and what the files of this room call of one another, rho_node_x_* of node_x.c. A part is used
 * behind an `if` on the build's option alone.
 */
#ifndef RHOTRACK_NODE_PARTS_H
#define RHOTRACK_NODE_PARTS_H

#include <string.h>

#include "rhotrack/node.h"

#define RHO_NODE_MAGIC 0x6e6f6465u

/* Range of a sensor whose description states none. */
#define RANGE_UNKNOWN_M (2.0f * RHO_LIMIT_POSITION_M)

/* Longest wait of a command for a step: longer than a turn of any radar. */
#define COMMAND_WAIT_US 60000000

#if RHO_SEARCHES
#define NODE_INITIATOR(node) (&(node)->initiator)
#else
#define NODE_INITIATOR(node) ((void)(node), (struct rho_initiator *)0)
#endif
#if RHO_SEARCHES && RHO_MAX_WINDOWS > 1
#define NODE_UNPACKED(node) ((node)->unpacked)
#define NODE_FATES(node) ((node)->fates)
#else
#define NODE_UNPACKED(node) ((void)(node), (struct rho_plot *)0)
#define NODE_FATES(node) ((void)(node), (uint8_t *)0)
#endif
#if RHO_NODE_HAS_PASSIVE
#define NODE_PASSIVE(node) (&(node)->passive)
#else
#define NODE_PASSIVE(node) ((void)(node), (struct rho_passive *)0)
#endif
#if RHO_PAPERS
#define NODE_PAPER_STARTS(node) (&(node)->paper_starts)
#else
#define NODE_PAPER_STARTS(node) ((void)(node), (struct rho_paper_starts *)0)
#endif
#if RHO_NODE_HAS_PASSIVE_PAPER
#define NODE_PASSIVE_PAPER(node) (&(node)->passive_paper)
#else
#define NODE_PASSIVE_PAPER(node) ((void)(node), (struct rho_passive_paper *)0)
#endif
#if RHO_MAX_ZONES > 0
#define NODE_ZONES(node) (&(node)->zones)
#else
#define NODE_ZONES(node) ((void)(node), (struct rho_zones *)0)
#endif
#if RHO_LEARNS_REFLECTORS
#define NODE_LEARNING(node) (&(node)->learning)
#else
#define NODE_LEARNING(node) ((void)(node), (struct rho_reflector_learning *)0)
#endif
#if RHO_MAX_COMMANDS > 0
#define NODE_OPERATOR(node) (&(node)->operated)
#else
#define NODE_OPERATOR(node) ((void)(node), (struct rho_node_operator *)0)
#endif

static inline int rho_node_is_ready(const struct rho_node *node)
{
    return node && node->magic == RHO_NODE_MAGIC;
}

/* Errors of a call with a node and what it is given: NULL, STATE (not initialised). */
static inline enum rho_status node_check(const struct rho_node *node, const void *given)
{
    return !node || !given ? RHO_ERROR_NULL : !rho_node_is_ready(node) ? RHO_ERROR_STATE : RHO_OK;
}

/* Configurations and settings are copied whole, so that equal ones have equal padding. */
static inline int node_equals(const void *one, const void *other, size_t size)
{
    return memcmp(one, other, size) == 0;
}

/* 1 where the papers' methods start tracks, from plots or from bearings. */
static inline int rho_node_is_plots_by_paper(const struct rho_node *node)
{
    return RHO_PAPERS && (!(RHO_SEARCHES) || node->options.is_plots_by_paper);
}

static inline int rho_node_is_bearings_by_paper(const struct rho_node *node)
{
    return RHO_NODE_HAS_PASSIVE_PAPER && (!(RHO_SEARCHES) || node->options.is_bearings_by_paper);
}

/* node_setup.c: begins anew on another clock (node.h) */
void rho_node_restart(struct rho_node *node);

/* Describes a sensor to the tracker; returns 0 where that refuses it. */
int rho_node_sensor_describe(struct rho_node *node, const struct rho_sensor *sensor);

/*
 * node_settings.c: fills in configurations of tracker and initiator as they follow the settings;
 * the node's own settings leave them as they are. CONFIG: as rho_node_set_settings.
 */
enum rho_status rho_node_settings_prepare(struct rho_node *node,
                                          const struct rho_settings *settings,
                                          struct rho_node_config *config);

/* Makes prepared settings the node's; descriptions of sensors follow them. */
void rho_node_settings_adopt(struct rho_node *node, const struct rho_settings *settings);

/* The chain of a step (node.h); is_live: the scan came as messages. */
enum rho_status rho_node_chain_scan(struct rho_node *node, const struct rho_scan *scan,
                                    int is_live);
enum rho_status rho_node_chain_bearings(struct rho_node *node, const struct rho_bearing_scan *scan);

/* All windows but the first become free, and the first has no sensor. */
enum rho_status rho_node_windows_init(struct rho_node *node,
                                      const struct rho_initiator_config *config);

/* The window of a scan's sensor, added where it is new and there is room. */
struct rho_initiator *rho_node_windows_find(struct rho_node *node, const struct rho_scan *scan,
                                            int is_live);

/* The window of the newest scan. */
const struct rho_initiator *rho_node_windows_newest(const struct rho_node *node);

/* The window of this sensor, added where it is new; NULL where there is no room for it. */
struct rho_initiator *rho_node_windows_add(struct rho_node *node, int32_t sensor_id);

/* Queues an operator's command or setting, or counts it; 0 where the channel is another one. */
int rho_node_commands_take(struct rho_node *node, const char *channel, const uint8_t *data,
                           size_t size, int64_t now_us);

/* Runs the commands that wait, after a step; its report shows what they change. */
void rho_node_commands_run(struct rho_node *node);

/* node_commands.c: answers that are published are dropped; the others become messages. */
void rho_node_answers_drop(struct rho_node *node);
void rho_node_answers_show(struct rho_node *node);
/* due_us, or sooner where an answer waits or a command becomes too old. */
int64_t rho_node_answers_due(const struct rho_node *node, int64_t due_us);

/* Refuses commands that came before that time, as what the operator saw has changed. */
void rho_node_commands_refuse(struct rho_node *node, int64_t before_us);

#endif
