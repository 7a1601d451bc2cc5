/* SPDX-License-Identifier: MIT */
/*
 * node_bearings: the node's passive sensors, whose scans become frames. Where RHO_SCAN_KINDS has
 * none, a radar node carries none of their code and memory.
 */
#ifndef NODE_BEARINGS_H
#define NODE_BEARINGS_H

#include "node.h"
#include "rhotrack/frames.h"

#if (RHO_SCAN_KINDS) & 4

/* Begins anew: the search, and the frames with their sensors. */
enum rho_status node_bearings_open_search(void);
enum rho_status node_bearings_open_frames(void);

/* A scan of bearings; steps the frame that it closes. */
void node_bearings_take(const struct rho_feed_item *item);

/* Steps the open frame where it began before that time: a scan of plots comes next. */
void node_bearings_close_before(int64_t time_us);

const struct rho_frames *node_bearings_frames(void);

#else

static inline enum rho_status node_bearings_open_search(void)
{
    return RHO_OK;
}

static inline enum rho_status node_bearings_open_frames(void)
{
    return RHO_OK;
}

static inline void node_bearings_take(const struct rho_feed_item *item)
{
    (void)item;
}

static inline void node_bearings_close_before(int64_t time_us)
{
    (void)time_us;
}

static inline const struct rho_frames *node_bearings_frames(void)
{
    return NULL;
}

#endif
#endif
