/* SPDX-License-Identifier: MIT */
/*
 * Tracks end where nobody sees them: targets that left, radars that are switched off; what lies
 * beyond a stated coverage, and what is faster than any target.
 */
#include "tracker_setup.h"

#define PI 3.14159265358979323846
#define TARGETS_MAX 64
#define RADARS_MAX 3
#define EMPTY_S 600.0 /* after the last target has left */

struct radar {
    double x_m, y_m, range_m, turn_s, sigma_m, sigma_rad, clutter;
    double sector_from_rad, sector_to_rad; /* equal: all round */
    int sectors;                           /* scans of a turn */
    int is_described, is_off;
};

struct target {
    double x_m, y_m, vx_mps, vy_mps, born_s;
};

static struct radar radars[RADARS_MAX];
static struct target targets[TARGETS_MAX];
static int num_radars, num_targets;
static double now_s;
static int says_sector; /* scans say the radar's own sector */

/*
 * What was reported: rows of believed tracks, those far from any target that is or was seen lately,
 * those of impossible speed.
 */
static struct tally {
    unsigned rows, false_rows, fast_rows, scans, most_tracks;
    unsigned missing, present; /* of targets well inside: without a track; all */
} tally;

static struct radar usual_radar(void)
{
    return (struct radar){.range_m = 80e3,
                          .turn_s = 4.0,
                          .sigma_m = 30.0,
                          .sigma_rad = 0.003,
                          .clutter = 50.0,
                          .sectors = 1,
                          .is_described = 1};
}

static void start(uint64_t seed, double v_min_mps, double v_max_mps, double accel_mps2)
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

static double x_of(const struct target *target, double t_s)
{
    return target->x_m + target->vx_mps * t_s;
}

static double y_of(const struct target *target, double t_s)
{
    return target->y_m + target->vy_mps * t_s;
}

static int in_sector(double azimuth_rad, double from_rad, double to_rad)
{
    const double width =
        to_rad - from_rad <= 0.0 ? to_rad - from_rad + 2.0 * PI : to_rad - from_rad;
    double off = fmod(azimuth_rad - from_rad, 2.0 * PI);
    off += off < 0.0 ? 2.0 * PI : 0.0;
    return off < width;
}

/* Has any radar that is on been able to see it at that time? */
static int is_inside(const struct target *target, double t_s, double share)
{
    for (int i = 0; i < num_radars; i++) {
        const struct radar *radar = &radars[i];
        const double dx_m = x_of(target, t_s) - radar->x_m, dy_m = y_of(target, t_s) - radar->y_m;
        if (t_s >= target->born_s && !radar->is_off && hypot(dx_m, dy_m) < share * radar->range_m &&
            in_sector(atan2(dy_m, dx_m), radar->sector_from_rad, radar->sector_to_rad)) {
            return 1;
        }
    }
    return 0;
}

static void add_polar(const struct radar *radar, double range_m, double azimuth_rad)
{
    const double x_m = radar->x_m + range_m * cos(azimuth_rad);
    const double y_m = radar->y_m + range_m * sin(azimuth_rad);
    struct rho_plot *plot = add_plot(x_m, y_m, radar->sigma_m);
    plot->sigma_cross_m = (float)(range_m * radar->sigma_rad);
}

static unsigned poisson(double mean)
{
    unsigned count = 0;
    for (double product = uniform(0.0, 1.0), least = exp(-mean); product > least; count++) {
        product *= uniform(0.0, 1.0);
    }
    return count;
}

