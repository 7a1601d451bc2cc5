/* SPDX-License-Identifier: MIT */
/*
 * Single plots: the score a hit adds, looks elsewhere that change nothing, and which plot the Hough
 * gate takes.
 */
#include "gates_scene.h"

static struct rho_tracker tracker_then;
static struct rho_initiator initiator_then;
static struct rho_report report_then;
static double interval_s = 1.0; /* interval of the scans */

static void copy_objects(void)
{
    memcpy(&tracker_then, &tracker, sizeof tracker);
    memcpy(&initiator_then, &initiator, sizeof initiator);
    memcpy(&report_then, &report, sizeof report);
}

static void restore_objects(void)
{
    memcpy(&tracker, &tracker_then, sizeof tracker);
    memcpy(&initiator, &initiator_then, sizeof initiator);
    memcpy(&report, &report_then, sizeof report);
}

/* One straight target, stepped up to scan k - 1. */
static void start_and_fly_lone_target(uint8_t gate, uint32_t measures, int num_scans)
{
    set_up_scene(gate, 77);
    scene.interval_s = interval_s;
    scene.measures = measures;
    scene.num_targets = 1;
    scene.target[0] = (struct target){-5000.0, 4000.0, 3000.0, 200.0, -0.4, 0.0, 0.0, 0.0};
    begin_tracker();
    for (int i = 0; i < num_scans; i++) {
        step_tracker(i);
    }
    assert_int_equal(report.num_tracks, 1);
}

/* ---- scores of hits and misses --------------------------------------------------------------- */

static void coasting_tracks_are_confirmed_again_by_a_hit(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        start_and_fly_lone_target((uint8_t)gate, 0, 15);
        scene.pd = 0.0;
        step_tracker(15);
        assert_int_equal(report.tracks[0].status, RHO_TRACK_COASTING);
        assert_int_equal(report.tracks[0].misses, 1);
        step_tracker(16);
        assert_int_equal(report.tracks[0].misses, 2);
        scene.pd = 1.0;
        step_tracker(17);
        assert_int_equal(report.tracks[0].status, RHO_TRACK_CONFIRMED);
        assert_int_equal(report.tracks[0].hits, 16);
        assert_int_equal(report.tracks[0].misses, 2);
    }
}

/* Score that the next scan adds: the target's plot without noise, measured in the given way. */
static double score_gain_of_plot(uint32_t measures)
{
    double before_nat = (double)report.tracks[0].score_nat;
    struct rho_scan scan = scan_without_plots_of_step(30);
    struct target at = target_on_its_turning_path_at(&scene.target[0], 30.0);
    copy_objects();
    scene.measures = scan.measures = measures;
    num_plots = 0;
    add_target_plot(&at, 0.0, 0);
    plots[0].x_m = (float)at.x_m;
    plots[0].y_m = (float)at.y_m;
    plots[0].vx_mps = (float)(at.speed_mps * cos(at.course_rad));
    plots[0].vy_mps = (float)(at.speed_mps * sin(at.course_rad));
    plots[0].range_rate_mps = (plots[0].x_m * plots[0].vx_mps + plots[0].y_m * plots[0].vy_mps) /
                              hypotf(plots[0].x_m, plots[0].y_m);
    step_with_scan(&scan, &initiator);
    assert_int_equal(report.fates[0], RHO_FATE_CLAIMED);
    double gain_nat = (double)report.tracks[0].score_nat - before_nat;
    restore_objects();
    return gain_nat;
}

/*
 * Another measured dimension is worth ln of the clutter's spread in it, 2 v_max = 800 m/s, less ln
 * of the innovation density, computed here with the reported velocity variance. Where the target is
 * predicted, both models agree.
 */
static void velocity_and_range_rate_add_to_the_score(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        start_and_fly_lone_target((uint8_t)gate, 0, 30);
        double variance = (double)report.tracks[0].sigma_mps * (double)report.tracks[0].sigma_mps;
        double place = score_gain_of_plot(0), rate = score_gain_of_plot(RHO_MEASURES_RANGE_RATE),
               velocity = score_gain_of_plot(RHO_MEASURES_VELOCITY);
        double rate_nat = log(800.0) - 0.5 * log(6.2832 * (1.0 + variance));
        double velocity_nat = 2.0 * log(800.0) - log(6.2832 * (25.0 + variance));
        print_message("gate %d: place %.2f, with range rate %.2f, velocity %.2f more\n", gate,
                      place, rate - place, velocity - place);
        assert_true(fabs(rate - place - rate_nat) < 1.0);
        /* a Kalman filter's gate does not use velocities */
        assert_true(fabs(velocity - place - (gate == RHO_TRACKER_BEST ? velocity_nat : 0.0)) < 1.0);
    }
}

