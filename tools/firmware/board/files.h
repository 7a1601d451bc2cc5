/* SPDX-License-Identifier: MIT */
/*
 * files: the functions that the replay needs from its machine: files, console, instruction count.
 * Implemented in host/ with stdio, and in mps2/ through the debugger (semihosting).
 */
#ifndef FILES_H
#define FILES_H

#include <stddef.h>
#include <stdint.h>

/* Open a file; return a handle above 0, or 0 where it cannot be opened. */
int files_open_to_read(const char *path);
int files_open_to_write(const char *path);

/* Returns the number of bytes read, fewer than size at the end of the file. */
size_t files_read(int file, uint8_t *bytes, size_t size);

/* Return 0 on failure, such as a full disk. */
int files_try_to_write(int file, const uint8_t *bytes, size_t size);
int files_try_to_close(int file);

/* Prints the text on the console, without adding a newline. */
void files_print(const char *text);

/*
 * files_read_instruction_counter reads a counter of executed instructions (0 where there is none),
 * which wraps; files_instructions_elapsed gives the instructions between two readings, up to 2.6e9.
 */
uint32_t files_read_instruction_counter(void);
uint32_t files_instructions_elapsed(uint32_t from, uint32_t to);

/* Largest stack depth so far, in bytes; 0 where not known. */
size_t files_stack_used(void);

#endif
