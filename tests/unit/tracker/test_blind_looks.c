/* SPDX-License-Identifier: MIT */
/*
 * Tracks in the Doppler notch of their sensor coast and keep their identity, and the sensor is not
 * suspect. Gone targets that the notch cannot hide end as usual.
 */
#include "tracker_setup.h"

#define SENSOR 1

static struct rho_sensor radar;

static void describe_radar(float notch_mps, float blind_speed_mps)
{
    radar = (struct rho_sensor){.sensor_id = SENSOR,
                                .pd = 0.9f,
                                .range_max_m = 60e3f,
                                .notch_mps = notch_mps,
                                .blind_speed_mps = blind_speed_mps};
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
}

static void start_tracker(float v_max_mps, float accel_max_mps2, float v_min_mps)
{
    use_usual_configs(3);
    config.v_max_mps = initiation.v_max_mps = v_max_mps;
    config.v_min_mps = v_min_mps;
    config.accel_max_mps2 = accel_max_mps2;
    begin_tracker();
}

/*
 * Adds a plot if the range rate over ground is outside the notch of `true_notch_mps`. Returns
 * whether it did.
 */
static int add_plot_if_outside_notch_and_step(double t_s, double x_m, double y_m, double vx_mps,
                                              double vy_mps, double sigma_m, double true_notch_mps)
{
    const double dx_m = x_m - (double)radar.x_m, dy_m = y_m - (double)radar.y_m;
    const double rate_mps = (dx_m * vx_mps + dy_m * vy_mps) / hypot(dx_m, dy_m);
    const int is_seen = fabs(rate_mps) >= true_notch_mps;
    if (is_seen) {
        add_noisy_plot(x_m, y_m, sigma_m);
    }
    step_scan((struct rho_scan){.time_us = llround(t_s * 1e6), .sensor_id = SENSOR});
    return is_seen;
}

/* Scans in which the track is neither confirmed nor coasting, and its identities. */
struct passage {
    unsigned unseen, lost, misses;
    uint32_t first_id, last_id;
    int is_there;
};

static void note_passage(struct passage *passage, int k, int is_seen)
{
    const struct rho_track_report *track = report.num_tracks > 0 ? &report.tracks[0] : NULL;
    passage->unseen += !is_seen;
    passage->is_there = track && track->status != RHO_TRACK_TENTATIVE;
    passage->lost += k >= 8 && !passage->is_there;
    if (track) {
        passage->first_id = passage->first_id ? passage->first_id : track->track_id;
        passage->last_id = track->track_id;
        passage->misses = track->misses;
    }
}

/* An aircraft of 75 m/s passes 12 km away; the radar may move sideways with it. */
static struct passage fly_past_radar(double platform_mps)
{
    struct passage passage = {0};
    for (int k = 0; k < 110; k++) {
        const double t_s = 4.0 * k;
        radar.x_m = (float)(platform_mps * (t_s - 220.0));
        assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
        note_passage(&passage, k,
                     add_plot_if_outside_notch_and_step(t_s, 75.0 * (t_s - 220.0), 12000.0, 75.0,
                                                        0.0, 30.0, 12.0));
    }
    return passage;
}

static void an_aircraft_in_the_notch_keeps_its_track(void **state)
{
    (void)state;
    start_tracker(350.0f, 20.0f, 30.0f);
    describe_radar(12.0f, 0.0f);
    const struct passage passage = fly_past_radar(0.0);
    assert_true(passage.unseen > 10);
    assert_int_equal(passage.lost, 0);
    assert_int_equal(passage.first_id, passage.last_id);
    /* blind looks are no misses; a few at the notch's edge are */
    assert_true(passage.misses <= 3);
}

static void an_aircraft_in_an_undeclared_notch_is_lost(void **state)
{
    (void)state;
    start_tracker(350.0f, 20.0f, 30.0f);
    describe_radar(0.0f, 0.0f);
    const struct passage passage = fly_past_radar(0.0);
    assert_true(passage.lost > 5);
}

/*
 * A radar flying beside the aircraft sees it in the notch by the range rate over ground, without
 * its own motion.
 */
static void the_notch_of_a_moving_radar_is_of_rates_over_ground(void **state)
{
    (void)state;
    start_tracker(350.0f, 20.0f, 30.0f);
    describe_radar(12.0f, 0.0f);
    const struct passage passage = fly_past_radar(45.0);
    assert_true(passage.unseen > 20);
    assert_int_equal(passage.lost, 0);
    assert_int_equal(passage.first_id, passage.last_id);
}

