/* SPDX-License-Identifier: MIT */
/*
 * Frames of bearings: what becomes of each bearing, counters, capacities, late and refused frames,
 * no initiation.
 */
#include "bearing_frame_chain.h"

#define NUM(array) (sizeof(array) / sizeof((array)[0]))

static struct rho_tracker tracker_then;
static struct rho_passive passive_then;
static struct rho_report report_then;
static struct rho_bearing many[3][RHO_MAX_PLOTS + 50];

/* Coming in from the east, in sight of sensor 0 at 0.25 rad, of sensor 1 at -0.09 rad. */
static const struct target incomer = {.x_m = 60e3, .y_m = 5e3, .vx_mps = -200.0, .vy_mps = 10.0};

/* Frames 0 .. 11 of that target, which is found and followed. */
static void fly_one(unsigned sensors)
{
    random_state = 9;
    scene = scene_of(sensors, 1, 0.1, 1.0, 0.0);
    scene.target[0] = incomer;
    start_chain(5.0f);
    fly_frames(0, 12, 10.0);
    assert_int_equal(report.num_tracks, 1);
}

static void keep_snapshot(void)
{
    tracker_then = tracker;
    passive_then = passive;
    report_then = report;
}

static void say(struct look *look, double bearing_rad)
{
    add_bearing(look, bearing_rad, 0.1 * DEG_RAD, -1);
}

/* ---- fates ----------------------------------------------------------------------------------- */

static void every_bearing_has_its_fate_in_its_place(void **state)
{
    (void)state;
    fly_one(2);
    see_frame(12, 120.0);
    struct look *look = scene.look[scene_slot_of(12)];
    say(&look[0], 0.0);
    look[0].bearings[1].bearing_rad = NAN;
    say(&look[0], -1.4); /* to the south: meets nothing */
    say(&look[0], 0.5);  /* meets the second sensor's first */
    say(&look[0], 0.6);
    look[0].bearings[4].offset_us = RHO_LIMIT_OFFSET_US + 1;
    say(&look[0], 0.6);
    look[0].bearings[5].sigma_rad = 0.0f;
    while (look[0].count < RHO_MAX_BEARINGS + 2) {
        say(&look[0], 0.5 + 0.01 * look[0].count);
    }
    struct rho_bearing target = look[1].bearings[0];
    look[1].count = 0;
    say(&look[1], -0.5);
    say(&look[1], 2.0); /* to the other side of the base */
    look[1].bearings[look[1].count++] = target;
    fill_frame(&scene, scene_slot_of(12), &full);
    step_frame(&full.frame);
    const uint8_t expected[] = {RHO_FATE_CLAIMED, RHO_FATE_INVALID, RHO_FATE_GHOST,
                                RHO_FATE_HELD,    RHO_FATE_INVALID, RHO_FATE_INVALID};
    assert_memory_equal(report.fates, expected, sizeof expected);
    for (unsigned i = NUM(expected); i < look[0].count; i++) {
        assert_int_equal(report.fates[i], i < RHO_MAX_BEARINGS ? RHO_FATE_HELD : RHO_FATE_NO_ROOM);
    }
    const uint8_t second[] = {RHO_FATE_HELD, RHO_FATE_GHOST, RHO_FATE_CLAIMED};
    assert_memory_equal(report.fates + look[0].count, second, sizeof second);
    assert_int_equal(report.tracks[0].plot, 2); /* of the last sensor's scan */
    assert_int_equal(report.tracks[0].sensor_id, 11);
    assert_int_equal(report.fates_total[RHO_FATE_GHOST], 2);
    /* what was held is in the batch, ghosts too, and nothing else */
    assert_int_equal(passive.batch.num_bearings[BATCH - 1][0], RHO_MAX_BEARINGS - 4);
    assert_int_equal(passive.batch.num_bearings[BATCH - 1][1], 2);
    assert_float_equal(passive.batch.bearings[BATCH - 1][0][1].bearing_rad, 0.5, 1e-6);
    assert_float_equal(passive.batch.bearings[BATCH - 1][1][0].bearing_rad, -0.5, 1e-6);
    assert_float_equal(passive.batch.bearings[BATCH - 1][1][1].bearing_rad, 2.0, 1e-6);
}

