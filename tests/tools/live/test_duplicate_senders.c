/* SPDX-License-Identifier: MIT */
/*
 * Senders of a sensor's messages: two at the same time cause one warning, a restarted sender causes
 * none.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "live/duplicate_senders.h"

static struct duplicate_senders senders;
static char *text;
static size_t size;
static FILE *to;

static void clear_senders(void)
{
    memset(&senders, 0, sizeof senders);
    to = open_memstream(&text, &size);
}

static void note_message_of(uint32_t address, uint16_t port, bool is_own, const char *channel,
                            int64_t now_us)
{
    const struct transport_message message = {.channel = channel,
                                              .sender = {address, port, is_own}};

    duplicate_senders_note_message(&senders, &message, now_us, to);
}

static void note_message(const char *channel, uint16_t port, bool is_own, int64_t now_us)
{
    note_message_of(0x0a090001u, port, is_own, channel, now_us);
}

/* A message on one of many channels that no radar of these tests has. */
static void note_message_of_many(uint32_t address, uint16_t port, unsigned channel, int64_t now_us)
{
    char name[32];

    snprintf(name, sizeof name, "RHO_PLOTS_%u", 1000 + channel);
    note_message_of(address, port, false, name, now_us);
}

static void expect_lines(const char *expected)
{
    fclose(to);
    assert_string_equal(text, expected);
    free(text);
}

static void two_senders_of_one_sensor_are_warned_of_once(void **state)
{
    (void)state;
    clear_senders();
    for (int i = 1; i < 100; i++) {
        note_message("RHO_DIRECTIONS_7", i % 3 ? 5001 : 5002, false, i);
        note_message("RHO_POLAR_8", 5001, false, i); /* this sensor has one sender only */
    }
    expect_lines(
        "rhotrack: sensor 7 has another sender, 10.9.0.1:5002, until now 10.9.0.1:5001: a restart, "
        "or two at once\n"
        "rhotrack: sensor 7 has two senders: 10.9.0.1:5001 and 10.9.0.1:5002; each needs a number "
        "of its own\n");
}

/*
 * Channel names that belong to no sensor are neither printed nor stored: the table has room for
 * sensors alone.
 */
static void names_that_are_no_sensor_channels_are_ignored(void **state)
{
    static const char *const names[] = {"RHO_PLOTS_\033[2J", "RHO_PLOTS_",      "RHO_PLOTS_-",
                                        "RHO_PLOTS_7 ",      "RHO_POLAR_32768", "RHO_PLOTS_+7",
                                        "RHO_PLOTS_000007",  "RHO_BEARINGS_7x", "RHO_DIRECTIONS_"};

    (void)state;
    clear_senders();
    for (size_t i = 0; i < 100 * (sizeof names / sizeof *names); i++) {
        note_message(names[i / 100], i % 2 ? 1 : 2, false, (int64_t)i);
    }
    assert_int_equal(senders.num_channels, 0);
    expect_lines("");
}

static void a_restarted_sender_is_not_warned_of(void **state)
{
    (void)state;
    clear_senders();
    for (int i = 1; i < 100; i++) { /* messages 1 s apart, and 13 s at each restart */
        const int64_t now_us = 1000000 * (i + 12 * (int64_t)(i / 10));

        note_message("RHO_BEARINGS_7", (uint16_t)(5000 + i / 10), false, now_us);
        note_message("SOMETHING_7", i % 2 ? 1 : 2, false, now_us);
        /* port 0: a transport that does not tell the sender */
        note_message("RHO_PLOTS_1", 0, false, now_us);
    }
    expect_lines("");
}

/* A radar of 10 s a turn: the first sender is heard again 8 s after the second one. */
static void a_second_sender_is_warned_of_at_once_as_a_possible_restart(void **state)
{
    static const char line[] = "rhotrack: sensor 3 has another sender, 10.9.0.1:5002, until now "
                               "10.9.0.1:5001: a restart, or two at once\n";

    (void)state;
    clear_senders();
    note_message("RHO_POLAR_3", 5001, false, 1000000);
    note_message("RHO_POLAR_3", 5002, false, 3000000);
    expect_lines(line);
    clear_senders();
    for (int i = 0; i < 3; i++) {
        note_message("RHO_POLAR_3", 5001, false, 1000000 + 10000000 * i);
    }
    for (int i = 0; i < 50; i++) { /* another port in each message */
        note_message("RHO_POLAR_3", (uint16_t)(5002 + i), false, 23000000 + 1000000 * i);
    }
    expect_lines(line);
}

