/* SPDX-License-Identifier: MIT */
/* scan_slots: the slots in which scans are assembled, and the order in which scans go out. */
#include <string.h>

#include "scan_assembler_internal.h"

void rho_scan_assembler_increment(uint32_t *counter)
{
    *counter = rho_count(*counter, 1);
}

struct rho_scan_assembler_slot *
rho_scan_assembler_find_slot_in_state(struct rho_scan_assembler *assembler, enum slot_state state)
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

struct rho_scan_assembler_slot *
rho_scan_assembler_find_open_scan(struct rho_scan_assembler *assembler,
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

int rho_scan_assembler_has_open_out_of_sequence(const struct rho_scan_assembler *assembler,
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
static int is_slot_open_or_complete(const struct rho_scan_assembler_slot *slot)
{
    return slot->state == SLOT_OPEN || slot->state == SLOT_COMPLETE;
}

void rho_scan_assembler_complete_scan(struct rho_scan_assembler *assembler,
                                      struct rho_scan_assembler_slot *slot)
{
    if (slot->parts_here < slot->num_parts) {
        rho_scan_assembler_increment(&assembler->counters.scans_incomplete);
    }
    slot->state = SLOT_COMPLETE;
}

void rho_scan_assembler_complete_open_scans(struct rho_scan_assembler *assembler,
                                            const struct rho_scan_assembler_source *source,
                                            int numbers_restart)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct rho_scan_assembler_slot *slot = &assembler->slots[i];

        if (is_open_scan_of(assembler, slot, source)) {
            rho_scan_assembler_complete_scan(assembler, slot);
        }
        if (numbers_restart && slot->order == ORDER_NEXT &&
            &assembler->sources[slot->source] == source) {
            slot->order = ORDER_OF_OLD_NUMBERS;
        }
    }
}

static int is_newcomer_scan_held(const struct rho_scan_assembler *assembler,
                                 const struct rho_scan_assembler_slot *slot, int64_t now_us)
{
    return now_us < rho_scan_assembler_scan_of_new_sensor_held_until_us(assembler, slot);
}

static int is_of_established_sensor(const struct rho_scan_assembler *assembler,
                                    const struct rho_scan_assembler_slot *slot, int64_t now_us)
{
    return !HAS_OTHERS || !rho_scan_assembler_is_newcomer(
                              assembler->sources[slot->source].known_us,
                              rho_scan_assembler_eldest_sensor_known_us(assembler, now_us));
}

struct rho_scan_assembler_slot *
rho_scan_assembler_find_free_slot_or_drop_scan(struct rho_scan_assembler *assembler,
                                               int for_newcomer, int64_t now_us)
{
    struct rho_scan_assembler_slot *room =
        rho_scan_assembler_find_slot_in_state(assembler, SLOT_FREE);

    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS && !room; i++) {
        struct rho_scan_assembler_slot *slot = &assembler->slots[i];

        if (is_slot_open_or_complete(slot) && !for_newcomer &&
            is_newcomer_scan_held(assembler, slot, now_us)) {
            rho_scan_assembler_increment(&assembler->counters.sensors_no_room);
            slot->state = SLOT_FREE;
            room = slot;
        } else if (is_slot_open_or_complete(slot) && slot->order == ORDER_OUT_OF_SEQUENCE &&
                   !(for_newcomer && is_of_established_sensor(assembler, slot, now_us))) {
            slot->state = SLOT_FREE; /* scans_late has counted it before */
            room = slot;
        }
    }
    return room;
}

void rho_scan_assembler_drop_waiting_scans(struct rho_scan_assembler *assembler)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct rho_scan_assembler_slot *slot = &assembler->slots[i];

        if (is_slot_open_or_complete(slot)) {
            /* an out-of-sequence scan was counted in scans_late when it came */
            assembler->counters.scans_late =
                rho_count(assembler->counters.scans_late, slot->order != ORDER_OUT_OF_SEQUENCE);
            slot->state = SLOT_FREE;
        }
    }
}

