/* SPDX-License-Identifier: MIT */
#include "live/command_gate.h"

#include <inttypes.h>
#include <string.h>

#include "base/common.h"
#include "rhotrack/command.h"
#include "transport/address_list.h"

#define SECOND_US 1000000
/* lines of refused messages, of which the counts tell the number: one a second, and so many once */
#define LINES_AT_ONCE 10

struct command_gate command_gate_open(bool takes_commands, const char *from, const char *url)
{
    struct command_gate gate = {.is_open = takes_commands || from};
    char reason[ADDRESS_LIST_REASON_BYTES];

    if (from && !transport_url_tells_senders(url)) {
        fail(EXIT_USAGE, "node: --commands-from needs udpm://...: other URLs tell no sender");
    }
    if (from && !address_list_parse("--commands-from", from, &gate.from, reason)) {
        fail(EXIT_USAGE, "%s", reason);
    }
    return gate;
}

/* ---- Lines ---- */

/*
 * Prints a message in words, with its sender where that is known; no end of the line.
 *   before  the value that a setting had before it was changed; NULL: it was not
 */
static void print_heard(const struct command_heard *heard, const float *before, FILE *to)
{
    fprintf(to, "rhotrack: %s: ", heard->is_setting ? "setting" : "command");
    if (!heard->is_valid) {
        fputs("no valid message", to);
    } else if (!heard->is_setting) {
        command_words_print(&heard->command, to);
    } else {
        fputs(rho_command_setting_name(heard->setting.field), to);
        if (before) {
            fprintf(to, " %.7g ->", (double)*before);
        }
        fprintf(to, " %.7g", (double)heard->setting.value);
    }
    if (heard->sender.port != 0) {
        fputs(", from ", to);
        transport_print_sender(&heard->sender, to);
    }
}

static void print_refused(const struct command_heard *heard, const char *why, FILE *to)
{
    print_heard(heard, NULL, to);
    fprintf(to, ": refused: %s\n", why);
}

/* ---- Messages ---- */

/*
 * Takes a token of a bucket that gets one each interval_us and holds `room`. Its one number is the
 * time at which it is full again. A log that is replayed may go back in time: the bucket is full.
 */
static bool take_token(int64_t *full_us, int64_t now_us, int64_t interval_us, int room)
{
    if (*full_us < now_us || *full_us > now_us + room * interval_us) {
        *full_us = now_us;
    }
    if (*full_us + interval_us > now_us + room * interval_us) {
        return false;
    }
    *full_us += interval_us;
    return true;
}

/* Decodes an operator's message. Returns false where the channel is not an operator's. */
static bool hear_message(const struct transport_message *message, struct command_heard *heard)
{
    *heard = (struct command_heard){
        .is_setting = strcmp(message->channel, RHO_MESSAGE_SETTING_CHANNEL) == 0,
        .sender = message->sender,
    };
    if (heard->is_setting) {
        heard->is_valid =
            rho_message_setting_decode(message->data, message->size, &heard->setting) == RHO_OK &&
            rho_message_setting_validate(&heard->setting, NULL) == RHO_OK;
        return true;
    }
    heard->is_valid =
        rho_message_command_decode(message->data, message->size, &heard->command) == RHO_OK &&
        rho_message_command_validate(&heard->command, NULL) == RHO_OK;
    return strcmp(message->channel, RHO_MESSAGE_COMMAND_CHANNEL) == 0;
}

static void remember_until_answer(struct command_gate *gate, const struct command_heard *heard,
                                  const struct rho_settings *settings)
{
    if (gate->num_waiting == 0) { /* else the answers to come start from the values that are here */
        command_words_setting_values(settings, gate->values);
    }
    if (gate->num_waiting == sizeof gate->waiting / sizeof *gate->waiting) {
        gate->num_waiting--;
        memmove(gate->waiting, gate->waiting + 1, gate->num_waiting * sizeof *gate->waiting);
    }
    gate->waiting[gate->num_waiting++] = *heard;
}

