/* SPDX-License-Identifier: MIT */
/*
 * Tracks end when no sensor sees them: targets that left, radars that are switched off; the
 * probability of existence behind it; plots beyond a stated coverage, and tracks faster than any
 * target.
 */
#include "../../src/tracker/step.h"
#include "tracker_setup.h"

#define PI 3.14159265358979323846
#define TARGETS_MAX 64
#define RADARS_MAX 3
#define EMPTY_S 600.0 /* seconds after the last target has left */

struct radar {
    double x_m, y_m, range_m, turn_s, sigma_m, sigma_rad, clutter;
    double sector_from_rad, sector_to_rad; /* equal angles: the whole circle */
    int sectors;                           /* scans in a turn */
    int is_described, is_off;
};

struct target {
    double x_m, y_m, vx_mps, vy_mps, born_s;
};

static struct radar radars[RADARS_MAX];
static struct target targets[TARGETS_MAX];
static int num_radars, num_targets;
static double now_s;
static int says_sector; /* scans state the radar's own sector */

/*
 * Rows reported: of believed tracks, of those far from any target seen lately (false), of those too
 * fast.
 */
static struct tally {
    unsigned rows, false_rows, fast_rows, scans, most_tracks;
    unsigned missing, present; /* well-covered targets without a track, and all */
} tally;

static struct radar radar_of_80_km(void)
{
    return (struct radar){.range_m = 80e3,
                          .turn_s = 4.0,
                          .sigma_m = 30.0,
                          .sigma_rad = 0.003,
                          .clutter = 50.0,
                          .sectors = 1,
                          .is_described = 1};
}

static void start_scene(uint64_t seed, double v_min_mps, double v_max_mps, double accel_mps2)
{
    use_usual_configs(seed);
    rho_tracker_config_default(&config);
    rho_initiator_config_default(&initiation);
    config.v_min_mps = initiation.v_min_mps = (float)v_min_mps;
    config.v_max_mps = initiation.v_max_mps = (float)v_max_mps;
    config.accel_max_mps2 = (float)accel_mps2;
    begin_tracker();
    memset(&tally, 0, sizeof tally);
    memset(targets, 0, sizeof targets);
    num_targets = 0;
    now_s = 0.0;
    for (int i = 0; i < num_radars; i++) {
        const struct rho_sensor sensor = {.sensor_id = i + 1,
                                          .x_m = (float)radars[i].x_m,
                                          .y_m = (float)radars[i].y_m,
                                          .pd = 0.9f,
                                          .range_max_m = (float)radars[i].range_m,
                                          .sector_from_rad = (float)radars[i].sector_from_rad,
                                          .sector_to_rad = (float)radars[i].sector_to_rad};
        if (radars[i].is_described) {
            assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
        }
    }
}

static double target_x_m(const struct target *target, double t_s)
{
    return target->x_m + target->vx_mps * t_s;
}

static double target_y_m(const struct target *target, double t_s)
{
    return target->y_m + target->vy_mps * t_s;
}

static int is_in_sector(double azimuth_rad, double from_rad, double to_rad)
{
    const double width =
        to_rad - from_rad <= 0.0 ? to_rad - from_rad + 2.0 * PI : to_rad - from_rad;
    double off = fmod(azimuth_rad - from_rad, 2.0 * PI);
    off += off < 0.0 ? 2.0 * PI : 0.0;
    return off < width;
}

/* Whether any radar that is on covers the target at that time; share: of its range. */
static int is_seen_by_any_radar(const struct target *target, double t_s, double share)
{
    for (int i = 0; i < num_radars; i++) {
        const struct radar *radar = &radars[i];
        const double dx_m = target_x_m(target, t_s) - radar->x_m,
                     dy_m = target_y_m(target, t_s) - radar->y_m;
        if (t_s >= target->born_s && !radar->is_off && hypot(dx_m, dy_m) < share * radar->range_m &&
            is_in_sector(atan2(dy_m, dx_m), radar->sector_from_rad, radar->sector_to_rad)) {
            return 1;
        }
    }
    return 0;
}

static void add_plot_at_range(const struct radar *radar, double range_m, double azimuth_rad)
{
    const double x_m = radar->x_m + range_m * cos(azimuth_rad);
    const double y_m = radar->y_m + range_m * sin(azimuth_rad);
    struct rho_plot *plot = add_plot(x_m, y_m, radar->sigma_m);
    plot->sigma_cross_m = (float)(range_m * radar->sigma_rad);
}

static unsigned draw_poisson(double mean)
{
    unsigned count = 0;
    for (double product = uniform(0.0, 1.0), least = exp(-mean); product > least; count++) {
        product *= uniform(0.0, 1.0);
    }
    return count;
}

