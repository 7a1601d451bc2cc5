/* SPDX-License-Identifier: MIT */
#include "io/asterix/asterix_file.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/common.h"
#include "io/asterix/captured_datagrams.h"

#define CAPACITY ((size_t)4 * 65536)

struct asterix_file {
    char *path;
    FILE *file;                          /* a file of data blocks, or NULL */
    struct captured_datagrams *captured; /* a network recording, or NULL */
    bool wants_tracks;                   /* records of tracks are read, not those of radars */
    bool keep_going, is_end;             /* is_end: no bytes of the file follow the buffer */
    /* buffer of CAPACITY bytes; of a network recording, one datagram */
    uint8_t *bytes;
    size_t size, at;
    uint64_t offset;  /* offset of the buffer in the file, or in all datagrams' contents */
    uint64_t foreign; /* datagrams that do not consist of data blocks */
    uint8_t category;
    struct asterix_block_source source; /* of the current block */
    bool is_block_begun;                /* a record of it was read */
    size_t block_end; /* end of the current block in the buffer; equal to `at` between blocks */
    uint64_t records, bytes_skipped, places_skipped;
    /* blocks of categories that are not read, and their records where these are decodable */
    uint64_t others[256], other_records[256];
};

static bool is_wanted_category(const struct asterix_file *file, uint8_t category)
{
    return file->wants_tracks
               ? category == ASTERIX_TRACKS
               : asterix_category_is_plots(category) || asterix_category_is_service(category);
}

/* Whether the bytes begin with a data block of a known category whose records can all be read. */
static bool is_block_good(const uint8_t *data, size_t size)
{
    struct asterix_block block;
    struct asterix_record record;
    struct asterix_error error;

    if (size < ASTERIX_HEADER_BYTES || !asterix_category_is_known(data[0]) ||
        !asterix_block_read(data, size, &block, &error) || block.size == 0) {
        return false;
    }
    for (size_t at = 0; at < block.size; at += record.size) {
        if (!asterix_record_read(block.category, block.records + at, block.size - at, &record,
                                 &error)) {
            return false;
        }
    }
    return true;
}

/* Whether the file begins with a block whose records can all be read. */
static bool begins_with_good_block(const char *path)
{
    uint8_t *bytes = must_alloc(ASTERIX_BLOCK_MAX);
    FILE *file = fopen(path, "rb");
    bool is_good = file && is_block_good(bytes, fread(bytes, 1, ASTERIX_BLOCK_MAX, file));

    if (file) {
        fclose(file);
    }
    free(bytes);
    return is_good;
}

bool asterix_file_is_asterix(const char *path)
{
    struct stat status;

    if (path_ends_with(path, ".ast") || path_ends_with(path, ".asterix") ||
        captured_datagrams_is_capture(path)) {
        return true;
    }
    return !stat(path, &status) && S_ISREG(status.st_mode) && begins_with_good_block(path);
}

/* Whether the bytes consist of whole data blocks of any category. */
static bool consists_of_blocks(const uint8_t *data, size_t size)
{
    struct asterix_block block;
    struct asterix_error error;

    while (size > 0) {
        if (!asterix_block_read(data, size, &block, &error)) {
            return false;
        }
        data += ASTERIX_HEADER_BYTES + block.size;
        size -= ASTERIX_HEADER_BYTES + block.size;
    }
    return true;
}

/* Once the current datagram is read, fetches the next one that consists of data blocks. */
static void fill_from_next_datagram(struct asterix_file *file)
{
    const uint8_t *data;
    size_t size;

    if (file->at < file->size) {
        return;
    }
    file->offset += file->size;
    file->size = file->at = 0;
    while (file->size == 0 &&
           captured_datagrams_next(file->captured, file->keep_going, &data, &size)) {
        if (consists_of_blocks(data, size)) {
            memcpy(file->bytes, data, size);
            file->size = size;
        } else {
            file->foreign++;
        }
    }
    file->is_end = file->size == 0;
}

