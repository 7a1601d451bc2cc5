/* SPDX-License-Identifier: MIT */
/*
 * asterix_file: the records of radars (CAT048, CAT034, CAT001, CAT002) of a recording: data blocks
 * one after the other, as they were sent; or those in the UDP datagrams of a network recording
 * (captured_datagrams.h).
 *
 * Blocks of other categories are skipped and counted, a line each. A bad place is an error,
 * `rhotrack: FILE: byte N: what is wrong`, exit 2; with keep_going the rest of its block is
 * skipped, and where its length is not to be believed all bytes up to the next block of these
 * categories that is good as a whole. In a network recording the place is `packet N, byte M of its
 * content`; datagrams that are not blocks from the first byte to the last are left out and counted.
 */
#ifndef RHOTRACK_TOOL_ASTERIX_FILE_H
#define RHOTRACK_TOOL_ASTERIX_FILE_H

#include <stdio.h>

#include "io/asterix/asterix.h"

/*
 * Whether a file is a recording: a name that ends with .ast or .asterix, or a plain file that
 * begins with a data block of such records, or of tracks (CAT062), that is good as a whole, or as a
 * network recording.
 */
bool asterix_file_is_asterix(const char *path);

/* Whether such a data block, or one of tracks, begins there of which every record can be read. */
bool asterix_block_is_good(const uint8_t *data, size_t size);

/*
 * The first place of a radar that a recording tells; none in any other file. Nothing is said of bad
 * ones.
 */
struct asterix_place asterix_file_radar_place(const char *path);

struct asterix_file;

/* A plain file. Errors: exit 2. Memory: four of the longest blocks. */
struct asterix_file *asterix_file_open(const char *path, bool keep_going);

/* The same, for the records of tracks (CAT062) in place of those of radars. */
struct asterix_file *asterix_file_open_tracks(const char *path, bool keep_going);

/* The next record, valid until the next call. Returns false after the last. */
bool asterix_file_next_record(struct asterix_file *file, struct asterix_record *record);

/* How many bytes of the file, or of the blocks in its datagrams, are taken. */
uint64_t asterix_file_position(const struct asterix_file *file);

/* How many records there were so far. */
uint64_t asterix_file_num_records(const struct asterix_file *file);

/* How many blocks of a category that is not read were left out so far. */
uint64_t asterix_file_num_skipped_blocks(const struct asterix_file *file, uint8_t category);

/* Tells on standard error what was skipped, if anything. */
void asterix_file_report_skipped(const struct asterix_file *file);
void asterix_file_close(struct asterix_file *file);

#endif
