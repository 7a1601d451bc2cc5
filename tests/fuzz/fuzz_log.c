/* SPDX-License-Identifier: MIT */
/*
 * The parser of LCM event logs on any bytes: it reaches the end, reads only inside, gives each byte
 * to an event or a skip, finds the same in a stream of pieces as in the whole, and reads back what
 * the writer wrote.
 */
#include <stdlib.h>
#include <string.h>

#include "io/log/lcm_log.h"

static void abort_unless(bool holds)
{
    if (!holds) {
        abort();
    }
}

static void check_event(const uint8_t *data, const struct lcm_log_event *event, size_t count)
{
    size_t channel = strlen(event->channel);

    abort_unless(channel >= 1 && channel <= LCM_LOG_MAX_CHANNEL);
    abort_unless(count == LCM_LOG_HEADER_BYTES + channel + event->size);
    abort_unless(event->data == data + count - event->size);
}

/* Written again, an event has the bytes that it was read from, but for its number. */
static void check_event_written_again(const struct lcm_log_event *event, const uint8_t *from,
                                      size_t count)
{
    char *again;
    size_t bytes;
    FILE *file = open_memstream(&again, &bytes);
    struct lcm_log_writer writer = {.file = file};

    abort_unless(file != NULL);
    abort_unless(lcm_log_write(&writer, event->utime, event->channel, event->data, event->size));
    abort_unless(fclose(file) == 0);
    abort_unless(bytes == count && memcmp(again, from, 4) == 0 &&
                 memcmp(again + 12, from + 12, count - 12) == 0);
    free(again);
}

/* Parses the bytes, or a beginning of them, from memory of exactly their size. */
static enum lcm_log_found parse_exact_copy(const uint8_t *data, size_t size, bool is_end,
                                           size_t *count, uint64_t *size_of_event)
{
    uint8_t *copy = malloc(size + 1);
    struct lcm_log_event event;
    enum lcm_log_found found;

    abort_unless(copy != NULL);
    memcpy(copy + 1, data, size); /* + 1: not aligned */
    found = lcm_log_parse(copy + 1, size, is_end, &event, count);
    abort_unless(*count > 0 || (size == 0 && is_end));
    if (found == LCM_LOG_EVENT) {
        abort_unless(*count <= size);
        check_event(copy + 1, &event, *count);
        check_event_written_again(&event, copy + 1, *count);
        *size_of_event = event.size;
    } else if (found == LCM_LOG_SKIP) {
        abort_unless(*count <= size);
    } else {
        abort_unless(!is_end && *count > size);
    }
    free(copy);
    return found;
}

/* An event found in a beginning of the bytes is found in all of them. */
static void check_parse_of_beginning(const uint8_t *data, size_t size, size_t part)
{
    size_t count = 0, whole = 0;
    uint64_t bytes = 0, bytes_of_whole = 0;
    enum lcm_log_found found = parse_exact_copy(data, part, false, &count, &bytes);

    if (found == LCM_LOG_EVENT) {
        abort_unless(parse_exact_copy(data, size, true, &whole, &bytes_of_whole) == LCM_LOG_EVENT);
        abort_unless(count == whole && bytes == bytes_of_whole);
    } else if (found == LCM_LOG_SKIP) {
        abort_unless(parse_exact_copy(data, size, true, &whole, &bytes_of_whole) == LCM_LOG_SKIP);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    size_t at = 0, count = 0, part;
    uint64_t bytes = 0;

    if (size == 0) {
        return 0;
    }
    part = data[size - 1] % size;
    check_parse_of_beginning(data, size, part);
    while (at < size) {
        abort_unless(parse_exact_copy(data + at, size - at, true, &count, &bytes) != LCM_LOG_MORE);
        at += count;
    }
    abort_unless(at == size);
    return 0;
}
