/* SPDX-License-Identifier: MIT */
/*
 * Events within a turn of sectors: the radar is described anew or forgotten; sectors are not
 * searched, impossible, late, contain rows of earlier ones, or measure other things; more radars
 * than the table holds.
 */
#include "sectors_scene.h"

#include <float.h>

/* Turns until all targets have tracks. */
#define TURNS 10

static struct rho_tracker other_tracker;
static struct rho_initiator other_initiator;
static struct rho_report other_report;

static void copy_objects(void)
{
    other_tracker = tracker;
    other_initiator = initiator;
    other_report = report;
}

static void assert_unchanged(void)
{
    assert_memory_equal(&tracker, &other_tracker, sizeof tracker);
    assert_memory_equal(&initiator, &other_initiator, sizeof initiator);
    assert_memory_equal(&report, &other_report, sizeof report);
}

/* All targets have one track, with the hits that the scene gave them. */
static void assert_targets_tracked_with_all_hits(const struct scene *scene)
{
    assert_int_equal(report.num_tracks, TARGETS);
    assert_int_equal(tracker.counters.tracks_started, TARGETS);
    for (int i = 0; i < TARGETS; i++) {
        const struct rho_track_report *track = track_of_target(scene, i);

        assert_non_null(track);
        assert_int_equal(track->status, RHO_TRACK_CONFIRMED);
        assert_int_equal(track->hits, scene->plots[i]);
        assert_int_equal(track->misses, 0);
    }
}

/* ---- descriptions of the radar --------------------------------------------------------------- */

/* From from_turn on, the radar is described again at one sector of each turn. */
static void fly_and_describe_radar(struct scene *scene, int from_turn, int at_sector, float x_m,
                                   float pd)
{
    scene->sectors = SECTORS;
    start_tracker();
    for (int turn = 0; turn < 2 * TURNS; turn++) {
        for (int sector = 0; sector < SECTORS; sector++) {
            if (turn >= from_turn && sector == at_sector) {
                describe_sensor(1, x_m, pd);
            }
            step_sector(scene, turn, sector);
        }
    }
}

static void describing_a_radar_the_same_changes_nothing(void **state)
{
    struct scene without = {.turning = 1, .speed_mps = 80.0, .hidden = -1};
    (void)state;
    fly_turns(&without, 2 * TURNS);
    copy_objects();
    for (int at = 0; at < SECTORS; at += 5) {
        struct scene with = {.turning = 1, .speed_mps = 80.0, .hidden = -1};

        fly_and_describe_radar(&with, 0, at, 0.0f, 0.9f);
        assert_unchanged();
    }
}

/* Another P_D or another place: the turn of sectors goes on, no target is seen twice or missed. */
static void a_new_description_does_not_break_the_turn(void **state)
{
    const float pds[] = {0.5f, 0.9f, 0.99f}, places_m[] = {0.0f, 5.0f};
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        for (size_t k = 0; k < 2; k++) {
            for (int at = 0; at < SECTORS; at += 4) { /* described just before a target's sector */
                struct scene scene = {.turning = i == 1 ? -1 : 1, .speed_mps = 80.0, .hidden = -1};

                fly_and_describe_radar(&scene, 4, at, places_m[k], pds[i]);
                assert_targets_tracked_with_all_hits(&scene);
                assert_int_equal(rho_tracker_look_of(&tracker, 1)->count, 2 * TURNS * SECTORS);
            }
        }
    }
}

/*
 * Forgotten just after target 5, which is hidden until the new count of scans equals the old one at
 * its last sight: the old sight must not count for this pass.
 */
