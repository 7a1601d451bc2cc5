/* SPDX-License-Identifier: MIT */
/*
 * An operator's command messages act as the tracker's own functions do, and answers report the
 * outcome.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/command.h"

static struct rho_tracker tracker, tracker_before;
static struct rho_report report, report_before;
static struct rho_message_command_answer answer;

/* One step without plots. */
static void start_tracker_and_step_without_plots(void)
{
    struct rho_tracker_config config;
    const struct rho_scan scan = {.time_us = 5000000, .sensor_id = 3};
    rho_tracker_config_default(&config);
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    memset(&report, 0, sizeof report);
    assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
}

/* Runs a command; its answer repeats number and action, and has the step's time. */
static enum rho_status run_command_and_check_answer(struct rho_message_command command)
{
    command.number = 77;
    memset(&answer, 0xee, sizeof answer);
    const enum rho_status status = rho_command_run(&command, &tracker, &report, &answer);
    assert_int_equal(answer.number, 77);
    assert_int_equal(answer.action, command.action);
    assert_int_equal(answer.utime, 5000000);
    assert_int_equal(answer.status, status);
    assert_int_equal(answer.scan, 0);
    assert_int_equal(answer.epoch, 0);
    assert_int_equal(rho_message_command_answer_validate(&answer, NULL),
                     command.action > 0 ? RHO_OK : RHO_ERROR_VALUE);
    return status;
}

static struct rho_message_command command_to_start_at(float x_m)
{
    return (struct rho_message_command){.action = RHO_MESSAGE_COMMAND_START,
                                        .x_m = x_m,
                                        .y_m = 200.0f,
                                        .sigma_m = 20.0f,
                                        .vx_mps = 30.0f,
                                        .vy_mps = -40.0f,
                                        .sigma_mps = 5.0f};
}

static void commands_are_run_and_answered(void **state)
{
    (void)state;
    start_tracker_and_step_without_plots();
    assert_int_equal(run_command_and_check_answer(command_to_start_at(100.0f)), RHO_OK);
    assert_int_equal(answer.track_id, 1);
    assert_int_equal(run_command_and_check_answer(command_to_start_at(900.0f)), RHO_OK);
    assert_int_equal(answer.track_id, 2);
    assert_int_equal(report.num_tracks, 2);
    assert_true(report.tracks[1].state[0] > 899.0f && report.tracks[1].state[0] < 901.0f);
    assert_true(report.tracks[1].state[4] < -39.0f && report.tracks[1].state[4] > -41.0f);

    assert_int_equal(run_command_and_check_answer((struct rho_message_command){
                         .action = RHO_MESSAGE_COMMAND_RENUMBER, .track_id = 1, .new_id = 9}),
                     RHO_OK);
    assert_int_equal(answer.track_id, 9);
    assert_int_equal(report.tracks[1].track_id, 9);

    assert_int_equal(run_command_and_check_answer((struct rho_message_command){
                         .action = RHO_MESSAGE_COMMAND_FREEZE, .track_id = 9}),
                     RHO_OK);
    assert_int_equal(answer.track_id, 9);
    assert_int_equal(tracker.tracks[1].is_frozen, 1);
    assert_int_equal(run_command_and_check_answer((struct rho_message_command){
                         .action = RHO_MESSAGE_COMMAND_THAW, .track_id = 9}),
                     RHO_OK);
    assert_int_equal(tracker.tracks[1].is_frozen, 0);

    assert_int_equal(run_command_and_check_answer((struct rho_message_command){
                         .action = RHO_MESSAGE_COMMAND_DROP, .track_id = 9}),
                     RHO_OK);
    assert_int_equal(answer.track_id, 9);
    assert_int_equal(report.num_tracks, 1);

    assert_int_equal(run_command_and_check_answer(
                         (struct rho_message_command){.action = RHO_MESSAGE_COMMAND_EXCLUDE,
                                                      .x_m = -1.0f,
                                                      .y_m = -2.0f,
                                                      .x_max_m = 3.0f,
                                                      .y_max_m = 4.0f}),
                     RHO_OK);
    assert_int_equal(answer.track_id, 0);
    assert_int_equal(tracker.num_excluded, 1);
    const struct rho_extent area = {-1.0f, 3.0f, -2.0f, 4.0f};
    assert_memory_equal(&tracker.excluded[0], &area, sizeof area);
    assert_int_equal(run_command_and_check_answer((struct rho_message_command){
                         .action = RHO_MESSAGE_COMMAND_INCLUDE, .x_m = 3.0f, .y_m = -2.0f}),
                     RHO_OK);
    assert_int_equal(tracker.num_excluded, 0);
}

