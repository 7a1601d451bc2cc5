/* SPDX-License-Identifier: MIT */
/*
 * Bearing files to frames: which scans form a frame, which sensors it lacks, several files, rows
 * that are skipped.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/random.h"
#include "io/scans/bearing_reader.h"

#define HEADER "t_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad\n"
#define MAX_FILES 2

/* Files written by the running test and a reader over them. */
struct given {
    struct parameters parameters;
    char paths[MAX_FILES][40];
    int num_paths;
    struct bearing_reader *reader;
};

static void add_file_with(struct given *given, const char *text)
{
    char *path = given->paths[given->num_paths++];
    int file;

    strcpy(path, "/tmp/rhotrack-frames-XXXXXX");
    file = mkstemp(path);
    assert_true(file >= 0);
    assert_int_equal(write(file, text, strlen(text)), (long)strlen(text));
    close(file);
}

static void open_reader(struct given *given, bool keep_going)
{
    char *paths[MAX_FILES];

    for (int i = 0; i < given->num_paths; i++) {
        paths[i] = given->paths[i];
    }
    given->reader = bearing_reader_open(paths, given->num_paths, &given->parameters, keep_going);
}

static struct given given_file_with(const char *text)
{
    struct given given = {.num_paths = 0};

    parameters_set_defaults(&given.parameters);
    add_file_with(&given, text);
    return given;
}

static struct given open_reader_of_text(const char *text)
{
    struct given given = given_file_with(text);

    open_reader(&given, false);
    return given;
}

static void close_and_delete_files(struct given *given)
{
    bearing_reader_close(given->reader);
    for (int i = 0; i < given->num_paths; i++) {
        unlink(given->paths[i]);
    }
}

/*
 * The next frame as text: its time in ms, then sensor and number of bearings of each scan; "end"
 * past the last.
 */
static const char *next_frame_as_text(struct given *given)
{
    static char text[200];
    const struct rho_frame *frame = bearing_reader_next(given->reader);
    int length;

    if (!frame) {
        return "end";
    }
    length = snprintf(text, sizeof text, "%ld:", (long)(frame->time_us / 1000));
    for (uint32_t i = 0; i < frame->num_scans; i++) {
        length += snprintf(text + length, sizeof text - (size_t)length, " %d(%u)",
                           (int)frame->scans[i].sensor_id, (unsigned)frame->scans[i].num_bearings);
    }
    return text;
}

static void assert_frames(struct given *given, const char *const *expected)
{
    for (size_t i = 0; strcmp(expected[i], "end") != 0; i++) {
        assert_string_equal(next_frame_as_text(given), expected[i]);
    }
    assert_string_equal(next_frame_as_text(given), "end");
    assert_string_equal(next_frame_as_text(given), "end");
}

static void scans_of_one_time_form_a_frame_sorted_by_sensor(void **state)
{
    struct given given = open_reader_of_text(HEADER "0,7,0,0,1\n0,7,0,0,1.5\n0,3,90,0,2\n"
                                                    "10,3,90,0,2\n10,7,0,0,\n10,7,0,0,0.5\n");
    (void)state;

    assert_frames(&given, (const char *[]){"0: 3(1) 7(2)", "10000: 3(1) 7(1)", "end"});
    close_and_delete_files(&given);
}

static void a_frame_holds_the_values_of_its_rows(void **state)
{
    struct given given = open_reader_of_text(
        "t_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad,sigma_rad,sector_from_rad,sector_to_rad,"
        "snr_db\n5,1,-10,20,0.25,0.01,-1,2,12\n5,1,-10,20,-3,,-1,2,\n5,2,90,0,1,,,,\n");
    const struct rho_frame *frame = bearing_reader_next(given.reader);
    const struct rho_bearing_scan *scan = &frame->scans[0];
    const struct rho_bearing *bearings = scan->bearings;
    (void)state;

    assert_int_equal(frame->time_us, 5000000);
    assert_int_equal(scan->time_us, 5000000);
    assert_true(scan->x_m == -10.0f && scan->y_m == 20.0f);
    assert_true(scan->sector_from_rad == -1.0f && scan->sector_to_rad == 2.0f);
    assert_int_equal(scan->num_bearings, 2);
    assert_true(bearings[0].bearing_rad == 0.25f && bearings[0].sigma_rad == 0.01f);
    assert_true(bearings[0].snr_db == 12.0f && bearings[0].offset_us == 0);
    assert_true(bearings[1].bearing_rad == -3.0f && bearings[1].snr_db == 0.0f);
    assert_true(frame->scans[1].sector_from_rad == 0.0f && frame->scans[1].sector_to_rad == 0.0f);
    close_and_delete_files(&given);
}

