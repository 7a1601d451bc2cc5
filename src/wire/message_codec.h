/* SPDX-License-Identifier: MIT */
/*
 * message_codec: the form of the generated tables that describe the messages, and the few functions
 * that all messages share. Private to message.
 *
 * A struct is described by runs of members of the same width, one behind the other in memory as on
 * the wire. Tables hold offsets instead of pointers, so that they stay in flash.
 */
#ifndef RHOTRACK_MESSAGE_CODEC_H
#define RHOTRACK_MESSAGE_CODEC_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/message.h"
#include "rhotrack/types.h"

#define MESSAGE_FINGERPRINT_BYTES 8u
#define MESSAGE_COUNT_BYTES 2u

/* Members of one width without a gap between them. */
struct message_run {
    uint16_t offset; /* in the struct, of the first */
    uint8_t width;   /* 1, 2, 4, 8 bytes */
    uint8_t count;
};

/* Floats in a row that must be within the same range; not finite is never within. */
struct message_float_rule {
    uint16_t offset;
    uint16_t count;
    float min, max;
};

enum message_rule_kind {
    MESSAGE_RANGE,  /* min .. max */
    MESSAGE_ONE_OF, /* bit v of max is set; v below 31 */
    MESSAGE_BELOW,  /* min .. less than the int16_t at offset max */
    MESSAGE_TIME,   /* within RHO_LIMIT_TIME_US either way */
    MESSAGE_COUNT   /* 0 or more, of 8 bytes */
};

/* Integers of one width in a row that must keep the same rule; in few bytes, for there are many. */
struct message_int_rule {
    unsigned offset : 16, width : 4, count : 8;
    unsigned kind : 4; /* enum message_rule_kind */
    int32_t min, max;
};

/* A struct, or what comes before a list: its runs, and its bytes on the wire. */
struct message_layout {
    const struct message_run *runs;
    uint16_t num_runs, wire_bytes;
};

/* A message. Without a list its max is 0, and what describes the list means nothing. */
struct message_format {
    uint64_t fingerprint;
    struct message_layout head, element;
    uint16_t count_offset, list_offset, element_bytes; /* in the struct */
    uint16_t max;
};

/* The rules of a struct, or of what comes before a list. */
struct message_checks {
    const struct message_int_rule *ints;
    const struct message_float_rule *floats;
    uint16_t num_ints, num_floats;
};

/*
 * The rules of a message. They are apart from its format, so that firmware which only encodes it
 * does not carry them; nor does it carry the tables of other messages, as each has its own.
 */
struct message_rules {
    const struct message_format *format;
    struct message_checks head, element;
};

/* The common part of message.h's ..._encode, ..._decode, ..._validate, ..._begin and ..._add. */
enum rho_status rho_message_encode(const struct message_format *format, const void *message,
                                   uint8_t *buffer, size_t capacity, size_t *size);
enum rho_status rho_message_decode(const struct message_format *format, const uint8_t *data,
                                   size_t size, void *message);
enum rho_status rho_message_validate(const struct message_rules *rules, const void *message,
                                     struct rho_message_place *place);
enum rho_status rho_message_begin(const struct message_format *format,
                                  struct rho_message_writer *writer, uint8_t *buffer,
                                  size_t capacity, const void *head);
enum rho_status rho_message_add(const struct message_format *format,
                                struct rho_message_writer *writer, const void *element);

#endif
