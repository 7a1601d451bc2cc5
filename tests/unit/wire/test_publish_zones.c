/* SPDX-License-Identifier: MIT */
/* Counts and events of zones as messages: receivers read what the zones hold. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/publish.h"

static struct rho_zones zones;
static struct rho_report report;

/* Track 40 stays in both zones for a second, track 41 passes the second one. */
static void count_tracks_in_zones(void)
{
    struct rho_zone zone = {.zone_id = 3,
                            .num_corners = 3,
                            .has_heading = 1,
                            .x_m = {0.0f, 10.0f, 0.0f},
                            .y_m = {0.0f, 0.0f, 10.0f},
                            .queue_mps = 1.0f};
    assert_int_equal(rho_zones_init(&zones, sizeof zones), RHO_OK);
    assert_int_equal(rho_zones_add(&zones, &zone), RHO_OK);
    zone.zone_id = -70000;
    assert_int_equal(rho_zones_add(&zones, &zone), RHO_OK);
    memset(&report, 0, sizeof report);
    report.num_tracks = 2;
    report.tracks[0] = (struct rho_track_report){
        .track_id = 40, .status = RHO_TRACK_CONFIRMED, .state = {2.0f, 2.0f}};
    report.tracks[1] = (struct rho_track_report){
        .track_id = 41, .status = RHO_TRACK_CONFIRMED, .state = {1.0f, 1.0f, 0.0f, 3.0f}};
    report.time_us = 5000000;
    assert_int_equal(rho_zones_step(&zones, &report), RHO_OK);
    report.tracks[1].state[RHO_X] = 50.0f;
    report.time_us = 6000000;
    assert_int_equal(rho_zones_step(&zones, &report), RHO_OK);
}

static void counts_of_zones_are_sent(void **state)
{
    struct rho_message_zone_list filled, read;
    uint8_t buffer[RHO_MESSAGE_ZONE_LIST_MAX_SIZE];
    size_t size;

    (void)state;
    count_tracks_in_zones();
    rho_publish_zones(&zones, &filled);
    assert_int_equal(rho_message_zone_list_encode(&filled, buffer, sizeof buffer, &size), RHO_OK);
    assert_int_equal(rho_message_zone_list_decode(buffer, size, &read), RHO_OK);
    assert_int_equal(rho_message_zone_list_validate(&read, NULL), RHO_OK);
    assert_int_equal(read.utime, 6000000);
    assert_int_equal(read.num_zones, 2);
    assert_int_equal(read.zones[0].zone_id, 3);
    assert_int_equal(read.zones[1].zone_id, -70000);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(read.zones[i].inside, 1);
        assert_int_equal(read.zones[i].queued, 1);
        assert_int_equal(read.zones[i].entered, 2);
        assert_int_equal(read.zones[i].left, 1);
        assert_int_equal(read.zones[i].along, 1);
        assert_int_equal(read.zones[i].against, 0);
        assert_true(read.zones[i].dwell_mean_s == 1.0f && read.zones[i].dwell_max_s == 1.0f);
    }
}

static void events_of_the_last_step_are_sent(void **state)
{
    struct rho_message_zone_event_list filled, read;
    uint8_t buffer[RHO_MESSAGE_ZONE_EVENT_LIST_MAX_SIZE];
    size_t size;

    (void)state;
    count_tracks_in_zones();
    rho_publish_zone_events(&zones, &filled);
    assert_int_equal(rho_message_zone_event_list_encode(&filled, buffer, sizeof buffer, &size),
                     RHO_OK);
    assert_int_equal(rho_message_zone_event_list_decode(buffer, size, &read), RHO_OK);
    assert_int_equal(rho_message_zone_event_list_validate(&read, NULL), RHO_OK);
    assert_int_equal(read.num_events, 2);
    assert_int_equal(read.events[1].zone_id, -70000);
    assert_int_equal(read.events[1].track_id, 41);
    assert_int_equal(read.events[1].change, RHO_MESSAGE_ZONE_EVENT_LEAVES);
    assert_int_equal(read.events[1].direction, 1);
    assert_true(read.events[1].speed_mps == 3.0f && read.events[1].dwell_s == 1.0f);
}

static void without_zones_no_counts_or_events_are_sent(void **state)
{
    struct rho_message_zone_list list;
    struct rho_message_zone_event_list events;

    (void)state;
    rho_publish_zones(&zones, NULL);
    rho_publish_zone_events(&zones, NULL);
    memset(&list, 0x5a, sizeof list);
    memset(&events, 0x5a, sizeof events);
    rho_publish_zones(NULL, &list);
    rho_publish_zone_events(NULL, &events);
    assert_int_equal(list.num_zones, 0);
    assert_int_equal(list.utime, 0);
    assert_int_equal(events.num_events, 0);
    assert_int_equal(events.utime, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_of_zones_are_sent),
        cmocka_unit_test(events_of_the_last_step_are_sent),
        cmocka_unit_test(without_zones_no_counts_or_events_are_sent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
