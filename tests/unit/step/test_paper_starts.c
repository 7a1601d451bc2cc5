/* SPDX-License-Identifier: MIT */
/*
 * The papers' methods start a tracker's tracks: each Hough transform from plots, the passive method
 * from bearings; what is held, used, counted and refused.
 */
#include "rhotrack/paper_starts.h"
#include "step_looks.h"
#include "tracker_setup.h"

#define SCAN_S 2.0
#define CLUTTER 12
#define SENSORS 3

static struct rho_paper_starts starts, starts_then;
static struct rho_passive_paper paper;
static struct rho_paper_starts_config lines;

static double target_place_m(int axis, double t_s)
{
    return axis ? 1500.0 - 90.0 * t_s : -3000.0 + 220.0 * t_s;
}

/* Plots have half a metre of noise, as the papers' cells assume. */
static struct rho_scan make_scan(int k)
{
    const double t_s = SCAN_S * k;
    num_plots = 0;
    add_plot(target_place_m(0, t_s) + 0.5 * normal(), target_place_m(1, t_s) + 0.5 * normal(), 0.5);
    for (int i = 0; i < CLUTTER; i++) {
        const double x_m = uniform(-3500.0, 3500.0);
        add_plot(x_m, uniform(-3500.0, 3500.0), 0.5);
    }
    return (struct rho_scan){
        .time_us = (int64_t)(1e6 * t_s), .sensor_id = 1, .num_plots = num_plots, .plots = plots};
}

static void begin_with_method(enum rho_hough_method method)
{
    use_usual_configs(5);
    begin_tracker();
    rho_paper_starts_config_default(&lines, method);
    lines.hough.rho_max_m = 5000.0f;
    /* half a metre of noise turns the line of two plots by a milliradian */
    lines.hough.rho_cell_m = 25.0f;
    lines.hough.theta_cell_rad = 0.02f;
    lines.hough.eps_rho_m = 25.0f;
    lines.hough.eps_theta_rad = 0.02f;
    assert_int_equal(rho_paper_starts_init(&starts, sizeof starts, &lines), RHO_OK);
}

static void step_with_starts(int k)
{
    const struct rho_scan scan = make_scan(k);
    assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
    assert_int_equal(rho_paper_starts_step(&starts, &tracker, &scan, &report), RHO_OK);
}

static uint32_t count_fate(enum rho_fate fate)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < report.num_plots; i++) {
        count += report.fates[i] == fate;
    }
    assert_int_equal(count, report.fates_total[fate]);
    return count;
}

static const struct rho_track_report *track_on_target(double t_s)
{
    for (uint32_t i = 0; i < report.num_tracks; i++) {
        const struct rho_track_report *track = &report.tracks[i];
        if (hypot(track->state[0] - target_place_m(0, t_s),
                  track->state[1] - target_place_m(1, t_s)) < 20.0) {
            return track;
        }
    }
    return NULL;
}

/* Confirmed with the window's fourth scan, and kept under one identity. */
static void each_hough_transform_starts_a_track_of_the_target(void **state)
{
    (void)state;
    static const enum rho_hough_method methods[] = {RHO_HOUGH_HT, RHO_HOUGH_MHT, RHO_HOUGH_IHT,
                                                    RHO_HOUGH_NHT_A, RHO_HOUGH_NHT_C};
    for (size_t i = 0; i < sizeof methods / sizeof methods[0]; i++) {
        uint32_t track_id = 0;
        begin_with_method(methods[i]);
        for (int k = 0; k < 14; k++) {
            step_with_starts(k);
            const struct rho_track_report *track = track_on_target(SCAN_S * k);
            if (k == 3) {
                assert_non_null(track);
                assert_int_equal(track->status, RHO_TRACK_CONFIRMED);
                assert_int_equal(track->hits, 4);
                track_id = track->track_id;
            }
            if (k >= 3) {
                assert_non_null(track);
                assert_int_equal(track->track_id, track_id);
            }
        }
        assert_float_equal(track_on_target(26.0)->state[3], 220.0f, 3.0f);
    }
}

