/* SPDX-License-Identifier: MIT */
/*
 * A rotating radar stepped sector by sector: targets at the edges of sectors are seen once a turn, tracks start as early as from
 * whole turns, and what is reported is never older than a sector.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/tracker.h"

#define SECTORS 32
#define TURN_US INT64_C(4000000)
#define SECTOR_US (TURN_US / SECTORS)
#define TARGETS 8
#define PI 3.14159265358979323846

static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_report report;

/* A scene: which way the antenna turns (+1 counter-clockwise), where its first sector begins, and who is not seen. */
struct scene {
    int turning;
    double first_rad;
    double speed_mps; /* along the circle, counter-clockwise */
    int hidden;       /* a target that is not seen from `hidden_turn` on; -1: none */
    int hidden_turn;
    int sectors; /* a turn */
    /* what came of it */
    int plots[TARGETS];
    uint32_t fates[RHO_NUM_FATES];
};

static void start(void)
{
    struct rho_tracker_config config;
    struct rho_initiator_config start_config;
    const struct rho_sensor sensor = {.sensor_id = 1, .pd = 0.9f, .range_max_m = 80000.0f};

    memset(&report, 0, sizeof report);
    rho_tracker_config_default(&config);
    rho_initiator_config_default(&start_config);
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, &start_config), RHO_OK);
    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
}

static double range_of(int target)
{
    return 20000.0 + 4000.0 * target;
}

/* Target i starts at the edge of sectors 4 i and 4 i + 1, and flies along a circle about the radar. */
static double azimuth_of(const struct scene *scene, int target, double t_s)
{
    return scene->first_rad + 4.0 * target * 2.0 * PI / SECTORS +
           scene->speed_mps / range_of(target) * t_s;
}

static double wrapped(double angle_rad)
{
    return remainder(angle_rad, 2.0 * PI);
}

/* When the antenna passes it in a turn: the turn's own time, or less than 0 where that is in no such turn. */
static double time_of_pass(const struct scene *scene, int target, int turn)
{
    double turn_s = (double)TURN_US * 1e-6, t_s = turn * turn_s;

    for (int i = 0; i < 6; i++) {
        double way = scene->turning * (azimuth_of(scene, target, t_s) - scene->first_rad);

        way -= 2.0 * PI * floor(way / (2.0 * PI));
        t_s = (turn + way / (2.0 * PI)) * turn_s;
    }
    return t_s;
}

static struct rho_plot plot_of(const struct scene *scene, int target, double t_s, int64_t scan_us)
{
    double azimuth_rad = azimuth_of(scene, target, t_s), range_m = range_of(target);
    float noise = 10.0f * sinf(7.3f * (float)target + 1.9f * (float)t_s);

    return (struct rho_plot){.offset_us = (int32_t)(llround(t_s * 1e6) - scan_us),
                             .x_m = (float)((range_m + noise) * cos(azimuth_rad)),
                             .y_m = (float)((range_m + noise) * sin(azimuth_rad)),
                             .sigma_range_m = 15.0f,
                             .sigma_cross_m = (float)(0.003 * range_m)};
}

static int is_hidden(const struct scene *scene, int target, int turn)
{
    return target == scene->hidden && turn >= scene->hidden_turn;
}

/* One sector: at its end, with the plots that the antenna passed in it. */
static void step_sector(struct scene *scene, int turn, int sector)
{
    struct rho_plot plots[TARGETS];
    uint32_t count = 0;
    double width_rad = 2.0 * PI / scene->sectors;
    double edge_rad = scene->first_rad + scene->turning * sector * width_rad;
    int64_t sector_us = TURN_US / scene->sectors;
    int64_t from_us = turn * TURN_US + sector * sector_us, to_us = from_us + sector_us;

    for (int i = 0; i < TARGETS; i++) {
        for (int of = turn - 1; of <= turn + 1; of++) {
            double t_s = time_of_pass(scene, i, of);
            int64_t time_us = llround(t_s * 1e6);

            if (time_us >= from_us && time_us < to_us && !is_hidden(scene, i, turn)) {
                plots[count++] = plot_of(scene, i, t_s, to_us);
                scene->plots[i]++;
                break; /* the antenna is there once in a sector */
            }
        }
    }
    struct rho_scan scan = {
        .time_us = to_us,
        .sensor_id = 1,
        .sector_from_rad = (float)wrapped(scene->turning > 0 ? edge_rad : edge_rad - width_rad),
        .sector_to_rad = (float)wrapped(scene->turning > 0 ? edge_rad + width_rad : edge_rad),
        .num_plots = count,
        .plots = plots};
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
    for (int fate = 0; fate < RHO_NUM_FATES; fate++) {
        scene->fates[fate] += report.fates_total[fate];
    }
}

