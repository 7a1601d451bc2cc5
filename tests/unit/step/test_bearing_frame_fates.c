/* SPDX-License-Identifier: MIT */
/*
 * Frames of bearings: the fate of each bearing, counters, capacities, late and refused frames, and
 * frames without initiation.
 */
#include "bearing_frame_chain.h"

#define NUM(array) (sizeof(array) / sizeof((array)[0]))

static struct rho_tracker tracker_then;
static struct rho_passive passive_then;
static struct rho_report report_then;
static struct rho_bearing many[3][RHO_MAX_PLOTS + 50];

/* A target coming in from the east, at 0.25 rad from sensor 0 and -0.09 rad from sensor 1. */
static const struct target incomer = {.x_m = 60e3, .y_m = 5e3, .vx_mps = -200.0, .vy_mps = 10.0};

/* Steps frames 0 .. 11 of that target, which is found and followed. */
static void track_incomer_for_twelve_frames(unsigned sensors)
{
    random_state = 9;
    scene = scene_of(sensors, 1, 0.1, 1.0, 0.0);
    scene.target[0] = incomer;
    start_chain(5.0f);
    fly_frames(0, 12, 10.0);
    assert_int_equal(report.num_tracks, 1);
}

static void copy_objects(void)
{
    tracker_then = tracker;
    passive_then = passive;
    report_then = report;
}

static void add_look_bearing(struct look *look, double bearing_rad)
{
    add_bearing(look, bearing_rad, 0.1 * DEG_RAD, -1);
}

/* ---- fates of bearings ----------------------------------------------------------------------- */

static void each_bearing_has_its_fate_in_its_row(void **state)
{
    (void)state;
    track_incomer_for_twelve_frames(2);
    see_frame(12, 120.0);
    struct look *look = scene.look[scene_slot_of(12)];
    add_look_bearing(&look[0], 0.0);
    look[0].bearings[1].bearing_rad = NAN;
    add_look_bearing(&look[0], -1.4); /* to the south, crosses no other bearing */
    add_look_bearing(&look[0], 0.5);  /* crosses the second sensor's first bearing */
    add_look_bearing(&look[0], 0.6);
    look[0].bearings[4].offset_us = RHO_LIMIT_OFFSET_US + 1;
    add_look_bearing(&look[0], 0.6);
    look[0].bearings[5].sigma_rad = 0.0f;
    while (look[0].count < RHO_MAX_BEARINGS + 2) {
        add_look_bearing(&look[0], 0.5 + 0.01 * look[0].count);
    }
    struct rho_bearing target = look[1].bearings[0];
    look[1].count = 0;
    add_look_bearing(&look[1], -0.5);
    add_look_bearing(&look[1], 2.0); /* to the other side of the base line */
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
    assert_int_equal(report.tracks[0].plot, 2); /* index in the last sensor's scan */
    assert_int_equal(report.tracks[0].sensor_id, 11);
    assert_int_equal(report.fates_total[RHO_FATE_GHOST], 2);
    /* the batch holds the bearings of fate CLAIMED, HELD or GHOST, and no others */
    const struct rho_batch_bearing *first = passive.batch.bearings[BATCH - 1][0];
    const struct rho_batch_bearing *other = passive.batch.bearings[BATCH - 1][1];
    assert_int_equal(passive.batch.num_bearings[BATCH - 1][0], RHO_MAX_BEARINGS - 3);
    assert_int_equal(passive.batch.num_bearings[BATCH - 1][1], 3);
    assert_int_equal(first[0].owner.track_id, report.tracks[0].track_id);
    assert_float_equal(first[1].bearing_rad, -1.4, 1e-6);
    assert_float_equal(first[2].bearing_rad, 0.5, 1e-6);
    assert_float_equal(other[0].bearing_rad, -0.5, 1e-6);
    assert_float_equal(other[1].bearing_rad, 2.0, 1e-6);
    assert_int_equal(other[2].owner.track_id, report.tracks[0].track_id);
    for (unsigned i = 0; i < 2; i++) {
        assert_int_equal(first[1 + i].owner.track_id + other[i].owner.track_id, 0);
    }
}

