/* SPDX-License-Identifier: MIT */
/*
 * The table of sensors: one row a sensor, described ones first; where it is full, a new sensor
 * takes the row of the undescribed one that was heard longest ago.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "rhotrack/operator.h"
#include "rhotrack/tracker.h"

static struct rho_tracker tracker;
static struct rho_report report;

static struct rho_sensor sensor_of(int32_t sensor_id)
{
    return (struct rho_sensor){.sensor_id = sensor_id, .pd = 0.9f, .range_max_m = 1e5f};
}

static enum rho_status describe(int32_t sensor_id)
{
    const struct rho_sensor sensor = sensor_of(sensor_id);
    return rho_tracker_set_sensor(&tracker, &sensor);
}

static void hear(int32_t sensor_id, int64_t t_s)
{
    const struct rho_scan scan = {.time_us = 1000000 * t_s, .sensor_id = sensor_id};
    assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
}

static int set_up(void **state)
{
    struct rho_tracker_config config;
    (void)state;
    rho_tracker_config_default(&config);
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    return 0;
}

/* Each sensor has one row: to hear and to describe it in either order does not give it another. */
static void a_sensor_has_one_row(void **state)
{
    (void)state;
    hear(7, 1);
    assert_int_equal(describe(3), RHO_OK);
    hear(3, 2);
    assert_int_equal(describe(7), RHO_OK);
    hear(7, 3);
    assert_int_equal(tracker.num_rows, 2);
    assert_int_equal(tracker.num_sensors, 2);
    assert_int_equal(tracker.sensors[0].sensor.sensor_id, 3);
    assert_int_equal(tracker.sensors[1].sensor.sensor_id, 7);
    assert_true(tracker.sensors[1].pace.interval_s == 2.0f); /* measured since it was first heard */
    assert_true(rho_tracker_is_sound(&tracker));
}

/* A described sensor keeps its row; the undescribed one heard longest ago gives way to another. */
static void a_full_table_keeps_described_sensors(void **state)
{
    (void)state;
    assert_int_equal(describe(1000), RHO_OK);
    hear(1000, 0);
    for (int32_t id = 1; id < RHO_MAX_SENSORS; id++) {
        hear(id, id);
    }
    assert_int_equal(tracker.num_rows, RHO_MAX_SENSORS);
    hear(1, RHO_MAX_SENSORS);
    hear(500, RHO_MAX_SENSORS + 1); /* in place of 2 */
    assert_null(RHO_SECTORS ? rho_tracker_look_of(&tracker, 2) : NULL);
    assert_true(!RHO_SECTORS || rho_tracker_look_of(&tracker, 1));
    assert_true(!RHO_SECTORS || rho_tracker_look_of(&tracker, 500));
    assert_true(!RHO_SECTORS || rho_tracker_look_of(&tracker, 1000));
    assert_int_equal(describe(501), RHO_OK); /* in place of 3 */
    assert_null(RHO_SECTORS ? rho_tracker_look_of(&tracker, 3) : NULL);
    assert_int_equal(tracker.num_rows, RHO_MAX_SENSORS);
    assert_int_equal(tracker.num_sensors, 2);
    assert_int_equal(tracker.sensors[1].sensor.sensor_id, 501);
    assert_true(rho_tracker_is_sound(&tracker));
}

/* Where all rows are of described sensors, a further one is stepped without a row. */
static void a_table_of_described_sensors_takes_no_other(void **state)
{
    (void)state;
    for (int32_t id = 1; id <= RHO_MAX_SENSORS; id++) {
        assert_int_equal(describe(id), RHO_OK);
    }
    hear(999, 1);
    assert_null(rho_tracker_look_of(&tracker, 999));
    assert_int_equal(describe(999), RHO_ERROR_CAPACITY);
    assert_int_equal(rho_tracker_forget_sensor(&tracker, 1), RHO_OK);
    assert_int_equal(rho_tracker_forget_sensor(&tracker, 1), RHO_ERROR_STATE);
    hear(999, 2);
    assert_int_equal(tracker.num_rows, RHO_MAX_SENSORS);
    assert_int_equal(tracker.num_sensors, RHO_MAX_SENSORS - 1);
    assert_int_equal(describe(999), RHO_OK);
    assert_int_equal(tracker.num_sensors, RHO_MAX_SENSORS);
    assert_true(rho_tracker_is_sound(&tracker));
}

/* A sensor whose scans are all late is stepped, but takes no row, and none from another sensor. */
static void a_sensor_that_is_always_late_takes_no_row(void **state)
{
    (void)state;
    hear(1, 100);
    hear(2, 90);
    assert_int_equal(tracker.counters.scans_retrodicted, RHO_SECTORS ? 1 : 0);
    assert_int_equal(tracker.num_rows, 1);
    assert_null(rho_tracker_look_of(&tracker, 2));
    assert_int_equal(describe(3), RHO_OK);
    hear(3, 95);
    assert_null(rho_tracker_look_of(&tracker, 3));
    hear(2, 101);
    assert_int_equal(tracker.num_rows, 3);
    assert_true(rho_tracker_is_sound(&tracker));
}

/* A tracker that was never initialised is told apart before its table is read. */
static void a_table_without_a_tracker_is_not_read(void **state)
{
    static struct rho_tracker none;
    struct rho_tracker_known known;
    const struct rho_operator_start start = {.sigma_m = 1.0f};
    (void)state;
    none.num_rows = none.num_sensors = UINT16_MAX;
    assert_int_equal(rho_tracker_known_of(&none, 1, &known), RHO_ERROR_STATE);
    assert_int_equal(rho_tracker_start_at(&none, &start, &report), RHO_ERROR_STATE);
}

/* A forgotten sensor leaves nothing: heard again, it has an undescribed row without a history. */
static void a_forgotten_sensor_begins_anew(void **state)
{
    struct rho_tracker_known known;
    (void)state;
    for (int32_t id = 1; id <= 3; id++) {
        assert_int_equal(describe(id), RHO_OK);
        hear(id, id);
        hear(id, id + 10);
    }
    assert_int_equal(rho_tracker_forget_sensor(&tracker, 1), RHO_OK);
    assert_null(rho_tracker_look_of(&tracker, 1));
    assert_int_equal(tracker.num_rows, 2);
    hear(1, 20);
    assert_int_equal(tracker.num_rows, 3);
    assert_int_equal(tracker.num_sensors, 2);
    assert_true(tracker.sensors[2].pace.interval_s == 0.0f);
    assert_int_equal(rho_tracker_known_of(&tracker, 1, &known), RHO_ERROR_STATE);
    assert_int_equal(rho_tracker_known_of(&tracker, 3, &known), RHO_OK);
    assert_true(rho_tracker_is_sound(&tracker));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_sensor_has_one_row, set_up),
        cmocka_unit_test_setup(a_full_table_keeps_described_sensors, set_up),
        cmocka_unit_test_setup(a_table_of_described_sensors_takes_no_other, set_up),
        cmocka_unit_test_setup(a_sensor_that_is_always_late_takes_no_row, set_up),
        cmocka_unit_test(a_table_without_a_tracker_is_not_read),
        cmocka_unit_test_setup(a_forgotten_sensor_begins_anew, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
