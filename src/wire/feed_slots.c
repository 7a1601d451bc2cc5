/* SPDX-License-Identifier: MIT */
/* Scans that are put together, and when it is their turn. */
#include <string.h>

#include "feed_parts.h"

void rho_feed_count_one(uint32_t *counter)
{
    *counter = rho_count(*counter, 1);
}

struct rho_feed_slot *rho_feed_find_state(struct rho_feed *feed, enum feed_slot_state state)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        if (feed->slots[i].state == state) {
            return &feed->slots[i];
        }
    }
    return NULL;
}

static int is_open_of(const struct rho_feed *feed, const struct rho_feed_slot *slot,
                      const struct rho_feed_source *source)
{
    return slot->state == FEED_SLOT_OPEN && &feed->sources[slot->source] == source;
}

struct rho_feed_slot *rho_feed_find_scan(struct rho_feed *feed,
                                         const struct rho_feed_source *source,
                                         const struct feed_heading *heading)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct rho_feed_slot *slot = &feed->slots[i];

        if (is_open_of(feed, slot, source) && slot->place.scan == heading->place.scan &&
            slot->place.epoch == heading->place.epoch) {
            return slot;
        }
    }
    return NULL;
}

int rho_feed_has_late_open(const struct rho_feed *feed, const struct rho_feed_source *source)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        if (is_open_of(feed, &feed->slots[i], source) && feed->slots[i].order == FEED_ORDER_LATE) {
            return 1;
        }
    }
    return 0;
}

/* It waits for its parts or its turn. */
static int is_waiting(const struct rho_feed_slot *slot)
{
    return slot->state == FEED_SLOT_OPEN || slot->state == FEED_SLOT_COMPLETE;
}

void rho_feed_close_slot(struct rho_feed *feed, struct rho_feed_slot *slot)
{
    if (slot->parts_here < slot->num_parts) {
        rho_feed_count_one(&feed->counters.scans_incomplete);
    }
    slot->state = FEED_SLOT_COMPLETE;
}

void rho_feed_close_open(struct rho_feed *feed, const struct rho_feed_source *source, int is_over)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct rho_feed_slot *slot = &feed->slots[i];

        if (is_open_of(feed, slot, source)) {
            rho_feed_close_slot(feed, slot);
        }
        if (is_over && slot->order == FEED_ORDER_NEXT && &feed->sources[slot->source] == source) {
            slot->order = FEED_ORDER_OLD;
        }
    }
}

static int is_early(const struct rho_feed *feed, const struct rho_feed_slot *slot, int64_t now_us)
{
    return now_us < rho_feed_early_until_us(feed, slot);
}

static int is_elder_s(const struct rho_feed *feed, const struct rho_feed_slot *slot, int64_t now_us)
{
    return !rho_feed_is_new(feed->sources[slot->source].known_us, rho_feed_eldest_us(feed, now_us));
}

struct rho_feed_slot *rho_feed_make_free(struct rho_feed *feed, int is_new, int64_t now_us)
{
    struct rho_feed_slot *room = rho_feed_find_state(feed, FEED_SLOT_FREE);

    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS && !room; i++) {
        struct rho_feed_slot *slot = &feed->slots[i];

        if (is_waiting(slot) && !is_new && is_early(feed, slot, now_us)) {
            rho_feed_count_one(&feed->counters.sensors_no_room);
            slot->state = FEED_SLOT_FREE;
            room = slot;
        } else if (is_waiting(slot) && slot->order == FEED_ORDER_LATE &&
                   !(is_new && is_elder_s(feed, slot, now_us))) {
            slot->state = FEED_SLOT_FREE; /* it was counted when it came */
            room = slot;
        }
    }
    return room;
}

/* What belongs to the clock that held before cannot be stepped any more. */
void rho_feed_drop_slots(struct rho_feed *feed)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct rho_feed_slot *slot = &feed->slots[i];

        if (is_waiting(slot)) {
            /* a late one was counted when it came */
            feed->counters.scans_late =
                rho_count(feed->counters.scans_late, slot->order != FEED_ORDER_LATE);
            slot->state = FEED_SLOT_FREE;
        }
    }
}