/* A bearing without any bearing of another sensor may be a target's: it is held. */
static void a_bearing_without_partners_is_held(void **state)
{
    (void)state;
    start_chain(5.0f);
    scene = scene_of(2, 0, 0.1, 1.0, 0.0);
    see_frame(0, 0.0);
    add_look_bearing(&scene.look[0][0], -1.4);
    fill_frame(&scene, 0, &full);
    step_frame(&full.frame);
    assert_int_equal(report.fates[0], RHO_FATE_HELD);
    add_look_bearing(&scene.look[0][1], 0.0);
    scene.look[0][1].bearings[0].sigma_rad = NAN; /* an invalid bearing */
    fill_frame(&scene, 0, &full);
    full.frame.time_us = 1;
    step_frame(&full.frame);
    assert_int_equal(report.fates[0], RHO_FATE_HELD);
    assert_int_equal(report.fates[1], RHO_FATE_INVALID);
}

/* Each held bearing started a track, left with the oldest frame, or is in the batch. */
static void fate_counters_add_up_over_a_long_run(void **state)
{
    (void)state;
    uint32_t frames = 0;
    random_state = 31;
    scene = scene_of(3, 3, 0.1, 0.9, 1.0);
    for (unsigned i = 0; i < 3; i++) {
        scene.target[i] = random_target(300.0);
    }
    start_chain(5.0f);
    for (unsigned k = 0; k < 60; k++) { /* targets also pass behind the sensors, where tracks end */
        fly_frame(k, 10.0);
        const struct rho_tracker_counters *counters = &tracker.counters;
        frames++;
        assert_int_equal(counters->scans_accepted, 3 * frames);
        assert_int_equal(counters->fates[RHO_FATE_HELD] + counters->fates[RHO_FATE_GHOST],
                         counters->plots_initiated + counters->plots_clutter +
                             count_bearings_of_track_in_batch(0));
        assert_int_equal(counters->tracks_started - counters->tracks_ended, report.num_tracks);
    }
    assert_int_equal(
        tracker.counters.fates[RHO_FATE_STALE] + tracker.counters.fates[RHO_FATE_INVALID], 0);
    assert_true(tracker.counters.fates[RHO_FATE_CLAIMED] > 100);
    assert_true(tracker.counters.fates[RHO_FATE_GHOST] > 10);
    assert_true(tracker.counters.plots_clutter > 50 && tracker.counters.plots_initiated > 20);
}

/* ---- bearings beyond the capacities ---------------------------------------------------------- */

/*
 * The batch's newest frame holds exactly this scan's bearings of fate HELD or GHOST, in their
 * order.
 */
static void expect_newest_batch_frame_holds_held_and_ghosts(unsigned sensor,
                                                            const struct rho_bearing_scan *scan)
{
    unsigned newest = passive.batch.num_scans - 1u, held = 0;
    for (uint32_t i = 0; i < scan->num_bearings && i < RHO_MAX_PLOTS; i++) {
        if (report.fates[i] == RHO_FATE_HELD || report.fates[i] == RHO_FATE_GHOST) {
            const struct rho_batch_bearing *bearing = &passive.batch.bearings[newest][sensor][held];
            assert_true(bearing->bearing_rad == scan->bearings[i].bearing_rad);
            held++;
        }
    }
    assert_int_equal(passive.batch.num_bearings[newest][sensor], held);
}

