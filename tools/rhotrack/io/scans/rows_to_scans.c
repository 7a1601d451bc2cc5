/* SPDX-License-Identifier: MIT */
#include "io/scans/rows_to_scans.h"

#include <stdlib.h>
#include <string.h>

#include "base/common.h"

void rows_to_scans_start(struct rows_to_scans *gather, size_t element_bytes, int64_t interval_us)
{
    *gather = (struct rows_to_scans){.element_bytes = element_bytes, .interval_us = interval_us};
}

void rows_to_scans_set_reception(struct rows_to_scans *gather, int64_t received_us)
{
    gather->has_clock = true;
    gather->clock_us = received_us;
}

/* The time by which rows are ordered: of reception where the file has it, else the row's own. */
static int64_t reception_time_or_row_time_us(const struct rows_to_scans *gather, int64_t time_us)
{
    return gather->has_clock ? gather->clock_us : time_us;
}

/* The sensor's newest scan in memory; NULL where there is none. */
static struct gathered_scan *newest_scan_of_sensor(struct rows_to_scans *gather, int32_t sensor_id)
{
    for (size_t i = gather->count; i-- > 0;) {
        if (gather->scans[i].sensor_id == sensor_id) {
            return &gather->scans[i];
        }
    }
    return NULL;
}

/*
 * The scan in memory with an index in the file, by binary search; NULL where it is not in memory.
 */
static struct gathered_scan *find_scan_by_order(struct rows_to_scans *gather, size_t order)
{
    size_t first = 0, end = gather->count;

    while (first < end) {
        size_t middle = first + (end - first) / 2;

        if (gather->scans[middle].order < order) {
            first = middle + 1;
        } else {
            end = middle;
        }
    }
    return first < gather->count && gather->scans[first].order == order ? &gather->scans[first]
                                                                        : NULL;
}

struct gathered_scan *rows_to_scans_find_scan(struct rows_to_scans *gather, int32_t sensor_id,
                                              const struct scan_number *number, int64_t time_us)
{
    size_t order = scan_numbers_find_scan_index(&gather->numbers, sensor_id, number);
    struct gathered_scan *scan =
        order == SCAN_NUMBERS_NONE ? NULL : find_scan_by_order(gather, order);

    scan = scan ? scan : newest_scan_of_sensor(gather, sensor_id);
    return scan && row_joins_scan(number, time_us, &scan->number, scan->start_us,
                                  gather->interval_us)
               ? scan
               : NULL;
}

bool rows_to_scans_check_time(const struct rows_to_scans *gather, const struct gathered_scan *scan,
                              int64_t time_us, const struct row_check *check)
{
    bool is_within = scan && scan->number.is_given && !gather->has_clock;
    int64_t clock_us = reception_time_or_row_time_us(gather, time_us);

    return is_within || !gather->has_rows || clock_us >= gather->last_us ||
           row_refuse_decrease(check, gather->has_clock, gather->last_us, clock_us);
}

static void note_last_heard_time(struct rows_to_scans *gather, struct gathered_scan *scan,
                                 int64_t time_us)
{
    scan->heard_us = reception_time_or_row_time_us(gather, time_us);
    if (!gather->has_rows || scan->heard_us > gather->last_us) {
        gather->last_us = scan->heard_us;
    }
    gather->has_rows = true;
}

struct gathered_scan *rows_to_scans_begin_scan(struct rows_to_scans *gather,
                                               const struct gathered_scan *heading, int64_t time_us)
{
    struct gathered_scan *begun;

    /* Counts, in each open scan of the sensor, one more scan that began after it. */
    for (size_t i = 0; i < gather->count; i++) {
        gather->scans[i].begun_since += gather->scans[i].sensor_id == heading->sensor_id;
    }
    gather->scans = must_make_room_for_one(gather->scans, gather->count, &gather->capacity,
                                           sizeof *gather->scans);
    begun = &gather->scans[gather->count++];
    *begun = *heading;
    begun->start_us = begun->time_us = time_us;
    begun->begun_us = begun->heard_us = reception_time_or_row_time_us(gather, time_us);
    begun->order = gather->order++;
    scan_numbers_drop_before(&gather->numbers, gather->scans[0].order);
    scan_numbers_set_scan(&gather->numbers, heading->sensor_id, &heading->number, begun->order);
    return begun;
}