/* One scan of a radar, or of a sector of it. */
static void look(int which, double from_rad, double to_rad)
{
    const struct radar *radar = &radars[which];
    const int is_part = radar->sectors > 1;
    const double first_rad = is_part ? from_rad : radar->sector_from_rad;
    const double last_rad = is_part ? to_rad : radar->sector_to_rad;
    double width_rad = last_rad - first_rad;
    width_rad += width_rad <= 0.0 ? 2.0 * PI : 0.0;
    for (int i = 0; i < num_targets; i++) {
        const double dx_m = x_of(&targets[i], now_s) - radar->x_m;
        const double dy_m = y_of(&targets[i], now_s) - radar->y_m;
        const double range_m = hypot(dx_m, dy_m) + radar->sigma_m * normal();
        const double azimuth_rad = atan2(dy_m, dx_m) + radar->sigma_rad * normal();
        const int is_seen = uniform(0.0, 1.0) < 0.9;
        if (is_seen && now_s >= targets[i].born_s && hypot(dx_m, dy_m) < radar->range_m &&
            in_sector(atan2(dy_m, dx_m), first_rad, last_rad)) {
            add_polar(radar, range_m, azimuth_rad);
        }
    }
    const unsigned clutter = poisson(radar->clutter * width_rad / (2.0 * PI));
    for (unsigned i = 0; i < clutter; i++) {
        const double range_m = uniform(0.01, 1.0) * radar->range_m;
        add_polar(radar, range_m, uniform(first_rad, first_rad + width_rad));
    }
    const int says = is_part || says_sector;
    step_scan(
        (struct rho_scan){.time_us = llround(now_s * 1e6),
                          .sensor_id = which + 1,
                          .sector_from_rad = (float)(says ? remainder(first_rad, 2.0 * PI) : 0.0),
                          .sector_to_rad = (float)(says ? remainder(last_rad, 2.0 * PI) : 0.0)});
}

static int is_believed(const struct rho_track_report *track)
{
    return track->status == RHO_TRACK_CONFIRMED || track->status == RHO_TRACK_COASTING;
}

static const struct rho_track_report *track_near(const struct target *target, double most_m)
{
    for (unsigned i = 0; i < report.num_tracks; i++) {
        const struct rho_track_report *track = &report.tracks[i];
        if (is_believed(track) && hypot((double)track->state[0] - x_of(target, now_s),
                                        (double)track->state[1] - y_of(target, now_s)) < most_m) {
            return track;
        }
    }
    return NULL;
}

/* A target that left counts for six more turns. */
static void count_rows(double range_m, double turn_s)
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
                was_inside |= is_inside(&targets[k], now_s - back * turn_s, 1.0);
            }
            has_target |= was_inside && hypot((double)track->state[0] - x_of(&targets[k], now_s),
                                              (double)track->state[1] - y_of(&targets[k], now_s)) <
                                            0.0125 * range_m + 3.0 * (double)track->sigma_m;
        }
        const double speed_mps = hypot((double)track->state[3], (double)track->state[4]);
        tally.rows += is_believed(track);
        tally.false_rows += is_believed(track) && !has_target;
        tally.fast_rows += is_believed(track) && speed_mps > 1.1 * (double)config.v_max_mps;
    }
    for (int k = 0; k < num_targets; k++) {
        if (is_inside(&targets[k], now_s, 0.97) &&
            is_inside(&targets[k], now_s - 6.0 * turn_s, 0.97)) {
            tally.present++;
            tally.missing += !track_near(&targets[k], 0.0125 * range_m);
        }
    }
}

/* Turns of all radars, which have the same period, one after the other within it. */
static void fly(double until_s)
{
    const double begin_s = now_s;
    for (int turn = 0; begin_s + (turn + 1) * radars[0].turn_s <= until_s + 1e-9; turn++) {
        for (int i = 0; i < num_radars; i++) {
            for (int sector = 0; sector < radars[i].sectors && !radars[i].is_off; sector++) {
                const double width_rad = 2.0 * PI / radars[i].sectors;
                now_s =
                    begin_s + radars[0].turn_s * (turn + (double)i / num_radars +
                                                  (double)sector / radars[i].sectors / num_radars);
                look(i, -PI + width_rad * sector, -PI + width_rad * (sector + 1));
            }
        }
        count_rows(radars[0].range_m, radars[0].turn_s);
        now_s = begin_s + radars[0].turn_s * (turn + 1);
    }
}

/* From the middle outwards; they have left after 300 s. */
static void add_leaving(int count, double range_m, double speed_mps)
{
    for (int i = 0; i < count; i++) {
        const double heading_rad = uniform(-PI, PI);
        const double from_m = range_m - speed_mps * uniform(100.0, 250.0);
        targets[num_targets++] =
            (struct target){from_m * cos(heading_rad), from_m * sin(heading_rad),
                            speed_mps * cos(heading_rad), speed_mps * sin(heading_rad), 0.0};
    }
}

