/* SPDX-License-Identifier: MIT */
/*
 * state_saver: writes a state file of the node (state_file.h) once a minute, each time in a process
 * of its own, so that messages do not wait for the disk. What fails is said once, and once more
 * when it works again; the last good file stays, and the next attempt is a minute later.
 */
#ifndef RHOTRACK_TOOL_STATE_SAVER_H
#define RHOTRACK_TOOL_STATE_SAVER_H

#include <stdbool.h>
#include <stdint.h>
#include <sys/types.h>

struct state_saver {
    const char *path; /* the caller's text; NULL: nothing is written */
    const char *what; /* names the contents, as in "snapshot" */
    /* writes the file; false with errno where that fails */
    bool (*save)(void *context, const char *path);
    void *context;
    /* private */
    int64_t due_us;    /* monotonic time of the next save */
    pid_t process;     /* the one that writes; 0: none */
    int error_said;    /* errno of the failure that was said, -1 for a killed process; 0: none */
    bool is_late_said; /* it was said that a save does not end */
};

/* Sets the time of the first save, and says where the file cannot be written. */
void state_saver_start(struct state_saver *saver, int64_t now_us);

/* Saves the state if a minute has passed since the last time, and says what came of that. */
void state_saver_save_when_due(struct state_saver *saver, int64_t now_us);

/* Saves the state now, and waits for it. Returns false where it could not be written. */
bool state_saver_save_at_end(struct state_saver *saver);

#endif
