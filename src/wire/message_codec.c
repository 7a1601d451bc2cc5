/* SPDX-License-Identifier: MIT */
#include "message_codec.h"

#include <string.h>

#include "rhotrack/types.h"

/* Numbers, big endian */

static uint16_t get16(const uint8_t *from)
{
    return (uint16_t)((unsigned)from[0] << 8 | from[1]);
}

static uint32_t get32(const uint8_t *from)
{
    return (uint32_t)from[0] << 24 | (uint32_t)from[1] << 16 | (uint32_t)from[2] << 8 | from[3];
}

static uint64_t get64(const uint8_t *from)
{
    return (uint64_t)get32(from) << 32 | get32(from + 4);
}

/*
 * Copies members of one width from memory to the wire or back. Both are the same copy: the bytes of
 * a number are reversed on a little-endian machine, and stay in order on a big-endian one.
 */
static void copy_members(uint8_t *to, const uint8_t *from, unsigned width, size_t count)
{
    for (; width == 4 && count > 0; count--, from += 4, to += 4) { /* most are 4 bytes wide */
        const uint32_t v32 = get32(from);
        memcpy(to, &v32, sizeof v32);
    }
    for (; count > 0; count--, from += width, to += width) {
        if (width == 8) {
            const uint64_t v64 = get64(from);
            memcpy(to, &v64, sizeof v64);
        } else if (width == 2) {
            const uint16_t v16 = get16(from);
            memcpy(to, &v16, sizeof v16);
        } else {
            *to = *from;
        }
    }
}

/* Structs */

enum direction { TO_WIRE, FROM_WIRE };

static void copy_struct(enum direction direction, uint8_t *to, const uint8_t *from,
                        const struct message_layout *layout)
{
    const struct message_run *end = layout->runs + layout->num_runs;
    for (const struct message_run *run = layout->runs; run < end; run++) {
        if (direction == TO_WIRE) {
            copy_members(to, from + run->offset, run->width, run->count);
            to += (size_t)run->width * run->count;
        } else {
            copy_members(to + run->offset, from, run->width, run->count);
            from += (size_t)run->width * run->count;
        }
    }
}

static void copy_list(enum direction direction, uint8_t *to, const uint8_t *from,
                      const struct message_format *format, size_t count)
{
    const struct message_layout *element = &format->element;
    if (element->num_runs == 1 && element->wire_bytes == format->element_bytes) { /* one long run */
        copy_members(to, from, element->runs->width, count * element->runs->count);
        return;
    }
    for (; count > 0; count--) {
        copy_struct(direction, to, from, element);
        to += direction == TO_WIRE ? element->wire_bytes : format->element_bytes;
        from += direction == TO_WIRE ? format->element_bytes : element->wire_bytes;
    }
}

/* Number of list elements that a struct states; 0 in a message without a list. */
static int16_t stated_count(const struct message_format *format, const uint8_t *message)
{
    int16_t count = 0;
    if (format->max > 0) {
        memcpy(&count, message + format->count_offset, sizeof count);
    }
    return count;
}

/* Encode */

static size_t head_bytes(const struct message_format *format)
{
    return (size_t)MESSAGE_FINGERPRINT_BYTES + format->head.wire_bytes +
           (format->max > 0 ? MESSAGE_COUNT_BYTES : 0u);
}

static void encode_count(uint8_t *buffer, const struct message_format *format, uint16_t count)
{
    uint8_t *to = buffer + head_bytes(format) - MESSAGE_COUNT_BYTES;
    to[0] = (uint8_t)(count >> 8);
    to[1] = (uint8_t)count;
}

static void encode_head(uint8_t *buffer, const uint8_t *message,
                        const struct message_format *format, uint16_t count)
{
    if (format->max > 0) {
        encode_count(buffer, format, count);
    }
    copy_members(buffer, (const uint8_t *)&format->fingerprint, MESSAGE_FINGERPRINT_BYTES, 1);
    copy_struct(TO_WIRE, buffer + MESSAGE_FINGERPRINT_BYTES, message, &format->head);
}

enum rho_status rho_message_encode(const struct message_format *format, const void *message,
                                   uint8_t *buffer, size_t capacity, size_t *size)
{
    const uint8_t *bytes = message;
    if (!message || !buffer || !size) {
        return RHO_ERROR_NULL;
    }
    const int count = stated_count(format, bytes);
    if (count < 0 || count > format->max) {
        return RHO_ERROR_COUNT;
    }
    const size_t head = head_bytes(format);
    const size_t total = head + (size_t)count * format->element.wire_bytes;
    if (total > capacity) {
        return RHO_ERROR_CAPACITY;
    }
    *size = total;
    encode_head(buffer, bytes, format, (uint16_t)count);
    if (count > 0) {
        copy_list(TO_WIRE, buffer + head, bytes + format->list_offset, format, (size_t)count);
    }
    return RHO_OK;
}

/* Encode piece by piece */

enum rho_status rho_message_begin(const struct message_format *format,
                                  struct rho_message_writer *writer, uint8_t *buffer,
                                  size_t capacity, const void *head)
{
    if (!writer || !buffer || !head) {
        return RHO_ERROR_NULL;
    }
    if (head_bytes(format) > capacity) {
        return RHO_ERROR_CAPACITY;
    }
    encode_head(buffer, head, format, 0);
    *writer = (struct rho_message_writer){.buffer = buffer,
                                          .capacity = capacity,
                                          .size = head_bytes(format),
                                          .fingerprint = format->fingerprint};
    return RHO_OK;
}

