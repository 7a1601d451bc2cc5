/* SPDX-License-Identifier: MIT */
/*
 * Two cars that were taken for one body become two tracks once it is surely wider than any; a truck
 * stays one.
 */
#include "rhotrack/body.h"
#include "tracker_setup.h"

#if RHO_BODIES

#define STEP_S 0.05
#define LONGEST_M 15.0f
#define SPEED_MPS 15.0
#define LANE_M 3.5

static void begin_road(uint64_t seed)
{
    use_usual_configs(seed);
    config.v_max_mps = initiation.v_max_mps = 50.0f;
    begin_tracker();
    assert_int_equal(rho_tracker_set_body_max(&tracker, LONGEST_M), RHO_OK);
}

static double at_m(int k)
{
    return 200.0 - SPEED_MPS * STEP_S * k;
}

/* A scatterer, seen more often than not. */
static void see(double x_m, double y_m, double sigma_m)
{
    if (uniform(0.0, 1.0) < 0.7) {
        add_noisy_plot(x_m, y_m, sigma_m);
    }
}

static void look(int k)
{
    step_at(STEP_S * k);
    assert_true(rho_tracker_is_sound(&tracker));
}

/* Two in neighbouring lanes, one 8 m ahead: from afar they are one, for the noise is as large. */
static void see_cars(int k)
{
    const double sigma_m = k < 40 ? 1.5 : 0.3;
    for (int car = 0; car < 2; car++) {
        for (int i = -1; i <= 1; i++) {
            see(at_m(k) + 8.0 * car + 1.8 * i, LANE_M * car + 0.6 * i, sigma_m);
        }
    }
}

static void two_cars_abreast_become_two(void **state)
{
    unsigned split = 0;
    (void)state;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        begin_road(seed);
        unsigned one = 0;
        for (int k = 0; k < 200; k++) {
            see_cars(k);
            look(k);
            one += report.num_tracks == 1;
        }
        split += one > 20; /* they had been one */
        assert_int_equal(report.num_tracks, 2);
        for (int car = 0; car < 2; car++) {
            unsigned near = 0;
            for (unsigned i = 0; i < 2; i++) {
                const float *place = report.tracks[i].state;
                near += fabs((double)place[RHO_X] - at_m(199) - 8.0 * car) < 1.2 &&
                        fabs((double)place[RHO_Y] - LANE_M * car) < 1.0 &&
                        report.tracks[i].status != RHO_TRACK_TENTATIVE;
            }
            assert_int_equal(near, 1);
        }
        assert_non_null(report_of(1)); /* the identity of both stays one's */
    }
    print_message("%u of 10 had been one\n", split);
    assert_true(split >= 7);
}

static void a_truck_stays_one(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        begin_road(seed);
        for (int k = 0; k < 200; k++) {
            for (int i = 0; i < 8; i++) {
                see(at_m(k) + 1.6 * i - 5.6, i % 2 ? 1.25 : -1.25, 0.3);
            }
            look(k);
        }
        assert_int_equal(report.num_tracks, 1);
        assert_int_equal(tracker.counters.tracks_ended, 0);
    }
}

/* ---- from when on ---------------------------------------------------------------------------- */

/* A body of this width and sigma, known from so many plots, is split in the next scan. */
static int is_split(float width_m, float sigma_m, float of_plots)
{
    begin_road(3);
    for (int k = 0; k < 60; k++) {
        for (int i = -2; i <= 2; i++) {
            add_noisy_plot(at_m(k) + 2.0 * i, 0.2 * i, 0.1);
        }
        look(k);
    }
    assert_int_equal(report.num_tracks, 1);
    struct rho_body_filter *body = &tracker.bodies.of[0];
    body->most_plots = 100; /* scatterers that stay add nothing to the sigma */
    body->plots = of_plots;
    body->heading_sigma_rad = 0.0f;
    body->along.weight = body->across.weight = 2000.0f;
    body->across_m2 = body->across.mean_m2 = width_m * width_m / 12.0f;
    /* the sigma of root(12 v) is 6 / width of v's */
    body->across.variance_m4 = width_m * width_m / 36.0f * sigma_m * sigma_m;
    body->across.prior_share = 0.0f;
    for (int i = -1; i <= 1; i += 2) {
        (void)add_plot(at_m(60) + 1.0 * i, 0.25 * (double)width_m * i, 0.1);
    }
    look(60);
    return report.num_tracks == 2;
}

/* 0.3 of the longest are 4.5 m. */
static void only_what_is_surely_too_wide_is_split(void **state)
{
    (void)state;
    assert_true(is_split(5.5f, 0.3f, 200.0f));
    assert_false(is_split(5.5f, 0.8f, 200.0f));
    assert_false(is_split(4.3f, 0.1f, 200.0f));
    assert_true(is_split(5.0f, 0.1f, 200.0f));
    assert_false(is_split(5.5f, 0.3f, 80.0f));
    assert_true(is_split(5.5f, 0.3f, 130.0f));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_cars_abreast_become_two),
        cmocka_unit_test(a_truck_stays_one),
        cmocka_unit_test(only_what_is_surely_too_wide_is_split),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 0;
}

#endif
