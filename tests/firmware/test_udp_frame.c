/* SPDX-License-Identifier: MIT */
/*
 * Ethernet frames of the firmware example, compared with one of liblcm's, and frames that it has to
 * refuse.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "../../tools/firmware/board/udp_frame.h"

#define PAYLOAD_MAX (UDP_FRAME_MAX - UDP_FRAME_HEAD)

static const struct udp_frame_host host = {.mac = {2, 0x52, 0x48, 0x4f, 0, 1},
                                           .address = {10, 9, 0, 100}};

/*
 * A frame of liblcm 1.5.3 that sends "hi" on channel A from 10.9.0.1 with TTL 1; with the checksum
 * that a network card fills in.
 */
static const uint8_t of_liblcm[] = {
    0x01, 0x00, 0x5e, 0x7f, 0x4c, 0x43, 0x16, 0xb6, 0x2b, 0x9c, 0x92, 0x43, 0x08, 0x00,
    0x45, 0x00, 0x00, 0x28, 0x67, 0xba, 0x40, 0x00, 0x01, 0x11, 0xcb, 0xbe, 0x0a, 0x09,
    0x00, 0x01, 0xef, 0xff, 0x4c, 0x43, 0xab, 0x50, 0x1d, 0xf3, 0x00, 0x14, 0xca, 0x56,
    0x4c, 0x43, 0x30, 0x32, 0x00, 0x00, 0x00, 0x00, 0x41, 0x00, 0x68, 0x69};

#define AT_TYPE 12
#define AT_VERSION 14
#define AT_LENGTH 16
#define AT_FRAGMENT 20
#define AT_PROTOCOL 23
#define AT_IP_CHECKSUM 24
#define AT_GROUP 33
#define AT_PORT 37
#define AT_UDP_LENGTH 39
#define AT_UDP_CHECKSUM 40

static uint8_t frame[UDP_FRAME_MAX];
static const uint8_t *payload;

static size_t parse_frame(size_t size)
{
    payload = NULL;
    return udp_frame_find_payload(frame, size, &payload);
}

static void set_frame_of_liblcm(void)
{
    memcpy(frame, of_liblcm, sizeof of_liblcm);
}

/* Changes one byte of the IP head and corrects its checksum. */
static void change_ip_head_byte(unsigned at, uint8_t value)
{
    uint32_t sum = 0;
    frame[at] = value;
    frame[AT_IP_CHECKSUM] = frame[AT_IP_CHECKSUM + 1] = 0;
    for (unsigned i = 14; i < 34; i += 2) {
        sum += (uint32_t)frame[i] << 8 | frame[i + 1];
    }
    sum = ~((sum & 0xffff) + (sum >> 16));
    frame[AT_IP_CHECKSUM] = (uint8_t)(sum >> 8);
    frame[AT_IP_CHECKSUM + 1] = (uint8_t)sum;
}

static void a_frame_of_liblcm_is_accepted(void **state)
{
    (void)state;
    set_frame_of_liblcm();
    assert_int_equal(parse_frame(sizeof of_liblcm), 12);
    assert_ptr_equal(payload, frame + UDP_FRAME_HEAD);
    assert_memory_equal(payload, "LC02\0\0\0\0A\0hi", 12);
    assert_int_equal(udp_frame_source_ipv4(frame), 0x0a090001);
    frame[AT_UDP_CHECKSUM] = frame[AT_UDP_CHECKSUM + 1] = 0; /* 0: sent without a checksum */
    assert_int_equal(parse_frame(sizeof of_liblcm), 12);
    memset(frame + sizeof of_liblcm, 0xee, 6); /* short frames are padded */
    assert_int_equal(parse_frame(sizeof of_liblcm + 6), 12);
}

static void a_built_frame_equals_that_of_liblcm(void **state)
{
    const struct udp_frame_host there = {.mac = {0x16, 0xb6, 0x2b, 0x9c, 0x92, 0x43},
                                         .address = {10, 9, 0, 1}};
    (void)state;
    memset(frame, 0xee, sizeof frame);
    memcpy(frame + UDP_FRAME_HEAD, of_liblcm + UDP_FRAME_HEAD, 12);
    assert_int_equal(udp_frame_build_around_payload(frame, &there, 0x67ba, 12), sizeof of_liblcm);
    /* compares all but the source port and the checksum over it */
    assert_memory_equal(frame, of_liblcm, 34);
    assert_memory_equal(frame + 36, of_liblcm + 36, 4);
    assert_memory_equal(frame + UDP_FRAME_HEAD, of_liblcm + UDP_FRAME_HEAD, 12);
}

static void built_frames_of_every_size_are_accepted(void **state)
{
    uint32_t random = 1;
    (void)state;
    for (size_t size = 1; size <= PAYLOAD_MAX; size += 1 + size / 7) {
        for (size_t i = 0; i < size; i++) {
            random = random * 1664525u + 1013904223u;
            frame[UDP_FRAME_HEAD + i] = (uint8_t)(random >> 24);
        }
        size_t built = udp_frame_build_around_payload(frame, &host, (uint16_t)random, size);
        assert_int_equal(built, UDP_FRAME_HEAD + size);
        assert_int_equal(parse_frame(built), size);
        frame[UDP_FRAME_HEAD + random % size] ^= 0x10;
        assert_int_equal(parse_frame(built), 0);
    }
}

