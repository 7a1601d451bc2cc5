/* SPDX-License-Identifier: MIT */
/*
 * identity_numbers: any int32 identities numbered from 0 in the order in which they come; a hash
 * that grows.
 */
#ifndef RHOTRACK_TOOL_IDENTITY_NUMBERS_H
#define RHOTRACK_TOOL_IDENTITY_NUMBERS_H

#include <stddef.h>
#include <stdint.h>

/* Begins as {0}. */
struct identity_numbers {
    int32_t *ids; /* count, by number */
    size_t count, capacity;
    size_t *slots; /* number + 1, 0: free; num_slots is a power of two */
    size_t num_slots;
};

/* The identity's number. A new one gets the next, which is `count` as it was before. */
size_t identity_numbers_find_or_add(struct identity_numbers *identities, int32_t id);

void identity_numbers_free(struct identity_numbers *identities);

#endif
