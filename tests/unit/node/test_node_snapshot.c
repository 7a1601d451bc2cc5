/* SPDX-License-Identifier: MIT */
/* A node saved as one image, and loaded into another one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "node_senders.h"

static uint8_t *image;
static size_t image_size;
static struct rho_initiator *storage;

static void save_node(void)
{
    struct rho_snapshot_part parts[RHO_NODE_PARTS];
    const unsigned num_parts = rho_node_list_parts(&node, parts);

    assert_true(num_parts >= 3);
    free(image);
    image_size = rho_snapshot_size(parts, num_parts);
    image = malloc(image_size);
    assert_int_equal(rho_snapshot_save(parts, num_parts, 0, image, image_size, &image_size),
                     RHO_OK);
}

static void start_with_storage(const struct rho_node_config *config)
{
    start_node(config);
    if (RHO_MAX_WINDOWS > 1) {
        assert_int_equal(rho_node_add_storage(&node, storage, rho_node_storage_size(2)), RHO_OK);
    }
}

static void step_two_radars(int32_t first, int32_t last_scan)
{
    for (int32_t k = first; k < last_scan; k++, now_us += SECOND_US) {
        send_scan(1, k, now_us);
        send_scan(2, k, now_us + 1000);
    }
    run_until(INT64_MAX);
}

static void a_loaded_node_goes_on_as_the_saved_one(void **state)
{
    struct rho_node_config config = default_config();
    static struct rho_report expected;
    struct rho_settings saved;
    uint16_t num_windows;
    int64_t saved_us;

    (void)state;
    config.options.windows = RHO_NODE_SINGLE;
    start_with_storage(&config);
    step_two_radars(0, 8);
    save_node();
    num_windows = node.windows.count;
    assert_int_equal(num_windows, RHO_MAX_WINDOWS > 1 ? 2 : 1);
    saved_us = now_us;
    step_two_radars(8, 12);
    expected = node.report;
    assert_true(expected.num_tracks > 0);
    start_with_storage(&config);
    assert_int_equal(rho_node_saved_settings(image, image_size, &saved), RHO_OK);
    assert_memory_equal(&saved, &node.settings, sizeof saved);
    assert_int_equal(rho_node_load(&node, image, image_size), RHO_OK);
    assert_int_equal(node.windows.count, num_windows);
    now_us = saved_us;
    step_two_radars(8, 12);
    assert_int_equal(node.counters.restarts, 0);
    assert_memory_equal(&node.report.tracks, &expected.tracks,
                        expected.num_tracks * sizeof expected.tracks[0]);
    assert_int_equal(node.report.num_tracks, expected.num_tracks);
}

static void scans_older_than_the_snapshot_restart_the_node(void **state)
{
    const struct rho_node_config config = default_config();

    (void)state;
    for (int is_older = 0; is_older < 2; is_older++) {
        start_with_storage(&config);
        send_scan(1, 0, now_us);
        save_node();
        start_with_storage(&config);
        assert_int_equal(rho_node_load(&node, image, image_size), RHO_OK);
        now_us += is_older ? -node.assembler.config.jump_max_us - 2 * SECOND_US : SECOND_US;
        send_scan(1, 0, now_us);
        assert_string_equal(done, is_older ? "RS" : "S");
        assert_int_equal(node.counters.restarts, is_older);
        assert_int_equal(node.epoch, EPOCH + is_older);
    }
}

static void snapshots_of_other_nodes_are_refused(void **state)
{
    struct rho_node_config config = default_config();
    struct rho_settings settings;

    (void)state;
    config.options.windows = RHO_NODE_SINGLE;
    start_with_storage(&config);
    step_two_radars(0, 3);
    save_node();
    assert_int_equal(rho_node_load(NULL, image, image_size), RHO_ERROR_NULL);
    assert_int_equal(rho_node_load(&node, NULL, image_size), RHO_ERROR_NULL);
    assert_int_equal(rho_node_load(&node, image, 10), RHO_ERROR_SHORT);
    assert_int_equal(rho_node_saved_settings(image, image_size, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_node_saved_settings(image, 10, &settings), RHO_ERROR_SHORT);
    if (RHO_MAX_WINDOWS > 1) {
        start_node(&config);
        assert_int_equal(rho_node_load(&node, image, image_size), RHO_ERROR_CAPACITY);
        config.options.windows = RHO_NODE_ONE;
        start_with_storage(&config);
        assert_int_equal(rho_node_load(&node, image, image_size), RHO_ERROR_CONFIG);
        config.options.windows = RHO_NODE_SINGLE;
    }
    config.tracker.coast_scans_max++;
    start_with_storage(&config);
    assert_int_equal(rho_node_load(&node, image, image_size), RHO_ERROR_CONFIG);
    assert_int_equal(node.tracker.num_tracks, 0);
    assert_int_equal(node.is_restored, 0);
    config.tracker.coast_scans_max--;
    start_with_storage(&config);
    node.told.pd = 0.6f;
    assert_int_equal(rho_node_load(&node, image, image_size), RHO_ERROR_CONFIG);
    start_with_storage(&config);
    image[image_size / 2] ^= 1;
    assert_int_equal(rho_node_load(&node, image, image_size), RHO_ERROR_VALUE);
    node.magic = 0;
    assert_int_equal(rho_node_load(&node, image, image_size), RHO_ERROR_STATE);
    assert_int_equal(rho_node_list_parts(&node, NULL), 0);
}

/* Saves a node whose settings were changed while it ran. */
static void save_changed_node(void)
{
    const struct rho_node_config config = default_config();
    struct rho_settings settings;

    start_with_storage(&config);
    settings = node.settings;
    settings.v_max_mps = 250.0f;
    settings.pd = 0.7f;
    assert_int_equal(rho_node_set_settings(&node, &settings), RHO_OK);
    send_scan(1, 0, now_us);
    save_node();
}

