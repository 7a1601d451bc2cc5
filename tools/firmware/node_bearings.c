/* SPDX-License-Identifier: MIT */
#include "node_bearings.h"

#include "node_step.h"
#include "rhotrack/passive.h"

#if (RHO_SCAN_KINDS) & 4

static struct rho_frames frames;
static struct rho_passive passive;

enum rho_status node_bearings_open_search(void)
{
    struct rho_passive_config search;
    rho_passive_config_default(&search);
    return rho_passive_init(&passive, sizeof passive, &search);
}

enum rho_status node_bearings_open_frames(void)
{
    struct rho_frames_config gather;
    rho_frames_config_default(&gather);
    gather.sensors_min = RHO_MAX_PASSIVE_SENSORS; /* until a frame has told how many there are */
    return rho_frames_init(&frames, sizeof frames, &gather);
}

static void step_closed(void)
{
    struct rho_frame_view view;
    if (!rho_frames_closed(&frames, &view)) {
        return;
    }
    frames.config.sensors_min = 2;
    if (view.is_restart) {
        node_restart();
    }
    node_step_frame(&passive, &view.frame);
}

void node_bearings_take(const struct rho_feed_item *item)
{
    if ((!item->has_sensor || node_describe(&item->sensor)) &&
        rho_frames_push(&frames, &item->bearings) == RHO_OK) {
        step_closed();
    }
}

void node_bearings_close_before(int64_t time_us)
{
    const struct rho_frames_slot *open = &frames.slots[frames.open];
    if (open->num_scans > 0 && open->time_us < time_us && rho_frames_close(&frames) == RHO_OK) {
        step_closed();
    }
}

const struct rho_frames *node_bearings_frames(void)
{
    return &frames;
}

#endif
