/* SPDX-License-Identifier: MIT */
#include "io/log/lcm_log.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/big_endian.h"
#include "base/common.h"

enum {
    SYNC_BYTES = 4,
    HEADER_MAX_BYTES = LCM_LOG_HEADER_BYTES + LCM_LOG_MAX_CHANNEL,
    PLACES_SHOWN = 3,
    FIRST_CAPACITY = 1 << 16
};

static const uint8_t sync_word[SYNC_BYTES] = {0xED, 0xA1, 0xDA, 0x01};

static int64_t load_int64(const uint8_t *data)
{
    uint64_t value = load_big_endian(data, 8);

    return value <= INT64_MAX ? (int64_t)value : -(int64_t)~value - 1;
}

/* Whether the bytes begin with a sync word, or with its beginning where fewer than 4 are there. */
static bool may_begin_sync_word(const uint8_t *data, size_t size)
{
    return memcmp(data, sync_word, size < SYNC_BYTES ? size : SYNC_BYTES) == 0;
}

/*
 * Length of the event that the bytes begin with, or the header's length while the header is cut
 * off; 0 where the header, or the part of the channel that is there, is not that of an event.
 */
static size_t event_length_from_header(const uint8_t *data, size_t size)
{
    uint64_t channel, content;
    size_t there;

    if (!may_begin_sync_word(data, size)) {
        return 0;
    }
    if (size < LCM_LOG_HEADER_BYTES) {
        return LCM_LOG_HEADER_BYTES;
    }
    /* a negative length reads as a very large one, and is refused below */
    channel = load_big_endian(data + 20, 4);
    content = load_big_endian(data + 24, 4);
    if (channel < 1 || channel > LCM_LOG_MAX_CHANNEL || content > LCM_LOG_MAX_DATA) {
        return 0;
    }
    there = size - LCM_LOG_HEADER_BYTES < channel ? size - LCM_LOG_HEADER_BYTES : (size_t)channel;
    if (memchr(data + LCM_LOG_HEADER_BYTES, '\0', there)) {
        return 0;
    }
    return LCM_LOG_HEADER_BYTES + (size_t)channel + (size_t)content;
}

/*
 * Offset from which the bytes are a sync word, or the beginning of one at the end of the buffer;
 * size where there is none.
 */
static size_t find_sync_word(const uint8_t *data, size_t from, size_t size)
{
    while (from < size) {
        const uint8_t *first = memchr(data + from, sync_word[0], size - from);

        if (!first) {
            return size;
        }
        from = (size_t)(first - data);
        if (may_begin_sync_word(first, size - from)) {
            return from;
        }
        from++;
    }
    return size;
}

/*
 * Offset of a whole header with its channel name that begins inside an event of `bytes` bytes;
 * bytes where there is none.
 */
static size_t find_header_inside_event(const uint8_t *data, size_t bytes, size_t size)
{
    size_t at = find_sync_word(data, 1, size);

    while (at < bytes) {
        size_t left = size - at;

        if (left > LCM_LOG_HEADER_BYTES && event_length_from_header(data + at, left) > 0 &&
            left - LCM_LOG_HEADER_BYTES >= load_big_endian(data + at + 20, 4)) {
            return at;
        }
        at = find_sync_word(data, at + 1, size);
    }
    return bytes;
}

static enum lcm_log_found found_bytes_to_skip(size_t bytes, size_t *count)
{
    *count = bytes;
    return LCM_LOG_SKIP;
}

static enum lcm_log_found found_too_few_bytes(size_t bytes, size_t *count)
{
    *count = bytes;
    return LCM_LOG_MORE;
}

enum lcm_log_found lcm_log_parse(const uint8_t *data, size_t size, bool is_end,
                                 struct lcm_log_event *event, size_t *count)
{
    size_t bytes = event_length_from_header(data, size), inside;

    if (bytes == 0) {
        return found_bytes_to_skip(find_sync_word(data, size > 0, size), count);
    }
    if (size < bytes && is_end) {
        return found_bytes_to_skip(find_sync_word(data, 1, size), count);
    }
    if (size < bytes + SYNC_BYTES && !is_end) {
        return found_too_few_bytes(bytes + SYNC_BYTES, count);
    }
    if (size > bytes && !may_begin_sync_word(data + bytes, size - bytes)) {
        if (size < bytes + HEADER_MAX_BYTES && !is_end) {
            return found_too_few_bytes(bytes + HEADER_MAX_BYTES, count);
        }
        inside = find_header_inside_event(data, bytes, size);
        if (inside < bytes) {
            return found_bytes_to_skip(inside, count);
        }
    }
    size_t channel = (size_t)load_big_endian(data + 20, 4);