/* A bearing that meets nobody's, as nobody else has any, may be a target's. */
static void a_lonely_bearing_is_no_ghost(void **state)
{
    (void)state;
    start_chain(5.0f);
    scene = scene_of(2, 0, 0.1, 1.0, 0.0);
    see_frame(0, 0.0);
    say(&scene.look[0][0], -1.4);
    fill_frame(&scene, 0, &full);
    step_frame(&full.frame);
    assert_int_equal(report.fates[0], RHO_FATE_HELD);
    say(&scene.look[0][1], 0.0);
    scene.look[0][1].bearings[0].sigma_rad = NAN; /* is none */
    fill_frame(&scene, 0, &full);
    full.frame.time_us = 1;
    step_frame(&full.frame);
    assert_int_equal(report.fates[0], RHO_FATE_HELD);
    assert_int_equal(report.fates[1], RHO_FATE_INVALID);
}

/* Held bearings start tracks, leave with the oldest frame, or are there. */
static void counters_add_up_over_a_long_run(void **state)
{
    (void)state;
    uint32_t frames = 0;
    random_state = 31;
    scene = scene_of(3, 3, 0.1, 0.9, 1.0);
    for (unsigned i = 0; i < 3; i++) {
        scene.target[i] = random_target(300.0);
    }
    start_chain(5.0f);
    for (unsigned k = 0; k < 60; k++) { /* also beyond the sensors, where tracks end */
        fly_frame(k, 10.0);
        const struct rho_tracker_counters *counters = &tracker.counters;
        frames++;
        assert_int_equal(counters->scans_accepted, frames);
        assert_int_equal(counters->fates[RHO_FATE_HELD] + counters->fates[RHO_FATE_GHOST],
                         counters->plots_initiated + counters->plots_clutter + count_held());
        assert_int_equal(counters->tracks_started - counters->tracks_ended, report.num_tracks);
    }
    assert_int_equal(
        tracker.counters.fates[RHO_FATE_STALE] + tracker.counters.fates[RHO_FATE_INVALID], 0);
    assert_true(tracker.counters.fates[RHO_FATE_CLAIMED] > 100);
    assert_true(tracker.counters.fates[RHO_FATE_GHOST] > 10);
    assert_true(tracker.counters.plots_clutter > 50 && tracker.counters.plots_initiated > 30);
}

/* ---- capacities ------------------------------------------------------------------------------ */

/*
 * The batch's newest frame holds just the bearings of this scan that are HELD or a GHOST, in their
 * order.
 */
static void expect_held(unsigned sensor, const struct rho_bearing_scan *scan, uint32_t first)
{
    unsigned newest = passive.batch.num_scans - 1u, held = 0;
    for (uint32_t i = 0; i < scan->num_bearings && first + i < RHO_MAX_PLOTS; i++) {
        if (report.fates[first + i] == RHO_FATE_HELD || report.fates[first + i] == RHO_FATE_GHOST) {
            const struct rho_batch_bearing *bearing = &passive.batch.bearings[newest][sensor][held];
            assert_true(bearing->bearing_rad == scan->bearings[i].bearing_rad);
            held++;
        }
    }
    assert_int_equal(passive.batch.num_bearings[newest][sensor], held);
}