bool command_gate_admits(struct command_gate *gate, const struct transport_message *message,
                         const struct rho_settings *settings, FILE *to)
{
    struct command_heard heard;
    const char *why = NULL;
    bool is_for_node = true; /* which counts what it refuses itself */

    if (strncmp(message->channel, "RHO_", 4) != 0 || !hear_message(message, &heard)) {
        return true;
    }
    if (!gate->is_open) {
        why = "the node runs without --commands";
    } else if (!rho_udpm_admits(&gate->from, message->sender.address)) {
        why = "the address is not in --commands-from";
        is_for_node = false;
    } else if (!take_token(&gate->commands_us, message->received_us, SECOND_US / COMMANDS_A_S,
                           COMMANDS_AT_ONCE)) {
        why = "more commands than are taken in a second";
        gate->beyond++;
        is_for_node = false;
    } else if (!heard.is_valid) {
        why = "another version, or a value outside its range";
    }
    if (!why) {
        remember_until_answer(gate, &heard, settings);
    } else if (to && take_token(&gate->lines_us, message->received_us, SECOND_US, LINES_AT_ONCE)) {
        print_refused(&heard, why, to);
    }
    return is_for_node;
}

/* ---- Answers ---- */

/* Takes the message that an answer is of out of those that wait. Returns false where it is none. */
static bool recall_message(struct command_gate *gate, bool is_setting, int32_t number, int about,
                           struct command_heard *heard)
{
    for (unsigned i = 0; i < gate->num_waiting; i++) {
        *heard = gate->waiting[i];
        if (heard->is_setting == is_setting &&
            (is_setting ? heard->setting.number == number && heard->setting.field == about
                        : heard->command.number == number && heard->command.action == about)) {
            gate->num_waiting--;
            memmove(gate->waiting + i, gate->waiting + i + 1,
                    (gate->num_waiting - i) * sizeof *gate->waiting);
            return true;
        }
    }
    return false;
}

static void note_command_answer(struct command_gate *gate,
                                const struct rho_message_command_answer *answer, FILE *to)
{
    struct command_heard heard;

    if (!recall_message(gate, false, answer->number, answer->action, &heard) || !to) {
        return;
    }
    if (answer->status != RHO_OK) {
        print_refused(&heard, command_words_refusal(answer->status), to);
        return;
    }
    print_heard(&heard, NULL, to);
    if (answer->action == RHO_MESSAGE_COMMAND_START) {
        fprintf(to, ": track %" PRId32, answer->track_id);
    }
    fputs("\n", to);
}

static void note_setting_answer(struct command_gate *gate,
                                const struct rho_message_setting_answer *answer, FILE *to)
{
    struct command_heard heard;
    char why[COMMAND_REASON_BYTES];
    float *value;

    if (!recall_message(gate, true, answer->number, answer->field, &heard)) {
        return;
    }
    value = &gate->values[answer->field]; /* a field of settings, as the message was valid */
    if (to && answer->status != RHO_OK) {
        command_words_setting_refusal(answer, why);
        print_refused(&heard, why, to);
    } else if (to) {
        print_heard(&heard, value, to);
        fputs("\n", to);
    }
    *value = answer->status == RHO_OK ? answer->value : *value;
}

void command_gate_note_answer(struct command_gate *gate, const char *channel, const uint8_t *data,
                              size_t size, FILE *to)
{
    struct rho_message_command_answer command;
    struct rho_message_setting_answer setting;

    if (gate->num_waiting == 0) {
        return;
    }
    if (strcmp(channel, RHO_MESSAGE_COMMAND_ANSWER_CHANNEL) == 0 &&
        rho_message_command_answer_decode(data, size, &command) == RHO_OK) {
        note_command_answer(gate, &command, to);
    } else if (strcmp(channel, RHO_MESSAGE_SETTING_ANSWER_CHANNEL) == 0 &&
               rho_message_setting_answer_decode(data, size, &setting) == RHO_OK) {
        note_setting_answer(gate, &setting, to);
    }
}
