/* SPDX-License-Identifier: MIT */
/*
 * identities: any int32 identities numbered from 0 in the order in which they come; a hash that
 * grows.
 */
#ifndef RHOTRACK_TOOL_IDENTITIES_H
#define RHOTRACK_TOOL_IDENTITIES_H

#include <stddef.h>
#include <stdint.h>

/* Begins as {0}. */
struct identities {
    int32_t *ids; /* count, by number */
    size_t count, capacity;
    size_t *slots; /* number + 1, 0: free; num_slots is a power of two */
    size_t num_slots;
};

/* The identity's number; `count` as it was before where it is new. */
size_t identities_number(struct identities *identities, int32_t id);

void identities_free(struct identities *identities);

#endif
