/* SPDX-License-Identifier: MIT */
#include "io/rows/rows_from_messages.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"

#define SCAN_SHIFT 24 /* a scan has fewer than 2^24 rows: 32767 parts of 256 */

void rows_from_messages_start(struct rows_collection *collection, const struct rows_kind *kind)
{
    *collection = (struct rows_collection){.count = 0};
    rows_init(&collection->rows, kind);
}

static const char *describe_bad_message(enum rho_status status, const struct rows_kind *kind,
                                        const char *field, char *reason)
{
    const char *name = rho_message_type_name(kind->type);

    switch (status) {
    case RHO_ERROR_SHORT:
        snprintf(reason, ROWS_FROM_MESSAGES_REASON_BYTES, "too short for a %s", name);
        break;
    case RHO_ERROR_TYPE:
        snprintf(reason, ROWS_FROM_MESSAGES_REASON_BYTES, "not a %s, or of another version", name);
        break;
    case RHO_ERROR_COUNT:
        snprintf(reason, ROWS_FROM_MESSAGES_REASON_BYTES,
                 "the length of its list is invalid for a %s", name);
        break;
    case RHO_ERROR_TRAILING:
        snprintf(reason, ROWS_FROM_MESSAGES_REASON_BYTES, "too long for a %s", name);
        break;
    default:
        snprintf(reason, ROWS_FROM_MESSAGES_REASON_BYTES, "%s is outside the range of a %s", field,
                 name);
        break;
    }
    return reason;
}

const char *rows_from_messages_add(struct rows_collection *collection, const char *channel,
                                   const uint8_t *data, size_t size,
                                   char reason[ROWS_FROM_MESSAGES_REASON_BYTES])
{
    const struct rows_kind *narrow = collection->rows.kind;
    const struct rows_kind *kind =
        narrow->wider && rows_kind_has_channel(narrow->wider, channel) ? narrow->wider : narrow;
    struct rows_message message = {.arrival = collection->count};
    size_t before = collection->rows.count;
    const char *field = "a value";
    enum rho_status status = kind->decode(data, size, &collection->rows, &message, &field);

    if (status != RHO_OK) {
        return describe_bad_message(status, kind, field, reason);
    }
    if (kind->has_sensor &&
        strtol(channel + strlen(kind->channel), NULL, 10) != message.key.sensor_id) {
        collection->rows.num_cells = collection->rows.list[before].cells;
        collection->rows.count = before;
        return "sensor_id is not that of the channel";
    }
    message.received_us = message.key.time_us;
    collection->messages =
        must_make_room_for_one(collection->messages, collection->count, &collection->capacity,
                               sizeof *collection->messages);
    collection->messages[collection->count++] = message;
    return NULL;
}

void rows_from_messages_add_event(struct rows_collection *collection, const char *path,
                                  const struct lcm_log_event *event, bool keep_going)
{
    char reason[ROWS_FROM_MESSAGES_REASON_BYTES];
    const char *why;

    if (rows_kind_of_channel(event->channel) != collection->rows.kind) {
        return;
    }
    why = rows_from_messages_add(collection, event->channel, event->data, event->size, reason);
    if (why && !keep_going) {
        fail(EXIT_USAGE, "%s: event %" PRId64 " at byte %" PRIu64 ", %s: %s", path, event->number,
             event->offset, event->channel, why);
    }
    collection->messages_bad += why != NULL;
    if (!why && collection->with_received && collection->rows.kind->has_received) {
        struct rows_message *message = &collection->messages[collection->count - 1];

        message->received_us = event->utime;
        collection->rows.has_received |= event->utime != message->key.time_us;
    }
}

/* Order by sensor, epoch, scan and time. */
static int compare_scans(const struct rows_message *one, const struct rows_message *other)
{
    int order = rows_compare_int64(one->key.sensor_id, other->key.sensor_id);

    order = order ? order : rows_compare_int64(one->key.epoch, other->key.epoch);
    order = order ? order : rows_compare_int64(one->key.scan, other->key.scan);
    return order ? order : rows_compare_int64(one->key.time_us, other->key.time_us);
}