enum rho_status rho_message_add(const struct message_format *format,
                                struct rho_message_writer *writer, const void *element)
{
    if (!writer || !element) {
        return RHO_ERROR_NULL;
    }
    if (writer->fingerprint != format->fingerprint) {
        return RHO_ERROR_STATE;
    }
    if (writer->count >= format->max ||
        writer->capacity - writer->size < format->element.wire_bytes) {
        return RHO_ERROR_CAPACITY;
    }
    copy_list(TO_WIRE, writer->buffer + writer->size, element, format, 1);
    writer->size += format->element.wire_bytes;
    writer->count++;
    encode_count(writer->buffer, format, writer->count);
    return RHO_OK;
}

enum rho_status rho_message_end(struct rho_message_writer *writer, size_t *size)
{
    if (!writer || !size) {
        return RHO_ERROR_NULL;
    }
    if (!writer->buffer) {
        return RHO_ERROR_STATE;
    }
    *size = writer->size;
    *writer = (struct rho_message_writer){.buffer = NULL};
    return RHO_OK;
}

/* Decode */

enum rho_status rho_message_decode(const struct message_format *format, const uint8_t *data,
                                   size_t size, void *message)
{
    uint8_t *bytes = message;
    const size_t head = head_bytes(format);
    size_t count = 0;
    if (!data || !message) {
        return RHO_ERROR_NULL;
    }
    /* fingerprint, size and list count are checked before any of it is decoded */
    if (size < MESSAGE_FINGERPRINT_BYTES) {
        return RHO_ERROR_SHORT;
    }
    if (get64(data) != format->fingerprint) {
        return RHO_ERROR_TYPE;
    }
    if (size < head) {
        return RHO_ERROR_SHORT;
    }
    if (format->max > 0) { /* a negative count reads as more than 32767 */
        count = get16(data + head - MESSAGE_COUNT_BYTES);
    }
    if (count > format->max) {
        return RHO_ERROR_COUNT;
    }
    const size_t rest = count * format->element.wire_bytes;
    if (size - head != rest) {
        return size - head < rest ? RHO_ERROR_SHORT : RHO_ERROR_TRAILING;
    }
    copy_struct(FROM_WIRE, bytes, data + MESSAGE_FINGERPRINT_BYTES, &format->head);
    if (format->max > 0) {
        const int16_t stored = (int16_t)count;
        memcpy(bytes + format->count_offset, &stored, sizeof stored);
        copy_list(FROM_WIRE, bytes + format->list_offset, data + head, format, count);
    }
    return RHO_OK;
}

/* Validate */

static int64_t read_native_int(const uint8_t *from, unsigned width)
{
    int8_t v8;
    int16_t v16;
    int32_t v32;
    int64_t v64;
    switch (width) {
    case 1:
        memcpy(&v8, from, sizeof v8);
        return v8;
    case 2:
        memcpy(&v16, from, sizeof v16);
        return v16;
    case 4:
        memcpy(&v32, from, sizeof v32);
        return v32;
    default:
        memcpy(&v64, from, sizeof v64);
        return v64;
    }
}

static int keeps_int_rule(const uint8_t *bytes, const struct message_int_rule *rule,
                          unsigned offset)
{
    const int64_t v = read_native_int(bytes + offset, rule->width);
    switch (rule->kind) {
    case MESSAGE_ONE_OF:
        return v >= 0 && v < 31 && ((uint32_t)rule->max >> v & 1u) != 0;
    case MESSAGE_BELOW:
        return v >= rule->min && v < read_native_int(bytes + rule->max, 2);
    case MESSAGE_TIME:
        return v >= -RHO_LIMIT_TIME_US && v <= RHO_LIMIT_TIME_US;
    case MESSAGE_COUNT:
        return v >= 0;
    default:
        return v >= rule->min && v <= rule->max;
    }
}

#define ALL_GOOD UINT16_MAX

/* Offset of the first integer, or else float, that breaks its rule; ALL_GOOD where none does. */
static uint16_t offset_of_bad_member(const uint8_t *bytes, const struct message_checks *checks)
{
    for (unsigned i = 0; i < checks->num_ints; i++) {
        const struct message_int_rule *rule = &checks->ints[i];
        unsigned offset = rule->offset;
        for (unsigned k = 0; k < rule->count; k++, offset += rule->width) {
            if (!keeps_int_rule(bytes, rule, offset)) {
                return (uint16_t)offset;
            }
        }
    }
    for (unsigned i = 0; i < checks->num_floats; i++) {
        const struct message_float_rule *rule = &checks->floats[i];
        unsigned offset = rule->offset;
        for (unsigned k = 0; k < rule->count; k++, offset += (unsigned)sizeof(float)) {
            float v;
            memcpy(&v, bytes + offset, sizeof v);
            if (!(v >= rule->min && v <= rule->max)) {
                return (uint16_t)offset;
            }
        }
    }
    return ALL_GOOD;
}

enum rho_status rho_message_validate(const struct message_rules *rules, const void *message,
                                     struct rho_message_place *place)
{
    const struct message_format *format = rules->format;
    const uint8_t *bytes = message;
    if (!message) {
        return RHO_ERROR_NULL;
    }
    const int count = stated_count(format, bytes);
    enum rho_status status = RHO_ERROR_VALUE;
    uint16_t bad;
    int element = -1;
    if (count < 0 || count > format->max) {
        status = RHO_ERROR_COUNT;
        bad = format->count_offset;
    } else {
        bad = offset_of_bad_member(bytes, &rules->head);
        while (bad == ALL_GOOD && ++element < count) {
            bad = offset_of_bad_member(bytes + format->list_offset +
                                           (size_t)element * format->element_bytes,
                                       &rules->element);
        }
    }
    if (bad == ALL_GOOD) {
        return RHO_OK;
    }
    if (place) {
        *place = (struct rho_message_place){bad, (int16_t)element};
    }
    return status;
}
