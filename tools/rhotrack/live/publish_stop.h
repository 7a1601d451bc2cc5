/* SPDX-License-Identifier: MIT */
/*
 * publish_stop: shared by both kinds of `publish`: playing files and
 * forwarding live ASTERIX.
 */
#ifndef RHOTRACK_TOOL_PUBLISH_STOP_H
#define RHOTRACK_TOOL_PUBLISH_STOP_H

#include "command_line.h"
#include "transport/transport.h"

#define PUBLISH_EPOCH_OF_CSV 1 /* epoch of messages made of CSV rows without a column epoch */

/* SIGINT, SIGTERM and (unless ignored, as by nohup) SIGHUP then stop publishing. */
void publish_watch_signals(void);
bool publish_is_stopped(void);

/*
 * Boot number of this run for messages' epochs, never 0: the time in units of 2 ms, as two runs may
 * begin within one second.
 */
int32_t publish_run_epoch(void);

/*
 * Sends a message, and retries for 0.1 s while the network is busy. Returns false where the message
 * is too long for a datagram; exit 1 on other errors.
 */
bool publish_send_message(struct transport *transport, const char *channel, const uint8_t *data,
                          size_t size);

/*
 * Receives ASTERIX at the command's input udp://ADDRESS:PORT, and publishes its scans as messages.
 */
int publish_asterix(const struct command_line *line);

#endif
