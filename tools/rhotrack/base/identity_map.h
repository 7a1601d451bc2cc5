/* SPDX-License-Identifier: MIT */
/*
 * identity_map: numbers int32 identities from 0 in their order of appearance, by a growing
 * hash table.
 */
#ifndef RHOTRACK_TOOL_IDENTITY_MAP_H
#define RHOTRACK_TOOL_IDENTITY_MAP_H

#include <stddef.h>
#include <stdint.h>

/* Map from identities to numbers; initialised with {0}. */
struct identity_numbers {
    int32_t *ids; /* the identities in order of their numbers; `count` of them */
    size_t count, capacity;
    /* open-addressing table of number + 1, 0: free slot; num_slots is a power of two */
    size_t *slots;
    size_t num_slots;
};

/* Returns the number of an identity. A new identity is added with the next number. */
size_t identity_numbers_find_or_add(struct identity_numbers *identities, int32_t id);

void identity_numbers_free(struct identity_numbers *identities);

#endif
