/* SPDX-License-Identifier: MIT */
/*
 * The message codec; every test runs over all messages of the table in message_codecs.h, made from
 * lcm_types/ without the codec's generator.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#include "message_codecs.h"
#include "vectors/message_vectors.h"

#define NUM(array) (sizeof(array) / sizeof((array)[0]))
#define GUARD 16 /* guard bytes behind a buffer */
#define RANDOM_MESSAGES 50

struct kit {
    const struct message_shape *shape;
    const struct message_codec *codec;
    size_t type, head_bytes, element_bytes; /* head_bytes on the wire, with fingerprint and count */
    uint64_t state;
    _Alignas(8) char message[MESSAGE_STRUCT_MAX], other[MESSAGE_STRUCT_MAX];
    uint8_t bytes[MESSAGE_BYTES_MAX];
    size_t size;
};

static void init_kit(struct kit *kit, size_t type)
{
    memset(kit, MESSAGE_PATTERN, sizeof *kit);
    kit->shape = &our_shapes[type];
    kit->codec = &codecs[type];
    kit->type = type;
    kit->state = 77 + type;
    fill_with_random_bits(kit->shape, kit->message, 0, &kit->state);
    kit->head_bytes = encode_plainly(kit->shape, 0, kit->message, kit->bytes);
    fill_with_random_bits(kit->shape, kit->message, kit->shape->most > 0, &kit->state);
    kit->element_bytes = encode_plainly(kit->shape, 0, kit->message, kit->bytes) - kit->head_bytes;
}

/* Fills kit->message at random, and kit->bytes with its encoding. */
static void fill_kit_with_random_bits(struct kit *kit, int count)
{
    memset(kit->message, 0, sizeof kit->message);
    fill_with_random_bits(kit->shape, kit->message, count, &kit->state);
    kit->size = encode_plainly(kit->shape, kit->codec->fingerprint, kit->message, kit->bytes);
}

#define FOR_EACH_MESSAGE(kit)                                                                      \
    for (size_t type_ = 0; type_ < NUM_CODECS && (init_kit(&(kit), type_), true); type_++)
#define FOR_EACH_LIST(kit)                                                                         \
    FOR_EACH_MESSAGE(kit)                                                                          \
    if ((kit).shape->most > 0)

static void assert_untouched(const void *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        assert_int_equal(((const uint8_t *)bytes)[i], MESSAGE_PATTERN);
    }
}

/* Decodes from memory that ends with the bytes, so that sanitizers detect reads beyond. */
static enum rho_status decode_from_exact_memory(struct kit *kit, const uint8_t *bytes, size_t size,
                                                void *message)
{
    uint8_t *tight = malloc(size > 0 ? size : 1);
    enum rho_status status;

    assert_non_null(tight);
    memcpy(tight, bytes, size);
    status = kit->codec->decode(size > 0 ? tight : tight + 1, size, message);
    free(tight);
    return status;
}

/* Decoding the bytes is refused, and nothing is written. */
static void assert_decode_refused(struct kit *kit, const uint8_t *bytes, size_t size,
                                  enum rho_status expected)
{
    memset(kit->other, MESSAGE_PATTERN, sizeof kit->other);
    assert_int_equal(decode_from_exact_memory(kit, bytes, size, kit->other), expected);
    assert_untouched(kit->other, sizeof kit->other);
}

/* Names, channels and fingerprints */

static void names_channels_and_fingerprints_follow_lcm_types(void **state)
{
    struct kit kit;

    (void)state;
    assert_int_equal(NUM_CODECS, RHO_NUM_MESSAGE_TYPES);
    FOR_EACH_MESSAGE(kit)
    {
        const enum rho_message_type type = (enum rho_message_type)kit.type;

        assert_string_equal(rho_message_type_name(type), kit.shape->name);
        assert_true(rho_message_fingerprint(type) == kit.codec->fingerprint);
        assert_int_equal(kit.codec->max_size,
                         kit.head_bytes + (size_t)kit.shape->most * kit.element_bytes);
        if (kit.codec->channel) {
            assert_string_equal(kit.codec->channel, kit.codec->our_channel);
        }
    }
    assert_string_equal(RHO_MESSAGE_STATUS_CHANNEL, "RHO_STATUS");
}

