/* SPDX-License-Identifier: MIT */
/*
 * page_server: one page of text over HTTP on 127.0.0.1, for a program that must not wait.
 *
 * It is no thread and no library: it waits in the program's own poll, by one descriptor, so the
 * text is made between two steps and needs no lock. What clients do is bounded: each call takes a
 * few of them, a request has 4 KiB and 2 s from the connection to the last byte of its answer, and
 * where all places are taken the one that has been there longest goes. The page is made ten times a
 * second at most, however often it is asked for.
 */
#ifndef RHOTRACK_TOOL_PAGE_SERVER_H
#define RHOTRACK_TOOL_PAGE_SERVER_H

#include <stdint.h>
#include <stdio.h>

struct page_server;

/* Writes the page. */
typedef void page_server_write(FILE *out, void *context);

/*
 * NULL for port 0. A port that is taken, and whatever else does not listen: exit 1.
 *   path  of the page: "/metrics"
 */
struct page_server *page_server_open(uint16_t port, const char *path, const char *type,
                                     page_server_write *write, void *context);

/* All of the functions below take NULL for: there is none. */

/* To poll for POLLIN; -1: none. */
int page_server_descriptor(const struct page_server *server);

/* Does what is there to do now, where the descriptor is readable and once a second. */
void page_server_serve(struct page_server *server);

/* Answers with the page; other answers, and clients that were cut off. */
uint64_t page_server_num_sent(const struct page_server *server);
uint64_t page_server_num_refused(const struct page_server *server);

void page_server_close(struct page_server *server);

#endif
