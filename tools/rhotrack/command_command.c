/* SPDX-License-Identifier: MIT */
/* command: sends an operator's command or setting to a live node, and prints the node's answer. */
#include <errno.h>
#include <inttypes.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "base/name_hint.h"
#include "commands.h"
#include "live/command_words.h"
#include "rhotrack/command.h"
#include "rhotrack/message.h"
#include "transport/transport.h"

/* default position noise of a track that an operator starts at a place on a map */
#define SIGMA_M 100.0f
#define WAIT_S 15.0

static const char *action_name_at(size_t index)
{
    return index < COMMAND_ACTIONS    ? command_actions[index].name
           : index == COMMAND_ACTIONS ? "set"
                                      : NULL;
}

static const struct command_action *must_find_action(const char *name)
{
    const char *hint;

    for (size_t i = 0; i < COMMAND_ACTIONS; i++) {
        if (strcmp(command_actions[i].name, name) == 0) {
            return &command_actions[i];
        }
    }
    hint = name_hint_nearest(name, action_name_at);
    if (hint) {
        fail(EXIT_USAGE, "command: unknown action '%s', did you mean '%s'?", name, hint);
    }
    fail(EXIT_USAGE, "command: unknown action '%s'; see rhotrack command --help", name);
}

static int32_t parse_track_id(const char *text)
{
    char *end;
    const long number = strtol(text, &end, 10);

    if (*text < '0' || *text > '9' || *end || number < 1 || number > INT32_MAX) {
        fail(EXIT_USAGE, "command: '%s' is not a track's number, 1 .. %" PRId32, text, INT32_MAX);
    }
    return (int32_t)number;
}

/* True where a blank-separated list contains the first `length` characters of `word` as a word. */
static bool list_has_word(const char *list, const char *word, size_t length)
{
    for (; *list; list += strcspn(list, " "), list += strspn(list, " ")) {
        if (strcspn(list, " ") == length && strncmp(list, word, length) == 0) {
            return true;
        }
    }
    return false;
}

static bool is_key_given(char **arguments, int num_arguments, const char *key, size_t length)
{
    for (int i = 0; i < num_arguments; i++) {
        if (strncmp(arguments[i], key, length) == 0 && arguments[i][length] == '=') {
            return true;
        }
    }
    return false;
}

static void parse_key_value(const struct command_action *action, const char *text,
                            struct rho_message_command *command)
{
    const size_t length = strcspn(text, "=");
    float *field = command_words_member(command, text, length);
    char *end;

    if (text[length] != '=' || !field ||
        (!list_has_word(action->keys, text, length) &&
         !list_has_word(action->more, text, length))) {
        fail(EXIT_USAGE, "command: %s takes no '%s'; see rhotrack command --help", action->name,
             text);
    }
    *field = strtof(text + length + 1, &end);
    if (end == text + length + 1 || *end) {
        fail(EXIT_USAGE, "command: '%s' is not a number", text);
    }
}

/* Exit 2 unless the lower left corner of an area to exclude lies below its upper right corner. */
static void check_area_corners(const struct rho_message_command *command)
{
    const float low_m[2] = {command->x_m, command->y_m};
    const float high_m[2] = {command->x_max_m, command->y_max_m};

    for (int i = 0; i < 2; i++) {
        if (!(low_m[i] < high_m[i])) {
            fail(EXIT_USAGE, "command: exclude: %c_max_m=%g is not above %c_m=%g", "xy"[i],
                 (double)high_m[i], "xy"[i], (double)low_m[i]);
        }
    }
}

static struct rho_message_command parse_command(char **arguments, int num_arguments)
{
    const struct command_action *action = must_find_action(arguments[0]);
    struct rho_message_command command = {.action = action->action};
    struct rho_message_place place = {0};