    event->number = load_int64(data + 4);
    event->utime = load_int64(data + 12);
    memcpy(event->channel, data + LCM_LOG_HEADER_BYTES, channel);
    event->channel[channel] = '\0';
    event->data = data + LCM_LOG_HEADER_BYTES + channel;
    event->size = bytes - LCM_LOG_HEADER_BYTES - channel;
    *count = bytes;
    return LCM_LOG_EVENT;
}

struct skipped_place {
    uint64_t offset, bytes;
};

struct lcm_log_reader {
    char *path;
    int file;
    uint8_t *buffer;
    size_t capacity, first, end; /* unparsed bytes are buffer[first .. end) */
    uint64_t offset;             /* offset in the file of buffer[first] */
    bool is_end;                 /* the end of the file has been read */
    struct lcm_log_counts counts;
    /* skipped places: the first few, for the report, and the newest */
    struct skipped_place shown[PLACES_SHOWN], last;
    bool last_has_sync;
};

bool lcm_log_is_log(const char *path)
{
    uint8_t start[SYNC_BYTES];
    struct stat status;
    bool is_log;
    FILE *file;

    if (path_ends_with(path, ".lcm")) {
        return true;
    }
    if (stat(path, &status) || !S_ISREG(status.st_mode) || !(file = fopen(path, "rb"))) {
        return false; /* a pipe could not be read again from its beginning */
    }
    is_log =
        fread(start, 1, SYNC_BYTES, file) == SYNC_BYTES && may_begin_sync_word(start, SYNC_BYTES);
    fclose(file);
    return is_log;
}

static _Noreturn void fail_to_read(const char *path)
{
    fail(EXIT_USAGE, "%s: %s", path, strerror(errno));
}

struct lcm_log_reader *lcm_log_open(const char *path)
{
    struct lcm_log_reader *reader = must_calloc(1, sizeof *reader);

    reader->file = open(path, O_RDONLY | O_CLOEXEC);
    if (reader->file < 0) {
        fail_to_read(path);
    }
    reader->path = must_copy_text(path);
    reader->capacity = FIRST_CAPACITY;
    reader->buffer = must_alloc(reader->capacity);
    return reader;
}

/*
 * Makes room behind the buffer's unparsed bytes: by moving them to the front where they fill at
 * most half of the buffer, else by doubling the buffer.
 */
static void make_buffer_room(struct lcm_log_reader *reader)
{
    size_t there = reader->end - reader->first;

    if (reader->end < reader->capacity) {
        return;
    }
    if (there <= reader->capacity / 2) {
        memmove(reader->buffer, reader->buffer + reader->first, there);
        reader->first = 0;
        reader->end = there;
        return;
    }
    reader->capacity *= 2;
    reader->buffer = must_realloc(reader->buffer, reader->capacity);
}

/*
 * Reads until `bytes` unparsed bytes are buffered, or the file ends: memory grows with real bytes.
 */
static void read_until_buffered(struct lcm_log_reader *reader, size_t bytes)
{
    while (!reader->is_end && reader->end - reader->first < bytes) {
        ssize_t got;

        make_buffer_room(reader);
        do {
            got = read(reader->file, reader->buffer + reader->end, reader->capacity - reader->end);
        } while (got < 0 && errno == EINTR);
        if (got < 0) {
            fail_to_read(reader->path);
        }
        reader->end += (size_t)got;
        reader->is_end = got == 0;
    }
}

static void record_skipped_bytes_and_place(struct lcm_log_reader *reader, const uint8_t *data,
                                           size_t bytes)
{
    struct lcm_log_counts *counts = &reader->counts;
    struct skipped_place *last = &reader->last;

    if (last->bytes == 0 || last->offset + last->bytes != reader->offset) {
        counts->places_skipped++;
        *last = (struct skipped_place){reader->offset, 0};
    }
    reader->last_has_sync =
        /* the skipped bytes begin with a whole sync word: a skip never ends inside of one */
        may_begin_sync_word(data, bytes);
    last->bytes += bytes;
    counts->bytes_skipped += bytes;
    if (counts->places_skipped <= PLACES_SHOWN) {
        reader->shown[counts->places_skipped - 1] = *last;
    }
}

