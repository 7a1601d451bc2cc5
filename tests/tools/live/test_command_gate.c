/* SPDX-License-Identifier: MIT */
/*
 * An operator's messages to a live node: a line for each, with its sender and outcome; those of
 * other addresses, and those of a flood, are counted and cost no scan.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "live/command_gate.h"
#include "live/node_core.h"

#define SECOND_US INT64_C(1000000)
#define START_US INT64_C(1790000000000000) /* microseconds since 1970, in 2026 */

enum { SCANS = 12, FLOOD_A_S = 35000 };

/* A node behind a gate, as `rhotrack node` has it, and what it sends and says. */
struct live {
    struct parameters parameters;
    struct node_core *core;
    struct command_gate gate;
    unsigned messages, answers;
    size_t num_tracks; /* bytes of all track lists */
    uint8_t tracks[SCANS * RHO_MESSAGE_TRACK_LIST_MAX_SIZE];
    char *text;
    size_t size;
    FILE *to;
};

static struct live live;

static void note_sent_message(void *context, const char *channel, const uint8_t *data, size_t size)
{
    struct live *of = context;

    command_gate_note_answer(&of->gate, channel, data, size, of->to);
    of->messages++;
    of->answers += strcmp(channel, RHO_MESSAGE_COMMAND_ANSWER_CHANNEL) == 0 ||
                   strcmp(channel, RHO_MESSAGE_SETTING_ANSWER_CHANNEL) == 0;
    if (strcmp(channel, RHO_MESSAGE_TRACK_LIST_CHANNEL) == 0) {
        assert_true(of->num_tracks + size <= sizeof of->tracks);
        memcpy(of->tracks + of->num_tracks, data, size);
        of->num_tracks += size;
    }
}

static void open_live(bool takes_commands, const char *from)
{
    const struct node_core_events events = {.context = &live, .send = note_sent_message};

    memset(&live, 0, sizeof live);
    parameters_set_defaults(&live.parameters);
    live.core = node_core_open(&live.parameters, 1, &events);
    live.gate = command_gate_open(takes_commands, from, "udpm://239.255.76.67:7667");
    if (live.gate.is_open) {
        node_core_allow_commands(live.core);
    }
    live.to = open_memstream(&live.text, &live.size);
}

static void take_message(const char *channel, const uint8_t *data, size_t size, uint32_t address,
                         int64_t now_us)
{
    const struct transport_message message = {.channel = channel,
                                              .data = data,
                                              .size = size,
                                              .received_us = now_us,
                                              .sender = {address, 5001, false}};

    if (command_gate_admits(&live.gate, &message, node_core_settings(live.core), live.to)) {
        node_core_take_message(live.core, channel, data, size, now_us);
    }
}

/* Takes the k-th scan, of a target that flies north. */
static void take_scan(int32_t k)
{
    static struct rho_message_polar_scan scan;
    uint8_t buffer[RHO_MESSAGE_POLAR_SCAN_MAX_SIZE];
    size_t size;

    scan = (struct rho_message_polar_scan){.utime = START_US + k * SECOND_US,
                                           .scan = k,
                                           .sensor_id = 1,
                                           .num_parts = 1,
                                           .num_polar_plots = 1};
    scan.polar_plots[0].range_m = 5000.0f + 50.0f * (float)k;
    scan.polar_plots[0].azimuth_rad = 1.5707964f;
    assert_int_equal(rho_message_polar_scan_encode(&scan, buffer, sizeof buffer, &size), RHO_OK);
    take_message("RHO_POLAR_1", buffer, size, 0x0a090001u, START_US + k * SECOND_US);
}

static void take_command(const struct rho_message_command *command, uint32_t address,
                         int64_t now_us)
{
    uint8_t buffer[RHO_MESSAGE_COMMAND_MAX_SIZE];
    size_t size;

    assert_int_equal(rho_message_command_encode(command, buffer, sizeof buffer, &size), RHO_OK);
    take_message(RHO_MESSAGE_COMMAND_CHANNEL, buffer, size, address, now_us);
}

/* A command that the node refuses, as there is no such track. */
static void take_drop(int32_t number, uint32_t address, int64_t now_us)
{
    const struct rho_message_command command = {
        .number = number, .action = RHO_MESSAGE_COMMAND_DROP, .track_id = 999};

    take_command(&command, address, now_us);
}

