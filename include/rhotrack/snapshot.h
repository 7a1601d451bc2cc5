/* SPDX-License-Identifier: MIT */
/*
 * snapshot: saves objects as one image of bytes, and loads them again: a node that restarts goes on
 * with its tracks and with all that it has learned.
 *
 *     struct rho_snapshot_part parts[] = {
 *         {.kind = RHO_SNAPSHOT_TRACKER, .object = &tracker, .size = sizeof tracker},
 *         {.kind = RHO_SNAPSHOT_INITIATOR, .id = 7, .object = &starts, .size = sizeof starts},
 *     };
 *     size_t at = 0, length;
 *     while (rho_snapshot_save(parts, 2, at, page, sizeof page, &length) == RHO_OK && length > 0) {
 *         write_flash(at, page, length);
 *         at += length;
 *     }
 *     ...
 *     if (rho_snapshot_load(parts, 2, flash, flash_size) != RHO_OK) {
 *         begin_anew();     by rho_tracker_init and rho_initiator_init
 *     }
 *
 * A device that keeps what it was told and taught, but no tracks, has a block of settings and map:
 *
 *     struct rho_snapshot_part kept[] = {
 *         {.kind = RHO_SNAPSHOT_SETTINGS, .object = &settings, .size = sizeof settings},
 *         {.kind = RHO_SNAPSHOT_CLUTTER_MAP, .object = &tracker.clutter_map,
 *          .size = sizeof tracker.clutter_map},
 *     };
 *
 * It is loaded after rho_tracker_init, between two steps, where the sensors' clock goes on. Where
 * it begins anew at each start, the map is loaded beside the tracker's, and rho_clutter_map_teach
 * is given its echoes.
 *
 * An image holds any objects of the kinds below, whole, with their configurations: nothing has to
 * be initialised before it is loaded. It is taken between any two steps; later steps give the same
 * bytes as without it. Scan assembly is not part of it: scans that were still open are lost.
 *
 *   header    magic, version of the format, layout, size of the image, number of parts; each part's
 *             kind, id and size
 *   objects   as they are in memory, each aligned to 8 bytes
 *   checksum  CRC-32 of all bytes before it
 *
 * `layout` stands for everything that two builds must agree on: byte order, capacities, options,
 * sizes and places of fields. An image of another build is refused, and so is an image that was not
 * written to its end, or was written in pieces with a step between: two areas of flash, written in
 * turn, survive a power cut. The checksum finds damage, not intent: whoever can write the flash can
 * write any image. So an image's objects are checked (rho_tracker_is_sound and its like) before
 * they are used: no index leads outside of them, and no loop is endless. Whether their numbers are
 * right is not checked.
 *
 * Stack: 130 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_SNAPSHOT_H
#define RHOTRACK_SNAPSHOT_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/types.h"

RHO_BEGIN_C

/*
 * Version of the image's contents: goes up where fields of the objects change their meaning and not
 * their place.
 */
#define RHO_SNAPSHOT_VERSION 1

/* Alignment in memory, in bytes, of an image that rho_snapshot_load reads. */
#define RHO_SNAPSHOT_ALIGNMENT 8

enum rho_snapshot_kind {
    RHO_SNAPSHOT_TRACKER = 1, /* struct rho_tracker */
    RHO_SNAPSHOT_INITIATOR,   /* struct rho_initiator, with its window and density maps */
    RHO_SNAPSHOT_PASSIVE,     /* struct rho_passive */
    /* struct rho_settings: consistent where rho_settings_check accepts them */
    RHO_SNAPSHOT_SETTINGS,
    /* struct rho_clutter_map of a tracker, with the echoes learned; not with RHO_MAX_ECHOES 0 */
    RHO_SNAPSHOT_CLUTTER_MAP,
    RHO_SNAPSHOT_REFLECTORS, /* struct rho_reflector_learning; not with RHO_MAX_REFLECTORS 0 */
};

/* A part of an image: an object of the caller. */
struct rho_snapshot_part {
    enum rho_snapshot_kind kind;
    /*
     * chosen by the caller, to tell objects of a kind apart: an initiator's sensor_id, for example
     */
    int32_t id;
    void *object;
    size_t size; /* sizeof(object) of the caller */
};

/*
 * Size in bytes of an image of these parts; 0 where a part's kind or size is not the library's.
 * Cost: num_parts.
 */