/* Steps one scan of a radar, or of one of its sectors. */
static void step_radar_scan(int which, double from_rad, double to_rad)
{
    const struct radar *radar = &radars[which];
    const int is_part = radar->sectors > 1;
    const double first_rad = is_part ? from_rad : radar->sector_from_rad;
    const double last_rad = is_part ? to_rad : radar->sector_to_rad;
    double width_rad = last_rad - first_rad;
    width_rad += width_rad <= 0.0 ? 2.0 * PI : 0.0;
    for (int i = 0; i < num_targets; i++) {
        const double dx_m = target_x_m(&targets[i], now_s) - radar->x_m;
        const double dy_m = target_y_m(&targets[i], now_s) - radar->y_m;
        const double range_m = hypot(dx_m, dy_m) + radar->sigma_m * normal();
        const double azimuth_rad = atan2(dy_m, dx_m) + radar->sigma_rad * normal();
        const int is_seen = uniform(0.0, 1.0) < 0.9;
        if (is_seen && now_s >= targets[i].born_s && hypot(dx_m, dy_m) < radar->range_m &&
            is_in_sector(atan2(dy_m, dx_m), first_rad, last_rad)) {
            add_plot_at_range(radar, range_m, azimuth_rad);
        }
    }
    const unsigned clutter = draw_poisson(radar->clutter * width_rad / (2.0 * PI));
    for (unsigned i = 0; i < clutter; i++) {
        const double range_m = uniform(0.01, 1.0) * radar->range_m;
        add_plot_at_range(radar, range_m, uniform(first_rad, first_rad + width_rad));
    }
    const int says = is_part || says_sector;
    step_scan(
        (struct rho_scan){.time_us = llround(now_s * 1e6),
                          .sensor_id = which + 1,
                          .sector_from_rad = (float)(says ? remainder(first_rad, 2.0 * PI) : 0.0),
                          .sector_to_rad = (float)(says ? remainder(last_rad, 2.0 * PI) : 0.0)});
}

static int is_confirmed_or_coasting(const struct rho_track_report *track)
{
    return track->status == RHO_TRACK_CONFIRMED || track->status == RHO_TRACK_COASTING;
}

static const struct rho_track_report *
first_confirmed_or_coasting_track_within(const struct target *target, double most_m)
{
    for (unsigned i = 0; i < report.num_tracks; i++) {
        const struct rho_track_report *track = &report.tracks[i];
        if (is_confirmed_or_coasting(track) &&
            hypot((double)track->state[0] - target_x_m(target, now_s),
                  (double)track->state[1] - target_y_m(target, now_s)) < most_m) {
            return track;
        }
    }
    return NULL;
}

/* Rows near a target that left do not count as false for six more turns. */
static void tally_false_and_missing_tracks_of_report(double range_m, double turn_s)
{
    tally.scans++;
    tally.most_tracks =
        report.num_tracks > tally.most_tracks ? report.num_tracks : tally.most_tracks;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        const struct rho_track_report *track = &report.tracks[i];
        int has_target = 0;
        for (int k = 0; k < num_targets; k++) {
            int was_inside = 0;
            for (int back = 0; back <= 6; back++) {
                was_inside |= is_seen_by_any_radar(&targets[k], now_s - back * turn_s, 1.0);
            }
            has_target |=
                was_inside && hypot((double)track->state[0] - target_x_m(&targets[k], now_s),
                                    (double)track->state[1] - target_y_m(&targets[k], now_s)) <
                                  0.0125 * range_m + 3.0 * (double)track->sigma_m;
        }
        const double speed_mps = hypot((double)track->state[3], (double)track->state[4]);
        tally.rows += is_confirmed_or_coasting(track);
        tally.false_rows += is_confirmed_or_coasting(track) && !has_target;
        tally.fast_rows +=
            is_confirmed_or_coasting(track) && speed_mps > 1.1 * (double)config.v_max_mps;
    }
    for (int k = 0; k < num_targets; k++) {
        if (is_seen_by_any_radar(&targets[k], now_s, 0.97) &&
            is_seen_by_any_radar(&targets[k], now_s - 6.0 * turn_s, 0.97)) {
            tally.present++;
            tally.missing +=
                !first_confirmed_or_coasting_track_within(&targets[k], 0.0125 * range_m);
        }
    }
}

