/* SPDX-License-Identifier: MIT */
/* Zones: tracks enter, stay, queue and leave. Reports are made by hand. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "random_draws.h"
#include "rhotrack/zones.h"

static struct rho_zones zones;
static struct rho_report report;

/* A lane of 100 by 4 m that begins at (0, 0) and heads east. */
static struct rho_zone make_lane(int32_t zone_id)
{
    return (struct rho_zone){.zone_id = zone_id,
                             .num_corners = 4,
                             .has_heading = 1,
                             .x_m = {0.0f, 100.0f, 100.0f, 0.0f},
                             .y_m = {0.0f, 0.0f, 4.0f, 4.0f},
                             .margin_m = 2.0f,
                             .queue_mps = 1.0f};
}

static void open_lane(void)
{
    const struct rho_zone zone = make_lane(7);
    assert_int_equal(rho_zones_init(&zones, sizeof zones), RHO_OK);
    assert_int_equal(rho_zones_add(&zones, &zone), RHO_OK);
    memset(&report, 0, sizeof report);
}

static void add_track(uint32_t track_id, float x_m, float y_m, float vx_mps)
{
    report.tracks[report.num_tracks++] =
        (struct rho_track_report){.track_id = track_id,
                                  .status = RHO_TRACK_CONFIRMED,
                                  .state = {x_m, y_m, 0.0f, vx_mps, 0.0f, 0.0f}};
}

/* Steps with the report and begins the next one, a second later. */
static void step_zones(void)
{
    assert_int_equal(rho_zones_step(&zones, &report), RHO_OK);
    report.time_us += 1000000;
    report.num_tracks = 0;
}

static void expect_event(unsigned i, int32_t zone_id, uint32_t track_id,
                         enum rho_zone_change change, int direction, float dwell_s)
{
    assert_true(i < zones.num_events);
    assert_int_equal(zones.events[i].zone_id, zone_id);
    assert_int_equal(zones.events[i].track_id, track_id);
    assert_int_equal(zones.events[i].change, change);
    assert_int_equal(zones.events[i].direction, direction);
    assert_true(fabsf(zones.events[i].dwell_s - dwell_s) < 1e-4f);
}

static void a_track_that_passes_enters_and_leaves_once(void **state)
{
    (void)state;
    open_lane();
    for (int k = 0; k < 16; k++) {
        add_track(3, -15.0f + 10.0f * (float)k, 2.0f, 10.0f);
        step_zones();
        if (k == 2) {
            expect_event(0, 7, 3, RHO_ZONE_ENTERS, 1, 0.0f);
        } else if (k == 12) {
            expect_event(0, 7, 3, RHO_ZONE_LEAVES, 1, 10.0f);
        } else {
            assert_int_equal(zones.num_events, 0);
        }
        assert_int_equal(zones.counts[0].inside, k >= 2 && k < 12);
        assert_true(fabsf(zones.counts[0].speed_mps - (k >= 2 && k < 12 ? 10.0f : 0.0f)) < 1e-4f);
    }
    assert_int_equal(zones.counts[0].entered, 1);
    assert_int_equal(zones.counts[0].left, 1);
    assert_int_equal(zones.counts[0].ended, 0);
    assert_int_equal(zones.counts[0].along, 1);
    assert_int_equal(zones.counts[0].against, 0);
    assert_true(fabsf(zones.counts[0].dwell_mean_s - 10.0f) < 1e-4f);
    assert_true(fabsf(zones.counts[0].dwell_max_s - 10.0f) < 1e-4f);
    assert_int_equal(zones.num_visitors, 0);
}

static void a_track_that_moves_to_and_fro_at_the_border_counts_once(void **state)
{
    (void)state;
    open_lane();
    for (int k = 0; k < 40; k++) {
        add_track(1, k % 2 ? -1.9f : 0.5f, 2.0f, 0.0f);
        step_zones();
    }
    assert_int_equal(zones.counts[0].entered, 1);
    assert_int_equal(zones.counts[0].left, 0);
    assert_int_equal(zones.counts[0].inside, 1);
    add_track(1, -2.1f, 2.0f, -3.0f);
    step_zones();
    expect_event(0, 7, 1, RHO_ZONE_LEAVES, -1, 40.0f);
    assert_int_equal(zones.counts[0].against, 1);
}

