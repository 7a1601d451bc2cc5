/* SPDX-License-Identifier: MIT */
/*
 * `make sanitize` includes this in front of every unit test for the memory sanitizer: objects that
 * a test compares by bytes must not hold uninitialised ones, not even as padding, as these could
 * differ between runs.
 */
#ifndef RHOTRACK_TESTS_DEFINED_MEMORY_H
#define RHOTRACK_TESTS_DEFINED_MEMORY_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <sanitizer/msan_interface.h>

#undef assert_memory_equal
#define assert_memory_equal(a, b, size)                                                            \
    (__msan_check_mem_is_initialized((a), (size)), __msan_check_mem_is_initialized((b), (size)),   \
     _assert_memory_equal((const char *)(a), (const char *)(b), (size), __FILE__, __LINE__))

#endif
