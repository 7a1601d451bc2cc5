/* SPDX-License-Identifier: MIT */
/*
 * The node: messages in, steps in order of time, messages out; sensors that it describes and
 * forgets; restarts.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "node_senders.h"
#include "rhotrack/operator.h"

/*
 * ---- start ------------------------------------------------------------------------------------
 */

static void wrong_calls_are_refused(void **state)
{
    struct rho_node_config config = default_config();
    struct rho_settings settings;
    const struct rho_scan scan = {.time_us = 0};
    const struct rho_zone zone = {.num_corners = 2};
    uint8_t bytes[4];
    size_t size;

    (void)state;
    memset(&node, 0, sizeof node);
    rho_settings_default(&settings);
    assert_int_equal(rho_node_take(&node, "RHO_PLOTS_1", (const uint8_t *)"", 0, 0),
                     RHO_ERROR_STATE);
    assert_int_equal(rho_node_take(NULL, "RHO_PLOTS_1", (const uint8_t *)"", 0, 0), RHO_ERROR_NULL);
    assert_int_equal(rho_node_next(&node, 0), RHO_NODE_NOTHING);
    assert_int_equal(rho_node_num_messages(&node), 0);
    assert_true(rho_node_due_us(&node) == INT64_MAX);
    assert_int_equal(rho_node_step_scan(&node, &scan), RHO_ERROR_STATE);
    assert_int_equal(rho_node_configure(&node, &config), RHO_ERROR_STATE);
    assert_int_equal(rho_node_reconfigure(&node, &config), RHO_ERROR_STATE);
    assert_int_equal(rho_node_set_settings(&node, &settings), RHO_ERROR_STATE);
    assert_int_equal(rho_node_add_zone(&node, &zone), RHO_ERROR_STATE);
    assert_int_equal(rho_node_publish(&node, 0, bytes, sizeof bytes, &size), RHO_ERROR_STATE);
    assert_int_equal(rho_node_init(NULL, sizeof node, &settings), RHO_ERROR_NULL);
    assert_int_equal(rho_node_init(&node, sizeof node, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_node_init(&node, sizeof node - 1, &settings), RHO_ERROR_SIZE);
    settings.v_max_mps = -1.0f;
    assert_int_equal(rho_node_init(&node, sizeof node, &settings), RHO_ERROR_CONFIG);
    assert_int_equal(rho_node_next(&node, 0), RHO_NODE_NOTHING);
    settings.v_max_mps = 100.0f;
    settings.scan_interval_s = 0.0f; /* of no part of its own */
    assert_int_equal(rho_node_init(&node, sizeof node, &settings),
                     RHO_MAX_COMMANDS > 0 ? RHO_ERROR_CONFIG : RHO_OK);
    assert_null(rho_node_channel(NULL, 0));
    start_default_node();
    assert_null(rho_node_channel(&node, 0));
    assert_int_equal(rho_node_step_scan(&node, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_node_step_bearings(NULL, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_node_add_zone(&node, &zone),
                     RHO_MAX_ZONES > 0 ? RHO_ERROR_VALUE : RHO_ERROR_CAPACITY);
    assert_int_equal(rho_node_take(&node, "ELSE", (const uint8_t *)"", 0, 0), RHO_ERROR_TYPE);
}

/* Parts that the build does not have, and values outside their ranges. */
static void configurations_that_no_part_takes_are_refused(void **state)
{
    struct rho_node_config config = default_config();

    (void)state;
    config.passive_range_max_m = NAN;
    start_default_node();
    assert_int_equal(rho_node_configure_bearings(&node, &config), RHO_ERROR_CONFIG);
    assert_int_equal(rho_node_configure_bearings(&node, &config), RHO_ERROR_STATE);
    start_default_node();
    assert_int_equal(rho_node_configure(&node, &config), RHO_ERROR_CONFIG);
    assert_int_equal(rho_node_configure(&node, &config), RHO_ERROR_STATE);
    config = default_config();
    config.options.windows = RHO_NUM_NODE_WINDOWS;
    start_default_node();
    assert_int_equal(rho_node_configure(&node, &config),
                     RHO_MAX_WINDOWS > 1 ? RHO_ERROR_CONFIG : RHO_OK);
    config = default_config();
    config.options.takes_commands = 1;
    start_default_node();
    assert_int_equal(rho_node_configure(&node, &config),
                     RHO_MAX_COMMANDS > 0 ? RHO_OK : RHO_ERROR_CONFIG);
    config = default_config();
    config.options.learns_reflectors = 1;
    start_default_node();
    assert_int_equal(rho_node_configure(&node, &config),
                     RHO_LEARNS_REFLECTORS ? RHO_OK : RHO_ERROR_CONFIG);
    config = default_config();
    config.options.is_plots_by_paper = 1;
    start_default_node();
    assert_int_equal(rho_node_configure(&node, &config), RHO_PAPERS ? RHO_OK : RHO_ERROR_CONFIG);
    config = default_config();
    config.body_max_m = 20.0f;
    start_default_node();
    assert_int_equal(rho_node_configure(&node, &config), RHO_BODIES ? RHO_OK : RHO_ERROR_CONFIG);
    config = default_config();
    config.assembler.other.noise.sigma_rad = -1.0f;
    start_default_node();
    assert_int_equal(rho_node_configure(&node, &config), RHO_ERROR_CONFIG);
}

static void a_node_with_refused_bearings_is_not_used(void **state)
{
    struct rho_node_config config = default_config();
    const struct rho_scan scan = {.time_us = 0};

    (void)state;
    config.passive.pd = -1.0f;
    start_default_node();
    assert_int_equal(rho_node_configure_bearings(&node, &config), RHO_ERROR_CONFIG);
    assert_int_equal(rho_node_step_scan(&node, &scan), RHO_ERROR_STATE);
    assert_int_equal(rho_node_next(&node, 0), RHO_NODE_NOTHING);
}

static void refused_configurations_leave_tracker_and_windows(void **state)
{
    struct rho_node_config config = default_config();

    (void)state;
    start_default_node();
    config.tracker.v_max_mps = 100.0f;
    config.initiator.scans = 1;
    assert_int_equal(rho_node_reconfigure(&node, &config), RHO_ERROR_CONFIG);
    assert_true(node.tracker.config.v_max_mps > 100.0f);
    assert_int_not_equal(rho_node_window(&node, 0)->config.scans, 1);
}

/* What the settings say of a radar holds for each sensor that is not described. */
static void settings_reach_tracker_initiator_and_sensors(void **state)
{
    struct rho_settings settings;

    (void)state;
    rho_settings_preset(&settings, RHO_PRESET_MARINE);
    assert_int_equal(rho_node_init(&node, sizeof node, &settings), RHO_OK);
    assert_true(node.tracker.config.v_max_mps <= 50.0f);
    assert_true(rho_node_window(&node, 0)->config.v_max_mps <= 50.0f);
    assert_null(rho_node_window(&node, 1));
    assert_null(rho_node_window(NULL, 0));
    assert_true(node.assembler.config.other.sensor.pd <= 0.8f);
    assert_true(node.assembler.config.other.noise.sigma_azimuth_rad >= 0.0089f);
    assert_memory_equal(&node.settings, &settings, sizeof settings);
    settings.pd = 0.7f;
    assert_int_equal(rho_node_set_settings(&node, &settings), RHO_OK);
    assert_true(node.assembler.config.other.sensor.pd <= 0.7f);
    assert_true(node.tracker.config.pd <= 0.7f);
    assert_true(rho_node_window(&node, 0)->config.pd <= 0.7f);
    settings.pd = 2.0f;
    assert_int_equal(rho_node_set_settings(&node, &settings), RHO_ERROR_CONFIG);
    assert_true(node.settings.pd <= 0.7f);
    assert_true(node.told.pd >= 0.79f);
}

/* A sensor with a range of its own keeps it, and refuses settings that contradict it. */
static void descriptions_follow_the_settings_that_they_equal(void **state)
{
    struct rho_scan_assembler_sensor own = {.sensor = {.sensor_id = 3}}, follows;
    struct rho_settings settings;

    (void)state;
    start_default_node();
    settings = node.settings;
    own.noise = node.assembler.config.other.noise;
    rho_settings_apply_sensor(&settings, &own.sensor);
    follows = own;
    follows.sensor.sensor_id = 4;
    own.sensor.range_min_m = 5000.0f;
    own.sensor.range_max_m = 30000.0f;
    assert_int_equal(rho_scan_assembler_set_sensor(&node.assembler, &own), RHO_OK);
    assert_int_equal(rho_scan_assembler_set_sensor(&node.assembler, &follows), RHO_OK);
    settings.range_max_m = 60000.0f;
    assert_int_equal(rho_node_set_settings(&node, &settings), RHO_OK);
    assert_true(node.assembler.known[0].sensor.range_max_m <= 30000.0f);
    assert_true(node.assembler.known[1].sensor.range_max_m <= 60000.0f &&
                node.assembler.known[1].sensor.range_max_m >= 60000.0f);
    follows.sensor.range_min_m = 40000.0f;
    follows.sensor.range_max_m = 60000.0f;
    assert_int_equal(rho_scan_assembler_set_sensor(&node.assembler, &follows), RHO_OK);
    settings.range_max_m = 35000.0f;
    assert_int_equal(rho_node_set_settings(&node, &settings), RHO_ERROR_CONFIG);
    assert_true(node.settings.range_max_m >= 60000.0f);
}

/* Sensors that are not described, too, need a range that is above their least one. */
static void settings_that_contradict_other_sensors_are_refused(void **state)
{
    struct rho_node_config config = default_config();
    struct rho_settings settings;

    (void)state;
    config.assembler.other.sensor.range_min_m = 50e3f;
    start_node(&config);
    settings = node.settings;
    settings.range_max_m = 40e3f;
    assert_int_equal(rho_node_set_settings(&node, &settings), RHO_ERROR_CONFIG);
    assert_true(node.assembler.config.other.sensor.range_max_m > 50e3f);
    assert_true(node.settings.range_max_m > 50e3f);
}

/*
 * ---- steps and messages -----------------------------------------------------------------------
 */

static void scans_are_stepped_and_published(void **state)
{
    static struct rho_message_track_list tracks;
    static struct rho_message_peak_list peaks;
    uint8_t bytes[RHO_MESSAGE_TRACK_LIST_MAX_SIZE + RHO_MESSAGE_PEAK_LIST_MAX_SIZE];
    size_t size;
    uint16_t end;

    (void)state;
    start_default_node();
    send_scan(1, 0, now_us);
    now_us += SECOND_US;
    send_scan(1, 1, now_us);
    assert_string_equal(done, "SS");
    assert_int_equal(rho_node_num_messages(&node), 0); /* nothing was due last */
    assert_int_equal(node.counters.steps, 2);
    assert_int_equal(node.tracker.num_sensors, 1);
    wanted = RHO_MESSAGE_PEAK_LIST_CHANNEL;
    now_us += SECOND_US;
    send_scan(1, 2, now_us);
    assert_int_equal(num_wanted, 1);
    assert_int_equal(rho_message_peak_list_decode(last, last_size, &peaks), RHO_OK);
    assert_int_equal(peaks.scan, 3);
    wanted = RHO_MESSAGE_TRACK_LIST_CHANNEL;
    now_us += SECOND_US;
    send_scan(1, 3, now_us);
    assert_int_equal(rho_message_track_list_decode(last, last_size, &tracks), RHO_OK);
    assert_int_equal(tracks.scan, 4);
    assert_int_equal(tracks.epoch, EPOCH);
    assert_true(tracks.utime == now_us);
    node.done = RHO_NODE_SCAN;
    end = rho_node_num_messages(&node);
    assert_int_equal(end, 2);
    assert_int_equal(rho_node_publish(&node, end, bytes, sizeof bytes, &size), RHO_ERROR_VALUE);
    assert_int_equal(rho_node_publish(&node, 0, bytes, 4, &size), RHO_ERROR_CAPACITY);
    assert_int_equal(rho_node_publish(NULL, 0, bytes, 4, &size), RHO_ERROR_NULL);
}

/* A program that has scans calls the chain, and may ask for its messages, too. */
static void scans_without_messages_take_the_same_chain(void **state)
{
    const struct rho_plot plot = {.x_m = 9e3f, .sigma_range_m = 10.0f, .sigma_cross_m = 10.0f};
    struct rho_scan scan = {.num_plots = 1, .plots = &plot};

    (void)state;
    start_default_node();
    for (int k = 0; k < 5; k++) {
        scan.time_us = k * 10 * SECOND_US;
        assert_int_equal(rho_node_step_scan(&node, &scan), RHO_OK);
        assert_true(node.report.time_us == scan.time_us);
        assert_int_equal(rho_node_num_messages(&node), 2);
        assert_string_equal(rho_node_channel(&node, 1), RHO_MESSAGE_PEAK_LIST_CHANNEL);
        assert_null(rho_node_channel(&node, 2));
    }
    assert_int_equal(node.counters.steps, 5);
    assert_int_equal(rho_node_window(&node, 0)->window.num_scans, 5);
    scan.time_us = INT64_MAX;
    assert_int_not_equal(rho_node_step_scan(&node, &scan), RHO_OK);
    assert_int_equal(node.counters.scans_refused, 1);
    assert_int_equal(node.counters.steps, 5);
    assert_int_equal(rho_node_num_messages(&node), 0);
    scan.time_us = 50 * SECOND_US;
    assert_int_equal(rho_node_step_scan(&node, &scan), RHO_OK);
    const struct rho_bearing_scan look = {.time_us = 60 * SECOND_US};
    assert_int_equal(rho_node_step_bearings(&node, &look), RHO_OK);
    assert_int_equal(rho_node_num_messages(&node), 2);
    assert_int_equal(rho_node_next(&node, 0), RHO_NODE_NOTHING);
    assert_int_equal(rho_node_num_messages(&node), 0);
}

static void the_status_holds_mean_and_longest_step_time(void **state)
{
    struct rho_message_status status;
    struct rho_message_work work;

    (void)state;
    start_default_node();
    send_scan(1, 0, now_us);
    rho_node_count_time(&node, 30);
    rho_node_count_time(&node, 10);
    rho_node_status(&node, &status);
    assert_int_equal(status.scan, 1);
    assert_int_equal(status.epoch, EPOCH);
    assert_int_equal(status.scans_accepted, 1);
    assert_true(status.step_us >= 20.0f && status.step_us <= 20.0f);
    assert_true(status.step_max_us >= 30.0f && status.step_max_us <= 30.0f);
    rho_node_status(&node, &status);
    assert_true(status.step_us <= 0.0f && status.step_max_us <= 0.0f);
    rho_node_work(&node, &work);
    assert_int_equal(work.num_steps, 1);
    assert_int_equal(work.epoch, EPOCH);
    assert_int_equal(work.work_max, node.tracker.config.work_max);
}

static void learned_values_of_sensors_are_sent_in_turn(void **state)
{
    struct rho_message_learned learned = {.sensor_id = 77};

    (void)state;
    start_default_node();
    assert_int_equal(rho_node_learned(&node, &learned), 0);
    assert_int_equal(rho_node_learned(NULL, &learned), 0);
    assert_int_equal(learned.sensor_id, 77);
    for (int32_t sensor = 5; sensor < 8; sensor++) {
        const struct rho_sensor described = {
            .sensor_id = sensor, .pd = 0.8f, .range_max_m = 50000.0f};
        assert_int_equal(rho_tracker_set_sensor(&node.tracker, &described), RHO_OK);
    }
    for (int call = 0; call < 7; call++) {
        assert_int_equal(rho_node_learned(&node, &learned), 1);
        assert_int_equal(learned.sensor_id, 5 + call % 3);
        assert_int_equal(learned.epoch, EPOCH);
        assert_int_equal(learned.scan, node.step);
    }
    assert_int_equal(rho_node_learned(&node, NULL), 0);
}

static void lives_of_tracks_are_sent_in_parts(void **state)
{
    static struct rho_message_life life;
    uint8_t bytes[RHO_MESSAGE_LIFE_MAX_SIZE];
    size_t size = 12345;

    (void)state;
    memset(&node, 0, sizeof node);
    assert_int_equal(rho_node_life(NULL, 0, bytes, sizeof bytes, &size), RHO_ERROR_NULL);
    assert_int_equal(rho_node_life(&node, 0, bytes, sizeof bytes, &size), RHO_ERROR_STATE);
    start_default_node();
    assert_int_equal(rho_node_life(&node, 0, NULL, sizeof bytes, &size), RHO_ERROR_NULL);
    assert_int_equal(rho_node_life(&node, 1, bytes, sizeof bytes, &size), RHO_ERROR_VALUE);
    assert_int_equal(rho_node_life(&node, 0, bytes, 4, &size), RHO_ERROR_CAPACITY);
    assert_int_equal(size, 12345);
    assert_int_equal(rho_node_life(&node, 0, bytes, sizeof bytes, &size), RHO_OK);
    assert_int_equal(rho_message_life_decode(bytes, size, &life), RHO_OK);
    assert_int_equal(life.scan, 0);
    assert_int_equal(life.num_tracks, 0);
    for (int32_t k = 0; k < 8; k++, now_us += SECOND_US) {
        send_scan(1, k, now_us);
    }
    assert_true(node.tracker.num_tracks > 0);
    assert_int_equal(rho_node_life(&node, 0, bytes, sizeof bytes, &size), RHO_OK);
    assert_int_equal(rho_message_life_decode(bytes, size, &life), RHO_OK);
    assert_int_equal(rho_message_life_validate(&life, NULL), RHO_OK);
    assert_int_equal(life.scan, 8);
    assert_int_equal(life.epoch, EPOCH);
    assert_true(life.utime == now_us - SECOND_US);
    assert_int_equal(life.num_tracks, node.tracker.num_tracks);
    assert_int_equal(life.tracks[0].track_id, node.report.tracks[0].track_id);
    assert_true(life.tracks[0].existence > 0.9f);
}

/* Scans without their last part fill the assembler: the oldest is given before its hold time. */
static void a_full_assembler_gives_one_scan_to_make_room(void **state)
{
    (void)state;
    start_default_node();
    for (int16_t sensor = 1; sensor <= RHO_MAX_OPEN_SCANS; sensor++) {
        send_polar(sensor, 0, now_us + sensor, 2, 20000.0f);
    }
    assert_string_equal(done, "");
    assert_true(rho_node_due_us(&node) == now_us + node.assembler.config.hold_us);
    send_polar(RHO_MAX_OPEN_SCANS + 1, 0, now_us + RHO_MAX_OPEN_SCANS + 1, 2, 20000.0f);
    assert_string_equal(done, "S");
    assert_int_equal(node.counters.scans_early, 1);
    now_us += SECOND_US;
    run_until(now_us);
    assert_int_equal(strlen(done), RHO_MAX_OPEN_SCANS + 1);
    assert_int_equal(node.counters.scans_early, 1);
}

/*
 * ---- sensors ----------------------------------------------------------------------------------
 */

static void silent_sensors_make_room_for_others(void **state)
{
    const int64_t step_us = 20 * SECOND_US;

    (void)state;
    start_default_node();
    for (int16_t sensor = 1; sensor <= RHO_MAX_SENSORS; sensor++, now_us += 10) {
        send_scan(sensor, 0, now_us);
    }
    for (int32_t k = 1; k <= 2; k++) {
        now_us += step_us;
        send_scan(1, k, now_us);
    }
    now_us += 10;
    assert_true(2 * step_us > node.assembler.config.jump_max_us);
    assert_int_equal(node.tracker.num_sensors, RHO_MAX_SENSORS);
    assert_int_equal(node.counters.sensors_forgotten, 0);
    send_scan(RHO_MAX_SENSORS + 1, 0, now_us);
    run_until(INT64_MAX);
    assert_int_equal(node.counters.sensors_forgotten, RHO_MAX_SENSORS - 1);
    assert_int_equal(node.tracker.num_sensors, 2);
    assert_int_equal(node.counters.scans_refused, 0);
}

static void a_scan_of_a_sensor_without_room_is_refused(void **state)
{
    struct rho_message_status status;

    (void)state;
    start_default_node();
    for (int16_t sensor = 1; sensor <= RHO_MAX_SENSORS; sensor++) {
        send_scan(sensor, 0, now_us);
        node.assembler.sources[sensor - 1].heard_us = now_us;
    }
    run_until(INT64_MAX);
    done[0] = '\0';
    /* the tracker's table is full of sensors that the assembler hears under other numbers */
    for (int i = 0; i < RHO_MAX_SENSORS; i++) {
        node.assembler.sources[i].sensor_id = (int16_t)node.tracker.sensors[i].sensor.sensor_id;
    }
    node.item = (struct rho_scan_assembler_item){.kind = RHO_SCAN_ASSEMBLER_PLOTS};
    node.item.sensor = node.tracker.sensors[0].sensor;
    node.item.sensor.sensor_id = RHO_MAX_SENSORS + 1;
    node.item.has_sensor = 1;
    node.item.scan.num_plots = 5;
    node.has_item = 1;
    run_until(now_us);
    assert_string_equal(done, "");
    assert_int_equal(node.counters.sensors_refused, 1);
    assert_int_equal(node.counters.scans_refused, 1);
    rho_node_status(&node, &status);
    assert_int_equal(node.counters.plots_refused, 5);
    assert_int_equal(status.plots_in, RHO_MAX_SENSORS + 5);
}

/*
 * ---- restart ----------------------------------------------------------------------------------
 */

/* The sensor's clock goes back by hours, and three of its scans agree on that. */
static void set_clock_back(void)
{
    for (int32_t k = 0; k < 4; k++) {
        now_us += SECOND_US;
        send_scan(1, 1000 + k, (500 + k) * SECOND_US);
    }
}

static void a_restart_keeps_what_is_no_track(void **state)
{
    const struct rho_extent area = {1e3f, 2e3f, 1e3f, 2e3f};
    const struct rho_reflector wall = {-5e4f, 9e4f, 5e4f, 9e4f};
    float looks = 0.0f;

    (void)state;
    start_default_node();
    if (RHO_MAX_ECHOES > 0) {
        assert_int_equal(rho_clutter_map_teach(&node.tracker.clutter_map, 1, 3e3f, 4e3f, 20.0f,
                                               30.0f, RHO_ECHO_KNOWN_HITS),
                         RHO_OK);
        assert_int_equal(rho_clutter_map_teach(&node.tracker.clutter_map, 1, 5e3f, 4e3f, 20.0f,
                                               30.0f, RHO_ECHO_KNOWN_HITS - 1),
                         RHO_OK);
        assert_int_equal(
            rho_clutter_map_teach_returns(&node.tracker.clutter_map, 0, 6, 1, 5.0f, 2.0f), RHO_OK);
    }
    assert_int_equal(rho_tracker_exclude_area(&node.tracker, &area), RHO_OK);
    assert_int_equal(rho_tracker_set_reflectors(&node.tracker, &wall, 1), RHO_OK);
    for (int32_t k = 0; k < 8; k++, now_us += SECOND_US) {
        send_scan(1, k, now_us);
    }
    assert_true(node.tracker.num_tracks > 0);
    const uint32_t started = node.tracker.counters.tracks_started;
    set_clock_back();
    assert_string_equal(done, "SSSSSSSSRSS");
    assert_int_equal(node.counters.restarts, 1);
    assert_int_equal(node.epoch, EPOCH + 1);
    assert_int_equal(node.tracker.num_tracks, 0);
    assert_int_equal(rho_node_window(&node, 0)->window.num_scans, 2);
    assert_int_equal(node.tracker.counters.tracks_started, started);
    assert_int_equal(node.tracker.num_excluded, 1);
    assert_memory_equal(&node.tracker.excluded[0], &area, sizeof area);
    assert_int_equal(node.tracker.num_reflectors, 1);
    if (RHO_MAX_ECHOES > 0) {
        uint32_t place = 0;
        const struct rho_echo *echo = rho_clutter_map_next_known(&node.tracker.clutter_map, &place);

        assert_non_null(echo);
        assert_true(echo->x_m >= 3e3f && echo->x_m <= 3e3f);
        assert_true(echo->along[0] >= 399.9f && echo->along[0] <= 400.1f);
        assert_null(rho_clutter_map_next_known(&node.tracker.clutter_map, &place));
        rho_clutter_map_learned_looks_and_returns(&node.tracker.clutter_map, 0, 6, 1, &looks, NULL);
        assert_true(looks >= 4.0f && looks <= 5.1f);
    }
    assert_int_equal(rho_tracker_is_sound(&node.tracker), 1);
}

static void zones_count_on_over_a_restart(void **state)
{
    const struct rho_zone zone = {.zone_id = 5,
                                  .num_corners = 4,
                                  .x_m = {2e4f, 3e4f, 3e4f, 2e4f},
                                  .y_m = {-1e4f, -1e4f, 1e4f, 1e4f}};
    struct rho_message_zone_event_list list;

    (void)state;
    if (RHO_MAX_ZONES == 0) {
        return;
    }
    start_default_node();
    wanted = RHO_MESSAGE_ZONE_EVENT_LIST_CHANNEL;
    assert_int_equal(rho_node_add_zone(&node, &zone), RHO_OK);
    for (int32_t k = 0; k < 10; k++, now_us += SECOND_US) {
        send_scan(1, k, now_us);
    }
    assert_int_equal(num_wanted, 1);
    assert_int_equal(rho_message_zone_event_list_decode(last, last_size, &list), RHO_OK);
    assert_int_equal(list.num_events, 1);
    assert_int_equal(list.events[0].zone_id, 5);
    assert_int_equal(list.epoch, EPOCH);
    assert_int_equal(node.zones.counts[0].entered, 1);
    set_clock_back();
    assert_int_equal(node.counters.restarts, 1);
    assert_int_equal(node.zones.counts[0].entered, 1);
    assert_int_equal(node.zones.counts[0].ended, 1);
}

/*
 * ---- bearings ---------------------------------------------------------------------------------
 */

/* Sensors of directions and of bearings share rows; noise that is not stated is the setting. */
static void directions_are_stepped_beside_bearings(void **state)
{
    (void)state;
    start_default_node();
    node.assembler.config.gives_other = 1;
    for (int32_t k = 0; k < 3; k++, now_us += SECOND_US) {
        send_bearing(1, 0.0f, k, now_us);
        send_direction(2, 20000.0f, k, now_us);
    }
    run_until(INT64_MAX);
    assert_string_equal(done, "BBBBBB");
    assert_int_equal(node.counters.bearings_refused, 0);
    assert_int_equal(node.tracker.num_sensors, 2);
#if RHO_SEARCHES
    const struct rho_batch *batch = &node.passive.batch;
    assert_int_equal(batch->num_scans, 3);
    assert_int_equal(batch->num_sensors, 2);
    for (unsigned k = 0; k < 3; k++) {
        assert_int_equal(batch->num_bearings[k][0], 1);
        assert_int_equal(batch->num_bearings[k][1], 1);
        assert_true(batch->looks[k][0].z_m == 0.0f && batch->looks[k][1].z_m == 50.0f);
        assert_true(batch->bearings[k][0][0].sigma_slope == 0.0f);
        assert_true(batch->bearings[k][1][0].sigma_slope > 0.0f);
    }
#endif
}

/* Bearings and plots of one time are stepped as they come, and wait for no frame. */
static void bearings_and_plots_are_stepped_in_the_order_of_time(void **state)
{
    (void)state;
    start_default_node();
    node.assembler.config.hold_us = 0;
    send_bearing(1, 0.0f, 0, now_us);
    assert_string_equal(done, "B");
    for (int32_t scan = 0; scan < 3; scan++) {
        send_scan(5, scan, now_us + 10 + 10 * scan);
    }
    send_bearing(1, 0.0f, 1, now_us + 100);
    assert_string_equal(done, "BSSSB");
}

/* A scan of a sensor is taken wherever it stands, and nothing begins anew. */
static void a_moving_passive_sensor_is_heard_from_everywhere(void **state)
{
    (void)state;
    start_default_node();
    for (int32_t k = 0; k < 21; k++, now_us += SECOND_US) {
        const float y_m = k < 4 ? 0.0f : 500.0f * (float)k;
        send_bearing(1, y_m, k, now_us);
        send_bearing(2, y_m, k, now_us); /* both at one place */
    }
    run_until(INT64_MAX);
    assert_int_equal(node.counters.steps, 42);
    assert_int_equal(node.counters.bearings_refused, 0);
    assert_int_equal(node.counters.restarts, 0);
}

static void passive_sensors_have_the_range_of_the_initiation(void **state)
{
    struct rho_node_config config = default_config();

    (void)state;
    config.passive_range_max_m = 90000.0f;
    config.assembler.gives_other = 1;
    config.assembler.other.sensor.range_max_m = 2.0f * RHO_LIMIT_POSITION_M;
    start_node(&config);
    send_bearing(1, 0.0f, 0, now_us);
    assert_int_equal(node.tracker.num_sensors, 1);
    assert_true(node.tracker.sensors[0].sensor.range_max_m <= 90000.0f);
}

/* Sensors farther apart than the paper's cells reach are refused by its method alone. */
static void passive_sensors_far_apart_are_refused_by_the_papers_method(void **state)
{
    (void)state;
    for (uint8_t is_by_paper = 0; is_by_paper <= RHO_PAPERS; is_by_paper++) {
        struct rho_node_config config = default_config();
        float far_m = RHO_LIMIT_POSITION_M;

        config.options.is_bearings_by_paper = is_by_paper;
        start_node(&config);
#if RHO_PAPERS
        far_m = is_by_paper ? node.passive_paper.batch.apart_max_m : far_m;
#endif
        for (int32_t scan = 0; scan < 3; scan++) {
            send_bearing(1, -10000.0f, scan, now_us + 10000000 * scan);
            send_bearing(2, 10000.0f, scan, now_us + 10000000 * scan);
            send_bearing(3, far_m, scan, now_us + 10000000 * scan);
            run_until(INT64_MAX);
        }
        assert_string_equal(done, "BBBBBBBBB");
        assert_int_equal(node.counters.bearings_refused, is_by_paper ? 3 : 0);
    }
}

/* The papers' methods start tracks from plots and bearings in the same chain. */
static void the_papers_methods_start_tracks(void **state)
{
    struct rho_node_config config = default_config();

    (void)state;
    config.options.is_plots_by_paper = 1;
    if (!RHO_PAPERS) {
        return;
    }
    start_node(&config);
    for (int32_t k = 0; k < 6; k++, now_us += 2 * SECOND_US) {
        send_polar(1, k, now_us, 1, 20000.0f + 600.0f * (float)k);
    }
    assert_true(node.tracker.num_tracks > 0);
    assert_int_equal(rho_node_window(&node, 0)->window.num_scans, 0);
    assert_int_equal(
        node.report.fates_total[RHO_FATE_CLAIMED] + node.report.fates_total[RHO_FATE_HELD], 1);
}

/* A step whose plots the papers' method refuses was made: its report is published. */
static void a_refusal_by_the_papers_method_leaves_the_step(void **state)
{
    struct rho_node_config config = default_config();

    (void)state;
    config.options.is_plots_by_paper = RHO_PAPERS != 0;
    start_node(&config);
#if RHO_PAPERS
    node.paper_starts.magic = 0;
#endif
    wanted = RHO_MESSAGE_TRACK_LIST_CHANNEL;
    send_scan(1, 0, now_us);
    now_us += SECOND_US;
    send_scan(1, 1, now_us);
    run_until(INT64_MAX);
    assert_string_equal(done, "SS");
    assert_int_equal(num_wanted, 2);
    assert_int_equal(node.counters.steps, 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrong_calls_are_refused),
        cmocka_unit_test(configurations_that_no_part_takes_are_refused),
        cmocka_unit_test(a_node_with_refused_bearings_is_not_used),
        cmocka_unit_test(refused_configurations_leave_tracker_and_windows),
        cmocka_unit_test(settings_reach_tracker_initiator_and_sensors),
        cmocka_unit_test(descriptions_follow_the_settings_that_they_equal),
        cmocka_unit_test(settings_that_contradict_other_sensors_are_refused),
        cmocka_unit_test(scans_are_stepped_and_published),
        cmocka_unit_test(scans_without_messages_take_the_same_chain),
        cmocka_unit_test(the_status_holds_mean_and_longest_step_time),
        cmocka_unit_test(learned_values_of_sensors_are_sent_in_turn),
        cmocka_unit_test(lives_of_tracks_are_sent_in_parts),
        cmocka_unit_test(a_full_assembler_gives_one_scan_to_make_room),
        cmocka_unit_test(silent_sensors_make_room_for_others),
        cmocka_unit_test(a_scan_of_a_sensor_without_room_is_refused),
        cmocka_unit_test(a_restart_keeps_what_is_no_track),
        cmocka_unit_test(zones_count_on_over_a_restart),
        cmocka_unit_test(directions_are_stepped_beside_bearings),
        cmocka_unit_test(bearings_and_plots_are_stepped_in_the_order_of_time),
        cmocka_unit_test(a_moving_passive_sensor_is_heard_from_everywhere),
        cmocka_unit_test(passive_sensors_have_the_range_of_the_initiation),
        cmocka_unit_test(passive_sensors_far_apart_are_refused_by_the_papers_method),
        cmocka_unit_test(the_papers_methods_start_tracks),
        cmocka_unit_test(a_refusal_by_the_papers_method_leaves_the_step),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