static void describe(const struct rho_feed *feed, struct rho_feed_slot *slot,
                     const struct feed_heading *heading)
{
    const struct rho_feed_sensor *known = rho_feed_known(feed, heading->sensor_id);
    int has_place = heading->x_m < 0.0f || heading->x_m > 0.0f || heading->y_m < 0.0f ||
                    heading->y_m > 0.0f || heading->z_m < 0.0f || heading->z_m > 0.0f;

    slot->sensor = known->sensor;
    slot->sensor.sensor_id = heading->sensor_id;
    if (has_place || RHO_FEED_IS(heading->kind, RHO_FEED_BEARINGS)) {
        slot->sensor.x_m = heading->x_m;
        slot->sensor.y_m = heading->y_m;
        slot->sensor.z_m = heading->z_m;
    }
    slot->has_sensor = (uint8_t)(known != &feed->config.other || feed->config.is_told ||
                                 (has_place && !RHO_FEED_IS(heading->kind, RHO_FEED_BEARINGS)));
}

void rho_feed_open_slot(struct rho_feed *feed, struct rho_feed_slot *slot,
                        const struct rho_feed_source *source, const struct feed_heading *heading,
                        enum feed_slot_order order)
{
    slot->place = heading->place;
    slot->measures = heading->measures;
    slot->sector_from_rad = heading->sector_from_rad;
    slot->sector_to_rad = heading->sector_to_rad;
    slot->source = (uint16_t)(source - feed->sources);
    slot->num_parts = heading->num_parts;
    slot->parts_here = 0;
    slot->num_inputs = 0;
    slot->kind = heading->kind;
    slot->order = (uint8_t)order;
    memset(slot->parts, 0, sizeof slot->parts);
    describe(feed, slot, heading);
    slot->state = FEED_SLOT_OPEN;
}

/* ---- Parts ---- */

static int is_equal(float a, float b)
{
    return a <= b && a >= b;
}

/* The parts of a scan must say the same of it. */
static int agrees(const struct rho_feed_slot *slot, const struct feed_heading *heading)
{
    int has_place = RHO_FEED_IS(heading->kind, RHO_FEED_POLAR);

    return slot->place.time_us == heading->place.time_us && slot->num_parts == heading->num_parts &&
           slot->measures == heading->measures &&
           is_equal(slot->sector_from_rad, heading->sector_from_rad) &&
           is_equal(slot->sector_to_rad, heading->sector_to_rad) &&
           (!has_place || ((is_equal(slot->sensor.x_m, heading->x_m) &&
                            is_equal(slot->sensor.y_m, heading->y_m) &&
                            is_equal(slot->sensor.z_m, heading->z_m)) ||
                           (is_equal(heading->x_m, 0.0f) && is_equal(heading->y_m, 0.0f) &&
                            is_equal(heading->z_m, 0.0f))));
}

void rho_feed_count_double(struct rho_feed *feed, struct rho_feed_source *source,
                           const struct feed_heading *heading)
{
    if (heading->part == 0 && heading->place.scan == source->place.scan &&
        source->check > FEED_CHECK_NO_TURN && source->check != heading->check) {
        source->has_twin = 1;
        rho_feed_count_one(&feed->counters.scans_other);
    } else {
        rho_feed_count_one(&feed->counters.scans_duplicate);
    }
}

void rho_feed_add_part(struct rho_feed *feed, struct rho_feed_slot *slot,
                       const struct feed_heading *heading, const union feed_message *message,
                       int64_t now_us)
{
    struct rho_feed_source *source = &feed->sources[slot->source];

    if (slot->parts[heading->part] > 0) {
        rho_feed_count_double(feed, source, heading);
        return;
    }
    if (slot->parts_here > 0 && !agrees(slot, heading)) {
        rho_feed_count_one(&feed->counters.scans_bad);
        return;
    }
    rho_feed_fill(feed, slot, heading, message);
    if (heading->part == 0 && heading->place.scan == source->place.scan) {
        source->check = heading->check;
    }
    slot->heard_us = now_us;
    if (slot->parts_here == slot->num_parts) {
        rho_feed_close_slot(feed, slot);
    }
}

