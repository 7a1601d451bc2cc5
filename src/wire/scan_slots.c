/* SPDX-License-Identifier: MIT */
/* scan_slots: the slots in which scans are assembled, and the order in which scans go out. */
#include <string.h>

#include "rhotrack/detail/approx.h"
#include "scan_internal.h"

void rho_scan_increment(uint32_t *counter)
{
    *counter = rho_count(*counter, 1);
}

struct rho_scan_assembler_slot *rho_slot_in_state(struct rho_scan_assembler *assembler,
                                                  enum slot_state state)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        if (assembler->slots[i].state == state) {
            return &assembler->slots[i];
        }
    }
    return NULL;
}

static int is_open_scan_of(const struct rho_scan_assembler *assembler,
                           const struct rho_scan_assembler_slot *slot,
                           const struct rho_scan_assembler_source *source)
{
    return slot->state == SLOT_OPEN && &assembler->sources[slot->source] == source;
}

struct rho_scan_assembler_slot *rho_slot_find_open(struct rho_scan_assembler *assembler,
                                                   const struct rho_scan_assembler_source *source,
                                                   const struct scan_heading *heading)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct rho_scan_assembler_slot *slot = &assembler->slots[i];
        if (is_open_scan_of(assembler, slot, source) && slot->place.scan == heading->place.scan &&
            slot->place.epoch == heading->place.epoch) {
            return slot;
        }
    }
    return NULL;
}

int rho_slot_has_out_of_sequence(const struct rho_scan_assembler *assembler,
                                 const struct rho_scan_assembler_source *source)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        if (is_open_scan_of(assembler, &assembler->slots[i], source) &&
            assembler->slots[i].order == ORDER_OUT_OF_SEQUENCE) {
            return 1;
        }
    }
    return 0;
}

/* 1 where a slot's scan waits for parts, or to go out. */
static int is_waiting(const struct rho_scan_assembler_slot *slot)
{
    return slot->state == SLOT_OPEN || slot->state == SLOT_COMPLETE;
}

/* Ends the wait for parts of an open scan; counts the scan where some are missing. */
static void complete_slot(struct rho_scan_assembler *assembler,
                          struct rho_scan_assembler_slot *slot)
{
    uint32_t *incomplete = &assembler->counters.scans_incomplete;
    *incomplete = rho_count(*incomplete, slot->parts_here < slot->num_parts);
    slot->state = SLOT_COMPLETE;
}

void rho_slot_complete_all(struct rho_scan_assembler *assembler,
                           const struct rho_scan_assembler_source *source, int numbers_restart)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct rho_scan_assembler_slot *slot = &assembler->slots[i];
        if (is_open_scan_of(assembler, slot, source)) {
            complete_slot(assembler, slot);
        }
        if (numbers_restart && slot->order == ORDER_NEXT &&
            &assembler->sources[slot->source] == source) {
            slot->order = ORDER_OF_OLD_NUMBERS;
        }
    }
}

/* 1 where the slot's scan is a newcomer's, and is held. */
static int is_held(const struct rho_scan_assembler *assembler,
                   const struct rho_scan_assembler_slot *slot, int64_t now_us)
{
    return now_us < rho_scan_held_until_us(assembler, slot);
}

struct rho_scan_assembler_slot *rho_slot_make_free(struct rho_scan_assembler *assembler,
                                                   int for_newcomer, int64_t now_us)
{
    struct rho_scan_assembler_slot *room = rho_slot_in_state(assembler, SLOT_FREE);
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS && !room; i++) {
        struct rho_scan_assembler_slot *slot = &assembler->slots[i];
        if (is_waiting(slot) && !for_newcomer && is_held(assembler, slot, now_us)) {
            rho_scan_increment(&assembler->counters.sensors_no_room);
            slot->state = SLOT_FREE;
            room = slot;
        } else if (is_waiting(slot) && slot->order == ORDER_OUT_OF_SEQUENCE &&
                   (!for_newcomer || /* a newcomer does not take an established sensor's place */
                    (HAS_OTHERS &&
                     rho_scan_is_newcomer(assembler->sources[slot->source].known_us,
                                          rho_scan_eldest_known_us(assembler, now_us))))) {
            slot->state = SLOT_FREE; /* scans_late has counted it before */
            room = slot;
        }
    }
    return room;
}

