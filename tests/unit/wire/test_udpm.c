/* SPDX-License-Identifier: MIT */
/*
 * Datagrams: hand-written bytes, encode and parse, and every way to be refused, from buffers of
 * exactly their size.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/udpm.h"

#define LONGEST 63u

static const uint8_t by_hand[] = {'L',  'C', '0', '2', 0x12, 0x34, 0x56,
                                  0x78, 'A', 'B', 0,   0xca, 0xfe};

/*
 * Parses a copy of exactly that size; pointers in the result are invalid afterwards, numbers are
 * not.
 */
static enum rho_status parse_exact_copy(const uint8_t *data, size_t size,
                                        struct rho_udpm_datagram *datagram)
{
    uint8_t *exact = malloc(size > 0 ? size : 1);
    enum rho_status status;

    assert_non_null(exact);
    memcpy(exact, data, size);
    status = rho_udpm_parse(exact, size, datagram);
    if (status == RHO_OK) {
        assert_ptr_equal(datagram->channel, exact + 8);
        assert_int_equal(
            datagram->channel + strlen(datagram->channel) + 1 - (const char *)datagram->payload, 0);
        assert_ptr_equal(datagram->payload + datagram->payload_size, exact + size);
        assert_true(rho_udpm_is_self_test(datagram) == 0);
    }
    free(exact);
    return status;
}

static void assert_refused(const uint8_t *data, size_t size, enum rho_status status)
{
    struct rho_udpm_datagram datagram, before;

    memset(&datagram, 0x5a, sizeof datagram);
    before = datagram;
    assert_int_equal(parse_exact_copy(data, size, &datagram), status);
    assert_memory_equal(&datagram, &before, sizeof datagram);
}

static void a_header_is_encoded_as_documented_bytes(void **state)
{
    uint8_t buffer[32];
    size_t head = 0;

    (void)state;
    memset(buffer, 0xee, sizeof buffer);
    assert_int_equal(rho_udpm_begin(buffer, sizeof buffer, 0x12345678u, "AB", &head), RHO_OK);
    assert_int_equal(head, 11);
    assert_memory_equal(buffer, by_hand, 11);
    for (size_t i = 11; i < sizeof buffer; i++) {
        assert_int_equal(buffer[i], 0xee);
    }
}

static void a_hand_written_datagram_is_parsed(void **state)
{
    struct rho_udpm_datagram datagram;

    (void)state;
    assert_int_equal(rho_udpm_parse(by_hand, sizeof by_hand, &datagram), RHO_OK);
    assert_int_equal(datagram.sequence, 0x12345678u);
    assert_string_equal(datagram.channel, "AB");
    assert_ptr_equal(datagram.payload, by_hand + 11);
    assert_int_equal(datagram.payload_size, 2);
}

static void names_of_every_length_and_sequences_are_read_back(void **state)
{
    static const uint32_t sequences[] = {0, 1, 0x7fffffffu, 0x80000000u, 0xffffffffu, 0x01020304u};
    char channel[LONGEST + 1] = "";

    (void)state;
    for (size_t length = 1; length <= LONGEST; length++) {
        for (size_t i = 0; i < sizeof sequences / sizeof sequences[0]; i++) {
            uint8_t buffer[RHO_UDPM_MAX_HEAD + 3];
            struct rho_udpm_datagram datagram;
            size_t head = 0;

            memset(channel, 'a' + (int)(length % 26), length);
            channel[length] = '\0';
            assert_int_equal(rho_udpm_begin(buffer, 8 + length + 1, sequences[i], channel, &head),
                             RHO_OK);
            assert_int_equal(head, 8 + length + 1);
            memcpy(buffer + head, "xyz", 3);
            for (size_t payload = 0; payload <= 3; payload++) {
                assert_int_equal(parse_exact_copy(buffer, head + payload, &datagram), RHO_OK);
                assert_int_equal(datagram.sequence, sequences[i]);
                assert_int_equal(datagram.payload_size, payload);
            }
            for (size_t size = 0; size < head; size++) {
                assert_refused(buffer, size, size < 8 ? RHO_ERROR_SHORT : RHO_ERROR_VALUE);
            }
        }
    }
    assert_int_equal(RHO_UDPM_MAX_HEAD, 8 + LONGEST + 1);
}

