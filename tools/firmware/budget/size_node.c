/* SPDX-License-Identifier: MIT */
/*
 * size_node: the firmware's node (../lcm_datagram_node.c) without a board. `make budget`
 * links it to measure its size; it is never run.
 */
#include "../lcm_datagram_node.h"

static uint8_t datagram[RHO_UDPM_MAX_DATAGRAM];

static void discard_datagram(void *context, const uint8_t *bytes, size_t size)
{
    (void)context;
    (void)bytes;
    (void)size;
}

static int64_t zero_clock_us(void *context)
{
    (void)context;
    return 0;
}

int main(void)
{
    struct node_config config;
    node_config_default(&config);
    config.hooks.send = discard_datagram;
    config.hooks.clock_us = zero_clock_us;
    if (node_start(&config) != RHO_OK) {
        return 1;
    }
    node_receive(datagram, sizeof datagram, 0, 0);
    node_tick(node_due_us());
    return 0;
}