static void a_forgotten_radar_starts_a_new_turn(void **state)
{
    enum { TARGET = 5, QUARTERS = 4, SECTOR = 2, TURN = 4 };
    struct scene scene = {.turning = 1, .speed_mps = 80.0, .hidden = -1, .sectors = QUARTERS};
    (void)state;
    start_tracker();
    for (int turn = 0; turn <= 2 * TURN + 1; turn++) {
        for (int sector = 0; sector < QUARTERS; sector++) {
            const int is_past = turn > TURN || (turn == TURN && sector > SECTOR);
            const uint16_t seen = rho_tracker_look_of(&tracker, 1) != NULL
                                      ? rho_tracker_look_of(&tracker, 1)->count
                                      : 0;

            scene.hidden = turn <= 2 * TURN && is_past ? TARGET : -1;
            step_sector(&scene, turn, sector);
            if (turn == TURN && sector == SECTOR) {
                assert_true(track_of_target(&scene, TARGET)->plot >= 0);
                assert_int_equal(rho_tracker_forget_sensor(&tracker, 1), RHO_OK);
                assert_null(rho_tracker_look_of(&tracker, 1));
                describe_sensor(1, 0.0f, 0.9f);
            }
            if (turn == 2 * TURN + 1 && sector == SECTOR) {
                /* the same count as at its last sight */
                assert_int_equal(seen, QUARTERS * TURN + SECTOR + 1);
                assert_non_null(track_of_target(&scene, TARGET));
                assert_true(track_of_target(&scene, TARGET)->plot >= 0);
            }
        }
    }
}

/* More radars than the table holds: described ones keep their rows, and targets are seen by all. */
static void more_radars_than_the_table_holds_are_tracked(void **state)
{
    enum { SENSORS = RHO_MAX_SENSORS + 3 };
    struct scene scene = {.turning = 1, .speed_mps = 80.0, .hidden = -1};
    (void)state;
    start_tracker();
    for (int32_t id = 2; id <= RHO_MAX_SENSORS; id++) {
        describe_sensor(id, 0.0f, 0.9f);
    }
    other_tracker = tracker;
    const struct rho_sensor beyond = {.sensor_id = SENSORS, .pd = 0.9f, .range_max_m = 1e5f};
    assert_int_equal(rho_tracker_set_sensor(&tracker, &beyond), RHO_ERROR_CAPACITY);
    assert_memory_equal(&tracker, &other_tracker, sizeof tracker);
    for (int k = 0; k < 6 * SENSORS; k++) {
        struct rho_plot plots[TARGETS];
        const struct rho_scan scan = {.time_us = k * INT64_C(1000000),
                                      .sensor_id = 1 + k % SENSORS,
                                      .num_plots = TARGETS,
                                      .plots = plots};

        for (int i = 0; i < TARGETS; i++) {
            plots[i] = target_plot(&scene, i, k, scan.time_us);
            scene.plots[i]++;
        }
        step_scan(&scene, &scan);
        if (scan.sensor_id <= RHO_MAX_SENSORS) {
            assert_int_equal(rho_tracker_look_of(&tracker, scan.sensor_id)->time_us, scan.time_us);
        }
        assert_true(tracker.num_rows <= RHO_MAX_SENSORS);
    }
    assert_targets_tracked_with_all_hits(&scene);
    assert_int_equal(tracker.num_sensors, RHO_MAX_SENSORS);
    for (int32_t id = 1; id <= SENSORS; id++) { /* described sensors keep their rows */
        assert_int_equal(rho_tracker_look_of(&tracker, id) != NULL, id <= RHO_MAX_SENSORS);
    }
}

/* ---- unusual sectors ------------------------------------------------------------------------- */

/*
 * The antenna covers two eighths of its turn for long enough that misses would end the other tracks
 * twice.
 */
