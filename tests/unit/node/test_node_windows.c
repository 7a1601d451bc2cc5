/* SPDX-License-Identifier: MIT */
/*
 * Which radars start tracks from a common window: two of much the same coverage, in the order in
 * which they were described. And the storage of windows.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "../../src/node/node_parts.h"
#include "node_senders.h"

#define STORED 6

static struct rho_initiator *storage;

static void open_node(enum rho_node_windows windows)
{
    struct rho_node_config config = default_config();

    config.options.windows = (uint8_t)windows;
    start_node(&config);
    assert_int_equal(rho_node_add_storage(&node, storage, rho_node_storage_size(STORED)), RHO_OK);
    for (int32_t id = 1; id <= 7; id++) {
        struct rho_scan_assembler_sensor known = node.assembler.config.other;

        known.sensor.sensor_id = id;
        known.sensor.range_max_m = 80e3f;
        assert_int_equal(rho_scan_assembler_set_sensor(&node.assembler, &known), RHO_OK);
    }
}

static void describe_sensor(int32_t sensor_id, float x_m, float range_max_m)
{
    const struct rho_sensor sensor = {
        .sensor_id = sensor_id, .x_m = x_m, .pd = 0.9f, .range_max_m = range_max_m};

    assert_int_equal(rho_tracker_set_sensor(&node.tracker, &sensor), RHO_OK);
}

static int is_live; /* scans come as messages */

static struct rho_initiator *initiator_of(int32_t sensor_id)
{
    const struct rho_scan scan = {.sensor_id = sensor_id};

    return rho_node_windows_find(&node, &scan, is_live);
}

static void radars_of_the_same_coverage_share_a_window(void **state)
{
    (void)state;
    open_node(RHO_NODE_PAIRS);
    describe_sensor(7, 0.0f, 80e3f);
    describe_sensor(3, 60e3f, 80e3f);
    struct rho_initiator *first = initiator_of(7);
    assert_ptr_equal(initiator_of(3), first);
    assert_ptr_equal(initiator_of(7), first);
    assert_int_equal(node.windows.count, 1);
}

static void a_third_radar_shares_a_window_with_the_fourth(void **state)
{
    (void)state;
    open_node(RHO_NODE_PAIRS);
    for (int32_t id = 1; id <= 3; id++) {
        describe_sensor(id, 0.0f, 80e3f);
    }
    struct rho_initiator *third = initiator_of(3);
    assert_ptr_not_equal(initiator_of(1), third);
    assert_ptr_equal(initiator_of(2), initiator_of(1));
    describe_sensor(4, 0.0f, 80e3f);
    assert_ptr_equal(initiator_of(4), third);
    assert_ptr_equal(initiator_of(3), third);
    assert_ptr_equal(initiator_of(2), initiator_of(1)); /* sensors 1 and 2 stay a pair */
}

static void radars_of_different_coverage_have_a_window_each(void **state)
{
    (void)state;
    open_node(RHO_NODE_PAIRS);
    describe_sensor(1, 0.0f, 80e3f);
    describe_sensor(2, 65e3f, 80e3f); /* too far from sensor 1 */
    describe_sensor(3, 0.0f, 40e3f);  /* covers a quarter of sensor 1's area */
    assert_ptr_not_equal(initiator_of(1), initiator_of(2));
    assert_ptr_not_equal(initiator_of(1), initiator_of(3));
    assert_ptr_not_equal(initiator_of(99), initiator_of(1)); /* an undescribed sensor */
    open_node(RHO_NODE_SINGLE);
    describe_sensor(1, 0.0f, 80e3f);
    describe_sensor(2, 0.0f, 80e3f);
    assert_ptr_not_equal(initiator_of(1), initiator_of(2));
    open_node(RHO_NODE_ONE);
    assert_ptr_equal(initiator_of(1), initiator_of(99));
}

/*
 * Of a file, all sensors are described as the file says, so a sensor missing in the config may
 * share.
 */