/* Points, lines and peaks stay until the next step; a line names the track that it started. */
static void points_and_peaks_of_the_last_search_stay_readable(void **state)
{
    (void)state;
    begin_with_method(RHO_HOUGH_NHT_C);
    assert_int_equal(rho_paper_starts_points(&starts).at.num_scans, 0);
    for (int k = 0; k < 4; k++) {
        assert_int_equal(starts.has_searched, 0);
        step_with_starts(k);
    }
    const struct rho_hough_points points = rho_paper_starts_points(&starts);
    assert_int_equal(starts.has_searched, 1);
    assert_int_equal(points.at.num_scans, 4);
    assert_int_equal(points.at.scan_end[3], 4 * (CLUTTER + 1));
    assert_float_equal(points.t_s[0], -3.0 * SCAN_S, 1e-5);
    uint32_t named = 0, newest = 0;
    for (uint32_t i = points.at.scan_end[2]; i < points.at.scan_end[3]; i++) {
        newest += memcmp(&points.at.x_m[i], &plots[0].x_m, sizeof plots[0].x_m) == 0;
    }
    assert_int_equal(newest, 1); /* the window orders its points differently from the scan */
    for (uint32_t i = 0; i < starts.result.num_peaks; i++) {
        struct rho_hough_track again;
        assert_int_equal(rho_hough_track(&starts.hough, &points, starts.peaks[i].theta_cell,
                                         starts.peaks[i].rho_cell, 0.0f, &again),
                         RHO_OK);
        assert_memory_equal(&again, &starts.lines[i].line, sizeof again);
        named += starts.lines[i].track_id == report.tracks[0].track_id;
    }
    assert_int_equal(named, 1);
    step_with_starts(2); /* a late scan */
    assert_int_equal(starts.has_searched, 0);
}

/* Plots that no track claims are held, as by an initiator; fates and counters agree. */
static void unclaimed_plots_are_held_and_counted(void **state)
{
    (void)state;
    begin_with_method(RHO_HOUGH_IHT);
    uint32_t held = 0;
    for (int k = 0; k < 8; k++) {
        step_with_starts(k);
        held += count_fate(RHO_FATE_HELD);
        assert_int_equal(count_fate(RHO_FATE_NO_ROOM), 0);
        assert_int_equal(count_fate(RHO_FATE_HELD) + count_fate(RHO_FATE_CLAIMED), CLUTTER + 1);
    }
    assert_int_equal(tracker.counters.fates[RHO_FATE_HELD], held);
    assert_int_equal(tracker.counters.fates[RHO_FATE_NO_ROOM], 0);
    assert_in_range(tracker.counters.plots_initiated, 4, 4 * tracker.counters.tracks_started);
    assert_int_equal(starts.window.num_scans, 4);
}

/* A line without a newest plot, or of too few scans, starts nothing. */
static void lines_without_a_new_plot_start_nothing(void **state)
{
    (void)state;
    begin_with_method(RHO_HOUGH_IHT);
    for (int k = 0; k < 4; k++) {
        struct rho_scan scan = make_scan(k);
        scan.num_plots = k == 3 ? 0 : 1; /* three scans with the target alone, the last one empty */
        assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
        assert_int_equal(rho_paper_starts_step(&starts, &tracker, &scan, &report), RHO_OK);
        assert_int_equal(report.num_tracks, 0);
    }
    assert_int_equal(starts.result.num_peaks, 1);
    assert_int_equal(starts.lines[0].track_id, 0);
    begin_with_method(RHO_HOUGH_IHT);
    lines.scans_min = 3;
    assert_int_equal(rho_paper_starts_init(&starts, sizeof starts, &lines), RHO_OK);
    for (int k = 0; k < 3; k++) {
        step_with_starts(k);
    }
    assert_non_null(track_on_target(4.0));
}

