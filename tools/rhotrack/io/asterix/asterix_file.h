/* SPDX-License-Identifier: MIT */
/*
 * asterix_file: reads the radar records (CAT048, CAT034, CAT001, CAT002) of a recording, which is a
 * file of data blocks one after the other as they were sent, or a network recording whose UDP
 * datagrams hold them (captured_datagrams.h).
 *
 * Blocks of other categories are skipped, and reported by category with their number. Damage is an
 * error, `rhotrack: FILE: byte N: what is wrong`, exit 2; with keep_going the rest of the damaged
 * block is skipped, and where its length cannot be trusted all bytes up to the next block of these
 * categories that can be read as a whole. In a network recording the place is `packet N, byte M of
 * its content`; datagrams that do not consist of whole blocks are left out and counted.
 */
#ifndef RHOTRACK_TOOL_ASTERIX_FILE_H
#define RHOTRACK_TOOL_ASTERIX_FILE_H

#include <stdio.h>

#include "io/asterix/asterix_codec.h"

/*
 * Whether a file is an ASTERIX recording: its name ends with .ast or .asterix, or it is a plain
 * file that begins with a readable data block of radar or track records, or like a network
 * recording.
 */
bool asterix_file_is_asterix(const char *path);

/*
 * The first place of a radar that a recording states; is_given is false where there is none, and
 * for other files. Bad blocks are skipped without a report.
 */
struct asterix_place asterix_file_radar_place(const char *path);

struct asterix_file;

/* Opens a plain file to read radar records. Errors: exit 2. Memory: 256 KiB. */
struct asterix_file *asterix_file_open(const char *path, bool keep_going);

/* Opens a plain file to read records of tracks (CAT062) instead of radar records. */
struct asterix_file *asterix_file_open_tracks(const char *path, bool keep_going);

/* Reads the next record, valid until the next call. Returns false after the last record. */
bool asterix_file_next_record(struct asterix_file *file, struct asterix_record *record);

/* Number of bytes read, of the file or of the datagrams' contents. */
uint64_t asterix_file_position(const struct asterix_file *file);

/* Number of blocks of a category that were left out so far, since it is not read. */
uint64_t asterix_file_skipped_blocks(const struct asterix_file *file, uint8_t category);

/* Reports skipped bytes, left-out blocks and left-out datagrams on standard error, if any. */
void asterix_file_report_skipped(const struct asterix_file *file);
void asterix_file_close(struct asterix_file *file);

#endif