static void targets_in_unsearched_sectors_are_not_missed(void **state)
{
    (void)state;
    for (int turning = -1; turning <= 1; turning += 2) {
        struct scene scene = {.turning = turning, .speed_mps = 80.0, .hidden = -1};
        int before[TARGETS];

        fly_turns(&scene, TURNS);
        for (int i = 0; i < TARGETS; i++) {
            before[i] = track_of_target(&scene, i)->hits;
        }
        for (int turn = TURNS; turn < 2 * TURNS; turn++) {
            /* targets 2 and 3 at their edges 8 and 12 */
            for (int sector = 6; sector < 14; sector++) {
                step_sector(&scene, turn, sector);
            }
        }
        assert_int_equal(report.num_tracks, TARGETS);
        for (int i = 0; i < TARGETS; i++) {
            const struct rho_track_report *track = track_of_target(&scene, i);
            int edge = turning > 0 ? 4 * i : (SECTORS - 4 * i) % SECTORS;

            assert_non_null(track);
            assert_int_equal(track->status, RHO_TRACK_CONFIRMED);
            assert_int_equal(track->misses, 0);
            assert_int_equal(track->hits - before[i], edge == 8 || edge == 12 ? TURNS : 0);
        }
        step_sector(&scene, 2 * TURNS, 0); /* all are seen again in a full turn */
        for (int sector = 1; sector < SECTORS; sector++) {
            step_sector(&scene, 2 * TURNS, sector);
        }
        assert_targets_tracked_with_all_hits(&scene);
    }
}

static void impossible_sectors_are_refused(void **state)
{
    const float ends[] = {NAN, INFINITY, -INFINITY, FLT_MAX, -FLT_MAX, 6.3f, -6.3f};
    struct scene scene = {.turning = 1, .speed_mps = 80.0, .hidden = -1};
    struct rho_plot plots[TARGETS];
    uint8_t fates[TARGETS];
    uint32_t unused = 0;
    (void)state;
    fly_turns(&scene, TURNS);
    copy_objects();
    const struct rho_scan good = sector_scan(&scene, TURNS, 0, plots);
    for (size_t i = 0; i < 2 * sizeof ends / sizeof ends[0]; i++) {
        struct rho_scan bad = good;
        struct rho_bearing_scan bearings = {.time_us = good.time_us, .sensor_id = 1};

        *(i % 2 ? &bad.sector_from_rad : &bad.sector_to_rad) = ends[i / 2];
        bearings.sector_from_rad = bad.sector_from_rad;
        bearings.sector_to_rad = bad.sector_to_rad;
        assert_int_equal(rho_tracker_step(&tracker, &initiator, &bad, &report), RHO_ERROR_VALUE);
        assert_int_equal(rho_tracker_step(&tracker, NULL, &bad, &report), RHO_ERROR_VALUE);
        assert_int_equal(rho_tracker_step_bearings(&tracker, NULL, &bearings, &report),
                         RHO_ERROR_VALUE);
        assert_int_equal(rho_initiator_push(&initiator, &bad, NULL, fates, &unused),
                         RHO_ERROR_VALUE);
        bad.time_us -= TURN_US; /* a late sector, too */
        assert_int_equal(rho_tracker_step(&tracker, &initiator, &bad, &report), RHO_ERROR_VALUE);
        assert_unchanged();
    }
    /* the refused sector has left nothing in the turn */
    for (int sector = 0; sector < SECTORS; sector++) {
        step_sector(&scene, TURNS, sector);
    }
    scene.plots[0]--; /* the refused sector's plot was counted, too */
    assert_targets_tracked_with_all_hits(&scene);
}

/*
 * Two neighbouring sectors come in the wrong order, with a target at the edge between them or at
 * another edge.
 */
static void sectors_in_the_wrong_order_see_targets_once(void **state)
{
    (void)state;
    for (int turning = -1; turning <= 1; turning += 2) {
        for (int at = 7; at <= 9; at++) {
            struct scene scene = {
                .turning = turning, .speed_mps = 80.0, .hidden = -1, .sectors = SECTORS};

            fly_turns(&scene, TURNS);
            for (int turn = TURNS; turn < 2 * TURNS; turn++) {
                for (int sector = 0; sector < SECTORS; sector++) {
                    step_sector(&scene, turn,
                                sector == at       ? at + 1
                                : sector == at + 1 ? at
                                                   : sector);
                }
            }
            assert_int_equal(tracker.counters.scans_retrodicted, TURNS);
            assert_targets_tracked_with_all_hits(&scene);
        }
    }
}

