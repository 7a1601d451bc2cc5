/* SPDX-License-Identifier: MIT */
#include "lan9118.h"

#include <string.h>

#include "mps2.h"

#define CHIP(offset) MPS2_REGISTER(MPS2_ETHERNET + (offset))
#define RX_DATA CHIP(0x00u)
#define TX_DATA CHIP(0x20u)
#define RX_STATUS CHIP(0x40u)
#define TX_STATUS CHIP(0x48u)
#define IRQ_CONFIG CHIP(0x54u)
#define IRQ_STATUS CHIP(0x58u)
#define IRQ_ENABLE CHIP(0x5Cu)
#define BYTE_TEST CHIP(0x64u)
#define FIFO_LEVELS CHIP(0x68u)
#define TX_CONFIG CHIP(0x70u)
#define HW_CONFIG CHIP(0x74u)
#define RX_LEVEL CHIP(0x7Cu)
#define TX_LEVEL CHIP(0x80u)
#define MAC_COMMAND CHIP(0xA4u)
#define MAC_VALUE CHIP(0xA8u)

#define BYTE_TEST_VALUE 0x87654321u
#define HW_RESET 1u
#define HW_TX_FIFO_5K (5u << 16 | 1u << 20)
#define TX_ON 2u
/* the buffer is the first and last segment of a frame */
#define TX_WHOLE_FRAME (1u << 13 | 1u << 12)
#define RX_DAMAGED (1u << 15)
#define IRQ_LINE_ON (1u << 8 | 1u << 4 | 1u) /* interrupt line enabled, active high, push-pull */
#define IRQ_RX_LEVEL (1u << 3)
#define MAC_BUSY (1u << 31)
#define MAC_CONTROL 1u
#define MAC_HIGH 2u
#define MAC_LOW 3u
#define MAC_RX_TX_MULTICAST (1u << 2 | 1u << 3 | 1u << 19)
#define TRIES 100000

static int wait_for_bits_clear(volatile uint32_t *chip_register, uint32_t bits)
{
    for (int i = 0; i < TRIES; i++) {
        if ((*chip_register & bits) == 0) {
            return 1;
        }
    }
    return 0;
}

static int try_to_write_mac_register(uint32_t mac_register, uint32_t value)
{
    MAC_VALUE = value;
    MAC_COMMAND = MAC_BUSY | mac_register;
    return wait_for_bits_clear(&MAC_COMMAND, MAC_BUSY);
}

int lan9118_try_to_open(const uint8_t mac[6])
{
    if (BYTE_TEST != BYTE_TEST_VALUE) {
        return 0;
    }
    HW_CONFIG = HW_RESET;
    if (!wait_for_bits_clear(&HW_CONFIG, HW_RESET)) {
        return 0;
    }
    HW_CONFIG = HW_TX_FIFO_5K;
    FIFO_LEVELS = 0; /* interrupt from the first received frame on */
    IRQ_STATUS = 0xffffffffu;
    IRQ_ENABLE = IRQ_RX_LEVEL;
    IRQ_CONFIG = IRQ_LINE_ON;
    TX_CONFIG = TX_ON;
    return try_to_write_mac_register(MAC_HIGH, (uint32_t)mac[5] << 8 | mac[4]) &&
           try_to_write_mac_register(MAC_LOW, (uint32_t)mac[3] << 24 | (uint32_t)mac[2] << 16 |
                                                  (uint32_t)mac[1] << 8 | mac[0]) &&
           try_to_write_mac_register(MAC_CONTROL, MAC_RX_TX_MULTICAST);
}

static void discard_received_words(size_t words)
{
    while (words-- > 0) {
        (void)RX_DATA;
    }
}

size_t lan9118_receive(uint8_t *frame, size_t capacity)
{
    size_t size = 0;
    while (size == 0 && (RX_LEVEL >> 16 & 0xff) > 0) {
        uint32_t status = RX_STATUS;
        /* length includes the 4 bytes of the frame's checksum */
        size_t length = status >> 16 & 0x3fff, words = (length + 3) / 4;
        if ((status & RX_DAMAGED) || length <= 4 || length - 4 > capacity) {
            discard_received_words(words);
            continue;
        }
        size = length - 4;
        for (size_t at = 0; at < 4 * words; at += 4) {
            uint32_t word = RX_DATA;
            if (at < size) {
                memcpy(frame + at, &word, size - at < 4 ? size - at : 4);
            }
        }
    }
    IRQ_STATUS = IRQ_RX_LEVEL;
    return size;
}

int lan9118_try_to_send(const uint8_t *frame, size_t size)
{
    /* discard the states of sent frames: a full state FIFO would stop the transmitter */
    while (TX_LEVEL >> 16 & 0xff) {
        (void)TX_STATUS;
    }
    if ((TX_LEVEL & 0xffff) < size + 16) {
        return 0;
    }
    TX_DATA = TX_WHOLE_FRAME | (uint32_t)size;
    TX_DATA = (uint32_t)size;
    for (size_t at = 0; at < size; at += 4) {
        uint32_t word = 0;
        memcpy(&word, frame + at, size - at < 4 ? size - at : 4);
        TX_DATA = word;
    }
    return 1;
}
