/* SPDX-License-Identifier: MIT */
/* Who sends a sensor's messages: two at once are named once, one that was started anew is not. */
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

static void begin(void)
{
    memset(&senders, 0, sizeof senders);
    to = open_memstream(&text, &size);
}

static void hear(const char *channel, uint16_t port, bool is_own, int64_t now_us)
{
    const struct transport_message message = {.channel = channel,
                                              .sender = {0x0a090001u, port, is_own}};

    duplicate_senders_note_message(&senders, &message, now_us, to);
}

static void said(const char *expected)
{
    fclose(to);
    assert_string_equal(text, expected);
    free(text);
}

static void two_senders_are_named_once(void **state)
{
    (void)state;
    begin();
    for (int i = 1; i < 100; i++) {
        hear("RHO_PLOTS_7", i % 3 ? 5001 : 5002, false, i);
        hear("RHO_POLAR_8", 5001, false, i); /* by one of them alone */
    }
    said(
        "rhotrack: sensor 7 has another sender, 10.9.0.1:5002, until now 10.9.0.1:5001: a restart, "
        "or two at once\n"
        "rhotrack: sensor 7 has two senders: 10.9.0.1:5001 and 10.9.0.1:5002; each needs a number "
        "of its own\n");
}

/* Names that are no sensor's are neither printed nor kept: the table has room for sensors alone. */
static void other_names_are_not_sensors(void **state)
{
    static const char *const names[] = {"RHO_PLOTS_\033[2J", "RHO_PLOTS_",      "RHO_PLOTS_-",
                                        "RHO_PLOTS_7 ",      "RHO_POLAR_32768", "RHO_PLOTS_+7",
                                        "RHO_PLOTS_000007",  "RHO_BEARINGS_7x"};

    (void)state;
    begin();
    for (size_t i = 0; i < 100 * (sizeof names / sizeof *names); i++) {
        hear(names[i / 100], i % 2 ? 1 : 2, false, (int64_t)i);
    }
    assert_int_equal(senders.num_channels, 0);
    said("");
}

static void one_that_is_started_anew_is_not(void **state)
{
    (void)state;
    begin();
    for (int i = 1; i < 100; i++) { /* 1 s apart, and 13 s where it is started anew */
        const int64_t now_us = 1000000 * (i + 12 * (int64_t)(i / 10));

        hear("RHO_BEARINGS_7", (uint16_t)(5000 + i / 10), false, now_us);
        hear("SOMETHING_7", i % 2 ? 1 : 2, false, now_us);
        hear("RHO_PLOTS_1", 0, false, now_us); /* a provider that does not tell */
    }
    said("");
}

/* A radar that turns in 10 s: the first sender is heard again 8 s later. */
static void another_one_is_told_before_it_is_certain(void **state)
{
    static const char line[] = "rhotrack: sensor 3 has another sender, 10.9.0.1:5002, until now "
                               "10.9.0.1:5001: a restart, or two at once\n";

    (void)state;
    begin();
    hear("RHO_POLAR_3", 5001, false, 1000000);
    hear("RHO_POLAR_3", 5002, false, 3000000);
    said(line);
    begin();
    for (int i = 0; i < 3; i++) {
        hear("RHO_POLAR_3", 5001, false, 1000000 + 10000000 * i);
    }
    for (int i = 0; i < 50; i++) { /* a port a message */
        hear("RHO_POLAR_3", (uint16_t)(5002 + i), false, 23000000 + 1000000 * i);
    }
    said(line);
}

static void another_node_is_named_once(void **state)
{
    (void)state;
    begin();
    for (int i = 0; i < 100; i++) {
        hear("RHO_STATUS", 6001, true, i);
        hear("RHO_STATUS", 6002, false, i);
    }
    said("rhotrack: another node publishes tracks here: 10.9.0.1:6002\n");
}

static void lines_are_few(void **state)
{
    unsigned lines = 0;

    (void)state;
    begin();
    for (int i = 0; i < 30000; i++) {
        hear("RHO_STATUS", (uint16_t)(1 + i), false, i % 3000);
    }
    hear("RHO_STATUS", 40000, false, 1000000);
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
        cmocka_unit_test(two_senders_are_named_once),
        cmocka_unit_test(other_names_are_not_sensors),
        cmocka_unit_test(one_that_is_started_anew_is_not),
        cmocka_unit_test(another_one_is_told_before_it_is_certain),
        cmocka_unit_test(another_node_is_named_once),
        cmocka_unit_test(lines_are_few),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
