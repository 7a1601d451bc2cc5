/* SPDX-License-Identifier: MIT */
/*
 * radar_node_main: the radar node's main loop: receives scans over LCM, publishes tracks. To make
 * your own node: its radars are in known_radars.h, the tracker's settings in
 * node_settings_defaults.h and nodes/, the hardware in board/.
 */
#include "board/board.h"
#include "known_radars.h"
#include "lcm_datagram_node.h"
#include "rhotrack/udpm.h"

#define REPORT_INTERVAL_US 1000000

static void send_datagram(void *context, const uint8_t *datagram, size_t size)
{
    (void)context;
    board_send(datagram, size);
}

static int64_t monotonic_clock_us(void *context)
{
    (void)context;
    return board_time_us();
}

static enum rho_status start_node(void)
{
    struct node_config config;
    node_config_default(&config);
    config.sensors = radars;
    config.num_sensors = sizeof radars / sizeof *radars;
    config.boot = board_count_start();
    config.hooks.send = send_datagram;
    config.hooks.clock_us = monotonic_clock_us;
    return node_start(&config);
}

/*
 * A counter and the line that reports it, "stack       3904", with room for ten digits at its end.
 */
struct growing_number {
    char text[sizeof "stack           "];
    uint32_t said;
};

/* Prints the counter's line if the number is larger than at the last print. */
static void print_if_grown(struct growing_number *growing_number, uint32_t number)
{
    size_t last = sizeof growing_number->text - 2;
    if (number <= growing_number->said) {
        return;
    }
    growing_number->said = number;
    for (; number > 0; number /= 10) {
        growing_number->text[last--] = (char)('0' + number % 10);
    }
    board_print_line(growing_number->text);
}

static void print_grown_counters(void)
{
    static struct growing_number stack = {.text = "stack           "},
                                 unsent = {.text = "unsent          "},
                                 strange = {.text = "strange         "};
    print_if_grown(&stack, (uint32_t)board_stack_used());
    print_if_grown(&unsent, board_num_unsent());
    print_if_grown(&strange, rho_count(node_sender_filter()->refused_source,
                                       node_sender_filter()->refused_mac));
}

int main(void)
{
    static uint8_t datagram[RHO_UDPM_MAX_DATAGRAM];
    int64_t report_us = 0;
    if (!board_try_to_open()) {
        board_print_line("the network does not answer");
        return 1;
    }
    if (start_node() != RHO_OK) {
        board_print_line("the node's settings are not taken");
        return 1;
    }
    board_print_line("the node listens");
    for (;;) {
        int64_t now_us = board_time_us();
        uint32_t source_ipv4 = 0;
        size_t size = board_receive(datagram, sizeof datagram, &source_ipv4);
        if (size > 0) {
            node_receive(datagram, size, source_ipv4, now_us);
        }
        node_tick(now_us);
        if (now_us >= report_us) {
            report_us = now_us + REPORT_INTERVAL_US;
            print_grown_counters();
        }
        if (size == 0) {
            board_sleep_until(node_due_us());
        }
    }
}
