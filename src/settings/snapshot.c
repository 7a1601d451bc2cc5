/* SPDX-License-Identifier: MIT */
#include "rhotrack/snapshot.h"

#include <string.h>

#include "rhotrack/initiator.h"
#include "rhotrack/passive.h"
#include "rhotrack/reflectors.h"
#include "rhotrack/settings.h"
#include "rhotrack/tracker.h"

/*
 * Offsets and sizes of a snapshot image's fields, in bytes. Numbers have the least significant byte
 * first on every machine.
 */
enum {
    MAGIC_AT = 0,
    VERSION_AT = 8,
    LAYOUT_AT = 12,
    SIZE_AT = 16,
    NUM_PARTS_AT = 20,
    HEADER_BYTES = 24,
    PART_BYTES = 16, /* fields of a part: kind, id, size, 0 */
    END_BYTES = 8    /* fields at the end of an image: 0, checksum */
};

static const uint8_t magic[8] = {'r', 'h', 'o', 's', 'n', 'a', 'p', '\n'};

/* Numbers and checksum */

static void put_u32(uint8_t *bytes, uint32_t value)
{
    for (unsigned i = 0; i < 4; i++) {
        bytes[i] = (uint8_t)(value >> 8 * i);
    }
}

static uint32_t get_u32(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
           (uint32_t)bytes[3] << 24;
}

/*
 * Adds bytes to a CRC-32 (IEEE 802.3), four bits at a time. The running value is the complement of
 * the checksum, and begins as UINT32_MAX.
 */
static uint32_t add_to_crc(uint32_t crc, const uint8_t *bytes, size_t size)
{
    static const uint32_t table[16] = {0x00000000u, 0x1db71064u, 0x3b6e20c8u, 0x26d930acu,
                                       0x76dc4190u, 0x6b6b51f4u, 0x4db26158u, 0x5005713cu,
                                       0xedb88320u, 0xf00f9344u, 0xd6d6a3e8u, 0xcb61b38cu,
                                       0x9b64c2b0u, 0x86d3d2d4u, 0xa00ae278u, 0xbdbdf21cu};
    for (size_t i = 0; i < size; i++) {
        crc = crc >> 4 ^ table[(crc ^ bytes[i]) & 15u];
        crc = crc >> 4 ^ table[(crc ^ (uint32_t)bytes[i] >> 4) & 15u];
    }
    return crc;
}

/* Layout */

#define PLACE(type, field) (uint32_t) offsetof(struct type, field)

/*
 * Capacities, options, sizes and offsets that two builds must agree on to exchange snapshots.
 * Hashed in the machine's byte order, so that this must agree, too.
 */
