/* SPDX-License-Identifier: MIT */
/*
 * Files of plots and of bearings, merged by time: the order of scans and frames, equal times,
 * counts, files of one kind alone.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/scans/bearing_reader.h"
#include "io/scans/merged_inputs.h"

#define PLOTS "t_s,sensor_id,x_m,y_m\n"
#define BEARINGS "t_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad\n"
#define MAX_FILES 4

/* Files written by the running test and the inputs over them. */
struct given {
    struct parameters parameters;
    char paths[MAX_FILES][40];
    int num_paths;
    struct merged_inputs *inputs;
};

static struct given given_no_files(void)
{
    struct given given = {.num_paths = 0};

    parameters_set_defaults(&given.parameters);
    return given;
}

static void add_file_with(struct given *given, const char *text)
{
    char *path = given->paths[given->num_paths++];
    int file;

    strcpy(path, "/tmp/rhotrack-inputs-XXXXXX");
    file = mkstemp(path);
    assert_true(file >= 0);
    assert_int_equal(write(file, text, strlen(text)), (long)strlen(text));
    close(file);
}

static void open_inputs(struct given *given, bool keep_going)
{
    char *paths[MAX_FILES];

    for (int i = 0; i < given->num_paths; i++) {
        paths[i] = given->paths[i];
    }
    given->inputs = merged_inputs_open(paths, given->num_paths, &given->parameters, keep_going);
}

static struct given open_inputs_of_texts(const char *first, const char *second)
{
    struct given given = given_no_files();

    add_file_with(&given, first);
    if (second) {
        add_file_with(&given, second);
    }
    open_inputs(&given, false);
    return given;
}

static void close_and_delete_files(struct given *given)
{
    merged_inputs_close(given->inputs);
    for (int i = 0; i < given->num_paths; i++) {
        unlink(given->paths[i]);
    }
}

/*
 * The next input as text: its time in ms; `s` and sensor, or `f` and sensors, each with its number
 * of plots or bearings. "end" past the last.
 */
static const char *next_input_as_text(struct given *given)
{
    static char text[200];
    const struct input input = merged_inputs_next(given->inputs);
    int length;

    assert_true(!input.scan || !input.frame);
    assert_true(input.scan || !input.sensor);
    if (input.scan) {
        snprintf(text, sizeof text, "%ld: s%d(%u)%s", (long)(input.scan->time_us / 1000),
                 (int)input.scan->sensor_id, (unsigned)input.scan->num_plots,
                 input.sensor ? " known" : "");
        return text;
    }
    if (!input.frame) {
        return "end";
    }
    length = snprintf(text, sizeof text, "%ld: f", (long)(input.frame->time_us / 1000));
    for (uint32_t i = 0; i < input.frame->num_scans; i++) {
        length += snprintf(text + length, sizeof text - (size_t)length, " %d(%u)",
                           (int)input.frame->scans[i].sensor_id,
                           (unsigned)input.frame->scans[i].num_bearings);
    }
    return text;
}

static void assert_inputs(struct given *given, const char *const *expected)
{
    for (size_t i = 0; strcmp(expected[i], "end") != 0; i++) {
        assert_string_equal(next_input_as_text(given), expected[i]);
    }
    assert_string_equal(next_input_as_text(given), "end");
    assert_string_equal(next_input_as_text(given), "end");
}

static const char *const plots_text = PLOTS "0,1,5,5\n0,1,6,6\n4,1,5,5\n8,1,5,5\n20,1,5,5\n";
static const char *const bearings_text = BEARINGS "-1,8,0,0,1\n-1,9,9,0,1\n4,8,0,0,1\n4,9,9,0,1\n"
                                                  "4,9,9,0,2\n12,9,9,0,1\n";
static const char *const merged[] = {
    /* at equal times scans of plots come first */
    "-1000: f 8(1) 9(1)", "0: s1(2)",      "4000: s1(1)",  "4000: f 8(1) 9(2)",
    "8000: s1(1)",        "12000: f 9(1)", "20000: s1(1)", "end"};

