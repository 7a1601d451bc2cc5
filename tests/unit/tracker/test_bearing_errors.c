/* SPDX-License-Identifier: MIT */
/*
 * Errors of bearings that last: found by plots of the same tracks, and then weighed once. A radar
 * sees two boats each second, a camera at the origin sees them half a second later.
 */
#include "../tracker_setup.h"

#define CAMERA 2
#define SIGMA_RAD 0.005
#define PLOT_SIGMA_M 5.0

/* Error of the camera's bearings of a boat at a time. */
typedef double (*error_of)(int boat, double t_s);

static double boat_x_m(int boat, double t_s)
{
    return 300.0 - 3.0 * t_s + 40.0 * boat;
}

static double boat_y_m(int boat, double t_s)
{
    return 200.0 - 300.0 * boat + 2.0 * t_s;
}

static void look_from_camera(error_of error, double t_s)
{
    struct rho_bearing bearings[2];
    const struct rho_bearing_scan scan = {.time_us = llround(t_s * 1e6),
                                          .sensor_id = CAMERA,
                                          .num_bearings = 2,
                                          .bearings = bearings};
    for (int boat = 0; boat < 2; boat++) {
        bearings[boat] = (struct rho_bearing){
            .bearing_rad = (float)(atan2(boat_y_m(boat, t_s), boat_x_m(boat, t_s)) +
                                   error(boat, t_s) + SIGMA_RAD * normal()),
            .sigma_rad = (float)SIGMA_RAD};
    }
    assert_int_equal(rho_tracker_step_bearings(&tracker, NULL, &scan, &report), RHO_OK);
}

static const struct rho_bearing_errors *errors_of_camera(void)
{
    for (unsigned row = 0; row < tracker.num_rows; row++) {
        if (tracker.sensors[row].sensor.sensor_id == CAMERA) {
            return &tracker.sensors[row].bearing_errors;
        }
    }
    fail_msg("the tracker has no row of the camera");
    return NULL;
}

/* RMS error of the tracks from 30 s on. */
static double rms_m_with(error_of error, float learn_noise_max, uint64_t seed)
{
    double square = 0.0;
    int rows = 0;
    use_usual_configs(seed);
    config.v_max_mps = initiation.v_max_mps = 20.0f;
    config.v_min_mps = initiation.v_min_mps = 0.0f;
    config.accel_max_mps2 = 0.5f;
    config.learn_noise_max = learn_noise_max;
    begin_tracker();
    for (int t_s = 0; t_s < 100; t_s++) {
        for (int boat = 0; boat < 2; boat++) {
            add_noisy_plot(boat_x_m(boat, t_s), boat_y_m(boat, t_s), PLOT_SIGMA_M);
        }
        step_at(t_s);
        for (unsigned i = 0; i < report.num_tracks && t_s >= 30; i++) {
            const float *state = report.tracks[i].state;
            double nearest2 = INFINITY;
            for (int boat = 0; boat < 2; boat++) {
                nearest2 = fmin(nearest2, pow((double)state[0] - boat_x_m(boat, t_s), 2.0) +
                                              pow((double)state[1] - boat_y_m(boat, t_s), 2.0));
            }
            square += nearest2;
            rows++;
        }
        assert_true(rho_tracker_is_sound(&tracker));
        if (error) {
            look_from_camera(error, t_s + 0.5);
        }
    }
    assert_true(rows >= 130);
    return sqrt(square / rows);
}

/* Of eleven seeds: now and then a track that was pulled away at first goes on beside the boat. */
static double median_rms_m(error_of error, float learn_noise_max)
{
    double rms_m[11];
    for (int i = 0; i < 11; i++) {
        const double one_m = rms_m_with(error, learn_noise_max, (uint64_t)i + 1);
        int at = i;
        for (; at > 0 && rms_m[at - 1] > one_m; at--) {
            rms_m[at] = rms_m[at - 1];
        }
        rms_m[at] = one_m;
    }
    return rms_m[5];
}

static double no_error(int boat, double t_s)
{
    return 0.0 * boat * t_s;
}

static double a_bias(int boat, double t_s)
{
    return 0.04 + 0.0 * boat * t_s;
}

static double bow_to_stern(int boat, double t_s)
{
    return 0.04 * sin(0.3 * t_s + 2.0 * boat);
}

static void errors_that_last_do_not_pull_tracks(void **state)
{
    static const error_of lasting[2] = {a_bias, bow_to_stern};
    (void)state;
    const double alone_m = median_rms_m(NULL, 4.0f);
    for (int i = 0; i < 2; i++) {
        const double believed_m = median_rms_m(lasting[i], 1.0f);
        const double with_m = median_rms_m(lasting[i], 4.0f);
        print_message("%.1f m alone, %.1f m with a camera, %.1f m where it is believed\n", alone_m,
                      with_m, believed_m);
        assert_true(believed_m > 1.5 * alone_m);
        assert_true(with_m < 1.15 * alone_m);
        const struct rho_bearing_errors *errors = errors_of_camera();
        const double sigma_rad = sqrt((double)(errors->excess / errors->weight));
        assert_true(sigma_rad > 0.018 && sigma_rad < 0.055);
    }
}

static void bearings_as_stated_are_believed(void **state)
{
    (void)state;
    const double alone_m = median_rms_m(NULL, 4.0f);
    const double with_m = median_rms_m(no_error, 4.0f);
    print_message("%.1f m alone, %.1f m with a camera\n", alone_m, with_m);
    assert_true(with_m < 0.85 * alone_m);
}

/* A pair is a plot and the first bearing after it; sums beyond their limits are not sound. */
static void pairs_are_counted_and_have_limits(void **state)
{
    (void)state;
    (void)rms_m_with(no_error, 4.0f, 1);
    struct rho_bearing_errors *errors = (struct rho_bearing_errors *)errors_of_camera();
    assert_true(errors->pairs > 150.0f && errors->pairs <= 200.0f);
    for (int i = 0; i < 3; i++) {
        const struct rho_bearing_errors kept = *errors;
        *(i == 0 ? &errors->pairs : i == 1 ? &errors->weight : &errors->excess) = NAN;
        assert_false(rho_tracker_is_sound(&tracker));
        *errors = kept;
        assert_true(rho_tracker_is_sound(&tracker));
    }
}

/* The plot that a track keeps is its last one. */
static void a_track_keeps_its_last_plot(void **state)
{
    const struct rho_plot plot = {
        .x_m = 30.0f, .y_m = -40.0f, .sigma_range_m = 2.0f, .sigma_cross_m = 7.0f};
    struct rho_track track = {0};
    (void)state;
    rho_track_keep_plot(&track, &plot);
    assert_float_equal(track.plot_m[0], 30.0, 0.0);
    assert_float_equal(track.plot_m[1], -40.0, 0.0);
    assert_float_equal(track.plot_sigma_m, 7.0, 0.0);
    assert_int_equal(track.has_new_plot, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_that_last_do_not_pull_tracks),
        cmocka_unit_test(bearings_as_stated_are_believed),
        cmocka_unit_test(pairs_are_counted_and_have_limits),
        cmocka_unit_test(a_track_keeps_its_last_plot),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
