/* SPDX-License-Identifier: MIT */
/*
 * The node: messages in, steps in order of time, messages out; sensors that it describes and
 * forgets.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/node.h"

#define SECOND_US INT64_C(1000000)
#define EPOCH 7
#define WAITING 2

static struct rho_scan_assembler assembler;
static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_frames frames;
static struct rho_passive passive;
static struct rho_report report;
static struct rho_node_waiting waiting[WAITING];
static struct rho_node node;
static int64_t now_us;

/* The node's due work in order: S scan, F frame, R restart. */
static char done[4096];

static struct rho_node_config node_config_of(uint16_t waiting_max)
{
    return (struct rho_node_config){.assembler = &assembler,
                                    .tracker = &tracker,
                                    .report = &report,
                                    .frames = &frames,
                                    .passive = &passive,
                                    .waiting = waiting_max > 0 ? waiting : NULL,
                                    .waiting_max = waiting_max,
                                    .epoch = EPOCH};
}

static void init_tracker_and_initiator(void)
{
    struct rho_tracker_config config;
    struct rho_initiator_config start;

    rho_tracker_config_default(&config);
    rho_initiator_config_default(&start);
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, &start), RHO_OK);
}

static void init_assembler(void)
{
    struct rho_scan_assembler_config config;

    rho_scan_assembler_config_default(&config);
    assert_int_equal(rho_scan_assembler_init(&assembler, sizeof assembler, &config), RHO_OK);
}

static void init_all_objects(void)
{
    struct rho_frames_config gather;
    struct rho_passive_config search;

    rho_frames_config_default(&gather);
    rho_passive_config_default(&search);
    init_assembler();
    init_tracker_and_initiator();
    memset(&report, 0, sizeof report);
    assert_int_equal(rho_frames_init(&frames, sizeof frames, &gather), RHO_OK);
    assert_int_equal(rho_passive_init(&passive, sizeof passive, &search), RHO_OK);
    now_us = 1000 * SECOND_US;
    done[0] = '\0';
}

static void start_node(uint16_t waiting_max)
{
    const struct rho_node_config config = node_config_of(waiting_max);

    init_all_objects();
    assert_int_equal(rho_node_init(&node, sizeof node, &config), RHO_OK);
}

static void run_due_work_until(int64_t until_us)
{
    enum rho_node_due due;

    while ((due = rho_node_next(&node, until_us)) != RHO_NODE_NOTHING) {
        size_t length = strlen(done);

        assert_true(length + 1 < sizeof done);
        done[length] = "-SFR"[due];
        done[length + 1] = '\0';
        if (due == RHO_NODE_RESTART) {
            init_tracker_and_initiator();
            node.epoch++;
        } else {
            assert_int_equal(rho_node_step(&node, &initiator), RHO_OK);
        }
    }
}

static void take_message(const char *prefix, int sensor_id, const uint8_t *data, size_t size)
{
    char channel[40];

    snprintf(channel, sizeof channel, "%s%d", prefix, sensor_id);
    while (rho_node_take(&node, channel, data, size, now_us) == RHO_ERROR_CAPACITY) {
        run_due_work_until(now_us);
    }
    run_due_work_until(now_us);
}

/* Sends a radar's polar scan with one plot; scan numbers are seconds. */
static void send_first_part_of_polar_scan(int16_t sensor_id, int32_t scan, int64_t time_us,
                                          int16_t num_parts)
{
    static struct rho_message_polar_scan message;
    uint8_t bytes[RHO_MESSAGE_POLAR_SCAN_MAX_SIZE];
    size_t size;

    message = (struct rho_message_polar_scan){.utime = time_us,
                                              .scan = scan,
                                              .sensor_id = sensor_id,
                                              .sensor_x_m = 1000.0f * sensor_id,
                                              .num_parts = num_parts,
                                              .num_polar_plots = 1};
    message.polar_plots[0].range_m = 20000.0f + 100.0f * (float)scan;
    assert_int_equal(rho_message_polar_scan_encode(&message, bytes, sizeof bytes, &size), RHO_OK);
    take_message(RHO_MESSAGE_POLAR_SCAN_CHANNEL, sensor_id, bytes, size);
}