static void a_header_that_does_not_fit_is_refused(void **state)
{
    uint8_t buffer[16], before[16];
    size_t head = 99;

    (void)state;
    memset(buffer, 0xee, sizeof buffer);
    memcpy(before, buffer, sizeof before);
    for (size_t capacity = 0; capacity < 11; capacity++) {
        assert_int_equal(rho_udpm_begin(buffer, capacity, 1, "AB", &head), RHO_ERROR_CAPACITY);
    }
    assert_int_equal(rho_udpm_begin(NULL, 16, 1, "AB", &head), RHO_ERROR_NULL);
    assert_int_equal(rho_udpm_begin(buffer, 16, 1, NULL, &head), RHO_ERROR_NULL);
    assert_int_equal(rho_udpm_begin(buffer, 16, 1, "AB", NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_udpm_begin(buffer, 16, 1, "", &head), RHO_ERROR_VALUE);
    assert_int_equal(head, 99);
    assert_memory_equal(buffer, before, sizeof buffer);
}

static void a_channel_has_63_characters_at_most(void **state)
{
    /* a name of 64 characters without an end must not be read further */
    char *channel = malloc(LONGEST + 1);
    uint8_t buffer[RHO_UDPM_MAX_HEAD + 8];
    size_t head = 99;

    (void)state;
    assert_non_null(channel);
    memset(channel, 'c', LONGEST + 1);
    assert_int_equal(rho_udpm_begin(buffer, sizeof buffer, 1, channel, &head), RHO_ERROR_VALUE);
    assert_int_equal(head, 99);
    free(channel);
    memcpy(buffer, by_hand, 8);
    memset(buffer + 8, 'c', sizeof buffer - 8);
    for (size_t size = 8; size <= sizeof buffer; size++) {
        assert_refused(buffer, size, RHO_ERROR_VALUE);
    }
    buffer[8 + LONGEST + 1] = '\0'; /* name of 64 characters */
    assert_refused(buffer, sizeof buffer, RHO_ERROR_VALUE);
    buffer[8] = '\0'; /* empty name */
    assert_refused(buffer, sizeof buffer, RHO_ERROR_VALUE);
}

static void a_wrong_magic_number_is_refused(void **state)
{
    uint8_t bytes[sizeof by_hand];

    (void)state;
    for (unsigned bit = 0; bit < 32; bit++) { /* one of the flips gives LC03, a fragment */
        memcpy(bytes, by_hand, sizeof bytes);
        bytes[bit / 8] = (uint8_t)(bytes[bit / 8] ^ 1u << bit % 8);
        assert_refused(bytes, sizeof bytes, RHO_ERROR_TYPE);
        assert_refused(bytes, 8, RHO_ERROR_TYPE);
        assert_refused(bytes, 7, RHO_ERROR_SHORT);
    }
    assert_refused((const uint8_t *)"LC03fragment", 13, RHO_ERROR_TYPE);
}

static void null_pointers_are_refused(void **state)
{
    struct rho_udpm_datagram datagram;

    (void)state;
    assert_int_equal(rho_udpm_parse(NULL, 20, &datagram), RHO_ERROR_NULL);
    assert_int_equal(rho_udpm_parse(by_hand, sizeof by_hand, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_udpm_is_self_test(NULL), 0);
    datagram.channel = NULL;
    assert_int_equal(rho_udpm_is_self_test(&datagram), 0);
}

static void datagrams_need_no_alignment(void **state)
{
    uint8_t buffer[64];

    (void)state;
    for (size_t at = 0; at < 8; at++) {
        struct rho_udpm_datagram datagram;
        size_t head = 0;

        assert_int_equal(rho_udpm_begin(buffer + at, 32, 0x12345678u, "AB", &head), RHO_OK);
        assert_memory_equal(buffer + at, by_hand, 11);
        assert_int_equal(rho_udpm_parse(buffer + at, 20, &datagram), RHO_OK);
        assert_int_equal(datagram.sequence, 0x12345678u);
        assert_int_equal(datagram.payload_size, 9);
    }
}

static void the_self_test_channel_is_known_by_its_exact_name(void **state)
{
    static const char *const others[] = {"LCM_SELF_TES", "LCM_SELF_TEST1", "lcm_self_test", "L",
                                         "RHO_TRACKS"};
    struct rho_udpm_datagram datagram = {.channel = "LCM_SELF_TEST"};

    (void)state;
    assert_int_equal(rho_udpm_is_self_test(&datagram), 1);
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        datagram.channel = others[i];
        assert_int_equal(rho_udpm_is_self_test(&datagram), 0);
    }
}

static void random_bytes_are_parsed_safely(void **state)
{
    uint8_t bytes[100];
    struct rho_udpm_datagram datagram;
    uint32_t seed = 1;
    unsigned good = 0;

    (void)state;
    for (unsigned round = 0; round < 20000; round++) {
        size_t size = 0;

        for (size_t i = 0; i < sizeof bytes; i++) {
            seed = seed * 1664525u + 1013904223u;
            bytes[i] = (uint8_t)(seed >> 24);
        }
        size = bytes[0] % sizeof bytes;
        memcpy(bytes, "LC02", round % 4 > 0 ? 4 : 0);
        good += parse_exact_copy(bytes, size, &datagram) == RHO_OK;
    }
    assert_in_range(good, 1000, 10000);
}

static void only_allowed_addresses_are_admitted(void **state)
{
    static struct rho_udpm_guard guard;

    (void)state;
    assert_true(rho_udpm_admits(&guard, 0) && rho_udpm_admits(&guard, 0x0a090001u));
    assert_int_equal(guard.refused_source, 0);
    guard.num_sources = RHO_UDPM_MAX_SOURCES;
    for (uint32_t i = 0; i < RHO_UDPM_MAX_SOURCES; i++) {
        guard.sources[i] = 0x0a090001u + i;
    }
    for (uint32_t i = 0; i < RHO_UDPM_MAX_SOURCES; i++) {
        assert_true(rho_udpm_admits(&guard, 0x0a090001u + i));
    }
    assert_false(rho_udpm_admits(&guard, 0x0a090000u));
    assert_false(rho_udpm_admits(&guard, 0x0a090001u + RHO_UDPM_MAX_SOURCES));
    assert_false(rho_udpm_admits(&guard, 0));
    assert_int_equal(guard.refused_source, 3);
    guard.refused_source = UINT32_MAX;
    assert_false(rho_udpm_admits(&guard, 0));
    assert_int_equal(guard.refused_source, UINT32_MAX);
    guard.num_sources = RHO_UDPM_MAX_SOURCES + 1;
    assert_false(rho_udpm_admits(&guard, 0x0a090001u));
    assert_false(rho_udpm_admits(NULL, 0x0a090001u));
    assert_int_equal(guard.refused_mac, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_header_is_encoded_as_documented_bytes),
        cmocka_unit_test(a_hand_written_datagram_is_parsed),
        cmocka_unit_test(names_of_every_length_and_sequences_are_read_back),
        cmocka_unit_test(a_header_that_does_not_fit_is_refused),
        cmocka_unit_test(a_channel_has_63_characters_at_most),
        cmocka_unit_test(a_wrong_magic_number_is_refused),
        cmocka_unit_test(null_pointers_are_refused),
        cmocka_unit_test(datagrams_need_no_alignment),
        cmocka_unit_test(the_self_test_channel_is_known_by_its_exact_name),
        cmocka_unit_test(random_bytes_are_parsed_safely),
        cmocka_unit_test(only_allowed_addresses_are_admitted),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
