/* SPDX-License-Identifier: MIT */
/*
 * big_endian: reads and writes unsigned numbers of 1 to 8 bytes, the most significant byte first.
 */
#ifndef RHOTRACK_TOOL_BIG_ENDIAN_H
#define RHOTRACK_TOOL_BIG_ENDIAN_H

#include <stdint.h>

static inline uint64_t load_big_endian(const uint8_t *data, int bytes)
{
    uint64_t value = 0;

    for (int i = 0; i < bytes; i++) {
        value = value << 8 | data[i];
    }
    return value;
}

/* Writes the lowest bytes of the value. */
static inline void store_big_endian(uint8_t *data, uint64_t value, int bytes)
{
    for (int i = bytes; i-- > 0; value >>= 8) {
        data[i] = (uint8_t)value;
    }
}

#endif
