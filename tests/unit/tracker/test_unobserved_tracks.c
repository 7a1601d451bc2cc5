/* SPDX-License-Identifier: MIT */
/*
 * How long a track that no scan looks at is kept: by the interval of the sensor that saw it. Limits
 * are tried with a track that is made by hand, which takes the private header.
 */
#include "../../src/tracker/step.h"
#include "tracker_setup.h"

#define OTHER 2 /* sees nothing of it */

static void scan_of(int32_t sensor_id, double t_s, float from_rad, float to_rad)
{
    step_scan((struct rho_scan){.time_us = llround(t_s * 1e6),
                                .sensor_id = sensor_id,
                                .sector_from_rad = from_rad,
                                .sector_to_rad = to_rad});
}

/*
 * A radar looks to the west every ten seconds for two minutes, and then to the east alone, every
 * second, where a target is, and is silent from `silent_s` on. Seconds until its track ends.
 */
static double kept_s(double silent_s)
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
        scan_of(1, t_s, 2.5f, -2.5f);
    }
    for (double t_s = 120.0; t_s < silent_s; t_s += 1.0) {
        add_plot(10000.0 + 20.0 * t_s, 0.0, 10.0);
        scan_of(1, t_s, -0.5f, 0.5f);
    }
    assert_int_equal(report.num_tracks, 1);
    for (double t_s = silent_s; t_s < silent_s + 2000.0; t_s += 1.0) {
        scan_of(OTHER, t_s, 0.0f, 0.0f);
        if (report.num_tracks == 0) {
            return t_s - silent_s;
        }
    }
    return INFINITY;
}

/* It is taken to look elsewhere after sixteen intervals, here of ten seconds each. */
static void a_sensor_that_turns_elsewhere_has_another_interval(void **state)
{
    (void)state;
    const double before_s = kept_s(110.0 + 0.8 * 160.0), after_s = kept_s(110.0 + 1.3 * 160.0);
    print_message("kept %.0f s, and %.0f s\n", before_s, after_s);
    assert_true(before_s > 5.0 * after_s);
}

/* ---- intervals ------------------------------------------------------------------------------- */

/* Of a sensor that is heard at these times, in seconds. */
static double interval_after(const double *at_s, int num)
{
    use_usual_configs(1);
    begin_tracker();
    for (int i = 0; i < num; i++) {
        scan_of(1, at_s[i], 0.0f, 0.0f);
    }
    return (double)tracker.paces[0].interval_s;
}

/* The newest one counts for a quarter, and as twice the mean one at most. */
static void the_interval_of_a_sensor_is_a_mean(void **state)
{
    static const double sooner[] = {0.0, 10.0, 14.0}, later[] = {0.0, 10.0, 24.0},
                        outage[] = {0.0, 10.0, 60.0};
    (void)state;
    assert_float_equal(interval_after(sooner, 3), 10.0 - 0.25 * 6.0, 1e-4);
    assert_float_equal(interval_after(later, 3), 10.0 + 0.25 * 4.0, 1e-4);
    assert_float_equal(interval_after(outage, 3), 10.0 + 0.25 * 10.0, 1e-4);
}

/* Seconds between hits of a track that is seen every ten, and then once after so many. */
static double seen_every_after(double last_gap_s)
{
    use_usual_configs(1);
    config.gate = RHO_TRACKER_NEAREST;
    config.accel_max_mps2 = 0.5f;
    begin_tracker();
    for (int k = 0; k < 12; k++) {
        add_plot(10000.0 + 20.0 * 10.0 * k, 0.0, 10.0);
        scan_of(1, 10.0 * k, 0.0f, 0.0f);
    }
    assert_int_equal(report.num_tracks, 1);
    const double at_s = 110.0 + last_gap_s;
    add_plot(10000.0 + 20.0 * at_s, 0.0, 10.0);
    scan_of(1, at_s, 0.0f, 0.0f);
    assert_int_equal(report.num_tracks, 1);
    for (unsigned row = 0; row < tracker.num_tracks; row++) {
        if (tracker.tracks[row].status != RHO_TRACK_FREE) {
            return (double)tracker.tracks[row].seen_every_s;
        }
    }
    return 0.0;
}

/* A shorter one counts for half, a longer one for a sixteenth, as scans may have missed it. */
static void the_interval_of_a_track_falls_fast_and_rises_slowly(void **state)
{
    (void)state;
    assert_float_equal(seen_every_after(4.0), 10.0 - 0.5 * 6.0, 1e-4);
    assert_float_equal(seen_every_after(14.0), 10.0 + 0.0625 * 4.0, 1e-4);
    assert_float_equal(seen_every_after(25.0), 10.0 + 0.0625 * 10.0, 1e-4);
}

/* ---- limits ---------------------------------------------------------------------------------- */

