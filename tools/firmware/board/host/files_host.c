/* SPDX-License-Identifier: MIT */
/* files_host: files.h implemented with the C library, for any hosted machine. */
#include <stdio.h>

#include "../files.h"

#define FILES_MAX 8

static FILE *files[FILES_MAX];

static int open_file(const char *path, const char *mode)
{
    for (int i = 0; i < FILES_MAX; i++) {
        if (!files[i]) {
            files[i] = fopen(path, mode);
            return files[i] ? i + 1 : 0;
        }
    }
    return 0;
}

int files_open_to_read(const char *path)
{
    return open_file(path, "rb");
}

int files_open_to_write(const char *path)
{
    return open_file(path, "wb");
}

size_t files_read(int file, uint8_t *bytes, size_t size)
{
    return fread(bytes, 1, size, files[file - 1]);
}

int files_try_to_write(int file, const uint8_t *bytes, size_t size)
{
    return fwrite(bytes, 1, size, files[file - 1]) == size;
}

int files_try_to_close(int file)
{
    int failed = fclose(files[file - 1]);
    files[file - 1] = NULL;
    return !failed;
}

void files_print(const char *text)
{
    fputs(text, stdout);
}

uint32_t files_read_instruction_counter(void)
{
    return 0;
}

uint32_t files_instructions_elapsed(uint32_t from, uint32_t to)
{
    return to - from;
}

size_t files_stack_used(void)
{
    return 0;
}