/* A scan of another radar, all round, of all targets. */
static void look_around(const struct scene *scene, int64_t time_us)
{
    struct rho_plot plots[TARGETS];
    const struct rho_scan scan = {
        .time_us = time_us, .sensor_id = 2, .num_plots = TARGETS, .plots = plots};

    for (int i = 0; i < TARGETS; i++) {
        plots[i] = plot_of(scene, i, (double)time_us * 1e-6, time_us);
    }
    assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
    assert_int_equal(report.fates_total[RHO_FATE_CLAIMED], TARGETS);
}

static void fly(struct scene *scene, int turns)
{
    if (scene->sectors == 0) {
        scene->sectors = SECTORS;
    }
    start();
    for (int turn = 0; turn < turns; turn++) {
        for (int sector = 0; sector < scene->sectors; sector++) {
            step_sector(scene, turn, sector);
        }
    }
}

/* The track of a target now; NULL: none is near. */
static const struct rho_track_report *track_of(const struct scene *scene, int target)
{
    double t_s = (double)report.time_us * 1e-6, azimuth_rad = azimuth_of(scene, target, t_s);
    double x_m = range_of(target) * cos(azimuth_rad), y_m = range_of(target) * sin(azimuth_rad);

    for (uint32_t i = 0; i < report.num_tracks; i++) {
        const struct rho_track_report *track = &report.tracks[i];

        if (hypot((double)track->state[0] - x_m, (double)track->state[1] - y_m) < 600.0) {
            return track;
        }
    }
    return NULL;
}