void rho_slot_drop_waiting(struct rho_scan_assembler *assembler)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct rho_scan_assembler_slot *slot = &assembler->slots[i];
        if (is_waiting(slot)) {
            /* an out-of-sequence scan was counted in scans_late when it came */
            assembler->counters.scans_late =
                rho_count(assembler->counters.scans_late, slot->order != ORDER_OUT_OF_SEQUENCE);
            slot->state = SLOT_FREE;
        }
    }
}

static int is_at_origin(const struct scan_heading *heading)
{
    return rho_is_equal(heading->x_m, 0.0f) && rho_is_equal(heading->y_m, 0.0f) &&
           rho_is_equal(heading->z_m, 0.0f);
}

struct rho_scan_assembler_slot *rho_slot_open(struct rho_scan_assembler *assembler,
                                              const struct rho_scan_assembler_source *source,
                                              const struct scan_heading *heading,
                                              enum slot_order order)
{
    struct rho_scan_assembler_slot *slot = rho_slot_in_state(assembler, SLOT_FREE);
    const struct rho_scan_assembler_sensor *known = rho_scan_sensor(assembler, heading->sensor_id);
    const int is_bearings = RHO_SCAN_ASSEMBLER_IS(heading->kind, RHO_SCAN_ASSEMBLER_BEARINGS);
    const int has_place = !is_at_origin(heading);
    slot->place = heading->place;
    slot->measures = heading->measures;
    slot->sector_from_rad = heading->sector_from_rad;
    slot->sector_to_rad = heading->sector_to_rad;
    slot->source = (uint16_t)(source - assembler->sources);
    slot->num_parts = heading->num_parts;
    slot->parts_here = 0;
    slot->num_inputs = 0;
    slot->kind = heading->kind;
    slot->order = (uint8_t)order;
    memset(slot->parts, 0, sizeof slot->parts);
    slot->sensor = known->sensor;
    slot->sensor.sensor_id = heading->sensor_id;
    if (has_place || is_bearings) {
        slot->sensor.x_m = heading->x_m;
        slot->sensor.y_m = heading->y_m;
        slot->sensor.z_m = heading->z_m;
    }
    slot->has_sensor = (uint8_t)(known != &assembler->config.other ||
                                 assembler->config.gives_other || (has_place && !is_bearings));
    slot->state = SLOT_OPEN;
    rho_scan_increment(&assembler->counters.scans_accepted);
    return slot;
}

/* Parts */

/* 1 where a part agrees with its scan on time, number of parts, measures, sector and position. */
static int does_part_match(const struct rho_scan_assembler_slot *slot,
                           const struct scan_heading *heading)
{
    return slot->place.time_us == heading->place.time_us && slot->num_parts == heading->num_parts &&
           slot->measures == heading->measures &&
           rho_is_equal(slot->sector_from_rad, heading->sector_from_rad) &&
           rho_is_equal(slot->sector_to_rad, heading->sector_to_rad) &&
           (!RHO_SCAN_ASSEMBLER_IS(heading->kind, RHO_SCAN_ASSEMBLER_POLAR) ||
            is_at_origin(heading) ||
            (rho_is_equal(slot->sensor.x_m, heading->x_m) &&
             rho_is_equal(slot->sensor.y_m, heading->y_m) &&
             rho_is_equal(slot->sensor.z_m, heading->z_m)));
}

void rho_slot_count_duplicate(struct rho_scan_assembler *assembler,
                              struct rho_scan_assembler_source *source,
                              const struct scan_heading *heading)
{
    if (heading->part == 0 && heading->place.scan == source->place.scan &&
        source->check > CHECK_NOT_ADMITTED && source->check != heading->check) {
        source->has_two_senders = 1;
        rho_scan_increment(&assembler->counters.scans_other);
    } else {
        rho_scan_increment(&assembler->counters.scans_duplicate);
    }
}

void rho_slot_add_part(struct rho_scan_assembler *assembler, struct rho_scan_assembler_slot *slot,
                       const struct scan_heading *heading, const union scan_message *message,
                       int64_t now_us)
{
    struct rho_scan_assembler_source *source = &assembler->sources[slot->source];
    if (slot->parts[heading->part] > 0) {
        rho_slot_count_duplicate(assembler, source, heading);
        return;
    }
    if (slot->parts_here > 0 && !does_part_match(slot, heading)) {
        rho_scan_increment(&assembler->counters.scans_bad);
        return;
    }
    rho_slot_add_measurements(assembler, slot, heading, message);
    if (heading->part == 0 && heading->place.scan == source->place.scan) {
        source->check = heading->check;
    }
    slot->heard_us = now_us;
    if (slot->parts_here == slot->num_parts) {
        complete_slot(assembler, slot);
    }
}