/* Steps turns of all radars, which have the same period, interleaved within it. */
static void step_all_until(double until_s)
{
    const double begin_s = now_s;
    for (int turn = 0; begin_s + (turn + 1) * radars[0].turn_s <= until_s + 1e-9; turn++) {
        for (int i = 0; i < num_radars; i++) {
            for (int sector = 0; sector < radars[i].sectors && !radars[i].is_off; sector++) {
                const double width_rad = 2.0 * PI / radars[i].sectors;
                now_s =
                    begin_s + radars[0].turn_s * (turn + (double)i / num_radars +
                                                  (double)sector / radars[i].sectors / num_radars);
                step_radar_scan(i, -PI + width_rad * sector, -PI + width_rad * (sector + 1));
            }
        }
        tally_false_and_missing_tracks_of_report(radars[0].range_m, radars[0].turn_s);
        now_s = begin_s + radars[0].turn_s * (turn + 1);
    }
}

/* Targets fly outwards from the middle and have left after 300 s. */
static void add_leaving_targets(int count, double range_m, double speed_mps)
{
    for (int i = 0; i < count; i++) {
        const double heading_rad = uniform(-PI, PI);
        const double from_m = range_m - speed_mps * uniform(100.0, 250.0);
        targets[num_targets++] =
            (struct target){from_m * cos(heading_rad), from_m * sin(heading_rad),
                            speed_mps * cos(heading_rad), speed_mps * sin(heading_rad), 0.0};
    }
}

static unsigned count_confirmed_or_coasting_tracks(void)
{
    unsigned count = 0;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        count += is_confirmed_or_coasting(&report.tracks[i]);
    }
    return count;
}

static void print_tally(const char *what)
{
    print_message("%s: %.3f false a scan, %u of %u rows too fast, missing %.3f, at most %u tracks, "
                  "%u at the end\n",
                  what, (double)tally.false_rows / tally.scans, tally.fast_rows, tally.rows,
                  (double)tally.missing / (tally.present ? tally.present : 1), tally.most_tracks,
                  report.num_tracks);
}

/* ---- targets that leave the coverage --------------------------------------------------------- */

static void expect_no_track_after(const char *what, uint64_t seed, double speed_mps,
                                  double v_max_mps, double accel_mps2)
{
    start_scene(seed, 0.1 * speed_mps, v_max_mps, accel_mps2);
    add_leaving_targets(8, radars[0].range_m, speed_mps);
    step_all_until(270.0);
    const uint32_t newest = tracker.next_track_id;
    step_all_until(300.0 + EMPTY_S);
    print_tally(what);
    assert_true(tracker.counters.tracks_confirmed >= 6);
    assert_int_equal(count_confirmed_or_coasting_tracks(), 0);
    for (unsigned i = 0; i < report.num_tracks; i++) {
        assert_true(report.tracks[i].track_id >= newest);
    }
    assert_true((double)tally.false_rows / tally.scans < 0.08);
    assert_true(tally.fast_rows * 100 <= tally.rows);
}

static void no_track_is_left_ten_minutes_after_the_last_target(void **state)
{
    (void)state;
    num_radars = 1;
    for (int is_described = 0; is_described < 2; is_described++) {
        for (uint64_t seed = 1; seed <= 3; seed++) {
            radars[0] = radar_of_80_km();
            radars[0].is_described = is_described;
            expect_no_track_after(is_described ? "turns, described" : "turns", seed, 250.0, 350.0,
                                  20.0);
            if (RHO_SECTORS) {
                radars[0].sectors = 8;
                expect_no_track_after(is_described ? "sectors, described" : "sectors", seed, 250.0,
                                      350.0, 20.0);
            }
        }
    }
}

/*
 * A 24 GHz radar: 20 scans a second of a sector of 2 rad, 80 m; cars at 2 to 20 m/s leave at its
 * end and sides.
 */
static void a_short_range_sector_radar_keeps_no_track_of_gone_cars(void **state)
{
    (void)state;
    num_radars = 1;
    for (int kind = 0; kind < 3; kind++) {
        for (uint64_t seed = 1; seed <= 3; seed++) {
            radars[0] = (struct radar){.range_m = 80.0,
                                       .turn_s = 0.05,
                                       .sigma_m = 0.3,
                                       .sigma_rad = 0.01,
                                       .clutter = 6.0,
                                       .sector_from_rad = -1.0,
                                       .sector_to_rad = 1.0,
                                       .sectors = 1,
                                       .is_described = kind == 0};
            says_sector = kind == 2;
            start_scene(seed, 0.5, 40.0, 8.0);
            for (int i = 0; i < 12; i++) {
                const double range_m = uniform(10.0, 60.0), azimuth_rad = uniform(-0.9, 0.9);
                const double speed_mps = uniform(2.0, 20.0), heading_rad = uniform(-PI, PI);
                targets[num_targets++] = (struct target){
                    range_m * cos(azimuth_rad), range_m * sin(azimuth_rad),
                    speed_mps * cos(heading_rad), speed_mps * sin(heading_rad), 0.0};
            }
            step_all_until(60.0);
            const uint32_t newest = tracker.next_track_id;
            step_all_until(60.0 + 0.2 * EMPTY_S);
            print_tally(kind == 0   ? "24 GHz, described"
                        : kind == 1 ? "24 GHz"
                                    : "24 GHz, scans of a sector");
            says_sector = 0;
            assert_true(tracker.counters.tracks_confirmed >= 8);
            for (unsigned i = 0; i < report.num_tracks; i++) {
                assert_true(report.tracks[i].track_id >= newest);
            }
        }
    }
}