static void refused_commands_change_nothing(void **state)
{
    const struct rho_message_command bad[] = {
        {.action = RHO_MESSAGE_COMMAND_DROP, .track_id = 7},
        {.action = RHO_MESSAGE_COMMAND_RENUMBER, .track_id = 1, .new_id = 1},
        {.action = RHO_MESSAGE_COMMAND_FREEZE, .track_id = 7},
        {.action = RHO_MESSAGE_COMMAND_EXCLUDE, .x_max_m = 1.0f},
        {.action = RHO_MESSAGE_COMMAND_INCLUDE},
        {.action = RHO_MESSAGE_COMMAND_START},
        {.action = 0},
        {.action = RHO_MESSAGE_COMMAND_INCLUDE + 1},
        {.action = -1},
    };
    const struct rho_message_command drop = {.action = RHO_MESSAGE_COMMAND_DROP, .track_id = 1};
    (void)state;
    start_tracker_and_step_without_plots();
    assert_int_equal(run_command_and_check_answer(command_to_start_at(100.0f)), RHO_OK);
    memcpy(&tracker_before, &tracker, sizeof tracker);
    memcpy(&report_before, &report, sizeof report);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(run_command_and_check_answer(bad[i]), RHO_ERROR_VALUE);
        assert_int_equal(answer.track_id, 0);
    }
    assert_int_equal(rho_command_run(NULL, &tracker, &report, &answer), RHO_ERROR_NULL);
    assert_int_equal(rho_command_run(&drop, NULL, &report, &answer), RHO_ERROR_NULL);
    assert_int_equal(rho_command_run(&drop, &tracker, NULL, &answer), RHO_ERROR_NULL);
    assert_int_equal(rho_command_run(&drop, &tracker, &report, NULL), RHO_ERROR_NULL);
    assert_memory_equal(&tracker_before, &tracker, sizeof tracker);
    assert_memory_equal(&report_before, &report, sizeof report);
}

/* A message with a number outside its range is refused. */
static void invalid_command_messages_are_refused(void **state)
{
    struct rho_message_command command = command_to_start_at(100.0f), read;
    uint8_t bytes[RHO_MESSAGE_COMMAND_MAX_SIZE];
    size_t size;
    (void)state;
    assert_int_equal(rho_message_command_encode(&command, bytes, sizeof bytes, &size), RHO_OK);
    assert_int_equal(rho_message_command_decode(bytes, size, &read), RHO_OK);
    assert_int_equal(rho_message_command_validate(&read, NULL), RHO_OK);
    assert_memory_equal(&read.x_m, &command.x_m, sizeof read.x_m);
    assert_int_equal(rho_message_command_decode(bytes, size - 1, &read), RHO_ERROR_SHORT);
    command.x_m = 3e6f;
    assert_int_equal(rho_message_command_validate(&command, NULL), RHO_ERROR_VALUE);
    command = command_to_start_at(100.0f);
    command.action = RHO_MESSAGE_COMMAND_INCLUDE + 1;
    assert_int_equal(rho_message_command_validate(&command, NULL), RHO_ERROR_VALUE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(commands_are_run_and_answered),
        cmocka_unit_test(refused_commands_change_nothing),
        cmocka_unit_test(invalid_command_messages_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
