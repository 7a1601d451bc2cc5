/* SPDX-License-Identifier: MIT */
/*
 * Whose datagrams the firmware's node accepts: allowed addresses, and a right code behind the
 * message where a code is required. The code here is a toy, a keyed sum that anybody can forge who
 * has seen two datagrams: a product uses an HMAC instead.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "../../tools/firmware/lcm_datagram_node.h"
#include "rhotrack/message.h"
#include "rhotrack/udpm.h"

#define RADAR UINT32_C(0x0a090001)
#define OTHER_RADAR UINT32_C(0x0a090002)
#define STRANGER UINT32_C(0x0a090042)
#define TOY_BYTES 4u

static const uint32_t toy_key = 0x5eed1234u;
static struct rho_message_status status; /* the newest status message that the node sent */
static int64_t now_us;
static int32_t scans_sent;

static uint32_t toy_keyed_sum(const uint8_t *bytes, size_t size)
{
    uint32_t sum = toy_key;
    for (size_t i = 0; i < size; i++) {
        sum = sum * 31u + bytes[i];
    }
    return sum;
}

static void store_big_endian(uint8_t *to, uint32_t value)
{
    for (unsigned i = 0; i < TOY_BYTES; i++) {
        to[i] = (uint8_t)(value >> (24 - 8 * i));
    }
}

/*
 * The hook that checks a code: the last four bytes of a datagram are the code of the bytes before.
 */
static int check_and_strip_code(void *context, const uint8_t *datagram, size_t *size)
{
    uint8_t code[TOY_BYTES];
    (void)context;
    if (*size < TOY_BYTES) {
        return 0;
    }
    store_big_endian(code, toy_keyed_sum(datagram, *size - TOY_BYTES));
    *size -= TOY_BYTES;
    return memcmp(code, datagram + *size, TOY_BYTES) == 0;
}

/* A faulty hook, which says that the datagram is longer than it was. */
static int lengthen_datagram(void *context, const uint8_t *datagram, size_t *size)
{
    (void)context;
    (void)datagram;
    *size += 1;
    return 1;
}

static void keep_newest_status(void *context, const uint8_t *bytes, size_t size)
{
    struct rho_udpm_datagram datagram;
    (void)context;
    assert_int_equal(rho_udpm_parse(bytes, size, &datagram), RHO_OK);
    if (strcmp(datagram.channel, RHO_MESSAGE_STATUS_CHANNEL) == 0) {
        assert_int_equal(
            rho_message_status_decode(datagram.payload, datagram.payload_size, &status), RHO_OK);
    }
}

static int64_t simulated_clock_us(void *context)
{
    (void)context;
    return now_us;
}

static void start_node(const uint32_t *sources, uint16_t num_sources,
                       int (*hook)(void *context, const uint8_t *datagram, size_t *size))
{
    struct node_config config;
    node_config_default(&config);
    config.hooks.send = keep_newest_status;
    config.hooks.clock_us = simulated_clock_us;
    config.sources = sources;
    config.num_sources = num_sources;
    config.hooks.is_authentic = hook;
    assert_int_equal(node_start(&config), RHO_OK);
    assert_int_equal(node_sender_filter()->refused_source, 0);
}

/* The next scan, without plots, as a datagram with or without a code. Returns its size in bytes. */
static size_t build_empty_scan_datagram(uint8_t *bytes, size_t capacity, int has_code)
{
    static struct rho_message_plot_scan scan;
    size_t head, size;
    scan = (struct rho_message_plot_scan){.utime = now_us,
                                          .scan = scans_sent++,
                                          .epoch = 1,
                                          .sensor_id = 1,
                                          .kind = RHO_MESSAGE_PLOT_SCAN_POSITION_2D,
                                          .num_parts = 1};
    assert_int_equal(rho_udpm_begin(bytes, capacity, 0, RHO_MESSAGE_PLOT_SCAN_CHANNEL "1", &head),
                     RHO_OK);
    assert_int_equal(rho_message_plot_scan_encode(&scan, bytes + head, capacity - head, &size),
                     RHO_OK);
    size += head;
    if (has_code) {
        store_big_endian(bytes + size, toy_keyed_sum(bytes, size));
        size += TOY_BYTES;
    }
    return size;
}

/*
 * How many of ten scans from a source the node accepts. In each datagram the byte flip_at is
 * changed, for SIZE_MAX none.
 */
static int32_t count_scans_accepted_of_ten(uint32_t source, int has_code, size_t flip_at)
{
    uint8_t bytes[RHO_UDPM_MAX_DATAGRAM];
    int32_t before;
    node_step_waiting_scans();
    before = status.scans_accepted;
    for (int i = 0; i < 10; i++) {
        size_t size;
        now_us += 1000000;
        size = build_empty_scan_datagram(bytes, sizeof bytes, has_code);
        if (flip_at < size) {
            bytes[flip_at] ^= 1;
        }
        node_receive(bytes, size, source, now_us);
    }
    node_step_waiting_scans();
    return status.scans_accepted - before;
}

