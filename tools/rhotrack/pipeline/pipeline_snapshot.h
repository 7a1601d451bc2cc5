/* SPDX-License-Identifier: MIT */
/* pipeline_snapshot: a pipeline in a file, and back (rhotrack/snapshot.h). */
#ifndef RHOTRACK_TOOL_PIPELINE_SNAPSHOT_H
#define RHOTRACK_TOOL_PIPELINE_SNAPSHOT_H

#include "pipeline/pipeline.h"

/*
 * Writes the pipeline beside the file, to the disk, and renames. False: it failed, with errno; the
 * file is as it was.
 */
bool pipeline_save_snapshot(struct pipeline *pipeline, const char *path);

enum pipeline_restored {
    PIPELINE_RESTORED,
    PIPELINE_NO_FILE, /* there is none, or it is empty */
    /* damaged, of another version or build, or of other parameters: said on standard error */
    PIPELINE_REFUSED,
};

/*
 * Takes a pipeline with bearings over from the file; it was opened with these parameters, and is
 * left alone where it is not PIPELINE_RESTORED. Settings that an operator had changed become those
 * of the parameters. A file that is no snapshot at all: exit 2, so that it is not written over.
 */
enum pipeline_restored pipeline_restore_snapshot(struct pipeline *pipeline,
                                                 struct parameters *parameters, const char *path);

#endif