/* Tracks start with the window's plots: these are hits, the later plots too. */
static void assert_all_seen_once(struct scene *scene, int turns)
{
    int plots = 0;

    fly(scene, turns);
    assert_int_equal(report.num_tracks, TARGETS);
    for (int i = 0; i < TARGETS; i++) {
        const struct rho_track_report *track = track_of(scene, i);

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

static void targets_at_edges_are_seen_once_a_turn(void **state)
{
    (void)state;
    for (int turning = -1; turning <= 1; turning += 2) {
        for (int k = 0; k < 4; k++) {
            struct scene still = {.turning = turning, .first_rad = 1.1 * k, .hidden = -1};
            struct scene with = {.turning = turning,
                                 .first_rad = -0.7 * k,
                                 .speed_mps = 120.0 * (k - 1),
                                 .hidden = -1};

            assert_all_seen_once(&still, 12);
            assert_all_seen_once(&with, 20);
        }
    }
}

static void other_numbers_of_sectors_do_the_same(void **state)
{
    const int numbers[] = {1, 3, 4, 8, 64, 128};
    (void)state;
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        struct scene scene = {
            .turning = -1, .speed_mps = 150.0, .hidden = -1, .sectors = numbers[i]};

        assert_all_seen_once(&scene, 14);
    }
}

/* The antenna saw the target at the end of a sector; what comes at the beginning of the next one is not its second plot. */
static void a_track_takes_one_plot_a_pass(void **state)
{
    struct scene scene = {.turning = 1, .hidden = -1};
    uint32_t second = 0;
    (void)state;

    fly(&scene, 10);
    for (int sector = 0; sector < SECTORS; sector++) {
        const struct rho_track_report *track;
        struct rho_plot plot;
        struct rho_scan scan = {.time_us = 10 * TURN_US + (sector + 1) * SECTOR_US,
                                .sensor_id = 1,
                                .sector_from_rad = (float)wrapped(2.0 * PI * sector / SECTORS),
                                .sector_to_rad = (float)wrapped(2.0 * PI * (sector + 1) / SECTORS),
                                .plots = &plot};

        if (sector % 4 < 2 && sector > 1) { /* of target sector / 4, at this edge, twice */
            plot = plot_of(&scene, sector / 4, (double)scan.time_us * 1e-6, scan.time_us);
            scan.num_plots = 1;
        }
        assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
        if (sector % 4 == 1 && sector > 1) {
            track = track_of(&scene, sector / 4);
            assert_non_null(track);
            assert_int_equal(track->plot, -1);
            second += report.fates_total[RHO_FATE_HELD];
        }
    }
    assert_int_equal(second, TARGETS - 1);
    for (int i = 0; i < TARGETS; i++) {
        assert_true(track_of(&scene, i)->misses <= 1);
    }
}

/* Another radar's plots between two sectors: who was seen at the edge has been seen all the same. */
static void another_radar_in_between_changes_nothing(void **state)
{
    (void)state;
    for (int turning = -1; turning <= 1; turning += 2) {
        struct scene scene = {.turning = turning, .hidden = -1, .sectors = SECTORS};

        start();
        for (int turn = 0; turn < 12; turn++) {
            for (int sector = 0; sector < SECTORS; sector++) {
                step_sector(&scene, turn, sector);
                if (turn >= 6 && sector % 4 == 0) {
                    look_around(&scene, report.time_us + SECTOR_US / 2);
                }
            }
        }
        assert_int_equal(report.num_tracks, TARGETS);
        for (int i = 0; i < TARGETS; i++) {
            assert_int_equal(track_of(&scene, i)->misses, 0);
        }
    }
}

/* A target that is not there any more is missed once a turn, wherever it stands to the edges. */
static void misses_count_once_a_turn(void **state)
{
    (void)state;
    for (int turning = -1; turning <= 1; turning += 2) {
        for (int target = 0; target < TARGETS; target++) {
            struct scene scene = {.turning = turning,
                                  .speed_mps = 40.0 * (target - 3),
                                  .hidden = target,
                                  .hidden_turn = 10};
            const struct rho_track_report *track;

            fly(&scene, 12);
            track = track_of(&scene, target);
            assert_non_null(track);
            assert_in_range(track->misses, 1, 2); /* the edge of the turn is one of a sector, too */
            assert_int_equal(track->status, RHO_TRACK_COASTING);
        }
    }
}

/* As whole turns do: with the third plot, or as many as clear skies ask for. */
static void tracks_start_as_early_as_from_whole_turns(void **state)
{
    int first_turn[2] = {0, 0};
    (void)state;
    for (int k = 0; k < 2; k++) {
        struct scene scene = {
            .turning = 1, .speed_mps = 100.0, .hidden = -1, .sectors = k ? 1 : 32};

        start();
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

/* A track's report is of the sector that its plot came with. */
static void reports_keep_up_with_the_antenna(void **state)
{
    struct scene scene = {.turning = -1, .speed_mps = 100.0, .hidden = -1};
    int seen = 0;
    (void)state;

    fly(&scene, 8);
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
    assert_in_range(seen, TARGETS - 1, TARGETS + 1); /* one may move over the turn's edge */
}

/* The window holds turns, not sectors: a lost one begins another scan, and goes on. */
static void a_lost_sector_costs_little(void **state)
{
    struct scene scene = {.turning = 1, .speed_mps = 60.0, .hidden = -1, .sectors = SECTORS};
    (void)state;

    start();
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
        cmocka_unit_test(targets_at_edges_are_seen_once_a_turn),
        cmocka_unit_test(other_numbers_of_sectors_do_the_same),
        cmocka_unit_test(a_track_takes_one_plot_a_pass),
        cmocka_unit_test(another_radar_in_between_changes_nothing),
        cmocka_unit_test(misses_count_once_a_turn),
        cmocka_unit_test(tracks_start_as_early_as_from_whole_turns),
        cmocka_unit_test(reports_keep_up_with_the_antenna),
        cmocka_unit_test(a_lost_sector_costs_little),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