static void set_sensor_of_slot(const struct rho_scan_assembler *assembler,
                               struct rho_scan_assembler_slot *slot,
                               const struct scan_heading *heading)
{
    const struct rho_scan_assembler_sensor *known =
        rho_scan_assembler_sensor_or_default(assembler, heading->sensor_id);
    int has_place = heading->x_m < 0.0f || heading->x_m > 0.0f || heading->y_m < 0.0f ||
                    heading->y_m > 0.0f || heading->z_m < 0.0f || heading->z_m > 0.0f;

    slot->sensor = known->sensor;
    slot->sensor.sensor_id = heading->sensor_id;
    if (has_place || RHO_SCAN_ASSEMBLER_IS(heading->kind, RHO_SCAN_ASSEMBLER_BEARINGS)) {
        slot->sensor.x_m = heading->x_m;
        slot->sensor.y_m = heading->y_m;
        slot->sensor.z_m = heading->z_m;
    }
    slot->has_sensor =
        (uint8_t)(known != &assembler->config.other || assembler->config.gives_other ||
                  (has_place &&
                   !RHO_SCAN_ASSEMBLER_IS(heading->kind, RHO_SCAN_ASSEMBLER_BEARINGS)));
}

void rho_scan_assembler_open_scan(struct rho_scan_assembler *assembler,
                                  struct rho_scan_assembler_slot *slot,
                                  const struct rho_scan_assembler_source *source,
                                  const struct scan_heading *heading, enum slot_order order)
{
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
    set_sensor_of_slot(assembler, slot, heading);
    slot->state = SLOT_OPEN;
}

/* ---- Parts ---- */

static int is_equal_float(float a, float b)
{
    return a <= b && a >= b;
}

/* 1 where a part agrees with its scan on time, number of parts, measures, sector and position. */
static int do_time_parts_sector_and_place_match_slot(const struct rho_scan_assembler_slot *slot,
                                                     const struct scan_heading *heading)
{
    int has_place = RHO_SCAN_ASSEMBLER_IS(heading->kind, RHO_SCAN_ASSEMBLER_POLAR);

    return slot->place.time_us == heading->place.time_us && slot->num_parts == heading->num_parts &&
           slot->measures == heading->measures &&
           is_equal_float(slot->sector_from_rad, heading->sector_from_rad) &&
           is_equal_float(slot->sector_to_rad, heading->sector_to_rad) &&
           (!has_place ||
            ((is_equal_float(slot->sensor.x_m, heading->x_m) &&
              is_equal_float(slot->sensor.y_m, heading->y_m) &&
              is_equal_float(slot->sensor.z_m, heading->z_m)) ||
             (is_equal_float(heading->x_m, 0.0f) && is_equal_float(heading->y_m, 0.0f) &&
              is_equal_float(heading->z_m, 0.0f))));
}

void rho_scan_assembler_count_duplicate(struct rho_scan_assembler *assembler,
                                        struct rho_scan_assembler_source *source,
                                        const struct scan_heading *heading)
{
    if (heading->part == 0 && heading->place.scan == source->place.scan &&
        source->check > CHECK_NOT_ADMITTED && source->check != heading->check) {
        source->has_two_senders = 1;
        rho_scan_assembler_increment(&assembler->counters.scans_other);
    } else {
        rho_scan_assembler_increment(&assembler->counters.scans_duplicate);
    }
}