static void only_confirmed_tracks_enter_and_coasting_ones_stay(void **state)
{
    static const enum rho_track_status other[] = {RHO_TRACK_TENTATIVE, RHO_TRACK_COASTING};
    (void)state;
    open_lane();
    for (unsigned i = 0; i < 2; i++) {
        add_track(5, 50.0f, 2.0f, 0.0f);
        report.tracks[0].status = other[i];
        step_zones();
        assert_int_equal(zones.counts[0].inside, 0);
    }
    add_track(5, 50.0f, 2.0f, 0.0f);
    step_zones();
    add_track(5, 60.0f, 2.0f, 10.0f);
    report.tracks[0].status = RHO_TRACK_COASTING;
    step_zones();
    assert_int_equal(zones.counts[0].inside, 1);
    add_track(5, 150.0f, 2.0f, 10.0f);
    report.tracks[0].status = RHO_TRACK_COASTING;
    step_zones();
    expect_event(0, 7, 5, RHO_ZONE_LEAVES, 1, 2.0f);
}

static void a_track_that_ends_inside_does_not_count_as_left(void **state)
{
    (void)state;
    open_lane();
    add_track(9, 50.0f, 2.0f, 4.0f);
    step_zones();
    step_zones();
    expect_event(0, 7, 9, RHO_ZONE_ENDS, 0, 1.0f);
    assert_true(zones.events[0].speed_mps == 4.0f);
    assert_int_equal(zones.counts[0].ended, 1);
    assert_int_equal(zones.counts[0].left, 0);
    assert_int_equal(zones.counts[0].inside, 0);
}

static void a_clock_set_back_ends_all_visits(void **state)
{
    (void)state;
    open_lane();
    report.time_us = 100000000;
    add_track(9, 50.0f, 2.0f, 4.0f);
    step_zones();
    report.time_us = 0;
    add_track(9, 50.0f, 2.0f, 4.0f);
    step_zones();
    assert_int_equal(zones.num_events, 2);
    expect_event(0, 7, 9, RHO_ZONE_ENDS, 0, 0.0f);
    expect_event(1, 7, 9, RHO_ZONE_ENTERS, 1, 0.0f);
}

static void slow_tracks_form_the_queue(void **state)
{
    (void)state;
    open_lane();
    add_track(1, 90.0f, 1.0f, 0.2f);
    add_track(2, 70.0f, 3.0f, 0.0f);
    add_track(3, 40.0f, 2.0f, 1.5f);
    step_zones();
    assert_int_equal(zones.counts[0].inside, 3);
    assert_int_equal(zones.counts[0].queued, 2);
    assert_true(fabsf(zones.counts[0].queue_m - 20.0f) < 1e-3f);
    /* below twice queue_mps, so that the track stays in the queue */
    add_track(1, 91.0f, 1.0f, 1.9f);
    add_track(2, 72.0f, 3.0f, 2.1f);
    add_track(3, 41.0f, 2.0f, 0.5f);
    step_zones();
    assert_int_equal(zones.counts[0].queued, 2);
    assert_true(fabsf(zones.counts[0].queue_m - 50.0f) < 1e-3f);
    add_track(1, 95.0f, 1.0f, 5.0f);
    add_track(2, 75.0f, 3.0f, 5.0f);
    add_track(3, 42.0f, 2.0f, 5.0f);
    step_zones();
    assert_int_equal(zones.counts[0].queued, 0);
    assert_true(zones.counts[0].queue_m == 0.0f);
}

/* Without a heading the queue is as long as its diagonal. */
static void a_zone_without_heading_has_no_direction(void **state)
{
    struct rho_zone zone = make_lane(8);
    (void)state;
    open_lane();
    zone.has_heading = 0;
    assert_int_equal(rho_zones_add(&zones, &zone), RHO_OK);
    add_track(1, 10.0f, 0.5f, 0.0f);
    add_track(2, 13.0f, 3.5f, 0.0f);
    add_track(3, 50.0f, 3.5f, 9.0f);
    step_zones();
    assert_int_equal(zones.num_events, 6);
    expect_event(4, 7, 3, RHO_ZONE_ENTERS, 1, 0.0f);
    expect_event(5, 8, 3, RHO_ZONE_ENTERS, 0, 0.0f);
    assert_true(fabsf(zones.counts[1].queue_m - sqrtf(18.0f)) < 1e-3f);
    assert_true(fabsf(zones.counts[0].queue_m - 3.0f) < 1e-3f);
}

