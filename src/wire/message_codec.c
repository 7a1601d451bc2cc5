/* SPDX-License-Identifier: MIT */
#include "message_codec.h"

#include <float.h>
#include <string.h>

#include "rhotrack/types.h"

/* ---- Numbers, big endian ---- */

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

/* ---- Members of one width ---- */

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

/* ---- Structs ---- */

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

static uint8_t *encode_list(uint8_t *to, const uint8_t *list, const struct message_format *format,
                            size_t count)
{
    const struct message_run *run = format->element.runs;

    if (is_list_one_run(format)) {
        return encode_members(to, list, run->width, count * run->count);
    }
    for (size_t i = 0; i < count; i++) {
        to = encode_struct(to, list + i * format->element_bytes, &format->element);
    }
    return to;
}

static void decode_list(const uint8_t *from, uint8_t *list, const struct message_format *format,
                        size_t count)
{
    const struct message_run *run = format->element.runs;

    if (is_list_one_run(format)) {
        (void)decode_members(from, list, run->width, count * run->count);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        from = decode_struct(from, list + i * format->element_bytes, &format->element);
    }
}

static int16_t list_count_of_message_struct(const struct message_format *format,
                                            const uint8_t *message)
{
    int16_t count = 0;

    if (format->max > 0) {
        memcpy(&count, message + format->count_offset, sizeof count);
    }
    return count;
}

/* ---- Encode ---- */

static size_t encoded_head_bytes(const struct message_format *format)
{
    return MESSAGE_FINGERPRINT_BYTES + format->head.wire_bytes +
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
    size_t count, total;
    uint8_t *to;

    if (!message || !buffer || !size) {
        return RHO_ERROR_NULL;
    }
    if (list_count_of_message_struct(format, bytes) < 0 ||
        list_count_of_message_struct(format, bytes) > format->max) {
        return RHO_ERROR_COUNT;
    }
    count = (size_t)list_count_of_message_struct(format, bytes);
    total = encoded_head_bytes(format) + count * format->element.wire_bytes;
    if (total > capacity) {
        return RHO_ERROR_CAPACITY;
    }
    to = encode_head(buffer, bytes, format, (uint16_t)count);
    if (count > 0) {
        (void)encode_list(to, bytes + format->list_offset, format, count);
    }
    *size = total;
    return RHO_OK;
}

/* ---- Encode piece by piece ---- */

