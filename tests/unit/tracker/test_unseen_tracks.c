/* SPDX-License-Identifier: MIT */
/*
 * How long an unobserved track is kept: by the scan interval of the sensor that saw it. Limits are
 * tested with a track made by hand, with the private header.
 */
#include "../../src/tracker/clutter.h"
#include "../../src/tracker/plots.h"
#include "../../src/tracker/sensors.h"
#include "../../src/tracker/step.h"
#include "tracker_setup.h"

#define OTHER 2 /* a sensor that does not cover the track */

static void step_empty_scan(int32_t sensor_id, double t_s, float from_rad, float to_rad)
{
    step_scan((struct rho_scan){.time_us = llround(t_s * 1e6),
                                .sensor_id = sensor_id,
                                .sector_from_rad = from_rad,
                                .sector_to_rad = to_rad});
}

/*
 * A radar looks west every ten seconds for two minutes, then only east, where the target is, every
 * second, and is silent from `silent_from_s` on. Returns seconds until its track ends.
 */
static double seconds_until_track_ends(double silent_from_s)
{
    use_usual_configs(1);
    config.gate = RHO_TRACKER_NEAREST;
    config.accel_max_mps2 = 0.5f;
    begin_tracker();
    for (int32_t id = 1; id <= OTHER; id++) {
        const struct rho_sensor sensor = {
            .sensor_id = id, .x_m = id == OTHER ? -9e5f : 0.0f, .pd = 0.9f, .range_max_m = 5e4f};
        assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
    }
    for (double t_s = 0.0; t_s < 120.0; t_s += 10.0) {
        step_empty_scan(1, t_s, 2.5f, -2.5f);
    }
    for (double t_s = 120.0; t_s < silent_from_s; t_s += 1.0) {
        add_plot(10000.0 + 20.0 * t_s, 0.0, 10.0);
        step_empty_scan(1, t_s, -0.5f, 0.5f);
    }
    assert_int_equal(report.num_tracks, 1);
    for (double t_s = silent_from_s; t_s < silent_from_s + 2000.0; t_s += 1.0) {
        step_empty_scan(OTHER, t_s, 0.0f, 0.0f);
        if (report.num_tracks == 0) {
            return t_s - silent_from_s;
        }
    }
    return INFINITY;
}

/*
 * Another sector counts as the radar's usual one after sixteen intervals, here of ten seconds each.
 */
static void a_new_sector_counts_as_usual_after_sixteen_intervals(void **state)
{
    (void)state;
    const double before_s = seconds_until_track_ends(110.0 + 0.8 * 160.0),
                 after_s = seconds_until_track_ends(110.0 + 1.3 * 160.0);
    print_message("kept %.0f s, and %.0f s\n", before_s, after_s);
    assert_true(before_s > 5.0 * after_s);
}

/* ---- scan intervals -------------------------------------------------------------------------- */

/* Interval of a sensor heard at these times, in seconds. */
static double interval_learned_from_scans_at(const double *at_s, int num)
{
    use_usual_configs(1);
    begin_tracker();
    for (int i = 0; i < num; i++) {
        step_empty_scan(1, at_s[i], 0.0f, 0.0f);
    }
    return (double)tracker.sensors[0].pace.interval_s;
}

/* The newest interval weighs a quarter, and counts as twice the mean at most. */
static void the_interval_of_a_sensor_is_a_running_mean(void **state)
{
    static const double sooner[] = {0.0, 10.0, 14.0}, later[] = {0.0, 10.0, 24.0},
                        outage[] = {0.0, 10.0, 60.0};
    (void)state;
    assert_float_equal(interval_learned_from_scans_at(sooner, 3), 10.0 - 0.25 * 6.0, 1e-4);
    assert_float_equal(interval_learned_from_scans_at(later, 3), 10.0 + 0.25 * 4.0, 1e-4);
    assert_float_equal(interval_learned_from_scans_at(outage, 3), 10.0 + 0.25 * 10.0, 1e-4);
}

/* Hit interval of a track seen every ten seconds, and then once after last_gap_s. */
static double track_interval_after(double last_gap_s)
{
    use_usual_configs(1);
    config.gate = RHO_TRACKER_NEAREST;
    config.accel_max_mps2 = 0.5f;
    begin_tracker();
    for (int k = 0; k < 12; k++) {
        add_plot(10000.0 + 20.0 * 10.0 * k, 0.0, 10.0);
        step_empty_scan(1, 10.0 * k, 0.0f, 0.0f);
    }
    assert_int_equal(report.num_tracks, 1);
    const double at_s = 110.0 + last_gap_s;
    add_plot(10000.0 + 20.0 * at_s, 0.0, 10.0);
    step_empty_scan(1, at_s, 0.0f, 0.0f);
    assert_int_equal(report.num_tracks, 1);
    for (unsigned row = 0; row < tracker.num_tracks; row++) {
        if (tracker.tracks[row].status != RHO_TRACK_FREE) {
            return (double)tracker.tracks[row].seen_every_s;
        }
    }
    return 0.0;
}

/* A shorter interval weighs half, a longer one a sixteenth, as scans may have missed the target. */
static void a_tracks_hit_interval_falls_fast_and_rises_slowly(void **state)
{
    (void)state;
    assert_float_equal(track_interval_after(4.0), 10.0 - 0.5 * 6.0, 1e-4);
    assert_float_equal(track_interval_after(14.0), 10.0 + 0.0625 * 4.0, 1e-4);
    assert_float_equal(track_interval_after(25.0), 10.0 + 0.0625 * 10.0, 1e-4);
}

/* ---- limits of unobserved time --------------------------------------------------------------- */

