/* SPDX-License-Identifier: MIT */
/* startup: from reset to the image's main, and the vector table of interrupts. */
#include <stdint.h>
#include <string.h>

#include "../board.h"
#include "mps2.h"

#define STACK_PATTERN 0x5AA55AA5u

/* Symbols of the linker script. */
extern uint32_t link_data_from[], link_data[], link_data_end[], link_bss[], link_bss_end[];
extern uint32_t link_stack[], link_stack_top[];

/*
 * Fault entry: resets the stack pointer to the top, as an overflowed stack has no room for the
 * report, and calls mps2_report_fault_and_stop with the exception's number.
 */
__attribute__((noreturn, naked)) static void enter_fault_handler(void)
{
    __asm__ volatile("movw r0, #:lower16:link_stack_top\n"
                     "movt r0, #:upper16:link_stack_top\n"
                     "mov sp, r0\n"
                     "mrs r0, ipsr\n"
                     "b mps2_report_fault_and_stop\n");
}

/* Default handlers for images that enable neither interrupt. */
__attribute__((weak)) void mps2_systick_interrupt(void)
{
}
__attribute__((weak)) void mps2_mute_ethernet_interrupt(void)
{
}

/* Fills the unused stack with a pattern, so that board_stack_used can find the largest depth. */
static inline void fill_stack_with_pattern(void)
{
    uint32_t *here;
    __asm__ volatile("mov %0, sp" : "=r"(here));
    for (uint32_t *word = link_stack; word < here; word++) {
        *word = STACK_PATTERN;
    }
}

size_t board_stack_used(void)
{
    const uint32_t *word = link_stack;
    size_t words = ((uintptr_t)link_stack_top - (uintptr_t)link_stack) / sizeof *word;
    while (words > 0 && *word == STACK_PATTERN) {
        word++;
        words--;
    }
    return words * sizeof *word;
}

/* Reset entry: only enables the FPU, which must be on before any code that uses it is entered. */
__attribute__((noreturn, naked)) void mps2_reset(void);
__attribute__((naked)) void mps2_reset(void)
{
    __asm__ volatile("movw r0, #0xED88\n" /* 0xE000ED88: CPACR, access to the FPU */
                     "movt r0, #0xE000\n"
                     "ldr r1, [r0]\n"
                     "orr r1, r1, #0xF00000\n"
                     "str r1, [r0]\n"
                     "dsb\n"
                     "isb\n"
                     "b mps2_start\n");
}

__attribute__((noreturn, used)) void mps2_start(void);
void mps2_start(void)
{
    fill_stack_with_pattern();
    memcpy(link_data, link_data_from, (size_t)((uintptr_t)link_data_end - (uintptr_t)link_data));
    memset(link_bss, 0, (size_t)((uintptr_t)link_bss_end - (uintptr_t)link_bss));
    mps2_run_main();
}

typedef void (*handler)(void);

__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack_top;
    handler exceptions[15];
    handler interrupts[MPS2_ETHERNET_IRQ + 1];
} vectors = {
    .stack_top = link_stack_top,
    /* exceptions 1: reset; 2 .. 14: NMI, faults and supervisor calls; 15: SysTick */
    .exceptions = {mps2_reset, enter_fault_handler, enter_fault_handler, enter_fault_handler,
                   enter_fault_handler, enter_fault_handler, enter_fault_handler,
                   enter_fault_handler, enter_fault_handler, enter_fault_handler,
                   enter_fault_handler, enter_fault_handler, enter_fault_handler,
                   enter_fault_handler, mps2_systick_interrupt},
    .interrupts = {[0 ... MPS2_ETHERNET_IRQ - 1] = enter_fault_handler,
                   [MPS2_ETHERNET_IRQ] = mps2_mute_ethernet_interrupt},
};
