/* SPDX-License-Identifier: MIT */
/*
 * Extended targets of several plots a scan: each gets one track with its extent; near each other
 * they keep two; and which extents a tracker may be told.
 */
#include "rhotrack/operator.h"
#include "tracker_setup.h"

#define SENSOR 1
#define STEP_S 0.1

struct vehicle {
    double x_m, y_m, vx_mps, length_m, width_m;
    int scatterers;
};

/* Plots are this many seconds after their scan's time. */
static double own_s;

static void start_tracker_with_longest(float longest_m)
{
    const struct rho_sensor radar = {.sensor_id = SENSOR, .pd = 0.9f, .range_max_m = 1e3f};
    use_usual_configs(11);
    own_s = 0.0;
    config.v_max_mps = initiation.v_max_mps = 60.0f;
    begin_tracker();
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
    assert_int_equal(rho_tracker_set_body_max(&tracker, longest_m), RHO_OK);
}

/*
 * Each scatterer lies at a random point of its part of the length and is seen with probability 0.7.
 */
static void see_vehicle(const struct vehicle *vehicle, int k)
{
    for (int i = 0; i < vehicle->scatterers; i++) {
        const double part = (i + uniform(0.0, 1.0)) / vehicle->scatterers - 0.5;
        const double side = uniform(-0.5, 0.5);
        if (uniform(0.0, 1.0) < 0.7) {
            add_noisy_plot(vehicle->x_m + vehicle->vx_mps * (STEP_S * k + own_s) +
                               part * vehicle->length_m,
                           vehicle->y_m + side * vehicle->width_m, 0.2);
            plots[num_plots - 1].offset_us = (int32_t)lround(1e6 * own_s);
        }
    }
}

static void step_scan_at(int k)
{
    step_scan((struct rho_scan){.time_us = INT64_C(100000) * k, .sensor_id = SENSOR});
}

/* Row of the only track on the vehicle; -1: none. */
static int row_of_track_on(const struct vehicle *vehicle, int k)
{
    int found = -1;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        const double dx_m =
            (double)report.tracks[i].state[0] - vehicle->x_m - vehicle->vx_mps * STEP_S * k;
        if (fabs(dx_m) < vehicle->length_m / 2 &&
            fabs((double)report.tracks[i].state[1] - vehicle->y_m) < vehicle->width_m / 2 + 0.5) {
            assert_int_equal(found, -1);
            found = (int)i;
        }
    }
    return found;
}

static const struct vehicle truck = {-200.0, 60.0, 20.0, 12.0, 2.5, 8};

static void a_truck_of_several_plots_has_one_track(void **state)
{
    (void)state;
    for (int with_bodies = 0; with_bodies < RHO_BODIES + 1; with_bodies++) {
        unsigned most = 0;
        struct rho_body body;
        start_tracker_with_longest(with_bodies ? 15.0f : 0.0f);
        assert_int_equal(rho_tracker_body_of(&tracker, 0, &body), 0);
        for (int k = 0; k < 150; k++) {
            see_vehicle(&truck, k);
            const uint32_t seen = num_plots;
            step_scan_at(k);
            most = report.num_tracks > most ? report.num_tracks : most;
            if (with_bodies && k > 20) {
                /* every plot belongs to the track, and the track's row is one of the scan's */
                assert_int_equal(report.fates_total[RHO_FATE_CLAIMED], seen);
                assert_int_equal(report.num_tracks, 1);
                assert_int_equal(report.tracks[0].track_id, 1);
                assert_in_range(report.tracks[0].plot, 0, seen - 1);
            }
        }
        if (!with_bodies) {
            assert_true(most > 3);
            continue;
        }
        assert_int_equal(most, 1);
        assert_int_equal(rho_tracker_body_of(&tracker, 0, &body), 1);
        assert_true(fabs((double)body.length_m - 12.0) < 1.0);
        assert_true(fabs((double)body.width_m - 2.5) < 0.5);
        assert_true(fabs((double)body.heading_rad) < 0.05);
        assert_true(body.sigma_length_m < 2.0f && body.sigma_heading_rad < 0.1f);
        /*
         * the noise of a group is mostly the spread over the body, so no sensor noise is learned
         * from it
         */
        assert_true(tracker.sensors[0].learned.log_noise[0] == 0.0f);
        const double off_m =
            (double)report.tracks[0].state[0] - truck.x_m - truck.vx_mps * STEP_S * 149;
        assert_true(fabs(off_m) < 1.0);
        assert_int_equal(rho_tracker_body_of(&tracker, 1, &body), 0);
        assert_int_equal(rho_tracker_body_of(NULL, 0, &body), 0);
        assert_true(rho_tracker_has_body(&tracker, 0));
        assert_false(rho_tracker_has_body(&tracker, 1));
        assert_false(rho_tracker_has_body(NULL, 0));
        tracker.bodies.of[0].most_plots = 1; /* no scan had two */
        assert_false(rho_tracker_has_body(&tracker, 0));
        tracker.bodies.of[0].most_plots = 2;
        assert_int_equal(rho_tracker_body_of(&tracker, 0, NULL), 0);
        assert_true(rho_tracker_is_sound(&tracker));
    }
}

