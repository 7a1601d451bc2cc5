/* SPDX-License-Identifier: MIT */
/* An operator's commands and settings as messages, and their answers. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "node_senders.h"
#include "rhotrack/operator.h"

static void start_node_of_operator(int takes_commands)
{
    struct rho_node_config config = default_config();

    config.options.takes_commands = (uint8_t)takes_commands;
    start_node(&config);
    send_scan(1, 0, now_us);
    done[0] = '\0';
    wanted = RHO_MESSAGE_COMMAND_ANSWER_CHANNEL;
}

/* Encodes the exclusion of a square, of which number is the side in metres. */
static size_t encode_command(int32_t number, uint8_t bytes[RHO_MESSAGE_COMMAND_MAX_SIZE])
{
    const struct rho_message_command command = {.number = number,
                                                .action = RHO_MESSAGE_COMMAND_EXCLUDE,
                                                .x_max_m = (float)number,
                                                .y_max_m = (float)number};
    size_t size;

    assert_int_equal(
        rho_message_command_encode(&command, bytes, RHO_MESSAGE_COMMAND_MAX_SIZE, &size), RHO_OK);
    return size;
}

static void send_command(int32_t number)
{
    uint8_t bytes[RHO_MESSAGE_COMMAND_MAX_SIZE];

    take_message(RHO_MESSAGE_COMMAND_CHANNEL, bytes, encode_command(number, bytes));
}

/* Gives the node a command, and lets it do nothing. */
static void leave_command(int32_t number)
{
    uint8_t bytes[RHO_MESSAGE_COMMAND_MAX_SIZE];
    const size_t size = encode_command(number, bytes);

    assert_int_equal(rho_node_take(&node, RHO_MESSAGE_COMMAND_CHANNEL, bytes, size, now_us),
                     RHO_OK);
}

static void send_setting(int16_t field, float value)
{
    const struct rho_message_setting setting = {.number = 9, .field = field, .value = value};
    uint8_t bytes[RHO_MESSAGE_SETTING_MAX_SIZE];
    size_t size;

    assert_int_equal(rho_message_setting_encode(&setting, bytes, sizeof bytes, &size), RHO_OK);
    take_message(RHO_MESSAGE_SETTING_CHANNEL, bytes, size);
}

static struct rho_message_command_answer last_answer(void)
{
    struct rho_message_command_answer answer;

    assert_int_equal(rho_message_command_answer_decode(last, last_size, &answer), RHO_OK);
    return answer;
}

static void a_command_is_run_after_the_next_step(void **state)
{
    (void)state;
    start_node_of_operator(1);
    send_command(50);
    assert_string_equal(done, "");
    assert_int_equal(node.tracker.num_excluded, 0);
    now_us += SECOND_US;
    send_scan(1, 1, now_us);
    assert_string_equal(done, "S");
    assert_int_equal(node.tracker.num_excluded, 1);
    assert_int_equal(num_wanted, 1);
    assert_int_equal(last_answer().number, 50);
    assert_int_equal(last_answer().status, RHO_OK);
    assert_int_equal(last_answer().scan, 2);
    assert_int_equal(last_answer().epoch, EPOCH);
    assert_int_equal(node.counters.commands_done, 1);
    now_us += SECOND_US;
    send_scan(1, 2, now_us);
    assert_int_equal(num_wanted, 1); /* an answer is published once */
}

static void commands_beyond_the_queue_are_refused_at_once(void **state)
{
    (void)state;
    start_node_of_operator(1);
    for (int32_t number = 1; number <= RHO_MAX_COMMANDS; number++) {
        send_command(number);
    }
    assert_string_equal(done, "");
    send_command(99);
    assert_string_equal(done, "A");
    assert_int_equal(num_wanted, 1);
    assert_int_equal(last_answer().number, 99);
    assert_int_equal(last_answer().status, RHO_ERROR_CAPACITY);
    now_us += SECOND_US;
    send_scan(1, 1, now_us);
    assert_int_equal(num_wanted, 1 + RHO_MAX_COMMANDS);
    assert_int_equal(last_answer().number, RHO_MAX_COMMANDS);
}