static unsigned count_believed(void)
{
    unsigned count = 0;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        count += is_believed(&report.tracks[i]);
    }
    return count;
}

static void tell(const char *what)
{
    print_message("%s: %.3f false a scan, %u of %u rows too fast, missing %.3f, at most %u tracks, "
                  "%u at the end\n",
                  what, (double)tally.false_rows / tally.scans, tally.fast_rows, tally.rows,
                  (double)tally.missing / (tally.present ? tally.present : 1), tally.most_tracks,
                  report.num_tracks);
}

/* ---- targets leave --------------------------------------------------------------------------- */

static void expect_none(const char *what, uint64_t seed, double speed_mps, double v_max_mps,
                        double accel_mps2)
{
    start(seed, 0.1 * speed_mps, v_max_mps, accel_mps2);
    add_leaving(8, radars[0].range_m, speed_mps);
    fly(270.0);
    const uint32_t newest = tracker.next_track_id;
    fly(300.0 + EMPTY_S);
    tell(what);
    assert_true(tracker.counters.tracks_confirmed >= 6);
    assert_int_equal(count_believed(), 0);
    for (unsigned i = 0; i < report.num_tracks; i++) {
        assert_true(report.tracks[i].track_id >= newest);
    }
    assert_true((double)tally.false_rows / tally.scans < 0.08);
    assert_true(tally.fast_rows * 100 <= tally.rows);
}

static void ten_minutes_after_the_last_target_left_no_track_is_there(void **state)
{
    (void)state;
    num_radars = 1;
    for (int is_described = 0; is_described < 2; is_described++) {
        for (uint64_t seed = 1; seed <= 3; seed++) {
            radars[0] = usual_radar();
            radars[0].is_described = is_described;
            expect_none(is_described ? "turns, described" : "turns", seed, 250.0, 350.0, 20.0);
            if (RHO_SECTORS) {
                radars[0].sectors = 8;
                expect_none(is_described ? "sectors, described" : "sectors", seed, 250.0, 350.0,
                            20.0);
            }
        }
    }
}

/*
 * 24 GHz: 20 scans a second of a sector of 2 rad, 80 m; cars at 2 to 20 m/s leave over its end and
 * its sides.
 */