/* Steps three scans with so many bearings, which all cross those of the other sensors. */
static void step_three_bearing_scans_and_expect_fates(uint32_t num_0, uint32_t num_1,
                                                      uint32_t num_2)
{
    const uint32_t num[3] = {num_0, num_1, num_2};
    const float middle_rad[3] = {0.4f, -0.4f, -0.3f};
    start_chain(5.0f);
    scene = scene_of(3, 0, 0.1, 1.0, 0.0);
    for (unsigned s = 0; s < 3; s++) {
        for (unsigned i = 0; i < NUM(many[s]); i++) {
            many[s][i] = (struct rho_bearing){.bearing_rad = middle_rad[s] + 1e-5f * (float)i,
                                              .sigma_rad = 0.01f};
        }
        const struct rho_bearing_scan look = {.sensor_id = (int32_t)s,
                                              .x_m = (float)scene.sensor_x_m[s],
                                              .y_m = (float)scene.sensor_y_m[s],
                                              .num_bearings = num[s],
                                              .bearings = many[s]};
        step_frame(&(struct rho_frame){.num_scans = 1, .scans = &look});
        for (uint32_t i = 0; i < num[s] && i < RHO_MAX_PLOTS; i++) {
            assert_int_equal(report.fates[i],
                             i < RHO_MAX_BEARINGS ? RHO_FATE_HELD : RHO_FATE_NO_ROOM);
        }
        expect_newest_batch_frame_holds_held_and_ghosts(s, &look);
        assert_int_equal(report.fates_total[RHO_FATE_INVALID] + report.fates_total[RHO_FATE_GHOST],
                         0);
    }
}

static void bearings_beyond_the_capacities_get_fate_no_room(void **state)
{
    (void)state;
    step_three_bearing_scans_and_expect_fates(RHO_MAX_BEARINGS, RHO_MAX_BEARINGS + 1, 2);
    step_three_bearing_scans_and_expect_fates(RHO_MAX_BEARINGS + 7, 0, RHO_MAX_BEARINGS + 9);
    step_three_bearing_scans_and_expect_fates(RHO_MAX_PLOTS, 3, 4);
    step_three_bearing_scans_and_expect_fates(RHO_MAX_PLOTS + 40, 3, 4);
    step_three_bearing_scans_and_expect_fates(1, RHO_MAX_PLOTS + 40, 4);
}

/* The first bearings alone are read. */
static void absurd_numbers_of_bearings_do_no_harm(void **state)
{
    (void)state;
    start_chain(5.0f);
    for (unsigned i = 0; i < RHO_MAX_BEARINGS; i++) {
        many[0][i] = (struct rho_bearing){.bearing_rad = 0.1f * (float)i, .sigma_rad = 0.01f};
    }
    const struct rho_bearing_scan look = {.num_bearings = UINT32_MAX, .bearings = many[0]};
    assert_int_equal(rho_tracker_step_bearings(&tracker, &passive, &look, &report), RHO_OK);
    assert_int_equal(report.num_plots, UINT32_MAX);
    assert_int_equal(report.fates_total[RHO_FATE_HELD], RHO_MAX_BEARINGS);
    assert_int_equal(report.fates_total[RHO_FATE_NO_ROOM], UINT32_MAX - RHO_MAX_BEARINGS);
    expect_newest_batch_frame_holds_held_and_ghosts(0, &look);
}

/* The track table is full of tracks of plots in the west, where the passive sensors do not look. */
static void a_full_track_table_starts_no_track_and_holds_bearings(void **state)
{
    (void)state;
    static struct rho_initiator initiator;
    static struct rho_plot plots[RHO_MAX_TRACKS];
    struct rho_initiator_config config;
    if (RHO_MAX_TRACKS > RHO_MAX_PLOTS || RHO_MAX_TRACKS > 100) {
        skip(); /* a workstation's track table is too large to fill in a unit test */
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
        assert_int_equal(tracker.counters.tracks_no_room, k < ROWS_MIN - 1 ? 0 : k - ROWS_MIN + 2);
    }
    assert_int_equal(tracker.counters.tracks_started, RHO_MAX_TRACKS);
    assert_int_equal(count_bearings_of_track_in_batch(0), 2 * BATCH);
}

/* ---- late and refused frames, frames without initiation -------------------------------------- */

