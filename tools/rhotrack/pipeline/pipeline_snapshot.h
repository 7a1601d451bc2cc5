/* SPDX-License-Identifier: MIT */
/* pipeline_snapshot: saves a pipeline to a file, and restores it (rhotrack/snapshot.h). */
#ifndef RHOTRACK_TOOL_PIPELINE_SNAPSHOT_H
#define RHOTRACK_TOOL_PIPELINE_SNAPSHOT_H

#include "pipeline/pipeline.h"

/*
 * Saves the pipeline: writes a file beside `path`, syncs it to the disk, and renames it. Returns
 * false with errno on failure, and leaves the file as it was.
 */
bool pipeline_save_snapshot(struct pipeline *pipeline, const char *path);

enum pipeline_restored {
    PIPELINE_RESTORED,
    PIPELINE_NO_FILE, /* no snapshot file, or an empty one */
    /* damaged, or of another version, build or parameters: reported on standard error */
    PIPELINE_REFUSED,
};

/*
 * Restores a pipeline that was opened with these parameters and with bearings; the pipeline is
 * unchanged unless PIPELINE_RESTORED is returned. Settings that an operator had changed are set in
 * the parameters. Exit 2 for a file that is not a snapshot, so that it is not overwritten.
 */
enum pipeline_restored pipeline_restore_snapshot(struct pipeline *pipeline,
                                                 struct parameters *parameters, const char *path);

#endif