static void commands_that_wait_too_long_are_refused(void **state)
{
    (void)state;
    start_node_of_operator(1);
    send_command(50);
    now_us += 59 * SECOND_US;
    run_until(now_us);
    assert_string_equal(done, "");
    now_us += 2 * SECOND_US;
    run_until(now_us);
    assert_string_equal(done, "A");
    assert_int_equal(last_answer().status, RHO_ERROR_STATE);
    assert_int_equal(node.counters.commands_refused, 1);
    assert_int_equal(node.tracker.num_excluded, 0);
}

/* What the operator saw has changed: the command is refused before the new epoch. */
static void a_restart_refuses_waiting_commands(void **state)
{
    (void)state;
    start_node_of_operator(1);
    send_command(50);
    for (int32_t k = 0; k < 4; k++) {
        now_us += SECOND_US;
        send_scan(1, 1000 + k, (500 + k) * SECOND_US);
    }
    assert_string_equal(done, "RSS");
    assert_int_equal(num_wanted, 1);
    assert_int_equal(last_answer().status, RHO_ERROR_STATE);
    assert_int_equal(last_answer().epoch, EPOCH);
    assert_int_equal(node.tracker.num_excluded, 0);
}

/* A node that begins anew runs no command of before, and publishes no answer. */
static void a_configuration_drops_waiting_commands_and_answers(void **state)
{
    struct rho_node_config config = default_config();

    (void)state;
    config.options.takes_commands = 1;
    start_node_of_operator(1);
    for (int32_t number = 1; number <= RHO_MAX_COMMANDS + 1; number++) {
        send_command(number);
    }
    assert_int_equal(rho_node_num_messages(&node), 0);
    num_wanted = 0;
    assert_int_equal(rho_node_configure(&node, &config), RHO_OK);
    now_us += SECOND_US;
    send_scan(1, 1, now_us);
    assert_int_equal(node.tracker.num_excluded, 0);
    assert_int_equal(num_wanted, 0);
}

/* Answers come with the step that ran the commands, whoever calls it. */
static void a_step_without_messages_answers_commands(void **state)
{
    const struct rho_scan scan = {.time_us = INT64_C(1001) * SECOND_US, .sensor_id = 1};

    (void)state;
    start_node_of_operator(1);
    send_command(50);
    assert_int_equal(rho_node_step_scan(&node, &scan), RHO_OK);
    assert_string_equal(rho_node_channel(&node, 0), RHO_MESSAGE_COMMAND_ANSWER_CHANNEL);
    keep_wanted_messages();
    assert_int_equal(num_wanted, 1);
    assert_int_equal(last_answer().number, 50);
}

/* Answers that nobody publishes push out older ones: those of the last step are no longer all. */
static void answers_beyond_the_list_are_not_published_for_others(void **state)
{
    (void)state;
    start_node_of_operator(1);
    for (int32_t number = 1; number <= RHO_MAX_COMMANDS + 1; number++) {
        send_command(number);
    }
    for (int32_t number = 200; number < 200 + RHO_MAX_COMMANDS; number++) {
        leave_command(number);
    }
    assert_int_equal(rho_node_next(&node, now_us), RHO_NODE_ANSWER);
    assert_int_equal(rho_node_num_messages(&node), RHO_MAX_COMMANDS);
    for (int32_t number = 300; number < 303; number++) { /* one finds room, two push out */
        leave_command(number);
    }
    assert_int_equal(rho_node_num_messages(&node), RHO_MAX_COMMANDS - 2);
    keep_wanted_messages();
    assert_int_equal(last_answer().number, 200 + RHO_MAX_COMMANDS - 1);
}

static void bad_and_unwanted_commands_are_counted(void **state)
{
    const uint8_t bytes[3] = {1, 2, 3};

    (void)state;
    start_node_of_operator(1);
    take_message(RHO_MESSAGE_COMMAND_CHANNEL, bytes, sizeof bytes);
    take_message(RHO_MESSAGE_SETTING_CHANNEL, bytes, sizeof bytes);
    assert_int_equal(node.counters.commands_bad, 2);
    start_node_of_operator(0);
    send_command(50);
    send_setting(RHO_MESSAGE_SETTING_PD, 0.5f);
    now_us += SECOND_US;
    send_scan(1, 1, now_us);
    assert_int_equal(node.counters.commands_not_allowed, 2);
    assert_int_equal(num_wanted, 0);
    assert_int_equal(node.tracker.num_excluded, 0);
}