static const uint32_t facts[] = {
    RHO_MAX_PLOTS,
    RHO_MAX_SCANS,
    RHO_MAX_BINS,
    RHO_MAX_TRACKS,
    RHO_MAX_HYPOTHESES,
    RHO_MAX_GATE_PLOTS,
    RHO_MAX_SENSORS,
    RHO_MAX_CANDIDATES,
    RHO_MAX_DENSITY_CELLS,
    RHO_MAX_DENSITY_MAPS,
    RHO_MAX_CLUTTER_CELLS,
    RHO_MAX_BEARINGS,
    RHO_MAX_PASSIVE_SCANS,
    RHO_MAX_PASSIVE_SENSORS,
    RHO_MAX_PASSIVE_TRACKS,
    RHO_FILTERS,
    RHO_SECTORS,
    RHO_AMBIGUOUS_RANGE_RATES,
    RHO_PLOT_STRIPS,
    RHO_HYPOTHESES_OF_TRACK,
    RHO_HYPOTHESES_CHILDREN,
    RHO_HYPOTHESES_MEMORY,
    RHO_MAX_ECHOES,
    RHO_ECHO_REGIONS,
    RHO_STROBE_BINS,
    RHO_ECHO_HIT_CLASSES,
    RHO_ECHO_GAP_CLASSES,
    sizeof(struct rho_tracker),
    sizeof(struct rho_tracker_config),
    sizeof(struct rho_tracker_counters),
    sizeof(struct rho_sensor),
    sizeof(struct rho_tracker_learned),
    RHO_LEARN_RINGS,
    sizeof(struct rho_tracker_pace),
    sizeof(struct rho_track),
    sizeof(struct rho_assignment),
    sizeof(struct rho_hypotheses),
    sizeof(struct rho_hypothesis),
    sizeof(struct rho_imm),
    sizeof(struct rho_input),
    PLACE(rho_tracker, config),
    PLACE(rho_tracker, counters),
    PLACE(rho_tracker, sensors),
    PLACE(rho_tracker, tracks),
    PLACE(rho_tracker, assignment),
    PLACE(rho_tracker, hypotheses),
    PLACE(rho_track, score_mnat),
    PLACE(rho_track, time_us),
    PLACE(rho_track, kalman),
    PLACE(rho_track, num_velocities),
    PLACE(rho_track, input),
    PLACE(rho_hypotheses, node_of),
    PLACE(rho_hypotheses, nodes),
    PLACE(rho_hypothesis, time_us),
    PLACE(rho_hypothesis, picks),
    PLACE(rho_hypothesis, num_candidates),
    sizeof(struct rho_initiator),
    sizeof(struct rho_initiator_config),
    sizeof(struct rho_density_map),
    sizeof(struct rho_candidate),
    sizeof(struct rho_window),
    sizeof(struct rho_window_scan),
    sizeof(struct rho_window_plot),
    PLACE(rho_initiator, config),
    PLACE(rho_initiator, density),
    PLACE(rho_initiator, candidates),
    PLACE(rho_initiator, window),
    PLACE(rho_window, extent),
    PLACE(rho_window, ring),
    PLACE(rho_window_scan, sensor),
    PLACE(rho_window_scan, num_plots),
    PLACE(rho_window_scan, bin_start),
    PLACE(rho_window_scan, plots),
    sizeof(struct rho_passive),
    sizeof(struct rho_passive_config),
    sizeof(struct rho_passive_track),
    sizeof(struct rho_batch),
    PLACE(rho_passive, tracks),
    PLACE(rho_passive, batch),
    PLACE(rho_batch, time_us),
    PLACE(rho_batch, bearings),
    sizeof(struct rho_settings),
    PLACE(rho_settings, scans),
    PLACE(rho_settings, work_max),
    sizeof(struct rho_clutter_map),
    sizeof(struct rho_echo),
    PLACE(rho_clutter_map, echoes),
    sizeof(struct rho_reflector_learning),
    sizeof(struct rho_learned_reflector),
    PLACE(rho_reflector_learning, lines),
    PLACE(rho_learned_reflector, witnesses),
};

static uint32_t layout_hash(void)
{
    return add_to_crc(0, (const uint8_t *)facts, sizeof facts);
}

/* Kinds */

/* Sizes of the objects of the kinds; 0: there is no such kind in this build. */
static const size_t sizes[] = {
    [RHO_SNAPSHOT_TRACKER] = sizeof(struct rho_tracker),
    [RHO_SNAPSHOT_INITIATOR] = sizeof(struct rho_initiator),
    [RHO_SNAPSHOT_PASSIVE] = sizeof(struct rho_passive),
    [RHO_SNAPSHOT_SETTINGS] = sizeof(struct rho_settings),
    [RHO_SNAPSHOT_CLUTTER_MAP] = RHO_MAX_ECHOES > 0 ? sizeof(struct rho_clutter_map) : 0,
    [RHO_SNAPSHOT_REFLECTORS] = RHO_MAX_REFLECTORS > 0 ? sizeof(struct rho_reflector_learning) : 0,
};

static size_t size_of_kind(uint32_t kind)
{
    return kind < sizeof sizes / sizeof sizes[0] ? sizes[kind] : 0;
}

static int is_object_sound(uint32_t kind, const void *object)
{
    switch (kind) {
    case RHO_SNAPSHOT_TRACKER:
        return rho_tracker_is_sound(object);
    case RHO_SNAPSHOT_INITIATOR:
        return rho_initiator_is_sound(object);
    case RHO_SNAPSHOT_PASSIVE:
        return rho_passive_is_sound(object);
    case RHO_SNAPSHOT_SETTINGS:
        return rho_settings_check(object, 0) == RHO_OK;
    case RHO_SNAPSHOT_CLUTTER_MAP:
        return RHO_MAX_ECHOES > 0 && rho_clutter_map_is_sound(object);
    case RHO_SNAPSHOT_REFLECTORS:
        return RHO_MAX_REFLECTORS > 0 && rho_reflector_learning_is_sound(object);
    default:
        return 0;
    }
}

static size_t padding_of(size_t size)
{
    return (RHO_SNAPSHOT_ALIGNMENT - size % RHO_SNAPSHOT_ALIGNMENT) % RHO_SNAPSHOT_ALIGNMENT;
}