static void sigma_comes_from_row_else_sensor_else_default(void **state)
{
    struct given given =
        given_file_with("t_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad,sigma_rad\n"
                        "0,1,0,0,1,0.01\n0,1,0,0,1,\n0,2,9,0,1,\n");
    const struct rho_frame *frame;
    (void)state;

    parameters_set_assignment(&given.parameters, "sensor.1.sigma_rad=0.02");
    open_reader(&given, false);
    frame = bearing_reader_next(given.reader);
    assert_true(frame->scans[0].bearings[0].sigma_rad == 0.01f);
    assert_true(frame->scans[0].bearings[1].sigma_rad == 0.02f);
    assert_true(frame->scans[1].bearings[0].sigma_rad == 0.00175f);
    close_and_delete_files(&given);
}

static void elevations_and_heights_are_those_of_the_rows(void **state)
{
    struct given given =
        given_file_with("t_s,sensor_id,sensor_x_m,sensor_y_m,sensor_z_m,bearing_rad,elevation_deg,"
                        "sigma_elevation_rad\n5,1,-10,20,7,0.25,90,0.01\n5,1,-10,20,7,0.5,,0.01\n"
                        "5,1,-10,20,7,0.75,-45,\n5,2,90,0,,1,0,\n");
    const struct rho_bearing *bearings;
    const struct rho_frame *frame;
    (void)state;

    given.parameters.value[PARAMETER_SIGMA_ELEVATION_RAD] = 0.25;
    open_reader(&given, false);
    frame = bearing_reader_next(given.reader);
    bearings = frame->scans[0].bearings;
    assert_true(frame->scans[0].z_m == 7.0f && frame->scans[1].z_m == 0.0f);
    assert_float_equal(bearings[0].elevation_rad, 1.5707963, 1e-6);
    assert_true(bearings[0].sigma_elevation_rad == 0.01f);
    assert_true(bearings[1].bearing_rad == 0.5f && bearings[1].sigma_elevation_rad == 0.0f);
    assert_float_equal(bearings[2].elevation_rad, -0.78539816, 1e-6);
    assert_true(bearings[2].sigma_elevation_rad == 0.25f);
    assert_true(frame->scans[1].bearings[0].elevation_rad == 0.0f);
    assert_true(frame->scans[1].bearings[0].sigma_elevation_rad == 0.25f);
    close_and_delete_files(&given);
}

static void azimuth_and_elevation_without_a_range_are_bearings(void **state)
{
    struct given given = given_file_with(
        "t_s,sensor_id,sensor_x_m,sensor_y_m,azimuth_deg,elevation_rad\n5,1,0,0,90,0.5\n"
        "5,2,90,0,0,-0.5\n");
    const struct rho_frame *frame;
    (void)state;

    assert_true(bearing_reader_is_bearings(given.paths[0]));
    open_reader(&given, false);
    frame = bearing_reader_next(given.reader);
    assert_float_equal(frame->scans[0].bearings[0].bearing_rad, 0.0, 1e-6);
    assert_float_equal(frame->scans[1].bearings[0].bearing_rad, 1.5707963, 1e-6);
    assert_true(frame->scans[0].bearings[0].elevation_rad == 0.5f);
    close_and_delete_files(&given);
    given = given_file_with("t_s,range_m,azimuth_deg,elevation_rad\n5,100,90,0.5\n");
    assert_false(bearing_reader_is_bearings(given.paths[0]));
    unlink(given.paths[0]);
}