static void a_late_frame_changes_counters_only(void **state)
{
    (void)state;
    track_incomer_for_twelve_frames(2);
    copy_objects();
    see_frame(12, 109.999999);
    step_frame(&full.frame);
    assert_int_equal(report.fates_total[RHO_FATE_STALE], 2);
    assert_int_equal(report.fates[0] + report.fates[1], 2 * RHO_FATE_STALE);
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(report.tracks[0].hits, 24);
    assert_int_equal(tracker.counters.scans_late, 2);
    assert_int_equal(tracker.counters.scans_accepted, 24);
    assert_int_equal(tracker.counters.fates[RHO_FATE_STALE], 2);
    tracker.counters = tracker_then.counters;
    assert_memory_equal(&tracker, &tracker_then, sizeof tracker);
    assert_memory_equal(&passive, &passive_then, sizeof passive);
    fly_frame(12, 10.0);
    assert_int_equal(report.fates_total[RHO_FATE_CLAIMED], 2);
}

static void expect_refused_look(struct rho_passive *of, enum rho_status status)
{
    assert_int_equal(rho_tracker_step_bearings(&tracker, of, &full.scans[0], &report), status);
    assert_memory_equal(&tracker, &tracker_then, sizeof tracker);
    assert_memory_equal(&passive, &passive_then, sizeof passive);
    assert_memory_equal(&report, &report_then, sizeof report);
}

/* A good look that was never stepped, with one fault in it. */
#define EXPECT_REFUSED(change, status)                                                             \
    do {                                                                                           \
        fill_frame(&scene, scene_slot_of(12), &full);                                              \
        change;                                                                                    \
        expect_refused_look(&passive, status);                                                     \
    } while (0)

static void prepare_good_frame(void)
{
    track_incomer_for_twelve_frames(2);
    see_frame(12, 120.0);
    copy_objects();
}