/* A row comes up to three sectors late: it has one fate and starts no second track. */
static void a_late_row_of_an_earlier_sector_counts_once(void **state)
{
    (void)state;
    for (int late = 1; late <= 3; late++) {
        struct scene scene = {.turning = 1, .speed_mps = 80.0, .hidden = -1, .sectors = SECTORS};
        struct rho_plot kept[TARGETS];

        start_tracker();
        for (int turn = 0; turn < 2 * TURNS; turn++) {
            for (int sector = 0; sector < SECTORS; sector++) {
                struct rho_plot plots[TARGETS];
                struct rho_scan scan = sector_scan(&scene, turn, sector, plots);

                if (turn % 5 == 4 && sector == 12) { /* the sector of target 3 */
                    assert_int_equal(scan.num_plots, 1);
                    kept[0] = plots[0];
                    scan.num_plots = 0;
                } else if (turn % 5 == 4 && sector == 12 + late) {
                    plots[scan.num_plots] = kept[0];
                    plots[scan.num_plots++].offset_us -= late * (int32_t)SECTOR_US;
                }
                step_scan(&scene, &scan);
            }
        }
        assert_int_equal(report.num_tracks, TARGETS);
        assert_int_equal(tracker.counters.tracks_started, TARGETS);
        int plots = 0, hits = 0;
        for (int i = 0; i < TARGETS; i++) {
            plots += scene.plots[i];
            hits += track_of_target(&scene, i)->hits;
            assert_true(track_of_target(&scene, i)->hits <= scene.plots[i]);
            assert_true(i == 3 || track_of_target(&scene, i)->hits == scene.plots[i]);
        }
        assert_int_equal(scene.fates[RHO_FATE_CLAIMED] + scene.fates[RHO_FATE_HELD], plots);
        assert_int_equal(hits, scene.fates[RHO_FATE_CLAIMED] + tracker.counters.plots_initiated);
    }
}

/* ---- measurements of sectors ----------------------------------------------------------------- */

/* Every n-th sector with plots has range rates or heights; 0: none has. */
static void fly_with_some_measurements(struct scene *scene, int range_rates, int heights)
{
    scene->sectors = SECTORS;
    start_tracker();
    for (int turn = 0; turn < TURNS; turn++) {
        for (int sector = 0; sector < SECTORS; sector++) {
            struct rho_plot plots[TARGETS];
            struct rho_scan scan = sector_scan(scene, turn, sector, plots);

            if (scan.num_plots > 0 && range_rates > 0 && sector / 4 % range_rates == 0) {
                scan.measures |= RHO_MEASURES_RANGE_RATE;
            }
            if (scan.num_plots > 0 && heights > 0 && sector / 4 % heights == 0) {
                scan.measures |= RHO_MEASURES_Z;
            }
            for (uint32_t i = 0; i < scan.num_plots; i++) {
                plots[i].sigma_range_rate_mps =
                    1.0f; /* targets circle the radar, so their range rate is 0 */
                plots[i].sigma_up_m = 100.0f;
            }
            step_scan(scene, &scan);
        }
    }
}

/* Sectors without plots measure nothing, as rows of a file or an antenna's messages say. */
static void sectors_of_a_turn_may_measure_different_things(void **state)
{
    static const struct {
        int range_rates, heights;
    } cases[] = {{1, 0}, {0, 1}, {1, 1}, {2, 0}, {0, 2}, {3, 2}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct scene scene = {.turning = i % 2 ? 1 : -1, .speed_mps = 80.0, .hidden = -1};

        fly_with_some_measurements(&scene, cases[i].range_rates, cases[i].heights);
        assert_targets_tracked_with_all_hits(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(describing_a_radar_the_same_changes_nothing),
        cmocka_unit_test(a_new_description_does_not_break_the_turn),
        cmocka_unit_test(a_forgotten_radar_starts_a_new_turn),
        cmocka_unit_test(more_radars_than_the_table_holds_are_tracked),
        cmocka_unit_test(targets_in_unsearched_sectors_are_not_missed),
        cmocka_unit_test(impossible_sectors_are_refused),
        cmocka_unit_test(sectors_in_the_wrong_order_see_targets_once),
        cmocka_unit_test(a_late_row_of_an_earlier_sector_counts_once),
        cmocka_unit_test(sectors_of_a_turn_may_measure_different_things),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
