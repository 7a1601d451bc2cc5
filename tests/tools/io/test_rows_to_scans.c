/* SPDX-License-Identifier: MIT */
/*
 * Rows grouped to scans while they are read: the same scans as with all rows in memory, in order,
 * and with few scans in memory at a time.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "io/scans/rows_to_scans.h"

#define ROWS 4000
#define SECOND INT64_C(1000000)

struct test_row {
    int32_t sensor_id;
    struct scan_number number;
    int64_t time_us;
    bool has_element;
};

/* A scan of the reference: indices of its rows. */
struct whole {
    struct test_row first;
    int64_t time_us;
    bool has_time;
    size_t count;
    int32_t sum;
};

/* Takes a row, whose time must be allowed for its scan. */
static void take_row(struct rows_to_scans *gather, const struct test_row *row, int32_t element)
{
    char reason[ROW_REASON_BYTES];
    const struct row_check check = {.reason = reason};
    struct gathered_scan *scan =
        rows_to_scans_find_scan(gather, row->sensor_id, &row->number, row->time_us);

    assert_true(rows_to_scans_check_time(gather, scan, row->time_us, &check));
    if (!scan) {
        const struct gathered_scan begun = {.sensor_id = row->sensor_id, .number = row->number};

        scan = rows_to_scans_begin_scan(gather, &begun, row->time_us);
    }
    if (row->has_element) {
        rows_to_scans_add_element(gather, scan, row->time_us, &element);
    } else {
        rows_to_scans_add_empty_row(gather, scan, row->time_us);
    }
}

static struct whole whole[ROWS];
static size_t num_whole;

static struct whole *find_reference_scan(const struct test_row *row, int64_t interval_us)
{
    struct whole *newest = NULL;

    for (size_t i = 0; i < num_whole; i++) {
        struct whole *scan = &whole[i];

        if (scan->first.sensor_id != row->sensor_id) {
            continue;
        }
        newest = scan;
        if (row->number.is_given && scan->first.number.is_given &&
            row->number.scan == scan->first.number.scan) {
            return scan;
        }
    }
    return newest && row_joins_scan(&row->number, row->time_us, &newest->first.number,
                                    newest->first.time_us, interval_us)
               ? newest
               : NULL;
}

static void add_row_to_reference(const struct test_row *row, int64_t interval_us, int32_t element)
{
    struct whole *scan = find_reference_scan(row, interval_us);

    if (!scan) {
        scan = &whole[num_whole++];
        *scan = (struct whole){.first = *row, .time_us = row->time_us};
    }
    if (row->has_element) {
        scan->count++;
        scan->sum += element;
    } else if (row->number.is_given && !scan->has_time) {
        scan->has_time = true;
        scan->time_us = row->time_us;
    }
}

/* Insertion sort, which keeps the order of equal times. */
static void sort_reference_by_time(void)
{
    for (size_t i = 1; i < num_whole; i++) {
        struct whole scan = whole[i];
        size_t at = i;

        for (; at > 0 && whole[at - 1].time_us > scan.time_us; at--) {
            whole[at] = whole[at - 1];
        }
        whole[at] = scan;
    }
}

/* Completed scans equal the next scans of the reference. */
static void check_completed_scans(struct rows_to_scans *gather, bool all, size_t *next)
{
    struct gathered_scan scan;

    while (rows_to_scans_take_scan(gather, all, &scan)) {
        const struct whole *expected = &whole[(*next)++];
        int32_t sum = 0;

        for (size_t i = 0; i < scan.count; i++) {
            sum += ((const int32_t *)scan.elements)[i];
        }
        assert_int_equal(scan.time_us, expected->time_us);
        assert_int_equal(scan.start_us, expected->first.time_us);
        assert_int_equal(scan.sensor_id, expected->first.sensor_id);
        assert_int_equal(scan.count, expected->count);
        assert_int_equal(sum, expected->sum);
        gathered_scan_free(&scan);
    }
}

/* Groups the rows in both ways. Returns the largest number of scans that were in memory. */
static size_t most_open_scans_equal_to_reference(const struct test_row *rows, int64_t interval_us)
{
    struct rows_to_scans gather;
    size_t next = 0, most = 0;

    num_whole = 0;
    for (int i = 0; i < ROWS; i++) {
        add_row_to_reference(&rows[i], interval_us, i);
    }
    sort_reference_by_time();
    rows_to_scans_start(&gather, sizeof(int32_t), interval_us);
    for (int i = 0; i < ROWS; i++) {
        take_row(&gather, &rows[i], i);
        most = gather.count > most ? gather.count : most;
        check_completed_scans(&gather, false, &next);
    }
    check_completed_scans(&gather, true, &next);
    assert_int_equal(next, num_whole);
    rows_to_scans_free(&gather);
    return most;
}

static void rows_are_grouped_by_time(void **state)
{
    static struct test_row rows[ROWS];
    (void)state;

    for (unsigned seed = 1; seed <= 6; seed++) {
        struct random random = random_start(seed, 1, 0);
        const int64_t interval_us = seed % 2 ? 0 : 3 * SECOND;
        int64_t now_us = -50 * SECOND;

        for (int i = 0; i < ROWS; i++) {
            now_us +=
                random_below(&random, 3) == 0 ? (int64_t)random_below(&random, 2000) * 1000 : 0;
            rows[i] = (struct test_row){.sensor_id = (int32_t)random_below(&random, 4),
                                        .time_us = now_us,
                                        .has_element = random_below(&random, 5) > 0};
        }
        assert_true(most_open_scans_equal_to_reference(rows, interval_us) <= (interval_us ? 9 : 5));
        assert_true(num_whole > 300);
    }
}

