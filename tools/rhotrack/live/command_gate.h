/* SPDX-License-Identifier: MIT */
/*
 * command_gate: the operator's messages (RHO_COMMANDS, RHO_SETTINGS) that a live node does. One
 * message may blind it, so each is said with its sender and outcome; one that is done has a line
 * always. Nothing proves who sends: by --commands-from only some addresses may, and all together
 * no more than COMMANDS_A_S a second, so that a flood costs no scan, nor fills the disk by lines.
 *
 *     if (!command_gate_admits(&gate, &message, node_core_settings(core), stderr)) {
 *         return;
 *     }
 *     node_core_take_message(core, ...);
 *
 * and for each message that the core sends
 *
 *     command_gate_note_answer(&gate, channel, data, size, stderr);
 */
#ifndef RHOTRACK_TOOL_COMMAND_GATE_H
#define RHOTRACK_TOOL_COMMAND_GATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "live/command_words.h"
#include "rhotrack/config.h"
#include "rhotrack/message.h"
#include "rhotrack/udpm.h"
#include "transport/transport.h"

/*
 * Far above what a person at a map does. COMMANDS_AT_ONCE: a program that does not wait for answers
 * may fill a node's places for waiting commands, RHO_MAX_COMMANDS.
 */
enum { COMMANDS_A_S = 10, COMMANDS_AT_ONCE = 20 };

/* A command or setting, and its sender. */
struct command_heard {
    bool is_setting, is_valid;
    struct rho_message_command command;
    struct rho_message_setting setting;
    struct transport_sender sender;
};

/* All zero: a node that takes no commands. */
struct command_gate {
    bool is_open;               /* the node takes commands */
    struct rho_udpm_guard from; /* addresses that may command; it counts the others' messages */
    uint64_t beyond;            /* messages beyond COMMANDS_A_S */
    /* times at which the buckets of commands and of lines of refused ones are full again */
    int64_t commands_us, lines_us;
    /* messages that the node has and has not answered: it waits for a step */
    unsigned num_waiting;
    struct command_heard waiting[RHO_MAX_COMMANDS + 1];
    float values[COMMAND_SETTINGS + 1]; /* of the settings, before the next answer */
};

/*
 * A gate for the options --commands and --commands-from. Exit 2 where the addresses are none, or
 * where the transport of the URL does not tell senders.
 *   from  NULL: any address
 */
struct command_gate command_gate_open(bool takes_commands, const char *from, const char *url);

/*
 * True where the node is to take the message: any but an operator's that is refused here. Prints
 * a line of one that is refused or not valid; of many in a row one a second.
 *   settings  the node's
 *   to        NULL: prints nothing
 */
bool command_gate_admits(struct command_gate *gate, const struct transport_message *message,
                         const struct rho_settings *settings, FILE *to);

/* Prints a line where a message that the node sends is its answer to an operator. */
void command_gate_note_answer(struct command_gate *gate, const char *channel, const uint8_t *data,
                              size_t size, FILE *to);

#endif
