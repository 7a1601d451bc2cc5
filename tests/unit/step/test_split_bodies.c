/* SPDX-License-Identifier: MIT */
/*
 * Two cars tracked as one body are split once the body is surely wider or longer than any target,
 * or range rates show its parts moving apart; a truck keeps one track.
 */
#include "rhotrack/body.h"
#include "tracker_setup.h"

#if RHO_BODIES

#define STEP_S 0.05
#define LONGEST_M 15.0f
#define SPEED_MPS 15.0
#define LANE_M 3.5

static void start_tracker_on_road(uint64_t seed)
{
    use_usual_configs(seed);
    config.v_max_mps = initiation.v_max_mps = 50.0f;
    begin_tracker();
    assert_int_equal(rho_tracker_set_body_max(&tracker, LONGEST_M), RHO_OK);
}

static double road_place_m(int k)
{
    return 200.0 - SPEED_MPS * STEP_S * k;
}

/* A scatterer seen with probability 0.7. */
static void see_scatterer_at(double x_m, double y_m, double sigma_m)
{
    if (uniform(0.0, 1.0) < 0.7) {
        add_noisy_plot(x_m, y_m, sigma_m);
    }
}

static void step_scan_at(int k)
{
    step_at(STEP_S * k);
    assert_true(rho_tracker_is_sound(&tracker));
}

/*
 * Two cars in neighbouring lanes, one 8 m ahead: from afar the noise is as large as their distance,
 * so they are one.
 */
static void see_cars(int k)
{
    const double sigma_m = k < 40 ? 1.5 : 0.3;
    for (int car = 0; car < 2; car++) {
        for (int i = -1; i <= 1; i++) {
            see_scatterer_at(road_place_m(k) + 8.0 * car + 1.8 * i, LANE_M * car + 0.6 * i,
                             sigma_m);
        }
    }
}

static void two_cars_abreast_are_split_into_two_tracks(void **state)
{
    unsigned split = 0;
    (void)state;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        start_tracker_on_road(seed);
        unsigned one = 0;
        for (int k = 0; k < 200; k++) {
            see_cars(k);
            step_scan_at(k);
            one += report.num_tracks == 1;
        }
        split += one > 20; /* they had been tracked as one */
        assert_int_equal(report.num_tracks, 2);
        for (int car = 0; car < 2; car++) {
            unsigned near = 0;
            for (unsigned i = 0; i < 2; i++) {
                const float *place = report.tracks[i].state;
                near += fabs((double)place[RHO_X] - road_place_m(199) - 8.0 * car) < 1.2 &&
                        fabs((double)place[RHO_Y] - LANE_M * car) < 1.0 &&
                        report.tracks[i].status != RHO_TRACK_TENTATIVE;
            }
            assert_int_equal(near, 1);
        }
        assert_non_null(report_of(1)); /* one car keeps the identity of the common track */
    }
    print_message("%u of 10 had been one\n", split);
    assert_true(split >= 7);
}

static void a_truck_keeps_one_track(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        start_tracker_on_road(seed);
        for (int k = 0; k < 200; k++) {
            for (int i = 0; i < 8; i++) {
                see_scatterer_at(road_place_m(k) + 1.6 * i - 5.6, i % 2 ? 1.25 : -1.25, 0.3);
            }
            step_scan_at(k);
        }
        assert_int_equal(report.num_tracks, 1);
        assert_int_equal(tracker.counters.tracks_ended, 0);
    }
}

/* ---- splits by range rates and lengths ------------------------------------------------------- */

#define RATE_SIGMA_MPS 0.1

/*
 * A body in front of the radar: its place, velocity and turn rate; and a scatterer in the body's
 * axes.
 */
struct body {
    double x_m, y_m, speed_mps, course_rad, turn_radps;
};

static double azimuth_sigma_rad = 0.01;

/* wheels_mps: additional spread of range rates of its parts */
static void see_scatterer(const struct body *body, double along_m, double across_m,
                          double wheels_mps)
{
    const double c = cos(body->course_rad), s = sin(body->course_rad);
    const double off_x_m = c * along_m - s * across_m, off_y_m = s * along_m + c * across_m;
    const double x_m = body->x_m + off_x_m, y_m = body->y_m + off_y_m;
    const double range_m = hypot(x_m, y_m), cross_m = azimuth_sigma_rad * range_m;
    const double rate_mps = ((body->speed_mps * c - body->turn_radps * off_y_m) * x_m +
                             (body->speed_mps * s + body->turn_radps * off_x_m) * y_m) /
                            range_m;
    if (uniform(0.0, 1.0) > 0.6) {
        return;
    }
    const double far_m = 0.2 * normal(), side_m = cross_m * normal();
    const double off_mps = RATE_SIGMA_MPS * normal() + wheels_mps * uniform(-1.0, 1.0);
    struct rho_plot *plot = add_plot(x_m + (far_m * x_m - side_m * y_m) / range_m,
                                     y_m + (far_m * y_m + side_m * x_m) / range_m, 0.2);
    plot->sigma_cross_m = (float)cross_m;
    plot->range_rate_mps = (float)(rate_mps + off_mps);
    plot->sigma_range_rate_mps = (float)RATE_SIGMA_MPS;
}

