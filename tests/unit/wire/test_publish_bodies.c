/* SPDX-License-Identifier: MIT */
/*
 * Bodies of tracks as messages in parts: receivers read what the tracker knows; a node whose
 * tracker was told of bodies sends them after tracks and peaks.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/node.h"
#include "rhotrack/publish.h"
#include "rhotrack/udpm.h"

#define VEHICLES 30 /* enough for two parts */
#define PLOTS 3

static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_report report;
static struct rho_message_body_list list;

static void start_tracker(float body_max_m)
{
    struct rho_tracker_config config;
    struct rho_initiator_config start;

    rho_tracker_config_default(&config);
    rho_initiator_config_default(&start);
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, &start), RHO_OK);
    assert_int_equal(rho_tracker_set_body_max(&tracker, body_max_m), RHO_OK);
    memset(&report, 0, sizeof report);
}

/* Vehicles of 8 m side by side, 100 m apart, seen at both ends and in the middle. */
static void track_vehicles(int num_vehicles, int seconds)
{
    static struct rho_plot plots[VEHICLES * PLOTS];

    for (int k = 0; k < 10 * seconds; k++) {
        for (int i = 0; i < PLOTS * num_vehicles; i++) {
            const float along_m = 4.0f * (float)(i % PLOTS - 1);

            plots[i] = (struct rho_plot){.x_m = 2.0f * (float)k + along_m,
                                         .y_m = 100.0f * (float)(i / PLOTS),
                                         .sigma_range_m = 0.3f,
                                         .sigma_cross_m = 0.3f,
                                         .sigma_up_m = 0.3f};
        }
        const struct rho_scan scan = {.time_us = 100000 * (int64_t)k,
                                      .plots = plots,
                                      .num_plots = (uint32_t)(PLOTS * num_vehicles)};
        assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
    }
}

static void publish_and_read_part(uint16_t part)
{
    uint8_t buffer[RHO_MESSAGE_BODY_LIST_MAX_SIZE];
    size_t size;

    assert_int_equal(
        rho_publish_bodies(&tracker, &report, 77, 5, part, buffer, sizeof buffer, &size), RHO_OK);
    assert_int_equal(rho_message_body_list_decode(buffer, size, &list), RHO_OK);
    assert_int_equal(rho_message_body_list_validate(&list, NULL), RHO_OK);
}

static void each_body_is_sent_once_with_its_track(void **state)
{
    struct rho_body body;
    unsigned track = 0;

    (void)state;
    if (!RHO_BODIES) {
        skip();
    }
    start_tracker(12.0f);
    assert_int_equal(rho_publish_num_body_parts(&tracker, &report), 1);
    publish_and_read_part(0);
    assert_int_equal(list.num_bodies, 0);
    track_vehicles(VEHICLES, 3);
    assert_int_equal(report.num_tracks, VEHICLES);
    assert_int_equal(rho_publish_num_body_parts(&tracker, &report), 2);
    for (uint16_t part = 0; part < 2; part++) {
        publish_and_read_part(part);
        assert_int_equal(list.num_bodies, part == 0 ? RHO_MESSAGE_BODY_LIST_MAX_BODIES
                                                    : VEHICLES - RHO_MESSAGE_BODY_LIST_MAX_BODIES);
        assert_int_equal(list.utime, report.time_us);
        assert_int_equal(list.scan, 77);
        assert_int_equal(list.epoch, 5);
        assert_int_equal(list.part, part);
        assert_int_equal(list.num_parts, 2);
        for (int i = 0; i < list.num_bodies; i++, track++) {
            const struct rho_message_body *sent = &list.bodies[i];

            assert_int_equal(rho_tracker_body_of(&tracker, track, &body), 1);
            assert_int_equal(sent->track_id, report.tracks[track].track_id);
            assert_true(sent->x_m == report.tracks[track].state[RHO_X] &&
                        sent->y_m == report.tracks[track].state[RHO_Y]);
            assert_true(sent->reference_x_m == sent->x_m && sent->reference_y_m == sent->y_m);
            assert_true(sent->length_m == body.length_m && sent->width_m == body.width_m);
            assert_true(sent->length_m > 5.0f && sent->length_m < 15.0f);
            assert_true(sent->heading_rad == body.heading_rad);
            assert_true(sent->sigma_length_m == body.sigma_length_m &&
                        sent->sigma_width_m == body.sigma_width_m &&
                        sent->sigma_heading_rad == body.sigma_heading_rad);
            assert_true(sent->sigma_along_m == body.sigma_along_m &&
                        sent->sigma_across_m == body.sigma_across_m);
            assert_true(sent->plots == body.plots && body.plots > PLOTS);
        }
    }
    assert_int_equal(track, VEHICLES);
}