static int by_scan_part_and_arrival(const void *a, const void *b)
{
    const struct rows_message *one = a, *other = b;
    int order = compare_scans(one, other);

    order = order ? order : rows_compare_int64(one->part, other->part);
    return order ? order : rows_compare_int64((int64_t)one->arrival, (int64_t)other->arrival);
}

/* Rows to be kept, collected in their final order. */
struct ordering {
    struct rows_collection *collection;
    struct row *list;
    size_t count;
};

static void append_row(struct ordering *ordering, size_t index, const struct rows_message *message,
                       uint64_t order)
{
    struct row *row = &ordering->list[ordering->count++];

    *row = ordering->collection->rows.list[index];
    row->received_us = message->received_us;
    row->order = order;
}

static uint64_t lowest_arrival_index(const struct rows_message *messages, size_t count)
{
    uint64_t first = messages[0].arrival;

    for (size_t i = 1; i < count; i++) {
        first = messages[i].arrival < first ? messages[i].arrival : first;
    }
    return first;
}

/*
 * Adds the row of a scan itself, which has no measurement, unless an element of the scan, added
 * from index `before` on, has the scan's time. Counts a list without elements.
 */
static void append_scan_row(struct ordering *ordering, const struct rows_message *message,
                            size_t before, uint64_t order)
{
    int64_t earliest_us = INT64_MAX;

    for (size_t i = before; i < ordering->count; i++) {
        if (ordering->list[i].time_us < earliest_us) {
            earliest_us = ordering->list[i].time_us;
        }
    }
    if (ordering->collection->rows.kind->has_sensor) {
        if (earliest_us != message->key.time_us) {
            append_row(ordering, message->first - 1, message, order);
        }
    } else if (ordering->count == before) {
        ordering->collection->lists_empty++;
    }
}

/*
 * Adds the rows of one scan, whose messages are in the order of their parts; repeated parts are
 * left out.
 */
static void append_rows_of_one_scan(struct ordering *ordering, const struct rows_message *messages,
                                    size_t count)
{
    uint64_t order = lowest_arrival_index(messages, count) << SCAN_SHIFT;
    size_t before = ordering->count, parts = 0;

    for (size_t i = 0; i < count; i++) {
        if (i > 0 && messages[i].part == messages[i - 1].part) {
            ordering->collection->messages_again++;
            continue;
        }
        parts++;
        for (size_t row = 0; row < messages[i].count; row++) {
            append_row(ordering, messages[i].first + row, &messages[i],
                       order + 1 + (ordering->count - before));
        }
    }
    ordering->collection->scans_incomplete += parts < (size_t)messages[0].num_parts;
    append_scan_row(ordering, &messages[0], before, order);
}

static int by_time(const void *a, const void *b)
{
    const struct row *one = a, *other = b;
    int order = rows_compare_int64(one->time_us, other->time_us);

    return order ? order : rows_compare_int64((int64_t)one->order, (int64_t)other->order);
}

static int by_reception(const void *a, const void *b)
{
    const struct row *one = a, *other = b;
    int order = rows_compare_int64(one->received_us, other->received_us);

    return order ? order : rows_compare_int64((int64_t)one->order, (int64_t)other->order);
}

void rows_from_messages_sort(struct rows_collection *collection)
{
    struct ordering ordering = {.collection = collection};
    size_t end;

    if (collection->count == 0) {
        return;
    }
    ordering.list = must_alloc(collection->rows.count * sizeof *ordering.list);
    qsort(collection->messages, collection->count, sizeof *collection->messages,
          by_scan_part_and_arrival);
    for (size_t first = 0; first < collection->count; first = end) {
        const struct rows_message *messages = collection->messages + first;

        end = first + 1;
        while (end < collection->count &&
               compare_scans(messages, collection->messages + end) == 0) {
            end++;
        }
        append_rows_of_one_scan(&ordering, messages, end - first);
    }
    qsort(ordering.list, ordering.count, sizeof *ordering.list,
          collection->rows.has_received ? by_reception : by_time);
    free(collection->rows.list);
    collection->rows.list = ordering.list;
    collection->rows.capacity = collection->rows.count;
    collection->rows.count = ordering.count;
}

void rows_from_messages_free(struct rows_collection *collection)
{
    rows_free(&collection->rows);
    free(collection->messages);
}