/* Three scans with so many bearings, all of which meet those of the others. */
static void expect_room(uint32_t num_0, uint32_t num_1, uint32_t num_2)
{
    const uint32_t num[3] = {num_0, num_1, num_2};
    const float middle_rad[3] = {0.4f, -0.4f, -0.3f};
    struct rho_bearing_scan scans[3];
    uint32_t first = 0;
    start_chain(5.0f);
    scene = scene_of(3, 0, 0.1, 1.0, 0.0);
    for (unsigned s = 0; s < 3; s++) {
        for (unsigned i = 0; i < NUM(many[s]); i++) {
            many[s][i] = (struct rho_bearing){.bearing_rad = middle_rad[s] + 1e-5f * (float)i,
                                              .sigma_rad = 0.01f};
        }
        scans[s] = (struct rho_bearing_scan){.sensor_id = (int32_t)s,
                                             .x_m = (float)scene.sensor_x_m[s],
                                             .y_m = (float)scene.sensor_y_m[s],
                                             .num_bearings = num[s],
                                             .bearings = many[s]};
    }
    const struct rho_frame frame = {.num_scans = 3, .scans = scans};
    step_frame(&frame);
    for (unsigned s = 0; s < 3; s++) {
        for (uint32_t i = 0; i < num[s] && first + i < RHO_MAX_PLOTS; i++) {
            assert_int_equal(report.fates[first + i],
                             i < RHO_MAX_BEARINGS ? RHO_FATE_HELD : RHO_FATE_NO_ROOM);
        }
        expect_held(s, &scans[s], first);
        first += num[s];
    }
    assert_int_equal(report.fates_total[RHO_FATE_INVALID] + report.fates_total[RHO_FATE_GHOST], 0);
}

static void bearings_beyond_the_capacities_find_no_room(void **state)
{
    (void)state;
    expect_room(RHO_MAX_BEARINGS, RHO_MAX_BEARINGS + 1, 2);
    expect_room(RHO_MAX_BEARINGS + 7, 0, RHO_MAX_BEARINGS + 9);
    /* fates end within the second scan, before the third, with the first, within the first */
    expect_room(RHO_MAX_PLOTS - 3, 5, 4);
    expect_room(RHO_MAX_PLOTS - 3, 3, 4);
    expect_room(RHO_MAX_PLOTS, 3, 4);
    expect_room(RHO_MAX_PLOTS + 40, 3, 4);
    expect_room(1, RHO_MAX_PLOTS + 40, 4);
}

/* Their sum is beyond 32 bits; only the first of each scan are looked at. */
static void numbers_beyond_all_reason_do_no_harm(void **state)
{
    (void)state;
    struct rho_bearing_scan scans[3];
    const uint32_t num[3] = {UINT32_MAX, 5, 4};
    start_chain(5.0f);
    scene = scene_of(3, 0, 0.1, 1.0, 0.0);
    for (unsigned s = 0; s < 3; s++) {
        scans[s] = (struct rho_bearing_scan){.sensor_id = (int32_t)s,
                                             .x_m = (float)scene.sensor_x_m[s],
                                             .y_m = (float)scene.sensor_y_m[s],
                                             .num_bearings = num[s],
                                             .bearings = many[s]};
        for (unsigned i = 0; i < RHO_MAX_BEARINGS; i++) {
            many[s][i] = (struct rho_bearing){.bearing_rad = 0.1f * (float)i, .sigma_rad = 0.01f};
        }
    }
    const struct rho_frame frame = {.num_scans = 3, .scans = scans};
    assert_int_equal(rho_tracker_step_frame(&tracker, &passive, &frame, &report), RHO_OK);
    assert_int_equal(report.num_plots, UINT32_MAX);
    assert_int_equal(passive.batch.num_bearings[0][1], 0); /* no fates, so not held either */
    assert_int_equal(passive.batch.num_bearings[0][2], 0);
    expect_held(0, &(struct rho_bearing_scan){.num_bearings = 50, .bearings = many[0]}, 0);
}

/*
 * All places of the table are taken by plots' tracks in the west, where the passive sensors do not
 * look.
 */