static void message_types_out_of_range_have_no_name(void **state)
{
    const int others[] = {-1, RHO_NUM_MESSAGE_TYPES, 255, INT32_MAX, INT32_MIN};

    (void)state;
    for (size_t i = 0; i < NUM(others); i++) {
        assert_string_equal(rho_message_type_name((enum rho_message_type)others[i]), "unknown");
        assert_true(rho_message_fingerprint((enum rho_message_type)others[i]) == 0);
    }
}

static void the_fingerprint_tells_the_message_type(void **state)
{
    struct kit kit;

    (void)state;
    assert_int_equal(rho_message_type_of(NULL, 8), RHO_NUM_MESSAGE_TYPES);
    FOR_EACH_MESSAGE(kit)
    {
        fill_kit_with_random_bits(&kit, kit.shape->most);
        assert_int_equal(rho_message_type_of(kit.bytes, kit.size), kit.type);
        assert_int_equal(rho_message_type_of(kit.bytes, 8), kit.type);
        assert_int_equal(rho_message_type_of(kit.bytes, 7), RHO_NUM_MESSAGE_TYPES);
        assert_int_equal(rho_message_type_of(kit.bytes, 0), RHO_NUM_MESSAGE_TYPES);
        for (unsigned bit = 0; bit < 64; bit++) {
            kit.bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
            assert_int_equal(rho_message_type_of(kit.bytes, kit.size), RHO_NUM_MESSAGE_TYPES);
            kit.bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        }
    }
}

/* Encode and decode */

static void a_plot_is_encoded_as_documented_bytes(void **state)
{
    static const uint8_t expected[] = {
        0x78, 0x8a, 0xd2, 0x6d, 0x74, 0x48, 0xd5, 0x5b, /* fingerprint */
        0xff, 0xff, 0xff, 0xfe,                         /* dt_us -2 */
        0x3f, 0x80, 0x00, 0x00, 0xc0, 0x00, 0x00, 0x00, /* x_m 1, y_m -2 */
        0x3f, 0x00, 0x00, 0x00, 0x42, 0xc8, 0x00, 0x00, /* z_m 0.5, vx_mps 100 */
        0x80, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, /* vy_mps -0, vz_mps 0 */
        0x41, 0x20, 0x00, 0x00, 0x3e, 0x80, 0x00, 0x00, /* sigma_m 10, sigma_mps 0.25 */
        0x41, 0x50, 0x00, 0x00,                         /* snr_db 13 */
    };
    const struct rho_message_plot plot = {.dt_us = -2,
                                          .x_m = 1.0f,
                                          .y_m = -2.0f,
                                          .z_m = 0.5f,
                                          .vx_mps = 100.0f,
                                          .vy_mps = -0.0f,
                                          .sigma_m = 10.0f,
                                          .sigma_mps = 0.25f,
                                          .snr_db = 13.0f};
    uint8_t bytes[RHO_MESSAGE_PLOT_MAX_SIZE];
    size_t size = 0;

    (void)state;
    assert_int_equal(rho_message_plot_encode(&plot, bytes, sizeof bytes, &size), RHO_OK);
    assert_int_equal(size, sizeof expected);
    assert_memory_equal(bytes, expected, sizeof expected);
}

static void members_are_encoded_in_order_big_endian(void **state)
{
    struct kit kit;
    uint8_t bytes[MESSAGE_BYTES_MAX];
    size_t size = 0;

    (void)state;
    FOR_EACH_MESSAGE(kit)
    {
        for (int k = 0; k < RANDOM_MESSAGES; k++) {
            fill_kit_with_random_bits(&kit, draw_count(kit.shape, &kit.state));
            memset(bytes, MESSAGE_PATTERN, sizeof bytes);
            assert_int_equal(kit.codec->encode(kit.message, bytes, sizeof bytes, &size), RHO_OK);
            assert_int_equal(size, kit.size);
            assert_memory_equal(bytes, kit.bytes, size);
            assert_untouched(bytes + size, sizeof bytes - size);
        }
    }
}

/* Decoded bit for bit, whatever the bits; padding of the struct stays untouched. */
static void members_survive_encode_and_decode(void **state)
{
    struct kit kit;

    (void)state;
    FOR_EACH_MESSAGE(kit)
    {
        for (int k = 0; k < RANDOM_MESSAGES; k++) {
            fill_kit_with_random_bits(&kit, draw_count(kit.shape, &kit.state));
            memset(kit.other, MESSAGE_PATTERN, sizeof kit.other);
            assert_int_equal(decode_from_exact_memory(&kit, kit.bytes, kit.size, kit.other),
                             RHO_OK);
            assert_true(are_numbers_equal(kit.shape, kit.message, kit.shape, kit.other));
            for (struct walk w = walk_members(kit.shape, kit.other); walk_to_next(&w);) {
                memset(w.at, MESSAGE_PATTERN,
                       w.member == &kit.shape->counter ? 0 : w.member->width);
            }
            message_set_count(kit.shape, kit.other, 0xa5a5 - 0x10000);
            assert_untouched(kit.other, sizeof kit.other);
        }
    }
}

