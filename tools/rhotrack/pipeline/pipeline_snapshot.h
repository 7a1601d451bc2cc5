/* SPDX-License-Identifier: MIT */
/* pipeline_snapshot: saves a pipeline to a file, and restores it (rhotrack/snapshot.h). */
#ifndef RHOTRACK_TOOL_PIPELINE_SNAPSHOT_H
#define RHOTRACK_TOOL_PIPELINE_SNAPSHOT_H

#include "pipeline/pipeline.h"

/* Saves the pipeline, as state_file_replace: false with errno on failure. */
bool pipeline_save_snapshot(struct pipeline *pipeline, const char *path);

enum pipeline_restored {
    PIPELINE_RESTORED,
    PIPELINE_NO_FILE,
    /*
     * reported on standard error: empty, damaged and set aside, or of another version, build or
     * parameters
     */
    PIPELINE_REFUSED,
    PIPELINE_STUCK, /* damaged, and cannot be set aside: must not be written over */
};

/*
 * Restores a pipeline that was opened with these parameters and with bearings; the pipeline is
 * unchanged unless PIPELINE_RESTORED is returned. Settings that an operator had changed are set in
 * the parameters. Exit 2 for a text and for what is no regular file, exit 1 for a path that may not
 * be read.
 */
enum pipeline_restored pipeline_restore_snapshot(struct pipeline *pipeline,
                                                 struct parameters *parameters, const char *path);

#endif
