/* SPDX-License-Identifier: MIT */
/*
 * semihosting: files.h, program arguments and exit through a debugger or QEMU: a breakpoint
 * instruction with the operation in r0 and its operands in r1. Without a debugger the breakpoint is
 * a fault, so products do not link this file.
 */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "../board.h"
#include "../files.h"
#include "mps2.h"

#define SYS_OPEN 0x01
#define SYS_CLOSE 0x02
#define SYS_WRITE0 0x04
#define SYS_WRITE 0x05
#define SYS_READ 0x06
#define SYS_GET_CMDLINE 0x15
#define SYS_EXIT_EXTENDED 0x20
#define OPEN_READ_BINARY 1
#define OPEN_WRITE_BINARY 5
#define EXIT_BY_PROGRAM 0x20026u

#define TIMER_RUN 1u
#define ARGUMENTS_MAX 8
/* exit code: more than ARGUMENTS_MAX arguments, or a command line that is too long */
#define EXIT_ARGUMENTS 119u
#define EXIT_FAULT 120u /* exit code of a fault, plus the exception's number */

static uint32_t call_debugger(uint32_t operation, const void *operands)
{
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = operands;
    __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

static uint32_t pointer_as_word(const void *pointer)
{
    return (uint32_t)(uintptr_t)pointer;
}

/* ---- Files ---- */

/* Semihosting handles are 0 and above, -1 on failure; files.h adds 1. */
static int open_file(const char *path, uint32_t mode)
{
    const uint32_t operands[3] = {pointer_as_word(path), mode, (uint32_t)strlen(path)};
    return (int)call_debugger(SYS_OPEN, operands) + 1;
}

int files_open_to_read(const char *path)
{
    return open_file(path, OPEN_READ_BINARY);
}

int files_open_to_write(const char *path)
{
    return open_file(path, OPEN_WRITE_BINARY);
}

/* SYS_READ and SYS_WRITE return the number of bytes not transferred. */
size_t files_read(int file, uint8_t *bytes, size_t size)
{
    const uint32_t operands[3] = {(uint32_t)file - 1, pointer_as_word(bytes), (uint32_t)size};
    return size - call_debugger(SYS_READ, operands);
}

int files_try_to_write(int file, const uint8_t *bytes, size_t size)
{
    const uint32_t operands[3] = {(uint32_t)file - 1, pointer_as_word(bytes), (uint32_t)size};
    return call_debugger(SYS_WRITE, operands) == 0;
}

int files_try_to_close(int file)
{
    const uint32_t operands[1] = {(uint32_t)file - 1};
    return call_debugger(SYS_CLOSE, operands) == 0;
}

void files_print(const char *text)
{
    (void)call_debugger(SYS_WRITE0, text);
}

size_t files_stack_used(void)
{
    return board_stack_used();
}

/* ---- Instructions ---- */

/*
 * Instructions are counted by QEMU's time: with -icount shift=6 an instruction takes 64 ns, a tick
 * of the timer 40 ns.
 */
uint32_t files_read_instruction_counter(void)
{
    return UINT32_MAX - TIMER0_VALUE;
}

uint32_t files_instructions_elapsed(uint32_t from, uint32_t to)
{
    return (uint32_t)((uint64_t)(to - from) * 40 / 64);
}

/* ---- Start and end ---- */

int main(int argc, char **argv);

/*
 * Replaced in newlib_stdout.c for images whose C library has a console to open and
 * flush.
 */
__attribute__((weak)) void mps2_open_console(void)
{
}
__attribute__((weak)) void mps2_close_console(void)
{
}

static void exit_program(uint32_t status) __attribute__((noreturn));
static void exit_program(uint32_t status)
{
    const uint32_t operands[2] = {EXIT_BY_PROGRAM, status};
    (void)call_debugger(SYS_EXIT_EXTENDED, operands);
    for (;;) {
    }
}

void mps2_report_fault_and_stop(unsigned exception)
{
    exit_program(EXIT_FAULT + exception);
}

/* Splits the command line into words in place; returns their number. */
static int split_command_line(char *line, char **words)
{
    int count = 0;
    for (char *next = line; *next; count++) {
        if (count == ARGUMENTS_MAX) {
            exit_program(EXIT_ARGUMENTS);
        }
        words[count] = next;
        next += strcspn(next, " ");
        while (*next == ' ') {
            *next++ = '\0';
        }
    }
    return count;
}

void mps2_run_main(void)
{
    static char line[1024];
    static char *words[ARGUMENTS_MAX + 1];
    const uint32_t operands[2] = {pointer_as_word(line), sizeof line};
    int status;
    if (call_debugger(SYS_GET_CMDLINE, operands) != 0) {
        exit_program(EXIT_ARGUMENTS);
    }
    TIMER0_RELOAD = UINT32_MAX;
    TIMER0_VALUE = UINT32_MAX;
    TIMER0_CONTROL = TIMER_RUN;
    mps2_open_console();
    status = main(split_command_line(line, words), words);
    mps2_close_console();
    exit_program((uint32_t)status);
}
