/* SPDX-License-Identifier: MIT */
#include "transport/address_list.h"

#include <arpa/inet.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"

static bool add_address(const char *option, const char *word, struct rho_udpm_guard *guard,
                        char reason[ADDRESS_LIST_REASON_BYTES])
{
    struct in_addr address;

    if (inet_pton(AF_INET, word, &address) != 1) {
        snprintf(reason, ADDRESS_LIST_REASON_BYTES, "%s: '%.60s' is not an IPv4 address", option,
                 word);
        return false;
    }
    if (guard->num_sources == RHO_UDPM_MAX_SOURCES) {
        snprintf(reason, ADDRESS_LIST_REASON_BYTES, "%s: more than %d addresses", option,
                 RHO_UDPM_MAX_SOURCES);
        return false;
    }
    guard->sources[guard->num_sources++] = ntohl(address.s_addr);
    return true;
}

bool address_list_parse(const char *option, const char *text, struct rho_udpm_guard *guard,
                        char reason[ADDRESS_LIST_REASON_BYTES])
{
    char *copy = must_copy_text(text), *rest = NULL;
    char *word = strtok_r(copy, ",", &rest);
    bool is_list = word != NULL;

    if (!is_list) {
        snprintf(reason, ADDRESS_LIST_REASON_BYTES, "%s has no address", option);
    }
    for (; word && is_list; word = strtok_r(NULL, ",", &rest)) {
        is_list = add_address(option, word, guard, reason);
    }
    free(copy);
    return is_list;
}