/* Scan k of two vehicles: from the twentieth scan on each keeps its track. */
static void expect_a_track_for_each(const struct vehicle *pair, int k, uint32_t ids[2])
{
    see_vehicle(&pair[0], k);
    see_vehicle(&pair[1], k);
    step_scan_at(k);
    for (int n = 0; n < 2 && k >= 20; n++) {
        const int place = row_of_track_on(&pair[n], k);
        assert_true(place >= 0);
        ids[n] = ids[n] ? ids[n] : report.tracks[place].track_id;
        assert_int_equal(report.tracks[place].track_id, ids[n]);
    }
}

/* First seen apart, then beside or behind each other for long. */
static void neighbouring_vehicles_keep_two_tracks(void **state)
{
    static const struct vehicle pairs[][2] = {
        /* bumper to bumper: two cars close up to 1.5 m */
        {{-200.0, 60.0, 15.0, 4.5, 1.8, 4}, {-194.0, 60.0, 15.0, 4.5, 1.8, 4}},
        /* a car beside a truck, one lane apart */
        {{-200.0, 60.0, 20.0, 12.0, 2.5, 8}, {-199.0, 63.5, 20.0, 4.5, 1.8, 4}},
    };
    (void)state;
    if (!RHO_BODIES) {
        skip();
    }
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        uint32_t ids[2] = {0, 0};
        start_tracker_with_longest(15.0f);
        for (int k = 0; k < 260; k++) {
            struct vehicle now[2] = {pairs[i][0], pairs[i][1]};
            /* 20 m further apart at first, closed in 10 s */
            now[1].x_m += k < 100 ? 20.0 - 0.2 * k : 0.0;
            expect_a_track_for_each(now, k, ids);
            assert_true(k < 20 || report.num_tracks == 2);
        }
    }
}

/* A car overtakes a truck one lane apart, with plots taken long after the scan's time. */
static void plots_far_from_the_scan_time_go_to_their_track(void **state)
{
    const struct vehicle pair[2] = {{-250.0, 60.0, 20.0, 12.0, 2.5, 8},
                                    {-275.0, 63.5, 22.0, 4.5, 1.8, 4}};
    uint32_t ids[2] = {0, 0};
    (void)state;
    if (!RHO_BODIES) {
        skip();
    }
    start_tracker_with_longest(15.0f);
    own_s = 1.5;
    for (int k = 0; k < 220; k++) {
        expect_a_track_for_each(pair, k, ids);
    }
}

/*
 * A truck half in an excluded area: its plots in the area start nothing and are reported one by
 * one.
 */
