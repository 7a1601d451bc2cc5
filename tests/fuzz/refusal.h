/* SPDX-License-Identifier: MIT */
/*
 * refusal: readers of the program that refuse their file.
 *
 * Such a reader calls fail(), which ends the program. Here it jumps out of the reader (linked with
 * --wrap=fail), and the files that it had open are closed (the streams by --wrap=fopen and its
 * like), and what it had allocated is given back by the hooks of the sanitizer's allocator. So
 * leaks of runs that do not fail are still found.
 */
#ifndef RHOTRACK_TESTS_FUZZ_REFUSAL_H
#define RHOTRACK_TESTS_FUZZ_REFUSAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Once, before the first reader: what the process keeps for good is there by then. */
void refusal_begin(void);

/* Calls the reader. True where it refused: with exit code 2, and one line. */
bool refusal_ends(void (*read)(void *context), void *context);

/* A file with these bytes, of which there is one at a time. Returns its path. */
char *refusal_write_file(const uint8_t *data, size_t size);

#endif