/*
 * Two radars that turn in about 4 s; rows of a scan come up to 3 s after the next one has begun,
 * and times go back.
 */
static void rows_are_grouped_by_scan_number(void **state)
{
    static struct test_row rows[ROWS];
    (void)state;

    for (unsigned seed = 1; seed <= 6; seed++) {
        struct random random = random_start(seed, 2, 0);
        int64_t now_us = 0;

        for (int i = 0; i < ROWS; i++) {
            int32_t sensor_id = (int32_t)random_below(&random, 2);
            int64_t turn_us = (4 + sensor_id) * SECOND, back_us;

            now_us += (int64_t)random_below(&random, 200) * 1000;
            back_us = (int64_t)random_below(&random, 3000) * 1000;
            rows[i] = (struct test_row){
                .sensor_id = sensor_id,
                .number = {.is_given = true, .scan = (int32_t)((now_us - back_us) / turn_us)},
                .time_us = now_us,
                .has_element = random_below(&random, 8) > 0};
        }
        assert_true(most_open_scans_equal_to_reference(rows, 0) < 2 * 60 / 4 + 6);
        assert_true(num_whole > 100);
    }
}

static void times_may_go_back_within_a_numbered_scan_alone(void **state)
{
    char reason[ROW_REASON_BYTES] = "";
    const struct row_check check = {.reason = reason};
    const struct test_row one = {1, {true, 1, 0}, 5 * SECOND, true},
                          two = {1, {true, 2, 0}, 6 * SECOND, true},
                          back = {1, {true, 1, 0}, 4 * SECOND, true};
    const struct scan_number other = {true, 3, 0};
    struct rows_to_scans gather;
    (void)state;

    rows_to_scans_start(&gather, sizeof(int32_t), 0);
    take_row(&gather, &one, 0);
    take_row(&gather, &two, 0);
    take_row(&gather, &back, 0);
    assert_int_equal(gather.count, 2);
    assert_null(rows_to_scans_find_scan(&gather, 1, &other, 5 * SECOND));
    assert_false(rows_to_scans_check_time(&gather, NULL, 5 * SECOND, &check));
    assert_string_equal(reason, "time decreases from 6.000000 s to 5.000000 s");
    rows_to_scans_free(&gather);
}

/*
 * A numbered scan is complete after a minute, or with begun_max once its sensor has begun so many
 * newer scans.
 */
static void numbered_scans_end_after_a_minute_or_begun_max_newer_ones(void **state)
{
    struct rows_to_scans gather;
    struct gathered_scan scan;
    (void)state;

    for (unsigned begun_max = 0; begun_max <= 2; begun_max++) {
        const int last = begun_max ? (int)begun_max : 61;

        rows_to_scans_start(&gather, sizeof(int32_t), 0);
        gather.begun_max = begun_max;
        for (int k = 0; k <= last; k++) {
            const struct test_row row = {1, {true, k, 0}, k * SECOND, true};

            assert_false(rows_to_scans_take_scan(&gather, false, &scan));
            take_row(&gather, &row, k);
        }
        assert_true(rows_to_scans_take_scan(&gather, false, &scan));
        assert_int_equal(scan.number.scan, 0);
        gathered_scan_free(&scan);
        rows_to_scans_free(&gather);
    }
}

/*
 * Row times are by biased clocks, scan times by the common one: sensor 1 is two seconds ahead,
 * sensor 2 three behind.
 */
static void scans_of_biased_clocks_are_sorted_by_common_time(void **state)
{
    const int64_t biases_us[] = {0, 2 * SECOND, -3 * SECOND};
    struct rows_to_scans gather;
    struct gathered_scan scan;
    int64_t last_us = INT64_MIN;
    size_t count = 0, most = 0;
    (void)state;

    rows_to_scans_start(&gather, sizeof(int32_t), 0);
    gather.bias_max_us = (int32_t)biases_us[1];
    for (int k = 0; k < 300; k++) {
        const int sensor_id = k % 3;
        const struct gathered_scan begun = {.sensor_id = sensor_id,
                                            .bias_us = (int32_t)biases_us[sensor_id]};
        const int64_t time_us = k * SECOND / 2;

        rows_to_scans_add_element(&gather, rows_to_scans_begin_scan(&gather, &begun, time_us),
                                  time_us, &k);
        most = gather.count > most ? gather.count : most;
        while (rows_to_scans_take_scan(&gather, k == 299, &scan)) {
            const int element = *(const int32_t *)scan.elements;

            assert_int_equal(gathered_scan_time_us(&scan),
                             element * SECOND / 2 - biases_us[scan.sensor_id]);
            assert_true(gathered_scan_time_us(&scan) >= last_us);
            last_us = gathered_scan_time_us(&scan);
            count++;
            gathered_scan_free(&scan);
        }
    }
    assert_int_equal(count, 300);
    assert_true(most <= 2 * 5 + 2);
    rows_to_scans_free(&gather);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_are_grouped_by_time),
        cmocka_unit_test(rows_are_grouped_by_scan_number),
        cmocka_unit_test(times_may_go_back_within_a_numbered_scan_alone),
        cmocka_unit_test(numbered_scans_end_after_a_minute_or_begun_max_newer_ones),
        cmocka_unit_test(scans_of_biased_clocks_are_sorted_by_common_time),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
