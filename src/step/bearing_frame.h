/* SPDX-License-Identifier: MIT */
/*
 * bearing_frame: what the step of a frame of bearings and its initiation share. Private to them.
 */
#ifndef RHOTRACK_BEARING_FRAME_H
#define RHOTRACK_BEARING_FRAME_H

#include "phases.h"
#include "rhotrack/detail/measurement.h"

static inline int is_bearing(const struct rho_bearing *bearing)
{
    return rho_measurement_is_bearing(bearing) && bearing->offset_us <= RHO_LIMIT_OFFSET_US &&
           bearing->offset_us >= -RHO_LIMIT_OFFSET_US;
}

/*
 * The number of bearings of a scan that have a place in the report's fates and in the batch. first:
 * the place of the scan's first bearing among those of the frame.
 */
static inline uint32_t num_held(const struct step *step, const struct rho_bearing_scan *scan,
                                uint32_t first)
{
    const uint32_t room = first < step->num_gated ? step->num_gated - first : 0;
    const uint32_t num = scan->num_bearings < room ? scan->num_bearings : room;
    return num < RHO_MAX_BEARINGS ? num : RHO_MAX_BEARINGS;
}

/* The frame as a batch takes it: the bearings that have fates, and these fates in a row. */
struct held_frame {
    struct rho_frame frame;
    struct rho_bearing_scan scans[RHO_MAX_PASSIVE_SENSORS];
    uint8_t fates[RHO_MAX_PASSIVE_SENSORS * RHO_MAX_BEARINGS];
};

/* bearing_initiation.c: fills *held from step->frame, and gives its fates back to the report */
void rho_tracker_hold_frame(const struct step *step, struct held_frame *held);
void rho_tracker_return_fates(const struct step *step, struct held_frame *held);

#endif