/* Refills the buffer so that it holds two longest blocks from the position on, if the file does. */
static void fill_buffer(struct asterix_file *file)
{
    size_t got;

    if (file->captured) {
        fill_from_next_datagram(file);
        return;
    }
    if (file->is_end || file->size - file->at >= 2 * (size_t)ASTERIX_BLOCK_MAX) {
        return;
    }
    memmove(file->bytes, file->bytes + file->at, file->size - file->at);
    file->offset += file->at;
    file->size -= file->at;
    file->at = 0;
    got = fread(file->bytes + file->size, 1, CAPACITY - file->size, file->file);
    if (ferror(file->file)) {
        fail(EXIT_USAGE, "%s: %s", file->path, strerror(errno));
    }
    file->is_end = got < CAPACITY - file->size;
    file->size += got;
}

struct asterix_file *asterix_file_open(const char *path, bool keep_going)
{
    struct asterix_file *file = must_calloc(1, sizeof *file);
    struct stat status;

    file->path = must_copy_text(path);
    file->keep_going = keep_going;
    if (!stat(path, &status) && !S_ISREG(status.st_mode)) {
        fail(EXIT_USAGE, "%s: an ASTERIX recording is read twice and must be a regular file", path);
    }
    file->bytes = must_alloc(CAPACITY);
    if (captured_datagrams_is_capture(path)) {
        file->captured = captured_datagrams_open(path);
        return file;
    }
    file->file = fopen(path, "rb");
    if (!file->file) {
        fail(EXIT_USAGE, "%s: %s", path, strerror(errno));
    }
    fill_buffer(file);
    if (file->size == 0) {
        fail(EXIT_USAGE, "%s: byte 0: the file is empty", path);
    }
    return file;
}

struct asterix_file *asterix_file_open_tracks(const char *path, bool keep_going)
{
    struct asterix_file *file = asterix_file_open(path, keep_going);

    file->wants_tracks = true;
    return file;
}

/* Advances to the next readable block, or to the end. */
static void advance_to_good_block(struct asterix_file *file)
{
    for (;;) {
        fill_buffer(file);
        if (file->at == file->size ||
            is_block_good(file->bytes + file->at, file->size - file->at)) {
            return;
        }
        file->at++;
    }
}

static _Noreturn void fail_at_bad_byte(const struct asterix_file *file,
                                       const struct asterix_error *error)
{
    if (file->captured) {
        fail(EXIT_USAGE, "%s: packet %" PRIu64 ", byte %zu of its content: %s", file->path,
             captured_datagrams_packet(file->captured), file->at + error->at, error->reason);
    }
    fail(EXIT_USAGE, "%s: byte %" PRIu64 ": %s", file->path, file->offset + file->at + error->at,
         error->reason);
}

/*
 * Handles a bad block at the position, as `error` describes: exit 2, or with keep_going skips it.
 * The block's own length is trusted where it leads to another readable block, or to the end.
 */
static void fail_or_skip_bad_block(struct asterix_file *file, const struct asterix_error *error)
{
    uint64_t start = file->offset + file->at;
    size_t end = file->block_end;

    if (!file->keep_going) {
        fail_at_bad_byte(file, error);
    }
    if (end > file->at &&
        (end == file->size || is_block_good(file->bytes + end, file->size - end))) {
        file->at = end;
    } else {
        file->at++;
        advance_to_good_block(file);
    }
    file->block_end = file->at;
    file->places_skipped++;
    file->bytes_skipped += file->offset + file->at - start;
}

/* Number of a skipped block's records, up to the first bad one. */
static uint64_t count_block_records(const struct asterix_block *block)
{
    struct asterix_record record;
    struct asterix_error error;
    uint64_t count = 0;

    for (size_t at = 0;
         at < block->size && asterix_record_read(block->category, block->records + at,
                                                 block->size - at, &record, &error);
         at += record.size) {
        count++;
    }
    return count;
}

/*
 * Advances to the first record of the next block of a category that is read; other blocks are
 * counted and skipped. Returns false at the end.
 */
