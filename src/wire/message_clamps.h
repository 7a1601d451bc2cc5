/* SPDX-License-Identifier: MIT */
/*
 * message_clamps: numbers of the library brought into the narrower integer members of a message,
 * and the number of messages of a list. Private to src/wire and src/node.
 */
#ifndef RHOTRACK_MESSAGE_CLAMPS_H
#define RHOTRACK_MESSAGE_CLAMPS_H

#include <stdint.h>

#include "rhotrack/types.h"

static inline int16_t rho_clamp_to_int16(uint32_t count)
{
    return (int16_t)(count < INT16_MAX ? count : INT16_MAX);
}

static inline int32_t rho_clamp_to_int32(uint32_t count)
{
    return count < INT32_MAX ? (int32_t)count : INT32_MAX;
}

/* The sum of a counter of a message, which is 0 or more, and a counter of the library. */
static inline int32_t rho_clamp_sum_to_int32(int32_t counter, uint32_t more)
{
    return rho_clamp_to_int32(rho_count((uint32_t)counter, more));
}

/* A sensor's number; -1 where it is beyond the range of the member. */
static inline int16_t rho_clamp_sensor_id(int32_t sensor_id)
{
    return (int16_t)(sensor_id >= INT16_MIN && sensor_id <= INT16_MAX ? sensor_id : -1);
}

/* Number of messages of at most `most` elements each for a number of elements; at least 1. */
static inline unsigned rho_num_parts(unsigned elements, unsigned most)
{
    return elements <= most ? 1 : (elements + most - 1) / most;
}

#endif
