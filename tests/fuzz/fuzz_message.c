/* SPDX-License-Identifier: MIT */
/*
 * The LCM codec on any bytes. Each input is offered to every decode three times: as it is; with the
 * struct's own fingerprint in front; and with the count, too, that its length makes, so that the
 * fuzzer need not find 8 bytes of fingerprint and a length that fits. Then the input is a struct in
 * memory, for encode, validate and the writer.
 */
#include <stdlib.h>

#include "unit/wire/message_codecs.h"

#define PATTERN 0x5a

static void must(bool holds)
{
    if (!holds) {
        abort();
    }
}

/* Each byte is the one before. */
static bool is_pattern(const uint8_t *bytes, size_t size)
{
    return size == 0 || (bytes[0] == PATTERN && memcmp(bytes, bytes + 1, size - 1) == 0);
}

/* Good or not, it ends with a status of its own, and the place is a member of the struct. */
static void check_validate(size_t type, const void *message)
{
    struct rho_message_place place = {UINT16_MAX, -2};
    const enum rho_status status = codecs[type].validate(message, &place);

    if (status == RHO_OK) {
        return;
    }
    must(status == RHO_ERROR_VALUE || status == RHO_ERROR_COUNT);
    must(place.element >= -1 &&
         place.element < (our_shapes[type].most > 0 ? our_shapes[type].most : 1));
    must(place.offset <
         (place.element < 0 ? our_shapes[type].size : our_shapes[type].element_size));
    must(strlen(codecs[type].field(&place)) > 0);
}

/*
 * Memory of its exact size, so that a step beyond is seen. Refused: untouched. Accepted: the same
 * bytes again.
 */
static void check_decode(size_t type, const uint8_t *data, size_t size)
{
    const struct message_shape *shape = &our_shapes[type];
    uint8_t *message = malloc(shape->size), *again = malloc(size + 1);
    size_t again_size = 0;
    enum rho_status status;

    must(message && again);
    memset(message, PATTERN, shape->size);
    status = codecs[type].decode(data, size, message);
    if (status != RHO_OK) {
        must(status == RHO_ERROR_SHORT || status == RHO_ERROR_TYPE || status == RHO_ERROR_COUNT ||
             status == RHO_ERROR_TRAILING);
        must(is_pattern(message, shape->size));
    } else {
        const int count = message_count(shape, message);
        const size_t used = shape->list_offset + (size_t)count * shape->element_size;

        must(rho_message_type_of(data, size) == (enum rho_message_type)type);
        must(count >= 0 && count <= shape->most);
        must(shape->most == 0 || is_pattern(message + used, shape->size - used));
        must(codecs[type].encode(message, again, size - 1, &again_size) == RHO_ERROR_CAPACITY);
        must(codecs[type].encode(message, again, size, &again_size) == RHO_OK);
        must(again_size == size && memcmp(again, data, size) == 0);
        check_validate(type, message);
    }
    free(again);
    free(message);
}

/* The input with this struct's fingerprint, and the count that its length makes. */
static void check_as(size_t type, const uint8_t *data, size_t size)
{
    const struct message_shape *shape = &our_shapes[type];
    const size_t head =
        codecs[type].max_size - (size_t)shape->most * (shape->most > 0 ? shape->wire_bytes : 0);
    uint8_t *bytes = malloc(size);
    size_t count;

    must(bytes);
    memcpy(bytes, data, size);
    (void)put_bits(bytes, 8, codecs[type].fingerprint);
    check_decode(type, bytes, size);
    if (shape->most > 0 && size >= head) {
        count = (size - head) / shape->wire_bytes;
        (void)put_bits(bytes + head - 2, 2, count);
        check_decode(type, bytes, head + count * shape->wire_bytes);
        if (size > head + count * shape->wire_bytes) {
            check_decode(type, bytes, size);
        }
    }
    free(bytes);
}

/* Any bits as a struct in memory. */
static void check_encode(size_t type, const uint8_t *data, size_t size)
{
    const struct message_shape *shape = &our_shapes[type];
    uint8_t *message = malloc(shape->size), bytes[MESSAGE_BYTES_MAX];
    size_t bytes_size = 0;
    enum rho_status status;

    must(message);
    for (size_t i = 0; i < shape->size; i++) {
        message[i] = data[i % size];
    }
    status = codecs[type].encode(message, bytes, codecs[type].max_size, &bytes_size);
    must(status == RHO_OK || status == RHO_ERROR_COUNT);
    if (status == RHO_OK) {
        must(bytes_size <= codecs[type].max_size);
        check_decode(type, bytes, bytes_size);
    }
    check_validate(type, message);
    free(message);
}

/*
 * A list in a buffer of any size: whole after each element. Room for the head is what begin wants.
 */
static void check_writer(size_t type, const uint8_t *data, size_t size)
{
    const struct message_shape *shape = &our_shapes[type];
    const size_t capacity = (size_t)data[0] * 8 + data[size - 1];
    uint8_t *buffer = malloc(capacity > 0 ? capacity : 1);
    _Alignas(8) uint8_t message[MESSAGE_STRUCT_MAX];
    struct rho_message_writer writer;
    enum rho_status status;
    size_t written = 0;

    must(buffer);
    for (size_t i = 0; i < sizeof message; i++) {
        message[i] = data[i % size];
    }
    status = codecs[type].begin(&writer, buffer, capacity, message);
    must(status == RHO_OK || status == RHO_ERROR_CAPACITY);
    for (int i = 0; status == RHO_OK; i++) {
        must(writer.size <= capacity && i <= shape->most);
        if ((i & (i - 1)) == 0) { /* 0, 1, 2, 4, ...: not all, for the time it takes */
            check_decode(type, buffer, writer.size);
        }
        status = codecs[type].add(&writer, message + (size_t)i % 64 * 8);
    }
    must(status == RHO_ERROR_CAPACITY);
    if (capacity >= codecs[type].max_size - (size_t)shape->most * shape->wire_bytes) {
        check_decode(type, buffer, writer.size);
    }
    must(capacity < codecs[type].max_size ||
         (rho_message_end(&writer, &written) == RHO_OK && written == codecs[type].max_size));
    free(buffer);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const enum rho_message_type type = rho_message_type_of(data, size);

    must(type == RHO_NUM_MESSAGE_TYPES || size >= 8);
    for (size_t i = 0; i < NUM_CODECS; i++) {
        check_decode(i, data, size);
    }
    if (size >= 8) {
        const size_t chosen = type < RHO_NUM_MESSAGE_TYPES ? (size_t)type : data[7] % NUM_CODECS;

        check_as(chosen, data, size);
        check_encode(chosen, data, size);
        if (codecs[chosen].begin) {
            check_writer(chosen, data, size);
        }
    }
    return 0;
}