static void a_setting_changes_tracker_and_initiators(void **state)
{
    struct rho_message_setting_answer answer;

    (void)state;
    start_node_of_operator(1);
    wanted = RHO_MESSAGE_SETTING_ANSWER_CHANNEL;
    send_setting(RHO_MESSAGE_SETTING_V_MAX_MPS, 300.0f);
    now_us += SECOND_US;
    send_scan(1, 1, now_us);
    assert_int_equal(num_wanted, 1);
    assert_int_equal(rho_message_setting_answer_decode(last, last_size, &answer), RHO_OK);
    assert_int_equal(answer.status, RHO_OK);
    assert_int_equal(answer.number, 9);
    assert_int_equal(answer.epoch, EPOCH);
    assert_int_equal(node.settings_changed, 1);
    assert_true(node.settings.v_max_mps <= 300.0f && node.told.v_max_mps > 300.0f);
    assert_true(node.tracker.config.v_max_mps <= 300.0f);
    assert_true(rho_node_window(&node, 0)->config.v_max_mps <= 300.0f);
    send_setting(RHO_MESSAGE_SETTING_PD, 5.0f);
    now_us += SECOND_US;
    send_scan(1, 2, now_us);
    assert_int_equal(rho_message_setting_answer_decode(last, last_size, &answer), RHO_OK);
    assert_int_equal(answer.status, RHO_ERROR_CONFIG);
    assert_int_equal(answer.fault_field, RHO_MESSAGE_SETTING_PD);
    assert_int_equal(node.settings_changed, 1);
}

/* A sensor of its own least range contradicts a shorter range of all. */
static void a_setting_that_contradicts_a_sensor_is_refused(void **state)
{
    struct rho_message_setting_answer answer;
    struct rho_scan_assembler_sensor known;

    (void)state;
    start_node_of_operator(1);
    wanted = RHO_MESSAGE_SETTING_ANSWER_CHANNEL;
    known = node.assembler.config.other;
    known.sensor.sensor_id = 1;
    known.sensor.range_min_m = 50e3f;
    assert_int_equal(rho_scan_assembler_set_sensor(&node.assembler, &known), RHO_OK);
    send_setting(RHO_MESSAGE_SETTING_RANGE_MAX_M, 40e3f);
    now_us += SECOND_US;
    send_scan(1, 1, now_us);
    assert_int_equal(rho_message_setting_answer_decode(last, last_size, &answer), RHO_OK);
    assert_int_equal(answer.status, RHO_ERROR_CONFIG);
    assert_true(node.settings.range_max_m > 50e3f);
}

static void a_build_without_commands_does_not_know_their_channel(void **state)
{
    const uint8_t bytes[3] = {1, 2, 3};

    (void)state;
    start_default_node();
    assert_int_equal(rho_node_take(&node, RHO_MESSAGE_COMMAND_CHANNEL, bytes, sizeof bytes, now_us),
                     RHO_ERROR_TYPE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_command_is_run_after_the_next_step),
        cmocka_unit_test(commands_beyond_the_queue_are_refused_at_once),
        cmocka_unit_test(commands_that_wait_too_long_are_refused),
        cmocka_unit_test(a_restart_refuses_waiting_commands),
        cmocka_unit_test(a_configuration_drops_waiting_commands_and_answers),
        cmocka_unit_test(a_step_without_messages_answers_commands),
        cmocka_unit_test(answers_beyond_the_list_are_not_published_for_others),
        cmocka_unit_test(bad_and_unwanted_commands_are_counted),
        cmocka_unit_test(a_setting_changes_tracker_and_initiators),
        cmocka_unit_test(a_setting_that_contradicts_a_sensor_is_refused),
    };
    const struct CMUnitTest tests_without[] = {
        cmocka_unit_test(a_build_without_commands_does_not_know_their_channel),
    };

    return RHO_MAX_COMMANDS > 0 ? cmocka_run_group_tests(tests, NULL, NULL)
                                : cmocka_run_group_tests(tests_without, NULL, NULL);
}
