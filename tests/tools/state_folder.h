/* SPDX-License-Identifier: MIT */
/* state_folder: a folder of a test's own for state files, what is in it, and what is said. */
#ifndef RHO_TEST_STATE_FOLDER_H
#define RHO_TEST_STATE_FOLDER_H

#include <dirent.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char state_folder[] = "/tmp/rhotrack-state-XXXXXX";
static char said[65536];
static int own_stderr = -1;

/* Group setup: makes the folder and goes there. */
static inline int enter_state_folder(void **state)
{
    (void)state;
    return mkdtemp(state_folder) && chdir(state_folder) == 0 ? 0 : -1;
}

static inline unsigned count_files(void)
{
    DIR *folder = opendir(".");
    unsigned count = 0;

    for (const struct dirent *entry; folder && (entry = readdir(folder));) {
        count += entry->d_name[0] != '.';
    }
    closedir(folder);
    return count;
}

/* Removes all files of the folder. */
static inline void empty_state_folder(void)
{
    DIR *folder = opendir(".");

    for (const struct dirent *entry; folder && (entry = readdir(folder));) {
        (void)!remove(entry->d_name);
    }
    closedir(folder);
}

/* Group teardown. */
static inline int leave_state_folder(void **state)
{
    (void)state;
    empty_state_folder();
    return chdir("/") == 0 && rmdir(state_folder) == 0 ? 0 : -1;
}

/* From here on standard error goes to `said`, which end_of_listening fills. */
static inline void listen_to_stderr(void)
{
    const int file = open(".said", O_RDWR | O_CREAT | O_TRUNC, 0600);

    own_stderr = dup(STDERR_FILENO);
    dup2(file, STDERR_FILENO);
    close(file);
}

static inline void end_of_listening(void)
{
    ssize_t got;

    fflush(stderr);
    got = pread(STDERR_FILENO, said, sizeof said - 1, 0);
    said[got > 0 ? got : 0] = '\0';
    dup2(own_stderr, STDERR_FILENO);
    close(own_stderr);
    unlink(".said");
}

static inline void write_whole_file(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");

    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0) {
        abort();
    }
}

static inline size_t read_whole_file(const char *path, void *bytes, size_t room)
{
    FILE *file = fopen(path, "rb");
    const size_t size = file ? fread(bytes, 1, room, file) : 0;

    if (!file) {
        abort();
    }
    fclose(file);
    return size;
}

static inline bool is_file(const char *path)
{
    struct stat status;

    return stat(path, &status) == 0;
}

#endif