/* ---- radars that are silent ------------------------------------------------------------------ */

static void add_crossing_targets(int count, double range_m)
{
    for (int i = 0; i < count; i++) {
        const double heading_rad = uniform(-PI, PI), speed_mps = uniform(100.0, 300.0);
        const double off_m = uniform(-0.5, 0.5) * range_m, along_m = uniform(-0.7, -0.2) * range_m;
        targets[num_targets++] =
            (struct target){along_m * cos(heading_rad) - off_m * sin(heading_rad),
                            along_m * sin(heading_rad) + off_m * cos(heading_rad),
                            speed_mps * cos(heading_rad), speed_mps * sin(heading_rad), 0.0};
    }
}

static void tracks_survive_a_minute_without_the_radar(void **state)
{
    (void)state;
    num_radars = 1;
    unsigned kept = 0, found = 0, all = 0, false_rows = 0, scans = 0;
    for (int is_described = 0; is_described < 2; is_described++) {
        for (uint64_t seed = 1; seed <= 5; seed++) {
            uint32_t ids[TARGETS_MAX];
            radars[0] = radar_of_80_km();
            radars[0].range_m = 120e3;
            radars[0].is_described = is_described;
            start_scene(seed, 30.0, 350.0, 20.0);
            add_crossing_targets(20, 120e3);
            step_all_until(100.0);
            for (int i = 0; i < num_targets; i++) {
                const struct rho_track_report *track =
                    first_confirmed_or_coasting_track_within(&targets[i], 1500.0);
                ids[i] = track ? track->track_id : 0;
            }
            now_s += 60.0;
            memset(&tally, 0, sizeof tally);
            step_all_until(now_s + 16.0);
            for (int i = 0; i < num_targets; i++) {
                const struct rho_track_report *track =
                    first_confirmed_or_coasting_track_within(&targets[i], 1500.0);
                kept += track && track->track_id == ids[i];
                found += track != NULL;
                all++;
            }
            step_all_until(now_s + 40.0);
            false_rows += tally.false_rows;
            scans += tally.scans;
            print_tally("a minute's outage");
        }
    }
    print_message("kept %u, there after four turns %u of %u, false %.3f\n", kept, found, all,
                  (double)false_rows / scans);
    assert_true(found * 100 >= all * 90);
    assert_true((double)false_rows / scans < 0.1);
}

/* One scan: a straight target, seen or not, and clutter far from it. */
static void step_scan_of_one_target(double t_s, int is_seen, int clutter)
{
    if (is_seen) {
        const double x_m = -40e3 + 200.0 * t_s + 30.0 * normal();
        add_plot(x_m, 20e3 + 30.0 * normal(), 30.0);
    }
    for (int i = 0; i < clutter; i++) {
        const double x_m = uniform(-60e3, 60e3);
        add_plot(x_m, uniform(-60e3, -10e3), 30.0);
    }
    step_scan((struct rho_scan){.time_us = llround(t_s * 1e6), .sensor_id = 1});
}

/* The radar is off for a minute and then misses the target `misses` times. */
static void miss_after_radar_was_off(uint64_t seed, int misses, int clutter)
{
    double t_s = 0.0;
    start_scene(seed, 30.0, 350.0, 20.0);
    for (; t_s < 120.0; t_s += 4.0) {
        step_scan_of_one_target(t_s, 1, clutter);
    }
    const uint32_t id = report.tracks[0].track_id;
    assert_int_equal(report_of(id)->status, RHO_TRACK_CONFIRMED);
    t_s += 60.0;
    for (int k = 1; k <= misses; k++, t_s += 4.0) {
        step_scan_of_one_target(t_s, 0, clutter);
        assert_non_null(report_of(id));
    }
    for (int k = 0; k < 5; k++, t_s += 4.0) {
        step_scan_of_one_target(t_s, 1, clutter);
        assert_non_null(report_of(id));
        if (k > 0 || clutter < 100) { /* the first plot amid dense clutter may be any of many */
            assert_int_equal(report_of(id)->plot, 0);
        }
    }
    assert_int_equal(report_of(id)->status, RHO_TRACK_CONFIRMED);
}