    if (action->action == RHO_MESSAGE_COMMAND_START) {
        command.sigma_m = SIGMA_M;
    }
    if (num_arguments - 1 < action->num_numbers) {
        fail(EXIT_USAGE, "command: %s needs %s", action->name,
             action->num_numbers > 1 ? "a track's number and a new one" : "a track's number");
    }
    command.track_id = action->num_numbers > 0 ? parse_track_id(arguments[1]) : 0;
    command.new_id = action->num_numbers > 1 ? parse_track_id(arguments[2]) : 0;
    arguments += 1 + action->num_numbers;
    num_arguments -= 1 + action->num_numbers;
    for (int i = 0; i < num_arguments; i++) {
        parse_key_value(action, arguments[i], &command);
        if (is_key_given(arguments, i, arguments[i], strcspn(arguments[i], "="))) {
            fail(EXIT_USAGE, "command: %.*s is given twice", (int)strcspn(arguments[i], "="),
                 arguments[i]);
        }
    }
    for (const char *key = action->keys; *key; key += strcspn(key, " "), key += strspn(key, " ")) {
        if (!is_key_given(arguments, num_arguments, key, strcspn(key, " "))) {
            fail(EXIT_USAGE, "command: %s needs %.*s=VALUE", action->name, (int)strcspn(key, " "),
                 key);
        }
    }
    if (rho_message_command_validate(&command, &place) != RHO_OK) {
        fail(EXIT_USAGE, "command: %s is outside its range", rho_message_command_field(&place));
    }
    if (action->action == RHO_MESSAGE_COMMAND_EXCLUDE) {
        check_area_corners(&command);
    }
    return command;
}

static const char *setting_name_at(size_t index)
{
    return rho_command_setting_name((int)index + 1);
}

static struct rho_message_setting parse_set_name_and_value(char **arguments, int num_arguments)
{
    struct rho_message_setting setting = {0};
    const char *name, *hint;
    char *end;

    if (num_arguments != 3) {
        fail(EXIT_USAGE, "command: set needs a setting's name and a value");
    }
    for (int16_t i = 1; setting.field == 0 && (name = rho_command_setting_name(i)); i++) {
        setting.field = strcmp(name, arguments[1]) == 0 ? i : 0;
    }
    if (setting.field == 0) {
        hint = name_hint_nearest(arguments[1], setting_name_at);
        if (hint) {
            fail(EXIT_USAGE, "command: no setting '%s', did you mean '%s'?", arguments[1], hint);
        }
        fail(EXIT_USAGE, "command: no setting '%s'; see rhotrack command --help", arguments[1]);
    }
    setting.value = strtof(arguments[2], &end);
    if (end == arguments[2] || *end ||
        rho_message_setting_validate(&setting, &(struct rho_message_place){0}) != RHO_OK) {
        fail(EXIT_USAGE, "command: '%s' is not a number", arguments[2]);
    }
    return setting;
}

static void print_setting_answer_or_fail(const struct rho_message_setting_answer *answer)
{
    static const char *const when[] = {"", "from the next step on",
                                       "from the next step on; the initiation window begins anew",
                                       "with the next scan of each sensor that has no own value",
                                       "with the next plots that say no noise of their own"};
    char why[COMMAND_REASON_BYTES];

    if (answer->status == RHO_OK) {
        printf("done: %s %g, %s\n", rho_command_setting_name(answer->field), (double)answer->value,
               when[answer->applies]);
        return;
    }
    command_words_setting_refusal(answer, why);
    fail(EXIT_RUNTIME, "refused: %s", why);
}

/* The answer to a setting where is_setting, else the answer to a command. */
struct answer {
    bool is_setting;
    struct rho_message_command_answer command;
    struct rho_message_setting_answer setting;
};

