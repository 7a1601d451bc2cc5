/* SPDX-License-Identifier: MIT */
/*
 * A snapshot that is changed at any byte, or cut at any length, is set aside as it is and never
 * taken: of a small one all bytes and lengths are tried, of a node's own some.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

/* before cmocka.h, which has a macro `fail` */
#include "base/common.h"

#include <cmocka.h>
#include <sys/wait.h>

#include "pipeline/pipeline.h"
#include "pipeline/pipeline_snapshot.h"
#include "rhotrack/snapshot.h"
#include "tools/state_folder.h"

#define TRIES 24 /* bytes and lengths that are tried of a whole snapshot */

static struct parameters parameters;
static struct pipeline pipeline;

static void open_pipeline(void)
{
    parameters_set_defaults(&parameters);
    pipeline = pipeline_allocate();
    pipeline.is_live = true;
    pipeline_open(&pipeline, &parameters);
    pipeline_open_passive(&pipeline, &parameters);
}

static enum pipeline_restored restore(void)
{
    enum pipeline_restored restored;

    listen_to_stderr();
    restored = pipeline_restore_snapshot(&pipeline, &parameters, "state");
    end_of_listening();
    return restored;
}

/* Writes an image of the node's settings alone, which no node takes, but which is whole. */
static size_t write_small_snapshot(void)
{
    static uint8_t image[4096];
    struct rho_settings settings = pipeline.node->settings;
    struct rho_snapshot_part parts[2];
    size_t size;

    for (int i = 0; i < 2; i++) {
        parts[i] = (struct rho_snapshot_part){RHO_SNAPSHOT_SETTINGS, i, &settings, sizeof settings};
    }
    assert_int_equal(rho_snapshot_save(parts, 2, 0, image, sizeof image, &size), RHO_OK);
    write_whole_file("state", image, size);
    return size;
}

/* It is not taken, and is again the file state. */
static void assert_set_aside(const char *what, size_t at)
{
    const enum pipeline_restored restored = restore();

    if (restored != PIPELINE_REFUSED || is_file("state") || !is_file("state.damaged") ||
        count_files() != 1 || !strstr(said, "; set aside as state.damaged; tracks begin anew\n")) {
        fail_msg("%s %zu: restored %d, said: %s", what, at, (int)restored, said);
    }
    assert_int_equal(rename("state.damaged", "state"), 0);
}

static void flip(size_t at, uint8_t bits)
{
    const int file = open("state", O_RDWR);
    uint8_t byte;

    assert_int_equal(pread(file, &byte, 1, (off_t)at), 1);
    byte ^= bits;
    assert_int_equal(pwrite(file, &byte, 1, (off_t)at), 1);
    close(file);
}

static void a_small_snapshot_with_any_bit_changed_is_set_aside(void **state)
{
    size_t size;

    (void)state;
    open_pipeline();
    size = write_small_snapshot();
    assert_int_equal(restore(), PIPELINE_REFUSED);
    assert_string_equal(said,
                        "rhotrack: state: a snapshot with other parameters; tracks begin anew\n");
    for (size_t at = 0; at < size; at++) {
        for (unsigned bit = 0; bit < 8; bit++) {
            flip(at, (uint8_t)(1u << bit));
            assert_set_aside("byte", at);
            flip(at, (uint8_t)(1u << bit));
        }
        flip(at, 255);
        assert_set_aside("byte", at);
        flip(at, 255);
    }
    assert_int_equal(restore(), PIPELINE_REFUSED);
    assert_true(is_file("state"));
    pipeline_free(&pipeline);
    empty_state_folder();
}

static void a_small_snapshot_of_any_other_length_is_set_aside(void **state)
{
    size_t size;

    (void)state;
    open_pipeline();
    size = write_small_snapshot();
    for (size_t more = 1; more <= 64; more++) {
        assert_int_equal(truncate("state", (off_t)(size + more)), 0);
        assert_set_aside("length", size + more);
    }
    for (size_t length = size - 1; length > 0; length--) {
        assert_int_equal(truncate("state", (off_t)length), 0);
        assert_set_aside("length", length);
    }
    assert_int_equal(truncate("state", 0), 0);
    assert_int_equal(restore(), PIPELINE_REFUSED);
    assert_string_equal(said, "rhotrack: state: the snapshot is empty; tracks begin anew\n");
    for (size_t length = 1; length <= size; length++) {
        assert_int_equal(truncate("state", (off_t)length), 0);
        assert_set_aside("zeros of length", length);
    }
    pipeline_free(&pipeline);
    empty_state_folder();
}

static void a_whole_snapshot_that_is_changed_is_set_aside(void **state)
{
    struct stat status;
    size_t size;

    (void)state;
    open_pipeline();
    assert_true(pipeline_save_snapshot(&pipeline, "state"));
    assert_int_equal(count_files(), 1);
    assert_int_equal(stat("state", &status), 0);
    size = (size_t)status.st_size;
    for (size_t i = 0; i < TRIES; i++) {
        const size_t at = i * (size - 1) / (TRIES - 1);

        flip(at, (uint8_t)(1u << i % 8));
        assert_set_aside("byte", at);
        flip(at, (uint8_t)(1u << i % 8));
    }
    assert_int_equal(restore(), PIPELINE_RESTORED);
    for (size_t i = 1; i <= TRIES; i++) {
        const size_t length = size - 1 - (i - 1) * (size - 2) / (TRIES - 1);

        assert_int_equal(truncate("state", (off_t)length), 0);
        assert_set_aside("length", length);
    }
    pipeline_free(&pipeline);
    empty_state_folder();
}

static void say_and_exit(int exit_code, const char *message)
{
    fprintf(stderr, "%s\n", message);
    _exit(exit_code);
}

/* How a node ends, or 0, that finds a text of that many letters in its place. */
static int exit_code_of_text(size_t letters, char last)
{
    char text[256];
    int status;

    memset(text, 'a', sizeof text);
    text[letters - 1] = last;
    write_whole_file("state", text, letters);
    listen_to_stderr();
    if (fork() == 0) {
        fail_handler = say_and_exit;
        (void)pipeline_restore_snapshot(&pipeline, &parameters, "state");
        _exit(0);
    }
    wait(&status);
    end_of_listening();
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static void a_long_text_is_another_file_and_stays(void **state)
{
    (void)state;
    open_pipeline();
    assert_int_equal(exit_code_of_text(64, '\n'), EXIT_USAGE);
    assert_string_equal(said, "state: not a snapshot, and would be overwritten\n");
    assert_true(is_file("state") && count_files() == 1);
    assert_int_equal(exit_code_of_text(63, '\n'), 0);
    assert_true(is_file("state.damaged"));
    assert_int_equal(exit_code_of_text(200, '\0'), 0);
    assert_int_equal(exit_code_of_text(200, '\177'), 0);
    assert_true(is_file("state.damaged.3"));
    pipeline_free(&pipeline);
    empty_state_folder();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_small_snapshot_with_any_bit_changed_is_set_aside),
        cmocka_unit_test(a_small_snapshot_of_any_other_length_is_set_aside),
        cmocka_unit_test(a_whole_snapshot_that_is_changed_is_set_aside),
        cmocka_unit_test(a_long_text_is_another_file_and_stays),
    };

    return cmocka_run_group_tests(tests, enter_state_folder, leave_state_folder);
}
