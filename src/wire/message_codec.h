/* SPDX-License-Identifier: MIT */
/*
 * message_codec: encodes, decodes and validates messages by the generated tables of message_types.c
 * that describe them. Private to src/wire.
 *
 * A struct is described by runs: members of the same width that follow each other in memory as they
 * do on the wire. Tables hold offsets instead of pointers, so that they stay in flash.
 */
#ifndef RHOTRACK_MESSAGE_CODEC_H
#define RHOTRACK_MESSAGE_CODEC_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/message.h"
#include "rhotrack/types.h"

/* Bytes on the wire before a message's members, and before its list. */
enum { MESSAGE_FINGERPRINT_BYTES = 8, MESSAGE_COUNT_BYTES = 2 };

/* Members of one width without a gap between them. */
struct message_run {
    uint16_t offset; /* of the first member in the struct, bytes */
    uint8_t width;   /* 1, 2, 4, 8 bytes */
    uint8_t count;
};

/* Successive floats that must be within one range, which NaN never is. */
struct message_float_rule {
    uint16_t offset;
    uint16_t count;
    float min, max;
};

enum message_rule_kind {
    MESSAGE_RANGE,  /* the value is in min .. max */
    MESSAGE_ONE_OF, /* the value is 0 .. 30, and the bit of that number is set in max */
    MESSAGE_BELOW,  /* min or more, and less than the int16_t member at offset max */
    MESSAGE_TIME,   /* a time in -RHO_LIMIT_TIME_US .. RHO_LIMIT_TIME_US */
    MESSAGE_COUNT   /* a count of 8 bytes: 0 or more */
};

/* Successive integers of one width that must keep one rule; bit fields save flash. */
struct message_int_rule {
    unsigned offset : 16, width : 4, count : 8;
    unsigned kind : 4; /* enum message_rule_kind */
    int32_t min, max;
};

/* Layout of a struct, or of a message's head before its list: runs, and bytes on the wire. */
struct message_layout {
    const struct message_run *runs;
    uint16_t num_runs, wire_bytes;
};

/* Format of a message. In one without a list max is 0, and the list's other fields are unused. */
struct message_format {
    uint64_t fingerprint;
    struct message_layout head, element;
    uint16_t count_offset, list_offset, element_bytes; /* in the struct */
    uint16_t max;                                      /* elements that the list may hold */
};

/* Value rules of a list element, or of a message's head before its list. */
struct message_checks {
    const struct message_int_rule *ints;
    const struct message_float_rule *floats;
    uint16_t num_ints, num_floats;
};

/*
 * Value rules of a message. They are apart from its format, so that firmware which only encodes the
 * message does not link them; nor does it link the tables of other messages, as each has its own.
 */
struct message_rules {
    const struct message_format *format;
    struct message_checks head, element;
};

/* The functions of message.h call these with the tables of their message. */
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