/* Score of hits among so many unclaimed plots, while no initiator measures their density. */
static double mean_score_gain_of_a_hit_among_unclaimed_plots(uint8_t gate, unsigned strangers)
{
    double score_nat = 0.0;
    start_and_fly_lone_target(gate, 0, 10);
    for (int k = 10; k < 80; k++) {
        struct rho_scan scan = scan_without_plots_of_step(k);
        see_scan(k, k);
        for (unsigned i = 0; i < strangers; i++) {
            plots[num_plots++] = (struct rho_plot){.x_m = i % 2 ? 9e4f : -9e4f,
                                                   .y_m = i / 2 % 2 ? 9e4f : -9e4f,
                                                   .sigma_range_m = 10.0f,
                                                   .sigma_cross_m = 10.0f};
        }
        step_with_scan(&scan, NULL);
        score_nat = k == 70 ? (double)report.tracks[0].score_nat : score_nat;
    }
    assert_int_equal(report.tracks[0].hits, 80);
    return ((double)report.tracks[0].score_nat - score_nat) / 9.0;
}

static void without_an_initiator_unclaimed_plots_set_the_clutter(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        double few = mean_score_gain_of_a_hit_among_unclaimed_plots((uint8_t)gate, 4),
               many = mean_score_gain_of_a_hit_among_unclaimed_plots((uint8_t)gate, 40);
        assert_true(fabs(few - many - log(10.0)) < 0.05);
    }
}

/* ---- looks elsewhere ------------------------------------------------------------------------- */

/* Adds a second plot beside the target's at each of a few scans, which opens several hypotheses. */
static void step_scans_with_second_plots_beside_target(int from, int to)
{
    for (int k = from; k < to; k++) {
        struct rho_scan scan = scan_without_plots_of_step(k);
        struct target at = target_on_its_turning_path_at(&scene.target[0], k);
        see_scan(k, k);
        at.x_m += 35.0 * cos(2.0 * k);
        at.y_m += 35.0 * sin(2.0 * k);
        add_target_plot(&at, 0.0, -1);
        step_with_scan(&scan, &initiator);
    }
}

/* A look elsewhere changes neither the score nor the open hypotheses. */
static void scans_of_other_sectors_change_no_evidence(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        start_and_fly_lone_target((uint8_t)gate, 0, 15);
        step_scans_with_second_plots_beside_target(15, 19);
        float score_nat = report.tracks[0].score_nat;
        unsigned count = report.tracks[0].num_hypotheses;
        assert_true(gate == RHO_TRACKER_BEST ? count >= 3 : count == 1);
        for (int i = 1; i <= 6; i++) {
            struct rho_scan scan = scan_without_plots_of_step(18);
            scan.time_us += 100000 * i;
            scan.sector_from_rad = -2.0f; /* sector away from the target, which is at 2 to 3 rad */
            scan.sector_to_rad = -1.0f;
            num_plots = 0;
            step_with_scan(&scan, &initiator);
            assert_float_equal(report.tracks[0].score_nat, score_nat, 0.0f);
            assert_int_equal(report.tracks[0].num_hypotheses, count);
            assert_int_equal(report.tracks[0].misses, 0);
        }
        step_tracker(19);
        assert_int_equal(report.fates_total[RHO_FATE_CLAIMED], 1);
        assert_true(distance_m(&report.tracks[0], 0, 19.0) < 60.0);
    }
}

/*
 * A miss counts where the target is predicted now: in four seconds it went from azimuth 2.5 to 2.4
 * rad, and the sector ends in between.
 */