/* A line takes plots within three sigmas of a cell of 25 m from its motion. */
static void a_line_takes_plots_within_three_sigmas_of_its_motion(void **state)
{
    const double speed_mps = hypot(220.0, 90.0);
    (void)state;
    for (int i = 0; i < 2; i++) {
        begin_with_method(RHO_HOUGH_IHT);
        for (int k = 0; k < 4; k++) {
            const double t_s = SCAN_S * k, off_m = k == 1 ? (i ? 78.0 : 72.0) : 0.0;
            num_plots = 0;
            add_plot(target_place_m(0, t_s) + off_m * 90.0 / speed_mps,
                     target_place_m(1, t_s) + off_m * 220.0 / speed_mps, 0.5);
            const struct rho_scan scan = {
                .time_us = (int64_t)(1e6 * t_s), .sensor_id = 1, .num_plots = 1, .plots = plots};
            assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
            assert_int_equal(rho_paper_starts_step(&starts, &tracker, &scan, &report), RHO_OK);
        }
        assert_true(starts.result.num_peaks > 0);
        assert_int_equal(report.num_tracks, !i);
    }
}

static void the_same_scans_give_the_same_bytes(void **state)
{
    (void)state;
    for (int run = 0; run < 2; run++) {
        /* fills the memory with other bytes in each run */
        memset(&starts, 0x5a * run, sizeof starts);
        begin_with_method(RHO_HOUGH_NHT_C);
        for (int k = 0; k < 9; k++) {
            step_with_starts(k);
        }
        if (run == 0) {
            memcpy(&starts_then.result, &starts.result, sizeof starts.result);
            memcpy(&starts_then.window, &starts.window, sizeof starts.window);
        }
    }
    assert_memory_equal(&starts_then.result, &starts.result, sizeof starts.result);
    assert_memory_equal(&starts_then.window, &starts.window, sizeof starts.window);
}