static void a_short_radar_of_a_sector_keeps_none(void **state)
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
            start(seed, 0.5, 40.0, 8.0);
            for (int i = 0; i < 12; i++) {
                const double range_m = uniform(10.0, 60.0), azimuth_rad = uniform(-0.9, 0.9);
                const double speed_mps = uniform(2.0, 20.0), heading_rad = uniform(-PI, PI);
                targets[num_targets++] = (struct target){
                    range_m * cos(azimuth_rad), range_m * sin(azimuth_rad),
                    speed_mps * cos(heading_rad), speed_mps * sin(heading_rad), 0.0};
            }
            fly(60.0);
            const uint32_t newest = tracker.next_track_id;
            fly(60.0 + 0.2 * EMPTY_S);
            tell(kind == 0   ? "24 GHz, described"
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

static void add_crossing(int count, double range_m)
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

static void a_minute_without_the_radar(void **state)
{
    (void)state;
    num_radars = 1;
    unsigned kept = 0, found = 0, all = 0, false_rows = 0, scans = 0;
    for (int is_described = 0; is_described < 2; is_described++) {
        for (uint64_t seed = 1; seed <= 5; seed++) {
            uint32_t ids[TARGETS_MAX];
            radars[0] = usual_radar();
            radars[0].range_m = 120e3;
            radars[0].is_described = is_described;
            start(seed, 30.0, 350.0, 20.0);
            add_crossing(20, 120e3);
            fly(100.0);
            for (int i = 0; i < num_targets; i++) {
                const struct rho_track_report *track = track_near(&targets[i], 1500.0);
                ids[i] = track ? track->track_id : 0;
            }
            now_s += 60.0;
            memset(&tally, 0, sizeof tally);
            fly(now_s + 16.0);
            for (int i = 0; i < num_targets; i++) {
                const struct rho_track_report *track = track_near(&targets[i], 1500.0);
                kept += track && track->track_id == ids[i];
                found += track != NULL;
                all++;
            }
            fly(now_s + 40.0);
            false_rows += tally.false_rows;
            scans += tally.scans;
            tell("a minute's outage");
        }
    }
    print_message("kept %u, there after four turns %u of %u, false %.3f\n", kept, found, all,
                  (double)false_rows / scans);
    assert_true(found * 100 >= all * 90);
    assert_true((double)false_rows / scans < 0.1);
}

/* One target that flies straight, seen or not, and clutter far from it. */
static void look_at_one(double t_s, int is_seen, int clutter)
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

/*
 * The radar is off for a minute, and misses the target so many times when it is back; what is left
 * of its track then.
 */
static void miss_after_a_minute(uint64_t seed, int misses, int clutter)
{
    double t_s = 0.0;
    start(seed, 30.0, 350.0, 20.0);
    for (; t_s < 120.0; t_s += 4.0) {
        look_at_one(t_s, 1, clutter);
    }
    const uint32_t id = report.tracks[0].track_id;
    assert_int_equal(report_of(id)->status, RHO_TRACK_CONFIRMED);
    t_s += 60.0;
    for (int k = 1; k <= misses; k++, t_s += 4.0) {
        look_at_one(t_s, 0, clutter);
        const struct rho_track_report *track = report_of(id);
        assert_int_equal(track != NULL, k < 3);
        assert_true(!track || track->status == RHO_TRACK_TENTATIVE);
    }
    for (int k = 0; k < 5 && misses < 3; k++, t_s += 4.0) {
        look_at_one(t_s, 1, clutter);
        assert_non_null(report_of(id));
        assert_int_equal(report_of(id)->plot, 0);
    }
    assert_true(misses > 2 || report_of(id)->status == RHO_TRACK_CONFIRMED);
}

/*
 * Until it is seen again the track is tentative; it ends at the third miss. In dense clutter the
 * plot that ends the wait is a doubtful one, which must not count against the track a second time.
 */
static void a_target_missed_when_the_radar_is_back_keeps_its_track(void **state)
{
    (void)state;
    num_radars = 1;
    for (int is_described = 0; is_described < 2; is_described++) {
        radars[0] = usual_radar();
        radars[0].is_described = is_described;
        for (uint64_t seed = 1; seed <= 5; seed++) {
            for (int misses = 0; misses <= 3; misses++) {
                miss_after_a_minute(seed, misses, 6);
            }
            if (RHO_MAX_PLOTS > 300) {
                miss_after_a_minute(seed, 1, 300);
            }
        }
    }
}

/* Seen in so many scans, then missed in so many; the track's identity before. */
static uint32_t hide(int seen, int missed, double *t_s)
{
    start(7, 30.0, 350.0, 20.0);
    for (int k = 0; k < seen; k++, *t_s += 4.0) {
        look_at_one(*t_s, 1, 6);
    }
    const uint32_t id = report.tracks[0].track_id;
    for (int k = 1; k <= missed; k++, *t_s += 4.0) {
        look_at_one(*t_s, 0, 6);
        const struct rho_track_report *track = report_of(id);
        assert_true(!track || k < 3 || track->status == RHO_TRACK_TENTATIVE);
    }
    return id;
}

/*
 * Behind a hill for forty seconds; what is not back after twelve misses has gone. Of a new track
 * five are enough.
 */
static void a_grown_target_that_hides_keeps_its_identity(void **state)
{
    (void)state;
    num_radars = 1;
    radars[0] = usual_radar();
    for (int missed = 9; missed <= 12; missed++) {
        double t_s = 0.0;
        const uint32_t id = hide(24, missed, &t_s);
        assert_int_equal(report_of(id) != NULL, missed < 12);
        for (int k = 0; k < 3; k++, t_s += 4.0) {
            look_at_one(t_s, 1, 6);
        }
        assert_int_equal(report_of(id) != NULL, missed < 12);
        assert_true(missed == 12 || report_of(id)->status == RHO_TRACK_CONFIRMED);
    }
    double t_s = 0.0;
    assert_non_null(report_of(hide(12, 4, &t_s)));
    t_s = 0.0;
    assert_null(report_of(hide(12, 5, &t_s)));
}

/*
 * Radars of which one is switched off for good, where the others see none of its targets, or some
 * of them.
 */
static void a_radar_that_is_switched_off_leaves_no_tracks(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        for (int is_described = 0; is_described < 2; is_described++) {
            num_radars = 2;
            radars[0] = radars[1] = usual_radar();
            radars[0].is_described = radars[1].is_described = is_described;
            radars[1].x_m = 140e3; /* an overlap of 20 km */
            radars[0].is_off = radars[1].is_off = 0;
            start(seed, 30.0, 350.0, 20.0);
            add_crossing(12, 80e3);
            fly(120.0);
            const uint32_t newest = tracker.next_track_id;
            const unsigned tracks = report.num_tracks;
            for (int i = 0; i < num_targets; i++) {
                targets[i].born_s = 1e9; /* all are gone */
            }
            radars[0].is_off = 1;
            fly(240.0); /* more than four times what it may coast */
            assert_true(tracks >= 10);
            for (unsigned i = 0; i < report.num_tracks; i++) {
                assert_true(report.tracks[i].track_id >= newest);
            }
            /* described, the other one alone sees what it sees; else it looked everywhere */
            assert_true(!is_described || tracker.counters.tracks_unseen > 0);
        }
    }
}