/* Whether a place is inside, by the turns of the corners about it, in double precision. */
static int is_inside_by_winding_number(const struct rho_zone *zone, double x_m, double y_m)
{
    double turned_rad = 0.0;
    for (unsigned i = 0; i < zone->num_corners; i++) {
        const unsigned next = (i + 1) % zone->num_corners;
        const double a_rad = atan2(zone->y_m[i] - y_m, zone->x_m[i] - x_m);
        const double b_rad = atan2(zone->y_m[next] - y_m, zone->x_m[next] - x_m);
        turned_rad += remainder(b_rad - a_rad, 2.0 * 3.14159265358979);
    }
    return fabs(turned_rad) > 3.0;
}

static void zones_may_be_concave_and_of_either_orientation(void **state)
{
    struct rho_zone zone = {.zone_id = 1,
                            .num_corners = 7,
                            .x_m = {0.0f, 50.0f, 60.0f, 30.0f, 20.0f, 10.0f, -10.0f},
                            .y_m = {0.0f, -5.0f, 40.0f, 35.0f, 20.0f, 60.0f, 55.0f}};
    unsigned inside = 0;
    (void)state;
    random_state = 4;
    for (int way = 0; way < 2; way++) {
        assert_int_equal(rho_zones_init(&zones, sizeof zones), RHO_OK);
        assert_int_equal(rho_zones_add(&zones, &zone), RHO_OK);
        memset(&report, 0, sizeof report);
        for (uint32_t k = 0; k < 2000; k++) {
            const float x_m = (float)uniform(-30.0, 80.0), y_m = (float)uniform(-30.0, 80.0);
            add_track(k, x_m, y_m, 0.0f);
            step_zones();
            assert_int_equal(zones.counts[0].inside, is_inside_by_winding_number(&zone, x_m, y_m));
            inside += zones.counts[0].inside;
        }
        for (unsigned i = 0; i < 3; i++) {
            const float x_m = zone.x_m[i], y_m = zone.y_m[i];
            zone.x_m[i] = zone.x_m[6 - i];
            zone.y_m[i] = zone.y_m[6 - i];
            zone.x_m[6 - i] = x_m;
            zone.y_m[6 - i] = y_m;
        }
    }
    assert_in_range(inside, 500, 3000);
}

/* All tracks enter all zones in one step. */
static void events_beyond_the_capacity_are_counted(void **state)
{
    (void)state;
    assert_int_equal(rho_zones_init(&zones, sizeof zones), RHO_OK);
    for (int32_t i = 0; i < RHO_MAX_ZONES; i++) {
        const struct rho_zone zone = make_lane(i);
        assert_int_equal(rho_zones_add(&zones, &zone), RHO_OK);
    }
    memset(&report, 0, sizeof report);
    for (uint32_t i = 0; i < RHO_MAX_TRACKS; i++) {
        add_track(i, 50.0f, 2.0f, 0.0f);
    }
    step_zones();
    assert_int_equal(zones.num_events, RHO_ZONE_EVENTS);
    assert_int_equal(zones.events_dropped, RHO_MAX_ZONES * RHO_MAX_TRACKS - RHO_ZONE_EVENTS);
    for (unsigned i = 0; i < RHO_MAX_ZONES; i++) {
        assert_int_equal(zones.counts[i].entered, RHO_MAX_TRACKS);
        assert_int_equal(zones.counts[i].inside, RHO_MAX_TRACKS);
    }
    step_zones();
    assert_int_equal(zones.counts[0].ended, RHO_MAX_TRACKS);
    assert_int_equal(zones.num_visitors, 0);
}

static void expect_zone_refused(const struct rho_zone *zone, enum rho_status status)
{
    const struct rho_zones before = zones;
    assert_int_equal(rho_zones_add(&zones, zone), status);
    assert_memory_equal(&before, &zones, sizeof zones);
}

