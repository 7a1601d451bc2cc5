/* SPDX-License-Identifier: MIT */
#include "io/asterix/asterix_file.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/common.h"

#define CAPACITY ((size_t)4 * 65536)

struct asterix_file {
    char *path;
    FILE *file;
    bool keep_going, is_end; /* end: nothing comes behind the bytes */
    uint8_t *bytes;          /* CAPACITY of them */
    size_t size, at;
    uint64_t offset; /* of the bytes in the file */
    uint8_t category;
    size_t block_end; /* of the block under way; at: outside one */
    uint64_t records, bytes_skipped, places_skipped;
    uint64_t others[256]; /* blocks of categories that are not read */
};

/* ---- What sort of file ---- */

static bool is_wanted(uint8_t category)
{
    return category == ASTERIX_SERVICE || category == ASTERIX_PLOTS;
}

bool asterix_block_is_good(const uint8_t *data, size_t size)
{
    struct asterix_block block;
    struct asterix_record record;
    struct asterix_error error;

    if (size < ASTERIX_HEADER_BYTES || !is_wanted(data[0]) ||
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

/* Its first block. */
static bool begins_good(const char *path)
{
    uint8_t *bytes = must_alloc(ASTERIX_BLOCK_MAX);
    FILE *file = fopen(path, "rb");
    bool is_good = file && asterix_block_is_good(bytes, fread(bytes, 1, ASTERIX_BLOCK_MAX, file));

    if (file) {
        fclose(file);
    }
    free(bytes);
    return is_good;
}

bool asterix_file_is_asterix(const char *path)
{
    struct stat status;

    if (path_ends_with(path, ".ast") || path_ends_with(path, ".asterix")) {
        return true;
    }
    return !stat(path, &status) && S_ISREG(status.st_mode) && begins_good(path);
}

/* ---- Bytes ---- */

/* A whole block, if there is one, and another one behind it are in memory from the position on. */
static void fill(struct asterix_file *file)
{
    size_t got;

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

    file->path = must_copy(path);
    file->keep_going = keep_going;
    if (!stat(path, &status) && !S_ISREG(status.st_mode)) {
        fail(EXIT_USAGE,
             "%s: a recording in ASTERIX is looked at twice, so that only a plain file will do",
             path);
    }
    file->file = fopen(path, "rb");
    if (!file->file) {
        fail(EXIT_USAGE, "%s: %s", path, strerror(errno));
    }
    file->bytes = must_alloc(CAPACITY);
    fill(file);
    if (file->size == 0) {
        fail(EXIT_USAGE, "%s: byte 0: the file is empty", path);
    }
    return file;
}

/* ---- Bad places ---- */

/* Up to the next good block, or the end. */
static void find_block(struct asterix_file *file)
{
    for (;;) {
        fill(file);
        if (file->at == file->size ||
            asterix_block_is_good(file->bytes + file->at, file->size - file->at)) {
            return;
        }
        file->at++;
    }
}

/*
 * The block at the position is bad, as `error` says: the reading ends, or skips it. A block's own
 * length is believed where another good one, or the end, is behind it.
 */
static void skip_bad(struct asterix_file *file, const struct asterix_error *error)
{
    uint64_t start = file->offset + file->at;
    size_t end = file->block_end;

    if (!file->keep_going) {
        fail(EXIT_USAGE, "%s: byte %" PRIu64 ": %s", file->path, start + error->at, error->reason);
    }
    if (end > file->at &&
        (end == file->size || asterix_block_is_good(file->bytes + end, file->size - end))) {
        file->at = end;
    } else {
        file->at++;
        find_block(file);
    }
    file->block_end = file->at;
    file->places_skipped++;
    file->bytes_skipped += file->offset + file->at - start;
}

/* ---- Records ---- */

/* The next block that is read begins. Returns false at the end. */
static bool next_block(struct asterix_file *file)
{
    struct asterix_block block;
    struct asterix_error error;

    for (;;) {
        fill(file);
        file->block_end = file->at;
        if (file->at == file->size) {
            return false;
        }
        if (!asterix_block_read(file->bytes + file->at, file->size - file->at, &block, &error)) {
            skip_bad(file, &error);
        } else if (is_wanted(block.category)) {
            file->category = block.category;
            file->at += ASTERIX_HEADER_BYTES;
            file->block_end = file->at + block.size;
            return true;
        } else {
            file->others[block.category]++;
            file->at += ASTERIX_HEADER_BYTES + block.size;
        }
    }
}

bool asterix_file_next(struct asterix_file *file, struct asterix_record *record)
{
    struct asterix_error error;

    for (;;) {
        if (file->at == file->block_end && !next_block(file)) {
            return false;
        }
        if (file->at == file->block_end) {
            continue; /* a block without records */
        }
        if (asterix_record_read(file->category, file->bytes + file->at, file->block_end - file->at,
                                record, &error)) {
            file->at += record->size;
            file->records++;
            return true;
        }
        skip_bad(file, &error);
    }
}

uint64_t asterix_file_position(const struct asterix_file *file)
{
    return file->offset + file->at;
}

uint64_t asterix_file_records(const struct asterix_file *file)
{
    return file->records;
}

uint64_t asterix_file_others(const struct asterix_file *file, uint8_t category)
{
    return file->others[category];
}

struct asterix_place asterix_file_place(const char *path)
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
    while (!service.place.is_given && asterix_file_next(file, &record)) {
        if (record.category == ASTERIX_SERVICE) {
            asterix_service_read(&record, &service);
        }
    }
    asterix_file_close(file);
    return service.place;
}

/* ---- What was skipped ---- */

static void report_others(const struct asterix_file *file)
{
    const char *between = "blocks of other categories left out: ";

    for (int i = 0; i < 256; i++) {
        if (file->others[i] > 0) {
            if (*between != ',') {
                fprintf(stderr, "rhotrack: %s: ", file->path);
            }
            fprintf(stderr, "%s%" PRIu64 " of CAT%03d", between, file->others[i], i);
            between = ", ";
        }
    }
    if (*between == ',') {
        fputc('\n', stderr);
    }
}

void asterix_file_report(const struct asterix_file *file)
{
    if (file->places_skipped > 0) {
        fprintf(stderr, "rhotrack: %s: %" PRIu64 " bytes skipped at %" PRIu64 " bad places\n",
                file->path, file->bytes_skipped, file->places_skipped);
    }
    report_others(file);
}

void asterix_file_close(struct asterix_file *file)
{
    if (file) {
        fclose(file->file);
        free(file->bytes);
        free(file->path);
        free(file);
    }
}
