/* SPDX-License-Identifier: MIT */
/* State files: written whole or not at all, and set aside where they are damaged. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <errno.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "base/state_file.h"
#include "tools/state_folder.h"

static bool write_text(FILE *file, const void *context)
{
    return fputs(context, file) >= 0;
}

static bool write_half(FILE *file, const void *context)
{
    (void)fputs(context, file);
    errno = ENOSPC;
    return false;
}

static void assert_contents(const char *path, const char *expected)
{
    char text[64];
    const size_t size = read_whole_file(path, text, sizeof text - 1);

    text[size] = '\0';
    assert_string_equal(text, expected);
}

static void a_file_is_replaced_with_its_permissions(void **state)
{
    struct stat status;

    (void)state;
    assert_true(state_file_replace("state", write_text, "one"));
    assert_contents("state", "one");
    assert_int_equal(chmod("state", 0640), 0);
    assert_true(state_file_replace("state", write_text, "two"));
    assert_contents("state", "two");
    assert_int_equal(stat("state", &status), 0);
    assert_int_equal(status.st_mode & 07777, 0640);
    assert_int_equal(count_files(), 1);
    empty_state_folder();
}

static void a_write_that_fails_leaves_the_old_file(void **state)
{
    (void)state;
    assert_true(state_file_replace("state", write_text, "one"));
    assert_false(state_file_replace("state", write_half, "two"));
    assert_int_equal(errno, ENOSPC);
    assert_contents("state", "one");
    assert_int_equal(count_files(), 1);
    assert_false(state_file_replace("nowhere/state", write_text, "two"));
    assert_int_equal(errno, ENOENT);
    assert_false(state_file_is_writable("nowhere/state"));
    assert_int_equal(errno, ENOENT);
    assert_false(state_file_replace("state/state", write_text, "two"));
    assert_int_equal(errno, ENOTDIR);
    empty_state_folder();
}

/* The buffer of a stream reaches the disk at its end only: its failure counts, too. */
static void a_disk_that_refuses_the_last_bytes_is_a_failure(void **state)
{
    int status;

    (void)state;
    assert_true(state_file_replace("state", write_text, "one"));
    if (fork() == 0) {
        const struct rlimit limit = {3, 3};

        signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &limit);
        _exit(state_file_replace("state", write_text, "three") ? 0 : errno);
    }
    wait(&status);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), EFBIG);
    assert_contents("state", "one");
    assert_int_equal(count_files(), 1);
    empty_state_folder();
}

static void what_a_killed_program_left_does_not_matter(void **state)
{
    (void)state;
    write_whole_file("state.part", "half", 4);
    assert_int_equal(chmod("state.part", 0400), 0);
    assert_true(state_file_is_writable("state"));
    assert_int_equal(count_files(), 0);
    write_whole_file("other", "other", 5);
    assert_int_equal(symlink("other", "state.part"), 0);
    assert_true(state_file_replace("state", write_text, "one"));
    assert_contents("state", "one");
    assert_contents("other", "other");
    assert_int_equal(count_files(), 2);
    assert_int_equal(mkdir("state.part", 0700), 0);
    assert_false(state_file_replace("state", write_text, "two"));
    assert_int_equal(errno, EEXIST);
    assert_contents("state", "one");
    empty_state_folder();
}

static void a_link_is_kept(void **state)
{
    struct stat status;

    (void)state;
    assert_int_equal(mkdir("folder", 0700), 0);
    write_whole_file("folder/real", "one", 3);
    assert_int_equal(symlink("folder/real", "state"), 0);
    assert_true(state_file_replace("state", write_text, "two"));
    assert_int_equal(lstat("state", &status), 0);
    assert_true(S_ISLNK(status.st_mode));
    assert_contents("folder/real", "two");
    assert_int_equal(remove("folder/real"), 0);
    empty_state_folder();
}

static void a_bounded_number_is_set_aside(void **state)
{
    static const char *const names[] = {"state.damaged", "state.damaged.2", "state.damaged.3",
                                        "state.damaged.4"};

    (void)state;
    for (int i = 0; i < 9; i++) {
        char text[2] = {(char)('0' + i), '\0'}, expected[128];

        write_whole_file("state", text, 1);
        listen_to_stderr();
        assert_true(state_file_set_aside("state", "state: bad", "all begins anew"));
        end_of_listening();
        snprintf(expected, sizeof expected, "rhotrack: state: bad; set aside as %s; %s\n",
                 names[i < 3 ? i : 3], "all begins anew");
        assert_string_equal(said, expected);
        assert_false(is_file("state"));
        assert_contents(names[i < 3 ? i : 3], text);
    }
    assert_int_equal(count_files(), 4);
    assert_contents(names[0], "0");
    listen_to_stderr();
    assert_false(state_file_set_aside("state", "state: bad", "all begins anew"));
    end_of_listening();
    assert_string_equal(said, "rhotrack: state: bad; it cannot be set aside (No such file or "
                              "directory), and is not written; all begins anew\n");
    empty_state_folder();
}

static void a_file_is_read_whole_or_its_error_is_told(void **state)
{
    static uint8_t big[(1 << 20) + 3];
    uint8_t *bytes;
    size_t size;
    int error;

    (void)state;
    assert_null(state_file_read("state", "test", &size, &error));
    assert_int_equal(error, 0);
    write_whole_file("state", big, 0);
    bytes = state_file_read("state", "test", &size, &error);
    assert_non_null(bytes);
    assert_int_equal(size, 0);
    free(bytes);
    big[sizeof big - 1] = 9;
    write_whole_file("state", big, sizeof big);
    bytes = state_file_read("state", "test", &size, &error);
    assert_int_equal(size, sizeof big);
    assert_memory_equal(bytes, big, sizeof big);
    free(bytes);
    /* a regular file that opens and cannot be read */
    assert_null(state_file_read("/proc/self/mem", "test", &size, &error));
    assert_int_equal(error, EIO);
    empty_state_folder();
}

static void the_checksum_is_crc_32(void **state)
{
    (void)state;
    assert_int_equal(state_file_crc("123456789", 9), 0xcbf43926);
    assert_int_equal(state_file_crc("", 0), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_is_replaced_with_its_permissions),
        cmocka_unit_test(a_write_that_fails_leaves_the_old_file),
        cmocka_unit_test(a_disk_that_refuses_the_last_bytes_is_a_failure),
        cmocka_unit_test(what_a_killed_program_left_does_not_matter),
        cmocka_unit_test(a_link_is_kept),
        cmocka_unit_test(a_bounded_number_is_set_aside),
        cmocka_unit_test(a_file_is_read_whole_or_its_error_is_told),
        cmocka_unit_test(the_checksum_is_crc_32),
    };

    return cmocka_run_group_tests(tests, enter_state_folder, leave_state_folder);
}
