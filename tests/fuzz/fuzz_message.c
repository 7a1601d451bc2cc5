/* SPDX-License-Identifier: MIT */
/*
 * The LCM codec on any bytes. Each input is decoded as every message three times: as it is; behind
 * the struct's own fingerprint; and also with the element count that its length makes, so that the
 * fuzzer need not guess 8 bytes of fingerprint and a matching length. Then the input serves as a
 * struct in memory for encode, validate and the writer.
 */
#include <stdlib.h>

#include "unit/wire/message_codecs.h"

#define PATTERN 0x5a

static void abort_unless(bool holds)
{
    if (!holds) {
        abort();
    }
}

/* Whether all bytes have the fill value of untouched memory. */
static bool is_pattern(const uint8_t *bytes, size_t size)
{
    return size == 0 || (bytes[0] == PATTERN && memcmp(bytes, bytes + 1, size - 1) == 0);
}

/* validate returns a status of its own, and the place it names is a member of the struct. */
static void check_validate_names_a_member(size_t type, const void *message)
{
    struct rho_message_place place = {UINT16_MAX, -2};
    const enum rho_status status = codecs[type].validate(message, &place);

    if (status == RHO_OK) {
        return;
    }
    abort_unless(status == RHO_ERROR_VALUE || status == RHO_ERROR_COUNT);
    abort_unless(place.element >= -1 &&
                 place.element < (our_shapes[type].most > 0 ? our_shapes[type].most : 1));
    abort_unless(place.offset <
                 (place.element < 0 ? our_shapes[type].size : our_shapes[type].element_size));
    abort_unless(strlen(codecs[type].field(&place)) > 0);
}

/*
 * Decodes memory of exactly the message's size, so that reads beyond it are seen. A refused message
 * leaves the struct untouched; an accepted one encodes to the same bytes.
 */
static void check_decode(size_t type, const uint8_t *data, size_t size)
{
    const struct message_shape *shape = &our_shapes[type];
    uint8_t *message = malloc(shape->size), *again = malloc(size + 1);
    size_t again_size = 0;
    enum rho_status status;

    abort_unless(message && again);
    memset(message, PATTERN, shape->size);
    status = codecs[type].decode(data, size, message);
    if (status != RHO_OK) {
        abort_unless(status == RHO_ERROR_SHORT || status == RHO_ERROR_TYPE ||
                     status == RHO_ERROR_COUNT || status == RHO_ERROR_TRAILING);
        abort_unless(is_pattern(message, shape->size));
    } else {
        const int count = message_count(shape, message);
        const size_t used = shape->list_offset + (size_t)count * shape->element_size;

        abort_unless(rho_message_type_of(data, size) == (enum rho_message_type)type);
        abort_unless(count >= 0 && count <= shape->most);
        abort_unless(shape->most == 0 || is_pattern(message + used, shape->size - used));
        abort_unless(codecs[type].encode(message, again, size - 1, &again_size) ==
                     RHO_ERROR_CAPACITY);
        abort_unless(codecs[type].encode(message, again, size, &again_size) == RHO_OK);
        abort_unless(again_size == size && memcmp(again, data, size) == 0);
        check_validate_names_a_member(type, message);
    }
    free(again);
    free(message);
}

/* Decodes the input behind this struct's fingerprint, with the count that its length makes. */
static void check_decode_with_own_fingerprint(size_t type, const uint8_t *data, size_t size)
{
    const struct message_shape *shape = &our_shapes[type];
    const size_t head =
        codecs[type].max_size - (size_t)shape->most * (shape->most > 0 ? shape->wire_bytes : 0);
    uint8_t *bytes = malloc(size);
    size_t count;

    abort_unless(bytes);
    memcpy(bytes, data, size);
    (void)put_big_endian(bytes, 8, codecs[type].fingerprint);
    check_decode(type, bytes, size);
    if (shape->most > 0 && size >= head) {
        count = (size - head) / shape->wire_bytes;
        (void)put_big_endian(bytes + head - 2, 2, count);
        check_decode(type, bytes, head + count * shape->wire_bytes);
        if (size > head + count * shape->wire_bytes) {
            check_decode(type, bytes, size);
        }
    }
    free(bytes);
}

/* Encodes any bits as a struct in memory. */
static void check_encode_any_struct(size_t type, const uint8_t *data, size_t size)
{
    const struct message_shape *shape = &our_shapes[type];
    uint8_t *message = malloc(shape->size), bytes[MESSAGE_BYTES_MAX];
    size_t bytes_size = 0;
    enum rho_status status;

    abort_unless(message);
    for (size_t i = 0; i < shape->size; i++) {
        message[i] = data[i % size];
    }
    status = codecs[type].encode(message, bytes, codecs[type].max_size, &bytes_size);
    abort_unless(status == RHO_OK || status == RHO_ERROR_COUNT);
    if (status == RHO_OK) {
        abort_unless(bytes_size <= codecs[type].max_size);
        check_decode(type, bytes, bytes_size);
    }
    check_validate_names_a_member(type, message);
    free(message);
}

/*
 * Writes a list into a buffer of any size: the message is complete after each element; begin needs
 * room for the head only.
 */
static void check_writer_in_any_buffer(size_t type, const uint8_t *data, size_t size)
{
    const struct message_shape *shape = &our_shapes[type];
    const size_t capacity = (size_t)data[0] * 8 + data[size - 1];
    uint8_t *buffer = malloc(capacity > 0 ? capacity : 1);
    _Alignas(8) uint8_t message[MESSAGE_STRUCT_MAX];
    struct rho_message_writer writer;
    enum rho_status status;
    size_t written = 0;

    abort_unless(buffer);
    for (size_t i = 0; i < sizeof message; i++) {
        message[i] = data[i % size];
    }
    status = codecs[type].begin(&writer, buffer, capacity, message);
    abort_unless(status == RHO_OK || status == RHO_ERROR_CAPACITY);
    for (int i = 0; status == RHO_OK; i++) {
        abort_unless(writer.size <= capacity && i <= shape->most);
        if ((i & (i - 1)) == 0) { /* only at 1, 2, 4, 8 .. elements, to save time */
            check_decode(type, buffer, writer.size);
        }
        status = codecs[type].add(&writer, message + (size_t)i % 64 * 8);
    }
    abort_unless(status == RHO_ERROR_CAPACITY);
    if (capacity >= codecs[type].max_size - (size_t)shape->most * shape->wire_bytes) {
        check_decode(type, buffer, writer.size);
    }
    abort_unless(
        capacity < codecs[type].max_size ||
        (rho_message_end(&writer, &written) == RHO_OK && written == codecs[type].max_size));
    free(buffer);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const enum rho_message_type type = rho_message_type_of(data, size);

    abort_unless(type == RHO_NUM_MESSAGE_TYPES || size >= 8);
    for (size_t i = 0; i < NUM_CODECS; i++) {
        check_decode(i, data, size);
    }
    if (size >= 8) {
        const size_t chosen = type < RHO_NUM_MESSAGE_TYPES ? (size_t)type : data[7] % NUM_CODECS;

        check_decode_with_own_fingerprint(chosen, data, size);
        check_encode_any_struct(chosen, data, size);
        if (codecs[chosen].begin) {
            check_writer_in_any_buffer(chosen, data, size);
        }
    }
    return 0;
}