static void bad_zones_are_refused(void **state)
{
    struct rho_zone zone;
    (void)state;
    open_lane();
    expect_zone_refused(NULL, RHO_ERROR_NULL);
    zone = make_lane(7); /* the id is in use */
    expect_zone_refused(&zone, RHO_ERROR_VALUE);
    zone = make_lane(8);
    zone.num_corners = 2;
    expect_zone_refused(&zone, RHO_ERROR_VALUE);
    zone.num_corners = RHO_ZONE_CORNERS + 1;
    expect_zone_refused(&zone, RHO_ERROR_VALUE);
    zone = make_lane(8);
    zone.x_m[2] = NAN;
    expect_zone_refused(&zone, RHO_ERROR_VALUE);
    zone = make_lane(8);
    zone.y_m[3] = 1e30f;
    expect_zone_refused(&zone, RHO_ERROR_VALUE);
    zone = make_lane(8);
    zone.y_m[2] = zone.y_m[3] = 0.0f; /* a zone of no area */
    expect_zone_refused(&zone, RHO_ERROR_VALUE);
    zone = make_lane(8);
    zone.margin_m = -1.0f;
    expect_zone_refused(&zone, RHO_ERROR_VALUE);
    zone = make_lane(8);
    zone.queue_mps = NAN;
    expect_zone_refused(&zone, RHO_ERROR_VALUE);
    zone = make_lane(8);
    zone.heading_rad = 8.0f;
    expect_zone_refused(&zone, RHO_ERROR_VALUE);
    zone = make_lane(8);
    zone.has_heading = 2;
    expect_zone_refused(&zone, RHO_ERROR_VALUE);
    for (int32_t i = 8; i < 7 + RHO_MAX_ZONES; i++) {
        zone = make_lane(i);
        assert_int_equal(rho_zones_add(&zones, &zone), RHO_OK);
    }
    zone = make_lane(7 + RHO_MAX_ZONES);
    expect_zone_refused(&zone, RHO_ERROR_CAPACITY);
}

static void bad_calls_change_nothing(void **state)
{
    struct rho_zones before;
    const struct rho_zone zone = make_lane(1);
    (void)state;
    assert_int_equal(rho_zones_init(NULL, sizeof zones), RHO_ERROR_NULL);
    memset(&zones, 0x5a, sizeof zones);
    before = zones;
    assert_int_equal(rho_zones_init(&zones, sizeof zones - 1), RHO_ERROR_SIZE);
    assert_int_equal(rho_zones_add(&zones, &zone), RHO_ERROR_STATE);
    assert_int_equal(rho_zones_step(&zones, &report), RHO_ERROR_STATE);
    assert_int_equal(rho_zones_step(NULL, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_zones_step(&zones, NULL), RHO_ERROR_NULL);
    assert_memory_equal(&before, &zones, sizeof zones);
    open_lane();
    report.num_tracks = RHO_MAX_TRACKS + 1;
    before = zones;
    assert_int_equal(rho_zones_step(&zones, &report), RHO_ERROR_VALUE);
    assert_memory_equal(&before, &zones, sizeof zones);
}

static void every_zone_change_has_a_name(void **state)
{
    (void)state;
    assert_string_equal(rho_zone_change_name(RHO_ZONE_ENTERS), "enters");
    assert_string_equal(rho_zone_change_name(RHO_ZONE_LEAVES), "leaves");
    assert_string_equal(rho_zone_change_name(RHO_ZONE_ENDS), "ends");
    assert_string_equal(rho_zone_change_name(RHO_NUM_ZONE_CHANGES), "unknown");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_track_that_passes_enters_and_leaves_once),
        cmocka_unit_test(a_track_that_moves_to_and_fro_at_the_border_counts_once),
        cmocka_unit_test(only_confirmed_tracks_enter_and_coasting_ones_stay),
        cmocka_unit_test(a_track_that_ends_inside_does_not_count_as_left),
        cmocka_unit_test(a_clock_set_back_ends_all_visits),
        cmocka_unit_test(slow_tracks_form_the_queue),
        cmocka_unit_test(a_zone_without_heading_has_no_direction),
        cmocka_unit_test(zones_may_be_concave_and_of_either_orientation),
        cmocka_unit_test(events_beyond_the_capacity_are_counted),
        cmocka_unit_test(bad_zones_are_refused),
        cmocka_unit_test(bad_calls_change_nothing),
        cmocka_unit_test(every_zone_change_has_a_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