enum rho_status rho_message_begin(const struct message_format *format,
                                  struct rho_message_writer *writer, uint8_t *buffer,
                                  size_t capacity, const void *head)
{
    if (!writer || !buffer || !head) {
        return RHO_ERROR_NULL;
    }
    if (encoded_head_bytes(format) > capacity) {
        return RHO_ERROR_CAPACITY;
    }
    (void)encode_head(buffer, head, format, 0);
    *writer = (struct rho_message_writer){.buffer = buffer,
                                          .capacity = capacity,
                                          .size = encoded_head_bytes(format),
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
    (void)encode_list(writer->buffer + writer->size, element, format, 1);
    writer->size += format->element.wire_bytes;
    writer->count++;
    (void)put16(writer->buffer + encoded_head_bytes(format) - MESSAGE_COUNT_BYTES, writer->count);
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

/* ---- Decode ---- */

/* Checks fingerprint, size and list count of an encoded message, before any of it is decoded. */
static enum rho_status check_encoded_bytes(const struct message_format *format, const uint8_t *data,
                                           size_t size, size_t *count)
{
    size_t head = encoded_head_bytes(format), rest;

    *count = 0;
    if (size < MESSAGE_FINGERPRINT_BYTES) {
        return RHO_ERROR_SHORT;
    }
    if (get64(data) != format->fingerprint) {
        return RHO_ERROR_TYPE;
    }
    if (size < head) {
        return RHO_ERROR_SHORT;
    }
    if (format->max > 0) {
        *count = get16(data + head -
                       MESSAGE_COUNT_BYTES); /* a negative count reads as more than 32767 */
    }
    if (*count > format->max) {
        return RHO_ERROR_COUNT;
    }
    rest = *count * format->element.wire_bytes;
    return size - head < rest ? RHO_ERROR_SHORT : size - head > rest ? RHO_ERROR_TRAILING : RHO_OK;
}

enum rho_status rho_message_decode(const struct message_format *format, const uint8_t *data,
                                   size_t size, void *message)
{
    uint8_t *bytes = message;
    enum rho_status status;
    const uint8_t *from;
    int16_t stored;
    size_t count;

    if (!data || !message) {
        return RHO_ERROR_NULL;
    }
    status = check_encoded_bytes(format, data, size, &count);
    if (status != RHO_OK) {
        return status;
    }
    from = decode_struct(data + MESSAGE_FINGERPRINT_BYTES, bytes, &format->head);
    if (format->max > 0) {
        stored = (int16_t)count;
        memcpy(bytes + format->count_offset, &stored, sizeof stored);
        decode_list(from + MESSAGE_COUNT_BYTES, bytes + format->list_offset, format, count);
    }
    return RHO_OK;
}

/* ---- Validate ---- */

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
    int64_t v = read_native_int(bytes + offset, rule->width);

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

/* Offset of the first integer that breaks the rule; ALL_GOOD where none does. */
static uint16_t offset_of_bad_int(const uint8_t *bytes, const struct message_int_rule *rule)
{
    unsigned offset = rule->offset;

    for (unsigned i = 0; i < rule->count; i++, offset += rule->width) {
        if (!keeps_int_rule(bytes, rule, offset)) {
            return (uint16_t)offset;
        }
    }
    return ALL_GOOD;
}

static uint16_t offset_of_bad_float(const uint8_t *bytes, const struct message_float_rule *rule)
{
    float v;

    for (unsigned i = 0; i < rule->count; i++) {
        memcpy(&v, bytes + rule->offset + i * sizeof v, sizeof v);
        if (!(v >= rule->min && v <= rule->max)) {
            return (uint16_t)(rule->offset + i * sizeof v);
        }
    }
    return ALL_GOOD;
}

static uint16_t offset_of_bad_member(const uint8_t *bytes, const struct message_checks *checks)
{
    uint16_t bad = ALL_GOOD;

    for (unsigned i = 0; i < checks->num_ints && bad == ALL_GOOD; i++) {
        bad = offset_of_bad_int(bytes, &checks->ints[i]);
    }
    for (unsigned i = 0; i < checks->num_floats && bad == ALL_GOOD; i++) {
        bad = offset_of_bad_float(bytes, &checks->floats[i]);
    }
    return bad;
}

static enum rho_status set_bad_place(enum rho_status status, struct rho_message_place *place,
                                     uint16_t offset, int element)
{
    if (place) {
        *place = (struct rho_message_place){offset, (int16_t)element};
    }
    return status;
}

enum rho_status rho_message_validate(const struct message_rules *rules, const void *message,
                                     struct rho_message_place *place)
{
    const struct message_format *format = rules->format;
    const uint8_t *bytes = message;
    uint16_t bad;
    int count;

    if (!message) {
        return RHO_ERROR_NULL;
    }
    count = list_count_of_message_struct(format, bytes);
    if (count < 0 || count > format->max) {
        return set_bad_place(RHO_ERROR_COUNT, place, format->count_offset, -1);
    }
    bad = offset_of_bad_member(bytes, &rules->head);
    if (bad != ALL_GOOD) {
        return set_bad_place(RHO_ERROR_VALUE, place, bad, -1);
    }
    for (int i = 0; i < count; i++) {
        bad = offset_of_bad_member(bytes + format->list_offset + (size_t)i * format->element_bytes,
                                   &rules->element);
        if (bad != ALL_GOOD) {
            return set_bad_place(RHO_ERROR_VALUE, place, bad, i);
        }
    }
    return RHO_OK;
}