static void live_sensors_missing_in_the_config_share_no_window(void **state)
{
    (void)state;
    for (is_live = 0; is_live < 2; is_live++) {
        open_node(RHO_NODE_PAIRS);
        describe_sensor(1, 0.0f, 80e3f);
        describe_sensor(8, 0.0f, 80e3f);
        assert_int_equal(initiator_of(8) == initiator_of(1), !is_live);
        describe_sensor(2, 0.0f, 80e3f);
        assert_int_equal(initiator_of(2) == initiator_of(1), is_live);
    }
    is_live = 0;
}

static void radars_with_sectors_have_their_own_window(void **state)
{
    (void)state;
    open_node(RHO_NODE_PAIRS);
    describe_sensor(1, 0.0f, 80e3f);
    describe_sensor(2, 0.0f, 80e3f);
    const struct rho_scan sector = {.sensor_id = 2, .sector_to_rad = 1.0f};
    assert_ptr_not_equal(rho_node_windows_find(&node, &sector, 0), initiator_of(1));
}

/* Steps whole turns of both radars for a minute, until their turn times are known. */
static void step_turns_of_two_radars(int first_s, int second_s)
{
    for (int t_s = 0; t_s <= 60; t_s++) {
        for (int32_t id = 1; id <= 2; id++) {
            const struct rho_scan scan = {.sensor_id = id, .time_us = t_s * SECOND_US};

            if (t_s % (id == 1 ? first_s : second_s) == 0) {
                assert_int_equal(rho_node_step_scan(&node, &scan), RHO_OK);
            }
        }
    }
}

static void radars_of_different_turn_times_stop_sharing(void **state)
{
    (void)state;
    static const int turns_s[][3] = {{4, 5, 1}, {5, 4, 1}, {4, 4, 1}, {4, 10, 0}, {1, 2, 0}};

    for (size_t i = 0; i < sizeof turns_s / sizeof turns_s[0]; i++) {
        open_node(RHO_NODE_PAIRS);
        describe_sensor(1, 0.0f, 80e3f);
        describe_sensor(2, 0.0f, 80e3f);
        step_turns_of_two_radars(turns_s[i][0], turns_s[i][1]);
        assert_int_equal(initiator_of(1) == initiator_of(2), turns_s[i][2]);
    }
}

/* Seven turns of 10 s; the first scans had gone into the window that both radars shared. */
static void a_radar_that_stops_sharing_keeps_its_scans(void **state)
{
    (void)state;
    open_node(RHO_NODE_PAIRS);
    describe_sensor(1, 0.0f, 80e3f);
    describe_sensor(2, 0.0f, 80e3f);
    step_turns_of_two_radars(4, 10);
    struct rho_window *window = &initiator_of(2)->window;
    assert_ptr_not_equal(initiator_of(2), initiator_of(1));
    assert_int_equal(window->num_scans, 7);
    for (unsigned m = 0; m < window->num_scans; m++) {
        assert_int_equal(rho_window_scan_at(window, m)->time_us, m * 10 * SECOND_US);
        assert_int_equal(rho_window_scan_at(window, m)->sensor.sensor_id, 2);
    }
}

static int share_a_window(float first_s, float second_s)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        struct rho_tracker_pace *pace = &node.tracker.sensors[i].pace;
        const int32_t id = node.tracker.sensors[i].sensor.sensor_id;

        pace->interval_s = id == 1 ? first_s : id == 2 ? second_s : pace->interval_s;
    }
    return initiator_of(1) == initiator_of(2);
}

/*
 * Near a ratio of 1.5 turns of one radar to a turn of the other, they do not change windows back
 * and forth.
 */
static void sharing_stops_at_1_5_and_resumes_at_1_4_times_the_turn(void **state)
{
    (void)state;
    for (int is_slow = 0; is_slow < 2; is_slow++) {
        const float slow_s = is_slow ? 10.0f : 4.0f;

        open_node(RHO_NODE_PAIRS);
        describe_sensor(1, 0.0f, 80e3f);
        describe_sensor(2, 0.0f, 80e3f);
        step_turns_of_two_radars(4, 4);
        assert_true(share_a_window(slow_s, slow_s / 1.45f));
        assert_true(share_a_window(slow_s, slow_s / 1.49f));
        assert_false(share_a_window(slow_s, slow_s / 1.51f));
        assert_false(share_a_window(slow_s, slow_s / 1.49f));
        assert_false(share_a_window(slow_s / 1.45f, slow_s));
        assert_true(share_a_window(slow_s, slow_s / 1.35f));
    }
}

