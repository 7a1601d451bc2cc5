/* SPDX-License-Identifier: MIT */
/*
 * state_file: files that a program writes for its next start, as the node its snapshot. A cut of
 * power and a full disk leave the old file or the new one, whole; a file that is damaged all the
 * same is set aside, so that nothing of it is lost and the program runs.
 */
#ifndef RHOTRACK_TOOL_STATE_FILE_H
#define RHOTRACK_TOOL_STATE_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Writes the contents of a file; false with errno where that fails. */
typedef bool state_file_writer(FILE *file, const void *context);

/*
 * Replaces the file: writes PATH.part beside it, syncs that to the disk, renames it, and syncs the
 * folder. Returns false with errno on failure, and leaves the file as it was. A PATH.part that a
 * killed program left is removed. The new file has the permissions of the old one. A symbolic link
 * is kept; to a file without a name, as /dev/fd/3 may be, it is refused.
 */
bool state_file_replace(const char *path, state_file_writer *write, const void *context);

/* Whether a file beside the path can be made; errno says why not. */
bool state_file_is_writable(const char *path);

/*
 * Reads a file into new memory; NULL where it is missing (*error 0) or the disk does not give it
 * (*error: errno). Exit 2 for what is no regular file, exit 1 for a path that may not be read; what
 * names the contents, as in "snapshot".
 */
uint8_t *state_file_read(const char *path, const char *what, size_t *size, int *error);

/*
 * Renames a file that is damaged or not the program's own to PATH.damaged, or to .damaged.2 to
 * .damaged.4 where earlier ones are kept; the last one is then replaced. Says so on standard error.
 * Returns false where it could not be renamed: then it must not be written over.
 *   why   "PATH: what is wrong"
 *   then  what comes of it, as "tracks begin anew"
 */
bool state_file_set_aside(const char *path, const char *why, const char *then);

/* Exit 2 where the path, which may be NULL, is that of another file of the program, or NULL. */
void state_file_refuse_same(const char *path, const char *what, const char *other,
                            const char *others_what);

/* CRC-32 (IEEE 802.3), as in a snapshot (rhotrack/snapshot.h). */
uint32_t state_file_crc(const void *bytes, size_t size);

#endif
