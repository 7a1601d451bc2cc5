/* SPDX-License-Identifier: MIT */
/* What must hold: else the line and the condition are said, and the target aborts. */
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
