/* SPDX-License-Identifier: MIT */
/*
 * The live tracker without its network: sensors that have fallen silent or moved do not keep others
 * out forever.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "live/node_core.h"
#include "rhotrack/message.h"

#define SECOND_US INT64_C(1000000)
#define START_US INT64_C(1790000000000000) /* microseconds since 1970, in 2026 */

struct heard {
    unsigned lists, tracks; /* tracks in the last list */
    struct rho_message_setting_answer answer;
    struct rho_message_status status;
    struct rho_message_work work;
};

static void keep_sent_message(void *context, const char *channel, const uint8_t *data, size_t size)
{
    static struct rho_message_track_list list;
    struct heard *heard = context;

    if (strcmp(channel, RHO_MESSAGE_TRACK_LIST_CHANNEL) == 0) {
        assert_int_equal(rho_message_track_list_decode(data, size, &list), RHO_OK);
        assert_int_equal(rho_message_track_list_validate(&list, NULL), RHO_OK);
        heard->lists++;
        heard->tracks = (unsigned)list.num_tracks_total;
    } else if (strcmp(channel, RHO_MESSAGE_STATUS_CHANNEL) == 0) {
        assert_int_equal(rho_message_status_decode(data, size, &heard->status), RHO_OK);
        assert_int_equal(rho_message_status_validate(&heard->status, NULL), RHO_OK);
    } else if (strcmp(channel, RHO_MESSAGE_SETTING_ANSWER_CHANNEL) == 0) {
        assert_int_equal(rho_message_setting_answer_decode(data, size, &heard->answer), RHO_OK);
    } else if (strcmp(channel, RHO_MESSAGE_WORK_CHANNEL) == 0) {
        assert_int_equal(rho_message_work_decode(data, size, &heard->work), RHO_OK);
        assert_int_equal(rho_message_work_validate(&heard->work, NULL), RHO_OK);
    }
}

struct live {
    struct parameters parameters;
    struct heard heard;
    struct node_core *core;
};

static void open_node_core(struct live *live)
{
    const struct node_core_events events = {.context = &live->heard, .send = keep_sent_message};

    *live = (struct live){.core = NULL};
    parameters_set_defaults(&live->parameters);
    live->core = node_core_open(&live->parameters, 1, &events);
}

/*
 * Takes the k-th bearing scan of a sensor that sees a target flying north at 200 m/s, 30 km east.
 */
static void take_bearing_scan(struct live *live, int16_t sensor_id, float x_m, float y_m, int32_t k)
{
    static struct rho_message_bearing_scan scan;
    uint8_t buffer[RHO_MESSAGE_BEARING_SCAN_MAX_SIZE];
    char channel[32];
    size_t size;

    scan = (struct rho_message_bearing_scan){.utime = START_US + k * SECOND_US,
                                             .scan = k,
                                             .sensor_id = sensor_id,
                                             .sensor_x_m = x_m,
                                             .sensor_y_m = y_m,
                                             .num_bearings = 1};
    scan.bearing_rad[0] = atan2f(200.0f * (float)k - y_m, 30000.0f - x_m);
    assert_int_equal(rho_message_bearing_scan_encode(&scan, buffer, sizeof buffer, &size), RHO_OK);
    snprintf(channel, sizeof channel, "%s%d", RHO_MESSAGE_BEARING_SCAN_CHANNEL, sensor_id);
    node_core_take_message(live->core, channel, buffer, size, START_US + k * SECOND_US);
}

static void passive_sensors_that_fell_silent_make_room(void **state)
{
    struct live live;

    (void)state;
    open_node_core(&live);
    for (int16_t i = 0; i < RHO_MAX_PASSIVE_SENSORS; i++) {
        take_bearing_scan(&live, (int16_t)(100 + i), 1000.0f * (float)i, 5000.0f, 0);
    }
    for (int32_t k = 1; k < 90; k++) {
        take_bearing_scan(&live, 1, 0.0f, -10000.0f, k);
        take_bearing_scan(&live, 2, 0.0f, 10000.0f, k);
    }
    /* silent sensors keep their place for a minute */
    assert_in_range(node_core_node_counters(live.core)->bearings_refused, 110, 122);
    assert_int_equal(node_core_node_counters(live.core)->restarts, 0);
    assert_int_equal(live.heard.tracks, 1);
    node_core_close(live.core);
}