void rows_to_scans_add_element(struct rows_to_scans *gather, struct gathered_scan *scan,
                               int64_t time_us, const void *element)
{
    scan->elements =
        must_make_room_for_one(scan->elements, scan->count, &scan->capacity, gather->element_bytes);
    scan->times_us = must_make_room_for_one(scan->times_us, scan->count, &scan->times_capacity,
                                            sizeof *scan->times_us);
    memcpy((char *)scan->elements + scan->count * gather->element_bytes, element,
           gather->element_bytes);
    scan->times_us[scan->count++] = time_us;
    note_last_heard_time(gather, scan, time_us);
}

void rows_to_scans_add_empty_row(struct rows_to_scans *gather, struct gathered_scan *scan,
                                 int64_t time_us)
{
    /* a later scan was given out already: the scan keeps the time of its first row */
    bool is_given =
        gather->has_given && !gather->has_clock && time_us - scan->bias_us < gather->given_us;

    if (scan->number.is_given && !scan->has_time && !is_given) {
        scan->has_time = true;
        scan->time_us = time_us;
    }
    note_last_heard_time(gather, scan, time_us);
}

static bool is_scan_complete(const struct rows_to_scans *gather, const struct gathered_scan *scan)
{
    int64_t since_us = gather->last_us - scan->begun_us;

    if (gather->has_clock && gather->interval_us > 0 && !scan->number.is_given) {
        /*
         * Whether a scan gathered over an interval is complete by reception times, which lag by
         * different delays: its sensor's next scan has begun, or two intervals have passed.
         */
        return scan->begun_since > 0 || since_us >= 2 * gather->interval_us;
    }
    if (scan->number.is_given && since_us <= RHO_LIMIT_OFFSET_US &&
        !(gather->begun_max && scan->begun_since >= gather->begun_max)) {
        return false;
    }
    return since_us > 0 && since_us >= gather->interval_us;
}

int64_t gathered_scan_time_us(const struct gathered_scan *scan)
{
    return scan->time_us - scan->bias_us;
}

/* Whether a row to come may begin an earlier scan, since its sensor's clock may be ahead. */
static bool may_be_preceded_by_new_scan(const struct rows_to_scans *gather,
                                        const struct gathered_scan *scan)
{
    return !gather->has_clock &&
           gather->last_us - gather->bias_max_us < gathered_scan_time_us(scan);
}

static bool goes_out_before(const struct rows_to_scans *gather, const struct gathered_scan *one,
                            const struct gathered_scan *other)
{
    return gather->has_clock ? one->begun_us < other->begun_us
                             : gathered_scan_time_us(one) < gathered_scan_time_us(other);
}

/* Index of the scan that goes out before all others. */
static size_t find_next_scan_out(const struct rows_to_scans *gather)
{
    size_t first = 0;

    for (size_t i = 1; i < gather->count; i++) {
        if (goes_out_before(gather, &gather->scans[i], &gather->scans[first])) {
            first = i;
        }
    }
    return first;
}

bool rows_to_scans_take_scan(struct rows_to_scans *gather, bool all, struct gathered_scan *scan)
{
    size_t first = find_next_scan_out(gather);

    if (gather->count == 0 ||
        (!all && (!is_scan_complete(gather, &gather->scans[first]) ||
                  may_be_preceded_by_new_scan(gather, &gather->scans[first])))) {
        return false;
    }
    *scan = gather->scans[first];
    gather->count--;
    memmove(gather->scans + first, gather->scans + first + 1,
            (gather->count - first) * sizeof *gather->scans);
    gather->has_given = true;
    gather->given_us = gathered_scan_time_us(scan);
    return true;
}

void gathered_scan_free(struct gathered_scan *scan)
{
    free(scan->elements);
    free(scan->times_us);
    scan->elements = NULL;
    scan->times_us = NULL;
}

void rows_to_scans_free(struct rows_to_scans *gather)
{
    for (size_t i = 0; i < gather->count; i++) {
        gathered_scan_free(&gather->scans[i]);
    }
    free(gather->scans);
    scan_numbers_clear(&gather->numbers);
    *gather = (struct rows_to_scans){.count = 0};
}