static void another_node_is_warned_of_once(void **state)
{
    (void)state;
    clear_senders();
    for (int i = 0; i < 100; i++) {
        note_message("RHO_STATUS", 6001, true, i);
        note_message("RHO_STATUS", 6002, false, i);
    }
    expect_lines("rhotrack: another node publishes tracks here: 10.9.0.1:6002\n");
}

static void the_number_of_warnings_is_limited(void **state)
{
    unsigned lines = 0;

    (void)state;
    clear_senders();
    for (int i = 0; i < 30000; i++) {
        note_message("RHO_STATUS", (uint16_t)(1 + i), false, i % 3000);
    }
    note_message("RHO_STATUS", 40000, false, 1000000);
    fclose(to);
    for (size_t i = 0; i < size; i++) {
        lines += text[i] == '\n';
    }
    free(text);
    assert_int_equal(lines, SENDERS_LINES + 1);
}

/*
 * A stranger sends on 200 channels, 100 messages a second, before the radar and beside it: on its
 * channels it is the only sender, so the only lines are those of the radar.
 */
static void expect_two_senders_beside_stranger(uint32_t address)
{
    const int64_t hundredth_us = 10000;

    clear_senders();
    for (int64_t i = 1; i < 4000; i++) {
        note_message_of_many(address, 6001, (unsigned)(i % 200), i * hundredth_us);
        if (i >= 1000 && i % 1000 == 0) { /* 10 s a turn */
            note_message("RHO_POLAR_3", 5001, false, i * hundredth_us);
        }
        if (i >= 2000 && i % 1000 == 400) {
            note_message("RHO_POLAR_3", 5002, false, i * hundredth_us);
        }
    }
    expect_lines(
        "rhotrack: sensor 3 has another sender, 10.9.0.1:5002, until now 10.9.0.1:5001: a restart, "
        "or two at once\n"
        "rhotrack: sensor 3 has two senders: 10.9.0.1:5001 and 10.9.0.1:5002; each needs a number "
        "of its own\n");
}

static void two_senders_are_warned_of_beside_200_channels_of_a_stranger(void **state)
{
    (void)state;
    expect_two_senders_beside_stranger(0x0a090002u);
    expect_two_senders_beside_stranger(0x0a090001u); /* on the radar's host, with its own port */
}

static void channels_unheard_for_a_minute_are_forgotten(void **state)
{
    const int64_t second_us = 1000000;

    (void)state;
    clear_senders();
    for (unsigned i = 0; i < 200; i++) { /* each of an address of its own, and heard once */
        note_message_of_many(0x0a090100u + i, 6001, i, (1 + (int64_t)i) * second_us);
    }
    note_message("RHO_POLAR_3", 5001, false, 201 * second_us);
    note_message("RHO_POLAR_3", 5002, false, 202 * second_us);
    expect_lines("rhotrack: sensor 3 has another sender, 10.9.0.1:5002, until now 10.9.0.1:5001: a "
                 "restart, or two at once\n");
}

/* 64 radars of addresses of their own, and then 136 more channels in their pauses. */
static void channels_that_are_heard_keep_their_places(void **state)
{
    const int64_t second_us = 1000000;

    (void)state;
    clear_senders();
    for (int64_t turn = 0; turn < 20; turn++) {
        for (unsigned i = 0; i < 200; i++) {
            note_message_of_many(0x0a090100u + i, 6001, i, (1 + 10 * turn) * second_us + i);
        }
    }
    for (unsigned i = 0; i < 64; i += 63) {
        note_message_of_many(0x0a090001u, 5001, i, 192 * second_us);
    }
    expect_lines(
        "rhotrack: sensor 1000 has another sender, 10.9.0.1:5001, until now 10.9.1.0:6001: a "
        "restart, or two at once\n"
        "rhotrack: sensor 1063 has another sender, 10.9.0.1:5001, until now 10.9.1.63:6001: a "
        "restart, or two at once\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_senders_of_one_sensor_are_warned_of_once),
        cmocka_unit_test(names_that_are_no_sensor_channels_are_ignored),
        cmocka_unit_test(a_restarted_sender_is_not_warned_of),
        cmocka_unit_test(a_second_sender_is_warned_of_at_once_as_a_possible_restart),
        cmocka_unit_test(another_node_is_warned_of_once),
        cmocka_unit_test(the_number_of_warnings_is_limited),
        cmocka_unit_test(two_senders_are_warned_of_beside_200_channels_of_a_stranger),
        cmocka_unit_test(channels_unheard_for_a_minute_are_forgotten),
        cmocka_unit_test(channels_that_are_heard_keep_their_places),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