static void plots_in_excluded_areas_join_no_group(void **state)
{
    (void)state;
    if (!RHO_BODIES) {
        skip();
    }
    for (int most = 0; most < 2; most++) {
        const struct rho_extent area = {-100.0f, most ? 100.0f : 0.0f, 50.0f, 70.0f};
        const struct vehicle parked = {1.0, 60.0, 0.0, 12.0, 2.5, 8};
        uint32_t inside = 0;
        start_tracker_with_longest(15.0f);
        assert_int_equal(rho_tracker_exclude_area(&tracker, &area), RHO_OK);
        for (int k = 0; k < 20; k++) {
            see_vehicle(&parked, k);
            for (uint32_t i = 0; i < num_plots; i++) {
                inside += plots[i].x_m <= area.x_max_m;
            }
            step_scan_at(k);
            if (most) {
                assert_int_equal(report.fates_total[RHO_FATE_GHOST], report.num_plots);
            }
        }
        assert_int_equal(report.num_tracks, most ? 0 : 1);
        assert_true(tracker.counters.plots_excluded > 0);
        assert_true(most ? tracker.counters.plots_excluded == inside
                         : tracker.counters.plots_excluded <= inside);
    }
}

/* Two trucks that pass each other 12 m apart, soon after they were found. */
static void vehicles_passing_each_other_keep_two_tracks(void **state)
{
    const struct vehicle pair[2] = {{-60.0, 60.0, 20.0, 12.0, 2.5, 2},
                                    {60.0, 72.0, -20.0, 12.0, 2.5, 2}};
    uint32_t ids[2] = {0, 0};
    (void)state;
    if (!RHO_BODIES) {
        skip();
    }
    start_tracker_with_longest(25.0f);
    for (int k = 0; k < 120; k++) {
        expect_a_track_for_each(pair, k, ids);
    }
}

static void bad_plots_and_full_scans_do_no_harm(void **state)
{
    (void)state;
    if (!RHO_BODIES) {
        skip();
    }
    start_tracker_with_longest(15.0f);
    for (int k = 0; k < 20; k++) {
        add_plot(NAN, 60.0, 0.2);
        see_vehicle(&truck, k);
        add_plot(0.0, 0.0, -1.0);
        const uint32_t seen = num_plots;
        step_scan_at(k);
        assert_int_equal(report.fates_total[RHO_FATE_INVALID], 2);
        assert_int_equal(report.fates[0], RHO_FATE_INVALID);
        assert_int_equal(report.fates[seen - 1], RHO_FATE_INVALID);
    }
    assert_int_equal(report.num_tracks, 1);
    for (int i = 0; i < RHO_MAX_PLOTS + 10; i++) {
        add_plot(uniform(-900.0, 900.0), 500.0, 0.2);
    }
    step_scan_at(20);
    assert_int_equal(report.num_plots, RHO_MAX_PLOTS + 10);
    assert_in_range(report.fates_total[RHO_FATE_NO_ROOM], 10, RHO_MAX_PLOTS);
}

/* With a small work limit, plots that are not grouped count as points, and the step reports it. */
static void work_of_grouping_is_bounded(void **state)
{
    (void)state;
    if (!RHO_BODIES) {
        skip();
    }
    use_usual_configs(11);
    config.work_max = 4000;
    config.v_max_mps = initiation.v_max_mps = 60.0f;
    begin_tracker();
    assert_int_equal(rho_tracker_set_body_max(&tracker, 100.0f), RHO_OK);
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 120; i++) {
            add_noisy_plot(uniform(-20.0, 20.0), 60.0, 0.2);
        }
        step_scan_at(k);
        assert_true(report.is_partial);
        assert_true(tracker.work.work < 8000);
    }
}

static void bad_body_lengths_are_refused(void **state)
{
    static struct rho_tracker empty;
    (void)state;
    start_tracker_with_longest(0.0f);
    assert_int_equal(rho_tracker_set_body_max(NULL, 1.0f), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_set_body_max(&empty, 1.0f), RHO_ERROR_STATE);
    assert_int_equal(rho_tracker_set_body_max(&tracker, -1.0f), RHO_ERROR_VALUE);
    assert_int_equal(rho_tracker_set_body_max(&tracker, NAN), RHO_ERROR_VALUE);
    assert_int_equal(rho_tracker_set_body_max(&tracker, 1.01f * RHO_LIMIT_BODY_M), RHO_ERROR_VALUE);
    assert_int_equal(rho_tracker_set_body_max(&tracker, RHO_LIMIT_BODY_M),
                     RHO_BODIES ? RHO_OK : RHO_ERROR_CAPACITY);
    assert_int_equal(rho_tracker_set_body_max(&tracker, 0.0f), RHO_OK);
}

