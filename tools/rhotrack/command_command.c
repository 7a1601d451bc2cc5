/* SPDX-License-Identifier: MIT */
/* command: an operator's word to a live tracker, and its answer. */
#include <errno.h>
#include <inttypes.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "base/hint.h"
#include "commands.h"
#include "live/transport.h"
#include "rhotrack/message.h"

#define SIGMA_M 100.0f /* of a place that a person points at */
#define WAIT_S 15.0

/* ---- What is said ---- */

static const struct action {
    const char *name;
    int8_t action;
    int num_numbers;  /* that follow it: tracks */
    const char *keys; /* that it needs, and others that it takes */
    const char *more;
} actions[] = {
    {"start", RHO_MESSAGE_COMMAND_START, 0, "x_m y_m", "sigma_m vx_mps vy_mps sigma_mps"},
    {"drop", RHO_MESSAGE_COMMAND_DROP, 1, "", ""},
    {"renumber", RHO_MESSAGE_COMMAND_RENUMBER, 2, "", ""},
    {"freeze", RHO_MESSAGE_COMMAND_FREEZE, 1, "", ""},
    {"thaw", RHO_MESSAGE_COMMAND_THAW, 1, "", ""},
    {"exclude", RHO_MESSAGE_COMMAND_EXCLUDE, 0, "x_m y_m x_max_m y_max_m", ""},
    {"include", RHO_MESSAGE_COMMAND_INCLUDE, 0, "x_m y_m", ""},
};

enum { NUM_ACTIONS = sizeof actions / sizeof *actions };

static const char *action_name(size_t index)
{
    return index < NUM_ACTIONS ? actions[index].name : NULL;
}

static const struct action *find_action(const char *name)
{
    const char *hint;

    for (size_t i = 0; i < NUM_ACTIONS; i++) {
        if (strcmp(actions[i].name, name) == 0) {
            return &actions[i];
        }
    }
    hint = hint_nearest(name, action_name);
    if (hint) {
        fail(EXIT_USAGE, "command: unknown action '%s', did you mean '%s'?", name, hint);
    }
    fail(EXIT_USAGE, "command: unknown action '%s'; see rhotrack command --help", name);
}

static int32_t read_track(const char *text)
{
    char *end;
    const long number = strtol(text, &end, 10);

    if (*text < '0' || *text > '9' || *end || number < 1 || number > INT32_MAX) {
        fail(EXIT_USAGE, "command: '%s' is no track's number, 1 .. %" PRId32, text, INT32_MAX);
    }
    return (int32_t)number;
}

/* Whether the words of a list hold this one of so many letters. */
static bool has_word(const char *list, const char *word, size_t length)
{
    for (; *list; list += strcspn(list, " "), list += strspn(list, " ")) {
        if (strcspn(list, " ") == length && strncmp(list, word, length) == 0) {
            return true;
        }
    }
    return false;
}

static float *field_of(struct rho_message_command *command, const char *key, size_t length)
{
    const struct {
        const char *name;
        float *value;
    } fields[] = {{"x_m", &command->x_m},         {"y_m", &command->y_m},
                  {"x_max_m", &command->x_max_m}, {"y_max_m", &command->y_max_m},
                  {"sigma_m", &command->sigma_m}, {"sigma_mps", &command->sigma_mps},
                  {"vx_mps", &command->vx_mps},   {"vy_mps", &command->vy_mps}};

    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++) {
        if (strlen(fields[i].name) == length && strncmp(fields[i].name, key, length) == 0) {
            return fields[i].value;
        }
    }
    return NULL;
}

static bool is_given(char **arguments, int num_arguments, const char *key, size_t length)
{
    for (int i = 0; i < num_arguments; i++) {
        if (strncmp(arguments[i], key, length) == 0 && arguments[i][length] == '=') {
            return true;
        }
    }
    return false;
}

static void read_value(const struct action *action, const char *text,
                       struct rho_message_command *command)
{
    const size_t length = strcspn(text, "=");
    float *field = field_of(command, text, length);
    char *end;

    if (text[length] != '=' || !field ||
        (!has_word(action->keys, text, length) && !has_word(action->more, text, length))) {
        fail(EXIT_USAGE, "command: %s takes no '%s'; see rhotrack command --help", action->name,
             text);
    }
    *field = strtof(text + length + 1, &end);
    if (end == text + length + 1 || *end) {
        fail(EXIT_USAGE, "command: '%s' is not a number", text);
    }
}

/* An area has its lower left corner first. */
static void check_corners(const struct rho_message_command *command)
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