/* A car brakes, stands in the notch for 20 s and drives on; 20 looks a second. */
static struct passage fly_stopping_car(double for_s, float *off_m)
{
    struct passage passage = {0};
    double x_m = 150.0, v_mps = -14.0, stood_s = 0.0;
    *off_m = 0.0f;
    for (int k = 0; k < 20 * 40; k++) {
        const double accel_mps2 = x_m > 95.0 ? 0.0 : stood_s < for_s ? 3.0 : -2.0;
        if (accel_mps2 > 0.0 && v_mps >= 0.0) {
            stood_s += 0.05;
            v_mps = 0.0;
        } else {
            v_mps += 0.05 * accel_mps2;
            v_mps = v_mps > 0.0 ? 0.0 : v_mps < -14.0 ? -14.0 : v_mps;
            x_m += 0.05 * v_mps;
        }
        note_passage(&passage, k,
                     add_plot_if_outside_notch_and_step(0.05 * k, x_m, 3.0, v_mps, 0.0, 0.3, 0.3));
        if (stood_s > 0.0 && stood_s < for_s && report.num_tracks > 0) {
            const float *at = report.tracks[0].state;
            *off_m = fmaxf(*off_m, hypotf(at[0] - (float)x_m, at[1] - 3.0f));
        }
    }
    return passage;
}

static void a_stopped_car_in_the_notch_keeps_its_track(void **state)
{
    float off_m;
    (void)state;
    start_tracker(40.0f, 6.0f, 0.0f);
    describe_radar(0.3f, 0.0f);
    const struct passage passage = fly_stopping_car(20.0, &off_m);
    assert_true(passage.unseen > 390);
    assert_int_equal(passage.lost, 0);
    assert_int_equal(passage.first_id, passage.last_id);
    assert_true(off_m < 1.0f); /* the coasting track stays at the car */
    start_tracker(40.0f, 6.0f, 0.0f);
    describe_radar(0.0f, 0.0f);
    assert_true(fly_stopping_car(20.0, &off_m).lost > 300);
}

/* The track of a car that never drives on ends after some minutes. */
static void a_track_in_the_notch_ends_after_minutes(void **state)
{
    int k = 0;
    (void)state;
    start_tracker(40.0f, 6.0f, 0.0f);
    describe_radar(0.3f, 0.0f);
    for (; k < 100; k++) {
        (void)add_plot_if_outside_notch_and_step(0.5 * k, 150.0 - 0.5 * k, 3.0, -1.0, 0.0, 0.3,
                                                 0.3);
    }
    /* the car stops within one look */
    for (; k < 106; k++) {
        (void)add_plot_if_outside_notch_and_step(0.5 * k, 100.0 - 0.2 * (k - 100), 3.0, -0.4, 0.0,
                                                 0.1, 0.3);
    }
    for (; k < 106 + 560; k++) {
        (void)add_plot_if_outside_notch_and_step(0.5 * k, 98.8, 3.0, 0.0, 0.0, 0.3, 0.3);
    }
    assert_int_equal(report.num_tracks, 1);
    for (; k < 106 + 700; k++) {
        (void)add_plot_if_outside_notch_and_step(0.5 * k, 98.8, 3.0, 0.0, 0.0, 0.3, 0.3);
    }
    assert_int_equal(report.num_tracks, 0);
}

/* A gone target is missed if its range rate would be outside the notch. */
static void a_gone_target_outside_the_notch_ends(void **state)
{
    (void)state;
    for (int blind = 0; blind < 2; blind++) {
        start_tracker(350.0f, 20.0f, 30.0f);
        describe_radar(12.0f, blind ? 40.0f : 0.0f);
        for (int k = 0; k < 40; k++) {
            (void)add_plot_if_outside_notch_and_step(4.0 * k, 8000.0 + 300.0 * k, 0.0, 75.0, 0.0,
                                                     30.0, k < 24 ? 0.0 : 1e9);
        }
        /*
         * 75 m/s is within 12 m/s of a multiple of 40 m/s: misses do not show that the target has
         * gone
         */
        assert_int_equal(report.num_tracks, blind);
    }
}

/* Score that the twentieth plot of an aircraft adds, in a blind or an open look. */
static double score_gain_of_plot_nat(int is_blind)
{
    double before_nat = 0.0;
    start_tracker(350.0f, 20.0f, 30.0f);
    describe_radar(0.0f, 0.0f);
    for (int k = 0; k < 20; k++) {
        (void)add_plot_if_outside_notch_and_step(4.0 * k, 8000.0 + 300.0 * k, 0.0, 75.0, 0.0, 30.0,
                                                 0.0);
        if (k == 18) {
            before_nat = (double)report.tracks[0].score_nat;
            describe_radar(is_blind ? 12.0f : 0.0f, is_blind ? 37.5f : 0.0f);
        }
    }
    assert_int_equal(report.num_tracks, 1);
    return (double)report.tracks[0].score_nat - before_nat;
}

/* All but one of a hundred looks are blind, and three in a hundred blind looks have a plot. */
static void a_plot_of_a_blind_look_adds_less_score(void **state)
{
    (void)state;
    const double less_nat = score_gain_of_plot_nat(0) - score_gain_of_plot_nat(1);
    assert_true(fabs(less_nat - log(0.9 / (0.99 * 0.03 + 0.01 * 0.9))) < 0.2);
}