/* A body stays finite where plots say almost nothing of its heading. */
static void a_body_seen_with_poor_azimuths_stays_finite(void **state)
{
    struct rho_body body;
    (void)state;
    if (!RHO_BODIES) {
        skip();
    }
    start_tracker_with_longest(15.0f);
    for (int k = 0; k < 400; k++) {
        for (int i = 0; i < 20; i++) {
            const double along_m = uniform(-0.5, 0.5), off_m = normal();
            add_plot(100.0 + 20.0 * STEP_S * k + along_m, 30.0 * off_m, 0.3)->sigma_cross_m = 30.0f;
        }
        step_scan_at(k);
        assert_true(rho_tracker_is_sound(&tracker));
    }
    float least = INFINITY; /* two tracks may share plots that are so far apart */
    for (unsigned row = 0; row < tracker.num_tracks; row++) {
        assert_int_equal(rho_tracker_body_of(&tracker, row, &body), 1);
        assert_true(isfinite(body.sigma_width_m) && isfinite(body.sigma_length_m));
        least = fminf(least, tracker.bodies.of[row].slope_weight);
    }
    assert_true(least < 1.0f);
}

/* The longest body is told to be nearly 0 m, and one that stands still never shows its extent. */
static void the_shortest_bodies_keep_a_length_of_0_1_m(void **state)
{
    static const float longest_m[] = {1e-30f, 1e-3f, 0.1f};
    (void)state;
    if (!RHO_BODIES) {
        skip();
    }
    for (size_t i = 0; i < sizeof longest_m / sizeof longest_m[0]; i++) {
        struct rho_body body;
        start_tracker_with_longest(longest_m[i]);
        for (int k = 0; k < 30; k++) {
            (void)add_plot(30.0, 50.0, 0.2);
            (void)add_plot(30.0, 50.0, 0.2);
            step_scan_at(k);
            assert_true(rho_tracker_is_sound(&tracker));
            if (rho_tracker_body_of(&tracker, 0, &body)) {
                assert_true(fabs((double)body.length_m - 0.1) < 0.02);
                assert_true(isfinite(body.sigma_length_m) && isfinite(body.sigma_width_m));
            }
        }
        assert_int_equal(rho_tracker_body_of(&tracker, 0, &body), 1);
    }
}

/*
 * The extent of a standing body is not learned: it stays half as long as the longest, and as wide.
 */
static void a_standing_body_is_taken_as_half_the_longest(void **state)
{
    struct rho_body body;
    (void)state;
    if (!RHO_BODIES) {
        skip();
    }
    start_tracker_with_longest(15.0f);
    for (int k = 0; k < 10; k++) {
        (void)add_plot(29.0, 50.0, 0.2);
        (void)add_plot(31.0, 50.0, 0.2);
        step_scan_at(k);
    }
    assert_int_equal(rho_tracker_body_of(&tracker, 0, &body), 1);
    assert_true(fabs((double)body.length_m - 7.5) < 0.1);
    assert_true(fabs((double)body.width_m - 7.5) < 0.1);
}

/* A body of unknown length is taken as half the longest, but at least 0.1 m. */
static void a_standing_body_is_at_least_0_1_m_long(void **state)
{
    static const struct {
        float longest_m;
        double length_m;
    } cases[] = {{0.01f, 0.1}, {0.18f, 0.1}, {0.22f, 0.11}, {0.3f, 0.15}};
    (void)state;
    if (!RHO_BODIES) {
        skip();
    }
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct rho_body body;
        start_tracker_with_longest(cases[i].longest_m);
        for (int k = 0; k < 10; k++) {
            (void)add_plot(30.0, 50.0, 0.2);
            (void)add_plot(30.0, 50.0, 0.2);
            step_scan_at(k);
        }
        assert_int_equal(rho_tracker_body_of(&tracker, 0, &body), 1);
        assert_true(fabs((double)body.length_m - cases[i].length_m) < 0.005);
        assert_true(fabs((double)body.width_m - cases[i].length_m) < 0.005);
    }
}

