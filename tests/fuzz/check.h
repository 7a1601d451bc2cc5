/* SPDX-License-Identifier: MIT */
/*
 * A condition that must hold: otherwise its line and text are printed and the fuzz target aborts.
 */
#ifndef RHOTRACK_TESTS_FUZZ_CHECK_H
#define RHOTRACK_TESTS_FUZZ_CHECK_H

#include <stdio.h>
#include <stdlib.h>

#define CHECK(condition)                                                                           \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            fprintf(stderr, "line %d: %s\n", __LINE__, #condition);                                \
            abort();                                                                               \
        }                                                                                          \
    } while (0)

#endif