static enum rho_status check_parts(const struct rho_snapshot_part *parts, unsigned num_parts)
{
    if (num_parts > 0 && !parts) {
        return RHO_ERROR_NULL;
    }
    for (unsigned i = 0; i < num_parts; i++) {
        if (!parts[i].object) {
            return RHO_ERROR_NULL;
        }
        if (size_of_kind((uint32_t)parts[i].kind) == 0) {
            return RHO_ERROR_VALUE;
        }
        if (size_of_kind((uint32_t)parts[i].kind) != parts[i].size) {
            return RHO_ERROR_SIZE;
        }
    }
    return RHO_OK;
}

static size_t image_size(const struct rho_snapshot_part *parts, unsigned num_parts)
{
    return rho_snapshot_offset(parts, num_parts, num_parts) + END_BYTES;
}

size_t rho_snapshot_size(const struct rho_snapshot_part *parts, unsigned num_parts)
{
    return check_parts(parts, num_parts) == RHO_OK ? image_size(parts, num_parts) : 0;
}

/* Save */

/*
 * Writer of a snapshot image. All bytes of the image pass in order; those from `from` to before
 * `end` are written to the buffer.
 */
struct writer {
    size_t at, from, end;
    uint8_t *buffer;
    uint32_t crc;
    int has_crc; /* the checksum is computed, as the buffer will hold it */
};

/* Writes those bytes that lie in the requested range of the image, and passes over the others. */
static void put_bytes(struct writer *writer, const void *data, size_t size)
{
    const uint8_t *bytes = data;
    const size_t at = writer->at;
    const size_t first = at > writer->from ? at : writer->from;
    const size_t end = at + size < writer->end ? at + size : writer->end;
    if (writer->has_crc) {
        writer->crc = add_to_crc(writer->crc, bytes, size);
    }
    if (first < end) {
        memcpy(writer->buffer + (first - writer->from), bytes + (first - at), end - first);
    }
    writer->at += size;
}

static void put_header(struct writer *writer, const struct rho_snapshot_part *parts,
                       unsigned num_parts)
{
    uint8_t bytes[HEADER_BYTES];
    memcpy(bytes + MAGIC_AT, magic, sizeof magic);
    put_u32(bytes + VERSION_AT, RHO_SNAPSHOT_VERSION);
    put_u32(bytes + LAYOUT_AT, layout_hash());
    put_u32(bytes + SIZE_AT, (uint32_t)image_size(parts, num_parts));
    put_u32(bytes + NUM_PARTS_AT, num_parts);
    put_bytes(writer, bytes, HEADER_BYTES);
    for (unsigned i = 0; i < num_parts; i++) {
        put_u32(bytes, (uint32_t)parts[i].kind);
        put_u32(bytes + 4, (uint32_t)parts[i].id);
        put_u32(bytes + 8, (uint32_t)parts[i].size);
        put_u32(bytes + 12, 0);
        put_bytes(writer, bytes, PART_BYTES);
    }
}

static int are_objects_sound(const struct rho_snapshot_part *parts, unsigned num_parts)
{
    for (unsigned i = 0; i < num_parts; i++) {
        if (!is_object_sound((uint32_t)parts[i].kind, parts[i].object)) {
            return 0;
        }
    }
    return 1;
}

enum rho_status rho_snapshot_save(const struct rho_snapshot_part *parts, unsigned num_parts,
                                  size_t offset, uint8_t *buffer, size_t size, size_t *length)
{
    static const uint8_t zeros[RHO_SNAPSHOT_ALIGNMENT] = {0};
    enum rho_status status = check_parts(parts, num_parts);
    if (!buffer || !length || status != RHO_OK) {
        return status != RHO_OK ? status : RHO_ERROR_NULL;
    }
    if (offset == 0 && !are_objects_sound(parts, num_parts)) {
        return RHO_ERROR_STATE;
    }
    const size_t all = image_size(parts, num_parts);
    const size_t left = offset < all ? all - offset : 0;
    *length = size < left ? size : left;
    struct writer writer = {.from = offset,
                            .end = offset + *length,
                            .crc = UINT32_MAX,
                            .has_crc = offset + *length > all - 4u};
    writer.buffer = buffer;
    put_header(&writer, parts, num_parts);
    for (unsigned i = 0; i < num_parts; i++) {
        put_bytes(&writer, parts[i].object, parts[i].size);
        put_bytes(&writer, zeros, padding_of(parts[i].size));
    }
    uint8_t checksum[4] = {0};
    put_bytes(&writer, checksum, sizeof checksum);
    put_u32(checksum, ~writer.crc);
    put_bytes(&writer, checksum, sizeof checksum);
    return RHO_OK;
}