static void take_setting(int32_t number, int16_t field, float value)
{
    const struct rho_message_setting setting = {.number = number, .field = field, .value = value};
    uint8_t buffer[RHO_MESSAGE_SETTING_MAX_SIZE];
    size_t size;

    assert_int_equal(rho_message_setting_encode(&setting, buffer, sizeof buffer, &size), RHO_OK);
    take_message(RHO_MESSAGE_SETTING_CHANNEL, buffer, size, 0x0a090002u, START_US);
}

static unsigned num_lines(void)
{
    unsigned lines = 0;

    fflush(live.to);
    for (size_t i = 0; i < live.size; i++) {
        lines += live.text[i] == '\n';
    }
    return lines;
}

static void close_live(void)
{
    node_core_close(live.core);
    fclose(live.to);
    free(live.text);
}

static void expect_lines(const char *expected)
{
    fflush(live.to);
    assert_string_equal(live.text, expected);
    close_live();
}

/* Twelve scans, with so many commands in the second before each; the node as it is then. */
static void track_beside_commands(int32_t commands_a_s)
{
    open_live(true, NULL);
    for (int32_t k = 0; k < SCANS; k++) {
        for (int32_t i = 0; i < commands_a_s; i++) {
            take_drop(i, 0x0a090002u, START_US + (k - 1) * SECOND_US + i * SECOND_US / FLOOD_A_S);
        }
        take_scan(k);
    }
    node_core_flush(live.core);
}

/*
 * Each answer costs a node a system call. Beside 35 000 commands a second it makes the same steps
 * and tracks, to the last bit, and sends a few messages more.
 */
static void a_flood_of_commands_costs_no_scan(void **state)
{
    static uint8_t quiet[sizeof live.tracks];
    const unsigned answers_max = COMMANDS_AT_ONCE + COMMANDS_A_S * SCANS;
    size_t num_quiet;
    unsigned messages;

    (void)state;
    track_beside_commands(0);
    assert_int_equal(node_core_node_counters(live.core)->steps, SCANS);
    assert_int_equal(node_core_last_report(live.core)->num_tracks, 1);
    num_quiet = live.num_tracks;
    memcpy(quiet, live.tracks, num_quiet);
    messages = live.messages;
    close_live();

    track_beside_commands(FLOOD_A_S);
    assert_int_equal(node_core_node_counters(live.core)->steps, SCANS);
    assert_int_equal(node_core_assembler_counters(live.core)->scans_lost, 0);
    assert_int_equal(live.num_tracks, num_quiet);
    assert_memory_equal(live.tracks, quiet, num_quiet);
    assert_in_range(live.answers, COMMANDS_A_S * (SCANS - 1), answers_max);
    assert_int_equal(live.messages, messages + live.answers);
    assert_int_equal(live.answers, node_core_node_counters(live.core)->commands_refused);
    assert_int_equal(live.gate.beyond + live.answers, FLOOD_A_S * SCANS);
    assert_int_equal(live.gate.num_waiting, 0);
    /* each answer, and each second one of the others */
    assert_in_range(num_lines(), live.answers, live.answers + 10 + SCANS);
    close_live();
}

