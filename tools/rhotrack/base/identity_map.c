/* SPDX-License-Identifier: MIT */
#include "base/identity_map.h"

#include <stdlib.h>

#include "base/common.h"

/* Finds the hash slot of an identity, or the free slot where it is to be stored. */
static size_t *find_identity_slot(const struct identity_numbers *identities, int32_t id)
{
    /* Knuth's multiplicative hash; its upper bits are mixed best */
    uint32_t hash = (uint32_t)id * 2654435769u;
    size_t at = (hash ^ hash >> 16) & (identities->num_slots - 1);
    while (identities->slots[at] != 0 && identities->ids[identities->slots[at] - 1] != id) {
        at = (at + 1) & (identities->num_slots - 1);
    }
    return &identities->slots[at];
}

size_t identity_numbers_find_or_add(struct identity_numbers *identities, int32_t id)
{
    if (2 * identities->count >= identities->num_slots) {
        free(identities->slots);
        identities->num_slots = identities->num_slots == 0 ? 64 : 2 * identities->num_slots;
        identities->slots = must_calloc(identities->num_slots, sizeof *identities->slots);
        for (size_t i = 0; i < identities->count; i++) {
            *find_identity_slot(identities, identities->ids[i]) = i + 1;
        }
    }
    size_t *slot = find_identity_slot(identities, id);
    if (*slot == 0) {
        identities->ids = must_make_room_for_one(identities->ids, identities->count,
                                                 &identities->capacity, sizeof *identities->ids);
        identities->ids[identities->count++] = id;
        *slot = identities->count;
    }
    return *slot - 1;
}

void identity_numbers_free(struct identity_numbers *identities)
{
    free(identities->ids);
    free(identities->slots);
    *identities = (struct identity_numbers){0};
}