static void buffers_need_no_alignment(void **state)
{
    struct kit kit;
    uint8_t bytes[MESSAGE_BYTES_MAX + 8];
    size_t size = 0;

    (void)state;
    FOR_EACH_MESSAGE(kit)
    {
        for (size_t shift = 0; shift < 8; shift++) {
            fill_kit_with_random_bits(&kit, kit.shape->most);
            assert_int_equal(
                kit.codec->encode(kit.message, bytes + shift, MESSAGE_BYTES_MAX, &size), RHO_OK);
            assert_memory_equal(bytes + shift, kit.bytes, kit.size);
            assert_int_equal(kit.codec->decode(bytes + shift, size, kit.other), RHO_OK);
            assert_true(are_numbers_equal(kit.shape, kit.message, kit.shape, kit.other));
        }
    }
}

static size_t bytes_of_hex(const char *hex, uint8_t *bytes)
{
    const size_t size = strlen(hex) / 2;

    for (size_t i = 0; i < size; i++) {
        const char pair[3] = {hex[2 * i], hex[2 * i + 1], 0};

        bytes[i] = (uint8_t)strtoul(pair, NULL, 16);
    }
    return size;
}

/* vectors/message_vectors.h holds messages encoded by lcm-gen's C. */
static void messages_of_lcm_gen_are_read_and_written(void **state)
{
    uint8_t theirs[MESSAGE_BYTES_MAX], bytes[MESSAGE_BYTES_MAX];
    struct kit kit;
    size_t size = 0;

    (void)state;
    assert_int_equal(NUM(message_vectors), NUM_CODECS * NUM_GOLDEN);
    for (size_t i = 0; i < NUM(message_vectors); i++) {
        const size_t their_size = bytes_of_hex(message_vectors[i].hex, theirs);

        init_kit(&kit, i / NUM_GOLDEN);
        assert_string_equal(message_vectors[i].name, kit.shape->name);
        fill_golden(kit.shape, kit.message, message_vectors[i].golden);
        assert_int_equal(kit.codec->encode(kit.message, bytes, sizeof bytes, &size), RHO_OK);
        assert_int_equal(size, their_size);
        assert_memory_equal(bytes, theirs, size);
        assert_int_equal(rho_message_type_of(theirs, their_size), kit.type);
        assert_int_equal(decode_from_exact_memory(&kit, theirs, their_size, kit.other), RHO_OK);
        assert_true(are_numbers_equal(kit.shape, kit.message, kit.shape, kit.other));
        if (message_vectors[i].golden == GOLDEN_TYPICAL ||
            message_vectors[i].golden == GOLDEN_FULL) {
            assert_int_equal(kit.codec->validate(kit.other, NULL), RHO_OK);
        }
    }
}

/* What decode refuses */

static void decoding_null_pointers_is_refused(void **state)
{
    struct kit kit;

    (void)state;
    FOR_EACH_MESSAGE(kit)
    {
        fill_kit_with_random_bits(&kit, kit.shape->most);
        assert_int_equal(kit.codec->decode(NULL, kit.size, kit.other), RHO_ERROR_NULL);
        assert_int_equal(kit.codec->decode(NULL, 0, kit.other), RHO_ERROR_NULL);
        assert_int_equal(kit.codec->decode(kit.bytes, kit.size, NULL), RHO_ERROR_NULL);
        assert_untouched(kit.other, sizeof kit.other);
    }
}

static void truncated_messages_are_refused(void **state)
{
    struct kit kit;

    (void)state;
    FOR_EACH_MESSAGE(kit)
    {
        for (int count = 0; count <= kit.shape->most;
             count += kit.shape->most > 2 ? kit.shape->most / 2 : 1) {
            fill_kit_with_random_bits(&kit, count);
            for (size_t size = 0; size < kit.size; size++) {
                assert_decode_refused(&kit, kit.bytes, size, RHO_ERROR_SHORT);
            }
        }
    }
}