static void a_target_missed_after_a_radar_pause_keeps_its_track(void **state)
{
    (void)state;
    num_radars = 1;
    for (int is_described = 0; is_described < 2; is_described++) {
        radars[0] = radar_of_80_km();
        radars[0].is_described = is_described;
        for (uint64_t seed = 1; seed <= 5; seed++) {
            for (int misses = 0; misses <= 2; misses++) {
                miss_after_radar_was_off(seed, misses, 6);
            }
            if (RHO_MAX_PLOTS > 300) {
                miss_after_radar_was_off(seed, 1, 300);
            }
        }
    }
}

/* ---- the probability that the target exists -------------------------------------------------- */

/* Starts a scene and sees a target in 12 scans; returns its track. */
static uint32_t see_target_in_12_scans(double *t_s)
{
    start_scene(7, 30.0, 350.0, 20.0);
    for (int k = 0; k < 12; k++, *t_s += 4.0) {
        step_scan_of_one_target(*t_s, 1, 2);
    }
    assert_int_equal(report.num_tracks, 1);
    return report.tracks[0].track_id;
}

/* In a pause of the radar the target may have gone or been hidden: fewer misses end its track. */
static void a_pause_of_the_radar_counts_as_scans_that_passed(void **state)
{
    int misses[2] = {0, 0};
    (void)state;
    num_radars = 1;
    radars[0] = radar_of_80_km();
    for (int i = 0; i < 2; i++) {
        double t_s = 0.0;
        const uint32_t id = see_target_in_12_scans(&t_s);
        for (t_s += i ? 60.0 : 0.0; report_of(id) && misses[i] < 20; t_s += 4.0) {
            step_scan_of_one_target(t_s, 0, 2);
            misses[i]++;
        }
    }
    assert_in_range(misses[0], 12, 16);
    assert_in_range(misses[1], 3, misses[0] - 2);
}

/* The established track of a target behind a hill for forty seconds goes on; 18 misses end it. */
static void an_established_target_hidden_for_a_while_keeps_its_identity(void **state)
{
    static const int missed[] = {9, 10, 18};
    (void)state;
    num_radars = 1;
    radars[0] = radar_of_80_km();
    for (int i = 0; i < 3; i++) {
        double t_s = 0.0;
        start_scene(7, 30.0, 350.0, 20.0);
        for (int k = 0; k < 24; k++, t_s += 4.0) {
            step_scan_of_one_target(t_s, 1, 6);
        }
        const uint32_t id = report.tracks[0].track_id;
        for (int k = 1; k <= missed[i]; k++, t_s += 4.0) {
            step_scan_of_one_target(t_s, 0, 6);
            const struct rho_track_report *track = report_of(id);
            assert_true(!track || k < 5 || track->status == RHO_TRACK_TENTATIVE);
        }
        assert_int_equal(report_of(id) != NULL, missed[i] < 18);
        for (int k = 0; k < 3; k++, t_s += 4.0) {
            step_scan_of_one_target(t_s, 1, 6);
        }
        assert_int_equal(report_of(id) != NULL, missed[i] < 18);
        assert_true(missed[i] == 18 || report_of(id)->status == RHO_TRACK_CONFIRMED);
    }
}

/* Eight targets abreast, seen for 120 s by a radar without clutter. */
static void see_eight_targets_abreast(uint64_t seed)
{
    num_radars = 1;
    radars[0] = radar_of_80_km();
    radars[0].range_m = 150e3;
    radars[0].clutter = 0.0;
    start_scene(seed, 30.0, 350.0, 20.0);
    for (int i = 0; i < 8; i++) {
        targets[num_targets++] = (struct target){-100e3, -60e3 + 12e3 * i, 200.0, 0.0, 0.0};
    }
    step_all_until(120.0);
    assert_int_equal(count_confirmed_or_coasting_tracks(), 8);
}

/* Of four scans without any plot the radar is the cause; a target missed alone has rather gone. */
static void misses_of_all_tracks_are_the_radars(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 5; seed++) {
        for (int missed = 1; missed <= 8; missed += 7) {
            see_eight_targets_abreast(seed);
            const uint32_t newest = tracker.next_track_id;
            for (int i = 0; i < missed; i++) {
                targets[i].born_s = 1e9;
            }
            step_all_until(now_s + 16.0);
            unsigned shown = 0;
            for (int i = 0; i < missed; i++) {
                shown += first_confirmed_or_coasting_track_within(&targets[i], 3000.0) != NULL;
                targets[i].born_s = 0.0;
            }
            assert_int_equal(shown, missed == 1 ? 0 : 8);
            step_all_until(now_s + 12.0);
            assert_int_equal(count_confirmed_or_coasting_tracks(), 8);
            assert_int_equal(tracker.next_track_id, newest);
        }
    }
}

