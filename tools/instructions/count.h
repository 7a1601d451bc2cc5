/* SPDX-License-Identifier: MIT */
/*
 * count: counts the instructions between count_begin and count_end for the programs in this folder.
 * On a workstation valgrind counts them (callgrind, started with --collect-atstart=no). On a
 * Cortex-M in QEMU (COUNT_ON_TARGET) a timer counts them, and count_print_totals prints the calls,
 * their sum and their maximum; a program prints its own results before that.
 */
#ifndef COUNT_H
#define COUNT_H

#include <stdint.h>
#include <stdio.h>

static uint32_t count_calls;

#ifdef COUNT_ON_TARGET

#include "board/files.h"

static uint32_t count_from, count_empty, count_max;
static uint64_t count_sum;

static inline void count_begin(void)
{
    if (count_calls == 0) { /* the cost of the two readings */
        count_from = files_read_instruction_counter();
        count_empty = files_instructions_elapsed(count_from, files_read_instruction_counter());
    }
    count_from = files_read_instruction_counter();
}

static inline void count_end(void)
{
    uint32_t count =
        files_instructions_elapsed(count_from, files_read_instruction_counter()) - count_empty;
    count_calls++;
    count_sum += count;
    if (count > count_max) {
        count_max = count;
    }
}

/* The reading of the counter; valgrind has none that a program can read, so there it is 0. */
static inline uint32_t count_instructions_now(void)
{
    return files_read_instruction_counter();
}

static inline uint32_t count_instructions_between(uint32_t from, uint32_t to)
{
    return files_instructions_elapsed(from, to);
}

static inline void count_print_totals(void)
{
    printf("calls %lu sum %llu max %lu\n", (unsigned long)count_calls,
           (unsigned long long)count_sum, (unsigned long)count_max);
}

#else

#include <valgrind/callgrind.h>

static inline void count_begin(void)
{
    CALLGRIND_TOGGLE_COLLECT;
}

static inline void count_end(void)
{
    CALLGRIND_TOGGLE_COLLECT;
    count_calls++;
}

static inline uint32_t count_instructions_now(void)
{
    return 0;
}

static inline uint32_t count_instructions_between(uint32_t from, uint32_t to)
{
    return to - from;
}

static inline void count_print_totals(void)
{
    printf("calls %lu\n", (unsigned long)count_calls);
}

#endif
#endif