size_t rho_snapshot_size(const struct rho_snapshot_part *parts, unsigned num_parts);

/*
 * Writes the image from its byte `offset` on, as much as the buffer has room for: all of it, or a
 * page after the other.
 *   length  bytes written; 0: the image ends before `offset`
 * Errors: NULL, SIZE (a part's size is not the library's), VALUE (a kind that is none), STATE (a
 * part is not initialised, or its bytes are no object's: checked where offset is 0). Cost: the
 * bytes copied; with the last piece all bytes once more for the checksum, about 12 instructions
 * each. Stack: 900 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_snapshot_save(const struct rho_snapshot_part *parts,
                                                 unsigned num_parts, size_t offset, uint8_t *buffer,
                                                 size_t size, size_t *length);

/*
 * Loads an image into the parts' objects, whatever these held before. Number, order, kinds and ids
 * of the parts must be the image's (rho_snapshot_list tells them).
 *   image  in addressable memory, aligned to RHO_SNAPSHOT_ALIGNMENT; bytes behind the image are
 *          ignored
 * Errors: NULL, SIZE (of another build; or a part's size is not the library's), VALUE (the image is
 * not aligned; the checksum; contents that are no object's), SHORT (it ends too early), TYPE (no
 * image, or of another version), COUNT (other parts than the image's). Nothing is changed. Cost: as
 * rho_snapshot_save, and a check of all objects. Stack: 900 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_snapshot_load(const struct rho_snapshot_part *parts,
                                                 unsigned num_parts, const void *image,
                                                 size_t size);

/* A loader of an image that comes in pieces, and goes by RHO_SNAPSHOT_PASSES times. */
#define RHO_SNAPSHOT_PASSES 2
struct rho_snapshot_loader {
    const struct rho_snapshot_part *parts;
    unsigned num_parts;
    uint32_t at; /* bytes of the image taken in this pass */
    uint32_t crc;
    /* passes ended. RHO_SNAPSHOT_PASSES: the parts are loaded. More: the image was refused */
    uint32_t passes;
};

/*
 * Begins to load an image in pieces. The loader keeps the address of `parts`. Errors: NULL, SIZE,
 * VALUE, as rho_snapshot_save.
 */
RHO_MUST_CHECK enum rho_status rho_snapshot_begin(struct rho_snapshot_loader *loader,
                                                  const struct rho_snapshot_part *parts,
                                                  unsigned num_parts);

/*
 * Takes the next bytes of an image in memory that cannot be addressed (NVRAM, a file). The whole
 * image goes by twice: the first pass checks it, the second one copies it to the parts.
 *
 *     for (pass = 0; pass < RHO_SNAPSHOT_PASSES; pass++) {
 *         for (at = 0; at < all && status == RHO_OK; at += sizeof page) {
 *             read_nvram(at, page, sizeof page);
 *             status = rho_snapshot_take(&loader, page, sizeof page);
 *         }
 *     }
 *
 * The last byte of a pass ends it; the rest of that piece is ignored. Pieces may have any size.
 * Errors: NULL, STATE (not begun, loaded, or refused before), and those of rho_snapshot_load. An
 * error in the first pass, which finds all damage, changes nothing. An error that only the second
 * can find (contents that are no object's, bytes that are others when they are read again) leaves
 * the parts uninitialised, all zeros.
 * Cost: the bytes, and with the last one a check of all objects. Stack: 900 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_snapshot_take(struct rho_snapshot_loader *loader,
                                                 const uint8_t *bytes, size_t size);

/*
 * Place of a part's object in an image of these parts, in bytes from its begin: to read an image in
 * addressable memory without loading it. Cost: num_parts.
 */
size_t rho_snapshot_offset(const struct rho_snapshot_part *parts, unsigned num_parts,
                           unsigned place);

/*
 * Lists the parts of an image: fills kind, id and size of up to max_parts parts; their pointers
 * stay. Sets *num_parts to the number of parts in the image. Errors: those of rho_snapshot_load up
 * to the checksum. Cost: the checksum.
 */
RHO_MUST_CHECK enum rho_status rho_snapshot_list(const void *image, size_t size,
                                                 struct rho_snapshot_part *parts,
                                                 unsigned max_parts, unsigned *num_parts);

RHO_END_C

#endif