/* All targets leave at once: their tracks may be shown for the coasting time and three misses. */
static void targets_that_leave_together_soon_lose_their_tracks(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 5; seed++) {
        see_eight_targets_abreast(seed);
        num_targets = 0;
        for (int k = 1; k <= 20; k++) {
            step_all_until(now_s + 4.0);
            assert_true(k < 9 || count_confirmed_or_coasting_tracks() == 0);
        }
        assert_int_equal(report.num_tracks, 0);
    }
}

/* One of two radars is switched off for good; the other one sees none or some of its targets. */
static void tracks_end_when_their_radar_is_switched_off(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        for (int is_described = 0; is_described < 2; is_described++) {
            num_radars = 2;
            radars[0] = radars[1] = radar_of_80_km();
            radars[0].is_described = radars[1].is_described = is_described;
            radars[1].x_m = 140e3; /* coverages overlap by 20 km */
            radars[0].is_off = radars[1].is_off = 0;
            start_scene(seed, 30.0, 350.0, 20.0);
            add_crossing_targets(12, 80e3);
            step_all_until(120.0);
            const uint32_t newest = tracker.next_track_id;
            const unsigned tracks = report.num_tracks;
            for (int i = 0; i < num_targets; i++) {
                targets[i].born_s = 1e9; /* no target is left */
            }
            radars[0].is_off = 1;
            step_all_until(240.0); /* more than four times the longest coasting */
            assert_true(tracks >= 10);
            for (unsigned i = 0; i < report.num_tracks; i++) {
                assert_true(report.tracks[i].track_id >= newest);
            }
            /* described radars cover their own area alone, others are taken to look everywhere */
            assert_true(!is_described || tracker.counters.tracks_unseen > 0);
        }
    }
}

/*
 * A radar is silent for ten minutes: no track of the targets gone by then is shown any more, and
 * none is left after ten scans.
 */
static void after_ten_silent_minutes_no_old_track_is_left(void **state)
{
    (void)state;
    num_radars = 1;
    for (int is_described = 0; is_described < 2; is_described++) {
        for (uint64_t seed = 1; seed <= 3; seed++) {
            radars[0] = radar_of_80_km();
            radars[0].is_described = is_described;
            start_scene(seed, 30.0, 350.0, 20.0);
            add_crossing_targets(12, 80e3);
            step_all_until(120.0);
            const uint32_t newest = tracker.next_track_id;
            num_targets = 0;
            now_s += EMPTY_S;
            for (int turn = 0; turn < 10; turn++) {
                step_all_until(now_s + 4.0);
                for (unsigned i = 0; i < report.num_tracks; i++) {
                    assert_false(is_confirmed_or_coasting(&report.tracks[i]) &&
                                 report.tracks[i].track_id < newest);
                }
            }
            for (unsigned i = 0; i < report.num_tracks; i++) {
                assert_true(report.tracks[i].track_id >= newest);
            }
        }
    }
}

/* Two radars out of step: targets are tracked across both coverages, and tracks end behind them. */
static void targets_are_tracked_through_the_coverage_of_two_radars(void **state)
{
    (void)state;
    unsigned missing = 0, present = 0, false_rows = 0, scans = 0;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        num_radars = 2;
        radars[0] = radars[1] = radar_of_80_km();
        radars[1].x_m = 80e3;
        start_scene(seed, 30.0, 350.0, 20.0);
        for (int i = 0; i < 20; i++) {
            targets[num_targets++] =
                (struct target){-90e3 + 12e3 * (i % 5), uniform(-40e3, 40e3), uniform(200.0, 300.0),
                                uniform(-30.0, 30.0), 0.0};
        }
        step_all_until(900.0);
        print_tally("two radars");
        missing += tally.missing;
        present += tally.present;
        false_rows += tally.false_rows;
        scans += tally.scans;
    }
    assert_true(missing * 100 < present * 3);
    assert_true((double)false_rows / scans < 0.1);
}

/*
 * Forty minutes of targets that come and go, three or four at a time: an embedded tracker's slots
 * must suffice.
 */
static void tracks_of_gone_targets_free_their_slots(void **state)
{
    (void)state;
    num_radars = 1;
    radars[0] = radar_of_80_km();
    start_scene(1, 30.0, 350.0, 20.0);
    for (int i = 0; i < TARGETS_MAX; i++) {
        const double heading_rad = uniform(-PI, PI), off_m = uniform(-70e3, 70e3);
        const double along_m = -sqrt(80e3 * 80e3 - off_m * off_m), born_s = 37.0 * i;
        struct target target = {along_m * cos(heading_rad) - off_m * sin(heading_rad),
                                along_m * sin(heading_rad) + off_m * cos(heading_rad),
                                300.0 * cos(heading_rad), 300.0 * sin(heading_rad), born_s};
        target.x_m -= born_s * target.vx_mps;
        target.y_m -= born_s * target.vy_mps;
        targets[num_targets++] = target;
    }
    step_all_until(2400.0);
    print_tally("come and go");
    assert_int_equal(tracker.counters.tracks_no_room, 0);
    assert_true(tally.most_tracks < 32);
    assert_true(tally.missing * 100 < tally.present * 3);
    assert_true((double)tally.false_rows / tally.scans < 0.1);
}

