/* SPDX-License-Identifier: MIT */
/* How long a track that no scan looks at is kept: by the interval of the sensor that saw it. */
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
    draw(1);
    config.gate = RHO_TRACKER_NEAREST;
    config.accel_max_mps2 = 0.5f;
    begin();
    for (int32_t id = 1; id <= OTHER; id++) {
        const struct rho_sensor sensor = {
            .sensor_id = id, .x_m = id == OTHER ? -9e5f : 0.0f, .pd = 0.9f, .range_max_m = 5e4f};
        assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
    }
    for (double t_s = 0.0; t_s < 120.0; t_s += 10.0) {
        scan_of(1, t_s, 2.5f, -2.5f);
    }
    for (double t_s = 120.0; t_s < silent_s; t_s += 1.0) {
        add(10000.0 + 20.0 * t_s, 0.0, 10.0);
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
    draw(1);
    begin();
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
    draw(1);
    config.gate = RHO_TRACKER_NEAREST;
    config.accel_max_mps2 = 0.5f;
    begin();
    for (int k = 0; k < 12; k++) {
        add(10000.0 + 20.0 * 10.0 * k, 0.0, 10.0);
        scan_of(1, 10.0 * k, 0.0f, 0.0f);
    }
    assert_int_equal(report.num_tracks, 1);
    const double at_s = 110.0 + last_gap_s;
    add(10000.0 + 20.0 * at_s, 0.0, 10.0);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sensor_that_turns_elsewhere_has_another_interval),
        cmocka_unit_test(the_interval_of_a_sensor_is_a_mean),
        cmocka_unit_test(the_interval_of_a_track_falls_fast_and_rises_slowly),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
