/* SPDX-License-Identifier: MIT */
#include "io/scans/scan_numbers.h"

#include <stdbool.h>
#include <stdlib.h>

#include "base/common.h"

struct scan_numbers_slot {
    int32_t sensor_id;
    struct scan_number number; /* is_given false: the slot is free */
    size_t scan;
};

/*
 * Hash of a sensor and number: multiplicative, by 2^64 over the golden ratio, so that every bit of
 * the key affects the lower bits of the result.
 */
static size_t hash_scan_number(int32_t sensor_id, const struct scan_number *number)
{
    const uint64_t multiplier = UINT64_C(0x9E3779B97F4A7C15);
    uint64_t mixed = (uint32_t)sensor_id * multiplier;

    mixed = ((mixed ^ mixed >> 32) + (uint32_t)number->epoch) * multiplier;
    mixed = ((mixed ^ mixed >> 32) + (uint32_t)number->scan) * multiplier;
    return (size_t)(mixed ^ mixed >> 32);
}

/* The slot of a sensor and number, or the free slot for it; there is always a free one. */
static struct scan_numbers_slot *find_slot(const struct scan_numbers *numbers, int32_t sensor_id,
                                           const struct scan_number *number)
{
    size_t at = hash_scan_number(sensor_id, number);

    for (;; at++) {
        struct scan_numbers_slot *slot = &numbers->slots[at & (numbers->capacity - 1)];
        bool is_it = slot->sensor_id == sensor_id && slot->number.epoch == number->epoch &&
                     slot->number.scan == number->scan;

        if (!slot->number.is_given || is_it) {
            return slot;
        }
    }
}

static bool is_slot_used_and_not_dropped(const struct scan_numbers *numbers,
                                         const struct scan_numbers_slot *slot)
{
    return slot->number.is_given && slot->scan >= numbers->dropped;
}

static size_t count_slots_not_dropped(const struct scan_numbers *numbers)
{
    size_t wanted = 0;

    for (size_t i = 0; i < numbers->capacity; i++) {
        wanted += is_slot_used_and_not_dropped(numbers, &numbers->slots[i]);
    }
    return wanted;
}

/*
 * Ensures that at most half of the slots are used: makes a new table of the wanted slots, at most a
 * quarter full, where needed.
 */
static void ensure_free_slots(struct scan_numbers *numbers)
{
    const struct scan_numbers old = *numbers;

    if (2 * (old.count + 1) <= old.capacity) {
        return;
    }
    numbers->count = count_slots_not_dropped(&old);
    for (numbers->capacity = 64; numbers->capacity < 4 * (numbers->count + 1);) {
        numbers->capacity *= 2;
    }
    numbers->slots = must_calloc(numbers->capacity, sizeof *numbers->slots);
    for (size_t i = 0; i < old.capacity; i++) {
        if (is_slot_used_and_not_dropped(&old, &old.slots[i])) {
            *find_slot(numbers, old.slots[i].sensor_id, &old.slots[i].number) = old.slots[i];
        }
    }
    free(old.slots);
}

size_t scan_numbers_find_scan_index(const struct scan_numbers *numbers, int32_t sensor_id,
                                    const struct scan_number *number)
{
    const struct scan_numbers_slot *slot;

    if (!number->is_given || numbers->count == 0) {
        return SCAN_NUMBERS_NONE;
    }
    slot = find_slot(numbers, sensor_id, number);
    return slot->number.is_given ? slot->scan : SCAN_NUMBERS_NONE;
}

void scan_numbers_set_scan(struct scan_numbers *numbers, int32_t sensor_id,
                           const struct scan_number *number, size_t scan)
{
    struct scan_numbers_slot *slot;

    if (!number->is_given) {
        return;
    }
    ensure_free_slots(numbers);
    slot = find_slot(numbers, sensor_id, number);
    numbers->count += !slot->number.is_given;
    *slot = (struct scan_numbers_slot){sensor_id, *number, scan};
}

void scan_numbers_drop_before(struct scan_numbers *numbers, size_t before)
{
    numbers->dropped = before;
}

void scan_numbers_clear(struct scan_numbers *numbers)
{
    free(numbers->slots);
    *numbers = (struct scan_numbers){.slots = NULL};
}
