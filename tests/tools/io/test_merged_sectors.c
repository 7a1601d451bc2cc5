/* SPDX-License-Identifier: MIT */
/*
 * The last turns of a file: sectors joined to turns, of one radar and of two interleaved; scans of
 * whole circles; late scans.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io/scans/plot_reader.h"
#include "io/turns/merged_sectors.h"

#define HEADER                                                                                     \
    "t_s,sensor_id,range_m,azimuth_rad,sensor_x_m,sensor_y_m,sector_from_rad,sector_to_rad,scan\n"
#define PI 3.14159265358979323846
#define SECTORS 4

/*
 * Prints rows of a radar's sector n, counter-clockwise from 0: its opening, and a plot in its
 * middle 0.5 s earlier.
 */
static size_t print_sector_rows(char *text, int sensor, double x_m, int sector_index, double t_s)
{
    double from = 2 * PI * (sector_index % SECTORS) / SECTORS, to = from + 2 * PI / SECTORS;
    double middle = from + PI / SECTORS;

    return (size_t)sprintf(
        text, "%.6f,%d,,,%.1f,0,%.7f,%.7f,%d\n%.6f,%d,10000,%.7f,%.1f,0,%.7f,%.7f,%d\n", t_s,
        sensor, x_m, from, to, sector_index + 1, t_s - 0.5, sensor,
        middle > PI ? middle - 2 * PI : middle, x_m, from, to, sector_index + 1);
}

static struct revolutions read_newest_turns_of_all_radars(const char *text, size_t max)
{
    char path[] = "/tmp/rhotrack-turns-XXXXXX", *paths[] = {path};
    struct parameters parameters;
    struct plot_reader *reader;
    struct revolutions revolutions;
    int file = mkstemp(path);

    assert_true(file >= 0);
    assert_int_equal(write(file, text, strlen(text)), (long)strlen(text));
    close(file);
    parameters_set_defaults(&parameters);
    reader = plot_reader_open(paths, 1, &parameters, false);
    revolutions = revolutions_read_last(reader, max);
    plot_reader_close(reader);
    unlink(path);
    return revolutions;
}

static void assert_turn_has(const struct revolution *turn, int sensor, double t_s,
                            unsigned num_plots)
{
    assert_int_equal(turn->scan.sensor_id, sensor);
    assert_int_equal(turn->scan.time_us, (int64_t)(t_s * 1e6 + 0.5));
    assert_int_equal(turn->scan.num_plots, num_plots);
    assert_true(turn->has_sensor);
}

static void test_sectors_of_one_radar_form_turns(void **state)
{
    char text[8192] = HEADER;
    size_t length = strlen(text);
    struct revolutions revolutions;

    (void)state;
    for (int n = 0; n < 3 * SECTORS + 2; n++) { /* + 2: the last turn has only begun */
        length += print_sector_rows(text + length, 1, 500, n, n + 1);
    }
    revolutions = read_newest_turns_of_all_radars(text, 3);
    assert_int_equal(revolutions.total, 4);
    assert_int_equal(revolutions.count, 3);
    assert_int_equal(revolutions.late, 0);
    assert_turn_has(&revolutions.list[0], 1, 5, 4);
    assert_turn_has(&revolutions.list[1], 1, 9, 4);
    assert_turn_has(&revolutions.list[2], 1, 13, 2);
    for (int i = 0; i < 4;
         i++) { /* plots keep their own times, half a second before their sector's */
        assert_int_equal(revolutions.list[0].scan.plots[i].offset_us, i * 1000000 - 500000);
    }
    assert_float_equal(revolutions.list[0].scan.plots[0].x_m, 500 + 10000 * 0.70710678, 0.1);
    assert_true(revolutions.list[0].scan.sector_from_rad >=
                revolutions.list[0].scan.sector_to_rad); /* the turn covers the whole circle */
    assert_float_equal(revolutions.list[2].scan.sector_from_rad, 0, 1e-6);
    assert_float_equal(revolutions.list[2].scan.sector_to_rad, PI, 1e-6);
    revolutions_free(&revolutions);
}