/*
 * A confirmed track 10 km east, seen at 0 s by sensor 1, which looks every 4 s up to
 * sensor_range_max_m.
 */
static struct rho_track *make_confirmed_track(float sensor_range_max_m, uint8_t misses)
{
    const struct rho_sensor sensor = {
        .sensor_id = 1, .pd = 0.9f, .range_max_m = sensor_range_max_m};
    struct rho_track *track = &tracker.tracks[0];
    use_usual_configs(1);
    begin_tracker();
    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
    tracker.num_tracks = tracker.num_rows = 1;
    tracker.sensors[0].sensor.sensor_id = 1;
    tracker.sensors[0].pace.is_heard = 1;
    tracker.sensors[0].pace.interval_s = 4.0f;
    *track = (struct rho_track){.track_id = 1,
                                .status = RHO_TRACK_CONFIRMED,
                                .plot = -1,
                                .sensor_id = 1,
                                .seen_every_s = 4.0f,
                                .misses_in_row = misses};
    track->kalman.state[RHO_X] = 10000.0f;
    return track;
}

static int does_track_end_after(float sensor_range_max_m, uint8_t misses, double unseen_s)
{
    struct rho_track *track = make_confirmed_track(sensor_range_max_m, misses);
    const struct step at = {.tracker = &tracker,
                            .look = {.tracker = &tracker,
                                     .fates = report.fates,
                                     .teaches = 1,
                                     .time_us = llround(unseen_s * 1e6)}};
    return rho_unseen_update(&at.look, track);
}

static void unobserved_tracks_end_at_their_time_limits(void **state)
{
    (void)state;
    /* covered by a sensor: four times five and a half scans */
    assert_false(does_track_end_after(20000.0f, 0, 81.9));
    assert_true(does_track_end_after(20000.0f, 0, 82.1));
    /* whatever was missed */
    assert_false(does_track_end_after(20000.0f, 3, 81.9));
    assert_true(does_track_end_after(20000.0f, 3, 82.1));
    /* outside all coverage: five scans less 0.7 */
    assert_false(does_track_end_after(5000.0f, 0, 17.1));
    assert_true(does_track_end_after(5000.0f, 0, 17.3));
}

/* The unit of a target's life: the interval of the slowest sensor that sees the track. */
static void the_slowest_sensor_that_sees_a_track_sets_its_interval(void **state)
{
    (void)state;
    for (int i = 0; i < 5; i++) {
        struct rho_track *track = make_confirmed_track(20000.0f, 0);
        const struct rho_sensor other = {
            .sensor_id = 2, .pd = 0.9f, .range_max_m = i == 1 ? 9000.0f : 20000.0f};
        const struct rho_look look = {.tracker = &tracker};
        assert_int_equal(rho_tracker_set_sensor(&tracker, &other), RHO_OK);
        tracker.num_rows = 2;
        tracker.sensors[1].pace.is_heard = i != 2;
        tracker.sensors[1].pace.interval_s = 10.0f;
        track->sensor_id = i == 4 ? 2 : 1;
        track->seen_every_s = i == 3 ? 12.0f : 3.0f;
        assert_float_equal(rho_unseen_interval_s(&look, track),
                           i == 3             ? 12.0f
                           : i == 1 || i == 2 ? 4.0f
                                              : 10.0f,
                           0.0f);
    }
}

/* A hit restarts the time for which a track is unseen, whichever row the plot has. */
static void a_hit_restarts_the_unseen_time(void **state)
{
    (void)state;
    for (int16_t plot = -1; plot < 2; plot++) {
        struct rho_track *track = make_confirmed_track(20000.0f, 0);
        const struct rho_look look = {.tracker = &tracker, .teaches = 1, .time_us = 23000000};
        track->plot = plot;
        assert_false(rho_unseen_update(&look, track));
        assert_int_equal(track->seen_us, plot < 0 ? 0 : 23000000);
    }
}

static void an_out_of_sequence_plot_counts_at_its_own_time(void **state)
{
    (void)state;
    for (int16_t plot = -1; plot < 2; plot++) {
        struct rho_track *track = make_confirmed_track(20000.0f, 0);
        const struct step at = {
            .tracker = &tracker,
            .look = {.tracker = &tracker, .fates = report.fates, .time_us = 3000000, .teaches = 0}};
        track->plot = plot;
        assert_false(rho_unseen_update(&at.look, track));
        assert_int_equal(track->seen_us, plot < 0 ? 0 : 3000000);
    }
}

static void tracks_as_uncertain_as_the_sensors_range_end(void **state)
{
    struct rho_track *track = make_confirmed_track(20000.0f, 0);
    (void)state;
    for (int i = 0; i < 2; i++) {
        for (int axis = 0; axis < 2; axis++) {
            track->kalman.covariance[RHO_AT(axis, axis)] = i ? 4.04e8f : 3.96e8f;
            track->kalman.covariance[RHO_AT(3 + axis, 3 + axis)] = 1.0f;
        }
        assert_int_equal(rho_unseen_is_lost(&tracker, track), i);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_new_sector_counts_as_usual_after_sixteen_intervals),
        cmocka_unit_test(the_interval_of_a_sensor_is_a_running_mean),
        cmocka_unit_test(a_tracks_hit_interval_falls_fast_and_rises_slowly),
        cmocka_unit_test(unobserved_tracks_end_at_their_time_limits),
        cmocka_unit_test(the_slowest_sensor_that_sees_a_track_sets_its_interval),
        cmocka_unit_test(a_hit_restarts_the_unseen_time),
        cmocka_unit_test(an_out_of_sequence_plot_counts_at_its_own_time),
        cmocka_unit_test(tracks_as_uncertain_as_the_sensors_range_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