/*
 * A radar that is silent for ten minutes: at its next scan nothing is left of what is not there any
 * more.
 */
static void after_a_long_silence_nothing_old_is_left(void **state)
{
    (void)state;
    num_radars = 1;
    for (int is_described = 0; is_described < 2; is_described++) {
        for (uint64_t seed = 1; seed <= 3; seed++) {
            radars[0] = usual_radar();
            radars[0].is_described = is_described;
            start(seed, 30.0, 350.0, 20.0);
            add_crossing(12, 80e3);
            fly(120.0);
            const uint32_t newest = tracker.next_track_id;
            num_targets = 0;
            now_s += EMPTY_S;
            fly(now_s + 4.0);
            for (unsigned i = 0; i < report.num_tracks; i++) {
                assert_false(is_believed(&report.tracks[i]) && report.tracks[i].track_id < newest);
            }
            fly(now_s + 16.0);
            for (unsigned i = 0; i < report.num_tracks; i++) {
                assert_true(report.tracks[i].track_id >= newest);
            }
        }
    }
}

/* Two radars, out of step: targets are found and followed across both, and end behind them. */
static void targets_pass_through_two_radars(void **state)
{
    (void)state;
    unsigned missing = 0, present = 0, false_rows = 0, scans = 0;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        num_radars = 2;
        radars[0] = radars[1] = usual_radar();
        radars[1].x_m = 80e3;
        start(seed, 30.0, 350.0, 20.0);
        for (int i = 0; i < 20; i++) {
            targets[num_targets++] =
                (struct target){-90e3 + 12e3 * (i % 5), uniform(-40e3, 40e3), uniform(200.0, 300.0),
                                uniform(-30.0, 30.0), 0.0};
        }
        fly(900.0);
        tell("two radars");
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
 * are for those.
 */
static void targets_that_have_gone_take_no_slots(void **state)
{
    (void)state;
    num_radars = 1;
    radars[0] = usual_radar();
    start(1, 30.0, 350.0, 20.0);
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
    fly(2400.0);
    tell("come and go");
    assert_int_equal(tracker.counters.tracks_no_room, 0);
    assert_true(tally.most_tracks < 32);
    assert_true(tally.missing * 100 < tally.present * 3);
    assert_true((double)tally.false_rows / tally.scans < 0.1);
}

/* ---- what is beyond limits ------------------------------------------------------------------- */

/*
 * A plot at that range and azimuth of a radar of 10 to 80 km that sees from -1 to 1 rad; heights
 * count for the least range.
 */
static void expect_fate(double range_m, double azimuth_rad, int fate)
{
    const uint32_t outside = tracker.counters.plots_outside;
    add_polar(&radars[0], range_m, azimuth_rad);
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
    radars[0] = usual_radar();
    radars[0].x_m = 5e3;
    radars[0].y_m = -3e3;
    radars[0].is_described = 0;
    start(1, 30.0, 350.0, 20.0);
    expect_fate(200e3, 3.0, RHO_FATE_HELD); /* nothing was said */
    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
    expect_fate(40e3, 0.0, RHO_FATE_HELD);
    expect_fate(80e3 + 110.0, 0.5, RHO_FATE_HELD); /* noise of 30 m, 4 of it */
    expect_fate(80e3 + 130.0, 0.5, RHO_FATE_INVALID);
    expect_fate(10e3 - 110.0, 0.5, RHO_FATE_HELD);
    expect_fate(10e3 - 130.0, 0.5, RHO_FATE_INVALID);
    expect_fate(40e3, 1.011, RHO_FATE_HELD); /* of 3 mrad */
    expect_fate(40e3, 1.013, RHO_FATE_INVALID);
    expect_fate(40e3, -1.011, RHO_FATE_HELD);
    expect_fate(40e3, -1.013, RHO_FATE_INVALID);
    expect_fate(40e3, 3.0, RHO_FATE_INVALID);
    assert_int_equal(rho_tracker_forget_sensor(&tracker, 1), RHO_OK);
    expect_fate(40e3, 3.0, RHO_FATE_HELD);
}

/* At v_max targets are followed; one that goes on to pull beyond it is not for long. */
static void nothing_is_faster_than_v_max_for_long(void **state)
{
    (void)state;
    num_radars = 1;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        radars[0] = usual_radar();
        radars[0].range_m = 150e3;
        start(seed, 30.0, 350.0, 20.0);
        for (int i = 0; i < 12; i++) {
            targets[num_targets++] =
                (struct target){-110e3, -110e3 + 20e3 * i, 350.0, uniform(-1.0, 1.0), 0.0};
        }
        fly(500.0);
        tell("at v_max");
        print_message("too fast: %u\n", tracker.counters.tracks_too_fast);
        assert_int_equal(tracker.counters.tracks_too_fast, 0);
        assert_true(tally.fast_rows * 20 < tally.rows);
    }
    radars[0] = usual_radar();
    radars[0].clutter = 0.0;
    start(1, 30.0, 350.0, 20.0);
    int rows = 0;
    for (int k = 0; k < 40; k++) {
        const double t_s = 4.0 * k, pulls_s = t_s > 80.0 ? t_s - 80.0 : 0.0;
        const double x_m = -70e3 + 300.0 * t_s + 0.5 * 10.0 * pulls_s * pulls_s;
        add_plot(x_m, 10e3, 30.0);
        step_at(t_s);
        if (300.0 + 10.0 * pulls_s > 1.3 * 350.0) {
            rows += count_believed() > 0;
        }
    }
    print_message("%d rows of the one that is too fast\n", rows);
    assert_true(tracker.counters.tracks_too_fast >= 1);
    assert_true(rows <= 2); /* three updates in a row are too fast */
}

/*
 * A track of clutter is given up once its score has fallen 4.6 nat below the threshold that started
 * it, in steps of ln 2: one in a hundred is true.
 */
static void tentative_tracks_end_at_a_score(void **state)
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ten_minutes_after_the_last_target_left_no_track_is_there),
        cmocka_unit_test(a_short_radar_of_a_sector_keeps_none),
        cmocka_unit_test(a_minute_without_the_radar),
        cmocka_unit_test(a_target_missed_when_the_radar_is_back_keeps_its_track),
        cmocka_unit_test(a_grown_target_that_hides_keeps_its_identity),
        cmocka_unit_test(a_radar_that_is_switched_off_leaves_no_tracks),
        cmocka_unit_test(after_a_long_silence_nothing_old_is_left),
        cmocka_unit_test(targets_pass_through_two_radars),
        cmocka_unit_test(targets_that_have_gone_take_no_slots),
        cmocka_unit_test(plots_beyond_a_stated_coverage_are_invalid),
        cmocka_unit_test(nothing_is_faster_than_v_max_for_long),
        cmocka_unit_test(tentative_tracks_end_at_a_score),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
