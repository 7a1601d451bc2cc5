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

static void note_message(const char *channel, uint16_t port, bool is_own, int64_t now_us)
{
    const struct transport_message message = {.channel = channel,
                                              .sender = {0x0a090001u, port, is_own}};

    duplicate_senders_note_message(&senders, &message, now_us, to);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_senders_of_one_sensor_are_warned_of_once),
        cmocka_unit_test(names_that_are_no_sensor_channels_are_ignored),
        cmocka_unit_test(a_restarted_sender_is_not_warned_of),
        cmocka_unit_test(a_second_sender_is_warned_of_at_once_as_a_possible_restart),
        cmocka_unit_test(another_node_is_warned_of_once),
        cmocka_unit_test(the_number_of_warnings_is_limited),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