static void bad_calls_of_paper_starts_are_refused(void **state)
{
    (void)state;
    begin_with_method(RHO_HOUGH_IHT);
    const struct rho_scan scan = make_scan(0);
    assert_int_equal(rho_paper_starts_step(NULL, &tracker, &scan, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_paper_starts_step(&starts, NULL, &scan, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_paper_starts_step(&starts, &tracker, NULL, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_paper_starts_step(&starts, &tracker, &scan, NULL), RHO_ERROR_NULL);
    /* before the first step */
    assert_int_equal(rho_paper_starts_step(&starts, &tracker, &scan, &report), RHO_ERROR_STATE);
    assert_int_equal(rho_paper_starts_init(NULL, sizeof starts, &lines), RHO_ERROR_NULL);
    assert_int_equal(rho_paper_starts_init(&starts, sizeof starts, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_paper_starts_init(&starts, sizeof starts - 1, &lines), RHO_ERROR_SIZE);
    static const uint16_t bad[][2] = {{2, 0}, {RHO_MAX_SCANS + 1, 0}, {4, 1}, {4, 5}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct rho_paper_starts_config wrong = lines;
        wrong.scans = bad[i][0];
        wrong.scans_min = bad[i][1];
        assert_int_equal(rho_paper_starts_init(&starts, sizeof starts, &wrong), RHO_ERROR_CONFIG);
    }
    struct rho_paper_starts_config wrong = lines;
    wrong.hough.rho_cell_m = -1.0f;
    assert_int_equal(rho_paper_starts_init(&starts, sizeof starts, &wrong), RHO_ERROR_CONFIG);
    assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
    assert_int_equal(rho_paper_starts_step(&starts, &tracker, &scan, &report),
                     RHO_ERROR_STATE); /* the init before this was refused */
}

/* ---- tracks from frames of bearings ---------------------------------------------------------- */

static const float place_m[SENSORS][2] = {{-20000.0f, 0.0f}, {20000.0f, 0.0f}, {0.0f, -20000.0f}};
static struct rho_bearing bearings[SENSORS];
static struct rho_bearing_scan looks[SENSORS];

static struct rho_frame make_frame(int k)
{
    const double t_s = 10.0 * k, x_m = -8000.0 + 150.0 * t_s, y_m = 30000.0 + 60.0 * t_s;
    for (int s = 0; s < SENSORS; s++) {
        bearings[s] = (struct rho_bearing){
            .bearing_rad =
                (float)(atan2(y_m - place_m[s][1], x_m - place_m[s][0]) + 0.0005 * normal()),
            .sigma_rad = 0.0005f};
        looks[s] = (struct rho_bearing_scan){.time_us = (int64_t)(1e6 * t_s),
                                             .sensor_id = s + 1,
                                             .x_m = place_m[s][0],
                                             .y_m = place_m[s][1],
                                             .num_bearings = 1,
                                             .bearings = &bearings[s]};
    }
    return (struct rho_frame){
        .time_us = (int64_t)(1e6 * t_s), .num_scans = SENSORS, .scans = looks};
}

/* For each gate: the track has the filter of that gate. */
static void lines_from_bearings_start_tracks(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        struct rho_passive_paper_config of_paper;
        use_usual_configs(6);
        config.gate = (uint8_t)gate;
        config.input.is_estimated = 1;
        begin_tracker();
        rho_passive_paper_config_default(&of_paper);
        assert_int_equal(rho_passive_paper_init(&paper, sizeof paper, &of_paper), RHO_OK);
        for (int k = 0; k < 16; k++) {
            const struct rho_frame frame = make_frame(k);
            assert_int_equal(step_looks(&tracker, NULL, &paper, &frame, &report), RHO_OK);
            assert_int_equal(count_fate(RHO_FATE_NO_ROOM), 0);
            assert_int_equal(report.num_tracks, k < 7 ? 0 : 1);
        }
        assert_int_equal(tracker.counters.tracks_started, 1);
        assert_int_equal(report.tracks[0].status, RHO_TRACK_CONFIRMED);
        assert_int_equal(tracker.tracks[0].filter,
                         gate == RHO_TRACKER_BEST ? RHO_TRACK_HYPOTHESES : RHO_TRACK_INPUT);
        assert_float_equal(report.tracks[0].state[0], -8000.0f + 150.0f * 150.0f, 150.0f);
        assert_float_equal(report.tracks[0].state[1], 30000.0f + 60.0f * 150.0f, 150.0f);
        assert_float_equal(report.tracks[0].state[3], 150.0f, 15.0f);
    }
}

static void bad_calls_of_passive_paper_are_refused(void **state)
{
    (void)state;
    const struct rho_frame frame = make_frame(0);
    const struct rho_bearing_scan *scan = &frame.scans[0];
    use_usual_configs(6);
    begin_tracker();
    struct rho_passive_paper_config of_paper;
    rho_passive_paper_config_default(&of_paper);
    assert_int_equal(rho_passive_paper_init(&paper, sizeof paper, &of_paper), RHO_OK);
    assert_int_equal(rho_passive_paper_step(NULL, &tracker, scan, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_paper_step(&paper, NULL, scan, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_paper_step(&paper, &tracker, NULL, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_paper_step(&paper, &tracker, scan, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_paper_step(&paper, &tracker, scan, &report), RHO_ERROR_STATE);
    assert_int_equal(rho_tracker_step_bearings(&tracker, NULL, &frame.scans[0], &report), RHO_OK);
    memset(&paper, 0, sizeof paper);
    assert_int_equal(rho_passive_paper_step(&paper, &tracker, scan, &report), RHO_ERROR_STATE);
}

static void bad_estimates_given_by_a_caller_start_no_track(void **state)
{
    (void)state;
    struct rho_kalman estimate;
    const struct rho_frame frame = make_frame(0);
    use_usual_configs(6);
    begin_tracker();
    rho_kalman_init(&estimate);
    assert_int_equal(rho_tracker_start_estimate(&tracker, &estimate, 1, 4, 0, &report),
                     RHO_ERROR_STATE);
    assert_int_equal(rho_tracker_step_bearings(&tracker, NULL, &frame.scans[0], &report), RHO_OK);
    assert_int_equal(rho_tracker_start_estimate(&tracker, &estimate, 1, 4, 0, &report),
                     RHO_ERROR_VALUE); /* no axis is open */
    for (int axis = 0; axis < 2; axis++) {
        assert_int_equal(rho_kalman_open_axis(&estimate, axis, 3e4f, 1e4f, 400.0f), RHO_OK);
    }
    assert_int_equal(rho_tracker_start_estimate(&tracker, &estimate, 1, 0, 0, &report),
                     RHO_ERROR_VALUE); /* no scan saw the target */
    assert_int_equal(rho_tracker_start_estimate(&tracker, &estimate, 1, 4, INT32_MIN, &report),
                     RHO_ERROR_VALUE);
    assert_int_equal(rho_tracker_start_estimate(NULL, &estimate, 1, 4, 0, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_start_estimate(&tracker, NULL, 1, 4, 0, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_start_estimate(&tracker, &estimate, 1, 4, 0, NULL),
                     RHO_ERROR_NULL);
    const struct {
        int is_of_state, at;
        float number;
    } bad[] = {{1, RHO_X, NAN},
               {1, RHO_Y, 2.1e6f},
               {1, RHO_VX, -2.1e4f},
               {1, RHO_Z, INFINITY},
               {0, RHO_AT(RHO_X, RHO_X), INFINITY},
               {0, RHO_AT(RHO_VY, RHO_VY), -1.0f},
               {0, RHO_AT(RHO_VY, RHO_VY), NAN},
               {0, RHO_AT(RHO_X, RHO_X), 2.0f * RHO_VARIANCE_MAX},
               {0, RHO_AT(RHO_VX, RHO_VX), 0.5f * RHO_VARIANCE_MIN},
               {0, RHO_AT(RHO_VX, RHO_X), 2001.0f}, /* variances 1e4 and 400: 2000 at most */
               {0, RHO_AT(RHO_Y, RHO_X), 1.1e4f},   /* a correlation above 1 */
               {0, RHO_AT(RHO_VX, RHO_X), NAN},
               {0, RHO_AT(RHO_Z, RHO_X), 1.0f}, /* the axis is closed */
               {0, RHO_AT(RHO_VZ, RHO_VZ), 1.0f}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct rho_kalman none = estimate;
        *(bad[i].is_of_state ? &none.state[bad[i].at] : &none.covariance[bad[i].at]) =
            bad[i].number;
        assert_int_equal(rho_tracker_start_estimate(&tracker, &none, 1, 4, 0, &report),
                         RHO_ERROR_VALUE);
    }
    assert_int_equal(report.num_tracks, 0);
    estimate.covariance[RHO_AT(RHO_VX, RHO_X)] = 2000.0f; /* a correlation of 1 is none too much */
    assert_int_equal(rho_tracker_start_estimate(&tracker, &estimate, 1, 4, 0, &report), RHO_OK);
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(report.tracks[0].status, RHO_TRACK_CONFIRMED);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_hough_transform_starts_a_track_of_the_target),
        cmocka_unit_test(points_and_peaks_of_the_last_search_stay_readable),
        cmocka_unit_test(unclaimed_plots_are_held_and_counted),
        cmocka_unit_test(lines_without_a_new_plot_start_nothing),
        cmocka_unit_test(a_line_takes_plots_within_three_sigmas_of_its_motion),
        cmocka_unit_test(the_same_scans_give_the_same_bytes),
        cmocka_unit_test(bad_calls_of_paper_starts_are_refused),
        cmocka_unit_test(lines_from_bearings_start_tracks),
        cmocka_unit_test(bad_calls_of_passive_paper_are_refused),
        cmocka_unit_test(bad_estimates_given_by_a_caller_start_no_track),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