/* Scans that are due */

/*
 * 1 where a scan is the next one in the order of time: every other live sensor has sent a scan that
 * is not older, no skipped number may be older, and no older scan waits for parts.
 */
static int is_next_in_time(const struct rho_scan_assembler *assembler,
                           const struct rho_scan_assembler_slot *slot, int64_t now_us)
{
    const int64_t time_us = slot->place.time_us;
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_scan_assembler_source *source = &assembler->sources[i];
        if (source->off_clock == 0 && source->place.time_us < time_us &&
            rho_scan_is_live(assembler, source, now_us)) {
            return 0;
        }
    }
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        const struct rho_scan_assembler_slot *other = &assembler->slots[i];
        const struct rho_scan_assembler_source *source = &assembler->sources[other->source];
        if ((other->state == SLOT_OPEN && other->place.time_us < time_us) ||
            /* the scan before it was skipped, and may still come with a time before time_us */
            (is_waiting(other) && other->order == ORDER_NEXT &&
             rho_elapsed_us(other->place.time_us, time_us) < source->interval_us &&
             rho_scan_awaits_previous(source, other->place.scan))) {
            return 0;
        }
    }
    return 1;
}

static int has_waited(const struct rho_scan_assembler *assembler,
                      const struct rho_scan_assembler_slot *slot, int64_t now_us)
{
    const uint64_t hold_us = (uint64_t)assembler->config.hold_us;
    /* A scan does not wait for a reception clock that was set back to catch up. */
    return now_us == INT64_MAX || rho_elapsed_us(now_us, slot->heard_us) >= hold_us ||
           rho_elapsed_us(slot->heard_us, now_us) > hold_us;
}

/* The order in which scans go out: by time, then sensor_id, then kind. */
static int comes_before(const struct rho_scan_assembler_slot *a,
                        const struct rho_scan_assembler_slot *b)
{
    if (a->place.time_us != b->place.time_us) {
        return a->place.time_us < b->place.time_us;
    }
    return a->sensor.sensor_id != b->sensor.sensor_id ? a->sensor.sensor_id < b->sensor.sensor_id
                                                      : a->kind < b->kind;
}

/* The first scan to go out of those in a state; held scans of newcomers are left out. */
static struct rho_scan_assembler_slot *find_first(struct rho_scan_assembler *assembler,
                                                  enum slot_state state, int64_t now_us)
{
    struct rho_scan_assembler_slot *first = NULL;
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct rho_scan_assembler_slot *slot = &assembler->slots[i];
        if (slot->state == state && (!first || comes_before(slot, first)) &&
            !is_held(assembler, slot, now_us)) {
            first = slot;
        }
    }
    return first;
}

struct rho_scan_assembler_slot *rho_slot_find_spare(struct rho_scan_assembler *assembler,
                                                    int64_t now_us)
{
    struct rho_scan_assembler_slot *spare = find_first(assembler, SLOT_COMPLETE, now_us);
    struct rho_scan_assembler_slot *weak = NULL;
    const uint32_t eldest_us = rho_scan_eldest_known_us(assembler, now_us);
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct rho_scan_assembler_slot *slot = &assembler->slots[i];
        const struct rho_scan_assembler_source *source = &assembler->sources[slot->source];
        if (slot->state != SLOT_OPEN) {
            continue;
        }
        if (!rho_scan_is_proven(&assembler->config, source) ||
            rho_scan_is_newcomer(source->known_us, eldest_us)) {
            weak = weak ? weak : slot;
        } else if (spare && slot->place.time_us < spare->place.time_us) {
            spare = NULL;
        }
    }
    return spare ? spare : weak;
}

