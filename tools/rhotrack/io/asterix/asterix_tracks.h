/* SPDX-License-Identifier: MIT */
/*
 * asterix_tracks: tracks as a recording in ASTERIX, CAT062: one record a track and list, in data
 * blocks of ASTERIX_TRACKS_BLOCK bytes at most, which fit datagrams. Lists begin blocks.
 *
 * A track's number is its identity modulo 65536. Its first record says so, and when a list no
 * longer has it one record more says that it was the last, with what the track was at the list
 * before, at the time of the list without it. Place and velocity are those of the local frame;
 * latitude and longitude, and where heights are measured the altitude above the ellipsoid, are
 * there where the origin is set. SAC and SIC are the parameters asterix_sac and asterix_sic.
 */
#ifndef RHOTRACK_TOOL_ASTERIX_TRACKS_H
#define RHOTRACK_TOOL_ASTERIX_TRACKS_H

#include <stdbool.h>
#include <stdio.h>

#include "rhotrack/message.h"
#include "settings/parameters.h"

#define ASTERIX_TRACKS_BLOCK 1400u

struct asterix_tracks;

/* Whether an output of this name is such a recording: it ends with .ast or .asterix. */
bool asterix_tracks_path_is_asterix(const char *path);

/* Exit 2 where an output of this name is asked for with covariances, which it has no place for. */
void asterix_tracks_refuse_covariance(const char *path, bool with_covariance);

/* The file stays the caller's. */
struct asterix_tracks *asterix_tracks_open(FILE *file, const struct parameters *parameters);

/* A list, or a part of it: with the last part it is complete, and written. */
void asterix_tracks_add(struct asterix_tracks *tracks,
                        const struct rho_message_track_list *message);
void asterix_tracks_close(struct asterix_tracks *tracks); /* NULL: nothing */

#endif