static void extra_bytes_behind_a_message_are_refused(void **state)
{
    struct kit kit;
    uint8_t bytes[3 * MESSAGE_BYTES_MAX] = {0};
    const size_t more[] = {1, 2, 4, 8, 36, MESSAGE_BYTES_MAX};

    (void)state;
    FOR_EACH_MESSAGE(kit)
    {
        for (int count = 0; count <= kit.shape->most; count++) {
            fill_kit_with_random_bits(&kit, count);
            memcpy(bytes, kit.bytes, kit.size);
            for (size_t i = 0; i < NUM(more); i++) {
                assert_decode_refused(&kit, bytes, kit.size + more[i], RHO_ERROR_TRAILING);
            }
        }
    }
}

static void a_wrong_fingerprint_is_refused(void **state)
{
    struct kit kit;

    (void)state;
    FOR_EACH_MESSAGE(kit)
    {
        fill_kit_with_random_bits(&kit, kit.shape->most);
        for (unsigned bit = 0; bit < 64; bit++) {
            kit.bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
            assert_decode_refused(&kit, kit.bytes, kit.size, RHO_ERROR_TYPE);
            assert_decode_refused(&kit, kit.bytes, 8, RHO_ERROR_TYPE);
            kit.bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        }
        for (size_t i = 0; i < NUM_CODECS; i++) {
            (void)put_big_endian(kit.bytes, 8, codecs[i].fingerprint);
            if (i != kit.type) {
                assert_decode_refused(&kit, kit.bytes, kit.size, RHO_ERROR_TYPE);
            }
        }
    }
}

/*
 * With the bytes of the right count, one too few or one too many elements: only the count is
 * refused.
 */
static void counts_beyond_the_list_are_refused_by_decode(void **state)
{
    static uint8_t bytes[65536 * 64];
    struct kit kit;

    (void)state;
    FOR_EACH_LIST(kit)
    {
        const int bad[] = {kit.shape->most + 1,
                           kit.shape->most + 2,
                           255 + kit.shape->most,
                           256 + kit.shape->most,
                           32766,
                           32767,
                           32768,
                           65535,
                           65536 - kit.shape->most};

        fill_kit_with_random_bits(&kit, kit.shape->most);
        memcpy(bytes, kit.bytes, kit.size);
        for (size_t i = 0; i < NUM(bad); i++) {
            const size_t size = kit.head_bytes + (size_t)bad[i] * kit.element_bytes;

            (void)put_big_endian(bytes + kit.head_bytes - 2, 2, (uint64_t)bad[i]);
            if (size < sizeof bytes) {
                assert_decode_refused(&kit, bytes, size, RHO_ERROR_COUNT);
                assert_decode_refused(&kit, bytes, size - 1, RHO_ERROR_COUNT);
                assert_decode_refused(&kit, bytes, size + 1, RHO_ERROR_COUNT);
            }
            assert_decode_refused(&kit, bytes, kit.head_bytes, RHO_ERROR_COUNT);
            assert_decode_refused(&kit, bytes, kit.size, RHO_ERROR_COUNT);
        }
    }
}

/* What encode refuses */

/* A refused encode writes neither bytes nor the size. */
static void assert_not_encoded(struct kit *kit, size_t capacity, enum rho_status expected)
{
    uint8_t bytes[MESSAGE_BYTES_MAX];
    size_t size = 12345;

    memset(bytes, MESSAGE_PATTERN, sizeof bytes);
    assert_int_equal(kit->codec->encode(kit->message, bytes, capacity, &size), expected);
    assert_untouched(bytes, sizeof bytes);
    assert_int_equal(size, 12345);
}

static void encode_refuses_null_pointers(void **state)
{
    struct kit kit;
    uint8_t bytes[MESSAGE_BYTES_MAX];
    size_t size = 12345;

    (void)state;
    FOR_EACH_MESSAGE(kit)
    {
        memset(bytes, MESSAGE_PATTERN, sizeof bytes);
        fill_kit_with_random_bits(&kit, kit.shape->most);
        assert_int_equal(kit.codec->encode(NULL, bytes, sizeof bytes, &size), RHO_ERROR_NULL);
        assert_int_equal(kit.codec->encode(kit.message, NULL, sizeof bytes, &size), RHO_ERROR_NULL);
        assert_int_equal(kit.codec->encode(kit.message, bytes, sizeof bytes, NULL), RHO_ERROR_NULL);
        assert_untouched(bytes, sizeof bytes);
        assert_int_equal(size, 12345);
    }
}