static bool decode_matching_answer(const struct transport_message *message, int32_t number,
                                   struct answer *answer)
{
    if (answer->is_setting) {
        return strcmp(message->channel, RHO_MESSAGE_SETTING_ANSWER_CHANNEL) == 0 &&
               rho_message_setting_answer_decode(message->data, message->size, &answer->setting) ==
                   RHO_OK &&
               rho_message_setting_answer_validate(&answer->setting, NULL) == RHO_OK &&
               answer->setting.number == number;
    }
    return strcmp(message->channel, RHO_MESSAGE_COMMAND_ANSWER_CHANNEL) == 0 &&
           rho_message_command_answer_decode(message->data, message->size, &answer->command) ==
               RHO_OK &&
           rho_message_command_answer_validate(&answer->command, NULL) == RHO_OK &&
           answer->command.number == number;
}

static bool await_answer(struct transport *transport, int32_t number, int64_t end_us,
                         struct answer *answer)
{
    struct pollfd here = {.fd = transport_descriptor(transport), .events = POLLIN};
    struct transport_message message;

    for (int64_t left_us; (left_us = end_us - monotonic_clock_us()) > 0;) {
        switch (transport_receive(transport, &message)) {
        case TRANSPORT_MESSAGE:
            if (decode_matching_answer(&message, number, answer)) {
                return true;
            }
            break;
        case TRANSPORT_NOTHING:
            (void)poll(&here, 1, (int)(left_us / 1000 < 100 ? left_us / 1000 + 1 : 100));
            break;
        default:
            return false;
        }
    }
    return false;
}

/* Sends a command or setting and waits for the node's answer; exit 1 where none comes in wait_s. */
static void send_and_await_answer_or_fail(struct transport *transport, const char *channel,
                                          const uint8_t *data, size_t size, int32_t number,
                                          double wait_s, struct answer *answer)
{
    if (!transport_send(transport, channel, data, size)) {
        fail(EXIT_RUNTIME, "%s: the command is not sent: %s", transport_url(transport),
             strerror(errno));
    }
    if (!await_answer(transport, number, monotonic_clock_us() + (int64_t)(wait_s * 1e6), answer)) {
        fail(EXIT_RUNTIME, "no answer in %g s: no node with --commands has made a step", wait_s);
    }
}

static void print_command_answer_or_fail(const struct rho_message_command_answer *answer)
{
    if (answer->status != RHO_OK) {
        fail(EXIT_RUNTIME, "refused: %s", command_words_refusal(answer->status));
    }
    if (answer->track_id > 0) {
        printf("done: track %" PRId32 "\n", answer->track_id);
    } else {
        puts("done");
    }
}

int command_command(struct command_line *line)
{
    struct answer answer = {.is_setting = strcmp(line->arguments[0], "set") == 0};
    struct rho_message_command command = {0};
    struct rho_message_setting setting = {0};
    const double wait_s = line->seconds > 0 ? line->seconds : WAIT_S;
    uint8_t buffer[RHO_MESSAGE_COMMAND_MAX_SIZE];
    struct transport *transport;
    size_t size;

    if (answer.is_setting) {
        setting = parse_set_name_and_value(line->arguments, line->num_arguments);
    } else {
        command = parse_command(line->arguments, line->num_arguments);
    }
    transport = transport_open(line->lcm, TRANSPORT_SEND_AND_RECEIVE);
    command.utime = setting.utime = transport_now_us(transport);
    command.number = setting.number = (int32_t)(command.utime & INT32_MAX);
    must_succeed(answer.is_setting
                     ? rho_message_setting_encode(&setting, buffer, sizeof buffer, &size)
                     : rho_message_command_encode(&command, buffer, sizeof buffer, &size),
                 "command");
    send_and_await_answer_or_fail(
        transport, answer.is_setting ? RHO_MESSAGE_SETTING_CHANNEL : RHO_MESSAGE_COMMAND_CHANNEL,
        buffer, size, command.number, wait_s, &answer);
    if (answer.is_setting) {
        print_setting_answer_or_fail(&answer.setting);
    } else {
        print_command_answer_or_fail(&answer.command);
    }
    transport_close(transport);
    return 0;
}