static void passive_sensors_that_are_heard_keep_their_room(void **state)
{
    struct live live;

    (void)state;
    open_node_core(&live);
    for (int32_t k = 0; k < 90; k++) {
        for (int16_t i = 0; i < RHO_MAX_PASSIVE_SENSORS; i++) {
            take_bearing_scan(&live, i, 0.0f, -15000.0f + 10000.0f * (float)i, k);
        }
        if (k > 20 && k % 4 == 0) { /* one sensor too many, heard at every fourth scan only */
            take_bearing_scan(&live, 50, 3000.0f, 3000.0f, k);
        }
    }
    assert_true(node_core_node_counters(live.core)->bearings_refused > 10);
    assert_int_equal(live.heard.tracks, 1);
    node_core_close(live.core);
}

static void a_wrong_place_of_a_passive_sensor_keeps_no_scan_out(void **state)
{
    struct live live;

    (void)state;
    open_node_core(&live);
    take_bearing_scan(&live, 1, 7000.0f, 0.0f, 0); /* a mistake, or a forged message */
    for (int32_t k = 1; k < 60; k++) {
        take_bearing_scan(&live, 1, 0.0f, -10000.0f, k);
        take_bearing_scan(&live, 2, 0.0f, 10000.0f, k);
    }
    assert_int_equal(node_core_node_counters(live.core)->bearings_refused, 0);
    assert_int_equal(node_core_node_counters(live.core)->restarts, 0);
    assert_int_equal(live.heard.tracks, 1);
    node_core_close(live.core);
}

/* Two sensors jump together, and drive on: the one track lasts. */
static void passive_sensors_that_move_keep_their_track(void **state)
{
    struct live live;

    (void)state;
    open_node_core(&live);
    for (int32_t k = 0; k < 80; k++) {
        const float x_m = k < 20 ? 7000.0f : 10.0f * (float)k;
        take_bearing_scan(&live, 1, x_m, -10000.0f, k);
        take_bearing_scan(&live, 2, x_m, 10000.0f, k);
    }
    assert_int_equal(node_core_node_counters(live.core)->bearings_refused, 0);
    assert_int_equal(node_core_node_counters(live.core)->restarts, 0);
    assert_int_equal(live.heard.tracks, 1);
    node_core_close(live.core);
}

/*
 * Takes a radar's plot of a target that flies north from 5 km north of it, as plots that stand
 * still would be clutter.
 */
static void take_polar_plot(struct live *live, int16_t sensor_id, float x_m, int32_t k)
{
    static struct rho_message_polar_scan scan;
    uint8_t buffer[RHO_MESSAGE_POLAR_SCAN_MAX_SIZE];
    char channel[32];
    size_t size;

    scan = (struct rho_message_polar_scan){.utime = START_US + k * SECOND_US,
                                           .scan = k,
                                           .sensor_id = sensor_id,
                                           .num_parts = 1,
                                           .sensor_x_m = x_m,
                                           .num_polar_plots = 1};
    scan.polar_plots[0].range_m = 5000.0f + 50.0f * (float)k;
    scan.polar_plots[0].azimuth_rad = 1.5707964f;
    assert_int_equal(rho_message_polar_scan_encode(&scan, buffer, sizeof buffer, &size), RHO_OK);
    snprintf(channel, sizeof channel, "%s%d", RHO_MESSAGE_POLAR_SCAN_CHANNEL, sensor_id);
    node_core_take_message(live->core, channel, buffer, size, START_US + k * SECOND_US);
}

static void radars_that_fell_silent_make_room(void **state)
{
    struct live live;
    const struct rho_report *report;

    (void)state;
    open_node_core(&live);
    for (int16_t i = 0; i < RHO_MAX_SENSORS; i++) {
        take_polar_plot(&live, (int16_t)(1000 + i), 50000.0f + 1000.0f * (float)i, 0);
    }
    for (int32_t k = 1; k < 60; k++) {
        take_polar_plot(&live, 1, -20000.0f, k);
    }
    assert_true(node_core_node_counters(live.core)->sensors_forgotten > 0);
    assert_int_equal(node_core_node_counters(live.core)->scans_refused, 0);
    report = node_core_last_report(live.core);
    assert_int_equal(report->num_tracks, 1);
    assert_float_equal(report->tracks[0].state[0], -20000.0f, 50.0f);
    node_core_close(live.core);
}