static void null_pointers_are_refused(void **state)
{
    (void)state;
    prepare_good_frame();
    const struct rho_bearing_scan *look = &full.scans[0];
    assert_int_equal(rho_tracker_step_bearings(NULL, &passive, look, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_step_bearings(&tracker, &passive, NULL, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_step_bearings(&tracker, &passive, look, NULL), RHO_ERROR_NULL);
    EXPECT_REFUSED(full.scans[0].bearings = NULL, RHO_ERROR_NULL);
}

static void objects_never_initialised_are_refused(void **state)
{
    (void)state;
    prepare_good_frame();
    tracker.magic = tracker_then.magic = 0;
    EXPECT_REFUSED((void)0, RHO_ERROR_STATE);
    track_incomer_for_twelve_frames(2);
    see_frame(12, 120.0);
    passive.magic = 0;
    copy_objects();
    EXPECT_REFUSED((void)0, RHO_ERROR_STATE);
    expect_refused_look(&passive, RHO_ERROR_STATE);
}

static void numbers_out_of_range_are_refused(void **state)
{
    (void)state;
    const float bad_m[] = {NAN, INFINITY, -INFINITY, 2.1e6f};
    const float bad_rad[] = {NAN, INFINITY, 6.3f, -6.3f};
    prepare_good_frame();
    for (unsigned i = 0; i < NUM(bad_m); i++) {
        EXPECT_REFUSED(full.scans[0].x_m = bad_m[i], RHO_ERROR_VALUE);
        EXPECT_REFUSED(full.scans[0].y_m = bad_m[i], RHO_ERROR_VALUE);
        EXPECT_REFUSED(full.scans[0].z_m = bad_m[i], RHO_ERROR_VALUE);
        EXPECT_REFUSED(full.scans[0].sector_from_rad = bad_rad[i], RHO_ERROR_VALUE);
        EXPECT_REFUSED(full.scans[0].sector_to_rad = bad_rad[i], RHO_ERROR_VALUE);
    }
    EXPECT_REFUSED(full.scans[0].time_us = RHO_LIMIT_TIME_US + 1, RHO_ERROR_VALUE);
    EXPECT_REFUSED(full.scans[0].time_us = -RHO_LIMIT_TIME_US - 1, RHO_ERROR_VALUE);
    EXPECT_REFUSED(full.scans[0].time_us = INT64_MAX, RHO_ERROR_VALUE);
    EXPECT_REFUSED(full.scans[0].time_us = INT64_MIN, RHO_ERROR_VALUE);
}

static void looks_that_the_batch_refuses_are_refused(void **state)
{
    (void)state;
    prepare_good_frame();
    EXPECT_REFUSED(full.scans[0].time_us = 110000000, RHO_ERROR_STATE); /* a second look */
    track_incomer_for_twelve_frames(RHO_MAX_PASSIVE_SENSORS);
    see_frame(12, 120.0);
    copy_objects();
    EXPECT_REFUSED(full.scans[0].sensor_id = 99, RHO_ERROR_CAPACITY);
}

static void without_passive_initiation_tracks_go_on_and_none_start(void **state)
{
    (void)state;
    track_incomer_for_twelve_frames(2);
    passive_then = passive;
    scene.targets = 2;
    scene.target[1] = (struct target){.x_m = 30e3, .y_m = -20e3, .vx_mps = -100.0, .vy_mps = 90.0};
    for (unsigned k = 12; k < 24; k++) {
        see_frame(k, 10.0 * k);
        assert_int_equal(step_looks(&tracker, NULL, NULL, &full.frame, &report), RHO_OK);
        check_fate_counts_add_up(&full.frame);
        assert_int_equal(report.fates_total[RHO_FATE_CLAIMED], 2);
        assert_int_equal(report.fates_total[RHO_FATE_NO_ROOM], 2);
        assert_int_equal(report.num_tracks, 1);
        assert_int_equal(report.tracks[0].hits, 2 * (k + 1));
    }
    assert_memory_equal(&passive, &passive_then, sizeof passive);
    /* too many sensors do not matter without initiation */
    full.scans[0].sensor_id = 99;
    assert_int_equal(rho_tracker_step_bearings(&tracker, NULL, &full.scans[0], &report), RHO_OK);
    full.scans[0].x_m = NAN;
    assert_int_equal(rho_tracker_step_bearings(&tracker, NULL, &full.scans[0], &report),
                     RHO_ERROR_VALUE);
}

/* Bearings of 0.01 rad sigma are covered up to four sigmas beyond a sensor's sector. */
static void bearings_over_4_sigmas_beyond_the_sector_are_invalid(void **state)
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
        random_state = 9;
        scene = scene_of(2, 1, 0.1, 1.0, 0.0);
        start_chain(5.0f);
        assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
        assert_int_equal(rho_tracker_step_bearings(&tracker, NULL, &look_at, &report), RHO_OK);
        assert_int_equal(tracker.counters.plots_outside, i % 2);
        assert_int_equal(report.fates[0] == RHO_FATE_INVALID, i % 2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_bearing_has_its_fate_in_its_row),
        cmocka_unit_test(bearings_over_4_sigmas_beyond_the_sector_are_invalid),
        cmocka_unit_test(a_bearing_without_partners_is_held),
        cmocka_unit_test(fate_counters_add_up_over_a_long_run),
        cmocka_unit_test(bearings_beyond_the_capacities_get_fate_no_room),
        cmocka_unit_test(absurd_numbers_of_bearings_do_no_harm),
        cmocka_unit_test(a_full_track_table_starts_no_track_and_holds_bearings),
        cmocka_unit_test(a_late_frame_changes_counters_only),
        cmocka_unit_test(null_pointers_are_refused),
        cmocka_unit_test(objects_never_initialised_are_refused),
        cmocka_unit_test(numbers_out_of_range_are_refused),
        cmocka_unit_test(looks_that_the_batch_refuses_are_refused),
        cmocka_unit_test(without_passive_initiation_tracks_go_on_and_none_start),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
