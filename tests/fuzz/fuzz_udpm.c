/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as a datagram: what is accepted lies within the datagram, and building it from its
 * parts gives the same bytes.
 */
#include <stdint.h>
#include <string.h>

#include "check.h"
#include "rhotrack/udpm.h"

static void check_datagram_head_writer(const uint8_t *data, size_t size)
{
    char channel[80];
    uint8_t buffer[80];
    size_t head = 1000, length = size < sizeof channel - 1 ? size : sizeof channel - 1;

    memcpy(channel, data, length);
    channel[length] = '\0';
    length = strlen(channel);
    if (rho_udpm_begin(buffer, sizeof buffer, 7, channel, &head) == RHO_OK) {
        CHECK(length >= 1 && length <= RHO_UDPM_MAX_CHANNEL && head == length + 9);
    } else {
        CHECK((length == 0 || length > RHO_UDPM_MAX_CHANNEL) && head == 1000);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct rho_udpm_datagram datagram = {0};
    uint8_t buffer[RHO_UDPM_MAX_HEAD];
    size_t head = 0;

    check_datagram_head_writer(data, size);
    if (rho_udpm_parse(data, size, &datagram) != RHO_OK) {
        CHECK(!datagram.channel && !datagram.payload && datagram.payload_size == 0);
        return 0;
    }
    CHECK(strlen(datagram.channel) <= RHO_UDPM_MAX_CHANNEL);
    CHECK(datagram.payload + datagram.payload_size == data + size);
    CHECK(rho_udpm_begin(buffer, sizeof buffer, datagram.sequence, datagram.channel, &head) ==
          RHO_OK);
    CHECK(head + datagram.payload_size == size && memcmp(buffer, data, head) == 0);
    (void)rho_udpm_is_self_test(&datagram);
    return 0;
}