static void misses_count_where_the_target_is_predicted(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        start_and_fly_lone_target((uint8_t)gate, 0, 15);
        struct target last = target_on_its_turning_path_at(&scene.target[0], 14.0);
        struct target next = target_on_its_turning_path_at(&scene.target[0], 18.0);
        double from_rad = atan2(last.y_m, last.x_m), to_rad = atan2(next.y_m, next.x_m);
        struct rho_scan scan = scan_without_plots_of_step(18);
        scan.sector_from_rad = (float)((from_rad + to_rad) / 2.0);
        scan.sector_to_rad = (float)(from_rad + 0.5);
        assert_true(to_rad < from_rad - 0.05);
        num_plots = 0;
        step_with_scan(&scan, &initiator);
        assert_int_equal(report.tracks[0].misses, 0);
        scan.time_us += 1;
        scan.sector_to_rad = scan.sector_from_rad;
        scan.sector_from_rad = (float)(to_rad - 0.5);
        step_with_scan(&scan, &initiator);
        assert_int_equal(report.tracks[0].misses, 1);
    }
}

/*
 * A bearing 10 s after the last plot of a target that may pull 30 m/s^2: 0.1 rad (600 m) off it may
 * be the target's; right after a plot it may not.
 */
static void gates_of_bearings_allow_for_manoeuvres(void **state)
{
    (void)state;
    for (int i = 0; i < 2 * RHO_NUM_TRACKER_GATES; i++) {
        const int late_s = i % 2 ? 10 : 0;
        start_and_fly_lone_target((uint8_t)(i / 2), 0, 15);
        struct target at = target_on_its_turning_path_at(&scene.target[0], 14.0 + late_s);
        const float x_m = (float)at.x_m, y_m = (float)at.y_m - 6000.0f;
        const struct rho_bearing bearing = {.bearing_rad = 1.5707963f + 0.1f, .sigma_rad = 1e-3f};
        const struct rho_bearing_scan look_up = {.time_us = 1000000 * (14 + late_s),
                                                 .sensor_id = 5,
                                                 .x_m = x_m,
                                                 .y_m = y_m,
                                                 .num_bearings = 1,
                                                 .bearings = &bearing};
        assert_int_equal(rho_tracker_step_bearings(&tracker, NULL, &look_up, &report), RHO_OK);
        assert_int_equal(report.fates[0], late_s ? RHO_FATE_CLAIMED : RHO_FATE_NO_ROOM);
    }
}

/* ---- the Hough gate -------------------------------------------------------------------------- */