/* ---- plots and tracks beyond limits ---------------------------------------------------------- */

/*
 * The fate of a plot at that range and azimuth, of a radar of 10 to 80 km that covers -1 to 1 rad;
 * heights count for the least range.
 */
static void expect_fate_of_plot_at(double range_m, double azimuth_rad, int fate)
{
    const uint32_t outside = tracker.counters.plots_outside;
    add_plot_at_range(&radars[0], range_m, azimuth_rad);
    now_s += 4.0;
    step_scan((struct rho_scan){.time_us = llround(now_s * 1e6), .sensor_id = 1});
    assert_int_equal(report.fates[0], fate);
    assert_int_equal(report.fates_total[fate], 1);
    assert_int_equal(tracker.counters.plots_outside - outside, fate == RHO_FATE_INVALID);
    assert_int_equal(tracker.counters.fates[RHO_FATE_INVALID], tracker.counters.plots_outside);
}

static void plots_beyond_a_stated_coverage_are_invalid(void **state)
{
    (void)state;
    struct rho_sensor sensor = {.sensor_id = 1,
                                .x_m = 5e3f,
                                .y_m = -3e3f,
                                .pd = 0.9f,
                                .range_min_m = 10e3f,
                                .range_max_m = 80e3f,
                                .sector_from_rad = -1.0f,
                                .sector_to_rad = 1.0f};
    num_radars = 1;
    radars[0] = radar_of_80_km();
    radars[0].x_m = 5e3;
    radars[0].y_m = -3e3;
    radars[0].is_described = 0;
    start_scene(1, 30.0, 350.0, 20.0);
    expect_fate_of_plot_at(200e3, 3.0, RHO_FATE_HELD); /* no coverage was stated */
    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
    expect_fate_of_plot_at(40e3, 0.0, RHO_FATE_HELD);
    expect_fate_of_plot_at(80e3 + 110.0, 0.5, RHO_FATE_HELD); /* within 4 sigmas of 30 m */
    expect_fate_of_plot_at(80e3 + 130.0, 0.5, RHO_FATE_INVALID);
    expect_fate_of_plot_at(10e3 - 110.0, 0.5, RHO_FATE_HELD);
    expect_fate_of_plot_at(10e3 - 130.0, 0.5, RHO_FATE_INVALID);
    expect_fate_of_plot_at(40e3, 1.011, RHO_FATE_HELD); /* within 4 sigmas of 3 mrad */
    expect_fate_of_plot_at(40e3, 1.013, RHO_FATE_INVALID);
    expect_fate_of_plot_at(40e3, -1.011, RHO_FATE_HELD);
    expect_fate_of_plot_at(40e3, -1.013, RHO_FATE_INVALID);
    expect_fate_of_plot_at(40e3, 3.0, RHO_FATE_INVALID);
    assert_int_equal(rho_tracker_forget_sensor(&tracker, 1), RHO_OK);
    expect_fate_of_plot_at(40e3, 3.0, RHO_FATE_HELD);
}

/* Rows of the track of a target that accelerates by 1 g, above 1.3 times v_max. */
static int count_rows_of_a_target_that_gets_too_fast(int is_nearest)
{
    int rows = 0;
    radars[0] = radar_of_80_km();
    radars[0].clutter = 0.0;
    start_scene(1, 30.0, 350.0, 20.0);
    if (is_nearest) {
        config.gate = RHO_TRACKER_NEAREST;
        begin_tracker();
    }
    for (int k = 0; k < 40; k++) {
        const double t_s = 4.0 * k, pulls_s = t_s > 80.0 ? t_s - 80.0 : 0.0;
        const double x_m = -70e3 + 300.0 * t_s + 0.5 * 10.0 * pulls_s * pulls_s;
        add_plot(x_m, 10e3, 30.0);
        step_at(t_s);
        if (300.0 + 10.0 * pulls_s > 1.3 * 350.0) {
            rows += count_confirmed_or_coasting_tracks() > 0;
        }
    }
    return rows;
}