/* A computed checksum of 0 is sent as 0xffff, as 0 would mean that there is no checksum. */
static void a_checksum_of_zero_is_sent_as_0xffff(void **state)
{
    int seen = 0;
    (void)state;
    for (unsigned value = 0; value < 0x10000; value++) {
        frame[UDP_FRAME_HEAD] = (uint8_t)(value >> 8);
        frame[UDP_FRAME_HEAD + 1] = (uint8_t)value;
        assert_int_equal(parse_frame(udp_frame_build_around_payload(frame, &host, 0, 2)), 2);
        assert_false(frame[AT_UDP_CHECKSUM] == 0 && frame[AT_UDP_CHECKSUM + 1] == 0);
        seen += frame[AT_UDP_CHECKSUM] == 0xff && frame[AT_UDP_CHECKSUM + 1] == 0xff;
    }
    assert_true(seen > 0);
}

static void frames_with_a_wrong_ip_head_are_refused(void **state)
{
    static const struct {
        unsigned at;
        uint8_t value;
    } heads[] = {{AT_VERSION, 0x65},    {AT_VERSION, 0x44},   {AT_VERSION, 0x4f},
                 {AT_LENGTH + 1, 0x29}, {AT_LENGTH + 1, 27},  {AT_LENGTH, 0xff},
                 {AT_FRAGMENT, 0x20},   {AT_FRAGMENT + 1, 1}, {AT_PROTOCOL, 6},
                 {AT_GROUP, 0x44}};
    (void)state;
    for (size_t i = 0; i < sizeof heads / sizeof *heads; i++) {
        set_frame_of_liblcm();
        change_ip_head_byte(heads[i].at, heads[i].value);
        assert_int_equal(parse_frame(sizeof of_liblcm), 0);
    }
    for (size_t size = 0; size < sizeof of_liblcm; size++) {
        set_frame_of_liblcm();
        assert_int_equal(parse_frame(size), 0);
    }
    set_frame_of_liblcm();
    frame[AT_TYPE + 1] = 0x06;
    assert_int_equal(parse_frame(sizeof of_liblcm), 0);
    set_frame_of_liblcm();
    frame[AT_IP_CHECKSUM] ^= 1;
    assert_int_equal(parse_frame(sizeof of_liblcm), 0);
}

static void datagrams_with_bad_lengths_or_checksums_are_refused(void **state)
{
    static const struct {
        unsigned at;
        uint8_t value;
    } wrong[] = {
        {AT_PORT, 0xf4}, {AT_UDP_LENGTH, 7}, {AT_UDP_LENGTH, 0x15}, {AT_UDP_LENGTH - 1, 0xff}};
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        set_frame_of_liblcm();
        frame[AT_UDP_CHECKSUM] = frame[AT_UDP_CHECKSUM + 1] = 0;
        frame[wrong[i].at] = wrong[i].value;
        assert_int_equal(parse_frame(sizeof of_liblcm), 0);
    }
}

static void ip_options_are_skipped(void **state)
{
    (void)state;
    set_frame_of_liblcm();
    memmove(frame + 38, frame + 34, sizeof of_liblcm - 34);
    memset(frame + 34, 1, 4); /* IP options: no operation */
    frame[AT_LENGTH + 1] = 0x2c;
    frame[AT_VERSION] = 0x46;
    frame[AT_UDP_CHECKSUM + 4] = frame[AT_UDP_CHECKSUM + 5] = 0;
    /* the IP checksum covers the options, too */
    change_ip_head_byte(AT_VERSION, 0x46);
    uint32_t sum =
        ((uint32_t)(uint8_t)~frame[AT_IP_CHECKSUM] << 8 | (uint8_t)~frame[AT_IP_CHECKSUM + 1]) +
        0x0202;
    sum = ~((sum & 0xffff) + (sum >> 16));
    frame[AT_IP_CHECKSUM] = (uint8_t)(sum >> 8);
    frame[AT_IP_CHECKSUM + 1] = (uint8_t)sum;
    assert_int_equal(parse_frame(sizeof of_liblcm + 4), 12);
    assert_memory_equal(payload, "LC02", 4);
}

/* RFC 2236: to the group, TTL 1, router alert; type 0x16, checksum, group. */
static void the_igmp_report_is_as_rfc_2236_says(void **state)
{
    static const uint8_t expected[] = {0x01, 0x00, 0x5e, 0x7f, 0x4c, 0x43, 0x02, 0x52, 0x48, 0x4f,
                                       0x00, 0x01, 0x08, 0x00, 0x46, 0x00, 0x00, 0x20, 0x00, 0x00,
                                       0x40, 0x00, 0x01, 0x02, 0x9e, 0x28, 0x0a, 0x09, 0x00, 0x64,
                                       0xef, 0xff, 0x4c, 0x43, 0x94, 0x04, 0x00, 0x00, 0x16, 0x00,
                                       0xad, 0xbc, 0xef, 0xff, 0x4c, 0x43};
    (void)state;
    memset(frame, 0xee, sizeof frame);
    udp_frame_build_igmp_report(frame, &host);
    assert_memory_equal(frame, expected, sizeof expected);
    for (size_t i = sizeof expected; i < UDP_FRAME_JOIN; i++) {
        assert_int_equal(frame[i], 0);
    }
    assert_int_equal(parse_frame(UDP_FRAME_JOIN), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_frame_of_liblcm_is_accepted),
        cmocka_unit_test(a_built_frame_equals_that_of_liblcm),
        cmocka_unit_test(built_frames_of_every_size_are_accepted),
        cmocka_unit_test(a_checksum_of_zero_is_sent_as_0xffff),
        cmocka_unit_test(frames_with_a_wrong_ip_head_are_refused),
        cmocka_unit_test(datagrams_with_bad_lengths_or_checksums_are_refused),
        cmocka_unit_test(ip_options_are_skipped),
        cmocka_unit_test(the_igmp_report_is_as_rfc_2236_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
