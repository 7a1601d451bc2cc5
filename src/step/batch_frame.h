/* SPDX-License-Identifier: MIT */
/*
 * batch_frame: usable bearings of a frame (the scans of all passive sensors at one time), and the
 * frame in the form that a batch takes. Private to the step and the initiation of bearings.
 */
#ifndef RHOTRACK_BATCH_FRAME_H
#define RHOTRACK_BATCH_FRAME_H

#include "phases.h"
#include "rhotrack/detail/measurement.h"

static inline int is_usable_bearing(const struct rho_bearing *bearing)
{
    return rho_bearing_is_valid(bearing) && bearing->offset_us <= RHO_LIMIT_OFFSET_US &&
           bearing->offset_us >= -RHO_LIMIT_OFFSET_US;
}

/* Number of a scan's bearings with a fate and a place in the batch; first: place in the frame. */
static inline uint32_t num_bearings_with_fates(const struct rho_look *look,
                                               const struct rho_bearing_scan *scan, uint32_t first)
{
    const uint32_t room = first < look->num_gated ? look->num_gated - first : 0;
    const uint32_t num = scan->num_bearings < room ? scan->num_bearings : room;
    return num < RHO_MAX_BEARINGS ? num : RHO_MAX_BEARINGS;
}

/*
 * A frame in the form that a batch takes: scans cut to the bearings with fates, and their fates.
 */
struct batch_frame {
    struct rho_frame frame;
    struct rho_bearing_scan scans[RHO_MAX_PASSIVE_SENSORS];
    uint8_t fates[RHO_MAX_PASSIVE_SENSORS * RHO_MAX_BEARINGS];
};

/* The tracks that took the bearings of a frame's scans. */
struct frame_owners {
    struct rho_batch_owner of[RHO_MAX_PASSIVE_SENSORS][RHO_MAX_BEARINGS];
};

/* bearing_initiation.c: fills *held by a frame and the look's fates; copies its fates back */
void rho_step_frame_to_batch(const struct rho_look *look, const struct rho_frame *frame,
                             struct batch_frame *held);
void rho_step_batch_to_report(const struct rho_look *look, const struct batch_frame *held,
                              const struct rho_frame *frame);

#endif
