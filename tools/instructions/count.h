/* SPDX-License-Identifier: MIT */
/*
 * count: the instructions between count_begin and count_end, for the jobs beside it. On this
 * machine valgrind counts them (callgrind, started with --collect-atstart=no); on a Cortex-M under
 * QEMU (COUNT_ON_TARGET) the timer does, and count_report says what it has seen. What a job says
 * itself goes to standard output before that.
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
    if (count_calls == 0) { /* what counting itself takes */
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

/* For who looks at single calls. */
static inline uint32_t count_instructions_now(void)
{
    return files_read_instruction_counter();
}

static inline uint32_t count_instructions_between(uint32_t from, uint32_t to)
{
    return files_instructions_elapsed(from, to);
}

static inline void count_report(void)
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

static inline void count_report(void)
{
    printf("calls %lu\n", (unsigned long)count_calls);
}

#endif
#endif