/* Completes overdue scans and drops late ones; returns the scan to go out now, or NULL. */
static struct rho_scan_assembler_slot *find_due(struct rho_scan_assembler *assembler,
                                                int64_t now_us)
{
    const int has_hold = assembler->config.hold_us > 0;
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct rho_scan_assembler_slot *slot = &assembler->slots[i];
        if (is_waiting(slot) && slot->order == ORDER_OUT_OF_SEQUENCE &&
            !rho_scan_is_in_time(assembler, (enum rho_scan_assembler_kind)slot->kind,
                                 slot->place.time_us)) {
            slot->state = SLOT_FREE; /* became too late while it waited; scans_late has it */
        } else if (slot->state == SLOT_OPEN && has_waited(assembler, slot, now_us) &&
                   (has_hold || now_us == INT64_MAX)) {
            complete_slot(assembler, slot);
        }
    }
    struct rho_scan_assembler_slot *slot;
    if (assembler->is_pressed) { /* one must go out to make room */
        slot = rho_slot_find_spare(assembler, now_us);
        slot = slot ? slot : find_first(assembler, SLOT_COMPLETE, now_us);
        slot = slot ? slot : find_first(assembler, SLOT_OPEN, now_us);
        if (slot && slot->state == SLOT_OPEN) {
            complete_slot(assembler, slot);
        }
        return slot;
    }
    slot = find_first(assembler, SLOT_COMPLETE, now_us);
    if (!slot) {
        return NULL;
    }
    /*
     * Where any complete scan has waited hold_us, it goes out, and older ones before it, however
     * short they have waited. Held scans of newcomers do not count.
     */
    int is_due = 0;
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS && !is_due; i++) {
        is_due = assembler->slots[i].state == SLOT_COMPLETE &&
                 has_waited(assembler, &assembler->slots[i], now_us) &&
                 !is_held(assembler, &assembler->slots[i], now_us);
    }
    if (!is_due) {
        return is_next_in_time(assembler, slot, now_us) ? slot : NULL;
    }
    /*
     * An older scan whose parts are still coming goes out before a due one, incomplete: behind it,
     * it would be out of sequence.
     */
    struct rho_scan_assembler_slot *open =
        has_hold ? find_first(assembler, SLOT_OPEN, now_us) : NULL;
    if (open && open->place.time_us < slot->place.time_us) {
        complete_slot(assembler, open);
        return open;
    }
    return slot;
}

static void fill_item(const struct rho_scan_assembler_slot *slot,
                      struct rho_scan_assembler_item *item)
{
    *item = (struct rho_scan_assembler_item){
        .kind = (enum rho_scan_assembler_kind)slot->kind,
        .sensor = slot->sensor,
        .has_sensor = slot->has_sensor,
        .parts_missing = (uint16_t)(slot->num_parts - slot->parts_here),
        .heard_us = slot->heard_us,
    };
    if (RHO_SCAN_ASSEMBLER_IS(slot->kind, RHO_SCAN_ASSEMBLER_BEARINGS)) {
        item->bearings = (struct rho_bearing_scan){.time_us = slot->place.time_us,
                                                   .sensor_id = slot->sensor.sensor_id,
                                                   .x_m = slot->sensor.x_m,
                                                   .y_m = slot->sensor.y_m,
                                                   .z_m = slot->sensor.z_m,
                                                   .sector_from_rad = slot->sector_from_rad,
                                                   .sector_to_rad = slot->sector_to_rad,
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

int rho_scan_assembler_next(struct rho_scan_assembler *assembler, int64_t now_us,
                            struct rho_scan_assembler_item *item)
{
    if (!assembler || !item || assembler->magic != SCAN_MAGIC) {
        return 0;
    }
    struct rho_scan_assembler_slot *slot = rho_slot_in_state(assembler, SLOT_GIVEN);
    if (slot) {
        slot->state = SLOT_FREE;
    }
    if (rho_slot_in_state(assembler, SLOT_FREE)) {
        assembler->is_pressed = 0; /* there is room: no scan has to go out early */
    }
    slot = find_due(assembler, now_us);
    if (!slot) {
        return 0;
    }
    slot->state = SLOT_GIVEN;
    assembler->out_us =
        assembler->out_us > slot->place.time_us ? assembler->out_us : slot->place.time_us;
    fill_item(slot, item);
    item->is_restart = assembler->is_restart;
    assembler->is_restart = 0;
    return 1;
}

int64_t rho_scan_assembler_due_us(const struct rho_scan_assembler *assembler)
{
    int64_t due_us = INT64_MAX;
    if (!assembler || assembler->magic != SCAN_MAGIC) {
        return due_us;
    }
    const int64_t hold_us = assembler->config.hold_us;
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        const struct rho_scan_assembler_slot *slot = &assembler->slots[i];
        if ((slot->state == SLOT_COMPLETE || (slot->state == SLOT_OPEN && hold_us > 0)) &&
            slot->heard_us <= INT64_MAX - hold_us) {
            const int64_t early_us =
                slot->state == SLOT_COMPLETE ? rho_scan_held_until_us(assembler, slot) : INT64_MIN;
            int64_t held_us = slot->heard_us + hold_us;
            held_us = early_us > held_us ? early_us : held_us;
            due_us = held_us < due_us ? held_us : due_us;
        }
    }
    return due_us;
}
