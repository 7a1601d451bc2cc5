/* SPDX-License-Identifier: MIT */
/*
 * Splits ASTERIX data blocks into records and items, by the lengths of items.
 */
#include "io/asterix/asterix_codec.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "io/asterix/asterix_item_lengths.h"

#define FX 1u  /* field extension bit, the last bit of a byte: another byte follows */
#define BITS 7 /* items per byte of a field specification; the last bit is FX */

/* Position of decoding in the bytes of a record. */
struct cursor {
    const uint8_t *data;
    size_t size, at;
    uint8_t category;
    struct asterix_error *error;
};

static bool set_error(const struct cursor *cursor, size_t at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Sets the error's place and reason. Always returns false. */
static bool set_error(const struct cursor *cursor, size_t at, const char *format, ...)
{
    va_list arguments;

    cursor->error->at = at;
    va_start(arguments, format);
    vsnprintf(cursor->error->reason, sizeof cursor->error->reason, format, arguments);
    va_end(arguments);
    return false;
}

bool asterix_block_read(const uint8_t *data, size_t size, struct asterix_block *block,
                        struct asterix_error *error)
{
    const struct cursor cursor = {.error = error};
    size_t length;

    if (size < ASTERIX_HEADER_BYTES) {
        return set_error(&cursor, 0, "a data block has at least %u bytes, but only %zu are left",
                         ASTERIX_HEADER_BYTES, size);
    }
    length = (size_t)data[1] << 8 | data[2];
    if (length < ASTERIX_HEADER_BYTES) {
        return set_error(&cursor, 1,
                         "a data block of category %u has an invalid length of %zu bytes", data[0],
                         length);
    }
    if (length > size) {
        return set_error(&cursor, 0,
                         "a data block of category %u has %zu bytes, but only %zu are left",
                         data[0], length, size);
    }
    *block = (struct asterix_block){.category = data[0],
                                    .records = data + ASTERIX_HEADER_BYTES,
                                    .size = length - ASTERIX_HEADER_BYTES};
    return true;
}

bool asterix_category_is_known(uint8_t category)
{
    return asterix_category_find_profile(category, false);
}

bool asterix_category_is_plots(uint8_t category)
{
    return category == ASTERIX_PLOTS || category == ASTERIX_OLD_PLOTS;
}

bool asterix_category_is_service(uint8_t category)
{
    return category == ASTERIX_SERVICE || category == ASTERIX_OLD_SERVICE;
}

/*
 * Bytes of an extended item, up to the part of `step` bytes whose last bit is clear; more than the
 * bytes left where there is no such part.
 */
static size_t count_extended_bytes(const struct cursor *cursor, size_t step)
{
    size_t bytes = step;

    while (cursor->at + bytes <= cursor->size && (cursor->data[cursor->at + bytes - 1] & FX)) {
        bytes += step;
    }
    return bytes;
}

/*
 * Bytes of an item that is not compound, more than the bytes left where it is cut off. 0: the item
 * states a length of 0.
 */
static size_t count_simple_item_bytes(const struct cursor *cursor, const struct asterix_item *item)
{
    size_t first = cursor->at < cursor->size ? cursor->data[cursor->at] : cursor->size + 1;

    switch (item->form) {
    case ASTERIX_FIXED:
        return item->bytes;
    case ASTERIX_EXTENDED:
    case ASTERIX_REPEATED_FX:
        return count_extended_bytes(cursor, item->bytes);
    case ASTERIX_REPEATED:
        return cursor->at < cursor->size ? 1 + first * item->bytes : 1;
    case ASTERIX_EXPLICIT:
        return first;
    default:
        return 0;
    }
}

/* Moves the cursor behind an item that is not compound; false: it is cut off, or without bytes. */
static bool skip_simple_item(struct cursor *cursor, const struct asterix_item *item,
                             const char *compound_name)
{
    size_t bytes = count_simple_item_bytes(cursor, item);

    if (bytes == 0) {
        return set_error(cursor, cursor->at, "I%03u/%s has a length of 0", cursor->category,
                         item->name);
    }
    if (bytes > cursor->size - cursor->at) {
        return set_error(cursor, cursor->at, "I%03u/%s%s%s goes beyond its data block",
                         cursor->category, compound_name ? compound_name : item->name,
                         compound_name ? "/" : "", compound_name ? item->name : "");
    }
    cursor->at += bytes;
    return true;
}

/*
 * Reads the field specification at the cursor, which moves behind it: bit i of *present is set
 * where the record has the item at place i of the profile.
 */
static bool read_field_specification(struct cursor *cursor, const struct asterix_item *items,
                                     size_t num_items, const char *name, uint64_t *present)
{
    size_t start = cursor->at, bytes = count_extended_bytes(cursor, 1);

    if (start + bytes > cursor->size) {
        return set_error(cursor, start, "the field specification of %s goes beyond its data block",
                         name);
    }
    if (bytes > (num_items + BITS - 1) / BITS) {
        return set_error(cursor, start, "the field specification of %s has %zu bytes", name, bytes);
    }
    *present = 0;
    for (size_t place = 0; place < bytes * BITS; place++) {
        bool is_there = cursor->data[start + place / BITS] >> (BITS - place % BITS) & 1;

        if (is_there && (place >= num_items || items[place].form == ASTERIX_NONE)) {
            return set_error(cursor, start + place / BITS,
                             "%s has an item at the undefined place %zu", name, place + 1);
        }
        if (is_there) {
            *present |= UINT64_C(1) << place;
        }
    }
    cursor->at += bytes;
    return true;
}

static bool skip_compound_item(struct cursor *cursor, const struct asterix_item *item)
{
    char name[16];
    uint64_t present = 0;

    snprintf(name, sizeof name, "I%03u/%s", cursor->category, item->name);
    if (!read_field_specification(cursor, item->parts, item->num_parts, name, &present)) {
        return false;
    }
    for (size_t i = 0; i < item->num_parts; i++) {
        if ((present >> i & 1) && !skip_simple_item(cursor, &item->parts[i], item->name)) {
            return false;
        }
    }
    return true;
}

/*
 * Skips a random field sequence: items in any order, each behind its place in the profile; compound
 * items cannot occur.
 */
static bool skip_random_field_sequence(struct cursor *cursor,
                                       const struct asterix_category *profile)
{
    size_t start = cursor->at, count = start < cursor->size ? cursor->data[start] : 0;

    cursor->at++;
    for (size_t i = 0; i < count; i++) {
        size_t place = cursor->at < cursor->size ? cursor->data[cursor->at] : 0;
        const struct asterix_item *item =
            place > 0 && place <= profile->num_items ? &profile->items[place - 1] : NULL;

        if (!item || item->form == ASTERIX_NONE || item->form == ASTERIX_ANY) {
            return set_error(cursor, start, "I%03u/RFS has an item at the undefined place %zu",
                             cursor->category, place);
        }
        cursor->at++;
        if (!skip_simple_item(cursor, item, NULL)) {
            return false;
        }
    }
    return start < cursor->size ||
           set_error(cursor, start, "I%03u/RFS goes beyond its data block", cursor->category);
}

static bool skip_item(struct cursor *cursor, const struct asterix_category *profile,
                      const struct asterix_item *item)
{
    switch (item->form) {
    case ASTERIX_COMPOUND:
        return skip_compound_item(cursor, item);
    case ASTERIX_ANY:
        return skip_random_field_sequence(cursor, profile);
    default:
        return skip_simple_item(cursor, item, NULL);
    }
}

/* Whether a record of CAT001 is of a track: the first bit of item 020 chooses the profile. */
static bool is_cat001_track_record(const struct cursor *cursor)
{
    const size_t behind = count_extended_bytes(cursor, 1);

    return cursor->category == ASTERIX_OLD_PLOTS && cursor->size > 0 &&
           (cursor->data[0] >> (BITS - I001_020) & 1) &&
           behind + (cursor->data[0] >> BITS & 1) * 2u < cursor->size &&
           cursor->data[behind + (cursor->data[0] >> BITS & 1) * 2u] >> 7;
}

void asterix_record_complete_source(struct asterix_record *record, bool is_first,
                                    struct asterix_block_source *source)
{
    if (is_first) {
        source->is_given = false;
    }
    if (record->category != ASTERIX_OLD_PLOTS) {
        return;
    }
    if (record->items[0]) { /* I001/010 of plots and of tracks */
        source->is_given = true;
        memcpy(source->item, record->items[0], sizeof source->item);
    } else if (source->is_given) {
        record->items[0] = source->item;
        record->sizes[0] = sizeof source->item;
    }
}

bool asterix_record_read(uint8_t category, const uint8_t *data, size_t size,
                         struct asterix_record *record, struct asterix_error *error)
{
    struct cursor cursor = {.data = data, .size = size, .category = category, .error = error};
    const bool is_track = is_cat001_track_record(&cursor);
    const struct asterix_category *profile = asterix_category_find_profile(category, is_track);
    char name[24];
    uint64_t present = 0;

    if (!profile) {
        return set_error(&cursor, 0, "category %u is not known", category);
    }
    snprintf(name, sizeof name, "a record of CAT%03u", category);
    if (!read_field_specification(&cursor, profile->items, profile->num_items, name, &present)) {
        return false;
    }
    *record = (struct asterix_record){.category = category, .is_track = is_track};
    for (size_t i = 0; i < profile->num_items; i++) {
        const struct asterix_item *item = &profile->items[i];
        size_t start = cursor.at;

        if (!(present >> i & 1)) {
            continue;
        }
        if (!skip_item(&cursor, profile, item)) {
            return false;
        }
        record->items[i] = data + start;
        record->sizes[i] = (uint16_t)(cursor.at - start);
    }
    record->size = cursor.at;
    return true;
}