static void bad_arguments_of_publishing_are_refused(void **state)
{
    uint8_t buffer[RHO_MESSAGE_BODY_LIST_MAX_SIZE];
    size_t size = 12345;

    (void)state;
    start_tracker(0.0f);
    assert_int_equal(rho_publish_num_body_parts(&tracker, &report), 0);
    assert_int_equal(rho_publish_num_body_parts(NULL, &report), 0);
    assert_int_equal(rho_publish_num_body_parts(&tracker, NULL), 0);
    assert_int_equal(rho_publish_bodies(&tracker, &report, 0, 0, 0, buffer, sizeof buffer, &size),
                     RHO_ERROR_VALUE);
    if (RHO_BODIES) {
        start_tracker(12.0f);
        assert_int_equal(
            rho_publish_bodies(&tracker, &report, 0, 0, 1, buffer, sizeof buffer, &size),
            RHO_ERROR_VALUE);
        assert_int_equal(rho_publish_bodies(&tracker, &report, 0, 0, 0, buffer, 20, &size),
                         RHO_ERROR_CAPACITY);
    }
    assert_int_equal(rho_publish_bodies(NULL, &report, 0, 0, 0, buffer, sizeof buffer, &size),
                     RHO_ERROR_NULL);
    assert_int_equal(rho_publish_bodies(&tracker, NULL, 0, 0, 0, buffer, sizeof buffer, &size),
                     RHO_ERROR_NULL);
    assert_int_equal(rho_publish_bodies(&tracker, &report, 0, 0, 0, NULL, sizeof buffer, &size),
                     RHO_ERROR_NULL);
    assert_int_equal(rho_publish_bodies(&tracker, &report, 0, 0, 0, buffer, sizeof buffer, NULL),
                     RHO_ERROR_NULL);
    assert_int_equal(size, 12345);
}

static void the_node_sends_bodies_after_tracks_and_peaks(void **state)
{
    static struct rho_node node;
    struct rho_node_config config;
    struct rho_settings settings;
    uint8_t buffer[RHO_UDPM_MAX_DATAGRAM];
    size_t size;

    (void)state;
    rho_settings_default(&settings);
    for (int has_bodies = 0; has_bodies < RHO_BODIES + 1; has_bodies++) {
        rho_node_config_default(&config, &settings);
        config.epoch = 5;
        config.body_max_m = has_bodies ? 12.0f : 0.0f;
        start_tracker(config.body_max_m);
        assert_int_equal(rho_node_init(&node, sizeof node, &settings), RHO_OK);
        assert_int_equal(rho_node_configure(&node, &config), RHO_OK);
        track_vehicles(2, 3);
        node.tracker = tracker;
        node.report = report;
        node.done = RHO_NODE_SCAN;
        assert_int_equal(rho_node_num_messages(&node),
                         rho_publish_num_parts(&report) + 1 + has_bodies);
        const uint16_t peaks = rho_publish_num_parts(&report);
        assert_string_equal(rho_node_channel(&node, 0), RHO_MESSAGE_TRACK_LIST_CHANNEL);
        assert_string_equal(rho_node_channel(&node, peaks), RHO_MESSAGE_PEAK_LIST_CHANNEL);
        if (has_bodies) {
            assert_string_equal(rho_node_channel(&node, (uint16_t)(peaks + 1)),
                                RHO_MESSAGE_BODY_LIST_CHANNEL);
            assert_int_equal(
                rho_node_publish(&node, (uint16_t)(peaks + 1), buffer, sizeof buffer, &size),
                RHO_OK);
            assert_int_equal(rho_message_body_list_decode(buffer, size, &list), RHO_OK);
            assert_int_equal(list.num_bodies, 2);
            assert_int_equal(list.epoch, 5);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_body_is_sent_once_with_its_track),
        cmocka_unit_test(bad_arguments_of_publishing_are_refused),
        cmocka_unit_test(the_node_sends_bodies_after_tracks_and_peaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