static void see_car(const struct body *body)
{
    for (int i = -1; i <= 1; i++) {
        see_scatterer(body, 1.5 * i, 0.6 * i, 0.0);
    }
}

static void see_truck(const struct body *body, double wheels_mps)
{
    for (int i = 0; i < 8; i++) {
        see_scatterer(body, 1.6 * i - 5.6, i % 2 ? 1.25 : -1.25, wheels_mps);
    }
}

static void drive_one_step(struct body *body)
{
    body->course_rad += STEP_S * body->turn_radps;
    body->x_m += STEP_S * body->speed_mps * cos(body->course_rad);
    body->y_m += STEP_S * body->speed_mps * sin(body->course_rad);
}

static void step_scan_with_rates(int k)
{
    step_scan((struct rho_scan){.time_us = llround(STEP_S * 1e6 * k),
                                .measures = RHO_MEASURES_RANGE_RATE});
    assert_true(rho_tracker_is_sound(&tracker));
}

/*
 * Counts, of ten runs, those in which both cars have a track at the end; *had_been_one: those with
 * one track for a second.
 */
static unsigned count_runs_of_two_tracks(struct body one, struct body other, int looks,
                                         unsigned *had_been_one)
{
    unsigned runs = 0;
    *had_been_one = 0;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        struct body cars[2] = {one, other};
        unsigned looks_of_one = 0, near[2] = {0, 0};
        start_tracker_on_road(seed);
        for (int k = 0; k < looks; k++) {
            for (int car = 0; car < 2; car++) {
                see_car(&cars[car]);
                drive_one_step(&cars[car]);
            }
            step_scan_with_rates(k);
            looks_of_one += report.num_tracks == 1;
        }
        *had_been_one += looks_of_one > 20;
        for (unsigned i = 0; i < report.num_tracks; i++) {
            for (int car = 0; car < 2; car++) {
                near[car] += fabs((double)report.tracks[i].state[RHO_X] - cars[car].x_m) < 2.0 &&
                             fabs((double)report.tracks[i].state[RHO_Y] - cars[car].y_m) < 1.5;
            }
        }
        runs += report.num_tracks == 2 && near[0] == 1 && near[1] == 1;
    }
    return runs;
}

/* Side by side, one of them 1 m/s faster: they are 6 m apart at the end. */
static void range_rates_split_an_overtaking_car(void **state)
{
    unsigned had_been_one;
    (void)state;
    const unsigned runs =
        count_runs_of_two_tracks((struct body){150.0, 0.0, -6.0, 0.0, 0.0},
                                 (struct body){150.0, LANE_M, -7.0, 0.0, 0.0}, 120, &had_been_one);
    print_message("two in %u, after one in %u of 10\n", runs, had_been_one);
    assert_true(had_been_one >= 7 && runs >= 8);
}

static void two_cars_in_a_row_are_split_by_their_length(void **state)
{
    unsigned had_been_one;
    (void)state;
    const unsigned runs =
        count_runs_of_two_tracks((struct body){100.0, 5.0, -7.0, 0.0, 0.0},
                                 (struct body){113.0, 5.0, -7.0, 0.0, 0.0}, 200, &had_been_one);
    print_message("two in %u, after one in %u of 10\n", runs, had_been_one);
    assert_true(had_been_one >= 2);
    assert_int_equal(runs, 10);
}

/* A truck and a car beside it, at one speed: together they are wider than any body so long. */
static void a_car_beside_a_truck_has_its_own_track(void **state)
{
    unsigned runs = 0, looks_of_one = 0;
    (void)state;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        struct body truck = {16.0, 6.0, 16.0, 0.0, 0.0}, car = {14.0, 6.0 + LANE_M, 16.0, 0.0, 0.0};
        start_tracker_on_road(seed);
        assert_int_equal(rho_tracker_set_body_max(&tracker, 20.0f), RHO_OK);
        for (int k = 0; k < 120; k++) {
            see_truck(&truck, 0.0);
            see_car(&car);
            drive_one_step(&truck);
            drive_one_step(&car);
            step_scan_with_rates(k);
            looks_of_one += report.num_tracks == 1;
        }
        runs += report.num_tracks == 2;
    }
    print_message("two in %u of 10, after one in %.1f looks\n", runs, 0.1 * looks_of_one);
    assert_true(runs >= 9);
    assert_true(looks_of_one <= 10 * 40);
}