static void encode_refuses_every_too_small_buffer(void **state)
{
    struct kit kit;
    uint8_t bytes[MESSAGE_BYTES_MAX];
    size_t size = 0;

    (void)state;
    FOR_EACH_MESSAGE(kit)
    {
        fill_kit_with_random_bits(&kit, kit.shape->most);
        for (size_t capacity = 0; capacity < kit.size; capacity++) {
            assert_not_encoded(&kit, capacity, RHO_ERROR_CAPACITY);
        }
        memset(bytes, MESSAGE_PATTERN, sizeof bytes);
        assert_int_equal(kit.codec->encode(kit.message, bytes, kit.size, &size), RHO_OK);
        assert_untouched(bytes + size, GUARD);
    }
}

static void encode_and_validate_refuse_counts_beyond_the_list(void **state)
{
    struct kit kit;

    (void)state;
    FOR_EACH_LIST(kit)
    {
        const int bad[] = {-1,     kit.shape->most + 1, 256 + kit.shape->most, 32767,
                           -32768, -kit.shape->most};

        fill_kit_with_random_bits(&kit, kit.shape->most);
        fill_with_valid_numbers(kit.shape, kit.message, kit.shape->most, &kit.state);
        for (size_t i = 0; i < NUM(bad); i++) {
            struct rho_message_place place = {9999, 99};

            message_set_count(kit.shape, kit.message, bad[i]);
            assert_not_encoded(&kit, MESSAGE_BYTES_MAX, RHO_ERROR_COUNT);
            assert_not_encoded(&kit, 0, RHO_ERROR_COUNT);
            assert_int_equal(kit.codec->validate(kit.message, NULL), RHO_ERROR_COUNT);
            assert_int_equal(kit.codec->validate(kit.message, &place), RHO_ERROR_COUNT);
            assert_int_equal(place.element, -1);
            assert_string_equal(kit.codec->field(&place), kit.shape->counter.name);
        }
    }
}

/* Rules of values */

struct value_case {
    uint64_t bits;
    bool is_good;
};

static uint64_t float_bits(float v)
{
    return load_bits(&v, 4);
}

static size_t edge_cases_of_float(const struct message_member *member, struct value_case *cases)
{
    const struct value_case all[] = {
        {float_bits(member->low), true},
        {float_bits(member->high), true},
        {float_bits(nextafterf(member->low, member->high)), true},
        {float_bits(nextafterf(member->high, member->low)), true},
        {float_bits(nextafterf(member->low, -INFINITY)), false},
        {float_bits(nextafterf(member->high, INFINITY)), false},
        {0x80000000, true}, /* -0 */
        {0x7f800000, false},
        {0xff800000, false},
        {0x7fc00000, false},
        {0xffc00000, false},
        {0x7f800001, false},
        {0xffffffff, false},
    };

    memcpy(cases, all, sizeof all);
    return NUM(all);
}

static size_t edge_cases_of_integer(const struct message_member *member, int64_t other,
                                    struct value_case *cases)
{
    const int64_t top = (int64_t)(UINT64_MAX >> (65 - 8 * member->width)), bottom = -top - 1;
    const int64_t min = member->rule == MEMBER_BELOW   ? 0
                        : member->rule == MEMBER_RANGE ? member->min
                                                       : bottom;
    const int64_t max = member->rule == MEMBER_BELOW   ? other - 1
                        : member->rule == MEMBER_RANGE ? member->max
                                                       : top;
    const int64_t tried[] = {
        min, max, bottom, top, min > bottom ? min - 1 : min, max < top ? max + 1 : max};
    size_t count = 0;

    if (member->rule == MEMBER_ONE_OF) {
        for (int v = -128; v < 128; v++) {
            bool is_good = false;

            for (int i = 0; i < member->num_choices; i++) {
                is_good = is_good || v == member->choices[i];
            }
            cases[count++] = (struct value_case){(uint64_t)(int64_t)v, is_good};
        }
        return count;
    }
    for (size_t i = 0; i < NUM(tried); i++) {
        cases[count++] =
            (struct value_case){(uint64_t)tried[i], tried[i] >= min && tried[i] <= max};
    }
    return count;
}

/* Offset that validate reports for this number. */
static size_t offset_of_member(struct kit *kit, const struct walk *w)
{
    const char *from =
        w->element < 0 ? kit->message : message_element(kit->shape, kit->message, w->element);

    return (size_t)(w->at - from);
}

