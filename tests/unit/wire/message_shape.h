/* SPDX-License-Identifier: MIT */
/*
 * Messages described as lists of numbers, whatever their C type: to fill, compare and encode them
 * in the plainest way. The tables (vectors/message_table.h) are made from lcm_types/ without the
 * codec's generator. The code handles the library's structs and those of lcm-gen, which hold a
 * pointer to their list.
 */
#ifndef RHOTRACK_TESTS_MESSAGE_SHAPE_H
#define RHOTRACK_TESTS_MESSAGE_SHAPE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

enum member_rule { MEMBER_ANY, MEMBER_RANGE, MEMBER_ONE_OF, MEMBER_BELOW };

struct message_member {
    const char *name;
    size_t offset, head_offset; /* head_offset: in the struct of members before the list */
    unsigned width, count;
    enum member_rule rule;
    int64_t min, max;
    size_t other; /* for BELOW: offset of the int16_t that it must stay below */
    int choices[8], num_choices;
    bool is_float;
    float low, high;
};

struct message_shape {
    const char *name;
    const struct message_member *members; /* before the list's count, or all members */
    size_t num_members, size;
    struct message_member counter;
    size_t list_offset;
    const struct message_member *element_members;
    /* wire_bytes: encoded size of an element */
    size_t num_element_members, element_size, wire_bytes;
    int most; /* largest number of elements; 0: no list */
    bool list_is_pointer;
};

#define MESSAGE_BYTES_MAX 1472 /* more than the longest message */

/* Bits of a number, in memory and on the wire */

static inline uint64_t load_bits(const void *at, unsigned width_bytes)
{
    uint8_t v8;
    uint16_t v16;
    uint32_t v32;
    uint64_t v64;

    switch (width_bytes) {
    case 1:
        memcpy(&v8, at, 1);
        return v8;
    case 2:
        memcpy(&v16, at, 2);
        return v16;
    case 4:
        memcpy(&v32, at, 4);
        return v32;
    default:
        memcpy(&v64, at, 8);
        return v64;
    }
}

static inline void store_bits(void *at, unsigned width, uint64_t bits)
{
    const uint8_t v8 = (uint8_t)(bits & 0xff);
    const uint16_t v16 = (uint16_t)(bits & 0xffff);
    const uint32_t v32 = (uint32_t)(bits & 0xffffffff);
    const void *const from[] = {[1] = &v8, [2] = &v16, [4] = &v32, [8] = &bits};

    memcpy(at, from[width], width);
}

static inline uint8_t *put_big_endian(uint8_t *to, unsigned width, uint64_t bits)
{
    for (unsigned i = width; i > 0; i--) {
        *to++ = (uint8_t)(bits >> 8 * (i - 1) & 0xff);
    }
    return to;
}

/* Parts of a message */

static inline int16_t message_count(const struct message_shape *shape, const void *message)
{
    int16_t count = 0;

    if (shape->most > 0) {
        memcpy(&count, (const char *)message + shape->counter.offset, sizeof count);
    }
    return count;
}

static inline void message_set_count(const struct message_shape *shape, void *message, int count)
{
    const int16_t stored = (int16_t)count;

    if (shape->most > 0) {
        memcpy((char *)message + shape->counter.offset, &stored, sizeof stored);
    }
}

static inline char *message_element(const struct message_shape *shape, void *message, int element)
{
    char *list = (char *)message + shape->list_offset;

    if (shape->list_is_pointer) {
        memcpy(&list, (const void *)list, sizeof list);
    }
    return list + (size_t)element * shape->element_size;
}

/*
 * All numbers of a message in wire order, including the list's count. Use: for (struct walk w =
 * walk_members(shape, message); walk_to_next(&w);), then w.member, w.at, w.element.
 */
struct walk {
    const struct message_shape *shape;
    char *message;
    const struct message_member *member;
    char *at;
    int element; /* -1: before the list */
    size_t next_member;
    unsigned next_index; /* in an array member */
};

static inline struct walk walk_members(const struct message_shape *shape, void *message)
{
    return (struct walk){.shape = shape, .message = message, .element = -1};
}

static inline bool walk_to_next(struct walk *w)
{
    const struct message_shape *shape = w->shape;

    if (w->next_member == (w->element < 0 ? shape->num_members : shape->num_element_members)) {
        if (w->element < 0 && w->member != &shape->counter && shape->most > 0) {
            w->member = &shape->counter;
            w->at = w->message + shape->counter.offset;
            return true;
        }
        if (w->element + 1 >= message_count(shape, w->message) || w->element + 1 >= shape->most) {
            return false;
        }
        w->element++;
        w->next_member = 0;
    }
    w->member = &(w->element < 0 ? shape->members : shape->element_members)[w->next_member];
    w->at = (w->element < 0 ? w->message : message_element(shape, w->message, w->element)) +
            w->member->offset + (size_t)w->next_index * w->member->width;
    if (++w->next_index == w->member->count) {
        w->next_index = 0;
        w->next_member++;
    }
    return true;
}

/* Encoding as the specification of LCM says */

static inline size_t encode_plainly(const struct message_shape *shape, uint64_t fingerprint,
                                    void *message, uint8_t *bytes)
{
    uint8_t *to = put_big_endian(bytes, 8, fingerprint);

    for (struct walk w = walk_members(shape, message); walk_to_next(&w);) {
        to = put_big_endian(to, w.member->width, load_bits(w.at, w.member->width));
    }
    return (size_t)(to - bytes);
}

