/* SPDX-License-Identifier: MIT */
/*
 * files: what the replay asks of the machine that it runs on: files, arguments, a count of work. In
 * host/ with stdio, in mps2/ through the debugger (semihosting).
 */
#ifndef FILES_H
#define FILES_H

#include <stddef.h>
#include <stdint.h>

/* A file as a number above 0; 0: it cannot be opened. */
int files_open_to_read(const char *path);
int files_open_to_write(const char *path);

/* Returns the bytes that were read, fewer at the end. */
size_t files_read(int file, uint8_t *bytes, size_t size);

/* Return 0 where not all was written. */
int files_write(int file, const uint8_t *bytes, size_t size);
int files_close(int file);

/* On the console; no newline is added. */
void files_say(const char *text);

/*
 * The processor's instructions so far, where they can be counted (0 else). Wraps at 2^32 - 1, so
 * that what lies between two calls can be told up to 2.6e9.
 */
uint32_t files_instructions(void);
uint32_t files_instructions_between(uint32_t from, uint32_t to);

/* Bytes of stack that were used at most; 0: not known. */
size_t files_stack_used(void);

#endif
