/* SPDX-License-Identifier: MIT */
#include "base/state_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/common.h"

/*
 * Files that are set aside and kept. A disk that damages a file at each start must not fill itself
 * with them; the first ones, which show how it began, stay.
 */
#define KEPT_MAX 4

static char *path_with_ending(const char *path, const char *ending)
{
    const size_t bytes = strlen(path) + strlen(ending) + 1;
    char *name = must_alloc(bytes);

    snprintf(name, bytes, "%s%s", path, ending);
    return name;
}

/* ---- Write ---- */

/* The file that the path leads to, in new memory; NULL with errno where it has no name. */
static char *resolve_links(const char *path)
{
    char *target = realpath(path, NULL);
    struct stat status;

    if (!target && stat(path, &status) == 0) {
        errno = ENOENT;
        return NULL;
    }
    return target ? target : must_copy_text(path);
}

/*
 * Creates the part; the descriptor, or -1 with errno. What is there is removed, not opened: it may
 * be read-only, or a link that somebody else made.
 */
static int create_part(const char *part)
{
    unlink(part);
    return open(part, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
}

/* Writes the part to the disk, with the target's permissions; returns 0 or errno. */
static int write_part(const char *part, const char *target, state_file_writer *write,
                      const void *context)
{
    const int descriptor = create_part(part);
    FILE *file = descriptor >= 0 ? fdopen(descriptor, "w") : NULL;
    struct stat status;
    int refused;

    if (!file) {
        return errno;
    }
    if (stat(target, &status) == 0) {
        (void)!fchmod(descriptor, status.st_mode & 07777);
    }
    errno = EIO; /* where the writer gives no reason */
    refused = write(file, context) && fflush(file) == 0 && fsync(descriptor) == 0 ? 0 : errno;
    return fclose(file) != 0 && refused == 0 ? errno : refused;
}

/* Syncs the folder of a file, so that its new name is on the disk; returns 0 or errno. */
static int sync_folder_of(const char *target)
{
    const char *slash = strrchr(target, '/');
    char *folder = slash ? strndup(target, (size_t)(slash - target) + 1) : must_copy_text(".");
    const int descriptor = folder ? open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
    int refused = descriptor < 0 || fsync(descriptor) != 0 ? errno : 0;

    if (descriptor >= 0) {
        close(descriptor);
    }
    free(folder);
    return refused == EINVAL ? 0 : refused; /* a file system that syncs no folders */
}

bool state_file_replace(const char *path, state_file_writer *write, const void *context)
{
    char *target = resolve_links(path), *part;
    int refused;

    if (!target) {
        return false;
    }
    part = path_with_ending(target, ".part");
    refused = write_part(part, target, write, context);
    if (refused == 0 && rename(part, target) != 0) {
        refused = errno;
    }
    if (refused) {
        unlink(part);
    } else {
        refused = sync_folder_of(target);
    }
    free(part);
    free(target);
    errno = refused;
    return refused == 0;
}

bool state_file_is_writable(const char *path)
{
    char *target = resolve_links(path), *part;
    int descriptor, refused;

    if (!target) {
        return false;
    }
    part = path_with_ending(target, ".part");
    descriptor = create_part(part);
    refused = descriptor < 0 ? errno : 0;
    if (descriptor >= 0) {
        close(descriptor);
        unlink(part);
    }
    free(part);
    free(target);
    errno = refused;
    return refused == 0;
}

/* ---- Read ---- */

/* Whether the fault is one of the command line and its permissions, and not of the disk. */
static bool is_fault_of_path(int error)
{
    return error == EACCES || error == EPERM || error == ENOTDIR || error == ELOOP ||
           error == ENAMETOOLONG;
}

/* Opens a regular file; -1 with errno, ENOENT where it is missing. */
static int open_regular(const char *path, const char *what)
{
    struct stat status;
    int descriptor = -1;

    if (stat(path, &status) == 0) {
        if (!S_ISREG(status.st_mode)) {
            fail(EXIT_USAGE, "%s: not a regular file; a %s cannot be written to it", path, what);
        }
        descriptor = open(path, O_RDONLY | O_CLOEXEC);
    }
    if (descriptor < 0 && is_fault_of_path(errno)) {
        fail(EXIT_RUNTIME, "%s: %s", path, strerror(errno));
    }
    return descriptor;
}

uint8_t *state_file_read(const char *path, const char *what, size_t *size, int *error)
{
    const int file = open_regular(path, what);
    uint8_t *bytes = NULL;
    size_t room = 0;
    ssize_t got = 1;

    *size = 0;
    *error = file < 0 && errno != ENOENT ? errno : 0;
    while (file >= 0 && *error == 0 && got > 0) {
        if (*size == room) {
            room = room ? 2 * room : 1 << 20;
            bytes = must_realloc(bytes, room);
        }
        got = read(file, bytes + *size, room - *size);
        if (got < 0 && errno == EINTR) {
            got = 1;
        } else if (got < 0) {
            *error = errno;
        } else {
            *size += (size_t)got;
        }
    }
    if (file >= 0) {
        close(file);
    }
    if (*error) {
        free(bytes);
        bytes = NULL;
    }
    return bytes;
}

/* ---- Damaged files ---- */

/* The first name that is free for a file to be set aside, or the last one. */
static char *name_of_damaged(const char *path)
{
    char ending[32] = ".damaged";
    struct stat status;
    char *name = path_with_ending(path, ending);

    for (int i = 2; i <= KEPT_MAX && lstat(name, &status) == 0; i++) {
        free(name);
        snprintf(ending, sizeof ending, ".damaged.%d", i);
        name = path_with_ending(path, ending);
    }
    return name;
}

bool state_file_set_aside(const char *path, const char *why, const char *then)
{
    char *name = name_of_damaged(path);
    const bool is_aside = rename(path, name) == 0;

    if (is_aside) {
        fprintf(stderr, "rhotrack: %s; set aside as %s; %s\n", why, name, then);
    } else {
        fprintf(stderr, "rhotrack: %s; it cannot be set aside (%s), and is not written; %s\n", why,
                strerror(errno), then);
    }
    free(name);
    return is_aside;
}

void state_file_refuse_same(const char *path, const char *what, const char *other,
                            const char *others_what)
{
    if (path && other && (strcmp(path, other) == 0 || is_same_file(path, other))) {
        fail(EXIT_USAGE, "%s: the %s cannot be the %s", path, others_what, what);
    }
}

/* ---- Checksum ---- */

uint32_t state_file_crc(const void *bytes, size_t size)
{
    static uint32_t table[256];
    uint32_t crc = UINT32_MAX;

    for (uint32_t i = 0; table[255] == 0 && i < 256; i++) {
        uint32_t row = i;

        for (int bit = 0; bit < 8; bit++) {
            row = row >> 1 ^ (row & 1 ? UINT32_C(0xedb88320) : 0);
        }
        table[i] = row;
    }
    for (size_t i = 0; i < size; i++) {
        crc = crc >> 8 ^ table[(crc ^ ((const uint8_t *)bytes)[i]) & 255];
    }
    return ~crc;
}