/* The first radar's window is in the node; the last one that there is room for is shared. */
static void radars_without_storage_share_the_last_window(void **state)
{
    (void)state;
    open_node(RHO_NODE_SINGLE);
    for (int32_t id = 1; id <= STORED + 1; id++) {
        assert_int_equal(rho_node_wants_storage(&node), 0);
        assert_non_null(initiator_of(id));
        assert_int_equal(node.windows.count, id);
    }
    assert_int_equal(rho_node_wants_storage(&node), 1);
    assert_int_equal(node.windows.shared, 0);
    assert_ptr_equal(initiator_of(100), &storage[STORED - 1]);
    assert_ptr_equal(initiator_of(101), &storage[STORED - 1]);
    assert_int_equal(node.windows.shared, 2);
    assert_ptr_equal(initiator_of(1), rho_node_window(&node, 0));
    assert_null(rho_node_window(&node, STORED + 1));
}

static void storage_too_small_is_refused(void **state)
{
    const size_t one = rho_node_storage_size(1);

    (void)state;
    assert_int_equal(one, sizeof(struct rho_initiator));
    start_default_node();
    assert_int_equal(rho_node_add_storage(NULL, storage, one), RHO_ERROR_NULL);
    assert_int_equal(rho_node_add_storage(&node, NULL, one), RHO_ERROR_NULL);
    assert_int_equal(rho_node_add_storage(&node, storage, one - 1), RHO_ERROR_SIZE);
    assert_int_equal(rho_node_add_storage(&node, (uint8_t *)storage + 1, one), RHO_ERROR_VALUE);
    assert_int_equal(rho_node_add_storage(&node, storage, one),
                     RHO_MAX_WINDOWS > 1 ? RHO_OK : RHO_ERROR_CAPACITY);
    node.magic = 0;
    assert_int_equal(rho_node_add_storage(&node, storage, one), RHO_ERROR_STATE);
    assert_int_equal(rho_node_wants_storage(&node), 0);
}

/* A build with one window gives it to all radars, and wants no storage. */
static void a_build_with_one_window_shares_it(void **state)
{
    (void)state;
    start_default_node();
    assert_ptr_equal(initiator_of(1), rho_node_window(&node, 0));
    assert_ptr_equal(initiator_of(2), rho_node_window(&node, 0));
    assert_int_equal(rho_node_wants_storage(&node), 0);
    assert_int_equal(node.windows.shared, 0);
}

static int allocate_storage(void **state)
{
    (void)state;
    storage = malloc(rho_node_storage_size(STORED));
    return storage ? 0 : -1;
}

static int free_storage(void **state)
{
    (void)state;
    free(storage);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(storage_too_small_is_refused),
        cmocka_unit_test(radars_of_the_same_coverage_share_a_window),
        cmocka_unit_test(a_third_radar_shares_a_window_with_the_fourth),
        cmocka_unit_test(radars_of_different_coverage_have_a_window_each),
        cmocka_unit_test(live_sensors_missing_in_the_config_share_no_window),
        cmocka_unit_test(radars_with_sectors_have_their_own_window),
        cmocka_unit_test(radars_of_different_turn_times_stop_sharing),
        cmocka_unit_test(a_radar_that_stops_sharing_keeps_its_scans),
        cmocka_unit_test(sharing_stops_at_1_5_and_resumes_at_1_4_times_the_turn),
        cmocka_unit_test(radars_without_storage_share_the_last_window),
    };
    const struct CMUnitTest tests_of_one_window[] = {
        cmocka_unit_test(storage_too_small_is_refused),
        cmocka_unit_test(a_build_with_one_window_shares_it),
    };

    return RHO_MAX_WINDOWS > 1
               ? cmocka_run_group_tests(tests, allocate_storage, free_storage)
               : cmocka_run_group_tests(tests_of_one_window, allocate_storage, free_storage);
}
