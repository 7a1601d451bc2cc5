/* SPDX-License-Identifier: MIT */
/* node_commands: an operator's commands and settings: their queue, and their answers. */
#include <string.h>

#include "node_parts.h"
#include "rhotrack/command.h"

#define COMMAND_IS_LATE RHO_ERROR_STATE

void rho_node_answers_drop(struct rho_node *node)
{
    struct rho_node_operator *operated = NODE_OPERATOR(node);
    if (RHO_MAX_COMMANDS > 0 && operated->num_shown > 0) {
        operated->num_answers = (uint16_t)(operated->num_answers - operated->num_shown);
        memmove(operated->answers, operated->answers + operated->num_shown,
                operated->num_answers * sizeof operated->answers[0]);
        operated->num_shown = 0;
    }
}

void rho_node_answers_show(struct rho_node *node)
{
    if (RHO_MAX_COMMANDS > 0) {
        NODE_OPERATOR(node)->num_shown = NODE_OPERATOR(node)->num_answers;
    }
}

int64_t rho_node_answers_due(const struct rho_node *node, int64_t due_us)
{
    const struct rho_node_operator *operated = NODE_OPERATOR(node);
    int64_t sooner_us = INT64_MAX;
    if (RHO_MAX_COMMANDS == 0) {
        return due_us;
    }
    if (operated->num_answers > operated->num_shown) {
        sooner_us = node->now_us;
    } else if (operated->num_commands > 0 &&
               operated->commands[0].came_us < INT64_MAX - COMMAND_WAIT_US) {
        sooner_us = operated->commands[0].came_us + COMMAND_WAIT_US + 1;
    }
    return sooner_us < due_us ? sooner_us : due_us;
}

/* Answers a command or a setting; the oldest answer is lost where the caller publishes none. */
static void add_answer(struct rho_node *node, struct rho_node_answer *answer)
{
    struct rho_node_operator *operated = NODE_OPERATOR(node);
    const int8_t status = answer->is_setting ? answer->setting.status : answer->command.status;
    uint32_t *counter =
        status == RHO_OK ? &node->counters.commands_done : &node->counters.commands_refused;
    *counter = rho_count(*counter, 1);
    answer->command.utime = answer->setting.utime = node->report.time_us;
    answer->command.scan = answer->setting.scan = node->step;
    answer->command.epoch = answer->setting.epoch = node->epoch;
    if (RHO_MAX_COMMANDS == 0) {
        return;
    }
    if (operated->num_answers == RHO_MAX_COMMANDS + 1) {
        memmove(operated->answers, operated->answers + 1,
                (size_t)RHO_MAX_COMMANDS * sizeof operated->answers[0]);
        operated->num_answers--;
        operated->num_shown = (uint16_t)(operated->num_shown - (operated->num_shown > 0));
    }
    operated->answers[operated->num_answers++] = *answer;
}

static void refuse(struct rho_node *node, const struct rho_node_command *waiting,
                   enum rho_status status)
{
    struct rho_node_answer answer = {
        .is_setting = waiting->is_setting,
        .command = {.number = waiting->command.number,
                    .action = waiting->command.action,
                    .status = (int8_t)status},
        .setting = {.number = waiting->setting.number,
                    .field = waiting->setting.field,
                    .status = (int8_t)status},
    };
    add_answer(node, &answer);
}

void rho_node_commands_refuse(struct rho_node *node, int64_t before_us)
{
    struct rho_node_operator *operated = NODE_OPERATOR(node);
    unsigned kept = 0;
    if (RHO_MAX_COMMANDS == 0) {
        return;
    }
    for (unsigned i = 0; i < operated->num_commands; i++) {
        if (operated->commands[i].came_us < before_us) {
            refuse(node, &operated->commands[i], COMMAND_IS_LATE);
        } else {
            operated->commands[kept++] = operated->commands[i];
        }
    }
    operated->num_commands = (uint16_t)kept;
}

/* Changes one setting as if the node had been started with it. */
static void change_setting(struct rho_node *node, const struct rho_message_setting *setting,
                           struct rho_message_setting_answer *answer)
{
    struct rho_settings settings = node->settings;
    if (rho_command_set(setting, &settings, answer) == RHO_OK) {
        /* the range of a single sensor may conflict with the setting */
        answer->status = (int8_t)rho_node_set_settings(node, &settings);
        node->settings_changed = rho_count(node->settings_changed, answer->status == RHO_OK);
    }
}

void rho_node_commands_run(struct rho_node *node)
{
    struct rho_node_operator *operated = NODE_OPERATOR(node);
    for (unsigned i = 0; RHO_MAX_COMMANDS > 0 && i < operated->num_commands; i++) {
        struct rho_node_answer answer = {.is_setting = operated->commands[i].is_setting};
        if (answer.is_setting) {
            change_setting(node, &operated->commands[i].setting, &answer.setting);
        } else {
            (void)!rho_command_run(&operated->commands[i].command, &node->tracker, &node->report,
                                   &answer.command); /* the status is in the answer */
        }
        add_answer(node, &answer);
    }
    if (RHO_MAX_COMMANDS > 0) {
        operated->num_commands = 0;
    }
}

static int is_decoded(struct rho_node_command *waiting, const uint8_t *data, size_t size)
{
    return waiting->is_setting
               ? rho_message_setting_decode(data, size, &waiting->setting) == RHO_OK &&
                     rho_message_setting_validate(&waiting->setting, NULL) == RHO_OK
               : rho_message_command_decode(data, size, &waiting->command) == RHO_OK &&
                     rho_message_command_validate(&waiting->command, NULL) == RHO_OK;
}

static int is_channel(const char *channel, const char *other)
{
    while (channel && *channel && *channel == *other) {
        channel++;
        other++;
    }
    return channel && *channel == *other;
}

int rho_node_commands_take(struct rho_node *node, const char *channel, const uint8_t *data,
                           size_t size, int64_t now_us)
{
    struct rho_node_operator *operated = NODE_OPERATOR(node);
    struct rho_node_command waiting = {
        .came_us = now_us, .is_setting = is_channel(channel, RHO_MESSAGE_SETTING_CHANNEL)};
    if (RHO_MAX_COMMANDS == 0 ||
        (!waiting.is_setting && !is_channel(channel, RHO_MESSAGE_COMMAND_CHANNEL))) {
        return 0;
    }
    if (!node->options.takes_commands) {
        node->counters.commands_not_allowed = rho_count(node->counters.commands_not_allowed, 1);
    } else if (!is_decoded(&waiting, data, size)) {
        node->counters.commands_bad = rho_count(node->counters.commands_bad, 1);
    } else if (operated->num_commands != RHO_MAX_COMMANDS) {
        operated->commands[operated->num_commands++] = waiting;
    } else {
        refuse(node, &waiting, RHO_ERROR_CAPACITY);
    }
    return 1;
}
