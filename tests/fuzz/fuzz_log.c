/* SPDX-License-Identifier: MIT */
/*
 * The parser of LCM event logs on any bytes: it goes on to the end, stays inside, gives each byte
 * to an event or a skip, finds the same in a stream that comes in pieces as in one, and reads what
 * it wrote.
 */
#include <stdlib.h>
#include <string.h>

#include "io/log/lcm_log.h"

static void must(bool holds)
{
    if (!holds) {
        abort();
    }
}

static void check_event(const uint8_t *data, const struct lcm_log_event *event, size_t count)
{
    size_t channel = strlen(event->channel);

    must(channel >= 1 && channel <= LCM_LOG_MAX_CHANNEL);
    must(count == LCM_LOG_HEADER_BYTES + channel + event->size);
    must(event->data == data + count - event->size);
}

/* Written again, an event is the bytes that it was read from, but for its number. */
static void check_again(const struct lcm_log_event *event, const uint8_t *from, size_t count)
{
    char *again;
    size_t bytes;
    FILE *file = open_memstream(&again, &bytes);
    struct lcm_log_writer writer = {.file = file};

    must(file != NULL);
    must(lcm_log_write(&writer, event->utime, event->channel, event->data, event->size));
    must(fclose(file) == 0);
    must(bytes == count && memcmp(again, from, 4) == 0 &&
         memcmp(again + 12, from + 12, count - 12) == 0);
    free(again);
}

/* The first finding in memory of its exact size; of the whole, or of a beginning of it. */
static enum lcm_log_found parse(const uint8_t *data, size_t size, bool is_end, size_t *count,
                                uint64_t *size_of_event)
{
    uint8_t *copy = malloc(size + 1);
    struct lcm_log_event event;
    enum lcm_log_found found;

    must(copy != NULL);
    memcpy(copy + 1, data, size); /* not aligned */
    found = lcm_log_parse(copy + 1, size, is_end, &event, count);
    must(*count > 0 || (size == 0 && is_end));
    if (found == LCM_LOG_EVENT) {
        must(*count <= size);
        check_event(copy + 1, &event, *count);
        check_again(&event, copy + 1, *count);
        *size_of_event = event.size;
    } else if (found == LCM_LOG_SKIP) {
        must(*count <= size);
    } else {
        must(!is_end && *count > size);
    }
    free(copy);
    return found;
}

/* What a beginning of the bytes already shows is what all of them show. */
static void check_beginning(const uint8_t *data, size_t size, size_t part)
{
    size_t count = 0, whole = 0;
    uint64_t bytes = 0, bytes_of_whole = 0;
    enum lcm_log_found found = parse(data, part, false, &count, &bytes);

    if (found == LCM_LOG_EVENT) {
        must(parse(data, size, true, &whole, &bytes_of_whole) == LCM_LOG_EVENT);
        must(count == whole && bytes == bytes_of_whole);
    } else if (found == LCM_LOG_SKIP) {
        must(parse(data, size, true, &whole, &bytes_of_whole) == LCM_LOG_SKIP);
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
    check_beginning(data, size, part);
    while (at < size) {
        must(parse(data + at, size - at, true, &count, &bytes) != LCM_LOG_MORE);
        at += count;
    }
    must(at == size);
    return 0;
}