static void rows_within_scan_interval_form_one_scan(void **state)
{
    struct given given =
        given_file_with(HEADER "0,1,0,0,1\n0,2,9,0,1\n0.9,1,0,0,1\n1.0,1,0,0,1\n1.0,2,9,0,1\n");
    const struct rho_frame *frame;
    (void)state;

    parameters_set_assignment(&given.parameters, "scan_interval_s=1");
    open_reader(&given, false);
    frame = bearing_reader_next(given.reader);
    assert_int_equal(frame->scans[0].num_bearings, 2);
    assert_int_equal(frame->scans[0].bearings[1].offset_us, 900000);
    assert_frames(&given, (const char *[]){"1000: 1(1) 2(1)", "end"});
    close_and_delete_files(&given);
}

static const char late_text[] = HEADER "0,1,0,0,1\n0.05,2,9,0,1\n1,1,0,0,1\n1.050001,2,9,0,1\n";

/*
 * Rows of one scan number are one scan, whatever rows come between; its time is that of the row
 * without a bearing.
 */
static void rows_of_numbered_scans_may_be_interleaved(void **state)
{
    struct given given =
        open_reader_of_text("t_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad,scan\n"
                            "1,1,0,0,1,7\n1,2,90,0,2,7\n1.3,1,0,0,1,8\n1.5,1,0,0,1.25,7\n"
                            "1.5,2,90,0,2,8\n1.75,1,0,0,,8\n");
    const struct rho_frame *frame = bearing_reader_next(given.reader);
    (void)state;

    assert_int_equal(bearing_reader_counts(given.reader).scans, 4);
    assert_int_equal(frame->scans[0].num_bearings, 2);
    assert_int_equal(frame->scans[0].bearings[1].offset_us, 500000);
    assert_string_equal(next_frame_as_text(&given), "1500: 2(1)");
    frame = bearing_reader_next(given.reader);
    assert_int_equal(frame->time_us, 1750000);
    assert_int_equal(frame->scans[0].bearings[0].offset_us, -450000);
    close_and_delete_files(&given);
}

static void scans_within_the_tolerance_form_one_frame(void **state)
{
    struct given given = open_reader_of_text(late_text);
    (void)state;

    assert_frames(&given, (const char *[]){"0: 1(1) 2(1)", "1000: 1(1)", "1050: 2(1)", "end"});
    assert_int_equal(bearing_reader_counts(given.reader).frames_incomplete, 2);
    close_and_delete_files(&given);
}

static void the_frame_tolerance_is_configurable(void **state)
{
    struct given wide = given_file_with(late_text), none = given_file_with(late_text);
    (void)state;

    parameters_set_assignment(&wide.parameters, "frame_tolerance_s=0.1");
    open_reader(&wide, false);
    assert_frames(&wide, (const char *[]){"0: 1(1) 2(1)", "1000: 1(1) 2(1)", "end"});
    parameters_set_assignment(&none.parameters, "frame_tolerance_s=0");
    open_reader(&none, false);
    assert_frames(&none,
                  (const char *[]){"0: 1(1)", "50: 2(1)", "1000: 1(1)", "1050: 2(1)", "end"});
    close_and_delete_files(&wide);
    close_and_delete_files(&none);
}

/* The tolerance counts from the frame's first scan: a chain of scans does not prolong the frame. */
static void a_frame_lasts_no_longer_than_the_tolerance(void **state)
{
    struct given given = open_reader_of_text(HEADER "0,1,0,0,1\n0.04,2,9,0,1\n0.08,3,20,0,1\n");
    (void)state;

    assert_frames(&given, (const char *[]){"0: 1(1) 2(1)", "80: 3(1)", "end"});
    close_and_delete_files(&given);
}

static void a_sensor_that_reports_again_opens_a_frame(void **state)
{
    struct given given = open_reader_of_text(HEADER "0,1,0,0,1\n0.02,1,0,0,1\n0.03,2,9,0,1\n");
    (void)state;

    assert_frames(&given, (const char *[]){"0: 1(1)", "20: 1(1) 2(1)", "end"});
    close_and_delete_files(&given);
}

