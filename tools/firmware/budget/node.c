/* SPDX-License-Identifier: MIT */
/*
 * node: the node of this folder without a board, LCM datagrams in and out. `make budget` links it,
 * and nobody runs it.
 */
#include "../node.h"

static uint8_t datagram[RHO_UDPM_MAX_DATAGRAM];

static void send_nothing(void *context, const uint8_t *bytes, size_t size)
{
    (void)context;
    (void)bytes;
    (void)size;
}

static int64_t clock_us(void *context)
{
    (void)context;
    return 0;
}

int main(void)
{
    struct node_config config;
    node_config_default(&config);
    config.send = send_nothing;
    config.clock_us = clock_us;
    if (node_start(&config) != RHO_OK) {
        return 1;
    }
    node_receive(datagram, sizeof datagram, 0, 0);
    node_tick(node_due_us());
    return 0;
}