/* Load */

static uint32_t part_field(const uint8_t *image, unsigned part, unsigned field)
{
    return get_u32(image + HEADER_BYTES + (size_t)part * PART_BYTES + 4u * field);
}

/* True where each part of an image has the size of its kind, and the parts fill the image. */
static int is_filled_by_parts(const uint8_t *image, uint32_t size, uint32_t num_parts)
{
    size_t left = size - HEADER_BYTES - END_BYTES;
    if (num_parts > left / PART_BYTES) {
        return 0;
    }
    left -= num_parts * PART_BYTES;
    for (unsigned i = 0; i < num_parts; i++) {
        const size_t bytes = size_of_kind(part_field(image, i, 0));
        if (bytes == 0 || part_field(image, i, 2) != bytes || bytes + padding_of(bytes) > left) {
            return 0;
        }
        left -= bytes + padding_of(bytes);
    }
    return left == 0;
}

/* Checks an image's alignment, header, checksum and part sizes, but not the objects in it. */
static enum rho_status check_image(const uint8_t *image, size_t size)
{
    if (!image) {
        return RHO_ERROR_NULL;
    }
    if ((uintptr_t)image % RHO_SNAPSHOT_ALIGNMENT != 0) {
        return RHO_ERROR_VALUE;
    }
    if (size < HEADER_BYTES + END_BYTES) {
        return RHO_ERROR_SHORT;
    }
    if (memcmp(image, magic, sizeof magic) != 0 ||
        get_u32(image + VERSION_AT) != RHO_SNAPSHOT_VERSION) {
        return RHO_ERROR_TYPE;
    }
    if (get_u32(image + LAYOUT_AT) != layout_hash()) {
        return RHO_ERROR_SIZE;
    }
    const uint32_t said = get_u32(image + SIZE_AT);
    if (said > size) {
        return RHO_ERROR_SHORT;
    }
    if (said < HEADER_BYTES + END_BYTES ||
        ~add_to_crc(UINT32_MAX, image, said - 4u) != get_u32(image + said - 4u) ||
        !is_filled_by_parts(image, said, get_u32(image + NUM_PARTS_AT))) {
        return RHO_ERROR_VALUE;
    }
    return RHO_OK;
}

enum rho_status rho_snapshot_list(const void *image, size_t size, struct rho_snapshot_part *parts,
                                  unsigned max_parts, unsigned *num_parts)
{
    const uint8_t *bytes = image;
    if (!num_parts || (max_parts > 0 && !parts)) {
        return RHO_ERROR_NULL;
    }
    const enum rho_status status = check_image(bytes, size);
    if (status != RHO_OK) {
        return status;
    }
    *num_parts = get_u32(bytes + NUM_PARTS_AT);
    for (unsigned i = 0; i < *num_parts && i < max_parts; i++) {
        parts[i].kind = (enum rho_snapshot_kind)part_field(bytes, i, 0);
        parts[i].id = (int32_t)part_field(bytes, i, 1);
        parts[i].size = part_field(bytes, i, 2);
    }
    return RHO_OK;
}

size_t rho_snapshot_offset(const struct rho_snapshot_part *parts, unsigned num_parts,
                           unsigned place)
{
    size_t offset = HEADER_BYTES + (size_t)num_parts * PART_BYTES;
    for (unsigned i = 0; parts && i < place && i < num_parts; i++) {
        offset += parts[i].size + padding_of(parts[i].size);
    }
    return offset;
}