/* A confirmed track 10 km east, seen at 0 s by sensor 1, which looks every 4 s and sees so far. */
static struct rho_track *have_track(float range_m, uint8_t misses)
{
    const struct rho_sensor sensor = {.sensor_id = 1, .pd = 0.9f, .range_max_m = range_m};
    struct rho_track *track = &tracker.tracks[0];
    use_usual_configs(1);
    begin_tracker();
    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
    tracker.num_tracks = tracker.num_paces = 1;
    tracker.paces[0].sensor_id = 1;
    tracker.paces[0].interval_s = 4.0f;
    *track = (struct rho_track){.track_id = 1,
                                .status = RHO_TRACK_CONFIRMED,
                                .plot = -1,
                                .sensor_id = 1,
                                .seen_every_s = 4.0f,
                                .misses_in_row = misses};
    track->kalman.state[RHO_X] = 10000.0f;
    return track;
}

static const struct rho_track_limits limits = {.doubt_mnat = 5000, .fall_mnat = 20000};

static int ends_after(float range_m, uint8_t misses, double unseen_s)
{
    struct rho_track *track = have_track(range_m, misses);
    const struct step at = {.tracker = &tracker, .time_us = llround(unseen_s * 1e6)};
    return rho_tracker_update_and_test_unobserved(&at, track, 0, &limits);
}

static void times_without_a_look_end_a_track(void **state)
{
    (void)state;
    /* a sensor might look: four times five scans and a half */
    assert_false(ends_after(20000.0f, 0, 81.9));
    assert_true(ends_after(20000.0f, 0, 82.1));
    /* it looks again: five and a half without its misses, of which there are three */
    assert_false(ends_after(20000.0f, 3, 33.9));
    assert_true(ends_after(20000.0f, 3, 34.1));
    assert_false(ends_after(20000.0f, 2, 34.1));
    /* none sees the place: five but 0.7 */
    assert_false(ends_after(5000.0f, 0, 17.1));
    assert_true(ends_after(5000.0f, 0, 17.3));
}

/* Its plot after so long is doubtful from a tenth of a clutter plot in its gate of 3 sigmas on. */
static void a_plot_among_clutter_is_doubtful_after_long(void **state)
{
    const double sigma_m = sqrt(0.1 / (3.14159265 * 9.0 * 1e-7));
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct rho_track *track = have_track(20000.0f, 0);
        const struct rho_scan scan = {.sensor_id = 1};
        const struct step at = {.tracker = &tracker, .scan = &scan, .time_us = 23000000};
        tracker.unclaimed_plots = 10.0f; /* on 10 by 10 km */
        tracker.extent = (struct rho_extent){0.0f, 10000.0f, 0.0f, 10000.0f};
        for (int axis = 0; axis < 2; axis++) {
            track->kalman.covariance[RHO_AT(axis, axis)] =
                (float)(sigma_m * sigma_m * (i ? 1.02 : 0.98));
            track->kalman.covariance[RHO_AT(3 + axis, 3 + axis)] = 1.0f;
        }
        track->plot = 0;
        assert_false(rho_tracker_update_and_test_unobserved(&at, track, 0, &limits));
        assert_int_equal(track->score_mnat, i ? -5000 : 0);
        assert_int_equal(track->seen_us, 23000000); /* whichever row the plot has */
    }
}

static void a_plot_out_of_sequence_was_seen_then(void **state)
{
    (void)state;
    for (int16_t plot = -1; plot < 2; plot++) {
        struct rho_track *track = have_track(20000.0f, 0);
        const struct step at = {.tracker = &tracker, .time_us = 3000000, .is_late = 1};
        track->plot = plot;
        assert_false(rho_tracker_update_and_test_unobserved(&at, track, 0, &limits));
        assert_int_equal(track->seen_us, plot < 0 ? 0 : 3000000);
    }
}

static void a_place_as_uncertain_as_the_sensor_sees_far_is_unknown(void **state)
{
    struct rho_track *track = have_track(20000.0f, 0);
    const struct step at = {.tracker = &tracker};
    (void)state;
    for (int i = 0; i < 2; i++) {
        for (int axis = 0; axis < 2; axis++) {
            track->kalman.covariance[RHO_AT(axis, axis)] = i ? 4.04e8f : 3.96e8f;
            track->kalman.covariance[RHO_AT(3 + axis, 3 + axis)] = 1.0f;
        }
        assert_int_equal(rho_tracker_is_place_too_uncertain(&at, track), i);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sensor_that_turns_elsewhere_has_another_interval),
        cmocka_unit_test(the_interval_of_a_sensor_is_a_mean),
        cmocka_unit_test(the_interval_of_a_track_falls_fast_and_rises_slowly),
        cmocka_unit_test(times_without_a_look_end_a_track),
        cmocka_unit_test(a_plot_among_clutter_is_doubtful_after_long),
        cmocka_unit_test(a_plot_out_of_sequence_was_seen_then),
        cmocka_unit_test(a_place_as_uncertain_as_the_sensor_sees_far_is_unknown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