/* Tracker, windows and descriptions have the loaded settings. */
static void changed_settings_are_loaded(void **state)
{
    const struct rho_node_config config = default_config();

    (void)state;
    save_changed_node();
    start_with_storage(&config);
    assert_int_equal(rho_node_load(&node, image, image_size), RHO_OK);
    assert_true(node.settings.v_max_mps <= 250.0f && node.told.v_max_mps > 250.0f);
    assert_true(node.tracker.config.v_max_mps <= 250.0f);
    assert_true(rho_node_window(&node, 0)->config.v_max_mps <= 250.0f);
    assert_true(node.assembler.config.other.sensor.pd <= 0.7f);
}

/* A refused image changes neither configurations beside the settings nor descriptions. */
static void a_refused_snapshot_of_changed_settings_changes_nothing(void **state)
{
    struct rho_node_config config = default_config();
    struct rho_scan_assembler_sensor known = config.assembler.other;

    (void)state;
    save_changed_node();
    config.tracker.coast_scans_max++;
    start_with_storage(&config);
    known.sensor.sensor_id = 1;
    known.sensor.pd = 0.7f;
    assert_int_equal(rho_scan_assembler_set_sensor(&node.assembler, &known), RHO_OK);
    node.told.v_min_mps = 1.0f;
    assert_int_equal(rho_node_load(&node, image, image_size), RHO_ERROR_CONFIG);
    assert_true(node.settings.pd >= 0.9f);
    assert_true(node.assembler.known[0].sensor.pd <= 0.7f);
    assert_int_equal(node.tracker.config.coast_scans_max, config.tracker.coast_scans_max);
}

static int allocate_storage(void **state)
{
    (void)state;
    storage = malloc(rho_node_storage_size(2));
    return storage ? 0 : -1;
}

static int free_memory(void **state)
{
    (void)state;
    free(storage);
    free(image);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_loaded_node_goes_on_as_the_saved_one),
        cmocka_unit_test(scans_older_than_the_snapshot_restart_the_node),
        cmocka_unit_test(snapshots_of_other_nodes_are_refused),
        cmocka_unit_test(changed_settings_are_loaded),
        cmocka_unit_test(a_refused_snapshot_of_changed_settings_changes_nothing),
    };

    return cmocka_run_group_tests(tests, allocate_storage, free_memory);
}