static void frames_that_lack_sensors_are_counted(void **state)
{
    struct given given = open_reader_of_text(HEADER "0,1,0,0,1\n0,2,9,0,\n0,3,20,0,1\n"
                                                    "10,1,0,0,1\n10,3,20,0,1\n20,2,9,0,1\n");
    struct bearing_reader_counts counts = bearing_reader_counts(given.reader);
    (void)state;

    assert_int_equal(counts.frames, 3);
    assert_int_equal(counts.scans, 6);
    assert_int_equal(counts.bearings, 5);
    assert_int_equal(counts.frames_incomplete, 2);
    assert_int_equal(counts.rows_skipped, 0);
    assert_frames(&given,
                  (const char *[]){"0: 1(1) 2(0) 3(1)", "10000: 1(1) 3(1)", "20000: 2(1)", "end"});
    close_and_delete_files(&given);
}

static void several_files_are_merged_by_time(void **state)
{
    struct given given = given_file_with(HEADER "0,1,0,0,1\n10,1,0,0,1\n20,1,0,0,1\n");
    (void)state;

    add_file_with(&given, HEADER "0.01,2,9,0,1\n9.99,2,9,0,1\n9.99,2,9,0,2\n");
    open_reader(&given, false);
    assert_frames(&given,
                  (const char *[]){"0: 1(1) 2(1)", "9990: 1(1) 2(2)", "20000: 1(1)", "end"});
    close_and_delete_files(&given);
}

static void sensors_are_listed_by_ascending_id(void **state)
{
    struct given given = given_file_with(HEADER "0,5,-7,8,1\n");
    const struct frame_sensor *sensors;
    size_t count;
    (void)state;

    add_file_with(&given, HEADER "0,-2,9,0,1\n");
    open_reader(&given, false);
    sensors = bearing_reader_sensors(given.reader, &count);
    assert_int_equal(count, 2);
    assert_int_equal(sensors[0].sensor_id, -2);
    assert_int_equal(sensors[1].sensor_id, 5);
    assert_true(sensors[1].x_m == -7.0f && sensors[1].y_m == 8.0f);
    close_and_delete_files(&given);
}

static void keep_last_skips_all_but_the_last_frames(void **state)
{
    struct given given =
        open_reader_of_text(HEADER "0,1,0,0,1\n0,2,9,0,1\n10,1,0,0,1\n20,1,0,0,1\n30,2,9,0,1\n");
    (void)state;

    bearing_reader_keep_last(given.reader, 4);
    assert_int_equal(bearing_reader_num_frames(given.reader), 4);
    bearing_reader_keep_last(given.reader, 2);
    assert_frames(&given, (const char *[]){"20000: 1(1)", "30000: 2(1)", "end"});
    close_and_delete_files(&given);
}

/* Where each frame has one sensor's scan, as many frames of each sensor are kept. */
static void keep_last_counts_looks_of_each_sensor_where_they_take_turns(void **state)
{
    struct given given = open_reader_of_text(HEADER "0,1,0,0,1\n5,2,9,0,1\n10,1,0,0,1\n15,2,9,0,1\n"
                                                    "20,1,0,0,1\n25,2,9,0,1\n");
    (void)state;

    bearing_reader_keep_last(given.reader, 2);
    assert_frames(&given, (const char *[]){"10000: 1(1)", "15000: 2(1)", "20000: 1(1)",
                                           "25000: 2(1)", "end"});
    close_and_delete_files(&given);
}