static void without_restrictions_all_senders_are_accepted(void **state)
{
    (void)state;
    start_node(NULL, 0, NULL);
    assert_int_equal(count_scans_accepted_of_ten(RADAR, 0, SIZE_MAX), 10);
    assert_int_equal(count_scans_accepted_of_ten(STRANGER, 0, SIZE_MAX), 10);
    assert_int_equal(node_sender_filter()->refused_source, 0);
    assert_int_equal(node_sender_filter()->refused_mac, 0);
}

static void datagrams_of_unlisted_addresses_are_refused_and_counted(void **state)
{
    const uint32_t sources[] = {RADAR, OTHER_RADAR};
    int32_t refused;
    (void)state;
    start_node(sources, 2, NULL);
    node_step_waiting_scans();
    refused = status.fragments_refused;
    assert_int_equal(count_scans_accepted_of_ten(STRANGER, 0, SIZE_MAX), 0);
    assert_int_equal(node_sender_filter()->refused_source, 10);
    assert_int_equal(status.fragments_refused - refused, 10);
    assert_int_equal(count_scans_accepted_of_ten(RADAR, 0, SIZE_MAX), 10);
    assert_int_equal(count_scans_accepted_of_ten(OTHER_RADAR, 0, SIZE_MAX), 10);
    assert_int_equal(node_sender_filter()->refused_source, 10);
}

/* Each byte of a datagram and of its code is protected: with one changed byte it is refused. */
static void datagrams_without_a_valid_code_are_refused(void **state)
{
    uint8_t bytes[RHO_UDPM_MAX_DATAGRAM];
    const size_t size = build_empty_scan_datagram(bytes, sizeof bytes, 1);
    uint32_t refused = 0;
    (void)state;
    start_node(NULL, 0, check_and_strip_code);
    assert_int_equal(count_scans_accepted_of_ten(STRANGER, 1, SIZE_MAX), 10);
    assert_int_equal(count_scans_accepted_of_ten(RADAR, 0, SIZE_MAX), 0);
    assert_int_equal(node_sender_filter()->refused_mac, refused += 10);
    for (size_t i = 0; i < size; i++) {
        assert_int_equal(count_scans_accepted_of_ten(RADAR, 1, i), 0);
        assert_int_equal(node_sender_filter()->refused_mac, refused += 10);
    }
    for (size_t i = 0; i < TOY_BYTES; i++) {
        node_receive(bytes, i, RADAR, now_us);
        assert_int_equal(node_sender_filter()->refused_mac, ++refused);
    }
    assert_int_equal(node_sender_filter()->refused_source, 0);
}

static void the_address_is_checked_before_the_code(void **state)
{
    const uint32_t source = RADAR;
    (void)state;
    start_node(&source, 1, check_and_strip_code);
    assert_int_equal(count_scans_accepted_of_ten(STRANGER, 1, SIZE_MAX), 0);
    assert_int_equal(node_sender_filter()->refused_source, 10);
    assert_int_equal(node_sender_filter()->refused_mac, 0);
    assert_int_equal(count_scans_accepted_of_ten(RADAR, 1, SIZE_MAX), 10);
}

static void a_hook_cannot_make_a_datagram_longer(void **state)
{
    (void)state;
    start_node(NULL, 0, lengthen_datagram);
    assert_int_equal(count_scans_accepted_of_ten(RADAR, 0, SIZE_MAX), 0);
    assert_int_equal(node_sender_filter()->refused_mac, 10);
}

static void bad_lists_of_allowed_addresses_are_refused(void **state)
{
    static const uint32_t sources[RHO_UDPM_MAX_SOURCES + 1];
    struct node_config config;
    (void)state;
    node_config_default(&config);
    config.hooks.send = keep_newest_status;
    config.hooks.clock_us = simulated_clock_us;
    config.sources = sources;
    config.num_sources = RHO_UDPM_MAX_SOURCES + 1;
    assert_int_equal(node_start(&config), RHO_ERROR_VALUE);
    config.num_sources = 1;
    config.sources = NULL;
    assert_int_equal(node_start(&config), RHO_ERROR_VALUE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_restrictions_all_senders_are_accepted),
        cmocka_unit_test(datagrams_of_unlisted_addresses_are_refused_and_counted),
        cmocka_unit_test(datagrams_without_a_valid_code_are_refused),
        cmocka_unit_test(the_address_is_checked_before_the_code),
        cmocka_unit_test(a_hook_cannot_make_a_datagram_longer),
        cmocka_unit_test(bad_lists_of_allowed_addresses_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