static void scans_and_frames_are_merged_by_time(void **state)
{
    struct given given = open_inputs_of_texts(plots_text, bearings_text);
    (void)state;

    assert_true(merged_inputs_have_plots(given.inputs));
    assert_true(merged_inputs_have_bearings(given.inputs));
    assert_inputs(&given, merged);
    close_and_delete_files(&given);
}

static void the_order_of_the_files_does_not_matter(void **state)
{
    struct given given = open_inputs_of_texts(bearings_text, plots_text);
    (void)state;

    assert_inputs(&given, merged);
    close_and_delete_files(&given);
}

/* Two files of each kind, given alternately. */
static void two_files_of_each_kind_are_merged(void **state)
{
    struct given given = given_no_files();
    (void)state;

    add_file_with(&given, BEARINGS "0,8,0,0,1\n10,8,0,0,1\n");
    add_file_with(&given, PLOTS "5,1,5,5\n10,1,5,5\n");
    add_file_with(&given, BEARINGS "0.01,9,9,0,1\n20,9,9,0,1\n");
    add_file_with(&given, PLOTS "3,2,5,5\n10,2,5,5\n");
    open_inputs(&given, false);
    assert_inputs(&given, (const char *[]){"0: f 8(1)", "10: f 9(1)", "3000: s2(1)", "5000: s1(1)",
                                           "10000: s1(1)", "10000: s2(1)", "10000: f 8(1)",
                                           "20000: f 9(1)", "end"});
    close_and_delete_files(&given);
}

/*
 * A given scan stays valid until the caller asks again, though the next one was read ahead to
 * compare times.
 */
static void a_scan_stays_valid_until_the_next_call(void **state)
{
    struct given given = open_inputs_of_texts(PLOTS "0,1,5,6\n1,1,7,8\n",
                                              BEARINGS "0,8,0,0,1\n0,9,9,0,2\n2,8,0,0,3\n");
    struct input scan, frame;
    (void)state;

    scan = merged_inputs_next(given.inputs);
    assert_true(scan.scan->plots[0].x_m == 5.0f && scan.scan->plots[0].y_m == 6.0f);
    frame = merged_inputs_next(given.inputs);
    assert_true(frame.frame->scans[1].bearings[0].bearing_rad == 2.0f);
    scan = merged_inputs_next(given.inputs);
    assert_true(scan.scan->plots[0].x_m == 7.0f && scan.scan->plots[0].y_m == 8.0f);
    frame = merged_inputs_next(given.inputs);
    assert_true(frame.frame->scans[0].bearings[0].bearing_rad == 3.0f);
    close_and_delete_files(&given);
}

static void scans_of_configured_sensors_come_with_their_description(void **state)
{
    struct given given = given_no_files();
    (void)state;

    add_file_with(&given, "t_s,sensor_id,range_m,azimuth_rad\n0,3,5000,1\n2,4,5000,1\n");
    add_file_with(&given, BEARINGS "1,8,0,0,1\n");
    parameters_set_assignment(&given.parameters, "sensor.3.x_m=700");
    parameters_set_assignment(&given.parameters, "sensor.3.y_m=0");
    open_inputs(&given, false);
    assert_inputs(&given, (const char *[]){"0: s3(1) known", "1000: f 8(1)", "2000: s4(1)", "end"});
    close_and_delete_files(&given);
}

static void files_of_plots_alone_give_no_passive_sensors(void **state)
{
    struct given given = open_inputs_of_texts(PLOTS "0,1,5,5\n", PLOTS "0,2,5,5\n");
    size_t count = 7;
    (void)state;

    assert_true(merged_inputs_have_plots(given.inputs));
    assert_false(merged_inputs_have_bearings(given.inputs));
    merged_inputs_passive_sensors(given.inputs, &count);
    assert_int_equal(count, 0);
    assert_inputs(&given, (const char *[]){"0: s1(1)", "0: s2(1)", "end"});
    close_and_delete_files(&given);
}