static struct rho_message_command read_command(char **arguments, int num_arguments)
{
    const struct action *action = find_action(arguments[0]);
    struct rho_message_command command = {.action = action->action};
    struct rho_message_place place = {0};

    if (action->action == RHO_MESSAGE_COMMAND_START) {
        command.sigma_m = SIGMA_M;
    }
    if (num_arguments - 1 < action->num_numbers) {
        fail(EXIT_USAGE, "command: %s needs %s", action->name,
             action->num_numbers > 1 ? "a track's number and a new one" : "a track's number");
    }
    command.track_id = action->num_numbers > 0 ? read_track(arguments[1]) : 0;
    command.new_id = action->num_numbers > 1 ? read_track(arguments[2]) : 0;
    arguments += 1 + action->num_numbers;
    num_arguments -= 1 + action->num_numbers;
    for (int i = 0; i < num_arguments; i++) {
        read_value(action, arguments[i], &command);
        if (is_given(arguments, i, arguments[i], strcspn(arguments[i], "="))) {
            fail(EXIT_USAGE, "command: %.*s is given twice", (int)strcspn(arguments[i], "="),
                 arguments[i]);
        }
    }
    for (const char *key = action->keys; *key; key += strcspn(key, " "), key += strspn(key, " ")) {
        if (!is_given(arguments, num_arguments, key, strcspn(key, " "))) {
            fail(EXIT_USAGE, "command: %s needs %.*s=VALUE", action->name, (int)strcspn(key, " "),
                 key);
        }
    }
    if (rho_message_command_validate(&command, &place) != RHO_OK) {
        fail(EXIT_USAGE, "command: %s is outside its range", rho_message_command_field(&place));
    }
    if (action->action == RHO_MESSAGE_COMMAND_EXCLUDE) {
        check_corners(&command);
    }
    return command;
}

/* ---- The answer ---- */

static bool is_answer(const struct transport_message *message, int32_t number,
                      struct rho_message_command_answer *answer)
{
    return strcmp(message->channel, RHO_MESSAGE_COMMAND_ANSWER_CHANNEL) == 0 &&
           rho_message_command_answer_decode(message->data, message->size, answer) == RHO_OK &&
           rho_message_command_answer_validate(answer, NULL) == RHO_OK && answer->number == number;
}

static bool await_answer(struct transport *transport, int32_t number, int64_t end_us,
                         struct rho_message_command_answer *answer)
{
    struct pollfd here = {.fd = transport_descriptor(transport), .events = POLLIN};
    struct transport_message message;

    for (int64_t left_us; (left_us = end_us - clock_us()) > 0;) {
        switch (transport_receive(transport, &message)) {
        case TRANSPORT_MESSAGE:
            if (is_answer(&message, number, answer)) {
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

static const char *reason_of(int8_t status)
{
    switch (status) {
    case RHO_ERROR_VALUE:
        return "no such track or place, or an identity that is taken";
    case RHO_ERROR_STATE:
        return "the track is tentative, or the node has made no step";
    case RHO_ERROR_CAPACITY:
        return "there is no room";
    default:
        return rho_status_name((enum rho_status)status);
    }
}

int command_command(struct command_line *line)
{
    struct rho_message_command command = read_command(line->arguments, line->num_arguments);
    const double wait_s = line->seconds > 0 ? line->seconds : WAIT_S;
    struct rho_message_command_answer answer;
    struct transport *transport = transport_open(line->lcm, TRANSPORT_SEND_AND_RECEIVE);
    uint8_t buffer[RHO_MESSAGE_COMMAND_MAX_SIZE];
    size_t size;

    command.utime = transport_now_us(transport);
    command.number = (int32_t)(command.utime & INT32_MAX);
    must_succeed(rho_message_command_encode(&command, buffer, sizeof buffer, &size), "command");
    if (!transport_send(transport, RHO_MESSAGE_COMMAND_CHANNEL, buffer, size)) {
        fail(EXIT_RUNTIME, "%s: the command is not sent: %s", transport_url(transport),
             strerror(errno));
    }
    if (!await_answer(transport, command.number, clock_us() + (int64_t)(wait_s * 1e6), &answer)) {
        fail(EXIT_RUNTIME, "no answer in %g s: no node with --commands has made a step", wait_s);
    }
    if (answer.status != RHO_OK) {
        fail(EXIT_RUNTIME, "refused: %s", reason_of(answer.status));
    }
    if (answer.track_id > 0) {
        printf("done: track %" PRId32 "\n", answer.track_id);
    } else {
        puts("done");
    }
    transport_close(transport);
    return 0;
}
