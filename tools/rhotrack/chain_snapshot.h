/* SPDX-License-Identifier: MIT */
/* chain_snapshot: a chain in a file, and back (rhotrack/snapshot.h). */
#ifndef RHOTRACK_TOOL_CHAIN_SNAPSHOT_H
#define RHOTRACK_TOOL_CHAIN_SNAPSHOT_H

#include "chain.h"

/* Writes the chain beside the file, to the disk, and renames. False: it failed, with errno; the file is as it was. */
bool chain_save(const struct chain *chain, const char *path);

enum chain_restored {
    CHAIN_RESTORED,
    CHAIN_NO_FILE, /* there is none, or it is empty */
    CHAIN_REFUSED, /* damaged, of another version or build, or of other parameters: said on standard error */
};

/*
 * Takes a chain with bearings over from the file; it was opened with these parameters, and is left alone where it is not
 * CHAIN_RESTORED. A file that is no snapshot at all: exit 2, so that it is not written over.
 */
enum chain_restored chain_restore(struct chain *chain, const struct parameters *parameters,
                                  const char *path);

#endif