/* Each scan has the place of its rows; of a sensor its first place and farthest way are told. */
static void sensors_may_move_and_stand_together(void **state)
{
    struct given given =
        open_reader_of_text(HEADER "0,1,0,0,1\n0,2,0,0,1\n10,1,30,40,1\n10,2,0,0,1\n"
                                   "20,1,3,4,1\n20,2,0,0,\n");
    const struct frame_sensor *sensors;
    const struct rho_frame *frame;
    size_t count;
    (void)state;

    sensors = bearing_reader_sensors(given.reader, &count);
    assert_int_equal(count, 2);
    assert_true(sensors[0].x_m == 0.0f && sensors[0].y_m == 0.0f);
    assert_float_equal(sensors[0].moves_m, 50.0, 1e-9);
    assert_float_equal(sensors[1].moves_m, 0.0, 0.0);
    frame = bearing_reader_next(given.reader);
    assert_int_equal(frame->num_scans, 2);
    assert_true(frame->scans[0].x_m == 0.0f && frame->scans[0].y_m == 0.0f);
    frame = bearing_reader_next(given.reader);
    assert_true(frame->scans[0].x_m == 30.0f && frame->scans[0].y_m == 40.0f);
    assert_true(frame->scans[1].x_m == 0.0f && frame->scans[1].y_m == 0.0f);
    frame = bearing_reader_next(given.reader);
    assert_true(frame->scans[0].x_m == 3.0f && frame->scans[0].y_m == 4.0f);
    close_and_delete_files(&given);
}

static void bad_rows_are_skipped_and_counted(void **state)
{
    struct given given =
        given_file_with(HEADER "0,1,0,0,1\n0,1,0,0,4e6\n" /* row without an angle */
                               "0,2,9,0,1\n"
                               "0,2,10,0,1\n" /* another place in the same scan */
                               "-1,2,9,0,1\n" /* the time goes back */
                               "10,2\n"       /* too few cells */
                               "10,1,0,0,1\n");
    (void)state;

    open_reader(&given, true);
    assert_int_equal(bearing_reader_counts(given.reader).rows_skipped, 4);
    assert_frames(&given, (const char *[]){"0: 1(1) 2(1)", "10000: 1(1)", "end"});
    close_and_delete_files(&given);
}

static void files_of_bearings_are_recognised_by_their_header(void **state)
{
    struct given bearings = given_file_with(HEADER),
                 empty = given_file_with("t_s,sensor_id,x_m,y_m\n"),
                 both = given_file_with("t_s,sensor_id,x_m,y_m,bearing_rad\n0,1,2,3,1\n");
    (void)state;

    assert_true(bearing_reader_is_bearings(bearings.paths[0]));
    assert_false(bearing_reader_is_bearings(empty.paths[0]));
    assert_false(bearing_reader_is_bearings(both.paths[0]));
    assert_false(bearing_reader_is_bearings("/tmp"));
    assert_false(bearing_reader_is_bearings("/tmp/there/is/no/such/file"));
    close_and_delete_files(&bearings);
    close_and_delete_files(&empty);
    close_and_delete_files(&both);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scans_of_one_time_form_a_frame_sorted_by_sensor),
        cmocka_unit_test(a_frame_holds_the_values_of_its_rows),
        cmocka_unit_test(sigma_comes_from_row_else_sensor_else_default),
        cmocka_unit_test(elevations_and_heights_are_those_of_the_rows),
        cmocka_unit_test(azimuth_and_elevation_without_a_range_are_bearings),
        cmocka_unit_test(rows_within_scan_interval_form_one_scan),
        cmocka_unit_test(rows_of_numbered_scans_may_be_interleaved),
        cmocka_unit_test(scans_within_the_tolerance_form_one_frame),
        cmocka_unit_test(the_frame_tolerance_is_configurable),
        cmocka_unit_test(a_frame_lasts_no_longer_than_the_tolerance),
        cmocka_unit_test(a_sensor_that_reports_again_opens_a_frame),
        cmocka_unit_test(frames_that_lack_sensors_are_counted),
        cmocka_unit_test(several_files_are_merged_by_time),
        cmocka_unit_test(sensors_are_listed_by_ascending_id),
        cmocka_unit_test(keep_last_skips_all_but_the_last_frames),
        cmocka_unit_test(keep_last_counts_looks_of_each_sensor_where_they_take_turns),
        cmocka_unit_test(sensors_may_move_and_stand_together),
        cmocka_unit_test(bad_rows_are_skipped_and_counted),
        cmocka_unit_test(files_of_bearings_are_recognised_by_their_header),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
