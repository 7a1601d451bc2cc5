/* SPDX-License-Identifier: MIT */
/*
 * node_passive: the frames of the live tracker's passive sensors, and which of these sensors are in them.
 *
 * Places of passive sensors are taken from the first scan that says them, be it a wrong or a hostile one. A sensor that
 * is not heard any more must not keep another one out for ever, nor a place that was wrong the sensor itself.
 */
#ifndef RHOTRACK_TOOL_NODE_PASSIVE_H
#define RHOTRACK_TOOL_NODE_PASSIVE_H

#include <stdint.h>

#include "parameters.h"
#include "rhotrack/feed.h"
#include "rhotrack/frames.h"

struct node_passive {
    const struct parameters *parameters;
    struct rho_frames frames;
    unsigned refused_scans[RHO_MAX_PASSIVE_SENSORS]; /* in a row, of each of the frames' sensors */
};

/* Whether a believed scan of the sensor, of any kind, came in the last jump_max_us. */
int node_is_heard(const struct rho_feed *feed, int32_t sensor_id, int64_t now_us);

/* The parameters' address is kept. Values that the library does not take: exit 2. */
void node_passive_open(struct node_passive *passive, const struct parameters *parameters);

/* Frames and sensors begin anew; the counters go on. */
void node_passive_forget(struct node_passive *passive);

/* A frame was closed: how many sensors there are is known from it. */
void node_passive_has_frame(struct node_passive *passive);

/* Takes a scan into the open frame, or the next. 0: refused. apart_max_m: from sensor to sensor, in a search. */
int node_passive_take(struct node_passive *passive, const struct rho_bearing_scan *scan,
                      float apart_max_m);

/*
 * After a refusal: true where a sensor that the feed does not hear any more is in the way, or the scan's own has been
 * refused so often that its place is believed to be another one. Then it is time to forget.
 */
int node_passive_is_blocked(struct node_passive *passive, const struct rho_feed *feed,
                            const struct rho_bearing_scan *scan, int64_t now_us);

#endif