/* Change of rho by (20) to (30) of the paper, plane by plane, by searching all cells. */
static double change_of_rho_mps(const struct rho_track *track, const double velocity_mps[3],
                                int num_planes)
{
    static const int axes[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    const double cell_rad = 5.0 * 3.14159265358979 / 180.0;
    double sum = 0.0;
    for (int plane = 0; plane < num_planes; plane++) {
        int a = axes[plane][0], b = axes[plane][1];
        double da = (double)track->newest_mps[a] - (double)track->before_mps[a];
        double db = (double)track->newest_mps[b] - (double)track->before_mps[b];
        double least = INFINITY, theta_rad = 0.0;
        for (int j = 1; j <= 36; j++) {
            double at_rad = (j - 0.5) * cell_rad;
            double change = fabs(da * cos(at_rad) + db * sin(at_rad));
            theta_rad = change < least ? at_rad : theta_rad;
            least = fmin(change, least);
        }
        sum += fabs((velocity_mps[a] - (double)track->newest_mps[a]) * cos(theta_rad) +
                    (velocity_mps[b] - (double)track->newest_mps[b]) * sin(theta_rad));
    }
    return sum;
}

/* The velocity of a plot, measured or from its place. */
static void measured_or_derived_velocity_of_plot(const struct rho_plot *plot,
                                                 const double expected_m[3], double velocity_mps[3])
{
    const struct rho_track *track = &tracker_then.tracks[0];
    const float place_m[3] = {plot->x_m, plot->y_m, plot->z_m};
    const float measured_mps[3] = {plot->vx_mps, plot->vy_mps, plot->vz_mps};
    for (int axis = 0; axis < 3; axis++) {
        velocity_mps[axis] = scene.measures & RHO_MEASURES_VELOCITY
                                 ? (double)measured_mps[axis]
                                 : (double)track->newest_mps[axis] +
                                       ((double)place_m[axis] - expected_m[axis]) / interval_s;
    }
}

/*
 * Five plots in the gate, near the predicted place. Returns the paper's choice, 0 if two are
 * equally good.
 */
static int assert_choice_of_paper_and_return_if_clear(int k)
{
    double expected_m[3], least = INFINITY, second = INFINITY;
    const float *at = report.tracks[0].state;
    int best = -1;
    struct rho_scan scan = scan_without_plots_of_step(k);
    copy_objects();
    for (int axis = 0; axis < 3; axis++) {
        expected_m[axis] = (double)at[axis] + interval_s * (double)at[3 + axis];
    }
    num_plots = 0;
    for (int i = 0; i < 5; i++) {
        struct target plot = {.x_m = expected_m[0], .y_m = expected_m[1], .z_m = expected_m[2]};
        plot.speed_mps = uniform(190.0, 210.0);
        plot.course_rad = uniform(-0.5, -0.3);
        add_target_plot(&plot, 0.0, -1);
    }
    for (int i = 0; i < 5; i++) {
        double velocity_mps[3];
        measured_or_derived_velocity_of_plot(&plots[i], expected_m, velocity_mps);
        double off = change_of_rho_mps(&tracker_then.tracks[0], velocity_mps,
                                       scene.measures & RHO_MEASURES_Z ? 3 : 1);
        best = off < least ? i : best;
        second = off < least ? least : fmin(off, second);
        least = fmin(off, least);
    }
    step_with_scan(&scan, NULL);
    if (second - least < 0.02) {
        return 0;
    }
    assert_int_equal(report.tracks[0].plot, best);
    return 1;
}

static void the_hough_gate_takes_the_plot_of_least_rho_change(void **state)
{
    static const uint32_t kinds[] = {0, RHO_MEASURES_Z, RHO_MEASURES_VELOCITY,
                                     RHO_MEASURES_Z | RHO_MEASURES_VELOCITY};
    (void)state;
    interval_s = 2.0;
    for (unsigned kind = 0; kind < 4; kind++) {
        int told = 0;
        start_and_fly_lone_target(RHO_TRACKER_HOUGH, kinds[kind], 12);
        for (int k = 12; k < 62; k++) {
            for (int i = 0; i < 4; i++) {
                told += assert_choice_of_paper_and_return_if_clear(k);
                restore_objects(); /* undone, as taking clutter would lead the track astray */
            }
            step_tracker(k);
        }
        assert_true(told > 190);
    }
    interval_s = 1.0;
}

/* The normal of the line in velocity space on which the track should stay: the cell of (20). */
static void normal_of_velocity_line(const struct rho_track *track, double normal[2])
{
    const double cell_rad = 5.0 * 3.14159265358979 / 180.0;
    double least = INFINITY;
    for (int j = 1; j <= 36; j++) {
        const double c = cos((j - 0.5) * cell_rad), s = sin((j - 0.5) * cell_rad);
        const double change =
            fabs(((double)track->newest_mps[0] - (double)track->before_mps[0]) * c +
                 ((double)track->newest_mps[1] - (double)track->before_mps[1]) * s);
        if (change < least) {
            least = change;
            normal[0] = c;
            normal[1] = s;
        }
    }
}

static unsigned lower, upper; /* rows of the tracks with the lower and the higher y */

/* Adds a plot whose velocity is this far off the lines of both tracks. */
static void add_plot_off_both_lines(double y_m, double lower_mps, double upper_mps)
{
    const float *u_mps = tracker.tracks[lower].newest_mps,
                *v_mps = tracker.tracks[upper].newest_mps;
    double a[2], b[2];
    normal_of_velocity_line(&tracker.tracks[lower], a);
    normal_of_velocity_line(&tracker.tracks[upper], b);
    const double p = lower_mps + a[0] * (double)u_mps[0] + a[1] * (double)u_mps[1];
    const double q = upper_mps + b[0] * (double)v_mps[0] + b[1] * (double)v_mps[1];
    const double det = a[0] * b[1] - a[1] * b[0];
    struct target at = {.x_m = -5000.0 + 200.0 * 16, .y_m = y_m};
    add_target_plot(&at, 0.0, -1);
    plots[num_plots - 1].vx_mps = (float)((p * b[1] - q * a[1]) / det);
    plots[num_plots - 1].vy_mps = (float)((a[0] * q - b[0] * p) / det);
}

/* Two tracks, at y = 0 and 400 m, whose velocities changed nearly along x and y. */
static struct rho_scan fly_two_tracks_and_make_empty_next_scan(uint8_t status_of_upper)
{
    set_up_scene(RHO_TRACKER_HOUGH, 77);
    config.hough_window_m = 2000.0f;
    scene.measures = RHO_MEASURES_VELOCITY;
    scene.num_targets = 2;
    scene.target[0] = (struct target){-5000.0, 0.0, 3000.0, 200.0, 0.0, 0.0, 0.0, 0.0};
    scene.target[1] = (struct target){-5000.0, 400.0, 3000.0, 200.0, 0.0, 0.0, 0.0, 0.0};
    begin_tracker();
    for (int k = 0; k < 16; k++) {
        step_tracker(k);
    }
    assert_int_equal(report.num_tracks, 2);
    upper = tracker.tracks[1].kalman.state[1] > 200.0f;
    lower = 1 - upper;
    for (unsigned i = 0; i < 2; i++) {
        const float *newest_mps = tracker.tracks[i].newest_mps;
        tracker.tracks[i].before_mps[0] = newest_mps[0] - (i == lower ? 3.0f : 0.1f);
        tracker.tracks[i].before_mps[1] = newest_mps[1] - (i == upper ? 3.0f : 0.1f);
    }
    tracker.tracks[upper].status = status_of_upper;
    num_plots = 0;
    return scan_without_plots_of_step(16);
}

/*
 * The confirmed track may take either plot, the tentative one only the first, worth 16 + ln 1000
 * nat to it. For the confirmed track the second plot costs 200 ln of the residual ratio, so up to a
 * ratio of 1.12 it leaves the first.
 */
static void a_confirmed_track_gives_way_for_a_residual_ratio_up_to_1_1(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct rho_scan scan = fly_two_tracks_and_make_empty_next_scan(RHO_TRACK_TENTATIVE);
        add_plot_off_both_lines(0.0, 10.0, 0.0);
        add_plot_off_both_lines(-1800.0, i ? 10.9 : 11.7, 0.0);
        step_with_scan(&scan, NULL);
        assert_int_equal(report.tracks[lower].plot, i);
        assert_int_equal(report.tracks[upper].plot, i ? 0 : -1);
    }
}