/* One step without the initiator: 240 plots of clutter, away from the target. */
static void see_among_clutter(double t_s, int is_seen)
{
    for (int i = 0; i < 240; i++) {
        add_plot(9000.0 + 200.0 * (i % 60), -2600.0 + 400.0 * (i / 60), 30.0);
    }
    if (is_seen) {
        add_noisy_plot(8000.0 + 75.0 * t_s, 0.0, 30.0);
    }
    const struct rho_scan scan = {
        .time_us = llround(t_s * 1e6), .sensor_id = SENSOR, .num_plots = num_plots, .plots = plots};
    assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
    num_plots = 0;
}

/* Expected unclaimed plots in the gate of three sigmas, at their density over the covered area. */
static double clutter_plots_in_gate(void)
{
    const struct rho_extent *extent = &tracker.extent;
    const double area_m2 =
        (double)(extent->x_max_m - extent->x_min_m) * (double)(extent->y_max_m - extent->y_min_m);
    return 9.0 * 3.141592653589793 * pow((double)report.tracks[0].sigma_m, 2.0) *
           (double)tracker.unclaimed_plots / area_m2;
}

/* With three plots of clutter in its gate, a track in the notch is missed all the same. */
static void clutter_in_the_gate_ends_coasting_in_the_notch(void **state)
{
    (void)state;
    for (int last = 40; last < 44; last++) {
        double before = 0.0;
        start_tracker(350.0f, 20.0f, 30.0f);
        describe_radar(12.0f, 37.5f);
        for (int k = 0; k < 12; k++) {
            (void)add_plot_if_outside_notch_and_step(4.0 * k, 8000.0 + 300.0 * k, 0.0, 75.0, 0.0,
                                                     30.0, 0.0);
        }
        for (int k = 12; k < 80 && report.tracks[0].misses == 0; k++) {
            before = clutter_plots_in_gate();
            see_among_clutter(4.0 * k, k < last);
            assert_int_equal(report.num_tracks, 1);
        }
        assert_true(before < 3.3 && clutter_plots_in_gate() > 2.7);
    }
}

/*
 * Aircraft on straight courses past the radar, new ones following: range rates of -190 .. 190 m/s.
 */
static void step_flights_past_radar(int k)
{
    for (int i = 0; i < 12; i++) {
        const int life = (k + 7 * i) / 40, age = (k + 7 * i) % 40;
        const double azimuth = 6.2832 * i / 12 + 2.4 * life, x = cos(azimuth), y = sin(azimuth);
        const double along_m = 200.0 * 4.0 * (age - 20), range_m = hypot(9000.0, along_m);
        const double rate_mps = 200.0 * along_m / range_m;
        const double noise_x = 20.0 * normal(), noise_y = 20.0 * normal();
        if (uniform(0.0, 1.0) < 0.9 && fabs(remainder(rate_mps, 60.0)) >= 12.0) {
            (void)add_plot(9000.0 * x - along_m * y + noise_x, 9000.0 * y + along_m * x + noise_y,
                           20.0);
        }
    }
    step_scan((struct rho_scan){.time_us = INT64_C(4000000) * k, .sensor_id = SENSOR});
}

/*
 * P_D is learned outside the notches. Undeclared blind speeds make the sensor suspect; a notch at
 * rest is found a few times, is refuted, and is given up.
 */
static void pd_is_learned_outside_declared_notches(void **state)
{
    struct rho_tracker_known known;
    (void)state;
    for (int is_told = 0; is_told < 2; is_told++) {
        start_tracker(350.0f, 20.0f, 30.0f);
        describe_radar(is_told ? 12.0f : 0.0f, is_told ? 60.0f : 0.0f);
        for (int k = 0; k < 600; k++) {
            step_flights_past_radar(k);
        }
        assert_int_equal(rho_tracker_known_of(&tracker, SENSOR, &known), RHO_OK);
        assert_true(known.looks > 500);
        assert_true(is_told ? known.pd[0] > 0.85f : known.pd[0] < 0.8f);
        assert_true(known.notch_mps <= 0.0f);
    }
}

static void bad_notches_are_refused(void **state)
{
    (void)state;
    start_tracker(350.0f, 20.0f, 30.0f);
    describe_radar(12.0f, 25.0f);
    radar.blind_speed_mps = 24.0f;
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_ERROR_CONFIG);
    radar.blind_speed_mps = 0.0f;
    radar.notch_mps = -1.0f;
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_ERROR_CONFIG);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_aircraft_in_the_notch_keeps_its_track),
        cmocka_unit_test(an_aircraft_in_an_undeclared_notch_is_lost),
        cmocka_unit_test(the_notch_of_a_moving_radar_is_of_rates_over_ground),
        cmocka_unit_test(a_stopped_car_in_the_notch_keeps_its_track),
        cmocka_unit_test(a_track_in_the_notch_ends_after_minutes),
        cmocka_unit_test(a_gone_target_outside_the_notch_ends),
        cmocka_unit_test(pd_is_learned_outside_declared_notches),
        cmocka_unit_test(bad_notches_are_refused),
        cmocka_unit_test(a_plot_of_a_blind_look_adds_less_score),
        cmocka_unit_test(clutter_in_the_gate_ends_coasting_in_the_notch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