static void test_interleaved_radars_form_turns_of_their_own(void **state)
{
    char text[16384] = HEADER;
    size_t length = strlen(text);
    struct revolutions revolutions;

    (void)state;
    for (int n = 0; n < 3 * SECTORS; n++) { /* the second radar's turns begin half a turn later */
        length += print_sector_rows(text + length, 1, 0, n, n + 1);
        length += print_sector_rows(text + length, 2, 800, n + SECTORS / 2, n + 1.2);
    }
    revolutions = read_newest_turns_of_all_radars(text, 5);
    assert_int_equal(revolutions.total, 6);
    assert_int_equal(revolutions.count, 5);
    assert_turn_has(&revolutions.list[0], 2, 1.2, 4);
    assert_turn_has(&revolutions.list[1], 1, 5, 4);
    assert_turn_has(&revolutions.list[2], 2, 5.2, 4);
    assert_turn_has(&revolutions.list[3], 1, 9, 4);
    assert_turn_has(&revolutions.list[4], 2, 9.2, 4);
    assert_float_equal(revolutions.list[4].sensor.x_m, 800, 1e-3);
    revolutions_free(&revolutions);
    revolutions =
        /* with room for one turn, a dropped turn that still goes on does not come back */
        read_newest_turns_of_all_radars(text, 1);
    assert_int_equal(revolutions.total, 6);
    assert_int_equal(revolutions.count, 1);
    assert_turn_has(&revolutions.list[0], 2, 9.2, 4);
    revolutions_free(&revolutions);
}

static void test_scans_of_a_whole_circle_are_turns(void **state)
{
    struct revolutions revolutions = read_newest_turns_of_all_radars(
        "t_s,sensor_id,x_m,y_m\n0,1,5,5\n0,1,6,5\n0.5,2,1,1\n2,1,7,5\n"
        "2,2,,\n4,1,8,5\n",
        4);

    (void)state;
    assert_int_equal(revolutions.total, 5);
    assert_int_equal(revolutions.count, 4);
    assert_int_equal(revolutions.list[0].scan.sensor_id, 2);
    assert_int_equal(revolutions.list[1].scan.num_plots, 1);
    assert_int_equal(revolutions.list[2].scan.num_plots, 0);
    assert_int_equal(revolutions.list[3].scan.time_us, 4000000);
    assert_float_equal(revolutions.list[3].scan.plots[0].x_m, 8, 0);
    assert_false(revolutions.list[3].has_sensor);
    revolutions_free(&revolutions);
}

/*
 * Scans in order of reception: a late scan of another sensor is kept in its place, one of the same
 * sensor is left out.
 */
static void test_late_scans_of_the_same_sensor_are_left_out(void **state)
{
    struct revolutions revolutions =
        read_newest_turns_of_all_radars("t_s,sensor_id,x_m,y_m,received_s\n0,1,1,1,0\n4,1,2,1,4\n"
                                        "8,1,3,1,8\n5,2,9,9,8.5\n6,1,4,1,9\n12,1,5,1,12\n",
                                        4);

    (void)state;
    assert_int_equal(revolutions.late, 1);
    assert_int_equal(revolutions.total, 5);
    assert_int_equal(revolutions.count, 4);
    assert_int_equal(revolutions.list[0].scan.time_us, 4000000);
    assert_int_equal(revolutions.list[1].scan.sensor_id, 2);
    assert_int_equal(revolutions.list[2].scan.time_us, 8000000);
    assert_int_equal(revolutions.list[3].scan.time_us, 12000000);
    revolutions_free(&revolutions);
}

static void test_a_scan_without_plots_is_a_turn(void **state)
{
    struct revolutions revolutions =
        read_newest_turns_of_all_radars("t_s,sensor_id,x_m,y_m\n0,1,,\n", 7);

    (void)state;
    assert_int_equal(revolutions.count, 1);
    assert_int_equal(revolutions.list[0].scan.num_plots, 0);
    revolutions_free(&revolutions);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sectors_of_one_radar_form_turns),
        cmocka_unit_test(test_interleaved_radars_form_turns_of_their_own),
        cmocka_unit_test(test_scans_of_a_whole_circle_are_turns),
        cmocka_unit_test(test_late_scans_of_the_same_sensor_are_left_out),
        cmocka_unit_test(test_a_scan_without_plots_is_a_turn),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
