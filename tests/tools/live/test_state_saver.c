/* SPDX-License-Identifier: MIT */
/*
 * The node's saver of state files on bad disks: each failure is said once, and so is its end; the
 * process that writes does not outlive the node.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>

#include "live/state_saver.h"
#include "tools/state_folder.h"

#define MINUTE_US INT64_C(60000000)

/* What the disk does: an errno, or one of these. */
enum { DISK_GOOD = 0, DISK_KILLS = -1, DISK_STALLS = -2 };

static int disk;
static int stalled[2]; /* a pipe: the process that stalls ends with the first byte in it */

static bool save(void *context, const char *path)
{
    const int does = *(const int *)context;
    char byte;

    if (does == DISK_KILLS) {
        raise(SIGKILL);
    } else if (does == DISK_STALLS) {
        (void)!read(stalled[0], &byte, 1);
    } else if (does != DISK_GOOD) {
        errno = does;
        return false;
    }
    write_whole_file(path, "state", 5);
    return true;
}

static struct state_saver start_saver(const char *path)
{
    struct state_saver saver = {.path = path, .what = "test", .save = save, .context = &disk};

    disk = DISK_GOOD;
    state_saver_start(&saver, 0);
    return saver;
}

/* Saves at this minute, waits until the process has ended, and returns what was said. */
static const char *save_at_minute(struct state_saver *saver, int minute)
{
    listen_to_stderr();
    state_saver_save_when_due(saver, minute * MINUTE_US);
    assert_true(saver->process > 0);
    while (saver->process > 0) {
        usleep(500);
        state_saver_save_when_due(saver, minute * MINUTE_US);
    }
    end_of_listening();
    return said;
}

static void a_failure_is_said_once_and_so_is_its_end(void **state)
{
    struct state_saver saver = start_saver("state");

    (void)state;
    assert_string_equal(save_at_minute(&saver, 1), "");
    assert_true(is_file("state"));
    disk = ENOSPC;
    assert_string_equal(save_at_minute(&saver, 2),
                        "rhotrack: state: No space left on device; the test is not written\n");
    assert_string_equal(save_at_minute(&saver, 3), "");
    assert_string_equal(save_at_minute(&saver, 4), "");
    disk = EROFS;
    assert_string_equal(save_at_minute(&saver, 5),
                        "rhotrack: state: Read-only file system; the test is not written\n");
    assert_string_equal(save_at_minute(&saver, 6), "");
    disk = DISK_GOOD;
    assert_string_equal(save_at_minute(&saver, 7), "rhotrack: state: the test is written again\n");
    assert_string_equal(save_at_minute(&saver, 8), "");
    disk = DISK_KILLS;
    assert_string_equal(
        save_at_minute(&saver, 9),
        "rhotrack: state: the process that writes it was killed; the test is not written\n");
    assert_string_equal(save_at_minute(&saver, 10), "");
    disk = DISK_GOOD;
    assert_string_equal(save_at_minute(&saver, 11), "rhotrack: state: the test is written again\n");
    empty_state_folder();
}

static void nothing_is_saved_before_a_minute(void **state)
{
    struct state_saver saver = start_saver("state");

    (void)state;
    state_saver_save_when_due(&saver, MINUTE_US - 1);
    assert_int_equal(saver.process, 0);
    (void)save_at_minute(&saver, 1);
    state_saver_save_when_due(&saver, 2 * MINUTE_US - 1);
    assert_int_equal(saver.process, 0);
    saver.path = NULL;
    state_saver_save_when_due(&saver, 5 * MINUTE_US);
    assert_int_equal(saver.process, 0);
    assert_true(state_saver_save_at_end(&saver));
    empty_state_folder();
}

static void a_slow_disk_is_said_once_and_holds_nothing_up(void **state)
{
    struct state_saver saver = start_saver("state");
    pid_t first;

    (void)state;
    assert_int_equal(pipe(stalled), 0);
    disk = DISK_STALLS;
    listen_to_stderr();
    state_saver_save_when_due(&saver, MINUTE_US);
    first = saver.process;
    for (int minute = 2; minute < 6; minute++) {
        state_saver_save_when_due(&saver, minute * MINUTE_US);
    }
    end_of_listening();
    assert_string_equal(said, "rhotrack: state: the disk is slow; the test is not written yet\n");
    assert_int_equal(saver.process, first);
    disk = DISK_GOOD;
    assert_int_equal(write(stalled[1], "x", 1), 1);
    listen_to_stderr();
    while (saver.process == first) {
        usleep(500);
        state_saver_save_when_due(&saver, 5 * MINUTE_US);
    }
    end_of_listening();
    assert_string_equal(said, "rhotrack: state: the test is written again\n");
    close(stalled[0]);
    close(stalled[1]);
    empty_state_folder();
}

static void a_path_that_cannot_be_written_is_said_at_the_start(void **state)
{
    struct state_saver saver;

    (void)state;
    listen_to_stderr();
    saver = start_saver("folder/state");
    disk = ENOENT;
    assert_false(state_saver_save_at_end(&saver));
    end_of_listening();
    assert_string_equal(
        said, "rhotrack: folder/state: No such file or directory; the test is not written\n");
    assert_int_equal(mkdir("folder", 0700), 0);
    disk = DISK_GOOD;
    listen_to_stderr();
    assert_true(state_saver_save_at_end(&saver));
    end_of_listening();
    assert_string_equal(said, "rhotrack: folder/state: the test is written again\n");
    assert_int_equal(remove("folder/state"), 0);
    empty_state_folder();
}

/* Else it would, once the disk answers, put an old state over that of the next node. */
static void a_process_that_stalls_ends_with_its_node(void **state)
{
    struct pollfd here = {.events = POLLIN};
    int alive[2], status;

    (void)state;
    assert_int_equal(pipe(stalled), 0);
    assert_int_equal(pipe(alive), 0);
    if (fork() == 0) {
        struct state_saver saver = start_saver("state");

        disk = DISK_STALLS;
        state_saver_save_when_due(&saver, MINUTE_US);
        _exit(saver.process > 0 ? 0 : 1);
    }
    wait(&status);
    assert_int_equal(status, 0);
    close(alive[1]);
    here.fd = alive[0];
    assert_int_equal(poll(&here, 1, 10000), 1); /* it alone still held the other end */
    assert_false(is_file("state"));
    close(alive[0]);
    close(stalled[0]);
    close(stalled[1]);
    empty_state_folder();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_failure_is_said_once_and_so_is_its_end),
        cmocka_unit_test(nothing_is_saved_before_a_minute),
        cmocka_unit_test(a_slow_disk_is_said_once_and_holds_nothing_up),
        cmocka_unit_test(a_path_that_cannot_be_written_is_said_at_the_start),
        cmocka_unit_test(a_process_that_stalls_ends_with_its_node),
    };

    return cmocka_run_group_tests(tests, enter_state_folder, leave_state_folder);
}
