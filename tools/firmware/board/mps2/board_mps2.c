/* SPDX-License-Identifier: MIT */
/* board_mps2: the radar node's board functions (board.h) on an MPS2 board with Ethernet. */
#include <string.h>

#include "../board.h"
#include "../udp_frame.h"
#include "lan9118.h"
#include "mps2.h"

#define SYSTICK_RUN 7u /* SysTick enabled, with interrupts, at the processor's clock */
#define TICKS_PER_MS (MPS2_CLOCK_HZ / 1000u)
#define TICKS_PER_US (MPS2_CLOCK_HZ / 1000000u)
#define JOIN_INTERVAL_US 60000000
#define REJECTED_MAX 16   /* most frames read in one call that are no datagrams for the node */
#define SEND_TRIES 100000 /* some 10 ms, in which the chip sends everything that it holds */
#define UART_SENDS 1u
#define UART_FULL 1u

/* The node's IPv4 address; each node on a network needs its own. */
#ifndef BOARD_ADDRESS
#define BOARD_ADDRESS 10, 9, 0, 100
#endif
static const struct udp_frame_host host = {.mac = {0x02, 0x52, 0x48, 0x4f, 0x00, 0x01},
                                           .address = {BOARD_ADDRESS}};

/* milliseconds since the start, counted by the SysTick interrupt; wraps */
static volatile uint32_t ticks_ms;
static uint32_t last_ms;
static int64_t time_ms;
static int64_t join_due_us;
static uint16_t frames_sent;
static uint32_t unsent;

/* ---- Clock ---- */

void mps2_systick_interrupt(void)
{
    ticks_ms++;
}

int64_t board_time_us(void)
{
    static int64_t newest_us;
    uint32_t now_ms, value;
    int64_t now_us;
    do { /* read both in the same millisecond */
        now_ms = ticks_ms;
        value = SYSTICK_VALUE;
    } while (now_ms != ticks_ms);
    time_ms += (uint32_t)(now_ms - last_ms);
    last_ms = now_ms;
    /*
     * at value 0 the new millisecond is already counted; its interrupt may also come late: time
     * never goes back
     */
    now_us = time_ms * 1000 + (value > 0 ? (TICKS_PER_MS - value) / TICKS_PER_US : 0);
    if (now_us > newest_us) {
        newest_us = now_us;
    }
    return newest_us;
}

/* ---- Network ---- */

/*
 * Interrupt of the chip: disabled until the next board_sleep_until, as it stays
 * active until the frames are read.
 */
void mps2_mute_ethernet_interrupt(void)
{
    NVIC_DISABLE = 1u << MPS2_ETHERNET_IRQ;
}

int board_try_to_open(void)
{
    UART0_DIVIDER = 16;
    UART0_CONTROL = UART_SENDS;
    SYSTICK_RELOAD = TICKS_PER_MS - 1;
    SYSTICK_VALUE = 0;
    SYSTICK_CONTROL = SYSTICK_RUN;
    return lan9118_try_to_open(host.mac);
}

/*
 * Sends an IGMP report once a minute: switches drop members of a multicast group that do not
 * report.
 */
static void send_group_report_if_due(void)
{
    static uint8_t frame[UDP_FRAME_JOIN];
    int64_t now_us = board_time_us();
    if (now_us >= join_due_us) {
        join_due_us = now_us + JOIN_INTERVAL_US;
        udp_frame_build_igmp_report(frame, &host);
        (void)lan9118_try_to_send(frame, sizeof frame);
    }
}

size_t board_receive(uint8_t *buffer, size_t capacity, uint32_t *source_ipv4)
{
    static uint8_t frame[UDP_FRAME_MAX];
    const uint8_t *payload;
    size_t size, length;
    send_group_report_if_due();
    for (int i = 0; i < REJECTED_MAX && (size = lan9118_receive(frame, sizeof frame)) > 0; i++) {
        length = udp_frame_find_payload(frame, size, &payload);
        if (length > 0 && length <= capacity) {
            memcpy(buffer, payload, length);
            *source_ipv4 = udp_frame_source_ipv4(frame);
            return length;
        }
    }
    return 0;
}

void board_send(const uint8_t *datagram, size_t size)
{
    static uint8_t frame[UDP_FRAME_MAX];
    int tries = SEND_TRIES;
    if (size <= sizeof frame - UDP_FRAME_HEAD) {
        memcpy(frame + UDP_FRAME_HEAD, datagram, size);
        size = udp_frame_build_around_payload(frame, &host, frames_sent++, size);
        while (!lan9118_try_to_send(frame, size) && --tries > 0) {
        }
        unsent += tries == 0;
    }
}

uint32_t board_num_unsent(void)
{
    return unsent;
}

void board_sleep_until(int64_t until_us)
{
    if (board_time_us() < until_us) {
        NVIC_UNPEND = 1u << MPS2_ETHERNET_IRQ;
        NVIC_ENABLE = 1u << MPS2_ETHERNET_IRQ;
        /* sleeps a millisecond at most: SysTick interrupts it */
        __asm__ volatile("wfi" ::: "memory");
    }
}

/* ---- Console ---- */

static void print_character(char character)
{
    while (UART0_STATE & UART_FULL) {
    }
    UART0_DATA = (uint32_t)character;
}

void board_print_line(const char *text)
{
    while (*text) {
        print_character(*text++);
    }
    print_character('\r');
    print_character('\n');
}

/* ---- Start and end ---- */

/* The board has no non-volatile memory to count starts in. */
int32_t board_count_start(void)
{
    return 0;
}

int main(void);

void mps2_run_main(void)
{
    (void)main();
    for (;;) {
    }
}

void mps2_report_fault_and_stop(unsigned exception)
{
    char text[] = "fault 00";
    text[6] = (char)('0' + exception / 10 % 10);
    text[7] = (char)('0' + exception % 10);
    board_print_line(text);
    for (;;) { /* stop here; in a product the watchdog restarts the node */
    }
}
