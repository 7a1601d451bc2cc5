/* SPDX-License-Identifier: MIT */
/* address_list: permitted senders of datagrams, from an option's text. */
#ifndef RHOTRACK_TOOL_ADDRESS_LIST_H
#define RHOTRACK_TOOL_ADDRESS_LIST_H

#include <stdbool.h>

#include "rhotrack/udpm.h"

#define ADDRESS_LIST_REASON_BYTES 120

/*
 * Adds the addresses of an option's text, ADDRESS,ADDRESS,..., to a guard. Returns false with the
 * reason, which names the option, where one is no IPv4 address, where there are more than
 * RHO_UDPM_MAX_SOURCES, or none.
 */
bool address_list_parse(const char *option, const char *text, struct rho_udpm_guard *guard,
                        char reason[ADDRESS_LIST_REASON_BYTES]);

#endif