/* ---- Scans that are due ---- */

/* The number before the slot's was skipped; if it comes, it is likely to be older than time_us. */
static int awaits_older(const struct rho_feed *feed, const struct rho_feed_slot *slot,
                        int64_t time_us)
{
    const struct rho_feed_source *source = &feed->sources[slot->source];

    return is_waiting(slot) && slot->order == FEED_ORDER_NEXT &&
           rho_elapsed_us(slot->place.time_us, time_us) < source->interval_us &&
           rho_feed_awaits(source, slot->place.scan);
}

/*
 * Every other live sensor has sent what is not older, none has skipped a number that may be, and nothing older is still
 * being put together.
 */
static int is_turn(const struct rho_feed *feed, const struct rho_feed_slot *slot, int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_feed_source *source = &feed->sources[i];

        if (source->is_used && source->off_clock == 0 &&
            source->place.time_us < slot->place.time_us &&
            rho_elapsed_us(now_us, source->heard_us) <= (uint64_t)feed->config.jump_max_us) {
            return 0;
        }
    }
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        const struct rho_feed_slot *other = &feed->slots[i];

        if ((other->state == FEED_SLOT_OPEN && other->place.time_us < slot->place.time_us) ||
            awaits_older(feed, other, slot->place.time_us)) {
            return 0;
        }
    }
    return 1;
}

static int has_waited(const struct rho_feed *feed, const struct rho_feed_slot *slot, int64_t now_us)
{
    uint64_t hold_us = (uint64_t)feed->config.hold_us;

    /* Nothing waits for a reception clock that was set back to come to where it was. */
    return now_us == INT64_MAX || rho_elapsed_us(now_us, slot->heard_us) >= hold_us ||
           rho_elapsed_us(slot->heard_us, now_us) > hold_us;
}

/* What was held goes out, and what is older before it, however long that has waited. What is early is not held yet. */
static int is_one_held(const struct rho_feed *feed, int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        if (feed->slots[i].state == FEED_SLOT_COMPLETE &&
            has_waited(feed, &feed->slots[i], now_us) && !is_early(feed, &feed->slots[i], now_us)) {
            return 1;
        }
    }
    return 0;
}

static void close_overdue(struct rho_feed *feed, int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct rho_feed_slot *slot = &feed->slots[i];

        if (slot->state == FEED_SLOT_OPEN && has_waited(feed, slot, now_us) &&
            (feed->config.hold_us > 0 || now_us == INT64_MAX)) {
            rho_feed_close_slot(feed, slot);
        }
    }
}

/* Of one time the lower sensor_id comes first, and of one sensor the lower kind. */
static int comes_before(const struct rho_feed_slot *a, const struct rho_feed_slot *b)
{
    if (a->place.time_us != b->place.time_us) {
        return a->place.time_us < b->place.time_us;
    }
    return a->sensor.sensor_id != b->sensor.sensor_id ? a->sensor.sensor_id < b->sensor.sensor_id
                                                      : a->kind < b->kind;
}

/* Without those that are early. */
static struct rho_feed_slot *find_first(struct rho_feed *feed, enum feed_slot_state state,
                                        int64_t now_us)
{
    struct rho_feed_slot *first = NULL;

    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct rho_feed_slot *slot = &feed->slots[i];

        if (slot->state == state && (!first || comes_before(slot, first)) &&
            !is_early(feed, slot, now_us)) {
            first = slot;
        }
    }
    return first;
}