static size_t smaller_size(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Compares a piece of an image with the header and the table of parts that the loader expects. */
static enum rho_status compare_header(const struct rho_snapshot_loader *loader,
                                      const uint8_t *bytes, size_t size)
{
    uint8_t expected[PART_BYTES] = {0};
    for (size_t i = 0; i < size; i++) {
        const size_t at = loader->at + i;
        if (i % PART_BYTES == 0) {
            struct writer writer = {.from = at, .end = at + smaller_size(PART_BYTES, size - i)};
            writer.buffer = expected;
            put_header(&writer, loader->parts, loader->num_parts);
        }
        if (bytes[i] != expected[i % PART_BYTES]) {
            return at < LAYOUT_AT ? RHO_ERROR_TYPE
                   : at < SIZE_AT ? RHO_ERROR_SIZE
                                  : RHO_ERROR_COUNT;
        }
    }
    return RHO_OK;
}

enum rho_status rho_snapshot_load(const struct rho_snapshot_part *parts, unsigned num_parts,
                                  const void *image, size_t size)
{
    const uint8_t *bytes = image;
    enum rho_status status = check_parts(parts, num_parts);
    if (status == RHO_OK) {
        status = check_image(bytes, size);
    }
    if (status != RHO_OK) {
        return status;
    }
    const struct rho_snapshot_loader whole = {.parts = parts, .num_parts = num_parts};
    status = compare_header(&whole, bytes, rho_snapshot_offset(parts, num_parts, 0));
    if (status != RHO_OK) {
        return status;
    }
    /* all objects are checked before any part is changed */
    for (int is_copy = 0; is_copy < 2; is_copy++) {
        for (unsigned i = 0; i < num_parts; i++) {
            const uint8_t *object = bytes + rho_snapshot_offset(parts, num_parts, i);
            if (is_copy) {
                memcpy(parts[i].object, object, parts[i].size);
            } else if (!is_object_sound((uint32_t)parts[i].kind, object)) {
                return RHO_ERROR_VALUE;
            }
        }
    }
    return RHO_OK;
}

/* Load in pieces */

/* Copies the bytes of a piece of an image that belong to objects. */
static void copy_piece(const struct rho_snapshot_loader *loader, const uint8_t *bytes, size_t size)
{
    for (unsigned i = 0; i < loader->num_parts; i++) {
        const struct rho_snapshot_part *part = &loader->parts[i];
        const size_t first = rho_snapshot_offset(loader->parts, loader->num_parts, i);
        const size_t from = first > loader->at ? first : loader->at;
        const size_t end = smaller_size(first + part->size, loader->at + size);
        if (from < end) {
            memcpy((uint8_t *)part->object + (from - first), bytes + (from - loader->at),
                   end - from);
        }
    }
}

/*
 * Ends a pass over an image: the first pass checks the checksum, the second one the loaded objects
 * too, which are cleared where that fails.
 */
static enum rho_status end_pass(struct rho_snapshot_loader *loader)
{
    int is_whole = loader->crc == 0xdebb20e3u /* after bytes and their own checksum */;
    if (loader->passes == 1 && !(is_whole && are_objects_sound(loader->parts, loader->num_parts))) {
        for (unsigned i = 0; i < loader->num_parts; i++) {
            memset(loader->parts[i].object, 0, loader->parts[i].size);
        }
        is_whole = 0;
    }
    loader->at = 0;
    loader->crc = UINT32_MAX;
    loader->passes++;
    return is_whole ? RHO_OK : RHO_ERROR_VALUE;
}

enum rho_status rho_snapshot_begin(struct rho_snapshot_loader *loader,
                                   const struct rho_snapshot_part *parts, unsigned num_parts)
{
    const enum rho_status status = check_parts(parts, num_parts);
    if (!loader || status != RHO_OK) {
        return loader ? status : RHO_ERROR_NULL;
    }
    *loader =
        (struct rho_snapshot_loader){.parts = parts, .num_parts = num_parts, .crc = UINT32_MAX};
    return RHO_OK;
}

enum rho_status rho_snapshot_take(struct rho_snapshot_loader *loader, const uint8_t *bytes,
                                  size_t size)
{
    enum rho_status status = RHO_OK;
    if (!loader || (size > 0 && !bytes)) {
        return RHO_ERROR_NULL;
    }
    if (loader->passes >= RHO_SNAPSHOT_PASSES || check_parts(loader->parts, loader->num_parts)) {
        return RHO_ERROR_STATE;
    }
    const size_t all = image_size(loader->parts, loader->num_parts);
    const size_t head = rho_snapshot_offset(loader->parts, loader->num_parts, 0);
    const size_t taken = smaller_size(size, all - loader->at);
    if (loader->passes == 0 && loader->at < head) {
        status = compare_header(loader, bytes, smaller_size(taken, head - loader->at));
    }
    if (loader->passes == 1) {
        copy_piece(loader, bytes, taken);
    }
    loader->crc = add_to_crc(loader->crc, bytes, taken);
    loader->at += (uint32_t)taken;
    if (status == RHO_OK && loader->at == all) {
        status = end_pass(loader);
    }
    if (status != RHO_OK) {
        loader->passes = RHO_SNAPSHOT_PASSES + 1; /* marks the image as refused */
    }
    return status;
}
