/* SPDX-License-Identifier: MIT */
#include "pipeline/pipeline_snapshot.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/common.h"
#include "base/state_file.h"
#include "rhotrack/snapshot.h"

/* size of a write */
#define PIECE_BYTES 65536

/* A text that is at least so long is no snapshot that a disk has damaged, but another file. */
#define TEXT_BYTES 64

/* ---- Save ---- */

static bool is_zeros(const uint8_t *bytes, size_t length)
{
    return length > 0 && bytes[0] == 0 && memcmp(bytes, bytes + 1, length - 1) == 0;
}

/*
 * Windows are mostly empty: what is zeros becomes a hole of the file, which costs the disk neither
 * time nor room.
 */
static bool write_snapshot(FILE *file, const void *context)
{
    struct pipeline *pipeline = *(struct pipeline *const *)context;
    struct rho_snapshot_part *parts = must_calloc(RHO_NODE_PARTS, sizeof *parts);
    const unsigned num_parts = rho_node_list_parts(pipeline->node, parts);
    uint8_t piece[PIECE_BYTES];
    size_t at = 0, length = 0;
    bool is_good;

    do {
        errno = EINVAL; /* where the library refuses the objects */
        is_good = rho_snapshot_save(parts, num_parts, at, piece, sizeof piece, &length) == RHO_OK &&
                  (is_zeros(piece, length) ? fseeko(file, (off_t)length, SEEK_CUR) == 0
                                           : fwrite(piece, 1, length, file) == length);
        at += length;
    } while (is_good && length > 0);
    is_good = is_good && fflush(file) == 0 && ftruncate(fileno(file), (off_t)at) == 0;
    free(parts);
    return is_good;
}

bool pipeline_save_snapshot(struct pipeline *pipeline, const char *path)
{
    return state_file_replace(path, write_snapshot, &pipeline);
}

/* ---- Restore ---- */

/* Says why the snapshot is not used. It is written over by the next one. */
static enum pipeline_restored refuse_snapshot(const char *path, const char *why)
{
    fprintf(stderr, "rhotrack: %s: %s; tracks begin anew\n", path, why);
    return PIPELINE_REFUSED;
}

static enum pipeline_restored set_snapshot_aside(const char *path, const char *why)
{
    const size_t bytes = strlen(path) + strlen(why) + 3;
    char *said = must_alloc(bytes);
    bool is_aside;

    snprintf(said, bytes, "%s: %s", path, why);
    is_aside = state_file_set_aside(path, said, "tracks begin anew");
    free(said);
    return is_aside ? PIPELINE_REFUSED : PIPELINE_STUCK;
}

static const char *damage_of_snapshot(const uint8_t *image, size_t size)
{
    static const char magic[] = "rhosnap\n";
    uint32_t crc;

    if (size < 8 || memcmp(image, magic, 8) != 0) {
        return "not a snapshot";
    }
    crc = state_file_crc(image, size - 4); /* its least significant byte comes first */
    for (unsigned i = 0; i < 4; i++) {
        if (image[size - 4 + i] != (uint8_t)(crc >> 8 * i)) {
            return "the snapshot is damaged";
        }
    }
    return NULL;
}

/* Why a snapshot that is whole does not fit this node; NULL where it is damaged all the same. */
static const char *reason_of_misfit(enum rho_status status)
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
        return NULL;
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

/* Replaces the pipeline and its parameters by those of the snapshot, if all of it fits. */
static enum rho_status adopt_snapshot(struct pipeline *pipeline, struct parameters *parameters,
                                      const uint8_t *image, size_t size)
{
    struct parameters changed = *parameters;
    struct rho_settings saved;
    enum rho_status status = rho_node_saved_settings(image, size, &saved);
    struct pipeline fresh;

    if (status == RHO_OK && !parameters_adopt_settings(&changed, &saved)) {
        status = RHO_ERROR_CONFIG;
    }
    if (status != RHO_OK) {
        return status;
    }
    fresh =
        open_fresh_pipeline(pipeline, parameters, &changed, num_windows_in_storage(image, size));
    fresh.node->settings = saved; /* parameters may have less digits */
    status = rho_node_load(fresh.node, image, size);
    if (status != RHO_OK) {
        pipeline_free(&fresh);
        return status;
    }
    pipeline_free(pipeline);
    *pipeline = fresh;
    *parameters = changed;
    return RHO_OK;
}

static enum pipeline_restored restore_image(struct pipeline *pipeline,
                                            struct parameters *parameters, const char *path,
                                            const uint8_t *image, size_t size)
{
    const char *why = damage_of_snapshot(image, size);
    enum rho_status status;

    if (why) {
        return set_snapshot_aside(path, why);
    }
    status = adopt_snapshot(pipeline, parameters, image, size);
    if (status == RHO_OK) {
        return PIPELINE_RESTORED;
    }
    why = reason_of_misfit(status);
    return why ? refuse_snapshot(path, why) : set_snapshot_aside(path, "the snapshot is damaged");
}

static bool is_long_text(const uint8_t *bytes, size_t size)
{
    bool is_text = size >= TEXT_BYTES;

    for (size_t i = 0; is_text && i < size; i++) {
        is_text = bytes[i] >= ' ' ? bytes[i] != 127 : bytes[i] >= '\t' && bytes[i] <= '\r';
    }
    return is_text;
}

enum pipeline_restored pipeline_restore_snapshot(struct pipeline *pipeline,
                                                 struct parameters *parameters, const char *path)
{
    enum pipeline_restored restored = PIPELINE_NO_FILE;
    size_t size;
    int error;
    uint8_t *image = state_file_read(path, "snapshot", &size, &error);

    if (is_long_text(image, size)) {
        fail(EXIT_USAGE, "%s: not a snapshot, and would be overwritten", path);
    }
    if (error) {
        restored = set_snapshot_aside(path, strerror(error));
    } else if (image && size == 0) {
        restored = refuse_snapshot(path, "the snapshot is empty");
    } else if (image) {
        restored = restore_image(pipeline, parameters, path, image, size);
    }
    free(image);
    return restored;
}