/* Checks one number of a valid message at the limits of its rule and just beyond. */
static void check_number_at_its_limits(struct kit *kit, const struct walk *w)
{
    struct value_case cases[256];
    const uint64_t before = load_bits(w->at, w->member->width);
    const int64_t other = (int16_t)load_bits(kit->message + w->member->other, 2);
    const size_t num_cases = w->member->is_float ? edge_cases_of_float(w->member, cases)
                                                 : edge_cases_of_integer(w->member, other, cases);
    const size_t offset = offset_of_member(kit, w);

    for (size_t i = 0; i < num_cases; i++) {
        struct rho_message_place place = {9999, 99};

        store_bits(w->at, w->member->width, cases[i].bits);
        if (cases[i].is_good) {
            assert_int_equal(kit->codec->validate(kit->message, &place), RHO_OK);
            continue;
        }
        assert_int_equal(kit->codec->validate(kit->message, NULL), RHO_ERROR_VALUE);
        assert_int_equal(kit->codec->validate(kit->message, &place), RHO_ERROR_VALUE);
        assert_int_equal(place.element, w->element);
        assert_int_equal(place.offset, offset);
        assert_string_equal(kit->codec->field(&place), w->member->name);
    }
    store_bits(w->at, w->member->width, before);
}

static void validate_checks_the_limits_of_each_number(void **state)
{
    struct kit kit;

    (void)state;
    FOR_EACH_MESSAGE(kit)
    {
        fill_with_valid_numbers(kit.shape, kit.message, kit.shape->most, &kit.state);
        for (struct walk w = walk_members(kit.shape, kit.message); walk_to_next(&w);) {
            if (w.member->rule == MEMBER_BELOW) {
                check_number_at_its_limits(&kit, &w);
                store_bits(w.at, w.member->width, 0); /* num_parts is then below its minimum of 1 */
            } else if (w.member != &kit.shape->counter) {
                check_number_at_its_limits(&kit, &w);
            }
        }
    }
}

static void validate_accepts_and_keeps_valid_messages(void **state)
{
    struct kit kit;

    (void)state;
    FOR_EACH_MESSAGE(kit)
    {
        for (int k = 0; k < RANDOM_MESSAGES; k++) {
            /* list elements behind the count are invalid, and must not be checked */
            memset(kit.message, 0x7f, sizeof kit.message);
            fill_with_valid_numbers(kit.shape, kit.message, draw_count(kit.shape, &kit.state),
                                    &kit.state);
            memcpy(kit.other, kit.message, sizeof kit.message);
            assert_int_equal(kit.codec->validate(kit.message, NULL), RHO_OK);
            assert_memory_equal(kit.other, kit.message, sizeof kit.message);
        }
    }
}

static void validate_and_name_refuse_null_pointers(void **state)
{
    struct kit kit;
    struct rho_message_place place = {9999, 99};

    (void)state;
    FOR_EACH_MESSAGE(kit)
    {
        assert_int_equal(kit.codec->validate(NULL, NULL), RHO_ERROR_NULL);
        assert_int_equal(kit.codec->validate(NULL, &place), RHO_ERROR_NULL);
        assert_string_equal(kit.codec->field(NULL), "unknown");
    }
}

/* Every member has its name, members without a rule, too. */
static void every_field_has_its_name(void **state)
{
    struct kit kit;

    (void)state;
    FOR_EACH_MESSAGE(kit)
    {
        fill_with_random_bits(kit.shape, kit.message, kit.shape->most, &kit.state);
        for (struct walk w = walk_members(kit.shape, kit.message); walk_to_next(&w);) {
            const struct rho_message_place place = {(uint16_t)offset_of_member(&kit, &w),
                                                    (int16_t)w.element};

            assert_string_equal(kit.codec->field(&place), w.member->name);
        }
    }
}

/* The writer of lists */

/* Copies the members before the list into the head struct. */
static void copy_head_members(const struct kit *kit, char *head)
{
    memset(head, 0, MESSAGE_STRUCT_MAX);
    for (size_t i = 0; i < kit->shape->num_members; i++) {
        const struct message_member *member = &kit->shape->members[i];

        memcpy(head + member->head_offset, kit->message + member->offset, member->width);
    }
}