static void a_full_table_starts_no_track_and_keeps_the_bearings(void **state)
{
    (void)state;
    static struct rho_initiator initiator;
    static struct rho_plot plots[RHO_MAX_TRACKS];
    struct rho_initiator_config config;
    if (RHO_MAX_TRACKS > RHO_MAX_PLOTS || RHO_MAX_TRACKS > 100) {
        skip(); /* the workstation's table is not filled in a unit test */
    }
    rho_initiator_config_default(&config);
    config.scans = 5;
    config.min_scans = 4;
    config.false_tracks_per_hour = 0.0f;
    start_chain(5.0f);
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, &config), RHO_OK);
    for (int k = 0; k < 10; k++) {
        struct rho_scan scan = {.time_us = 2000000 * (int64_t)k - 20000000, .plots = plots};
        scan.num_plots = k < 4 ? RHO_MAX_TRACKS / 2 : RHO_MAX_TRACKS;
        for (int i = 0; i < RHO_MAX_TRACKS; i++) {
            plots[i] = (struct rho_plot){.x_m = -90000.0f + 500.0f * (float)k,
                                         .y_m = 3000.0f * (float)i,
                                         .sigma_range_m = 10.0f,
                                         .sigma_cross_m = 10.0f};
        }
        assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
    }
    assert_int_equal(report.num_tracks, RHO_MAX_TRACKS);
    random_state = 9;
    scene = scene_of(2, 1, 0.1, 1.0, 0.0);
    scene.target[0] = incomer;
    for (unsigned k = 0; k < BATCH + 2; k++) {
        see_frame(k, 10.0 * k);
        for (unsigned s = 0; s < 2; s++) {
            full.scans[s].sector_from_rad = -1.5f;
            full.scans[s].sector_to_rad = 1.5f;
        }
        step_frame(&full.frame);
        assert_int_equal(report.num_tracks, RHO_MAX_TRACKS);
        assert_int_equal(tracker.counters.tracks_no_room, k < BATCH - 1 ? 0 : k - BATCH + 2);
    }
    assert_int_equal(tracker.counters.tracks_started, RHO_MAX_TRACKS);
    assert_int_equal(count_held(), 2 * BATCH);
}

/* ---- late, refused, alone -------------------------------------------------------------------- */

static void a_late_frame_changes_nothing_but_counters(void **state)
{
    (void)state;
    fly_one(2);
    keep_snapshot();
    see_frame(12, 109.999999);
    step_frame(&full.frame);
    assert_int_equal(report.fates_total[RHO_FATE_STALE], 2);
    assert_int_equal(report.fates[0] + report.fates[1], 2 * RHO_FATE_STALE);
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(report.tracks[0].hits, 12);
    assert_int_equal(tracker.counters.scans_late, 1);
    assert_int_equal(tracker.counters.scans_accepted, 12);
    assert_int_equal(tracker.counters.fates[RHO_FATE_STALE], 2);
    tracker.counters = tracker_then.counters;
    assert_memory_equal(&tracker, &tracker_then, sizeof tracker);
    assert_memory_equal(&passive, &passive_then, sizeof passive);
    fly_frame(12, 10.0);
    assert_int_equal(report.fates_total[RHO_FATE_CLAIMED], 2);
}

static void expect_status(struct rho_passive *of, enum rho_status status)
{
    assert_int_equal(rho_tracker_step_frame(&tracker, of, &full.frame, &report), status);
    assert_memory_equal(&tracker, &tracker_then, sizeof tracker);
    assert_memory_equal(&passive, &passive_then, sizeof passive);
    assert_memory_equal(&report, &report_then, sizeof report);
}

/* A good frame that was never taken, with one thing wrong of it. */
#define EXPECT_REFUSED(change, status)                                                             \
    do {                                                                                           \
        fill_frame(&scene, scene_slot_of(12), &full);                                              \
        change;                                                                                    \
        expect_status(&passive, status);                                                           \
    } while (0)

static void start_refusals(void)
{
    fly_one(2);
    see_frame(12, 120.0);
    keep_snapshot();
}

