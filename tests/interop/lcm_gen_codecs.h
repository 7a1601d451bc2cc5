/* SPDX-License-Identifier: MIT */
/*
 * The library's messages by the C that lcm-gen makes from lcm_types/: shapes and functions that
 * take any struct.
 */
#ifndef RHOTRACK_TESTS_LCM_GEN_CODECS_H
#define RHOTRACK_TESTS_LCM_GEN_CODECS_H

#include <float.h>
#include <stdlib.h>

#include "lcm_gen.h" /* includes all generated headers; written by build.sh */
#include "unit/wire/message_shape.h"

#define MESSAGE_STRUCT(s) rhotrack_##s##_t
#define MESSAGE_HEAD(s, m) 0
#define MESSAGE_TABLE(name) their_##name
#define MESSAGE_LIST_IS_POINTER true
#include "vectors/message_table.h"
#undef MESSAGE_STRUCT
#undef MESSAGE_HEAD
#undef MESSAGE_TABLE
#undef MESSAGE_LIST_IS_POINTER

struct lcm_gen_codec {
    int (*encode)(void *buffer, int capacity, const void *message);
    int (*decode)(const void *data, int size, void *message); /* allocates the list's memory */
    void (*cleanup)(void *message);
};

#define LCM_GEN(s)                                                                                 \
    static int their_##s##_encode(void *buffer, int capacity, const void *message)                 \
    {                                                                                              \
        return rhotrack_##s##_t_encode(buffer, 0, capacity, message);                              \
    }                                                                                              \
    static int their_##s##_decode(const void *data, int size, void *message)                       \
    {                                                                                              \
        return rhotrack_##s##_t_decode(data, 0, size, message);                                    \
    }                                                                                              \
    static void their_##s##_cleanup(void *message)                                                 \
    {                                                                                              \
        (void)rhotrack_##s##_t_decode_cleanup(message);                                            \
    }
#define LCM_GEN_WITHOUT_LIST(s, S) LCM_GEN(s)
#define LCM_GEN_WITH_LIST(s, S, channel) LCM_GEN(s)
MESSAGES_WITHOUT_LIST(LCM_GEN_WITHOUT_LIST)
MESSAGES_WITH_LIST(LCM_GEN_WITH_LIST)

#define ROW_OF(s) {their_##s##_encode, their_##s##_decode, their_##s##_cleanup},
#define ROW_OF_WITHOUT_LIST(s, S) ROW_OF(s)
#define ROW_OF_WITH_LIST(s, S, channel) ROW_OF(s)
static const struct lcm_gen_codec their_codecs[] = {MESSAGES_WITHOUT_LIST(ROW_OF_WITHOUT_LIST)
                                                        MESSAGES_WITH_LIST(ROW_OF_WITH_LIST)};

/* Points the list of a struct to memory for its longest list. */
static inline void set_list_memory(const struct message_shape *shape, void *message, void *memory)
{
    if (shape->most > 0) {
        memcpy((char *)message + shape->list_offset, &memory, sizeof memory);
    }
}

#endif