/* The buffer holds the message with so many elements, and nothing behind it was touched. */
static void assert_buffer_holds_message(struct kit *kit, const uint8_t *buffer, int count)
{
    size_t size;

    message_set_count(kit->shape, kit->message, count);
    size = encode_plainly(kit->shape, kit->codec->fingerprint, kit->message, kit->bytes);
    assert_memory_equal(buffer, kit->bytes, size);
    assert_untouched(buffer + size, MESSAGE_BYTES_MAX - size);
}

static void a_message_is_complete_after_each_added_element(void **state)
{
    _Alignas(8) char head[MESSAGE_STRUCT_MAX];
    uint8_t buffer[MESSAGE_BYTES_MAX];
    struct rho_message_writer writer;
    struct kit kit;
    size_t size = 0;

    (void)state;
    FOR_EACH_LIST(kit)
    {
        memset(buffer, MESSAGE_PATTERN, sizeof buffer);
        fill_kit_with_random_bits(&kit, kit.shape->most);
        copy_head_members(&kit, head);
        assert_int_equal(kit.codec->begin(&writer, buffer, sizeof buffer, head), RHO_OK);
        for (int i = 0; i < kit.shape->most; i++) {
            assert_buffer_holds_message(&kit, buffer, i);
            message_set_count(kit.shape, kit.message, kit.shape->most);
            assert_int_equal(kit.codec->add(&writer, message_element(kit.shape, kit.message, i)),
                             RHO_OK);
        }
        assert_buffer_holds_message(&kit, buffer, kit.shape->most);
        assert_int_equal(kit.codec->add(&writer, message_element(kit.shape, kit.message, 0)),
                         RHO_ERROR_CAPACITY);
        assert_buffer_holds_message(&kit, buffer, kit.shape->most);
        assert_int_equal(rho_message_end(&writer, &size), RHO_OK);
        assert_int_equal(size, kit.codec->max_size);
        assert_int_equal(rho_message_end(&writer, &size), RHO_ERROR_STATE);
        assert_int_equal(kit.codec->add(&writer, message_element(kit.shape, kit.message, 0)),
                         RHO_ERROR_STATE);
        assert_buffer_holds_message(&kit, buffer, kit.shape->most);
    }
}

/* Capacities for k elements, and one byte less than for k + 1. */
static void a_full_buffer_takes_no_more_elements(void **state)
{
    _Alignas(8) char head[MESSAGE_STRUCT_MAX];
    uint8_t buffer[MESSAGE_BYTES_MAX];
    struct rho_message_writer writer;
    struct kit kit;
    size_t size = 0;

    (void)state;
    FOR_EACH_LIST(kit)
    {
        fill_kit_with_random_bits(&kit, kit.shape->most);
        copy_head_members(&kit, head);
        for (int k = 0; k < 4; k++) {
            for (size_t more = 0; more < kit.element_bytes; more += kit.element_bytes - 1) {
                memset(buffer, MESSAGE_PATTERN, sizeof buffer);
                size = kit.head_bytes + (size_t)k * kit.element_bytes;
                assert_int_equal(kit.codec->begin(&writer, buffer, size + more, head), RHO_OK);
                for (int i = 0; i < k; i++) {
                    assert_int_equal(
                        kit.codec->add(&writer, message_element(kit.shape, kit.message, i)),
                        RHO_OK);
                }
                assert_int_equal(
                    kit.codec->add(&writer, message_element(kit.shape, kit.message, k)),
                    RHO_ERROR_CAPACITY);
                assert_buffer_holds_message(&kit, buffer, k);
                message_set_count(kit.shape, kit.message, kit.shape->most);
                assert_int_equal(rho_message_end(&writer, &size), RHO_OK);
                assert_int_equal(size, kit.head_bytes + (size_t)k * kit.element_bytes);
            }
        }
    }
}

static void a_refused_begin_writes_nothing(void **state)
{
    _Alignas(8) char head[MESSAGE_STRUCT_MAX];
    uint8_t buffer[MESSAGE_BYTES_MAX];
    struct rho_message_writer writer;
    struct kit kit;

    (void)state;
    FOR_EACH_LIST(kit)
    {
        memset(buffer, MESSAGE_PATTERN, sizeof buffer);
        memset(&writer, MESSAGE_PATTERN, sizeof writer);
        fill_kit_with_random_bits(&kit, 0);
        copy_head_members(&kit, head);
        for (size_t capacity = 0; capacity < kit.head_bytes; capacity++) {
            assert_int_equal(kit.codec->begin(&writer, buffer, capacity, head), RHO_ERROR_CAPACITY);
        }
        assert_int_equal(kit.codec->begin(NULL, buffer, sizeof buffer, head), RHO_ERROR_NULL);
        assert_int_equal(kit.codec->begin(&writer, NULL, sizeof buffer, head), RHO_ERROR_NULL);
        assert_int_equal(kit.codec->begin(&writer, buffer, sizeof buffer, NULL), RHO_ERROR_NULL);
        assert_untouched(buffer, sizeof buffer);
        assert_untouched(&writer, sizeof writer);
    }
}

