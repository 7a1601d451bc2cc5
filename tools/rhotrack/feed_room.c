/* SPDX-License-Identifier: MIT */
#include "feed_room.h"

int64_t feed_room_heard_us(const struct rho_feed *feed, const struct rho_feed_item *item)
{
    unsigned slot = 0;

    while (item->scan.plots != feed->slots[slot].plots &&
           item->bearings.bearings != feed->slots[slot].bearings) {
        slot++; /* an item points into one of them */
    }
    return feed->slots[slot].heard_us;
}

/* The feed is pressed as long as no slot is free; one that is given frees its own when the next one is asked for. */
bool feed_room_was_short(const struct rho_feed *feed, const struct rho_feed_item *item,
                         int64_t now_us)
{
    return feed->is_pressed && now_us - feed_room_heard_us(feed, item) < feed->config.hold_us;
}
