/* SPDX-License-Identifier: MIT */
/*
 * The last turns of a file: sectors that are one, of one radar and of two at a time; whole circles;
 * what comes late.
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

#include "io/scans/plot_scan_reader.h"
#include "io/turns/revolutions.h"

#define HEADER                                                                                     \
    "t_s,sensor_id,range_m,azimuth_rad,sensor_x_m,sensor_y_m,sector_from_rad,sector_to_rad,scan\n"
#define PI 3.14159265358979323846
#define SECTORS 4

/*
 * Rows of a radar's sector number n, counter-clockwise from 0 on: its opening, and a plot in its
 * middle 0.5 s before.
 */
static size_t put_sector(char *text, int sensor, double x_m, int n, double t_s)
{
    double from = 2 * PI * (n % SECTORS) / SECTORS, to = from + 2 * PI / SECTORS;
    double middle = from + PI / SECTORS;

    return (size_t)sprintf(
        text, "%.6f,%d,,,%.1f,0,%.7f,%.7f,%d\n%.6f,%d,10000,%.7f,%.1f,0,%.7f,%.7f,%d\n", t_s,
        sensor, x_m, from, to, n + 1, t_s - 0.5, sensor, middle > PI ? middle - 2 * PI : middle,
        x_m, from, to, n + 1);
}

static struct revolutions read_text(const char *text, size_t max)
{
    char path[] = "/tmp/rhotrack-turns-XXXXXX", *paths[] = {path};
    struct parameters parameters;
    struct scan_reader *reader;
    struct revolutions revolutions;
    int file = mkstemp(path);

    assert_true(file >= 0);
    assert_int_equal(write(file, text, strlen(text)), (long)strlen(text));
    close(file);
    parameters_set_defaults(&parameters);
    reader = plot_scan_reader_open(paths, 1, &parameters, false);
    revolutions = revolutions_read_last(reader, max);
    plot_scan_reader_close(reader);
    unlink(path);
    return revolutions;
}

static void assert_turn(const struct revolution *turn, int sensor, double t_s, unsigned num_plots)
{
    assert_int_equal(turn->scan.sensor_id, sensor);
    assert_int_equal(turn->scan.time_us, (int64_t)(t_s * 1e6 + 0.5));
    assert_int_equal(turn->scan.num_plots, num_plots);
    assert_true(turn->has_sensor);
}

static void test_sectors_of_one_radar(void **state)
{
    char text[8192] = HEADER;
    size_t length = strlen(text);
    struct revolutions revolutions;

    (void)state;
    for (int n = 0; n < 3 * SECTORS + 2; n++) { /* the last turn is only begun */
        length += put_sector(text + length, 1, 500, n, n + 1);
    }
    revolutions = read_text(text, 3);
    assert_int_equal(revolutions.total, 4);
    assert_int_equal(revolutions.count, 3);
    assert_int_equal(revolutions.late, 0);
    assert_turn(&revolutions.list[0], 1, 5, 4);
    assert_turn(&revolutions.list[1], 1, 9, 4);
    assert_turn(&revolutions.list[2], 1, 13, 2);
    for (int i = 0; i < 4;
         i++) { /* plots keep their own times: half a second before each sector's */
        assert_int_equal(revolutions.list[0].scan.plots[i].offset_us, i * 1000000 - 500000);
    }
    assert_float_equal(revolutions.list[0].scan.plots[0].x_m, 500 + 10000 * 0.70710678, 0.1);
    assert_true(revolutions.list[0].scan.sector_from_rad >=
                revolutions.list[0].scan.sector_to_rad); /* whole */
    assert_float_equal(revolutions.list[2].scan.sector_from_rad, 0, 1e-6);
    assert_float_equal(revolutions.list[2].scan.sector_to_rad, PI, 1e-6);
    revolutions_free(&revolutions);
}

static void test_radars_between_one_another(void **state)
{
    char text[16384] = HEADER;
    size_t length = strlen(text);
    struct revolutions revolutions;

    (void)state;
    for (int n = 0; n < 3 * SECTORS; n++) { /* the second one's turns begin half a turn later */
        length += put_sector(text + length, 1, 0, n, n + 1);
        length += put_sector(text + length, 2, 800, n + SECTORS / 2, n + 1.2);
    }
    revolutions = read_text(text, 5);
    assert_int_equal(revolutions.total, 6);
    assert_int_equal(revolutions.count, 5);
    assert_turn(&revolutions.list[0], 2, 1.2, 4);
    assert_turn(&revolutions.list[1], 1, 5, 4);
    assert_turn(&revolutions.list[2], 2, 5.2, 4);
    assert_turn(&revolutions.list[3], 1, 9, 4);
    assert_turn(&revolutions.list[4], 2, 9.2, 4);
    assert_float_equal(revolutions.list[4].sensor.x_m, 800, 1e-3);
    revolutions_free(&revolutions);
    revolutions =
        read_text(text, 1); /* a turn that is dropped while it goes on does not come back */
    assert_int_equal(revolutions.total, 6);
    assert_int_equal(revolutions.count, 1);
    assert_turn(&revolutions.list[0], 2, 9.2, 4);
    revolutions_free(&revolutions);
}

static void test_whole_circles(void **state)
{
    struct revolutions revolutions =
        read_text("t_s,sensor_id,x_m,y_m\n0,1,5,5\n0,1,6,5\n0.5,2,1,1\n2,1,7,5\n"
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

/* In the order of reception: of another sensor in its place, of the same one left out. */
static void test_late_scans(void **state)
{
    struct revolutions revolutions =
        read_text("t_s,sensor_id,x_m,y_m,received_s\n0,1,1,1,0\n4,1,2,1,4\n"
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

static void test_scan_that_saw_nothing(void **state)
{
    struct revolutions revolutions = read_text("t_s,sensor_id,x_m,y_m\n0,1,,\n", 7);

    (void)state;
    assert_int_equal(revolutions.count, 1);
    assert_int_equal(revolutions.list[0].scan.num_plots, 0);
    revolutions_free(&revolutions);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sectors_of_one_radar),
        cmocka_unit_test(test_radars_between_one_another),
        cmocka_unit_test(test_whole_circles),
        cmocka_unit_test(test_late_scans),
        cmocka_unit_test(test_scan_that_saw_nothing),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