static void a_writer_not_begun_takes_no_element(void **state)
{
    struct rho_message_writer writer = {.buffer = NULL};
    struct kit kit;
    size_t size = 12345;

    (void)state;
    FOR_EACH_LIST(kit)
    {
        assert_int_equal(kit.codec->add(&writer, kit.message), RHO_ERROR_STATE);
        assert_int_equal(kit.codec->add(NULL, kit.message), RHO_ERROR_NULL);
        assert_int_equal(kit.codec->add(&writer, NULL), RHO_ERROR_NULL);
    }
    assert_int_equal(rho_message_end(&writer, &size), RHO_ERROR_STATE);
    assert_int_equal(rho_message_end(NULL, &size), RHO_ERROR_NULL);
    assert_int_equal(rho_message_end(&writer, NULL), RHO_ERROR_NULL);
    assert_int_equal(size, 12345);
}

/* Each list is begun, and elements of every other message are offered. */
static void elements_of_another_message_are_refused(void **state)
{
    _Alignas(8) char head[MESSAGE_STRUCT_MAX];
    uint8_t buffer[MESSAGE_BYTES_MAX];
    struct rho_message_writer writer;
    struct kit kit;
    size_t size = 0;

    (void)state;
    FOR_EACH_LIST(kit)
    {
        memset(buffer, MESSAGE_PATTERN, sizeof buffer);
        fill_kit_with_random_bits(&kit, 1);
        copy_head_members(&kit, head);
        assert_int_equal(kit.codec->begin(&writer, buffer, sizeof buffer, head), RHO_OK);
        assert_int_equal(kit.codec->add(&writer, message_element(kit.shape, kit.message, 0)),
                         RHO_OK);
        for (size_t i = 0; i < NUM_CODECS; i++) {
            if (codecs[i].add && i != kit.type) {
                assert_int_equal(codecs[i].add(&writer, kit.message), RHO_ERROR_STATE);
            }
        }
        assert_buffer_holds_message(&kit, buffer, 1);
        assert_int_equal(rho_message_end(&writer, &size), RHO_OK);
        assert_int_equal(size, kit.size);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_channels_and_fingerprints_follow_lcm_types),
        cmocka_unit_test(message_types_out_of_range_have_no_name),
        cmocka_unit_test(the_fingerprint_tells_the_message_type),
        cmocka_unit_test(a_plot_is_encoded_as_documented_bytes),
        cmocka_unit_test(members_are_encoded_in_order_big_endian),
        cmocka_unit_test(members_survive_encode_and_decode),
        cmocka_unit_test(buffers_need_no_alignment),
        cmocka_unit_test(messages_of_lcm_gen_are_read_and_written),
        cmocka_unit_test(decoding_null_pointers_is_refused),
        cmocka_unit_test(truncated_messages_are_refused),
        cmocka_unit_test(extra_bytes_behind_a_message_are_refused),
        cmocka_unit_test(a_wrong_fingerprint_is_refused),
        cmocka_unit_test(counts_beyond_the_list_are_refused_by_decode),
        cmocka_unit_test(encode_refuses_null_pointers),
        cmocka_unit_test(encode_refuses_every_too_small_buffer),
        cmocka_unit_test(encode_and_validate_refuse_counts_beyond_the_list),
        cmocka_unit_test(validate_checks_the_limits_of_each_number),
        cmocka_unit_test(validate_accepts_and_keeps_valid_messages),
        cmocka_unit_test(validate_and_name_refuse_null_pointers),
        cmocka_unit_test(every_field_has_its_name),
        cmocka_unit_test(a_message_is_complete_after_each_added_element),
        cmocka_unit_test(a_full_buffer_takes_no_more_elements),
        cmocka_unit_test(a_refused_begin_writes_nothing),
        cmocka_unit_test(a_writer_not_begun_takes_no_element),
        cmocka_unit_test(elements_of_another_message_are_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
