/* SPDX-License-Identifier: MIT */
/*
 * metrics_page_server: serves one page of text over HTTP on 127.0.0.1, for a program that must not
 * block.
 *
 * There is no thread: the server is polled with the program's other descriptors, so the page is
 * made between two steps and needs no lock. The load by clients is bounded: each call serves a few
 * of them; a request has 4 KiB at most, and 2 s from the connection to the last byte of the answer;
 * where all places are taken the oldest client is dropped; and the page is made at most ten times a
 * second.
 */
#ifndef RHOTRACK_TOOL_METRICS_PAGE_SERVER_H
#define RHOTRACK_TOOL_METRICS_PAGE_SERVER_H

#include <stdint.h>
#include <stdio.h>

struct page_server;

/* Callback that writes the page's text. */
typedef void page_server_write(FILE *out, void *context);

/*
 * Listens on a port of 127.0.0.1; returns NULL for port 0. Exit 1 where listening fails.
 *   path  path of the page in its URL: "/metrics"
 */
struct page_server *page_server_open(uint16_t port, const char *path, const char *type,
                                     page_server_write *write, void *context);

/* All functions below accept NULL, no server. */

/* Descriptor to poll for POLLIN; -1: none. */
int page_server_poll_descriptor(const struct page_server *server);

/*
 * Accepts and serves clients without waiting; call where the descriptor is readable, and once a
 * second.
 */
void page_server_serve(struct page_server *server);

/* Numbers of answers with the page, and of refused requests and dropped clients. */
uint64_t page_server_num_sent(const struct page_server *server);
uint64_t page_server_num_refused(const struct page_server *server);

void page_server_close(struct page_server *server);

#endif
