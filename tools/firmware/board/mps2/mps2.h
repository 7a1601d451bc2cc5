/* SPDX-License-Identifier: MIT */
/*
 * mps2: registers of Arm's MPS2 boards with the FPGA images AN386 (Cortex-M4F) and AN500
 * (Cortex-M7).
 */
#ifndef MPS2_H
#define MPS2_H

#include <stdint.h>

#define MPS2_CLOCK_HZ 25000000u

#define MPS2_REGISTER(address) (*(volatile uint32_t *)(uintptr_t)(address))

/* Registers of the Cortex-M core: SysTick timer and interrupt controller. */
#define SYSTICK_CONTROL MPS2_REGISTER(0xE000E010u)
#define SYSTICK_RELOAD MPS2_REGISTER(0xE000E014u)
#define SYSTICK_VALUE MPS2_REGISTER(0xE000E018u)
#define NVIC_ENABLE MPS2_REGISTER(0xE000E100u)
#define NVIC_DISABLE MPS2_REGISTER(0xE000E180u)
#define NVIC_UNPEND MPS2_REGISTER(0xE000E280u)

/* A 32-bit down-counting timer at the clock's rate. */
#define TIMER0_CONTROL MPS2_REGISTER(0x40000000u)
#define TIMER0_VALUE MPS2_REGISTER(0x40000004u)
#define TIMER0_RELOAD MPS2_REGISTER(0x40000008u)

#define UART0_DATA MPS2_REGISTER(0x40004000u)
#define UART0_STATE MPS2_REGISTER(0x40004004u)
#define UART0_CONTROL MPS2_REGISTER(0x40004008u)
#define UART0_DIVIDER MPS2_REGISTER(0x40004010u)

/* Address of the LAN9118, which depends on the FPGA image. */
#ifndef MPS2_ETHERNET
#error "MPS2_ETHERNET: 0x40200000 for AN386, 0xA0000000 for AN500"
#endif
#define MPS2_ETHERNET_IRQ 13u

/* Last step of the start-up: runs the image's main. In board_mps2.c or semihosting.c. */
void mps2_run_main(void) __attribute__((noreturn));

/* Interrupt handlers of SysTick and Ethernet, defined by images that enable them. */
void mps2_systick_interrupt(void);
void mps2_mute_ethernet_interrupt(void);

/* Open and flush the console of printf in images that measure. In newlib_stdout.c. */
void mps2_open_console(void);
void mps2_close_console(void);

/* Handles a fault of the processor; exception is its number. */
void mps2_report_fault_and_stop(unsigned exception) __attribute__((noreturn, used));

#endif
