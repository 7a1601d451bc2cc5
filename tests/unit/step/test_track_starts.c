/* SPDX-License-Identifier: MIT */
/*
 * Tracks started by the caller's own initiator: the improved Hough transform beside a tracker that
 * has no initiator; and starts that are refused.
 */
#include "rhotrack/hough.h"
#include "tracker_setup.h"

#define SCAN_S 2.0
#define WINDOW 5
#define CLUTTER 12
#define SCANS 20
#define PEAKS 4000

/* ---- a Hough transform beside the tracker ---------------------------------------------------- */

/* Unclaimed plots of the last WINDOW scans, oldest first. */
static struct {
    struct rho_plot plots[WINDOW][RHO_MAX_PLOTS];
    int16_t rows[WINDOW][RHO_MAX_PLOTS];
    uint32_t count[WINDOW];
    double t_s[WINDOW];
} window;

static struct rho_hough hough;
static struct rho_accumulator_peak peaks[PEAKS];

static void keep_unclaimed_plots(double t_s)
{
    const int last = WINDOW - 1;

    for (int m = 0; m < last; m++) {
        memcpy(window.plots[m], window.plots[m + 1], sizeof window.plots[m]);
        memcpy(window.rows[m], window.rows[m + 1], sizeof window.rows[m]);
        window.count[m] = window.count[m + 1];
        window.t_s[m] = window.t_s[m + 1];
        for (uint32_t i = 0; i < window.count[m]; i++) {
            window.rows[m][i] = -1; /* the row is known for the newest scan only */
        }
    }
    window.count[last] = 0;
    window.t_s[last] = t_s;
    for (uint32_t i = 0; i < report.num_plots; i++) {
        if (report.fates[i] == RHO_FATE_NO_ROOM) {
            window.plots[last][window.count[last]] = plots[i];
            window.rows[last][window.count[last]++] = (int16_t)i;
        }
    }
}

/* Finds the plot of each scan nearest to the line's target, if within 10 m. */
static unsigned find_plots_near_line(const struct rho_hough_track *line,
                                     struct rho_track_plot *found)
{
    unsigned num = 0;

    for (int m = 0; m < WINDOW; m++) {
        const double dt_s = window.t_s[m] - window.t_s[WINDOW - 1];
        double least_m = 10.0;
        int nearest = -1;

        for (uint32_t i = 0; i < window.count[m]; i++) {
            const struct rho_plot *plot = &window.plots[m][i];
            const double off_m = hypot(plot->x_m - line->x_m - dt_s * line->vx_mps,
                                       plot->y_m - line->y_m - dt_s * line->vy_mps);

            nearest = off_m < least_m ? (int)i : nearest;
            least_m = off_m < least_m ? off_m : least_m;
        }
        if (nearest >= 0) {
            found[num++] = (struct rho_track_plot){.time_us = (int64_t)(1e6 * window.t_s[m]),
                                                   .sensor_id = 1,
                                                   .plot = window.plots[m][nearest],
                                                   .row = window.rows[m][nearest]};
        }
    }
    return num;
}

/* Starts a track if a line has a plot in each scan. */
static void start_tracks_from_lines(void)
{
    static float x_m[WINDOW * RHO_MAX_PLOTS], y_m[WINDOW * RHO_MAX_PLOTS];
    uint32_t scan_end[WINDOW], num = 0;
    float t_s[WINDOW * RHO_MAX_PLOTS];
    struct rho_hough_result result;

    for (int m = 0; m < WINDOW; m++) {
        for (uint32_t i = 0; i < window.count[m]; i++, num++) {
            x_m[num] = window.plots[m][i].x_m;
            y_m[num] = window.plots[m][i].y_m;
            t_s[num] = (float)window.t_s[m];
        }
        scan_end[m] = num;
    }
    const struct rho_hough_points points = {{x_m, y_m, WINDOW, scan_end}, t_s};
    assert_int_equal(rho_hough_find(&hough, &points, peaks, PEAKS, &result), RHO_OK);
    for (uint32_t i = 0; i < result.num_peaks; i++) {
        struct rho_track_plot found[WINDOW];
        struct rho_hough_track line;

        assert_int_equal(rho_hough_track(&hough, &points, peaks[i].theta_cell, peaks[i].rho_cell,
                                         (float)window.t_s[WINDOW - 1], &line),
                         RHO_OK);
        if (line.has_velocity && find_plots_near_line(&line, found) == WINDOW) {
            assert_int_equal(rho_tracker_start_track(&tracker, found, WINDOW, 0, &report), RHO_OK);
            /* the line's plots now belong to a track; another target is found in the next scan */
            return;
        }
    }
}

static double target_x_m(double t_s)
{
    return -3000.0 + 220.0 * t_s;
}

static double target_y_m(double t_s)
{
    return 1500.0 - 90.0 * t_s;
}

static void step_scan_at(int k)
{
    const double t_s = SCAN_S * k;

    num_plots = 0;
    add_plot(target_x_m(t_s) + 0.5 * normal(), target_y_m(t_s) + 0.5 * normal(), 0.5);
    for (int i = 0; i < CLUTTER; i++) {
        const double x_m = uniform(-3500.0, 3500.0);

        add_plot(x_m, uniform(-3500.0, 3500.0), 0.5);
    }
    struct rho_scan scan = {
        .time_us = (int64_t)(1e6 * t_s), .sensor_id = 1, .num_plots = num_plots, .plots = plots};
    assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
}

