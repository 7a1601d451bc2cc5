/* SPDX-License-Identifier: MIT */
/*
 * A rotating radar stepped sector by sector: targets at edges of sectors are seen once a turn,
 * tracks start as early as from whole turns, and reports are never older than a sector.
 */
#include "sectors_scene.h"

/* A scan by another radar of the whole circle, with plots of all targets. */
static void step_scan_of_other_radar(const struct scene *scene, int64_t time_us)
{
    struct rho_plot plots[TARGETS];
    const struct rho_scan scan = {
        .time_us = time_us, .sensor_id = 2, .num_plots = TARGETS, .plots = plots};

    for (int i = 0; i < TARGETS; i++) {
        plots[i] = target_plot(scene, i, (double)time_us * 1e-6, time_us);
    }
    assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
    assert_int_equal(report.fates_total[RHO_FATE_CLAIMED], TARGETS);
}

/* Tracks start from the window's plots, which count as hits, as do later plots. */
static void assert_all_seen_once(struct scene *scene, int turns)
{
    int plots = 0;

    fly_turns(scene, turns);
    assert_int_equal(report.num_tracks, TARGETS);
    for (int i = 0; i < TARGETS; i++) {
        const struct rho_track_report *track = track_of_target(scene, i);

        assert_non_null(track);
        assert_int_equal(track->status, RHO_TRACK_CONFIRMED);
        assert_int_equal(track->misses, 0);
        assert_int_equal(track->hits, scene->plots[i]);
        plots += scene->plots[i];
    }
    assert_int_equal(scene->fates[RHO_FATE_CLAIMED] + scene->fates[RHO_FATE_HELD], plots);
    assert_int_equal(tracker.counters.tracks_started, TARGETS);
    assert_int_equal(tracker.counters.plots_initiated, scene->fates[RHO_FATE_HELD]);
}

static void targets_at_sector_edges_are_seen_once_a_turn(void **state)
{
    (void)state;
    for (int turning = -1; turning <= 1; turning += 2) {
        for (int k = 0; k < 4; k++) {
            struct scene slow = {
                .turning = turning, .first_rad = 1.1 * k, .speed_mps = 20.0, .hidden = -1};
            struct scene with = {.turning = turning,
                                 .first_rad = -0.7 * k,
                                 .speed_mps = 120.0 * (k - 1.5),
                                 .hidden = -1};

            assert_all_seen_once(&slow, 12);
            assert_all_seen_once(&with, 20);
        }
    }
}

static void any_number_of_sectors_sees_targets_once_a_turn(void **state)
{
    const int numbers[] = {1, 3, 4, 8, 64, 128};
    (void)state;
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        struct scene scene = {
            .turning = -1, .speed_mps = 150.0, .hidden = -1, .sectors = numbers[i]};

        assert_all_seen_once(&scene, 14);
    }
}

/*
 * After a plot at the end of a sector, a plot at the beginning of the next one is not a second plot
 * of the same pass.
 */
static void a_track_takes_one_plot_per_pass_of_the_antenna(void **state)
{
    struct scene scene = {.turning = 1, .hidden = -1};
    uint32_t second = 0;
    (void)state;

    fly_turns(&scene, 10);
    for (int sector = 0; sector < SECTORS; sector++) {
        const struct rho_track_report *track;
        struct rho_plot plot;
        struct rho_scan scan = {.time_us = 10 * TURN_US + (sector + 1) * SECTOR_US,
                                .sensor_id = 1,
                                .sector_from_rad = (float)wrapped(2.0 * PI * sector / SECTORS),
                                .sector_to_rad = (float)wrapped(2.0 * PI * (sector + 1) / SECTORS),
                                .plots = &plot};

        if (sector % 4 < 2 && sector > 1) { /* two more plots of target sector / 4, at this edge */
            plot = target_plot(&scene, sector / 4, (double)scan.time_us * 1e-6, scan.time_us);
            scan.num_plots = 1;
        }
        assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
        if (sector % 4 == 1 && sector > 1) {
            track = track_of_target(&scene, sector / 4);
            assert_non_null(track);
            assert_int_equal(track->plot, -1);
            second += report.fates_total[RHO_FATE_HELD];
        }
    }
    assert_int_equal(second, TARGETS - 1);
    for (int i = 0; i < TARGETS; i++) {
        assert_true(track_of_target(&scene, i)->misses <= 1);
    }
}

/*
 * Another radar's plots between two sectors: a target seen at the edge still counts as seen in this
 * turn.
 */