/* Whether two messages hold the same numbers, bit for bit. */
static inline bool are_numbers_equal(const struct message_shape *shape, void *message,
                                     const struct message_shape *other_shape, void *other)
{
    struct walk a = walk_members(shape, message), b = walk_members(other_shape, other);

    while (walk_to_next(&a)) {
        if (!walk_to_next(&b) || strcmp(a.member->name, b.member->name) != 0 ||
            load_bits(a.at, a.member->width) != load_bits(b.at, b.member->width)) {
            return false;
        }
    }
    return !walk_to_next(&b);
}

/* Random contents */

/* random bits by splitmix64 */
static inline uint64_t draw_bits(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);

    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

/* Number of elements of a random list: none, all, or any number. */
static inline int draw_count(const struct message_shape *shape, uint64_t *state)
{
    const uint64_t kind = draw_bits(state) % 8;

    return kind == 0   ? 0
           : kind == 1 ? shape->most
                       : (int)(draw_bits(state) % (uint64_t)(shape->most + 1));
}

/* Random bits in all numbers, and a list of this count. */
static inline void fill_with_random_bits(const struct message_shape *shape, void *message,
                                         int count, uint64_t *state)
{
    message_set_count(shape, message, count);
    for (struct walk w = walk_members(shape, message); walk_to_next(&w);) {
        if (w.member != &shape->counter) {
            store_bits(w.at, w.member->width, draw_bits(state));
        }
    }
}

/* A random number that its rule allows. Members that bound others are set to about 30000 later. */
static inline void fill_valid_number(const struct message_member *member, char *at, uint64_t *state)
{
    const uint64_t bits = draw_bits(state);

    if (member->is_float) {
        const float share = (float)(bits >> 40) * 0x1p-24f;
        const float v = member->low * (1.0f - share) + member->high * share;

        memcpy(at, &v, sizeof v);
    } else if (member->rule == MEMBER_ONE_OF) {
        store_bits(at, member->width,
                   (uint64_t)(int64_t)member->choices[bits % (uint64_t)member->num_choices]);
    } else if (member->rule == MEMBER_BELOW) {
        store_bits(at, member->width, bits % 20000);
    } else if (member->rule == MEMBER_RANGE) {
        const uint64_t span = (uint64_t)member->max - (uint64_t)member->min;

        store_bits(at, member->width, (uint64_t)member->min + bits % (span + 1));
    } else {
        store_bits(at, member->width, bits);
    }
}

static inline void fill_with_valid_numbers(const struct message_shape *shape, void *message,
                                           int count, uint64_t *state)
{
    message_set_count(shape, message, count);
    for (struct walk w = walk_members(shape, message); walk_to_next(&w);) {
        if (w.member != &shape->counter) {
            fill_valid_number(w.member, w.at, state);
        }
    }
    for (struct walk w = walk_members(shape, message); walk_to_next(&w);) {
        if (w.member->rule == MEMBER_BELOW) {
            store_bits(w.message + w.member->other, 2, 20000 + draw_bits(state) % 12767);
        }
    }
}

/* The messages of the golden vectors */

enum golden { GOLDEN_EMPTY, GOLDEN_TYPICAL, GOLDEN_FULL, GOLDEN_EXTREME, NUM_GOLDEN };

/* Extreme numbers, among them NaN with a payload and subnormals. */
static inline uint64_t extreme_bits(const struct message_member *member, unsigned index)
{
    static const uint32_t floats[] = {0x80000000, 0x7f7fffff, 0xff7fffff, 0x00000001,
                                      0x7f800000, 0xff800000, 0x7fc12345, 0x807fffff};
    const uint64_t sign = UINT64_C(1) << (8 * member->width - 1);
    const uint64_t ints[] = {sign, sign - 1, 0, 2 * sign - 1};

    return member->is_float ? floats[index % 8] : ints[index % 4];
}

/* Fills in one of four contents. Typical numbers rise from member to member and are valid. */
static inline void fill_golden(const struct message_shape *shape, void *message, enum golden golden)
{
    const int counts[NUM_GOLDEN] = {0, shape->most < 2 ? shape->most : 2, shape->most,
                                    shape->most < 3 ? shape->most : 3};
    unsigned index = 0;

    message_set_count(shape, message, counts[golden]);
    for (struct walk w = walk_members(shape, message); walk_to_next(&w); index++) {
        const float v = 0.001953125f * (float)(1 + index % 512); /* below 1 and exact in binary */

        if (w.member == &shape->counter) {
            continue;
        }
        if (golden == GOLDEN_EMPTY) {
            store_bits(w.at, w.member->width, 0);
        } else if (golden == GOLDEN_EXTREME) {
            store_bits(w.at, w.member->width, extreme_bits(w.member, index));
        } else if (w.member->is_float) {
            memcpy(w.at, w.member->high < 1.0f ? (const void *)&(float){0.25f * v} : &v, sizeof v);
        } else if (w.member->rule == MEMBER_ONE_OF) {
            store_bits(w.at, w.member->width, (uint64_t)(int64_t)w.member->choices[0]);
        } else {
            store_bits(w.at, w.member->width,
                       w.member->rule == MEMBER_RANGE && w.member->max == 1 ? 1 : 1 + index);
        }
    }
}

#endif
