/* SPDX-License-Identifier: MIT */
/* feed_room: what a feed's scans say of its room: when they came, and whether they had to go before they had waited hold_ms. */
#ifndef RHOTRACK_TOOL_FEED_ROOM_H
#define RHOTRACK_TOOL_FEED_ROOM_H

#include <stdbool.h>
#include <stdint.h>

#include "rhotrack/feed.h"

/* Of the item that rho_feed_next gave last, before it is called again: when its last part came, by the reception clock. */
int64_t feed_room_heard_us(const struct rho_feed *feed, const struct rho_feed_item *item);

/* Such an item made room for another scan: it had not waited for hold_us. */
bool feed_room_was_short(const struct rho_feed *feed, const struct rho_feed_item *item,
                         int64_t now_us);

#endif