static void null_pointers_are_refused(void **state)
{
    (void)state;
    start_refusals();
    assert_int_equal(rho_tracker_step_frame(NULL, &passive, &full.frame, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_step_frame(&tracker, &passive, NULL, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_step_frame(&tracker, &passive, &full.frame, NULL), RHO_ERROR_NULL);
    EXPECT_REFUSED(full.frame.scans = NULL, RHO_ERROR_NULL);
    EXPECT_REFUSED(full.scans[0].bearings = NULL, RHO_ERROR_NULL);
    EXPECT_REFUSED(full.scans[1].bearings = NULL, RHO_ERROR_NULL);
}

static void what_was_never_initialised_is_refused(void **state)
{
    (void)state;
    start_refusals();
    tracker.magic = tracker_then.magic = 0;
    EXPECT_REFUSED((void)0, RHO_ERROR_STATE);
    fly_one(2);
    see_frame(12, 120.0);
    passive.magic = 0;
    keep_snapshot();
    EXPECT_REFUSED((void)0, RHO_ERROR_STATE);
    expect_status(&passive, RHO_ERROR_STATE);
}

static void numbers_out_of_range_are_refused(void **state)
{
    (void)state;
    const float bad_m[] = {NAN, INFINITY, -INFINITY, 2.1e6f};
    const float bad_rad[] = {NAN, INFINITY, 6.3f, -6.3f};
    start_refusals();
    for (unsigned i = 0; i < NUM(bad_m); i++) {
        EXPECT_REFUSED(full.scans[1].x_m = bad_m[i], RHO_ERROR_VALUE);
        EXPECT_REFUSED(full.scans[1].y_m = bad_m[i], RHO_ERROR_VALUE);
        EXPECT_REFUSED(full.scans[0].sector_from_rad = bad_rad[i], RHO_ERROR_VALUE);
        EXPECT_REFUSED(full.scans[1].sector_to_rad = bad_rad[i], RHO_ERROR_VALUE);
    }
    EXPECT_REFUSED(full.frame.time_us = RHO_LIMIT_TIME_US + 1, RHO_ERROR_VALUE);
    EXPECT_REFUSED(full.frame.time_us = INT64_MIN, RHO_ERROR_VALUE);
    EXPECT_REFUSED(full.scans[0].time_us = INT64_MAX, RHO_ERROR_VALUE);
    EXPECT_REFUSED(full.scans[0].time_us = INT64_MIN, RHO_ERROR_VALUE);
    EXPECT_REFUSED(full.scans[1].time_us += RHO_LIMIT_OFFSET_US + 1, RHO_ERROR_VALUE);
    EXPECT_REFUSED(full.scans[1].time_us -= RHO_LIMIT_OFFSET_US + 1, RHO_ERROR_VALUE);
}

static void what_the_batch_refuses_is_refused(void **state)
{
    (void)state;
    start_refusals();
    EXPECT_REFUSED(full.frame.time_us = full.scans[0].time_us = 110000000, RHO_ERROR_STATE);
    EXPECT_REFUSED(full.scans[1].y_m += 0.5f, RHO_ERROR_VALUE);
    EXPECT_REFUSED(full.scans[1] = full.scans[0], RHO_ERROR_VALUE);
    EXPECT_REFUSED(full.scans[1].sensor_id = 99, RHO_ERROR_VALUE);
    fly_one(RHO_MAX_PASSIVE_SENSORS < SCENE_SENSORS ? RHO_MAX_PASSIVE_SENSORS : SCENE_SENSORS);
    see_frame(12, 120.0);
    keep_snapshot();
    if (RHO_MAX_PASSIVE_SENSORS <= SCENE_SENSORS) {
        EXPECT_REFUSED((full.scans[0].sensor_id = 99, full.scans[0].x_m = 5e3f),
                       RHO_ERROR_CAPACITY);
    }
    fill_frame(&scene, scene_slot_of(12), &full);
    full.scans[0].time_us += RHO_LIMIT_OFFSET_US; /* as far as it goes */
    step_frame(&full.frame);
}

static void without_an_initiation_tracks_go_on_and_none_start(void **state)
{
    (void)state;
    fly_one(2);
    passive_then = passive;
    scene.targets = 2;
    scene.target[1] = (struct target){.x_m = 30e3, .y_m = -20e3, .vx_mps = -100.0, .vy_mps = 90.0};
    for (unsigned k = 12; k < 24; k++) {
        see_frame(k, 10.0 * k);
        assert_int_equal(rho_tracker_step_frame(&tracker, NULL, &full.frame, &report), RHO_OK);
        check_fates(&full.frame);
        assert_int_equal(report.fates_total[RHO_FATE_CLAIMED], 2);
        assert_int_equal(report.fates_total[RHO_FATE_NO_ROOM], 2);
        assert_int_equal(report.num_tracks, 1);
        assert_int_equal(report.tracks[0].hits, k + 1);
    }
    assert_memory_equal(&passive, &passive_then, sizeof passive);
    full.frame.time_us += 1; /* a sensor that moved is nothing to it, nor are many */
    full.scans[0].x_m += 100.0f;
    full.scans[1].sensor_id = 99;
    assert_int_equal(rho_tracker_step_frame(&tracker, NULL, &full.frame, &report), RHO_OK);
    full.scans[0].x_m = NAN;
    assert_int_equal(rho_tracker_step_frame(&tracker, NULL, &full.frame, &report), RHO_ERROR_VALUE);
}

/* Nobody looked: nothing is missed, and the batch moves on. */
static void a_frame_without_scans_is_a_frame(void **state)
{
    (void)state;
    fly_one(2);
    for (int64_t k = 12; k < 30; k++) {
        const struct rho_frame frame = {.time_us = 10000000 * k};
        step_frame(&frame);
        assert_int_equal(report.num_tracks, 1);
        assert_int_equal(report.tracks[0].misses, 0);
    }
    assert_int_equal(tracker.counters.scans_accepted, 30);
    assert_int_equal(count_held(), 0);
}

/* Bearings of 0.01 rad are covered up to four sigmas beyond the sector of a sensor. */
static void bearings_beyond_the_sector_are_outside(void **state)
{
    static const float bearings_rad[] = {0.539f, 0.541f, -0.539f, -0.541f};
    (void)state;
    for (int i = 0; i < 4; i++) {
        const struct rho_sensor sensor = {.sensor_id = 10,
                                          .pd = 0.9f,
                                          .range_max_m = 1e5f,
                                          .sector_from_rad = -0.5f,
                                          .sector_to_rad = 0.5f};
        const struct rho_bearing bearing = {.bearing_rad = bearings_rad[i], .sigma_rad = 0.01f};
        const struct rho_bearing_scan look_at = {
            .time_us = 1000000, .sensor_id = 10, .num_bearings = 1, .bearings = &bearing};
        const struct rho_frame frame = {.time_us = 1000000, .num_scans = 1, .scans = &look_at};
        random_state = 9;
        scene = scene_of(2, 1, 0.1, 1.0, 0.0);
        start_chain(5.0f);
        assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
        assert_int_equal(rho_tracker_step_frame(&tracker, NULL, &frame, &report), RHO_OK);
        assert_int_equal(tracker.counters.plots_outside, i % 2);
        assert_int_equal(report.fates[0] == RHO_FATE_INVALID, i % 2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_bearing_has_its_fate_in_its_place),
        cmocka_unit_test(bearings_beyond_the_sector_are_outside),
        cmocka_unit_test(a_lonely_bearing_is_no_ghost),
        cmocka_unit_test(counters_add_up_over_a_long_run),
        cmocka_unit_test(bearings_beyond_the_capacities_find_no_room),
        cmocka_unit_test(numbers_beyond_all_reason_do_no_harm),
        cmocka_unit_test(a_full_table_starts_no_track_and_keeps_the_bearings),
        cmocka_unit_test(a_late_frame_changes_nothing_but_counters),
        cmocka_unit_test(null_pointers_are_refused),
        cmocka_unit_test(what_was_never_initialised_is_refused),
        cmocka_unit_test(numbers_out_of_range_are_refused),
        cmocka_unit_test(what_the_batch_refuses_is_refused),
        cmocka_unit_test(without_an_initiation_tracks_go_on_and_none_start),
        cmocka_unit_test(a_frame_without_scans_is_a_frame),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