static void scans_of_another_radar_between_sectors_change_nothing(void **state)
{
    (void)state;
    for (int turning = -1; turning <= 1; turning += 2) {
        struct scene scene = {.turning = turning, .hidden = -1, .sectors = SECTORS};

        start_tracker();
        for (int turn = 0; turn < 12; turn++) {
            for (int sector = 0; sector < SECTORS; sector++) {
                step_sector(&scene, turn, sector);
                if (turn >= 6 && sector % 4 == 0) {
                    step_scan_of_other_radar(&scene, report.time_us + SECTOR_US / 2);
                }
            }
        }
        assert_int_equal(report.num_tracks, TARGETS);
        for (int i = 0; i < TARGETS; i++) {
            assert_int_equal(track_of_target(&scene, i)->misses, 0);
        }
    }
}

/* A gone target is missed once a turn, wherever it is relative to the edges of sectors. */
static void misses_are_counted_once_a_turn(void **state)
{
    (void)state;
    for (int turning = -1; turning <= 1; turning += 2) {
        for (int target = 0; target < TARGETS; target++) {
            struct scene scene = {.turning = turning,
                                  .speed_mps = 40.0 * (target - 3),
                                  .hidden = target,
                                  .hidden_turn = 10};
            const struct rho_track_report *track;

            fly_turns(&scene, 12);
            track = track_of_target(&scene, target);
            assert_non_null(track);
            assert_in_range(track->misses, 1, 2); /* the edge of the turn is also one of a sector */
            assert_int_not_equal(track->status, RHO_TRACK_CONFIRMED);
        }
    }
}

/* Tracks start with the third plot, or as many as low clutter requires, as from whole turns. */
static void sectors_start_tracks_as_early_as_whole_turns(void **state)
{
    int first_turn[2] = {0, 0};
    (void)state;
    for (int k = 0; k < 2; k++) {
        struct scene scene = {
            .turning = 1, .speed_mps = 100.0, .hidden = -1, .sectors = k ? 1 : 32};

        start_tracker();
        for (int turn = 0; turn < 9 && report.num_tracks < TARGETS; turn++) {
            for (int sector = 0; sector < scene.sectors; sector++) {
                step_sector(&scene, turn, sector);
            }
            first_turn[k] = turn;
        }
        assert_int_equal(report.num_tracks, TARGETS);
    }
    assert_int_equal(first_turn[0], first_turn[1]);
}

/* A track's report is of the sector with its plot. */
static void tracks_are_reported_in_the_sector_of_their_plot(void **state)
{
    struct scene scene = {.turning = -1, .speed_mps = 100.0, .hidden = -1};
    int seen = 0;
    (void)state;

    fly_turns(&scene, 8);
    for (int sector = 0; sector < SECTORS; sector++) {
        uint32_t claimed = 0;

        step_sector(&scene, 8, sector);
        for (uint32_t i = 0; i < report.num_tracks; i++) {
            if (report.tracks[i].plot >= 0) {
                assert_in_range(report.tracks[i].update_age_us, 0, SECTOR_US);
                claimed++;
            }
        }
        assert_int_equal(claimed, report.fates_total[RHO_FATE_CLAIMED]);
        seen += (int)claimed;
    }
    assert_in_range(seen, TARGETS - 1, TARGETS + 1); /* one target may cross the turn's edge */
}

/* The window holds turns, not sectors: after a lost sector it begins another turn and goes on. */
static void lost_sectors_cost_no_track(void **state)
{
    struct scene scene = {.turning = 1, .speed_mps = 60.0, .hidden = -1, .sectors = SECTORS};
    (void)state;

    start_tracker();
    for (int turn = 0; turn < 14; turn++) {
        for (int sector = 0; sector < SECTORS; sector++) {
            if ((turn * SECTORS + sector) % 45 != 2) {
                step_sector(&scene, turn, sector);
            }
        }
    }
    assert_int_equal(report.num_tracks, TARGETS);
    assert_int_equal(tracker.counters.tracks_started, TARGETS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(targets_at_sector_edges_are_seen_once_a_turn),
        cmocka_unit_test(any_number_of_sectors_sees_targets_once_a_turn),
        cmocka_unit_test(a_track_takes_one_plot_per_pass_of_the_antenna),
        cmocka_unit_test(scans_of_another_radar_between_sectors_change_nothing),
        cmocka_unit_test(misses_are_counted_once_a_turn),
        cmocka_unit_test(sectors_start_tracks_as_early_as_whole_turns),
        cmocka_unit_test(tracks_are_reported_in_the_sector_of_their_plot),
        cmocka_unit_test(lost_sectors_cost_no_track),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