static void the_status_message_tells_the_origin(void **state)
{
    struct live live;
    char reason[PARAMETER_REASON_BYTES];
    const struct rho_message_status *status = &live.heard.status;
    const struct node_core_losses losses = {.datagrams_refused = 0};
    const struct node_core_events events = {.context = &live.heard, .send = keep_sent_message};

    (void)state;
    open_node_core(&live);
    node_core_send_status(live.core, &losses);
    assert_true(status->origin_lat_1e7deg == 0 && status->origin_lon_1e7deg == 0);
    node_core_close(live.core);
    assert_true(parameters_assign(&live.parameters, "origin_lat_deg", "-33.9461234", SOURCE_CONFIG,
                                  reason));
    assert_true(parameters_assign(&live.parameters, "origin_lon_deg", "151.1771234", SOURCE_CONFIG,
                                  reason));
    assert_true(
        parameters_assign(&live.parameters, "origin_alt_m", "27.4321", SOURCE_CONFIG, reason));
    live.core = node_core_open(&live.parameters, 1, &events);
    node_core_send_status(live.core, &losses);
    assert_int_equal(status->origin_lat_1e7deg, -339461234);
    assert_int_equal(status->origin_lon_1e7deg, 1511771234);
    assert_int_equal(status->origin_alt_mm, 27432);
    node_core_close(live.core);
}

static void work_and_unprinted_reports_are_sent_apart_from_status(void **state)
{
    struct live live;
    const struct node_core_losses losses = {
        .datagrams_refused = 3, .reports_not_printed = 5, .events_not_logged = UINT64_MAX};
    const struct rho_message_work *work = &live.heard.work;

    (void)state;
    open_node_core(&live);
    for (int32_t k = 0; k < 4; k++) {
        take_bearing_scan(&live, 1, 0.0f, 0.0f, k);
        take_bearing_scan(&live, 2, 0.0f, 20000.0f, k);
    }
    node_core_flush(live.core);
    node_core_send_status(live.core, &losses);
    assert_int_equal(live.heard.status.fragments_refused, 3);
    assert_true(work->num_steps > 0);
    assert_int_equal(work->num_steps, node_core_node_counters(live.core)->steps);
    assert_int_equal(work->scan, live.heard.status.scan);
    assert_int_equal(work->utime, live.heard.status.utime);
    assert_int_equal(work->work_max, RHO_WORK_MAX);
    assert_int_equal(work->reports_not_printed, 5);
    assert_true(work->events_not_logged == INT64_MAX);
    node_core_close(live.core);
}

static void take_setting(struct live *live, int16_t field, float value, int32_t k)
{
    const struct rho_message_setting setting = {.number = k, .field = field, .value = value};
    uint8_t buffer[RHO_MESSAGE_SETTING_MAX_SIZE];
    size_t size;

    assert_int_equal(rho_message_setting_encode(&setting, buffer, sizeof buffer, &size), RHO_OK);
    node_core_take_message(live->core, RHO_MESSAGE_SETTING_CHANNEL, buffer, size,
                           START_US + k * SECOND_US);
}

/*
 * A sensor's own least range equals the setting, which two settings of one step change with the
 * largest range: the node alone would take both.
 */
static void settings_that_parameters_refuse_are_taken_back(void **state)
{
    struct live live;
    const struct node_core_events events = {.context = &live.heard, .send = keep_sent_message};

    (void)state;
    live = (struct live){.core = NULL};
    parameters_set_defaults(&live.parameters);
    parameters_set_assignment(&live.parameters, "range_min_m=40000");
    parameters_set_assignment(&live.parameters, "sensor.7.range_min_m=40000");
    live.core = node_core_open(&live.parameters, 1, &events);
    node_core_allow_commands(live.core);
    take_setting(&live, RHO_MESSAGE_SETTING_RANGE_MIN_M, 10.0f, 0);
    take_setting(&live, RHO_MESSAGE_SETTING_RANGE_MAX_M, 30000.0f, 0);
    take_polar_plot(&live, 1, 0.0f, 1);
    take_polar_plot(&live, 1, 0.0f, 2);
    assert_int_equal(live.heard.answer.field, RHO_MESSAGE_SETTING_RANGE_MAX_M);
    assert_int_equal(live.heard.answer.status, RHO_OK);
    take_setting(&live, RHO_MESSAGE_SETTING_RANGE_MAX_M, 30000.0f, 3);
    take_polar_plot(&live, 1, 0.0f, 3);
    take_polar_plot(&live, 1, 0.0f, 4);
    assert_int_equal(live.heard.answer.number, 3);
    assert_int_equal(live.heard.answer.status, RHO_ERROR_CONFIG);
    node_core_close(live.core);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(passive_sensors_that_fell_silent_make_room),
        cmocka_unit_test(passive_sensors_that_are_heard_keep_their_room),
        cmocka_unit_test(radars_that_fell_silent_make_room),
        cmocka_unit_test(a_wrong_place_of_a_passive_sensor_keeps_no_scan_out),
        cmocka_unit_test(passive_sensors_that_move_keep_their_track),
        cmocka_unit_test(settings_that_parameters_refuse_are_taken_back),
        cmocka_unit_test(the_status_message_tells_the_origin),
        cmocka_unit_test(work_and_unprinted_reports_are_sent_apart_from_status),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
