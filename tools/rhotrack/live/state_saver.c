/* SPDX-License-Identifier: MIT */
#include "live/state_saver.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/state_file.h"

#define SAVE_US 60000000
#define KILLED (-1)

static void say_outcome(struct state_saver *saver, int error)
{
    if (error && error != saver->error_said) {
        fprintf(stderr, "rhotrack: %s: %s; the %s is not written\n", saver->path,
                error == KILLED ? "the process that writes it was killed" : strerror(error),
                saver->what);
    } else if (!error && (saver->error_said || saver->is_late_said)) {
        fprintf(stderr, "rhotrack: %s: the %s is written again\n", saver->path, saver->what);
    }
    saver->error_said = error;
    saver->is_late_said = false;
}

/* Says what came of a save that has ended; waitpid's options say whether to wait for its end. */
static void reap_process(struct state_saver *saver, int options)
{
    int status = 0;

    if (saver->process > 0 && waitpid(saver->process, &status, options) != 0) {
        saver->process = 0;
        say_outcome(saver, WIFEXITED(status) ? WEXITSTATUS(status) : KILLED);
    }
}

/*
 * Starts the process that writes. It ends with the node: one that a slow disk holds up would else
 * write over the file of the node's successor.
 */
static void start_process(struct state_saver *saver)
{
    const pid_t node = getpid();

    saver->process = fork();
    if (saver->process == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (getppid() != node) { /* it ended before the line above */
            _exit(EXIT_FAILURE);
        }
        _exit(saver->save(saver->context, saver->path) ? 0 : errno);
    }
    if (saver->process < 0) {
        say_outcome(saver, errno);
        saver->process = 0;
    }
}

void state_saver_start(struct state_saver *saver, int64_t now_us)
{
    saver->due_us = now_us + SAVE_US;
    if (saver->path && !state_file_is_writable(saver->path)) {
        say_outcome(saver, errno);
    }
}

void state_saver_save_when_due(struct state_saver *saver, int64_t now_us)
{
    if (!saver->path) {
        return;
    }
    reap_process(saver, WNOHANG);
    if (now_us < saver->due_us) {
        return;
    }
    saver->due_us = now_us + SAVE_US;
    if (saver->process == 0) {
        start_process(saver);
    } else if (!saver->is_late_said) {
        fprintf(stderr, "rhotrack: %s: the disk is slow; the %s is not written yet\n", saver->path,
                saver->what);
        saver->is_late_said = true;
    }
}

bool state_saver_save_at_end(struct state_saver *saver)
{
    if (!saver->path) {
        return true;
    }
    reap_process(saver, 0);
    say_outcome(saver, saver->save(saver->context, saver->path) ? 0 : errno);
    return saver->error_said == 0;
}
