/* SPDX-License-Identifier: MIT */
/*
 * command_words: an operator's commands and settings in the words of `rhotrack command`, for its
 * command line, and for what a node says of them.
 */
#ifndef RHOTRACK_TOOL_COMMAND_WORDS_H
#define RHOTRACK_TOOL_COMMAND_WORDS_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "rhotrack/message.h"
#include "rhotrack/settings.h"

struct command_action {
    const char *name;
    int8_t action;
    int num_numbers;  /* track identities that follow the action's name */
    const char *keys; /* keys that the action requires; `more`: keys that it also accepts */
    const char *more;
};

enum { COMMAND_ACTIONS = 7, COMMAND_SETTINGS = RHO_MESSAGE_SETTING_STANDING };

extern const struct command_action command_actions[COMMAND_ACTIONS];

/* The member of a command that the first `length` characters of a key name; NULL: none. */
float *command_words_member(struct rho_message_command *command, const char *key, size_t length);

/* Prints a valid command as it is typed: "exclude x_m=0 y_m=0 x_max_m=9 y_max_m=9". */
void command_words_print(const struct rho_message_command *command, FILE *to);

/* Why a node refused a command, by the status in its answer. */
const char *command_words_refusal(int8_t status);

/* Why a node refused a setting. */
#define COMMAND_REASON_BYTES 160
void command_words_setting_refusal(const struct rho_message_setting_answer *answer,
                                   char why[COMMAND_REASON_BYTES]);

/* The values of the settings that a message can change, by the number that it gives them. */
void command_words_setting_values(const struct rho_settings *settings,
                                  float values[COMMAND_SETTINGS + 1]);

#endif