static bool enter_next_wanted_block(struct asterix_file *file)
{
    struct asterix_block block;
    struct asterix_error error;

    for (;;) {
        fill_buffer(file);
        file->block_end = file->at;
        if (file->at == file->size) {
            return false;
        }
        if (!asterix_block_read(file->bytes + file->at, file->size - file->at, &block, &error)) {
            fail_or_skip_bad_block(file, &error);
        } else if (is_wanted_category(file, block.category)) {
            file->category = block.category;
            file->at += ASTERIX_HEADER_BYTES;
            file->block_end = file->at + block.size;
            file->is_block_begun = false;
            return true;
        } else {
            file->others[block.category]++;
            file->other_records[block.category] += count_block_records(&block);
            file->at += ASTERIX_HEADER_BYTES + block.size;
        }
    }
}

bool asterix_file_next_record(struct asterix_file *file, struct asterix_record *record)
{
    struct asterix_error error;

    for (;;) {
        if (file->at == file->block_end && !enter_next_wanted_block(file)) {
            return false;
        }
        if (file->at == file->block_end) {
            continue; /* the block has no records */
        }
        if (asterix_record_read(file->category, file->bytes + file->at, file->block_end - file->at,
                                record, &error)) {
            asterix_record_complete_source(record, !file->is_block_begun, &file->source);
            file->is_block_begun = true;
            file->at += record->size;
            file->records++;
            return true;
        }
        fail_or_skip_bad_block(file, &error);
    }
}

uint64_t asterix_file_position(const struct asterix_file *file)
{
    return file->offset + file->at;
}

uint64_t asterix_file_skipped_blocks(const struct asterix_file *file, uint8_t category)
{
    return file->others[category];
}

struct asterix_place asterix_file_radar_place(const char *path)
{
    struct asterix_service service = {.has_type = false};
    struct asterix_record record;
    struct asterix_file *file;
    struct stat status;

    if (stat(path, &status) || !S_ISREG(status.st_mode) || status.st_size == 0 ||
        !asterix_file_is_asterix(path)) {
        return service.place;
    }
    file = asterix_file_open(path, true);
    while (!service.place.is_given && asterix_file_next_record(file, &record)) {
        if (asterix_category_is_service(record.category)) {
            asterix_service_read(&record, &service);
        }
    }
    asterix_file_close(file);
    return service.place;
}

/* Reports the left-out blocks on standard error, one line a category. */
static void report_skipped_categories(const struct asterix_file *file)
{
    for (int i = 0; i < 256; i++) {
        if (file->others[i] == 0) {
            continue;
        }
        fprintf(stderr, "rhotrack: %s: CAT%03d left out: ", file->path, i);
        if (file->other_records[i] > 0) {
            fprintf(stderr, "%" PRIu64 " records in ", file->other_records[i]);
        }
        fprintf(stderr, "%" PRIu64 " blocks%s\n", file->others[i],
                i == ASTERIX_TRACKS ? "; these are tracks" : "");
    }
}

void asterix_file_report_skipped(const struct asterix_file *file)
{
    if (file->places_skipped > 0) {
        fprintf(stderr, "rhotrack: %s: %" PRIu64 " bytes skipped at %" PRIu64 " bad places\n",
                file->path, file->bytes_skipped, file->places_skipped);
    }
    report_skipped_categories(file);
    if (file->foreign > 0) {
        fprintf(stderr, "rhotrack: %s: %" PRIu64 " datagrams that are not ASTERIX left out\n",
                file->path, file->foreign);
    }
    if (file->captured && captured_datagrams_why_cut(file->captured)) {
        fprintf(stderr, "rhotrack: %s: after packet %" PRIu64 ": %s; the rest is left out\n",
                file->path, captured_datagrams_packet(file->captured),
                captured_datagrams_why_cut(file->captured));
    }
    if (file->captured && captured_datagrams_incomplete(file->captured) > 0) {
        fprintf(stderr, "rhotrack: %s: %" PRIu64 " datagrams left out: fragments, or truncated\n",
                file->path, captured_datagrams_incomplete(file->captured));
    }
}

void asterix_file_close(struct asterix_file *file)
{
    if (file) {
        if (file->file) {
            fclose(file->file);
        }
        captured_datagrams_close(file->captured);
        free(file->bytes);
        free(file->path);
        free(file);
    }
}
