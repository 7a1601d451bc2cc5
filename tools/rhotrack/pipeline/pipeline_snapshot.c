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

/* Identifier of the tracker's part: how sensors share the initiators of the snapshot. */
enum { OF_NOBODY, OF_SENSORS, OF_ALL, OF_PAIRS };

/*
 * Number of parts besides initiators: tracker, passive, two settings; learned walls are optional.
 */
enum { OTHERS = 4 };

/* Identifiers of the settings' parts: as at the start, and as changed by operators. */
enum { SETTINGS_TOLD, SETTINGS_NOW };

/* The code of how sensors share initiators, stored as the identifier of the tracker's part. */
static int32_t initiator_sharing_code(const struct pipeline *pipeline)
{
    return pipeline->has_one_initiator ? OF_ALL
           : !pipeline->has_sensor     ? OF_NOBODY
           : pipeline->has_pairs       ? OF_PAIRS
                                       : OF_SENSORS;
}

/*
 * Lists the parts of a snapshot, in new memory: tracker, initiators, passive, both settings,
 * learned walls.
 */
static struct rho_snapshot_part *list_snapshot_parts(struct pipeline *pipeline, unsigned *num_parts)
{
    struct rho_snapshot_part *parts =
        must_calloc(pipeline->num_initiators + OTHERS + 1, sizeof *parts);
    unsigned count = 0;

    parts[count++] =
        (struct rho_snapshot_part){RHO_SNAPSHOT_TRACKER, initiator_sharing_code(pipeline),
                                   pipeline->tracker, sizeof *pipeline->tracker};
    for (size_t i = 0; i < pipeline->num_initiators; i++) {
        const struct pipeline_initiator *of = &pipeline->initiators[i];

        parts[count++] = (struct rho_snapshot_part){RHO_SNAPSHOT_INITIATOR, of->sensor_id,
                                                    of->initiator, sizeof *of->initiator};
    }
    parts[count++] = (struct rho_snapshot_part){RHO_SNAPSHOT_PASSIVE, 0, pipeline->passive,
                                                sizeof *pipeline->passive};
    parts[count++] = (struct rho_snapshot_part){RHO_SNAPSHOT_SETTINGS, SETTINGS_TOLD,
                                                &pipeline->told, sizeof pipeline->told};
    parts[count++] = (struct rho_snapshot_part){RHO_SNAPSHOT_SETTINGS, SETTINGS_NOW,
                                                &pipeline->settings, sizeof pipeline->settings};
    if (pipeline->learning) {
        parts[count++] = (struct rho_snapshot_part){RHO_SNAPSHOT_REFLECTORS, 0, pipeline->learning,
                                                    sizeof *pipeline->learning};
    }
    *num_parts = count;
    return parts;
}

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
    unsigned num_parts;
    struct rho_snapshot_part *parts = list_snapshot_parts(pipeline, &num_parts);
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
    default:
        return "the snapshot is damaged";
    }
}

/*
 * Adds the initiators that a snapshot has; false where a pipeline with these parameters cannot have
 * them.
 */
static bool add_missing_initiators(struct pipeline *pipeline, const struct rho_snapshot_part *parts,
                                   unsigned num_parts)
{
    const unsigned others = OTHERS + (pipeline->learning ? 1 : 0);
    const bool has_sensors = parts[0].id == OF_SENSORS || parts[0].id == OF_PAIRS;

    for (unsigned i = 1; i + others <= num_parts && has_sensors && !pipeline->has_one_initiator;
         i++) {
        (void)pipeline_find_or_add_initiator(pipeline, parts[i].id);
    }
    return num_parts == pipeline->num_initiators + others &&
           parts[0].id == initiator_sharing_code(pipeline);
}

static bool is_same_memory(const void *one, const void *other, size_t size)
{
    return memcmp(one, other, size) == 0;
}

/*
 * Loads a snapshot into an opened pipeline, and takes settings that an operator had changed into
 * the parameters. *is_other: the snapshot was made with other parameters.
 */
static enum rho_status load_snapshot(struct pipeline *pipeline, struct parameters *parameters,
                                     const uint8_t *image, size_t size, bool *is_other)
{
    const struct rho_passive_config search = pipeline->passive->config;
    const struct rho_settings told = pipeline->told;
    struct rho_tracker_config maintain;
    unsigned num_parts;
    struct rho_snapshot_part *parts = list_snapshot_parts(pipeline, &num_parts);
    enum rho_status status = rho_snapshot_load(parts, num_parts, image, size);

    free(parts);
    if (status != RHO_OK) {
        return status;
    }
    *is_other = !is_same_memory(&pipeline->told, &told, sizeof told) ||
                !parameters_adopt_settings(parameters, &pipeline->settings);
    parameters_to_tracker(parameters, &maintain);
    parameters_to_initiator(parameters, &pipeline->start);
    *is_other |= !is_same_memory(&pipeline->tracker->config, &maintain, sizeof maintain) ||
                 !is_same_memory(&pipeline->passive->config, &search, sizeof search);
    for (size_t i = 0; i < pipeline->num_initiators; i++) {
        *is_other |= !is_same_memory(&pipeline->initiators[i].initiator->config, &pipeline->start,
                                     sizeof pipeline->start);
    }
    return status;
}

static enum pipeline_restored replace_pipeline_by_snapshot(struct pipeline *pipeline,
                                                           struct parameters *parameters,
                                                           const char *path, const uint8_t *image,
                                                           size_t size)
{
    struct parameters changed = *parameters;
    unsigned num_parts = 0;
    enum rho_status status = rho_snapshot_list(image, size, NULL, 0, &num_parts);
    struct pipeline fresh;
    bool is_other;

    if (status != RHO_OK) {
        return refuse_snapshot(path, snapshot_refusal_reason(status));
    }
    struct rho_snapshot_part *parts = must_calloc(num_parts + 1, sizeof *parts);
    (void)!rho_snapshot_list(image, size, parts, num_parts, &num_parts);
    fresh = pipeline_allocate();
    fresh.is_live = pipeline->is_live;
    memset(fresh.report, 0, sizeof *fresh.report);
    pipeline_open(&fresh, parameters);
    pipeline_open_passive(&fresh, parameters);
    is_other = num_parts < OTHERS + 1 || !add_missing_initiators(&fresh, parts, num_parts);
    status = is_other ? RHO_OK : load_snapshot(&fresh, &changed, image, size, &is_other);
    free(parts);
    if (is_other || status != RHO_OK) {
        pipeline_free(&fresh);
        return refuse_snapshot(path, is_other ? "a snapshot with other parameters"
                                              : snapshot_refusal_reason(status));
    }
    fresh.initiator = fresh.initiators[0].initiator;
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