static unsigned count_runs_of_one_track(double turn_radps, double wheels_mps)
{
    unsigned runs = 0;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        struct body truck = {120.0, -20.0, 6.0, 2.0, 0.0};
        start_tracker_on_road(seed);
        for (int k = 0; k < 300; k++) {
            truck.turn_radps = k > 100 ? turn_radps : 0.0;
            see_truck(&truck, wheels_mps);
            drive_one_step(&truck);
            step_scan_with_rates(k);
        }
        runs += report.num_tracks == 1;
    }
    return runs;
}

/* The ends of a turning truck have different range rates, soon explained by its heading. */
static void a_turning_truck_keeps_one_track(void **state)
{
    (void)state;
    assert_int_equal(count_runs_of_one_track(0.0, 0.0), 10);
    assert_int_equal(count_runs_of_one_track(0.1, 0.0), 10);
    assert_true(count_runs_of_one_track(0.25, 0.0) >= 9);
}

/* Range rates that differ at random, not from place to place. */
static void range_rates_of_wheels_do_not_split_a_truck(void **state)
{
    (void)state;
    assert_true(count_runs_of_one_track(0.0, 0.3) >= 9);
}

/*
 * Near the radar the line of sight turns fast: an error of a plot's azimuth moves it along the body
 * and changes the range rate that is expected there, as a part that moves apart would.
 */
static void a_car_that_passes_near_the_radar_keeps_one_track(void **state)
{
    unsigned runs = 0;
    (void)state;
    azimuth_sigma_rad = 0.045;
    for (uint64_t seed = 1; seed <= 30; seed++) {
        struct body car = {30.0, 5.0 + 0.5 * (double)seed, 12.0, acos(-1.0), 0.0};
        start_tracker_on_road(seed);
        for (int k = 0; k < 200; k++) {
            see_car(&car);
            see_car(&car);
            drive_one_step(&car);
            step_scan_with_rates(k);
        }
        runs += report.num_tracks == 1;
    }
    azimuth_sigma_rad = 0.01;
    print_message("one in %u of 30\n", runs);
    assert_true(runs >= 29);
}

/* ---- limits of splits by width --------------------------------------------------------------- */

/* Whether a body of this width and sigma, shaped by so many plots, is split in the next scan. */
static int is_split(float width_m, float sigma_m, float of_plots)
{
    start_tracker_on_road(3);
    for (int k = 0; k < 60; k++) {
        for (int i = -2; i <= 2; i++) {
            add_noisy_plot(road_place_m(k) + 2.0 * i, 0.2 * i, 0.1);
        }
        step_scan_at(k);
    }
    assert_int_equal(report.num_tracks, 1);
    struct rho_body_filter *body = &tracker.bodies.of[0];
    body->most_plots = 100; /* scatterers that stay in place add nothing to the sigma */
    body->plots = of_plots;
    body->heading_sigma_rad = 0.0f;
    body->along.weight = body->across.weight = 2000.0f;
    body->across_m2 = body->across.mean_m2 = width_m * width_m / 12.0f;
    /* the width is root(12 v), so its sigma is 6 / width of v's sigma */
    body->across.variance_m4 = width_m * width_m / 36.0f * sigma_m * sigma_m;
    body->across.prior_share = 0.0f;
    for (int i = -1; i <= 1; i += 2) {
        (void)add_plot(road_place_m(60) + 1.0 * i, 0.25 * (double)width_m * i, 0.1);
    }
    step_scan_at(60);
    return report.num_tracks == 2;
}

/* The limit is 0.3 of the body's length, of 9.7 m and its error: about 3.1 m. */
static void only_surely_too_wide_bodies_are_split(void **state)
{
    (void)state;
    assert_true(is_split(5.5f, 0.3f, 200.0f));
    assert_false(is_split(5.5f, 1.3f, 200.0f));
    assert_false(is_split(3.0f, 0.1f, 200.0f));
    assert_true(is_split(3.6f, 0.1f, 200.0f));
    assert_false(is_split(5.5f, 0.3f, 80.0f));
    assert_true(is_split(5.5f, 0.3f, 130.0f));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_cars_abreast_are_split_into_two_tracks),
        cmocka_unit_test(a_truck_keeps_one_track),
        cmocka_unit_test(range_rates_split_an_overtaking_car),
        cmocka_unit_test(two_cars_in_a_row_are_split_by_their_length),
        cmocka_unit_test(a_car_beside_a_truck_has_its_own_track),
        cmocka_unit_test(a_turning_truck_keeps_one_track),
        cmocka_unit_test(range_rates_of_wheels_do_not_split_a_truck),
        cmocka_unit_test(a_car_that_passes_near_the_radar_keeps_one_track),
        cmocka_unit_test(only_surely_too_wide_bodies_are_split),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 0;
}

#endif