/* One track, confirmed by the first full window, keeps the target and its identity. */
static void a_caller_may_start_tracks_by_a_hough_transform(void **state)
{
    struct rho_hough_config lines;
    uint32_t track_id = 0;

    (void)state;
    rho_hough_config_default(&lines, RHO_HOUGH_IHT);
    lines.rho_max_m = 5000.0f;
    /* half a metre of noise turns the line of two plots by a milliradian */
    lines.rho_cell_m = 25.0f;
    lines.theta_cell_rad = 0.02f;
    lines.votes_min = 3.0f;
    assert_int_equal(rho_hough_init(&hough, sizeof hough, &lines), RHO_OK);
    memset(&window, 0, sizeof window);
    use_usual_configs(3);
    begin_tracker();
    for (int k = 0; k < SCANS; k++) {
        step_scan_at(k);
        if (report.num_tracks == 0) {
            keep_unclaimed_plots(SCAN_S * k);
            if (k >= WINDOW - 1) {
                start_tracks_from_lines();
            }
        }
        assert_int_equal(report.num_tracks, k >= WINDOW - 1);
        if (k >= WINDOW - 1) {
            const struct rho_track_report *track = &report.tracks[0];

            assert_int_equal(track->status, RHO_TRACK_CONFIRMED);
            assert_true(track_id == 0 || track->track_id == track_id);
            assert_int_equal(track->plot, 0);
            assert_true(fabs(track->state[0] - target_x_m(SCAN_S * k)) < 5.0);
            assert_true(fabs(track->state[1] - target_y_m(SCAN_S * k)) < 5.0);
            track_id = track->track_id;
        }
    }
    assert_int_equal(tracker.counters.tracks_started, 1);
}

/* ---- refused starts, a full table ------------------------------------------------------------ */

static struct rho_track_plot three[3];

/* Three plots of a target, and a step at the time of the last one. */
static void start_tracker_and_step_third_of_three_plots(void)
{
    use_usual_configs(4);
    begin_tracker();
    for (int i = 0; i < 3; i++) {
        three[i] = (struct rho_track_plot){.time_us = INT64_C(2000000) * i,
                                           .sensor_id = 1,
                                           .plot = {.x_m = 400.0f * (float)i,
                                                    .y_m = 70.0f,
                                                    .sigma_range_m = 10.0f,
                                                    .sigma_cross_m = 10.0f},
                                           .row = (int16_t)(i == 2 ? 0 : -1)};
    }
    plots[0] = three[2].plot;
    struct rho_scan scan = {
        .time_us = three[2].time_us, .sensor_id = 1, .num_plots = 1, .plots = plots};
    assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
}

static void expect_start_refused(enum rho_status status, int32_t score_mnat)
{
    static struct rho_tracker before;
    static struct rho_report told;

    before = tracker;
    told = report;
    assert_int_equal(rho_tracker_start_track(&tracker, three, 3, score_mnat, &report), status);
    assert_memory_equal(&tracker, &before, sizeof tracker);
    assert_memory_equal(&report, &told, sizeof report);
}

static void refused_starts_change_nothing(void **state)
{
    (void)state;
    start_tracker_and_step_third_of_three_plots();
    assert_int_equal(rho_tracker_start_track(NULL, three, 3, 0, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_start_track(&tracker, NULL, 3, 0, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_start_track(&tracker, three, 3, 0, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_start_track(&tracker, three, 0, 0, &report), RHO_ERROR_VALUE);
    expect_start_refused(RHO_ERROR_VALUE, INT32_MAX);
    expect_start_refused(RHO_ERROR_VALUE, INT32_MIN);
    expect_start_refused(RHO_ERROR_VALUE, -4606); /* the score at which tracks end */
    three[2].row = 1;                             /* a row beyond the scan, which has one plot */
    expect_start_refused(RHO_ERROR_VALUE, 0);
    three[2].row = 0;
    three[1].plot.x_m = NAN;
    expect_start_refused(RHO_ERROR_VALUE, 0);
    three[1].plot.x_m = 400.0f;
    three[0].time_us = INT64_MIN;
    expect_start_refused(RHO_ERROR_VALUE, 0);
    three[0].time_us = INT64_MAX;
    expect_start_refused(RHO_ERROR_VALUE, 0);
    three[0].time_us = 0;
    report.time_us++;
    expect_start_refused(RHO_ERROR_STATE, 0);
    report.time_us--;
    assert_int_equal(rho_tracker_start_track(&tracker, three, 3, -4605, &report), RHO_OK);
    assert_int_equal(report.tracks[0].status, RHO_TRACK_TENTATIVE);
    memset(&tracker, 0, sizeof tracker);
    expect_start_refused(RHO_ERROR_STATE, 0);
}

/* The lowest tentative track is replaced by a better one; a worse one replaces none. */
static void a_full_tracker_replaces_its_lowest_tentative_track(void **state)
{
    (void)state;
    start_tracker_and_step_third_of_three_plots();
    for (unsigned i = 0; i < RHO_MAX_TRACKS; i++) {
        assert_int_equal(
            rho_tracker_start_track(&tracker, three, 3, -1000 - (int32_t)(i % 3), &report), RHO_OK);
    }
    assert_int_equal(report.num_tracks, RHO_MAX_TRACKS);
    assert_int_equal(rho_tracker_start_track(&tracker, three, 3, -2000, &report),
                     RHO_ERROR_CAPACITY);
    assert_int_equal(tracker.counters.tracks_no_room, 1);
    assert_int_equal(rho_tracker_start_track(&tracker, three, 3, 500, &report), RHO_OK);
    assert_int_equal(report.num_tracks, RHO_MAX_TRACKS);
    assert_int_equal(report.tracks[RHO_MAX_TRACKS - 1].status, RHO_TRACK_CONFIRMED);
    assert_int_equal(tracker.counters.tracks_no_room, 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_caller_may_start_tracks_by_a_hough_transform),
        cmocka_unit_test(refused_starts_change_nothing),
        cmocka_unit_test(a_full_tracker_replaces_its_lowest_tentative_track),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
