/* SPDX-License-Identifier: MIT */
/*
 * publish: what both sorts of `publish` share: files that are played, and radars that are heard
 * live.
 */
#ifndef RHOTRACK_TOOL_PUBLISH_H
#define RHOTRACK_TOOL_PUBLISH_H

#include "command_line.h"
#include "transport/transport.h"

#define PUBLISH_EPOCH_OF_CSV 1 /* where rows do not say one */

/* SIGINT, SIGTERM and (but under nohup) SIGHUP stop it. */
void publish_watch_signals(void);
bool publish_is_stopped(void);

/*
 * The boot number of this run: the time in units of 2 ms, as two runs may begin within a second;
 * never 0.
 */
int32_t publish_run_epoch(void);

/*
 * Sends a message, again where the network has no room for a moment. False: too long for a
 * datagram. Errors: exit 1.
 */
bool publish_send_message(struct transport *transport, const char *channel, const uint8_t *data,
                          size_t size);

/* Forwards what radars send in ASTERIX to the URL that is the command's input. */
int publish_asterix(const struct command_line *line);

#endif