void rho_scan_assembler_add_part(struct rho_scan_assembler *assembler,
                                 struct rho_scan_assembler_slot *slot,
                                 const struct scan_heading *heading,
                                 const union scan_message *message, int64_t now_us)
{
    struct rho_scan_assembler_source *source = &assembler->sources[slot->source];

    if (slot->parts[heading->part] > 0) {
        rho_scan_assembler_count_duplicate(assembler, source, heading);
        return;
    }
    if (slot->parts_here > 0 && !do_time_parts_sector_and_place_match_slot(slot, heading)) {
        rho_scan_assembler_increment(&assembler->counters.scans_bad);
        return;
    }
    rho_scan_assembler_add_measurements(assembler, slot, heading, message);
    if (heading->part == 0 && heading->place.scan == source->place.scan) {
        source->check = heading->check;
    }
    slot->heard_us = now_us;
    if (slot->parts_here == slot->num_parts) {
        rho_scan_assembler_complete_scan(assembler, slot);
    }
}

/* ---- Scans that are due ---- */

/* 1 where the scan before the slot's was skipped, and may still come with a time before time_us. */
static int awaits_skipped_older_scan(const struct rho_scan_assembler *assembler,
                                     const struct rho_scan_assembler_slot *slot, int64_t time_us)
{
    const struct rho_scan_assembler_source *source = &assembler->sources[slot->source];

    return is_slot_open_or_complete(slot) && slot->order == ORDER_NEXT &&
           rho_elapsed_us(slot->place.time_us, time_us) < source->interval_us &&
           rho_scan_assembler_awaits_previous_number(source, slot->place.scan);
}

/*
 * 1 where a scan is the next one in the order of time: every other live sensor has sent a scan that
 * is not older, no skipped number may be older, and no older scan waits for parts.
 */
static int is_next_in_time(const struct rho_scan_assembler *assembler,
                           const struct rho_scan_assembler_slot *slot, int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_scan_assembler_source *source = &assembler->sources[i];

        if (source->is_used && source->off_clock == 0 &&
            source->place.time_us < slot->place.time_us &&
            rho_elapsed_us(now_us, source->heard_us) <= (uint64_t)assembler->config.jump_max_us) {
            return 0;
        }
    }
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        const struct rho_scan_assembler_slot *other = &assembler->slots[i];

        if ((other->state == SLOT_OPEN && other->place.time_us < slot->place.time_us) ||
            awaits_skipped_older_scan(assembler, other, slot->place.time_us)) {
            return 0;
        }
    }
    return 1;
}

static int has_waited_hold_us(const struct rho_scan_assembler *assembler,
                              const struct rho_scan_assembler_slot *slot, int64_t now_us)
{
    uint64_t hold_us = (uint64_t)assembler->config.hold_us;

    /* A scan does not wait for a reception clock that was set back to catch up. */
    return now_us == INT64_MAX || rho_elapsed_us(now_us, slot->heard_us) >= hold_us ||
           rho_elapsed_us(slot->heard_us, now_us) > hold_us;
}

/*
 * 1 where any complete scan has waited hold_us: it goes out, and older ones before it, however
 * short they have waited. Held scans of newcomers do not count.
 */
static int has_any_scan_waited_hold_us(const struct rho_scan_assembler *assembler, int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        if (assembler->slots[i].state == SLOT_COMPLETE &&
            has_waited_hold_us(assembler, &assembler->slots[i], now_us) &&
            !is_newcomer_scan_held(assembler, &assembler->slots[i], now_us)) {
            return 1;
        }
    }
    return 0;
}

static void complete_overdue_scans(struct rho_scan_assembler *assembler, int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct rho_scan_assembler_slot *slot = &assembler->slots[i];

        if (slot->state == SLOT_OPEN && has_waited_hold_us(assembler, slot, now_us) &&
            (assembler->config.hold_us > 0 || now_us == INT64_MAX)) {
            rho_scan_assembler_complete_scan(assembler, slot);
        }
    }
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
static struct rho_scan_assembler_slot *
find_first_scan_in_state(struct rho_scan_assembler *assembler, enum slot_state state,
                         int64_t now_us)
{
    struct rho_scan_assembler_slot *first = NULL;

    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct rho_scan_assembler_slot *slot = &assembler->slots[i];

        if (slot->state == state && (!first || comes_before(slot, first)) &&
            !is_newcomer_scan_held(assembler, slot, now_us)) {
            first = slot;
        }
    }
    return first;
}