/*
 * Between confirmed tracks the product of residuals decides, each plus 0.001 m/s: 0 and 1 m/s
 * against twice 0.031 m/s.
 */
static void products_of_velocity_residuals_plus_1_mmps_decide(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        const double off_mps = i ? 0.026 : 0.036;
        struct rho_scan scan = fly_two_tracks_and_make_empty_next_scan(RHO_TRACK_CONFIRMED);
        add_plot_off_both_lines(200.0, 0.0, off_mps);
        add_plot_off_both_lines(210.0, off_mps, 1.0);
        step_with_scan(&scan, NULL);
        assert_int_equal(report.tracks[lower].plot, i);
        assert_int_equal(report.tracks[upper].plot, 1 - i);
    }
}

/*
 * With fewer than three velocities the chi-square gate decides: it takes the plot in the middle,
 * not the one that continues straight.
 */
static void the_hough_gate_begins_with_the_third_velocity(void **state)
{
    (void)state;
    for (uint8_t velocities = 2; velocities < 4; velocities++) {
        struct rho_scan scan = fly_two_tracks_and_make_empty_next_scan(RHO_TRACK_CONFIRMED);
        const float *at = tracker.tracks[lower].kalman.state;
        tracker.tracks[lower].num_velocities = velocities;
        add_plot_off_both_lines(0.0, 9.0, 1.0);
        add_plot_off_both_lines(0.0, 0.0, 1.0);
        for (int i = 0; i < 2; i++) {
            plots[i].x_m = at[0] + at[3];
            plots[i].y_m = at[1] + at[4] + 15.0f * (float)i;
        }
        step_with_scan(&scan, NULL);
        assert_int_equal(report.tracks[lower].plot, velocities - 2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coasting_tracks_are_confirmed_again_by_a_hit),
        cmocka_unit_test(velocity_and_range_rate_add_to_the_score),
        cmocka_unit_test(without_an_initiator_unclaimed_plots_set_the_clutter),
        cmocka_unit_test(scans_of_other_sectors_change_no_evidence),
        cmocka_unit_test(misses_count_where_the_target_is_predicted),
        cmocka_unit_test(gates_of_bearings_allow_for_manoeuvres),
        cmocka_unit_test(the_hough_gate_takes_the_plot_of_least_rho_change),
        cmocka_unit_test(a_confirmed_track_gives_way_for_a_residual_ratio_up_to_1_1),
        cmocka_unit_test(products_of_velocity_residuals_plus_1_mmps_decide),
        cmocka_unit_test(the_hough_gate_begins_with_the_third_velocity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