static void send_bearing(int16_t sensor_id, float y_m, int32_t scan, int64_t time_us)
{
    static struct rho_message_bearing_scan message;
    uint8_t bytes[RHO_MESSAGE_BEARING_SCAN_MAX_SIZE];
    size_t size;

    message = (struct rho_message_bearing_scan){.utime = time_us,
                                                .scan = scan,
                                                .sensor_id = sensor_id,
                                                .sensor_y_m = y_m,
                                                .num_bearings = 1};
    message.bearing_rad[0] = atan2f(200.0f * (float)scan - y_m, 30000.0f);
    assert_int_equal(rho_message_bearing_scan_encode(&message, bytes, sizeof bytes, &size), RHO_OK);
    take_message(RHO_MESSAGE_BEARING_SCAN_CHANNEL, sensor_id, bytes, size);
}

/*
 * ---- start ------------------------------------------------------------------------------------
 */

static void missing_parts_of_a_node_are_refused(void **state)
{
    struct rho_node_config config = node_config_of(WAITING);

    (void)state;
    memset(&node, 0, sizeof node);
    init_all_objects();
    assert_int_equal(rho_node_take(&node, "RHO_PLOTS_1", (const uint8_t *)"", 0, 0),
                     RHO_ERROR_STATE);
    assert_int_equal(rho_node_take(NULL, "RHO_PLOTS_1", (const uint8_t *)"", 0, 0), RHO_ERROR_NULL);
    assert_int_equal(rho_node_next(&node, 0), RHO_NODE_NOTHING);
    assert_int_equal(rho_node_num_messages(&node), 0);
    assert_true(rho_node_due_us(&node) == INT64_MAX);
    assert_int_equal(rho_node_init(NULL, sizeof node, &config), RHO_ERROR_NULL);
    assert_int_equal(rho_node_init(&node, sizeof node, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_node_init(&node, sizeof node - 1, &config), RHO_ERROR_SIZE);
    config.passive_range_max_m = NAN;
    assert_int_equal(rho_node_init(&node, sizeof node, &config), RHO_ERROR_CONFIG);
    config = node_config_of(WAITING);
    config.frames = NULL; /* refused: a search of bearings without frames */
    assert_int_equal(rho_node_init(&node, sizeof node, &config), RHO_ERROR_NULL);
    config = node_config_of(WAITING);
    /* refused: the caller searches the bearings (no passive), but apart_max_m is not set */
    config.passive = NULL;
    assert_int_equal(rho_node_init(&node, sizeof node, &config), RHO_ERROR_CONFIG);
    config = node_config_of(WAITING);
    config.waiting = NULL;
    assert_int_equal(rho_node_init(&node, sizeof node, &config), RHO_ERROR_NULL);
    config = node_config_of(WAITING);
    config.report = NULL;
    assert_int_equal(rho_node_init(&node, sizeof node, &config), RHO_ERROR_NULL);
    config = node_config_of(WAITING);
    memset(&frames, 0, sizeof frames);
    assert_int_equal(rho_node_init(&node, sizeof node, &config), RHO_ERROR_STATE);
    assert_int_equal(rho_node_step(NULL, &initiator), RHO_ERROR_NULL);
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
    uint16_t last;

    (void)state;
    start_node(WAITING);
    assert_int_equal(rho_node_step(&node, &initiator), RHO_ERROR_STATE);
    for (int32_t k = 0; k < 3; k++, now_us += SECOND_US) {
        send_first_part_of_polar_scan(1, k, now_us, 1);
    }
    assert_string_equal(done, "SSS");
    assert_int_equal(node.counters.steps, 3);
    assert_int_equal(tracker.num_sensors, 1);
    last = (uint16_t)(rho_node_num_messages(&node) - 1);
    assert_int_equal(last, 1);
    assert_string_equal(rho_node_channel(&node, 0), RHO_MESSAGE_TRACK_LIST_CHANNEL);
    assert_string_equal(rho_node_channel(&node, last), RHO_MESSAGE_PEAK_LIST_CHANNEL);
    assert_int_equal(rho_node_publish(&node, &initiator, 0, bytes, sizeof bytes, &size), RHO_OK);
    assert_int_equal(rho_message_track_list_decode(bytes, size, &tracks), RHO_OK);
    assert_int_equal(tracks.scan, 3);
    assert_int_equal(tracks.epoch, EPOCH);
    assert_true(tracks.utime == now_us - SECOND_US);
    assert_int_equal(rho_node_publish(&node, &initiator, last, bytes, sizeof bytes, &size), RHO_OK);
    assert_int_equal(rho_message_peak_list_decode(bytes, size, &peaks), RHO_OK);
    assert_int_equal(peaks.scan, 3);
    assert_int_equal(
        rho_node_publish(&node, &initiator, (uint16_t)(last + 1), bytes, sizeof bytes, &size),
        RHO_ERROR_VALUE);
    assert_int_equal(rho_node_publish(&node, &initiator, 0, bytes, 4, &size), RHO_ERROR_CAPACITY);
    assert_int_equal(rho_node_publish(NULL, &initiator, 0, bytes, 4, &size), RHO_ERROR_NULL);
}

static void the_status_holds_mean_and_longest_step_time(void **state)
{
    struct rho_message_status status;
    struct rho_message_work work;

    (void)state;
    start_node(WAITING);
    send_first_part_of_polar_scan(1, 0, now_us, 1);
    rho_node_count_time(&node, 30);
    rho_node_count_time(&node, 10);
    rho_node_status(&node, &initiator, &status);
    assert_int_equal(status.scan, 1);
    assert_int_equal(status.epoch, EPOCH);
    assert_int_equal(status.scans_accepted, 1);
    assert_true(status.step_us >= 20.0f && status.step_us <= 20.0f);
    assert_true(status.step_max_us >= 30.0f && status.step_max_us <= 30.0f);
    rho_node_status(&node, &initiator, &status);
    assert_true(status.step_us <= 0.0f && status.step_max_us <= 0.0f);
    rho_node_work(&node, &work);
    assert_int_equal(work.num_steps, 1);
    assert_int_equal(work.epoch, EPOCH);
    assert_int_equal(work.work_max, tracker.config.work_max);
}

static void learned_values_of_sensors_are_sent_in_turn(void **state)
{
    struct rho_message_learned learned = {.sensor_id = 77};

    (void)state;
    start_node(WAITING);
    assert_int_equal(rho_node_learned(&node, &learned), 0);
    assert_int_equal(rho_node_learned(NULL, &learned), 0);
    assert_int_equal(learned.sensor_id, 77);
    for (int32_t sensor = 5; sensor < 8; sensor++) {
        const struct rho_sensor described = {
            .sensor_id = sensor, .pd = 0.8f, .range_max_m = 50000.0f};
        assert_int_equal(rho_tracker_set_sensor(&tracker, &described), RHO_OK);
    }
    for (int call = 0; call < 7; call++) {
        assert_int_equal(rho_node_learned(&node, &learned), 1);
        assert_int_equal(learned.sensor_id, 5 + call % 3);
        assert_int_equal(learned.epoch, EPOCH);
        assert_int_equal(learned.scan, node.step);
    }
    assert_int_equal(rho_node_learned(&node, NULL), 0);
}

/* Scans without their last part fill the assembler: the oldest is given before its hold time. */
static void a_full_assembler_gives_one_scan_to_make_room(void **state)
{
    (void)state;
    start_node(WAITING);
    for (int16_t sensor = 1; sensor <= RHO_MAX_OPEN_SCANS; sensor++) {
        send_first_part_of_polar_scan(sensor, 0, now_us + sensor, 2);
    }
    assert_string_equal(done, "");
    assert_true(rho_node_due_us(&node) == now_us + assembler.config.hold_us);
    send_first_part_of_polar_scan(RHO_MAX_OPEN_SCANS + 1, 0, now_us + RHO_MAX_OPEN_SCANS + 1, 2);
    assert_string_equal(done, "S");
    assert_int_equal(node.counters.scans_early, 1);
    now_us += SECOND_US;
    run_due_work_until(now_us);
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
    start_node(WAITING);
    for (int16_t sensor = 1; sensor <= RHO_MAX_SENSORS; sensor++, now_us += 10) {
        send_first_part_of_polar_scan(sensor, 0, now_us, 1);
    }
    for (int32_t k = 1; k <= 2; k++) {
        now_us += step_us;
        send_first_part_of_polar_scan(1, k, now_us, 1);
    }
    now_us += 10;
    assert_true(2 * step_us > assembler.config.jump_max_us);
    assert_int_equal(tracker.num_sensors, RHO_MAX_SENSORS);
    assert_int_equal(node.counters.sensors_forgotten, 0);
    send_first_part_of_polar_scan(RHO_MAX_SENSORS + 1, 0, now_us, 1);
    run_due_work_until(INT64_MAX);
    assert_int_equal(node.counters.sensors_forgotten, RHO_MAX_SENSORS - 1);
    assert_int_equal(tracker.num_sensors, 2);
    assert_int_equal(node.counters.scans_refused, 0);
}

static void a_scan_of_a_sensor_without_room_is_refused(void **state)
{
    struct rho_message_status status;

    (void)state;
    start_node(WAITING);
    for (int16_t sensor = 1; sensor <= RHO_MAX_SENSORS; sensor++) {
        send_first_part_of_polar_scan(sensor, 0, now_us, 1);
        assembler.sources[sensor - 1].heard_us = now_us;
    }
    run_due_work_until(INT64_MAX);
    done[0] = '\0';
    /* the tracker's table is full of sensors that the assembler hears under other numbers */
    for (int i = 0; i < RHO_MAX_SENSORS; i++) {
        assembler.sources[i].sensor_id = (int16_t)tracker.sensors[i].sensor.sensor_id;
    }
    node.item = (struct rho_scan_assembler_item){.kind = RHO_SCAN_ASSEMBLER_PLOTS};
    node.item.sensor = tracker.sensors[0].sensor;
    node.item.sensor.sensor_id = RHO_MAX_SENSORS + 1;
    node.item.has_sensor = 1;
    node.item.scan.num_plots = 5;
    node.has_item = 1;
    run_due_work_until(now_us);
    assert_string_equal(done, "");
    assert_int_equal(node.counters.sensors_refused, 1);
    assert_int_equal(node.counters.scans_refused, 1);
    rho_node_status(&node, &initiator, &status);
    assert_int_equal(node.counters.plots_refused, 5);
    assert_int_equal(status.plots_in, RHO_MAX_SENSORS + 5);
}

static void scans_older_than_a_loaded_snapshot_restart_the_node(void **state)
{
    const struct rho_node_config config = node_config_of(WAITING);

    (void)state;
    start_node(WAITING);
    send_first_part_of_polar_scan(1, 0, now_us, 1);
    for (int is_older = 0; is_older < 2; is_older++) {
        init_assembler();
        assert_int_equal(rho_node_init(&node, sizeof node, &config), RHO_OK);
        node.is_restored = 1;
        done[0] = '\0';
        now_us -= is_older ? assembler.config.jump_max_us + 2 * SECOND_US : -SECOND_US;
        send_first_part_of_polar_scan(1, 0, now_us, 1);
        assert_string_equal(done, is_older ? "RS" : "S");
        assert_int_equal(node.counters.restarts, is_older);
        assert_int_equal(node.epoch, EPOCH + is_older);
    }
}

/*
 * ---- bearings ---------------------------------------------------------------------------------
 */

static void frames_close_at_the_next_frame_or_by_timeout(void **state)
{
    (void)state;
    start_node(WAITING);
    assembler.config.gives_other = 1;
    for (int32_t k = 0; k < 2; k++, now_us += SECOND_US) {
        send_bearing(1, 0.0f, k, now_us);
        send_bearing(2, 20000.0f, k, now_us);
    }
    run_due_work_until(now_us - SECOND_US + 2 * assembler.config.hold_us);
    done[0] = '\0';
    send_bearing(1, 0.0f, 2, now_us);
    run_due_work_until(now_us + assembler.config.hold_us);
    assert_string_equal(done, "");
    assert_true(rho_node_due_us(&node) > now_us && rho_node_due_us(&node) < now_us + SECOND_US);
    run_due_work_until(rho_node_due_us(&node));
    assert_string_equal(done, "F");
    assert_int_equal(tracker.num_sensors, 2);
    assert_int_equal(rho_node_num_messages(&node), 2);
}

static void scans_wait_for_an_open_frame_of_bearings(void **state)
{
    for (uint16_t room = 0; room <= WAITING; room += WAITING) {
        (void)state;
        start_node(room);
        assembler.config.hold_us = 0;
        send_bearing(1, 0.0f, 0, now_us);
        send_first_part_of_polar_scan(5, 0, now_us + 10, 1);
        assert_string_equal(done, room > 0 ? "" : "FS");
        send_first_part_of_polar_scan(5, 1, now_us + 20, 1);
        assert_string_equal(done, "FSS");
        send_first_part_of_polar_scan(5, 2, now_us + 30, 1);
        run_due_work_until(INT64_MAX);
        assert_string_equal(done, "FSSS");
    }
}

static void a_moved_passive_sensor_is_accepted_after_a_while(void **state)
{
    (void)state;
    start_node(WAITING);
    for (int32_t k = 0; k < 4; k++, now_us += SECOND_US) {
        send_bearing(1, 0.0f, k, now_us);
    }
    for (int32_t k = 4; k < 21; k++, now_us += SECOND_US) {
        send_bearing(1, 500.0f, k, now_us);
    }
    assert_int_equal(node.counters.bearings_refused, 16);
    assert_int_equal(frames.num_sensors, 1);
    assert_true(frames.sensors[0].y_m > 400.0f);
    assert_int_equal(node.counters.restarts, 0);
}

static void passive_sensors_have_the_range_of_the_initiation(void **state)
{
    (void)state;
    start_node(WAITING);
    assembler.config.gives_other = 1;
    node.config.passive_range_max_m = 90000.0f;
    send_bearing(1, 0.0f, 0, now_us);
    assert_int_equal(tracker.num_sensors, 1);
    assert_true(tracker.sensors[0].sensor.range_max_m <= 90000.0f);
}

static void a_node_without_frames_refuses_bearings(void **state)
{
    struct rho_node_config config = node_config_of(0);

    (void)state;
    init_all_objects();
    config.frames = NULL;
    config.passive = NULL;
    assert_int_equal(rho_node_init(&node, sizeof node, &config), RHO_OK);
    send_bearing(1, 0.0f, 0, now_us);
    send_first_part_of_polar_scan(5, 0, now_us + 10, 1);
    run_due_work_until(INT64_MAX);
    assert_string_equal(done, "S");
    assert_int_equal(node.counters.bearings_refused, 1);
}

/* Frames are stepped and start no tracks; a sensor too far from the others is refused. */
static void frames_are_stepped_for_a_caller_with_its_own_search(void **state)
{
    struct rho_node_config config = node_config_of(0);

    (void)state;
    init_all_objects();
    config.passive = NULL;
    config.apart_max_m = 30000.0f;
    assert_int_equal(rho_node_init(&node, sizeof node, &config), RHO_OK);
    for (int32_t scan = 0; scan < 3; scan++) {
        send_bearing(1, -10000.0f, scan, now_us + 10000000 * scan);
        send_bearing(2, 10000.0f, scan, now_us + 10000000 * scan);
        send_bearing(3, 40000.0f, scan, now_us + 10000000 * scan);
        run_due_work_until(INT64_MAX);
    }
    assert_string_equal(done, "FFF");
    assert_int_equal(tracker.num_tracks, 0);
    assert_int_equal(node.counters.bearings_refused, 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(missing_parts_of_a_node_are_refused),
        cmocka_unit_test(frames_are_stepped_for_a_caller_with_its_own_search),
        cmocka_unit_test(scans_are_stepped_and_published),
        cmocka_unit_test(the_status_holds_mean_and_longest_step_time),
        cmocka_unit_test(learned_values_of_sensors_are_sent_in_turn),
        cmocka_unit_test(a_full_assembler_gives_one_scan_to_make_room),
        cmocka_unit_test(silent_sensors_make_room_for_others),
        cmocka_unit_test(a_scan_of_a_sensor_without_room_is_refused),
        cmocka_unit_test(scans_older_than_a_loaded_snapshot_restart_the_node),
        cmocka_unit_test(frames_close_at_the_next_frame_or_by_timeout),
        cmocka_unit_test(scans_wait_for_an_open_frame_of_bearings),
        cmocka_unit_test(a_moved_passive_sensor_is_accepted_after_a_while),
        cmocka_unit_test(passive_sensors_have_the_range_of_the_initiation),
        cmocka_unit_test(a_node_without_frames_refuses_bearings),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