/*
 * An older scan whose parts are still coming goes out before a due one, incomplete: behind it, it
 * would be out of sequence.
 */
static struct rho_scan_assembler_slot *
complete_older_open_scan_of_any_sensor(struct rho_scan_assembler *assembler,
                                       struct rho_scan_assembler_slot *slot, int64_t now_us)
{
    struct rho_scan_assembler_slot *open = find_first_scan_in_state(assembler, SLOT_OPEN, now_us);

    if (!open || open->place.time_us >= slot->place.time_us) {
        return slot;
    }
    rho_scan_assembler_complete_scan(assembler, open);
    return open;
}

struct rho_scan_assembler_slot *
rho_scan_assembler_find_scan_to_release_early(struct rho_scan_assembler *assembler, int64_t now_us)
{
    struct rho_scan_assembler_slot *spare =
                                       find_first_scan_in_state(assembler, SLOT_COMPLETE, now_us),
                                   *weak = NULL;
    uint32_t eldest_us =
        HAS_OTHERS ? rho_scan_assembler_eldest_sensor_known_us(assembler, now_us) : 0u;

    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct rho_scan_assembler_slot *slot = &assembler->slots[i];

        if (slot->state != SLOT_OPEN) {
            continue;
        }
        if (!rho_scan_assembler_is_proven(&assembler->config, &assembler->sources[slot->source]) ||
            rho_scan_assembler_is_newcomer(assembler->sources[slot->source].known_us, eldest_us)) {
            weak = weak ? weak : slot;
        } else if (spare && slot->place.time_us < spare->place.time_us) {
            spare = NULL;
        }
    }
    return spare ? spare : weak;
}

static struct rho_scan_assembler_slot *choose_scan_for_room(struct rho_scan_assembler *assembler,
                                                            int64_t now_us)
{
    struct rho_scan_assembler_slot *slot =
        rho_scan_assembler_find_scan_to_release_early(assembler, now_us);

    slot = slot ? slot : find_first_scan_in_state(assembler, SLOT_COMPLETE, now_us);
    slot = slot ? slot : find_first_scan_in_state(assembler, SLOT_OPEN, now_us);
    if (slot && slot->state == SLOT_OPEN) {
        rho_scan_assembler_complete_scan(assembler, slot);
    }
    return slot;
}

/* Drops out-of-sequence scans that have become too old while they waited. */
static void drop_too_late_scans(struct rho_scan_assembler *assembler)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct rho_scan_assembler_slot *slot = &assembler->slots[i];

        if (is_slot_open_or_complete(slot) && slot->order == ORDER_OUT_OF_SEQUENCE &&
            !rho_scan_assembler_is_not_too_late(assembler, (enum rho_scan_assembler_kind)slot->kind,
                                                slot->place.time_us)) {
            slot->state = SLOT_FREE; /* scans_late has counted the scan before */
        }
    }
}

struct rho_scan_assembler_slot *
rho_scan_assembler_complete_and_find_due(struct rho_scan_assembler *assembler, int64_t now_us)
{
    struct rho_scan_assembler_slot *slot;

    drop_too_late_scans(assembler);
    complete_overdue_scans(assembler, now_us);
    if (assembler->is_pressed) {
        return choose_scan_for_room(assembler, now_us);
    }
    slot = find_first_scan_in_state(assembler, SLOT_COMPLETE, now_us);
    if (!slot) {
        return NULL;
    }
    if (has_any_scan_waited_hold_us(assembler, now_us)) {
        return assembler->config.hold_us > 0
                   ? complete_older_open_scan_of_any_sensor(assembler, slot, now_us)
                   : slot;
    }
    return is_next_in_time(assembler, slot, now_us) ? slot : NULL;
}

void rho_scan_assembler_fill_item_with_scan(const struct rho_scan_assembler_slot *slot,
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
