/* SPDX-License-Identifier: MIT */
#include "pipeline/pipeline_snapshot.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/common.h"
#include "rhotrack/snapshot.h"

/* size of a write */
#define PIECE_BYTES 65536

/* ---- Save ---- */

static bool write_all_bytes(int file, const uint8_t *bytes, size_t size)
{
    while (size > 0) {
        ssize_t written = write(file, bytes, size);

        if (written < 0 && errno != EINTR) {
            return false;
        }
        bytes += written > 0 ? written : 0;
        size -= written > 0 ? (size_t)written : 0;
    }
    return true;
}

static bool write_snapshot_to_disk(int file, const struct rho_snapshot_part *parts,
                                   unsigned num_parts)
{
    uint8_t piece[PIECE_BYTES];
    size_t at = 0, length = 0;

    do {
        if (rho_snapshot_save(parts, num_parts, at, piece, sizeof piece, &length) != RHO_OK) {
            errno = EINVAL;
            return false;
        }
        if (!write_all_bytes(file, piece, length)) {
            return false;
        }
        at += length;
    } while (length > 0);
    return fsync(file) == 0;
}

bool pipeline_save_snapshot(struct pipeline *pipeline, const char *path)
{
    struct rho_snapshot_part *parts = must_calloc(RHO_NODE_PARTS, sizeof *parts);
    const unsigned num_parts = rho_node_list_parts(pipeline->node, parts);
    size_t room = strlen(path) + sizeof ".part";
    char *beside = must_alloc(room);
    bool is_saved = false;
    int file, reason;

    snprintf(beside, room, "%s.part", path);
    file = open(beside, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file >= 0) {
        is_saved = write_snapshot_to_disk(file, parts, num_parts);
        reason = errno;
        is_saved = close(file) == 0 && is_saved && rename(beside, path) == 0;
        if (!is_saved) {
            reason = reason ? reason : errno;
            unlink(beside);
            errno = reason;
        }
    }
    free(beside);
    free(parts);
    return is_saved;
}

/* ---- Restore ---- */

/* Reads a file into new memory; NULL where it is missing. Exit 1 where it cannot be read. */
static uint8_t *read_file_if_present(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    uint8_t *bytes = NULL;
    size_t room = 0, got = 1;

    *size = 0;
    if (!file && errno == ENOENT) {
        return NULL;
    }
    if (!file) {
        fail(EXIT_RUNTIME, "%s: %s", path, strerror(errno));
    }
    while (got > 0) {
        if (*size == room) {
            room = room ? 2 * room : 1 << 20;
            bytes = must_realloc(bytes, room);
        }
        got = fread(bytes + *size, 1, room - *size, file);
        *size += got;
    }
    if (ferror(file)) {
        fail(EXIT_RUNTIME, "%s: %s", path, strerror(errno));
    }
    fclose(file);
    return bytes;
}

static enum pipeline_restored refuse_snapshot(const char *path, const char *why)
{
    fprintf(stderr, "rhotrack: %s: %s; tracks begin anew\n", path, why);
    return PIPELINE_REFUSED;
}

static const char *snapshot_refusal_reason(enum rho_status status)
{
    switch ((int)status) {
    case RHO_ERROR_TYPE:
        return "a snapshot of another version";
    case RHO_ERROR_SIZE:
        return "a snapshot of another build";
    case RHO_ERROR_CONFIG:
    case RHO_ERROR_CAPACITY:
        return "a snapshot with other parameters";
    default:
        return "the snapshot is damaged";
    }
}

/* A node with the parameters as they were told and then changed, and room for the windows. */
static struct pipeline open_fresh_pipeline(const struct pipeline *pipeline,
                                           const struct parameters *parameters,
                                           const struct parameters *changed, unsigned num_windows)
{
    struct pipeline fresh = pipeline_allocate();

    fresh.is_live = pipeline->is_live;
    fresh.epoch = pipeline->epoch;
    fresh.takes_commands = pipeline->takes_commands;
    pipeline_open(&fresh, parameters);
    pipeline_open_passive(&fresh, parameters);
    pipeline_reconfigure(&fresh, changed);
    pipeline_add_storage(&fresh, num_windows);
    return fresh;
}

/* Number of windows in a snapshot that are not in the node itself. */
static unsigned num_windows_in_storage(const uint8_t *image, size_t size)
{
    struct rho_snapshot_part *parts = must_calloc(RHO_NODE_PARTS, sizeof *parts);
    unsigned num_parts = 0, num_windows = 0;

    (void)!rho_snapshot_list(image, size, parts, RHO_NODE_PARTS, &num_parts);
    for (unsigned i = 0; i < num_parts && i < RHO_NODE_PARTS; i++) {
        num_windows += parts[i].kind == RHO_SNAPSHOT_INITIATOR;
    }
    free(parts);
    return num_windows > 0 ? num_windows - 1 : 0;
}

static enum pipeline_restored replace_pipeline_by_snapshot(struct pipeline *pipeline,
                                                           struct parameters *parameters,
                                                           const char *path, const uint8_t *image,
                                                           size_t size)
{
    struct parameters changed = *parameters;
    struct rho_settings saved;
    enum rho_status status = rho_node_saved_settings(image, size, &saved);
    struct pipeline fresh;

    if (status == RHO_OK && !parameters_adopt_settings(&changed, &saved)) {
        status = RHO_ERROR_CONFIG;
    }
    if (status != RHO_OK) {
        return refuse_snapshot(path, snapshot_refusal_reason(status));
    }
    fresh =
        open_fresh_pipeline(pipeline, parameters, &changed, num_windows_in_storage(image, size));
    fresh.node->settings = saved; /* parameters may have less digits */
    status = rho_node_load(fresh.node, image, size);
    if (status != RHO_OK) {
        pipeline_free(&fresh);
        return refuse_snapshot(path, snapshot_refusal_reason(status));
    }
    pipeline_free(pipeline);
    *pipeline = fresh;
    *parameters = changed;
    return PIPELINE_RESTORED;
}

enum pipeline_restored pipeline_restore_snapshot(struct pipeline *pipeline,
                                                 struct parameters *parameters, const char *path)
{
    static const char magic[] = "rhosnap\n";
    enum pipeline_restored restored = PIPELINE_NO_FILE;
    size_t size;
    uint8_t *image = read_file_if_present(path, &size);

    if (size > 0 && (size < 8 || memcmp(image, magic, 8) != 0)) {
        fail(EXIT_USAGE, "%s: not a snapshot, and would be overwritten", path);
    }
    if (size > 0) {
        restored = replace_pipeline_by_snapshot(pipeline, parameters, path, image, size);
    }
    free(image);
    return restored;
}
