/* SPDX-License-Identifier: MIT */
#include "message_codec.h"

#include <string.h>

#include "rhotrack/types.h"

/* Numbers, big endian */

static uint8_t *put16(uint8_t *to, uint16_t v)
{
    to[0] = (uint8_t)(v >> 8);
    to[1] = (uint8_t)v;
    return to + 2;
}

static uint8_t *put32(uint8_t *to, uint32_t v)
{
    to[0] = (uint8_t)(v >> 24);
    to[1] = (uint8_t)(v >> 16);
    to[2] = (uint8_t)(v >> 8);
    to[3] = (uint8_t)v;
    return to + 4;
}

static uint8_t *put64(uint8_t *to, uint64_t v)
{
    return put32(put32(to, (uint32_t)(v >> 32)), (uint32_t)v);
}

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

/* Members of one width */

static uint8_t *encode_members(uint8_t *to, const uint8_t *from, unsigned width, size_t count)
{
    uint16_t v16;
    uint32_t v32;
    uint64_t v64;
    if (width == 4) { /* most members are 4 bytes wide */
        for (size_t i = 0; i < count; i++) {
            memcpy(&v32, from + 4 * i, sizeof v32);
            to = put32(to, v32);
        }
        return to;
    }
    for (size_t i = 0; i < count; i++, from += width) {
        if (width == 8) {
            memcpy(&v64, from, sizeof v64);
            to = put64(to, v64);
        } else if (width == 2) {
            memcpy(&v16, from, sizeof v16);
            to = put16(to, v16);
        } else {
            *to++ = *from;
        }
    }
    return to;
}

static const uint8_t *decode_members(const uint8_t *from, uint8_t *to, unsigned width, size_t count)
{
    uint16_t v16;
    uint32_t v32;
    uint64_t v64;
    if (width == 4) {
        for (size_t i = 0; i < count; i++) {
            v32 = get32(from + 4 * i);
            memcpy(to + 4 * i, &v32, sizeof v32);
        }
        return from + 4 * count;
    }
    for (size_t i = 0; i < count; i++, from += width, to += width) {
        if (width == 8) {
            v64 = get64(from);
            memcpy(to, &v64, sizeof v64);
        } else if (width == 2) {
            v16 = get16(from);
            memcpy(to, &v16, sizeof v16);
        } else {
            *to = *from;
        }
    }
    return from;
}

/* Structs */

static uint8_t *encode_struct(uint8_t *to, const uint8_t *from, const struct message_layout *layout)
{
    const struct message_run *run = layout->runs;
    for (unsigned i = 0; i < layout->num_runs; i++, run++) {
        to = encode_members(to, from + run->offset, run->width, run->count);
    }
    return to;
}

static const uint8_t *decode_struct(const uint8_t *from, uint8_t *to,
                                    const struct message_layout *layout)
{
    const struct message_run *run = layout->runs;
    for (unsigned i = 0; i < layout->num_runs; i++, run++) {
        from = decode_members(from, to + run->offset, run->width, run->count);
    }
    return from;
}

/* 1 where each list element is one run without gaps, so that the whole list is one long run. */
static int is_list_one_run(const struct message_format *format)
{
    return format->element.num_runs == 1 && format->element.wire_bytes == format->element_bytes;
}

static void encode_list(uint8_t *to, const uint8_t *list, const struct message_format *format,
                        size_t count)
{
    const struct message_run *run = format->element.runs;
    if (is_list_one_run(format)) {
        (void)encode_members(to, list, run->width, count * run->count);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        to = encode_struct(to, list + i * format->element_bytes, &format->element);
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

static uint8_t *encode_head(uint8_t *to, const uint8_t *message,
                            const struct message_format *format, uint16_t count)
{
    to = encode_struct(put64(to, format->fingerprint), message, &format->head);
    return format->max > 0 ? put16(to, count) : to;
}

enum rho_status rho_message_encode(const struct message_format *format, const void *message,
                                   uint8_t *buffer, size_t capacity, size_t *size)
{
    const uint8_t *bytes = message;
    if (!message || !buffer || !size) {
        return RHO_ERROR_NULL;
    }
    if (stated_count(format, bytes) < 0 || stated_count(format, bytes) > format->max) {
        return RHO_ERROR_COUNT;
    }
    const size_t count = (size_t)stated_count(format, bytes);
    const size_t total = head_bytes(format) + count * format->element.wire_bytes;
    if (total > capacity) {
        return RHO_ERROR_CAPACITY;
    }
    uint8_t *to = encode_head(buffer, bytes, format, (uint16_t)count);
    if (count > 0) {
        encode_list(to, bytes + format->list_offset, format, count);
    }
    *size = total;
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
    (void)encode_head(buffer, head, format, 0);
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
    encode_list(writer->buffer + writer->size, element, format, 1);
    writer->size += format->element.wire_bytes;
    writer->count++;
    (void)put16(writer->buffer + head_bytes(format) - MESSAGE_COUNT_BYTES, writer->count);
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
    const uint8_t *from = decode_struct(data + MESSAGE_FINGERPRINT_BYTES, bytes, &format->head);
    if (format->max > 0) {
        const int16_t stored = (int16_t)count;
        const struct message_run *run = format->element.runs;
        uint8_t *list = bytes + format->list_offset;
        memcpy(bytes + format->count_offset, &stored, sizeof stored);
        from += MESSAGE_COUNT_BYTES;
        if (is_list_one_run(format)) {
            (void)decode_members(from, list, run->width, count * run->count);
            return RHO_OK;
        }
        for (size_t i = 0; i < count; i++) {
            from = decode_struct(from, list + i * format->element_bytes, &format->element);
        }
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