static void files_of_bearings_alone_give_frames(void **state)
{
    struct given given = open_inputs_of_texts(bearings_text, NULL);
    const struct frame_sensor *sensors;
    size_t count;
    (void)state;

    assert_false(merged_inputs_have_plots(given.inputs));
    sensors = merged_inputs_passive_sensors(given.inputs, &count);
    assert_int_equal(count, 2);
    assert_int_equal(sensors[0].sensor_id, 8);
    assert_true(sensors[1].x_m == 9.0f);
    assert_inputs(&given, (const char *[]){"-1000: f 8(1) 9(1)", "4000: f 8(1) 9(2)",
                                           "12000: f 9(1)", "end"});
    close_and_delete_files(&given);
}

/* The exit code of a child process that opens the files. */
static int exit_code_of_opening(struct given *given)
{
    int status;
    pid_t child = fork();

    assert_true(child >= 0);
    if (child == 0) {
        (void)!freopen("/dev/null", "w", stderr);
        open_inputs(given, false);
        _exit(0);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static void a_single_passive_sensor_needs_a_radar_beside_it(void **state)
{
    struct given given = given_no_files();
    (void)state;

    add_file_with(&given, BEARINGS "0,8,0,0,1\n10,8,0,0,1\n");
    assert_int_equal(exit_code_of_opening(&given), 2);
    add_file_with(&given, PLOTS "5,1,5,5\n");
    assert_int_equal(exit_code_of_opening(&given), 0);
    open_inputs(&given, false);
    assert_inputs(&given, (const char *[]){"0: f 8(1)", "5000: s1(1)", "10000: f 8(1)", "end"});
    close_and_delete_files(&given);
}

static void counts_cover_scans_and_frames(void **state)
{
    struct given given = open_inputs_of_texts(plots_text, bearings_text);
    struct merged_inputs_counts counts;
    (void)state;

    assert_inputs(&given, merged);
    counts = merged_inputs_counts(given.inputs);
    assert_int_equal(counts.scans, 4);
    assert_int_equal(counts.frames, 3);
    assert_int_equal(counts.steps, 7);
    assert_int_equal(counts.plots, 5 + 6);
    assert_int_equal(counts.frames_incomplete, 1);
    assert_int_equal(counts.rows_skipped, 0);
    close_and_delete_files(&given);
}

static void bad_rows_of_both_kinds_are_skipped_and_counted(void **state)
{
    struct given given = given_no_files();
    struct merged_inputs_counts counts;
    (void)state;

    add_file_with(&given, PLOTS "0,1,5,5\n0,1,nan,5\n1,1,5,5\n");
    add_file_with(&given, BEARINGS "0,8,0,0,4e6\n0,8,0,0,1\n0,9,9,0,1\n0,9,8,0,1\n");
    open_inputs(&given, true);
    assert_inputs(&given, (const char *[]){"0: s1(1)", "0: f 8(1) 9(1)", "1000: s1(1)", "end"});
    counts = merged_inputs_counts(given.inputs);
    assert_int_equal(counts.rows_skipped, 3);
    close_and_delete_files(&given);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scans_and_frames_are_merged_by_time),
        cmocka_unit_test(the_order_of_the_files_does_not_matter),
        cmocka_unit_test(two_files_of_each_kind_are_merged),
        cmocka_unit_test(a_scan_stays_valid_until_the_next_call),
        cmocka_unit_test(scans_of_configured_sensors_come_with_their_description),
        cmocka_unit_test(files_of_plots_alone_give_no_passive_sensors),
        cmocka_unit_test(files_of_bearings_alone_give_frames),
        cmocka_unit_test(a_single_passive_sensor_needs_a_radar_beside_it),
        cmocka_unit_test(counts_cover_scans_and_frames),
        cmocka_unit_test(bad_rows_of_both_kinds_are_skipped_and_counted),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
