/* SPDX-License-Identifier: MIT */
#include "rhotrack/udpm.h"

#include <string.h>

#include "rhotrack/types.h"

enum { NUMBERS_BYTES = 8 }; /* of a datagram's magic and sequence number */

static const uint8_t magic[4] = {'L', 'C', '0', '2'};

/* Length of a channel name; 0 where it is empty, or no NUL ends it in time. */
static size_t channel_length(const char *channel, size_t size)
{
    for (size_t i = 0; i < size && i <= RHO_UDPM_MAX_CHANNEL; i++) {
        if (channel[i] == '\0') {
            return i;
        }
    }
    return 0;
}

int rho_udpm_admits(struct rho_udpm_guard *guard, uint32_t source_ipv4)
{
    if (!guard || guard->num_sources > RHO_UDPM_MAX_SOURCES) {
        return 0;
    }
    for (uint32_t i = 0; i < guard->num_sources; i++) {
        if (guard->sources[i] == source_ipv4) {
            return 1;
        }
    }
    guard->refused_source = rho_count(guard->refused_source, guard->num_sources > 0 ? 1 : 0);
    return guard->num_sources == 0;
}

enum rho_status rho_udpm_begin(uint8_t *buffer, size_t capacity, uint32_t sequence,
                               const char *channel, size_t *head)
{
    if (!buffer || !channel || !head) {
        return RHO_ERROR_NULL;
    }
    const size_t length = channel_length(channel, SIZE_MAX);
    if (length == 0) {
        return RHO_ERROR_VALUE;
    }
    if (capacity < NUMBERS_BYTES + length + 1) {
        return RHO_ERROR_CAPACITY;
    }
    memcpy(buffer, magic, sizeof magic);
    for (unsigned i = 0; i < 4; i++) {
        buffer[4 + i] = (uint8_t)(sequence >> (24 - 8 * i));
    }
    memcpy(buffer + NUMBERS_BYTES, channel, length + 1);
    *head = NUMBERS_BYTES + length + 1;
    return RHO_OK;
}

enum rho_status rho_udpm_parse(const uint8_t *data, size_t size, struct rho_udpm_datagram *datagram)
{
    if (!data || !datagram) {
        return RHO_ERROR_NULL;
    }
    if (size < NUMBERS_BYTES) {
        return RHO_ERROR_SHORT;
    }
    if (memcmp(data, magic, sizeof magic) != 0) {
        return RHO_ERROR_TYPE;
    }
    const char *channel = (const char *)data + NUMBERS_BYTES;
    const size_t length = channel_length(channel, size - NUMBERS_BYTES);
    if (length == 0) {
        return RHO_ERROR_VALUE;
    }
    uint32_t sequence = 0;
    for (unsigned i = 0; i < 4; i++) {
        sequence = sequence << 8 | data[4 + i];
    }
    const size_t head = NUMBERS_BYTES + length + 1;
    *datagram = (struct rho_udpm_datagram){sequence, channel, data + head, size - head};
    return RHO_OK;
}

int rho_udpm_is_self_test(const struct rho_udpm_datagram *datagram)
{
    static const char name[] = "LCM_SELF_TEST";
    size_t i = 0;
    if (!datagram || !datagram->channel) {
        return 0;
    }
    while (name[i] != '\0' && datagram->channel[i] == name[i]) {
        i++;
    }
    return name[i] == datagram->channel[i];
}
