/* SPDX-License-Identifier: MIT */
/*
 * The radar node: hears scans over LCM, publishes tracks. Where to start from for a node of your own: the radars that
 * it knows are in the table below, the tracker's settings in start(), the hardware in board/.
 */
#include "board/board.h"
#include "node.h"
#include "rhotrack/udpm.h"

#define REPORT_INTERVAL_US 1000000

/* One radar at the origin. Sensors that are not in the table are taken at their word, with the feed's defaults. */
static const struct rho_feed_sensor radars[] = {
    {.sensor = {.sensor_id = 1, .pd = 0.9f, .range_max_m = 150000.0f},
     .noise = {.sigma_m = 20.0f,
               .sigma_mps = 1.0f,
               .sigma_range_m = 15.0f,
               .sigma_azimuth_rad = 0.003f,
               .sigma_elevation_rad = 0.003f,
               .sigma_range_rate_mps = 1.0f,
               .sigma_rad = 0.002f}},
};

static void send_datagram(void *context, const uint8_t *datagram, size_t size)
{
    (void)context;
    board_send(datagram, size);
}

static int64_t clock_us(void *context)
{
    (void)context;
    return board_time_us();
}

static enum rho_status start(void)
{
    struct node_config config;
    node_config_default(&config);
    config.sensors = radars;
    config.num_sensors = sizeof radars / sizeof *radars;
    config.boot = board_boot();
    config.send = send_datagram;
    config.clock_us = clock_us;
    return node_start(&config);
}

/* "stack       3904": text ends with room for ten digits. */
static void say(char *text, size_t last, uint32_t number)
{
    do {
        text[last--] = (char)('0' + number % 10);
        number /= 10;
    } while (number > 0);
    board_say(text);
}

/* What has come to more since the last time. */
static void report(void)
{
    static uint32_t said_stack, said_unsent;
    uint32_t stack = (uint32_t)board_stack_used(), unsent = board_unsent();
    if (stack > said_stack) {
        char text[] = "stack           ";
        say(text, sizeof text - 2, stack);
        said_stack = stack;
    }
    if (unsent > said_unsent) {
        char text[] = "unsent          ";
        say(text, sizeof text - 2, unsent);
        said_unsent = unsent;
    }
}

int main(void)
{
    static uint8_t datagram[RHO_UDPM_MAX_DATAGRAM];
    int64_t report_us = 0;
    if (!board_open()) {
        board_say("the network does not answer");
        return 1;
    }
    if (start() != RHO_OK) {
        board_say("the node's settings are not taken");
        return 1;
    }
    board_say("the node listens");
    for (;;) {
        int64_t now_us = board_time_us();
        size_t size = board_receive(datagram, sizeof datagram);
        if (size > 0) {
            node_receive(datagram, size, now_us);
        }
        node_tick(now_us);
        if (now_us >= report_us) {
            report_us = now_us + REPORT_INTERVAL_US;
            report();
        }
        if (size == 0) {
            board_wait(node_due_us());
        }
    }
}