static void each_message_is_said_with_sender_and_outcome(void **state)
{
    const struct rho_message_command area = {.number = 1,
                                             .action = RHO_MESSAGE_COMMAND_EXCLUDE,
                                             .x_m = -9000.5f,
                                             .y_m = -3000.0f,
                                             .x_max_m = 2e6f,
                                             .y_max_m = 0.0f};
    const struct rho_message_command start = {
        .number = 1, .action = RHO_MESSAGE_COMMAND_START, .x_m = 10.0f, .sigma_m = 50.0f};

    (void)state;
    open_live(true, NULL);
    take_command(&area, 0x0a090002u, START_US);
    take_setting(1, RHO_MESSAGE_SETTING_RANGE_MAX_M, 50000.0f); /* the numbers are the senders' */
    take_setting(1, RHO_MESSAGE_SETTING_RANGE_MAX_M, 1.0f);
    take_setting(1, RHO_MESSAGE_SETTING_PD, 1.5f);
    take_setting(1, RHO_MESSAGE_SETTING_MIN_SCANS, 4.5f);
    take_command(&start, 0x0a090003u, START_US);
    take_drop(1, 0x0a090004u, START_US);
    assert_int_equal(num_lines(), 0); /* they wait for a step */
    take_scan(1);
    node_core_flush(live.core);
    take_setting(2, RHO_MESSAGE_SETTING_RANGE_MAX_M, 2.0f);
    take_message(RHO_MESSAGE_COMMAND_CHANNEL, (const uint8_t *)"\033[2J", 4, 0x0a090005u, START_US);
    take_scan(2);
    node_core_flush(live.core);
    expect_lines(
        "rhotrack: command: exclude x_m=-9000.5 y_m=-3000 x_max_m=2000000 y_max_m=0, from "
        "10.9.0.2:5001\n"
        "rhotrack: setting: range_max_m 100000 -> 50000, from 10.9.0.2:5001\n"
        "rhotrack: setting: range_max_m 50000 -> 1, from 10.9.0.2:5001\n"
        "rhotrack: setting: pd 1.5, from 10.9.0.2:5001: refused: pd 1.5 is not within 0.01 .. "
        "0.999\n"
        "rhotrack: setting: min_scans 4.5, from 10.9.0.2:5001: refused: min_scans is a whole "
        "number\n"
        "rhotrack: command: start x_m=10 y_m=0 sigma_m=50 vx_mps=0 vy_mps=0 sigma_mps=0, from "
        "10.9.0.3:5001: track 1\n"
        "rhotrack: command: drop 999, from 10.9.0.4:5001: refused: no such track or place, or an "
        "identity that is taken\n"
        "rhotrack: command: no valid message, from 10.9.0.5:5001: refused: another version, or a "
        "value outside its range\n"
        "rhotrack: setting: range_max_m 1 -> 2, from 10.9.0.2:5001\n");
}

/* A flood of them takes no token of the address that may, and prints few lines. */
static void addresses_that_are_not_listed_command_nothing(void **state)
{
    (void)state;
    open_live(false, "10.9.0.7,10.9.0.2");
    assert_true(live.gate.is_open);
    for (int32_t i = 0; i < 1000; i++) {
        take_drop(i, 0x0a090003u, START_US);
    }
    assert_int_equal(live.gate.from.refused_source, 1000);
    assert_int_equal(num_lines(), 10);
    take_drop(7, 0x0a090002u, START_US);
    take_scan(1);
    node_core_flush(live.core);
    assert_int_equal(live.answers, 1);
    assert_int_equal(live.gate.beyond, 0);
    assert_non_null(strstr(live.text, "10.9.0.3:5001: refused: the address is not in "
                                      "--commands-from\n"));
    assert_non_null(strstr(live.text, "drop 999, from 10.9.0.2:5001: refused: no such track"));
    close_live();
}

static void a_node_that_takes_no_commands_says_so(void **state)
{
    (void)state;
    open_live(false, NULL);
    take_drop(1, 0x0a090002u, START_US);
    assert_int_equal(node_core_node_counters(live.core)->commands_not_allowed, 1);
    expect_lines("rhotrack: command: drop 999, from 10.9.0.2:5001: refused: the node runs without "
                 "--commands\n");
}

/* A log that is replayed begins anew at an earlier time. */
static void a_clock_that_goes_back_fills_the_bucket(void **state)
{
    (void)state;
    open_live(true, NULL);
    for (int32_t i = 0; i < COMMANDS_AT_ONCE + 1; i++) {
        take_drop(i, 0x0a090002u, START_US);
    }
    assert_int_equal(live.gate.beyond, 1);
    take_drop(0, 0x0a090002u, START_US + SECOND_US / COMMANDS_A_S);
    assert_int_equal(live.gate.beyond, 1);
    take_drop(0, 0x0a090002u, START_US + SECOND_US / COMMANDS_A_S);
    assert_int_equal(live.gate.beyond, 2);
    for (int32_t i = 0; i < COMMANDS_AT_ONCE; i++) {
        take_drop(i, 0x0a090002u, START_US - 3600 * SECOND_US);
    }
    assert_int_equal(live.gate.beyond, 2);
    close_live();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flood_of_commands_costs_no_scan),
        cmocka_unit_test(each_message_is_said_with_sender_and_outcome),
        cmocka_unit_test(addresses_that_are_not_listed_command_nothing),
        cmocka_unit_test(a_node_that_takes_no_commands_says_so),
        cmocka_unit_test(a_clock_that_goes_back_fills_the_bucket),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
