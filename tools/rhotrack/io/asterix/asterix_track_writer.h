/* SPDX-License-Identifier: MIT */
/*
 * asterix_track_writer: writes tracks as an ASTERIX recording, CAT062: one record for each track
 * and list, in data blocks of at most ASTERIX_TRACKS_BLOCK bytes, which fit datagrams. Each list
 * begins a block.
 *
 * A track's number is its identity modulo 65536. Its first record is marked as first. When a list
 * no longer has the track, one more record marks its end, with the state of the list before and the
 * time of the list without it. Position and velocity are those of the local frame; latitude and
 * longitude, and where heights are measured the altitude above the ellipsoid, are added where the
 * origin is set. SAC and SIC are the parameters asterix_sac and asterix_sic.
 */
#ifndef RHOTRACK_TOOL_ASTERIX_TRACK_WRITER_H
#define RHOTRACK_TOOL_ASTERIX_TRACK_WRITER_H

#include <stdbool.h>
#include <stdio.h>

#include "rhotrack/message.h"
#include "settings/parameters.h"

#define ASTERIX_TRACKS_BLOCK 1400u

struct asterix_track_writer;

/* Whether an output of this name is an ASTERIX recording: it ends with .ast or .asterix. */
bool asterix_track_writer_is_path(const char *path);

/* Exit 2 where an ASTERIX output is requested with covariances, for which CAT062 has no item. */
void asterix_track_writer_check(const char *path, bool with_covariance);

/* Starts writing to a file, which the caller keeps and closes. */
struct asterix_track_writer *asterix_track_writer_open(FILE *file,
                                                       const struct parameters *parameters);

/* Adds a message of tracks; the last part of a list writes the whole list. */
void asterix_track_writer_add(struct asterix_track_writer *tracks,
                              const struct rho_message_track_list *message);
void asterix_track_writer_free(
    struct asterix_track_writer *tracks); /* Frees the writer; NULL is allowed. */

#endif