static void advance_reader(struct lcm_log_reader *reader, size_t bytes)
{
    reader->first += bytes;
    reader->offset += bytes;
}

bool lcm_log_next(struct lcm_log_reader *reader, struct lcm_log_event *event)
{
    size_t wanted = LCM_LOG_HEADER_BYTES;

    for (;;) {
        const uint8_t *data;
        enum lcm_log_found found;

        read_until_buffered(reader, wanted);
        data = reader->buffer + reader->first;
        if (reader->first == reader->end) {
            return false;
        }
        found = lcm_log_parse(data, reader->end - reader->first, reader->is_end, event, &wanted);
        if (found == LCM_LOG_EVENT) {
            event->offset = reader->offset;
            reader->counts.events++;
            advance_reader(reader, wanted);
            return true;
        }
        if (found == LCM_LOG_SKIP) {
            record_skipped_bytes_and_place(reader, data, wanted);
            advance_reader(reader, wanted);
            wanted = LCM_LOG_HEADER_BYTES;
        }
    }
}

struct lcm_log_counts lcm_log_counts(const struct lcm_log_reader *reader)
{
    return reader->counts;
}

uint64_t lcm_log_position(const struct lcm_log_reader *reader)
{
    return reader->offset;
}

/* Whether the file ends within an event: the last skipped bytes begin with a sync word. */
static bool is_last_event_cut_off(const struct lcm_log_reader *reader)
{
    return reader->is_end && reader->first == reader->end && reader->last_has_sync &&
           reader->last.offset + reader->last.bytes == reader->offset;
}

void lcm_log_report_skipped(const struct lcm_log_reader *reader)
{
    uint64_t places = reader->counts.places_skipped;

    for (uint64_t i = 0; i < places && i < PLACES_SHOWN; i++) {
        fprintf(stderr, "rhotrack: %s: %" PRIu64 " bytes skipped at byte %" PRIu64 "\n",
                reader->path, reader->shown[i].bytes, reader->shown[i].offset);
    }
    if (places > PLACES_SHOWN) {
        fprintf(stderr, "rhotrack: %s: %" PRIu64 " bytes skipped in %" PRIu64 " places in all\n",
                reader->path, reader->counts.bytes_skipped, places);
    }
    if (is_last_event_cut_off(reader)) {
        fprintf(stderr, "rhotrack: %s: the last event is cut off\n", reader->path);
    }
}

void lcm_log_close(struct lcm_log_reader *reader)
{
    if (!reader) {
        return;
    }
    close(reader->file);
    free(reader->path);
    free(reader->buffer);
    free(reader);
}

void lcm_log_put_header(uint8_t header[LCM_LOG_HEADER_BYTES], int64_t number, int64_t utime,
                        size_t channel_bytes, size_t data_bytes)
{
    memcpy(header, sync_word, SYNC_BYTES);
    store_big_endian(header + 4, (uint64_t)number, 8);
    store_big_endian(header + 12, (uint64_t)utime, 8);
    store_big_endian(header + LCM_LOG_CHANNEL_AT, channel_bytes, 4);
    store_big_endian(header + LCM_LOG_DATA_AT, data_bytes, 4);
}

uint64_t lcm_log_event_bytes(uint64_t channel_bytes, uint64_t data_bytes)
{
    return LCM_LOG_HEADER_BYTES + channel_bytes + data_bytes;
}

bool lcm_log_write(struct lcm_log_writer *writer, int64_t utime, const char *channel,
                   const uint8_t *data, size_t size)
{
    uint8_t header[LCM_LOG_HEADER_BYTES];
    size_t length = strlen(channel);

    if (length < 1 || length > LCM_LOG_MAX_CHANNEL || size > LCM_LOG_MAX_DATA) {
        errno = EINVAL;
        return false;
    }
    lcm_log_put_header(header, writer->number, utime, length, size);
    if (fwrite(header, sizeof header, 1, writer->file) != 1 ||
        fwrite(channel, length, 1, writer->file) != 1 ||
        (size > 0 && fwrite(data, size, 1, writer->file) != 1)) {
        return false;
    }
    writer->number = writer->number < INT64_MAX ? writer->number + 1 : 0;
    return true;
}

void lcm_log_must_write(struct lcm_log_writer *writer, const char *path, int64_t utime,
                        const char *channel, const uint8_t *data, size_t size)
{
    if (!lcm_log_write(writer, utime, channel, data, size)) {
        fail(EXIT_RUNTIME, "%s: cannot be written: %s", path, strerror(errno));
    }
}
