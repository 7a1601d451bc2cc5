/* SPDX-License-Identifier: MIT */
/*
 * The library's messages as a table, in the order of rho_message_type: shapes, and functions that
 * take any struct.
 */
#ifndef RHOTRACK_TESTS_MESSAGE_CODECS_H
#define RHOTRACK_TESTS_MESSAGE_CODECS_H

#include <float.h>

#include "message_shape.h"
#include "rhotrack/message.h"

#define MESSAGE_STRUCT(s) struct rho_message_##s
#define MESSAGE_HEAD(s, m) offsetof(struct rho_message_##s##_head, m)
#define MESSAGE_TABLE(name) our_##name
#define MESSAGE_LIST_IS_POINTER false
#include "vectors/message_table.h"
#undef MESSAGE_STRUCT
#undef MESSAGE_HEAD
#undef MESSAGE_TABLE
#undef MESSAGE_LIST_IS_POINTER

struct message_codec {
    enum rho_status (*encode)(const void *message, uint8_t *buffer, size_t capacity, size_t *size);
    enum rho_status (*decode)(const uint8_t *data, size_t size, void *message);
    enum rho_status (*validate)(const void *message, struct rho_message_place *place);
    const char *(*field)(const struct rho_message_place *place);
    /* functions of messages that have a list */
    enum rho_status (*begin)(struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
                             const void *head);
    enum rho_status (*add)(struct rho_message_writer *writer, const void *element);
    size_t head_size;
    const char *channel; /* channel as lcm_types/ says */
    const char *our_channel;
    uint64_t fingerprint;
    size_t max_size;
};

#define CODEC(s)                                                                                   \
    static inline enum rho_status s##_encode(const void *message, uint8_t *buffer,                 \
                                             size_t capacity, size_t *size)                        \
    {                                                                                              \
        return rho_message_##s##_encode(message, buffer, capacity, size);                          \
    }                                                                                              \
    static inline enum rho_status s##_decode(const uint8_t *data, size_t size, void *message)      \
    {                                                                                              \
        return rho_message_##s##_decode(data, size, message);                                      \
    }                                                                                              \
    static inline enum rho_status s##_validate(const void *message,                                \
                                               struct rho_message_place *place)                    \
    {                                                                                              \
        return rho_message_##s##_validate(message, place);                                         \
    }
#define CODEC_WITHOUT_LIST(s, S) CODEC(s)
#define CODEC_WITH_LIST(s, S, channel)                                                             \
    CODEC(s)                                                                                       \
    static inline enum rho_status s##_begin(struct rho_message_writer *writer, uint8_t *buffer,    \
                                            size_t capacity, const void *head)                     \
    {                                                                                              \
        return rho_message_##s##_begin(writer, buffer, capacity, head);                            \
    }                                                                                              \
    static inline enum rho_status s##_add(struct rho_message_writer *writer, const void *element)  \
    {                                                                                              \
        return rho_message_##s##_add(writer, element);                                             \
    }
MESSAGES_WITHOUT_LIST(CODEC_WITHOUT_LIST)
MESSAGES_WITH_LIST(CODEC_WITH_LIST)

#define FUNCTIONS(s, S)                                                                            \
    .encode = s##_encode, .decode = s##_decode, .validate = s##_validate,                          \
    .field = rho_message_##s##_field, .fingerprint = RHO_MESSAGE_##S##_FINGERPRINT,                \
    .max_size = RHO_MESSAGE_##S##_MAX_SIZE
#define ROW_WITHOUT_LIST(s, S) {FUNCTIONS(s, S)},
#define ROW_WITH_LIST(s, S, channel_)                                                              \
    {FUNCTIONS(s, S),     .begin = s##_begin,                                                      \
     .add = s##_add,      .head_size = sizeof(struct rho_message_##s##_head),                      \
     .channel = channel_, .our_channel = RHO_MESSAGE_##S##_CHANNEL},
static const struct message_codec codecs[] = {MESSAGES_WITHOUT_LIST(ROW_WITHOUT_LIST)
                                                  MESSAGES_WITH_LIST(ROW_WITH_LIST)};

#define NUM_CODECS (sizeof codecs / sizeof codecs[0])

/* Large enough for any message struct, with guard bytes behind it. */
#define MESSAGE_STRUCT_MAX 2048
#define MESSAGE_PATTERN 0xa5

#endif