/* Targets at v_max are followed; a target that accelerates beyond v_max soon loses its track. */
static void tracks_faster_than_v_max_end_soon(void **state)
{
    (void)state;
    num_radars = 1;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        radars[0] = radar_of_80_km();
        radars[0].range_m = 150e3;
        start_scene(seed, 30.0, 350.0, 20.0);
        for (int i = 0; i < 12; i++) {
            targets[num_targets++] =
                (struct target){-110e3, -110e3 + 20e3 * i, 350.0, uniform(-1.0, 1.0), 0.0};
        }
        step_all_until(500.0);
        print_tally("at v_max");
        print_message("too fast: %u\n", tracker.counters.tracks_too_fast);
        assert_int_equal(tracker.counters.tracks_too_fast, 0);
        assert_true(tally.fast_rows * 20 < tally.rows);
    }
    /* gate nearest ends the track at the third update that is too fast, best may lose it before */
    for (int is_nearest = 0; is_nearest < 2; is_nearest++) {
        const int rows = count_rows_of_a_target_that_gets_too_fast(is_nearest);
        print_message("%d rows of the one that is too fast\n", rows);
        assert_true(tracker.counters.tracks_too_fast >= 1 || !is_nearest);
        assert_in_range(rows, 1, 4);
    }
}

/*
 * A track of clutter ends once its score has fallen 4.6 nat, ln 100, below the threshold that
 * started it, in steps of ln 2.
 */
static void tentative_tracks_end_4_6_nat_below_their_start(void **state)
{
    double least_nat = 0.0;
    (void)state;
    begin_tracker_by_rate(3);
    config.pd = initiation.pd = 0.5f;
    config.coast_scans_max = 50;
    config.accel_max_mps2 = 5.0f;
    begin_tracker();
    for (int k = 0; k < 40; k++) {
        const double before_nat = 1e-3 * tracker.start_mnat;
        for (int i = 0; i < 30; i++) {
            const double x_m = uniform(-2e4, 2e4);
            add_plot(x_m, uniform(-2e4, 2e4), 20.0);
        }
        if (k < 8) {
            add_noisy_plot(200.0 * k, 0.0, 20.0);
        }
        step_at(2.0 * k);
        for (unsigned i = 0; i < report.num_tracks; i++) {
            if (!tracker.tracks[i].was_confirmed) {
                least_nat = fmin(least_nat, (double)report.tracks[i].score_nat - before_nat);
            }
        }
    }
    assert_true(least_nat > -4.7 && least_nat < -3.6);
}

/* After a sure miss little is left of the sum that the probabilities are divided by. */
static void probabilities_of_a_life_never_exceed_one(void **state)
{
    (void)state;
    use_usual_configs(1);
    begin_tracker();
    tracker.num_tracks = 1;
    for (int misses = 0; misses < 40; misses++) {
        for (int k = 0; k < 1000; k++) {
            struct rho_track *track = &tracker.tracks[0];
            const float hidden = powf(10.0f, -(float)k / 140.0f);
            *track = (struct rho_track){.status = RHO_TRACK_CONFIRMED,
                                        .visible = 1.0f - hidden,
                                        .hidden = hidden,
                                        .seen_share = 1.0f,
                                        .misses_in_row = 100,
                                        .look_nat = -0.5f * (float)misses};
            const struct rho_look look = {.tracker = &tracker, .pd = 0.9f};
            rho_life_weigh(&tracker, &look);
            assert_true(track->visible >= 0.0f && track->visible + track->hidden <= 1.000001f);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_track_is_left_ten_minutes_after_the_last_target),
        cmocka_unit_test(a_short_range_sector_radar_keeps_no_track_of_gone_cars),
        cmocka_unit_test(tracks_survive_a_minute_without_the_radar),
        cmocka_unit_test(a_target_missed_after_a_radar_pause_keeps_its_track),
        cmocka_unit_test(a_pause_of_the_radar_counts_as_scans_that_passed),
        cmocka_unit_test(an_established_target_hidden_for_a_while_keeps_its_identity),
        cmocka_unit_test(misses_of_all_tracks_are_the_radars),
        cmocka_unit_test(targets_that_leave_together_soon_lose_their_tracks),
        cmocka_unit_test(tracks_end_when_their_radar_is_switched_off),
        cmocka_unit_test(after_ten_silent_minutes_no_old_track_is_left),
        cmocka_unit_test(targets_are_tracked_through_the_coverage_of_two_radars),
        cmocka_unit_test(tracks_of_gone_targets_free_their_slots),
        cmocka_unit_test(plots_beyond_a_stated_coverage_are_invalid),
        cmocka_unit_test(tracks_faster_than_v_max_end_soon),
        cmocka_unit_test(tentative_tracks_end_4_6_nat_below_their_start),
        cmocka_unit_test(probabilities_of_a_life_never_exceed_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