/* A scan that goes out makes older ones late, so one whose parts are still coming goes before it, without them. */
static struct rho_feed_slot *or_older_open(struct rho_feed *feed, struct rho_feed_slot *slot,
                                           int64_t now_us)
{
    struct rho_feed_slot *open = find_first(feed, FEED_SLOT_OPEN, now_us);

    if (!open || open->place.time_us >= slot->place.time_us) {
        return slot;
    }
    rho_feed_close_slot(feed, open);
    return open;
}

struct rho_feed_slot *rho_feed_find_spare(struct rho_feed *feed, int64_t now_us)
{
    struct rho_feed_slot *spare = find_first(feed, FEED_SLOT_COMPLETE, now_us), *weak = NULL;
    uint32_t eldest_us = rho_feed_eldest_us(feed, now_us);

    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct rho_feed_slot *slot = &feed->slots[i];

        if (slot->state != FEED_SLOT_OPEN) {
            continue;
        }
        if (!rho_feed_is_proven(&feed->config, &feed->sources[slot->source]) ||
            rho_feed_is_new(feed->sources[slot->source].known_us, eldest_us)) {
            weak = weak ? weak : slot;
        } else if (spare && slot->place.time_us < spare->place.time_us) {
            spare = NULL;
        }
    }
    return spare ? spare : weak;
}

static struct rho_feed_slot *press(struct rho_feed *feed, int64_t now_us)
{
    struct rho_feed_slot *slot = rho_feed_find_spare(feed, now_us);

    slot = slot ? slot : find_first(feed, FEED_SLOT_COMPLETE, now_us);
    slot = slot ? slot : find_first(feed, FEED_SLOT_OPEN, now_us);
    if (slot && slot->state == FEED_SLOT_OPEN) {
        rho_feed_close_slot(feed, slot);
    }
    return slot;
}

/* Late scans that have waited until they are of no use any more. */
static void drop_useless(struct rho_feed *feed)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct rho_feed_slot *slot = &feed->slots[i];

        if (is_waiting(slot) && slot->order == FEED_ORDER_LATE &&
            !rho_feed_is_in_time(feed, (enum rho_feed_kind)slot->kind, slot->place.time_us)) {
            slot->state = FEED_SLOT_FREE; /* it was counted when it came */
        }
    }
}

struct rho_feed_slot *rho_feed_find_due(struct rho_feed *feed, int64_t now_us)
{
    struct rho_feed_slot *slot;

    drop_useless(feed);
    close_overdue(feed, now_us);
    if (feed->is_pressed) {
        return press(feed, now_us);
    }
    slot = find_first(feed, FEED_SLOT_COMPLETE, now_us);
    if (!slot) {
        return NULL;
    }
    if (is_one_held(feed, now_us)) {
        return feed->config.hold_us > 0 ? or_older_open(feed, slot, now_us) : slot;
    }
    return is_turn(feed, slot, now_us) ? slot : NULL;
}

void rho_feed_fill_item(const struct rho_feed_slot *slot, struct rho_feed_item *item)
{
    *item = (struct rho_feed_item){
        .kind = (enum rho_feed_kind)slot->kind,
        .sensor = slot->sensor,
        .has_sensor = slot->has_sensor,
        .parts_missing = (uint16_t)(slot->num_parts - slot->parts_here),
    };
    if (RHO_FEED_IS(slot->kind, RHO_FEED_BEARINGS)) {
        item->bearings = (struct rho_bearing_scan){.time_us = slot->place.time_us,
                                                   .sensor_id = slot->sensor.sensor_id,
                                                   .x_m = slot->sensor.x_m,
                                                   .y_m = slot->sensor.y_m,
                                                   .num_bearings = slot->num_inputs,
                                                   .bearings = slot->bearings};
    } else {
        item->scan = (struct rho_scan){.time_us = slot->place.time_us,
                                       .sensor_id = slot->sensor.sensor_id,
                                       .measures = slot->measures,
                                       .sector_from_rad = slot->sector_from_rad,
                                       .sector_to_rad = slot->sector_to_rad,
                                       .num_plots = slot->num_inputs,
                                       .plots = slot->plots};
    }
}