/* The filter works with variances of 1e-7 m^2 and above. */
static void variances_below_1e_7_m2_are_unsound(void **state)
{
    (void)state;
    if (!RHO_BODIES) {
        skip();
    }
    start_tracker_with_longest(15.0f);
    for (int k = 0; k < 20; k++) {
        see_vehicle(&truck, k);
        step_scan_at(k);
    }
    for (int i = 0; i < 3; i++) {
        const struct rho_bodies good = tracker.bodies;
        struct rho_body_filter *body = &tracker.bodies.of[0];
        float *m2 = i == 0 ? &body->along_m2 : i == 1 ? &body->across_m2 : &body->prior_m2;
        *m2 = 1.4e-7f;
        assert_true(rho_tracker_is_sound(&tracker));
        *m2 = 0.7e-7f;
        assert_false(rho_tracker_is_sound(&tracker));
        tracker.bodies = good;
    }
}

static void corrupt_body_state_is_detected(void **state)
{
    (void)state;
    if (!RHO_BODIES) {
        skip();
    }
    start_tracker_with_longest(15.0f);
    for (int k = 0; k < 20; k++) {
        see_vehicle(&truck, k);
        step_scan_at(k);
    }
    assert_true(rho_tracker_is_sound(&tracker));
    const struct rho_bodies good = tracker.bodies;
    tracker.bodies.count = RHO_MAX_TRACKS + 1;
    assert_false(rho_tracker_is_sound(&tracker));
    tracker.bodies = good;
    tracker.bodies.length_max_m = NAN;
    assert_false(rho_tracker_is_sound(&tracker));
    tracker.bodies = good;
    tracker.bodies.of[0].along_m2 = NAN;
    assert_false(rho_tracker_is_sound(&tracker));
    tracker.bodies = good;
    tracker.bodies.of[0].across.weight = 0.0f;
    assert_false(rho_tracker_is_sound(&tracker));
    tracker.bodies = good;
    tracker.bodies.of[0].along.prior_share = NAN;
    assert_false(rho_tracker_is_sound(&tracker));
    tracker.bodies = good;
    tracker.bodies.of[0].slope_weight = 0.0f; /* the weight's reciprocal is taken */
    assert_false(rho_tracker_is_sound(&tracker));
    tracker.bodies = good;
    tracker.bodies.of[0].along_m2 = 0.0f; /* the length's reciprocal is taken */
    assert_false(rho_tracker_is_sound(&tracker));
    tracker.bodies = good;
    assert_true(rho_tracker_is_sound(&tracker));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_truck_of_several_plots_has_one_track),
        cmocka_unit_test(neighbouring_vehicles_keep_two_tracks),
        cmocka_unit_test(plots_far_from_the_scan_time_go_to_their_track),
        cmocka_unit_test(plots_in_excluded_areas_join_no_group),
        cmocka_unit_test(vehicles_passing_each_other_keep_two_tracks),
        cmocka_unit_test(bad_plots_and_full_scans_do_no_harm),
        cmocka_unit_test(work_of_grouping_is_bounded),
        cmocka_unit_test(bad_body_lengths_are_refused),
        cmocka_unit_test(a_body_seen_with_poor_azimuths_stays_finite),
        cmocka_unit_test(the_shortest_bodies_keep_a_length_of_0_1_m),
        cmocka_unit_test(a_standing_body_is_taken_as_half_the_longest),
        cmocka_unit_test(a_standing_body_is_at_least_0_1_m_long),
        cmocka_unit_test(variances_below_1e_7_m2_are_unsound),
        cmocka_unit_test(corrupt_body_state_is_detected),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
